//! Converged solutions at frequencies that all ways of a system have in common.

use std::error::Error;
use std::thread;

use hbvib::analysis::forced_response;
use hbvib::hooks::Hooks;
use hbvib::options::{ForcedOptions, SolverOptions};
use hbvib::results::Branch;
use num_complex::Complex64;

use crate::measure::sweep;
use crate::systems::System;

/// Relative error by rounding and by the end of Newton's method.
pub const ROUNDING: f64 = 1e-11;

/// Largest number of frequencies.
const MOST: usize = 25;

/// Relative distance in frequency from a fold within which no solution is compared: at a fold the error at a fixed
/// frequency is infinite, however accurate the curve is.
const FOLD: f64 = 2e-3;

/// Residual at which the truth counts as converged.
const RESIDUAL: f64 = 1e-12;

/// A converged solution.
#[derive(Clone, Copy, Debug)]
pub struct Solution {
    /// Angular frequency.
    pub omega: f64,
    /// Fundamental of the response degree of freedom.
    pub response: Complex64,
}

/// Converged solutions along a response.
#[derive(Debug)]
pub struct Truth {
    /// Harmonics and samples.
    pub with: (usize, usize),
    /// The solutions, in the order of the branch.
    pub solutions: Vec<Solution>,
    /// Amplitude at the largest peak.
    pub peak: f64,
    /// Largest relative change from half the harmonics and samples: at least the error of the truth.
    pub change: f64,
}

/// Fundamental of the response degree of freedom at a stored point.
pub fn fundamental(branch: &Branch, point: usize) -> Complex64 {
    let place = branch.carried_at(point).and_then(|c| c.iter().position(|&h| h == 1));
    let all = branch.response_at(point).unwrap_or_default();
    place.and_then(|i| all.get(i).copied()).unwrap_or(Complex64::ZERO)
}

fn amplitude_of_peak(branch: &Branch) -> f64 {
    branch.peaks().iter().fold(0.0, |m, p| p.amplitude.max(m))
}

impl Truth {
    /// Spreads frequencies evenly over the points of a branch with many harmonics and solves there with the
    /// harmonics of the truth.
    ///
    /// # Errors
    ///
    /// If a solution is not found.
    pub fn new(system: &System) -> Result<Self, Box<dyn Error>> {
        let (harmonics, samples) = system.truth;
        let guide = SolverOptions {
            harmonics: harmonics.min(63),
            samples: samples.min(1024),
            tolerance: 0.0,
            response_dof: Some(system.response),
            ..SolverOptions::default()
        };
        let branch = sweep(system, &guide, &[])?;
        let near_fold = |omega: f64| branch.folds().iter().any(|f| (omega / f.omega - 1.0).abs() < FOLD);
        let far: Vec<usize> = (0..branch.points())
            .filter(|&k| !near_fold(branch.omega()[k]))
            .collect();
        let count = MOST.min(far.len());
        let points: Vec<usize> = (0..count).map(|i| far[i * (far.len() - 1) / (count - 1)]).collect();
        let half = (harmonics / 2, samples / 2);
        let both = |k: usize| -> Result<(Solution, f64), String> {
            let omega = branch.omega()[k];
            let solve = |with| solve_near(system, &branch, k, (omega, omega), with).map_err(|e| e.to_string());
            let response = fundamental(&solve(system.truth)?, 0);
            let change = (fundamental(&solve(half)?, 0) - response).norm() / response.norm();
            Ok((Solution { omega, response }, change))
        };
        let (one, other) = points.split_at(count / 2);
        let solve_all = |points: &[usize]| points.iter().map(|&k| both(k)).collect::<Result<Vec<_>, _>>();
        let (first, second) = thread::scope(|scope| {
            let thread = scope.spawn(|| solve_all(other));
            (solve_all(one), thread.join())
        });
        let mut found = first?;
        found.extend(second.map_err(|_| "a thread of the truth panicked")??);
        let peak = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        let peak = match peak {
            Some(p) => {
                let about = (p.omega * (1.0 - 3e-4), p.omega * (1.0 + 3e-4));
                // The solution starts from the point of the curve before the peak, so that it stays on the same
                // branch.
                amplitude_of_peak(&solve_near(system, &branch, p.point, about, system.truth)?)
            }
            None => f64::NAN,
        };
        Ok(Self {
            with: system.truth,
            change: found.iter().map(|s| s.1).fold(0.0, f64::max),
            solutions: found.into_iter().map(|s| s.0).collect(),
            peak,
        })
    }

    /// The converged fundamental at the frequency of a stored point, from its harmonics.
    ///
    /// # Errors
    ///
    /// If it is not found.
    pub fn near(&self, system: &System, branch: &Branch, point: usize) -> Result<Complex64, Box<dyn Error>> {
        let omega = branch.omega_at(point).ok_or("no such point")?;
        let found = solve_near(system, branch, point, (omega, omega), self.with)?;
        Ok(fundamental(&found, 0))
    }

    /// Relative error of the amplitude at the largest peak.
    pub fn error_of_peak(&self, branch: &Branch) -> f64 {
        (amplitude_of_peak(branch) / self.peak - 1.0).abs()
    }
}

/// The response over a range of frequency with other harmonics, from a stored point.
fn solve_near(
    system: &System,
    branch: &Branch,
    point: usize,
    (omega_start, omega_stop): (f64, f64),
    (harmonics, samples): (usize, usize),
) -> Result<Branch, Box<dyn Error>> {
    let n = branch.ndof();
    let mut guess = vec![Complex64::ZERO; (branch.harmonics() + 1) * n];
    branch.harmonics_at(point, &mut guess)?;
    guess.resize((harmonics + 1) * n, Complex64::ZERO);
    let options = SolverOptions {
        harmonics,
        samples,
        tolerance: 0.0,
        response_dof: Some(system.response),
        tol_residual: RESIDUAL,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start,
        omega_stop,
        guess: Some(&guess),
        ..ForcedOptions::default()
    };
    Ok(forced_response(&system.model, &options, &range, &mut Hooks::default())?)
}
