//! Time of a way for a whole response, and the errors of its points.

use std::error::Error;
use std::thread;

use hbvib::{Branch, ForcedOptions, Hooks, SolverOptions, Special, Status, estimate_at, forced_response};
use num_complex::Complex64;

use crate::cpu_time::cpu_seconds;
use crate::systems::System;
use crate::truth::{ROUNDING, Truth, fundamental};

/// A way to compute a response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// Highest harmonic number; where a tolerance chooses, the initial one.
    pub harmonics: usize,
    /// Samples per period; 0: as accurate as the laws allow.
    pub samples: usize,
    /// Requested relative error; 0: exactly `harmonics`.
    pub tolerance: f64,
}

impl Way {
    /// The options of the solver.
    pub fn options(&self, response: usize) -> SolverOptions {
        SolverOptions {
            harmonics: self.harmonics,
            samples: self.samples,
            tolerance: self.tolerance,
            response_dof: Some(response),
            ..SolverOptions::default()
        }
    }

    /// Whether the tolerance chooses the harmonics.
    pub fn is_automatic(&self) -> bool {
        self.tolerance > 0.0
    }
}

/// Estimated and true error of one solution.
#[derive(Clone, Copy, Debug)]
pub struct Checked {
    /// Angular frequency.
    pub omega: f64,
    /// Highest carried harmonic.
    pub harmonics: usize,
    /// Error estimate of the library; NaN if it is unknown.
    pub estimate: f64,
    /// The true error; NaN if the way has no such solution, or the truth was not found.
    pub error: f64,
}

/// Time and errors of a way.
#[derive(Debug)]
pub struct Outcome {
    pub way: Way,
    /// CPU time of the whole response without estimates that were not requested, s.
    pub seconds: f64,
    pub points: usize,
    pub status: Status,
    /// Smallest, median and largest of the highest harmonics of the points.
    pub used: [usize; 3],
    /// Number of error estimates for the choice of harmonics.
    pub estimates: usize,
    /// Highest harmonic of a fold.
    pub at_folds: usize,
    /// Solutions at the common frequencies.
    pub checked: Vec<Checked>,
    /// Points of the branch itself, for ways that choose their harmonics.
    pub own: Vec<Checked>,
    /// Relative error of the largest peak.
    pub peak: f64,
    /// Number of common frequencies at which the library reports an unknown error.
    pub unknown: usize,
}

impl Outcome {
    /// The largest error at the common frequencies where there is a solution.
    pub fn error(&self) -> f64 {
        largest(&self.checked)
    }

    /// Number of common frequencies at which the solution is missing.
    pub fn missing(&self) -> usize {
        self.checked.iter().filter(|c| c.error.is_nan()).count()
    }

    /// Number of points of the branch for which no converged solution was found.
    pub fn unsolved(&self) -> usize {
        self.own.iter().filter(|c| c.error.is_nan()).count()
    }

    /// The largest error of the points of the branch itself.
    pub fn own_error(&self) -> f64 {
        largest(&self.own)
    }

    /// Numbers of solutions whose ratio of estimated to true error lies within [0.3, 3] and within [0.1, 10], and
    /// number of solutions whose ratio is known.
    pub fn effectivity(&self, floor: f64) -> [usize; 3] {
        let ratios = self.checked.iter().chain(&self.own);
        let ratios = ratios.filter(|c| c.error > floor && c.estimate.is_finite());
        ratios.fold([0; 3], |[near, far, all], c| {
            let ratio = c.estimate / c.error;
            let within = |factor: f64| usize::from(ratio * factor >= 1.0 && ratio <= factor);
            // The narrow band is [0.3, 3]; 0.3 is not 1/3.
            let narrow = usize::from((0.3..=3.0).contains(&ratio));
            [near + narrow, far + within(10.0), all + 1]
        })
    }
}

fn largest(of: &[Checked]) -> f64 {
    of.iter().fold(0.0, |m, c| c.error.max(m))
}

/// Follows the whole response.
///
/// # Errors
///
/// If no point is found.
pub fn sweep(system: &System, options: &SolverOptions, at: &[f64]) -> Result<Branch, Box<dyn Error>> {
    let range = ForcedOptions {
        omega_start: system.range.0,
        omega_stop: system.range.1,
        at,
        ..ForcedOptions::default()
    };
    Ok(forced_response(&system.model, options, &range, &mut Hooks::default())?)
}

/// Largest number of timing rounds.
const ROUNDS: usize = 9;
/// Time after which a way is no longer repeated, s.
const ENOUGH: f64 = 0.4;

