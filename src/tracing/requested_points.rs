//! Solutions at requested parameter values: located between two neighbours of the branch, or solved from the beginning.
//!
//! Between two points the curve may bulge, or turn twice, so that no solution lies near their cubic. A response has one all the same:
//! it is then sought as a first point is.

use crate::continuation::initial_point::{self, Effort};
use crate::continuation::{PointAt, Settings};
use crate::error::{Result, Status};
use crate::harmonics::discretised::Traceable;
use crate::results::SpecialKind;
use crate::tracing::course::BranchTracer;

/// Bounds of the work for such a solution.
/// Kind: cap.
const REQUESTED_MOST: Effort = Effort {
    points: 200,
    iterations: 2_000,
    until: u64::MAX,
};

/// Solves at the requested parameter values on the arc from `a` (included) to `b` (included if it is the last
/// point of the branch), which has no fold inside.
pub(super) fn find_requested(
    tracer: &mut BranchTracer<'_>,
    analysis: &mut dyn Traceable,
    a: PointAt<'_>,
    b: PointAt<'_>,
    last: bool,
) -> Result<()> {
    let (at, interrupt) = (tracer.course.at, tracer.interrupt);
    for (i, &p) in at.iter().enumerate() {
        let (pa, pb) = (a.0.parameter(), b.0.parameter());
        let inside = (pa <= p && p < pb) || (pb < p && p <= pa);
        let inside = inside || (last && p.to_bits() == pb.to_bits());
        if inside {
            let found = tracer.find(analysis, SpecialKind::At(i), a, b, |locator, problem, a, b| {
                locator.at_parameter(problem, a, b, p, interrupt)
            })?;
            if found.is_none() && analysis.may_start_anywhere() {
                start_at(tracer, analysis, i, p)?;
            }
        }
    }
    Ok(())
}

/// Solves at the i-th requested value p as for a first point, with the harmonics that the solution requires.
fn start_at(tracer: &mut BranchTracer<'_>, analysis: &mut dyn Traceable, i: usize, p: f64) -> Result<()> {
    let settings = Settings {
        start: p,
        ..tracer.course.settings
    };
    loop {
        match initial_point::solve_within(analysis.problem(), &settings, REQUESTED_MOST, tracer.interrupt) {
            Ok(first) if tracer.record_special(analysis, SpecialKind::At(i), &first.point)? => return Ok(()),
            // More harmonics are selected.
            Ok(_) => {}
            Err(e) if e.recoverable || e.status == Status::NoConvergence => return Ok(()),
            Err(e) => return Err(e),
        }
    }
}
