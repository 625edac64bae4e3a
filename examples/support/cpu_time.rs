//! CPU time of this thread, which other programs on the machine do not lengthen, and the unit in which small work is told.

use nalgebra::{SMatrix, SVector};
use std::hint::black_box;

/// CPU time of this thread so far, s.
#[cfg(unix)]
pub fn cpu_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is valid for writing.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Time since the first call, s: this system tells no CPU time of a thread.
#[cfg(not(unix))]
pub fn cpu_seconds() -> f64 {
    use std::time::Instant;
    thread_local!(static START: Instant = Instant::now());
    START.with(|start| start.elapsed().as_secs_f64())
}

/// CPU time of one LU factorisation of order 11 with a solution, "LU11", s: the least of several stretches.
#[allow(dead_code, reason = "not every program that includes this file tells multiples")]
pub fn lu11_seconds() -> f64 {
    const COUNT: u32 = 10_000;
    let a = SMatrix::<f64, 11, 11>::from_fn(|i, j| if i == j { 5.0 } else { 1.0 / (1 + i * 3 + j) as f64 });
    let b = SVector::<f64, 11>::from_element(1.0);
    let stretch = |_| {
        let begin = cpu_seconds();
        for _ in 0..COUNT {
            black_box(black_box(a).lu().solve(black_box(&b)));
        }
        (cpu_seconds() - begin) / f64::from(COUNT)
    };
    (0..10).map(stretch).fold(f64::INFINITY, f64::min)
}
