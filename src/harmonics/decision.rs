//! How many harmonics a branch carries from a point on: one decision, from the signs of the point and the state of the branch.
//!
//! The controller asks [`decide`] at each [`Occasion`] and carries out the [`Action`]. With σ = 3/2 η over the tolerance, η the
//! error, the rows are, the first that applies:
//!
//! | occasion | condition | action |
//! |---|---|---|
//! | begins | fewer harmonics than a curve has at least | raise to these |
//! | solved | the error follows from an earlier one | keep |
//! | solved | else | estimate |
//! | estimated | σ unknown, and more harmonics changed nothing | drop to those before |
//! | estimated | σ = 0 | drop to those above rounding |
//! | estimated | σ ≤ 0.08, fresh, no miss with fewer | drop to the required ones |
//! | estimated | σ ≤ 1 | keep |
//! | estimated | σ > 1 | raise to the required ones |
//! | estimated | σ unknown | raise to twice as many |
//! | recorded | σ = 0 | drop to those above rounding |
//! | recorded | σ > 0.7, harmonics cost little | raise to the required ones |
//! | recorded | unknown, σ < 0.7, the wait is over | drop by one level at least |
//! | recorded | harmonics cost much, the wait is over | drop to the required ones, on trial |
//! | recorded | two estimates in a row have σ < 0.08 | drop to the required ones |
//! | recorded | fewer harmonics than a curve has at least | raise to these |
//! | recorded | else | keep |
//! | beside | σ > 1 or unknown | raise to the required ones |
//! | beside | else | keep |
//!
//! A raise that has no level to go to, and a drop that would not lose harmonics, is `Keep`; a folded branch does not drop below
//! its level while something is nonlinear, nor any branch below half of its most harmonics.

/// Share of the tolerance above which the next point is refined in advance, unless harmonics cost much.
/// Kind: tuned; measured on: not recorded.
const RAISE: f64 = 0.7;

/// Share of the tolerance below which the next point is coarsened.
/// Kind: tuned; measured on: not recorded.
pub(super) const DROP: f64 = 0.08;

/// Successive estimates below that share after which the branch is coarsened: one alone may be an exception.
/// Kind: tuned; measured on: not recorded.
const LOW: usize = 2;

/// Most refinements of one point.
/// Kind: cap.
pub(super) const MOST_REFINEMENTS: usize = 12;

/// State of a branch: the part of its past that matters for the next decision.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum State {
    /// No nonlinear point met the tolerance yet: nothing has justified the harmonics.
    Fresh,
    /// The harmonics follow from known errors.
    Settled,
    /// The harmonics were raised because an error was unknown.
    Unknown,
    /// The branch had a fold: with fewer harmonics it may fold elsewhere and reverse.
    Folded,
}

/// The event after which a decision is needed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Occasion {
    /// A curve begins where something is nonlinear.
    Begins,
    /// A point was solved. `predicted`: its error follows from that of an earlier point.
    Solved { predicted: bool },
    /// The error of a point was estimated.
    Estimated {
        /// Whether the point missed the tolerance with fewer harmonics before.
        missed: bool,
        /// Level from which the point was refined, where the refinement changed nothing.
        unchanged_from: Option<usize>,
        /// Number of refinements of this point so far.
        refinements: usize,
    },
    /// The point was recorded: the next step begins.
    Recorded,
    /// The error of a special point beside the curve was estimated.
    Beside,
}

/// Levels of harmonics from which a decision chooses.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Choices {
    /// Level of the point.
    pub level: usize,
    /// Level with the harmonics that the error requires.
    pub required: usize,
    /// Level with twice as many harmonics as the current one.
    pub doubled: usize,
    /// Lowest level of a curve where something is nonlinear.
    pub few: usize,
    /// Lowest level that the past of the branch admits.
    pub lowest: usize,
    /// Highest affordable level.
    pub last: usize,
}

/// Signs of a point by which its harmonics are chosen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Signs {
    pub occasion: Occasion,
    /// Error with the margin of its estimate, over the tolerance; NaN where it is unknown.
    pub share: f64,
    pub choices: Choices,
    /// Whether a recent miss still forbids a drop to the level that missed.
    pub waits: bool,
    /// Number of successive estimates whose share is below [`DROP`].
    pub low: usize,
    /// Whether each harmonic costs many factorisations or large matrices.
    pub costly: bool,
    /// Whether the allowed work did not suffice for the estimate, so that more harmonics would tell no more.
    pub too_large: bool,
}

