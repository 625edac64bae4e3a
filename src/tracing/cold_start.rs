//! A second start of a branch with more harmonics, where its first point misses the tolerance and leads to none that meets
//! it: with few harmonics the equations may have a solution far from those with many.

use crate::continuation::Point;
use crate::continuation::initial_point::{self, Effort};
use crate::error::{Result, Status};
use crate::harmonics::controller::Refined;
use crate::harmonics::discretised::Traceable;
use crate::interrupt::Phase;
use crate::options::Range;
use crate::tracing::course::BranchTracer;

/// Most starts, each with at least twice the harmonics of the one before.
/// Kind: cap.
const COLD_START_MOST_STARTS: usize = 3;

/// Most points of a homotopy to such a start.
/// Kind: cap.
const COLD_START_MOST_POINTS: usize = 100;

/// Newton iterations that a start may take as a multiple of those of the one before, for which so many count at least: with
/// twice the harmonics the path to a solution is about as long, and most of a path that is longer leads to none.
/// Kind: tuned; measured on: not recorded.
const COLD_START_MULTIPLE: usize = 4;
const COLD_START_LEAST: usize = 40;

/// The first point with the harmonics that its error requires.
pub(super) fn refine_first(tracer: &mut BranchTracer<'_>, analysis: &mut dyn Traceable, first: Point) -> Result<Point> {
    let Range {
        start: begin,
        stop: end,
    } = tracer.course.range;
    let is_curve = begin.to_bits() != end.to_bits();
    let first = if is_curve && analysis.linear_share(&first)? >= 1.0 {
        tracer.controller.begin_curve(analysis, first, tracer.interrupt)?
    } else {
        first
    };
    let Refined { mut point, mut stuck } = tracer.controller.refine(analysis, first, true, tracer.interrupt)?;
    let mut effort = Effort {
        points: COLD_START_MOST_POINTS,
        iterations: usize::MAX,
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
        match initial_point::solve_within(analysis.problem(), &tracer.course.settings, effort, tracer.interrupt) {
            Ok(start) => {
                effort.iterations = COLD_START_MULTIPLE * start.point.iterations.max(COLD_START_LEAST);
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
