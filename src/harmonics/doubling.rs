//! The response of a point as its harmonics are doubled: how much of the change is still missing.
//!
//! With X₀ the response of the point, Xₖ that of the k-th extension and dₖ = |Xₖ − Xₖ₋₁| the next change is about
//! dₖ q, q = dₖ/dₖ₋₁, and the whole one about |Xₖ − X₀| + dₖ q. The largest relative change of several responses counts, or that
//! of their norm.

use crate::error::{Result, try_copy};
use crate::harmonics::estimate::{CONTEXT, ESTIMATE_MARGIN, Estimate, norm_of_responses, relative};
use num_complex::Complex64;

/// The next change, relative to the whole, at which the response has settled, and at which it will do where no further
/// extension is possible.
/// Kind: tuned; measured on: not recorded.
const DOUBLING_SETTLED: f64 = 0.2;
const SUFFICIENT: f64 = 0.6;

/// Largest change, relative to the tolerance, that is harmless after one extension.
/// Kind: tuned; measured on: not recorded.
const DOUBLING_HARMLESS: f64 = 0.05;

/// Least and largest change that may be missing behind the last one, over that.
/// Kind: tuned; measured on: not recorded.
const MISSING: (f64, f64) = (0.5, 2.0);

/// Responses of a point and of its extensions to more harmonics.
#[derive(Clone, Debug)]
pub(super) struct Doubling {
    point: Vec<Complex64>,
    /// Whether one norm of all responses is compared, not each response.
    together: bool,
    last: Vec<Complex64>,
    /// First change, and the last two changes.
    first: f64,
    changes: [f64; 2],
    extensions: usize,
}

impl Doubling {
    /// Starts with the responses of the point.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(point: &[Complex64], together: bool) -> Result<Self> {
        Ok(Self {
            point: try_copy(point, CONTEXT)?,
            together,
            last: try_copy(point, CONTEXT)?,
            first: 0.0,
            changes: [0.0; 2],
            extensions: 0,
        })
    }

    /// Adds the responses of the next extension, and the change that it made.
    pub fn add(&mut self, responses: &[Complex64]) {
        let change = self.difference(responses, &self.last);
        if self.extensions == 0 {
            self.first = change;
        }
        self.changes = [self.changes[1], change];
        self.last.copy_from_slice(responses);
        self.extensions += 1;
    }

    /// Difference of two sets of responses, relative to the second; 0 where nothing differs.
    fn difference(&self, responses: &[Complex64], others: &[Complex64]) -> f64 {
        let differences = responses.iter().zip(others).map(|(a, b)| (a - b).norm());
        if self.together {
            return relative(differences.fold(0.0, f64::hypot), norm_of_responses(responses).into());
        }
        let each = differences.zip(responses).map(|(d, size)| relative(d, *size));
        each.fold(0.0, f64::max)
    }

    /// Number of extensions added.
    pub fn extensions(&self) -> usize {
        self.extensions
    }

    /// Size of the change over all extensions so far, relative to the response.
    pub fn whole(&self) -> f64 {
        self.difference(&self.last, &self.point)
    }

    /// Predicted next change, relative to the whole one; infinite where it is not known.
    pub fn next(&self) -> f64 {
        let [before, last] = self.changes;
        if self.extensions < 2 || before == 0.0 {
            return f64::INFINITY;
        }
        let whole = self.whole();
        if last == 0.0 {
            0.0
        } else {
            last * (last / before) / whole
        }
    }

    /// Whether the response has settled.
    pub fn has_settled(&self) -> bool {
        self.next() <= DOUBLING_SETTLED
    }

    /// Whether the whole change is known well enough if no further extension is possible.
    pub fn suffices(&self) -> bool {
        self.next() <= SUFFICIENT
    }

    /// Predicted sum of all further changes, d q/(1 − q), each being q times the one before, with the q found last.
    pub fn missing(&self) -> f64 {
        let [before, last] = self.changes;
        let q = last / before;
        let share = if q < 1.0 { q / (1.0 - q) } else { f64::INFINITY };
        last * share.clamp(MISSING.0, MISSING.1)
    }

    /// Whether the whole change and all that may be missing meet a tolerance. One extension alone shows less than
    /// two.
    pub fn is_harmless(&self, tolerance: f64) -> bool {
        let whole = self.whole();
        match self.extensions {
            0 => false,
            1 => whole <= DOUBLING_HARMLESS * tolerance,
            _ => ESTIMATE_MARGIN * (whole + self.missing()) <= tolerance,
        }
    }

    /// Whether the whole change is known well enough and misses a tolerance: a further extension would not change what follows.
    pub fn misses(&self, tolerance: f64) -> bool {
        let whole = self.whole() * (1.0 + self.next());
        tolerance > 0.0 && self.suffices() && ESTIMATE_MARGIN * whole > tolerance
    }

    /// The estimate of the last extension, with the change that may be missing.
    pub fn bounded(&self, mut estimate: Estimate) -> Estimate {
        if self.extensions > 1 {
            estimate.scale_response(estimate.response + self.missing());
        }
        estimate
    }

    /// Ratio of the whole change to the first.
    pub fn ratio(&self) -> f64 {
        self.whole() * (1.0 + self.next()) / self.first
    }

    /// Ratio of the whole change, with that which may be missing, to the first; `None` where one extension shows no
    /// change after the first.
    pub fn bounded_ratio(&self) -> Option<f64> {
        let whole = self.whole();
        (self.extensions > 1 && self.first > 0.0).then(|| (whole + self.missing()) / self.first)
    }

    /// The estimate of the last extension, with the predicted missing change added.
    pub fn completed(&self, mut estimate: Estimate) -> Estimate {
        estimate.scale_response(estimate.response * (1.0 + self.next()));
        estimate
    }

    /// Error of the response after the first extension, by a ratio of changes found before.
    pub fn scaled(&self, ratio: f64) -> f64 {
        ratio * self.first
    }
}

