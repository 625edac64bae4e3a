//! The bordered system [J r; tᵀ] of arc-length continuation: one factorisation serves the Newton
//! step and the next tangent.
//!
//! Unknowns whose column of J is that of the identity (contacts that stick, seen from the stuck structure) are
//! eliminated first: x_t = b_t − J_ta x_a − r_t x_p. The remaining system couples the other unknowns and the
//! parameter.

mod bordered_parts;
mod factor_reuse;
mod near_diagonal;

pub use bordered_parts::Parts;

use crate::error::{Result, boxed, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::{Lu, operations_of_factors};
use crate::linalg::factors::small_lu::{self, SmallLu};
use near_diagonal::NearDiagonal;
use num_complex::Complex64;

/// Factors of the matrix of the active unknowns and the parameter.
enum Factors {
    Small(Box<SmallLu>),
    Large(Lu<f64>),
}

impl Factors {
    /// Memory for matrices of up to `n` rows.
    fn new(n: usize) -> Result<Self> {
        Ok(if n <= small_lu::SMALL_LU_LARGEST {
            Self::Small(boxed(|| SmallLu::new(n))?)
        } else {
            Self::Large(Lu::new(n, 1)?)
        })
    }

    fn set_order(&mut self, n: usize) {
        match self {
            Self::Small(lu) => lu.set_order(n),
            Self::Large(lu) => lu.set_order(n),
        }
    }

    /// Column j, to be filled, of a matrix of the order set last.
    fn column(&mut self, j: usize) -> &mut [f64] {
        match self {
            Self::Small(lu) => lu.column(j),
            Self::Large(lu) => {
                let n = lu.order();
                &mut lu.matrix()[j * n..(j + 1) * n]
            }
        }
    }

    /// Fills in the bordered matrix [J·u, r·p; row].
    fn fill_bordered(&mut self, jacobian: &[f64], u: f64, p: f64, column: &[f64], row: &[f64]) {
        let n = column.len();
        if let Self::Small(lu) = self {
            lu.fill_bordered(jacobian, u, p, column, row);
            return;
        }
        let columns = jacobian.chunks_exact(n.max(1)).map(|c| (c, u)).chain([(column, p)]);
        for ((j, (from, factor)), last) in columns.enumerate().zip(row) {
            let to = self.column(j);
            for (x, from) in to.iter_mut().zip(from) {
                *x = from * factor;
            }
            to[n] = *last;
        }
    }

    fn factor(&mut self, interrupt: &Interrupt<'_>) -> Result<()> {
        match self {
            Self::Small(lu) => {
                interrupt.count(operations_of_factors(small_lu::SMALL_LU_LARGEST));
                lu.factor()
            }
            Self::Large(lu) => lu.factor(interrupt),
        }
    }

    fn solve(&self, b: &mut [f64]) {
        match self {
            Self::Small(lu) => lu.solve(b),
            Self::Large(lu) => lu.solve(b),
        }
    }
}

/// LU factors of the (n + 1) × (n + 1) matrix [J r; tᵀ].
pub struct Bordered {
    lu: Factors,
    /// Factors by terms of low rank, and whether they are those of the matrix factored last.
    near: Option<Box<NearDiagonal>>,
    is_near: bool,
    n: usize,
    /// Unknowns that are solved for. The others have identity columns.
    active: Vec<usize>,
    eliminated: Vec<usize>,
    /// Rows of the eliminated unknowns, over the active ones and the parameter.
    rest: Vec<f64>,
    /// Border entries of the eliminated unknowns.
    border: Vec<f64>,
    u_scale: f64,
    reduced: Vec<f64>,
    refinement: Refinement,
}

/// Right-hand side, change and scaled unknowns of an iterative refinement.
pub struct Refinement {
    known: Vec<f64>,
    change: Vec<f64>,
    scaled: Vec<f64>,
}

impl Bordered {
    /// Memory for `n` unknowns and one parameter.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize) -> Result<Self> {
        const CONTEXT: &str = "the bordered system";
        // Eliminated times active unknowns is at most (n/2)·(n/2 + 1).
        let rest = (n / 2 + 1).saturating_mul(n / 2 + 2);
        let mut bordered = Self {
            lu: Factors::new(n + 1)?,
            near: None,
            is_near: false,
            n,
            active: try_vec(n, 0, CONTEXT)?,
            eliminated: try_vec(n, 0, CONTEXT)?,
            rest: try_vec(rest, 0.0, CONTEXT)?,
            border: try_vec(n, 0.0, CONTEXT)?,
            u_scale: 1.0,
            reduced: try_vec(n + 1, 0.0, CONTEXT)?,
            refinement: Refinement {
                known: try_vec(n + 1, 0.0, CONTEXT)?,
                change: try_vec(n + 1, 0.0, CONTEXT)?,
                scaled: try_vec(n, 0.0, CONTEXT)?,
            },
        };
        bordered.rest.clear();
        Ok(bordered)
    }

    /// Factors [J·u_scale, r·p_scale; row] with J (n × n, column-major) and the column r. `is_active` marks the
    /// unknowns whose column of J differs from that of the identity.
    ///
    /// # Errors
    /// `Singular`; `StoppedByCaller`.
    pub fn factor(
        &mut self,
        jacobian: &[f64],
        column: &[f64],
        is_active: &[bool],
        (u_scale, p_scale): (f64, f64),
        row: &[f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        let n = self.n;
        self.is_near = false;
        self.active.clear();
        self.eliminated.clear();
        for (k, &active) in is_active.iter().enumerate() {
            if active {
                self.active.push(k);
            } else {
                self.eliminated.push(k);
            }
        }
        self.u_scale = u_scale;
        let m = self.active.len() + 1;
        self.lu.set_order(m);
        if self.eliminated.is_empty() {
            self.lu.fill_bordered(jacobian, u_scale, p_scale, column, row);
            self.border.clear();
            self.rest.clear();
            return self.lu.factor(interrupt);
        }
        self.border.clear();
        self.border.extend(self.eliminated.iter().map(|&t| row[t]));
        self.rest.clear();
        for (j, &q) in self.active.iter().enumerate() {
            let from = &jacobian[q * n..(q + 1) * n];
            let to = self.lu.column(j);
            to[m - 1] = row[q];
            for (x, &p) in to.iter_mut().zip(&self.active) {
                *x = from[p] * u_scale;
            }
            let begin = self.rest.len();
            self.rest.extend(self.eliminated.iter().map(|&t| from[t] * u_scale));
            to[m - 1] -= dot(&self.border, &self.rest[begin..]) / u_scale;
        }
        let to = self.lu.column(m - 1);
        for (x, &p) in to.iter_mut().zip(&self.active) {
            *x = column[p] * p_scale;
        }
        let begin = self.rest.len();
        self.rest.extend(self.eliminated.iter().map(|&t| column[t] * p_scale));
        to[m - 1] = row[n] - dot(&self.border, &self.rest[begin..]) / u_scale;
        self.lu.factor(interrupt)
    }

    /// Factors the matrix, all of whose unknowns are active, by its difference from a complex diagonal, pair by pair, where that has a
    /// low rank. [`Self::solve`] then leaves an error, for [`Self::refine`] to remove. `false`, without factors, where it has not.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    pub fn factor_near(&mut self, k: &Parts<'_>, diagonal: &[Complex64], interrupt: &Interrupt<'_>) -> Result<bool> {
        self.is_near = false;
        let mut near = match self.near.take() {
            Some(near) => near,
            None => boxed(|| NearDiagonal::new(self.n))?,
        };
        let factored = near.factor(k, diagonal, interrupt);
        self.near = Some(near);
        self.is_near = factored?;
        if self.is_near {
            self.active.clear();
            self.active.extend(0..self.n);
            self.eliminated.clear();
            self.border.clear();
            self.rest.clear();
            self.u_scale = k.scales.0;
        }
        Ok(self.is_near)
    }

    /// Whether the factors are those of [`Self::factor_near`].
    #[must_use]
    pub fn is_near(&self) -> bool {
        self.is_near
    }

    /// The factors by terms, where they are those of the matrix factored last.
    fn terms(&mut self) -> Option<&mut NearDiagonal> {
        self.near.as_deref_mut().filter(|_| self.is_near)
    }

    /// Whether the determinant of the factored matrix is positive.
    ///
    /// With t the solution for (0, …, 0, 1), the determinant of [J r; tᵀ] has the same sign.
    #[must_use]
    pub fn is_positive(&self) -> bool {
        if let (true, Some(near)) = (self.is_near, &self.near) {
            return near.is_positive();
        }
        match &self.lu {
            Factors::Small(lu) => lu.is_positive(),
            Factors::Large(lu) => lu.is_positive(),
        }
    }

    /// Solves in place for a right-hand side of n + 1 numbers.
    pub fn solve(&mut self, b: &mut [f64]) {
        if let Some(near) = self.terms() {
            return near.solve(b);
        }
        let n = self.n;
        let m = self.active.len() + 1;
        let x = &mut self.reduced[..m];
        for (x, &p) in x.iter_mut().zip(&self.active) {
            *x = b[p];
        }
        let known: f64 = self.border.iter().zip(&self.eliminated).map(|(r, &t)| r * b[t]).sum();
        x[m - 1] = b[n] - known / self.u_scale;
        self.lu.solve(x);
        let count = self.eliminated.len();
        for (j, &xj) in x.iter().enumerate() {
            for (&t, r) in self.eliminated.iter().zip(&self.rest[j * count..(j + 1) * count]) {
                b[t] -= r * xj;
            }
        }
        for &t in &self.eliminated {
            b[t] /= self.u_scale;
        }
        for (&xj, &p) in x.iter().zip(&self.active) {
            b[p] = xj;
        }
        b[n] = x[m - 1];
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eliminating_identity_columns_changes_nothing() {
        let n = 5;
        let is_active = [true, false, true, false, false];
        let mut jacobian: Vec<f64> = (0..n * n).map(|k| (k as f64 * 1.7 + 0.3).sin()).collect();
        for (k, _) in is_active.iter().enumerate().filter(|(_, a)| !**a) {
            for i in 0..n {
                jacobian[k * n + i] = f64::from(u8::from(i == k));
            }
        }
        let column: Vec<f64> = (0..n).map(|k| (k as f64 + 0.5).cos()).collect();
        let row: Vec<f64> = (0..=n).map(|k| (k as f64 * 0.9 + 0.2).cos()).collect();
        let rhs: Vec<f64> = (0..=n).map(|k| (k as f64 * 2.1).sin() + 1.0).collect();
        let solve = |active: &[bool]| {
            let mut bordered = Bordered::new(n).unwrap();
            bordered
                .factor(&jacobian, &column, active, (0.7, 3.0), &row, &Interrupt::none())
                .unwrap();
            let mut b = rhs.clone();
            bordered.solve(&mut b);
            b
        };
        for (a, b) in solve(&is_active).iter().zip(solve(&[true; 5])) {
            assert!((a - b).abs() < 1e-13);
        }
    }
}
