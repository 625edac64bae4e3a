//! The response at the ends of a range, beyond which a higher peak may lie.

use crate::results::{Branch, ResponseSeries};

/// The larger value of a response at the first and the last point of its curve, and its angular frequency; NaN without a point.
pub(crate) fn at_ends(branch: &Branch, response: &ResponseSeries) -> (f64, f64) {
    let (omega, values) = (branch.omega(), response.values());
    let mut found = (f64::NAN, f64::NAN);
    for point in [Some(0), omega.len().checked_sub(1)].into_iter().flatten() {
        if let (Some(&value), Some(&omega)) = (values.get(point), omega.get(point))
            && (found.0.is_nan() || value > found.0)
        {
            found = (value, omega);
        }
    }
    found
}
