//! A forced response over a parameter of the model: its amplitude at a fixed frequency, or in a peak.

use crate::analysis::forced_response::forced_response;
use crate::continuation::initial_point;
use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Continuation, Point, Settings};
use crate::error::{Result, Status, fail, try_push};
use crate::hooks::{Hooks, Progress};
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions};
use crate::results::{Branch, Optimum, ParameterData, Resolution, SpecialKind};
use crate::sensitivity::{Parameter, TrackedResponse, design};
use num_complex::Complex64;
use std::sync::Arc;

/// What a parameter response follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Follow {
    /// The response at this angular frequency.
    Omega(f64),
    /// The peak next to this angular frequency, within a tenth of it.
    Peak(f64),
}

/// Range of a parameter response.
#[derive(Clone, Copy, Debug)]
pub struct ParameterRange<'a> {
    /// First value of the parameter.
    pub start: f64,
    /// Last value; below the first for a downward response.
    pub stop: f64,
    /// Values within the range at which every solution is stored.
    pub at: &'a [f64],
    /// What is followed.
    pub follow: Follow,
}

/// Share of a frequency within which its peak is sought.
const NEAR: f64 = 0.1;

/// Follows the amplitude of a forced response over a parameter, with [`SolverOptions::harmonics`] at all points. Steps are
/// controlled by the angle of the curve, so that folds are passed.
///
/// A branch that ends early is returned with a positive [`Branch::status`] and every point found. Where a peak vanishes
/// in a fold, that is `StoppedStepTooSmall`.
///
/// # Errors
/// Those of [`forced_response`] and of [`Parameter::check`]; `Unsupported` with a tolerance that chooses the harmonics;
/// `NoConvergence` if there is no peak near the frequency.
pub fn parameter_response(
    model: &Model,
    solver: &SolverOptions,
    parameter: Parameter<'_>,
    range: &ParameterRange<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    solver.check()?;
    if solver.tolerance > 0.0 {
        return fail!(
            Unsupported,
            "tolerance = {}, needs 0: a parameter response has the same harmonics at all points",
            solver.tolerance
        );
    }
    parameter.check(model)?;
    range.check()?;
    let ParameterRange {
        start,
        stop,
        at,
        follow,
    } = *range;
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    let first = design(model, core::slice::from_ref(&parameter), &[start])?;
    let (omega_start, omega_stop, is_peak) = match follow {
        Follow::Omega(omega) => (omega, omega, false),
        Follow::Peak(omega) => ((1.0 - NEAR) * omega, (1.0 + NEAR) * omega, true),
    };
    let range = ForcedOptions {
        omega_start,
        omega_stop,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&first, solver, &range, hooks)?;
    if branch.points() == 0 {
        return fail!(NoConvergence, "the response at the start of the range was not found");
    }
    let point = match follow {
        Follow::Omega(_) => 0,
        Follow::Peak(omega) => {
            let distance = |p: f64| (p - omega).abs();
            let nearest = branch
                .peaks()
                .iter()
                .min_by(|a, b| distance(a.omega).total_cmp(&distance(b.omega)));
            match nearest {
                Some(peak) => peak.point,
                None => {
                    return fail!(
                        NoConvergence,
                        "at the start of the range the response has no peak within {omega_start} .. {omega_stop}"
                    );
                }
            }
        }
    };
    let (Some(omega), Some(motion)) = (branch.omega_at(point), branch.motion_at(point)) else {
        return fail!(Internal, "a stored point has no motion");
    };
    let mut problem = TrackedResponse::new(
        (model, parameter),
        (solver, branch.response_dof()),
        (start, stop),
        (motion, branch.condensed_at(point).length(), omega),
        is_peak,
        &interrupt,
    )?;
    let settings = Settings {
        start,
        end: stop,
        tolerance: solver.tol_residual,
        max_iterations: solver.max_newton,
        steps: StepControl::new(solver.step, solver.step_min, solver.step_max),
    };
    let condensed = branch.condensed_at(point);
    let resolution = Resolution {
        condensed: Arc::new(condensed.clone()),
        samples: solver.samples,
    };
    let reduction = condensed.reduction_with(model, solver, 0);
    let mut found = Branch::new(&resolution, reduction, solver.harmonics, branch.response_dof())?;
    let mut data = ParameterData::default();
    let mut beside = Vec::new();
    let status = trace(
        &mut problem,
        settings,
        (at, solver.max_points),
        (&mut found, &mut data),
        &mut beside,
        hooks,
    );
    let status = match status {
        Err(e) if e.status == Status::StoppedByCaller => e.status,
        status => status?,
    };
    store_beside(&mut problem, &beside, (&mut found, &mut data))?;
    found.set_parameter_data(data);
    found.set_ending(status, None, (false, false));
    Ok(found)
}

impl ParameterRange<'_> {
    /// Checks the range, the requested values and the frequency.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        let (Follow::Omega(omega) | Follow::Peak(omega)) = self.follow;
        if !(omega > 0.0 && omega.is_finite()) {
            return fail!(Argument, "omega = {omega}, needs an angular frequency > 0");
        }
        check(self.start, self.stop, self.at)
    }
}

