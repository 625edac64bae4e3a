//! Transfer of points and motions between resolutions: harmonics that both carry are kept, others are zero.

use crate::condense::Condensed;
use crate::continuation::Point;
use crate::error::{Result, try_vec};
use num_complex::Complex64;

/// Unknowns `v` in the harmonics of another condensed model, with the `others` numbers after the motions unchanged;
/// motions are multiplied by a factor.
pub(crate) fn transferred(from: &Condensed, to: &Condensed, v: &[f64], others: usize, factor: f64) -> Result<Vec<f64>> {
    let motions = to.unknowns();
    let mut found = try_vec(motions + others, 0.0, "the harmonics")?;
    let (motion, rest) = v.split_at(v.len() - others);
    to.set().transfer(from.set(), motion, factor, &mut found[..motions]);
    found[motions..].copy_from_slice(rest);
    Ok(found)
}

/// A point in other harmonics; it need not be a solution there. `others` of its unknowns are no motions; the
/// parameter counts among them. `is_length`: the observed amplitude is a length.
pub(crate) fn transferred_point(
    point: &Point,
    from: &Condensed,
    to: &Condensed,
    others: usize,
    is_length: bool,
) -> Result<Point> {
    let factor = from.length() / to.length();
    let of_amplitude: Complex64 = if is_length { factor } else { 1.0 }.into();
    Ok(Point {
        v: transferred(from, to, &point.v, others, factor)?,
        tangent: transferred(from, to, &point.tangent, others, factor)?,
        amplitude: point.amplitude * of_amplitude,
        slope: point.slope * of_amplitude,
        ..*point
    })
}
