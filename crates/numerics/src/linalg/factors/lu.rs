//! LU factorisation with partial pivoting, in place and without allocation, real or complex.
//!
//! Small matrices use plain loops, which the compiler vectorises and which need no set-up; larger ones use the
//! blocked kernels of faer, and large ones panels between which a caller may interrupt.

mod panels;
mod scalar;
mod small;
mod substitution;

use crate::error::{Error, Result, fail, try_vec};
use crate::interrupt::Interrupt;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Conj, MatMut, MatRef, Par};
use pulp::Arch;
use small::{Columns, Factorisation};
use substitution::Substitution;

pub use scalar::Scalar;

/// Order above which the blocked kernels are quicker.
/// Kind: tuned; measured on: not recorded.
const BLOCKED_ABOVE: usize = 32;

/// Order above which the factorisation can be interrupted between panels of columns.
/// Kind: tuned; measured on: not recorded.
const PANELS_ABOVE: usize = 384;

/// Numbers of right-hand sides times unknowns squared between two checks of the interrupt in a solution.
/// Kind: block.
const LU_BETWEEN_CHECKS: usize = 1 << 23;

/// Right sides from which small factors solve for all rows at once.
/// Kind: tuned; measured on: not recorded.
const COLUMNS_AT_ONCE: usize = 4;

/// Operations of a factorisation that take the time of one of a simple loop: a register holds four numbers.
/// Kind: block.
const LU_SIDE_BY_SIDE: u64 = 4;

const CONTEXT: &str = "an LU factorisation";

/// Operations of the factors of a matrix of order n, ⅔ n³, in those of a simple loop, as they are counted.
#[must_use]
pub fn operations_of_factors(n: usize) -> u64 {
    2 * (n as u64).saturating_pow(3) / (3 * LU_SIDE_BY_SIDE)
}

/// Memory for the blocked kernels.
struct Blocked {
    forward: Vec<usize>,
    backward: Vec<usize>,
    /// Permutation of one panel; and its interchanges.
    panel: Vec<usize>,
    swaps: Vec<usize>,
    scratch: MemBuffer,
}

/// Factors P A = L U of a square column-major matrix, with the memory to hold them.
pub struct Lu<T> {
    arch: Arch,
    n: usize,
    a: Vec<T>,
    pivots: Vec<usize>,
    blocked: Option<Blocked>,
    /// Memory for small matrices: one column, and all right-hand sides with one row more.
    small: Vec<T>,
}

impl<T: Scalar> Lu<T> {
    /// Memory for factors of n × n matrices, and for solving up to `columns` right-hand sides at a
    /// time.
    ///
    /// # Errors
    /// `OutOfMemory`, also when n² overflows.
    pub fn new(n: usize, columns: usize) -> Result<Self> {
        let Some(nn) = n.checked_mul(n) else {
            return fail!(OutOfMemory, "a dense factorisation of {n} unknowns cannot be stored");
        };
        let in_panels = if n > PANELS_ABOVE { n } else { 0 };
        // A lower order may be set later.
        let small = if n <= BLOCKED_ABOVE && columns >= COLUMNS_AT_ONCE {
            (n + 1) * columns
        } else {
            n.min(BLOCKED_ABOVE)
        };
        let blocked = if n > BLOCKED_ABOVE {
            let need = factor::lu_in_place_scratch::<usize, T>(n, n, Par::Seq, faer::Spec::default())
                .or(solve::solve_in_place_scratch::<usize, T>(n, columns, Par::Seq))
                .or(solve::solve_transpose_in_place_scratch::<usize, T>(
                    n,
                    columns,
                    Par::Seq,
                ));
            Some(Blocked {
                forward: try_vec(n, 0, CONTEXT)?,
                backward: try_vec(n, 0, CONTEXT)?,
                panel: try_vec(in_panels, 0, CONTEXT)?,
                swaps: try_vec(in_panels, 0, CONTEXT)?,
                scratch: MemBuffer::try_new(need).map_err(|_| Error::out_of_memory(CONTEXT))?,
            })
        } else {
            None
        };
        Ok(Self {
            arch: Arch::new(),
            n,
            a: try_vec(nn, <T as nalgebra::ComplexField>::from_real(0.0), CONTEXT)?,
            pivots: try_vec(n, 0, CONTEXT)?,
            blocked,
            small: try_vec(small, <T as nalgebra::ComplexField>::from_real(0.0), CONTEXT)?,
        })
    }

