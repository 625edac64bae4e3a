//! Closed curves that a step of a sweep entered beside its own curve: without their first point they would be followed forever.

use crate::results::Special;

/// Most folds of a round, which has as many of them where the parameter is largest as where it is smallest.
const MOST_FOLDS: usize = 8;

/// Relative difference of the same fold, located in two rounds.
const SAME_FOLD: f64 = 1e-6;

/// Whether the last folds are those of three rounds of one closed curve: a curve that comes back to a place by chance, or along itself,
/// does not pass the same folds in the same order twice more.
pub(super) fn goes_round(folds: &[Special]) -> bool {
    let same = |a: &Special, b: &Special| {
        (a.omega - b.omega).abs() <= SAME_FOLD * a.omega.abs()
            && (a.amplitude - b.amplitude).abs() <= SAME_FOLD * a.amplitude.abs()
    };
    (2..=MOST_FOLDS).step_by(2).any(|round| {
        folds.len() >= 3 * round
            && folds[folds.len() - 3 * round..]
                .windows(round + 1)
                .all(|pair| same(&pair[0], &pair[round]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folds(of: &[(f64, f64)]) -> Vec<Special> {
        let special = |(point, &(omega, amplitude))| Special {
            point,
            omega,
            amplitude,
        };
        of.iter().enumerate().map(special).collect()
    }

    #[test]
    fn three_rounds_are_seen_and_nothing_less() {
        let (a, b, c, d) = ((1.0, 0.3), (1.2, 0.5), (1.1, 0.7), (1.3, 0.9));
        assert!(goes_round(&folds(&[c, a, b, a, b, a, b])));
        assert!(!goes_round(&folds(&[a, b, a, b, a])));
        assert!(!goes_round(&folds(&[a, b, a, b, a, c])));
        assert!(goes_round(&folds(&[a, b, c, d, a, b, c, d, a, b, c, d])));
        // There and back along one curve, and folds that move.
        assert!(!goes_round(&folds(&[a, b, c, d, d, c, b, a, a, b, c, d])));
        let moving: Vec<_> = (0..12)
            .map(|k| (1.0 + 0.1 * f64::from(k % 2), 1.0 + 1e-3 * f64::from(k)))
            .collect();
        assert!(!goes_round(&folds(&moving)));
        assert!(!goes_round(&[]));
    }
}
