//! Selection of harmonics by a tolerance: more where the error of a point misses it, fewer where they carry little.
//!
//! A solution W whose error η is too large is resolved from its corrected solution Z*, see [`crate::harmonics`],
//! with the lowest harmonics H′ beyond which Z* has converged:
//!
//! > 3/2 A t(H′) ≤ ½ tolerance,  t(h) = ‖Z*_{>h}‖/‖Z*‖,  A = η/t(H)
//!
//! and the branch continues with H′. The factor 3/2 allows for the error of the estimate. Harmonics are dropped only
//! where the error is far below the tolerance, so that they do not alternate. Where a harmonic costs many factorisations,
//! the bound is 0.7 of the tolerance, and harmonics are dropped as soon as fewer meet it: the point is solved with them, and
//! the change of its response, added to its error, shows whether they do.

use crate::continuation::{Point, PointAt};
use crate::error::Result;
use crate::harmonics::decision::{Action, Choices, MOST_REFINEMENTS, Occasion, Signs, decide};
use crate::harmonics::discretised::{Assessment, Discretised};
use crate::harmonics::estimate_spacing::{EstimateSpacing, Trend};
use crate::harmonics::harmonic_history::HarmonicHistory;
use crate::harmonics::{ESTIMATE_MARGIN, Estimate};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::results::SpecialKind;

/// Target of the error as a share of the tolerance, where harmonics cost little and where they cost much.
/// Kind: tuned; measured on: not recorded.
const AIM: (f64, f64) = (0.5, 0.7);

/// Relative size of a harmonic that is round-off.
/// Kind: rounding.
const CONTROLLER_ROUND_OFF: f64 = 1e-13;

/// Levels by which a point is refined if the next one was not found from it.
/// Kind: tuned; measured on: not recorded.
const BACKTRACK: usize = 3;

/// A point with the harmonics that its error requires, in the current resolution.
pub(crate) struct Refined {
    pub point: Point,
    /// Whether the point misses the tolerance and no solution was found with more harmonics, although more are
    /// available.
    pub stuck: bool,
    /// Whether its error is known.
    pub known: bool,
}

/// Selects the harmonics of each point of a branch: collects the signs, asks [`decide`], and carries out the answer.
pub(crate) struct AdaptivityController {
    tolerance: f64,
    /// Number of estimates so far, cheap checks that all contacts stick not counted.
    estimates: usize,
    /// Error of the last point that met the tolerance, and the harmonics that it requires.
    last: Option<(f64, usize)>,
    history: HarmonicHistory,
    spacing: EstimateSpacing,
}

