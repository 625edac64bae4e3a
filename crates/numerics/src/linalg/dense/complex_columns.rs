//! Products of complex columns with a vector, and their change by two dyads, compiled for the vector instructions of the processor.
//!
//! Re z and Im z multiply the numbers of a column as they lie in memory, each into a sum of its own, and
//! A z = Σ a Re z + i Σ a Im z is put together at the end: no number is moved within a register. Aᴴ f takes the sums Re aᴴf and Im aᴴf,
//! the latter as the former with −i f.

#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use num_complex::Complex64;
use pulp::bytemuck::cast_slice;
use pulp::{Arch, Simd, WithSimd};

/// Numbers of a column that are added at a time, each to a sum of its own.
/// Kind: block.
const LANES: usize = 8;

/// out ← A z for columns that begin `stride` apart; `memory` is as long as `out`.
pub fn multiply(
    columns: &[Complex64],
    stride: usize,
    z: &[Complex64],
    out: &mut [Complex64],
    memory: &mut [Complex64],
) {
    Arch::new().dispatch(Product {
        columns,
        stride,
        z,
        sums: (out, memory),
    });
}

struct Product<'a> {
    columns: &'a [Complex64],
    stride: usize,
    z: &'a [Complex64],
    sums: (&'a mut [Complex64], &'a mut [Complex64]),
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let (out, by_im) = self.sums;
        let rows = out.len();
        out.fill(Complex64::ZERO);
        by_im.fill(Complex64::ZERO);
        let column = |j: usize| &self.columns[j * self.stride..][..rows];
        let mut pairs = self.z.chunks_exact(2);
        for (k, z) in pairs.by_ref().enumerate() {
            // Contacts that stick change no force.
            if z[0] == Complex64::ZERO && z[1] == Complex64::ZERO {
                continue;
            }
            let numbers = column(2 * k).iter().zip(column(2 * k + 1));
            for ((a, b), (p, q)) in out.iter_mut().zip(&mut *by_im).zip(numbers) {
                *a += p * z[0].re + q * z[1].re;
                *b += p * z[0].im + q * z[1].im;
            }
        }
        for z in pairs.remainder() {
            for ((a, b), p) in out.iter_mut().zip(&mut *by_im).zip(column(self.z.len() - 1)) {
                *a += p * z.re;
                *b += p * z.im;
            }
        }
        for (a, b) in out.iter_mut().zip(by_im) {
            *a += Complex64::new(-b.im, b.re);
        }
    }
}

/// out ← Aᴴ f for columns as long as f, one after the other; `turned` is memory for −i f.
pub fn multiply_adjoint(columns: &[Complex64], force: &[Complex64], turned: &mut [Complex64], out: &mut [Complex64]) {
    for (to, f) in turned.iter_mut().zip(force) {
        *to = Complex64::new(f.im, -f.re);
    }
    Arch::new().dispatch(Adjoint {
        columns,
        force,
        turned: &turned[..force.len()],
        out,
    });
}

struct Adjoint<'a> {
    columns: &'a [Complex64],
    force: &'a [Complex64],
    turned: &'a [Complex64],
    out: &'a mut [Complex64],
}

impl WithSimd for Adjoint<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let length = self.force.len().max(1);
        let (force, turned) = (
            cast_slice::<Complex64, f64>(self.force).as_chunks::<LANES>(),
            cast_slice::<Complex64, f64>(self.turned).as_chunks::<LANES>(),
        );
        for (out, column) in self.out.iter_mut().zip(self.columns.chunks_exact(length)) {
            let column = cast_slice::<Complex64, f64>(column).as_chunks::<LANES>();
            let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
            for ((a, f), t) in column.0.iter().zip(force.0).zip(turned.0) {
                for k in 0..LANES {
                    re[k] += a[k] * f[k];
                    im[k] += a[k] * t[k];
                }
            }
            let (mut sum_re, mut sum_im) = (re.iter().sum::<f64>(), im.iter().sum::<f64>());
            for ((a, f), t) in column.1.iter().zip(force.1).zip(turned.1) {
                sum_re += a * f;
                sum_im += a * t;
            }
            *out = Complex64::new(sum_re, sum_im);
        }
    }
}

