//! Derivatives of a complex amplitude at a stored point of a forced response by parameters of the model.
//!
//! The real and the imaginary part have an adjoint solution each, from one factorised Newton matrix, for all parameters.

use crate::error::{Result, fail, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::Range;
use crate::options::{Measure, Response};
use crate::results::Branch;
use crate::sensitivity::{
    ForcedPoint, Parameter, Reason, SampledModel, TotalDerivative, WaveMatrices, contact_at_onset,
};
use num_complex::Complex64;
use std::borrow::Cow;

const CONTEXT: &str = "the derivatives of a complex amplitude";

/// A complex amplitude with its derivatives.
#[derive(Clone, Debug)]
pub struct ComplexSensitivities {
    /// Complex amplitude X of the response.
    pub value: Complex64,
    /// Derivative dX/dω along the branch.
    pub by_omega: Complex64,
    /// Derivatives dX/dp at a fixed frequency, one for each parameter; NaN where one does not exist.
    pub values: Vec<Complex64>,
    /// Reason of each derivative that is NaN.
    pub reasons: Vec<Reason>,
}

/// Derivatives of the complex amplitude of a response at a stored point of a forced response by parameters of the
/// model, which must be the one with which the branch was computed. The branch need not have watched the response.
/// Its measure is the fundamental or a harmonic; without degrees of freedom it reads the response degree of freedom.
/// Derivatives are exact for the harmonics of the point.
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

/// Computes derivatives as [`complex_sensitivity`], and the caller may stop it.
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
    let mut matrices = WaveMatrices::default();
    let at = (branch, point);
    let omega = branch.omega_at(point).unwrap_or_default();
    let mut equations = Equations {
        range: omega.into(),
        at: None,
    };
    complex_at(
        model,
        at,
        response,
        (parameters, &mut matrices),
        (true, &mut equations, interrupt),
    )
}

/// Equations near the points of a curve for which derivatives were made, with the range of frequency in which they
/// hold.
pub(crate) struct Equations<'a> {
    pub range: Range,
    /// Equations of the last point; `None` before the first.
    pub at: Option<ForcedPoint<'a>>,
}

impl<'a> Equations<'a> {
    /// The equations of a point that watch a response; the last ones are used again where they are valid.
    fn of(
        &mut self,
        branch: &'a Branch,
        point: usize,
        response: &Response<'_>,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<&mut ForcedPoint<'a>> {
        let (condensed, samples) = (branch.condensed_at(point), branch.samples_at(point));
        let at = match self.at.take() {
            Some(at) if at.are_of(condensed, samples) => at,
            _ => {
                let dof = branch.response_dof();
                let at = ForcedPoint::over(condensed, dof, samples, self.range, interrupt)?;
                at.watching(response, dof, samples)?
            }
        };
        Ok(self.at.insert(at))
    }

    /// The complex amplitude of a response at a stored point.
    ///
    /// # Errors
    /// As [`complex_sensitivity_with`].
    pub fn amplitude(
        &mut self,
        (branch, point): (&'a Branch, usize),
        response: &Response<'_>,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Complex64> {
        let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
            return fail!(Index, "point = {point}, needs 0 .. {}", branch.stored());
        };
        self.of(branch, point, response, interrupt)?
            .complex_amplitude(motion, omega)
    }
}

/// Computes derivatives without checks. Without `two_sided`, a contact at the onset of slip has the derivatives of
/// the side that its evaluation takes. The structure's matrices are kept in `matrices` for further points of the
/// model, and the equations in `equations` for those of the branch and the response.
///
/// # Errors
/// As [`complex_sensitivity_with`].
pub(crate) fn complex_at<'a>(
    model: &Model,
    (branch, point): (&'a Branch, usize),
    response: &Response<'_>,
    (parameters, matrices): (&[Parameter<'_>], &mut WaveMatrices),
    (two_sided, equations, interrupt): (bool, &mut Equations<'a>, &'a Interrupt<'a>),
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
            "a contact is rigid or near-rigid, and its motion at this point is that of a rigid one; derivatives need a finite kt and a branch of fixed \
             harmonics, tolerance = 0"
        );
    }
    let at = equations.of(branch, point, response, interrupt)?;
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
    let solution = SampledModel { condensed, samples };
    if two_sided && let Some(contact) = contact_at_onset(&at_frequency, solution, &real, interrupt)? {
        found.reasons.fill(Reason::OnsetOfSlip { contact });
        return Ok(found);
    }
    // The matrices at a frequency hold there alone.
    let mut own = WaveMatrices::default();
    let matrices = match &at_frequency {
        Cow::Borrowed(_) => matrices,
        Cow::Owned(_) => &mut own,
    };
    let of_real = TotalDerivative::new(model, &at_frequency, solution, &real, interrupt)?;
    let mut of_real = of_real.with_matrices(core::mem::take(matrices));
    for ((value, reason), parameter) in found.values.iter_mut().zip(&mut found.reasons).zip(parameters) {
        (value.re, *reason) = of_real.by(parameter)?;
    }
    *matrices = of_real.into_matrices();
    let of_imaginary = TotalDerivative::new(model, &at_frequency, solution, &imaginary, interrupt)?;
    let mut of_imaginary = of_imaginary.with_matrices(core::mem::take(matrices));
    for (value, parameter) in found.values.iter_mut().zip(parameters) {
        value.im = of_imaginary.by(parameter)?.0;
    }
    *matrices = of_imaginary.into_matrices();
    Ok(found)
}
