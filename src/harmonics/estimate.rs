//! Estimate of the distance between a solved point and the periodic motion to which harmonic balance converges: the
//! error that the omitted harmonics cause, found with the equations of more harmonics.
//!
//! A solution W with harmonics up to H is extended to the cut-off harmonic H₂ of the structure, at least to 2H + 1.
//! From Z = (W, 0) a damped Newton method solves the problem with harmonics up to H₂, and stops as soon as its next
//! step is small against the total change. With the last iterate Z, the simplified Newton step δ after it and Z* = Z
//! + δ
//!
//! > η_W = (‖Z* − W‖ + ‖δ‖)/‖Z*‖,  η_X = (|X(Z*) − X(W)| + |∂X/∂Z δ|)/|X(Z*)|
//!
//! with X the response observed. One step would do where the extended harmonics hardly act on each other, kt|G_h| < ½
//! for h > H. Where the structure resonates in high harmonics, they act on each other through the stick phases of the
//! contact: results for neighbouring H then agree with each other while all of them are wrong.
//!
//! The step is that of Deuflhard's natural monotonicity test (Newton Methods for Nonlinear Problems, 2004, §3.3),
//! which neither the scaling of the equations nor the reference stiffness changes.

use crate::condense::Condensed;
use crate::error::{Result, Status, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::options::{MAX_SAMPLES, SolverOptions};
use crate::problem::contact_forces::ContactForces;
use num_complex::Complex64;

pub(super) const CONTEXT: &str = "the error estimate";

/// Largest size of the next step relative to the change: 0.1 costs about one step more than 0.3.
/// Kind: tuned; measured on: not recorded.
pub(super) const ESTIMATE_SHARE: f64 = 0.1;

/// Largest ratio of an error to its estimate for which the selection of harmonics allows.
/// Kind: tuned; measured on: not recorded.
pub(crate) const ESTIMATE_MARGIN: f64 = 1.5;

/// Unknowns of an extended problem above which no estimate is made.
/// Kind: cap.
pub(super) const MOST_EXTENDED: usize = 30_000;

/// Share of the change up to which the tail, beyond the middle of the extended harmonics, counts as converged; then
/// harmonics above a limit that lies below the cut-off may be omitted.
/// Kind: tuned; measured on: not recorded.
pub(super) const CONVERGED_TAIL: f64 = 0.1;

/// Relative size of the forces in the extended harmonics below which they are round-off.
/// Kind: rounding.
pub(super) const ESTIMATE_ROUNDING: f64 = 1e-12;

/// Errors of a solved point that its omitted harmonics cause, and in sampled laws its samples.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Whether the estimate is reliable. If it is not certified, all errors are NaN: unknown.
    pub certified: bool,
    /// Whether the estimate is uncertified because the extended problem would be too large, so that more harmonics
    /// would not help.
    pub too_large: bool,
    /// Relative error of the relative motions at the contacts, in norm.
    pub motion: f64,
    /// Relative error of the complex fundamental of the response degree of freedom or, if responses were requested,
    /// of these: the largest error, or that of their norm.
    pub response: f64,
    /// Relative error of each requested response.
    pub responses: Vec<f64>,
    /// Relative error of the frequency of a nonlinear mode; 0 for a forced response.
    pub frequency: f64,
    /// Absolute error of the damping ratio of a nonlinear mode; 0 for a forced response.
    pub damping: f64,
    /// Highest harmonic of the extended problem.
    pub harmonics: usize,
    /// Number of Newton steps taken.
    pub steps: usize,
    /// Relative change ‖Z* − W‖/‖Z*‖ of the motion.
    pub change: f64,
    /// Carried harmonics above H with their share ‖Z*_h‖/‖Z*‖.
    pub tail: Vec<(usize, f64)>,
    /// The corrected solution Z* with more harmonics.
    pub corrected: Corrected,
}

impl Estimate {
    /// Sets the error of the response, and changes those of all responses in proportion.
    pub(super) fn scale_response(&mut self, response: f64) {
        let factor = response / self.response;
        for error in &mut self.responses {
            *error = if self.response > 0.0 { *error * factor } else { response };
        }
        self.response = response;
    }
}

/// A solution with the extended harmonics, one or two Newton steps closer to the exact one.
#[derive(Clone, Debug)]
pub struct Corrected {
    /// The set of carried harmonics.
    pub set: HarmonicSet,
    /// Packed relative motions, coordinate after coordinate, in the caller's unit of length.
    pub motion: Vec<f64>,
    /// Fundamental of the response degree of freedom, in the caller's unit of length.
    pub response: Complex64,
    /// The requested responses, in the caller's unit of length: complex amplitudes where they have such.
    pub watched: Vec<Complex64>,
    /// Angular frequency of the corrected solution.
    pub omega: f64,
    /// Damping ratio of a nonlinear mode.
    pub damping: f64,
    /// Per coordinate, whether its motion is exchanged, so that it is a rate and harmonic h counts 1/h; empty if none
    /// is.
    pub(crate) rates: Vec<bool>,
}

