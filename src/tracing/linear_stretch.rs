//! Stretches of a branch on which every contact is linear: the response is a rational function of the parameter, and is
//! solved at given values of it, without a step length.
//!
//! The values are placed by the resonances, see [`LinearGrid`]; peaks are the roots of the exact derivative of the
//! amplitude between them. A stretch ends where a contact leaves its linear state, which is located to rounding, or at
//! the end of the range.

use crate::continuation::special_points::SpecialPoint;
use crate::continuation::{Point, PointAt};
use crate::error::{Result, Status, try_push};
use crate::harmonics::discretised::Traceable;
use crate::hooks::{Hooks, LogLevel};
use crate::linalg::norm;
use crate::options::Range;
use crate::results::SpecialKind;
use crate::roots::{Bracket, least};
use crate::tracing::course::{BranchTracer, Stretch, some_unless_lost};
use crate::tracing::resonance_grid::LinearGrid;
use crate::tracing::response_kinks;

/// Outcome of the part of a stretch from a point to the next value.
enum Next {
    Reached(Point),
    /// The last point with linear contacts, and a parameter value beyond it at which some contact is not linear.
    Onset(Point, f64),
}

/// Share of its linear range above which the motion of a contact may have a maximum beyond it between two values.
/// Kind: tuned; measured on: not recorded.
const LINEAR_STRETCH_NEARLY: f64 = 0.7;

/// Width, over the distance of the two values, at which the place of such a maximum is found.
/// Kind: tuned; measured on: not recorded.
const FOUND_SHARE: f64 = 5e-4;

/// Relative width of an interval that is rounding.
/// Kind: rounding.
const LINEAR_STRETCH_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Parts of the cubic between two neighbours in which peaks are searched.
/// Kind: tuned; measured on: not recorded.
const PARTS: usize = 8;

/// Relative change of the amplitude over the distance of two neighbours whose sign the cubic does not tell for certain.
/// Kind: tuned; measured on: not recorded.
const UNCERTAIN: f64 = 0.05;

/// Largest number of evaluations of a root search.
/// Kind: cap.
const LINEAR_STRETCH_MAX_EVALUATIONS: usize = 100;

/// Relative distance from an undamped resonance at which its part of the motion dominates, however small its force.
/// Kind: rounding.
const BESIDE_UNDAMPED: f64 = 1e-8;

/// Ratio of a motion there to those at the neighbours, 4e-5 and more away, that nothing but a pole makes.
/// Kind: tuned; measured on: undamped oscillators, chains, sectors, and dampers at nodes of modes.
const FAR_LARGER: f64 = 10.0;

const CONTEXT: &str = "the linear response";

