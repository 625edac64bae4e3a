//! Cost of a response: time of its parts, times for comparison, and memory.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::time::{Duration, Instant};

use hbvib::{Interrupt, Model, SolverOptions};

use hbvib::internals::Condensed;
use hbvib::internals::Lu;
use hbvib::internals::Workspace;

use crate::memory::peak_memory;
use crate::response::Response;

/// Repetitions of a measurement; the shortest time counts.
const REPEATS: usize = 5;

/// Shows the time of every part of a response, and the peak memory of the program.
///
/// # Errors
///
/// If the screen cannot be written to, or a measurement fails.
pub fn show(screen: &mut impl Write, read: Duration, model: &Model, response: &Response) -> Result<(), Box<dyn Error>> {
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
        ("curve, peaks, at frequencies", times.curve),
        ("recovery of all motions", times.recovery),
    ] {
        writeln!(screen, "  {what:<34}{:>9.3} s", time.as_secs_f64())?;
    }
    let per_iteration = (times.first_point + times.curve).as_secs_f64() / iterations.max(1) as f64;
    writeln!(
        screen,
        "  {iterations} Newton iterations on the curve, {:.2} ms each with all related work",
        1e3 * per_iteration
    )?;
    let lu = dense_lu(reduction.unknowns)?.as_secs_f64();
    writeln!(
        screen,
        "  one dense LU of {} unknowns takes {:.3} ms: the whole is {:.1} of them per iteration",
        reduction.unknowns,
        1e3 * lu,
        per_iteration / lu
    )?;
    let solver = SolverOptions {
        harmonics: response.branch.harmonics(),
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let direct = factorisation(model, &solver, response.peak.frequency * TAU)?.as_secs_f64();
    writeln!(
        screen,
        "  flexibility by factorisation: {:.2} ms per frequency for {} harmonics",
        1e3 * direct,
        reduction.harmonics_carried
    )?;
    let estimates = response.branch.estimates();
    if estimates > 0 {
        let of_points = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        writeln!(
            screen,
            "  {estimates} error estimates: {:.1e} at most, with up to {} harmonics",
            of_points(response.branch.error_estimate()),
            of_points(response.branch.harmonics_used())
        )?;
    }
    if let Some(mebibytes) = peak_memory() {
        writeln!(screen, "  peak memory {mebibytes:.0} MiB")?;
    }
    Ok(())
}

/// Time of one dense real LU factorisation, for comparison with an iteration.
fn dense_lu(n: usize) -> Result<Duration, Box<dyn Error>> {
    let mut lu = Lu::<f64>::new(n, 1)?;
    let mut best = Duration::MAX;
    for _ in 0..REPEATS {
        for (k, x) in lu.matrix().iter_mut().enumerate() {
            *x = (k as f64 * 0.37).sin() + if k % (n + 1) == 0 { 4.0 } else { 0.0 };
        }
        let begin = Instant::now();
        lu.factor(&Interrupt::none())?;
        best = best.min(begin.elapsed());
    }
    Ok(best)
}

/// Time of factorising the dynamic stiffness and solving for every contact, all harmonics.
fn factorisation(model: &Model, solver: &SolverOptions, omega: f64) -> Result<Duration, Box<dyn Error>> {
    let condensed = Condensed::new(model, solver, omega, &Interrupt::none())?;
    let mut workspace = Workspace::new(&condensed, None)?;
    let mut best = Duration::MAX;
    for _ in 0..REPEATS {
        let begin = Instant::now();
        for i in 0..condensed.blocks().len() {
            workspace.evaluate(&condensed, i, omega, false, &Interrupt::none())?;
        }
        best = best.min(begin.elapsed());
    }
    Ok(best)
}
