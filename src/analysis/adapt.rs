//! As many harmonics as the error wanted asks for: more where a point misses it, fewer where they carry little.
//!
//! A solution W whose error η is too large is solved again from its corrected solution Z*, see
//! [`crate::error_estimate`], with the lowest harmonics H′ beyond which that has faded:
//!
//! > 3/2 A t(H′) ≤ ½ tolerance,  t(h) = ‖Z*_{>h}‖/‖Z*‖,  A = η/t(H)
//!
//! and the branch goes on with H′. The factor 3/2 allows for the error of the estimate. Harmonics fall only where the
//! error is far below the tolerance, so that they do not flutter.

use super::follow::Keeper;
use crate::branch::SpecialKind;
use crate::continuation::Point;
use crate::error::Result;
use crate::error_estimate::Estimate;
use crate::linalg::norm;
use core::cmp::Ordering;

/// How far the error may be above its estimate.
const MARGIN: f64 = 1.5;

/// Share of the tolerance that is aimed at.
const AIM: f64 = 0.5;

/// Share of the tolerance above which the next point gets more harmonics before it misses.
const RAISE: f64 = 0.7;

/// Share of the tolerance below which the next point gets fewer.
const DROP: f64 = 0.08;

/// Points for which a branch does not fall to a rung on which one missed the tolerance.
const PATIENCE: usize = 10;

/// Least size of a harmonic that carries something.
const NOTHING: f64 = 1e-13;

/// Rungs that a branch climbs where a point was stuck.
const RETREAT: usize = 3;

/// Most rungs that one point may climb.
const MOST_CLIMBS: usize = 12;

/// An estimate with the error that the tolerance bounds; NaN where it is unknown.
pub(super) struct Assessment {
    pub error: f64,
    pub estimate: Estimate,
}

/// How harmonics are chosen.
pub(super) struct Choice {
    tolerance: f64,
    /// Estimates made that were more than a look at contacts that stick.
    pub estimates: usize,
    /// Error and harmonics wanted of the last point.
    last: Option<(f64, usize)>,
    /// Lowest rung to which the branch may fall, and for how many points more: one above that where a point missed
    /// the tolerance.
    floor: (usize, usize),
    /// The highest rung so far. The branch falls no further than to half its harmonics.
    highest: usize,
    /// Whether it had a fold. Then it does not fall at all, where something is nonlinear: with fewer harmonics it may
    /// fold elsewhere, and turn round.
    pub folded: bool,
}

impl Choice {
    /// For an error wanted.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            estimates: 0,
            last: None,
            floor: (0, 0),
            highest: 0,
            folded: false,
        }
    }

    /// Whether an error that is told is above the tolerance, or unknown.
    pub fn is_missed_by(&self, error: f64) -> bool {
        // An unknown error is no number.
        self.tolerance > 0.0
            && !matches!(
                error.partial_cmp(&self.tolerance),
                Some(Ordering::Less | Ordering::Equal)
            )
    }

    fn accepts(&self, error: f64) -> bool {
        MARGIN * error <= self.tolerance
    }

    /// Counts an estimate.
    fn count(&mut self, found: &Assessment) {
        self.estimates += usize::from(!found.estimate.certified || found.estimate.steps > 0);
    }

    /// Highest harmonic that the solution should have; 0 where nothing is known.
    fn wanted(&self, found: &Assessment) -> usize {
        if !found.estimate.certified {
            return 0;
        }
        let left_out = found
            .estimate
            .tail
            .iter()
            .fold(0.0, |s, &(_, share)| f64::hypot(s, share));
        // Of a solution that misses nothing all is kept that is not rounding.
        let bound = if found.error > 0.0 && left_out > 0.0 {
            AIM * self.tolerance * left_out / (MARGIN * found.error)
        } else {
            NOTHING
        };
        let corrected = &found.estimate.corrected;
        let set = &corrected.set;
        let all = norm(&corrected.motion);
        let mut tail = 0.0_f64;
        for (i, &number) in set.numbers().iter().enumerate().rev() {
            let signals = corrected.motion.chunks_exact(set.packed_len());
            tail = signals.map(|y| set.get(y, i).norm()).fold(tail, f64::hypot);
            if tail > bound * all {
                return number;
            }
        }
        0
    }
}

/// A point with as many harmonics as its error asks for, on whose rung the keeper is.
pub(super) struct Refined {
    pub point: Point,
    /// Whether it misses the tolerance and was not found with more harmonics, though there are some.
    pub stuck: bool,
}

