//! Differences of exact first derivatives along a line: a second derivative to the fourth order.
//!
//! > f′(0) = 4/3 · (f(h) − f(−h))/2h − 1/3 · (f(2h) − f(−2h))/4h + O(h⁴): the errors of both differences are even in h.

/// Step h over the length by which the function changes, that of a motion, or the width of a peak.
/// Kind: tuned; measured on: not recorded.
const DIFFERENCE_STEP: f64 = 1e-4;

/// Places along the line, for a function that changes over `length`, and the weights of its values there.
pub(crate) fn central_differences(length: f64) -> [(f64, f64); 4] {
    let h = DIFFERENCE_STEP * length;
    let (near, far) = (4.0 / 3.0 / (2.0 * h), -1.0 / 3.0 / (4.0 * h));
    [(h, near), (-h, -near), (2.0 * h, far), (-2.0 * h, -far)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_the_fourth_degree_is_differentiated_to_rounding() {
        let f = |x: f64| 2.0 - 3.0 * x + 5.0 * x.powi(2) - 7.0 * x.powi(3) + 11.0 * x.powi(4);
        let slope: f64 = central_differences(1e3).iter().map(|(x, weight)| weight * f(*x)).sum();
        assert!((slope + 3.0).abs() < 1e-13, "{slope}");
        let fifth: f64 = central_differences(1e3)
            .iter()
            .map(|(x, weight)| weight * x.powi(5))
            .sum();
        assert!(fifth.abs() > 1e-5, "the fifth power shows the order: {fifth}");
    }
}
