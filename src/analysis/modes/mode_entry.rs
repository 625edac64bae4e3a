//! The first point of a further curve of a nonlinear mode: beside a branch point, or beyond a tongue of internal resonance.
//!
//! At a branch point with the direction t of the curve, the null vector φ of the Jacobian leads to the other one: the first point has
//! the place ε along φ − (φ·t)t, as in [`crate::analysis::forced::inside_start`].
//!
//! In an n:1 resonance the fundamental vanishes at the end of a tongue, and the motion has the n-th part of the period of another
//! mode. Small fundamentals are solutions of the linear equations about that motion, in any phase; those that remain differ by half
//! of that period. With the fundamental turned back to its phase, harmonic h changes its sign by the parity of h/n, rounded
//! (Kerschen et al. 2009, doi:10.1016/j.ymssp.2008.04.002, shows both curves, S33+ and S33−, that leave it).

use crate::analysis::forced::inside_start::{DISTANCES, Entered, Entry, dropped, null_vector};
use crate::analysis::forced::known_curve::lies_on;
use crate::analysis::modes::mode_discretised::ModeDiscretised;
use crate::condense::Condensed;
use crate::continuation::{Metric, Point, Settings};
use crate::error::{Result, fail, try_copy};
use crate::fourier::HarmonicSet;
use crate::harmonics::discretised::Discretised;
use crate::harmonics::transfer::transferred;
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::results::Branch;
use crate::tracing::inner_ends::Dropped;
use core::cell::Cell;
use num_complex::Complex64;

const CONTEXT: &str = "the start of a mode's further curve";

/// Unknowns that are no motions, and the same with the parameter.
/// Kind: fixed.
const OTHERS: usize = 2;
const OTHERS_AND_PARAMETER: usize = OTHERS + 1;

/// Share of the motion at a branch point in harmonics that the curve through it does not have.
/// Kind: tuned; measured on: not recorded.
const MODE_ENTRY_ABSENT: f64 = 1e-4;

/// The way to a further curve from a known point.
pub(crate) enum EntryWay<'k> {
    /// Beside a branch point of the curve with this tangent, in a sense of the null vector.
    BranchPoint { tangent: &'k [f64], sense: f64 },
    /// Through a vanishing fundamental, with other harmonics of which `order` is the lowest.
    OtherPhase { order: usize },
}

/// Entry of a further curve of a nonlinear mode, near a known point.
pub(crate) struct ModeEntry<'k> {
    /// The condensed model in whose harmonics the known point is given.
    pub from: &'k Condensed,
    /// Unknowns of the known point, followed by its parameter.
    pub v: &'k [f64],
    pub way: EntryWay<'k>,
    /// Curves on which the new point may lie already.
    pub known: &'k [&'k Branch],
    /// Outcome of the entry.
    pub outcome: Cell<Entry>,
}

impl ModeEntry<'_> {
    /// Finds the first point, oriented along the curve; and the harmonics that the curve has but the known curve that
    /// it leaves has not.
    ///
    /// # Errors
    /// `NoConvergence` where none is found, or it is known; those of the problem.
    pub fn enter(
        &self,
        mode: &mut ModeDiscretised<'_>,
        settings: &Settings,
        interrupt: &Interrupt<'_>,
    ) -> Result<Entered> {
        let to = mode.levels().at(mode.resolution())?.condensed.clone();
        let moved = |v: &[f64]| {
            transferred(
                self.from,
                &to,
                v,
                OTHERS_AND_PARAMETER,
                self.from.length() / to.length(),
            )
        };
        let start = moved(self.v)?;
        let entered = match self.way {
            EntryWay::BranchPoint { tangent, sense } => {
                let at = known_point(start, moved(tangent)?);
                beside(mode, &at, sense, to.set(), settings, interrupt)?
            }
            EntryWay::OtherPhase { order } => {
                let mut at = start;
                let motions = at.len() - OTHERS_AND_PARAMETER;
                turn(to.set(), &mut at[..motions], order);
                let tangent = try_copy(&at, CONTEXT)?;
                let point = mode.resolve(&known_point(at, tangent), true, interrupt)?;
                point.map(|point| Entered { point, dropped: None })
            }
        };
        let Some(entered) = entered else {
            return fail!(
                NoConvergence,
                "no point was found on the curve beside the nonlinear mode"
            );
        };
        for known in self.known {
            if lies_on(mode, known, &entered.point, 1, interrupt)? {
                self.outcome.set(Entry::Known);
                return fail!(NoConvergence, "the curve beside the nonlinear mode is known");
            }
        }
        self.outcome.set(Entry::Followed(entered.dropped));
        Ok(entered)
    }
}

