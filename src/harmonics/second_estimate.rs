//! A second, dearer estimate of a point of a forced response whose error the first one left unknown, before the branch tells so.
//!
//! It may take more work, keeps nothing of other points, and factors all harmonics of the extended problem where the work suffices:
//! an iteration that ends far from the step may have been the reason. If it tells nothing either, the point is extended once more by
//! further harmonics: where a contact grazes in one extended motion, it does not graze in the other.
//!
//! Errors of some models stay unknown at every point. After a second estimate in vain the next ones are left out, twice as many each
//! time.

use crate::fourier::HarmonicSet;
use crate::harmonics::carried_harmonics::carried_from;

/// Work of a second estimate over that of the first.
/// Kind: tuned; measured on: wheels of 24 sectors with stops.
const OF_SECOND: usize = 2;

/// Most unknown errors without a second estimate after one in vain.
/// Kind: cap.
const LONGEST_WAIT: usize = 64;

/// The way of an estimate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Further {
    /// As many harmonics as the first one.
    Same,
    /// More of them.
    More,
}

/// Whether an estimate is a second one, and when the next one is due.
#[derive(Default)]
pub(super) struct SecondEstimate {
    at_hand: Option<Further>,
    /// Unknown errors until the next one, and how many were left out before the last.
    left: usize,
    wait: usize,
}

impl SecondEstimate {
    /// The ways in their order.
    pub const ALL: [Further; 2] = [Further::Same, Further::More];

    /// Whether a second estimate is due at a point with an unknown error.
    pub fn is_due(&mut self) -> bool {
        let due = self.left == 0;
        self.left = self.left.saturating_sub(1);
        due
    }

    /// Begins one.
    pub fn begin(&mut self, further: Further) {
        self.at_hand = Some(further);
    }

    /// Ends it.
    pub fn end(&mut self) {
        self.at_hand = None;
    }

    /// Notes whether it told the error.
    pub fn note(&mut self, told: bool) {
        self.wait = if told {
            0
        } else {
            (2 * self.wait).clamp(1, LONGEST_WAIT)
        };
        self.left = self.wait;
    }

    /// Whether the estimate at hand is a second one.
    pub fn is_at_hand(&self) -> bool {
        self.at_hand.is_some()
    }

    /// Newton iterations by which the work is bounded.
    pub fn iterations(&self, of_first: usize) -> usize {
        if self.is_at_hand() {
            OF_SECOND * of_first
        } else {
            of_first
        }
    }

    /// The least harmonic to which a point is extended.
    pub fn least(&self, set: &HarmonicSet, of_first: usize) -> usize {
        match self.at_hand {
            Some(Further::More) => carried_from(set, of_first + 1),
            _ => of_first,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Further, SecondEstimate};
    use crate::fourier::HarmonicSet;

    #[test]
    fn second_estimates_in_vain_become_rare() {
        let mut second = SecondEstimate::default();
        let mut made = Vec::new();
        for point in 0..32 {
            if second.is_due() {
                made.push(point);
                second.note(false);
            }
        }
        assert_eq!(made, [0, 2, 5, 10, 19]);
        second.note(true);
        assert!(second.is_due());
    }

    #[test]
    fn the_last_way_takes_more_work_and_harmonics() {
        let (mut second, set) = (SecondEstimate::default(), HarmonicSet::all(9).unwrap());
        let of = |second: &SecondEstimate| (second.iterations(40), second.least(&set, 19));
        assert_eq!(of(&second), (40, 19));
        second.begin(Further::Same);
        assert_eq!(of(&second), (80, 19));
        second.begin(Further::More);
        assert_eq!(of(&second), (80, 20));
        second.end();
        assert!(!second.is_at_hand() && of(&second) == (40, 19));
    }
}
