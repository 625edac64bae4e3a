//! The points of a branch before the current one, and the prediction of the next one from them.
//!
//! Many points predict a smooth branch best, two a branch with corners nearby: the number of the last prediction, one fewer
//! or one more, that which would have predicted the last step better predicts the next one. More than three points are used
//! where the branch is far better predicted than its steps, which the caller bounds, require.

use crate::continuation::curvature_circle::{CurvatureCircle, Place};
use crate::continuation::predictor::{MOST_POINTS, Predictor, Weights};
use crate::continuation::{Metric, Point};
use crate::error::{Error, Result, try_vec};
use num_complex::Complex64;

/// Largest distance of a prediction from the tangent, as a share of the step.
/// Kind: tuned; measured on: not recorded.
const LARGEST_DEPARTURE: f64 = 0.5;

/// Points from which a branch is predicted at first and wherever its steps follow the error of the prediction.
/// Kind: tuned; measured on: not recorded.
const FEW_POINTS: usize = 3;

const CONTEXT: &str = "the continuation";

/// Points before the current one, and the choice of the number of points for a prediction.
pub(super) struct History {
    /// Points before the current one, the newest first.
    before: Vec<Point>,
    /// Largest number of points, the current one included, from which predictions are made.
    most: usize,
    /// Number of points of the last prediction.
    count: usize,
    /// Alternative prediction from one point fewer or one more, and its number of points; empty where there is none.
    other: Vec<f64>,
    other_count: usize,
    /// Whether the last prediction was a solution, so that fewer points need not be tried.
    is_met: bool,
    places: Places,
}

/// Positions of the current point and of those before it along one circle of curvature, which is used for a few
/// points.
struct Places {
    /// Position of each point, the newest first; `None` where there is no circle.
    found: [Option<Place>; MOST_POINTS],
    circle: Option<CurvatureCircle>,
    /// Number of points since the one for which the circle was made; and whether the current point has a position.
    age: usize,
    is_current: bool,
}

/// Points for which a circle serves, its own among them, both of which must be kept.
/// Kind: fixed.
const MOST_PLACED: usize = MOST_POINTS - 1;

impl Places {
    const NONE: Self = Self {
        found: [None; MOST_POINTS],
        circle: None,
        age: 0,
        is_current: false,
    };

    /// Adds a point, whose position is computed later.
    fn push(&mut self) {
        self.circle = self.circle.filter(|_| self.is_current && self.age + 1 < MOST_PLACED);
        self.age += 1;
        self.is_current = false;
        self.found.rotate_right(1);
    }

    /// Computes the missing positions.
    fn complete(&mut self, here: &Point, before: &[Point], metric: Metric) {
        if self.is_current {
            return;
        }
        self.is_current = true;
        if let (Some(circle), [.., own]) = (&self.circle, &before[..self.age.min(before.len())]) {
            self.found[0] = circle.place((own, before.get(self.age)), here);
            if self.found[0].is_some() {
                return;
            }
        }
        self.age = 0;
        let circle = self.circle.insert(CurvatureCircle::new(here, before.first(), metric));
        let points = core::iter::once(here).chain(before);
        self.found = [None; MOST_POINTS];
        for (to, point) in self.found.iter_mut().zip(points) {
            *to = circle.place((here, before.first()), point);
        }
    }
}

impl History {
    /// A history without points, with memory for vectors of `length` numbers.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(length: usize) -> Result<Self> {
        let mut before = Vec::new();
        // One is added before the oldest is dropped.
        before
            .try_reserve_exact(MOST_POINTS)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        let mut other = try_vec(length, 0.0, CONTEXT)?;
        other.clear();
        Ok(Self {
            before,
            most: FEW_POINTS,
            count: 1,
            other,
            other_count: 1,
            is_met: false,
            places: Places::NONE,
        })
    }

    /// The point before the current one.
    pub fn previous(&self) -> Option<&Point> {
        self.before.first()
    }

    /// Adds the point that was the current one; returns the point that drops out, if any.
    pub fn push(&mut self, point: Point) -> Option<Point> {
        let oldest = if self.before.len() + 1 < MOST_POINTS {
            None
        } else {
            self.before.pop()
        };
        self.places.push();
        self.before.insert(0, point);
        oldest
    }

    /// Order of the last prediction: the power of the step with which its error grows.
    pub fn order(&self) -> f64 {
        2.0 * self.count as f64
    }

    /// Predicts the branch one step beyond `here`, from more than three points if it `is_smooth`; returns the
    /// predicted amplitude.
    pub fn predict(
        &mut self,
        here: &Point,
        metric: Metric,
        (step, is_smooth): (f64, bool),
        v: &mut [f64],
    ) -> Complex64 {
        let predictor = if is_smooth {
            self.places.complete(here, &self.before, metric);
            Predictor::by_circle(here, &self.before, &self.places.found, metric)
        } else {
            Predictor::by_arcs(here, &self.before[..self.before.len().min(FEW_POINTS - 1)], metric)
        };
        let other = &mut self.other;
        let mut weights = predictor.weights(step, 1);
        fill(&predictor, &weights, other, v.len());
        self.count = 1;
        for count in (2..=predictor.count().min(self.most)).rev() {
            let found = predictor.weights(step, count);
            predictor.place(&found, v);
            if metric.distance(other, v) <= LARGEST_DEPARTURE * step {
                (self.count, weights) = (count, found);
                break;
            }
        }
        if self.count == 1 {
            v.copy_from_slice(other);
        }
        other.clear();
        // One more and one fewer are tried in turn, where there are both.
        let (may_fall, may_grow) = (self.count > 2, self.count > 1 && self.count < predictor.count());
        let grows = may_grow && (!may_fall || self.other_count <= self.count);
        if grows || (may_fall && !(self.is_met && self.count == predictor.count())) {
            self.other_count = if grows { self.count + 1 } else { self.count - 1 };
            fill(&predictor, &predictor.weights(step, self.other_count), other, v.len());
        }
        predictor.amplitude(&weights)
    }

    /// Selects the number of points for the next prediction. The last one was `predicted` and led to `point`; errors
    /// are measured across the unit vector `row`.
    pub fn judge(&mut self, predicted: &[f64], point: &Point, row: &[f64], metric: Metric) {
        self.is_met = point.iterations == 0;
        if self.other.is_empty() {
            return;
        }
        let square = |from: &[f64]| metric.square_across(from, &point.v, row);
        if square(&self.other) < square(predicted) {
            self.most = self.other_count;
        }
    }
}

/// Writes a prediction to `v`, whose memory suffices.
fn fill(predictor: &Predictor<'_>, weights: &Weights, v: &mut Vec<f64>, length: usize) {
    v.resize(length, 0.0);
    predictor.place(weights, v);
}
