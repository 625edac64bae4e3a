//! Sparse matrices as a model keeps them: rows in 32 bits, and real numbers where all entries are real. A real
//! matrix takes half the memory that it takes as a [`Csc`], the form of computations.

use crate::error::{Result, try_copy, try_room};
use crate::linalg::sparse_storage::row_index::{Row, narrowed, wide};
use crate::linalg::sparse_storage::sparse::{Columns, Csc, Symmetry, worst_pair};
use num_complex::Complex64;

const CONTEXT: &str = "a matrix of the model";

/// A square matrix in compressed sparse columns, row indices ascending, no duplicates.
#[derive(Clone, Debug)]
pub struct KeptMatrix {
    /// Start of each column, and the end of the last.
    col_ptr: Vec<usize>,
    rows: Vec<Row>,
    values: Numbers,
}

#[derive(Clone, Debug)]
enum Numbers {
    /// Real values: the imaginary part of each entry is a positive zero.
    Real(Vec<f64>),
    Complex(Vec<Complex64>),
}

impl KeptMatrix {
    /// Keeps the entries of a square matrix, unchanged to the bit.
    ///
    /// # Errors
    /// `Dimension` for 2³² rows or more; `OutOfMemory`.
    pub fn new(a: Csc) -> Result<Self> {
        let Csc {
            rows: order,
            col_ptr,
            row_idx,
            values,
            ..
        } = a;
        let rows = narrowed(&row_idx, order, CONTEXT)?;
        drop(row_idx);
        // A negative zero is an imaginary part, too: all bits come back.
        let values = if values.iter().all(|v| v.im.to_bits() == 0) {
            let mut real = try_room(values.len(), CONTEXT)?;
            real.extend(values.iter().map(|v| v.re));
            Numbers::Real(real)
        } else {
            Numbers::Complex(values)
        };
        Ok(Self { col_ptr, rows, values })
    }

    /// A copy that returns an error if memory is short.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            col_ptr: try_copy(&self.col_ptr, CONTEXT)?,
            rows: try_copy(&self.rows, CONTEXT)?,
            values: match &self.values {
                Numbers::Real(values) => Numbers::Real(try_copy(values, CONTEXT)?),
                Numbers::Complex(values) => Numbers::Complex(try_copy(values, CONTEXT)?),
            },
        })
    }

    /// The matrix as compressed sparse columns with complex values, for computations.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn expanded(&self) -> Result<Csc> {
        let order = self.order();
        let mut row_idx = try_room(self.rows.len(), CONTEXT)?;
        let mut values = try_room(self.rows.len(), CONTEXT)?;
        for j in 0..order {
            self.visit(j, |i, v| {
                row_idx.push(i);
                values.push(v);
            });
        }
        Ok(Csc {
            rows: order,
            cols: order,
            col_ptr: try_copy(&self.col_ptr, CONTEXT)?,
            row_idx,
            values,
        })
    }

    /// Number of rows and columns.
    #[must_use]
    pub fn order(&self) -> usize {
        self.col_ptr.len().saturating_sub(1)
    }

    /// Number of entries of each column.
    pub fn lengths(&self) -> impl Iterator<Item = usize> + '_ {
        self.col_ptr.windows(2).map(|ends| ends[1] - ends[0])
    }

    /// Row of each entry, column after column.
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The entries as real numbers; `None` where one has an imaginary part, a negative zero included.
    #[must_use]
    pub fn real_values(&self) -> Option<&[f64]> {
        match &self.values {
            Numbers::Real(values) => Some(values),
            Numbers::Complex(_) => None,
        }
    }

    /// Entries of column `j` as (row, value).
    pub fn column(&self, j: usize) -> impl Iterator<Item = (usize, Complex64)> + '_ {
        (self.col_ptr[j]..self.col_ptr[j + 1]).map(|k| (wide(self.rows[k]), self.value(k)))
    }

    fn value(&self, k: usize) -> Complex64 {
        match &self.values {
            Numbers::Real(values) => values[k].into(),
            Numbers::Complex(values) => values[k],
        }
    }

    /// Whether no entry is stored.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Whether every entry is real.
    #[must_use]
    pub fn is_real(&self) -> bool {
        match &self.values {
            Numbers::Real(_) => true,
            Numbers::Complex(values) => values.iter().all(|v| v.im == 0.0),
        }
    }

    /// Largest modulus of an entry.
    #[must_use]
    pub fn max_abs(&self) -> f64 {
        (0..self.rows.len()).fold(0.0, |m, k| m.max(self.value(k).norm()))
    }

    /// The position (row, column) with the largest deviation from a symmetry, and the deviation.
    #[must_use]
    pub fn worst_pair(&self, symmetry: Symmetry) -> (usize, usize, f64) {
        worst_pair(self, symmetry)
    }

    /// A ← cA with a real factor c.
    pub fn scale(&mut self, factor: f64) {
        match &mut self.values {
            Numbers::Real(values) => values.iter_mut().for_each(|v| *v *= factor),
            Numbers::Complex(values) => values.iter_mut().for_each(|v| *v *= factor),
        }
    }
}

