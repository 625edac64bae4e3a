//! The largest damping ratio along a nonlinear mode as a function of a parameter of the model.

use crate::analysis::modes::nonlinear_mode::nonlinear_mode;
use crate::analysis::over_parameter::followed::Followed;
use crate::analysis::over_parameter::parameter_curve::CurveRecorder;
use crate::analysis::over_parameter::parameter_range::{ParameterRange, settings, wanted};
use crate::analysis::over_parameter::tracked_damping::{FollowedDamping, TrackedDamping};
use crate::condense::Condensed;
use crate::condense::blocks::reduction;
use crate::error::{Result, Status, fail, try_vec};
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::Range;
use crate::options::{DampingForm, ModeChoice, ModeOptions, SolverOptions};
use crate::results::stored::mode_branch::ModeData;
use crate::results::{Branch, ParameterData};
use crate::sensitivity::Parameter;
use crate::sensitivity::tracked::FirstMotion;

/// log₁₀ of an amplitude at which every contact that can stick sticks, whatever the units.
/// Kind: fixed.
const STUCK: f64 = -60.0;

/// Distances in log₁₀ from the onset of slip between which the maximum is sought.
/// Kind: tuned; measured on: not recorded.
const FROM_ONSET: (f64, f64) = (-0.1, 3.0);

/// Follows the largest damping ratio from the first value of the parameter, at which the model is `first`.
///
/// # Errors
/// Those of [`nonlinear_mode`]; `Argument` where no contact sticks at small amplitudes and no range was given;
/// `NoConvergence` without a maximum.
pub(crate) fn follow(
    (model, first, parameter): (&Model, &Model, Parameter<'_>),
    solver: &SolverOptions,
    range: &ParameterRange<'_>,
    (omega, log10_range): (f64, Option<(f64, f64)>),
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Branch> {
    let options = |(log10_start, log10_stop): (f64, f64)| ModeOptions {
        choice: ModeChoice::Near(omega),
        log10_start,
        log10_stop,
        ..ModeOptions::default()
    };
    let ends = match log10_range {
        Some(ends) => ends,
        None => match from_onset(first, solver, &options, hooks)? {
            Ok(ends) => ends,
            Err(stopped) => return without_points(first, solver, &stopped),
        },
    };
    // The limit is that of the curve, not of the search for its first point.
    let seek = SolverOptions {
        max_points: solver.max_points.max(SolverOptions::default().max_points),
        ..*solver
    };
    let branch = nonlinear_mode(first, &seek, &options(ends), hooks)?;
    if branch.status() == Status::StoppedByCaller {
        return without_points(first, solver, &branch);
    }
    let Some(data) = branch.mode_data() else {
        return fail!(Internal, "a nonlinear mode has no data of a mode");
    };
    let damping = |point: usize| branch.mode_at(point).map_or(f64::NAN, |at| at.damping_ratio);
    let peaks = branch.peaks().iter().map(|peak| peak.point);
    let Some(point) = peaks.max_by(|&a, &b| damping(a).total_cmp(&damping(b))) else {
        return fail!(
            NoConvergence,
            "at the start of the range the damping ratio has no maximum within 10^{} .. 10^{}",
            ends.0,
            ends.1
        );
    };
    let (Some(omega), Some(motion), Some(at)) =
        (branch.omega_at(point), branch.motion_at(point), branch.mode_at(point))
    else {
        return fail!(Internal, "a stored point has no motion");
    };
    let (linear, gauge) = (&data.linear, &data.gauge);
    let is_loaded = linear.rest.is_loaded();
    let levels = HarmonicLevels::new(first, solver, &[1], |harmonics, _| {
        let options = SolverOptions { harmonics, ..*solver };
        Ok(Condensed::for_mode(
            first,
            &options,
            (DampingForm::Mass, is_loaded),
            &linear.shape,
            interrupt,
        )?
        .0)
    })?;
    let own = branch.condensed_at(point);
    let level = levels.level_of(own.set());
    let resolution = levels.at(level)?;
    let to = resolution.condensed.set();
    let mut begin = try_vec(resolution.condensed.unknowns(), 0.0, "the parameter response")?;
    to.transfer(own.set(), motion, 1.0, &mut begin);
    let options = SolverOptions {
        harmonics: levels.highest(level),
        samples: branch.samples_at(point).max(resolution.samples),
        ..*solver
    };
    let followed = FollowedDamping {
        model,
        parameter,
        response_dof: branch.response_dof(),
        linear,
        gauge,
    };
    let start = FirstMotion {
        motion: &begin,
        length: own.length(),
        omega,
    };
    let values = Range::new(range.start, range.stop);
    let mut tracked = TrackedDamping::new(followed, &options, values, &start, at, to, interrupt)?;
    let settings = settings(solver, range);
    let reduction = reduction::reduction_with(&resolution.condensed, first, solver, 0);
    let highest = if levels.is_automatic() { 0 } else { solver.harmonics };
    let mut found = Branch::new(resolution, reduction, highest, branch.response_dof())?;
    found.set_mode(ModeData::new(
        data.info.clone(),
        linear.clone(),
        gauge.clone(),
        ends.into(),
    ));
    let mut data = ParameterData::default();
    let recorder = CurveRecorder::new(
        Followed::new(&mut tracked, (&levels, level), settings, interrupt),
        (settings, wanted(solver, range, range.start)),
        (&mut found, &mut data),
        interrupt,
    );
    let (status, missed) = recorder.record(hooks)?;
    found.set_parameter_data(data);
    found.complete_reduction(first, solver);
    found.set_ending(status, None, (false, missed));
    Ok(found)
}

/// The result of a run that was stopped while it followed the mode at the first value: it has no point.
fn without_points(first: &Model, solver: &SolverOptions, mode: &Branch) -> Result<Branch> {
    let mut found = Branch::stopped(first, solver)?;
    if let Some(data) = mode.mode_data() {
        let ends = Range::new(STUCK, STUCK + 1.0);
        found.set_mode(ModeData::new(
            data.info.clone(),
            data.linear.clone(),
            data.gauge.clone(),
            ends,
        ));
    }
    found.set_parameter_data(ParameterData::default());
    Ok(found)
}

/// Range of amplitude, as log₁₀, about the onset of slip; or the branch of a mode that was stopped.
fn from_onset<'a>(
    first: &Model,
    solver: &SolverOptions,
    options: &impl Fn((f64, f64)) -> ModeOptions<'a>,
    hooks: &mut Hooks<'_>,
) -> Result<core::result::Result<(f64, f64), Branch>> {
    let one_point = SolverOptions {
        max_points: 1,
        ..*solver
    };
    let onset = match nonlinear_mode(first, &one_point, &options((STUCK, STUCK + 1.0)), hooks) {
        Ok(branch) if branch.status() == Status::StoppedByCaller => return Ok(Err(branch)),
        Ok(branch) => branch.mode_data().map(|data| data.info.linear_up_to),
        Err(e) if e.status == Status::NoConvergence => None,
        Err(e) => return Err(e),
    };
    match onset {
        Some(onset) if onset.is_finite() => Ok(Ok((onset + FROM_ONSET.0, onset + FROM_ONSET.1))),
        _ => fail!(
            Argument,
            "no contact is known to stick at small amplitudes: set the range of log10 of the amplitude in which the damping is largest"
        ),
    }
}
