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
use crate::linalg::linear_system::{Jacobian, MatrixFree};
use crate::linalg::{complex_columns, dot};
use crate::problem::epmc::Epmc;
use crate::problem::newton_products::PackedHarmonics;
use crate::problem::parametric_problem::put;
use core::mem::swap;
use num_complex::Complex64;

const CONTEXT: &str = "the products of the nonlinear mode";

/// Unknowns of frequency and damping ratio.
const BEHIND: usize = 2;

/// Memory of products, made by the first of them.
#[derive(Default)]
pub(super) struct ModeProducts {
    /// Change of the contact forces less the reference, of all coordinates.
    change: Vec<f64>,
    /// Numbers of one harmonic, their product, and memory for it.
    harmonic: [Vec<Complex64>; 3],
    column: Vec<f64>,
    /// The last two rows at the point evaluated last, without the columns of frequency and damping ratio.
    rows: [Vec<f64>; 2],
    /// The matrix of an earlier point.
    kept: Kept,
}

/// The numbers that make up a matrix.
#[derive(Default)]
struct Kept {
    jacobians: Vec<f64>,
    tables: Vec<Vec<Complex64>>,
    by_omega: Vec<f64>,
    by_damping: Vec<f64>,
    rows: [Vec<f64>; 2],
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
            tables,
            products,
            by_omega,
            by_damping,
            ..
        } = self;
        active.fill(true);
        let column = &mut products.column[..];
        let (motions, others) = matrix.split_at_mut(order * (order - BEHIND));
        for (k, to) in motions.chunks_exact_mut(order).enumerate() {
            let (c, q) = (k / part, k % part);
            forces.interrupt().check()?;
            column.fill(0.0);
            let flexibility = (|i: usize| &tables[i][..], coordinates);
            forces.couple(0..harmonics, (c, q), flexibility, &mut products.harmonic[1], column);
            for (to, from) in to.chunks_exact_mut(part).zip(column.chunks_exact(m)) {
                to.copy_from_slice(&from[..part]);
            }
            to[k] += 1.0;
            for (to, row) in to[order - BEHIND..].iter_mut().zip(&products.rows) {
                *to = row[c * m + q];
            }
        }
        for (to, from) in others.chunks_exact_mut(order).zip([&*by_omega, &*by_damping]) {
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
                .add_mean_coupling((motion, i), (&self.tables[i], coordinates), column);
        }
    }

    fn keep(&mut self) -> Result<()> {
        self.make_products()?;
        self.fill_rows();
        let kept = &mut self.products.kept;
        self.forces.copy_jacobians(&mut kept.jacobians)?;
        for (to, from) in kept.tables.iter_mut().zip(&self.tables) {
            to.copy_from_slice(from);
        }
        kept.by_omega.copy_from_slice(&self.by_omega);
        kept.by_damping.copy_from_slice(&self.by_damping);
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
        for table in &self.tables {
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
            },
        };
        Ok(())
    }

    /// The last two rows at the point evaluated last.
    fn fill_rows(&mut self) {
        let fundamental = self.condensed.set().fundamental();
        for (k, row) in self.products.rows.iter_mut().enumerate() {
            row.fill(0.0);
            for (c, g) in self.gauge_rows.iter().enumerate() {
                self.forces.couple_scalar(fundamental, (0, c), g[k], row, 1);
            }
        }
    }

    /// Exchanges the current matrix for the one that was kept.
    fn exchange(&mut self) {
        let kept = &mut self.products.kept;
        self.forces.swap_jacobians(&mut kept.jacobians);
        swap(&mut self.tables, &mut kept.tables);
        swap(&mut self.by_omega, &mut kept.by_omega);
        swap(&mut self.by_damping, &mut kept.by_damping);
        swap(&mut self.products.rows, &mut kept.rows);
    }

    /// out = J d
    fn multiply_current(&mut self, d: &[f64], out: &mut [f64]) {
        let set = self.condensed.set();
        let (m, coordinates) = (set.packed_len(), self.condensed.coordinates());
        let n = self.size();
        let (motion, [along_omega, along_damping]) = (&d[..n - BEHIND], [d[n - 2], d[n - 1]]);
        let ModeProducts {
            change, harmonic, rows, ..
        } = &mut *self.products;
        let [z, sum, memory] = harmonic;
        for (c, dw) in change.chunks_exact_mut(m).enumerate() {
            self.forces.change(motion, c, dw);
        }
        out[..n - BEHIND].copy_from_slice(motion);
        for (to, row) in out[n - BEHIND..].iter_mut().zip(rows) {
            *to = dot(row, motion);
        }
        for (i, table) in self.tables.iter().enumerate() {
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
        for ((out, by_omega), by_damping) in out.iter_mut().zip(&self.by_omega).zip(&self.by_damping) {
            *out += by_omega * along_omega + by_damping * along_damping;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Condensed;
    use crate::condense::test_chains::chain;
    use crate::contact::Contact;
    use crate::interrupt::Interrupt;
    use crate::options::{DampingForm, SolverOptions};
    use crate::problem::epmc::{Gauge, LinearMode};
    use crate::problem::static_state::StaticState;
    use crate::problem::{Problem, Residual};

    /// A chain with sliders, and with a stop too, whose mean is carried: the filled matrix is compared with differences elsewhere.
    #[test]
    fn products_and_blocks_are_those_of_the_filled_matrix() {
        let none = Interrupt::none();
        for (has_stop, form) in [(false, DampingForm::Mass), (true, DampingForm::Stiffness)] {
            let mut model = chain(1, (0.0, 1e-3));
            if has_stop {
                model
                    .add_contact(&Contact::unilateral(None, Some(2), 3.0, 0.1))
                    .unwrap();
            }
            let options = SolverOptions {
                harmonics: 5,
                ..SolverOptions::default()
            };
            let linear = LinearMode {
                omega: 1.1,
                damping: 1e-3,
                shape: (0..model.ndof()).map(|k| Complex64::new(1.0 + k as f64, 0.2)).collect(),
                rest: StaticState::default(),
            };
            let gauge = Gauge {
                contact: None,
                reference_dof: 3,
            };
            let (condensed, _) = Condensed::for_mode(&model, &options, (form, false), &linear.shape, &none).unwrap();
            let mut problem = Epmc::new(&condensed, &gauge, &linear, 0, &none).unwrap();
            let n = problem.size();
            let (m, groups) = (problem.group(), condensed.coordinates());
            assert_eq!((n, has_stop), (groups * m + BEHIND, m % 2 == 1));
            let point = |seed: f64| (0..n).map(|k| (1.7 * k as f64 + seed).sin()).collect::<Vec<f64>>();
            let mut at = Residual::new(n).unwrap();
            problem.evaluate(&point(0.0), 0.3, &mut at).unwrap();
            let (mut matrix, mut active) = (vec![0.0; n * n], vec![true; n]);
            problem.fill(&mut matrix, &mut active).unwrap();
            let size = matrix.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
            for part in [m % 2 + 2, m] {
                let order = groups * part + BEHIND;
                let (mut block, mut active) = (vec![0.0; order * order], vec![true; order]);
                problem.fill_block(part, &mut block, &mut active).unwrap();
                let inner: Vec<usize> = (0..n).filter(|k| *k >= groups * m || k % m < part).collect();
                for (q, &column) in inner.iter().enumerate() {
                    for (p, &row) in inner.iter().enumerate() {
                        let (a, b) = (block[q * order + p], matrix[column * n + row]);
                        assert!((a - b).abs() < 1e-13 * size, "{part}: {row}, {column}: {a} {b}");
                    }
                }
            }
            for at in (m % 2..m).step_by(2) {
                let mut pair = vec![Complex64::ZERO; groups * groups];
                problem.fill_pair(at, &mut pair);
                for (k, z) in pair.iter().enumerate() {
                    let (row, column) = (k % groups * m + at, k / groups * m + at);
                    let a = |i: usize, j: usize| matrix[(column + j) * n + row + i];
                    let mean = 0.5 * Complex64::new(a(0, 0) + a(1, 1), a(1, 0) - a(0, 1));
                    assert!((z - mean).norm() < 1e-13 * size, "pair at {at}: {z} {mean}");
                }
            }
            // The matrix that was kept serves after an evaluation elsewhere.
            problem.keep().unwrap();
            problem.evaluate(&point(0.7), 0.4, &mut at).unwrap();
            let (d, mut product) = (point(2.0), vec![0.0; n]);
            problem.multiply(&d, &mut product).unwrap();
            for (row, product) in product.iter().enumerate() {
                let sum: f64 = (0..n).map(|k| matrix[k * n + row] * d[k]).sum();
                assert!((product - sum).abs() < 1e-12 * size, "{row}: {product} {sum}");
            }
            let mut other = vec![0.0; n * n];
            problem.fill(&mut other, &mut active).unwrap();
            let moved = matrix.iter().zip(&other).any(|(a, b)| (a - b).abs() > 1e-6 * size);
            assert!(moved, "both points have one matrix");
        }
    }
}
