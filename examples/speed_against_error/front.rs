//! Shortest times of ways of one kind for a requested error.

use crate::measure::Outcome;

/// Time and error of the ways that no other way surpasses in both, from the quickest to the most accurate.
#[derive(Debug)]
pub struct Front(Vec<(f64, f64)>);

impl Front {
    /// The front of some ways.
    pub fn new<'a>(outcomes: impl Iterator<Item = &'a Outcome>) -> Self {
        let mut all: Vec<(f64, f64)> = outcomes
            .filter(|o| o.missing() == 0)
            .map(|o| (o.seconds, o.error()))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut front: Vec<(f64, f64)> = Vec::new();
        for way in all {
            if front.last().is_none_or(|last| way.1 < last.1) {
                front.push(way);
            }
        }
        Self(front)
    }

    /// The time for an error, with the logarithm of time linear in that of the error between neighbours; `None` if
    /// no way reaches the error.
    pub fn time(&self, error: f64) -> Option<f64> {
        let exact = self.0.iter().position(|w| w.1 <= error)?;
        let Some(before) = exact.checked_sub(1) else {
            return Some(self.0[0].0);
        };
        let ((t0, e0), (t1, e1)) = (self.0[before], self.0[exact]);
        // An error of zero has no logarithm and is not interpolated.
        if e1 == 0.0 {
            return Some(t1);
        }
        let share = (e0 / error).ln() / (e0 / e1).ln();
        Some(t0 * (t1 / t0).powf(share))
    }
}

/// The fixed way with the fewest harmonics whose error is at most the given one.
pub fn fewest(outcomes: &[Outcome], error: f64) -> Option<&Outcome> {
    let mut fixed = outcomes.iter().filter(|o| !o.way.is_automatic() && o.way.samples == 0);
    fixed.find(|o| o.missing() == 0 && o.error() <= error)
}
