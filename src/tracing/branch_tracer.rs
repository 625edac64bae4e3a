//! Tracing of a branch from its first point to the end of the range: points, folds, peaks, and solutions at requested
//! parameter values. The tracer is the same for every analysis.

use crate::continuation::special_points::SpecialPoint;
use crate::continuation::{Advance, Continuation, LinearResonance, Metric, Point, PointAt, Settings};
use crate::error::{Result, Status, try_push};
use crate::harmonics::controller::{AdaptivityController, Refined};
use crate::harmonics::discretised::Traceable;
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::norm;
use crate::options::Range;
use crate::tracing::inner_ends::{InnerEnd, InnerEnds};
use crate::tracing::passed_folds::PassedFolds;
use crate::tracing::resonance_bands::ResonanceBands;
use crate::tracing::resonance_grid::LinearGrid;
use crate::tracing::retracing::RecentPoints;

/// Largest number of successive refinements of the last point, made if the next one is not found.
/// Kind: cap.
const MOST_BACKTRACKS: usize = 2;

/// Number of points with linear contacts after an onset, beyond which the response is followed as a linear one again.
/// Kind: tuned; measured on: not recorded.
const BRANCH_TRACER_PATIENCE: usize = 3;

/// First step after an onset, as a share of the distance to a value at which a contact is known to have left its linear
/// state.
/// Kind: tuned; measured on: not recorded.
const ONSET_SHARE: f64 = 0.25;

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
    merged_at: f64,
    /// Folds that the curve passed, by which it is seen to go round.
    pub(super) folds: PassedFolds,
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

/// Outcome of following a branch that left its range at the start.
enum Outside {
    /// The branch came back at this point, after folds that lie between the given pairs of neighbours.
    Back(Point, Vec<(Point, Point)>),
    /// The branch closed at its first point.
    Closed,
    Gone,
}

/// Outcome of the question whether a curve closes.
enum Following {
    /// The next point, with the status that ends the curve there, if any.
    GoesOn(Point, Option<Status>),
    Ended(Status),
}

/// Outcome of such an excursion for the recorded curve.
enum Return {
    /// The branch came back, and this point was recorded.
    Recorded(Point),
    Ended(Status),
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

    /// Number of error estimates made.
    pub fn estimates(&self) -> usize {
        self.controller.estimates()
    }

    /// Records the first point of the curve, or the only one, and follows the branch from this point.
    pub fn trace(&mut self, analysis: &mut dyn Traceable, first: Point, hooks: &mut Hooks<'_>) -> Result<Status> {
        let first = self.refine_first(analysis, first)?;
        analysis.record(&first)?;
        if self.report(analysis, hooks, &first) {
            return Ok(Status::StoppedByCaller);
        }
        self.trace_from(analysis, first, hooks)
    }