impl AdaptivityController {
    /// A controller for a tolerance.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            estimates: 0,
            last: None,
            history: HarmonicHistory::new(),
            spacing: EstimateSpacing::default(),
        }
    }

    /// Number of estimates made so far.
    pub fn estimates(&self) -> usize {
        self.estimates
    }

    /// Notes a special point of the branch.
    pub fn note_special(&mut self, kind: SpecialKind) {
        if kind.is_fold() {
            self.history.note_fold();
        }
    }

    /// Signs of a point with an error (NaN where unknown) that requires the harmonics up to `required`.
    fn signs(&self, equations: &dyn Discretised, occasion: Occasion, (error, required): (f64, usize)) -> Signs {
        let (levels, level) = (equations.levels(), equations.resolution());
        let half = levels.level_of_half(self.history.highest());
        Signs {
            occasion,
            share: ESTIMATE_MARGIN * error / self.tolerance,
            choices: Choices {
                level,
                required: levels.level_with(required),
                doubled: levels.level_of_double(level),
                few: levels.few(),
                lowest: half.max(levels.few()).max(self.history.floor()),
                last: levels.last(),
            },
            waits: self.history.waits(),
            low: self.history.low(),
            costly: levels.are_costly(),
            too_large: false,
        }
    }

    /// The action to take after an estimate.
    fn decide_by(
        &self,
        equations: &dyn Discretised,
        occasion: Occasion,
        found: &Assessment,
        required: usize,
    ) -> Action {
        let signs = Signs {
            too_large: found.estimate.too_large,
            ..self.signs(equations, occasion, (found.error, required))
        };
        decide(&signs, self.history.state())
    }

    fn accepts(&self, error: f64) -> bool {
        ESTIMATE_MARGIN * error <= self.tolerance
    }

    /// Adds an estimate to the count, unless it was a cheap check.
    fn count(&mut self, found: &Assessment) {
        self.estimates += usize::from(!found.estimate.certified || found.estimate.steps > 0);
    }

    /// The first point of a curve where something is nonlinear, with at least the fewest harmonics that such a curve
    /// carries: with fewer, an error estimate would tell nothing.
    pub fn begin_curve(
        &mut self,
        equations: &mut dyn Discretised,
        point: Point,
        interrupt: &Interrupt<'_>,
    ) -> Result<Point> {
        if !equations.levels().is_automatic() {
            return Ok(point);
        }
        let level = equations.resolution();
        let signs = self.signs(equations, Occasion::Begins, (f64::NAN, 0));
        let Action::Raise(few) = decide(&signs, self.history.state()) else {
            return Ok(point);
        };
        let Some(better) = resolve_at(equations, (&point, level), few, true, interrupt)? else {
            return Ok(point);
        };
        self.history.note_justified();
        Ok(better)
    }

    /// The point with the harmonics that its error requires. If it misses the tolerance after the last refinement, it
    /// is returned as it is.
    pub fn refine(
        &mut self,
        equations: &mut dyn Discretised,
        mut point: Point,
        keep_parameter: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<Refined> {
        let done = |point| {
            Ok(Refined {
                point,
                stuck: false,
                known: true,
            })
        };
        if !equations.levels().is_automatic() {
            return done(point);
        }
        let mut trend = Trend::of(&point, equations.share_of_highest(&point));
        let predicted = self.is_predicted(equations, &point, trend)?;
        if decide(&Signs::solved(predicted), self.history.state()) == Action::Keep {
            return done(point);
        }
        // The point before the last refinement, where its error was unknown and the refinement changed nothing.
        let mut unchanged: Option<(Point, usize)> = None;
        let mut missed = false; // with fewer harmonics
        for refinements in 0..=MOST_REFINEMENTS {
            let level = equations.resolution();
            let Some(found) = self.estimate(equations, &point, trend)? else {
                return done(point);
            };
            let accepted = self.accepts(found.error);
            let required = self.required_harmonics(equations, &found);
            self.last = accepted.then_some((found.error, required));
            if !accepted {
                self.history.note_miss(found.error.is_nan(), level);
                missed = true;
            }
            let occasion = Occasion::Estimated {
                missed,
                unchanged_from: unchanged.as_ref().map(|(_, before)| *before),
                refinements,
            };
            let action = self.decide_by(equations, occasion, &found, required);
            if accepted && found.error > 0.0 {
                self.history.note_justified();
            }
            let better = match action {
                Action::Keep | Action::Estimate => None,
                Action::Drop(before) if !accepted => {
                    // More harmonics would tell no more, and each later point would pay for them.
                    equations.select(before)?;
                    self.history.note_settled(before);
                    let fewer = unchanged.map_or(point, |(fewer, _)| fewer);
                    self.estimate_again(equations, &fewer)?;
                    return done(fewer);
                }
                Action::Drop(next) => resolve_at(equations, (&point, level), next, keep_parameter, interrupt)?,
                Action::Raise(next) => refine_to(equations, &point, &found.estimate, next, keep_parameter, interrupt)?,
            };
            let Some(better) = better else {
                let met = found.error.is_nan() && self.estimate_again(equations, &point)?;
                return Ok(Refined {
                    point,
                    stuck: !met && matches!(action, Action::Raise(_)),
                    known: met || !found.error.is_nan(),
                });
            };
            let before = equations.transfer(&point, level)?;
            let same = found.error.is_nan() && self.is_same(&before, &better);
            if same {
                equations.share_work();
            }
            let left = core::mem::replace(&mut point, better);
            unchanged = same.then_some((left, level));
            trend = Trend::of(&point, equations.share_of_highest(&point));
        }
        done(point)
    }

    /// Estimates the error of a point, and notes it for the spacing of the estimates.
    fn estimate(&mut self, equations: &mut dyn Discretised, point: &Point, trend: Trend) -> Result<Option<Assessment>> {
        let found = equations.estimate(point)?;
        if let Some(found) = &found {
            self.count(found);
            let may_fall = equations.resolution() > equations.levels().few();
            let error = (found.error, self.tolerance / ESTIMATE_MARGIN);
            self.spacing.note(equations.resolution(), trend, error, may_fall);
            self.history
                .note_estimate(ESTIMATE_MARGIN * found.error / self.tolerance);
        }
        Ok(found)
    }

    /// Estimates once more the error of a point that is kept although the first estimate left it unknown; whether it meets the tolerance.
    #[inline(never)]
    fn estimate_again(&mut self, equations: &mut dyn Discretised, point: &Point) -> Result<bool> {
        let Some(found) = equations.estimate_again(point)? else {
            return Ok(false);
        };
        self.count(&found);
        let required = self.required_harmonics(equations, &found);
        let accepted = self.accepts(found.error);
        self.last = accepted.then_some((found.error, required));
        Ok(accepted)
    }

    /// Whether the error of a point is predicted by that of an earlier one; it is then taken over.
    fn is_predicted(&mut self, equations: &mut dyn Discretised, point: &Point, trend: Trend) -> Result<bool> {
        self.spacing.note_step(point.step);
        let largest = self.tolerance / ESTIMATE_MARGIN;
        let Some(factor) = self.spacing.factor(equations.resolution(), trend, largest) else {
            return Ok(false);
        };
        if !equations.take_over_estimate(point, factor)? {
            self.spacing.forget();
            return Ok(false);
        }
        if let Some((error, _)) = &mut self.last {
            *error *= factor;
        }
        Ok(true)
    }

    /// Whether two solutions have one response within the tolerance.
    fn is_same(&self, before: &Point, after: &Point) -> bool {
        let change = (after.amplitude - before.amplitude).norm();
        ESTIMATE_MARGIN * change <= self.tolerance * after.amplitude.norm()
    }

    /// The last point, from which no next one was found, solved with more harmonics; `None` if that fails too.
    pub fn backtrack(
        equations: &mut dyn Discretised,
        (point, level): PointAt<'_>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let to = (level.max(equations.resolution()) + BACKTRACK).min(equations.levels().last());
        resolve_at(equations, (point, level), to, true, interrupt)
    }

    /// Whether a point beside the curve meets the tolerance; if not, the resolution has been raised, and the point is
    /// to be located again. A fold always does: at its parameter no solution is isolated, and its error is undefined.
    pub fn meets_tolerance(
        &mut self,
        equations: &mut dyn Discretised,
        kind: SpecialKind,
        point: &Point,
    ) -> Result<bool> {
        if !equations.levels().is_automatic() || kind.is_fold() {
            return Ok(true);
        }
        let Some(found) = equations.estimate(point)? else {
            return Ok(true);
        };
        self.count(&found);
        if self.accepts(found.error) {
            return Ok(true);
        }
        let required = self.required_harmonics(equations, &found);
        let Action::Raise(next) = self.decide_by(equations, Occasion::Beside, &found, required) else {
            if found.error.is_nan()
                && let Some(found) = equations.estimate_again(point)?
            {
                self.count(&found);
            }
            return Ok(true);
        };
        equations.select(next)?;
        Ok(false)
    }

    /// The point recorded last, with the harmonics with which the branch continues: solved again if they change.
    pub fn adjust(
        &mut self,
        equations: &mut dyn Discretised,
        point: Point,
        interrupt: &Interrupt<'_>,
    ) -> Result<Point> {
        let level = equations.resolution();
        let Some((error, required)) = self.last else {
            return Ok(point);
        };
        self.history.note_recorded(level);
        let signs = self.signs(equations, Occasion::Recorded, (error, required));
        let (next, on_trial) = match decide(&signs, self.history.state()) {
            Action::Keep | Action::Estimate => return Ok(point),
            Action::Raise(next) => (next, false),
            Action::Drop(next) => (next, signs.is_on_trial()),
        };
        // The parameter is kept, so that nothing lies between the recorded point and the one from which the branch
        // continues.
        let largest = if on_trial {
            AIM.1 * self.tolerance / ESTIMATE_MARGIN - error
        } else {
            self.tolerance
        };
        let found = match resolve_at(equations, (&point, level), next, true, interrupt)? {
            Some(found) => {
                let before = equations.transfer(&point, level)?;
                let change = (found.amplitude - before.amplitude).norm();
                (change <= largest * before.amplitude.norm()).then_some(found)
            }
            None => None,
        };
        if found.is_none() {
            // With fewer harmonics the error is larger than its estimate, as near a fold.
            equations.select(level)?;
            if on_trial {
                self.history.note_failed_trial(level);
            }
        }
        Ok(found.unwrap_or(point))
    }

    /// Highest harmonic that the solution requires; 0 if the error is unknown.
    fn required_harmonics(&self, equations: &dyn Discretised, found: &Assessment) -> usize {
        if !found.estimate.certified {
            return 0;
        }
        let left_out = found
            .estimate
            .tail
            .iter()
            .fold(0.0, |s, &(_, share)| f64::hypot(s, share));
        let aim = if equations.levels().are_costly() { AIM.1 } else { AIM.0 };
        // If the estimated error is zero, keep every harmonic above round-off.
        let bound = if found.error > 0.0 && left_out > 0.0 {
            aim * self.tolerance * left_out / (ESTIMATE_MARGIN * found.error)
        } else {
            CONTROLLER_ROUND_OFF
        };
        let corrected = &found.estimate.corrected;
        let set = &corrected.set;
        let all = if corrected.rates.is_empty() {
            norm(&corrected.motion)
        } else {
            (0..set.numbers().len())
                .map(|i| corrected.size(i))
                .fold(0.0, f64::hypot)
        };
        let mut tail = 0.0_f64;
        for (i, &number) in set.numbers().iter().enumerate().rev() {
            tail = tail.hypot(corrected.size(i));
            if tail > bound * all {
                return number;
            }
        }
        0
    }
}

