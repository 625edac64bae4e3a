//! The parts of a branch: its run, the numbers of its points, its special points.

use crate::condense::Reduction;
use crate::error::{Error, Status};
use crate::results::stored::special::Special;
use crate::results::verdicts::verdict::Located;
use num_complex::Complex64;

/// How a branch was computed, and how it ended.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) reduction: Reduction,
    /// Highest harmonic that points may carry; 0 where their number is automatic.
    pub(crate) harmonics: usize,
    /// Estimates of errors that were made.
    pub(crate) estimates: usize,
    pub(crate) response_dof: usize,
    pub(crate) status: Status,
    /// The error that ended the branch, where the status does not tell all.
    pub(crate) reason: Option<Error>,
    /// Whether all responses that were asked for count as one.
    pub(crate) together: bool,
    pub(crate) tells_stability: bool,
}

/// Numbers of each stored point, one entry a point but for those of contacts, motions and responses.
#[derive(Debug, Default)]
pub(crate) struct PointTable {
    pub(crate) places: Vec<Place>,
    pub(crate) omega: Vec<f64>,
    pub(crate) amplitude: Vec<f64>,
    pub(crate) residual: Vec<f64>,
    pub(crate) iterations: Vec<f64>,
    pub(crate) harmonics_used: Vec<f64>,
    /// Points × contacts.
    pub(crate) slip_fraction: Vec<f64>,
    /// Condensed motions, see [`Place`].
    pub(crate) motion: Vec<f64>,
    /// Harmonics of the response, see [`Place`].
    pub(crate) response: Vec<Complex64>,
}

/// Place of a stored point: the number of its resolution, and the offsets of its motion and of its response.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) resolution: usize,
    pub(crate) motion: usize,
    pub(crate) response: usize,
}

/// Estimated errors of each stored point; NaN where unknown.
#[derive(Debug, Default)]
pub(crate) struct PointErrors {
    /// Relative change of contact forces with the number of samples.
    pub(crate) sampling: Vec<f64>,
    /// Relative error of the result by the harmonics that are left out.
    pub(crate) truncation: Vec<f64>,
    /// That of the damping ratio of a nonlinear mode.
    pub(crate) damping: Vec<f64>,
}

/// Stability of each stored point.
#[derive(Debug, Default)]
pub(crate) struct PointStability {
    /// Largest modulus of a Floquet multiplier.
    pub(crate) floquet_radius: Vec<f64>,
    pub(crate) unstable_directions: Vec<f64>,
}

/// Special points of a branch, and its solutions at requested values of the parameter.
#[derive(Debug, Default)]
pub(crate) struct SpecialLists {
    pub(crate) peaks: Vec<Special>,
    pub(crate) folds: Vec<Special>,
    /// Limit cycles, each with the slope of the damping ratio.
    pub(crate) limit_cycles: Vec<(Special, f64)>,
    /// Folds included.
    pub(crate) bifurcations: Vec<Located>,
    /// Solutions at each requested value.
    pub(crate) at: Vec<Vec<Special>>,
}
