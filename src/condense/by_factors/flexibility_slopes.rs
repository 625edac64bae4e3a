//! Derivatives of the flexibility by the frequency, by factorisation.
//!
//! Where contacts are few the whole table ∂H/∂ω = −R Z_κ⁻¹ Z′ Z_κ⁻¹ B is made. Where they are many a residual takes its product with one
//! vector of forces only, R ∂x/∂ω of the motion x under them, and the response its last row.

use crate::condense::by_factors::dynamic_stiffness::{
    DampedFrequency, Variable, add_slope_product, fill_slope, multiply_slope,
};
use crate::condense::by_factors::flexibility::{CONTEXT, Table, Workspace, made, read};
use crate::condense::{Condensed, HarmonicBlock};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::complex_products::multiply_adjoint;
use crate::linalg::inner;
use num_complex::Complex64;

/// Columns of Z′ Z⁻¹ B at a time.
/// Kind: block.
const PRODUCTS: usize = 8;

impl Workspace {
    /// Fills the whole table ∂H/∂ω with the current factors and columns.
    pub(crate) fn fill_all_slopes(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let block = &condensed.blocks()[i];
        let n = condensed.ndof();
        let outputs = condensed.coordinates() + 1;
        if self.rows.is_empty() {
            self.rows = try_vec(self.columns.len(), Complex64::ZERO, CONTEXT)?;
            self.products = try_vec(n * PRODUCTS.min(outputs), Complex64::ZERO, CONTEXT)?;
        }
        self.rows.fill(Complex64::ZERO);
        let rows = block.motions.rows.iter().chain([&self.responses[i]]);
        for (column, row) in self.rows.chunks_exact_mut(n).zip(rows) {
            for &(p, a) in row.terms() {
                column[p] += a;
            }
        }
        made(&mut self.dynamic, condensed)?.solve(condensed, i, omega, &mut self.rows, true, interrupt)?;
        let entries = block.matrices.reference.values.len();
        if self.slope.len() < entries {
            self.slope = try_vec(entries, Complex64::ZERO, CONTEXT)?;
        }
        fill_slope(
            block,
            DampedFrequency::new(omega, self.damping),
            &mut self.slope[..entries],
        );
        // −Rᵀ as the adjoint of −conj R.
        for z in &mut self.rows {
            *z = -z.conj();
        }
        let columns = self.columns.chunks(PRODUCTS * n);
        for (columns, table) in columns.zip(self.table.slope.chunks_mut(PRODUCTS * outputs)) {
            interrupt.check_before(8 * (outputs * columns.len()) as u64)?;
            let products = &mut self.products[..columns.len()];
            for (column, product) in columns.chunks_exact(n).zip(products.chunks_exact_mut(n)) {
                multiply_slope(block, &self.slope[..entries], column, product);
            }
            multiply_adjoint(&self.rows, products, table, n);
        }
        if let Some(unbalance) = &block.load.unbalance {
            // The last column is that of the excitation, whose own derivative is 2ω times the unbalance.
            let last = self.table.slope.len() - outputs;
            for (slope, solved) in self.table.slope[last..].iter_mut().zip(self.rows.chunks_exact(n)) {
                *slope -= 2.0 * omega * inner(solved, unbalance);
            }
        }
        Ok(())
    }

    /// `load` ← r = Z⁻ᵀ Rᵀ of the response and `products` ← Z′ᵀ r, with the current factors.
    pub(crate) fn move_response(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = condensed.ndof();
        self.load.fill(Complex64::ZERO);
        for &(p, a) in self.responses[i].terms() {
            self.load[p] += a;
        }
        made(&mut self.dynamic, condensed)?.solve(condensed, i, omega, &mut self.load, true, interrupt)?;
        if self.products.len() < n {
            self.products = try_vec(n, Complex64::ZERO, CONTEXT)?;
        }
        let at = (omega.into(), self.damping);
        let moved = &mut self.products[..n];
        moved.fill(Complex64::ZERO);
        add_slope_product(condensed, i, at, Variable::Omega, true, &self.load, moved);
        Ok(())
    }

