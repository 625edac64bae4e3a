//! Eigenvalues λ in the upper half plane of (λ²M + λC + K) x = 0, with damping and gyroscopic forces in C and structural
//! damping in K.
//!
//! The problem is projected on the modes of M and the Hermitian part of K, all of them for a small structure, and solved
//! as λ (x, λx) = (λx, −Kx − λCx) by Schur's form (Tisseur & Meerbergen 2001, doi:10.1137/S0036144500381988). In a large
//! structure each eigenvalue is then corrected by inverse iteration with the whole matrices (Neumaier 1985,
//! doi:10.1137/0722055).

use crate::error::{Result, check_memory, fail, try_copy, try_extend, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::eigen;
use crate::linalg::factor::Factor;
use crate::linalg::held_rows::MovingRows;
use crate::linalg::lanczos;
use crate::linalg::quadratic::{ROUNDING, quadratic, terms};
use crate::linalg::sparse::{Csc, Form};
use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;

/// Degrees of freedom up to which the projection is complete.
const QUADRATIC_MODES_DENSE_UP_TO: usize = 100;

/// Modes of the projection beyond twice the number that is requested.
const SPARE: usize = 12;

/// Most modes of the projection of a large structure.
const QUADRATIC_MODES_MOST: usize = 200;

/// Iterations of Schur's form for each eigenvalue.
const QUADRATIC_MODES_ITERATIONS: usize = 200;

/// Imaginary part over the modulus below which an eigenvalue is no vibration.
const REAL: f64 = 1e-9;

/// Relative distance of the shift from an eigenvalue in its correction.
const QUADRATIC_MODES_OFFSET: f64 = 1e-7;

/// Largest number of corrections of an eigenvalue.
const QUADRATIC_MODES_CORRECTIONS: usize = 20;

/// Square matrices of the order 2r that Schur's form holds at a time.
const QUADRATIC_MODES_COPIES: usize = 6;

const CONTEXT: &str = "the damped modes";

/// M, C and K.
pub struct Quadratic<'a> {
    /// M
    pub mass: &'a Csc,
    /// C, with gyroscopic forces
    pub damping: &'a Csc,
    /// K, with structural damping
    pub stiffness: &'a Csc,
}

/// An eigenvalue with its shape, xᴴ M x = 1.
pub type Pair = (Complex64, Vec<Complex64>);

