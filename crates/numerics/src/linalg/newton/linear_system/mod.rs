//! Newton's matrix behind one trait: who solves with it keeps it, and nobody else holds n × n numbers.
//!
//! A step of arc-length continuation solves K x = b with the bordered matrix
//!
//! > K = [J·s_u, r·s_p; tᵀ],
//!
//! where J = ∂R/∂u belongs to a problem, r = ∂R/∂p is its derivative by the parameter, s_u and s_p are the units of
//! unknowns and parameter, and t is the row of one further condition. One file a backend: [`dense`] factors the whole
//! matrix, [`krylov`] iterates with products, and factors the block of the strongly coupled unknowns and the mean
//! coupling of those beyond it, or, of a wheel, the waves that equal sectors would have, or the terms of low rank by which
//! contacts differ from what they do for most of the period.

pub mod automatic;
mod continuum;
mod crosses;
pub mod dense;
mod eliminated_border;
pub mod krylov;
mod rank_factors;
mod rank_or_waves;
mod sector_waves;

use crate::error::{Result, fail};
use crate::interrupt::Interrupt;
use num_complex::Complex64;

/// The Jacobian J of a problem at the point evaluated last.
pub trait Jacobian {
    /// Number n of unknowns.
    fn size(&self) -> usize;

    /// Fills J, column-major, and marks each column that differs from that of the identity.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()>;

    /// Fills in a complex diagonal, a number for each pair of unknowns, from which J at the point evaluated last is likely to differ by
    /// terms of low rank alone; `false` where there is none.
    fn near_diagonal(&mut self, _diagonal: &mut [Complex64]) -> bool {
        false
    }

    /// out = J d at the point evaluated last, for less work than [`Self::fill`]; `false` where the problem has no such
    /// product.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    fn multiply_here(&mut self, _d: &[f64], _out: &mut [f64]) -> Result<bool> {
        Ok(false)
    }

    /// Whether solutions may lie in a continuum besides the branch, so that the matrix is singular at each of them.
    fn has_continuum(&self) -> bool {
        false
    }

    /// The Jacobian as an operator with products, where the problem has them; else `None`.
    fn matrix_free(&mut self) -> Option<&mut dyn MatrixFree> {
        None
    }
}

/// A Jacobian J by products. The unknowns are groups of equal length (packed signals), whose first numbers couple
/// most, followed by few unknowns that couple with all.
pub trait MatrixFree {
    /// Length of one group.
    fn group(&self) -> usize;

    /// Number of unknowns after the groups; they always belong to the block.
    fn behind(&self) -> usize {
        0
    }

    /// Number of columns of J that differ from those of the identity.
    fn coupled(&self) -> usize;

    /// Whether the last numbers of a group couple as much as the first, so that factors of a block help an iteration little.
    fn couples_all(&self) -> bool {
        false
    }

    /// Fills the block of J between the first `part` numbers of each group and the unknowns after the groups,
    /// column-major, and marks each of its columns that differs from that of the identity.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    fn fill_block(&mut self, part: usize, matrix: &mut [f64], active: &mut [bool]) -> Result<()>;

    /// Fills the complex matrix, column-major, by which J acts on average on one pair of numbers of each group, taken
    /// as `x[at] + i·x[at + 1]`: the part of its 2 × 2 blocks that commutes with i.
    fn fill_pair(&mut self, at: usize, matrix: &mut [Complex64]);

    /// Sectors of a wheel, where the groups of one sector follow those of another; `None` for other structures, and
    /// where unknowns follow the groups.
    fn ring(&self) -> Option<Ring<'_>> {
        None
    }

    /// Fills the block of wave p of [`Self::ring`], column-major and of the order of a sector: it belongs to the mean
    /// of J over the sectors, each in its own time, at the point evaluated last. Waves are filled in order, beginning
    /// with wave 0.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    fn fill_ring(&mut self, _wave: usize, _matrix: &mut [Complex64]) -> Result<()> {
        fail!(Internal, "a matrix that has no sectors")
    }

    /// J by the forces of its groups; `None` where it is not known so.
    fn forces(&mut self) -> Option<&mut dyn Forces> {
        None
    }

    /// Keeps J as it is at the point evaluated last, for [`Self::multiply`]; the problem may then be evaluated
    /// elsewhere.
    ///
    /// # Errors
    /// `OutOfMemory`.
    fn keep(&mut self) -> Result<()>;

    /// out ← J d with the J that was kept last.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    fn multiply(&mut self, d: &[f64], out: &mut [f64]) -> Result<()>;
}

/// A Jacobian J = D + G F with a matrix D that is solved quickly, a flexibility G, and the derivatives F of forces in groups by motions
/// in groups.
pub trait Forces {
    /// Number of groups of forces and motions.
    fn groups(&self) -> usize;

    /// Share of F, by its norm, in which the sectors of a wheel differ from their mean at the point evaluated last.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    fn unlikeness(&mut self) -> Result<f64>;

