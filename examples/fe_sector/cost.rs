//! What a response cost: where the time went, and the memory.

use std::io::Write;
use std::time::{Duration, Instant};

use hbvib::linalg::lu::Lu;

use crate::response::Response;

/// Shows the time of every part of a response, and the most memory that the program has used.
///
/// # Errors
///
/// If the screen cannot be written to.
pub fn show(screen: &mut impl Write, read: Duration, response: &Response) -> std::io::Result<()> {
    let reduction = response.branch.reduction();
    let times = &response.times;
    let iterations = response.iterations();
    writeln!(
        screen,
        "{} degrees of freedom condensed onto {} relative motions, {} real unknowns",
        reduction.degrees_of_freedom, reduction.coordinates, reduction.unknowns
    )?;
    for (what, time) in [
        ("reading the files", read),
        ("condensation and first point", times.first_point),
        ("curve, peaks, wanted frequencies", times.curve),
        ("recovery of all motions", times.recovery),
    ] {
        writeln!(screen, "  {what:<34}{:>9.3} s", time.as_secs_f64())?;
    }
    let per_iteration = (times.first_point + times.curve).as_secs_f64() / iterations.max(1) as f64;
    writeln!(
        screen,
        "  {iterations} Newton iterations on the curve, {:.2} ms each with all that goes with them",
        1e3 * per_iteration
    )?;
    if let Some(solve) = dense_solve(reduction.unknowns) {
        let solves = solve.as_secs_f64() * iterations.max(1) as f64;
        let sweep = (times.first_point + times.curve).as_secs_f64();
        writeln!(
            screen,
            "  {:.1} times as long as so many dense solves of that order, {:.2} ms each",
            sweep / solves,
            1e3 * solve.as_secs_f64()
        )?;
    }
    match peak_memory() {
        Some(mebibytes) => writeln!(screen, "  peak memory {mebibytes:.0} MiB"),
        None => Ok(()),
    }
}

/// The quickest of several factorisations of a full real matrix of order `n`, each with one solution.
fn dense_solve(n: usize) -> Option<Duration> {
    let mut lu: Lu<f64> = Lu::new(n, 1).ok()?;
    let mut b = vec![1.0; n];
    let once = |_| {
        for (i, a) in lu.matrix().iter_mut().enumerate() {
            let (row, column) = (i % n, i / n);
            *a = if row == column {
                n as f64
            } else {
                ((row * 31 + column * 17) % 101) as f64 * 0.01
            };
        }
        let begin = Instant::now();
        lu.factor().ok()?;
        lu.solve(&mut b);
        Some(begin.elapsed())
    };
    (0..7).filter_map(once).min()
}

/// The most memory that this process has occupied, in MiB, where the system tells (Linux).
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes / 1024.0)
}
