//! Harmonics of all degrees of freedom at a stored point.

use crate::error::{Result, fail, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::results::{Branch, Recovery};
use num_complex::Complex64;

impl Branch {
    /// Harmonics 0 ..= H of all degrees of freedom at a stored point: (H + 1) × ndof, harmonic by
    /// harmonic, in the caller's unit of length.
    ///
    /// # Errors
    /// `Index` for an unknown point, `Dimension` for a buffer of another length, `OutOfMemory`.
    pub fn harmonics_at(&self, point: usize, x: &mut [Complex64]) -> Result<()> {
        self.harmonics_at_with(point, x, &Interrupt::none())
    }

    /// The same as [`Self::harmonics_at`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::harmonics_at`]; `StoppedByCaller`.
    pub fn harmonics_at_with(&self, point: usize, x: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        let carried = self.carried_of(point)?;
        let n = self.ndof();
        let needed = (self.harmonics + 1) * n;
        if x.len() != needed {
            return fail!(
                Dimension,
                "x has {} complex entries, needs (harmonics+1)*ndof = {needed}",
                x.len()
            );
        }
        let mut found = try_vec(needed, Complex64::ZERO, "the harmonics")?;
        let mut recovery = Recovery::at(self, point, interrupt)?;
        for (i, &h) in carried.iter().enumerate() {
            interrupt.part(Phase::Results, i, carried.len())?;
            recovery.harmonic(i, &mut found[h * n..(h + 1) * n])?;
        }
        x.copy_from_slice(&found);
        Ok(())
    }
}