impl Columns for KeptMatrix {
    fn columns(&self) -> usize {
        self.order()
    }

    fn stored(&self) -> usize {
        self.rows.len()
    }

    fn visit(&self, j: usize, mut take: impl FnMut(usize, Complex64)) {
        let range = self.col_ptr[j]..self.col_ptr[j + 1];
        let rows = self.rows[range.clone()].iter().map(|&row| wide(row));
        match &self.values {
            Numbers::Real(values) => rows.zip(&values[range]).for_each(|(i, v)| take(i, (*v).into())),
            Numbers::Complex(values) => rows.zip(&values[range]).for_each(|(i, v)| take(i, *v)),
        }
    }

    fn get(&self, i: usize, j: usize) -> Complex64 {
        let range = self.col_ptr[j]..self.col_ptr[j + 1];
        self.rows[range.clone()]
            .binary_search_by(|&row| wide(row).cmp(&i))
            .map_or(Complex64::ZERO, |k| self.value(range.start + k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse_storage::sparse::Form;

    /// A matrix of order 30 with a third of its entries, real or not; `signed` turns one imaginary part to −0.
    fn matrix(complex: bool, signed: bool) -> Csc {
        let n = 30;
        let entry = |i: usize, j: usize| {
            let (re, im) = (((3 * i + 7 * j) as f64).sin(), ((5 * i + 2 * j) as f64).cos());
            Complex64::new(re, if complex { im } else { 0.0 })
        };
        let places = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let places = places.filter(|(i, j)| (i * j + i + 2 * j) % 3 == 0);
        let mut a = Csc::from_triplets(n, n, places.map(|(i, j)| (i, j, entry(i, j))).collect()).unwrap();
        if signed {
            a.values[11].im = -0.0;
        }
        a
    }

    fn bits(a: &Csc) -> Vec<[u64; 2]> {
        a.values.iter().map(|v| [v.re.to_bits(), v.im.to_bits()]).collect()
    }

    #[test]
    fn all_bits_of_a_matrix_come_back_and_its_sums_are_the_same() {
        for (complex, signed) in [(false, false), (false, true), (true, false)] {
            let a = matrix(complex, signed);
            let kept = KeptMatrix::new(a.try_clone().unwrap()).unwrap();
            let back = kept.expanded().unwrap();
            assert_eq!((&back, bits(&back)), (&a, bits(&a)));
            assert_eq!(kept.real_values().is_some(), !complex && !signed);
            assert_eq!((kept.is_real(), kept.is_empty()), (a.is_real(), false));
            assert_eq!(kept.max_abs().to_bits(), a.max_abs().to_bits());
            for symmetry in [Symmetry::Hermitian, Symmetry::Plain, Symmetry::Skew] {
                assert_eq!(kept.worst_pair(symmetry), a.worst_pair(symmetry));
            }
            for j in 0..30 {
                assert!(kept.column(j).eq(a.column(j)));
                assert!((0..30).all(|i| Columns::get(&kept, i, j) == a.get(i, j)));
            }
            let turn = Complex64::cis(0.3);
            let forms = [Form::Plain, Form::Transposed, Form::Conjugated];
            let sum = Csc::sum(30, &forms.map(|form| (turn, &kept, form))).unwrap();
            let exact = Csc::sum(30, &forms.map(|form| (turn, &a, form))).unwrap();
            assert_eq!((&sum, bits(&sum)), (&exact, bits(&exact)));
        }
    }

    #[test]
    fn a_real_matrix_takes_half_the_memory() {
        let kept = KeptMatrix::new(matrix(false, false)).unwrap();
        let (rows, values) = (kept.rows(), kept.real_values().unwrap());
        assert_eq!(2 * (size_of_val(rows) + size_of_val(values)), 24 * kept.stored());
    }
}
