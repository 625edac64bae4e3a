//! Error of stored points, see [`crate::harmonics`].

use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::{Artificial, Condensed, ModelCache};
use crate::error::{Result, fail, try_push};
use crate::harmonics::forced_response_error::ForcedEstimator;
use crate::harmonics::mode_error::{ModeEstimator, ModeState, NO_DAMPING};
use crate::harmonics::{Estimate, Solved};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{Content, DampingForm, Response, SolverOptions};
use crate::results::Branch;
use num_complex::Complex64;

/// Newton iterations by which the work is bounded: those of a point that is solved by homotopy.
/// Kind: cap.
const POINT_ERROR_ITERATIONS: usize = 200;

/// Estimates the error of a stored point of a branch by the harmonics that it neglects. `model` and `solver` are
/// those of the computation of the branch.
///
/// The estimate solves, once or a few times, the linear equations of a problem with more harmonics: at least twice
/// as many, and all in which the structure is compliant. If that exceeds the limits, or does not converge, the
/// estimate is not certified and its errors are NaN.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model or other options than those of the branch, `Callback`
/// for a law of the caller that fails, `OutOfMemory`.
pub fn estimate_at(model: &Model, solver: &SolverOptions, branch: &Branch, point: usize) -> Result<Estimate> {
    estimate_at_with(model, solver, branch, point, &Interrupt::none())
}

/// Estimates the error of a stored point as [`estimate_at`], and the caller may stop it.
///
/// # Errors
/// As [`estimate_at`]; `StoppedByCaller`.
pub fn estimate_at_with(
    model: &Model,
    solver: &SolverOptions,
    branch: &Branch,
    point: usize,
    interrupt: &Interrupt<'_>,
) -> Result<Estimate> {
    solver.check()?;
    branch.check_model(model)?;
    let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    };
    let samples = branch.samples_at(point);
    if solver.tolerance == 0.0 && (solver.harmonics != branch.harmonics() || solver.samples != samples) {
        return fail!(
            Argument,
            "the branch has harmonics = {} and samples = {samples}, the options {} and {}",
            branch.harmonics(),
            solver.harmonics,
            solver.samples
        );
    }
    // A guess may have had more harmonics than forces excite.
    let set = branch.condensed_at(point).set();
    let content = Content {
        base: set.base(),
        even: !set.is_odd(),
    };
    let solver = &SolverOptions {
        samples,
        exchange: branch.condensed_at(point).exchanged(),
        content,
        ..*solver
    };
    let condensed = branch.condensed_at(point);
    let (responses, watched) = watched(branch, point)?;
    let solved = Solved {
        condensed,
        motion,
        omega,
        response: branch
            .response_at(point)
            .and_then(|x| x.get(observed(condensed)))
            .copied()
            .unwrap_or(Complex64::ZERO),
        watched: &watched,
        together: branch.together(),
        sticks: None,
        iterations: POINT_ERROR_ITERATIONS,
    };
    let models = (&ModelCache::for_estimates()?, &SharedWaves::default());
    let Some((data, at)) = branch.mode_data().zip(branch.mode_at(point)) else {
        let estimator = ForcedEstimator::new(model, solver, branch.response_dof(), models, interrupt);
        return estimator.watching(&responses).at(&solved);
    };
    let wave;
    let model = if model.structure().engine_order() == data.info.engine_order {
        model
    } else {
        let mut other = model.try_clone()?;
        other.set_wave(data.info.engine_order);
        wave = other;
        &wave
    };
    let form = match condensed.blocks().first().map(|b| &b.matrices.artificial) {
        Some(Artificial::Stiffness(_)) => DampingForm::Stiffness,
        _ => DampingForm::Mass,
    };
    let start = (&data.linear, &data.gauge);
    let mut estimator = ModeEstimator::new((model, solver), form, start, branch.response_dof(), models, interrupt);
    estimator.at(
        &solved,
        ModeState {
            log10_amplitude: at.log10_amplitude,
            damping: at.damping_ratio,
            damping_unit: at.damping_ratio.abs().max(NO_DAMPING),
        },
    )
}

/// The responses of a branch, and their values at a point as an estimate watches them.
fn watched(branch: &Branch, point: usize) -> Result<(Vec<Response<'_>>, Vec<Complex64>)> {
    let (mut responses, mut values) = (Vec::new(), Vec::new());
    for series in branch.responses() {
        let complex = series.complex()[point];
        let value = if complex.re.is_nan() {
            series.values()[point].into()
        } else {
            complex
        };
        try_push(&mut responses, series.response(), "the responses")?;
        try_push(&mut values, value, "the responses")?;
    }
    Ok((responses, values))
}

/// Index of the carried harmonic whose amplitude a forced response reports: the lowest above zero.
pub(crate) fn observed(condensed: &Condensed) -> usize {
    condensed.set().watched()
}
