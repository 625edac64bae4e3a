//! Tables of a symmetric structure without the half that mirrors the other.
//!
//! Where Z is symmetric and W real, the flexibility of the contacts W Z⁻¹ Wᵀ is symmetric: of column j the rows from j on are kept,
//! with the row of the response; of the last column, the excitation, all rows.

use crate::condense::{Artificial, HarmonicBlock};
use crate::model::reduced_wave::MotionRow;
use num_complex::Complex64;

/// Columns that are mirrored at a time: what is read and written stays in the innermost memory of the processor.
const AT_ONCE: usize = 16;

/// Largest difference of mirrored entries over the largest entry that is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The numbers of a table that are kept.
#[derive(Clone, Copy)]
pub struct TableLayout {
    outputs: usize,
    is_symmetric: bool,
}

impl TableLayout {
    /// The layout of tables of `coordinates` contacts.
    #[must_use]
    pub fn new(coordinates: usize, is_symmetric: bool) -> Self {
        Self {
            outputs: coordinates + 1,
            is_symmetric,
        }
    }

    /// Whether a half is left out.
    #[must_use]
    pub fn is_symmetric(self) -> bool {
        self.is_symmetric
    }

    /// Number of parts with a size of their own: the columns, and the response under contact forces and under the excitation.
    #[must_use]
    pub fn parts(self) -> usize {
        self.outputs + 2
    }

    /// Numbers that are kept.
    #[must_use]
    pub fn size(self) -> usize {
        self.columns().map(|(_, from)| self.outputs - from).sum()
    }

    /// The columns, each with its first row that is kept.
    pub fn columns(self) -> impl Iterator<Item = (usize, usize)> {
        let half = self.is_symmetric;
        (0..self.outputs).map(move |j| (j, if half && j + 1 < self.outputs { j } else { 0 }))
    }

    /// The kept numbers of a table.
    pub fn pack(self, table: &[Complex64], packed: &mut [Complex64]) {
        let mut to = 0;
        for (j, from) in self.columns() {
            let kept = &table[j * self.outputs + from..(j + 1) * self.outputs];
            packed[to..to + kept.len()].copy_from_slice(kept);
            to += kept.len();
        }
    }

    /// The table of kept numbers.
    pub fn unpack(self, packed: &[Complex64], table: &mut [Complex64]) {
        let (outputs, n) = (self.outputs, self.outputs - 1);
        let mut at = 0;
        for (j, from) in self.columns() {
            let kept = &mut table[j * outputs + from..(j + 1) * outputs];
            kept.copy_from_slice(&packed[at..at + kept.len()]);
            at += kept.len();
        }
        if !self.is_symmetric {
            return;
        }
        for first in (0..n).step_by(AT_ONCE) {
            let end = n.min(first + AT_ONCE);
            for k in first + 1..n {
                for column in first..end.min(k) {
                    table[k * outputs + column] = table[column * outputs + k];
                }
            }
        }
    }
}

/// Whether the flexibility of a harmonic is symmetric.
#[must_use]
pub fn is_symmetric(block: &HarmonicBlock) -> bool {
    let reference = &block.reference;
    let on_pattern = |values: &[Complex64]| {
        let entry = |i: usize, j: usize| {
            let rows = &reference.row_idx[reference.col_ptr[j]..reference.col_ptr[j + 1]];
            rows.binary_search(&i)
                .map_or(Complex64::ZERO, |at| values[reference.col_ptr[j] + at])
        };
        let largest = values.iter().fold(0.0_f64, |most, v| most.max(v.norm()));
        (0..reference.cols).all(|j| {
            let own = reference.col_ptr[j]..reference.col_ptr[j + 1];
            own.into_iter()
                .all(|at| (values[at] - entry(j, reference.row_idx[at])).norm() <= ROUNDING * largest)
        })
    };
    let is_real = |row: &MotionRow| row.terms().all(|(_, a)| a.im == 0.0);
    block.tied.is_none()
        && matches!(block.artificial, Artificial::None)
        && block.rows.iter().all(is_real)
        && [&reference.values, &block.mass, &block.damping]
            .into_iter()
            .all(|values| on_pattern(values))
}

/// Largest relative deviation of a column of a table of so many rows from that of another one.
#[must_use]
pub fn deviation(a: &[Complex64], b: &[Complex64], outputs: usize) -> f64 {
    let mut largest = 0.0_f64;
    for (a, b) in a.chunks_exact(outputs).zip(b.chunks_exact(outputs)) {
        let off: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_sqr()).sum();
        let size: f64 = b.iter().map(Complex64::norm_sqr).sum();
        if off > 0.0 || off.is_nan() {
            largest = largest.max((off / size).sqrt());
            if off.is_nan() || size == 0.0 {
                return f64::INFINITY;
            }
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Condensed;
    use crate::condense::test_chains::{DAMPED, chain};
    use crate::interrupt::Interrupt;
    use crate::options::{DampingForm, SolverOptions};

    #[test]
    fn structures_are_symmetric_and_waves_of_a_wheel_are_not() {
        let shape = [Complex64::ONE; crate::condense::test_chains::N];
        let form = (DampingForm::Mass, false);
        for sectors in [1, 24] {
            for (damping, loss_factor) in DAMPED {
                let mut model = chain(sectors, damping);
                model.set_loss_factor(loss_factor).unwrap();
                let options = SolverOptions::default();
                let (condensed, _) = Condensed::for_mode(&model, &options, form, &shape, &Interrupt::none()).unwrap();
                for block in condensed.blocks() {
                    let mut forced = block.clone();
                    forced.artificial = Artificial::None;
                    // Waves of the mean and of half the sectors are standing ones.
                    let stands = forced.next.im.abs() < 1e-12;
                    assert_eq!(
                        is_symmetric(&forced),
                        stands,
                        "{sectors} sectors, harmonic {}",
                        forced.number
                    );
                }
            }
        }
    }

    #[test]
    fn a_symmetric_table_comes_back_from_its_half() {
        for coordinates in [0, 1, 2, 5, 15, 16, 17, 40] {
            let outputs = coordinates + 1;
            let value = |i: usize, j: usize| {
                let (a, b) = if j < coordinates && i < coordinates {
                    (i.min(j), i.max(j))
                } else {
                    (j, i)
                };
                Complex64::new(1.0 + a as f64, 0.5 + b as f64 * 3.0)
            };
            let table: Vec<Complex64> = (0..outputs * outputs)
                .map(|k| value(k % outputs, k / outputs))
                .collect();
            for half in [false, true] {
                let layout = TableLayout::new(coordinates, half);
                let mut packed = vec![Complex64::ZERO; layout.size()];
                layout.pack(&table, &mut packed);
                let expected = if half {
                    coordinates * (coordinates + 1) / 2 + coordinates + outputs
                } else {
                    outputs * outputs
                };
                assert_eq!(packed.len(), expected);
                let mut found = vec![Complex64::ZERO; table.len()];
                layout.unpack(&packed, &mut found);
                assert_eq!(found, table, "{coordinates}, {half}");
            }
        }
    }
}
