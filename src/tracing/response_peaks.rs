//! Peaks of responses between two neighbours of a branch.
//!
//! The steps follow the motion, not each response: any of them may have a maximum and a minimum within a step. The cubic
//! through the response at both ends and its derivatives tells where to look; solutions there decide.

use crate::continuation::special_points::{Locator, SpecialPoint};
use crate::continuation::{Metric, Point, PointAt};
use crate::error::{Error, Result, try_push};
use crate::harmonics::discretised::Traceable;
use crate::linalg::norm;
use crate::results::SpecialKind;
use crate::tracing::course::BranchTracer;
use num_complex::Complex64;

const CONTEXT: &str = "the peaks of a response";

/// Solutions that are kept for the arc that follows.
/// Kind: tuned; measured on: not recorded.
const NODES_BEFORE: usize = 3;

/// Parts of the cubic in which changes of sign are sought.
/// Kind: tuned; measured on: not recorded.
const PARTS_OF_ARC: usize = 16;

/// Largest relative distance of two solutions that are one.
/// Kind: rounding.
const SAME_SOLUTION: f64 = 1e-11;

/// Records the peaks of the observed response between two neighbours.
pub(super) fn find_peaks_between(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: PointAt<'_>,
    b: PointAt<'_>,
) -> Result<()> {
    let resolution = analysis.resolution();
    let moved;
    let (first, last) = if a.1 == resolution && b.1 == resolution {
        (a.0, b.0)
    } else {
        moved = (analysis.transfer(a.0, a.1)?, analysis.transfer(b.0, b.1)?);
        (&moved.0, &moved.1)
    };
    let brackets = predicted_brackets(tracer, first, last)?;
    if SpecialPoint::Peak.between(a.0, b.0) && brackets.len() <= 1 {
        return find_peak_on_arc(tracer, analysis, SpecialKind::Peak, a, b).map(|_| ());
    }
    let found = find_peaks_within(
        tracer,
        analysis,
        SpecialKind::Peak,
        ((first, last), resolution),
        brackets,
    )?;
    // A response that turns by half a circle within the arc is no cubic: its maximum need not lie where that has them.
    if !found && SpecialPoint::Peak.between(a.0, b.0) {
        find_peak_on_arc(tracer, analysis, SpecialKind::Peak, a, b)?;
    }
    Ok(())
}

/// Records the peaks of one kind on parts of an arc, by solutions within them; returns whether a peak was found.
fn find_peaks_within(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    (ends, resolution): ((&Point, &Point), usize),
    brackets: Vec<(f64, f64)>,
) -> Result<bool> {
    let mut any = false;
    for (low, high) in brackets {
        analysis.select(resolution)?;
        let solved = [low, high].map(|s| solved_between(tracer, analysis, kind, ends, s));
        let [low, high] = solved;
        let (Some(low), Some(high)) = (low?, high?) else {
            continue;
        };
        if SpecialPoint::Peak.between(&low, &high) {
            let found = find_peak_on_arc(tracer, analysis, kind, (&low, resolution), (&high, resolution))?;
            any |= found.is_some();
        }
    }
    Ok(any)
}

/// Records the peaks of all further responses between two neighbours. Each peak found divides the arc for the
/// next responses: those of a structure have their peaks near each other.
pub(super) fn find_peaks_of_responses(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: PointAt<'_>,
    b: PointAt<'_>,
) -> Result<()> {
    if analysis.further_responses().is_empty() {
        return Ok(());
    }
    analysis.select(a.1.max(b.1))?;
    let resolution = analysis.resolution();
    // Solutions along the arc in their order, each with its resolution, behind those that lead to it.
    let mut arc = core::mem::take(&mut tracer.before_arc);
    let is_next = arc.last().is_some_and(|(point, of)| *of == a.1 && point.v == a.0.v);
    if !is_next {
        arc.clear();
        try_push(&mut arc, (a.0.try_clone()?, a.1), CONTEXT)?;
    }
    let start = arc.len() - 1;
    try_push(&mut arc, (b.0.try_clone()?, b.1), CONTEXT)?;
    let mut locator = None;
    for response in analysis.further_responses() {
        let mut k = start;
        // A solution is read once: its slope may be rounding, and have another sign when it is read again.
        analysis.select(resolution)?;
        let mut first = seen_here(analysis, response, &arc[start])?;
        while k + 1 < arc.len() {
            k += 1;
            analysis.select(resolution)?;
            let last = seen_here(analysis, response, &arc[k])?;
            let ends = (&first, &last);
            let found = find_peaks_of(tracer, analysis, response, (&arc, k), ends, &mut locator)?;
            first = last;
            if let Some(found) = found {
                arc.try_reserve(1).map_err(|_| Error::out_of_memory(CONTEXT))?;
                arc.insert(k, found);
                k += 1;
            }
        }
    }
    arc.drain(..arc.len().saturating_sub(NODES_BEFORE));
    tracer.before_arc = arc;
    Ok(())
}

