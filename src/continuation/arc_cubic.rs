//! Cubic Hermite interpolation of a branch between two points with their tangents.

use crate::continuation::{Metric, Point};
use num_complex::Complex64;

/// Length of a circular arc over a chord, from the cosine of the angle between the directions at its ends. A
/// resonance is nearly a circle, and its chord would cost most of the accuracy.
pub(super) fn arc_length(chord: f64, cosine: f64) -> f64 {
    // Half the angle over its sine.
    let sine = (0.5 * (1.0 - cosine)).clamp(0.0, 1.0).sqrt();
    if sine < 1e-8 { chord } else { chord * sine.asin() / sine }
}

/// Whether the cubic of this change from s = 0 to 1, with these derivatives of equal sign at both ends, turns twice between them.
///
/// Its derivative a (1 − 4s + 3s²) + b (3s² − 2s) + 6 d (s − s²) is lowest at s₀ = (2a + b − 3d) / (3 (a + b − 2d)).
pub(super) fn turns_twice(change: f64, [a, b]: [f64; 2]) -> bool {
    let (a, b, d) = if a < 0.0 { (-a, -b, -change) } else { (a, b, change) };
    let (middle, bend) = (2.0 * a + b - 3.0 * d, 3.0 * (a + b - 2.0 * d));
    a > 0.0 && b > 0.0 && middle > 0.0 && middle < bend && middle * middle > a * bend
}

/// The cubic through `a` (s = 0) and `b` (s = 1) with their tangents.
pub struct Cubic<'p> {
    a: &'p Point,
    b: &'p Point,
    /// Length of the chord in the metric.
    pub chord: f64,
    /// Factors that scale the stored tangents to the length of the arc.
    tangent_scales: (f64, f64),
}

impl<'p> Cubic<'p> {
    /// The cubic through two points, with lengths in the given metric.
    #[must_use]
    pub fn new(a: &'p Point, b: &'p Point, metric: Metric) -> Self {
        let chord = metric.distance(&a.v, &b.v);
        let norms = (metric.norm(&a.tangent), metric.norm(&b.tangent));
        let arc = arc_length(chord, metric.dot(&a.tangent, &b.tangent) / (norms.0 * norms.1));
        Self {
            a,
            b,
            chord,
            tangent_scales: (arc / norms.0, arc / norms.1),
        }
    }

    /// Weights of a, b and of their tangents at s; and the derivatives of these weights by s.
    fn weights(&self, s: f64) -> ([f64; 4], [f64; 4]) {
        let (ra, rb) = self.tangent_scales;
        let (s2, s3) = (s * s, s * s * s);
        (
            [
                2.0 * s3 - 3.0 * s2 + 1.0,
                3.0 * s2 - 2.0 * s3,
                ra * (s3 - 2.0 * s2 + s),
                rb * (s3 - s2),
            ],
            [
                6.0 * (s2 - s),
                6.0 * (s - s2),
                ra * (3.0 * s2 - 4.0 * s + 1.0),
                rb * (3.0 * s2 - 2.0 * s),
            ],
        )
    }

    /// Writes the point at s to `v`.
    pub fn place(&self, s: f64, v: &mut [f64]) {
        let (w, _) = self.weights(s);
        let ends = self.a.v.iter().zip(&self.b.v);
        let tangents = self.a.tangent.iter().zip(&self.b.tangent);
        for ((v, (a, b)), (ta, tb)) in v.iter_mut().zip(ends).zip(tangents) {
            // The sum is centred on b, so that round-off stays relative to the distance.
            *v = b + w[0] * (a - b) + w[2] * ta + w[3] * tb;
        }
    }

    /// The amplitude at s, by its values and derivatives at both points.
    pub fn amplitude(&self, s: f64) -> Complex64 {
        let (w, _) = self.weights(s);
        let (a, b) = (self.a, self.b);
        b.amplitude + (a.amplitude - b.amplitude) * w[0] + a.slope * w[2] + b.slope * w[3]
    }

    /// Writes the point at s to `v`, and its derivative by s.
    pub fn at(&self, s: f64, v: &mut [f64], derivative: &mut [f64]) {
        self.place(s, v);
        let (_, d) = self.weights(s);
        let ends = self.a.v.iter().zip(&self.b.v);
        let tangents = self.a.tangent.iter().zip(&self.b.tangent);
        for ((derivative, (a, b)), (ta, tb)) in derivative.iter_mut().zip(ends).zip(tangents) {
            *derivative = d[0] * (a - b) + d[2] * ta + d[3] * tb;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{arc_length, turns_twice};

    #[test]
    fn the_arc_of_a_circle_is_longer_than_its_chord() {
        assert!((arc_length(2.0 * 0.3_f64.sin(), 0.6_f64.cos()) - 0.6).abs() < 1e-15);
        assert!((arc_length(1.0, 1.0) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_cubic_that_turns_twice_is_told_from_one_that_does_not() {
        let mut turning = 0;
        for k in 0..4000 {
            let [a, b, change] = [0.37, 0.61, 0.83].map(|x| (f64::from(k) * x).sin());
            let slope =
                |s: f64| a * (1.0 - 4.0 * s + 3.0 * s * s) + b * (3.0 * s * s - 2.0 * s) + 6.0 * change * (s - s * s);
            let lowest = (0..=2000).fold(f64::INFINITY, |low, i| {
                low.min(slope(f64::from(i) / 2000.0) * a.signum())
            });
            // The grid may miss a dip that is smaller than this.
            if lowest.abs() > 1e-5 {
                assert_eq!(
                    turns_twice(change, [a, b]),
                    a * b > 0.0 && lowest < 0.0,
                    "{a} {b} {change}"
                );
                turning += usize::from(turns_twice(change, [a, b]));
            }
        }
        assert!(turning > 500, "{turning}");
        assert!(!turns_twice(0.0, [0.0; 2]) && !turns_twice(f64::NAN, [1.0; 2]));
    }
}
