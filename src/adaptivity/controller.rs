//! Selection of harmonics by a tolerance: more where the error of a point misses it, fewer where they carry little.
//!
//! A solution W whose error η is too large is resolved from its corrected solution Z*, see [`crate::error_estimate`],
//! with the lowest harmonics H′ beyond which Z* has converged:
//!
//! > 3/2 A t(H′) ≤ ½ tolerance,  t(h) = ‖Z*_{>h}‖/‖Z*‖,  A = η/t(H)
//!
//! and the branch continues with H′. The factor 3/2 allows for the error of the estimate. Harmonics are dropped only
//! where the error is far below the tolerance, so that they do not alternate. Where a harmonic costs many factorisations,
//! the bound is 0.7 of the tolerance, and harmonics are dropped as soon as fewer meet it: the point is solved with them, and
//! the change of its response, added to its error, shows whether they do.

use crate::adaptivity::discretised::{Assessment, Discretised};
use crate::adaptivity::estimate_spacing::{EstimateSpacing, Signs};
use crate::continuation::{Point, PointAt};
use crate::error::Result;
use crate::error_estimate::{Estimate, MARGIN};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::results::SpecialKind;

/// Target of the error as a share of the tolerance, where harmonics cost little and where they cost much.
const AIM: (f64, f64) = (0.5, 0.7);

/// Share of the tolerance above which the next point is refined in advance, unless harmonics cost much.
const RAISE: f64 = 0.7;

/// Share of the tolerance below which the next point is coarsened.
const DROP: f64 = 0.08;

/// Successive estimates below that share after which the branch is coarsened: one alone may be an exception.
const LOW: usize = 2;

/// Number of points for which a branch is not coarsened to a level at which one missed the tolerance, and the most points
/// where the error of one was unknown there time and again.
const CONTROLLER_PATIENCE: usize = 10;
const MOST_PATIENCE: usize = 80;

/// Relative size of a harmonic that is round-off.
const CONTROLLER_ROUND_OFF: f64 = 1e-13;

/// Levels by which a point is refined if the next one was not found from it.
const BACKTRACK: usize = 3;

/// Most refinements of one point.
const MOST_REFINEMENTS: usize = 12;

/// A point with the harmonics that its error requires, at the current resolution.
pub(crate) struct Refined {
    pub point: Point,
    /// Whether it misses the tolerance and was not found with more harmonics, although more are available.
    pub stuck: bool,
}

/// Selects the harmonics of each point of a branch.
pub(crate) struct AdaptivityController {
    tolerance: f64,
    /// Number of estimates that were more than a check of contacts that stick.
    estimates: usize,
    /// Error of the last point that met the tolerance, and the harmonics that it requires.
    last: Option<(f64, usize)>,
    /// Lowest level to which the branch may be coarsened, one above that where a point missed the tolerance, and the
    /// number of points for which it holds.
    floor: (usize, usize),
    /// The highest level so far. The branch is coarsened to half its harmonics at most.
    highest: usize,
    /// Whether the branch had a fold. If so, it is not coarsened at all where something is nonlinear: with fewer
    /// harmonics it may fold elsewhere and reverse.
    folded: bool,
    /// Where the branch was refined because an error was unknown: the number of points until it may be coarsened again.
    unknown: Option<usize>,
    /// Whether a nonlinear point was estimated.
    begun: bool,
    /// Number of successive estimates far below the tolerance.
    low: usize,
    spacing: EstimateSpacing,
}