    /// The last row of ∂H/∂ω = −rᵀ Z′ Z⁻¹ B with r = Z⁻ᵀ Rᵀ of the response, with the current factors and columns.
    pub(crate) fn fill_slopes_of_response(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = condensed.ndof();
        let outputs = condensed.coordinates() + 1;
        self.table.slope.fill(Complex64::ZERO);
        self.move_response(condensed, (i, omega), interrupt)?;
        let moved = &self.products[..n];
        let product = |a: &[Complex64], b: &[Complex64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<Complex64>();
        let slopes = self.table.slope.chunks_exact_mut(outputs);
        for (column, slopes) in self.columns.chunks_exact(n).zip(slopes) {
            slopes[outputs - 1] = -product(moved, column);
        }
        self.add_slope_of_unbalance(&condensed.blocks()[i], omega);
        Ok(())
    }

    /// 2ω rᵀU to the slope of the response by the excitation, after [`Self::move_response`].
    pub(crate) fn add_slope_of_unbalance(&mut self, block: &HarmonicBlock, omega: f64) {
        if let (Some(unbalance), Some(last)) = (&block.load.unbalance, self.table.slope.last_mut()) {
            let product = self.load.iter().zip(unbalance).map(|(a, b)| a * b).sum::<Complex64>();
            *last += 2.0 * omega * product;
        }
    }

    /// The last row of ∂H/∂ω = −qᵀB with q = Z⁻ᵀ Z′ᵀ Z⁻ᵀ Rᵀ of the response, where no columns are at hand, with the current factors.
    pub(crate) fn fill_adjoint_slopes(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (n, block) = (condensed.ndof(), &condensed.blocks()[i]);
        let outputs = condensed.coordinates() + 1;
        self.table.slope.fill(Complex64::ZERO);
        self.move_response(condensed, (i, omega), interrupt)?;
        let adjoint = &mut self.products[..n];
        made(&mut self.dynamic, condensed)?.solve(condensed, i, omega, adjoint, true, interrupt)?;
        let slopes = self.table.slope.iter_mut().skip(outputs - 1).step_by(outputs);
        for (slope, row) in slopes.zip(&block.motions.rows) {
            *slope = -row.terms().map(|&(p, a)| a.conj() * adjoint[p]).sum::<Complex64>();
        }
        let Some(last) = self.table.slope.last_mut() else {
            return Ok(());
        };
        let (factor, by_omega) = (omega * omega, 2.0 * omega);
        *last -= block
            .load
            .force
            .iter()
            .zip(&*adjoint)
            .map(|(f, q)| f * q)
            .sum::<Complex64>();
        for ((u, q), r) in block.load.unbalance.iter().flatten().zip(&*adjoint).zip(&self.load) {
            *last += u * (by_omega * r - factor * q);
        }
        Ok(())
    }

    /// The column of the excitation of H and ∂H/∂ω of the i-th carried harmonic at `omega`; the others of `table` are then zero.
    ///
    /// With the motion x = Z⁻¹F it is R x and R ∂x/∂ω, ∂x/∂ω = Z⁻¹(∂F/∂ω − Z′ x).
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub(crate) fn tabulate_excited(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        table: &mut Table,
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let (n, block) = (condensed.ndof(), &condensed.blocks()[i]);
        if self.motion.is_empty() {
            self.motion = try_vec(2 * n, Complex64::ZERO, CONTEXT)?;
        }
        let mut motion = core::mem::take(&mut self.motion);
        let (x, dx) = motion.split_at_mut(n);
        let dynamic = made(&mut self.dynamic, condensed)?;
        dynamic.factor(condensed, i, omega.into(), self.damping, interrupt)?;
        block.force_at(omega, &mut self.load);
        x.copy_from_slice(&self.load);
        dynamic.solve(condensed, i, omega, x, false, interrupt)?;
        if dynamic.should_refine(condensed, i, x) {
            dynamic.refine(
                condensed,
                i,
                DampedFrequency::new(omega, self.damping),
                &self.load,
                x,
                interrupt,
            )?;
        }
        let found = self.recover_along(condensed, (i, omega), (&[], 1.0), x, dx, interrupt);
        let first = table.value.len() - (condensed.coordinates() + 1);
        let rows = || block.motions.rows.iter().chain([&self.responses[i]]);
        for (values, motion) in [(&mut table.value, &*x), (&mut table.slope, &*dx)] {
            values[..first].fill(Complex64::ZERO);
            read(rows(), motion, &mut values[first..]);
        }
        self.motion = motion;
        found
    }

    /// The change R ∂x/∂ω of the motion x under the excitation and constant contact forces, in the i-th carried
    /// harmonic at `omega`. `contact_force` holds w = f − κ y as in [`Self::recover`].
    ///
    /// # Errors
    /// As [`Self::evaluate`].
    pub(crate) fn slope_along(
        &mut self,
        condensed: &Condensed,
        (i, omega): (usize, f64),
        contact_force: &[Complex64],
        change: &mut [Complex64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = condensed.ndof();
        if self.motion.is_empty() {
            self.motion = try_vec(2 * n, Complex64::ZERO, CONTEXT)?;
        }
        let mut motion = core::mem::take(&mut self.motion);
        let (x, dx) = motion.split_at_mut(n);
        let solved = self.solve_under(condensed, (i, omega), contact_force, x, interrupt);
        let found = solved.and_then(|()| self.recover_along(condensed, (i, omega), (&[], 1.0), x, dx, interrupt));
        read(
            condensed.blocks()[i].motions.rows.iter().chain([&self.responses[i]]),
            dx,
            change,
        );
        self.motion = motion;
        found
    }
}
