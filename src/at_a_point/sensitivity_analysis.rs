//! Derivatives of a result at a stored point by parameters of the model; see [`crate::sensitivity`].

use crate::error::{Result, fail, try_copy, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::results::{Branch, ResponseSeries};
use crate::sensitivity::{
    Adjoint, ModePointAdjoint, ModeQuantity, Parameter, Reason, SampledModel, TotalDerivative, contact_at_onset,
    is_steep, peak_shift, stored_point,
};
use std::borrow::Cow;

const CONTEXT: &str = "the sensitivities";

/// Result at a stored point that is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Amplitude of a forced response at a fixed frequency.
    Amplitude,
    /// Amplitude of a peak, which moves with the parameters.
    PeakAmplitude,
    /// Angular frequency of a peak.
    PeakOmega,
    /// A requested response with this index, at a fixed frequency or at one of its peaks, which moves with the
    /// parameters.
    Response(usize),
    /// Angular frequency of a peak of the response with this index.
    ResponsePeakOmega(usize),
    /// Angular frequency of a nonlinear mode at a fixed amplitude.
    ModeOmega,
    /// Damping ratio of a nonlinear mode at a fixed amplitude; at its maximum also the derivative of the maximum.
    ModeDamping,
}

/// Derivatives of a result by parameters, in their order.
#[derive(Clone, Debug)]
pub struct Sensitivities {
    /// Derivative by each parameter; NaN where it does not exist.
    pub values: Vec<f64>,
    /// Reason of each derivative that is NaN.
    pub reasons: Vec<Reason>,
}

/// Derivatives of a result at a stored point of a branch by parameters of the model, which must be the one with which
/// the branch was computed.
///
/// One adjoint solution gives the derivatives by all parameters; the frequency of a peak, and the amplitude of one that is a
/// corner, take five. They are exact for
/// the harmonics of the point: those of the contact forces follow from the exact events of their evaluation.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model than that of the branch, and for a
/// result that the point does not have; those of [`Parameter::check`], naming the parameter; `OutOfMemory`.
pub fn sensitivity(
    model: &Model,
    branch: &Branch,
    point: usize,
    parameters: &[Parameter<'_>],
    of: Quantity,
) -> Result<Sensitivities> {
    sensitivity_with(model, branch, point, parameters, of, &Interrupt::none())
}

/// Computes derivatives as [`sensitivity`], and the caller may stop it.
///
/// # Errors
/// As [`sensitivity`]; `StoppedByCaller`.
pub fn sensitivity_with(
    model: &Model,
    branch: &Branch,
    point: usize,
    parameters: &[Parameter<'_>],
    of: Quantity,
    interrupt: &Interrupt<'_>,
) -> Result<Sensitivities> {
    let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    };
    branch.check_model(model)?;
    check_quantity(branch, point, of)?;
    if branch.condensed_at(point).has_exchanges() {
        return fail!(
            Unsupported,
            "a contact is rigid or near-rigid, and its motion at this point is that of a rigid one; derivatives need a finite kt and a branch of \
             fixed harmonics, tolerance = 0"
        );
    }
    for (i, parameter) in parameters.iter().enumerate() {
        parameter
            .check(model)
            .map_err(|e| e.at(format_args!("parameter {i}")))?;
    }
    interrupt.phase(Phase::Results, 0.0)?;
    let of_wave = of_wave(model, branch)?;
    let model = &*of_wave;
    let at_frequency = model.at_frequency(omega)?;
    let solution = SampledModel::at(branch, point);
    let absent = |reason| -> Result<Sensitivities> {
        Ok(Sensitivities {
            values: try_vec(parameters.len(), f64::NAN, CONTEXT)?,
            reasons: try_vec(parameters.len(), reason, CONTEXT)?,
        })
    };
    if branch.folds().iter().any(|fold| fold.point == point) && !is_frequency(of) {
        return absent(Reason::Fold);
    }
    let mut forced = None;
    let adjoint = if let Some((data, at)) = branch.mode_data().zip(branch.mode_at(point)) {
        let quantity = match of {
            Quantity::ModeOmega => ModeQuantity::Omega,
            _ => ModeQuantity::Damping,
        };
        let at = ModePointAdjoint {
            condensed: solution.condensed,
            linear: &data.linear,
            gauge: &data.gauge,
            samples: solution.samples,
            motion,
            omega,
            point: at,
        };
        at.solve(quantity, interrupt)?
    } else {
        forced
            .insert(stored_point(branch, point, omega, watched(branch, of), interrupt)?)
            .adjoint(motion, omega)?
    };
    let Some(adjoint) = adjoint else {
        return absent(Reason::Fold);
    };
    if let Some(contact) = contact_at_onset(&at_frequency, solution, &adjoint, interrupt)? {
        return absent(Reason::OnsetOfSlip { contact });
    }
    let mut found = absent(Reason::Exists)?;
    let derivatives = |adjoint: &Adjoint, values: &mut [f64], reasons: &mut [Reason]| -> Result<()> {
        let mut total = TotalDerivative::new(model, &at_frequency, solution, adjoint, interrupt)?;
        for ((value, reason), parameter) in values.iter_mut().zip(reasons).zip(parameters) {
            (*value, *reason) = total.by(parameter)?;
        }
        Ok(())
    };
    match &mut forced {
        Some(at) if is_frequency(of) => {
            let mut reasons = try_copy(&found.reasons, CONTEXT)?;
            let amplitude = peak_amplitude(branch, of, point).unwrap_or(f64::NAN);
            found.values = peak_shift(at, motion, omega, amplitude, parameters.len(), |adjoint, values| {
                derivatives(adjoint, values, &mut reasons)
            })?;
            found.reasons = reasons;
        }
        _ => derivatives(&adjoint, &mut found.values, &mut found.reasons)?,
    }
    if let Some((at, amplitude)) = forced.as_mut().zip(peak_amplitude(branch, of, point))
        && !is_frequency(of)
        && is_steep(omega, adjoint.by_omega, amplitude)
    {
        let mut reasons = try_copy(&found.reasons, CONTEXT)?;
        let shift = peak_shift(at, motion, omega, amplitude, parameters.len(), |adjoint, values| {
            derivatives(adjoint, values, &mut reasons)
        })?;
        found.go_along(adjoint.by_omega, &shift);
    }
    Ok(found)
}

/// The model in the wave of a nonlinear mode.
fn of_wave<'m>(model: &'m Model, branch: &Branch) -> Result<Cow<'m, Model>> {
    match branch.mode_data() {
        Some(data) if data.info.engine_order != model.structure().engine_order() => {
            let mut other = model.try_clone()?;
            other.set_wave(data.info.engine_order);
            Ok(Cow::Owned(other))
        }
        _ => Ok(Cow::Borrowed(model)),
    }
}