    /// Follows the branch from the point recorded last.
    pub fn trace_from(&mut self, analysis: &mut dyn Traceable, first: Point, hooks: &mut Hooks<'_>) -> Result<Status> {
        let settings = self.course.settings;
        if settings.start.to_bits() == settings.end.to_bits() {
            return self.record_single(analysis, &first);
        }
        let (begin, began) = (first.try_clone()?, analysis.resolution());
        // Where harmonics change, the branch continues from beside the point recorded last. Special points are
        // located between recorded points, so that none is omitted or found twice.
        let (mut recent, mut continuation) = RecentPoints::begin(settings, first, began)?;
        let mut backtracks = 0;
        // Number of points with linear contacts for which the continuation goes on all the same, after an onset.
        let mut patience = 0_usize;
        loop {
            if analysis.branch().points() >= self.course.max_points {
                return Ok(Status::StoppedMaxPoints);
            }

            // Where every contact is linear, follow the linear response to the onset of slip or to the end.
            if patience == 0 && analysis.is_linear() {
                match self.follow_linear(analysis, recent.last(), hooks)? {
                    None => {}
                    Some(Stretch::Onset {
                        before,
                        point,
                        distance,
                    }) => {
                        recent.go_on((before.as_ref(), &point), analysis.resolution())?;
                        continuation.start_at(point, ONSET_SHARE * distance)?;
                        patience = BRANCH_TRACER_PATIENCE;
                    }
                    Some(Stretch::End(point, Status::StoppedLeftRange)) => {
                        match self.come_back(analysis, point, (&begin, began), hooks)? {
                            Return::Ended(status) => return Ok(status),
                            Return::Recorded(back) => {
                                (recent, continuation) = RecentPoints::begin(settings, back, analysis.resolution())?;
                                continue;
                            }
                        }
                    }
                    Some(Stretch::End(_, status) | Stretch::Stopped(status)) => return Ok(status),
                }
            }

            // Predict and correct.
            let before = analysis.resolution();
            let parameter = continuation.current().parameter();
            self.interrupt
                .phase(Phase::Continuation, self.fraction_done(parameter))?;
            if let Some(bands) = &self.course.bands {
                bands.shorten_step(&mut continuation);
            }
            let (point, end) =
                match continuation.advance_over(analysis.problem(), &self.course.resonances, self.interrupt)? {
                    Advance::Accepted { point, last } => (point, last.then_some(Status::Ok)),
                    Advance::LeftAtStart { point } => (point, Some(Status::StoppedLeftRange)),
                    Advance::Stopped(status) => return Ok(status),
                };

            // Turn round a branch that comes back along its own points.
            let by = (&settings, self.interrupt);
            let Some(point) = recent.mend(analysis, &mut continuation, point, by, hooks)? else {
                continue;
            };

            // Refine until the error meets the tolerance.
            let refined = self.controller.refine(analysis, point, end.is_some(), self.interrupt);
            let Some(Refined { point, stuck }) = some_unless_lost(refined)? else {
                return Ok(Status::StoppedStepTooSmall);
            };
            let reversed =
                analysis.resolution() != before && self.is_reversed_or_outside(analysis, recent.last(), &point)?;
            if (stuck || reversed)
                && backtracks < MOST_BACKTRACKS
                && let Some(previous) = continuation.previous()
                && let Some(point) = AdaptivityController::backtrack(analysis, (previous, before), self.interrupt)?
            {
                backtracks += 1;
                continuation.go_on_from(None, point)?;
                continue;
            }
            backtracks = 0;

            // End where the curve closes, or comes back to its parent.
            let (point, end) = match self.closing(analysis, recent.last(), (point, end))? {
                Following::GoesOn(point, end) => (point, end),
                Following::Ended(status) => return Ok(status),
            };

            // Record the point, and the special points before it.
            if some_unless_lost(analysis.record(&point))?.is_none() {
                return Ok(Status::StoppedStepTooSmall);
            }
            let resolution = analysis.resolution();
            let stop = self.report(analysis, hooks, &point);
            self.locate_special(analysis, recent.last(), (&point, resolution), end.is_some())?;
            analysis.select(resolution)?;
            recent.push((&point, resolution))?;
            patience = patience.saturating_sub(1) * usize::from(analysis.is_linear());
            if stop {
                return Ok(Status::StoppedByCaller);
            }

            // Select the harmonics of the next step, or end.
            match end {
                None => {
                    let current = self.controller.adjust(analysis, point, self.interrupt)?;
                    let changes = resolution != before || analysis.resolution() != before;
                    go_on(analysis, &mut continuation, current, changes.then_some(before))?;
                }
                Some(Status::StoppedLeftRange) => match self.come_back(analysis, point, (&begin, began), hooks)? {
                    Return::Ended(status) => return Ok(status),
                    Return::Recorded(back) => {
                        (recent, continuation) = RecentPoints::begin(settings, back, analysis.resolution())?;
                    }
                },
                Some(status) => return Ok(status),
            }
        }
    }

