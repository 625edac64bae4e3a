//! Sum of small sparse matrices, as it is made for each harmonic of each small model: entries on the stack, and as bits which
//! of them there are.

use crate::error::{Result, try_room};
use crate::linalg::sparse::{Columns, Csc, Form};
use num_complex::Complex64;

/// Largest order.
pub(super) const LARGEST: usize = 16;

const CONTEXT: &str = "a sum of sparse matrices";

/// Σ cᵢ·form(Aᵢ) over square matrices of one order n, up to [`LARGEST`].
///
/// # Errors
/// `OutOfMemory`.
pub(super) fn small_sum<A: Columns>(n: usize, terms: &[(Complex64, &A, Form)]) -> Result<Csc> {
    let mut columns = [[Complex64::ZERO; LARGEST]; LARGEST];
    // Bit i of number j: whether row i of column j is stored.
    let mut rows = [0_u16; LARGEST];
    for &(c, a, form) in terms {
        for j in 0..n {
            a.visit(j, |i, v| {
                let (row, column) = if form == Form::Transposed { (j, i) } else { (i, j) };
                columns[column][row] += c * if form == Form::Conjugated { v.conj() } else { v };
                rows[column] |= 1 << row;
            });
        }
    }
    let stored = rows.iter().map(|rows| rows.count_ones() as usize).sum();
    let mut sum = Csc {
        rows: n,
        cols: n,
        col_ptr: try_room(n + 1, CONTEXT)?,
        row_idx: try_room(stored, CONTEXT)?,
        values: try_room(stored, CONTEXT)?,
    };
    sum.col_ptr.push(0);
    for (column, rows) in columns.iter().zip(rows).take(n) {
        let mut rest = rows;
        while rest != 0 {
            let row = rest.trailing_zeros() as usize;
            sum.row_idx.push(row);
            sum.values.push(column[row]);
            rest &= rest - 1;
        }
        sum.col_ptr.push(sum.row_idx.len());
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of order `n` whose entries, the same for every order, lie among the first six rows and columns.
    fn matrix(n: usize, which: usize) -> Csc {
        let entries = (0..36).filter(|k| (k * 5 + which * 7) % 11 < 6).map(|k| {
            let angle = (k + 40 * which) as f64;
            (k % 6, k / 6, Complex64::new(angle.sin(), angle.cos()))
        });
        Csc::from_triplets(n, n, entries.collect()).unwrap()
    }

    #[test]
    fn small_sums_are_those_of_large_matrices() {
        let forms = [Form::Plain, Form::Transposed, Form::Conjugated, Form::Transposed];
        let sum = |n: usize, count: usize| {
            let matrices: Vec<Csc> = (0..count).map(|which| matrix(n, which)).collect();
            let factor = |i: usize| Complex64::new(i as f64, 1.0 - i as f64);
            let terms: Vec<_> = matrices
                .iter()
                .enumerate()
                .map(|(i, a)| (factor(i), a, forms[i]))
                .collect();
            Csc::sum(n, &terms).unwrap()
        };
        for count in 1..=forms.len() {
            let (small, large) = (sum(6, count), sum(LARGEST + 1, count));
            assert_eq!(small.col_ptr[..], large.col_ptr[..7]);
            assert_eq!(large.col_ptr[7..], vec![large.col_ptr[6]; LARGEST - 5][..]);
            assert_eq!((small.row_idx, small.values), (large.row_idx, large.values));
        }
    }
}
