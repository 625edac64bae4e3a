//! The quadratic eigenproblem (λ²M + λC + K) x = 0 of a damped structure, and which of its eigenvalues are modes.

use crate::error::{Result, try_push, try_vec};
use crate::linalg::exact_sums::quadratic::{ComplexSum, QUADRATIC_ROUNDING, form, product, quadratic, terms};
use crate::linalg::factors::low_rank_term::add_term_product;
use crate::linalg::inner;
use crate::linalg::iterative::block_krylov::SparseVector;
use crate::linalg::sparse_storage::held_rows::MovingRows;
use crate::linalg::sparse_storage::sparse::{Csc, Form};
use num_complex::Complex64;

/// Imaginary part over the modulus below which an eigenvalue is no vibration: the root of rounding splits double ones.
/// Kind: rounding.
pub const QUADRATIC_PROBLEM_REAL: f64 = 1e-7;

/// Imaginary part over the modulus below which a motion that nothing holds may be no vibration.
/// Kind: rounding.
const NEARLY_REAL: f64 = 1e-3;

/// Relative distance of eigenvalues, and the square of the sine between their vectors, below which two are one.
/// Kind: rounding.
pub const ONE_VALUE: f64 = 1e-7;
const ONE_VECTOR: f64 = 1e-4;

const CONTEXT: &str = "the damped modes";

/// Matrices of the problem (λ²M + λC + K) x = 0.
pub struct Quadratic<'a> {
    /// Mass matrix M.
    pub mass: &'a Csc,
    /// Damping matrix C, gyroscopic forces included.
    pub damping: &'a Csc,
    /// Stiffness matrix K, structural damping included.
    pub stiffness: &'a Csc,
    /// Columns of L of damping L Lᴴ beside C.
    pub modal: &'a [SparseVector],
}

/// An eigenvalue with its shape, xᴴ M x = 1.
pub type Pair = (Complex64, Vec<Complex64>);

