//! Branch points of a curve whose motions have no Floquet multipliers, as those of a nonlinear mode: where another curve of the
//! same equations crosses it.
//!
//! At a simple branch point det [J r; tᵀ] changes its sign along a smooth curve, which it does at no regular point and at no fold
//! (Allgower & Georg, Introduction to Numerical Continuation Methods, 2003, §8.1, doi:10.1137/1.9780898719154). The sign
//! halves the arc across such a point.

use crate::continuation::arc_length::ALONG;
use crate::continuation::special_points::Locator;
use crate::continuation::{Metric, Point, PointAt};
use crate::error::{Result, try_copy};
use crate::harmonics::discretised::Traceable;
use crate::linalg::norm;
use crate::results::{BifurcationKind, SpecialKind};
use crate::tracing::course::BranchTracer;

/// Halvings of the arc across a branch point.
/// Kind: cap.
const BRANCH_POINTS_HALVINGS: usize = 26;

/// Locates and records the branch point between two neighbours of the curve, where the analysis seeks it.
pub(super) fn find_branch_point(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: PointAt<'_>,
    b: PointAt<'_>,
) -> Result<()> {
    if !analysis.seeks_branch_points() {
        return Ok(());
    }
    analysis.select(a.1.max(b.1))?;
    let level = analysis.resolution();
    let mut ends = Vec::new();
    for (point, from) in [a, b] {
        let moved = analysis.transfer(point, from)?;
        let solved = if from == level {
            Some(moved)
        } else {
            analysis.resolve(&moved, false, tracer.interrupt)?
        };
        let Some(solved) = solved else {
            return Ok(());
        };
        crate::error::try_push(&mut ends, solved, "the branch points")?;
    }
    let [a, b] = &ends[..] else { return Ok(()) };
    let metric = Metric::along(norm(b.unknowns()), &tracer.course.settings);
    let cosine = metric.dot(&a.tangent, &b.tangent) / (metric.norm(&a.tangent) * metric.norm(&b.tangent));
    // Across a corner the sign may change, too.
    if a.positive == b.positive || cosine < ALONG {
        return Ok(());
    }
    let mut locator = Locator::new(a.unknowns().len(), tracer.course.settings)?;
    let (mut low, mut high) = (0.0, 1.0);
    let mut nearest = (a.try_clone()?, b.try_clone()?);
    for _ in 0..BRANCH_POINTS_HALVINGS {
        let middle = 0.5 * (low + high);
        // At the branch point itself no plane across the curve isolates a solution.
        let Some(point) = locator.between(analysis.problem(), (a, b), middle, tracer.interrupt)? else {
            break;
        };
        if point.positive == a.positive {
            (low, nearest.0) = (middle, point);
        } else {
            (high, nearest.1) = (middle, point);
        }
    }
    let found = halfway((&nearest.0, &nearest.1), (a, b))?;
    let kind = SpecialKind::Bifurcation(BifurcationKind::BranchPoint, [None; 2]);
    tracer.record_special_as_it_is(analysis, kind, &found)
}

/// The point half way between two close ones, with the direction of a longer arc through `a` and `b`.
fn halfway((low, high): (&Point, &Point), (a, b): (&Point, &Point)) -> Result<Point> {
    const CONTEXT: &str = "the branch points";
    let mut found = low.try_clone()?;
    for (v, high) in found.v.iter_mut().zip(&high.v) {
        *v = 0.5 * (*v + high);
    }
    found.tangent = try_copy(&b.v, CONTEXT)?;
    for (t, a) in found.tangent.iter_mut().zip(&a.v) {
        *t -= a;
    }
    Ok(found)
}
