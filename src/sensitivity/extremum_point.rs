//! The condition of an extremum of a response over the frequency that stays regular where Newton's matrix is singular.
//!
//! With the amplitude A the matrix
//!
//! > B = [J R_ω; A_u A_ω]
//!
//! is singular where a motion t = (t_u, t_ω) along the branch leaves the amplitude as it is: in peaks and hollows. Its rank is full but for
//! one also where a detached curve is born or merges with another one, although J has no inverse there. The bordered system of a
//! [fold](crate::sensitivity::fold_point), with B in place of J, gives the condition g = 0. With the null vectors t and (w, a) of B and
//! Bᵀ its change is that of −(wᵀR + aA) along t: one difference of exact Jacobians.

use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use crate::linalg::{dot, norm};
use crate::sensitivity::adjoint::CONTEXT;
use crate::sensitivity::central_differences::central_differences;
use crate::sensitivity::fold_point::{Borders, FoldCondition};
use crate::sensitivity::forced_point::ForcedPoint;

/// The last column and row of the matrix B but for the unit of the frequency.
pub(crate) struct ExtremumBorder<'a> {
    /// Derivative of the residual by ω.
    pub by_omega: &'a [f64],
    /// Derivatives of the amplitude by the motions and by ω.
    pub by_motion: &'a [f64],
    pub slope: f64,
}

/// The matrix B at the point evaluated last, column-major, for a frequency unknown whose change by 1 changes ω by
/// `unit`.
pub(crate) fn extremum_matrix(jacobian: &[f64], border: &ExtremumBorder<'_>, unit: f64) -> Result<Vec<f64>> {
    let &ExtremumBorder {
        by_omega,
        by_motion,
        slope,
    } = border;
    let m = by_motion.len();
    let n = m + 1;
    let mut matrix = try_vec(n * n, 0.0, CONTEXT)?;
    for (k, column) in matrix.chunks_exact_mut(n).enumerate() {
        if k < m {
            column[..m].copy_from_slice(&jacobian[k * m..(k + 1) * m]);
            column[m] = by_motion[k];
        } else {
            for (to, from) in column.iter_mut().zip(by_omega) {
                *to = unit * from;
            }
            column[m] = unit * slope;
        }
    }
    Ok(matrix)
}

/// Derivatives of the condition at (u, ω) by the motions and by ω; `unit` as for the matrix, `length` is the unit of
/// lengths of u.
///
/// # Errors
/// Those of the model and of callbacks; `OutOfMemory`; `StoppedByCaller`.
pub(crate) fn extremum_gradient(
    point: &mut ForcedPoint<'_>,
    u: &[f64],
    omega: f64,
    length: f64,
    at: &FoldCondition,
    unit: f64,
) -> Result<Vec<f64>> {
    let m = u.len();
    let (along, by_unknown) = at.v.split_at(m);
    let d_omega = unit * by_unknown[0];
    let (w, weight) = (&at.w[..m], at.w[m]);
    let (size, speed) = (norm(u), norm(along));
    let whole = if size > 0.0 && speed > 0.0 {
        size / speed
    } else {
        omega / d_omega.abs()
    };
    let mut found = try_vec(m + 1, 0.0, CONTEXT)?;
    let mut moved = try_vec(m, 0.0, CONTEXT)?;
    for (step, share) in central_differences(whole) {
        for ((to, y), t) in moved.iter_mut().zip(u).zip(along) {
            *to = y + step * t;
        }
        let gradient = point.weighted_gradient(&moved, omega + step * d_omega, w, weight)?;
        let factor = share / length;
        for (x, g) in found.iter_mut().zip(&gradient) {
            *x += factor * g;
        }
    }
    Ok(found)
}

impl ForcedPoint<'_> {
    /// The derivatives of −L (wᵀR + aA) by the motions and by ω, with the unit of lengths L and the weight a of the amplitude.
    fn weighted_gradient(&mut self, u: &[f64], omega: f64, w: &[f64], weight: f64) -> Result<Vec<f64>> {
        let (by_motion, amplitude) = self.amplitude(u, omega)?;
        let length = self.length();
        let mut gradient = try_vec(u.len() + 1, 0.0, CONTEXT)?;
        let columns = self.jacobian().chunks_exact(u.len().max(1));
        for ((g, column), a) in gradient.iter_mut().zip(columns).zip(&by_motion) {
            *g = -length * (dot(column, w) + weight * a);
        }
        let none = try_vec(u.len(), 0.0, CONTEXT)?;
        let of_equations = self.of_lambda(u, omega, 0.0.into(), w)?.by_omega;
        let of_amplitude = self.of_lambda(u, omega, amplitude, &none)?.by_omega;
        gradient[u.len()] = of_equations - weight * of_amplitude;
        Ok(gradient)
    }
}

impl Borders {
    /// Transfers the borders to other harmonics, where their last number belongs to the frequency.
    pub fn transfer_with_frequency(&mut self, from: &HarmonicSet, to: &HarmonicSet, motions: usize) -> Result<()> {
        let last = [self.b.pop(), self.c.pop()];
        self.transfer(from, to, motions)?;
        for (vector, last) in [&mut self.b, &mut self.c].into_iter().zip(last) {
            crate::error::try_push(vector, last.unwrap_or(0.0), CONTEXT)?;
        }
        Ok(())
    }
}
