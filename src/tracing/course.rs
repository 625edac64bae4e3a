//! The course of a branch that is traced, and the tracer that all searches on it share.

use crate::continuation::{LinearResonance, Point, Settings};
use crate::error::{Result, Status};
use crate::harmonics::controller::AdaptivityController;
use crate::harmonics::discretised::Traceable;
use crate::hooks::{Hooks, Progress};
use crate::interrupt::Interrupt;
use crate::options::Range;
use crate::tracing::inner_ends::InnerEnds;
use crate::tracing::passed_folds::PassedFolds;
use crate::tracing::resonance_bands::ResonanceBands;
use crate::tracing::resonance_grid::{LinearGrid, PolesBeside};

/// The range to follow, and the solutions requested in it.
pub(crate) struct Course<'a> {
    pub settings: Settings,
    /// The whole range. `settings` may leave out a part that needs no following.
    pub range: Range,
    /// Parameter values of requested solutions.
    pub at: &'a [f64],
    pub max_points: usize,
    /// Whether the run ends, to start again with more samples, where these are required.
    pub may_refine: bool,
    /// Parameter value before the range up to which a branch that leaves at its start is followed, because it may
    /// come back; `None`: it is not followed.
    pub before: Option<f64>,
    /// Highest harmonic up to which the first point, at the start of the range, may be sought again with more
    /// harmonics; `None`: it may not.
    pub starts_again: Option<usize>,
    /// Operations that were counted before the analysis began.
    pub since: u64,
    /// Bounds of the steps where the branch is followed for its special points alone.
    pub bands: Option<ResonanceBands>,
    /// Resonances of the structure with linear forces, ascending, that no step passes where the branch feels them.
    pub resonances: Vec<LinearResonance>,
    /// Ends of a curve that was entered inside its range.
    pub ends: Option<InnerEnds>,
}

/// Traces one branch: predicts, corrects, refines and records its points.
pub(crate) struct BranchTracer<'a> {
    pub(super) course: Course<'a>,
    pub(super) controller: AdaptivityController,
    pub(super) interrupt: &'a Interrupt<'a>,
    /// Parameter values of linear stretches, if they could be computed; and whether they were requested.
    pub(super) linear_grid: Option<LinearGrid>,
    pub(super) grid_requested: bool,
    /// Last solutions of the previous arc, each with its resolution, where peaks of responses were sought on it.
    pub(super) before_arc: Vec<(Point, usize)>,
    /// Parameter value at which the curve came back to the branch that it branches off from; NaN where it did not.
    pub(super) merged_at: f64,
    /// Folds that the curve passed, by which it is seen to go round.
    pub(super) folds: PassedFolds,
}

impl<'a> BranchTracer<'a> {
    /// A tracer that selects harmonics by a tolerance, if one is given.
    pub fn new(course: Course<'a>, tolerance: f64, interrupt: &'a Interrupt<'a>) -> Self {
        Self {
            course,
            controller: AdaptivityController::new(tolerance),
            interrupt,
            linear_grid: None,
            grid_requested: false,
            before_arc: Vec::new(),
            merged_at: f64::NAN,
            folds: PassedFolds::default(),
        }
    }

    /// The range to follow, and the solutions requested in it.
    pub fn course(&self) -> &Course<'a> {
        &self.course
    }

    /// Parameter value at which the curve came back to the branch that it branches off from; NaN where it did not.
    pub fn merged_at(&self) -> f64 {
        self.merged_at
    }

    /// The first undamped resonance that a linear stretch has passed and that the forces excite.
    pub fn unbounded_at(&self) -> Option<f64> {
        self.linear_grid.as_ref().and_then(|grid| grid.unbounded)
    }

    /// The interval between two values of a linear response with the poles next to it.
    pub(super) fn poles_beside(&self, from: f64, to: f64) -> PolesBeside {
        let grid = self.linear_grid.as_ref();
        grid.map_or_else(|| PolesBeside::none(from, to), |grid| grid.poles_beside(from, to))
    }

    /// Number of error estimates made.
    pub fn estimates(&self) -> usize {
        self.controller.estimates()
    }

    /// Reports the point recorded last to the caller; `true` if the run ends, because the caller stops it or it
    /// starts again with more samples.
    pub fn report(&self, analysis: &dyn Traceable, hooks: &mut Hooks<'_>, point: &Point) -> bool {
        if self.course.may_refine && analysis.sampling_factor() > 1 {
            return true;
        }
        let branch = analysis.branch();
        hooks.report(&Progress {
            point: branch.points(),
            parameter: point.parameter(),
            amplitude: branch.amplitude().last().copied().unwrap_or(0.0),
            residual: point.residual,
            step: point.step,
            fraction_done: self.fraction_done(point.parameter()),
            newton_iterations: point.iterations,
        })
    }

    /// Completed share of the range at a parameter value.
    pub(super) fn fraction_done(&self, parameter: f64) -> f64 {
        let Range { start, stop: end } = self.course.range;
        let range = end - start;
        if range == 0.0 {
            return 1.0;
        }
        ((parameter - start) / range).clamp(0.0, 1.0)
    }
}

/// How a linear stretch ended.
pub(super) enum Stretch {
    /// A contact leaves its linear state just beyond the point, which was recorded last, and has left it at `distance`
    /// from there. Before it lies a point of the stretch, unless that was where the stretch began.
    Onset {
        before: Option<Point>,
        point: Point,
        distance: f64,
    },
    /// The stretch reached the end of the range, or its start, at the point recorded last.
    End(Point, Status),
    /// The run ends, with this status.
    Stopped(Status),
}

/// The value of an outcome; `None` if Newton's last correction, which is not evaluated, led to a motion that a law
/// cannot evaluate.
pub(super) fn some_unless_lost<T>(outcome: Result<T>) -> Result<Option<T>> {
    match outcome {
        Err(e) if e.status == Status::Singular || (e.recoverable && e.status != Status::Callback) => Ok(None),
        outcome => outcome.map(Some),
    }
}
