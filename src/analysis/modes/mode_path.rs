//! The path of a nonlinear mode: points of the linear range, the first point with slip, the branch from there on.

use crate::analysis::forced::forced_curve::told_way;
use crate::analysis::forced::sampling::may_refine;
use crate::analysis::modes::mode_discretised::ModeDiscretised;
use crate::continuation::initial_point::{self, First, Way};
use crate::continuation::{Advance, Continuation, Point, Settings};
use crate::error::{Result, Status, fail};
use crate::harmonics::discretised::{Discretised, Recorder};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::{Interrupt, Phase};
use crate::options::Range;
use crate::options::{ModeOptions, SolverOptions};
use crate::problem::Problem;
use crate::results::SpecialKind;
use crate::tracing::branch_tracer::{BranchTracer, Course};

/// First amplitude beyond the onset of slip that is solved for, relative to the onset. At the onset itself the branch
/// has a corner, and where modes share a frequency no solution is isolated.
/// Kind: tuned; measured on: not recorded.
const BEYOND_ONSET: f64 = 1.02;

/// Distance below the onset, in log₁₀, to which a branch that began to slip may come back before it reaches an
/// amplitude above the onset.
/// Kind: tuned; measured on: not recorded.
const BELOW_ONSET: f64 = 3.0;

/// Amplitudes, as log₁₀, up to which the mode is linear, and up to which it nearly is.
#[derive(Clone, Copy)]
pub(crate) struct Onset {
    pub linear_up_to: f64,
    pub nearly: f64,
}

impl Onset {
    /// Amplitude, as log₁₀, just beyond the onset of slip.
    fn beyond(self) -> f64 {
        self.linear_up_to + BEYOND_ONSET.log10()
    }
}

/// The course of the nonlinear part of the branch, and the settings of its first point.
pub(crate) fn course<'a>(
    solver: &SolverOptions,
    range: &ModeOptions<'a>,
    settings: Settings,
    onset: Onset,
) -> (Course<'a>, Settings) {
    let (start, end) = (range.log10_start, range.log10_stop);
    let from = if start <= onset.linear_up_to {
        onset.beyond().min(end)
    } else {
        start
    };
    let settings = Settings {
        start: from,
        ..settings
    };
    let course = Course {
        ends: None,
        settings: Settings {
            // The branch may come back to amplitudes below the onset, with slip.
            start: if from < end { start } else { from },
            ..settings
        },
        range: Range::new(start, end),
        at: range.at,
        max_points: solver.max_points,
        may_refine: may_refine(solver),
        before: None,
        starts_again: None,
        bands: None,
        resonances: Vec::new(),
        since: 0,
    };
    (course, settings)
}

