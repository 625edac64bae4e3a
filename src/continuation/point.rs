//! A solved point of a branch with its tangent.

use crate::continuation::corrector::Corrected;
use crate::error::{Result, try_copy, try_extend};
use crate::problem::End;
use num_complex::Complex64;

/// Relative change of a parameter that may be round-off of the correction.
/// Kind: rounding.
const POINT_ROUND_OFF: f64 = 1e-10;

/// Distance of two solutions that are one, over their size.
/// Kind: tuned; measured on: not recorded.
pub const ONE_SOLUTION: f64 = 1e-6;

/// A point with the index of its resolution.
pub type PointAt<'p> = (&'p Point, usize);

/// A solved point of a branch with its tangent.
#[derive(Clone, Debug)]
pub struct Point {
    /// Unknowns and parameter (u, p).
    pub v: Vec<f64>,
    /// Direction of the branch, in the sense in which it is followed.
    pub tangent: Vec<f64>,
    /// Observed complex amplitude.
    pub amplitude: Complex64,
    /// Derivative of the amplitude along the tangent.
    pub slope: Complex64,
    /// Relative residual of the point.
    pub residual: f64,
    /// Number of Newton iterations that the point took.
    pub iterations: usize,
    /// Arc length of the step to the point.
    pub step: f64,
    /// Whether round-off stopped the residual above the tolerance.
    pub stalled: bool,
    /// Whether det [J r; tangentᵀ] is positive: the sense of a branch, which corners keep.
    pub positive: bool,
}

impl Point {
    /// A corrected point with the tangent as it was found.
    #[must_use]
    pub fn new(v: Vec<f64>, corrected: Corrected, step: f64) -> Self {
        Self {
            v,
            tangent: corrected.tangent,
            amplitude: corrected.amplitude,
            slope: corrected.slope,
            residual: corrected.residual,
            iterations: corrected.iterations,
            step,
            stalled: corrected.stalled,
            positive: corrected.positive,
        }
    }

    /// A copy that returns an error if memory is short.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            v: try_copy(&self.v, "a point of the branch")?,
            tangent: try_copy(&self.tangent, "a point of the branch")?,
            ..*self
        })
    }

    /// A copy in the memory of a point that is no longer used.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone_into(&self, mut old: Self) -> Result<Self> {
        for (to, from) in [(&mut old.v, &self.v), (&mut old.tangent, &self.tangent)] {
            to.clear();
            try_extend(to, from, "a point of the branch")?;
        }
        Ok(Self {
            v: old.v,
            tangent: old.tangent,
            ..*self
        })
    }

    /// The parameter p.
    #[must_use]
    pub fn parameter(&self) -> f64 {
        self.v[self.v.len() - 1]
    }

    /// The unknowns u.
    #[must_use]
    pub fn unknowns(&self) -> &[f64] {
        &self.v[..self.v.len() - 1]
    }

    /// The point as the end of a step, with the size of its unknowns and the length of its tangent.
    #[must_use]
    pub fn as_end(&self, size: f64, length: f64) -> End<'_> {
        End {
            unknowns: self.unknowns(),
            tangent: &self.tangent,
            size,
            unit: 1.0 / length,
        }
    }

    /// Whether the parameter decreases from `before` although it increases at both ends, or the other way round: at
    /// least two folds lie between them.
    #[must_use]
    pub fn skips_folds_from(&self, before: &Self) -> bool {
        let (p, from) = (self.parameter(), before.parameter());
        let against = |tangent: &[f64]| (p - from) * tangent[tangent.len() - 1] < 0.0;
        (p - from).abs() > POINT_ROUND_OFF * p.abs().max(from.abs())
            && against(&self.tangent)
            && against(&before.tangent)
    }

    /// Turns the tangent round: the point is then followed in the other sense.
    pub fn reverse(&mut self) {
        for t in &mut self.tangent {
            *t = -*t;
        }
        self.slope = -self.slope;
        self.positive = !self.positive;
    }
}
