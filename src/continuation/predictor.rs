//! Prediction of a branch: Hermite extrapolation by arc length through its last points with their tangents.
//!
//! With nodes t_i, where the branch is v_i and has the unit tangent τ_i, and Lagrange's polynomials L_i,
//!
//! > v(t) = Σ_i L_i(t)² ((1 − 2(t − t_i)L_i′(t_i)) v_i + (t − t_i) τ_i).
//!
//! The error grows with the power 2n of the step, where n is the number of points. The length of an arc is that of a circle with the
//! chord and the angle between the tangents at its ends: a resonance is nearly one, and a chord in its place costs most of the
//! accuracy.

use crate::continuation::{Metric, Point};
use num_complex::Complex64;

/// The largest number of points.
pub const MOST_POINTS: usize = 3;

/// Length of the arc of a circle over a chord, from the cosine of the angle between the directions at its ends.
#[must_use]
pub fn arc_length(chord: f64, cosine: f64) -> f64 {
    // Half the angle over its sine.
    let sine = (0.5 * (1.0 - cosine)).clamp(0.0, 1.0).sqrt();
    if sine < 1e-8 { chord } else { chord * sine.asin() / sine }
}

/// The last points of a branch with their places along it, that of the newest one 0.
pub struct Predictor<'p> {
    /// The newest one first.
    points: [&'p Point; MOST_POINTS],
    places: [f64; MOST_POINTS],
    /// Factors that turn the stored tangents into unit ones.
    scales: [f64; MOST_POINTS],
    count: usize,
}

impl<'p> Predictor<'p> {
    /// The point `here` alone: its tangent.
    #[must_use]
    pub fn new(here: &'p Point, metric: Metric) -> Self {
        Self {
            points: [here; MOST_POINTS],
            places: [0.0; MOST_POINTS],
            scales: [1.0 / metric.norm(&here.tangent); MOST_POINTS],
            count: 1,
        }
    }

    /// With the point before those that it has, unless the two coincide.
    #[must_use]
    pub fn after(mut self, before: Option<&'p Point>, metric: Metric) -> Self {
        let Some(before) = before.filter(|_| self.count < MOST_POINTS) else {
            return self;
        };
        let last = self.count - 1;
        let after = self.points[last];
        let chord = metric.distance(&before.v, &after.v);
        if chord > 0.0 {
            let scale = 1.0 / metric.norm(&before.tangent);
            let cosine = metric.dot(&before.tangent, &after.tangent) * scale * self.scales[last];
            self.points[self.count] = before;
            self.places[self.count] = self.places[last] - arc_length(chord, cosine);
            self.scales[self.count] = scale;
            self.count += 1;
        }
        self
    }

    /// Number of points.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Weights of the points and of their stored tangents, from the newest `count` points.
    fn weights(&self, t: f64, count: usize) -> ([f64; MOST_POINTS], [f64; MOST_POINTS]) {
        let (mut values, mut tangents) = ([0.0; MOST_POINTS], [0.0; MOST_POINTS]);
        let places = &self.places[..count];
        for (i, &at) in places.iter().enumerate() {
            let (mut lagrange, mut slope) = (1.0, 0.0);
            for (_, other) in places.iter().enumerate().filter(|(j, _)| *j != i) {
                lagrange *= (t - other) / (at - other);
                slope += 1.0 / (at - other);
            }
            let square = lagrange * lagrange;
            values[i] = square * (1.0 - 2.0 * (t - at) * slope);
            tangents[i] = square * (t - at) * self.scales[i];
        }
        (values, tangents)
    }

    /// The branch at the arc length t beyond the newest point, from the newest `count` points.
    pub fn place(&self, t: f64, count: usize, v: &mut [f64]) {
        let (values, tangents) = self.weights(t, count);
        let here = self.points[0];
        // The sum is centred on the newest point, so that round-off stays relative to the distance.
        for ((v, h), d) in v.iter_mut().zip(&here.v).zip(&here.tangent) {
            *v = h + tangents[0] * d;
        }
        for i in 1..count {
            let point = self.points[i];
            let differences = point.v.iter().zip(&here.v);
            for ((v, (p, h)), d) in v.iter_mut().zip(differences).zip(&point.tangent) {
                *v += values[i] * (p - h) + tangents[i] * d;
            }
        }
    }

    /// The observed amplitude there.
    #[must_use]
    pub fn amplitude(&self, t: f64, count: usize) -> Complex64 {
        let (values, tangents) = self.weights(t, count);
        let here = self.points[0];
        let points = self.points[1..count].iter().zip(&values[1..]).zip(&tangents[1..]);
        points.fold(
            here.amplitude + here.slope * tangents[0],
            |sum, ((point, value), tangent)| sum + (point.amplitude - here.amplitude) * *value + point.slope * *tangent,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point at `angle` of a circle of radius 2, whose stored tangent has the length 3.
    fn on_circle(angle: f64) -> Point {
        let (sine, cosine) = angle.sin_cos();
        Point {
            v: vec![2.0 * cosine, 2.0 * sine],
            tangent: vec![-3.0 * sine, 3.0 * cosine],
            amplitude: Complex64::new(2.0 * cosine, 0.0),
            slope: Complex64::new(-3.0 * sine, 0.0),
            residual: 0.0,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        }
    }

    #[test]
    fn a_circle_is_predicted_with_the_order_of_the_points() {
        let metric = Metric { u: 1.0, p: 1.0 };
        assert!((arc_length(2.0 * 0.3_f64.sin(), 0.6_f64.cos()) - 0.6).abs() < 1e-15);
        assert!((arc_length(1.0, 1.0) - 1.0).abs() < 1e-15);
        let error = |step: f64, count: usize| {
            let points = [on_circle(0.4), on_circle(0.4 - step), on_circle(0.4 - 1.7 * step)];
            let predictor = Predictor::new(&points[0], metric)
                .after(Some(&points[1]), metric)
                .after(Some(&points[2]), metric);
            assert_eq!(predictor.count(), 3);
            let (mut v, truth) = ([0.0; 2], on_circle(0.4 + step));
            predictor.place(2.0 * step, count, &mut v);
            assert!((predictor.amplitude(2.0 * step, count).re - v[0]).abs() < 1e-15);
            (v[0] - truth.v[0]).hypot(v[1] - truth.v[1])
        };
        for count in 1..=MOST_POINTS {
            let order = (error(0.2, count) / error(0.1, count)).log2();
            assert!((order - 2.0 * count as f64).abs() < 0.1, "{order} with {count} points");
        }
    }

    #[test]
    fn coinciding_points_count_once() {
        let metric = Metric { u: 1.0, p: 1.0 };
        let point = on_circle(1.0);
        let predictor = Predictor::new(&point, metric)
            .after(Some(&point), metric)
            .after(None, metric);
        assert_eq!(predictor.count(), 1);
    }
}
