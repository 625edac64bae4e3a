//! Motion of the structure in one harmonic under contact forces alone, with its derivatives for Newton's method: by
//! the contact forces (the flexibility), by frequency and by damping ratio.
//!
//! x = −Z⁻¹ Wᴴ w, ∂x/∂w = −Z⁻¹ Wᴴ, ∂x/∂ω = −Z⁻¹ Z_ω x, ∂x/∂D = −Z⁻¹ Z_D x.

use crate::condense::Condensed;
use crate::condense::dynamic_stiffness::{DynamicStiffness, Variable, add_slope_product};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use num_complex::Complex64;

/// x and its derivatives in one harmonic.
pub struct Modal {
    dynamic: DynamicStiffness,
    /// Z⁻¹ Wᴴ, column after column.
    columns: Vec<Complex64>,
    x: Vec<Complex64>,
    by_omega: Vec<Complex64>,
    by_damping: Vec<Complex64>,
}

const CONTEXT: &str = "the flexibility of a mode";

impl Modal {
    /// Memory for a condensed model.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(condensed: &Condensed) -> Result<Self> {
        let n = condensed.ndof();
        let coordinates = condensed.coordinates();
        let zeros = |len| try_vec(len, Complex64::ZERO, CONTEXT);
        Ok(Self {
            dynamic: DynamicStiffness::new(condensed, coordinates.max(1))?,
            columns: zeros(n.saturating_mul(coordinates))?,
            x: zeros(n)?,
            by_omega: zeros(n)?,
            by_damping: zeros(n)?,
        })
    }

    /// Solves for the i-th carried harmonic at frequency `omega` and damping ratio `damping` under
    /// w = f − κ y.
    ///
    /// # Errors
    /// `Singular` naming the harmonic, at an undamped resonance that moves no contact; `StoppedByCaller`.
    pub fn solve(
        &mut self,
        condensed: &Condensed,
        i: usize,
        (omega, damping): (f64, f64),
        w: &[Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = self.x.len();
        let rows = &condensed.blocks()[i].rows;
        self.dynamic.factor(condensed, i, omega.into(), damping, interrupt)?;
        self.columns.fill(Complex64::ZERO);
        for (column, row) in self.columns.chunks_exact_mut(n).zip(rows) {
            for &(p, a) in row.terms() {
                column[p] += a.conj();
            }
        }
        self.dynamic
            .solve(condensed, i, omega, &mut self.columns, false, interrupt)?;
        self.x.fill(Complex64::ZERO);
        for (column, w) in self.columns.chunks_exact(n).zip(w) {
            for (x, z) in self.x.iter_mut().zip(column) {
                *x -= z * w;
            }
        }
        // On stiff structures Newton's method would not get below the rounding of an unrefined solution.
        self.by_damping.fill(Complex64::ZERO);
        for (row, w) in rows.iter().zip(w) {
            for &(p, a) in row.terms() {
                self.by_damping[p] -= a.conj() * w;
            }
        }
        self.dynamic
            .refine(condensed, i, (omega, damping), &self.by_damping, &mut self.x, interrupt)?;
        let at = (omega.into(), damping);
        for (derivative, by) in [
            (&mut self.by_omega, Variable::Omega),
            (&mut self.by_damping, Variable::Damping),
        ] {
            derivative.fill(Complex64::ZERO);
            add_slope_product(condensed, i, at, by, false, &self.x, derivative);
            self.dynamic.solve(condensed, i, omega, derivative, false, interrupt)?;
            for z in derivative.iter_mut() {
                *z = -*z;
            }
        }
        Ok(())
    }

    /// x
    #[must_use]
    pub fn x(&self) -> &[Complex64] {
        &self.x
    }

    /// ∂x/∂ω
    #[must_use]
    pub fn by_omega(&self) -> &[Complex64] {
        &self.by_omega
    }

    /// ∂x/∂D
    #[must_use]
    pub fn by_damping(&self) -> &[Complex64] {
        &self.by_damping
    }

    /// −∂x/∂w of one coordinate: Z⁻¹ Wᴴ.
    #[must_use]
    pub fn column(&self, coordinate: usize) -> &[Complex64] {
        let n = self.x.len();
        &self.columns[coordinate * n..(coordinate + 1) * n]
    }
}
