//! Motion of the structure in one harmonic of a nonlinear mode with a single relative motion and without springs: the
//! formulas of `condense::modal_motion` in closed form, the inner loop of every mode with one contact.
//!
//! With q the relative motion in each mode, S = Σ |q|²/d and p = 1/(1 − S e) the flexibility is G = S p, and
//!
//! > ξ = −p q*/d w,  ∂S = −Σ |q|² ∂d/d²,  ∂p = p² (∂S e + S ∂e),  ∂G = p² (∂S + S² ∂e),  ∂d = ∂c − ∂s μ.

use crate::condense::modal_solution::{Pair, Solution};
use crate::condense::wave_modes::{NEAR_MODE, WaveModes};
use crate::error::{Result, try_push, try_vec};
use crate::linalg::expand;
use num_complex::Complex64;

const CONTEXT: &str = "the modes of the structure";

/// The modes as one contact sees them.
pub(super) struct SingleMotion {
    /// q* and |q|²
    seen: Vec<(Complex64, f64)>,
    /// 1/d
    inverse: Vec<Complex64>,
    /// ξ or another motion in the modes.
    motion: Vec<Complex64>,
}

/// c and s with a coefficient e; or their derivatives by one variable.
#[derive(Clone, Copy)]
pub(super) struct Coefficient {
    pub pair: Pair,
    pub e: Complex64,
}

impl SingleMotion {
    /// From the relative motion in each mode.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(relative: &[Complex64]) -> Result<Self> {
        let mut seen = Vec::new();
        for q in relative {
            try_push(&mut seen, (q.conj(), q.norm_sqr()), CONTEXT)?;
        }
        Ok(Self {
            inverse: try_vec(relative.len(), Complex64::ZERO, CONTEXT)?,
            motion: try_vec(relative.len(), Complex64::ZERO, CONTEXT)?,
            seen,
        })
    }

    /// Solves under the force w, at ν and with derivatives by two variables; `false` where a denominator is small.
    pub fn solve(
        &mut self,
        modes: &WaveModes,
        (at, nu): (Coefficient, f64),
        derivatives: [Coefficient; 2],
        w: Complex64,
        to: Solution<'_>,
    ) -> bool {
        if !modes.invert((at.pair.c, at.pair.s), (nu, NEAR_MODE), &mut self.inverse) {
            return false;
        }
        // S, and Σ |q|²/d² and Σ |q|² μ/d² for its derivatives.
        let (mut sum, mut squares, mut weighted) = (Complex64::ZERO, Complex64::ZERO, Complex64::ZERO);
        for ((inverse, (_, size)), mu) in self.inverse.iter().zip(&self.seen).zip(&modes.values) {
            let square = inverse * inverse * *size;
            sum += inverse * *size;
            squares += square;
            weighted += square * *mu;
        }
        let pivot = (1.0 - sum * at.e).inv();
        let [of_column, of_x, of_derivatives @ ..] = to.relative else {
            return false;
        };
        *of_column = sum * pivot;
        *of_x = -*of_column * w;
        for (motion, (inverse, (q, _))) in self.motion.iter_mut().zip(self.inverse.iter().zip(&self.seen)) {
            *motion = pivot * inverse * q;
        }
        if to.is_whole {
            expand(&modes.vectors, &self.motion, to.columns);
        }
        for motion in &mut self.motion {
            *motion *= -w;
        }
        expand(&modes.vectors, &self.motion, to.x);
        let wholes = [to.by_omega, to.by_damping];
        for ((by, of_motion), whole) in derivatives.into_iter().zip(of_derivatives).zip(wholes) {
            let d_sum = by.pair.s * weighted - by.pair.c * squares;
            let d_pivot = pivot * pivot * (d_sum * at.e + sum * by.e);
            *of_motion = -pivot * pivot * (d_sum + sum * sum * by.e) * w;
            if !to.is_whole {
                continue;
            }
            let modes_of = self.inverse.iter().zip(&self.seen).zip(&modes.values);
            for (motion, ((inverse, (q, _)), mu)) in self.motion.iter_mut().zip(modes_of) {
                let d_inverse = (by.pair.s * *mu - by.pair.c) * inverse * inverse;
                *motion = -(d_inverse * pivot + inverse * d_pivot) * q * w;
            }
            expand(&modes.vectors, &self.motion, whole);
        }
        true
    }
}