    /// Order of the matrix.
    #[must_use]
    pub fn order(&self) -> usize {
        self.n
    }

    /// The matrix to fill, column-major, before [`Self::factor`].
    pub fn matrix(&mut self) -> &mut [T] {
        &mut self.a[..self.n * self.n]
    }

    /// Changes the order of the matrix, up to the order given to [`Self::new`].
    pub fn set_order(&mut self, n: usize) {
        self.n = n.min(self.pivots.len());
    }

    /// Factors the matrix that was filled in.
    ///
    /// # Errors
    /// `Singular` naming the pivot that is exactly zero or not finite; `StoppedByCaller`.
    pub fn factor(&mut self, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.n;
        if n > BLOCKED_ABOVE {
            return self.factor_blocked(interrupt);
        }
        let factorisation = Factorisation {
            n,
            a: &mut self.a[..n * n],
            pivots: &mut self.pivots,
            turned: &mut self.small,
        };
        interrupt.count(operations_of_factors(n));
        let done = self.arch.dispatch(factorisation);
        done.or_else(|(pivot, size)| singular(n, pivot, size))
    }

    fn factor_blocked(&mut self, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.n;
        // In stretches without early exit, which the compiler vectorises.
        let broken = |part: &[T]| part.iter().fold(false, |found, x| found | !x.size().is_finite());
        if self.a[..n * n].chunks(1024).any(broken) {
            return singular(n, 0, f64::NAN);
        }
        let Some(blocked) = &mut self.blocked else {
            return Ok(());
        };
        if n > PANELS_ABOVE {
            panels::factor(&mut self.a[..n * n], n, blocked, interrupt)?;
        } else {
            interrupt.check_before(operations_of_factors(n))?;
            factor::lu_in_place::<usize, T>(
                MatMut::from_column_major_slice_mut(&mut self.a[..n * n], n, n),
                &mut blocked.forward[..n],
                &mut blocked.backward[..n],
                Par::Seq,
                MemStack::new(&mut blocked.scratch),
                faer::Spec::default(),
            );
        }
        for j in 0..n {
            let size = self.a[j * n + j].size();
            if size == 0.0 || !size.is_finite() {
                return singular(n, j, size);
            }
        }
        interchanges(&blocked.forward[..n], &mut blocked.backward[..n], &mut self.pivots[..n]);
        Ok(())
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [T]) {
        let n = self.n;
        for k in 0..n {
            b.swap(k, self.pivots[k]);
        }
        if n > BLOCKED_ABOVE {
            let factors = &self.a[..n * n];
            return self.arch.dispatch(Substitution { n, factors, b });
        }
        for k in 0..n {
            let x = b[k];
            for (b, &l) in b[k + 1..].iter_mut().zip(&self.a[k * n + k + 1..(k + 1) * n]) {
                *b -= x * l;
            }
        }
        for k in (0..n).rev() {
            // The product with the reciprocal is the digits of `small_lu`.
            let x = b[k] * (T::one() / self.a[k * n + k]);
            b[k] = x;
            for (b, &u) in b[..k].iter_mut().zip(&self.a[k * n..k * n + k]) {
                *b -= x * u;
            }
        }
    }

    /// Solves Aᵀ x = b in place (transposed, not conjugated).
    pub fn solve_transposed(&self, b: &mut [T]) {
        let n = self.n;
        for k in 0..n {
            let column = &self.a[k * n..k * n + k];
            let sum = column.iter().zip(&b[..k]).fold(b[k], |s, (&u, &x)| s - u * x);
            b[k] = sum / self.a[k * n + k];
        }
        for k in (0..n).rev() {
            let column = &self.a[k * n + k + 1..(k + 1) * n];
            b[k] = column.iter().zip(&b[k + 1..]).fold(b[k], |s, (&l, &x)| s - l * x);
        }
        for k in (0..n).rev() {
            b.swap(k, self.pivots[k]);
        }
    }

