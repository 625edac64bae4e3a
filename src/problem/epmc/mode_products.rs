//! Products with Newton's matrix of a nonlinear mode, and its block between the first harmonics with frequency and damping ratio, for
//! linear solutions that never form the whole matrix.
//!
//! Behind the motions stand two unknowns and two equations, those of the normalisation:
//!
//! > J = [I + G (∂f/∂y − κ), ∂R/∂ω, ∂R/∂D; Re gᵀ (∂f/∂y − κ), …],
//!
//! g being the share of a contact force in them.

use crate::error::{Result, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::linalg::dense::complex_columns;
use crate::linalg::dot;
use crate::linalg::newton::linear_system::{Jacobian, MatrixFree};
use crate::problem::epmc::Epmc;
use crate::problem::newton_products::PackedHarmonics;
use crate::problem::parametric_problem::put;
use core::mem::swap;
use num_complex::Complex64;

const CONTEXT: &str = "the products of the nonlinear mode";

/// Unknowns of frequency and damping ratio.
/// Kind: fixed.
const BEHIND: usize = 2;

/// Memory of products with Newton's matrix, allocated by the first product.
#[derive(Default)]
pub(super) struct ModeProducts {
    /// Change of the contact forces minus κ y, for all coordinates.
    change: Vec<f64>,
    /// Memory: numbers of one harmonic, their product, and work space for it.
    harmonic: [Vec<Complex64>; 3],
    column: Vec<f64>,
    /// The last two rows at the point evaluated last, without the columns of frequency and damping ratio.
    rows: [Vec<f64>; 2],
    /// Data of the matrix at an earlier point, which is kept.
    kept: Kept,
}

/// Data from which the products of one matrix are computed.
#[derive(Default)]
struct Kept {
    jacobians: Vec<f64>,
    tables: Vec<Vec<Complex64>>,
    by_omega: Vec<f64>,
    by_damping: Vec<f64>,
    rows: [Vec<f64>; 2],
    /// Motions that no contact couples back.
    silent: Vec<bool>,
}

impl PackedHarmonics for Epmc<'_> {
    fn harmonics(&self) -> &HarmonicSet {
        self.condensed.set()
    }
}

impl MatrixFree for Epmc<'_> {
    fn group(&self) -> usize {
        self.condensed.set().packed_len()
    }

    fn behind(&self) -> usize {
        BEHIND
    }

    fn coupled(&self) -> usize {
        let coordinates = 0..self.condensed.coordinates();
        self.group() * coordinates.filter(|&c| self.forces.is_coupled(c)).count() + BEHIND
    }

    fn fill_block(&mut self, part: usize, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        self.make_products()?;
        self.fill_rows();
        let set = self.condensed.set();
        let (m, coordinates) = (set.packed_len(), self.condensed.coordinates());
        let harmonics = (0..set.numbers().len()).filter(|&i| set.offset(i) < part).count();
        let order = part * coordinates + BEHIND;
        let Self {
            forces,
            derivatives,
            products,
            ..
        } = self;
        active.fill(true);
        let column = &mut products.column[..];
        let (motions, others) = matrix.split_at_mut(order * (order - BEHIND));
        for (k, to) in motions.chunks_exact_mut(order).enumerate() {
            let (c, q) = (k / part, k % part);
            forces.interrupt().check()?;
            column.fill(0.0);
            let flexibility = (|i: usize| &derivatives.tables[i][..], coordinates);
            forces.couple(0..harmonics, (c, q), flexibility, &mut products.harmonic[1], column);
            for (to, from) in to.chunks_exact_mut(part).zip(column.chunks_exact(m)) {
                to.copy_from_slice(&from[..part]);
            }
            to[k] += 1.0;
            for (to, row) in to[order - BEHIND..].iter_mut().zip(&products.rows) {
                *to = row[c * m + q];
            }
        }
        for (to, from) in others
            .chunks_exact_mut(order)
            .zip([&derivatives.by_omega, &derivatives.by_damping])
        {
            let (groups, behind) = from.split_at(from.len() - BEHIND);
            for (to, from) in to.chunks_exact_mut(part).zip(groups.chunks_exact(m)) {
                to.copy_from_slice(&from[..part]);
            }
            to[order - BEHIND..].copy_from_slice(behind);
        }
        Ok(())
    }

    fn fill_pair(&mut self, at: usize, matrix: &mut [Complex64]) {
        let set = self.condensed.set();
        let coordinates = self.condensed.coordinates();
        let Some(i) = (0..set.numbers().len()).find(|&i| set.offset(i) == at) else {
            return;
        };
        matrix.fill(Complex64::ZERO);
        for (motion, column) in matrix.chunks_exact_mut(coordinates.max(1)).enumerate() {
            column[motion] = Complex64::ONE;
            self.forces
                .add_mean_coupling(motion, i, &self.derivatives.tables[i], coordinates, column);
        }
    }

    fn keep(&mut self) -> Result<()> {
        self.make_products()?;
        self.fill_rows();
        let kept = &mut self.products.kept;
        self.forces.copy_silent(&mut kept.silent)?;
        self.forces.copy_jacobians(&mut kept.jacobians)?;
        for (to, from) in kept.tables.iter_mut().zip(&self.derivatives.tables) {
            to.copy_from_slice(from);
        }
        kept.by_omega.copy_from_slice(&self.derivatives.by_omega);
        kept.by_damping.copy_from_slice(&self.derivatives.by_damping);
        for (to, from) in kept.rows.iter_mut().zip(&self.products.rows) {
            to.copy_from_slice(from);
        }
        Ok(())
    }

    fn multiply(&mut self, d: &[f64], out: &mut [f64]) -> Result<()> {
        self.exchange();
        self.multiply_current(d, out);
        self.exchange();
        Ok(())
    }
}

