//! A forced response over a parameter of the model: its amplitude at a fixed frequency, or in a peak.

use crate::analysis::forced_response::forced_response;
use crate::continuation::initial_point;
use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Continuation, Point, Settings};
use crate::error::{Result, Status, fail, try_push};
use crate::hooks::Hooks;
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions};
use crate::problem::Problem;
use crate::problem::Residual;
use crate::sensitivity::{Parameter, TrackedPoint, TrackedResponse};
use num_complex::Complex64;

/// What a parameter response follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Follow {
    /// The response at this angular frequency.
    Omega(f64),
    /// The peak next to this angular frequency, within a tenth of it.
    Peak(f64),
}

/// A point of a parameter response.
#[derive(Clone, Copy, Debug)]
pub struct ParameterPoint {
    /// Value of the parameter.
    pub parameter: f64,
    /// Angular frequency.
    pub omega: f64,
    /// Amplitude of the response degree of freedom.
    pub amplitude: f64,
    /// Total derivative of the amplitude by the parameter; NaN where there is none.
    pub d_amplitude: f64,
}

/// A forced response over a parameter.
#[derive(Clone, Debug)]
pub struct ParameterResponse {
    /// The points in the order in which they were found.
    pub points: Vec<ParameterPoint>,
    /// The solutions at each requested value.
    pub at: Vec<Vec<ParameterPoint>>,
    /// Minima and maxima of the amplitude over the parameter, `true` for a maximum.
    pub optima: Vec<(ParameterPoint, bool)>,
    /// [`Status::Ok`] when the whole range was covered.
    pub status: Status,
}

/// Share of a frequency within which its peak is sought.
const NEAR: f64 = 0.1;

/// Follows the amplitude of a forced response over a parameter from `start` to `stop`, at fixed harmonics.
///
/// # Errors
/// Those of [`forced_response`] and of [`Parameter::check`]; `NoConvergence` if there is no peak near the frequency.
pub fn parameter_response(
    model: &Model,
    solver: &SolverOptions,
    parameter: Parameter<'_>,
    (start, stop): (f64, f64),
    at: &[f64],
    follow: Follow,
    hooks: &mut Hooks<'_>,
) -> Result<ParameterResponse> {
    let solver = &solver.fixed();
    parameter.check(model)?;
    check(start, stop, at)?;
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    let first = parameter.applied(model, start)?;
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
            let distance = |p: &crate::results::Special| (p.omega - omega).abs();
            let nearest = branch.peaks().iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
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
    let problem = TrackedResponse::new(
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
    trace(problem, settings, (at, solver.max_points), &interrupt)
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

/// Records the points from the first one on.
fn trace(
    mut problem: TrackedResponse<'_>,
    settings: Settings,
    (at, most): (&[f64], usize),
    interrupt: &Interrupt<'_>,
) -> Result<ParameterResponse> {
    const CONTEXT: &str = "the parameter response";
    let first = initial_point::solve(&mut problem, &settings, interrupt)?.point;
    let mut locator = Locator::new(first.unknowns().len(), settings)?;
    let mut found = ParameterResponse {
        points: Vec::new(),
        at: Vec::new(),
        optima: Vec::new(),
        status: Status::Ok,
    };
    for _ in at {
        try_push(&mut found.at, Vec::new(), CONTEXT)?;
    }
    try_push(&mut found.points, record(&mut problem, &first)?, CONTEXT)?;
    let mut before = first.try_clone()?;
    let mut continuation = Continuation::new(settings, first)?;
    loop {
        let share = (before.parameter() - settings.start) / (settings.end - settings.start);
        interrupt.phase(Phase::Continuation, share.clamp(0.0, 1.0))?;
        let (point, last) = match continuation.advance(&mut problem, interrupt)? {
            Advance::Accepted { point, last } => (point, last),
            Advance::LeftAtStart { .. } => {
                found.status = Status::StoppedLeftRange;
                return Ok(found);
            }
            Advance::Stopped(status) => {
                found.status = status;
                return Ok(found);
            }
        };
        before = continuation.previous().map_or(Ok(before), Point::try_clone)?;
        for (values, &p) in found.at.iter_mut().zip(at) {
            if (before.parameter() - p) * (point.parameter() - p) > 0.0 {
                continue;
            }
            if let Some(special) = locator.at_parameter(&mut problem, &before, &point, p, interrupt)? {
                try_push(values, record(&mut problem, &special)?, CONTEXT)?;
            }
        }
        for is_maximum in [true, false] {
            let (a, b) = (sensed(&before, is_maximum)?, sensed(&point, is_maximum)?);
            if !SpecialPoint::Peak.between(&a, &b) {
                continue;
            }
            problem.set_reciprocal(!is_maximum);
            let special = locator.locate(&mut problem, SpecialPoint::Peak, &a, &b, interrupt);
            problem.set_reciprocal(false);
            if let Some(special) = special? {
                try_push(&mut found.optima, (record(&mut problem, &special)?, is_maximum), CONTEXT)?;
            }
        }
        try_push(&mut found.points, record(&mut problem, &point)?, CONTEXT)?;
        if last {
            return Ok(found);
        }
        if found.points.len() >= most {
            found.status = Status::StoppedMaxPoints;
            return Ok(found);
        }
        before = point;
    }
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

/// The results of a point in the caller's units.
fn record(problem: &mut TrackedResponse<'_>, point: &Point) -> Result<ParameterPoint> {
    let mut at = Residual::new(point.unknowns().len())?;
    problem.evaluate(point.unknowns(), point.parameter(), &mut at)?;
    let TrackedPoint {
        omega,
        amplitude,
        d_amplitude,
    } = problem.point(point.unknowns());
    Ok(ParameterPoint {
        parameter: point.parameter(),
        omega,
        amplitude,
        d_amplitude,
    })
}
