//! Compressed sparse columns with complex values: the storage of all structural matrices.

use crate::error::{Result, try_extend, try_push, try_room, try_vec};
use crate::linalg::sparse_storage::small_sum::{self, SmallSum};
use num_complex::Complex64;

/// A square or rectangular matrix in compressed sparse columns, row indices ascending, no
/// duplicates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Csc {
    /// Number of rows of the matrix.
    pub rows: usize,
    /// Number of columns of the matrix.
    pub cols: usize,
    /// Start of each column in [`Self::row_idx`], and the end of the last.
    pub col_ptr: Vec<usize>,
    /// Row of each stored entry.
    pub row_idx: Vec<usize>,
    /// Value of each stored entry.
    pub values: Vec<Complex64>,
}

/// Reads a square matrix column by column.
pub trait Columns {
    /// Number of columns of the matrix.
    fn columns(&self) -> usize;
    /// Number of stored entries.
    fn stored(&self) -> usize;
    /// Calls `take` with row and value of the entries of column `j`, rows ascending.
    fn visit(&self, j: usize, take: impl FnMut(usize, Complex64));
    /// The entry of row `i` and column `j`, zero where none is stored.
    fn get(&self, i: usize, j: usize) -> Complex64;
}

impl Columns for Csc {
    fn columns(&self) -> usize {
        self.cols
    }

    fn stored(&self) -> usize {
        self.values.len()
    }

    fn visit(&self, j: usize, mut take: impl FnMut(usize, Complex64)) {
        self.column(j).for_each(|(i, v)| take(i, v));
    }

    fn get(&self, i: usize, j: usize) -> Complex64 {
        Self::get(self, i, j)
    }
}

/// The position (row, column) with the largest deviation from a symmetry, and the deviation.
#[must_use]
pub fn worst_pair(a: &impl Columns, symmetry: Symmetry) -> (usize, usize, f64) {
    let mut worst = (0, 0, 0.0);
    for j in 0..a.columns() {
        a.visit(j, |i, v| {
            let gap = (v - symmetry.mirror(a.get(j, i))).norm();
            if gap > worst.2 {
                worst = (i, j, gap);
            }
        });
    }
    worst
}

/// The values of a matrix at the entries of `pattern`, which must contain all entries of it.
///
/// # Errors
/// `OutOfMemory`.
pub fn aligned(a: &impl Columns, pattern: &Csc) -> Result<Vec<Complex64>> {
    let mut values = try_vec(pattern.values.len(), Complex64::ZERO, "a sparse matrix")?;
    for j in 0..pattern.cols {
        let mut at = pattern.col_ptr[j];
        a.visit(j, |i, v| {
            while pattern.row_idx[at] < i {
                at += 1;
            }
            values[at] = v;
        });
    }
    Ok(values)
}

/// The transposed matrix Aᵀ.
fn transposed(a: &impl Columns) -> Result<Csc> {
    const CONTEXT: &str = "a sparse matrix";
    let n = a.columns();
    let mut col_ptr = try_vec(n + 1, 0, CONTEXT)?;
    for j in 0..n {
        a.visit(j, |i, _| col_ptr[i + 1] += 1);
    }
    for i in 0..n {
        col_ptr[i + 1] += col_ptr[i];
    }
    let mut next = try_vec(n, 0, CONTEXT)?;
    next.copy_from_slice(&col_ptr[..n]);
    let mut row_idx = try_vec(a.stored(), 0, CONTEXT)?;
    let mut values = try_vec(a.stored(), Complex64::ZERO, CONTEXT)?;
    for j in 0..n {
        a.visit(j, |i, v| {
            (row_idx[next[i]], values[next[i]]) = (j, v);
            next[i] += 1;
        });
    }
    Ok(Csc {
        rows: n,
        cols: n,
        col_ptr,
        row_idx,
        values,
    })
}

/// Entries of the terms above which those of their sum are counted before memory for them.
/// Kind: tuned; measured on: not recorded.
const COUNTED_ABOVE: usize = 4096;

/// Form in which a matrix enters a sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The matrix A itself.
    Plain,
    /// The transposed matrix Aᵀ, not conjugated.
    Transposed,
    /// The complex conjugate matrix, not transposed.
    Conjugated,
}