impl Epmc<'_> {
    fn make_products(&mut self) -> Result<()> {
        if !self.products.change.is_empty() {
            return Ok(());
        }
        let (unknowns, coordinates) = (self.condensed.unknowns(), self.condensed.coordinates());
        let zeros = |len| try_vec(len, 0.0, CONTEXT);
        let of_harmonic = || try_vec(coordinates, Complex64::ZERO, CONTEXT);
        let mut tables = Vec::new();
        for table in &self.derivatives.tables {
            try_push(&mut tables, try_vec(table.len(), Complex64::ZERO, CONTEXT)?, CONTEXT)?;
        }
        *self.products = ModeProducts {
            change: zeros(unknowns)?,
            harmonic: [of_harmonic()?, of_harmonic()?, of_harmonic()?],
            column: zeros(unknowns)?,
            rows: [zeros(unknowns)?, zeros(unknowns)?],
            kept: Kept {
                jacobians: Vec::new(),
                tables,
                by_omega: zeros(unknowns + BEHIND)?,
                by_damping: zeros(unknowns + BEHIND)?,
                rows: [zeros(unknowns)?, zeros(unknowns)?],
                silent: Vec::new(),
            },
        };
        Ok(())
    }

    /// The last two rows at the point evaluated last.
    fn fill_rows(&mut self) {
        let fundamental = self.condensed.set().fundamental();
        for (k, row) in self.products.rows.iter_mut().enumerate() {
            row.fill(0.0);
            for (c, g) in self.derivatives.gauge_rows.iter().enumerate() {
                self.forces.couple_scalar(fundamental, (0, c), g[k], row, 1);
            }
        }
    }

    /// Exchanges the data of the current matrix for those of the kept one.
    fn exchange(&mut self) {
        let kept = &mut self.products.kept;
        self.forces.swap_jacobians(&mut kept.jacobians);
        swap(&mut self.derivatives.tables, &mut kept.tables);
        swap(&mut self.derivatives.by_omega, &mut kept.by_omega);
        swap(&mut self.derivatives.by_damping, &mut kept.by_damping);
        swap(&mut self.products.rows, &mut kept.rows);
    }

    /// out ← J d with the current matrix.
    fn multiply_current(&mut self, d: &[f64], out: &mut [f64]) {
        let set = self.condensed.set();
        let (m, coordinates) = (set.packed_len(), self.condensed.coordinates());
        let n = self.size();
        let (motion, [along_omega, along_damping]) = (&d[..n - BEHIND], [d[n - 2], d[n - 1]]);
        let ModeProducts {
            change,
            harmonic,
            rows,
            kept,
            ..
        } = &mut *self.products;
        let [z, sum, memory] = harmonic;
        for (c, dw) in change.chunks_exact_mut(m).enumerate() {
            if kept.silent.get(c) == Some(&true) {
                dw.fill(0.0);
            } else {
                self.forces.change(motion, c, dw);
            }
        }
        out[..n - BEHIND].copy_from_slice(motion);
        for (to, row) in out[n - BEHIND..].iter_mut().zip(rows) {
            *to = dot(row, motion);
        }
        for (i, table) in self.derivatives.tables.iter().enumerate() {
            let (at, mean) = (set.offset(i), set.numbers()[i] == 0);
            for (z, dw) in z.iter_mut().zip(change.chunks_exact(m)) {
                *z = set.get(dw, i);
            }
            complex_columns::multiply(table, coordinates, z, sum, memory);
            for (c, sum) in sum.iter().enumerate() {
                put(out, c * m + at, mean, *sum);
                if mean {
                    out[c * m + at] += self.forces.mean_floor(c) * motion[c * m + at];
                }
            }
        }
        for ((out, by_omega), by_damping) in out
            .iter_mut()
            .zip(&self.derivatives.by_omega)
            .zip(&self.derivatives.by_damping)
        {
            *out += by_omega * along_omega + by_damping * along_damping;
        }
    }
}

#[cfg(test)]
#[path = "mode_products_tests.rs"]
mod tests;
