//! All special points between two neighbours of a branch, in the order in which they are sought.

use crate::continuation::PointAt;
use crate::continuation::special_points::SpecialPoint;
use crate::error::Result;
use crate::harmonics::discretised::Traceable;
use crate::results::SpecialKind;
use crate::tracing::course::BranchTracer;
use crate::tracing::{bifurcations, branch_points, requested_points, response_kinks, response_peaks};

/// Locates folds, other bifurcations, peaks, limit cycles and requested parameter values between two neighbours.
// Out of line: its points do not lie on the stack under a step.
#[inline(never)]
pub(super) fn locate_special(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: PointAt<'_>,
    b: PointAt<'_>,
    last: bool,
) -> Result<()> {
    analysis.select(a.1.max(b.1))?;
    let interrupt = tracer.interrupt;
    if analysis.observes_peaks() {
        response_peaks::find_peaks_between(tracer, analysis, a, b)?;
    }
    response_peaks::find_peaks_of_responses(tracer, analysis, a, b)?;
    response_kinks::find_kinks_of_responses(tracer, analysis, a, b)?;
    if let Some(level) = analysis.level_of_limit_cycles().map(SpecialPoint::Level)
        && level.between(a.0, b.0)
    {
        analysis.select(a.1.max(b.1))?;
        let kind = SpecialKind::LimitCycle { slope: f64::NAN };
        tracer.find(analysis, kind, a, b, |locator, problem, a, b| {
            locator.locate(problem, level, a, b, interrupt)
        })?;
    }
    // A peak may have required more harmonics; a fold is located with those of its neighbours.
    analysis.select(a.1.max(b.1))?;
    let fold = if SpecialPoint::Fold.between(a.0, b.0) {
        tracer.find(analysis, SpecialKind::Fold, a, b, |locator, problem, a, b| {
            locator.locate(problem, SpecialPoint::Fold, a, b, interrupt)
        })?
    } else {
        None
    };
    if let Some((fold, resolution)) = &fold {
        tracer.folds.note((fold, *resolution), a, b)?;
    }
    let turn = fold.as_ref().map(|(fold, resolution)| (fold, *resolution));
    bifurcations::find_bifurcations(tracer, analysis, a, b, turn)?;
    branch_points::find_branch_point(tracer, analysis, a, b)?;
    if let Some((fold, resolution)) = &fold {
        requested_points::find_requested(tracer, analysis, a, (fold, *resolution), false)?;
        requested_points::find_requested(tracer, analysis, (fold, *resolution), b, last)
    } else {
        requested_points::find_requested(tracer, analysis, a, b, last)
    }
}