#[cfg(test)]
mod tests {
    use super::Doubling;
    use num_complex::Complex64;

    /// Responses whose error falls by a factor q with each doubling.
    fn series(q: f64, extensions: usize) -> Doubling {
        let at = |k: i32| Complex64::new(1.0 + 1e-3 * q.powi(k), -2.0);
        let mut series = Doubling::new(&[at(0)], false).unwrap();
        for k in 1..=extensions {
            series.add(&[at(k as i32)]);
        }
        series
    }

    #[test]
    fn two_extensions_of_a_fast_series_settle() {
        for q in [0.05, 0.15, 0.3] {
            assert!(!series(q, 1).has_settled());
            let two = series(q, 2);
            assert!(two.has_settled(), "{q}");
            // The whole change is the error 1e-3 itself, the first one (1 − q) of it.
            let error = two.ratio() * 1e-3 * (1.0 - q);
            assert!((error / 1e-3 - 1.0).abs() < 0.1, "{q}: {error}");
        }
    }

    #[test]
    fn a_bounded_ratio_is_no_less_than_the_whole_change() {
        assert!(series(0.3, 1).bounded_ratio().is_none());
        for q in [0.05, 0.3, 0.45] {
            let ratio = series(q, 2).bounded_ratio().unwrap();
            let whole = 1.0 / (1.0 - q);
            assert!(ratio >= whole && ratio < 1.5 * whole, "{q}: {ratio}");
        }
    }

    #[test]
    fn a_change_that_is_known_well_enough_misses_a_tolerance_or_meets_it() {
        // The error is 1e-3 of √5, and 3/2 of it counts.
        let two = series(0.3, 2);
        let error = 1e-3 / 5.0_f64.sqrt();
        assert!(two.misses(1.2 * error) && !two.is_harmless(1.2 * error));
        assert!(!two.misses(2.0 * error) && two.is_harmless(2.0 * error));
        // Without a tolerance, and where too much is missing, nothing is missed.
        assert!(!two.misses(0.0) && !series(1.4, 2).misses(1e-9));
    }

    #[test]
    fn a_slow_series_takes_more() {
        assert!(!series(0.8, 2).has_settled());
        assert!(!series(1.0, 2).suffices());
        assert!(series(0.5, 3).has_settled());
    }
}
