//! Follows a branch from its first point to the end of the range: points, folds, peaks, solutions
//! wanted at given parameter values. The same for every analysis.

use crate::branch::{Branch, SpecialKind};
use crate::continuation::events::{Event, Locator};
use crate::continuation::{Advance, Continuation, Point, Settings};
use crate::error::{Error, Result, Status};
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

    /// Stores a point beside the curve.
    fn keep_special(&mut self, kind: SpecialKind, point: Point) -> Result<()>;

    /// What was stored so far.
    fn branch(&self) -> &Branch;
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

/// What became of a branch that left its range.
enum Outside {
    Back(Point),
    Gone,
    Cancelled,
}

/// Stores a point of the curve; `false` where Newton's last correction, which is not evaluated, led to where there
/// is no solution.
fn kept(keeper: &mut dyn Keeper, point: &Point) -> Result<bool> {
    match keeper.keep(point) {
        Err(e) if e.status == Status::Singular || (e.recoverable && e.status != Status::Callback) => Ok(false),
        stored => stored.map(|()| true),
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
                    keeper.keep_special(SpecialKind::At(i), first.try_clone()?)?;
                }
            }
            return Ok(Status::Ok);
        }
        let n = first.unknowns().len();
        let begin = first.try_clone()?;
        let mut locator = Locator::new(n, self.settings)?;
        let mut continuation = Continuation::new(self.settings, first)?;
        loop {
            if keeper.branch().points() >= self.max_points {
                return Ok(Status::StoppedMaxPoints);
            }
            let (point, end) = match continuation.advance(keeper.problem(), hooks.cancelled)? {
                Advance::Accepted { point, last } => (point, last.then_some(Status::Ok)),
                Advance::LeftAtStart { point } => (point, Some(Status::StoppedLeftRange)),
                Advance::Stopped(status) => return Ok(status),
            };
            if !kept(keeper, &point)? {
                return Ok(Status::StoppedStepTooSmall);
            }
            let stop = self.report(keeper, hooks, &point);
            if let Some(before) = continuation.previous() {
                self.events(keeper, &mut locator, before, &point, end.is_some())?;
            }
            if stop {
                return Ok(Status::StoppedByCaller);
            }
            match end {
                None => {}
                Some(Status::StoppedLeftRange) => match self.outside(keeper, point, &begin, hooks)? {
                    Outside::Back(back) => {
                        hooks.log(LogLevel::Info, "the branch left at its start and came back");
                        if !kept(keeper, &back)? {
                            return Ok(Status::StoppedStepTooSmall);
                        }
                        if self.report(keeper, hooks, &back) {
                            return Ok(Status::StoppedByCaller);
                        }
                        continuation = Continuation::new(self.settings, back)?;
                    }
                    Outside::Gone => return Ok(Status::StoppedLeftRange),
                    Outside::Cancelled => return Ok(Status::StoppedByCaller),
                },
                Some(status) => return Ok(status),
            }
        }
    }

    /// Follows the branch from where it left at the start of the range to where it comes back, which folds
    /// on both sides of the start make it do. What lies outside is not kept.
    fn outside(&self, keeper: &mut dyn Keeper, exit: Point, begin: &Point, hooks: &mut Hooks<'_>) -> Result<Outside> {
        let Some(before) = self.before else {
            return Ok(Outside::Gone);
        };
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

    /// Looks for folds, peaks and wanted parameter values between two neighbours.
    fn events(&self, keeper: &mut dyn Keeper, locator: &mut Locator, a: &Point, b: &Point, last: bool) -> Result<()> {
        if Event::Peak.between(a, b)
            && let Some(peak) = locator.locate(keeper.problem(), Event::Peak, a, b)?
        {
            keeper.keep_special(SpecialKind::Peak, peak)?;
        }
        let fold = if Event::Fold.between(a, b) {
            locator.locate(keeper.problem(), Event::Fold, a, b)?
        } else {
            None
        };
        if let Some(fold) = &fold {
            keeper.keep_special(SpecialKind::Fold, fold.try_clone()?)?;
            self.wanted(keeper, locator, a, fold, false)?;
            self.wanted(keeper, locator, fold, b, last)
        } else {
            self.wanted(keeper, locator, a, b, last)
        }
    }

    /// Solves at the wanted parameter values on the arc from `a` (included) to `b` (with the last
    /// point of the branch included), which has no fold inside.
    fn wanted(&self, keeper: &mut dyn Keeper, locator: &mut Locator, a: &Point, b: &Point, last: bool) -> Result<()> {
        for (i, &p) in self.at.iter().enumerate() {
            let (pa, pb) = (a.parameter(), b.parameter());
            let inside = (pa <= p && p < pb) || (pb < p && p <= pa);
            let inside = inside || (last && p.to_bits() == pb.to_bits());
            if inside && let Some(point) = locator.at_parameter(keeper.problem(), a, b, p)? {
                keeper.keep_special(SpecialKind::At(i), point)?;
            }
        }
        Ok(())
    }
}
