//! Prediction of a branch: Hermite extrapolation through its last points with their tangents.
//!
//! With nodes t_i, where the branch is v_i and has the derivative τ_i by the parameter t, and Lagrange's polynomials L_i,
//!
//! > v(t) = Σ_i L_i(t)² ((1 − 2(t − t_i)L_i′(t_i)) v_i + (t − t_i) τ_i).
//!
//! The error grows with the power 2n of the step, where n is the number of points, as far as the derivatives are those by the
//! parameter: the arc on the circle of curvature, see `continuation::curvature_circle`.

use crate::continuation::arc_cubic::arc_length;
use crate::continuation::curvature_circle::Place;
use crate::continuation::{Metric, Point};
use num_complex::Complex64;

/// The largest number of points.
pub const MOST_POINTS: usize = 5;

/// The last points of a branch with their places along it, that of the newest one 0.
pub struct Predictor<'p> {
    /// The newest one first.
    points: [&'p Point; MOST_POINTS],
    places: [f64; MOST_POINTS],
    /// 1/(t_i − t_j)
    inverses: [[f64; MOST_POINTS]; MOST_POINTS],
    /// Factors that turn the stored tangents into derivatives by the parameter.
    scales: [f64; MOST_POINTS],
    /// Derivative of the parameter by the length at the newest point.
    per_length: f64,
    count: usize,
}

/// Weights of the points and of their stored tangents.
pub struct Weights {
    values: [f64; MOST_POINTS],
    tangents: [f64; MOST_POINTS],
    count: usize,
}

impl<'p> Predictor<'p> {
    /// The point `here` and those before it, the newest one first, with their places by a circle of curvature, up to one that
    /// coincides with its neighbour or lies in another direction.
    #[must_use]
    pub fn by_circle(here: &'p Point, before: &'p [Point], places: &[Option<Place>], metric: Metric) -> Self {
        let [Some((newest, scale)), others @ ..] = places else {
            return Self::alone(here, 1.0 / metric.norm(&here.tangent));
        };
        let mut predictor = Self::alone(here, *scale);
        predictor.per_length = 1.0 / (scale * metric.norm(&here.tangent));
        for (point, place) in before.iter().zip(others) {
            let Some((place, scale)) = *place else { break };
            if !predictor.add(point, place - newest, scale) {
                break;
            }
        }
        predictor
    }

    /// The same with places by arc length, each arc taken for that of a circle: enough for a few points, and quick.
    #[must_use]
    pub fn by_arcs(here: &'p Point, before: &'p [Point], metric: Metric) -> Self {
        let mut predictor = Self::alone(here, 1.0 / metric.norm(&here.tangent));
        for point in before.iter().take(MOST_POINTS - 1) {
            let last = predictor.count - 1;
            let after = predictor.points[last];
            let scale = 1.0 / metric.norm(&point.tangent);
            let cosine = metric.dot(&point.tangent, &after.tangent) * scale * predictor.scales[last];
            let arc = arc_length(metric.distance(&point.v, &after.v), cosine);
            if !predictor.add(point, predictor.places[last] - arc, scale) {
                break;
            }
        }
        predictor
    }

    /// The point `here` alone, whose tangent becomes the derivative by this factor.
    fn alone(here: &'p Point, scale: f64) -> Self {
        Self {
            points: [here; MOST_POINTS],
            places: [0.0; MOST_POINTS],
            inverses: [[0.0; MOST_POINTS]; MOST_POINTS],
            scales: [scale; MOST_POINTS],
            per_length: 1.0,
            count: 1,
        }
    }

    /// Adds the point before those that it has; `false` where it does not lie before them.
    fn add(&mut self, point: &'p Point, place: f64, scale: f64) -> bool {
        let count = self.count;
        if place.is_nan() || place >= self.places[count - 1] {
            return false;
        }
        for i in 0..count {
            let inverse = 1.0 / (self.places[i] - place);
            self.inverses[i][count] = inverse;
            self.inverses[count][i] = -inverse;
        }
        (self.points[count], self.places[count], self.scales[count]) = (point, place, scale);
        self.count += 1;
        true
    }

    /// Number of points.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// The weights a step beyond the newest point, from the newest `count` points.
    #[must_use]
    pub fn weights(&self, step: f64, count: usize) -> Weights {
        let t = step * self.per_length;
        let (mut values, mut tangents) = ([0.0; MOST_POINTS], [0.0; MOST_POINTS]);
        for i in 0..count {
            let (mut lagrange, mut slope) = (1.0, 0.0);
            // The inverse that belongs to the point itself is 0.
            for (j, (inverse, other)) in self.inverses[i].iter().zip(&self.places).enumerate().take(count) {
                slope += inverse;
                if j != i {
                    lagrange *= (t - other) * inverse;
                }
            }
            let (square, distance) = (lagrange * lagrange, t - self.places[i]);
            values[i] = square * (1.0 - 2.0 * distance * slope);
            tangents[i] = square * distance * self.scales[i];
        }
        Weights {
            values,
            tangents,
            count,
        }
    }

    /// The branch there.
    pub fn place(&self, weights: &Weights, v: &mut [f64]) {
        let here = self.points[0];
        // The sum is centred on the newest point, so that round-off stays relative to the distance.
        for ((v, h), d) in v.iter_mut().zip(&here.v).zip(&here.tangent) {
            *v = h + weights.tangents[0] * d;
        }
        for i in 1..weights.count {
            let (point, value, tangent) = (self.points[i], weights.values[i], weights.tangents[i]);
            let differences = point.v.iter().zip(&here.v);
            for ((v, (p, h)), d) in v.iter_mut().zip(differences).zip(&point.tangent) {
                *v += value * (p - h) + tangent * d;
            }
        }
    }