/// The decision, with the level to select.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Action {
    Keep,
    Raise(usize),
    Drop(usize),
    Estimate,
}

impl Choices {
    fn raise(&self, to: usize) -> Action {
        let to = to.min(self.last);
        if to > self.level {
            Action::Raise(to)
        } else {
            Action::Keep
        }
    }

    fn drop(&self, to: usize) -> Action {
        let to = to.min(self.last);
        if to < self.level {
            Action::Drop(to)
        } else {
            Action::Keep
        }
    }
}

impl Signs {
    /// Signs of a point that was solved and whose error is not known yet.
    pub fn solved(predicted: bool) -> Self {
        Self {
            occasion: Occasion::Solved { predicted },
            share: f64::NAN,
            choices: Choices::default(),
            waits: false,
            low: 0,
            costly: false,
            too_large: false,
        }
    }

    /// Whether a drop is on trial: fewer harmonics are requested because they cost less, and the change of the
    /// response, added to the error, shows whether they meet the tolerance.
    pub fn is_on_trial(&self) -> bool {
        self.costly && !self.waits && self.share > 0.0
    }
}

/// The action at a point, by its signs and the state of the branch.
pub(crate) fn decide(signs: &Signs, state: State) -> Action {
    let choices = &signs.choices;
    match signs.occasion {
        Occasion::Begins => choices.raise(choices.few),
        Occasion::Solved { predicted: true } => Action::Keep,
        Occasion::Solved { predicted: false } => Action::Estimate,
        Occasion::Estimated {
            missed,
            unchanged_from,
            refinements,
        } => match unchanged_from {
            Some(before) if signs.share.is_nan() => Action::Drop(before),
            _ if signs.share <= 1.0 => met(signs, state == State::Fresh && !missed),
            _ if refinements >= MOST_REFINEMENTS => Action::Keep,
            _ if signs.share.is_nan() => refine(signs, choices.doubled),
            _ => refine(signs, choices.required),
        },
        Occasion::Recorded => next_step(signs, state),
        Occasion::Beside if signs.share <= 1.0 => Action::Keep,
        Occasion::Beside => refine(signs, choices.required),
    }
}

/// The action at an estimated point that meets the tolerance; `is_unjustified`: nothing has justified its harmonics.
fn met(signs: &Signs, is_unjustified: bool) -> Action {
    if signs.share == 0.0 || (is_unjustified && signs.share <= DROP) {
        signs.choices.drop(signs.choices.required)
    } else {
        Action::Keep
    }
}

/// Refines to a level, by one level at least, where that would tell more; else keeps the level.
fn refine(signs: &Signs, to: usize) -> Action {
    if signs.too_large {
        return Action::Keep;
    }
    signs.choices.raise(to.max(signs.choices.level + 1))
}

/// The action at a recorded point, before the next step of the branch.
fn next_step(signs: &Signs, state: State) -> Action {
    let (choices, share) = (&signs.choices, signs.share);
    // With nothing left out, fewer harmonics lose nothing above rounding, whatever the branch went through.
    if share == 0.0 {
        return choices.drop(choices.required);
    }
    let lowest = if state == State::Folded {
        choices.level
    } else {
        choices.lowest
    };
    let is_too_low = choices.level < lowest.min(choices.few);
    // Where only an unknown error asked for more harmonics, those below may do again.
    let again = state == State::Unknown && !signs.waits && share < RAISE;
    let below = choices.level.saturating_sub(1).max(choices.few);
    let next = choices.required.max(lowest).min(if again { below } else { usize::MAX });
    let may_rise = (share > RAISE && !signs.costly) || is_too_low;
    let may_fall = again || signs.is_on_trial() || (share < DROP && signs.low >= LOW);
    match choices.raise(next) {
        Action::Keep if may_fall => choices.drop(next),
        action if may_rise => action,
        _ => Action::Keep,
    }
}

#[cfg(test)]
mod tests {
    use super::{Action, Choices, MOST_REFINEMENTS, Occasion, Signs, State, decide};
    use Action::{Drop, Estimate, Keep, Raise};
    use State::{Folded, Fresh, Settled, Unknown};

    const ALL: [State; 4] = [Fresh, Settled, Unknown, Folded];

    const ESTIMATED: Occasion = Occasion::Estimated {
        missed: false,
        unchanged_from: None,
        refinements: 0,
    };

