//! Units of the rows, and the clock: CPU time of this thread, which other programs do not lengthen.

use faer::Mat;
use faer::linalg::solvers::PartialPivLu;
use nalgebra::{SMatrix, SVector};
use std::hint::black_box;
use std::time::Instant;

/// What a row is a multiple of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// LU of order 11 with one solution, nalgebra.
    Lu11,
    /// LU of this order, faer, one thread.
    Faer(usize),
}

impl Unit {
    /// Its name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lu11 => "LU11",
            Self::Faer(500) => "LU500",
            Self::Faer(_) => "LU1000",
        }
    }
}

/// CPU seconds of this thread; where the system does not tell them, of a clock.
pub fn cpu_seconds() -> f64 {
    thread_local!(static START: Instant = Instant::now());
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told
        .as_deref()
        .and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| START.with(|start| start.elapsed().as_secs_f64()), |ns| ns * 1e-9)
}

/// Seconds of one unit: the least of several runs.
pub fn unit_seconds(unit: Unit) -> f64 {
    // The system tells CPU time in steps of some milliseconds.
    let (count, runs) = match unit {
        Unit::Lu11 => (40_000, 5),
        Unit::Faer(500) => (4, 5),
        Unit::Faer(_) => (1, 5),
    };
    let mut least = f64::INFINITY;
    for _ in 0..runs {
        let begin = cpu_seconds();
        for _ in 0..count {
            match unit {
                Unit::Lu11 => lu11(),
                Unit::Faer(order) => lu(order),
            }
        }
        least = least.min((cpu_seconds() - begin) / f64::from(count));
    }
    least
}

fn lu11() {
    let a = SMatrix::<f64, 11, 11>::from_fn(|i, j| if i == j { 5.0 } else { 1.0 / (1 + i * 3 + j) as f64 });
    let b = SVector::<f64, 11>::from_element(1.0);
    black_box(black_box(a).lu().solve(black_box(&b)));
}

fn lu(order: usize) {
    let a = Mat::<f64>::from_fn(order, order, |i, j| {
        if i == j { 50.0 } else { (1.0 + (i * 3 + j) as f64).sin() }
    });
    black_box(PartialPivLu::new(black_box(a).as_ref()));
}