/// The point with as many harmonics as its error asks for. One that misses the tolerance for all that could be done is
/// returned all the same.
pub(super) fn refine(
    keeper: &mut dyn Keeper,
    mut point: Point,
    keep_parameter: bool,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Refined> {
    let done = |point| Ok(Refined { point, stuck: false });
    if !keeper.ladder().is_automatic() {
        return done(point);
    }
    for climbs in 0..=MOST_CLIMBS {
        let rung = keeper.rung();
        let Some(found) = keeper.assess(&point)? else {
            return done(point);
        };
        let choice = keeper.choice();
        choice.count(&found);
        let accepted = choice.accepts(found.error);
        let wanted = choice.wanted(&found);
        choice.last = accepted.then_some((found.error, wanted));
        if !accepted {
            choice.floor = (rung + 1, PATIENCE);
        }
        let next = if accepted {
            // What carries nothing is not carried.
            if found.error > 0.0 {
                return done(point);
            }
            keeper.ladder().rung_with(wanted)
        } else {
            keeper.ladder().rung_with(wanted).max(rung + 1)
        };
        let last = keeper.ladder().last();
        let next = next.min(last);
        let may_climb = !accepted && next > rung && !found.estimate.too_large && climbs < MOST_CLIMBS;
        let raised = if accepted && next < rung {
            go(keeper, (&point, rung), next, keep_parameter, cancelled)?
        } else if may_climb {
            climb(keeper, &point, &found.estimate, next, keep_parameter, cancelled)?
        } else {
            None
        };
        let Some(better) = raised else {
            return Ok(Refined {
                point,
                stuck: may_climb,
            });
        };
        point = better;
    }
    done(point)
}

/// The point of a rung from which the next one was stuck, with more harmonics; none where that is not found either.
pub(super) fn retreat(
    keeper: &mut dyn Keeper,
    (point, rung): (&Point, usize),
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<Point>> {
    let to = (rung.max(keeper.rung()) + RETREAT).min(keeper.ladder().last());
    go(keeper, (point, rung), to, true, cancelled)
}

/// Whether a point beside the curve may be kept; if not, the keeper has climbed, and it is to be found again. A fold
/// always may: at its parameter no solution is isolated, and errors there are none of its own.
pub(super) fn suffices(keeper: &mut dyn Keeper, kind: SpecialKind, point: &Point) -> Result<bool> {
    if !keeper.ladder().is_automatic() || kind.is_fold() {
        return Ok(true);
    }
    let rung = keeper.rung();
    let Some(found) = keeper.assess(point)? else {
        return Ok(true);
    };
    let choice = keeper.choice();
    choice.count(&found);
    if choice.accepts(found.error) {
        return Ok(true);
    }
    let wanted = choice.wanted(&found);
    let last = keeper.ladder().last();
    let next = keeper.ladder().rung_with(wanted).max(rung + 1).min(last);
    if next <= rung || found.estimate.too_large {
        return Ok(true);
    }
    keeper.go_to(next)?;
    Ok(false)
}

/// The point stored last with the harmonics with which the branch goes on: where they change, solved once more.
pub(super) fn settle(keeper: &mut dyn Keeper, point: Point, cancelled: Option<&dyn Fn() -> bool>) -> Result<Point> {
    let rung = keeper.rung();
    let choice = keeper.choice();
    let Some((error, wanted)) = choice.last else {
        return Ok(point);
    };
    let share = MARGIN * error / choice.tolerance;
    choice.floor.1 = choice.floor.1.saturating_sub(1);
    choice.highest = choice.highest.max(rung);
    let (highest, recent) = (choice.highest, choice.floor);
    let mut floor = 0;
    if error > 0.0 && choice.folded {
        floor = rung;
    } else if error > 0.0 {
        floor = keeper.ladder().rung_of_half(highest);
        if recent.1 > 0 {
            floor = floor.max(recent.0);
        }
    }
    let last = keeper.ladder().last();
    let next = keeper.ladder().rung_with(wanted).max(floor).min(last);
    if !((share > RAISE && next > rung) || (share < DROP && next < rung)) {
        return Ok(point);
    }
    // At its parameter, so that nothing lies between the point stored and the one that the branch goes on from.
    let Some(found) = go(keeper, (&point, rung), next, true, cancelled)? else {
        return Ok(point);
    };
    let before = keeper.carry(&point, rung)?;
    let tolerance = keeper.choice().tolerance;
    if (found.amplitude - before.amplitude).norm() > tolerance * before.amplitude.norm() {
        // Fewer harmonics than thought would do, as near a fold.
        keeper.go_to(rung)?;
        return Ok(point);
    }
    Ok(found)
}

/// Solves near a point of a rung with the harmonics of another one; the keeper stays where it is if that fails.
fn go(
    keeper: &mut dyn Keeper,
    (point, rung): (&Point, usize),
    to: usize,
    keep_parameter: bool,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<Point>> {
    let from = keeper.rung();
    keeper.go_to(to)?;
    let start = keeper.carry(point, rung)?;
    let found = keeper.solve_again(&start, keep_parameter, cancelled)?;
    if found.is_none() {
        keeper.go_to(from)?;
    }
    Ok(found)
}

/// Solves with the harmonics of a higher rung, from the corrected solution or rung by rung; the keeper stays where
/// it is if both fail.
fn climb(
    keeper: &mut dyn Keeper,
    point: &Point,
    estimate: &Estimate,
    to: usize,
    keep_parameter: bool,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<Point>> {
    let from = keeper.rung();
    keeper.go_to(to)?;
    if estimate.certified {
        // Where the plane across the branch has no solution near, a fixed parameter may have one.
        for fixed in [keep_parameter, true] {
            let start = keeper.corrected(point, from, estimate)?;
            if let Some(found) = keeper.solve_again(&start, fixed, cancelled)? {
                return Ok(Some(found));
            }
        }
    }
    let mut reached = point.try_clone()?;
    for rung in from + 1..=to {
        keeper.go_to(rung)?;
        let start = keeper.carry(&reached, rung - 1)?;
        match keeper.solve_again(&start, keep_parameter, cancelled)? {
            Some(found) => reached = found,
            None if rung == from + 1 => {
                keeper.go_to(from)?;
                return Ok(None);
            }
            None => {
                keeper.go_to(rung - 1)?;
                break;
            }
        }
    }
    Ok(Some(reached))
}
