//! Products with Hermitian matrices whose rows are compensated sums: the smallest stiffness of a structure survives next to its
//! largest one.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::exact_sums::compensated_sum::Sum;
use crate::linalg::sparse_storage::row_index::wide;
use crate::linalg::sparse_storage::triangle::{Entry, Triangle};
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Operations of a product and its sum, relative to plain ones.
/// Kind: block.
const OPERATIONS: u64 = 8;

/// Rows of a sum of products A x, as compensated sums of real and imaginary parts.
#[derive(Debug)]
pub struct Rows(Vec<[Sum; 2]>);

impl Rows {
    /// Rows of zeros.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        Ok(Self(try_vec(n, [Sum::default(); 2], "a product")?))
    }

    /// Adds the product A x.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn add<T: Entry>(&mut self, a: &Triangle<T>, x: &[T], interrupt: &Interrupt<'_>) -> Result<()> {
        interrupt.check_before(2 * OPERATIONS * a.values.len() as u64)?;
        let rows = &mut self.0;
        Arch::new().dispatch(Product { a, x, rows });
        Ok(())
    }

    /// Writes the rows, rounded, to `y`.
    pub fn rounded<T: Entry>(&self, y: &mut [T]) {
        for (y, [re, im]) in y.iter_mut().zip(&self.0) {
            *y = T::of(Complex64::new(re.total(), im.total()));
        }
    }
}

struct Product<'a, T> {
    a: &'a Triangle<T>,
    x: &'a [T],
    rows: &'a mut [[Sum; 2]],
}

impl<T: Entry> WithSimd for Product<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { a, x, rows } = self;
        for (j, &xj) in x.iter().enumerate() {
            let mut above = rows[j];
            let range = a.col_ptr[j]..a.col_ptr[j + 1];
            for (&i, &value) in a.row_idx[range.clone()].iter().zip(&a.values[range]) {
                let i = wide(i);
                if i == j {
                    value.add_exactly(xj, &mut above);
                } else {
                    value.add_exactly(xj, &mut rows[i]);
                    value.conjugated().add_exactly(x[i], &mut above);
                }
            }
            rows[j] = above;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse_storage::sparse::Csc;
    use crate::linalg::sparse_storage::triangle_product::multiply;

    /// A path graph's Laplacian in stiff units with a soft one of 1e-14 of it: the image of the constant vector is that of
    /// the soft part alone, which a plain product loses.
    #[test]
    fn the_smallest_part_of_a_stiff_matrix_is_exact() {
        const N: usize = 40;
        let interrupt = Interrupt::none();
        let soft = |i: usize| 1e-14 * (1.0 + i as f64 / 7.0);
        let mut entries = Vec::new();
        for i in 0..N - 1 {
            let k = Complex64::new(1.0 + i as f64 / 3.0, 0.0);
            let turn = Complex64::cis(0.3);
            entries.push((i, i, k));
            entries.push((i + 1, i + 1, k));
            entries.push((i, i + 1, -k * turn));
            entries.push((i + 1, i, -k * turn.conj()));
        }
        let stiff = Csc::from_triplets(N, N, entries).unwrap();
        let diagonal = (0..N).map(|i| (i, i, Complex64::from(soft(i)))).collect();
        let soft_part = Csc::from_triplets(N, N, diagonal).unwrap();
        let none = Csc::from_triplets(N, N, Vec::new()).unwrap();
        let triangle = |a: &Csc| Triangle::<Complex64>::sum(a, (0.0, &none), &interrupt).unwrap();
        let (stiff, soft_part) = (triangle(&stiff), triangle(&soft_part));
        let x: Vec<Complex64> = (0..N).map(|i| Complex64::cis(-0.3 * i as f64)).collect();
        let mut rows = Rows::new(N).unwrap();
        rows.add(&stiff, &x, &interrupt).unwrap();
        let mut own = vec![Complex64::ZERO; N];
        rows.rounded(&mut own);
        rows.add(&soft_part, &x, &interrupt).unwrap();
        let mut both = vec![Complex64::ZERO; N];
        rows.rounded(&mut both);
        // Entries and vector are rounded numbers, so that their exact image is not zero; the difference is the soft part.
        for (i, ((a, b), x)) in own.iter().zip(&both).zip(&x).enumerate() {
            assert!((b - a - soft(i) * x).norm() < 1e-3 * soft(i), "row {i}");
        }
        let mut plain = vec![Complex64::ZERO; N];
        multiply(&[(1.0, &stiff)], &x, &mut plain, &interrupt).unwrap();
        let worst = plain.iter().zip(&own).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(worst > 1e-16, "a plain product loses digits here: {worst:.1e}");
    }
}
