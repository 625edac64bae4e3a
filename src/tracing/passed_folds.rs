//! A curve that is closed, and goes round: it comes back to a fold that it has passed, in the same sense.
//!
//! A step may enter a closed curve beside the one that is followed, and so may a point that is solved with more harmonics. Without a
//! fold a curve over a range of the parameter cannot close, so that only folds are compared. A curve is one-dimensional: one that
//! passes a point twice in one sense repeats all that lies between, unless a step leaves it.

use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::{Point, PointAt, Settings};
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::harmonics::discretised::Traceable;
use crate::interrupt::Interrupt;
use crate::linalg::norm;

const CONTEXT: &str = "the folds of the branch";

/// Different folds that are kept, the last ones: a closed curve has two at least, and rarely more than six.
/// Kind: cap.
const FOLDS_KEPT: usize = 16;

/// Times that one fold is passed before the curve ends there. Where a closed curve nearly touches another, a step may leave it again, so
/// that the first round proves nothing.
/// Kind: tuned; measured on: light chains with stops, of `tests/robustness/passed_resonances.rs`.
const FOLDS_ROUNDS: usize = 8;

/// Distance of a fold to an arc, over its chord, up to which it may lie on the arc.
/// Kind: tuned; measured on: a chain of ten masses with a cubic spring.
const NEAR_ARC: f64 = 2.0;

/// Distance of two folds that are one, over the chord of the arc, and over the unknowns. At a fold the place along the curve is known to
/// the root of the accuracy of the parameter.
/// Kind: rounding.
const FOLDS_SAME: (f64, f64) = (1e-3, 1e-5);

/// The folds that the curve passed last.
#[derive(Default)]
pub(super) struct PassedFolds {
    kept: Vec<PassedFold>,
}

struct PassedFold {
    v: Vec<f64>,
    /// Chord of the arc that it lies on.
    along: Vec<f64>,
    /// Whether the parameter rises before it.
    rises: bool,
    resolution: usize,
    /// Times that it was passed.
    times: usize,
}

impl PassedFold {
    /// Whether a fold on an arc with this chord, whose parameter rises before it or does not, is the same one, passed in the same sense.
    fn is(&self, fold: &[f64], along: &[f64], rises: bool) -> bool {
        let same = (FOLDS_SAME.0 * norm(along)).min(FOLDS_SAME.1 * norm(fold));
        self.rises == rises && dot(&self.along, along) > 0.0 && distance(&self.v, fold) <= same
    }
}

impl PassedFolds {
    /// Keeps a fold on the arc from a to b, where all three have one resolution.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn note(&mut self, (fold, resolution): PointAt<'_>, a: PointAt<'_>, b: PointAt<'_>) -> Result<()> {
        if a.1 != resolution || b.1 != resolution {
            return Ok(());
        }
        let along = difference(&b.0.v, &a.0.v)?;
        let mut known = self.kept.iter_mut().filter(|passed| passed.resolution == resolution);
        if let Some(known) = known.find(|passed| passed.is(&fold.v, &along, rises(a.0))) {
            known.times += 1;
            return Ok(());
        }
        if self.kept.len() == FOLDS_KEPT {
            self.kept.remove(0);
        }
        let passed = PassedFold {
            v: try_copy(&fold.v, CONTEXT)?,
            along,
            rises: rises(a.0),
            resolution,
            times: 1,
        };
        try_push(&mut self.kept, passed, CONTEXT)
    }

    /// Whether the arc from a recorded point to the next one, both of the current resolution, passes a fold once more that was passed
    /// [`FOLDS_ROUNDS`] times; and whether the problem was evaluated elsewhere to decide that.
    ///
    /// # Errors
    /// Those of the problem; `StoppedByCaller`.
    // Out of line: its points do not lie on the stack under a step.
    #[inline(never)]
    pub fn repeat(
        &self,
        equations: &mut dyn Traceable,
        (a, from): PointAt<'_>,
        b: &Point,
        (settings, interrupt): (&Settings, &Interrupt<'_>),
    ) -> Result<(bool, bool)> {
        let resolution = equations.resolution();
        if from != resolution || self.kept.is_empty() || !SpecialPoint::Fold.between(a, b) {
            return Ok((false, false));
        }
        let along = difference(&b.v, &a.v)?;
        let chord = norm(&along);
        let is_near = |passed: &&PassedFold| {
            passed.times >= FOLDS_ROUNDS
                && passed.resolution == resolution
                && distance(&passed.v, &a.v).min(distance(&passed.v, &b.v)) <= NEAR_ARC * chord
        };
        if !self.kept.iter().any(|passed| is_near(&passed)) {
            return Ok((false, false));
        }
        let mut locator = Locator::new(a.unknowns().len(), *settings)?;
        let fold = match locator.locate(equations.problem(), SpecialPoint::Fold, a, b, interrupt) {
            Err(e) if e.recoverable => None,
            fold => fold?,
        };
        let Some(fold) = fold else {
            return Ok((false, true));
        };
        let mut near = self.kept.iter().filter(is_near);
        Ok((near.any(|passed| passed.is(&fold.v, &along, rises(a))), true))
    }
}

/// Whether the parameter rises at a point, in the sense of the curve.
fn rises(point: &Point) -> bool {
    point.tangent[point.tangent.len() - 1] > 0.0
}

fn difference(a: &[f64], b: &[f64]) -> Result<Vec<f64>> {
    let mut difference = try_vec(a.len(), 0.0, CONTEXT)?;
    for ((d, a), b) in difference.iter_mut().zip(a).zip(b) {
        *d = a - b;
    }
    Ok(difference)
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |d, (a, b)| d.hypot(a - b))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
