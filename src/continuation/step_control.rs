//! The arc-length step, controlled by the error of the predictor.

/// Step length and its bounds, in scaled unknowns.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    step: f64,
    min: f64,
    max: f64,
}

/// Target of the relative prediction error: small enough for two to three Newton iterations and for a smooth curve in
/// a plot.
pub const TARGET: f64 = 0.02;

/// Ratio of the prediction error to its target above which a prediction is rejected.
const REJECT: f64 = 8.0;

/// Iterations above which the step is reduced at any error.
const MANY_ITERATIONS: usize = 6;

impl StepControl {
    /// Steps from `first` within `min` and `max`; zeros select defaults.
    #[must_use]
    pub fn new(first: f64, min: f64, max: f64) -> Self {
        let max = if max > 0.0 { max } else { 0.04 };
        let min = if min > 0.0 { min } else { (1e-10_f64).min(max) };
        let first = if first > 0.0 { first } else { 0.25 * max };
        Self {
            step: first.clamp(min, max),
            min,
            max,
        }
    }

    /// The step to try.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The largest step.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.max
    }

    /// Shortens the step to try, down to the smallest one.
    pub fn at_most(&mut self, step: f64) {
        if step < self.step {
            self.step = step.max(self.min);
        }
    }

    /// Whether a predictor error can be accepted.
    #[must_use]
    pub fn accepts(&self, error: f64) -> bool {
        error <= REJECT * TARGET || self.step <= 2.0 * self.min
    }

    /// Chooses the next step after a point was accepted; the error of the predictor grows with the step to the power
    /// `order`.
    pub fn accepted(&mut self, used: f64, error: f64, order: f64, iterations: usize) {
        let mut factor = (0.8 * (TARGET / error.max(1e-12)).powf(1.0 / order)).clamp(0.3, 2.5);
        if iterations > MANY_ITERATIONS {
            factor = factor.min(0.7);
        }
        self.step = (used * factor).clamp(self.min, self.max);
    }

    /// Continues with a step of another length.
    pub fn restart(&mut self, step: f64) {
        self.step = step.clamp(self.min, self.max);
    }

    /// Shortens the step after a prediction that was too poor; `false` at the smallest step.
    pub fn rejected(&mut self, error: f64, order: f64) -> bool {
        let factor = (0.8 * (TARGET / error.max(TARGET)).powf(1.0 / order)).clamp(0.1, 0.6);
        self.shorten(factor)
    }

    /// Shortens the step after a failure; `false` at the smallest step.
    pub fn failed(&mut self) -> bool {
        self.shorten(0.4)
    }

    fn shorten(&mut self, factor: f64) -> bool {
        if self.step <= self.min {
            return false;
        }
        self.step = (self.step * factor).max(self.min);
        true
    }
}