/// Solves near a point with the harmonics of another level; if that fails, the resolution is unchanged.
fn resolve_at(
    equations: &mut dyn Discretised,
    (point, level): PointAt<'_>,
    to: usize,
    keep_parameter: bool,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Point>> {
    let from = equations.resolution();
    equations.select(to)?;
    let start = equations.transfer(point, level)?;
    let found = equations.resolve(&start, keep_parameter, interrupt)?;
    if found.is_none() {
        equations.select(from)?;
    }
    Ok(found)
}

/// Solves with the harmonics of a higher level, from the corrected solution or level by level; if both fail, the
/// resolution is unchanged.
fn refine_to(
    equations: &mut dyn Discretised,
    point: &Point,
    estimate: &Estimate,
    to: usize,
    keep_parameter: bool,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Point>> {
    let from = equations.resolution();
    equations.select(to)?;
    if estimate.certified {
        // Where the plane across the branch has no solution near, a fixed parameter may have one.
        let ways: &[bool] = if keep_parameter { &[true] } else { &[false, true] };
        for &fixed in ways {
            let start = equations.transfer_corrected(point, from, estimate)?;
            if let Some(found) = equations.resolve(&start, fixed, interrupt)? {
                return Ok(Some(found));
            }
        }
    }
    let mut reached = point.try_clone()?;
    for level in from + 1..=to {
        equations.select(level)?;
        let start = equations.transfer(&reached, level - 1)?;
        match equations.resolve(&start, keep_parameter, interrupt)? {
            Some(found) => reached = found,
            None if level == from + 1 => {
                equations.select(from)?;
                return Ok(None);
            }
            None => {
                equations.select(level - 1)?;
                break;
            }
        }
    }
    Ok(Some(reached))
}
