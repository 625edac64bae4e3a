//! Laws without memory: the force at a time follows from the relative motion and velocity at that
//! time alone.
//!
//! Such a law is told at equidistant times of a period; what is done with its samples (Fourier
//! coefficients, Jacobian) is the same for all of them and lives in [`crate::aft::memoryless`].

use crate::contact::law::Law;
use crate::error::Result;

/// Where a law writes its samples, sample after sample; within a sample direction after direction.
///
/// All numbers are 0 when a law is called.
#[derive(Debug)]
pub struct Samples<'a> {
    /// Force fᵢ, N × d.
    pub f: &'a mut [f64],
    /// ∂fᵢ/∂uⱼ at the same time, N × d × d, the row i in one piece.
    pub df_du: &'a mut [f64],
    /// ∂fᵢ/∂vⱼ at the same time, N × d × d; empty for laws that do not feel the velocity.
    pub df_dv: &'a mut [f64],
    /// Memory for the law's own use, 2·N × d.
    pub scratch: &'a mut [f64],
}

/// A law f(u, v) of d relative motions u and their velocities v = du/dt. All quantities are in the
/// solver's units.
pub trait Memoryless: Law {
    /// Whether the force depends on v; if not, v comes empty and df_dv goes empty.
    fn uses_velocity(&self) -> bool;

    /// Whether the law may be asked for half a period where motion and law are odd, so that the
    /// other half repeats the first with opposite sign.
    fn half_period_suffices(&self) -> bool {
        self.is_odd()
    }

    /// Samples per period that motions up to the reduced harmonic `highest` need; a fast transform may
    /// take a few more.
    fn samples(&self, highest: usize, asked: usize) -> usize;

    /// Whether these samples give the harmonics of the force without any error.
    fn is_alias_free(&self) -> bool {
        false
    }

    /// Force and tangents at given times, `samples` of them, for u and v that are stored like the
    /// force.
    ///
    /// # Errors
    /// Those of a callback.
    fn evaluate(&self, omega: f64, samples: usize, u: &[f64], v: &[f64], out: Samples<'_>) -> Result<()>;
}

/// Samples per period for a law of which nothing is known: 16 per period of the highest harmonic,
/// at least 64, rounded up to a power of two.
#[must_use]
pub fn automatic_samples(highest: usize) -> usize {
    highest
        .saturating_mul(16)
        .clamp(64, 1 << (usize::BITS - 2))
        .next_power_of_two()
}
