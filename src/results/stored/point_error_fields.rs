//! Estimated errors of the points of a branch.

use crate::results::Branch;

impl Branch {
    pub(crate) fn set_estimates(&mut self, estimates: usize) {
        self.run.estimates = estimates;
    }

    /// Number of error estimates that chose the harmonics of all points, those with stuck contacts not counted; 0
    /// if no tolerance chose.
    #[must_use]
    pub fn estimates(&self) -> usize {
        self.run.estimates
    }

    /// Aliasing check of laws that are sampled, at each point: the relative change of their forces with half the
    /// samples (twice as many, if half are too few). 0 where all laws are exact, NaN if a law failed in the check.
    /// It estimates the size of the error by sampling and is no bound of it.
    #[must_use]
    pub fn sampling_error(&self) -> &[f64] {
        &self.errors.sampling[..self.curve]
    }

    /// Estimated relative error of the response amplitude (in a nonlinear mode: of the frequency) by the harmonics
    /// left out, at each point. NaN where it is unknown, and everywhere unless a tolerance chooses the harmonics or
    /// [`SolverOptions::estimate_error`](crate::options::SolverOptions::estimate_error) requests it.
    #[must_use]
    pub fn error_estimate(&self) -> &[f64] {
        &self.errors.truncation[..self.curve]
    }

    /// Estimated relative error, as `error_estimate` has it, of one stored point, the special ones included; NaN at a
    /// fold, at whose frequency the solution is not isolated.
    #[must_use]
    pub fn error_estimate_at(&self, point: usize) -> Option<f64> {
        self.errors.truncation.get(point).copied()
    }

    /// Estimated relative error of the damping ratio of a nonlinear mode at each point; see
    /// [`Self::error_estimate`].
    #[must_use]
    pub fn damping_error_estimate(&self) -> &[f64] {
        &self.errors.damping[..self.curve]
    }

    /// Estimated relative error of the damping ratio at one stored point, the special ones included.
    #[must_use]
    pub fn damping_error_estimate_at(&self, point: usize) -> Option<f64> {
        self.errors.damping.get(point).copied()
    }
}
