//! The curve of a result over a parameter: its points, its optima, its turns, and the solutions at requested values.

use crate::analysis::over_parameter::followed::Followed;
use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::{Advance, Continuation, Point, Settings, initial_point};
use crate::error::{Result, Status, try_push};
use crate::harmonics::controller::AdaptivityController;
use crate::harmonics::discretised::Discretised;
use crate::hooks::{Hooks, Progress};
use crate::interrupt::{Interrupt, Phase};
use crate::problem::Problem;
use crate::results::{Branch, Optimum, ParameterData, SpecialKind, Turn};
use crate::tracing::branch_recorder::largest_change;

const CONTEXT: &str = "the parameter response";

/// Kind of a point beside the curve.
#[derive(Clone, Copy)]
pub(super) enum Beside {
    /// The solution at the requested value with this index.
    At(usize),
    /// The smallest or largest result.
    Optimum { is_maximum: bool },
    /// The smallest or largest parameter, where the curve turns.
    Turn { is_maximum: bool },
}

impl Beside {
    fn kind(self) -> SpecialKind {
        match self {
            Self::At(i) => SpecialKind::At(i),
            Self::Optimum { .. } | Self::Turn { .. } => SpecialKind::Peak,
        }
    }
}

/// A located point beside the curve, with its level and its estimated error.
struct Located {
    beside: Beside,
    point: Point,
    level: usize,
    error: f64,
}

/// Start of the curve, values at which to store solutions, and limits.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// Value of the parameter at the first point, within the range.
    pub begin: f64,
    pub at: &'a [f64],
    pub max_points: usize,
    /// Tolerance that selects the harmonics; 0: a fixed number.
    pub tolerance: f64,
}

/// Records one curve over the parameter.
pub(crate) struct CurveRecorder<'a> {
    pub(super) followed: Followed<'a>,
    pub(super) settings: Settings,
    wanted: Wanted<'a>,
    controller: AdaptivityController,
    branch: &'a mut Branch,
    data: &'a mut ParameterData,
    beside: Vec<Located>,
    pub(super) interrupt: &'a Interrupt<'a>,
    missed: bool,
}