/// The same for two vectors at once: the columns of a large matrix are read once.
pub fn multiply_adjoint_twice(
    columns: &[Complex64],
    forces: [&[Complex64]; 2],
    mut turned: [&mut [Complex64]; 2],
    [first, second]: [&mut [Complex64]; 2],
) {
    for (turned, force) in turned.iter_mut().zip(forces) {
        for (to, f) in turned.iter_mut().zip(force) {
            *to = Complex64::new(f.im, -f.re);
        }
    }
    let [of_first, of_second] = turned;
    Arch::new().dispatch(TwoAdjoints {
        columns,
        forces,
        turned: [&of_first[..forces[0].len()], &of_second[..forces[0].len()]],
        out: (first, second),
    });
}

/// The numbers of a vector, as many at a time as are added, and those left.
#[inline(always)]
fn lanes(of: &[Complex64]) -> (&[[f64; LANES]], &[f64]) {
    cast_slice::<Complex64, f64>(of).as_chunks::<LANES>()
}

struct TwoAdjoints<'a> {
    columns: &'a [Complex64],
    forces: [&'a [Complex64]; 2],
    turned: [&'a [Complex64]; 2],
    out: (&'a mut [Complex64], &'a mut [Complex64]),
}

impl WithSimd for TwoAdjoints<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let length = self.forces[0].len().max(1);
        let ([f, g], [t, u]) = (self.forces.map(lanes), self.turned.map(lanes));
        let outputs = self.out.0.iter_mut().zip(self.out.1.iter_mut());
        for ((first, second), column) in outputs.zip(self.columns.chunks_exact(length)) {
            let column = cast_slice::<Complex64, f64>(column).as_chunks::<LANES>();
            let mut sums = [[0.0; LANES]; 4];
            let numbers = f.0.iter().zip(t.0).zip(g.0.iter().zip(u.0));
            for (a, ((f, t), (g, u))) in column.0.iter().zip(numbers) {
                for k in 0..LANES {
                    sums[0][k] += a[k] * f[k];
                    sums[1][k] += a[k] * t[k];
                    sums[2][k] += a[k] * g[k];
                    sums[3][k] += a[k] * u[k];
                }
            }
            let mut whole = sums.map(|sum| sum.iter().sum::<f64>());
            let numbers = f.1.iter().zip(t.1).zip(g.1.iter().zip(u.1));
            for (a, ((f, t), (g, u))) in column.1.iter().zip(numbers) {
                for (sum, by) in whole.iter_mut().zip([f, t, g, u]) {
                    *sum += a * by;
                }
            }
            *first = Complex64::new(whole[0], whole[1]);
            *second = Complex64::new(whole[2], whole[3]);
        }
    }
}

/// A ← A − v wᴴ − w vᴴ for columns that begin `stride` apart and are as long as v; the last one ends with the matrix.
pub fn subtract_dyads(columns: &mut [Complex64], stride: usize, v: &[Complex64], w: &[Complex64]) {
    Arch::new().dispatch(Dyads { columns, stride, v, w });
}

struct Dyads<'a> {
    columns: &'a mut [Complex64],
    stride: usize,
    v: &'a [Complex64],
    w: &'a [Complex64],
}

