//! Linear systems that may be singular, by Householder factorisation with column pivoting.
//!
//! A P = Q R with a decreasing diagonal of R shows the rank (Businger & Golub 1965, doi:10.1007/BF01436084). The
//! solution of minimum norm is chosen: unlike that of elimination, it has no component along directions that the
//! equations leave undetermined.
//!
//! Factorisations of libraries cannot be stopped: this one asks the interrupt before each column, and requests memory that may be refused.

use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;

/// A square system that may be singular, with its memory.
pub struct LeastSquares {
    n: usize,
    a: Vec<f64>,
    order: Vec<usize>,
    /// First entries of the reflections, and rank of the matrix factorised last.
    heads: Vec<f64>,
    rank: usize,
    /// Squared lengths of the columns' remaining parts.
    lengths: Vec<f64>,
    solution: Vec<f64>,
}

impl LeastSquares {
    /// Memory for systems of order `n`.
    ///
    /// # Errors
    /// `OutOfMemory`, `StoppedByCaller`.
    pub fn new(n: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        const CONTEXT: &str = "a least-squares problem";
        Ok(Self {
            n,
            a: interrupt.zeros(n.saturating_mul(n), CONTEXT)?,
            order: try_vec(n, 0, CONTEXT)?,
            heads: try_vec(n, 0.0, CONTEXT)?,
            rank: 0,
            lengths: try_vec(n, 0.0, CONTEXT)?,
            solution: try_vec(n, 0.0, CONTEXT)?,
        })
    }

    /// The matrix, column-major, to be filled before [`Self::solve`], which overwrites it.
    pub fn matrix(&mut self) -> &mut [f64] {
        &mut self.a
    }

    /// Solves A x ≈ b in place and returns the numerical rank: directions of A that are shorter than `threshold`
    /// times the longest do not count.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn solve(&mut self, b: &mut [f64], threshold: f64, interrupt: &Interrupt<'_>) -> Result<usize> {
        self.factor(threshold, interrupt)?;
        self.solve_again(b);
        Ok(self.rank)
    }

    fn factor(&mut self, threshold: f64, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.n;
        let a = &mut self.a;
        let mut longest = 0.0_f64;
        self.rank = 0;
        for (j, p) in self.order.iter_mut().enumerate() {
            *p = j;
        }
        for k in 0..n {
            interrupt.check_before((6 * (n - k) * (n - k)) as u64)?;
            // Computed again at each step: updated lengths would be dominated by rounding where the rank shows.
            for (length, column) in self.lengths.iter_mut().zip(a.chunks_exact(n)).skip(k) {
                *length = column[k..].iter().map(|x| x * x).sum();
            }
            let Some(best) = (k..n).max_by(|&i, &j| self.lengths[i].total_cmp(&self.lengths[j])) else {
                break;
            };
            let length = self.lengths[best].sqrt();
            longest = longest.max(length);
            if length.is_nan() || length <= threshold * longest {
                break;
            }
            if best != k {
                let (left, right) = a.split_at_mut(best * n);
                left[k * n..(k + 1) * n].swap_with_slice(&mut right[..n]);
                self.order.swap(k, best);
            }
            let (done, rest) = a.split_at_mut((k + 1) * n);
            let column = &mut done[k * n + k..];
            let head = column[0];
            let pivot = if head > 0.0 { -length } else { length };
            // The reflection I − v vᵀ/s with v = column − pivot e₁ and s = −pivot·v₁.
            let first = head - pivot;
            for y in rest.chunks_exact_mut(n) {
                reflect(column, first, pivot, &mut y[k..]);
            }
            column[0] = pivot;
            self.heads[k] = first;
            self.rank = k + 1;
        }
        let rank = self.rank;
        let (r, open) = a.split_at_mut(rank * n);
        // Columns (−R₁⁻¹R₂, 1) span the null space; they are made orthonormal.
        for k in 0..n - rank {
            interrupt.check()?;
            let (before, this) = open.split_at_mut(k * n);
            let this = &mut this[..n];
            back(r, n, rank, this);
            this[rank..].fill(0.0);
            this[rank + k] = -1.0;
            for other in before.chunks_exact(n) {
                remove(other, this);
            }
            let length = this.iter().map(|x| x * x).sum::<f64>().sqrt();
            for x in this.iter_mut() {
                *x /= length;
            }
        }
        Ok(())
    }

    /// Solves for another right-hand side b in place, with the matrix of the last [`Self::solve`].
    pub fn solve_again(&mut self, b: &mut [f64]) {
        let (n, rank) = (self.n, self.rank);
        let (r, open) = self.a.split_at(rank * n);
        for (k, column) in r.chunks_exact(n).enumerate() {
            reflect(&column[k..], self.heads[k], column[k], &mut b[k..]);
        }
        back(r, n, rank, b);
        b[rank..].fill(0.0);
        // Nothing along the null space.
        for other in open.chunks_exact(n) {
            remove(other, b);
        }
        for (&to, x) in self.order.iter().zip(b.iter()) {
            self.solution[to] = *x;
        }
        b.copy_from_slice(&self.solution);
    }
}

