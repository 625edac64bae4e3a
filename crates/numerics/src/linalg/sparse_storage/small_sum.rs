//! Sum of small sparse matrices, as it is made for each harmonic of each small model: entries on the stack, and as bits which
//! of them there are.

use crate::error::{Result, try_room};
use num_complex::Complex64;

/// Largest order.
/// Kind: fixed.
pub(crate) const SMALL_SUM_LARGEST: usize = 16;

const CONTEXT: &str = "a sum of sparse matrices";

/// Sum of entries of square matrices of order up to `N`, at most [`SMALL_SUM_LARGEST`]. The type has its own size
/// because clearing room for the largest order takes longer than adding four rows.
pub(crate) struct SmallSum<const N: usize> {
    columns: [[Complex64; N]; N],
    /// Bit i of number j tells whether row i of column j is stored.
    rows: [u16; N],
}

impl<const N: usize> SmallSum<N> {
    /// A sum without entries.
    pub fn new() -> Self {
        Self {
            columns: [[Complex64::ZERO; N]; N],
            rows: [0; N],
        }
    }

    /// Adds an entry to the sum.
    pub fn add(&mut self, row: usize, column: usize, value: Complex64) {
        self.columns[column][row] += value;
        self.rows[column] |= 1 << row;
    }

    /// Compressed form: starts of the `n` columns and their end; row of each entry; value of each entry.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn compressed(&self, n: usize) -> Result<(Vec<usize>, Vec<usize>, Vec<Complex64>)> {
        let stored = self.rows.iter().map(|rows| rows.count_ones() as usize).sum();
        let mut starts = try_room(n + 1, CONTEXT)?;
        let (mut row_idx, mut values) = (try_room(stored, CONTEXT)?, try_room(stored, CONTEXT)?);
        starts.push(0);
        for (column, rows) in self.columns.iter().zip(self.rows).take(n) {
            let mut rest = rows;
            while rest != 0 {
                let row = rest.trailing_zeros() as usize;
                row_idx.push(row);
                values.push(column[row]);
                rest &= rest - 1;
            }
            starts.push(row_idx.len());
        }
        Ok((starts, row_idx, values))
    }
}
