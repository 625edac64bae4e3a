//! Follows a branch from its first point to the end of the range: points, folds, peaks, solutions
//! wanted at given parameter values. The same for every analysis.

use crate::adaptivity::controller::{AdaptivityController, Assessment, Refined, backtrack, coarsen_or_refine, refine};
use crate::adaptivity::harmonic_levels::HarmonicLevels;
use crate::continuation::special_points::{Event, Locator};
use crate::continuation::{Advance, Continuation, Metric, Point, Settings};
use crate::error::{Error, Result, Status};
use crate::error_estimate::Estimate;
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::linalg::norm;
use crate::problem::Problem;
use crate::results::{Branch, SpecialKind};

/// What an analysis does with the points that are found. It was last evaluated at the point that it
/// is handed.
pub(crate) trait Keeper {
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
    fn harmonic_levels(&self) -> &HarmonicLevels<'_>;

    /// The resolution of it that the problem has.
    fn resolution(&self) -> usize;

    /// Goes to another resolution.
    fn go_to(&mut self, resolution: usize) -> Result<()>;

    /// How a resolution is chosen.
    fn choice(&mut self) -> &mut AdaptivityController;

    /// Estimates the error of a point; none where nobody asked for it.
    fn assess(&mut self, point: &Point) -> Result<Option<Assessment>>;

    /// A point of another resolution in the harmonics at hand.
    fn transfer(&self, point: &Point, from: usize) -> Result<Point>;

    /// The corrected solution of a point of another resolution in the harmonics at hand.
    fn corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point>;

    /// Solves near a point with the harmonics at hand, see [`crate::continuation::resolve`].
    fn resolve(
        &mut self,
        near: &Point,
        keep_parameter: bool,
        cancelled: Option<&dyn Fn() -> bool>,
    ) -> Result<Option<Point>>;
}

/// How a run ended.
pub(crate) struct Ending {
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
pub(crate) struct BranchTracer<'a> {
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
const MOST_BACKTRACKS: usize = 2;

/// A point with the resolution of its harmonics.
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

impl BranchTracer<'_> {
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
        let (begin, began) = (first.try_clone()?, keeper.resolution());
        let mut continuation = Continuation::new(self.settings, first)?;
        // Where harmonics change the branch goes on from beside the point stored last: what is looked for is looked for
        // between stored points, so that nothing is passed over or found twice.
        let mut stored = (continuation.current().try_clone()?, began);
        let mut backtracks = 0;
        loop {
            if keeper.branch().points() >= self.max_points {
                return Ok(Status::StoppedMaxPoints);
            }
            let before = keeper.resolution();
            let (point, end) = match continuation.advance(keeper.problem(), hooks.cancelled)? {
                Advance::Accepted { point, last } => (point, last.then_some(Status::Ok)),
                Advance::LeftAtStart { point } => (point, Some(Status::StoppedLeftRange)),
                Advance::Stopped(status) => return Ok(status),
            };
            let Some(refined) = refined_point(keeper, point, end.is_some(), hooks)? else {
                return Ok(Status::StoppedStepTooSmall);
            };
            let reversed = keeper.resolution() != before
                && self.is_reversed_or_outside(keeper, (&stored.0, stored.1), &refined.point)?;
            if (refined.stuck || reversed)
                && backtracks < MOST_BACKTRACKS
                && let Some(previous) = continuation.previous()
                && let Some(point) = backtrack(keeper, (previous, before), hooks.cancelled)?
            {
                backtracks += 1;
                continuation.go_on_from(None, point)?;
                continue;
            }
            backtracks = 0;
            let point = refined.point;
            if !kept(keeper, &point)? {
                return Ok(Status::StoppedStepTooSmall);
            }
            let resolution = keeper.resolution();
            let stop = self.report(keeper, hooks, &point);
            self.events(keeper, (&stored.0, stored.1), (&point, resolution), end.is_some())?;
            keeper.go_to(resolution)?;
            stored = (point.try_clone()?, resolution);
            if stop {
                return Ok(Status::StoppedByCaller);
            }
            match end {
                None => {
                    let current = coarsen_or_refine(keeper, point, hooks.cancelled)?;
                    if resolution != before || keeper.resolution() != before {
                        let previous = match continuation.previous() {
                            Some(previous) => Some(keeper.transfer(previous, before)?),
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
                        stored = (continuation.current().try_clone()?, keeper.resolution());
                    }
                    Outside::Gone => return Ok(Status::StoppedLeftRange),
                    Outside::Cancelled => return Ok(Status::StoppedByCaller),
                },
                Some(status) => return Ok(status),
            }
        }
    }

    /// Whether a point found with other harmonics lies behind the one stored last, or outside of the range.
    fn is_reversed_or_outside(
        &self,
        keeper: &dyn Keeper,
        (previous, resolution): End<'_>,
        point: &Point,
    ) -> Result<bool> {
        let previous = keeper.transfer(previous, resolution)?;
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
        let begin = keeper.transfer(begin, began)?;
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

    /// Tells the caller of the point stored last; `true` if it wants to stop.
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

    /// Looks for folds, peaks and wanted parameter values between two neighbours, each given with its resolution.
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
        if let Some((fold, resolution)) = &fold {
            self.wanted(keeper, a, (fold, *resolution), false)?;
            self.wanted(keeper, (fold, *resolution), b, last)
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
            let resolution = keeper.resolution();
            let (a, b) = (keeper.transfer(a.0, a.1)?, keeper.transfer(b.0, b.1)?);
            let mut locator = Locator::new(a.unknowns().len(), self.settings)?;
            let Some(point) = search(&mut locator, keeper.problem(), &a, &b)? else {
                // What was found with fewer harmonics is better than nothing.
                if let Some((point, resolution)) = &found {
                    keeper.go_to(*resolution)?;
                    keeper.keep_special(kind, point.try_clone()?, true)?;
                }
                return Ok(found);
            };
            if keeper.keep_special(kind, point.try_clone()?, false)? {
                return Ok(Some((point, resolution)));
            }
            found = Some((point, resolution));
        }
    }
}
