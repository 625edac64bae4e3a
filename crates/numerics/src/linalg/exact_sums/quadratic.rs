//! The form xᴴ A x and the product A x, accurate under cancellation: for a motion that hardly strains a stiff
//! structure they are smaller than the rounding error of their largest term.
#![allow(clippy::inline_always, reason = "compiled for the instructions of the caller")]

use crate::linalg::exact_sums::compensated_sum::{Sum, rounding_of};
use crate::linalg::sparse_storage::sparse::Csc;
use num_complex::Complex64;
use pulp::{Arch, Simd, WithSimd};

/// Quadratic form below zero, relative to the sum of the moduli of its terms, that is rounding.
/// Kind: rounding.
pub const QUADRATIC_ROUNDING: f64 = 1e-14;

/// Sum of the moduli of the terms of xᴴ A x.
#[must_use]
pub fn terms(a: &Csc, x: &[Complex64]) -> f64 {
    let column = |j: usize| a.column(j).map(|(i, v)| v.norm() * x[i].norm()).sum::<f64>();
    x.iter().enumerate().map(|(j, x)| x.norm() * column(j)).sum()
}

/// Sum of the moduli of the terms of xᴴ A x, from the moduli of A (on a pattern) and of x, where many motions are
/// evaluated.
#[must_use]
pub fn terms_of_moduli(pattern: &Csc, of_matrix: &[f64], of_vector: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (j, x) in of_vector.iter().enumerate() {
        let column = pattern.col_ptr[j]..pattern.col_ptr[j + 1];
        let column = of_matrix[column.clone()].iter().zip(&pattern.row_idx[column]);
        sum += x * column.map(|(a, &i)| a * of_vector[i]).sum::<f64>();
    }
    sum
}

/// Terms of xᴴ A x over its value up to which plain sums have the digits of a size.
/// Kind: tuned; measured on: not recorded.
const CANCELLED: f64 = 1e4;

/// xᴴ A x of a Hermitian matrix to about twelve digits. Where the terms do not cancel, this takes a quarter of the
/// time of all digits.
#[must_use]
pub fn about_quadratic(a: &Csc, x: &[Complex64]) -> f64 {
    let (mut form, mut size) = (0.0, 0.0);
    for (j, xj) in x.iter().enumerate() {
        let (mut column, mut largest) = (Complex64::ZERO, 0.0);
        for (i, v) in a.column(j) {
            let term = v.conj() * x[i];
            column += term;
            largest += term.re.abs() + term.im.abs();
        }
        form += xj.re * column.re + xj.im * column.im;
        size += (xj.re.abs() + xj.im.abs()) * largest;
    }
    if size <= CANCELLED * form.abs() {
        return form;
    }
    quadratic(a, x)
}

/// xᴴ A x of a Hermitian matrix to all digits.
#[must_use]
pub fn quadratic(a: &Csc, x: &[Complex64]) -> f64 {
    let mut form = Sum::default();
    for (j, xj) in x.iter().enumerate() {
        // (A x)ⱼ by the column, which is the conjugate of the row.
        let (mut re, mut im) = (Sum::default(), Sum::default());
        for (i, v) in a.column(j) {
            re.add_product(v.re, x[i].re);
            re.add_product(v.im, x[i].im);
            im.add_product(v.re, x[i].im);
            im.add_product(-v.im, x[i].re);
        }
        form.add_product(xj.re, re.total());
        form.add_product(xj.im, im.total());
    }
    form.total()
}

/// Complex sum of [`product`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ComplexSum {
    re: Sum,
    im: Sum,
}

impl ComplexSum {
    /// Adds a·b; an entry `a` without imaginary part, the usual case, costs half.
    fn add_product(&mut self, a: Complex64, b: Complex64) {
        self.re.add_product(a.re, b.re);
        self.im.add_product(a.re, b.im);
        if a.im != 0.0 {
            self.re.add_product(-a.im, b.im);
            self.im.add_product(a.im, b.re);
        }
    }

    /// Adds a·b, where a is a sum with its own rounding errors.
    pub fn add_multiple(&mut self, a: Self, b: Complex64) {
        self.re.add_multiple(a.re, b.re);
        self.re.add_multiple(a.im, -b.im);
        self.im.add_multiple(a.re, b.im);
        self.im.add_multiple(a.im, b.re);
    }

    /// a minus the sum.
    #[must_use]
    pub fn subtracted_from(mut self, a: Complex64) -> Complex64 {
        self.re.add(-a.re);
        self.im.add(-a.im);
        -self.total()
    }

    /// Value of the sum.
    #[must_use]
    pub fn total(self) -> Complex64 {
        Complex64::new(self.re.total(), self.im.total())
    }
}

/// Entries of a column that are summed side by side.
/// Kind: block.
const QUADRATIC_LANES: usize = 4;

/// Sums with their rounding errors, side by side.
#[derive(Clone, Copy, Default)]
struct Lanes {
    value: [f64; QUADRATIC_LANES],
    error: [f64; QUADRATIC_LANES],
}

impl Lanes {
    #[inline(always)]
    fn add_products<const FUSED: bool>(&mut self, a: &[f64; QUADRATIC_LANES], b: &[f64; QUADRATIC_LANES]) {
        for k in 0..QUADRATIC_LANES {
            let product = a[k] * b[k];
            // Both are exact; a fused operation that the processor has is far quicker.
            let lost = if FUSED {
                a[k].mul_add(b[k], -product)
            } else {
                rounding_of(a[k], b[k], product)
            };
            let mut sum = Sum {
                value: self.value[k],
                error: self.error[k] + lost,
            };
            sum.add(product);
            (self.value[k], self.error[k]) = (sum.value, sum.error);
        }
    }