impl Sensitivities {
    /// Makes derivatives at a fixed frequency those of a corner, which goes along the slope of its side by the `shift` of its frequency:
    /// dA*/dp = ∂A/∂p + ∂A/∂ω dω*/dp.
    fn go_along(&mut self, slope: f64, shift: &[f64]) {
        for ((value, reason), shift) in self.values.iter_mut().zip(&mut self.reasons).zip(shift) {
            *value += slope * shift;
            if *reason == Reason::Exists && value.is_nan() {
                *reason = Reason::Fold;
            }
        }
    }
}

/// Whether a result is the frequency of a peak.
fn is_frequency(of: Quantity) -> bool {
    matches!(of, Quantity::PeakOmega | Quantity::ResponsePeakOmega(_))
}

/// The response that is differentiated, where it is not the amplitude of the response degree of freedom.
fn watched(branch: &Branch, of: Quantity) -> Option<&ResponseSeries> {
    match of {
        Quantity::Response(r) | Quantity::ResponsePeakOmega(r) => branch.responses().get(r),
        // The first response leads the amplitude and the peaks of the branch.
        _ => branch.responses().first().filter(|first| !first.response().is_plain()),
    }
}

/// Amplitude of the peak whose result is differentiated; `None` where it is one at a fixed frequency.
fn peak_amplitude(branch: &Branch, of: Quantity, point: usize) -> Option<f64> {
    let peaks = match of {
        Quantity::ResponsePeakOmega(r) | Quantity::Response(r) => branch.responses()[r].peaks(),
        Quantity::PeakAmplitude | Quantity::PeakOmega => branch.peaks(),
        _ => return None,
    };
    peaks.iter().find(|p| p.point == point).map(|p| p.amplitude)
}

/// Refuses a result that the point does not have.
fn check_quantity(branch: &Branch, point: usize, of: Quantity) -> Result<()> {
    let is_mode = branch.mode_data().is_some();
    match of {
        Quantity::ModeOmega | Quantity::ModeDamping if !is_mode => {
            fail!(
                Argument,
                "the branch is a forced response, which has no frequency or damping of a mode"
            )
        }
        Quantity::Response(r) | Quantity::ResponsePeakOmega(r) if r >= branch.responses().len() => {
            fail!(
                Argument,
                "response {r} of a branch that was asked for {}",
                branch.responses().len()
            )
        }
        Quantity::ResponsePeakOmega(r) if !branch.responses()[r].peaks().iter().any(|p| p.point == point) => {
            fail!(Argument, "point = {point} is no peak of response {r}")
        }
        Quantity::Amplitude | Quantity::PeakAmplitude | Quantity::PeakOmega if is_mode => {
            fail!(
                Argument,
                "the branch is a nonlinear mode, whose amplitude is its parameter: needs mode_omega or mode_damping"
            )
        }
        Quantity::PeakAmplitude | Quantity::PeakOmega if !branch.peaks().iter().any(|p| p.point == point) => {
            fail!(Argument, "point = {point} is no peak of the branch")
        }
        _ => Ok(()),
    }
}
