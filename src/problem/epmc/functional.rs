//! Frequency and damping ratio of a nonlinear mode as functionals of its unknowns, and the normalisation by the motion
//! of the structure: the sources of an adjoint solution.

use crate::linalg::newton::linear_system::Jacobian;
use crate::problem::epmc::{DAMPING_UNIT, Epmc, OMEGA_UNIT};
use num_complex::Complex64;

impl Epmc<'_> {
    /// Product L² B x̂₁ of the normalisation at the point last evaluated.
    #[must_use]
    pub fn weighted(&self) -> &[Complex64] {
        &self.memory.weighted
    }

    /// Factor of Im x̂₁ of the reference degree of freedom in the last row of the system.
    #[must_use]
    pub fn phase_scale(&self) -> f64 {
        self.condensed.length() / self.linear.shape[self.gauge.reference_dof].norm()
    }

    /// Index of the unknown that represents the frequency, and the derivative of the frequency ω by it.
    #[must_use]
    pub fn frequency_unknown(&self, omega: f64) -> (usize, f64) {
        (self.size() - 2, OMEGA_UNIT * omega)
    }

    /// Index of the unknown that represents the damping ratio, and the derivative of the ratio by it.
    #[must_use]
    pub fn damping_unknown(&self) -> (usize, f64) {
        (self.size() - 1, DAMPING_UNIT)
    }
}
