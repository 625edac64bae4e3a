//! Spacing of the error estimates along a branch that keeps its harmonics.
//!
//! Between two estimates the error follows the share of the highest carried harmonics in the motion,
//!
//! > η ≈ η₀ (t/t₀)^q · max(1, s/s₀),  t = ‖Y_{>H/2}‖/‖Y‖,  s = |dX/dp|/|X|,
//!
//! with η₀, t₀ and s₀ at the point estimated last: towards a fold, where the response X is steep against the parameter p,
//! the error at a fixed parameter grows without bound. The exponent q is 1 at first, and then that of the last two estimates
//! with different shares: about 1 where harmonics decay algebraically, and more where they decay exponentially, since the
//! error then follows harmonics far above the carried ones. Each estimate checks this rule. While it holds within a factor of
//! two, the spacing doubles; where it does not, the next point is estimated again. A point whose error is not far below
//! the tolerance, or whose share changes much, is estimated in any case.

use crate::continuation::Point;
use crate::fourier::HarmonicSet;
use crate::linalg::norm;

/// Largest ratio of an error to its prediction, either way, for which the spacing grows.
/// Kind: tuned; measured on: not recorded.
const HOLDS: f64 = 2.0;

/// Largest spacing, where errors are known and where they are not. With the fewest harmonics of a curve nothing is missed
/// where an error is found to be low later.
/// Kind: tuned; measured on: not recorded.
const ESTIMATE_SPACING_MOST: usize = 4;
const MOST_WITH_FEWEST: usize = 8;
const MOST_UNKNOWN: usize = 32;

/// Factor between a predicted error and the largest for which no estimate is made, at the first point after an estimate and
/// farther on: one and a half times, and three times the factor of two within which the rule held.
/// Kind: tuned; measured on: not recorded.
const ESTIMATE_SPACING_SAFETY: (f64, f64) = (3.0, 6.0);

/// Share of the largest error below which a prediction may be too large: estimates of so small errors differ by what they leave
/// unfinished.
/// Kind: tuned; measured on: not recorded.
const ESTIMATE_SPACING_HARMLESS: f64 = 0.05;

/// Ratio of the shares of two points beyond which nothing is predicted.
/// Kind: tuned; measured on: not recorded.
const ESTIMATE_SPACING_ALIKE: f64 = 5.0;

/// Ratio of two shares from which on the exponent follows from them, and its range.
/// Kind: tuned; measured on: not recorded.
const DIFFERENT: f64 = 1.05;
const EXPONENTS: (f64, f64) = (0.5, 8.0);

/// Share of the step before, below which a step shows that the branch was hard to predict.
/// Kind: tuned; measured on: not recorded.
const SHORTENED: f64 = 0.5;

/// Share of the harmonics above half of the carried ones in packed motions; 0 where none is below.
pub(crate) fn share_of_highest(set: &HarmonicSet, motion: &[f64]) -> f64 {
    let numbers = set.numbers();
    let highest = numbers.last().copied().unwrap_or(0);
    let first = numbers.partition_point(|&h| 2 * h <= highest);
    if !numbers[..first].iter().any(|&h| h > 0) || first == numbers.len() {
        return 0.0;
    }
    let from = set.offset(first);
    let signals = motion.chunks_exact(set.packed_len());
    let above = signals.map(|y| norm(&y[from..])).fold(0.0, f64::hypot);
    above / norm(motion)
}

/// Data of a point that show how the error changes from one point to another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trend {
    /// Share of the highest harmonics, see [`share_of_highest`].
    pub share: f64,
    /// Steepness |dX/dp|/|X| of the observed response X over the parameter p.
    pub steepness: f64,
}

impl Trend {
    /// Trend of a point with a given share of the highest harmonics.
    pub fn of(point: &Point, share: f64) -> Self {
        let along = point.tangent.last().copied().unwrap_or(0.0).abs() * point.amplitude.norm();
        let steepness = if along > 0.0 {
            point.slope.norm() / along
        } else {
            f64::INFINITY
        };
        Self { share, steepness }
    }

