//! Follows a branch from its first point to the end of the range: points, folds, peaks, solutions
//! wanted at given parameter values. The same for every analysis.

use super::adapt::{Assessment, Choice, Refined, refine, retreat, settle};
use super::levels::Ladder;
use crate::branch::{Branch, SpecialKind};
use crate::continuation::events::{Event, Locator};
use crate::continuation::{Advance, Continuation, Metric, Point, Settings};
use crate::error::{Error, Result, Status};
use crate::error_estimate::Estimate;
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::linalg::norm;
use crate::problem::Problem;

/// What an analysis does with the points that are found. It was last evaluated at the point that it
/// is handed.
pub(super) trait Keeper {
    /// The problem that is solved.
    fn problem(&mut self) -> &mut dyn Problem;

    /// Stores a point of the curve.
    fn keep(&mut self, point: &Point) -> Result<()>;

    /// Stores a point beside the curve; `false` where it asks for more harmonics, to which the keeper has gone. One
    /// that `must` be kept is stored as it is.
    fn keep_special(&mut self, kind: SpecialKind, point: Point, must: bool) -> Result<bool>;

    /// What was stored so far.
    fn branch(&self) -> &Branch;

    /// The harmonics that there are to choose from.
    fn ladder(&self) -> &Ladder<'_>;

    /// The rung of it that the problem has.
    fn rung(&self) -> usize;

    /// Goes to another rung.
    fn go_to(&mut self, rung: usize) -> Result<()>;

    /// How a rung is chosen.
    fn choice(&mut self) -> &mut Choice;

    /// Estimates the error of a point; none where nobody asked for it.
    fn assess(&mut self, point: &Point) -> Result<Option<Assessment>>;

    /// A point of another rung in the harmonics at hand.
    fn carry(&self, point: &Point, from: usize) -> Result<Point>;

    /// The corrected solution of a point of another rung in the harmonics at hand.
    fn corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point>;

    /// Solves near a point with the harmonics at hand, see [`crate::continuation::again`].
    fn solve_again(
        &mut self,
        near: &Point,
        keep_parameter: bool,
        cancelled: Option<&dyn Fn() -> bool>,
    ) -> Result<Option<Point>>;
}

/// How a run ended.
pub(super) struct Ending {
    pub status: Status,
    /// The failure of a law that ended it.
    pub reason: Option<Error>,
}

impl Ending {
    /// The end of a run that has kept `branch` so far: a law that failed stops it and keeps the points.
    pub fn of(outcome: Result<Status>, branch: &Branch) -> Result<Self> {
        match outcome {
            Ok(status) => Ok(Self { status, reason: None }),
            Err(e) if e.status == Status::Callback && branch.points() > 0 => Ok(Self {
                status: Status::StoppedCallback,
                reason: Some(e),
            }),
            // A law with states that found none at a point beside the curve.
            Err(e) if e.recoverable && branch.points() > 0 => Ok(Self {
                status: Status::StoppedStepTooSmall,
                reason: Some(e),
            }),
            Err(e) => Err(e),
        }
    }
}

/// How far to follow, and what to look for.
pub(super) struct Task<'a> {
    pub settings: Settings,
    /// The whole range, of which `settings` may leave out what needs no following.
    pub range: (f64, f64),
    /// Parameter values at which solutions are wanted.
    pub at: &'a [f64],
    pub max_points: usize,
    /// Parameter value before the range up to which a branch is followed that leaves at its start, in the
    /// hope that it comes back; none: not followed.
    pub before: Option<f64>,
}

/// How often in a row a branch goes back to its last point to come with more harmonics.
const MOST_RETREATS: usize = 2;

/// A point with the rung of its harmonics.
type End<'p> = (&'p Point, usize);

/// What became of a branch that left its range.
enum Outside {
    Back(Point),
    Gone,
    Cancelled,
}

/// A point of the curve with the harmonics that it asks for; `None` where there is no solution.
fn refined_point(keeper: &mut dyn Keeper, point: Point, fixed: bool, hooks: &Hooks<'_>) -> Result<Option<Refined>> {
    some_unless_lost(refine(keeper, point, fixed, hooks.cancelled))
}

/// Stores a point of the curve; `false` where there is no solution.
fn kept(keeper: &mut dyn Keeper, point: &Point) -> Result<bool> {
    Ok(some_unless_lost(keeper.keep(point))?.is_some())
}

/// Newton's last correction, which is not evaluated, may have led to where there is no solution.
fn some_unless_lost<T>(outcome: Result<T>) -> Result<Option<T>> {
    match outcome {
        Err(e) if e.status == Status::Singular || (e.recoverable && e.status != Status::Callback) => Ok(None),
        outcome => outcome.map(Some),
    }
}

/// Whether two solutions at one parameter value are one.
fn same(a: &[f64], b: &[f64]) -> bool {
    let difference = a.iter().zip(b).fold(0.0_f64, |d, (a, b)| d.hypot(a - b));
    difference <= 1e-8 * norm(b)
}

