//! The points of a branch before the current one, and the prediction of the next one from them.
//!
//! Three points predict a smooth branch best, two a branch with corners nearby: the number that would have predicted the last
//! step better predicts the next one.

use crate::continuation::predictor::{MOST_POINTS, Predictor};
use crate::continuation::{Metric, Point};
use crate::error::{Result, try_vec};
use num_complex::Complex64;

/// Largest distance of a prediction from the tangent, as a share of the step.
const LARGEST_DEPARTURE: f64 = 0.5;

/// Points before the current one.
pub(super) struct History {
    previous: Option<Point>,
    before: Option<Point>,
    /// Number of points, the current one among them, from which predictions are made at most.
    most: usize,
    /// Number of points of the last prediction.
    count: usize,
    /// Prediction from the other number of points; empty where there are not three.
    other: Vec<f64>,
}

impl History {
    /// No points; memory for vectors of `length` numbers.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(length: usize) -> Result<Self> {
        let mut other = try_vec(length, 0.0, "the continuation")?;
        other.clear();
        Ok(Self {
            previous: None,
            before: None,
            most: MOST_POINTS,
            count: 1,
            other,
        })
    }

    /// The point before the current one.
    pub fn previous(&self) -> Option<&Point> {
        self.previous.as_ref()
    }

    /// Adds the point that was the current one.
    pub fn push(&mut self, point: Point) {
        self.before = self.previous.replace(point);
    }

    /// The power of the step with which the error of the last prediction grows.
    pub fn order(&self) -> f64 {
        2.0 * self.count as f64
    }

    /// Predicts the branch a step beyond `here`; returns the amplitude there.
    pub fn predict(&mut self, here: &Point, metric: Metric, step: f64, v: &mut [f64]) -> Complex64 {
        let tangent = Predictor::new(here, metric);
        tangent.place(step, 1, v);
        self.count = 1;
        self.other.clear();
        let predictor = tangent
            .after(self.previous.as_ref(), metric)
            .after(self.before.as_ref(), metric);
        // At most as many numbers as there is memory for.
        self.other.extend_from_slice(v);
        for count in (2..=predictor.count().min(self.most)).rev() {
            predictor.place(step, count, v);
            if metric.distance(&self.other, v) <= LARGEST_DEPARTURE * step {
                self.count = count;
                break;
            }
        }
        match self.count {
            1 => v.copy_from_slice(&self.other),
            count if predictor.count() == MOST_POINTS => {
                predictor.place(step, other_than(count), &mut self.other);
                return predictor.amplitude(step, count);
            }
            _ => {}
        }
        self.other.clear();
        predictor.amplitude(step, self.count)
    }

    /// Selects the number of points of the next prediction, where the last one was `predicted` and led to `v` across the unit
    /// vector `row`.
    pub fn judge(&mut self, predicted: &[f64], v: &[f64], row: &[f64], metric: Metric) {
        if self.other.is_empty() {
            return;
        }
        let across = |from: &[f64]| {
            let along = metric.along_row(from, row) - metric.along_row(v, row);
            metric.distance(from, v).powi(2) - along * along
        };
        if across(&self.other) < across(predicted) {
            self.most = other_than(self.count);
        }
    }
}

/// Two points instead of the most, and the other way round.
fn other_than(count: usize) -> usize {
    MOST_POINTS + 2 - count
}
