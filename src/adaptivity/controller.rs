//! As many harmonics as the error wanted asks for: more where a point misses it, fewer where they carry little.
//!
//! A solution W whose error η is too large is solved again from its corrected solution Z*, see
//! [`crate::error_estimate`], with the lowest harmonics H′ beyond which that has faded:
//!
//! > 3/2 A t(H′) ≤ ½ tolerance,  t(h) = ‖Z*_{>h}‖/‖Z*‖,  A = η/t(H)
//!
//! and the branch goes on with H′. The factor 3/2 allows for the error of the estimate. Harmonics fall only where the
//! error is far below the tolerance, so that they do not flutter.

use crate::adaptivity::branch_tracer::Keeper;
use crate::continuation::Point;
use crate::error::Result;
use crate::error_estimate::Estimate;
use crate::linalg::norm;
use crate::results::SpecialKind;
use core::cmp::Ordering;

/// How far the error may be above its estimate.
const MARGIN: f64 = 1.5;

/// Share of the tolerance that is aimed at.
const AIM: f64 = 0.5;

/// Share of the tolerance above which the next point gets more harmonics before it misses.
const RAISE: f64 = 0.7;

/// Share of the tolerance below which the next point gets fewer.
const DROP: f64 = 0.08;

/// Points for which a branch does not fall to a resolution on which one missed the tolerance.
const PATIENCE: usize = 10;

/// Least size of a harmonic that carries something.
const NOTHING: f64 = 1e-13;

/// Resolutions that a branch climbs where a point was stuck.
const BACKTRACK: usize = 3;

/// Most resolutions that one point may climb.
const MOST_REFINEMENTS: usize = 12;

/// An estimate with the error that the tolerance bounds; NaN where it is unknown.
pub(crate) struct Assessment {
    pub error: f64,
    pub estimate: Estimate,
}

/// How harmonics are chosen.
pub(crate) struct AdaptivityController {
    tolerance: f64,
    /// Estimates made that were more than a look at contacts that stick.
    pub estimates: usize,
    /// Error and harmonics wanted of the last point.
    last: Option<(f64, usize)>,
    /// Lowest resolution to which the branch may fall, and for how many points more: one above that where a point missed
    /// the tolerance.
    floor: (usize, usize),
    /// The highest resolution so far. The branch falls no further than to half its harmonics.
    highest: usize,
    /// Whether it had a fold. Then it does not fall at all, where something is nonlinear: with fewer harmonics it may
    /// fold elsewhere, and turn round.
    pub folded: bool,
}

