//! The adjoint of one result at one solution, on the whole structure.

use crate::condense::Condensed;
use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::error::{Result, try_vec};
use crate::model::matrices::spring::{Row, along};
use num_complex::Complex64;

pub(super) const CONTEXT: &str = "the sensitivities";

/// Motion and adjoint motion of all independent degrees of freedom, harmonic after harmonic of those carried.
pub(crate) struct Adjoint {
    /// Angular frequency ω of the solution.
    pub omega: f64,
    /// Damping ratio D of the artificial damping of a nonlinear mode; 0 in a forced response.
    pub damping: f64,
    /// Packed relative motions of the coordinates in the solver's units, static ones included.
    pub relative: Vec<f64>,
    /// Motion X_h in the caller's units, harmonic after harmonic.
    pub motion: Vec<Complex64>,
    /// Adjoint motion Λ_h: the result changes by Re Λᴴ q under a load q in the caller's units.
    pub field: Vec<Complex64>,
    /// Change of the result per change of X₁ᴴ M X₁ by M in the normalisation of a nonlinear mode; otherwise 0.
    pub normalisation: f64,
    /// Whether vibrating forces act; `false` in a nonlinear mode.
    pub is_forced: bool,
    /// Total derivative of the result by ω, in a forced response.
    pub by_omega: f64,
    /// Amplitude of a forced response; 0 otherwise.
    pub amplitude: f64,
    /// Adjoint λ of the equations of a forced response.
    pub lambda: Vec<f64>,
}

impl Adjoint {
    /// Memory for a solution on `condensed`, whose relative motions are `relative`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub(super) fn new(
        condensed: &Condensed,
        DampedFrequency { omega, damping }: DampedFrequency,
        relative: Vec<f64>,
    ) -> Result<Self> {
        let size = condensed
            .degrees()
            .independent()
            .saturating_mul(condensed.blocks().len());
        Ok(Self {
            omega,
            damping,
            relative,
            motion: try_vec(size, Complex64::ZERO, CONTEXT)?,
            field: try_vec(size, Complex64::ZERO, CONTEXT)?,
            normalisation: 0.0,
            is_forced: damping == 0.0,
            by_omega: 0.0,
            amplitude: 0.0,
            lambda: Vec::new(),
        })
    }

    /// Motion and adjoint motion in the i-th carried harmonic.
    pub fn harmonic(&self, condensed: &Condensed, i: usize) -> (&[Complex64], &[Complex64]) {
        let n = condensed.degrees().independent();
        let range = i * n..(i + 1) * n;
        (&self.motion[range.clone()], &self.field[range])
    }

    /// Writes the packed relative motion of a row in each harmonic, and its adjoint.
    pub(super) fn relative_motion(
        &self,
        condensed: &Condensed,
        row: impl Fn(usize) -> Row,
        (motion, field): (&mut [f64], &mut [f64]),
    ) {
        let set = condensed.set();
        for (i, &number) in set.numbers().iter().enumerate() {
            let row = row(number);
            let (x, adjoint) = self.harmonic(condensed, i);
            set.set(motion, i, along(&row, x));
            set.set(field, i, along(&row, adjoint));
        }
    }
}
