//! The arc-length step, controlled by the error of the predictor.

use std::f64::consts::FRAC_PI_2;

/// Purpose of the points of a branch, which decides their spacing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// A curve for plots.
    Curve,
    /// Special points alone. They are solved for between the points of the branch, which need not be close enough for
    /// a plot.
    SpecialPoints,
}

impl Detail {
    /// Target of the relative prediction error. For a curve it is small enough for two to three Newton iterations and for a
    /// smooth plot.
    fn target(self) -> f64 {
        match self {
            Self::Curve => 0.02,
            Self::SpecialPoints => 0.06,
        }
    }

    /// Relative prediction error above which a prediction is rejected.
    fn largest_error(self) -> f64 {
        match self {
            Self::Curve => 0.16,
            Self::SpecialPoints => 0.24,
        }
    }

    /// Largest step by default, in scaled unknowns.
    fn largest_step(self) -> f64 {
        match self {
            Self::Curve => 0.04,
            Self::SpecialPoints => 0.25,
        }
    }
}

/// Relative residual before its last Newton step of a point that need not be exact: that step leaves about its square.
/// Kind: tuned; measured on: not recorded.
const LOOSE: f64 = 1e-5;

/// Step length and its bounds, in scaled unknowns.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    step: f64,
    min: f64,
    max: f64,
    /// Whether the caller gave the largest step.
    has_bound: bool,
    detail: Detail,
    crosses: bool,
}

/// Angle in radians by which the branch may turn in a step as foreseen. Steps in which it turns by more than π/3 are rejected.
/// Kind: tuned; measured on: not recorded.
const MOST_TURN: f64 = 0.8;

/// Largest growth of a step, and the share of it that the error allows.
/// Kind: tuned; measured on: not recorded.
const STEP_CONTROL_GROWTH: f64 = 2.5;
const STEP_CONTROL_SAFETY: f64 = 0.8;

/// Iterations above which the step is reduced at any error.
/// Kind: tuned; measured on: not recorded.
const MANY_ITERATIONS: usize = 6;

impl StepControl {
    /// Steps from `first` within `min` and `max`; zeros select defaults, which give way where a given one crosses them.
    #[must_use]
    pub fn new(first: f64, min: f64, max: f64) -> Self {
        Self::with_detail(first, min, max, Detail::Curve)
    }

    /// Steps as `new` makes them, for a given purpose.
    #[must_use]
    pub fn with_detail(first: f64, min: f64, max: f64, detail: Detail) -> Self {
        let has_bound = max > 0.0;
        let max = if has_bound { max } else { detail.largest_step().max(min) };
        let min = if min > 0.0 { min } else { (1e-10_f64).min(max) }.min(max);
        Self {
            // A first step that is given is taken as it is, also above the largest one that is chosen here.
            step: if first > 0.0 { first } else { (0.25 * max).max(min) },
            min,
            max,
            has_bound,
            detail,
            crosses: false,
        }
    }

    /// Lets a curve go straight on where another one crosses it.
    #[must_use]
    pub fn crossing_branches(mut self) -> Self {
        self.crosses = true;
        self
    }

    /// Whether the curve goes straight on where another one crosses it.
    #[must_use]
    pub fn crosses_branches(&self) -> bool {
        self.crosses
    }

    /// Relative residual to which the points are solved; `requested` is the value for exact points.
    #[must_use]
    pub fn tolerance(&self, requested: f64) -> f64 {
        match self.detail {
            Detail::Curve => requested,
            Detail::SpecialPoints => requested.max(LOOSE),
        }
    }

    /// Shares of a step, to be tried in this order, by which an inexact point may lie on the wrong side of a special
    /// point.
    #[must_use]
    pub fn margins(&self) -> &'static [f64] {
        match self.detail {
            Detail::Curve => &[0.0],
            Detail::SpecialPoints => &[0.05, 0.2, 0.8],
        }
    }

    /// The step to try, in scaled unknowns.
    #[must_use]
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The smallest step allowed.
    #[must_use]
    pub fn smallest(&self) -> f64 {
        self.min
    }

    /// The largest step allowed.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.max
    }

    /// The largest step that the caller gave; `None` if it gave none.
    #[must_use]
    pub fn bound(&self) -> Option<f64> {
        self.has_bound.then_some(self.max)
    }

    /// Whether the step to try is the largest one that the caller allows.
    #[must_use]
    pub fn is_bounded_by_caller(&self) -> bool {
        self.has_bound && self.step >= self.max
    }

    /// Shortens the step to try, down to the smallest one.
    pub fn at_most(&mut self, step: f64) {
        if step < self.step {
            self.step = step.max(self.min);
        }
    }

    /// Whether a prediction with this relative error can be accepted.
    #[must_use]
    pub fn accepts(&self, error: f64) -> bool {
        error <= self.detail.largest_error() || self.step <= 2.0 * self.min
    }

    /// Chooses the next step after a point was accepted; the error of the predictor grows with the step to the power
    /// `order`.
    pub fn accepted(&mut self, used: f64, error: f64, order: f64, iterations: usize) {
        let margin = self.detail.target() / error.max(1e-12);
        let mut factor = if margin >= (STEP_CONTROL_GROWTH / STEP_CONTROL_SAFETY).powi(order as i32) {
            STEP_CONTROL_GROWTH
        } else {
            (STEP_CONTROL_SAFETY * margin.powf(1.0 / order)).clamp(0.3, STEP_CONTROL_GROWTH)
        };
        if iterations > MANY_ITERATIONS {
            factor = factor.min(0.7);
        }
        self.step = (used * factor).clamp(self.min, self.max);
    }

    /// Shortens the next step so that the branch turns little: over the last step, of this length, it turned by the
    /// angle with this cosine.
    pub fn keep_direction(&mut self, cosine: f64, length: f64) {
        let allowed = MOST_TURN * length / self.step;
        // An angle is at most π/2 times its chord.
        if FRAC_PI_2 * (2.0 * (1.0 - cosine)).sqrt() > allowed {
            self.at_most(MOST_TURN * length / cosine.acos());
        }
    }

    /// Continues with the given step.
    pub fn restart(&mut self, step: f64) {
        self.step = step.clamp(self.min, self.max);
    }

    /// Shortens the step after a prediction that was too poor; `false` at the smallest step.
    pub fn rejected(&mut self, error: f64, order: f64) -> bool {
        let target = self.detail.target();
        let factor = (0.8 * (target / error.max(target)).powf(1.0 / order)).clamp(0.1, 0.6);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bounds_never_cross_whichever_of_them_are_given() {
        let values = [0.0, 1e-12, 1e-10, 0.01, 0.04, 0.1, 0.3, 7.0, f64::MAX];
        for detail in [Detail::Curve, Detail::SpecialPoints] {
            for first in values {
                for min in values {
                    for max in values {
                        let mut control = StepControl::with_detail(first, min, max, detail);
                        assert!(0.0 < control.min && control.min <= control.max);
                        if max > 0.0 {
                            assert_eq!(control.max.to_bits(), max.to_bits());
                        }
                        if min > 0.0 && (max == 0.0 || min <= max) {
                            assert_eq!(control.min.to_bits(), min.to_bits());
                        }
                        if first > 0.0 {
                            assert_eq!(control.step.to_bits(), first.to_bits());
                        }
                        control.accepted(control.step, 1e-3, 4.0, 3);
                        assert!(control.min <= control.step && control.step <= control.max);
                        control.restart(1.0);
                        assert!(control.min <= control.step && control.step <= control.max);
                    }
                }
            }
        }
    }
}