    /// Solves A X = B (or Aᵀ X = B) in place for the columns of `b`.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn solve_columns(&mut self, b: &mut [T], transposed: bool, interrupt: &Interrupt<'_>) -> Result<()> {
        let n = self.n;
        let Some(blocked) = self.blocked.as_mut().filter(|_| n > BLOCKED_ABOVE) else {
            let (columns, most) = (b.len() / n.max(1), self.small.len() / (n + 1));
            if !transposed && columns >= COLUMNS_AT_ONCE && columns <= most && n > 1 {
                self.arch.dispatch(Columns {
                    n,
                    factors: &self.a,
                    pivots: &self.pivots,
                    b,
                    memory: &mut self.small,
                });
                return Ok(());
            }
            for column in b.chunks_exact_mut(n.max(1)) {
                if transposed {
                    self.solve_transposed(column);
                } else {
                    self.solve(column);
                }
            }
            return Ok(());
        };
        let factors = MatRef::from_column_major_slice(&self.a[..n * n], n, n);
        let rows = PermRef::new_checked(&blocked.forward[..n], &blocked.backward[..n], n);
        let at_once = (LU_BETWEEN_CHECKS / (n * n)).max(1);
        for b in b.chunks_mut(at_once * n) {
            let columns = b.len() / n;
            interrupt.check_before((2 * n * n * columns) as u64)?;
            let b = MatMut::from_column_major_slice_mut(b, n, columns);
            let scratch = MemStack::new(&mut blocked.scratch);
            if transposed {
                solve::solve_transpose_in_place_with_conj(factors, factors, rows, Conj::No, b, Par::Seq, scratch);
            } else {
                solve::solve_in_place_with_conj(factors, factors, rows, Conj::No, b, Par::Seq, scratch);
            }
        }
        Ok(())
    }
}

/// A permutation by which position k receives row `forward[k]`, as a sequence of interchanges: position k is
/// exchanged with position `rows[k]`. `position` is memory, and holds the inverse permutation at the end.
fn interchanges(forward: &[usize], position: &mut [usize], rows: &mut [usize]) {
    for (k, p) in position.iter_mut().enumerate() {
        *p = k;
    }
    // rows[k] holds the row at position k until its interchange is known.
    for (k, r) in rows.iter_mut().enumerate() {
        *r = k;
    }
    for (k, &wanted) in forward.iter().enumerate() {
        let from = position[wanted];
        let displaced = rows[k];
        rows[from] = displaced;
        position[displaced] = from;
        rows[k] = from;
    }
    for (k, &row) in forward.iter().enumerate() {
        position[row] = k;
    }
}

fn singular(n: usize, pivot: usize, size: f64) -> Result<()> {
    fail!(
        Singular,
        "a linear system of {n} unknowns is singular: pivot {pivot} is {size}"
    )
}