/// Symmetry of a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symmetry {
    /// Hermitian, A = Aᴴ; real matrices are then symmetric.
    Hermitian,
    /// Symmetric, A = Aᵀ, also where A is complex.
    Plain,
    /// Skew-Hermitian, A = −Aᴴ; real matrices are then skew-symmetric.
    Skew,
    /// No symmetry is known.
    None,
}

impl Symmetry {
    /// The entry at the mirrored position of `v`; for a real entry it is real, without a negative zero.
    #[must_use]
    pub fn mirror(self, v: Complex64) -> Complex64 {
        match self {
            Self::Hermitian => Complex64::new(v.re, 0.0 - v.im),
            Self::Skew => -v.conj(),
            Self::Plain | Self::None => v,
        }
    }
}

/// Visits column `j` of one term of a sum; a transposed term takes the next matrix from `transposed`.
fn visit_term<'a>(
    (a, form): (&impl Columns, Form),
    transposed: &mut impl Iterator<Item = &'a Csc>,
    j: usize,
    take: impl FnMut(usize, Complex64),
) {
    match form {
        Form::Transposed => {
            if let Some(a) = transposed.next() {
                a.visit(j, take);
            }
        }
        Form::Plain | Form::Conjugated => a.visit(j, take),
    }
}

impl Csc {
    /// A matrix from (row, column, value) triplets; duplicates are summed, as in the assembly of finite elements.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn from_triplets(rows: usize, cols: usize, mut entries: Vec<(usize, usize, Complex64)>) -> Result<Self> {
        const CONTEXT: &str = "a sparse matrix";
        entries.sort_unstable_by_key(|&(i, j, _)| (j, i));
        // Their number first: a large matrix in vectors that grow would take up to twice its memory.
        let stored = entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).count();
        let mut a = Self {
            rows,
            cols,
            col_ptr: try_vec(cols + 1, 0, CONTEXT)?,
            row_idx: try_room(stored, CONTEXT)?,
            values: try_room(stored, CONTEXT)?,
        };
        for same in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let (i, j, first) = same[0];
            a.row_idx.push(i);
            a.values.push(same[1..].iter().fold(first, |sum, (_, _, v)| sum + v));
            a.col_ptr[j + 1] += 1;
        }
        for j in 0..cols {
            a.col_ptr[j + 1] += a.col_ptr[j];
        }
        Ok(a)
    }

    /// A matrix whose columns are filled in turn with entries (row, place, value), at most `stored` in all. Entries
    /// of one row are summed in the order of their places, which must differ.
    ///
    /// # Errors
    /// `OutOfMemory`; those of `fill`.
    pub fn from_columns(
        (rows, cols): (usize, usize),
        stored: usize,
        mut fill: impl FnMut(usize, &mut Vec<(usize, usize, Complex64)>) -> Result<()>,
    ) -> Result<Self> {
        const CONTEXT: &str = "a sparse matrix";
        let mut a = Self {
            rows,
            cols,
            col_ptr: try_vec(cols + 1, 0, CONTEXT)?,
            row_idx: try_room(stored, CONTEXT)?,
            values: try_room(stored, CONTEXT)?,
        };
        let mut entries = Vec::new();
        for j in 0..cols {
            entries.clear();
            fill(j, &mut entries)?;
            entries.sort_unstable_by_key(|&(i, place, _)| (i, place));
            for same in entries.chunk_by(|a, b| a.0 == b.0) {
                let (i, _, first) = same[0];
                let sum = same[1..].iter().fold(first, |sum, (_, _, v)| sum + v);
                try_push(&mut a.row_idx, i, CONTEXT)?;
                try_push(&mut a.values, sum, CONTEXT)?;
            }
            a.col_ptr[j + 1] = a.row_idx.len();
        }
        Ok(a)
    }

    /// The zero matrix of order n.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn zero(n: usize) -> Result<Self> {
        Self::from_triplets(n, n, Vec::new())
    }

    /// The sum Σ cᵢ·form(Aᵢ) over square matrices of order n.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn sum<A: Columns>(n: usize, terms: &[(Complex64, &A, Form)]) -> Result<Self> {
        const CONTEXT: &str = "a sum of sparse matrices";
        if terms.iter().all(|(_, a, _)| a.stored() == 0) {
            return Self::zero(n);
        }
        if n <= 4 {
            return Self::small_sum::<4, A>(n, terms);
        }
        if n <= small_sum::SMALL_SUM_LARGEST {
            return Self::small_sum::<{ small_sum::SMALL_SUM_LARGEST }, A>(n, terms);
        }
        let mut mirrored = Vec::new();
        for (_, a, _) in terms.iter().filter(|(_, _, form)| *form == Form::Transposed) {
            try_push(&mut mirrored, transposed(*a)?, CONTEXT)?;
        }
        // Rows of each column by the column that had them last.
        let mut in_column = try_vec(n, 0, CONTEXT)?;
        let mut stored = terms.iter().map(|(_, a, _)| a.stored()).sum();
        if stored > COUNTED_ABOVE {
            // Room that is not too large.
            stored = 0;
            for j in 0..n {
                let mut next = mirrored.iter();
                for &(_, a, form) in terms {
                    visit_term((a, form), &mut next, j, |i, _| {
                        stored += usize::from(in_column[i] != j + 1);
                        in_column[i] = j + 1;
                    });
                }
            }
            in_column.fill(0);
        }
        let mut sum = Self {
            rows: n,
            cols: n,
            col_ptr: try_vec(n + 1, 0, CONTEXT)?,
            row_idx: try_room(stored, CONTEXT)?,
            values: try_room(stored, CONTEXT)?,
        };
        // One column after the other: its entries by their rows, and the rows that it has.
        let mut column = try_vec(n, Complex64::ZERO, CONTEXT)?;
        let mut rows = try_vec(n, 0, CONTEXT)?;
        for j in 0..n {
            let mut count = 0;
            let mut next = mirrored.iter();
            for &(c, a, form) in terms {
                visit_term((a, form), &mut next, j, |i, v| {
                    if in_column[i] != j + 1 {
                        in_column[i] = j + 1;
                        column[i] = Complex64::ZERO;
                        rows[count] = i;
                        count += 1;
                    }
                    column[i] += c * if form == Form::Conjugated { v.conj() } else { v };
                });
            }
            let rows = &mut rows[..count];
            rows.sort_unstable();
            sum.row_idx.extend_from_slice(rows);
            sum.values.extend(rows.iter().map(|&i| column[i]));
            sum.col_ptr[j + 1] = sum.row_idx.len();
        }
        Ok(sum)
    }

    /// The sum of matrices up to the order of [`small_sum`].
    fn small_sum<const N: usize, A: Columns>(n: usize, terms: &[(Complex64, &A, Form)]) -> Result<Self> {
        let mut sum = SmallSum::<N>::new();
        for &(c, a, form) in terms {
            for j in 0..n {
                a.visit(j, |i, v| {
                    let (row, column) = if form == Form::Transposed { (j, i) } else { (i, j) };
                    sum.add(row, column, c * if form == Form::Conjugated { v.conj() } else { v });
                });
            }
        }
        let (col_ptr, row_idx, values) = sum.compressed(n)?;
        Ok(Self {
            rows: n,
            cols: n,
            col_ptr,
            row_idx,
            values,
        })
    }

    /// A copy that returns an error if memory is short.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        const CONTEXT: &str = "a sparse matrix";
        let mut copy = Self {
            rows: self.rows,
            cols: self.cols,
            ..Self::default()
        };
        try_extend(&mut copy.col_ptr, &self.col_ptr, CONTEXT)?;
        try_extend(&mut copy.row_idx, &self.row_idx, CONTEXT)?;
        try_extend(&mut copy.values, &self.values, CONTEXT)?;
        Ok(copy)
    }

    /// Entries of column `j` as (row, value).
    pub fn column(&self, j: usize) -> impl Iterator<Item = (usize, Complex64)> + '_ {
        let range = self.col_ptr[j]..self.col_ptr[j + 1];
        self.row_idx[range.clone()]
            .iter()
            .copied()
            .zip(self.values[range].iter().copied())
    }

    /// y ← y + c·A x.
    pub fn multiply_add(&self, c: Complex64, x: &[Complex64], y: &mut [Complex64]) {
        for (j, &x) in x.iter().enumerate() {
            let cx = c * x;
            for (i, v) in self.column(j) {
                y[i] += v * cx;
            }
        }
    }

    /// The product A x; `context` names the purpose of its memory in an error.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn times(&self, x: &[Complex64], context: &str) -> Result<Vec<Complex64>> {
        let mut y = try_vec(x.len(), Complex64::ZERO, context)?;
        self.multiply_add(Complex64::ONE, x, &mut y);
        Ok(y)
    }

    /// Adds c·A to a dense column-major matrix.
    pub fn add_to_dense(&self, c: Complex64, dense: &mut [Complex64]) {
        for j in 0..self.cols {
            for (i, v) in self.column(j) {
                dense[j * self.rows + i] += c * v;
            }
        }
    }

    /// The values of this matrix at the entries of `pattern`, which must contain all entries of this matrix.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn aligned(&self, pattern: &Self) -> Result<Vec<Complex64>> {
        aligned(self, pattern)
    }

    /// Whether no entry is stored.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Whether every entry is real.
    #[must_use]
    pub fn is_real(&self) -> bool {
        self.values.iter().all(|v| v.im == 0.0)
    }

    /// Largest modulus of an entry.
    #[must_use]
    pub fn max_abs(&self) -> f64 {
        self.values.iter().fold(0.0, |m, v| m.max(v.norm()))
    }

    /// Adds a value to a stored entry; does nothing where the entry is not stored.
    pub fn add_stored(&mut self, i: usize, j: usize, value: Complex64) {
        let range = self.col_ptr[j]..self.col_ptr[j + 1];
        if range.len() == self.rows {
            // A full column.
            self.values[range.start + i] += value;
        } else if let Ok(at) = self.row_idx[range.clone()].binary_search(&i) {
            self.values[range.start + at] += value;
        }
    }

    /// The entry of row `i` and column `j`, zero where none is stored.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> Complex64 {
        let range = self.col_ptr[j]..self.col_ptr[j + 1];
        self.row_idx[range.clone()]
            .binary_search(&i)
            .map_or(Complex64::ZERO, |k| self.values[range.start + k])
    }

    /// The position (row, column) with the largest deviation from A = Aᴴ, and the deviation |aᵢⱼ − conj(aⱼᵢ)|.
    #[must_use]
    pub fn worst_hermitian_pair(&self) -> (usize, usize, f64) {
        self.worst_pair(Symmetry::Hermitian)
    }

    /// The position (row, column) with the largest deviation from a given symmetry, and the deviation.
    #[must_use]
    pub fn worst_pair(&self, symmetry: Symmetry) -> (usize, usize, f64) {
        worst_pair(self, symmetry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of order `n` whose entries, the same for every order, lie among the first `used` rows and columns.
    fn matrix(n: usize, used: usize, which: usize) -> Csc {
        let entries = (0..used * used).filter(|k| (k * 5 + which * 7) % 11 < 6).map(|k| {
            let angle = (k + 40 * which) as f64;
            (k % used, k / used, Complex64::new(angle.sin(), angle.cos()))
        });
        Csc::from_triplets(n, n, entries.collect()).unwrap()
    }

    #[test]
    fn small_sums_are_those_of_large_matrices() {
        let forms = [Form::Plain, Form::Transposed, Form::Conjugated, Form::Transposed];
        let sum = |n: usize, used: usize, count: usize| {
            let matrices: Vec<Csc> = (0..count).map(|which| matrix(n, used, which)).collect();
            let factor = |i: usize| Complex64::new(i as f64, 1.0 - i as f64);
            let terms: Vec<_> = matrices
                .iter()
                .enumerate()
                .map(|(i, a)| (factor(i), a, forms[i]))
                .collect();
            Csc::sum(n, &terms).unwrap()
        };
        for count in 1..=forms.len() {
            for n in [4, 6] {
                let (small, large) = (sum(n, n, count), sum(small_sum::SMALL_SUM_LARGEST + 1, n, count));
                assert_eq!(small.col_ptr[..], large.col_ptr[..=n]);
                assert_eq!(
                    large.col_ptr[n..],
                    vec![large.col_ptr[n]; small_sum::SMALL_SUM_LARGEST + 2 - n][..]
                );
                assert_eq!((small.row_idx, small.values), (large.row_idx, large.values));
            }
        }
    }
}
