//! The responses of a branch.

use crate::condense::Resolution;
use crate::results::stored::branch::Branch;
use crate::results::watched::response_series::ResponseSeries;

/// Relative size of a response that is rounding.
/// Kind: rounding.
const ROUNDING_OF_RESPONSES: f64 = 1e-12;

/// Index of the response with the largest error at a stored point, in the norm of the tolerance.
pub(crate) fn leading_response(branch: &Branch, point: usize) -> Option<usize> {
    let error = |of: &ResponseSeries| -> f64 {
        let unit = if branch.run.together {
            of.values().get(point).map_or(f64::NAN, |x| x.abs())
        } else {
            1.0
        };
        of.errors().get(point).map_or(f64::NAN, |e| e * unit)
    };
    let known = branch
        .responses
        .iter()
        .map(error)
        .enumerate()
        .filter(|(_, e)| !e.is_nan());
    known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(r, _)| r)
}

/// Whether a value of a response, in the units of a resolution, is rounding against its largest one on the curve,
/// so that a peak of this size does not count.
pub(crate) fn is_rounding(branch: &Branch, response: usize, value: f64, resolution: &Resolution) -> bool {
    let values = branch.responses.get(response).map_or(&[][..], |of| of.values());
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(*x));
    value * resolution.condensed.length() <= ROUNDING_OF_RESPONSES * largest
}