impl Quadratic<'_> {
    /// The `count` eigenvalues of lowest imaginary part, fewer if there are not so many. Motions that do not oscillate, rigid or
    /// damped beyond vibration, are not counted, unless they grow: these have a real eigenvalue above zero, and come first.
    ///
    /// # Errors
    /// Those of the eigensolvers; `NoConvergence`, `OutOfMemory`, `StoppedByCaller`.
    pub fn lowest(&self, count: usize, interrupt: &Interrupt<'_>) -> Result<Vec<Pair>> {
        let hermitian = self.hermitian_stiffness()?;
        if let Some(moving) = MovingRows::of(&hermitian)? {
            let parts = [self.mass, self.damping, self.stiffness].map(|a| moving.reduced(a));
            let [mass, damping, stiffness] = parts;
            let reduced = Quadratic {
                mass: &mass?,
                damping: &damping?,
                stiffness: &stiffness?,
            };
            let mut pairs = reduced.lowest(count, interrupt)?;
            for pair in &mut pairs {
                pair.1 = moving.expanded(&pair.1)?;
            }
            return Ok(pairs);
        }
        let n = self.mass.rows;
        let complete = n <= QUADRATIC_MODES_DENSE_UP_TO;
        let basis = self.basis(
            &hermitian,
            if complete {
                n
            } else {
                (2 * count + SPARE).min(QUADRATIC_MODES_MOST).min(n)
            },
            interrupt,
        )?;
        let mut pairs = self.projected(&basis, interrupt)?;
        pairs.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
        pairs.truncate(count);
        for pair in &mut pairs {
            interrupt.check()?;
            if !complete {
                *pair = self.corrected(pair, interrupt)?;
            }
            let norm = quadratic(self.mass, &pair.1).sqrt();
            for x in &mut pair.1 {
                *x /= norm;
            }
        }
        pairs.sort_by(|a, b| a.0.im.total_cmp(&b.0.im));
        Ok(pairs)
    }

    /// The Hermitian part of K.
    fn hermitian_stiffness(&self) -> Result<Csc> {
        let n = self.mass.rows;
        let half = Complex64::new(0.5, 0.0);
        let transposed = Csc::sum(n, &[(Complex64::ONE, self.stiffness, Form::Transposed)])?;
        Csc::sum(
            n,
            &[
                (half, self.stiffness, Form::Plain),
                (half, &transposed, Form::Conjugated),
            ],
        )
    }

    /// The lowest undamped modes, column by column.
    fn basis(&self, hermitian: &Csc, count: usize, interrupt: &Interrupt<'_>) -> Result<DMatrix<Complex64>> {
        let n = self.mass.rows;
        if count < n && count <= n / 2 {
            return Ok(lanczos::lowest(hermitian, self.mass, count, interrupt)?.vectors);
        }
        check_memory::<Complex64>(n.saturating_mul(n).saturating_mul(2 * QUADRATIC_MODES_COPIES), CONTEXT)?;
        Ok(eigen::generalised(&dense(hermitian), &dense(self.mass), interrupt)?.vectors)
    }

    /// Eigenvalues and shapes of the projection on the columns of `basis`, which are orthonormal in M.
    fn projected(&self, basis: &DMatrix<Complex64>, interrupt: &Interrupt<'_>) -> Result<Vec<Pair>> {
        let (n, r) = (basis.nrows(), basis.ncols());
        check_memory::<Complex64>((4 * r * r).saturating_mul(QUADRATIC_MODES_COPIES), CONTEXT)?;
        let project = |a: &Csc| -> Result<DMatrix<Complex64>> {
            let mut moved = DMatrix::zeros(n, r);
            for (from, mut to) in basis.column_iter().zip(moved.column_iter_mut()) {
                interrupt.check()?;
                a.multiply_add(Complex64::ONE, from.as_slice(), to.as_mut_slice());
            }
            Ok(basis.adjoint() * moved)
        };
        let (k, c) = (project(self.stiffness)?, project(self.damping)?);
        // The unit of frequencies makes both halves of the state alike in size.
        let unit = (k.norm() / (r.max(1) as f64).sqrt()).sqrt();
        if unit == 0.0 || !unit.is_finite() {
            return Ok(Vec::new());
        }
        let mut companion = DMatrix::<Complex64>::zeros(2 * r, 2 * r);
        companion.view_mut((0, r), (r, r)).fill_with_identity();
        companion
            .view_mut((r, 0), (r, r))
            .copy_from(&(k * Complex64::from(-1.0 / (unit * unit))));
        companion
            .view_mut((r, r), (r, r))
            .copy_from(&(c * Complex64::from(-1.0 / unit)));
        let Some(schur) = Schur::try_new(companion, f64::EPSILON, QUADRATIC_MODES_ITERATIONS * 2 * r) else {
            return fail!(NoConvergence, "the eigenvalues of the damped structure were not found");
        };
        let (q, t) = schur.unpack();
        let size = t.norm();
        let mut pairs = Vec::new();
        for j in 0..2 * r {
            let value = t[(j, j)];
            let oscillates = value.im > REAL * value.norm().max(f64::EPSILON.sqrt() * REAL * size);
            let may_grow = value.re > 0.0 && value.im.abs() <= REAL * value.norm();
            if !(oscillates || may_grow) {
                continue;
            }
            interrupt.check()?;
            // (T − t_jj) y = 0 by back substitution; equal eigenvalues keep independent vectors.
            let mut y = try_vec(2 * r, Complex64::ZERO, CONTEXT)?;
            y[j] = Complex64::ONE;
            for i in (0..j).rev() {
                let sum: Complex64 = (i + 1..=j).map(|l| t[(i, l)] * y[l]).sum();
                let mut gap = t[(i, i)] - value;
                if gap.norm() < f64::EPSILON * size {
                    gap = (f64::EPSILON * size).into();
                }
                y[i] = -sum / gap;
            }
            let mut shape = try_vec(n, Complex64::ZERO, CONTEXT)?;
            for mode in 0..r {
                let part: Complex64 = (0..=j).map(|l| q[(mode, l)] * y[l]).sum();
                for (x, phi) in shape.iter_mut().zip(basis.column(mode).iter()) {
                    *x += part * phi;
                }
            }
            let mut eigenvalue = value * unit;
            if oscillates && self.is_rigid(eigenvalue, &shape) {
                continue;
            }
            if !oscillates {
                eigenvalue.im = 0.0;
                if !self.grows(eigenvalue.re, &shape) {
                    continue;
                }
            }
            try_push(&mut pairs, (eigenvalue, shape), CONTEXT)?;
        }
        Ok(pairs)
    }

    /// Whether a motion of a real eigenvalue λ > 0 is no rigid one up to rounding: xᴴ(K + λC)x, which is −λ² xᴴMx.
    fn grows(&self, rate: f64, x: &[Complex64]) -> bool {
        let force = quadratic(self.stiffness, x) + rate * quadratic(self.damping, x);
        force < -ROUNDING * (terms(self.stiffness, x) + rate * terms(self.damping, x))
    }

    /// Whether a motion is rigid up to rounding: its inertia |λ²| xᴴMx is below that of the forces. The two eigenvalues zero of a motion
    /// that nothing holds lie apart by the root of rounding, in any direction.
    fn is_rigid(&self, eigenvalue: Complex64, x: &[Complex64]) -> bool {
        let forces = terms(self.stiffness, x) + eigenvalue.norm() * terms(self.damping, x);
        eigenvalue.norm_sqr() * quadratic(self.mass, x) <= ROUNDING * forces
    }

    /// λ²M + λC + K
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn matrix(&self, eigenvalue: Complex64) -> Result<Csc> {
        Csc::sum(
            self.mass.rows,
            &[
                (Complex64::ONE, self.stiffness, Form::Plain),
                (eigenvalue, self.damping, Form::Plain),
                (eigenvalue * eigenvalue, self.mass, Form::Plain),
            ],
        )
    }

    /// (2λM + C) x
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn slope_times(&self, eigenvalue: Complex64, x: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut y = self.damping.times(x, CONTEXT)?;
        self.mass.multiply_add(2.0 * eigenvalue, x, &mut y);
        Ok(y)
    }

    /// Newton's method on A(λ) x = 0, vᴴ x = 1 with v = M x₀, with the factors at a shift nearby.
    fn corrected(&self, (start, shape): &Pair, interrupt: &Interrupt<'_>) -> Result<Pair> {
        let n = self.mass.rows;
        let (mut eigenvalue, mut x) = (*start, try_copy(shape, CONTEXT)?);
        let v = self.mass.times(shape, CONTEXT)?;
        let project = |z: &[Complex64]| -> Complex64 { v.iter().zip(z).map(|(v, z)| v.conj() * z).sum() };
        let mut factor = Factor::new(&self.matrix(eigenvalue)?, 2)?;
        let mut last = f64::INFINITY;
        for _ in 0..QUADRATIC_MODES_CORRECTIONS {
            interrupt.check()?;
            factor.factor(&self.matrix(eigenvalue * (1.0 + QUADRATIC_MODES_OFFSET))?, interrupt)?;
            let mut columns = try_vec(n, Complex64::ZERO, CONTEXT)?;
            self.matrix(eigenvalue)?.multiply_add(Complex64::ONE, &x, &mut columns);
            try_extend(&mut columns, &self.slope_times(eigenvalue, &x)?, CONTEXT)?;
            factor.solve(&mut columns, false, interrupt)?;
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

fn dense(a: &Csc) -> DMatrix<Complex64> {
    let mut d = DMatrix::zeros(a.rows, a.cols);
    a.add_to_dense(Complex64::ONE, d.as_mut_slice());
    d
}
