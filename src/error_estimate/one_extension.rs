//! One extension of a point of a forced response: the extended problem is solved, and its solution tells the error.

use crate::condense::Condensed;
use crate::error::{Result, try_copy, try_vec};
use crate::error_estimate::estimate::{CONTEXT, ROUNDING, SHARE, has_converged_tail, omits_nothing, relative, tail};
use crate::error_estimate::extended_newton::{FirstStep, extend};
use crate::error_estimate::extended_system::ExtendedSystem;
use crate::error_estimate::jump_error::beyond_extension;
use crate::error_estimate::kept_changes::{Extension, KeptChanges};
use crate::error_estimate::{Corrected, Estimate, Solved};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;
use crate::problem::harmonic_balance::HarmonicBalance;

/// Share of the residual that a guess from another point may leave.
const CLOSER: f64 = 0.5;

/// The harmonics to which a point is extended.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    /// Highest harmonic of the core, in which the structure is compliant.
    pub core: usize,
    /// Highest harmonic of all.
    pub highest: usize,
    /// The least one to which a point may be extended.
    pub least: usize,
    /// Whether a short first step suffices, as where the structure is compliant in none of the harmonics that the point omits.
    pub first_step: FirstStep,
    /// Whether the structure may be compliant beyond the core, where the problem would be too large.
    pub short: bool,
    /// Whether this is one of several extensions, each of which ends as soon as the response has converged.
    pub by_doubling: bool,
}

/// Extends a point, or a solution of it with fewer harmonics, with a system of a slot of the cache; `None` where some evaluation or
/// matrix fails, or the work does not suffice.
pub(super) fn extend_once(
    system: &mut ExtendedSystem<HarmonicBalance<'_>>,
    condensed: &Condensed,
    (solved, from): (&Solved<'_>, Option<&Corrected>),
    (extent, slot): (Extent, usize),
    (changes, tolerance): (&mut KeptChanges, f64),
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
    let residual = (&system.at.values[..], system.at.scale);
    if omits_nothing(residual, set, solved.condensed.set(), tolerance) {
        return solved.exact(0.0).map(Some);
    }
    system.measure_by_point(from.is_some());
    let length = condensed.length();
    let enough = |problem: &HarmonicBalance<'_>, at: &[f64], change: &[f64], next: &[f64]| {
        if !extent.by_doubling {
            let next = norm(&next[..n]);
            return next <= SHARE * norm(change) || next <= ROUNDING * norm(&before);
        }
        let (x, dx) = problem.observe(at, next);
        dx.norm() <= SHARE * (x + dx - solved.response / length).norm() || dx.norm() <= ROUNDING * x.norm()
    };
    let below = from.map_or(solved.condensed.set(), |from| &from.set);
    let extension = Extension {
        highest: below.numbers().last().copied().unwrap_or(0),
        slot,
    };
    // Elsewhere a step costs less than the evaluation of a guess.
    let guess = if system.iterates_long() {
        changes.guess(extension, set, &before)?
    } else {
        None
    };
    let mut extended = None;
    if let Some(guess) = guess {
        let residual = system.residual();
        if system.evaluate(&guess)? && system.residual() <= CLOSER * residual {
            let found = extend(system, (&guess, &before), enough, extent.first_step, interrupt)?;
            extended = found.filter(|found| found.certified);
        }
        if extended.is_none() && !system.evaluate(&before)? {
            return Ok(None);
        }
    }
    if extended.is_none() {
        extended = extend(system, (&before, &before), enough, extent.first_step, interrupt)?;
    }
    let Some(extended) = extended else {
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
    Ok(Some(Estimate {
        certified,
        too_large: !certified && extent.short,
        motion: known(beyond * change + extended.missing * norm(&extended.next[..n]) / size),
        response: known(relative(
            beyond * (response - solved.response).norm() + next + late * length,
            response,
        )),
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
            omega,
            damping: 0.0,
            rates,
        },
    }))
}
