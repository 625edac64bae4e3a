//! The past of a branch, as far as it bears on its harmonics: what [`crate::harmonics::decision`] calls its state, and the levels
//! to which it may not drop for some points.

use crate::harmonics::decision::{DROP, State};

/// Number of points for which a branch is not coarsened to a level at which one missed the tolerance, and the most points
/// where the error of one was unknown there time and again.
/// Kind: tuned; measured on: not recorded.
const CONTROLLER_PATIENCE: usize = 10;
const MOST_PATIENCE: usize = 80;

/// Past of a branch, as far as it limits the choice of harmonics.
#[derive(Debug)]
pub(crate) struct HarmonicHistory {
    /// Whether no nonlinear point has met the tolerance yet.
    fresh: bool,
    /// Whether the branch has had a fold.
    folded: bool,
    /// Number of points until the branch may be coarsened again, after it was refined because an error was unknown;
    /// else `None`.
    unknown: Option<usize>,
    /// Lowest level to which the branch may be coarsened, one above a level where a point missed the tolerance; and
    /// the number of points for which this holds.
    floor: (usize, usize),
    /// Highest level of the branch so far.
    highest: usize,
    /// Number of successive estimates far below the tolerance.
    low: usize,
}

impl HarmonicHistory {
    /// History of a branch without a point.
    pub fn new() -> Self {
        Self {
            fresh: true,
            folded: false,
            unknown: None,
            floor: (0, 0),
            highest: 0,
            low: 0,
        }
    }

    /// State of the branch. A fold is never forgotten once an error has justified the harmonics.
    pub fn state(&self) -> State {
        match (self.fresh, self.folded, self.unknown) {
            (true, ..) => State::Fresh,
            (false, true, _) => State::Folded,
            (false, false, Some(_)) => State::Unknown,
            (false, false, None) => State::Settled,
        }
    }

    /// Notes that the current harmonics are justified: by an error, or as the fewest of a curve.
    pub fn note_justified(&mut self) {
        self.fresh = false;
    }

    /// Notes that the branch has a fold.
    pub fn note_fold(&mut self) {
        self.folded = true;
    }

    /// Notes an estimate: its error with margin over the tolerance, NaN where it is unknown.
    pub fn note_estimate(&mut self, share: f64) {
        self.low = if share < DROP { self.low + 1 } else { 0 };
    }

    /// Notes that a point at a level missed the tolerance, or that its error was unknown.
    pub fn note_miss(&mut self, is_unknown: bool, level: usize) {
        self.unknown = is_unknown.then(|| {
            self.unknown
                .map_or(CONTROLLER_PATIENCE, |points| (2 * points).min(MOST_PATIENCE))
        });
        self.floor = (level + 1, self.unknown.unwrap_or(CONTROLLER_PATIENCE));
    }

    /// Notes that refining beyond a level told nothing more.
    pub fn note_settled(&mut self, level: usize) {
        self.floor = (level, 0);
    }

    /// Notes that a trial with fewer harmonics than those of `level` failed.
    pub fn note_failed_trial(&mut self, level: usize) {
        self.floor = (level, CONTROLLER_PATIENCE);
    }

    /// Notes a recorded point of a level. The wait after a miss gets shorter by one point.
    pub fn note_recorded(&mut self, level: usize) {
        self.floor.1 = self.floor.1.saturating_sub(1);
        self.highest = self.highest.max(level);
    }

    /// Whether a recent miss still limits the coarsening.
    pub fn waits(&self) -> bool {
        self.floor.1 > 0
    }

    /// Lowest level to which the branch may be coarsened while a recent miss counts, else 0.
    pub fn floor(&self) -> usize {
        if self.waits() { self.floor.0 } else { 0 }
    }

    /// Highest level of the branch so far.
    pub fn highest(&self) -> usize {
        self.highest
    }

    /// Number of successive estimates far below the tolerance.
    pub fn low(&self) -> usize {
        self.low
    }
}

#[cfg(test)]
mod tests {
    use super::{CONTROLLER_PATIENCE, HarmonicHistory, MOST_PATIENCE};
    use crate::harmonics::decision::State;

    #[test]
    fn a_branch_is_fresh_until_an_error_is_known_and_a_fold_is_never_forgotten() {
        let mut history = HarmonicHistory::new();
        history.note_miss(true, 3);
        assert_eq!(history.state(), State::Fresh);
        history.note_justified();
        assert_eq!(history.state(), State::Unknown);
        history.note_miss(false, 3);
        assert_eq!(history.state(), State::Settled);
        history.note_fold();
        history.note_miss(true, 3);
        assert_eq!(history.state(), State::Folded);
    }

    #[test]
    fn a_miss_bars_its_level_for_some_points() {
        let mut history = HarmonicHistory::new();
        history.note_miss(false, 3);
        for _ in 0..CONTROLLER_PATIENCE {
            assert_eq!(history.floor(), 4);
            history.note_recorded(4);
        }
        assert_eq!((history.waits(), history.floor(), history.highest()), (false, 0, 4));
    }

    #[test]
    fn unknown_errors_time_and_again_double_the_wait() {
        let mut history = HarmonicHistory::new();
        let mut waits = Vec::new();
        for _ in 0..6 {
            history.note_miss(true, 2);
            let mut points = 0;
            while history.waits() {
                history.note_recorded(3);
                points += 1;
            }
            waits.push(points);
        }
        assert_eq!(waits, [10, 20, 40, 80, MOST_PATIENCE, MOST_PATIENCE]);
    }

    #[test]
    fn only_estimates_in_a_row_are_low_ones() {
        let mut history = HarmonicHistory::new();
        let count = [0.01, 0.0, 0.5, 0.01, f64::NAN, 0.01].map(|share| {
            history.note_estimate(share);
            history.low()
        });
        assert_eq!(count, [1, 2, 0, 1, 0, 1]);
    }
}
