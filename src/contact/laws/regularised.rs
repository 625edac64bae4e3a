//! Friction with the jump of Coulomb's law smoothed: f = limit·tanh(v/v₀).
//!
//! The law creeps where Coulomb's sticks. Its Fourier coefficients fall off as e^{−nδ} with
//! sinh δ = π·v₀/(2V) for a motion of one harmonic of velocity V, the distance of the nearest pole
//! of tanh from the real axis of τ; N samples leave an error of about e^{−(N−H)δ}. The number of
//! samples that suffices hence depends on V/v₀, which is known with the solution only.

use crate::contact::forms::constants::{Constant, Role, named_constants, slip_limit};
use crate::contact::forms::force_derivative::{Combination, ForceDerivative};
use crate::contact::forms::law::{ContactLaw, Form, Law, LawInTime, Memoryless};
use crate::contact::forms::linearisation::{LINEARISATION_SMALL, Range};
use crate::contact::forms::samples::{Samples, automatic_samples};
use crate::error::{Result, fail};
use std::sync::Arc;

/// Finer sampling than that of a law of unknown form, for the steep passage through v = 0.
/// Kind: tuned; measured on: not recorded.
const REGULARISED_REFINEMENT: usize = 4;

/// Regularised friction in the caller's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Regularised {
    /// Friction coefficient, at least 0.
    pub mu: f64,
    /// Normal load, force, at least 0.
    pub preload: f64,
    /// Velocity at which the force reaches 76 % (tanh 1) of its limit, above 0.
    pub velocity: f64,
}

named_constants!(Regularised, 5, Mu => mu, Preload => preload, Velocity => velocity);

impl Regularised {
    fn slip_limit(&self) -> f64 {
        slip_limit(self.mu, self.preload)
    }
}

impl ContactLaw for Regularised {
    fn name(&self) -> &'static str {
        "regularised friction"
    }

    fn check(&self) -> Result<()> {
        TanhFriction::new(self.slip_limit(), self.velocity).map(|_| ())
    }

    fn role(&self) -> Role {
        if self.slip_limit() == 0.0 {
            Role::Inert
        } else {
            Role::Active
        }
    }

    fn stiffness_at_small_motion(&self, _k: usize, _l: usize) -> f64 {
        0.0
    }

    fn stiffness(&self, _k: usize) -> f64 {
        0.0
    }

    fn resistance(&self) -> f64 {
        self.slip_limit() / self.velocity
    }

    fn largest_force(&self) -> f64 {
        self.slip_limit()
    }

    fn load_scales_motion(&self) -> bool {
        false
    }

    /// The force is proportional to μ and to the load, and a function of y'/velocity.
    fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        match constant {
            Constant::Mu => Some(ForceDerivative::by_factor(self.mu, Combination::FORCE)),
            Constant::Preload => Some(ForceDerivative::by_factor(self.preload, Combination::FORCE)),
            Constant::Velocity => Some(ForceDerivative::tangential(Combination {
                by_tangential: -1.0 / self.velocity,
                ..Combination::ZERO
            })),
            _ => None,
        }
    }

    fn normal_load(&self, _y: f64) -> f64 {
        self.preload
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        let law = TanhFriction::new(self.slip_limit(), self.velocity)?;
        Ok(Arc::new(law.in_units(length)))
    }

    fn in_time(&self) -> Result<LawInTime> {
        Ok(LawInTime::smooth(self.law(1.0)?))
    }
}

/// Regularised friction in the units of a solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TanhFriction {
    limit: f64,
    velocity: f64,
    /// limit/velocity, which units do not change.
    damping: f64,
}

impl TanhFriction {
    /// Friction of slip limit `limit` ≥ 0 that reaches 76 % of it (tanh 1) at the velocity `velocity`
    /// > 0. Unless samples are requested it takes four times as many as [`automatic_samples`] has.
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
        ranges[0].speed / (self.velocity * (3.0 * LINEARISATION_SMALL).sqrt())
    }
}

impl Memoryless for TanhFriction {
    fn uses_velocity(&self) -> bool {
        true
    }

    fn samples(&self, highest: usize, requested: usize) -> usize {
        match requested {
            0 => automatic_samples(highest).saturating_mul(REGULARISED_REFINEMENT),
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
