//! One forced response, complete or refused, with its points in the paper's convention.

use std::error::Error;
use std::f64::consts::TAU;

use hbvib::analysis::forced_response;
use hbvib::branch::Branch;
use hbvib::error::Status;
use hbvib::hooks::{Hooks, Progress};
use hbvib::options::{ForcedOptions, SolverOptions};
use num_complex::Complex64;

use crate::model::{B2, DOFS, Parameters};

/// A range of frequency, and frequencies within it at which every solution is wanted, in Hz.
#[derive(Clone, Debug, Default)]
pub struct Range {
    /// Where the response begins.
    pub from: f64,
    /// Where it ends; it may lie below the begin.
    pub to: f64,
    /// In the order in which the solutions are to be listed.
    pub at: Vec<f64>,
}

/// A solution: motion of sector 1, x(t) = Re Σ `X_p` exp(i p ω t).
#[derive(Clone, Debug)]
pub struct Point {
    /// Frequency of the force, Hz.
    pub frequency: f64,
    /// Every harmonic that is carried: its number, and `X_p` in the order of [`DOFS`], m.
    pub harmonics: Vec<(usize, [Complex64; DOFS.len()])>,
}

impl Point {
    /// |`X_1`| of b2, m.
    pub fn amplitude(&self) -> f64 {
        let first = self.harmonics.iter().find(|h| h.0 == 1);
        first.map_or(0.0, |h| h.1[B2].norm())
    }
}

/// A response over the whole of a range.
#[derive(Clone, Debug)]
pub struct Response {
    /// The curve from exactly the begin to exactly the end.
    pub points: Vec<Point>,
    /// The point of largest amplitude, an end of the range if it is there.
    pub peak: Point,
    /// Every solution at the frequencies asked for, in the order asked.
    pub at: Vec<Point>,
    /// Whether rounding kept the residual of a point above the solver's tolerance.
    pub stalled: bool,
}

impl Response {
    /// Follows the response and reports the share of the range that is done.
    ///
    /// # Errors
    ///
    /// If the model or an option is refused, or the response could not be followed to its end.
    pub fn follow(
        parameters: &Parameters,
        solver: &SolverOptions,
        range: &Range,
        mut progress: impl FnMut(f64),
    ) -> Result<Self, Box<dyn Error>> {
        let solver = SolverOptions {
            response_dof: Some(B2),
            ..*solver
        };
        let at: Vec<f64> = range.at.iter().map(|f| f * TAU).collect();
        let options = ForcedOptions {
            omega_start: range.from * TAU,
            omega_stop: range.to * TAU,
            at: &at,
            guess: None,
        };
        let mut report = |state: &Progress| {
            progress(state.fraction_done);
            false
        };
        let mut hooks = Hooks {
            progress: Some(&mut report),
            ..Hooks::default()
        };
        let branch = forced_response(&parameters.model()?, &solver, &options, &mut hooks)?;
        let end = branch.omega().last().copied().unwrap_or(f64::NAN);
        if end.to_bits() != options.omega_stop.to_bits() {
            let reason = branch.status().name().to_string_lossy();
            return Err(format!(
                "the response ends at {} Hz ({reason}), before {} Hz",
                end / TAU,
                range.to
            )
            .into());
        }
        Self::collect(&branch, range)
    }

    fn collect(branch: &Branch, range: &Range) -> Result<Self, Box<dyn Error>> {
        // Hz to rad/s and back may change the last digit: the frequencies given are kept as given.
        let given = |omega: f64| {
            let mut known = [range.from, range.to].into_iter();
            let found = known.find(|f| (f * TAU).to_bits() == omega.to_bits());
            found.unwrap_or(omega / TAU)
        };
        let curve = branch.omega().iter().enumerate();
        let points: Vec<Point> = curve
            .map(|(i, &omega)| point(branch, i, given(omega)))
            .collect::<Result<_, _>>()?;
        let mut at = Vec::new();
        for (i, &frequency) in range.at.iter().enumerate() {
            if branch.at(i).is_empty() {
                return Err(format!("no solution was found at {frequency} Hz").into());
            }
            for special in branch.at(i) {
                at.push(point(branch, special.point, frequency)?);
            }
        }
        let maxima = branch.peaks().iter().map(|p| point(branch, p.point, given(p.omega)));
        let maxima: Vec<Point> = maxima.collect::<Result<_, _>>()?;
        let all = maxima.iter().chain(&points).chain(&at);
        let peak = all.reduce(|best, p| if p.amplitude() > best.amplitude() { p } else { best });
        let peak = peak.ok_or("the response has no points")?.clone();
        let stalled = branch.status() == Status::StoppedStalled;
        Ok(Self {
            points,
            peak,
            at,
            stalled,
        })
    }
}

fn point(branch: &Branch, number: usize, frequency: f64) -> Result<Point, Box<dyn Error>> {
    let mut all = vec![Complex64::ZERO; (branch.harmonics() + 1) * DOFS.len()];
    branch.harmonics_at(number, &mut all)?;
    let of = |p: usize| std::array::from_fn(|dof| all[p * DOFS.len() + dof]);
    let harmonics = branch.carried().iter().map(|&p| (p, of(p))).collect();
    Ok(Point { frequency, harmonics })
}