impl Lu<f64> {
    /// Whether the determinant of the factored matrix is positive.
    #[must_use]
    pub fn is_positive(&self) -> bool {
        let swaps = self.pivots[..self.n]
            .iter()
            .enumerate()
            .filter(|&(k, &p)| k != p)
            .count();
        let negative = (0..self.n).filter(|&k| self.a[k * self.n + k] < 0.0).count();
        (swaps + negative) % 2 == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    #[test]
    fn solves_a_system_and_its_transpose_by_either_kernel() {
        for n in [1, 7, BLOCKED_ABOVE, BLOCKED_ABOVE + 9, PANELS_ABOVE + 77] {
            let mut a: Vec<f64> = (0..n * n).map(|k| ((k * k + 3 * k + 2) as f64 * 0.37).sin()).collect();
            if n > PANELS_ABOVE {
                // Large matrices of this kind are ill-conditioned.
                (0..n).for_each(|k| a[k * n + k] += 30.0);
            }
            let mut lu = Lu::<f64>::new(n, 2).unwrap();
            lu.matrix().copy_from_slice(&a);
            lu.factor(&Interrupt::none()).unwrap();
            let x: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
            let mut b: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[j * n + i] * x[j]).sum()).collect();
            let mut bt: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[i * n + j] * x[j]).sum()).collect();
            let (mut both, mut both_t) = ([b.clone(), b.clone()].concat(), [bt.clone(), bt.clone()].concat());
            lu.solve(&mut b);
            lu.solve_transposed(&mut bt);
            lu.solve_columns(&mut both, false, &Interrupt::none()).unwrap();
            lu.solve_columns(&mut both_t, true, &Interrupt::none()).unwrap();
            for i in 0..n {
                for found in [b[i], bt[i], both[i], both[n + i], both_t[i], both_t[n + i]] {
                    assert!((found - x[i]).abs() < 1e-11, "n = {n}: {:e}", found - x[i]);
                }
            }
        }
    }

    #[test]
    fn many_right_sides_of_small_factors_have_the_digits_of_single_ones() {
        let entry = |k: usize| Complex64::new(((k * k + 3 * k + 2) as f64 * 0.37).sin(), (1.3 * k as f64).cos());
        for (n, columns) in [(2, 4), (24, 25), (31, 7)] {
            let mut lu = Lu::<Complex64>::new(n, columns).unwrap();
            for (k, a) in lu.matrix().iter_mut().enumerate() {
                *a = entry(k);
            }
            lu.factor(&Interrupt::none()).unwrap();
            let b: Vec<Complex64> = (0..n * columns).map(|k| entry(k + 7)).collect();
            let (mut at_once, mut alone) = (b.clone(), b.clone());
            lu.solve_columns(&mut at_once, false, &Interrupt::none()).unwrap();
            alone.chunks_exact_mut(n).for_each(|column| lu.solve(column));
            assert_eq!(at_once, alone, "{n}");
            for (x, b) in at_once.chunks_exact(n).zip(b.chunks_exact(n)) {
                for (i, b) in b.iter().enumerate() {
                    let sum: Complex64 = (0..n).map(|j| entry(j * n + i) * x[j]).sum();
                    assert!((sum - b).norm() < 1e-11, "{n}");
                }
            }
        }
    }

    #[test]
    fn panels_and_the_whole_matrix_have_the_same_determinant_and_a_stop_comes_between_panels() {
        let n = PANELS_ABOVE + 150;
        let checks = core::cell::Cell::new(0);
        let stop = || {
            checks.set(checks.get() + 1);
            checks.get() == 5
        };
        let fill = |lu: &mut Lu<f64>| {
            for (k, a) in lu.matrix().iter_mut().enumerate() {
                *a = ((k * k + 3 * k + 2) as f64 * 0.37).sin();
            }
        };
        let mut lu = Lu::<f64>::new(n, 1).unwrap();
        fill(&mut lu);
        let stopped = lu.factor(&Interrupt::new(Some(&stop), None));
        assert_eq!(stopped.unwrap_err().status, crate::error::Status::StoppedByCaller);
        fill(&mut lu);
        lu.factor(&Interrupt::none()).unwrap();
        let (mut whole, mut forward, mut backward) = (vec![0.0; n * n], vec![0; n], vec![0; n]);
        for (k, a) in whole.iter_mut().enumerate() {
            *a = ((k * k + 3 * k + 2) as f64 * 0.37).sin();
        }
        let need = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, faer::Spec::default());
        factor::lu_in_place::<usize, f64>(
            MatMut::from_column_major_slice_mut(&mut whole, n, n),
            &mut forward,
            &mut backward,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(need)),
            faer::Spec::default(),
        );
        let size = |a: &[f64]| (0..n).map(|k| a[k * n + k].abs().ln()).sum::<f64>();
        assert!((size(&lu.a) - size(&whole)).abs() < 1e-8);
        assert_eq!(lu.blocked.as_ref().unwrap().forward, forward);
    }

    #[test]
    fn a_singular_matrix_is_an_error() {
        for n in [2, BLOCKED_ABOVE + 9, PANELS_ABOVE + 9] {
            let mut lu = Lu::<f64>::new(n, 1).unwrap();
            lu.matrix().fill(1.0);
            assert!(lu.factor(&Interrupt::none()).is_err());
            lu.matrix().fill(f64::NAN);
            assert!(lu.factor(&Interrupt::none()).is_err());
        }
    }
}
