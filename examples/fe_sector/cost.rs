//! What a response cost: where the time went, and the memory.

use std::io::Write;
use std::time::Duration;

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
    match peak_memory() {
        Some(mebibytes) => writeln!(screen, "  peak memory {mebibytes:.0} MiB"),
        None => Ok(()),
    }
}

/// The most memory that this process has occupied, in MiB, where the system tells (Linux).
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes / 1024.0)
}
