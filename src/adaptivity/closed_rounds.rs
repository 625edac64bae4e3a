//! Closed curves that a step of a sweep entered beside its own curve: without their first point they would be followed forever.

use crate::continuation::Point;
use crate::error::{Result, try_push};
use crate::linalg::norm;

/// Most folds of a round, which has as many of them where the parameter is largest as where it is smallest.
const MOST_FOLDS: usize = 8;

/// Relative difference of the same fold, located in two rounds.
const SAME_FOLD: f64 = 1e-6;

/// Parameter and size of the unknowns of the folds that a branch passed.
#[derive(Default)]
pub(super) struct Rounds(Vec<[f64; 2]>);

impl Rounds {
    /// Adds the next fold.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn add(&mut self, fold: &Point) -> Result<()> {
        try_push(&mut self.0, [fold.parameter(), norm(fold.unknowns())], "the folds")
    }

    /// Whether the last folds are those of three rounds of one closed curve: a curve that comes back to a place by chance, or along
    /// itself, does not pass the same folds in the same order twice more.
    pub fn are_closed(&self) -> bool {
        let folds = &self.0;
        let same = |a: &[f64; 2], b: &[f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME_FOLD * a.abs());
        (2..=MOST_FOLDS).step_by(2).any(|round| {
            folds.len() >= 3 * round
                && folds[folds.len() - 3 * round..]
                    .windows(round + 1)
                    .all(|pair| same(&pair[0], &pair[round]))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Rounds;

    #[test]
    fn three_rounds_are_seen_and_nothing_less() {
        let are_closed = |folds: &[[f64; 2]]| Rounds(folds.to_vec()).are_closed();
        let [a, b, c, d] = [[1.0, 0.3], [1.2, 0.5], [1.1, 0.7], [1.3, 0.9]];
        assert!(are_closed(&[c, a, b, a, b, a, b]));
        assert!(!are_closed(&[a, b, a, b, a]));
        assert!(!are_closed(&[a, b, a, b, a, c]));
        assert!(are_closed(&[a, b, c, d, a, b, c, d, a, b, c, d]));
        // There and back along one curve, and folds that move.
        assert!(!are_closed(&[a, b, c, d, d, c, b, a, a, b, c, d]));
        let moving: Vec<_> = (0..12)
            .map(|k| [1.0 + 0.1 * f64::from(k % 2), 1.0 + 1e-3 * f64::from(k)])
            .collect();
        assert!(!are_closed(&moving));
        assert!(!are_closed(&[]));
    }
}