    /// Factor by which the error grows with the steepness, from `other` to this point.
    fn steeper_than(self, other: Self) -> f64 {
        if self.steepness > other.steepness {
            self.steepness / other.steepness
        } else {
            1.0
        }
    }
}

/// The last estimate, by which errors are predicted.
#[derive(Clone, Copy, Debug)]
struct Known {
    error: f64,
    trend: Trend,
    level: usize,
    /// Exponent q of the share of the highest harmonics.
    exponent: f64,
}

impl Known {
    /// Predicted error of a point with another trend, over the error of this estimate.
    fn factor_to(&self, trend: Trend) -> f64 {
        (trend.share / self.trend.share).powf(self.exponent) * trend.steeper_than(self.trend)
    }

    /// Exponent q that fits the errors of this estimate and of a point with another trend; unchanged where the shares
    /// are alike.
    fn exponent_to(&self, trend: Trend, error: f64) -> f64 {
        let shares = trend.share / self.trend.share;
        let grown = error / (self.error * trend.steeper_than(self.trend));
        let exponent = grown.ln() / shares.ln();
        if !(1.0 / DIFFERENT..=DIFFERENT).contains(&shares) && exponent.is_finite() {
            exponent.clamp(EXPONENTS.0, EXPONENTS.1)
        } else {
            self.exponent
        }
    }
}

/// Decides which points get an estimate, by the trend since the last one.
#[derive(Debug, Default)]
pub(crate) struct EstimateSpacing {
    known: Option<Known>,
    spacing: usize,
    /// Number of points since the last estimate.
    since: usize,
    /// Length of the step to the point before.
    step: f64,
}

impl EstimateSpacing {
    /// Predicted error of a point with this trend over the error estimated last; `None` where the point needs an
    /// estimate. Errors up to `largest` need none.
    pub fn factor(&mut self, level: usize, trend: Trend, largest: f64) -> Option<f64> {
        let known = self.known.filter(|known| known.level == level)?;
        if self.since + 1 >= self.spacing {
            return None;
        }
        let factor = if known.error.is_nan() {
            1.0
        } else {
            known.factor_to(trend)
        };
        let changed = trend.share / known.trend.share * trend.steeper_than(known.trend);
        let alike = known.error.is_nan() || (1.0 / ESTIMATE_SPACING_ALIKE..=ESTIMATE_SPACING_ALIKE).contains(&changed);
        let safety = if self.since == 0 {
            ESTIMATE_SPACING_SAFETY.0
        } else {
            ESTIMATE_SPACING_SAFETY.1
        };
        // An error that seems to fall is not relied on.
        if !alike || safety * factor.max(1.0) * known.error > largest {
            return None;
        }
        self.since += 1;
        Some(factor)
    }

    /// Notes an estimate: its error, NaN where it is unknown, and whether the curve may have fewer harmonics. Errors up to
    /// `allowed` meet the tolerance.
    pub fn note(&mut self, level: usize, trend: Trend, (error, allowed): (f64, f64), may_fall: bool) {
        let largest = if may_fall {
            ESTIMATE_SPACING_MOST
        } else {
            MOST_WITH_FEWEST
        };
        let before = self.known.filter(|known| known.level == level);
        let (holds, most) = match before {
            None => (false, largest),
            Some(known) if error.is_nan() || known.error.is_nan() => {
                (error.is_nan() && known.error.is_nan(), MOST_UNKNOWN)
            }
            Some(known) => {
                let predicted = known.error * known.factor_to(trend);
                let ratio = error / predicted;
                let is_harmless = predicted <= ESTIMATE_SPACING_HARMLESS * allowed;
                (ratio <= HOLDS && (ratio >= HOLDS.recip() || is_harmless), largest)
            }
        };
        self.spacing = if holds { (2 * self.spacing).min(most) } else { 1 };
        if error.is_nan() {
            self.spacing = self.spacing.max(2);
        }
        self.since = 0;
        let is_known = error.is_nan() || (error > 0.0 && trend.share > 0.0);
        self.known = is_known.then_some(Known {
            error,
            trend,
            level,
            exponent: before.map_or(1.0, |known| known.exponent_to(trend, error)),
        });
    }

