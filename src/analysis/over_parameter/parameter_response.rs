//! A result over a parameter of the model: the amplitude of a forced response at a fixed frequency, in a peak or in a fold,
//! or the largest damping ratio of a nonlinear mode.

use crate::analysis::forced::forced_curve::forced_harmonics;
use crate::analysis::forced_response::forced_response;
use crate::analysis::over_parameter::damping_maximum;
use crate::analysis::over_parameter::followed::Followed;
use crate::analysis::over_parameter::parameter_curve::CurveRecorder;
use crate::analysis::over_parameter::parameter_range::{Follow, ParameterRange, settings, wanted};
use crate::condense::blocks::reduction;
use crate::condense::{Condensed, Reference};
use crate::error::{Error, Result, Status, fail, try_push, try_vec};
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::hooks::Hooks;
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::{ForcedOptions, Range, Response, SolverOptions, check_responses};
use crate::results::motions::recovery;
use crate::results::{Branch, HigherPeak, ParameterData, Special};
use crate::sensitivity::tracked::FirstMotion;
use crate::sensitivity::{FollowedPoint, Parameter, ResponsePoint, TrackedResponse, design, is_corner};

/// Share of a frequency within which its peak or fold is sought.
/// Kind: tuned; measured on: not recorded.
const PARAMETER_RESPONSE_NEAR: f64 = 0.1;

/// Ends of the sweeps in which it is sought, over the frequency, until one meets it: where several motions exist, the one that has it
/// may be reached from one side only, and from afar.
/// Kind: tuned; measured on: not recorded.
const WAYS: [(f64, f64); 4] = [
    (1.0 - PARAMETER_RESPONSE_NEAR, 1.0 + PARAMETER_RESPONSE_NEAR),
    (1.0 + PARAMETER_RESPONSE_NEAR, 1.0 - PARAMETER_RESPONSE_NEAR),
    (0.5, 1.2),
    (1.5, 0.8),
];

/// Share of the rest of the range by which the response is examined beyond the value at which a peak vanished, and share of its
/// frequency within which another peak is sought there.
/// Kind: tuned; measured on: not recorded.
const BEYOND: f64 = 0.02;
const AROUND: f64 = 0.3;

/// Relative excess of an amplitude, and distance of a frequency, of another peak that is higher.
/// Kind: tuned; measured on: not recorded.
const HIGHER: (f64, f64) = (1e-6, 1e-5);

