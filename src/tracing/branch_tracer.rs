//! Tracing of a branch from its first point to the end of the range: points, folds, peaks, and solutions at requested
//! parameter values. The tracer is the same for every analysis.

use crate::continuation::special_points::SpecialPoint;
use crate::continuation::{Advance, Continuation, Metric, Point, PointAt, Settings};
use crate::error::{Result, Status, try_push};
use crate::harmonics::controller::{AdaptivityController, Refined};
use crate::harmonics::discretised::Traceable;
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Phase;
use crate::linalg::norm;
use crate::tracing::bifurcations;
use crate::tracing::cold_start;
pub(crate) use crate::tracing::course::{BranchTracer, Course};
use crate::tracing::course::{Stretch, some_unless_lost};
use crate::tracing::inner_ends::InnerEnd;
use crate::tracing::linear_stretch;
use crate::tracing::points_between;
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

impl BranchTracer<'_> {
    /// Records the first point of the curve, or the only one, and follows the branch from this point.
    pub fn trace(&mut self, analysis: &mut dyn Traceable, first: Point, hooks: &mut Hooks<'_>) -> Result<Status> {
        let first = cold_start::refine_first(self, analysis, first)?;
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
                match linear_stretch::follow_linear(self, analysis, recent.last(), hooks)? {
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
            let Some(Refined { point, stuck, .. }) = some_unless_lost(refined)? else {
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
            points_between::locate_special(self, analysis, recent.last(), (&point, resolution), end.is_some())?;
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
        bifurcations::record_turns_outside(self, analysis, &turns, resolution)?;
        if self.report(analysis, hooks, &back) {
            return Ok(Return::Ended(Status::StoppedByCaller));
        }
        Ok(Return::Recorded(back))
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

/// Whether two solutions at one parameter value are equal to a relative difference of 1e-8.
fn same(a: &[f64], b: &[f64]) -> bool {
    let difference = a.iter().zip(b).fold(0.0_f64, |d, (a, b)| d.hypot(a - b));
    difference <= 1e-8 * norm(b)
}
