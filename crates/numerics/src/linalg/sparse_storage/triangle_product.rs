//! Products of Hermitian sparse matrices, kept as triangles, with several columns. The columns lie side by side for it, as many as
//! vector instructions take, so that one pass over the matrix, which is what takes the time, serves all of them.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::sparse_storage::row_index::wide;
use crate::linalg::sparse_storage::triangle::{Entry, Triangle};
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Columns side by side.
/// Kind: block.
const PANEL_COLUMNS: usize = 8;

/// Columns from which on they are laid side by side; fewer are multiplied one after the other.
/// Kind: tuned; measured on: not recorded.
const WORTH_A_PANEL: usize = 3;

/// Real or imaginary parts of one row, for the columns of a panel.
type Lane = [f64; PANEL_COLUMNS];

/// Y ← (Σ f A) X with factors f and matrices A (at least one) of one order n, for column-major X and Y.
///
/// # Errors
/// `OutOfMemory`; `StoppedByCaller`.
pub fn multiply<T: Entry>(
    terms: &[(f64, &Triangle<T>)],
    x: &[T],
    y: &mut [T],
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let Some(n) = terms.first().map(|(_, a)| a.n).filter(|&n| n > 0) else {
        return Ok(());
    };
    let entries: usize = terms.iter().map(|(_, a)| a.values.len()).sum();
    let (mut panel, mut product) = (Vec::new(), Vec::new());
    for (x, y) in x.chunks(PANEL_COLUMNS * n).zip(y.chunks_mut(PANEL_COLUMNS * n)) {
        let columns = x.len() / n;
        interrupt.check_before(2 * (columns * entries) as u64)?;
        if columns < WORTH_A_PANEL {
            y.fill(T::NONE);
            for (x, y) in x.chunks_exact(n).zip(y.chunks_exact_mut(n)) {
                for &(factor, a) in terms {
                    add_column(factor, a, x, y);
                }
            }
            continue;
        }
        if panel.is_empty() {
            let room = || try_vec(n * if T::IS_COMPLEX { 2 } else { 1 }, [0.0; PANEL_COLUMNS], "a product");
            (panel, product) = (room()?, room()?);
        }
        lay(x, &mut panel, n);
        product.fill([0.0; PANEL_COLUMNS]);
        for &(factor, a) in terms {
            Arch::new().dispatch(Pass {
                factor,
                a,
                x: &panel,
                y: &mut product,
            });
        }
        take_up(&product, y, n);
    }
    Ok(())
}

/// y ← y + f A x for one column.
fn add_column<T: Entry>(factor: f64, a: &Triangle<T>, x: &[T], y: &mut [T]) {
    for (j, &xj) in x.iter().enumerate() {
        let xj = xj.scaled(factor);
        let mut above = T::NONE;
        let range = a.col_ptr[j]..a.col_ptr[j + 1];
        for (&i, &value) in a.row_idx[range.clone()].iter().zip(&a.values[range]) {
            let i = wide(i);
            y[i].add_product(value, xj);
            if i != j {
                above.add_conjugate_product(value, x[i]);
            }
        }
        y[j].add_product(above, T::of(factor.into()));
    }
}

/// Lays columns side by side: for each row the real parts, then the imaginary parts.
fn lay<T: Entry>(x: &[T], panel: &mut [Lane], n: usize) {
    let parts = panel.len() / n;
    for (c, x) in x.chunks_exact(n).enumerate() {
        for (row, x) in panel.chunks_exact_mut(parts).zip(x) {
            let z = x.complex();
            row[0][c] = z.re;
            if let Some(im) = row.get_mut(1) {
                im[c] = z.im;
            }
        }
    }
}

/// Copies rows that lie side by side back to columns.
fn take_up<T: Entry>(panel: &[Lane], y: &mut [T], n: usize) {
    let parts = panel.len() / n;
    for (c, y) in y.chunks_exact_mut(n).enumerate() {
        for (row, y) in panel.chunks_exact(parts).zip(y) {
            *y = T::of(Complex64::new(row[0][c], row.get(1).map_or(0.0, |im| im[c])));
        }
    }
}

/// y ← y + f A x for columns that lie side by side.
struct Pass<'a, T> {
    factor: f64,
    a: &'a Triangle<T>,
    x: &'a [Lane],
    y: &'a mut [Lane],
}

impl<T: Entry> WithSimd for Pass<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        if T::IS_COMPLEX {
            self.complex();
        } else {
            self.real();
        }
    }
}