    /// A point of level 5 of 0 to 9 whose error requires level 3, on a branch that may drop to level 2.
    const USUAL: Signs = Signs {
        occasion: Occasion::Recorded,
        share: 0.5,
        choices: Choices {
            level: 5,
            required: 3,
            doubled: 8,
            few: 1,
            lowest: 2,
            last: 9,
        },
        waits: false,
        low: 0,
        costly: false,
        too_large: false,
    };

    fn at(occasion: Occasion, share: f64) -> Signs {
        Signs {
            occasion,
            share,
            ..USUAL
        }
    }

    fn with(signs: Signs, change: impl Fn(&mut Choices)) -> Signs {
        let mut changed = signs;
        change(&mut changed.choices);
        changed
    }

    /// Each row: its reason, signs, the states that it is for, and the action.
    fn check(rows: &[(&str, Signs, &[State], Action)]) {
        for (reason, signs, states, action) in rows {
            for &state in *states {
                assert_eq!(decide(signs, state), *action, "{reason}, {state:?}");
            }
        }
    }

    #[test]
    fn the_first_point_of_a_curve() {
        let begins = at(Occasion::Begins, f64::NAN);
        check(&[
            (
                "with fewer its error would be estimated to no avail",
                with(begins, |c| c.few = 6),
                &ALL,
                Raise(6),
            ),
            ("the caller began with enough", begins, &ALL, Keep),
            (
                "memory for no more",
                with(begins, |c| (c.few, c.last) = (6, 5)),
                &ALL,
                Keep,
            ),
        ]);
    }

    #[test]
    fn a_solved_point() {
        check(&[
            ("its error follows from an earlier one", Signs::solved(true), &ALL, Keep),
            ("nothing tells its error", Signs::solved(false), &ALL, Estimate),
        ]);
    }

    #[test]
    fn an_estimated_point_that_meets_the_tolerance() {
        let missed = Occasion::Estimated {
            missed: true,
            unchanged_from: None,
            refinements: 1,
        };
        check(&[
            (
                "nothing is left out, so fewer lose nothing",
                at(ESTIMATED, 0.0),
                &ALL,
                Drop(3),
            ),
            (
                "each harmonic has content",
                with(at(ESTIMATED, 0.0), |c| c.required = 5),
                &ALL,
                Keep,
            ),
            ("nothing has justified so many", at(ESTIMATED, 0.08), &[Fresh], Drop(3)),
            (
                "one low error may be an exception",
                at(ESTIMATED, 0.08),
                &[Settled, Unknown, Folded],
                Keep,
            ),
            ("it missed with fewer", at(missed, 0.01), &ALL, Keep),
            ("the error is not low", at(ESTIMATED, 0.0801), &ALL, Keep),
            ("the error just meets the tolerance", at(ESTIMATED, 1.0), &ALL, Keep),
        ]);
    }

    #[test]
    fn an_estimated_point_that_misses_the_tolerance() {
        let unchanged = Occasion::Estimated {
            missed: true,
            unchanged_from: Some(2),
            refinements: 1,
        };
        let last = Occasion::Estimated {
            missed: true,
            unchanged_from: None,
            refinements: MOST_REFINEMENTS,
        };
        let large = |share| Signs {
            too_large: true,
            ..at(ESTIMATED, share)
        };
        check(&[
            (
                "as many as it requires",
                with(at(ESTIMATED, 1.5), |c| c.required = 7),
                &ALL,
                Raise(7),
            ),
            ("at least one level more", at(ESTIMATED, 1.5), &ALL, Raise(6)),
            (
                "no more than are affordable",
                with(at(ESTIMATED, 1.5), |c| (c.required, c.last) = (8, 7)),
                &ALL,
                Raise(7),
            ),
            ("none are left", with(at(ESTIMATED, 1.5), |c| c.last = 5), &ALL, Keep),
            (
                "an unknown error asks for twice as many",
                at(ESTIMATED, f64::NAN),
                &ALL,
                Raise(8),
            ),
            (
                "an error without bound asks for more",
                at(ESTIMATED, f64::INFINITY),
                &ALL,
                Raise(6),
            ),
            (
                "more told no more: back to those before",
                at(unchanged, f64::NAN),
                &ALL,
                Drop(2),
            ),
            ("more told the error", at(unchanged, 0.5), &ALL, Keep),
            ("more told that more are missing", at(unchanged, 2.0), &ALL, Raise(6)),
            ("the work does not suffice for an estimate", large(f64::NAN), &ALL, Keep),
            ("nor for more harmonics", large(3.0), &ALL, Keep),
            ("it was refined often enough", at(last, 3.0), &ALL, Keep),
            ("and stays unknown", at(last, f64::NAN), &ALL, Keep),
        ]);
    }