impl Task<'_> {
    /// Stores the first point of the curve, or the only one, and follows the branch from there.
    pub fn run(&self, keeper: &mut dyn Keeper, first: Point, hooks: &mut Hooks<'_>) -> Result<Status> {
        let first = refine(keeper, first, true, hooks.cancelled)?.point;
        keeper.keep(&first)?;
        if self.report(keeper, hooks, &first) {
            return Ok(Status::StoppedByCaller);
        }
        self.go_on(keeper, first, hooks)
    }

    /// Follows the branch from the point stored last.
    pub fn go_on(&self, keeper: &mut dyn Keeper, first: Point, hooks: &mut Hooks<'_>) -> Result<Status> {
        let (start, end) = (self.settings.start, self.settings.end);
        if start.to_bits() == end.to_bits() {
            for (i, p) in self.at.iter().enumerate() {
                if p.to_bits() == end.to_bits() {
                    // It has the harmonics that it was found to need, or could be found with.
                    keeper.keep_special(SpecialKind::At(i), first.try_clone()?, true)?;
                }
            }
            return Ok(Status::Ok);
        }
        let (begin, began) = (first.try_clone()?, keeper.rung());
        let mut continuation = Continuation::new(self.settings, first)?;
        // Where harmonics change the branch goes on from beside the point stored last: what is looked for is looked for
        // between stored points, so that nothing is passed over or found twice.
        let mut stored = (continuation.current().try_clone()?, began);
        let mut retreats = 0;
        loop {
            if keeper.branch().points() >= self.max_points {
                return Ok(Status::StoppedMaxPoints);
            }
            let before = keeper.rung();
            let (point, end) = match continuation.advance(keeper.problem(), hooks.cancelled)? {
                Advance::Accepted { point, last } => (point, last.then_some(Status::Ok)),
                Advance::LeftAtStart { point } => (point, Some(Status::StoppedLeftRange)),
                Advance::Stopped(status) => return Ok(status),
            };
            let Some(refined) = refined_point(keeper, point, end.is_some(), hooks)? else {
                return Ok(Status::StoppedStepTooSmall);
            };
            let astray = keeper.rung() != before && self.is_astray(keeper, (&stored.0, stored.1), &refined.point)?;
            if (refined.stuck || astray)
                && retreats < MOST_RETREATS
                && let Some(previous) = continuation.previous()
                && let Some(point) = retreat(keeper, (previous, before), hooks.cancelled)?
            {
                retreats += 1;
                continuation.go_on_from(None, point)?;
                continue;
            }
            retreats = 0;
            let point = refined.point;
            if !kept(keeper, &point)? {
                return Ok(Status::StoppedStepTooSmall);
            }
            let rung = keeper.rung();
            let stop = self.report(keeper, hooks, &point);
            self.events(keeper, (&stored.0, stored.1), (&point, rung), end.is_some())?;
            keeper.go_to(rung)?;
            stored = (point.try_clone()?, rung);
            if stop {
                return Ok(Status::StoppedByCaller);
            }
            match end {
                None => {
                    let current = settle(keeper, point, hooks.cancelled)?;
                    if rung != before || keeper.rung() != before {
                        let previous = match continuation.previous() {
                            Some(previous) => Some(keeper.carry(previous, before)?),
                            None => None,
                        };
                        continuation.go_on_from(previous, current)?;
                    }
                }
                Some(Status::StoppedLeftRange) => match self.outside(keeper, point, (&begin, began), hooks)? {
                    Outside::Back(back) => {
                        hooks.log(LogLevel::Info, "the branch left at its start and came back");
                        let Some(Refined { point: back, .. }) = refined_point(keeper, back, true, hooks)? else {
                            return Ok(Status::StoppedStepTooSmall);
                        };
                        if !kept(keeper, &back)? {
                            return Ok(Status::StoppedStepTooSmall);
                        }
                        if self.report(keeper, hooks, &back) {
                            return Ok(Status::StoppedByCaller);
                        }
                        continuation = Continuation::new(self.settings, back)?;
                        stored = (continuation.current().try_clone()?, keeper.rung());
                    }
                    Outside::Gone => return Ok(Status::StoppedLeftRange),
                    Outside::Cancelled => return Ok(Status::StoppedByCaller),
                },
                Some(status) => return Ok(status),
            }
        }
    }

    /// Whether a point found with other harmonics lies behind the one stored last, or outside of the range.
    fn is_astray(&self, keeper: &dyn Keeper, (previous, rung): End<'_>, point: &Point) -> Result<bool> {
        let previous = keeper.carry(previous, rung)?;
        let metric = Metric::along(norm(point.unknowns()), &self.settings);
        let forward = metric.dot(&point.v, &point.tangent) > metric.dot(&previous.v, &point.tangent);
        let (low, high) = (
            self.settings.start.min(self.settings.end),
            self.settings.start.max(self.settings.end),
        );
        Ok(!forward || point.parameter() < low || point.parameter() > high)
    }

    /// Follows the branch from where it left at the start of the range to where it comes back, which folds
    /// on both sides of the start make it do. What lies outside is not kept.
    fn outside(
        &self,
        keeper: &mut dyn Keeper,
        exit: Point,
        (begin, began): (&Point, usize),
        hooks: &mut Hooks<'_>,
    ) -> Result<Outside> {
        let Some(before) = self.before else {
            return Ok(Outside::Gone);
        };
        let begin = keeper.carry(begin, began)?;
        let settings = Settings {
            end: before,
            ..self.settings
        };
        let mut continuation = Continuation::new(settings, exit)?;
        for _ in keeper.branch().points()..self.max_points {
            match continuation.advance(keeper.problem(), hooks.cancelled) {
                Ok(Advance::Accepted { last: false, .. }) => {}
                // A closed curve would be walked for ever.
                Ok(Advance::LeftAtStart { point }) if !same(point.unknowns(), begin.unknowns()) => {
                    return Ok(Outside::Back(point));
                }
                Ok(Advance::Stopped(Status::StoppedByCaller)) => return Ok(Outside::Cancelled),
                Err(e) if e.status == Status::Callback => return Err(e),
                // What fails outside the range costs none of the points within.
                Ok(_) | Err(_) => break,
            }
        }
        Ok(Outside::Gone)
    }

    /// Tells the host of the point stored last; `true` if it wants to stop.
    pub fn report(&self, keeper: &dyn Keeper, hooks: &mut Hooks<'_>, point: &Point) -> bool {
        let (start, end) = self.range;
        let range = end - start;
        hooks.report(&Progress {
            point: keeper.branch().points(),
            parameter: point.parameter(),
            amplitude: keeper.branch().amplitude().last().copied().unwrap_or(0.0),
            residual: point.residual,
            step: point.step,
            fraction_done: if range == 0.0 {
                1.0
            } else {
                ((point.parameter() - start) / range).clamp(0.0, 1.0)
            },
            newton_iterations: point.iterations,
        })
    }

    /// Looks for folds, peaks and wanted parameter values between two neighbours, each given with its rung.
    fn events(&self, keeper: &mut dyn Keeper, a: End<'_>, b: End<'_>, last: bool) -> Result<()> {
        keeper.go_to(a.1.max(b.1))?;
        if Event::Peak.between(a.0, b.0) {
            self.find(keeper, SpecialKind::Peak, a, b, |locator, problem, a, b| {
                locator.locate(problem, Event::Peak, a, b)
            })?;
        }
        let fold = if Event::Fold.between(a.0, b.0) {
            self.find(keeper, SpecialKind::Fold, a, b, |locator, problem, a, b| {
                locator.locate(problem, Event::Fold, a, b)
            })?
        } else {
            None
        };
        if let Some((fold, rung)) = &fold {
            self.wanted(keeper, a, (fold, *rung), false)?;
            self.wanted(keeper, (fold, *rung), b, last)
        } else {
            self.wanted(keeper, a, b, last)
        }
    }

    /// Solves at the wanted parameter values on the arc from `a` (included) to `b` (with the last
    /// point of the branch included), which has no fold inside.
    fn wanted(&self, keeper: &mut dyn Keeper, a: End<'_>, b: End<'_>, last: bool) -> Result<()> {
        for (i, &p) in self.at.iter().enumerate() {
            let (pa, pb) = (a.0.parameter(), b.0.parameter());
            let inside = (pa <= p && p < pb) || (pb < p && p <= pa);
            let inside = inside || (last && p.to_bits() == pb.to_bits());
            if inside {
                self.find(keeper, SpecialKind::At(i), a, b, |locator, problem, a, b| {
                    locator.at_parameter(problem, a, b, p)
                })?;
            }
        }
        Ok(())
    }

    /// Searches between two neighbours and stores what is found, with as many harmonics as it asks for.
    fn find(
        &self,
        keeper: &mut dyn Keeper,
        kind: SpecialKind,
        a: End<'_>,
        b: End<'_>,
        search: impl Fn(&mut Locator, &mut dyn Problem, &Point, &Point) -> Result<Option<Point>>,
    ) -> Result<Option<(Point, usize)>> {
        let mut found: Option<(Point, usize)> = None;
        loop {
            let rung = keeper.rung();
            let (a, b) = (keeper.carry(a.0, a.1)?, keeper.carry(b.0, b.1)?);
            let mut locator = Locator::new(a.unknowns().len(), self.settings)?;
            let Some(point) = search(&mut locator, keeper.problem(), &a, &b)? else {
                // What was found with fewer harmonics is better than nothing.
                if let Some((point, rung)) = &found {
                    keeper.go_to(*rung)?;
                    keeper.keep_special(kind, point.try_clone()?, true)?;
                }
                return Ok(found);
            };
            if keeper.keep_special(kind, point.try_clone()?, false)? {
                return Ok(Some((point, rung)));
            }
            found = Some((point, rung));
        }
    }
}
