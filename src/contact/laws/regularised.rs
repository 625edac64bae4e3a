//! Friction with the jump of Coulomb's law smoothed: f = limit·tanh(v/v₀).
//!
//! The law creeps where Coulomb's sticks. Its Fourier coefficients fall off as e^{−nδ} with
//! sinh δ = π·v₀/(2V) for a motion of one harmonic of velocity V, the distance of the nearest pole
//! of tanh from the real axis of τ; N samples leave an error of about e^{−(N−H)δ}. The number of
//! samples hence depends on V/v₀, which only the solution tells.

use crate::contact::law::{Form, Law, Range, SMALL};
use crate::contact::memoryless_law::{Memoryless, Samples, automatic_samples};
use crate::error::{Result, fail};

/// Finer sampling than a law of unknown form gets, for the steep passage through v = 0.
const REFINEMENT: usize = 4;

/// Constants of regularised friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TanhFriction {
    limit: f64,
    velocity: f64,
    /// limit/velocity, which units do not change.
    damping: f64,
}

impl TanhFriction {
    /// Friction of slip limit `limit` ≥ 0 that reaches 76 % of it (tanh 1) at the velocity `velocity`
    /// > 0. Unless samples are asked for it takes four times as many as [`automatic_samples`] has.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the constant, its value and its range.
    pub fn new(limit: f64, velocity: f64) -> Result<Self> {
        for (name, value) in [("limit", limit), ("reference velocity", velocity)] {
            if !value.is_finite() {
                return fail!(
                    NotFinite,
                    "regularised friction: {name} = {value}, needs a finite number"
                );
            }
        }
        if limit < 0.0 {
            return fail!(Argument, "regularised friction: limit = {limit}, needs a number >= 0");
        }
        if velocity <= 0.0 {
            return fail!(
                Argument,
                "regularised friction: reference velocity = {velocity}, needs a number > 0"
            );
        }
        let damping = limit / velocity;
        if !damping.is_finite() {
            return fail!(
                NotFinite,
                "regularised friction: limit / reference velocity = {damping}, needs a finite number"
            );
        }
        Ok(Self {
            limit,
            velocity,
            damping,
        })
    }

    /// The law in units of `length` of its present unit: x = length·x̂, f = length·f̂.
    #[must_use]
    pub fn in_units(&self, length: f64) -> Self {
        Self {
            limit: self.limit / length,
            velocity: self.velocity / length,
            ..*self
        }
    }
}

impl Law for TanhFriction {
    fn is_odd(&self) -> bool {
        true
    }

    fn form(&self) -> Form<'_> {
        Form::Memoryless(self)
    }

    /// tanh r = r − r³/3 + …
    fn linearisation_scale(&self, ranges: &[Range], _reference: f64) -> f64 {
        ranges[0].speed / (self.velocity * (3.0 * SMALL).sqrt())
    }
}

impl Memoryless for TanhFriction {
    fn uses_velocity(&self) -> bool {
        true
    }

    fn samples(&self, highest: usize, asked: usize) -> usize {
        match asked {
            0 => automatic_samples(highest).saturating_mul(REFINEMENT),
            n => n,
        }
    }

    fn evaluate(&self, _omega: f64, _samples: usize, _u: &[f64], v: &[f64], out: Samples<'_>) -> Result<()> {
        for ((f, df), v) in out.f.iter_mut().zip(out.df_dv).zip(v) {
            let ratio = v / self.velocity;
            *f = self.limit * ratio.tanh();
            // 1 − tanh² = 1/cosh², without cancellation where friction slips.
            let cosh = ratio.cosh();
            *df = self.damping / (cosh * cosh);
        }
        Ok(())
    }
}