    /// The observed amplitude there.
    #[must_use]
    pub fn amplitude(&self, weights: &Weights) -> Complex64 {
        let here = self.points[0];
        let mut sum = here.amplitude + here.slope * weights.tangents[0];
        for i in 1..weights.count {
            let point = self.points[i];
            sum += (point.amplitude - here.amplitude) * weights.values[i] + point.slope * weights.tangents[i];
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::continuation::curvature_circle::CurvatureCircle;

    /// A point of a curve, whose stored tangent has the length of the derivative.
    fn point(v: [f64; 3], tangent: [f64; 3]) -> Point {
        Point {
            v: v.to_vec(),
            tangent: tangent.to_vec(),
            amplitude: Complex64::new(v[0], 0.0),
            slope: Complex64::new(tangent[0], 0.0),
            residual: 0.0,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        }
    }

    /// The prediction by the circle of the newest points.
    fn by_circle<'p>(here: &'p Point, before: &'p [Point], metric: Metric) -> Predictor<'p> {
        let own = (here, before.first());
        let circle = CurvatureCircle::new(own.0, own.1, metric);
        let points = core::iter::once(here).chain(before);
        let places: Vec<_> = points.map(|point| circle.place(own, point)).collect();
        Predictor::by_circle(here, before, &places, metric)
    }

    fn on_circle(angle: f64) -> Point {
        let (sine, cosine) = angle.sin_cos();
        point([2.0 * cosine, 2.0 * sine, 0.0], [-3.0 * sine, 3.0 * cosine, 0.0])
    }

    /// A curve in space whose curvature varies.
    fn on_curve(t: f64) -> Point {
        point(
            [t.sin(), 0.7 * t, 0.3 * (2.0 * t).cos()],
            [t.cos(), 0.7, -0.6 * (2.0 * t).sin()],
        )
    }

    /// Distance of the curve from its prediction a step beyond 0.4, from points at uneven distances.
    fn error(curve: fn(f64) -> Point, step: f64, count: usize) -> f64 {
        let metric = Metric { u: 1.0, p: 1.0 };
        let here = curve(0.4);
        let before = [1.0, 2.2, 3.1, 4.0].map(|steps| curve(0.4 - steps * step));
        let predictor = by_circle(&here, &before, metric);
        assert_eq!(predictor.count(), MOST_POINTS);
        let mut v = [0.0; 3];
        let weights = predictor.weights(step, count);
        predictor.place(&weights, &mut v);
        assert!((predictor.amplitude(&weights).re - v[0]).abs() < 1e-14);
        // The nearest point of the curve, by Newton's method.
        let mut t = 0.4;
        for _ in 0..50 {
            let at = curve(t);
            let (mut along, mut square) = (0.0, 0.0);
            for ((x, at), tangent) in v.iter().zip(&at.v).zip(&at.tangent) {
                along += (x - at) * tangent;
                square += tangent * tangent;
            }
            t += along / square;
        }
        let nearest = curve(t).v;
        (0..3).map(|i| (v[i] - nearest[i]).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn curves_are_predicted_with_the_order_of_the_points() {
        // Steps so long that the errors are far above rounding, which more points of a circle would not leave.
        let curves: [fn(f64) -> Point; 2] = [on_circle, on_curve];
        let steps = [&[0.05, 0.1, 0.1, 0.2, 0.2][..], &[0.02, 0.02, 0.03, 0.03, 0.05]];
        for (curve, steps) in curves.into_iter().zip(steps) {
            for (count, &step) in (1..).zip(steps) {
                let order = (error(curve, step, count) / error(curve, 0.5 * step, count)).log2();
                assert!(order > 2.0 * count as f64 - 0.8, "{order} with {count} points");
            }
        }
    }

    #[test]
    fn a_circle_is_predicted_along_its_arc() {
        let metric = Metric { u: 1.0, p: 1.0 };
        let before = [on_circle(0.2), on_circle(-0.1)];
        let here = on_circle(0.4);
        let (mut v, truth) = ([0.0; 3], on_circle(0.5).v);
        for predictor in [
            by_circle(&here, &before, metric),
            Predictor::by_arcs(&here, &before, metric),
        ] {
            for (place, angle) in predictor.places[..3].iter().zip([0.0, -0.2, -0.5]) {
                assert!((place - 2.0 * angle).abs() < 1e-14, "{place}");
            }
            predictor.place(&predictor.weights(0.2, 3), &mut v);
            assert!((v[0] - truth[0]).hypot(v[1] - truth[1]) < 2e-6);
        }
    }

    #[test]
    fn coinciding_points_count_once_and_those_of_another_direction_not() {
        let metric = Metric { u: 1.0, p: 1.0 };
        let here = on_circle(1.0);
        let mut reversed = on_circle(0.9);
        reversed.reverse();
        for before in [on_circle(1.0), reversed, on_circle(1.2)] {
            assert_eq!(by_circle(&here, &[before], metric).count(), 1);
        }
        let same = [on_circle(1.0)];
        for before in [&[][..], &same] {
            assert_eq!(by_circle(&here, before, metric).count(), 1);
            assert_eq!(Predictor::by_arcs(&here, before, metric).count(), 1);
        }
    }
}
