//! The responses of a branch, read from a motion in time.

use crate::analysis::in_time::record_peak::{over, peak};
use crate::analysis::in_time::time_response::TimeResponse;
use crate::error::{Result, try_push, try_vec};
use crate::fourier::{HarmonicSet, Reader};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{Component, Measure, Response};
use crate::results::Branch;
use num_complex::Complex64;
use std::f64::consts::TAU;

const CONTEXT: &str = "the responses in time";

/// A response of a point, as integration in time finds it.
#[derive(Clone, Copy, Debug)]
pub struct VerifiedResponse {
    /// Measure of the response in time. Displacements of sector 0 are read at the times of the integration; those of
    /// other sectors, velocities and accelerations are computed from the harmonics 0 ..= H.
    pub value: f64,
    /// Difference between the point and the motion in time, relative to the latter: of complex amplitudes where the
    /// measure has such.
    pub error: f64,
}

/// The responses of a stored point in time, at the angular frequency ω, in the order of the branch.
pub(crate) fn verified(
    (model, branch, point): (&Model, &Branch, usize),
    omega: f64,
    (time, harmonic): (&TimeResponse, usize),
    interrupt: &Interrupt<'_>,
) -> Result<Vec<VerifiedResponse>> {
    let mut found = Vec::new();
    for own in branch.responses() {
        let response = own.response();
        let harmonics = harmonics(model, &response, omega, time)?;
        let number = match response.measure {
            Measure::Fundamental => Some(harmonic),
            Measure::Harmonic(number) => Some(number),
            Measure::Peak | Measure::Rms | Measure::Range => None,
        };
        let from_times = response.component == Component::Displacement && response.sector == 0;
        let one = if let Some(number) = number {
            let value = harmonics.get(number).copied().unwrap_or(Complex64::ZERO);
            VerifiedResponse {
                value: value.norm(),
                error: over((own.complex()[point] - value).norm(), value.norm()),
            }
        } else {
            let value = if from_times {
                measured(response.measure, &gauge(&response, time)?)
            } else {
                read(response.measure, &harmonics, interrupt)?
            };
            VerifiedResponse {
                value,
                error: over((own.values()[point] - value).abs(), value),
            }
        };
        try_push(&mut found, one, CONTEXT)?;
    }
    Ok(found)
}

/// Harmonics 0 ..= H of a response (the sum Σ w x) in time.
fn harmonics(model: &Model, response: &Response<'_>, omega: f64, time: &TimeResponse) -> Result<Vec<Complex64>> {
    let mut found = Vec::new();
    let sectors = model.structure().sectors().max(1) as f64;
    let turn = TAU * (model.structure().engine_order() as f64) * response.sector as f64 / sectors;
    for (h, x) in time.harmonics.chunks_exact(time.ndof).enumerate() {
        let rate = Complex64::new(0.0, h as f64 * omega).powi(response.component.order());
        let sum = weighted(response, |dof| x[dof]);
        try_push(&mut found, sum * rate * Complex64::cis(h as f64 * turn), CONTEXT)?;
    }
    Ok(found)
}

/// Weighted sum Σ w x over the degrees of freedom of a response.
fn weighted<T>(response: &Response<'_>, x: impl Fn(usize) -> T) -> T
where
    T: core::iter::Sum + core::ops::Mul<f64, Output = T>,
{
    let weight = |k: usize| response.weights.get(k).copied().unwrap_or(1.0);
    response
        .dofs
        .iter()
        .enumerate()
        .map(|(k, dof)| x(*dof) * weight(k))
        .sum()
}

/// Values of a response (the sum Σ w x) at the times of a period.
fn gauge(response: &Response<'_>, time: &TimeResponse) -> Result<Vec<f64>> {
    let mut values = Vec::new();
    for x in time.samples.chunks_exact(time.ndof) {
        try_push(&mut values, weighted(response, |dof| x[dof]), CONTEXT)?;
    }
    Ok(values)
}

/// The measure of a signal that is given by its harmonics.
fn read(measure: Measure, harmonics: &[Complex64], interrupt: &Interrupt<'_>) -> Result<f64> {
    let set = HarmonicSet::all(harmonics.len().saturating_sub(1))?;
    let mut packed = try_vec(set.packed_len(), 0.0, CONTEXT)?;
    for (h, x) in harmonics.iter().enumerate() {
        set.set(&mut packed, h, *x);
    }
    Ok(Reader::new(&set)?.read(&set, measure, &packed, interrupt)?.value)
}

fn measured(measure: Measure, gauge: &[f64]) -> f64 {
    let times = gauge.len();
    let largest = |sign: f64| {
        let least = gauge.iter().fold(f64::INFINITY, |m, x| m.min(sign * x));
        // Shifted above zero, the largest value is the largest magnitude.
        peak(times, |i| sign * gauge[i] - least) + least
    };
    match measure {
        Measure::Rms => (gauge.iter().map(|x| x * x).sum::<f64>() / times.max(1) as f64).sqrt(),
        Measure::Range => largest(1.0) + largest(-1.0),
        _ => largest(1.0).max(largest(-1.0)),
    }
}
