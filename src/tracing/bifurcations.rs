//! Bifurcations between two neighbours of the curve: where a Floquet multiplier passes the unit circle.
//!
//! The number of multipliers outside the unit circle is compared at both neighbours. If k of them lie outside at one
//! and m > k at the other, then ln |μ| of those numbered k + 1 … m by falling modulus has a root between them, whatever
//! multipliers these are. Where the branch turns in between, positive real multipliers are not counted: the one that
//! passes 1 belongs to the fold.

use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::{Point, PointAt};
use crate::error::{Result, try_push};
use crate::harmonics::discretised::Traceable;
use crate::results::{BifurcationKind, SpecialKind, Verdict};
use crate::roots::Bracket;
use crate::tracing::course::BranchTracer;
use num_complex::Complex64;

/// Largest number of evaluations of one search, each with the multipliers of a motion.
/// Kind: cap.
const BIFURCATIONS_MAX_EVALUATIONS: usize = 40;

/// Width of the bracket, as a share of the step, and distance ln |μ| from the unit circle at which a search ends.
/// Kind: rounding.
const BIFURCATIONS_WIDTH: f64 = 1e-10;
const ON_CIRCLE: f64 = 1e-10;

/// Distance ln |μ| from the unit circle above which the multiplier does not pass it, but jumps over it: where slip
/// sets in, for example.
/// Kind: tuned; measured on: not recorded.
const JUMP: f64 = 1e-5;

/// Distance ln |μ| from the unit circle below which a root is interpolated where the motion in time is not found: next to
/// a branch point it is one of several that differ little.
/// Kind: tuned; measured on: not recorded.
const BIFURCATIONS_NEAR: f64 = 1e-2;

/// A multiplier's passage through the unit circle between two points.
struct Passage {
    /// Position on the arc, as a share of its length.
    at: f64,
    point: Point,
    multiplier: Complex64,
}

/// An arc without a fold inside, with the stability at its ends.
struct Arc<'p> {
    ends: (&'p Point, &'p Point),
    verdicts: (&'p Verdict, &'p Verdict),
    without_positive: bool,
}

impl Arc<'_> {
    /// Number of multipliers outside the unit circle at each end; `None` where one is not known.
    fn counts(&self) -> Option<(usize, usize)> {
        let count = |verdict: &Verdict| {
            let all = verdict.unstable?;
            Some(if self.without_positive {
                verdict.oscillating()
            } else {
                all
            })
        };
        Some((count(self.verdicts.0)?, count(self.verdicts.1)?))
    }
}

/// Locates and records the bifurcations, folds apart, between the last two recorded points of the curve.
pub(super) fn find_bifurcations(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: PointAt<'_>,
    b: PointAt<'_>,
    fold: Option<PointAt<'_>>,
) -> Result<()> {
    let Some((before, after)) = analysis.take_verdicts() else {
        return Ok(());
    };
    let level = analysis.resolution();
    let (a, b) = (analysis.transfer(a.0, a.1)?, analysis.transfer(b.0, b.1)?);
    let whole = Arc {
        ends: (&a, &b),
        verdicts: (&before, &after),
        without_positive: fold.is_some(),
    };
    let Some((from, to)) = whole.counts().filter(|(from, to)| from != to) else {
        return Ok(());
    };
    let mut found = Vec::new();
    if let Some((fold, resolution)) = fold {
        let fold = analysis.transfer(fold, resolution)?;
        let Some(between) = analysis.verdict(&fold)? else {
            return Ok(());
        };
        for (ends, verdicts) in [((&a, &fold), (&before, &between)), ((&fold, &b), (&between, &after))] {
            let arc = Arc {
                ends,
                verdicts,
                without_positive: true,
            };
            passages(tracer, analysis, &arc, &mut found)?;
        }
    } else {
        passages(tracer, analysis, &whole, &mut found)?;
    }
    let mut count = before.unstable.unwrap_or(from);
    for passage in &found {
        let step = if passage.multiplier.im == 0.0 { 1 } else { 2 };
        let next = if to > from {
            count + step
        } else {
            count.saturating_sub(step)
        };
        let kind = SpecialKind::Bifurcation(BifurcationKind::of(passage.multiplier), [Some(count), Some(next)]);
        analysis.select(level)?;
        tracer.record_special_as_it_is(analysis, kind, &passage.point)?;
        count = next;
    }
    Ok(())
}