/// Applies a reflection: y ← y − v (vᵀy)/s with s = −pivot·v₁, where v is a column with another first entry.
fn reflect(column: &[f64], first: f64, pivot: f64, y: &mut [f64]) {
    let (v, (head, rest)) = (&column[1..], y.split_at_mut(1));
    let along: f64 = first * head[0] + v.iter().zip(rest.iter()).map(|(v, y)| v * y).sum::<f64>();
    let share = along / (-pivot * first);
    head[0] -= share * first;
    for (y, v) in rest.iter_mut().zip(v) {
        *y -= share * v;
    }
}

/// Solves R₁ x = b in place for the first `rank` entries of b.
fn back(r: &[f64], n: usize, rank: usize, b: &mut [f64]) {
    for k in (0..rank).rev() {
        b[k] /= r[k * n + k];
        let x = b[k];
        for (b, r) in b[..k].iter_mut().zip(&r[k * n..]) {
            *b -= r * x;
        }
    }
}

/// Removes the component of b along a unit vector.
fn remove(unit: &[f64], b: &mut [f64]) {
    let share: f64 = unit.iter().zip(b.iter()).map(|(u, b)| u * b).sum();
    for (b, u) in b.iter_mut().zip(unit) {
        *b -= share * u;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_systems_are_solved_and_undetermined_directions_stay_zero() {
        let n = 6;
        let a: Vec<f64> = (0..n * n).map(|k| ((k * k + 5 * k + 1) as f64 * 0.61).sin()).collect();
        let x: Vec<f64> = (0..n).map(|k| (k as f64 + 0.5).cos()).collect();
        let times =
            |a: &[f64], x: &[f64]| -> Vec<f64> { (0..n).map(|i| (0..n).map(|j| a[j * n + i] * x[j]).sum()).collect() };
        let mut system = LeastSquares::new(n, &Interrupt::none()).unwrap();
        system.matrix().copy_from_slice(&a);
        let mut b = times(&a, &x);
        assert_eq!(system.solve(&mut b, 1e-12, &Interrupt::none()).unwrap(), n);
        for (b, x) in b.iter().zip(&x) {
            assert!((b - x).abs() < 1e-12);
        }
        // A column that is the sum of two others: the rank falls by one, and the equations still hold.
        let mut singular = a.clone();
        for i in 0..n {
            singular[4 * n + i] = singular[n + i] + singular[2 * n + i];
        }
        let right = times(&singular, &x);
        system.matrix().copy_from_slice(&singular);
        let mut found = right.clone();
        assert_eq!(system.solve(&mut found, 1e-12, &Interrupt::none()).unwrap(), n - 1);
        // Orthogonal to the null space e₁ + e₂ − e₄.
        assert!((found[1] + found[2] - found[4]).abs() < 1e-12);
        for (a, b) in times(&singular, &found).iter().zip(&right) {
            assert!((a - b).abs() < 1e-12);
        }
        // With the factors of before.
        let mut again = right.clone();
        system.solve_again(&mut again);
        assert_eq!(again, found);
    }
}