    fn sum(self) -> Sum {
        let mut sum = Sum::default();
        for (value, error) in self.value.into_iter().zip(self.error) {
            sum.add(value);
            sum.error += error;
        }
        sum
    }
}

/// xᴴ A x of any matrix, given by its values at the entries of a pattern. The imaginary part comes from the skew
/// part of A; for a Hermitian matrix it is rounding of second order.
#[must_use]
pub fn form(pattern: &Csc, values: &[Complex64], x: &[Complex64]) -> Complex64 {
    // No damping is the usual case of a mode.
    if values.iter().all(|v| *v == Complex64::ZERO) {
        return Complex64::ZERO;
    }
    Arch::new().dispatch(Form { pattern, values, x })
}

/// The arguments of [`form`].
struct Form<'a> {
    pattern: &'a Csc,
    values: &'a [Complex64],
    x: &'a [Complex64],
}

impl WithSimd for Form<'_> {
    type Output = Complex64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) -> Complex64 {
        if S::F64_LANES > 1 {
            self.sum::<true>()
        } else {
            self.sum::<false>()
        }
    }
}

impl Form<'_> {
    #[inline(always)]
    fn sum<const FUSED: bool>(self) -> Complex64 {
        let Self { pattern, values, x } = self;
        let mut form = ComplexSum::default();
        for (j, &xj) in x.iter().enumerate() {
            let column = pattern.col_ptr[j]..pattern.col_ptr[j + 1];
            let (entries, rows) = (&values[column.clone()], &pattern.row_idx[column]);
            let (mut re, mut im) = (Lanes::default(), Lanes::default());
            for (entries, rows) in entries.chunks(QUADRATIC_LANES).zip(rows.chunks(QUADRATIC_LANES)) {
                // A pattern may hold several matrices; the mass matrix among them is often diagonal.
                if entries.iter().all(|a| *a == Complex64::ZERO) {
                    continue;
                }
                let [mut a_re, mut a_im, mut b_re, mut b_im] = [[0.0; QUADRATIC_LANES]; 4];
                for (k, (a, &row)) in entries.iter().zip(rows).enumerate() {
                    (a_re[k], a_im[k], b_re[k], b_im[k]) = (a.re, a.im, x[row].re, -x[row].im);
                }
                re.add_products::<FUSED>(&a_re, &b_re);
                im.add_products::<FUSED>(&a_re, &b_im);
                if a_im.iter().any(|a| *a != 0.0) {
                    im.add_products::<FUSED>(&a_im, &b_re);
                    re.add_products::<FUSED>(&a_im.map(|a| -a), &b_im);
                }
            }
            let sum = ComplexSum {
                re: re.sum(),
                im: im.sum(),
            };
            form.add_multiple(sum, xj);
        }
        form.total()
    }
}

/// y ← y + A x, for a matrix given by its values at the entries of a pattern.
pub fn product(pattern: &Csc, values: &[Complex64], x: &[Complex64], y: &mut [ComplexSum]) {
    for (j, &xj) in x.iter().enumerate() {
        for at in pattern.col_ptr[j]..pattern.col_ptr[j + 1] {
            if values[at] != Complex64::ZERO {
                y[pattern.row_idx[at]].add_product(values[at], xj);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cancelling_terms_keep_what_remains() {
        // A chain of springs of very different stiffness, moved rigidly but for a small stretch.
        let mut entries = Vec::new();
        for (j, k) in [1e15, 3e9, 1e12].into_iter().enumerate() {
            for (row, column, sign) in [(j, j, 1.0), (j + 1, j + 1, 1.0), (j, j + 1, -1.0), (j + 1, j, -1.0)] {
                entries.push((row, column, Complex64::from(sign * k)));
            }
        }
        let a = Csc::from_triplets(4, 4, entries).unwrap();
        let phase = Complex64::new(0.6, 0.8);
        let x: Vec<Complex64> = [1.0, 1.0, 1.0 + 2f64.powi(-20), 1.0 + 2f64.powi(-20)]
            .iter()
            .map(|x| x * phase)
            .collect();
        let stretch = (x[2] - x[1]).norm_sqr();
        assert!((quadratic(&a, &x) / (3e9 * stretch) - 1.0).abs() < 1e-9);
        let whole = form(&a, &a.values, &x);
        assert!((whole.re / (3e9 * stretch) - 1.0).abs() < 1e-9);
        assert!(whole.im.abs() < 1e-30 * 1e15, "{:e}", whole.im);
        let mut forces = [ComplexSum::default(); 4];
        product(&a, &a.values, &x, &mut forces);
        let expected = [0.0, -3e9, 3e9, 0.0].map(|k| k * (x[2] - x[1]));
        for (force, expected) in forces.iter().zip(expected) {
            assert!((force.total() - expected).norm() < 1e-15 * expected.norm().max(1e-300));
        }
    }

    #[test]
    fn the_form_of_a_matrix_without_symmetry_is_its_double_sum() {
        let z = |k: i32| Complex64::new(f64::from(k), f64::from(k * k % 7));
        let entries = [(0, 0, z(1)), (2, 0, z(2)), (1, 1, z(3)), (0, 2, z(4)), (1, 2, z(5))];
        let a = Csc::from_triplets(3, 3, entries.to_vec()).unwrap();
        let x = [z(6), z(8), z(9)];
        let sum: Complex64 = entries.iter().map(|&(i, j, v)| x[i].conj() * v * x[j]).sum();
        assert_eq!(form(&a, &a.values, &x), sum);
    }
}
