//! The cubic spring: f = k·x + c·x³ on one relative motion, hardening for c > 0, softening for
//! c < 0.
//!
//! The force is a polynomial, so nothing needs to be located in time: harmonics of products are
//! convolutions of harmonics, and balance with H harmonics is exact. With x = X₀ + Re Σ Xₚ e^{ipτ} =
//! Σ cₚ e^{ipτ} (c₀ = X₀, cₚ = Xₚ/2, c₋ₚ = conj cₚ) the stiffness spectrum of the cubic term is
//! 3c·(x²)ₙ = 3c·Σ cₚ cₙ₋ₚ. One harmonic of amplitude A gives the describing function
//! k + ¾·c·A². An oscillator on such a spring is Duffing's; see Krack & Gross, Harmonic Balance
//! for Nonlinear Vibration Problems (2019), doi:10.1007/978-3-030-14023-6.

use crate::contact::forms::constants::{Constant, Role, named_constants};
use crate::contact::forms::force_derivative::{Combination, ForceDerivative};
use crate::contact::forms::law::{ContactLaw, Form, Law, LawInTime, Spectral};
use crate::contact::forms::linearisation::{LINEARISATION_SMALL, Range};
use crate::contact::laws::polynomial::Polynomial;
use crate::error::{Result, fail};
use crate::fourier::HarmonicSet;
use num_complex::Complex64;
use std::sync::Arc;

/// A cubic spring, in the units of the caller or of a solver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cubic {
    /// k, stiffness at small motion, force per length, at least 0.
    pub kt: f64,
    /// c, force per length cubed, of any sign.
    pub cubic: f64,
}

named_constants!(Cubic, 1, Kt => kt, Cubic => cubic);

impl ContactLaw for Cubic {
    fn name(&self) -> &'static str {
        "cubic spring"
    }

    fn check_stiffness(&self) -> Result<()> {
        if self.kt == 0.0 && self.cubic == 0.0 {
            return fail!(
                Argument,
                "contact: kt = 0 and cubic = 0, needs another number in one of them"
            );
        }
        Ok(())
    }

    fn role(&self) -> Role {
        match (self.cubic == 0.0, self.kt == 0.0) {
            (true, true) => Role::Inert,
            (true, false) => Role::Spring,
            (false, _) => Role::Active,
        }
    }

    fn stiffness_at_small_motion(&self, _k: usize, _l: usize) -> f64 {
        self.kt
    }

    fn stiffness(&self, _k: usize) -> f64 {
        self.kt
    }

    /// The cubic term is f − kt·x.
    fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        let by_cubic = Combination {
            force: 1.0,
            motion: -self.kt,
            ..Combination::ZERO
        };
        match constant {
            Constant::Kt => Some(ForceDerivative::tangential(Combination::MOTION)),
            Constant::Cubic => Some(ForceDerivative::by_factor(self.cubic, by_cubic)),
            _ => None,
        }
    }

    fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        Ok(Arc::new(Cubic {
            kt: self.kt,
            cubic: self.cubic * length * length,
        }))
    }

    /// A linear spring and a polynomial of the third degree.
    fn in_time(&self) -> Result<LawInTime> {
        let law = Polynomial::scalar(&[0.0, 0.0, self.cubic], &[])?;
        Ok(LawInTime {
            stiffness: self.kt,
            ..LawInTime::smooth(Arc::new(law))
        })
    }
}

impl Law for Cubic {
    fn is_odd(&self) -> bool {
        true
    }

    fn form(&self) -> Form<'_> {
        Form::Spectral(self)
    }

    /// From this scale on the cubic term is small against `reference`.
    fn linearisation_scale(&self, ranges: &[Range], reference: f64) -> f64 {
        ranges[0].size() * (self.cubic.abs() / (LINEARISATION_SMALL * reference)).sqrt()
    }
}

impl Spectral for Cubic {
    /// A product of two carried harmonics p ≥ q contributes to p + q and to p − q.
    fn spectrum(&self, set: &HarmonicSet, motion: &[f64], spectrum: &mut [Complex64]) {
        spectrum.fill(Complex64::ZERO);
        let (mean, rest) = motion.split_at(usize::from(set.has_mean()));
        let mean = mean.first().copied().unwrap_or(0.0);
        spectrum[0] = (mean * mean).into();
        let c = |pair: &[f64]| Complex64::new(0.5 * pair[0], 0.5 * pair[1]);
        for (i, pair) in rest.chunks_exact(2).enumerate() {
            let (p, cp) = (set.reduced(i), c(pair));
            spectrum[p] += 2.0 * mean * cp;
            spectrum[2 * p] += cp * cp;
            spectrum[0] += 2.0 * cp.norm_sqr();
            for (j, pair) in rest.chunks_exact(2).enumerate().take(i) {
                let (q, cq) = (set.reduced(j), c(pair));
                spectrum[p + q] += 2.0 * cp * cq;
                spectrum[p - q] += 2.0 * cp * cq.conj();
            }
        }
        for s in spectrum {
            *s *= 3.0 * self.cubic;
        }
    }

    fn linear(&self) -> f64 {
        self.kt
    }

    fn degree(&self) -> f64 {
        3.0
    }

    fn at(&self, x: f64) -> f64 {
        x * (self.kt + self.cubic * x * x)
    }
}