/// Times the ways alternately, so that other load of the machine affects all of them, and checks them.
///
/// # Errors
///
/// If a way does not find a first point.
pub fn all(system: &System, ways: &[Way], truth: &Truth) -> Result<Vec<Outcome>, Box<dyn Error>> {
    let mut outcomes = Vec::new();
    for way in ways {
        outcomes.push(check(system, *way, truth)?);
    }
    let mut spent = vec![0.0; ways.len()];
    for _ in 0..ROUNDS {
        for (outcome, spent) in outcomes.iter_mut().zip(&mut spent).filter(|o| *o.1 < ENOUGH) {
            let begin = cpu_seconds();
            let branch = sweep(system, &outcome.way.options(system.response), &[])?;
            let seconds = cpu_seconds() - begin;
            outcome.seconds = outcome.seconds.min(seconds);
            *spent += seconds;
            outcome.points = branch.points();
            outcome.estimates = branch.estimates();
        }
    }
    Ok(outcomes)
}

/// Number of checked points of a branch whose way chooses its harmonics.
const OWN: usize = 12;

fn check(system: &System, way: Way, truth: &Truth) -> Result<Outcome, Box<dyn Error>> {
    let options = way.options(system.response);
    let at: Vec<f64> = truth.solutions.iter().map(|s| s.omega).collect();
    let branch = sweep(system, &options, &at)?;
    let checked = truth.solutions.iter().enumerate().map(|(i, solution)| {
        // On a branch with folds, the solution nearest to the truth is compared.
        let distance = |s: &&Special| (fundamental(&branch, s.point) - solution.response).norm();
        let same = branch.at(i).iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        same.map_or(
            Checked {
                omega: solution.omega,
                harmonics: 0,
                estimate: f64::NAN,
                error: f64::NAN,
            },
            |s| Checked {
                estimate: estimate(system, &options, &branch, s.point),
                ..with_error(&branch, s.point, Some(solution.response))
            },
        )
    });
    let checked: Vec<Checked> = checked.collect();
    let mut used: Vec<usize> = branch.harmonics_used().iter().map(|h| *h as usize).collect();
    used.sort_unstable();
    let highest = |point| branch.carried_at(point).and_then(|c| c.last().copied()).unwrap_or(0);
    Ok(Outcome {
        way,
        seconds: f64::INFINITY,
        points: branch.points(),
        status: branch.status(),
        used: [used[0], used[used.len() / 2], used[used.len() - 1]],
        estimates: branch.estimates(),
        at_folds: branch.folds().iter().map(|f| highest(f.point)).max().unwrap_or(0),
        own: if way.is_automatic() {
            own(system, &branch, truth)
        } else {
            Vec::new()
        },
        peak: truth.error_of_peak(&branch),
        unknown: checked.iter().filter(|c| c.estimate.is_nan()).count(),
        checked,
    })
}

/// The error estimate of a stored point: the stored one, if the branch has it.
fn estimate(system: &System, options: &SolverOptions, branch: &Branch, point: usize) -> f64 {
    if options.tolerance > 0.0 {
        return branch.error_estimate_at(point).unwrap_or(f64::NAN);
    }
    estimate_at(&system.model, options, branch, point).map_or(f64::NAN, |e| e.response)
}

/// Points of a branch, spread evenly, compared with the solution with the harmonics of the truth that Newton's
/// method finds from them; half of them on a separate thread.
fn own(system: &System, branch: &Branch, truth: &Truth) -> Vec<Checked> {
    let last = branch.points() - 1;
    let points: Vec<usize> = (0..OWN).map(|i| i * last / (OWN - 1)).collect();
    let some = |points: &[usize]| -> Vec<Checked> {
        let exact = |k| truth.near(system, branch, k).ok();
        points.iter().map(|&k| with_error(branch, k, exact(k))).collect()
    };
    let (one, other) = points.split_at(OWN / 2);
    thread::scope(|scope| {
        let thread = scope.spawn(|| some(other));
        let mut found = some(one);
        found.extend(thread.join().unwrap_or_default());
        found
    })
}

fn with_error(branch: &Branch, point: usize, exact: Option<Complex64>) -> Checked {
    let found = fundamental(branch, point);
    let error = exact.map_or(f64::NAN, |x| (found - x).norm() / x.norm());
    Checked {
        omega: branch.omega_at(point).unwrap_or(f64::NAN),
        harmonics: branch.carried_at(point).and_then(|c| c.last().copied()).unwrap_or(0),
        estimate: branch.error_estimate_at(point).unwrap_or(f64::NAN),
        error: if error < ROUNDING { 0.0 } else { error },
    }
}
