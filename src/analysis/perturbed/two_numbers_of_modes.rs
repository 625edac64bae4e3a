//! Comparison of the multipliers on two numbers of modes.

use crate::analysis::perturbed::perturbed_motion::FAR;
use crate::results::{Floquet, Multiplier, MultiplierClass};

/// Difference of the radius, as a share of its distance from the unit circle, up to which two numbers of modes agree.
/// Kind: tuned; measured on: not recorded.
const AGREEMENT: f64 = 0.01;

/// The same where the radius is next to 1.
/// Kind: tuned; measured on: not recorded.
const FLOQUET_ON_MODES_LEAST: f64 = 1e-7;

/// Share of the radius above which multipliers of two numbers of modes are compared.
/// Kind: tuned; measured on: not recorded.
const FLOQUET_ON_MODES_LARGE: f64 = 0.5;

/// Whether the multipliers on two numbers of modes agree in the verdict and in the radius.
pub(crate) fn agree(few: &Floquet, many: &Floquet) -> bool {
    if few.grazing.is_some() || many.grazing.is_some() {
        return few.grazing.is_some() == many.grazing.is_some();
    }
    let allowed = FLOQUET_ON_MODES_LEAST.max(AGREEMENT * (1.0 - many.radius).abs());
    few.unstable == many.unstable && (many.radius - few.radius).abs() <= allowed
}

/// Large ordinary multipliers on few modes, each with its distance from the next one on many.
fn distances<'a>(few: &'a Floquet, many: &'a Floquet) -> impl Iterator<Item = (f64, f64)> + 'a {
    let ordinary = |m: &&Multiplier| m.class == MultiplierClass::Ordinary;
    let large = move |m: &&Multiplier| m.value.norm() >= FLOQUET_ON_MODES_LARGE * few.radius;
    few.multipliers.iter().filter(ordinary).filter(large).map(move |a| {
        let all = many.multipliers.iter().filter(ordinary);
        let next = all.map(|b| (a.value - b.value).norm()).fold(f64::INFINITY, f64::min);
        (a.value.norm(), next)
    })
}

/// Largest distance of a large ordinary multiplier on few modes from the nearest one on many; NaN where the motion is
/// far from the point, since two numbers of modes may agree on a motion that has little to do with the point.
pub(crate) fn change(few: &Floquet, many: &Floquet) -> f64 {
    if few.orbit_change.max(many.orbit_change) > FAR {
        return f64::NAN;
    }
    let largest = (many.radius - few.radius).abs();
    distances(few, many).fold(largest, |largest, (_, next)| largest.max(next))
}

/// Estimate of the error of the radius on many modes, as far as their doubling tells; NaN as [`change`].
///
/// A multiplier μ on few modes that has moved by d lies within |μ| + d of zero on all, if what is left moves it by no more than the
/// doubling did. Those far inside the circle may have moved much, and tell nothing of the radius. The error is not below d of the
/// largest one itself.
pub(crate) fn error_of_radius(few: &Floquet, many: &Floquet) -> f64 {
    if few.orbit_change.max(many.orbit_change) > FAR {
        return f64::NAN;
    }
    let change = (many.radius - few.radius).abs();
    distances(few, many).fold(change, |error, (size, next)| {
        let of_largest = if size >= few.radius { next } else { 0.0 };
        error.max(size + next - many.radius).max(of_largest)
    })
}