fn check(start: f64, stop: f64, at: &[f64]) -> Result<()> {
    for (name, value) in [("start", start), ("stop", stop)] {
        if !value.is_finite() {
            return fail!(NotFinite, "{name} = {value}, needs a finite number");
        }
    }
    if start.to_bits() == stop.to_bits() {
        return fail!(Argument, "the range of the parameter is empty: start = stop = {start}");
    }
    for (i, &p) in at.iter().enumerate() {
        if !(p >= start.min(stop) && p <= start.max(stop)) {
            return fail!(Argument, "at[{i}] = {p}, needs a value within {start} .. {stop}");
        }
    }
    Ok(())
}

/// Stores the points beside the curve; those that a stop of the caller prevents are left out.
fn store_beside(
    problem: &mut TrackedResponse<'_>,
    beside: &[(Beside, Point)],
    (found, data): (&mut Branch, &mut ParameterData),
) -> Result<()> {
    for (kind, point) in beside {
        let stored = match kind {
            Beside::At(i) => problem.store(point, found, data, Some(SpecialKind::At(*i))),
            Beside::Optimum { .. } => problem.store(point, found, data, Some(SpecialKind::Peak)),
        };
        let special = match stored {
            Err(e) if e.status == Status::StoppedByCaller => break,
            stored => stored?,
        };
        if let Beside::Optimum { is_maximum } = *kind {
            data.push_optimum(Optimum {
                point: special.point,
                omega: special.omega,
                amplitude: special.amplitude,
                parameter: point.parameter(),
                is_maximum,
            })?;
        }
    }
    Ok(())
}

/// A point beside the curve.
enum Beside {
    /// At a requested value.
    At(usize),
    /// Of the smallest or largest amplitude.
    Optimum { is_maximum: bool },
}

const CONTEXT: &str = "the parameter response";

/// Records the points of the curve from the first one on, and collects those beside it.
fn trace(
    problem: &mut TrackedResponse<'_>,
    settings: Settings,
    (at, most): (&[f64], usize),
    (branch, data): (&mut Branch, &mut ParameterData),
    beside: &mut Vec<(Beside, Point)>,
    hooks: &mut Hooks<'_>,
) -> Result<Status> {
    let interrupt = &hooks.interrupt();
    let mut before = initial_point::solve(problem, &settings, interrupt)?.point;
    let mut locator = Locator::new(before.unknowns().len(), settings)?;
    let mut continuation = Continuation::new(settings, before.try_clone()?)?;
    problem.store(&before, branch, data, None)?;
    if report(hooks, &before, &settings, branch) {
        return Ok(Status::StoppedByCaller);
    }
    loop {
        let share = (before.parameter() - settings.start) / (settings.end - settings.start);
        interrupt.phase(Phase::Continuation, share.clamp(0.0, 1.0))?;
        let (point, last) = match continuation.advance(problem, interrupt)? {
            Advance::Accepted { point, last } => (point, last),
            Advance::LeftAtStart { .. } => return Ok(Status::StoppedLeftRange),
            Advance::Stopped(status) => return Ok(status),
        };
        if let Some(previous) = continuation.previous() {
            // In the sense of the branch.
            before = previous.try_clone()?;
        }
        for (i, &p) in at.iter().enumerate() {
            let (a, b) = (before.parameter() - p, point.parameter() - p);
            // A value at a point of the curve is found once, at the end of a step.
            let begins = a == 0.0 && branch.points() > 1;
            if a * b > 0.0 || begins {
                continue;
            }
            if let Some(special) = locator.at_parameter(problem, &before, &point, p, interrupt)? {
                try_push(beside, (Beside::At(i), special), CONTEXT)?;
            }
        }
        for is_maximum in [true, false] {
            let (a, b) = (sensed(&before, is_maximum)?, sensed(&point, is_maximum)?);
            if !SpecialPoint::Peak.between(&a, &b) {
                continue;
            }
            problem.set_reciprocal(!is_maximum);
            let special = locator.locate(problem, SpecialPoint::Peak, &a, &b, interrupt);
            problem.set_reciprocal(false);
            if let Some(special) = special? {
                try_push(beside, (Beside::Optimum { is_maximum }, special), CONTEXT)?;
            }
        }
        problem.store(&point, branch, data, None)?;
        if report(hooks, &point, &settings, branch) {
            return Ok(Status::StoppedByCaller);
        }
        if last {
            return Ok(Status::Ok);
        }
        if branch.points() >= most {
            return Ok(Status::StoppedMaxPoints);
        }
        before = point;
    }
}

/// Reports a point of the curve; `true` when the caller requests a stop.
fn report(hooks: &mut Hooks<'_>, point: &Point, settings: &Settings, branch: &Branch) -> bool {
    let share = (point.parameter() - settings.start) / (settings.end - settings.start);
    hooks.report(&Progress {
        point: branch.points(),
        parameter: point.parameter(),
        amplitude: branch.amplitude().last().copied().unwrap_or(0.0),
        residual: point.residual,
        step: point.step,
        fraction_done: share.clamp(0.0, 1.0),
        newton_iterations: point.iterations,
    })
}

/// A point with its amplitude, or for a minimum with the reciprocal of it.
fn sensed(point: &Point, is_maximum: bool) -> Result<Point> {
    let mut copy = point.try_clone()?;
    if !is_maximum {
        let amplitude = point.amplitude.re;
        copy.amplitude = Complex64::from(1.0 / amplitude);
        copy.slope = Complex64::from(-point.slope.re / (amplitude * amplitude));
    }
    Ok(copy)
}