fn known_point(v: Vec<f64>, tangent: Vec<f64>) -> Point {
    Point {
        v,
        tangent,
        amplitude: Complex64::ZERO,
        slope: Complex64::ZERO,
        residual: f64::INFINITY,
        iterations: 0,
        step: 0.0,
        stalled: false,
        positive: true,
    }
}

/// The point beside a branch point, along the null vector in the given sense.
fn beside(
    mode: &mut ModeDiscretised<'_>,
    at: &Point,
    sense: f64,
    set: &HarmonicSet,
    settings: &Settings,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Entered>> {
    let n = at.unknowns().len();
    let motions = n - OTHERS;
    let symmetric = dropped(set, &at.v[..motions], MODE_ENTRY_ABSENT);
    let mut at = at.try_clone()?;
    if let Some(dropped) = symmetric {
        // Beside the branch point rounding is magnified in the harmonics that branch off.
        without(set, &mut at.v[..motions], dropped);
        without(set, &mut at.tangent[..motions], dropped);
    }
    let seek = |first: &[f64]| mode.null_direction(&at, first, interrupt);
    let Some((mut null, dropped)) = null_vector(set, n, OTHERS, symmetric, seek)? else {
        return Ok(None);
    };
    let size = norm(&at.v[..motions]);
    let metric = Metric::along(norm(at.unknowns()), settings);
    let along = metric.dot(&null, &at.tangent) / metric.dot(&at.tangent, &at.tangent);
    for (x, t) in null.iter_mut().zip(&at.tangent) {
        *x = sense * (*x - along * t);
    }
    let length = norm(&null[..n]);
    let (low, high) = (settings.start.min(settings.end), settings.start.max(settings.end));
    for distance in DISTANCES {
        let mut near = at.try_clone()?;
        near.tangent.copy_from_slice(&null);
        for (v, t) in near.v.iter_mut().zip(&null) {
            *v += distance * size / length * t;
        }
        let Some(mut point) = mode.resolve(&near, false, interrupt)? else {
            continue;
        };
        if !(low..=high).contains(&point.parameter()) {
            continue;
        }
        if metric.dot(&point.tangent, &null) < 0.0 {
            point.reverse();
        }
        return Ok(Some(Entered { point, dropped }));
    }
    Ok(None)
}

/// Sets the `dropped` harmonics of a motion to zero.
fn without(set: &HarmonicSet, motion: &mut [f64], dropped: Dropped) {
    for y in motion.chunks_exact_mut(set.packed_len().max(1)) {
        for (i, _) in set.numbers().iter().enumerate().filter(|(_, h)| dropped.has(**h)) {
            set.set(y, i, Complex64::ZERO);
        }
    }
}

/// Turns the small fundamental of a motion to its other phase.
fn turn(set: &HarmonicSet, motion: &mut [f64], order: usize) {
    let m = set.packed_len().max(1);
    for y in motion.chunks_exact_mut(m) {
        for (i, h) in set.numbers().iter().enumerate() {
            if ((2 * h + order) / (2 * order)) % 2 == 1 {
                set.set(y, i, -set.get(y, i));
            }
        }
    }
}