impl AdaptivityController {
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

/// A point with as many harmonics as its error asks for, on whose resolution the keeper is.
pub(crate) struct Refined {
    pub point: Point,
    /// Whether it misses the tolerance and was not found with more harmonics, though there are some.
    pub stuck: bool,
}

/// The point with as many harmonics as its error asks for. One that misses the tolerance for all that could be done is
/// returned all the same.
pub(crate) fn refine(
    keeper: &mut dyn Keeper,
    mut point: Point,
    keep_parameter: bool,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Refined> {
    let done = |point| Ok(Refined { point, stuck: false });
    if !keeper.harmonic_levels().is_automatic() {
        return done(point);
    }
    for refinements in 0..=MOST_REFINEMENTS {
        let resolution = keeper.resolution();
        let Some(found) = keeper.assess(&point)? else {
            return done(point);
        };
        let choice = keeper.choice();
        choice.count(&found);
        let accepted = choice.accepts(found.error);
        let wanted = choice.wanted(&found);
        choice.last = accepted.then_some((found.error, wanted));
        if !accepted {
            choice.floor = (resolution + 1, PATIENCE);
        }
        let next = if accepted {
            // What carries nothing is not carried.
            if found.error > 0.0 {
                return done(point);
            }
            keeper.harmonic_levels().resolution_with(wanted)
        } else {
            keeper.harmonic_levels().resolution_with(wanted).max(resolution + 1)
        };
        let last = keeper.harmonic_levels().last();
        let next = next.min(last);
        let may_climb = !accepted && next > resolution && !found.estimate.too_large && refinements < MOST_REFINEMENTS;
        let raised = if accepted && next < resolution {
            select(keeper, (&point, resolution), next, keep_parameter, cancelled)?
        } else if may_climb {
            refine_to(keeper, &point, &found.estimate, next, keep_parameter, cancelled)?
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

/// The point of a resolution from which the next one was stuck, with more harmonics; none where that is not found either.
pub(crate) fn backtrack(
    keeper: &mut dyn Keeper,
    (point, resolution): (&Point, usize),
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<Point>> {
    let to = (resolution.max(keeper.resolution()) + BACKTRACK).min(keeper.harmonic_levels().last());
    select(keeper, (point, resolution), to, true, cancelled)
}

/// Whether a point beside the curve may be kept; if not, the keeper has climbed, and it is to be found again. A fold
/// always may: at its parameter no solution is isolated, and errors there are none of its own.
pub(crate) fn meets_tolerance(keeper: &mut dyn Keeper, kind: SpecialKind, point: &Point) -> Result<bool> {
    if !keeper.harmonic_levels().is_automatic() || kind.is_fold() {
        return Ok(true);
    }
    let resolution = keeper.resolution();
    let Some(found) = keeper.assess(point)? else {
        return Ok(true);
    };
    let choice = keeper.choice();
    choice.count(&found);
    if choice.accepts(found.error) {
        return Ok(true);
    }
    let wanted = choice.wanted(&found);
    let last = keeper.harmonic_levels().last();
    let next = keeper
        .harmonic_levels()
        .resolution_with(wanted)
        .max(resolution + 1)
        .min(last);
    if next <= resolution || found.estimate.too_large {
        return Ok(true);
    }
    keeper.go_to(next)?;
    Ok(false)
}

/// The point stored last with the harmonics with which the branch goes on: where they change, solved once more.
pub(crate) fn coarsen_or_refine(
    keeper: &mut dyn Keeper,
    point: Point,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Point> {
    let resolution = keeper.resolution();
    let choice = keeper.choice();
    let Some((error, wanted)) = choice.last else {
        return Ok(point);
    };
    let share = MARGIN * error / choice.tolerance;
    choice.floor.1 = choice.floor.1.saturating_sub(1);
    choice.highest = choice.highest.max(resolution);
    let (highest, recent) = (choice.highest, choice.floor);
    let mut floor = 0;
    if error > 0.0 && choice.folded {
        floor = resolution;
    } else if error > 0.0 {
        floor = keeper.harmonic_levels().resolution_of_half(highest);
        if recent.1 > 0 {
            floor = floor.max(recent.0);
        }
    }
    let last = keeper.harmonic_levels().last();
    let next = keeper.harmonic_levels().resolution_with(wanted).max(floor).min(last);
    if !((share > RAISE && next > resolution) || (share < DROP && next < resolution)) {
        return Ok(point);
    }
    // At its parameter, so that nothing lies between the point stored and the one that the branch goes on from.
    let Some(found) = select(keeper, (&point, resolution), next, true, cancelled)? else {
        return Ok(point);
    };
    let before = keeper.transfer(&point, resolution)?;
    let tolerance = keeper.choice().tolerance;
    if (found.amplitude - before.amplitude).norm() > tolerance * before.amplitude.norm() {
        // Fewer harmonics than thought would do, as near a fold.
        keeper.go_to(resolution)?;
        return Ok(point);
    }
    Ok(found)
}

/// Solves near a point of a resolution with the harmonics of another one; the keeper stays where it is if that fails.
fn select(
    keeper: &mut dyn Keeper,
    (point, resolution): (&Point, usize),
    to: usize,
    keep_parameter: bool,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<Point>> {
    let from = keeper.resolution();
    keeper.go_to(to)?;
    let start = keeper.transfer(point, resolution)?;
    let found = keeper.resolve(&start, keep_parameter, cancelled)?;
    if found.is_none() {
        keeper.go_to(from)?;
    }
    Ok(found)
}

/// Solves with the harmonics of a higher resolution, from the corrected solution or resolution by resolution; the keeper stays where
/// it is if both fail.
fn refine_to(
    keeper: &mut dyn Keeper,
    point: &Point,
    estimate: &Estimate,
    to: usize,
    keep_parameter: bool,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<Point>> {
    let from = keeper.resolution();
    keeper.go_to(to)?;
    if estimate.certified {
        // Where the plane across the branch has no solution near, a fixed parameter may have one.
        for fixed in [keep_parameter, true] {
            let start = keeper.corrected(point, from, estimate)?;
            if let Some(found) = keeper.resolve(&start, fixed, cancelled)? {
                return Ok(Some(found));
            }
        }
    }
    let mut reached = point.try_clone()?;
    for resolution in from + 1..=to {
        keeper.go_to(resolution)?;
        let start = keeper.transfer(&reached, resolution - 1)?;
        match keeper.resolve(&start, keep_parameter, cancelled)? {
            Some(found) => reached = found,
            None if resolution == from + 1 => {
                keeper.go_to(from)?;
                return Ok(None);
            }
            None => {
                keeper.go_to(resolution - 1)?;
                break;
            }
        }
    }
    Ok(Some(reached))
}
