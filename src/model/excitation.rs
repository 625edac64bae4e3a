//! Forces per degree of freedom and harmonic.

use crate::error::{Result, fail, try_extend, try_push};
use crate::options::MAX_HARMONIC;
use num_complex::Complex64;

/// One harmonic force: Re(value·e^{i·harmonic·ωt}) on `dof`.
#[derive(Clone, Copy, Debug)]
pub struct Force {
    /// Degree of freedom.
    pub dof: usize,
    /// Harmonic number; 0 is a constant force.
    pub harmonic: usize,
    /// Complex amplitude, peak.
    pub value: Complex64,
}

/// All forces on a model.
#[derive(Clone, Debug, Default)]
pub struct Excitation {
    forces: Vec<Force>,
}

impl Excitation {
    /// Adds a force on a structure of `ndof` degrees of freedom.
    pub(super) fn add(&mut self, ndof: usize, dof: usize, harmonic: usize, value: Complex64) -> Result<()> {
        if dof >= ndof {
            return fail!(Index, "force: dof = {dof}, needs 0 .. {}", ndof - 1);
        }
        if harmonic > MAX_HARMONIC {
            return fail!(Argument, "force: harmonic = {harmonic}, needs 0 .. {MAX_HARMONIC}");
        }
        if !value.is_finite() {
            return fail!(NotFinite, "force: value = {} + {}i is not finite", value.re, value.im);
        }
        if harmonic == 0 && value.im != 0.0 {
            return fail!(Argument, "a constant force is real, but im = {}", value.im);
        }
        try_push(&mut self.forces, Force { dof, harmonic, value }, "the forces")
    }

    /// A copy, allocated fallibly.
    pub(super) fn try_clone(&self) -> Result<Self> {
        let mut copy = Self::default();
        try_extend(&mut copy.forces, &self.forces, "the forces")?;
        Ok(copy)
    }

    /// Removes all forces.
    pub(super) fn clear(&mut self) {
        self.forces.clear();
    }

    /// Largest real or imaginary part of a force.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.forces
            .iter()
            .fold(0.0, |m, f| m.max(f.value.re.abs()).max(f.value.im.abs()))
    }

    /// The forces in the order in which they were added.
    #[must_use]
    pub fn forces(&self) -> &[Force] {
        &self.forces
    }
}