impl Corrected {
    /// Size of the motions at the contacts in the i-th carried harmonic.
    pub(crate) fn size(&self, i: usize) -> f64 {
        size_of_harmonic(&self.set, (&self.motion, &self.rates), i)
    }

    /// Drops the harmonics above the fundamental whose size is at most `rounding`.
    pub(super) fn drop_rounding(&mut self, rounding: f64) {
        for i in 0..self.set.numbers().len() {
            if self.set.numbers()[i] <= 1 || self.size(i) > rounding {
                continue;
            }
            for signal in self.motion.chunks_exact_mut(self.set.packed_len()) {
                self.set.set(signal, i, Complex64::ZERO);
            }
        }
    }
}

/// Size of the i-th harmonic of packed motions; motions that are rates are divided by the number of the harmonic.
pub(super) fn size_of_harmonic(set: &HarmonicSet, (motion, rates): (&[f64], &[bool]), i: usize) -> f64 {
    let of_rate = (set.numbers()[i] as f64).max(1.0).recip();
    let signals = motion.chunks_exact(set.packed_len()).enumerate();
    let of_one = |(c, y): (usize, &[f64])| {
        let weight = if rates.get(c) == Some(&true) { of_rate } else { 1.0 };
        weight * set.get(y, i).norm()
    };
    signals.map(of_one).fold(0.0, f64::hypot)
}

/// A solved point, as the estimators need it.
#[derive(Clone, Copy)]
pub struct Solved<'a> {
    /// The model as it was condensed for the point.
    pub condensed: &'a Condensed,
    /// Packed relative motions, in the solver's unit of length.
    pub motion: &'a [f64],
    /// Angular frequency of the point.
    pub omega: f64,
    /// Fundamental of the response degree of freedom, in the caller's unit of length.
    pub response: Complex64,
    /// The requested responses, in the caller's unit of length.
    pub watched: &'a [Complex64],
    /// Whether the error of the responses is that of one norm of them all.
    pub together: bool,
    /// Whether all contacts stick, if that is known.
    pub sticks: Option<bool>,
    /// Newton iterations that a solution without a neighbour takes, which bound the work of an estimate.
    pub iterations: usize,
}

impl Solved<'_> {
    /// Whether every law is linear at this point, so that no harmonic is missing.
    pub(super) fn is_linear(&self, interrupt: &Interrupt<'_>) -> Result<bool> {
        if self.condensed.coordinates() == 0 {
            return Ok(true);
        }
        if let Some(sticks) = self.sticks {
            return Ok(sticks);
        }
        // The result for a contact that sticks does not depend on the samples.
        let mut forces = ContactForces::unchecked(self.condensed, 0, interrupt)?;
        match forces.evaluate(self.motion, self.omega) {
            Err(e) if e.recoverable => Ok(false),
            Err(e) => Err(e),
            Ok(()) => Ok(forces.all_stuck()),
        }
    }

    /// The estimate of a solution that omits no harmonic.
    pub(super) fn exact(&self, damping: f64) -> Result<Estimate> {
        let length = self.condensed.length();
        let mut motion = try_vec(self.motion.len(), 0.0, CONTEXT)?;
        for (to, from) in motion.iter_mut().zip(self.motion) {
            *to = from * length;
        }
        Ok(Estimate {
            certified: true,
            too_large: false,
            motion: 0.0,
            response: 0.0,
            responses: try_vec(self.watched.len(), 0.0, CONTEXT)?,
            frequency: 0.0,
            damping: 0.0,
            harmonics: self.condensed.set().numbers().last().copied().unwrap_or(0),
            steps: 0,
            change: 0.0,
            tail: Vec::new(),
            corrected: Corrected {
                set: self.condensed.set().try_clone()?,
                motion,
                response: self.response,
                watched: try_copy(self.watched, CONTEXT)?,
                omega: self.omega,
                damping,
                rates: self.condensed.rates()?,
            },
        })
    }

    /// The estimate of a point whose error is unknown.
    pub(super) fn unknown(&self, damping: f64, too_large: bool) -> Result<Estimate> {
        Ok(Estimate {
            certified: false,
            too_large,
            motion: f64::NAN,
            response: f64::NAN,
            responses: try_vec(self.watched.len(), f64::NAN, CONTEXT)?,
            frequency: f64::NAN,
            damping: f64::NAN,
            change: f64::NAN,
            ..self.exact(damping)?
        })
    }

    /// Packed motions times `factor` in the harmonics of an extended model; zero above the harmonics of the point.
    pub(super) fn extended(&self, to: &Condensed, unknowns: usize, factor: f64) -> Result<Vec<f64>> {
        let factor = factor * self.condensed.length() / to.length();
        let mut extended = try_vec(unknowns, 0.0, CONTEXT)?;
        let motions = to.coordinates() * to.set().packed_len();
        to.set()
            .transfer(self.condensed.set(), self.motion, factor, &mut extended[..motions]);
        Ok(extended)
    }
}