/// Follows a result over a parameter. Steps are controlled by the angle of the curve, so that folds over the parameter are
/// passed. The harmonics are [`SolverOptions::harmonics`] at all points, or at each those that
/// [`SolverOptions::tolerance`] requires.
///
/// A branch that ends early is returned with a positive [`Branch::status`] and every point found: with
/// `StoppedPeakVanished` where a peak, or a maximum of damping, meets a minimum.
///
/// # Errors
/// Those of [`forced_response`], of [`crate::nonlinear_mode`] and of [`Parameter::check`]; `NoConvergence` if there is no
/// peak, fold or maximum of damping near the frequency.
pub fn parameter_response(
    model: &Model,
    solver: &SolverOptions,
    parameter: Parameter<'_>,
    range: &ParameterRange<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    solver.check()?;
    if solver.stability.is_some() {
        return fail!(
            Argument,
            "stability: only a forced response has it along its curve; points over a parameter belong to different models"
        );
    }
    if solver.freedom {
        return fail!(
            Argument,
            "freedom: only a forced response has it along its curve; points over a parameter belong to different models"
        );
    }
    if solver.estimate_error && solver.tolerance == 0.0 {
        return fail!(
            Argument,
            "estimate_error with tolerance = 0: points over a parameter have estimates where a tolerance chooses their harmonics"
        );
    }
    parameter.check(model)?;
    range.check()?;
    let mode = matches!(range.follow, Follow::ModeMaxDamping { .. });
    if mode && range.response.is_some() {
        return fail!(Argument, "response: the largest damping ratio of a mode has none");
    }
    check_responses(range.response.as_slice(), model.ndof(), model.structure().sectors())?;
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    let first = design(model, core::slice::from_ref(&parameter), &[range.start])?;
    let (omega, kind) = match range.follow {
        Follow::Omega(omega) => (omega, ResponsePoint::Fixed),
        Follow::Peak(omega) => (omega, ResponsePoint::Peak),
        Follow::PeakThroughFolds(omega) => (omega, ResponsePoint::Extremum),
        Follow::Fold(omega) => (omega, ResponsePoint::Fold),
        Follow::ModeMaxDamping { omega, log10_range } => {
            if solver.samples > 0 {
                return Err(needs_events(solver.samples));
            }
            let models = (model, &first, parameter);
            return damping_maximum::follow(models, solver, range, (omega, log10_range), hooks, &interrupt);
        }
    };
    if kind != ResponsePoint::Fixed && solver.samples > 0 {
        return Err(needs_events(solver.samples));
    }
    let models = (model, &first, parameter);
    let mut data = ParameterData::default();
    let mut found = follow(models, solver, (range, omega, kind), &mut data, hooks, &interrupt)?;
    if kind == ResponsePoint::Peak && found.status() != Status::StoppedByCaller {
        find_higher_peaks(model, parameter, solver, (&found, range.response), &mut data, hooks)?;
        if found.status() == Status::StoppedPeakVanished {
            let reason = where_next(model, parameter, solver, range, (&found, &data), hooks)?;
            found.set_ending(Status::StoppedPeakVanished, Some(reason), (false, false));
        }
    }
    found.set_parameter_data(data);
    Ok(found)
}

/// The error for a point that is found by second derivatives, which sampled forces do not have.
fn needs_events(samples: usize) -> Error {
    Error::new(
        Status::Argument,
        format_args!(
            "samples = {samples}, needs 0: a peak, a fold or a maximum of damping that is followed needs exact events of contacts"
        ),
    )
}