    /// Chooses D for the point evaluated last, and factors it: the calls below are about this D, [`Self::rows`] before the problem is
    /// evaluated elsewhere. `false` where it is singular.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    fn begin(&mut self, _interrupt: &Interrupt<'_>) -> Result<bool> {
        Ok(true)
    }

    /// Writes the rows of F that belong to one group at the point evaluated last to `rows`, a block of columns for
    /// each motion group, whose index it adds to `motions`; both stay empty where all are zero. Returns the stiffness
    /// with which the numbers are compared.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    fn rows(&mut self, force: usize, rows: &mut Vec<f64>, motions: &mut Vec<usize>) -> Result<f64>;

    /// u ← D⁻¹ G w for the forces w of one group.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    fn response_of(&mut self, force: usize, w: &[f64], u: &mut [f64]) -> Result<()>;

    /// u ← u − D⁻¹ G w.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    fn subtract_response(&mut self, w: &[f64], u: &mut [f64]) -> Result<()>;

    /// u ← D⁻¹ u.
    fn divide(&mut self, u: &mut [f64]);
}

/// Sectors of a wheel whose groups of unknowns follow each other.
#[derive(Clone, Copy, Debug)]
pub struct Ring<'a> {
    /// Number N of sectors.
    pub sectors: usize,
    /// Per pair of numbers of a group, the factor λ from one sector to the next.
    pub lags: &'a [Complex64],
}

/// The rest of the bordered matrix K beside J: column, units and row.
#[derive(Clone, Copy, Debug)]
pub struct Border<'a> {
    /// Column r = ∂R/∂p.
    pub column: &'a [f64],
    /// Units of the unknowns and of the parameter.
    pub scales: (f64, f64),
    /// The row t, n + 1 numbers.
    pub row: &'a [f64],
}

/// A bordered system K x = b with its memory.
pub trait LinearSystem {
    /// Takes over the matrix at the point where the problem was evaluated last; former factors are kept.
    ///
    /// # Errors
    /// `OutOfMemory`; `StoppedByCaller`.
    fn update(&mut self, jacobian: &mut dyn Jacobian, border: Border<'_>, interrupt: &Interrupt<'_>) -> Result<()>;