    /// Follows a branch that left its range at the start, and records the point where it comes back.
    fn come_back(
        &mut self,
        analysis: &mut dyn Traceable,
        exit: Point,
        begin: PointAt<'_>,
        hooks: &mut Hooks<'_>,
    ) -> Result<Return> {
        let resolution = analysis.resolution();
        let (back, turns) = match self.follow_outside(analysis, exit, begin)? {
            Outside::Back(back, turns) => (back, turns),
            Outside::Closed => return Ok(Return::Ended(Status::StoppedClosed)),
            Outside::Gone => return Ok(Return::Ended(Status::StoppedLeftRange)),
        };
        hooks.log(LogLevel::Info, "the branch left at its start and came back");
        let refined = self.controller.refine(analysis, back, true, self.interrupt);
        let Some(Refined { point: back, .. }) = some_unless_lost(refined)? else {
            return Ok(Return::Ended(Status::StoppedStepTooSmall));
        };
        if some_unless_lost(analysis.record(&back))?.is_none() {
            return Ok(Return::Ended(Status::StoppedStepTooSmall));
        }
        self.record_turns_outside(analysis, &turns, resolution)?;
        if self.report(analysis, hooks, &back) {
            return Ok(Return::Ended(Status::StoppedByCaller));
        }
        Ok(Return::Recorded(back))
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
    fn fraction_done(&self, parameter: f64) -> f64 {
        let Range { start, stop: end } = self.course.range;
        let range = end - start;
        if range == 0.0 {
            return 1.0;
        }
        ((parameter - start) / range).clamp(0.0, 1.0)
    }

    /// The next point, of the current resolution, with the status that ends the curve at this point, if any. Where a
    /// curve that was entered inside its range closes, the point is its first one. The curve ends before the point where it
    /// passed the branch that it branches off from, and where it goes round a closed curve that a step has entered.
    fn closing(
        &mut self,
        analysis: &mut dyn Traceable,
        last: PointAt<'_>,
        (point, end): (Point, Option<Status>),
    ) -> Result<Following> {
        let by = (&self.course.settings, self.interrupt);
        let Some(ends) = &self.course.ends else {
            let (goes_round, evaluated) = if analysis.levels().is_automatic() {
                self.folds.repeat(analysis, last, &point, by)?
            } else {
                (false, false)
            };
            if goes_round {
                return Ok(Following::Ended(Status::StoppedClosed));
            }
            // The problem is to be evaluated at the point that is recorded.
            let again = if evaluated {
                analysis.resolve(&point, end.is_some(), self.interrupt)?
            } else {
                None
            };
            return Ok(Following::GoesOn(again.unwrap_or(point), end));
        };
        Ok(match ends.between(analysis, last, &point, by)? {
            None => Following::GoesOn(point, end),
            Some(InnerEnd::Closed(first)) => Following::GoesOn(first, Some(Status::StoppedClosed)),
            Some(InnerEnd::Merged(at)) => {
                self.merged_at = at;
                Following::Ended(Status::Ok)
            }
        })
    }

    /// Whether a point found with other harmonics lies before the point recorded last, or outside the range.
    // Out of line: its points do not lie on the stack under a step.
    #[inline(never)]
    fn is_reversed_or_outside(
        &self,
        analysis: &dyn Traceable,
        (previous, resolution): PointAt<'_>,
        point: &Point,
    ) -> Result<bool> {
        let settings = &self.course.settings;
        let previous = analysis.transfer(previous, resolution)?;
        let metric = Metric::along(norm(point.unknowns()), settings);
        let forward = metric.dot(&point.v, &point.tangent) > metric.dot(&previous.v, &point.tangent)
            && !point.skips_folds_from(&previous);
        let (low, high) = (settings.start.min(settings.end), settings.start.max(settings.end));
        Ok(!forward || point.parameter() < low || point.parameter() > high)
    }

    /// Follows the branch from where it left at the start of the range to where it comes back, as with folds on both
    /// sides of the start. No point outside is recorded.
    fn follow_outside(
        &self,
        analysis: &mut dyn Traceable,
        exit: Point,
        (begin, began): PointAt<'_>,
    ) -> Result<Outside> {
        let Some(before) = self.course.before else {
            return Ok(Outside::Gone);
        };
        // With other harmonics the first point is another solution: it is solved again with those of the excursion.
        let start = analysis.transfer(begin, began)?;
        let solved = if analysis.resolution() == began {
            None
        } else {
            analysis.resolve(&start, true, self.interrupt)?
        };
        let begin = solved.unwrap_or(start);
        let settings = Settings {
            end: before,
            ..self.course.settings
        };
        let mut turns = Vec::new();
        let mut last = exit.try_clone()?;
        let mut continuation = Continuation::new(settings, exit)?;
        for _ in analysis.branch().points()..self.course.max_points {
            match continuation.advance(analysis.problem(), self.interrupt) {
                Ok(Advance::Accepted { point, last: false }) => {
                    let before = core::mem::replace(&mut last, point);
                    if SpecialPoint::Fold.between(&before, &last) {
                        let turn = (before, last.try_clone()?);
                        try_push(&mut turns, turn, "the folds outside the range")?;
                    }
                }
                // A closed curve would be followed forever.
                Ok(Advance::LeftAtStart { point }) if same(point.unknowns(), begin.unknowns()) => {
                    return Ok(Outside::Closed);
                }
                Ok(Advance::LeftAtStart { point }) => {
                    if SpecialPoint::Fold.between(&last, &point) {
                        let turn = (last, point.try_clone()?);
                        try_push(&mut turns, turn, "the folds outside the range")?;
                    }
                    return Ok(Outside::Back(point, turns));
                }
                Err(e) if matches!(e.status, Status::Callback | Status::StoppedByCaller) => return Err(e),
                // A failure outside the range costs no point inside.
                Ok(_) | Err(_) => break,
            }
        }
        Ok(Outside::Gone)
    }
}

/// Continues from a point. `before` is the resolution of the previous one if the harmonics have changed.
fn go_on(
    analysis: &dyn Traceable,
    continuation: &mut Continuation,
    current: Point,
    before: Option<usize>,
) -> Result<()> {
    let Some(before) = before else {
        continuation.recycle(current);
        return Ok(());
    };
    let previous = continuation.previous();
    let previous = previous.map(|p| analysis.transfer(p, before)).transpose()?;
    continuation.go_on_from(previous, current)
}

/// The value of an outcome; `None` if Newton's last correction, which is not evaluated, led to a motion that a law
/// cannot evaluate.
pub(super) fn some_unless_lost<T>(outcome: Result<T>) -> Result<Option<T>> {
    match outcome {
        Err(e) if e.status == Status::Singular || (e.recoverable && e.status != Status::Callback) => Ok(None),
        outcome => outcome.map(Some),
    }
}

/// Whether two solutions at one parameter value are equal to a relative difference of 1e-8.
fn same(a: &[f64], b: &[f64]) -> bool {
    let difference = a.iter().zip(b).fold(0.0_f64, |d, (a, b)| d.hypot(a - b));
    difference <= 1e-8 * norm(b)
}