impl Quadratic<'_> {
    /// Hermitian part of K.
    pub fn hermitian_stiffness(&self) -> Result<Csc> {
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

    /// Result of `ask` for the problem of the rows that move, with these rows; `None` where all do.
    ///
    /// # Errors
    /// Those of `ask`; `OutOfMemory`.
    pub fn on_moving_rows<T>(
        &self,
        hermitian: &Csc,
        ask: impl FnOnce(&Quadratic<'_>) -> Result<T>,
    ) -> Result<Option<(T, MovingRows)>> {
        let Some(moving) = MovingRows::of(hermitian)? else {
            return Ok(None);
        };
        let parts = [self.mass, self.damping, self.stiffness].map(|a| moving.reduced(a));
        let [mass, damping, stiffness] = parts;
        let mut modal = Vec::new();
        for direction in self.modal {
            try_push(&mut modal, moving.reduced_vector(direction)?, CONTEXT)?;
        }
        let found = ask(&Quadratic {
            mass: &mass?,
            damping: &damping?,
            stiffness: &stiffness?,
            modal: &modal,
        })?;
        Ok(Some((found, moving)))
    }

    /// The eigenvalue, if it belongs to a mode: it oscillates, or grows and is then real. `None` for a motion that is
    /// rigid or damped beyond vibration.
    pub fn as_mode(&self, mut eigenvalue: Complex64, shape: &[Complex64]) -> Option<Complex64> {
        if eigenvalue.im.abs() < NEARLY_REAL * eigenvalue.norm()
            && let Some(rate) = self.unheld_rate(shape)
        {
            eigenvalue = rate.into();
        }
        if eigenvalue.im > QUADRATIC_PROBLEM_REAL * eigenvalue.norm() {
            return (!self.is_rigid(eigenvalue, shape)).then_some(eigenvalue);
        }
        if eigenvalue.re <= 0.0 || eigenvalue.im < -QUADRATIC_PROBLEM_REAL * eigenvalue.norm() {
            return None;
        }
        eigenvalue.im = 0.0;
        self.grows(eigenvalue.re, shape).then_some(eigenvalue)
    }

    /// The eigenvalue −xᴴCx/xᴴMx of a motion that nothing holds, where it is real. Several such motions have it in common, which rounding
    /// splits into pairs.
    fn unheld_rate(&self, x: &[Complex64]) -> Option<f64> {
        if quadratic(self.stiffness, x).abs() > QUADRATIC_ROUNDING * terms(self.stiffness, x) {
            return None;
        }
        let force = form(self.damping, &self.damping.values, x) + self.modal_form(x);
        let is_real = force.im.abs() <= QUADRATIC_PROBLEM_REAL * force.norm();
        is_real.then(|| -force.re / quadratic(self.mass, x))
    }

    /// Form xᴴL Lᴴx of the damping beside C.
    fn modal_form(&self, x: &[Complex64]) -> f64 {
        let seen = |direction: &SparseVector| direction.iter().map(|&(p, z)| z.conj() * x[p]).sum::<Complex64>();
        self.modal.iter().map(|direction| seen(direction).norm_sqr()).sum()
    }

    /// Whether a motion with a real eigenvalue λ > 0 is more than a rigid motion with rounding, by xᴴ(K + λC)x, which
    /// is −λ² xᴴMx.
    fn grows(&self, rate: f64, x: &[Complex64]) -> bool {
        let modal = self.modal_form(x);
        let force = quadratic(self.stiffness, x) + rate * (quadratic(self.damping, x) + modal);
        force < -QUADRATIC_ROUNDING * (terms(self.stiffness, x) + rate * (terms(self.damping, x) + modal))
    }

    /// Whether a motion is rigid up to rounding: its inertia |λ²| xᴴMx is below the rounding of the forces. The two
    /// zero eigenvalues of a motion that nothing holds are apart by the root of rounding, in any direction.
    fn is_rigid(&self, eigenvalue: Complex64, x: &[Complex64]) -> bool {
        let damping = terms(self.damping, x) + self.modal_form(x);
        let forces = terms(self.stiffness, x) + eigenvalue.norm() * damping;
        eigenvalue.norm_sqr() * quadratic(self.mass, x) <= QUADRATIC_ROUNDING * forces
    }

    /// Matrix λ²M + λC + K at an eigenvalue λ, without the damping beside C.
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

    /// Product (λ²M + λC + λL Lᴴ + K) x, whose terms may cancel beside stiff springs.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn times(&self, eigenvalue: Complex64, x: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut sums = try_vec(x.len(), ComplexSum::default(), CONTEXT)?;
        let mut y = try_vec(x.len(), Complex64::ZERO, CONTEXT)?;
        for (a, factor) in [
            (self.stiffness, Complex64::ONE),
            (self.damping, eigenvalue),
            (self.mass, eigenvalue * eigenvalue),
        ] {
            sums.fill(ComplexSum::default());
            product(a, &a.values, x, &mut sums);
            for (y, sum) in y.iter_mut().zip(&sums) {
                *y += factor * sum.total();
            }
        }
        add_term_product(self.modal, eigenvalue, false, x, &mut y);
        Ok(y)
    }

    /// Product (2λM + C + L Lᴴ) x, the slope of the matrix by λ.
    pub fn slope_times(&self, eigenvalue: Complex64, x: &[Complex64]) -> Result<Vec<Complex64>> {
        let mut y = self.damping.times(x, CONTEXT)?;
        self.mass.multiply_add(2.0 * eigenvalue, x, &mut y);
        add_term_product(self.modal, Complex64::ONE, false, x, &mut y);
        Ok(y)
    }
}

/// Whether two pairs are the same mode.
pub fn is_one(a: &Pair, b: &Pair) -> bool {
    if (a.0 - b.0).norm() > ONE_VALUE * a.0.norm() {
        return false;
    }
    let (aa, bb) = (inner(&a.1, &a.1).re, inner(&b.1, &b.1).re);
    inner(&a.1, &b.1).norm_sqr() >= (1.0 - ONE_VECTOR) * aa * bb
}