impl AdaptivityController {
    /// A controller for a tolerance.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            estimates: 0,
            last: None,
            floor: (0, 0),
            highest: 0,
            folded: false,
            unknown: None,
            begun: false,
            low: 0,
            spacing: EstimateSpacing::default(),
        }
    }

    /// Number of estimates made.
    pub fn estimates(&self) -> usize {
        self.estimates
    }

    /// Notes a special point of the branch.
    pub fn note_special(&mut self, kind: SpecialKind) {
        self.folded |= kind.is_fold();
    }

    fn accepts(&self, error: f64) -> bool {
        MARGIN * error <= self.tolerance
    }

    /// Counts an estimate.
    fn count(&mut self, found: &Assessment) {
        self.estimates += usize::from(!found.estimate.certified || found.estimate.steps > 0);
    }

    /// The first point of a curve, where something is nonlinear, with the fewest harmonics that the curve has there: with
    /// fewer its error would be estimated to no avail.
    pub fn begin_curve(
        &mut self,
        equations: &mut dyn Discretised,
        point: Point,
        interrupt: &Interrupt<'_>,
    ) -> Result<Point> {
        let (level, few) = (
            equations.resolution(),
            equations.levels().few().min(equations.levels().last()),
        );
        if !equations.levels().is_automatic() || level >= few {
            return Ok(point);
        }
        let Some(better) = resolve_at(equations, (&point, level), few, true, interrupt)? else {
            return Ok(point);
        };
        self.begun = true;
        Ok(better)
    }

    /// The point with the harmonics that its error requires. If it misses the tolerance at the last refinement, it is
    /// returned all the same.
    pub fn refine(
        &mut self,
        equations: &mut dyn Discretised,
        mut point: Point,
        keep_parameter: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<Refined> {
        let done = |point| Ok(Refined { point, stuck: false });
        if !equations.levels().is_automatic() {
            return done(point);
        }
        let mut signs = Signs::of(&point, equations.share_of_highest(&point));
        if self.is_predicted(equations, &point, signs)? {
            return done(point);
        }
        // The point before the last refinement, where its error was unknown and the refinement changed nothing.
        let mut settled: Option<(Point, usize)> = None;
        let mut missed = false; // with fewer harmonics
        for refinements in 0..=MOST_REFINEMENTS {
            let level = equations.resolution();
            let Some(found) = self.estimate(equations, &point, signs)? else {
                return done(point);
            };
            let accepted = self.accepts(found.error);
            let required = self.required_harmonics(equations, &found);
            self.last = accepted.then_some((found.error, required));
            if !accepted {
                self.note_miss(found.error, level);
                missed = true;
            }
            if let Some((fewer, below)) = settled.take().filter(|_| found.error.is_nan()) {
                // More harmonics would tell no more, and each later point would pay for them.
                equations.select(below)?;
                self.floor = (below, 0);
                return done(fewer);
            }
            let drops = accepted && self.may_drop(found.error, missed);
            let next = if found.error.is_nan() {
                equations.levels().level_of_double(level)
            } else {
                equations.levels().level_with(required)
            };
            let next = if accepted { next } else { next.max(level + 1) };
            let next = next.min(equations.levels().last());
            let may_refine = !accepted && next > level && !found.estimate.too_large && refinements < MOST_REFINEMENTS;
            let better = if drops && next < level {
                resolve_at(equations, (&point, level), next, keep_parameter, interrupt)?
            } else if may_refine {
                refine_to(equations, &point, &found.estimate, next, keep_parameter, interrupt)?
            } else {
                None
            };
            let Some(better) = better else {
                return Ok(Refined {
                    point,
                    stuck: may_refine,
                });
            };
            let before = equations.transfer(&point, level)?;
            let same = found.error.is_nan() && self.is_same(&before, &better);
            if same {
                equations.share_work();
            }
            let left = core::mem::replace(&mut point, better);
            settled = same.then_some((left, level));
            signs = Signs::of(&point, equations.share_of_highest(&point));
        }
        done(point)
    }

    /// Notes a point that misses the tolerance at a level, or whose error is unknown there.
    fn note_miss(&mut self, error: f64, level: usize) {
        self.unknown = error.is_nan().then(|| {
            self.unknown
                .map_or(CONTROLLER_PATIENCE, |points| (2 * points).min(MOST_PATIENCE))
        });
        self.floor = (level + 1, self.unknown.unwrap_or(CONTROLLER_PATIENCE));
    }

    /// Estimates the error of a point, and notes it for the spacing of the estimates.
    fn estimate(&mut self, equations: &mut dyn Discretised, point: &Point, signs: Signs) -> Result<Option<Assessment>> {
        let found = equations.estimate(point)?;
        if let Some(found) = &found {
            self.count(found);
            let may_fall = equations.resolution() > equations.levels().few();
            let error = (found.error, self.tolerance / MARGIN);
            self.spacing.note(equations.resolution(), signs, error, may_fall);
            let is_low = MARGIN * found.error < DROP * self.tolerance;
            self.low = if is_low { self.low + 1 } else { 0 };
        }
        Ok(found)
    }

    /// Whether the error of a point is predicted by that of an earlier one; it is then taken over.
    fn is_predicted(&mut self, equations: &mut dyn Discretised, point: &Point, signs: Signs) -> Result<bool> {
        self.spacing.note_step(point.step);
        let largest = self.tolerance / MARGIN;
        let Some(factor) = self.spacing.factor(equations.resolution(), signs, largest) else {
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

    /// Whether harmonics may be dropped at once: those without content, and at the first point that is nonlinear those
    /// that it does not require, if the branch began with a number of harmonics that nothing has justified: not if the point
    /// `missed` the tolerance with fewer.
    fn may_drop(&mut self, error: f64, missed: bool) -> bool {
        if error == 0.0 {
            return true;
        }
        let first = !core::mem::replace(&mut self.begun, true);
        first && !missed && MARGIN * error <= DROP * self.tolerance
    }

    /// Whether two solutions have one response within the tolerance.
    fn is_same(&self, before: &Point, after: &Point) -> bool {
        let change = (after.amplitude - before.amplitude).norm();
        MARGIN * change <= self.tolerance * after.amplitude.norm()
    }

    /// The point from which the next one was not found, with more harmonics; `None` if that is not found either.
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
        let level = equations.resolution();
        let Some(found) = equations.estimate(point)? else {
            return Ok(true);
        };
        self.count(&found);
        if self.accepts(found.error) {
            return Ok(true);
        }
        let required = self.required_harmonics(equations, &found);
        let last = equations.levels().last();
        let next = equations.levels().level_with(required).max(level + 1).min(last);
        if next <= level || found.estimate.too_large {
            return Ok(true);
        }
        equations.select(next)?;
        Ok(false)
    }

    /// The point recorded last with the harmonics with which the branch continues: resolved if they change.
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
        let share = MARGIN * error / self.tolerance;
        self.floor.1 = self.floor.1.saturating_sub(1);
        self.highest = self.highest.max(level);
        let floor = self.lowest_level(equations, error, level);
        let last = equations.levels().last();
        let next = equations.levels().level_with(required).max(floor).min(last);
        let too_few = level < floor.min(equations.levels().few());
        // Where only an unknown error asked for more harmonics, those below may do again.
        let below = level.saturating_sub(1).max(equations.levels().few());
        let again = self.unknown.is_some() && self.floor.1 == 0 && share < RAISE && !self.folded;
        let next = if again { next.min(below) } else { next };
        let costly = equations.levels().are_costly();
        let tries = costly && next < level && self.floor.1 == 0 && error > 0.0;
        let may_fall = again || tries || (share < DROP && (error == 0.0 || self.low >= LOW));
        let rises = share > RAISE && next > level && !costly;
        if !(rises || (may_fall && next < level) || too_few) {
            return Ok(point);
        }
        // The parameter is kept, so that nothing lies between the recorded point and the one from which the branch
        // continues.
        let largest = if tries {
            AIM.1 * self.tolerance / MARGIN - error
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
            if tries {
                self.floor = (level, CONTROLLER_PATIENCE);
            }
        }
        Ok(found.unwrap_or(point))
    }

    /// Lowest level to which the branch may be coarsened from a point of this error.
    fn lowest_level(&self, equations: &dyn Discretised, error: f64, level: usize) -> usize {
        if error == 0.0 {
            return 0;
        }
        if self.folded {
            return level;
        }
        let half = equations
            .levels()
            .level_of_half(self.highest)
            .max(equations.levels().few());
        if self.floor.1 > 0 { half.max(self.floor.0) } else { half }
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
            aim * self.tolerance * left_out / (MARGIN * found.error)
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