/// Follows the branch from the point recorded last, at which every contact is linear. `None` if the analysis has
/// no linear response.
// Out of line: its points do not lie on the stack under a step.
#[inline(never)]
pub(super) fn follow_linear(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    (from, resolution): PointAt<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Option<Stretch>> {
    make_grid(tracer, analysis, hooks)?;
    let settings = tracer.course.settings;
    // Between points of a linear response only the parameter counts.
    let most = settings
        .steps
        .bound()
        .map_or(f64::INFINITY, |bound| bound * (settings.end - settings.start).abs());
    let rising = from.tangent[from.tangent.len() - 1] > 0.0;
    let mut here = analysis.transfer(from, resolution)?;
    loop {
        if analysis.branch().points() >= tracer.course.max_points {
            return Ok(Some(Stretch::Stopped(Status::StoppedMaxPoints)));
        }
        tracer.interrupt.check()?;
        let Some(grid) = &tracer.linear_grid else {
            return Ok(None);
        };
        let Some(value) = grid.after(here.parameter(), rising, most) else {
            return Ok(None);
        };
        let (point, onset) = match next_linear(tracer, analysis, &here, value)? {
            Next::Reached(point) => (point, None),
            Next::Onset(point, beyond) => {
                let distance = (beyond - point.parameter()).abs();
                (point, Some(distance))
            }
        };
        let end = [settings.end, settings.start]
            .into_iter()
            .find(|bound| bound.to_bits() == point.parameter().to_bits());
        let moved = point.parameter().to_bits() != here.parameter().to_bits();
        if moved {
            if some_unless_lost(analysis.record(&point))?.is_none() {
                return Ok(Some(Stretch::Stopped(Status::StoppedStepTooSmall)));
            }
            let stop = tracer.report(analysis, hooks, &point);
            find_on_line(tracer, analysis, &here, &point, end.is_some(), hooks)?;
            if stop {
                return Ok(Some(Stretch::Stopped(Status::StoppedByCaller)));
            }
        }
        if let Some(distance) = onset {
            return Ok(Some(Stretch::Onset {
                before: moved.then_some(here),
                point,
                distance,
            }));
        }
        if let Some(bound) = end {
            let status = if bound.to_bits() == settings.end.to_bits() {
                Status::Ok
            } else {
                Status::StoppedLeftRange
            };
            return Ok(Some(Stretch::End(point, status)));
        }
        here = point;
    }
}

/// Computes the parameter values for all stretches of a branch, once.
fn make_grid(tracer: &mut BranchTracer<'_>, analysis: &mut dyn Traceable, hooks: &mut Hooks<'_>) -> Result<()> {
    if tracer.grid_requested {
        return Ok(());
    }
    tracer.grid_requested = true;
    let settings = tracer.course.settings;
    let range = Range::new(settings.start.min(settings.end), settings.start.max(settings.end));
    let Some(resonances) = analysis.resonances(range)? else {
        let reason = "natural frequencies are not known: linear contacts are followed like nonlinear ones";
        hooks.log(LogLevel::Info, reason);
        return Ok(());
    };
    tracer.linear_grid = Some(LinearGrid::new(&resonances, range)?);
    Ok(())
}

/// The linear response at `value`, or the last point before it at which every contact is linear.
fn next_linear(tracer: &BranchTracer<'_>, analysis: &mut dyn Traceable, here: &Point, value: f64) -> Result<Next> {
    let Some(point) = analysis.linear_at(here, value, tracer.interrupt)? else {
        return onset(tracer, analysis, here, value);
    };
    let shares = [here, &point].map(|p| analysis.linear_share(p));
    let [before, after] = shares;
    let largest = before?.max(after?);
    if largest.is_nan() || largest <= LINEAR_STRETCH_NEARLY {
        return Ok(Next::Reached(point));
    }
    // The share may have a maximum above 1 between two values.
    let here_at = here.parameter();
    let range = [here_at.min(value), here_at.max(value)];
    let mut beyond = None;
    let found = least(range, FOUND_SHARE * (range[1] - range[0]), |at| {
        match share_at(tracer, analysis, here, at) {
            Ok(Some(share)) => Ok(-share),
            Ok(None) => {
                beyond = Some(at);
                Err(None)
            }
            Err(failed) => Err(Some(failed)),
        }
    });
    match (found, beyond) {
        (Err(Some(failed)), _) => return Err(failed),
        (_, Some(at)) => return onset(tracer, analysis, here, at),
        _ => {}
    }
    // The problem must be evaluated at the point that is recorded next.
    Ok(match analysis.linear_at(here, value, tracer.interrupt)? {
        Some(point) => Next::Reached(point),
        None => Next::Onset(here.try_clone()?, value),
    })
}

/// Largest share of its linear range that a contact uses at a value; `None` if a contact leaves that range.
fn share_at(tracer: &BranchTracer<'_>, analysis: &mut dyn Traceable, here: &Point, value: f64) -> Result<Option<f64>> {
    match analysis.linear_at(here, value, tracer.interrupt)? {
        Some(point) => analysis.linear_share(&point).map(Some),
        None => Ok(None),
    }
}

/// The last point between `here` and a value beyond it at which every contact is linear, by bisection.
fn onset(tracer: &BranchTracer<'_>, analysis: &mut dyn Traceable, here: &Point, beyond: f64) -> Result<Next> {
    let mut inside = here.try_clone()?;
    let mut outside = beyond;
    while (outside - inside.parameter()).abs() > LINEAR_STRETCH_ROUNDING * outside.abs() {
        let middle = 0.5 * (inside.parameter() + outside);
        match analysis.linear_at(&inside, middle, tracer.interrupt)? {
            Some(point) => inside = point,
            None => outside = middle,
        }
    }
    Ok(Next::Onset(inside, beyond))
}

/// Records the peak and the requested solutions between two neighbours, `b` included if it is the last point.
fn find_on_line(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: &Point,
    b: &Point,
    last: bool,
    hooks: &mut Hooks<'_>,
) -> Result<()> {
    let (pa, pb) = (a.parameter(), b.parameter());
    let (low, high) = if pa < pb { (a, b) } else { (b, a) };
    if let Some(omega) = unbounded_between(tracer, analysis, [low, high])? {
        let text = format!("undamped resonance at {omega}: the response is unbounded, and no peak is recorded there");
        hooks.log(LogLevel::Warn, &text);
        if let Some(grid) = &mut tracer.linear_grid {
            grid.unbounded.get_or_insert(omega);
        }
    } else {
        if analysis.observes_peaks() {
            find_peaks(tracer, analysis, SpecialKind::Peak, low, high)?;
        }
        let resolution = analysis.resolution();
        for response in analysis.further_responses() {
            let low = analysis.seen_by(response, (low, resolution))?;
            let high = analysis.seen_by(response, (high, resolution))?;
            find_peaks(tracer, analysis, SpecialKind::PeakOf(response), &low, &high)?;
        }
        response_kinks::find_kinks_of_responses(tracer, analysis, (a, resolution), (b, resolution))?;
    }
    for (i, &p) in tracer.course.at.iter().enumerate() {
        let inside = (pa <= p && p < pb) || (pb < p && p <= pa) || (last && p.to_bits() == pb.to_bits());
        if inside && let Some(point) = analysis.linear_at(a, p, tracer.interrupt)? {
            record_on_line(tracer, analysis, SpecialKind::At(i), point)?;
        }
    }
    Ok(())
}

/// The first undamped resonance between two neighbours that the forces excite: right beside it the motion is far larger than at
/// both.
fn unbounded_between(
    tracer: &BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    ends: [&Point; 2],
) -> Result<Option<f64>> {
    let Some(grid) = &tracer.linear_grid else {
        return Ok(None);
    };
    let largest = ends.iter().fold([0.0_f64; 2], |most, point| larger(most, point));
    for &omega in &grid.undamped {
        if !(ends[0].parameter() < omega && omega < ends[1].parameter()) {
            continue;
        }
        for at in [omega * (1.0 - BESIDE_UNDAMPED), omega * (1.0 + BESIDE_UNDAMPED)] {
            let Some(beside) = analysis.linear_at(ends[0], at, tracer.interrupt)? else {
                continue;
            };
            let here = larger([0.0; 2], &beside);
            if (0..2).any(|i| here[i] > FAR_LARGER * largest[i]) {
                return Ok(Some(omega));
            }
        }
    }
    Ok(None)
}

/// Records a special point with the harmonics that it requires; the stretch continues with its own harmonics.
fn record_on_line(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    mut point: Point,
) -> Result<()> {
    let own = analysis.resolution();
    let mut at = own;
    while !tracer.record_special(analysis, kind, &point)? {
        let start = analysis.transfer(&point, at)?;
        let Some(found) = analysis.linear_at(&start, point.parameter(), tracer.interrupt)? else {
            // A point found with fewer harmonics is better than none.
            analysis.select(at)?;
            tracer.record_special_as_it_is(analysis, kind, &point)?;
            break;
        };
        (point, at) = (found, analysis.resolution());
    }
    analysis.select(own)
}

/// Records the maxima of the amplitude between two neighbours. The maxima of the cubic through both show where
/// there is more than one, or one beside a minimum.
fn find_peaks(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    low: &Point,
    high: &Point,
) -> Result<()> {
    let ends = [low, high].map(|p| (p.parameter(), growth(p)));
    let [(from, begin), (to, end)] = ends;
    // The cubic's derivative in the parts, and its value nearest to a change of sign.
    let mut brackets = Vec::new();
    let mut before = ends[0];
    let mut nearest: Option<(f64, f64)> = None;
    for i in 1..PARTS {
        let s = i as f64 / PARTS as f64;
        let (slope, size) = predicted_growth(low, high, s);
        let here = (from + s * (to - from), slope);
        if before.1 > 0.0 && slope <= 0.0 {
            try_push(&mut brackets, [before, here], CONTEXT)?;
        }
        let against = slope * begin.signum();
        if against < UNCERTAIN * size && nearest.is_none_or(|(_, least)| against < least) {
            nearest = Some((here.0, against));
        }
        before = here;
    }
    if before.1 > 0.0 && end <= 0.0 {
        try_push(&mut brackets, [before, ends[1]], CONTEXT)?;
    }
    let single = begin > 0.0 && end <= 0.0;
    if single && brackets.len() <= 1 {
        return find_peak(tracer, analysis, kind, low, ends);
    }
    if brackets.is_empty()
        && (begin > 0.0) == (end > 0.0)
        && let Some((value, _)) = nearest
    {
        let middle = (value, f64::NAN);
        let bracket = if begin > 0.0 {
            [ends[0], middle]
        } else {
            [middle, ends[1]]
        };
        try_push(&mut brackets, bracket, CONTEXT)?;
    }
    // The cubic tells where to look; the derivatives there and at the ends tell between which of them a maximum lies.
    let mut before = ends[0];
    for (value, _) in brackets.into_iter().flatten().chain([ends[1]]) {
        let inside = value > from && value < to;
        let here = if value <= before.0 {
            continue;
        } else if !inside {
            ends[1]
        } else if let Some(point) = analysis.linear_at(low, value, tracer.interrupt)? {
            (value, growth_of(analysis, kind, &point)?)
        } else {
            continue;
        };
        if before.1 > 0.0 && here.1 <= 0.0 {
            find_peak(tracer, analysis, kind, low, [before, here])?;
        }
        before = here;
    }
    Ok(())
}

/// Records the maximum between two values: the root of the derivative.
fn find_peak(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    from: &Point,
    ends: [(f64, f64); 2],
) -> Result<()> {
    let Some(peak) = stationary(tracer, analysis, kind, from, ends)? else {
        return Ok(());
    };
    record_on_line(tracer, analysis, kind, peak)
}

/// A root of the amplitude's derivative between two values.
fn stationary(
    tracer: &BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    kind: SpecialKind,
    near: &Point,
    [low, high]: [(f64, f64); 2],
) -> Result<Option<Point>> {
    let width = high.0 - low.0;
    let mut bracket = Bracket::new(low.1, high.1);
    let mut best = None;
    for _ in 0..LINEAR_STRETCH_MAX_EVALUATIONS {
        let (share, is_last) = (bracket.guess(), bracket.is_last());
        let at = low.0 + share * width;
        let rounding = LINEAR_STRETCH_ROUNDING * at.abs();
        // A root at an end of the bracket is solved there.
        let is_inside = low.0 < at && at < high.0;
        if best.is_some() && (bracket.width() * width <= rounding || !is_inside) {
            break;
        }
        let Some(point) = analysis.linear_at(near, at, tracer.interrupt)? else {
            break;
        };
        let slope = growth_of(analysis, kind, &point)?;
        best = Some(point);
        if slope == 0.0 || is_last || bracket.narrow(share, slope) * width <= rounding {
            break;
        }
    }
    Ok(best)
}

/// The larger of two amplitudes, and of two motions of the contacts.
fn larger([amplitude, motion]: [f64; 2], point: &Point) -> [f64; 2] {
    [
        amplitude.max(point.amplitude.norm()),
        motion.max(norm(point.unknowns())),
    ]
}

/// ½ d|z|²/ds and |z|² at s, for the cubic through two points of the amplitude z and their derivatives.
fn predicted_growth(a: &Point, b: &Point, s: f64) -> (f64, f64) {
    let width = b.parameter() - a.parameter();
    let slope = |p: &Point| p.slope * (width / p.tangent[p.tangent.len() - 1]);
    let (za, zb, da, db) = (a.amplitude, b.amplitude, slope(a), slope(b));
    let difference = zb - za;
    let (c2, c3) = (difference * 3.0 - da * 2.0 - db, da + db - difference * 2.0);
    let z = za + (da + (c2 + c3 * s) * s) * s;
    let dz = da + (c2 * 2.0 + c3 * (3.0 * s)) * s;
    ((z.conj() * dz).re, z.norm_sqr())
}

/// d|z|/dp of the response whose peak is sought.
fn growth_of(analysis: &mut dyn Traceable, kind: SpecialKind, point: &Point) -> Result<f64> {
    let resolution = analysis.resolution();
    Ok(match kind.response() {
        Some(response) => growth(&analysis.seen_by(response, (point, resolution))?),
        None => growth(point),
    })
}

/// d|z|/dp of the observed amplitude.
fn growth(point: &Point) -> f64 {
    SpecialPoint::Peak.function(point, point.tangent[point.tangent.len() - 1])
}
