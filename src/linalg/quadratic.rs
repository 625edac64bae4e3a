//! The form xᴴ A x, accurate though its terms cancel: for a motion that hardly strains a stiff
//! structure it is smaller than the rounding of its largest term.

use super::sparse::Csc;
use num_complex::Complex64;

/// A sum with its rounding errors kept apart (Ogita, Rump & Oishi 2005, doi:10.1137/030601818).
#[derive(Clone, Copy, Default)]
struct Sum {
    value: f64,
    error: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        let sum = self.value + term;
        let part = sum - self.value;
        self.error += (self.value - (sum - part)) + (term - part);
        self.value = sum;
    }

    fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.error += a.mul_add(b, -product);
        self.add(product);
    }

    fn total(self) -> f64 {
        self.value + self.error
    }
}

/// xᴴ A x of a Hermitian matrix.
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
    }
}
