//! A second start of a branch with more harmonics, where its first point misses the tolerance and leads to none that meets
//! it: with few harmonics the equations may have a solution far from those with many.

use crate::continuation::Point;
use crate::continuation::initial_point::{self, Effort};
use crate::error::{Result, Status};
use crate::harmonics::controller::Refined;
use crate::harmonics::discretised::Traceable;
use crate::interrupt::Phase;
use crate::tracing::course::BranchTracer;

/// Most starts, each with at least twice the harmonics of the one before.
/// Kind: cap.
const COLD_START_MOST_STARTS: usize = 3;

/// Most points of a homotopy to such a start: where the error is known to miss the tolerance, and where it is unknown. There the
/// operations are the bound, and a homotopy that is cut short wastes them.
/// Kind: cap.
const COLD_START_POINTS: (usize, usize) = (100, 1_000);

/// Operations over those of the first start, as [`Interrupt::operations`] counts them, at which no further start is sought: those of all
/// further starts where the error is known, so that a solution with more harmonics is there, or the first point of a curve is
/// sought, whose many points pay for it; and at a single frequency with an unknown error those of the whole call, estimates included, but
/// not less than a share for these starts. The first start measures the model: one with more harmonics must cost more, and mostly several
/// times as much.
/// Kind: tuned; measured on: 98 random chains of 2 to 8 masses with stops and sliders, 300 random models of all laws, two dear estimates.
const COLD_START_WORK: (u64, u64) = (100, 50);
const COLD_START_SHARE: u64 = 15;

/// The first point with the harmonics that its error requires.
pub(super) fn refine_first(tracer: &mut BranchTracer<'_>, analysis: &mut dyn Traceable, first: Point) -> Result<Point> {
    // Work of the first start.
    let since = tracer.course.since;
    let work = tracer.interrupt.operations().saturating_sub(since);
    let is_curve = !tracer.course.range.is_single();
    let first = if is_curve && analysis.linear_share(&first)? >= 1.0 {
        tracer.controller.begin_curve(analysis, first, tracer.interrupt)?
    } else {
        first
    };
    let Refined {
        mut point,
        mut stuck,
        known,
    } = tracer.controller.refine(analysis, first, true, tracer.interrupt)?;
    let now = tracer.interrupt.operations();
    let after = |from: u64, multiple: u64| from.saturating_add(multiple.saturating_mul(work));
    let (until, points) = if is_curve || known {
        (after(now, COLD_START_WORK.0), COLD_START_POINTS.0)
    } else {
        let until = after(since, COLD_START_WORK.1).max(after(now, COLD_START_SHARE));
        (until, COLD_START_POINTS.1)
    };
    for _ in 0..COLD_START_MOST_STARTS {
        let from = analysis.resolution();
        let levels = analysis.levels();
        let few = tracer
            .course
            .starts_again
            .is_some_and(|most| from <= levels.first(most));
        if !stuck || !few {
            break;
        }
        let to = levels.level_of_double(from).max(from + 1).min(levels.last());
        if to <= from {
            break;
        }
        analysis.select(to)?;
        tracer.interrupt.phase(Phase::FirstPoint, 0.0)?;
        let effort = Effort {
            points,
            iterations: usize::MAX,
            until,
        };
        match initial_point::solve_within(analysis.problem(), &tracer.course.settings, effort, tracer.interrupt) {
            Ok(start) => {
                let refined = tracer
                    .controller
                    .refine(analysis, start.point, true, tracer.interrupt)?;
                (point, stuck) = (refined.point, refined.stuck);
            }
            Err(e) if e.recoverable || e.status == Status::NoConvergence => {
                // The point and its estimate are those of the resolution before.
                analysis.select(from)?;
                break;
            }
            Err(e) => return Err(e),
        }
    }
    Ok(point)
}
