//! Harmonics of all degrees of freedom at a stored point.

use crate::error::{Result, fail};
use crate::interrupt::Interrupt;
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

    /// Harmonics as [`Self::harmonics_at`], and the caller may stop it.
    ///
    /// # Errors
    /// As [`Self::harmonics_at`]; `StoppedByCaller`.
    pub fn harmonics_at_with(&self, point: usize, x: &mut [Complex64], interrupt: &Interrupt<'_>) -> Result<()> {
        self.carried_of(point)?;
        let n = self.ndof();
        let needed = (self.run.harmonics + 1) * n;
        if x.len() != needed {
            return fail!(
                Dimension,
                "x has {} complex entries, needs (harmonics+1)*ndof = {needed}",
                x.len()
            );
        }
        let found = Recovery::at(self, point, interrupt)?.all(self.run.harmonics)?;
        x.copy_from_slice(&found);
        Ok(())
    }
}