    /// Notes the length of the step to a point. Where the branch was hard to predict, as where another harmonic
    /// begins to resonate, the error is hard to predict too: the point gets an estimate.
    pub fn note_step(&mut self, step: f64) {
        let before = core::mem::replace(&mut self.step, step);
        if step > 0.0 && step < SHORTENED * before {
            self.forget();
        }
    }

    /// Forgets the last estimate: the next point gets one.
    pub fn forget(&mut self) {
        self.known = None;
    }
}

#[cfg(test)]
mod tests {
    use super::{EstimateSpacing, Trend};

    const fn trend(share: f64, steepness: f64) -> Trend {
        Trend { share, steepness }
    }

    /// Estimated points among `count` ones whose error follows `error`.
    fn estimated(count: usize, error: impl Fn(usize) -> f64) -> Vec<usize> {
        let mut spacing = EstimateSpacing::default();
        let mut made = Vec::new();
        for i in 0..count {
            if spacing.factor(3, trend(1e-3, 1.0), 1e-3).is_none() {
                made.push(i);
                spacing.note(3, trend(1e-3, 1.0), (error(i), 1e-3), true);
            }
        }
        made
    }

    #[test]
    fn estimates_become_rare_while_they_are_predicted() {
        assert_eq!(estimated(20, |_| 5e-5), [0, 1, 3, 7, 11, 15, 19]);
    }

    #[test]
    fn a_prediction_that_failed_is_checked_at_the_next_point() {
        let made = estimated(20, |i| if i < 5 { 4e-5 } else { 1e-4 });
        assert_eq!(made, [0, 1, 3, 7, 8, 10, 14, 18]);
    }

    #[test]
    fn points_near_the_tolerance_are_estimated_each() {
        assert_eq!(estimated(5, |_| 4e-4), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn errors_far_below_the_tolerance_need_not_be_predicted() {
        let falls = |from: f64| estimated(20, move |i| from * 0.3_f64.powi(i as i32));
        assert_eq!(falls(4e-5), [0, 1, 3, 7, 11, 15, 19]);
        assert_eq!(falls(4e-4)[..3], [0, 1, 2]);
        // A rise is told by the next estimate.
        assert!(estimated(20, |i| if i % 4 == 3 { 4e-5 } else { 5e-6 }).len() > 7);
    }

    #[test]
    fn a_power_of_the_share_is_learnt() {
        // The share doubles over five points and falls again, the error follows its fourth power.
        let shares = (0..40_i32).map(|i| 1e-3 * 2.0_f64.powf(f64::from((i % 10 - 5).abs()) / 5.0));
        let mut spacing = EstimateSpacing::default();
        let mut made = 0;
        for share in shares {
            let error = 1e-6 * (share / 1e-3).powi(4);
            if let Some(factor) = spacing.factor(3, trend(share, 1.0), 1e-3) {
                let known = spacing.known.unwrap().error;
                assert!((known * factor / error - 1.0).abs() < 1e-9, "{share}");
            } else {
                made += 1;
                spacing.note(3, trend(share, 1.0), (error, 1e-3), true);
            }
        }
        assert!(made < 16, "{made}");
    }

    #[test]
    fn an_unknown_error_is_not_asked_for_at_each_point() {
        assert!(estimated(100, |_| f64::NAN).len() < 10);
    }

    #[test]
    fn other_harmonics_are_estimated_anew() {
        let mut spacing = EstimateSpacing::default();
        for _ in 0..3 {
            spacing.note(3, trend(1e-3, 1.0), (5e-5, 1e-3), true);
        }
        assert!(spacing.factor(4, trend(1e-3, 1.0), 1e-3).is_none());
        assert!(spacing.factor(3, trend(1e-2, 1.0), 1e-3).is_none());
        assert!(spacing.factor(3, trend(1e-3, 10.0), 1e-3).is_none());
        assert!(spacing.factor(3, trend(1e-3, 1.0), 1e-3).is_some());
    }
}