/// Records the peaks of a further response between the solution `next` of an arc and the one before it, in the
/// current harmonics. Returns the peak, if there is exactly one and it has these harmonics.
fn find_peaks_of(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    response: usize,
    (arc, next): (&[(Point, usize)], usize),
    (first, last): (&Point, &Point),
    locator: &mut Option<Locator>,
) -> Result<Option<(Point, usize)>> {
    let resolution = analysis.resolution();
    let brackets = predicted_brackets(tracer, first, last)?;
    let kind = SpecialKind::PeakOf(response);
    // Responses with one peak, as those of equal blades, divide the arc at the same place; no search succeeds between two such.
    if SpecialPoint::Peak.between(first, last) && are_one(first, last) {
        let point = if SpecialPoint::Peak.function(first, 1.0).abs() < SpecialPoint::Peak.function(last, 1.0).abs() {
            first
        } else {
            last
        };
        tracer.record_special(analysis, kind, point)?;
        return Ok(None);
    }
    if SpecialPoint::Peak.between(first, last) && brackets.len() <= 1 {
        // Nodes beyond the two have the harmonics of the arc.
        let (mut nodes, mut place) = (Vec::new(), 0);
        for (i, one) in arc.iter().enumerate() {
            if i == next - 1 {
                place = nodes.len();
            }
            if i == next - 1 || i == next || one.1 == resolution {
                try_push(&mut nodes, seen_here(analysis, response, one)?, CONTEXT)?;
            }
        }
        // One serves all peaks of an arc: it has the memory of a matrix.
        let known = match locator.take() {
            Some(known) => known,
            None => Locator::new(first.unknowns().len(), tracer.course.settings)?,
        };
        let locator = locator.insert(known.with_response(Some(response)));
        let found = locator.peak_on(analysis.problem(), &mut nodes, (place, place + 1), tracer.interrupt)?;
        if let Some(point) = found
            && tracer.record_special(analysis, kind, &point)?
        {
            return Ok(Some((point, resolution)));
        }
        return find_peak_on_arc(tracer, analysis, kind, (first, resolution), (last, resolution));
    }
    if !find_peaks_within(tracer, analysis, kind, ((first, last), resolution), brackets)?
        && SpecialPoint::Peak.between(first, last)
    {
        return find_peak_on_arc(tracer, analysis, kind, (first, resolution), (last, resolution));
    }
    Ok(None)
}

/// The solution at a share of an arc as a response sees it; at shares 0 and 1 the ends are returned as they are.
fn solved_between(
    tracer: &BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    (a, b): (&Point, &Point),
    s: f64,
) -> Result<Option<Point>> {
    for (end, at) in [(a, 0.0), (b, 1.0)] {
        if s.to_bits() == f64::to_bits(at) {
            return end.try_clone().map(Some);
        }
    }
    let locator = Locator::new(a.unknowns().len(), tracer.course.settings)?;
    let mut locator = locator.with_response(kind.response());
    locator.between(analysis.problem(), (a, b), s, tracer.interrupt)
}

fn find_peak_on_arc(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    a: PointAt<'_>,
    b: PointAt<'_>,
) -> Result<Option<(Point, usize)>> {
    let interrupt = tracer.interrupt;
    tracer.find(analysis, kind, a, b, |locator, problem, a, b| {
        locator.locate(problem, SpecialPoint::Peak, a, b, interrupt)
    })
}

/// Brackets, as shares of the arc, in which the cubic has a maximum.
fn predicted_brackets(tracer: &BranchTracer<'_>, a: &Point, b: &Point) -> Result<Vec<(f64, f64)>> {
    let mut found = Vec::new();
    let size = norm(a.unknowns()).max(norm(b.unknowns()));
    let metric = Metric::along(size, &tracer.course.settings);
    let width = metric.distance(&a.v, &b.v);
    let slopes = [a, b].map(|p| p.slope * (width / metric.norm(&p.tangent)));
    let difference = b.amplitude - a.amplitude;
    let (c2, c3) = (
        difference * 3.0 - slopes[0] * 2.0 - slopes[1],
        slopes[0] + slopes[1] - difference * 2.0,
    );
    let (c0, c1) = (a.amplitude, slopes[0]);
    let product = |x: Complex64, y: Complex64| x.re * y.re + x.im * y.im;
    // Re z̄ z′ as a polynomial of s. Where its first coefficient outweighs the others it keeps its sign.
    let first = product(c0, c1);
    let others = [
        product(c1, c1) + 2.0 * product(c0, c2),
        3.0 * (product(c0, c3) + product(c1, c2)),
        4.0 * product(c1, c3) + 2.0 * product(c2, c2),
        5.0 * product(c2, c3),
        3.0 * product(c3, c3),
    ];
    if first.abs() > others.iter().map(|c| c.abs()).sum::<f64>() {
        return Ok(found);
    }
    let growth = |s: f64| others.iter().rev().fold(0.0, |sum, c| (sum + c) * s) + first;
    let mut before = (0.0, first);
    for part in 1..=PARTS_OF_ARC {
        let s = part as f64 / PARTS_OF_ARC as f64;
        let here = (s, growth(s));
        if before.1 > 0.0 && here.1 <= 0.0 {
            try_push(&mut found, (before.0, here.0), CONTEXT)?;
        }
        before = here;
    }
    Ok(found)
}

/// Whether two solutions differ by rounding.
fn are_one(a: &Point, b: &Point) -> bool {
    let (size, distance) =
        a.v.iter()
            .zip(&b.v)
            .fold((0.0_f64, 0.0_f64), |(size, distance), (a, b)| {
                (size + a * a, distance + (a - b).powi(2))
            });
    let apart = (a.parameter() - b.parameter()).abs();
    distance.sqrt() <= SAME_SOLUTION * size.sqrt() && apart <= SAME_SOLUTION * a.parameter().abs()
}

/// A solution of another resolution, transferred to the current harmonics, as a response sees it.
fn seen_here(analysis: &mut dyn Traceable, response: usize, (point, of): &(Point, usize)) -> Result<Point> {
    let seen = analysis.seen_by(response, (point, *of))?;
    analysis.transfer(&seen, *of)
}