    /// Factors the matrix of the last update; the Jacobian must still be at its point.
    ///
    /// # Errors
    /// `Singular`; `StoppedByCaller`.
    fn factor(&mut self, jacobian: &mut dyn Jacobian, interrupt: &Interrupt<'_>) -> Result<()>;

    /// Solves in place for n + 1 numbers with the matrix that was factored last, to this relative residual; `false`
    /// where an iteration did not converge. `jacobian` belongs to the problem of [`Self::update`], which may have
    /// been evaluated elsewhere since.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of products; `StoppedByCaller`.
    fn solve(
        &mut self,
        jacobian: &mut dyn Jacobian,
        tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool>;

    /// out ← K x with the matrix of the last update.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of products.
    fn apply(&mut self, jacobian: &mut dyn Jacobian, x: &[f64], out: &mut [f64]) -> Result<()>;

    /// out ← (w₀K + w₁K₁ + w₂K₂) x with the matrices of the last three updates, the newest first, without their last
    /// rows, for which `out` holds 0. `false` where these matrices are not kept.
    fn apply_last(&mut self, _weights: [f64; 3], _x: &[f64], _out: &mut [f64]) -> bool {
        false
    }

    /// Solves in place with the matrix of the last update by the factors of an earlier one, to a relative error of
    /// `tolerance`. Returns `false`, with `b` unchanged, where new factors are needed or are quicker.
    ///
    /// # Errors
    /// `OutOfMemory`, and those of products; `StoppedByCaller`.
    fn solve_by_earlier_factors(
        &mut self,
        jacobian: &mut dyn Jacobian,
        tolerance: f64,
        b: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<bool>;

    /// Solves directly from the next update on, after an iteration that did not converge; `false` if solutions are
    /// direct already.
    fn solve_directly(&mut self) -> bool {
        false
    }

    /// Allows an iteration at most this many products in each solution from now on.
    fn limit_products(&mut self, most: usize) {
        let _ = most;
    }

    /// Number of products that the last solution took.
    fn products(&self) -> usize {
        0
    }

    /// Whether the determinant of the matrix of the last solution is positive.
    fn is_positive(&self) -> bool;
}

#[cfg(test)]
mod tests {
    use super::dense::DenseSystem;
    use super::krylov::{KrylovSystem, Lengths};
    use super::{Border, Jacobian, LinearSystem, MatrixFree};
    use crate::error::{Result, Status};
    use crate::interrupt::Interrupt;
    use num_complex::Complex64;

    /// A matrix whose unknowns are groups of `group` numbers, of which the later ones couple weakly.
    struct Toy {
        n: usize,
        group: usize,
        behind: usize,
        matrix: Vec<f64>,
        kept: Vec<f64>,
    }

    impl Toy {
        fn new(n: usize, (group, behind): (usize, usize), seed: f64) -> Self {
            let mut matrix = vec![0.0; n * n];
            for (k, a) in matrix.iter_mut().enumerate() {
                let (row, column) = (k % n, k / n);
                let is_strong = |i: usize| i % group < 2 || i >= n - behind;
                let weak = |i: usize| if is_strong(i) { 1.0 } else { 0.05 };
                let noise = (k as f64 * 0.37 + seed).sin() * weak(row) * weak(column);
                *a = f64::from(u8::from(row == column)) * 1.5 + 0.3 * noise;
            }
            Self {
                n,
                group,
                behind,
                matrix,
                kept: Vec::new(),
            }
        }
    }

    impl Jacobian for Toy {
        fn size(&self) -> usize {
            self.n
        }

        fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
            matrix.copy_from_slice(&self.matrix);
            active.fill(true);
            Ok(())
        }

        fn matrix_free(&mut self) -> Option<&mut dyn MatrixFree> {
            Some(self)
        }
    }

    impl MatrixFree for Toy {
        fn group(&self) -> usize {
            self.group
        }

        fn behind(&self) -> usize {
            self.behind
        }

        fn coupled(&self) -> usize {
            self.n
        }

        fn fill_block(&mut self, part: usize, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
            let groups = self.n - self.behind;
            let inner: Vec<usize> = (0..self.n).filter(|&i| i >= groups || i % self.group < part).collect();
            for (k, &column) in inner.iter().enumerate() {
                for (r, &row) in inner.iter().enumerate() {
                    matrix[k * inner.len() + r] = self.matrix[column * self.n + row];
                }
            }
            active.fill(true);
            Ok(())
        }

        fn fill_pair(&mut self, at: usize, matrix: &mut [Complex64]) {
            let groups = (self.n - self.behind) / self.group;
            for (k, to) in matrix.iter_mut().enumerate() {
                let (row, column) = (k % groups * self.group + at, k / groups * self.group + at);
                let a = |i: usize, j: usize| self.matrix[(column + j) * self.n + row + i];
                *to = 0.5 * Complex64::new(a(0, 0) + a(1, 1), a(1, 0) - a(0, 1));
            }
        }

        fn keep(&mut self) -> Result<()> {
            self.kept.clone_from(&self.matrix);
            Ok(())
        }

        fn multiply(&mut self, d: &[f64], out: &mut [f64]) -> Result<()> {
            out.fill(0.0);
            for (column, d) in self.kept.chunks_exact(self.n).zip(d) {
                for (out, a) in out.iter_mut().zip(column) {
                    *out += a * d;
                }
            }
            Ok(())
        }
    }

    /// ‖K x − b‖/‖b‖ of the solution x, and x.
    fn solved(system: &mut dyn LinearSystem, toy: &mut Toy, scales: (f64, f64)) -> (f64, Vec<f64>) {
        let n = toy.n;
        let column: Vec<f64> = (0..n).map(|k| (k as f64 * 0.9).cos()).collect();
        let row: Vec<f64> = (0..=n).map(|k| (k as f64 * 0.7 + 0.2).sin()).collect();
        let b: Vec<f64> = (0..=n).map(|k| (k as f64 * 2.1).sin() + 1.0).collect();
        let border = Border {
            column: &column,
            scales,
            row: &row,
        };
        system.update(toy, border, &Interrupt::none()).unwrap();
        system.factor(toy, &Interrupt::none()).unwrap();
        let (mut x, mut product) = (b.clone(), vec![0.0; n + 1]);
        assert!(system.solve(toy, 1e-12, &mut x, &Interrupt::none()).unwrap());
        system.apply(toy, &x, &mut product).unwrap();
        let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let difference: Vec<f64> = product.iter().zip(&b).map(|(p, b)| p - b).collect();
        (size(&difference) / size(&b), x)
    }

    #[test]
    fn both_backends_solve_the_same_bordered_system() {
        for (groups, group, behind) in [(4, 7, 0), (60, 3, 0), (4, 7, 2), (20, 3, 1)] {
            for scales in [(1.0, 1.0), (0.7, 3.0)] {
                let n = groups * group + behind;
                let mut toy = Toy::new(n, (group, behind), 0.3);
                let (gap, dense) = solved(&mut DenseSystem::new(n).unwrap(), &mut toy, scales);
                assert!(gap < 1e-12, "{gap:e}");
                for (part, middle) in [(2, 2), (1, 3), (3, 7), (group, group)] {
                    let lengths = Lengths {
                        group,
                        part: part.min(group),
                        middle: middle.min(group),
                        behind,
                    };
                    let mut krylov = KrylovSystem::new(n, lengths, 200).unwrap();
                    let (gap, x) = solved(&mut krylov, &mut toy, scales);
                    assert!(gap < 1e-11, "{gap:e}");
                    let largest = dense.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                    for (a, b) in x.iter().zip(&dense) {
                        assert!((a - b).abs() < 1e-9 * largest, "{part} of {group}: {a} {b}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut toy = Toy::new(6, (3, 0), 0.3);
        toy.matrix.fill(0.0);
        let border = Border {
            column: &[0.0; 6],
            scales: (1.0, 1.0),
            row: &[0.0; 7],
        };
        let mut system = DenseSystem::new(6).unwrap();
        system.update(&mut toy, border, &Interrupt::none()).unwrap();
        assert_eq!(
            system.factor(&mut toy, &Interrupt::none()).unwrap_err().status,
            Status::Singular
        );
    }
}
