//! Bounds and tolerances of a continuation.

use crate::continuation::step_control::StepControl;

/// Bounds and tolerances of a continuation.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Begin of the parameter range.
    pub start: f64,
    /// End of the parameter range.
    pub end: f64,
    /// Relative residual wanted.
    pub tolerance: f64,
    /// Cap on Newton iterations.
    pub max_iterations: usize,
    /// Steps.
    pub steps: StepControl,
}
