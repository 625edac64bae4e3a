//! Bounds and tolerances of a continuation.

use crate::continuation::step_control::StepControl;

/// Bounds and tolerances of a continuation.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Start of the parameter range.
    pub start: f64,
    /// End of the parameter range.
    pub end: f64,
    /// Relative residual at which a point counts as solved.
    pub tolerance: f64,
    /// Maximum number of Newton iterations.
    pub max_iterations: usize,
    /// Control of the step length.
    pub steps: StepControl,
}
