//! Derivatives of a flexibility from modes by the frequency, where contacts are many.
//!
//! The table of [`crate::condense::by_modes::modal_table`] is T = L A⁻¹ Rᴴ with A = d − R_Bᴴ e L_B, whose derivative −L A⁻¹ ∂A A⁻¹ Rᴴ takes as
//! many products of matrices as T itself. A residual and the response need it along one motion: with
//!
//! > A⁻¹ = d⁻¹ + d⁻¹ R_Bᴴ e (1 − G′ e)⁻¹ L_B d⁻¹,  ∂A = ∂d − R_Bᴴ ∂e L_B,
//!
//! and what `low_rank` keeps of T, that takes products with vectors alone.

use crate::condense::by_modes::modal_table::{ModalTable, ModalWork};
use crate::linalg::dense::complex_columns::{self, multiply_adjoint, multiply_adjoint_twice};
use num_complex::Complex64;

impl ModalTable {
    /// ∂x/∂ω of the motions x = H (excitation − w) of contacts and response under contact forces w that do not change, with the
    /// numbers of the last evaluation, at `omega`, in `work`.
    pub fn slope_along(&self, omega: f64, work: &mut ModalWork, w: &[Complex64], change: &mut [Complex64]) {
        let at = self.denominator(omega);
        if work.by_soft {
            return self.slope_by_soft(omega, work, w, change);
        }
        let Some(work) = work.sums.as_deref_mut() else {
            return;
        };
        let frequency = at.frequency();
        let (rows, coordinates) = (self.rows.count(), self.rows.coordinates());
        let (of, order) = (&self.coefficients, self.coefficients.len());
        let [xi, rate] = &mut work.of_modes;
        let [forces, memory, by_rate, of_rate] = &mut work.of_rows;
        // Under −w and e X (1, −w) the motions of the modes are ξ = d⁻¹ Rᴴ f.
        forces.fill(Complex64::ZERO);
        for (force, w) in forces.iter_mut().zip(w) {
            *force = -w;
        }
        if of.counts {
            // ∂ξ = d⁻¹ (∂f + R_Bᴴ ∂e X (1, −w) − ∂d ξ) without the change of the springs' forces by ∂ξ itself.
            let weights = &mut work.of_columns[..=coordinates];
            weights[..coordinates].copy_from_slice(&forces[..coordinates]);
            weights[coordinates] = Complex64::ONE;
            // Without w the columns of the contacts may be those of an earlier frequency.
            let first = if w.is_empty() { coordinates } else { 0 };
            let (inner, moved) = (&work.low_rank.inner()[first * order..], &mut work.of_springs[..]);
            complex_columns::multiply(inner, order, &weights[first..], moved, &mut memory[..order]);
            by_rate.fill(Complex64::ZERO);
            for (b, (x, e)) in moved.iter().zip(work.low_rank.entries()).enumerate() {
                forces[of.row_of(b)] += e * x;
                by_rate[of.row_of(b)] = of.d_entry(b, frequency.slope) * x;
            }
            multiply_adjoint_twice(self.rows.adjoint(), [forces, by_rate], [memory, of_rate], [xi, rate]);
        } else {
            rate.fill(Complex64::ZERO);
            multiply_adjoint(self.rows.adjoint(), forces, memory, xi);
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
            response += work.plain[of.row_of(b) * rows + coordinates] * work.low_rank.entries()[b] * z;
        }
        change[coordinates] = response;
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::condense::by_factors::flexibility::Table;
    use crate::interrupt::Interrupt;

    /// Asserts that the slopes along a motion, and the column of the excitation, are those of the whole table.
    pub fn assert_slopes((by_modes, omega): (&ModalTable, f64), exact: &Table, tolerance: f64) {
        let coordinates = by_modes.rows.coordinates();
        let outputs = coordinates + 1;
        let mut work = ModalWork::default();
        let mut table = Table::new(coordinates).unwrap();
        assert!(
            by_modes
                .evaluate((omega, false), &mut work, &mut table, &Interrupt::none())
                .unwrap()
        );
        if coordinates == 1 {
            return;
        }
        let slopes = exact.slope.chunks_exact(outputs);
        let norm = |of: &[Complex64]| of.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        let size = norm(&exact.slope);
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
        let alone = by_modes.evaluate_excited(omega, &mut work, &mut table, &Interrupt::none());
        assert!(alone.unwrap());
        let first = coordinates * outputs;
        for (found, exact) in [(&table.value, &exact.value), (&table.slope, &exact.slope)] {
            let off = found[first..].iter().zip(&exact[first..]).map(|(a, b)| (a - b).norm());
            let (off, size) = (off.fold(0.0, f64::max), norm(exact));
            assert!(off <= tolerance * size, "excitation at {omega}: {off:e} of {size:e}");
            assert!(found[..first].iter().all(|z| *z == Complex64::ZERO));
        }
    }
}
