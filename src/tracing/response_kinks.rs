//! Kinks of a peak or a range over the period: another instant takes the lead, and the slope of the measure jumps.
//!
//! With the leading instant τ and its change τ′ along the branch known at both ends of an arc, a jump is what a smooth motion
//! leaves unexplained. The kink lies where the parabolas of the measure from both sides meet; solutions there decide which side they
//! are on, until both sides are next to each other. The last solution of each is recorded: their slopes are those of both sides.

use crate::continuation::special_points::Locator;
use crate::continuation::{Metric, Point, PointAt};
use crate::error::{Result, try_copy, try_push};
use crate::harmonics::discretised::Traceable;
use crate::linalg::norm;
use crate::problem::gauges::Seen;
use crate::results::SpecialKind;
use crate::roots::root;
use crate::tracing::course::BranchTracer;
use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

const CONTEXT: &str = "the kinks of a response";

/// Smallest unexplained change of an instant that may be a jump.
/// Kind: tuned; measured on: not recorded.
const INSTANT_JUMP: f64 = 0.1;

/// Distance of the two sides of a kink, over the arc, at which they are next to each other.
/// Kind: rounding.
const NEXT_TO: f64 = 1e-8;

/// Smallest jump of the slope over the slopes: below it two instants that lead together are images of each other.
/// Kind: rounding.
const SLOPES_DIFFER: f64 = 1e-5;

/// Share of the arc below which a slope that changes in proportion to the share, times this factor, has no jump.
/// Kind: tuned; measured on: not recorded.
const WITHOUT_JUMP: (f64, f64) = (1e-5, 3.0);

/// Distance from the place where two parabolas meet to the far side, over the change of that place and at most over the gap, and
/// halvings in search of it.
/// Kind: tuned; measured on: not recorded.
const BESIDE_MEETING: f64 = 10.0;
const MOST_AWAY: f64 = 0.3;
/// Least distance of two solutions over the gap that tell how a slope changes.
/// Kind: tuned; measured on: not recorded.
const TELLS_BEND: f64 = 0.1;

/// Most solutions in search of a kink, and most kinks of an arc.
/// Kind: cap.
const MOST_PLACES: usize = 40;
const MOST_KINKS: usize = 4;

/// A function that solves at a share of an arc; its result is `None` where there is no solution.
type Between<'f, T> = dyn Fn(&mut T, &mut dyn Traceable, f64) -> Result<Option<Side>> + 'f;

/// A solution on an arc, as one response sees it.
struct Side {
    /// Share of the arc, for which it is solved; and share of the chord, of which the measure is a function.
    s: f64,
    t: f64,
    point: Point,
    seen: Seen,
    /// Factor from slopes along the tangent to slopes over the share of the chord.
    unit: f64,
}

impl Side {
    fn slope(&self) -> f64 {
        self.seen.slope * self.unit
    }

    /// Change of an instant towards another solution that a smooth motion between them does not explain, at most π.
    fn mismatch(&self, other: &Side, which: usize) -> f64 {
        let rate = 0.5 * (self.seen.instant_rates[which] * self.unit + other.seen.instant_rates[which] * other.unit);
        let change = other.seen.instants[which] - self.seen.instants[which] - rate * (other.t - self.t);
        ((change + PI).rem_euclid(TAU) - PI).abs()
    }

    fn jumps(&self, other: &Side) -> Option<usize> {
        (0..2).find(|which| self.mismatch(other, *which) > INSTANT_JUMP)
    }
}

/// The measure near one side of a kink: the parabola through two solutions.
struct Parabola {
    t: f64,
    value: f64,
    slope: f64,
    bend: f64,
}

impl Parabola {
    fn new(side: &Side, other: &Side) -> Self {
        let distance = side.t - other.t;
        let bend = (side.slope() - other.slope()) / distance;
        Self {
            t: side.t,
            value: side.seen.reading.value,
            slope: side.slope(),
            bend: if distance == 0.0 { 0.0 } else { bend },
        }
    }

    fn at(&self, t: f64) -> f64 {
        let away = t - self.t;
        self.value + (self.slope + 0.5 * self.bend * away) * away
    }
}

/// Share of the chord between `low` and `high` where the two parabolas are equal, or the end next to it.
fn meeting(sides: &(Parabola, Parabola), (low, high): (f64, f64)) -> f64 {
    let leads = |t: f64| sides.0.at(t) - sides.1.at(t);
    if leads(high) >= 0.0 {
        return high;
    }
    let ends = ((low, leads(low)), (high, leads(high)));
    root(ends.0, ends.1, |t| Ok::<_, Infallible>(leads(t))).unwrap_or(low)
}