    #[test]
    fn a_recorded_point_that_may_rise() {
        let rising = with(at(Occasion::Recorded, 0.71), |c| c.required = 6);
        let costly = Signs { costly: true, ..rising };
        let few = with(USUAL, |c| (c.few, c.lowest) = (6, 6));
        check(&[
            ("the next point would miss", rising, &ALL, Raise(6)),
            (
                "the tolerance is far enough",
                Signs { share: 0.7, ..rising },
                &ALL,
                Keep,
            ),
            ("harmonics cost much: only a miss raises them", costly, &ALL, Keep),
            ("none are left", with(rising, |c| c.last = 5), &ALL, Keep),
            (
                "a curve has at least so many",
                few,
                &[Fresh, Settled, Unknown],
                Raise(6),
            ),
            ("a folded curve keeps its harmonics", few, &[Folded], Keep),
            ("memory for no more", with(few, |c| c.last = 5), &ALL, Keep),
        ]);
    }

    #[test]
    fn a_recorded_point_that_may_drop() {
        let low = Signs {
            share: 0.07,
            low: 2,
            ..USUAL
        };
        let costly = Signs { costly: true, ..USUAL };
        let unjudged = [Fresh, Settled];
        check(&[
            (
                "nothing is left out, so fewer lose nothing",
                at(Occasion::Recorded, 0.0),
                &ALL,
                Drop(3),
            ),
            (
                "nothing is left out, nor below half",
                with(at(Occasion::Recorded, 0.0), |c| c.required = 0),
                &ALL,
                Drop(0),
            ),
            (
                "each harmonic has content",
                with(at(Occasion::Recorded, 0.0), |c| c.required = 5),
                &ALL,
                Keep,
            ),
            ("two errors in a row are low", low, &[Fresh, Settled, Unknown], Drop(3)),
            ("with fewer it may fold elsewhere", low, &[Folded], Keep),
            ("one error is low", Signs { low: 1, ..low }, &unjudged, Keep),
            (
                "to half of the most at once",
                with(low, |c| (c.required, c.lowest) = (0, 4)),
                &unjudged,
                Drop(4),
            ),
            (
                "the level below missed lately",
                with(low, |c| c.lowest = 5),
                &unjudged,
                Keep,
            ),
            ("the error is not low", USUAL, &unjudged, Keep),
            (
                "an unknown error alone raised them: one level back",
                with(USUAL, |c| c.required = 5),
                &[Unknown],
                Drop(4),
            ),
            ("or as many as the error admits", USUAL, &[Unknown], Drop(3)),
            ("the wait lasts", Signs { waits: true, ..USUAL }, &[Unknown], Keep),
            (
                "the next point would miss",
                Signs { share: 0.7, ..USUAL },
                &[Unknown],
                Keep,
            ),
            (
                "harmonics that cost much are dropped on trial",
                costly,
                &[Fresh, Settled, Unknown],
                Drop(3),
            ),
            (
                "not so soon after a trial that failed",
                Signs { waits: true, ..costly },
                &ALL,
                Keep,
            ),
            ("nor where the branch folded", costly, &[Folded], Keep),
        ]);
        assert!(costly.is_on_trial() && !USUAL.is_on_trial());
        assert!(!Signs { waits: true, ..costly }.is_on_trial());
        // With nothing left out there is nothing to try.
        assert!(!Signs { share: 0.0, ..costly }.is_on_trial());
    }

    #[test]
    fn a_point_beside_the_curve() {
        let beside = |share| at(Occasion::Beside, share);
        let large = Signs {
            too_large: true,
            ..beside(2.0)
        };
        check(&[
            ("it meets the tolerance", beside(1.0), &ALL, Keep),
            ("it is not a point of the curve: nothing drops", beside(0.0), &ALL, Keep),
            ("it misses", with(beside(2.0), |c| c.required = 8), &ALL, Raise(8)),
            ("its error is unknown: one level more", beside(f64::NAN), &ALL, Raise(6)),
            ("the work does not suffice", large, &ALL, Keep),
            ("none are left", with(beside(2.0), |c| c.last = 5), &ALL, Keep),
        ]);
    }
}