/// Records the branch from the start of its range on.
pub(crate) fn trace(
    mode: &mut ModeDiscretised<'_>,
    tracer: &mut BranchTracer<'_>,
    (settings, onset): (Settings, Onset),
    guess: Option<Vec<f64>>,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Status> {
    let Range { start, stop: end } = tracer.course().range;
    let max_points = tracer.course().max_points;
    let linear_up_to = onset.linear_up_to;
    let level = mode.resolution();
    if let Some(guess) = guess {
        return from_guess(mode, tracer, settings, guess, hooks, interrupt);
    }
    if start <= linear_up_to {
        // Nothing but the fundamental vibrates there.
        if mode.levels().is_automatic() {
            mode.select(0)?;
        }
        if let Some(status) = linear_range(mode, tracer, linear_up_to.min(end), hooks, interrupt)? {
            return Ok(status);
        }
        requested_below(mode, tracer, settings, level, linear_up_to, interrupt)?;
        if end <= linear_up_to {
            return Ok(Status::Ok);
        }
        if mode.branch().points() >= max_points {
            return Ok(Status::StoppedMaxPoints);
        }
    }
    mode.select(level)?;
    let corner = if linear_up_to.is_finite() {
        Some(mode.linear_point(linear_up_to)?)
    } else {
        None
    };
    let near = if corner.is_some() { onset.beyond() } else { onset.nearly };
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    match first_nonlinear(mode.problem(), &settings, near, corner.as_ref(), max_points, interrupt) {
        Ok(first) => {
            hooks.log(LogLevel::Info, "first point with slip or a nonlinear force solved");
            tracer.trace(mode, first.point, hooks)
        }
        Err(e) => match corner {
            // The amplitude turns as soon as contacts slip: the path leads around the corner.
            Some(corner) if e.status == Status::NoConvergence && start <= linear_up_to => {
                hooks.log(LogLevel::Info, "the amplitude turns at the onset of slip");
                tracer.trace_from(mode, corner, hooks)
            }
            _ => Err(e),
        },
    }
}

/// Records the branch from the point, at the start of the range, to which a guess leads.
fn from_guess(
    mode: &mut ModeDiscretised<'_>,
    tracer: &mut BranchTracer<'_>,
    settings: Settings,
    guess: Vec<f64>,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Status> {
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    mode.set_guess(guess);
    let First { point, way } = initial_point::solve(mode.problem(), &settings, interrupt)?;
    mode.note_guess(told_way(way, true, hooks));
    tracer.trace(mode, point, hooks)
}

/// Records solutions at the requested amplitudes of the linear range, and of the gap between this range and the first
/// point beyond.
fn requested_below(
    mode: &mut ModeDiscretised<'_>,
    tracer: &mut BranchTracer<'_>,
    settings: Settings,
    level: usize,
    linear_up_to: f64,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let requested = tracer.course().at;
    for (i, &p) in requested.iter().enumerate() {
        if p <= linear_up_to {
            let point = mode.linear_point(p)?;
            tracer.record_special(mode, SpecialKind::At(i), &point)?;
        } else if p < settings.start {
            mode.select(level)?;
            let at_it = Settings { start: p, ..settings };
            // The loop ends when the point requires no more harmonics.
            loop {
                let first = initial_point::solve(mode.problem(), &at_it, interrupt)?;
                if tracer.record_special(mode, SpecialKind::At(i), &first.point)? {
                    break;
                }
            }
        }
    }
    Ok(())
}

/// The point at `settings.start`, beyond the linear range. Newton's method from a linear mode far below may find
/// another mode, so the branch is followed from `near`, where the linear mode is a reliable initial guess: just
/// beyond the onset of slip, or where smooth laws are nearly linear.
fn first_nonlinear(
    problem: &mut dyn Problem,
    settings: &Settings,
    near: f64,
    onset: Option<&Point>,
    max_points: usize,
    interrupt: &Interrupt<'_>,
) -> Result<First> {
    if settings.start <= near || !near.is_finite() {
        return initial_point::solve(problem, settings, interrupt);
    }
    let at_near = Settings {
        start: near,
        end: settings.start,
        ..*settings
    };
    let first = match initial_point::solve(problem, &at_near, interrupt) {
        Ok(first) => first.point,
        // The amplitude turns as soon as contacts slip: the path leads around the corner.
        Err(e) => match onset {
            Some(onset) if e.status == Status::NoConvergence => onset.try_clone()?,
            _ => return Err(e),
        },
    };
    // The branch may come back to amplitudes below the onset.
    let path = Settings {
        start: near - BELOW_ONSET,
        ..at_near
    };
    let mut continuation = Continuation::new(path, first)?;
    for _ in 0..max_points {
        match continuation.advance(problem, interrupt)? {
            Advance::Accepted { point, last: true } => {
                return Ok(First {
                    point,
                    way: Way::Branch,
                });
            }
            Advance::Accepted { .. } => {}
            Advance::LeftAtStart { .. } | Advance::Stopped(_) => break,
        }
    }
    fail!(
        NoConvergence,
        "log10_start = {} was not reached from where the mode ceases to be linear, {near}; start below that, pass a guess, or raise max_newton or max_points",
        settings.start
    )
}

/// Records points from the start of the range to `end`, below which all contacts stick: no equation need be solved
/// there. They are as dense as the largest steps of the continuation.
fn linear_range(
    mode: &mut ModeDiscretised<'_>,
    tracer: &BranchTracer<'_>,
    end: f64,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Status>> {
    let course = tracer.course();
    let Range { start, stop } = course.range;
    let spacing = course.settings.steps.largest() * (stop - start);
    let steps = ((end - start) / spacing).ceil().max(1.0);
    let count = if end > start { steps as usize + 1 } else { 1 };
    for k in 0..count {
        if mode.branch().points() >= course.max_points {
            return Ok(Some(Status::StoppedMaxPoints));
        }
        let p = if k + 1 == count && count > 1 {
            end
        } else {
            start + (end - start) * (k as f64 / steps)
        };
        let point = mode.linear_point(p)?;
        mode.record(&point)?;
        if tracer.report(mode, hooks, &point) {
            return Ok(Some(Status::StoppedByCaller));
        }
        interrupt.check()?;
    }
    Ok(None)
}