impl WithSimd for Dyads<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { columns, stride, v, w } = self;
        for ((column, by_w), by_v) in columns.chunks_mut(stride).zip(w).zip(v) {
            let (by_w, by_v) = (by_w.conj(), by_v.conj());
            for ((a, v), w) in column.iter_mut().zip(v).zip(w) {
                *a -= v * by_w + w * by_v;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{multiply, multiply_adjoint, multiply_adjoint_twice, subtract_dyads};
    use num_complex::Complex64;

    #[test]
    fn a_product_is_the_sum_of_its_columns() {
        let number = |k: usize| Complex64::new((k as f64).sin(), (1.7 * k as f64).cos());
        for (rows, count, stride) in [(1, 1, 1), (3, 2, 5), (17, 9, 18), (60, 61, 61)] {
            // The last column ends with its rows.
            let a: Vec<Complex64> = (0..(count - 1) * stride + rows).map(number).collect();
            let z: Vec<Complex64> = (0..count).map(|k| number(3 * k + 1)).collect();
            let [mut out, mut memory] = [(); 2].map(|()| vec![Complex64::new(7.0, 7.0); rows]);
            multiply(&a, stride, &z, &mut out, &mut memory);
            for (i, out) in out.iter().enumerate() {
                let exact: Complex64 = z.iter().enumerate().map(|(j, z)| a[j * stride + i] * z).sum();
                assert!(
                    (out - exact).norm() < 1e-13 * count as f64,
                    "{rows}, {count}: {out} {exact}"
                );
            }
        }
    }

    #[test]
    fn a_product_with_the_adjoint_is_the_inner_product_of_each_column() {
        let number = |k: usize| Complex64::new((k as f64).sin(), (1.7 * k as f64).cos());
        for (rows, count) in [(1, 1), (3, 2), (4, 5), (17, 9), (91, 61)] {
            let a: Vec<Complex64> = (0..rows * count).map(number).collect();
            let f: Vec<Complex64> = (0..rows).map(|k| number(3 * k + 1)).collect();
            let (mut turned, mut out) = (vec![Complex64::ZERO; rows], vec![Complex64::ZERO; count]);
            multiply_adjoint(&a, &f, &mut turned, &mut out);
            for (column, out) in a.chunks_exact(rows).zip(&out) {
                let exact: Complex64 = column.iter().zip(&f).map(|(a, f)| a.conj() * f).sum();
                assert!(
                    (out - exact).norm() < 1e-14 * rows as f64,
                    "{rows}, {count}: {out} {exact}"
                );
            }
        }
    }

    #[test]
    fn products_with_two_vectors_are_those_with_each() {
        let number = |k: usize| Complex64::new((k as f64).sin(), (1.7 * k as f64).cos());
        for (rows, count) in [(1, 1), (4, 5), (17, 9), (91, 61)] {
            let a: Vec<Complex64> = (0..rows * count).map(number).collect();
            let forces = [1, 2].map(|s| (0..rows).map(|k| number(3 * k + s)).collect::<Vec<_>>());
            let (mut turned, mut out) = (
                [(); 2].map(|()| vec![Complex64::ZERO; rows]),
                vec![Complex64::ZERO; count],
            );
            let mut both = [(); 2].map(|()| vec![Complex64::ZERO; count]);
            let ([t, u], [x, y]) = (&mut turned, &mut both);
            multiply_adjoint_twice(&a, [&forces[0], &forces[1]], [t, u], [x, y]);
            for (force, found) in forces.iter().zip(&both) {
                multiply_adjoint(&a, force, &mut turned[0], &mut out);
                assert!(
                    found
                        .iter()
                        .zip(&out)
                        .all(|(a, b)| (a - b).norm() < 1e-14 * rows as f64)
                );
            }
        }
    }

    #[test]
    fn dyads_are_subtracted_from_each_column() {
        let number = |k: usize| Complex64::new((k as f64).sin(), (1.7 * k as f64).cos());
        let (n, stride) = (7, 9);
        let mut a: Vec<Complex64> = (0..(n - 1) * stride + n).map(number).collect();
        let before = a.clone();
        let [v, w] = [1, 2].map(|s| (0..n).map(|k| number(5 * k + s)).collect::<Vec<_>>());
        subtract_dyads(&mut a, stride, &v, &w);
        for (k, (a, before)) in a.iter().zip(before).enumerate() {
            let (i, j) = (k % stride, k / stride);
            let change = if i < n {
                v[i] * w[j].conj() + w[i] * v[j].conj()
            } else {
                Complex64::ZERO
            };
            assert!((a - (before - change)).norm() < 1e-14);
        }
    }
}
