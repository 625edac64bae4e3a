//! The condition of a fold of a forced response over the frequency, and its derivatives.
//!
//! Newton's matrix J is singular in a fold. With two vectors b and c the system
//!
//! > [J b; cᵀ 0] [v; g] = [0; 1],  [J b; cᵀ 0]ᵀ [w; g] = [0; 1]
//!
//! is regular, and g = 0 is the condition. Its change is dg = −wᵀ dJ v (Govaerts 2000, doi:10.1137/1.9780898719543), and
//! because second derivatives commute that is −d(wᵀ dR) along v: one difference of exact Jacobians.

use crate::error::{Result, Status, try_copy, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::norm;
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::central_differences::central_differences;
use crate::sensitivity::forced_point::ForcedPoint;

/// Iterations for the first borders.
/// Kind: tuned; measured on: not recorded.
const FOLD_POINT_ITERATIONS: usize = 3;

/// Size of a perturbation that makes an exactly singular matrix regular.
/// Kind: rounding.
const PERTURBATION: f64 = 1e-9;

/// Border vectors b and c of the condition.
#[derive(Clone, Debug, Default)]
pub(crate) struct Borders {
    pub b: Vec<f64>,
    pub c: Vec<f64>,
}

/// The condition of a fold and its null vectors.
pub(crate) struct FoldCondition {
    /// Value g of the condition: zero in a fold.
    pub value: f64,
    /// Null vector v of J in a fold.
    pub v: Vec<f64>,
    /// Null vector w of Jᵀ in a fold.
    pub w: Vec<f64>,
}

/// Derivatives of the condition of a fold.
pub(crate) struct FoldGradient {
    /// Derivatives by the motions, then by ω.
    pub by_unknowns: Vec<f64>,
    /// Derivative by the parameter.
    pub by_parameter: f64,
}

impl Borders {
    /// Borders for a point near a fold, from Newton's matrix at it, column-major.
    ///
    /// # Errors
    /// `OutOfMemory`; `Singular`; `StoppedByCaller`.
    pub fn near(jacobian: &[f64], n: usize, interrupt: &Interrupt<'_>) -> Result<Self> {
        let mut system = Lu::new(n, 1)?;
        system.matrix().copy_from_slice(jacobian);
        if let Err(e) = system.factor(interrupt) {
            if e.status != Status::Singular {
                return Err(e);
            }
            system.matrix().copy_from_slice(jacobian);
            for k in 0..n {
                system.matrix()[k * n + k] += PERTURBATION;
            }
            system.factor(interrupt)?;
        }
        let mut c = try_vec(n, 1.0, CONTEXT)?;
        let mut b = try_copy(&c, CONTEXT)?;
        for _ in 0..FOLD_POINT_ITERATIONS {
            b.copy_from_slice(&c);
            system.solve_transposed(&mut b);
            normalise(&mut b);
            c.copy_from_slice(&b);
            system.solve(&mut c);
            normalise(&mut c);
        }
        Ok(Self { b, c })
    }

    /// The condition for a matrix, column-major.
    ///
    /// # Errors
    /// `OutOfMemory`; `Singular`; `StoppedByCaller`.
    pub fn condition(&self, jacobian: &[f64], interrupt: &Interrupt<'_>) -> Result<FoldCondition> {
        let n = self.b.len();
        let mut system = Lu::new(n + 1, 1)?;
        let matrix = system.matrix();
        matrix.fill(0.0);
        for k in 0..n {
            let column = &mut matrix[k * (n + 1)..(k + 1) * (n + 1)];
            column[..n].copy_from_slice(&jacobian[k * n..(k + 1) * n]);
            column[n] = self.c[k];
        }
        matrix[n * (n + 1)..n * (n + 1) + n].copy_from_slice(&self.b);
        system.factor(interrupt)?;
        let mut v = try_vec(n + 1, 0.0, CONTEXT)?;
        v[n] = 1.0;
        let mut w = try_copy(&v, CONTEXT)?;
        system.solve(&mut v);
        system.solve_transposed(&mut w);
        let value = v.pop().unwrap_or(f64::NAN);
        w.pop();
        Ok(FoldCondition { value, v, w })
    }

    /// Replaces the borders by the null vectors, in the sense of the former borders, so that the condition keeps its
    /// sign.
    pub fn follow(&mut self, at: &FoldCondition) -> Result<()> {
        // vᵀc = wᵀb = 1 in a fold: both senses are kept.
        self.b = try_copy(&at.w, CONTEXT)?;
        self.c = try_copy(&at.v, CONTEXT)?;
        normalise(&mut self.b);
        normalise(&mut self.c);
        Ok(())
    }

    /// Transfers the borders to other harmonics.
    pub fn transfer(&mut self, from: &HarmonicSet, to: &HarmonicSet, n: usize) -> Result<()> {
        for x in [&mut self.b, &mut self.c] {
            let mut moved = try_vec(n, 0.0, CONTEXT)?;
            to.transfer(from, x, 1.0, &mut moved);
            *x = moved;
        }
        Ok(())
    }
}

/// Derivatives of the condition at (u, ω); `by_parameter` gives the derivative of a result by the parameter from its
/// adjoint motion. `length` is the unit of lengths of u.
///
/// # Errors
/// Those of the model and of callbacks; `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn fold_gradient(
    point: &mut ForcedPoint<'_>,
    u: &[f64],
    omega: f64,
    length: f64,
    at: &FoldCondition,
    mut by_parameter: impl FnMut(&Adjoint) -> Result<f64>,
) -> Result<FoldGradient> {
    let mut found = FoldGradient {
        by_unknowns: try_vec(u.len() + 1, 0.0, CONTEXT)?,
        by_parameter: 0.0,
    };
    for (step, weight) in central_differences(norm(u) / norm(&at.v)) {
        let mut moved = try_copy(u, CONTEXT)?;
        for (y, v) in moved.iter_mut().zip(&at.v) {
            *y += step * v;
        }
        let (gradient, adjoint) = point.residual_gradient(&moved, omega, &at.w)?;
        let factor = weight / length;
        for (x, g) in found.by_unknowns.iter_mut().zip(&gradient) {
            *x += factor * g;
        }
        found.by_parameter += factor * by_parameter(&adjoint)?;
    }
    Ok(found)
}

fn normalise(x: &mut [f64]) {
    let size = norm(x);
    for x in x {
        *x /= size;
    }
}
