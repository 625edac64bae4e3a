//! Eigenvalues λ in the upper half plane of (λ²M + λC + K) x = 0, with damping and gyroscopic forces in C and structural
//! damping in K.
//!
//! A small structure is projected on all modes of M and the Hermitian part of K, and solved as λ (x, λx) = (λx, −Kx − λCx) (Tisseur & Meerbergen 2001, doi:10.1137/S0036144500381988). The modes of a large one are found by the search of
//! [`quadratic_search`](crate::model::natural_modes::quadratic_search). Each eigenvalue is then corrected by inverse iteration with the whole matrices
//! (Neumaier 1985, doi:10.1137/0722055), which may not lead to another one.

use crate::error::{Result, Status, check_memory, fail, try_copy, try_extend, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::dense::general_eigen;
use crate::linalg::exact_sums::quadratic::{ComplexSum, product, quadratic};
use crate::linalg::libraries::{DMatrix, DVector};
use crate::linalg::sparse_storage::sparse::Csc;
use crate::model::natural_modes::all_undamped::all_undamped;
use crate::model::natural_modes::linear_modes::{ALL_MODES_UP_TO, finds_all};
use crate::model::natural_modes::quadratic_problem::{Pair, QUADRATIC_PROBLEM_REAL, Quadratic, is_one};
use crate::model::natural_modes::quadratic_search::lowest_by_search;
use crate::model::natural_modes::shifted_factors::ShiftedFactors;
use num_complex::Complex64;

/// Relative distance of the shift from an eigenvalue in its correction.
/// Kind: tuned; measured on: not recorded.
const QUADRATIC_MODES_OFFSET: f64 = 1e-7;

/// Largest number of corrections of an eigenvalue.
/// Kind: cap.
const QUADRATIC_MODES_CORRECTIONS: usize = 20;

/// Change of an eigenvalue by its correction, relative to it and to the distance of the next one, beyond which it has become another.
/// Kind: tuned; measured on: not recorded.
const BECOMES_OTHER: (f64, f64) = (1e-7, 0.1);

/// Modulus of an eigenvalue, over the norm of all of a small structure, from which it has twelve digits.
/// Kind: rounding.
const QUADRATIC_MODES_EXACT: f64 = 1e-4;

/// Frequency of a motion, over the highest, below which it is scaled as if it had that.
/// Kind: rounding.
const QUADRATIC_MODES_FLOOR: f64 = 1e-10;

/// Square matrices of the order 2r that the eigensolver holds at a time.
/// Kind: fixed.
const QUADRATIC_MODES_COPIES: usize = 6;

const CONTEXT: &str = "the damped modes";

impl Quadratic<'_> {
    /// The `count` eigenvalues of lowest imaginary part, or all if there are fewer. Motions that do not oscillate,
    /// rigid or damped beyond vibration, are not counted unless they grow: these have a real eigenvalue above zero,
    /// and come first.
    ///
    /// # Errors
    /// Those of the eigensolvers; `NoConvergence`, `OutOfMemory`, `StoppedByCaller`.
    pub fn lowest(&self, count: usize, interrupt: &Interrupt<'_>) -> Result<Vec<Pair>> {
        let hermitian = self.hermitian_stiffness()?;
        if let Some((mut pairs, moving)) = self.on_moving_rows(&hermitian, |moving| moving.lowest(count, interrupt))? {
            for pair in &mut pairs {
                pair.1 = moving.expanded(&pair.1)?;
            }
            return Ok(pairs);
        }
        let n = self.mass.rows;
        let is_small = n <= ALL_MODES_UP_TO;
        let searched = if finds_all(n, count) {
            None
        } else {
            lowest_by_search(self, &hermitian, count, interrupt)?
        };
        let (mut pairs, size) = match searched {
            Some(pairs) => (pairs, f64::INFINITY),
            None => self.projected(&self.basis(&hermitian, interrupt)?, interrupt)?,
        };
        pairs.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
        let mut found: Vec<Pair> = Vec::new();
        for (k, pair) in pairs.iter().enumerate() {
            if found.len() >= count {
                break;
            }
            interrupt.check()?;
            let better = if is_small && pair.0.norm() >= QUADRATIC_MODES_EXACT * size {
                (pair.0, try_copy(&pair.1, CONTEXT)?)
            } else {
                self.improved(&pairs, k, &found, interrupt)?
            };
            let Some(eigenvalue) = self.as_mode(better.0, &better.1) else {
                continue;
            };
            let mut shape = better.1;
            let norm = quadratic(self.mass, &shape).sqrt();
            for x in &mut shape {
                *x /= norm;
            }
            try_push(&mut found, (eigenvalue, shape), CONTEXT)?;
        }
        found.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
        Ok(found)
    }

    /// The k-th pair after its correction, or as it was found where that leads to another one.
    fn improved(&self, pairs: &[Pair], k: usize, found: &[Pair], interrupt: &Interrupt<'_>) -> Result<Pair> {
        let pair = &pairs[k];
        let others = pairs.iter().enumerate().filter(|(l, _)| *l != k);
        let gap = others.fold(f64::INFINITY, |least, (_, other)| least.min((other.0 - pair.0).norm()));
        let most = (BECOMES_OTHER.0 * pair.0.norm()).max(BECOMES_OTHER.1 * gap);
        match self.corrected(pair, interrupt) {
            Err(e) if !matches!(e.status, Status::NoConvergence | Status::Singular) => Err(e),
            Ok(better) if (better.0 - pair.0).norm() <= most && !found.iter().any(|other| is_one(other, &better)) => {
                Ok(better)
            }
            _ => Ok((pair.0, try_copy(&pair.1, CONTEXT)?)),
        }
    }

    /// Undamped modes as a basis, column after column.
    fn basis(&self, hermitian: &Csc, interrupt: &Interrupt<'_>) -> Result<DMatrix<Complex64>> {
        let n = self.mass.rows;
        check_memory::<Complex64>(n.saturating_mul(n).saturating_mul(2 * QUADRATIC_MODES_COPIES), CONTEXT)?;
        Ok(all_undamped(hermitian, self.mass, interrupt)?.vectors)
    }

    /// Eigenvalues and shapes of the problem projected on the columns of `basis`, which are orthonormal in M; and the norm of all
    /// eigenvalues, of which each has the rounding error.
    fn projected(&self, basis: &DMatrix<Complex64>, interrupt: &Interrupt<'_>) -> Result<(Vec<Pair>, f64)> {
        let (n, r) = (basis.nrows(), basis.ncols());
        check_memory::<Complex64>((4 * r * r).saturating_mul(QUADRATIC_MODES_COPIES), CONTEXT)?;
        let mut sums = try_vec(n, ComplexSum::default(), CONTEXT)?;
        let mut project = |a: &Csc| -> Result<DMatrix<Complex64>> {
            let mut moved = DMatrix::zeros(n, r);
            for (from, mut to) in basis.column_iter().zip(moved.column_iter_mut()) {
                interrupt.check()?;
                // In twice the precision: soft motions hardly strain stiff springs.
                sums.fill(ComplexSum::default());
                product(a, &a.values, from.as_slice(), &mut sums);
                for (to, sum) in to.iter_mut().zip(&sums) {
                    *to = sum.total();
                }
            }
            Ok(basis.adjoint() * moved)
        };
        let (k, mut c) = (project(self.stiffness)?, project(self.damping)?);
        for direction in self.modal {
            let seen = |j: usize| direction.iter().map(|&(p, z)| z.conj() * basis[(p, j)]).sum();
            let seen = DVector::<Complex64>::from_fn(r, |j, _| seen(j));
            c += &seen.map(|z| z.conj()) * seen.transpose();
        }
        // In energy coordinates, (Ω p, λ p) with the stiffness Ω² of each motion, no entry is larger than a frequency, and stiff motions
        // do not spoil soft ones.
        let mut frequencies = try_vec(r, 0.0, CONTEXT)?;
        for (omega, column) in frequencies.iter_mut().zip(k.column_iter()) {
            *omega = column.iter().fold(0.0_f64, |most, k| most.max(k.norm())).sqrt();
        }
        let highest = frequencies.iter().copied().fold(0.0, f64::max);
        if highest == 0.0 || !highest.is_finite() {
            return Ok((Vec::new(), highest));
        }
        for omega in &mut frequencies {
            *omega = omega.max(QUADRATIC_MODES_FLOOR * highest);
        }
        // Column after column, the two states of each motion side by side and those of stiff motions first: reductions from the left
        // then leave to small entries their own digits.
        let order = 2 * r;
        let place = |mode: usize| 2 * (r - 1 - mode);
        let mut companion = try_vec(order * order, Complex64::ZERO, CONTEXT)?;
        for (j, &omega) in frequencies.iter().enumerate() {
            companion[(place(j) + 1) * order + place(j)] = omega.into();
            for i in 0..r {
                companion[place(j) * order + place(i) + 1] = -k[(i, j)] / omega;
                companion[(place(j) + 1) * order + place(i) + 1] = -c[(i, j)];
            }
        }
        let size = companion.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        let states = general_eigen::eigen_of_any_order(&companion, order, interrupt)?;
        let mut pairs = Vec::new();
        for (&value, state) in states.values.iter().zip(states.vectors.chunks_exact(order)) {
            let oscillates = value.im
                > QUADRATIC_PROBLEM_REAL * value.norm().max(f64::EPSILON.sqrt() * QUADRATIC_PROBLEM_REAL * size);
            let may_grow = value.re > 0.0 && value.im.abs() <= QUADRATIC_PROBLEM_REAL * value.norm();
            if !(oscillates || may_grow) {
                continue;
            }
            interrupt.check()?;
            let mut shape = try_vec(n, Complex64::ZERO, CONTEXT)?;
            for (mode, (omega, column)) in frequencies.iter().zip(basis.column_iter()).enumerate() {
                let part = state[place(mode)] / omega;
                for (x, phi) in shape.iter_mut().zip(column.iter()) {
                    *x += part * phi;
                }
            }
            if let Some(eigenvalue) = self.as_mode(value, &shape) {
                try_push(&mut pairs, (eigenvalue, shape), CONTEXT)?;
            }
        }
        Ok((pairs, size))
    }

    /// Newton's method on A(λ) x = 0, vᴴ x = 1 with v = M x₀, with the factors at a shift nearby.
    fn corrected(&self, (start, shape): &Pair, interrupt: &Interrupt<'_>) -> Result<Pair> {
        let n = self.mass.rows;
        let (mut eigenvalue, mut x) = (*start, try_copy(shape, CONTEXT)?);
        let v = self.mass.times(shape, CONTEXT)?;
        let project = |z: &[Complex64]| -> Complex64 { v.iter().zip(z).map(|(v, z)| v.conj() * z).sum() };
        let mut factors: Option<ShiftedFactors<'_>> = None;
        let mut last = f64::INFINITY;
        for _ in 0..QUADRATIC_MODES_CORRECTIONS {
            interrupt.check()?;
            let shift = eigenvalue * (1.0 + QUADRATIC_MODES_OFFSET);
            let factors = match &mut factors {
                Some(factors) => {
                    factors.renew(shift, interrupt)?;
                    factors
                }
                none => none.insert(ShiftedFactors::new(self, shift, 2, interrupt)?),
            };
            let mut columns = self.times(eigenvalue, &x)?;
            try_extend(&mut columns, &self.slope_times(eigenvalue, &x)?, CONTEXT)?;
            factors.solve(&mut columns, false, interrupt)?;
            let (residual, slope) = columns.split_at(n);
            let step = -project(residual) / project(slope);
            let (mut change, mut size) = (0.0_f64, 0.0_f64);
            for ((x, r), s) in x.iter_mut().zip(residual).zip(slope) {
                let dx = r + step * s;
                *x -= dx;
                change = change.max(dx.norm());
                size = size.max(x.norm());
            }
            eigenvalue += step;
            if !(eigenvalue.is_finite() && size.is_finite() && (eigenvalue - start).norm() <= 0.5 * start.norm()) {
                return fail!(
                    NoConvergence,
                    "the damped mode near {} + {}i was not reached",
                    start.re,
                    start.im
                );
            }
            let change = change / size + step.norm() / eigenvalue.norm();
            if change <= 1e-14 || (change < 1e-9 && change > 0.5 * last) {
                break;
            }
            last = change;
        }
        Ok((eigenvalue, x))
    }
}
