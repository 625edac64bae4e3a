//! Derivatives of a complex amplitude at a stored point of a forced response by parameters of the model.
//!
//! The real and the imaginary part have an adjoint solution each, from one factorised Newton matrix, for all parameters.

use crate::error::{Result, fail, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::{Measure, Response};
use crate::results::Branch;
use crate::sensitivity::{ForcedPoint, Parameter, Reason, TotalDerivative, contact_at_onset};
use num_complex::Complex64;

const CONTEXT: &str = "the derivatives of a complex amplitude";

/// A complex amplitude with its derivatives.
#[derive(Clone, Debug)]
pub struct ComplexSensitivities {
    /// The amplitude X.
    pub value: Complex64,
    /// dX/dω along the branch.
    pub by_omega: Complex64,
    /// dX/dp at a fixed frequency, one for each parameter; NaN where there is none.
    pub values: Vec<Complex64>,
    /// The reasons of NaN.
    pub reasons: Vec<Reason>,
}

/// Derivatives of the complex amplitude of a response at a stored point of a forced response by parameters of the model, which must be
/// that of the computation of the branch. The branch need not have watched the response, whose measure is the fundamental or a harmonic;
/// without degrees of freedom it is that of the response degree of freedom. They are exact for the harmonics of the point.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model than that of the branch and for another measure, `Unsupported` for a
/// nonlinear mode and for a point with near-rigid contacts; those of [`Parameter::check`] and [`Response::check`]; `OutOfMemory`.
pub fn complex_sensitivity(
    model: &Model,
    branch: &Branch,
    point: usize,
    response: &Response<'_>,
    parameters: &[Parameter<'_>],
) -> Result<ComplexSensitivities> {
    complex_sensitivity_with(model, branch, point, response, parameters, &Interrupt::none())
}

/// The same as [`complex_sensitivity`], and the caller may stop it.
///
/// # Errors
/// As [`complex_sensitivity`]; `StoppedByCaller`.
pub fn complex_sensitivity_with(
    model: &Model,
    branch: &Branch,
    point: usize,
    response: &Response<'_>,
    parameters: &[Parameter<'_>],
    interrupt: &Interrupt<'_>,
) -> Result<ComplexSensitivities> {
    if point >= branch.stored() {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    }
    branch.check_model(model)?;
    response.check(model.ndof(), model.structure().sectors())?;
    if !matches!(response.measure, Measure::Fundamental | Measure::Harmonic(_)) {
        return fail!(
            Argument,
            "the measure of the response has no complex amplitude; needs the fundamental or a harmonic"
        );
    }
    for (i, parameter) in parameters.iter().enumerate() {
        parameter
            .check(model)
            .map_err(|e| e.at(format_args!("parameter {i}")))?;
    }
    interrupt.phase(Phase::Results, 0.0)?;
    complex_at(model, (branch, point), response, parameters, (true, interrupt))
}

/// The same without checks; without `two_sided` a contact at the onset of slip has the derivatives of the side that its evaluation takes.
///
/// # Errors
/// As [`complex_sensitivity_with`].
pub(super) fn complex_at(
    model: &Model,
    (branch, point): (&Branch, usize),
    response: &Response<'_>,
    parameters: &[Parameter<'_>],
    (two_sided, interrupt): (bool, &Interrupt<'_>),
) -> Result<ComplexSensitivities> {
    let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
        return fail!(Index, "point = {point}, needs 0 .. {}", branch.stored());
    };
    let (condensed, samples) = (branch.condensed_at(point), branch.samples_at(point));
    if branch.mode_data().is_some() {
        return fail!(
            Unsupported,
            "the branch is a nonlinear mode, whose phase is free; take the derivatives of its frequency and damping"
        );
    }
    if condensed.has_exchanges() {
        return fail!(
            Unsupported,
            "a contact is near-rigid, and its motion at this point is that of a rigid one; derivatives need a branch of fixed \
             harmonics, tolerance = 0"
        );
    }
    let dof = branch.response_dof();
    let at = ForcedPoint::new(condensed, (dof, samples), omega, interrupt)?;
    let mut at = at.watching((response, dof), samples)?;
    let nothing = Complex64::new(f64::NAN, f64::NAN);
    let mut found = ComplexSensitivities {
        value: nothing,
        by_omega: nothing,
        values: try_vec(parameters.len(), nothing, CONTEXT)?,
        reasons: try_vec(parameters.len(), Reason::Fold, CONTEXT)?,
    };
    let Some((value, [real, imaginary])) = at.parts(motion, omega)? else {
        return Ok(found);
    };
    found.value = value;
    if branch.folds().iter().any(|fold| fold.point == point) {
        return Ok(found);
    }
    found.by_omega = Complex64::new(real.by_omega, imaginary.by_omega);
    let at_frequency = model.at_frequency(omega)?;
    let solution = (condensed, samples);
    if two_sided && let Some(contact) = contact_at_onset(&at_frequency, solution, &real, interrupt)? {
        found.reasons.fill(Reason::OnsetOfSlip { contact });
        return Ok(found);
    }
    let models = (model, &*at_frequency);
    let mut of_real = TotalDerivative::new(models, solution, &real, interrupt)?;
    let mut of_imaginary = TotalDerivative::new(models, solution, &imaginary, interrupt)?;
    for ((value, reason), parameter) in found.values.iter_mut().zip(&mut found.reasons).zip(parameters) {
        (value.re, *reason) = of_real.by(parameter)?;
        value.im = of_imaginary.by(parameter)?.0;
    }
    Ok(found)
}
