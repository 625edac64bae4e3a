//! Derivatives of a flexibility from modes by the frequency, where contacts are many.
//!
//! The table of [`crate::condense::by_modes::modal_table`] is T = L A⁻¹ Rᴴ with A = d − R_Bᴴ e L_B, whose derivative −L A⁻¹ ∂A A⁻¹ Rᴴ takes as
//! many products of matrices as T itself. A residual needs it along one motion, and the response its own row: with
//!
//! > A⁻¹ = d⁻¹ + d⁻¹ R_Bᴴ e (1 − G′ e)⁻¹ L_B d⁻¹,  ∂A = ∂d − R_Bᴴ ∂e L_B,
//!
//! and what `low_rank` keeps of T, both take products with vectors alone.

use crate::condense::by_factors::flexibility::Table;
use crate::condense::by_modes::modal_table::{ModalTable, ModalWork, Work};
use crate::condense::by_modes::mode_sums::multiply_adjoint;
use crate::condense::by_modes::sum_terms::Denominator;
use crate::linalg::dense::complex_columns;
use num_complex::Complex64;

impl ModalTable {
    /// The last row of ∂H/∂ω, that of the response l: q = l A⁻¹, then −q ∂A A⁻¹ Rᴴ. The other rows are left as they are.
    pub(crate) fn fill_slopes_of_response(&self, work: &mut Work, (at, omega): (Denominator, f64), table: &mut Table) {
        let (rows, coordinates) = (self.rows.count(), self.rows.coordinates());
        let (of, order) = (&self.coefficients, self.coefficients.len());
        let frequency = at.frequency();
        let [q, moved] = &mut work.of_modes;
        let [weights, memory] = &mut work.of_rows;
        // The rows of l + T′_lB e (1 − G′ e)⁻¹ L_B, conjugate as multiply_adjoint takes them.
        weights.fill(Complex64::ZERO);
        weights[coordinates] = Complex64::ONE;
        if of.counts {
            for (b, y) in work.of_springs.iter_mut().enumerate() {
                *y = work.plain[of.row_of(b) * rows + coordinates] * of.entry(b, frequency.at);
            }
            work.low_rank.solve_row(&mut work.of_springs);
            for (b, y) in work.of_springs.iter().enumerate() {
                weights[of.row_of(b)] = y.conj();
            }
        }
        multiply_adjoint(self.rows.left(), weights, memory, q);
        for (q, inverse) in q.iter_mut().zip(&work.inverse) {
            *q = q.conj() * inverse;
        }
        // −q ∂A, with q R_Bᴴ ∂e as the weights of L_B.
        moved.fill(Complex64::ZERO);
        if of.counts {
            self.multiply_rows(q, weights, memory);
            weights[coordinates] = Complex64::ZERO;
            for b in 0..order {
                let weight = &mut weights[of.row_of(b)];
                *weight = (*weight * of.d_entry(b, frequency.slope)).conj();
            }
            multiply_adjoint(self.rows.left(), weights, memory, moved);
        }
        let mut excited = Complex64::ZERO;
        for (k, ((moved, q), inverse)) in moved.iter_mut().zip(q.iter()).zip(&work.inverse).enumerate() {
            *moved = (moved.conj() - q * (at.d_a - at.d_b * self.rows.source().value(k))) * inverse;
            let [force, rate] = self.excitation(k, omega);
            excited += *moved * force + q * rate;
        }
        self.multiply_rows(moved, weights, memory);
        let columns = table.slope.chunks_exact_mut(coordinates + 1);
        for (k, column) in columns.enumerate() {
            let mut sum = if k < coordinates { weights[k] } else { excited };
            if of.counts {
                let forces = &work.low_rank.force()[k * order..(k + 1) * order];
                for (b, force) in forces.iter().enumerate() {
                    sum += weights[of.row_of(b)] * force;
                }
            }
            column[coordinates] = sum;
        }
    }

