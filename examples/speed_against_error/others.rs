//! Time against error of the other analyses of the ring damper: its nonlinear mode, and one motion by integration in time.

use std::error::Error;
use std::io::Write;

use hbvib::{
    Branch, ForcedOptions, Hooks, ModeOptions, SolverOptions, SteadyMethod, TimeOptions, forced_response,
    nonlinear_mode, time_response,
};
use num_complex::Complex64;

use crate::cpu_time::{cpu_seconds, lu11_seconds};
use crate::model::{B2, Parameters};
use crate::tables::Done;
use crate::truth::fundamental;

/// log10 of the amplitudes of the mode, from stuck contacts to free sliding.
const RANGE: (f64, f64) = (-7.0, -1.0);

/// Harmonics of the truth.
const TRUTH: usize = 255;

/// A frequency near the peak, rad/s.
const OMEGA: f64 = 1312.0;

/// Repetitions; the quickest counts.
const REPEATS: usize = 3;

/// CPU time of a computation, s, and its result.
fn timed<T>(compute: impl Fn() -> Result<T, Box<dyn Error>>) -> Result<(f64, T), Box<dyn Error>> {
    let mut best = f64::INFINITY;
    let mut result = None;
    for _ in 0..REPEATS {
        let begin = cpu_seconds();
        result = Some(compute()?);
        best = best.min(cpu_seconds() - begin);
    }
    Ok((best, result.ok_or("nothing was computed")?))
}

fn options(harmonics: usize, tolerance: f64) -> SolverOptions {
    SolverOptions {
        harmonics,
        tolerance,
        response_dof: Some(B2),
        ..SolverOptions::default()
    }
}

/// Shows both tables.
///
/// # Errors
///
/// If a computation fails, or the screen cannot be written to.
pub fn show(screen: &mut impl Write) -> Done {
    let unit = lu11_seconds();
    modes(screen, unit)?;
    motions(screen, unit)
}

/// The nonlinear mode with several H, and from a tolerance.
fn modes(screen: &mut impl Write, unit: f64) -> Done {
    let model = Parameters::default().model()?;
    let at: Vec<f64> = (0..=12).map(|i| -6.5 + f64::from(i) / 2.4).collect();
    let range = ModeOptions {
        log10_start: RANGE.0,
        log10_stop: RANGE.1,
        at: &at,
        ..ModeOptions::default()
    };
    let mode = |harmonics, tolerance| -> Result<Branch, Box<dyn Error>> {
        let solver = options(harmonics, tolerance);
        Ok(nonlinear_mode(&model, &solver, &range, &mut Hooks::default())?)
    };
    // Frequency and damping ratio at the amplitudes.
    let numbers = |branch: &Branch| -> Vec<(f64, f64)> {
        let points = (0..at.len()).filter_map(|i| branch.at(i).first().map(|s| s.point));
        let both = |k| Some((branch.omega_at(k)?, branch.mode_at(k)?.damping_ratio));
        points.filter_map(both).collect()
    };
    let truth = numbers(&mode(TRUTH, 0.0)?);
    let largest = truth.iter().fold(0.0_f64, |most, (_, d)| most.max(d.abs()));
    writeln!(
        screen,
        "\nNonlinear mode of the ring damper, six decades of amplitude; truth: H = {TRUTH}\n\n\
         way               time ms  1000 LU11  points  largest error of frequency  of damping, over its largest"
    )?;
    let fixed = [1, 3, 5, 9, 15, 31, 63, 127].map(|h| (h, 0.0));
    for (harmonics, tolerance) in fixed.into_iter().chain([1e-2, 1e-3, 1e-4].map(|t| (9, t))) {
        let (seconds, branch) = timed(|| mode(harmonics, tolerance))?;
        let found = numbers(&branch);
        let pairs = || found.iter().zip(&truth);
        let of_omega = pairs().fold(0.0_f64, |most, (a, b)| most.max((a.0 / b.0 - 1.0).abs()));
        let of_damping = pairs().fold(0.0_f64, |most, (a, b)| most.max((a.1 - b.1).abs() / largest));
        let missing = truth.len() - found.len();
        let name = name(harmonics, tolerance);
        write!(
            screen,
            "{name:<16}  {:>7.2}  {:>9.2}  {:>6}  {of_omega:>26.1e}  {of_damping:>28.1e}",
            1e3 * seconds,
            1e-3 * seconds / unit,
            branch.points()
        )?;
        if missing > 0 {
            write!(screen, "  {missing} amplitudes missing")?;
        }
        writeln!(screen)?;
    }
    Ok(())
}

/// One motion, by harmonics and by integration in time.
fn motions(screen: &mut impl Write, unit: f64) -> Done {
    let model = Parameters::default().model()?;
    let solve = |harmonics, tolerance| -> Result<Branch, Box<dyn Error>> {
        let at = ForcedOptions {
            omega_start: OMEGA,
            omega_stop: OMEGA,
            ..ForcedOptions::default()
        };
        let solver = options(harmonics, tolerance);
        Ok(forced_response(&model, &solver, &at, &mut Hooks::default())?)
    };
    let truth = fundamental(&solve(2 * TRUTH + 1, 0.0)?, 0);
    let error = |x: Complex64| (x - truth).norm() / truth.norm();
    writeln!(
        screen,
        "\nOne motion of the ring damper, {OMEGA} rad/s; truth: H = {}\n\n\
         way                              time ms  1000 LU11  periods  error of the fundamental",
        2 * TRUTH + 1
    )?;
    let mut row = |name: &str, seconds: f64, periods: usize, x: Complex64| {
        writeln!(
            screen,
            "{name:<31}  {:>7.2}  {:>9.2}  {periods:>7}  {:>24.1e}",
            1e3 * seconds,
            1e-3 * seconds / unit,
            error(x)
        )
    };
    for (harmonics, tolerance) in [(9, 0.0), (31, 0.0), (63, 0.0), (127, 0.0), (9, 1e-3), (9, 1e-6)] {
        let (seconds, branch) = timed(|| solve(harmonics, tolerance))?;
        row(&name(harmonics, tolerance), seconds, 0, fundamental(&branch, 0))?;
    }
    let near = solve(9, 1e-3)?;
    let mut start = vec![Complex64::ZERO; (near.harmonics() + 1) * near.ndof()];
    near.harmonics_at(0, &mut start)?;
    let ways = [
        ("time, from tolerance 1e-3", SteadyMethod::Shooting, Some(&start[..])),
        ("time, from rest", SteadyMethod::Shooting, None),
        ("time, period after period", SteadyMethod::Marching, None),
    ];
    for (name, method, start) in ways {
        let in_time = TimeOptions {
            omega: OMEGA,
            method,
            start,
            // As small as the error of the truth.
            tolerance: 1e-9,
            ..TimeOptions::default()
        };
        let (seconds, found) = timed(|| Ok(time_response(&model, &in_time, &mut Hooks::default())?))?;
        row(name, seconds, found.periods, found.harmonics[found.ndof + B2])?;
    }
    Ok(())
}

fn name(harmonics: usize, tolerance: f64) -> String {
    if tolerance > 0.0 {
        format!("tolerance {tolerance:.0e}")
    } else {
        format!("H = {harmonics}")
    }
}
