//! The motion on which the tangents of a law are tested.

use crate::error::{Result, try_copy, try_vec};
use std::f64::consts::TAU;

/// Samples of the test motion.
/// Kind: tuned; measured on: not recorded.
pub(super) const SAMPLES: usize = 64;

pub(super) const CONTEXT: &str = "the test of a Jacobian";

/// Step of a central difference relative to the perturbed variable: at the cube root of the precision its error, of
/// second order, equals rounding.
pub(super) fn step_of(size: f64) -> f64 {
    f64::EPSILON.cbrt() * size
}

/// Periodic motion at which a law is tested: a mean and the harmonics 1 and 3.
pub(super) struct Motion {
    pub omega: f64,
    /// Motions and velocities, samples × d; no velocities for a force that does not depend on them.
    pub u: Vec<f64>,
    pub v: Vec<f64>,
    /// Amplitude of the motion in each of the d directions.
    pub amplitudes: Vec<f64>,
}

impl Motion {
    pub fn new(omega: f64, amplitudes: &[f64], velocity: bool) -> Result<Self> {
        let d = amplitudes.len();
        let mut u = try_vec(SAMPLES.saturating_mul(d), 0.0, CONTEXT)?;
        let mut v = try_vec(if velocity { u.len() } else { 0 }, 0.0, CONTEXT)?;
        for j in 0..SAMPLES {
            for (k, a) in amplitudes.iter().enumerate() {
                let tau = TAU * j as f64 / SAMPLES as f64 + 0.7 * k as f64;
                u[j * d + k] = a * (0.15 + 0.7 * tau.cos() + 0.25 * (3.0 * tau).sin());
                if velocity {
                    v[j * d + k] = omega * a * (-0.7 * tau.sin() + 0.75 * (3.0 * tau).cos());
                }
            }
        }
        Ok(Self {
            omega,
            u,
            v,
            amplitudes: try_copy(amplitudes, CONTEXT)?,
        })
    }

    /// Size of motion k, or of its velocity.
    pub fn size(&self, k: usize, of_velocity: bool) -> f64 {
        self.amplitudes[k] * if of_velocity { self.omega } else { 1.0 }
    }
}

/// Largest magnitude of each of the `width` numbers of a sample.
pub(super) fn sizes(values: &[f64], width: usize) -> Result<Vec<f64>> {
    let mut sizes = try_vec(width, 0.0, CONTEXT)?;
    for sample in values.chunks_exact(width) {
        for (size, x) in sizes.iter_mut().zip(sample) {
            *size = x.abs().max(*size);
        }
    }
    Ok(sizes)
}
