//! Stretches of a branch on which every contact is linear: the response is a rational function of the parameter, and is
//! solved at given values of it, without a step length.
//!
//! The values are placed by the resonances, see [`LinearGrid`]; peaks are the roots of the exact derivative of the
//! amplitude between them. A stretch ends where a contact leaves its linear state, which is located to rounding, or at
//! the end of the range.

use crate::continuation::{Point, PointAt};
use crate::error::{Result, Status};
use crate::harmonics::discretised::Traceable;
use crate::hooks::{Hooks, LogLevel};
use crate::linalg::norm;
use crate::options::Range;
use crate::results::SpecialKind;
use crate::tracing::course::{BranchTracer, Stretch, some_unless_lost};
use crate::tracing::linear_onset::Onset;
use crate::tracing::linear_peaks::{find_peaks, record_on_line};
use crate::tracing::linear_shares::{Between, place_beyond};
use crate::tracing::resonance_grid::LinearGrid;
use crate::tracing::response_kinks;

/// Outcome of the part of a stretch from a point to the next value.
enum Next {
    Reached(Point),
    /// The last point with linear contacts, and a parameter value beyond it at which some contact is not linear.
    Onset(Point, f64),
}

/// Relative distance from an undamped resonance at which its part of the motion dominates, however small its force.
/// Kind: rounding.
const BESIDE_UNDAMPED: f64 = 1e-8;

/// Ratio of a motion there to those at the neighbours, 4e-5 and more away, that nothing but a pole makes.
/// Kind: tuned; measured on: undamped oscillators, chains, sectors, and dampers at nodes of modes.
const FAR_LARGER: f64 = 10.0;

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
    tracer.linear_grid = Some(LinearGrid::new(resonances, range)?);
    Ok(())
}

/// The linear response at `value`, or the last point before it at which every contact is linear.
fn next_linear(tracer: &BranchTracer<'_>, analysis: &mut dyn Traceable, here: &Point, value: f64) -> Result<Next> {
    let Some(point) = analysis.linear_at(here, value, tracer.interrupt)? else {
        return onset(tracer, analysis, here, value);
    };
    match place_beyond(tracer, analysis, [here, &point])? {
        Between::Linear => Ok(Next::Reached(point)),
        Between::Beyond(at) => onset(tracer, analysis, here, at),
        // The problem must be evaluated at the point that is recorded next.
        Between::LinearAfterSearch => Ok(match analysis.linear_at(here, value, tracer.interrupt)? {
            Some(point) => Next::Reached(point),
            None => Next::Onset(here.try_clone()?, value),
        }),
    }
}

/// The last point between `here` and a value beyond it at which every contact is linear.
fn onset(tracer: &BranchTracer<'_>, analysis: &mut dyn Traceable, here: &Point, beyond: f64) -> Result<Next> {
    let mut inside = here.try_clone()?;
    let mut bracket = Onset::new(here.parameter(), analysis.linear_share(here)?, beyond);
    while let Some(at) = bracket.next() {
        let found = analysis.linear_at(&inside, at, tracer.interrupt)?;
        let share = found.as_ref().map(|point| analysis.linear_share(point));
        bracket.take(at, share.transpose()?);
        inside = found.unwrap_or(inside);
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
    for omega in grid.undamped() {
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

/// The larger of two amplitudes, and of two motions of the contacts.
fn larger([amplitude, motion]: [f64; 2], point: &Point) -> [f64; 2] {
    [
        amplitude.max(point.amplitude.norm()),
        motion.max(norm(point.unknowns())),
    ]
}