/// Records the folds that a branch passed before it came back into its range, located between pairs of neighbours
/// with the given resolution, if stability was requested. The last point of the curve is the one where it came back.
pub(super) fn record_turns_outside(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    turns: &[(Point, Point)],
    resolution: usize,
) -> Result<()> {
    let Some((before, after)) = analysis.take_verdicts() else {
        return Ok(());
    };
    let level = analysis.resolution();
    let mut count = before.unstable;
    for (i, (a, b)) in turns.iter().enumerate() {
        analysis.select(resolution)?;
        let next = if i + 1 == turns.len() {
            after.unstable
        } else {
            analysis.verdict(b)?.and_then(|verdict| verdict.unstable)
        };
        let mut locator = Locator::new(a.unknowns().len(), tracer.course.settings)?;
        let fold = locator.locate(analysis.problem(), SpecialPoint::Fold, a, b, tracer.interrupt)?;
        if let Some(fold) = fold {
            let kind = SpecialKind::Bifurcation(BifurcationKind::Fold, [count, next]);
            tracer.record_special_as_it_is(analysis, kind, &fold)?;
        }
        count = next;
    }
    analysis.select(level)
}

/// Appends the passages through the unit circle on an arc, in the order of the arc.
fn passages(
    tracer: &BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    arc: &Arc<'_>,
    found: &mut Vec<Passage>,
) -> Result<()> {
    let Some((from, to)) = arc.counts() else {
        return Ok(());
    };
    let first = found.len();
    let mut order = from.min(to);
    while order < from.max(to) {
        order += 1;
        let Some(mut passage) = passage(tracer, analysis, arc, order - 1)? else {
            continue;
        };
        let kind = BifurcationKind::of(passage.multiplier);
        if kind == BifurcationKind::NeimarkSacker {
            // Its conjugate passes with it.
            order += 1;
        } else {
            passage.multiplier.im = 0.0;
        }
        let place = found[first..].partition_point(|other| other.at < passage.at);
        try_push(found, passage, "the bifurcations")?;
        found[first + place..].rotate_right(1);
    }
    Ok(())
}

/// Position on the arc where the multiplier numbered `order`, by falling modulus, passes the unit circle.
fn passage(
    tracer: &BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    arc: &Arc<'_>,
    order: usize,
) -> Result<Option<Passage>> {
    let value = |verdict: &Verdict| verdict.growth(order, arc.without_positive);
    let (from, to) = (value(arc.verdicts.0).0, value(arc.verdicts.1).0);
    let mut bracket = Bracket::new(from, to);
    let mut in_time = Bracket::new(from, to);
    let mut ends = [arc.verdicts.0, arc.verdicts.1].map(|v| (value(v), v.in_time));
    let mut locator = Locator::new(arc.ends.0.unknowns().len(), tracer.course.settings)?;
    let mut best: Option<(f64, Passage)> = None;
    for _ in 0..BIFURCATIONS_MAX_EVALUATIONS {
        let at = bracket.guess();
        let Some(point) = locator.between(analysis.problem(), arc.ends, at, tracer.interrupt)? else {
            break;
        };
        let Some(verdict) = analysis.verdict(&point)?.filter(|v| v.unstable.is_some()) else {
            break;
        };
        let (growth, multiplier) = value(&verdict);
        if verdict.in_time {
            in_time.narrow(at, growth);
            let end = usize::from((growth > 0.0) == (to > 0.0));
            ends[end] = ((growth, multiplier), true);
        } else if ends
            .iter()
            .all(|((growth, _), in_time)| *in_time && growth.abs() < BIFURCATIONS_NEAR)
        {
            let at = in_time.guess();
            let [low, high] = ends.map(|((growth, multiplier), _)| (growth.abs(), multiplier));
            let multiplier = if low.0 < high.0 { low.1 } else { high.1 };
            let point = locator.between(analysis.problem(), arc.ends, at, tracer.interrupt)?;
            return Ok(point.map(|point| Passage { at, point, multiplier }));
        }
        if best.as_ref().is_none_or(|(least, _)| growth.abs() < *least) {
            best = Some((growth.abs(), Passage { at, point, multiplier }));
        }
        if growth.abs() < ON_CIRCLE
            || bracket.width() < BIFURCATIONS_WIDTH
            || bracket.narrow(at, growth) < BIFURCATIONS_WIDTH
        {
            break;
        }
    }
    Ok(best.filter(|(least, _)| *least < JUMP).map(|(_, passage)| passage))
}
