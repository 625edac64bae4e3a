//! Hermitian sparse matrices by their lower triangles, in real numbers where they are real: half the entries, and half
//! the memory of each.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Error, Result, try_room, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::exact_sums::compensated_sum::Sum;
use crate::linalg::sparse_storage::row_index::{Row, check_order, narrow};
use crate::linalg::sparse_storage::sparse::Columns;
use faer::traits::ComplexField;
use num_complex::Complex64;

const CONTEXT: &str = "a Hermitian matrix";

/// Real or complex number as an entry of a matrix.
pub trait Entry:
    ComplexField + Copy + Send + Sync + core::ops::AddAssign + core::ops::Mul<Output = Self> + 'static
{
    /// The number zero.
    const NONE: Self;
    /// Whether the type has imaginary parts.
    const IS_COMPLEX: bool;
    /// The number of this type from a complex one; a real type drops the imaginary part.
    fn of(z: Complex64) -> Self;
    /// The number as a complex one.
    fn complex(self) -> Complex64;
    /// The number times a real factor.
    #[must_use]
    fn scaled(self, factor: f64) -> Self;
    /// self ← self + a b.
    fn add_product(&mut self, a: Self, b: Self);
    /// self ← self + conj(a) b.
    fn add_conjugate_product(&mut self, a: Self, b: Self);
    /// The complex conjugate number.
    #[must_use]
    fn conjugated(self) -> Self;
    /// sum ← sum + self b, for real and imaginary part, with the rounding errors of both kept.
    fn add_exactly(self, b: Self, sum: &mut [Sum; 2]);
}

impl Entry for f64 {
    const NONE: Self = 0.0;
    const IS_COMPLEX: bool = false;

    #[inline]
    fn of(z: Complex64) -> Self {
        z.re
    }

    #[inline]
    fn complex(self) -> Complex64 {
        Complex64::new(self, 0.0)
    }

    #[inline]
    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    #[inline]
    fn add_product(&mut self, a: Self, b: Self) {
        *self += a * b;
    }

    #[inline]
    fn add_conjugate_product(&mut self, a: Self, b: Self) {
        *self += a * b;
    }

    #[inline]
    fn conjugated(self) -> Self {
        self
    }

    #[inline(always)]
    fn add_exactly(self, b: Self, [re, _]: &mut [Sum; 2]) {
        re.add_fused(self, b);
    }
}

impl Entry for Complex64 {
    const NONE: Self = Self::ZERO;
    const IS_COMPLEX: bool = true;

    #[inline]
    fn of(z: Complex64) -> Self {
        z
    }

    #[inline]
    fn complex(self) -> Complex64 {
        self
    }

    #[inline]
    fn scaled(self, factor: f64) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    #[inline]
    fn add_product(&mut self, a: Self, b: Self) {
        self.re += a.re * b.re - a.im * b.im;
        self.im += a.re * b.im + a.im * b.re;
    }

    #[inline]
    fn add_conjugate_product(&mut self, a: Self, b: Self) {
        self.re += a.re * b.re + a.im * b.im;
        self.im += a.re * b.im - a.im * b.re;
    }

    #[inline]
    fn conjugated(self) -> Self {
        self.conj()
    }

    #[inline(always)]
    fn add_exactly(self, b: Self, [re, im]: &mut [Sum; 2]) {
        re.add_fused(self.re, b.re);
        re.add_fused(-self.im, b.im);
        im.add_fused(self.re, b.im);
        im.add_fused(self.im, b.re);
    }
}

/// The lower triangle of a Hermitian matrix, column by column.
#[derive(Clone, Debug)]
pub struct Triangle<T> {
    /// Order of the matrix.
    pub n: usize,
    /// Start of each column, and the end of the last.
    pub col_ptr: Vec<usize>,
    /// Row of each entry, ascending in a column.
    pub row_idx: Vec<Row>,
    /// Value of each entry.
    pub values: Vec<T>,
}

/// Reads the lower triangle alone.
impl<T: Entry> Columns for Triangle<T> {
    fn columns(&self) -> usize {
        self.n
    }

    fn stored(&self) -> usize {
        self.values.len()
    }

    fn visit(&self, j: usize, mut take: impl FnMut(usize, Complex64)) {
        for at in self.col_ptr[j]..self.col_ptr[j + 1] {
            take(self.row_idx[at] as usize, self.values[at].complex());
        }
    }

    fn get(&self, i: usize, j: usize) -> Complex64 {
        let column = self.col_ptr[j]..self.col_ptr[j + 1];
        let place = self.row_idx[column.clone()].binary_search_by(|row| (*row as usize).cmp(&i));
        place.map_or(Complex64::ZERO, |at| self.values[column.start + at].complex())
    }
}

impl<T: Entry> Triangle<T> {
    /// The lower triangle of K + σM, without copies of the whole.
    ///
    /// # Errors
    /// `Dimension` for 2³² rows or more; `OutOfMemory`; `StoppedByCaller`.
    pub fn sum(k: &impl Columns, (shift, m): (f64, &impl Columns), interrupt: &Interrupt<'_>) -> Result<Self> {
        let n = k.columns();
        check_order(n)?;
        let (mut of_k, mut of_m) = (Vec::new(), Vec::new());
        // First the size, so that nothing is allocated twice.
        let mut count = 0;
        let mut col_ptr = try_vec(n + 1, 0, CONTEXT)?;
        for j in 0..n {
            merge(below(k, j, &mut of_k)?, below(m, j, &mut of_m)?, |_, _, _| count += 1);
            col_ptr[j + 1] = count;
        }
        let mut row_idx = try_room(count, CONTEXT)?;
        let mut values = try_room(count, CONTEXT)?;
        for j in 0..n {
            if j % 1024 == 0 {
                interrupt.check()?;
            }
            merge(below(k, j, &mut of_k)?, below(m, j, &mut of_m)?, |i, a, b| {
                let mut value = a + shift * b;
                if i == j {
                    value.im = 0.0;
                }
                row_idx.push(narrow(i));
                values.push(T::of(value));
            });
        }
        Ok(Self {
            n,
            col_ptr,
            row_idx,
            values,
        })
    }
}

/// Row and value of an entry.
type RowEntry = (usize, Complex64);

/// The entries of column j on and below the diagonal.
fn below<'a>(a: &impl Columns, j: usize, column: &'a mut Vec<RowEntry>) -> Result<&'a [RowEntry]> {
    column.clear();
    let mut count = 0;
    a.visit(j, |i, _| count += usize::from(i >= j));
    column.try_reserve(count).map_err(|_| Error::out_of_memory(CONTEXT))?;
    a.visit(j, |i, v| {
        if i >= j {
            column.push((i, v));
        }
    });
    Ok(column)
}

/// Calls `take` with (row, entry of `a`, entry of `b`) for each row that occurs in either column.
fn merge(mut a: &[RowEntry], mut b: &[RowEntry], mut take: impl FnMut(usize, Complex64, Complex64)) {
    while !(a.is_empty() && b.is_empty()) {
        let first = |column: &[RowEntry]| column.first().map_or(usize::MAX, |&(i, _)| i);
        let row = first(a).min(first(b));
        let next = |column: &mut &[RowEntry]| match column.split_first() {
            Some((&(i, v), rest)) if i == row => {
                *column = rest;
                v
            }
            _ => Complex64::ZERO,
        };
        let (x, y) = (next(&mut a), next(&mut b));
        take(row, x, y);
    }
}