impl<'a> CurveRecorder<'a> {
    /// A recorder for an empty branch.
    pub fn new(
        followed: Followed<'a>,
        (settings, wanted): (Settings, Wanted<'a>),
        (branch, data): (&'a mut Branch, &'a mut ParameterData),
        interrupt: &'a Interrupt<'a>,
    ) -> Self {
        Self {
            followed,
            settings,
            wanted,
            controller: AdaptivityController::new(wanted.tolerance),
            branch,
            data,
            beside: Vec::new(),
            interrupt,
            missed: false,
        }
    }

    /// Records the curve from its first point on, then the points beside it; returns its status and whether some point
    /// misses the tolerance.
    ///
    /// # Errors
    /// Those of the problem; `NoConvergence` without a first point.
    pub fn record(mut self, hooks: &mut Hooks<'_>) -> Result<(Status, bool)> {
        let status = match self.trace(hooks) {
            Err(e) if e.status == Status::StoppedByCaller => e.status,
            status => status?,
        };
        match self.store_beside() {
            Err(e) if e.status == Status::StoppedByCaller => {}
            stored => stored?,
        }
        Ok((status, self.missed))
    }

    fn trace(&mut self, hooks: &mut Hooks<'_>) -> Result<Status> {
        let (settings, interrupt) = (self.settings, self.interrupt);
        let begin = Settings {
            start: self.wanted.begin,
            ..settings
        };
        let first = initial_point::solve(self.followed.problem(), &begin, interrupt)?.point;
        let first = self
            .controller
            .refine(&mut self.followed, first, true, interrupt)?
            .point;
        self.store(&first)?;
        if self.report(hooks, &first) {
            return Ok(Status::StoppedByCaller);
        }
        let mut before = first.try_clone()?;
        let mut continuation = Continuation::new(settings, first)?;
        loop {
            let share = (before.parameter() - settings.start) / (settings.end - settings.start);
            interrupt.phase(Phase::Continuation, share.clamp(0.0, 1.0))?;
            let level = self.followed.resolution();
            let (point, last) = match continuation.advance(self.followed.problem(), interrupt)? {
                Advance::Accepted { point, last } => (point, last),
                Advance::LeftAtStart { .. } => return Ok(Status::StoppedLeftRange),
                Advance::Stopped(status) => return Ok(status),
            };
            if let Some(previous) = continuation.previous() {
                // In the sense of the branch.
                before = previous.try_clone()?;
            }
            let point = self
                .controller
                .refine(&mut self.followed, point, last, interrupt)?
                .point;
            if !self.followed.tracked().exists(&point)? {
                return Ok(Status::StoppedPeakVanished);
            }
            let (here, error) = (self.followed.resolution(), self.followed.take_error());
            self.locate(&before, level, &point, here)?;
            self.followed.select(here)?;
            self.store_with(&point, error)?;
            if self.report(hooks, &point) {
                return Ok(Status::StoppedByCaller);
            }
            if last {
                return Ok(Status::Ok);
            }
            if self.branch.points() >= self.wanted.max_points {
                return Ok(Status::StoppedMaxPoints);
            }
            before = point.try_clone()?;
            let current = self.controller.adjust(&mut self.followed, point, interrupt)?;
            if here != level || self.followed.resolution() != level {
                let previous = match continuation.previous() {
                    Some(previous) => Some(self.followed.transfer(previous, level)?),
                    None => None,
                };
                continuation.go_on_from(previous, current)?;
            }
        }
    }

    /// Locates turns, requested values and optima between two neighbours, each with its level of harmonics.
    fn locate(&mut self, a: &Point, level_a: usize, b: &Point, level_b: usize) -> Result<()> {
        if !SpecialPoint::Fold.between(a, b) {
            return self.locate_without_turn(a, level_a, b, level_b);
        }
        let interrupt = self.interrupt;
        self.followed.select(level_a.max(level_b))?;
        let is_maximum = a.tangent.last().is_some_and(|t| *t > 0.0);
        let count = self.beside.len();
        let ends = ((a, level_a), (b, level_b));
        self.find(Beside::Turn { is_maximum }, ends.0, ends.1, |locator, problem, a, b| {
            locator.locate(problem, SpecialPoint::Fold, a, b, interrupt)
        })?;
        let found = match self.beside.get(count) {
            Some(found) => (found.point.try_clone()?, found.level),
            None => return self.locate_without_turn(a, level_a, b, level_b),
        };
        // On each side of the turn the parameter is monotonic.
        self.locate_without_turn(a, level_a, &found.0, found.1)?;
        self.locate_without_turn(&found.0, found.1, b, level_b)
    }

    fn locate_without_turn(&mut self, a: &Point, level_a: usize, b: &Point, level_b: usize) -> Result<()> {
        let interrupt = self.interrupt;
        let highest = level_a.max(level_b);
        for (i, &p) in self.wanted.at.iter().enumerate() {
            let (before, after) = (a.parameter() - p, b.parameter() - p);
            // A value at a point of the curve is found once, at the end of a step.
            let begins = before == 0.0 && self.branch.points() > 1;
            if before * after > 0.0 || begins {
                continue;
            }
            self.followed.select(highest)?;
            self.find(Beside::At(i), (a, level_a), (b, level_b), |locator, problem, a, b| {
                locator.at_parameter(problem, a, b, p, interrupt)
            })?;
        }
        self.find_optima(a, level_a, b, level_b)
    }

    /// Searches for a point between two neighbours, with the harmonics that this point requires.
    pub(super) fn find(
        &mut self,
        beside: Beside,
        (a, level_a): (&Point, usize),
        (b, level_b): (&Point, usize),
        search: impl Fn(&mut Locator, &mut dyn Problem, &Point, &Point) -> Result<Option<Point>>,
    ) -> Result<()> {
        let is_reciprocal = matches!(beside, Beside::Optimum { is_maximum: false });
        let mut found: Option<Located> = None;
        loop {
            let level = self.followed.resolution();
            let (a, b) = (self.followed.transfer(a, level_a)?, self.followed.transfer(b, level_b)?);
            let mut locator = Locator::new(a.unknowns().len(), self.settings)?;
            self.followed.tracked().unknowns_mut().is_reciprocal = is_reciprocal;
            let located = search(&mut locator, self.followed.problem(), &a, &b);
            self.followed.tracked().unknowns_mut().is_reciprocal = false;
            let Some(mut point) = located? else { break };
            if is_reciprocal {
                point.amplitude = point.amplitude.inv();
            }
            let kind = beside.kind();
            let meets = self.controller.meets_tolerance(&mut self.followed, kind, &point)?;
            let error = self.followed.take_error();
            found = Some(Located {
                beside,
                point,
                level,
                error,
            });
            if meets {
                break;
            }
        }
        match found {
            Some(found) => try_push(&mut self.beside, found, CONTEXT),
            None => Ok(()),
        }
    }

    /// Stores a point of the curve with the error estimated last.
    fn store(&mut self, point: &Point) -> Result<()> {
        let error = self.followed.take_error();
        self.store_with(point, error)
    }

    fn store_with(&mut self, point: &Point, error: f64) -> Result<()> {
        let tracked = self.followed.tracked();
        let (_, sampling_error) = tracked.store(point, error, self.branch, self.data, None)?;
        self.note(error, sampling_error);
        Ok(())
    }

    /// Notes whether the error of the harmonics or of sampled forces misses the tolerance; an unknown error does.
    fn note(&mut self, error: f64, sampling_error: f64) {
        let tolerance = self.wanted.tolerance;
        let meets = error <= tolerance && sampling_error <= largest_change(tolerance);
        self.missed |= tolerance > 0.0 && !meets;
    }

    /// Stores the points beside the curve.
    fn store_beside(&mut self) -> Result<()> {
        for located in core::mem::take(&mut self.beside) {
            self.followed.select(located.level)?;
            let Located {
                beside, point, error, ..
            } = &located;
            let tracked = self.followed.tracked();
            let (special, sampling_error) =
                tracked.store(point, *error, self.branch, self.data, Some(beside.kind()))?;
            self.note(*error, sampling_error);
            let (parameter, amplitude) = (point.parameter(), special.amplitude);
            let (point, omega) = (special.point, special.omega);
            match *beside {
                Beside::Optimum { is_maximum } => self.data.push_optimum(Optimum {
                    point,
                    omega,
                    amplitude,
                    parameter,
                    is_maximum,
                })?,
                Beside::Turn { is_maximum } => self.data.push_turn(Turn {
                    point,
                    parameter,
                    omega,
                    amplitude,
                    is_maximum,
                })?,
                Beside::At(_) => {}
            }
        }
        Ok(())
    }

    /// Reports a point of the curve; `true` when the caller requests a stop.
    fn report(&self, hooks: &mut Hooks<'_>, point: &Point) -> bool {
        let (start, end) = (self.settings.start, self.settings.end);
        let share = (point.parameter() - start) / (end - start);
        hooks.report(&Progress {
            point: self.branch.points(),
            parameter: point.parameter(),
            amplitude: self.branch.amplitude().last().copied().unwrap_or(0.0),
            residual: point.residual,
            step: point.step,
            fraction_done: share.clamp(0.0, 1.0),
            newton_iterations: point.iterations,
        })
    }
}