/// Follows a peak, a fold, or a point at a fixed frequency of a forced response.
fn follow(
    (model, first, parameter): (&Model, &Model, Parameter<'_>),
    solver: &SolverOptions,
    (range, omega, kind): (&ParameterRange<'_>, f64, ResponsePoint),
    data: &mut ParameterData,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Branch> {
    // The limit is that of the curve, not of the search for its first point.
    let seek = SolverOptions {
        max_points: solver.max_points.max(SolverOptions::default().max_points),
        ..*solver
    };
    let watched = range.response.as_slice();
    let mut found = None;
    let ways = if kind == ResponsePoint::Fixed {
        &[(1.0, 1.0)]
    } else {
        &WAYS[..]
    };
    for &ends in ways {
        let branch = match forced_response(first, &seek, &sweep(ends, omega, watched), hooks) {
            Err(e) if e.status == Status::NoConvergence && kind != ResponsePoint::Fixed => continue,
            solved => solved?,
        };
        if branch.status() == Status::StoppedByCaller {
            return Branch::stopped(first, solver);
        }
        if let Some(point) = nearest(&branch, kind, omega) {
            found = Some((branch, point));
            break;
        }
    }
    let Some((branch, point)) = found else {
        let name = match kind {
            ResponsePoint::Fixed => {
                return fail!(NoConvergence, "the response at the start of the range was not found");
            }
            ResponsePoint::Peak | ResponsePoint::Extremum => "peak",
            ResponsePoint::Fold => "fold",
        };
        return fail!(
            NoConvergence,
            "at the start of the range the response has no {name} within {} .. {}",
            (1.0 - PARAMETER_RESPONSE_NEAR) * omega,
            (1.0 + PARAMETER_RESPONSE_NEAR) * omega
        );
    };
    let from = (&branch, point, kind);
    follow_from(
        (model, first, parameter),
        solver,
        (range, range.start),
        from,
        data,
        hooks,
        interrupt,
    )
}

/// Follows a point of a branch that was computed for the first value of the parameter; this value may lie within the
/// range.
pub(crate) fn follow_from(
    (model, first, parameter): (&Model, &Model, Parameter<'_>),
    solver: &SolverOptions,
    (range, begin): (&ParameterRange<'_>, f64),
    (branch, point, kind): (&Branch, usize, ResponsePoint),
    data: &mut ParameterData,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Branch> {
    let Some(omega) = branch.omega_at(point) else {
        return fail!(Internal, "a stored point has no frequency");
    };
    let motion = recovery::relative_motion_at(branch, point, interrupt)?;
    let levels = HarmonicLevels::new(first, solver, &forced_harmonics(first)?, |harmonics, _| {
        let options = SolverOptions { harmonics, ..*solver };
        Condensed::with_reference(first, &options, (omega, omega), Some(Reference::Complex), interrupt)
    })?;
    let own = branch.condensed_at(point);
    let level = levels.level_of(own.set());
    let resolution = levels.at(level)?;
    let mut start = try_vec(resolution.condensed.unknowns(), 0.0, "the parameter response")?;
    resolution.condensed.set().transfer(own.set(), &motion, 1.0, &mut start);
    let options = SolverOptions {
        harmonics: levels.highest(level),
        samples: branch.samples_at(point).max(resolution.samples),
        ..*solver
    };
    let followed = FollowedPoint {
        model,
        parameter,
        response_dof: branch.response_dof(),
        response: range.response,
        kind,
    };
    let first_motion = FirstMotion {
        motion: &start,
        length: own.length(),
        omega,
    };
    let values = Range::new(range.start, range.stop);
    let mut tracked = TrackedResponse::new(followed, &options, values, &first_motion, interrupt)?;
    let settings = settings(solver, range);
    let reduction = reduction::reduction_with(&resolution.condensed, first, solver, 0);
    let highest = if levels.is_automatic() { 0 } else { solver.harmonics };
    let mut found = Branch::new(resolution, reduction, highest, branch.response_dof())?;
    let recorder = CurveRecorder::new(
        Followed::new(&mut tracked, (&levels, level), settings, interrupt),
        (settings, wanted(solver, range, begin)),
        (&mut found, data),
        interrupt,
    );
    let (status, missed) = match recorder.record(hooks) {
        // Its equation has no solution there.
        Err(e) if e.status == Status::NoConvergence && is_peak(kind) && is_corner(branch, point, interrupt)? => {
            return fail!(
                NoConvergence,
                "the peak at angular frequency {omega} is a corner, where a contact begins to slip or to part: it has no zero slope to be \
                 followed by; solve peaks at several values instead"
            );
        }
        recorded => recorded?,
    };
    found.complete_reduction(first, solver);
    found.set_ending(status, None, (false, missed));
    Ok(found)
}

/// Whether a point is one where the slope of the response vanishes.
fn is_peak(kind: ResponsePoint) -> bool {
    matches!(kind, ResponsePoint::Peak | ResponsePoint::Extremum)
}

/// Options of a sweep from `start` to `stop`, both as multiples of a frequency.
fn sweep<'a>((start, stop): (f64, f64), omega: f64, responses: &'a [Response<'a>]) -> ForcedOptions<'a> {
    ForcedOptions {
        omega_start: start * omega,
        omega_stop: stop * omega,
        responses,
        ..ForcedOptions::default()
    }
}

/// Index of the special point of a kind nearest to a frequency; `None` where none is within
/// [`PARAMETER_RESPONSE_NEAR`] of it.
fn nearest(branch: &Branch, kind: ResponsePoint, omega: f64) -> Option<usize> {
    let list = match kind {
        ResponsePoint::Fixed => return (branch.points() > 0).then_some(0),
        ResponsePoint::Peak | ResponsePoint::Extremum => branch.peaks(),
        ResponsePoint::Fold => branch.folds(),
    };
    let distance = |s: &&Special| (s.omega - omega).abs();
    let near = list.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    (distance(&near) <= PARAMETER_RESPONSE_NEAR * omega.abs()).then_some(near.point)
}

/// Explains why a peak vanished: names the highest peak of the response a little beyond the last value, if it has
/// one.
fn where_next(
    model: &Model,
    parameter: Parameter<'_>,
    solver: &SolverOptions,
    range: &ParameterRange<'_>,
    (found, data): (&Branch, &ParameterData),
    hooks: &Hooks<'_>,
) -> Result<Error> {
    let point = found.points().saturating_sub(1);
    let (value, omega) = (data.parameter_at(point), found.omega_at(point));
    let (Some(value), Some(omega)) = (value, omega) else {
        return fail!(Internal, "a peak that vanished has no point");
    };
    let beyond = value + BEYOND * (range.stop - value);
    let design = design(model, core::slice::from_ref(&parameter), &[beyond])?;
    let solver = SolverOptions {
        response_dof: Some(found.response_dof()),
        ..*solver
    };
    let around = ForcedOptions {
        omega_start: (1.0 - AROUND) * omega,
        omega_stop: (1.0 + AROUND) * omega,
        responses: range.response.as_slice(),
        ..ForcedOptions::default()
    };
    let mut quiet = hooks.quiet();
    let branch = forced_response(&design, &solver, &around, &mut quiet).ok();
    let peaks = branch.iter().flat_map(Branch::peaks);
    let status = Status::StoppedPeakVanished;
    Ok(match peaks.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)) {
        Some(peak) => Error::new(
            status,
            format_args!(
                "the peak met a minimum between the values {value} and {beyond}; at {beyond} the highest peak near it has amplitude \
                 {} at omega = {}: go on from start = {beyond} with follow = peak and omega = {}",
                peak.amplitude, peak.omega, peak.omega
            ),
        ),
        None => Error::new(
            status,
            format_args!(
                "the peak met a minimum beyond the value {value}; at {beyond} the response has no peak within {} .. {}",
                around.omega_start, around.omega_stop
            ),
        ),
    })
}

/// Compares the followed peak with the highest one within a tenth of its frequency, at the first and the last point of
/// the curve and at the optima.
fn find_higher_peaks(
    model: &Model,
    parameter: Parameter<'_>,
    solver: &SolverOptions,
    (found, response): (&Branch, Option<Response<'_>>),
    data: &mut ParameterData,
    hooks: &Hooks<'_>,
) -> Result<()> {
    let mut points = Vec::new();
    try_push(&mut points, 0, "the higher peaks")?;
    for optimum in data.optima() {
        try_push(&mut points, optimum.point, "the higher peaks")?;
    }
    if found.points() > 1 {
        try_push(&mut points, found.points() - 1, "the higher peaks")?;
    }
    for point in points {
        let (Some(value), Some(omega)) = (data.parameter_at(point), found.omega_at(point)) else {
            continue;
        };
        let amplitude = found.stored_amplitude(point);
        let design = design(model, core::slice::from_ref(&parameter), &[value])?;
        let solver = SolverOptions {
            response_dof: Some(found.response_dof()),
            ..*solver
        };
        let range = sweep(WAYS[0], omega, response.as_slice());
        let mut quiet = hooks.quiet();
        // A sweep that fails shows no peak.
        let Ok(branch) = forced_response(&design, &solver, &range, &mut quiet) else {
            continue;
        };
        let highest = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
        let excess = HIGHER.0.max(2.0 * solver.tolerance);
        let higher =
            |p: &&Special| p.amplitude > (1.0 + excess) * amplitude && (p.omega / omega - 1.0).abs() > HIGHER.1;
        if let Some(peak) = highest.filter(higher) {
            data.push_higher(HigherPeak {
                point,
                parameter: value,
                omega: peak.omega,
                amplitude: peak.amplitude,
            })?;
        }
    }
    Ok(())
}
