//! Iterative solution with one bordered matrix by the factors of another one near it.
//!
//! With K₀ factored, x ← x + K₀⁻¹(b − K x) multiplies the error by E = 1 − K₀⁻¹K. A round costs O(n²) where factors
//! cost O(n³). Fast convergence also shows that E has no eigenvalue near 1 or above among the components of the
//! solution, so that det K = det K₀ · det(1 − E) has the sign of det K₀.

use crate::linalg::newton::bordered::{Bordered, Parts, dot};
use crate::linalg::{add_product, norm};

/// Largest ratio of a change to the one before it.
/// Kind: tuned; measured on: not recorded.
const SHRINK: f64 = 0.2;

/// Number of rounds beyond which new factors are quicker.
/// Kind: tuned; measured on: not recorded.
const MOST_ROUNDS: usize = 6;

/// Smallest m²/n, for m active unknowns among n, at which a factorisation (m³) was measured to cost more than the
/// rounds that replace it (n·m each).
/// Kind: tuned; measured on: not recorded.
const FACTOR_REUSE_LEAST: usize = 64;

impl Bordered {
    /// Solves in place with the matrix `k` by the stored factors, to a relative error of `tolerance`. Returns
    /// `false` and leaves `x` unchanged where new factors are necessary or quicker.
    pub fn refine(&mut self, k: &Parts<'_>, tolerance: f64, x: &mut [f64]) -> bool {
        if !self.is_reusable(k) {
            return false;
        }
        let mut known = core::mem::take(&mut self.refinement.known);
        let mut change = core::mem::take(&mut self.refinement.change);
        known.copy_from_slice(x);
        self.solve(x);
        let mut last = norm(x);
        let mut done = last == 0.0;
        for _ in 0..MOST_ROUNDS {
            if done {
                break;
            }
            self.subtract_product(k, x, &known, &mut change);
            self.solve(&mut change);
            let size = norm(&change);
            // A comparison with NaN is false, so that this also ends the rounds.
            let shrinks = size <= SHRINK * last;
            if !shrinks {
                break;
            }
            for (x, c) in x.iter_mut().zip(&change) {
                *x += c;
            }
            // The remaining error is the change times the shrinkage once more.
            done = size * (size / last) <= tolerance * norm(x);
            last = size;
        }
        if !done {
            x.copy_from_slice(&known);
        }
        self.refinement.known = known;
        self.refinement.change = change;
        done
    }

    /// Whether the factors belong to a matrix with the same eliminated unknowns, and their reuse is quicker.
    fn is_reusable(&self, k: &Parts<'_>) -> bool {
        let (m, n) = (self.active.len(), self.n);
        let count = k.active.iter().filter(|a| **a).count();
        m == count && self.active.iter().all(|&j| k.active[j]) && m * m >= FACTOR_REUSE_LEAST * n
    }

    /// out ← b − K x.
    fn subtract_product(&mut self, k: &Parts<'_>, x: &[f64], b: &[f64], out: &mut [f64]) {
        let n = self.n;
        let (u_scale, p_scale) = k.scales;
        for (s, x) in self.refinement.scaled.iter_mut().zip(x) {
            *s = u_scale * x;
        }
        let along = p_scale * x[n];
        for ((out, b), c) in out.iter_mut().zip(b).zip(k.column) {
            *out = b - c * along;
        }
        out[n] = b[n] - dot(k.row, x);
        let out = &mut out[..n];
        if self.eliminated.is_empty() {
            add_product(-1.0, k.jacobian, &self.refinement.scaled, out);
            return;
        }
        for &t in &self.eliminated {
            out[t] -= self.refinement.scaled[t];
        }
        for &j in &self.active {
            let s = self.refinement.scaled[j];
            for (out, k) in out.iter_mut().zip(&k.jacobian[j * n..(j + 1) * n]) {
                *out -= s * k;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix near the identity over n unknowns, some of them inactive, and its border.
    struct Case {
        n: usize,
        jacobian: Vec<f64>,
        column: Vec<f64>,
        active: Vec<bool>,
        row: Vec<f64>,
    }

    impl Case {
        fn new(n: usize, inactive: usize, change: f64) -> Self {
            let wave = |k: usize, c: f64| (k as f64 * 0.37 + c).sin();
            let active: Vec<bool> = (0..n).map(|k| k % 7 != 0 || k / 7 >= inactive).collect();
            let jacobian = (0..n * n)
                .map(|k| {
                    let unit = f64::from(u8::from(k % n == k / n));
                    if active[k / n] {
                        2.0 * unit + 0.2 * wave(k, 0.0) + change * wave(k * k, 1.0)
                    } else {
                        unit
                    }
                })
                .collect();
            Self {
                n,
                jacobian,
                column: (0..n).map(|k| wave(k, 0.5)).collect(),
                row: (0..=n).map(|k| wave(k, 0.2) + change * wave(k, 0.7)).collect(),
                active,
            }
        }

        fn parts(&self) -> Parts<'_> {
            Parts {
                jacobian: &self.jacobian,
                column: &self.column,
                active: &self.active,
                scales: (0.7, 3.0),
                row: &self.row,
            }
        }

        fn factor(&self, bordered: &mut Bordered) {
            let k = self.parts();
            bordered
                .factor(
                    k.jacobian,
                    k.column,
                    k.active,
                    k.scales,
                    k.row,
                    &crate::interrupt::Interrupt::none(),
                )
                .unwrap();
        }

        fn b(&self) -> Vec<f64> {
            (0..=self.n).map(|k| (k as f64 * 2.1).sin() + 1.0).collect()
        }
    }

    #[test]
    fn refinement_finds_what_new_factors_find() {
        for inactive in [0, 3] {
            let (old, new) = (Case::new(90, inactive, 0.0), Case::new(90, inactive, 1e-4));
            let mut bordered = Bordered::new(90).unwrap();
            new.factor(&mut bordered);
            let mut expected = new.b();
            bordered.solve(&mut expected);
            old.factor(&mut bordered);
            let mut found = new.b();
            assert!(bordered.refine(&new.parts(), 1e-12, &mut found));
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-10 * norm(&expected), "{a} {b}");
            }
        }
    }

    #[test]
    fn factors_of_a_matrix_that_is_another_are_refused() {
        // Too far away; other active unknowns; too few of them for refinement to pay; not finite.
        let old = Case::new(90, 0, 0.0);
        let mut broken = Case::new(90, 0, 0.0);
        broken.jacobian[5] = f64::NAN;
        for (old, new) in [
            (&old, &Case::new(90, 0, 3.0)),
            (&old, &Case::new(90, 2, 0.0)),
            (&Case::new(20, 0, 0.0), &Case::new(20, 0, 0.0)),
            (&old, &broken),
        ] {
            let mut bordered = Bordered::new(old.n).unwrap();
            old.factor(&mut bordered);
            let mut x = new.b();
            assert!(!bordered.refine(&new.parts(), 1e-12, &mut x));
            assert_eq!(x, new.b());
        }
    }
}
