//! One extension of a point of a forced response: the extended problem is solved, and its solution tells the error.

use crate::condense::Condensed;
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::estimate::{
    CONTEXT, ESTIMATE_ROUNDING, ESTIMATE_SHARE, has_converged_tail, norm_of_responses, omits_nothing, relative, tail,
};
use crate::harmonics::extended_newton::{ExtendedSolution, FirstStep, extend};
use crate::harmonics::extended_system::ExtendedSystem;
use crate::harmonics::jump_error::beyond_extension;
use crate::harmonics::kept_changes::{Extension, KeptChanges};
use crate::harmonics::{Corrected, Estimate, Solved};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;
use crate::problem::harmonic_balance::HarmonicBalance;
use core::cell::Cell;
use num_complex::Complex64;

/// Share of the residual that a guess from another point may leave.
/// Kind: tuned; measured on: not recorded.
const CLOSER: f64 = 0.5;

/// Size of the next step, relative to the motion or the response and over the tolerance of the run, that does not matter: where a
/// contact grazes, steps beside a small change may not fall to a tenth of it.
/// Kind: tuned; measured on: wheels of 24 sectors with stops.
const NEGLIGIBLE_STEP: f64 = 0.01;

/// Steps of one of several extensions before that holds for a single response.
/// Kind: tuned; measured on: a finite-element sector with 60 contacts.
const STEPS_BEFORE: usize = 6;

/// The harmonics to which a point is extended.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    /// Highest harmonic of the core, in which the structure is compliant.
    pub core: usize,
    /// Highest harmonic of the extended problem.
    pub highest: usize,
    /// Lowest harmonic up to which a point must be extended.
    pub least: usize,
    /// Whether a short first step is accepted, as where the structure is compliant in none of the harmonics that the
    /// point omits.
    pub first_step: FirstStep,
    /// Whether the structure may be compliant beyond the core, where the problem would be too large.
    pub short: bool,
    /// Whether this is one of several extensions, each of which ends once the response has converged.
    pub by_doubling: bool,
}

/// Extends a point, or a solution of it with fewer harmonics, with the system of a slot of the cache; `None` where an
/// evaluation or a matrix fails, or the work does not suffice.
pub(super) fn extend_once(
    system: &mut ExtendedSystem<HarmonicBalance<'_>>,
    condensed: &Condensed,
    (solved, from): (&Solved<'_>, Option<&Corrected>),
    (extent, slot): (Extent, usize),
    (changes, [tol_residual, tolerance]): (&mut KeptChanges, [f64; 2]),
    interrupt: &Interrupt<'_>,
) -> Result<Option<Estimate>> {
    let (omega, set) = (solved.omega, condensed.set());
    if set.numbers().len() == solved.condensed.set().numbers().len() {
        // Constant forces act alone: nothing vibrates.
        return solved.exact(0.0).map(Some);
    }
    let n = system.problem.unknowns();
    let point = solved.extended(condensed, n, 1.0)?;
    let mut before = try_copy(&point, CONTEXT)?;
    if let Some(from) = from {
        set.transfer(&from.set, &from.motion, 1.0 / condensed.length(), &mut before);
    }
    if !system.evaluate(&before)? {
        return Ok(None);
    }
    let residual = (&system.at.values[..], system.at.scale, 0.0);
    if omits_nothing(residual, set, solved.condensed.set(), tol_residual) {
        return solved.exact(0.0).map(Some);
    }
    system.measure_by_point(from.is_some());
    let length = condensed.length();
    let tests = Cell::new(0);
    let harmless = ESTIMATE_ROUNDING.max(NEGLIGIBLE_STEP * tolerance);
    let enough = |problem: &HarmonicBalance<'_>, at: &[f64], change: &[f64], next: &[f64]| {
        tests.set(tests.get() + 1);
        if !extent.by_doubling || !solved.watched.is_empty() {
            let next = norm(&next[..n]);
            return next <= ESTIMATE_SHARE * norm(change) || next <= harmless * norm(&before);
        }
        // The next extension begins from this one, and its change tells of more harmonics, not of a step that was left out.
        let least = if tests.get() > STEPS_BEFORE {
            harmless
        } else {
            ESTIMATE_ROUNDING
        };
        let (x, dx) = problem.observe(at, next);
        dx.norm() <= ESTIMATE_SHARE * (x + dx - solved.response / length).norm() || dx.norm() <= least * x.norm()
    };
    let extension = extension_of(from.map_or(solved.condensed.set(), |from| &from.set), slot);
    // Elsewhere a step costs less than the evaluation of a guess.
    let guess = system.iterates_long().then(|| changes.guess(extension, set, &before));
    let guess = guess.transpose()?.flatten();
    let starts = (&before[..], guess.as_deref());
    let Some(extended) = extended_from(system, starts, enough, extent.first_step, interrupt)? else {
        return Ok(None);
    };
    let mut z = extended.corrected()?;
    if extended.certified && system.iterates_long() {
        changes.keep(extension, set, (&before, &z))?;
    }
    let size = norm(&z);
    let mut change = try_vec(n, 0.0, CONTEXT)?;
    for ((c, z), s) in change.iter_mut().zip(&z).zip(&point) {
        *c = z - s;
    }
    let change = norm(&change) / size;
    let (x, dx) = system.problem.observe(&extended.at, &extended.next);
    let (response, next) = ((x + dx) * length, extended.missing * dx.norm() * length);
    let rates = condensed.rates()?;
    let tail = tail(set, solved.condensed.set(), (&z, &rates))?;
    let Some((beyond, late)) = beyond_extension(system, condensed, (&extended.at, omega), interrupt)? else {
        return Ok(None);
    };
    let certified = extended.certified && (!extent.short || has_converged_tail(&tail, change));
    let known = |x: f64| if certified { x } else { f64::NAN };
    for z in &mut z {
        *z *= length;
    }
    // The lateness of near-rigid sliders is known of the response that every point has.
    let besides = (beyond, relative(late * length, response));
    let mut watched = watched(system, solved, (&extended, length), besides)?;
    for error in &mut watched.errors {
        *error = known(*error);
    }
    let of_response = relative(
        beyond * (response - solved.response).norm() + next + late * length,
        response,
    );
    Ok(Some(Estimate {
        certified,
        too_large: !certified && extent.short,
        motion: known(beyond * change + extended.missing * norm(&extended.next[..n]) / size),
        response: known(if watched.errors.is_empty() {
            of_response
        } else {
            watched.error
        }),
        responses: watched.errors,
        frequency: known(0.0),
        damping: known(0.0),
        harmonics: set.numbers().last().copied().unwrap_or(0),
        steps: extended.steps,
        change,
        tail,
        corrected: Corrected {
            set: set.try_clone()?,
            motion: z,
            response,
            watched: watched.values,
            omega,
            damping: 0.0,
            rates,
        },
    }))
}