/// Records the kinks of all responses between two neighbouring points.
pub(super) fn find_kinks_of_responses(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: PointAt<'_>,
    b: PointAt<'_>,
) -> Result<()> {
    let highest = a.1.max(b.1);
    for response in 0..analysis.responses() {
        if analysis.reading_of(response, a)?.is_none() {
            continue;
        }
        analysis.select(highest)?;
        let arc = (analysis.transfer(a.0, a.1)?, analysis.transfer(b.0, b.1)?);
        let size = norm(arc.0.unknowns()).max(norm(arc.1.unknowns()));
        let metric = Metric::along(size, &tracer.course.settings);
        let mut chord = try_copy(&arc.1.v, CONTEXT)?;
        for (x, from) in chord.iter_mut().zip(&arc.0.v) {
            *x -= from;
        }
        let square = metric.dot(&chord, &chord);
        let side = |analysis: &mut dyn Traceable, point: &Point, at: PointAt<'_>, s: f64| -> Result<Option<Side>> {
            let Some(seen) = analysis.reading_of(response, at)? else {
                return Ok(None);
            };
            let unit = square / metric.dot(&point.tangent, &chord);
            if !(unit > 0.0 && unit.is_finite()) {
                return Ok(None);
            }
            let along = metric.dot(&point.v, &chord) - metric.dot(&arc.0.v, &chord);
            Ok(Some(Side {
                s,
                t: along / square,
                point: point.try_clone()?,
                seen,
                unit,
            }))
        };
        let ends = (side(analysis, &arc.0, a, 0.0)?, side(analysis, &arc.1, b, 1.0)?);
        let (Some(mut low), Some(high)) = ends else { continue };
        for _ in 0..MOST_KINKS {
            let Some(which) = low.jumps(&high) else { break };
            analysis.select(highest)?;
            let between = |tracer: &mut BranchTracer, analysis: &mut dyn Traceable, s: f64| -> Result<Option<Side>> {
                let locator = Locator::new(arc.0.unknowns().len(), tracer.course.settings)?;
                let mut locator = locator.with_response(Some(response));
                let ends = (&arc.0, &arc.1);
                let Some(point) = locator.between(analysis.problem(), ends, s, tracer.interrupt)? else {
                    return Ok(None);
                };
                side(analysis, &point, (&point, highest), s)
            };
            let Some(after) = find_kink(tracer, analysis, response, (&low, &high, which), &between)? else {
                break;
            };
            low = after;
        }
    }
    Ok(())
}

/// Records the first kink between two solutions, where an instant jumps; returns the solution after it.
fn find_kink<'s, 't>(
    tracer: &mut BranchTracer<'t>,
    analysis: &mut dyn Traceable,
    response: usize,
    (low, high, which): (&'s Side, &'s Side, usize),
    between: &Between<'_, BranchTracer<'t>>,
) -> Result<Option<Side>> {
    let mut sides = Vec::new();
    let (mut before, mut after, mut expected) = (low, high, f64::INFINITY);
    // Both sides are kept with their places among those that were found.
    for _ in 0..MOST_PLACES {
        let gap = after.t - before.t;
        if gap <= 2.0 * NEXT_TO {
            break;
        }
        let tangents = before.slope() - after.slope();
        if gap < WITHOUT_JUMP.0 && tangents.abs() <= WITHOUT_JUMP.1 * gap * (high.slope() - low.slope()).abs() {
            return Ok(None);
        }
        // A solution too near to another one tells rounding of how the slope changes.
        let other = |side: &Side, wanted: bool, end: &'s Side| {
            let own = sides.iter().filter(|(_, is)| *is == wanted).map(|(side, _)| side);
            let apart = own.filter(|other: &&Side| (other.t - side.t).abs() >= TELLS_BEND * gap);
            let distance = |other: &&Side| (other.t - side.t).abs();
            apart.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(end)
        };
        let parabolas = (
            Parabola::new(before, other(before, true, low)),
            Parabola::new(after, other(after, false, high)),
        );
        // Again on one side: the other one is brought as near as the place is known, and less near each time.
        let meeting = meeting(&parabolas, (before.t, after.t));
        let own = sides.last().is_some_and(|(_, is_before)| *is_before);
        let again = sides
            .iter()
            .rev()
            .take_while(|(_, is_before)| *is_before == own)
            .count();
        let away = (BESIDE_MEETING * (meeting - expected).abs()).max(NEXT_TO) * BESIDE_MEETING.powi(again as i32 - 2);
        expected = meeting;
        let beyond = if again < 2 {
            0.0
        } else {
            away.min(MOST_AWAY * gap) * if own { 1.0 } else { -1.0 }
        };
        let (first, last) = (before.t + 0.5 * NEXT_TO, after.t - 0.5 * NEXT_TO);
        let share = ((meeting + beyond).clamp(first, last) - before.t) / gap;
        let s = before.s + share * (after.s - before.s);
        let Some(found) = between(tracer, analysis, s)? else {
            return Ok(None);
        };
        // Where a third instant leads between them, the first of two kinks is sought.
        let (to_before, to_after) = (before.mismatch(&found, which), after.mismatch(&found, which));
        let is_before = to_before <= to_after && to_before <= INSTANT_JUMP;
        try_push(&mut sides, (found, is_before), CONTEXT)?;
        let of = |wanted: bool| sides.iter().filter(move |(_, is)| *is == wanted).map(|(side, _)| side);
        before = of(true).max_by(|a, b| a.t.total_cmp(&b.t)).unwrap_or(low);
        after = of(false).min_by(|a, b| a.t.total_cmp(&b.t)).unwrap_or(high);
    }
    let (slopes, gap) = ((before.slope(), after.slope()), after.t - before.t);
    let differ = (slopes.1 - slopes.0).abs() > SLOPES_DIFFER * slopes.0.abs().max(slopes.1.abs());
    if gap > 2.0 * NEXT_TO || !differ {
        return Ok(None);
    }
    for side in [before, after] {
        tracer.record_special_as_it_is(analysis, SpecialKind::KinkOf(response), &side.point)?;
    }
    Ok(Some(Side {
        s: after.s,
        t: after.t,
        point: after.point.try_clone()?,
        seen: after.seen,
        unit: after.unit,
    }))
}