    /// ∂x/∂ω of the motions x = H (excitation − w) of contacts and response under contact forces w that do not change, with the
    /// numbers of the last evaluation, at `omega`, in `work`.
    pub fn slope_along(&self, omega: f64, work: &mut ModalWork, w: &[Complex64], change: &mut [Complex64]) {
        let Some(work) = work.0.as_deref_mut() else {
            return;
        };
        let at = self.denominator(omega);
        let frequency = at.frequency();
        let (rows, coordinates) = (self.rows.count(), self.rows.coordinates());
        let (of, order) = (&self.coefficients, self.coefficients.len());
        let [xi, rate] = &mut work.of_modes;
        let [forces, memory] = &mut work.of_rows;
        // Under −w and e X (1, −w) the motions of the modes are ξ = d⁻¹ Rᴴ f.
        forces.fill(Complex64::ZERO);
        for (force, w) in forces.iter_mut().zip(w) {
            *force = -w;
        }
        let columns = |of: &[Complex64], b: usize| {
            let by_contacts: Complex64 = w.iter().enumerate().map(|(k, w)| of[k * order + b] * w).sum();
            of[coordinates * order + b] - by_contacts
        };
        if of.counts {
            for b in 0..order {
                forces[of.row_of(b)] += columns(work.low_rank.force(), b);
            }
        }
        multiply_adjoint(self.rows.adjoint(), forces, memory, xi);
        // ∂ξ = d⁻¹ (∂f + R_Bᴴ ∂e X (1, −w) − ∂d ξ) without the change of the springs' forces by ∂ξ itself.
        rate.fill(Complex64::ZERO);
        if of.counts {
            forces.fill(Complex64::ZERO);
            for b in 0..order {
                forces[of.row_of(b)] = of.d_entry(b, frequency.slope) * columns(work.low_rank.inner(), b);
            }
            multiply_adjoint(self.rows.adjoint(), forces, memory, rate);
        }
        for (k, ((rate, xi), inverse)) in rate.iter_mut().zip(xi.iter()).zip(&work.inverse).enumerate() {
            let [force, d_force] = self.excitation(k, omega);
            let xi = (xi + force) * inverse;
            *rate = (*rate + d_force - (at.d_a - at.d_b * self.rows.source().value(k)) * xi) * inverse;
        }
        complex_columns::multiply(self.rows.left(), rows, rate, forces, memory);
        if !of.counts {
            change.copy_from_slice(&forces[..=coordinates]);
            return;
        }
        for (b, z) in work.of_springs.iter_mut().enumerate() {
            *z = forces[of.row_of(b)];
        }
        work.low_rank.solve_rows(&mut work.of_springs);
        change[..coordinates].copy_from_slice(&work.of_springs[..coordinates]);
        let mut response = forces[coordinates];
        for (b, z) in work.of_springs.iter().enumerate() {
            response += work.plain[of.row_of(b) * rows + coordinates] * of.entry(b, frequency.at) * z;
        }
        change[coordinates] = response;
    }

    /// out ← v Rᴴ for a row v of numbers of the modes.
    fn multiply_rows(&self, v: &mut [Complex64], out: &mut [Complex64], memory: &mut [Complex64]) {
        let conjugate = |numbers: &mut [Complex64]| {
            for z in numbers {
                *z = z.conj();
            }
        };
        conjugate(v);
        complex_columns::multiply(self.rows.adjoint(), self.rows.count(), v, out, memory);
        conjugate(v);
        conjugate(out);
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::condense::by_factors::flexibility::Slopes;
    use crate::interrupt::Interrupt;

    /// Asserts that the slopes of the response, and those along a motion, are those of the whole table.
    pub fn assert_slopes((by_modes, omega): (&ModalTable, f64), exact: &Table, tolerance: f64) {
        let coordinates = by_modes.rows.coordinates();
        let outputs = coordinates + 1;
        let mut work = ModalWork::default();
        let mut table = Table::new(coordinates).unwrap();
        let at = (omega, Slopes::OfResponse);
        assert!(
            by_modes
                .evaluate(at, &mut work, &mut table, &Interrupt::none())
                .unwrap()
        );
        let slopes = exact.slope.chunks_exact(outputs);
        let size = exact.slope.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        for (found, exact) in table.slope.chunks_exact(outputs).zip(slopes.clone()) {
            let off = (found[coordinates] - exact[coordinates]).norm();
            assert!(off <= tolerance * size, "response at {omega}: {found:?} {exact:?}");
            assert!(coordinates == 1 || found[..coordinates].iter().all(|z| *z == Complex64::ZERO));
        }
        if coordinates == 1 {
            return;
        }
        let w: Vec<Complex64> = (0..coordinates)
            .map(|c| Complex64::cis(1.9 * c as f64 + 0.4) * (1.0 + c as f64))
            .collect();
        let mut along = vec![Complex64::ZERO; outputs];
        by_modes.slope_along(omega, &mut work, &w, &mut along);
        for (r, found) in along.iter().enumerate() {
            let by_contacts: Complex64 = w.iter().zip(slopes.clone()).map(|(w, column)| w * column[r]).sum();
            let exact = exact.slope[coordinates * outputs + r] - by_contacts;
            assert!(
                (found - exact).norm() <= tolerance * size * w.len() as f64,
                "{r} at {omega}: {found} {exact}"
            );
        }
    }
}
