//! A sparse matrix from compressed columns of the caller whose rows ascend, without the triplets that others take: of finite
//! elements these are several times as large as the matrix.

use crate::error::{Result, try_room, try_vec};
use crate::linalg::sparse_storage::sparse::{Csc, Symmetry};
use num_complex::Complex64;

const CONTEXT: &str = "a sparse matrix";

/// Compressed columns as the caller stores them, with checked bounds.
pub(crate) struct GivenColumns<'a> {
    pub order: usize,
    pub col_ptr: &'a [i64],
    pub row_idx: &'a [i64],
    pub index_base: i64,
}

impl GivenColumns<'_> {
    /// The matrix, completed by the mirror image of the given triangle if `mirrored` is its symmetry. Entries that
    /// `keep` (row, column) refuses, and zeros, are left out. `None` where rows do not ascend, or an entry is not
    /// finite or outside of the matrix.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn assembled(
        &self,
        value: impl Fn(usize) -> Complex64,
        keep: impl Fn(usize, usize) -> bool,
        mirrored: Option<Symmetry>,
    ) -> Result<Option<Csc>> {
        let n = self.order;
        let mut col_ptr = try_vec(n + 1, 0, CONTEXT)?;
        let mut valid = true;
        self.visit(|k, row, j| match row {
            Some(i) if value(k).is_finite() => {
                if value(k) != Complex64::ZERO && keep(i, j) {
                    col_ptr[j + 1] += 1;
                    if mirrored.is_some() && i != j {
                        col_ptr[i + 1] += 1;
                    }
                }
            }
            _ => valid = false,
        });
        if !valid {
            return Ok(None);
        }
        for j in 0..n {
            col_ptr[j + 1] += col_ptr[j];
        }
        let stored = col_ptr[n];
        let mut next = try_room(n, CONTEXT)?;
        next.extend_from_slice(&col_ptr[..n]);
        let mut row_idx = try_vec(stored, 0, CONTEXT)?;
        let mut values = try_vec(stored, Complex64::ZERO, CONTEXT)?;
        // Column after column: the rows of mirror images ascend too, and lie before or after all others of their column.
        self.visit(|k, row, j| {
            let (Some(i), v) = (row, value(k)) else { return };
            if v == Complex64::ZERO || !keep(i, j) {
                return;
            }
            (row_idx[next[j]], values[next[j]]) = (i, v);
            next[j] += 1;
            if let Some(symmetry) = mirrored.filter(|_| i != j) {
                (row_idx[next[i]], values[next[i]]) = (j, symmetry.mirror(v));
                next[i] += 1;
            }
        });
        Ok(Some(Csc {
            rows: n,
            cols: n,
            col_ptr,
            row_idx,
            values,
        }))
    }

    /// Calls `entry` with position, row and column of each entry, column after column; the row is `None` if it is
    /// outside of the matrix or not above the one before.
    fn visit(&self, mut entry: impl FnMut(usize, Option<usize>, usize)) {
        for (j, ends) in self.col_ptr.windows(2).enumerate() {
            let mut least = 0;
            for k in (ends[0] - self.index_base) as usize..(ends[1] - self.index_base) as usize {
                let row = self.row_idx[k].wrapping_sub(self.index_base);
                let inside = row >= least && row < self.order as i64;
                entry(k, inside.then_some(row as usize), j);
                least = row.saturating_add(1);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both triangles of a Hermitian matrix, and the whole, against triplets; zeros and entries of the other triangle.
    #[test]
    fn sorted_columns_give_the_matrix_of_their_triplets() {
        let n = 9;
        let entry = |i: usize, j: usize| {
            let (low, high) = (i.min(j), i.max(j));
            let size = ((3 * low + 5 * high) as f64).sin();
            let im = if i == j { 0.0 } else { 0.3 * size };
            let z = Complex64::new(size, if i < j { im } else { -im });
            if (low + high) % 3 == 0 { Complex64::ZERO } else { z }
        };
        let whole = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let triplets = whole.clone().map(|(i, j)| (i, j, entry(i, j)));
        let exact = Csc::from_triplets(n, n, triplets.filter(|(_, _, z)| *z != Complex64::ZERO).collect()).unwrap();
        let col_ptr: Vec<i64> = (0..=n).map(|j| (j * n + 1) as i64).collect();
        let row_idx: Vec<i64> = whole.map(|(i, _)| i as i64 + 1).collect();
        let given = GivenColumns {
            order: n,
            col_ptr: &col_ptr,
            row_idx: &row_idx,
            index_base: 1,
        };
        let value = |k: usize| entry(k % n, k / n);
        let kept: [fn(usize, usize) -> bool; 3] = [|_, _| true, |i, j| i >= j, |i, j| i <= j];
        for (keep, mirrored) in kept
            .into_iter()
            .zip([None, Some(Symmetry::Hermitian), Some(Symmetry::Hermitian)])
        {
            let found = given.assembled(value, keep, mirrored).unwrap().unwrap();
            assert_eq!(found, exact);
        }
        let refused = |row_idx: &Vec<i64>, value: fn(usize) -> Complex64| {
            let columns = GivenColumns {
                order: n,
                col_ptr: &col_ptr,
                row_idx,
                index_base: 1,
            };
            columns.assembled(value, |_, _| true, None).unwrap().is_none()
        };
        let one: fn(usize) -> Complex64 = |_| Complex64::ONE;
        assert!(!refused(&row_idx, one));
        for (k, row) in [(4, 4), (4, 0), (80, 10), (7, i64::MIN), (3, i64::MAX)] {
            let mut wrong = row_idx.clone();
            wrong[k] = row;
            assert!(refused(&wrong, one), "{k}, {row}");
        }
        assert!(refused(&row_idx, |k| if k == 50 {
            f64::NAN.into()
        } else {
            Complex64::ONE
        }));
    }
}