/// The extension from the harmonics of a set to those of a slot.
fn extension_of(below: &HarmonicSet, slot: usize) -> Extension {
    Extension {
        highest: below.numbers().last().copied().unwrap_or(0),
        slot,
    }
}

/// The solution of the extended problem from a guess, where that is closer, or else from the point; `None` where it is not found.
fn extended_from<'p>(
    system: &mut ExtendedSystem<HarmonicBalance<'p>>,
    (before, guess): (&[f64], Option<&[f64]>),
    enough: impl Fn(&HarmonicBalance<'p>, &[f64], &[f64], &[f64]) -> bool,
    first_step: FirstStep,
    interrupt: &Interrupt<'_>,
) -> Result<Option<ExtendedSolution>> {
    if let Some(guess) = guess {
        let residual = system.residual();
        if system.evaluate(guess)? && system.residual() <= CLOSER * residual {
            let found = extend(system, (guess, before), &enough, first_step, interrupt)?;
            if let Some(found) = found.filter(|found| found.certified) {
                return Ok(Some(found));
            }
        }
        if !system.evaluate(before)? {
            return Ok(None);
        }
    }
    extend(system, (before, before), &enough, first_step, interrupt)
}

/// The requested responses with more harmonics, and their errors.
struct Watched {
    values: Vec<Complex64>,
    /// Relative error of each response of the point, with the part that may still be missing.
    errors: Vec<f64>,
    /// Largest relative error, or that of the norm of all responses.
    error: f64,
}

/// Reads the responses at the corrected solution Z + δ, in the unit `length`. Their errors are a multiple of their
/// changes, plus a given term.
fn watched(
    system: &mut ExtendedSystem<HarmonicBalance<'_>>,
    solved: &Solved<'_>,
    (extended, length): (&ExtendedSolution, f64),
    (beyond, besides): (f64, f64),
) -> Result<Watched> {
    let mut found = Watched {
        values: Vec::new(),
        errors: Vec::new(),
        error: 0.0,
    };
    if solved.watched.is_empty() {
        return Ok(found);
    }
    let mut v = try_copy(&extended.at, CONTEXT)?;
    try_push(&mut v, solved.omega, CONTEXT)?;
    let mut seen = Vec::new();
    system.problem.see_all(&v, &extended.next, &mut seen)?;
    let mut whole = 0.0_f64;
    for (seen, before) in seen.iter().zip(solved.watched) {
        let (value, change) = seen.observed();
        let corrected = (value + change) * length;
        let missing = extended.missing * change.norm() * length;
        let change = (corrected - before).norm() + missing;
        whole = whole.hypot(beyond * change);
        try_push(&mut found.values, corrected, CONTEXT)?;
        try_push(
            &mut found.errors,
            relative(beyond * change, corrected) + besides,
            CONTEXT,
        )?;
    }
    found.error = if solved.together {
        relative(whole, norm_of_responses(&found.values).into()) + besides
    } else {
        found.errors.iter().copied().fold(0.0, f64::max)
    };
    Ok(found)
}