impl<T: Entry> Pass<'_, T> {
    #[inline(always)]
    fn real(self) {
        let Self { factor, a, x, y } = self;
        for j in 0..a.n {
            let xj = x[j].map(|x| factor * x);
            let mut above = [0.0; PANEL_COLUMNS];
            let range = a.col_ptr[j]..a.col_ptr[j + 1];
            for (&i, &value) in a.row_idx[range.clone()].iter().zip(&a.values[range]) {
                let (i, value) = (wide(i), value.complex().re);
                let (xi, yi) = (&x[i], &mut y[i]);
                let other = if i == j { 0.0 } else { factor * value };
                for c in 0..PANEL_COLUMNS {
                    yi[c] += value * xj[c];
                    above[c] += other * xi[c];
                }
            }
            for (y, above) in y[j].iter_mut().zip(above) {
                *y += above;
            }
        }
    }

    #[inline(always)]
    fn complex(self) {
        let Self { factor, a, x, y } = self;
        let (x, y) = (x.as_chunks::<2>().0, y.as_chunks_mut::<2>().0);
        for j in 0..a.n {
            let [xj_re, xj_im] = x[j].map(|part| part.map(|x| factor * x));
            let (mut above_re, mut above_im) = ([0.0; PANEL_COLUMNS], [0.0; PANEL_COLUMNS]);
            let range = a.col_ptr[j]..a.col_ptr[j + 1];
            for (&i, &value) in a.row_idx[range.clone()].iter().zip(&a.values[range]) {
                let (i, value) = (wide(i), value.complex());
                let ([xi_re, xi_im], [yi_re, yi_im]) = (&x[i], &mut y[i]);
                let other = if i == j { Complex64::ZERO } else { factor * value };
                for c in 0..PANEL_COLUMNS {
                    yi_re[c] += value.re * xj_re[c] - value.im * xj_im[c];
                    yi_im[c] += value.re * xj_im[c] + value.im * xj_re[c];
                    // Above the diagonal stands the conjugate number.
                    above_re[c] += other.re * xi_re[c] + other.im * xi_im[c];
                    above_im[c] += other.re * xi_im[c] - other.im * xi_re[c];
                }
            }
            for (part, above) in y[j].iter_mut().zip([above_re, above_im]) {
                for (y, above) in part.iter_mut().zip(above) {
                    *y += above;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse_storage::sparse::Csc;

    fn number(k: usize) -> Complex64 {
        Complex64::new((1.3 * k as f64).sin(), (0.7 * k as f64).cos())
    }

    fn hermitian(n: usize, seed: usize, real: bool) -> Csc {
        let mut entries = Vec::new();
        for j in 0..n {
            for i in (j..n).step_by(1 + (j + seed) % 4) {
                let mut z = number(seed + 31 * i + j);
                if real || i == j {
                    z.im = 0.0;
                }
                entries.push((i, j, z));
                if i != j {
                    entries.push((j, i, z.conj()));
                }
            }
        }
        Csc::from_triplets(n, n, entries).unwrap()
    }

    fn compare<T: Entry>(columns: usize, real: bool) {
        const N: usize = 23;
        let none = Interrupt::none();
        let full = [hermitian(N, 5, real), hermitian(N, 77, real)];
        let zero = Csc::from_triplets(N, N, Vec::new()).unwrap();
        let [a, b] = [0, 1].map(|k| Triangle::<T>::sum(&full[k], (0.0, &zero), &none).unwrap());
        let x: Vec<T> = (0..N * columns).map(|k| T::of(number(k + 9))).collect();
        let mut y = vec![T::of(Complex64::ONE); x.len()];
        multiply(&[(1.0, &a), (-0.7, &b)], &x, &mut y, &none).unwrap();
        for (x, y) in x.chunks_exact(N).zip(y.chunks_exact(N)) {
            for (i, y) in y.iter().enumerate() {
                let row = (0..N).map(|j| (full[0].get(i, j) - 0.7 * full[1].get(i, j)) * x[j].complex());
                assert!((y.complex() - row.sum::<Complex64>()).norm() < 1e-13, "{columns}");
            }
        }
    }

    #[test]
    fn products_are_their_sums_for_any_number_of_columns() {
        for columns in [1, 2, 3, 7, 8, 9, 16, 19] {
            compare::<f64>(columns, true);
            compare::<Complex64>(columns, false);
        }
    }
}