/// The norm of several responses.
pub(super) fn norm_of_responses(responses: &[Complex64]) -> f64 {
    responses.iter().map(|x| x.norm()).fold(0.0, f64::hypot)
}

/// A difference relative to a number; 0 if the difference is 0.
pub(super) fn relative(difference: f64, number: Complex64) -> f64 {
    if difference == 0.0 {
        0.0
    } else {
        difference / number.norm()
    }
}

/// Sizes of the harmonics above those of `below`, each relative to the norm of all, with their numbers.
pub(super) fn tail(
    set: &HarmonicSet,
    below: &HarmonicSet,
    (motion, rates): (&[f64], &[bool]),
) -> Result<Vec<(usize, f64)>> {
    let each = |i| size_of_harmonic(set, (motion, rates), i);
    let size = if rates.is_empty() {
        norm(motion)
    } else {
        (0..set.numbers().len()).map(each).fold(0.0, f64::hypot)
    };
    let highest = below.numbers().last().copied().unwrap_or(0);
    let mut found = Vec::new();
    for (i, &h) in set.numbers().iter().enumerate().filter(|&(_, &h)| h > highest) {
        try_push(&mut found, (h, each(i) / size), CONTEXT)?;
    }
    Ok(found)
}

/// Whether a solution has a converged tail: the part beyond the middle of the tail is small against the change.
pub(super) fn has_converged_tail(tail: &[(usize, f64)], change: f64) -> bool {
    let beyond = tail[tail.len() / 2..].iter().fold(0.0, |s, &(_, x)| f64::hypot(s, x));
    beyond <= CONVERGED_TAIL * change
}

/// Whether a solution with the harmonics of `below` and at most this relative residual also solves the extended
/// problem: no force above `rounding` acts in the further harmonics, and in the others more samples change nothing.
pub(super) fn omits_nothing(
    (residual, scale, rounding): (&[f64], f64, f64),
    set: &HarmonicSet,
    below: &HarmonicSet,
    tolerance: f64,
) -> bool {
    above(set, below, residual) <= rounding.max(ESTIMATE_ROUNDING * scale)
        && norm(residual) <= rounding.max(10.0 * tolerance * scale)
}

/// Norm of the part of packed signals of `set` above the harmonics of `below`.
fn above(set: &HarmonicSet, below: &HarmonicSet, packed: &[f64]) -> f64 {
    let highest = below.numbers().last().copied().unwrap_or(0);
    let first = set.numbers().partition_point(|&h| h <= highest);
    let from = if first < set.numbers().len() {
        set.offset(first)
    } else {
        set.packed_len()
    };
    let signals = packed.chunks_exact(set.packed_len());
    signals.map(|y| norm(&y[from..])).fold(0.0, f64::hypot)
}

/// Error of the structure on a basis that an estimate of an error may have.
/// Kind: tuned; measured on: not recorded.
const CERTIFICATE: f64 = 1e-3;

/// Options of the extended problem. Samples grow faster than the harmonics, so that the estimate includes the
/// sampling error of the point.
pub(super) fn extended_options(options: &SolverOptions, highest: usize) -> SolverOptions {
    let samples = match options.samples {
        0 => 0,
        n => n.saturating_mul(4).max(8 * highest).min(MAX_SAMPLES),
    };
    SolverOptions {
        harmonics: highest,
        samples,
        certificate: options.certificate.max(CERTIFICATE),
        ..*options
    }
}

/// Turns an estimate that could not be made into an unknown one, also where its counted size exceeds the limit of the
/// caller. Memory that is short at the moment must not change results: that stays an error, as does a callback that
/// gives up.
pub(super) fn or_unknown(found: Result<Option<Estimate>>, solved: &Solved<'_>, damping: f64) -> Result<Estimate> {
    match found {
        Ok(Some(estimate)) => Ok(estimate),
        Ok(None) => solved.unknown(damping, false),
        Err(e) if e.recoverable || e.beyond_limit || e.status == Status::Singular => {
            solved.unknown(damping, e.beyond_limit)
        }
        Err(e) => Err(e),
    }
}
