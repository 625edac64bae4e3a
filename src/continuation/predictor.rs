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
/// Kind: tuned; measured on: not recorded.
pub const MOST_POINTS: usize = 5;

/// The last points of a branch with their positions along it, counted from the newest one.
pub struct Predictor<'p> {
    /// The points, the newest first.
    points: [&'p Point; MOST_POINTS],
    places: [f64; MOST_POINTS],
    /// Reciprocals 1/(t_i − t_j) of the distances between the points.
    inverses: [[f64; MOST_POINTS]; MOST_POINTS],
    /// Factors that turn the stored tangents into derivatives by the parameter t.
    scales: [f64; MOST_POINTS],
    /// Derivative of the parameter t by the arc length at the newest point.
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
    /// The point `here` and the points before it, the newest first, positioned by a circle of curvature. It ends
    /// before a point that coincides with its neighbour or lies in another direction.
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

    /// The point `here` and the points before it, positioned by arc length, each arc taken as circular: quick, and
    /// enough for a few points.
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

    /// The point `here` alone; `scale` turns its tangent into the derivative.
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

    /// Adds a point before the others; `false` where its position does not lie before them.
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

    /// Number of points used.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Weights of the newest `count` points for a prediction one step beyond the newest one.
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

    /// Writes the predicted point (u, p) to `v`.
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

    /// The predicted amplitude.
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
#[path = "predictor_tests.rs"]
mod tests;
