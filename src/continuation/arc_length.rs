//! Arc-length continuation of R(u, p) = 0, one accepted point after the other.
//!
//! The unknown v = (u, p) is measured in a metric that follows the branch: u in units of ten times its present size,
//! p in units of the range. A step predicts by the polynomial through the last two to five points and tangents, corrects in the
//! plane orthogonal to the tangent (Allgower & Georg, Introduction to Numerical Continuation Methods, 2003,
//! doi:10.1137/1.9780898719154), and is accepted if the prediction was close and the direction kept.

mod corners;
mod crossed_resonances;

use crate::continuation::arc_cubic;
use crate::continuation::corrector::{Corrector, Foresight, Outcome};
use crate::continuation::history::History;
use crate::continuation::linear_resonance::LinearResonance;
use crate::continuation::metric::Metric;
use crate::continuation::point::Point;
use crate::continuation::settings::Settings;
use crate::continuation::step_control::StepControl;
use crate::error::{Error, Result, Status, try_extend, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::Problem;
use num_complex::Complex64;

/// Outcome of an attempt to advance.
#[derive(Debug)]
pub enum Advance {
    /// The next point; `last` if it is the end of the range.
    Accepted {
        /// The accepted point.
        point: Point,
        /// Whether the end of the range was reached.
        last: bool,
    },
    /// The branch turned back and left the range at its start, to a point outside.
    LeftAtStart {
        /// The first point outside the range.
        point: Point,
    },
    /// No further point was found.
    Stopped(Status),
}

/// Follows a branch from point to point.
pub struct Continuation {
    settings: Settings,
    steps: StepControl,
    corrector: Corrector,
    history: History,
    current: Point,
    /// Size of the unknowns at the current point; and length of its tangent, both in the metric of the last
    /// prediction.
    size: f64,
    length: f64,
    memory: StepMemory,
    /// Largest motion and amplitude so far.
    largest: (f64, f64),
    /// Relative error of the prediction of the point accepted last.
    last_error: f64,
    /// Number of points accepted last whose parameters differ by rounding alone.
    stationary: usize,
    surfaces: Surfaces,
}

/// Memory of steps.
pub struct StepMemory {
    /// A point whose memory the next one takes.
    unused: Option<Point>,
    row: Vec<f64>,
    scratch: Vec<f64>,
    /// Memory for the next prediction.
    prediction: Vec<f64>,
}

/// Corners that are left along their surface.
pub struct Surfaces {
    /// Whether corners are left that it reaches along their surface. Paths of homotopies end there, and so does a branch
    /// that meets the next one before its steps have grown again: one that goes to infinity would creep.
    may_leave: bool,
    left: bool,
}

const CONTEXT: &str = "the continuation";

/// Least cosine between the directions of the branch at the two ends of one step.
/// Kind: tuned; measured on: not recorded.
pub(crate) const STRAIGHT: f64 = 0.5;

/// Step below which a failure counts as a corner of the branch, and no resonance is looked for.
/// Kind: tuned; measured on: not recorded.
const CORNER_STEP: f64 = 1e-6;

/// Step of a branch that a corner no longer shortens.
/// Kind: tuned; measured on: not recorded.
const GROWN: f64 = 1e-3;

/// Least cosine between two directions that differ by the turn of a smooth branch alone, as beyond a corner and as predicted there.
/// Kind: tuned; measured on: not recorded.
pub(crate) const ALONG: f64 = 0.9;

/// Angle in radians between two directions up to which they are one line, per length of the step between them, and its bounds:
/// the branch itself turns along a step.
/// Kind: tuned; measured on: not recorded.
const LINE: f64 = 1e3;
const LINE_BOUNDS: (f64, f64) = (1e-3, 1.4e-2);

/// Motions below this share of the largest so far no longer refine the metric.
/// Kind: tuned; measured on: not recorded.
const FLOOR: f64 = 1e-2;

/// Relative motions below this share of the largest motion of the structure, the unit of all lengths, are its rounding.
/// Kind: rounding.
const ROUNDING_OF_MOTION: f64 = 1e-12;

/// Relative change of the parameter that is rounding, and the number of points in a row, no further apart, that show a branch
/// which ends in rounding. An amplitude that grows without bound at a resonance would else be followed there by chance.
/// Kind: rounding.
const ARC_LENGTH_ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Number of points in a row, no further apart, that show a branch which ends in rounding.
/// Kind: cap.
const MOST_STATIONARY: usize = 32 * OF_STATIONARY;
/// Tiny steps, which change no parameter wherever the branch leads, that count as one point.
/// Kind: cap.
const OF_STATIONARY: usize = 8;

/// Relative error of a prediction far below that which shortens steps.
/// Kind: tuned; measured on: not recorded.
const SMOOTH: f64 = 1e-5;

/// Largest relative error of the prediction of a step over a crossing, and least cosine between its directions.
/// Kind: tuned; measured on: not recorded.
const CROSSED: (f64, f64) = (1e-4, 0.99);

/// Length of a step that changes no parameter beyond rounding, wherever the branch leads.
/// Kind: rounding.
const TINY: f64 = 1e-6;

/// Share of the way to a resonance that a step goes which would pass it.
/// Kind: tuned; measured on: not recorded.
pub(crate) const APPROACH: f64 = 0.5;

/// Outcome of one step: prediction and correction.
enum Attempt {
    /// A point, with the error of its prediction and the cosine of the angle between the tangents at the ends of the
    /// step.
    Good {
        point: Point,
        error: f64,
        kept: f64,
    },
    Poor {
        error: f64,
    },
    /// The step has passed a resonance as a whole, at this share of its length.
    Passed {
        share: f64,
    },
    Failed,
}

impl Continuation {
    /// Follows the branch from a solved point at the start of the range.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(settings: Settings, mut first: Point) -> Result<Self> {
        let n = first.v.len() - 1;
        if (settings.end - settings.start) * first.tangent[n] < 0.0 {
            first.reverse();
        }
        Ok(Self {
            settings,
            steps: settings.steps,
            corrector: corrector(n, &settings)?,
            size: norm(first.unknowns()),
            length: 0.0,
            largest: (norm(first.unknowns()), first.amplitude.norm()),
            history: History::new(n + 1)?,
            current: first,
            memory: StepMemory {
                unused: None,
                row: try_vec(n + 1, 0.0, CONTEXT)?,
                scratch: try_vec(n + 1, 0.0, CONTEXT)?,
                prediction: Vec::new(),
            },
            last_error: f64::INFINITY,
            stationary: 0,
            surfaces: Surfaces {
                may_leave: false,
                left: false,
            },
        })
    }

    /// Also lets the branch leave corners that it reaches along the surface of an event.
    #[must_use]
    pub fn leaving_surfaces(mut self) -> Self {
        self.surfaces.may_leave = true;
        self
    }

    /// Continues from `current` in place of the point accepted last, and from `previous` in place of the point
    /// before, both in the unknowns of a problem that may have more or fewer of them.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn go_on_from(&mut self, previous: Option<Point>, current: Point) -> Result<()> {
        let n = current.v.len() - 1;
        if n + 1 != self.memory.row.len() {
            self.corrector = corrector(n, &self.settings)?;
            self.memory.row = try_vec(n + 1, 0.0, CONTEXT)?;
            self.memory.scratch = try_vec(n + 1, 0.0, CONTEXT)?;
        }
        self.note_size(&current);
        self.history = History::new(n + 1)?;
        if let Some(previous) = previous {
            self.history.push(previous);
        }
        self.last_error = f64::INFINITY;
        self.current = current;
        Ok(())
    }

    /// Continues from a point, without the branch before it, by a first step that changes the parameter by at most
    /// about `change`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn start_at(&mut self, point: Point, change: f64) -> Result<()> {
        self.go_on_from(None, point)?;
        self.steps = self.settings.steps;
        self.change_at_most(change);
        Ok(())
    }

    /// Shortens the next step such that it changes the parameter by at most about `change`.
    pub fn change_at_most(&mut self, change: f64) {
        let metric = self.metric();
        let tangent = &self.current.tangent;
        let share = tangent[tangent.len() - 1].abs() / metric.p / metric.norm(tangent);
        self.steps.at_most(change / metric.p / share);
    }

    /// The point that was accepted last.
    #[must_use]
    pub fn current(&self) -> &Point {
        &self.current
    }

    /// Number of Newton steps over all points so far, failed ones included.
    #[must_use]
    pub fn steps_taken(&self) -> usize {
        self.corrector.steps_taken()
    }

    /// Takes the memory of a point that is no longer used for the next one.
    pub fn recycle(&mut self, point: Point) {
        self.memory.prediction = point.v;
        self.corrector.recycle(point.tangent);
    }

    /// The point accepted before the current one; `None` at the first point.
    #[must_use]
    pub fn previous(&self) -> Option<&Point> {
        self.history.previous()
    }

    /// Finds the next point. It must not be called again once the end of the range was reported.
    ///
    /// # Errors
    /// Those of the problem; `Callback` if a callback of the caller failed down to the smallest step;
    /// `StoppedByCaller`.
    pub fn advance(&mut self, problem: &mut dyn Problem, interrupt: &Interrupt<'_>) -> Result<Advance> {
        self.advance_over(problem, &[], interrupt)
    }

    /// Finds the next point, by a step that passes none of the resonances `known`, in ascending order, which the branch feels.
    ///
    /// # Errors
    /// As [`Self::advance`].
    pub fn advance_over(
        &mut self,
        problem: &mut dyn Problem,
        known: &[LinearResonance],
        interrupt: &Interrupt<'_>,
    ) -> Result<Advance> {
        if self.stationary >= MOST_STATIONARY {
            return Ok(Advance::Stopped(Status::StoppedStepTooSmall));
        }
        let metric = self.metric();
        let n = self.memory.row.len() - 1;
        loop {
            let step = self.steps.step();
            let (v, amplitude) = self.predict(metric, step)?;
            let (fixed, length) = match self.overshoot(v[n]) {
                None => (None, step),
                Some((bound, share)) => (Some(bound), share * step),
            };
            let attempt = if let Some(bound) = fixed {
                // The range ends here: predict exactly to its end, and solve there at the fixed parameter.
                let (mut v, amplitude) = self.predict(metric, length)?;
                v[n] = bound;
                self.try_point(problem, metric, v, amplitude, length, true, interrupt)?
            } else {
                self.try_point(problem, metric, v, amplitude, step, false, interrupt)?
            };
            match attempt {
                Attempt::Good { point, error, kept } => {
                    if fixed.is_none() && self.overshoot(point.parameter()).is_some() {
                        // The correction ran past the end: repeat with a shorter step.
                        if !self.steps.failed() {
                            return Ok(Advance::Stopped(Status::StoppedStepTooSmall));
                        }
                        continue;
                    }
                    if let Some(share) = self.crossed(problem, &point, length, known, interrupt)? {
                        self.steps.at_most(APPROACH * share * length);
                        continue;
                    }
                    self.steps
                        .accepted(length, error, self.history.order(), point.iterations);
                    self.steps.keep_direction(kept, length);
                    self.last_error = error;
                    return self.accept(point, fixed);
                }
                Attempt::Poor { error } => {
                    if !self.steps.rejected(error, self.history.order()) {
                        return Ok(Advance::Stopped(Status::StoppedStepTooSmall));
                    }
                }
                Attempt::Passed { share } => self.steps.at_most(APPROACH * share * length),
                Attempt::Failed => {
                    // The code below uses the corrector again.
                    let failure = self.corrector.failure();
                    if length <= CORNER_STEP
                        && let Some(point) = self.turn_corner(problem, metric, length, length, interrupt)?
                    {
                        return self.accept(point, None);
                    }
                    if !self.steps.failed() {
                        return match self.leave_corner(problem, metric, interrupt)? {
                            Some(point) => self.accept(point, None),
                            None => too_small(failure),
                        };
                    }
                }
            }
        }
    }

    fn accept(&mut self, point: Point, fixed: Option<f64>) -> Result<Advance> {
        self.note_size(&point);
        self.surfaces.left &= point.step < GROWN;
        let change = (point.parameter() - self.current.parameter()).abs();
        self.stationary = if change > ARC_LENGTH_ROUNDING * point.parameter().abs() {
            0
        } else if point.step > TINY {
            self.stationary + OF_STATIONARY
        } else {
            self.stationary + 1
        };
        let next = match self.memory.unused.take() {
            Some(old) => point.try_clone_into(old)?,
            None => point.try_clone()?,
        };
        self.memory.unused = self.history.push(core::mem::replace(&mut self.current, next));
        Ok(match fixed {
            Some(bound) if bound.to_bits() == self.settings.start.to_bits() => Advance::LeftAtStart { point },
            Some(_) => Advance::Accepted { point, last: true },
            None => Advance::Accepted { point, last: false },
        })
    }

    /// Stores the size of the point that becomes the current one.
    fn note_size(&mut self, point: &Point) {
        self.size = norm(point.unknowns());
        self.largest.0 = self.largest.0.max(self.size);
        self.largest.1 = self.largest.1.max(point.amplitude.norm());
    }

    /// Smallest size of the unknowns by which the metric is scaled: smaller motions do not refine it.
    fn least_size(&self) -> f64 {
        (FLOOR * self.largest.0).max(ROUNDING_OF_MOTION)
    }

    /// Units for the step that starts at the current point.
    fn metric(&self) -> Metric {
        Metric::along(self.size.max(self.least_size()), &self.settings)
    }

    /// Predicts point and amplitude one step ahead. Leaves the tangent as the row that defines the plane of the
    /// correction.
    fn predict(&mut self, metric: Metric, step: f64) -> Result<(Vec<f64>, Complex64)> {
        self.length = metric.unit(&self.current.tangent, &mut self.memory.row);
        let mut v = core::mem::take(&mut self.memory.prediction);
        v.clear();
        try_extend(&mut v, &self.memory.row, CONTEXT)?;
        let is_smooth = self.is_smooth();
        let amplitude = self.history.predict(&self.current, metric, (step, is_smooth), &mut v);
        Ok((v, amplitude))
    }

    /// Whether predictions are much better than the steps require, since the caller bounds these.
    fn is_smooth(&self) -> bool {
        self.last_error <= SMOOTH && self.steps.is_bounded_by_caller()
    }

    /// The bound of the range that the parameter value p exceeds, if any, and the share of the step up to it.
    fn overshoot(&self, p: f64) -> Option<(f64, f64)> {
        let here = self.current.parameter();
        let (start, end) = (self.settings.start, self.settings.end);
        let sense = (end - start).signum();
        let bound = if sense * (p - end) >= 0.0 {
            end
        } else if sense * (p - start) <= 0.0 && sense * (p - here) < 0.0 {
            start
        } else {
            return None;
        };
        Some((bound, ((bound - here) / (p - here)).clamp(0.0, 1.0)))
    }

    #[allow(clippy::too_many_arguments)]
    fn try_point(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        mut v: Vec<f64>,
        amplitude: Complex64,
        step: f64,
        keep_parameter: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<Attempt> {
        let n = v.len() - 1;
        self.memory.scratch.copy_from_slice(&v);
        if keep_parameter {
            self.memory.row.fill(0.0);
            self.memory.row[n] = 1.0;
        }
        // A foreseen end has the tangent of the point before the last step: where branches cross, that direction leads along another one
        // if steps are as short as Newton's.
        self.corrector.set_foresight(if self.is_smooth() {
            Foresight::AlongBranch
        } else if step < GROWN {
            Foresight::None
        } else {
            Foresight::WithinCorrection
        });
        let corrected = match self
            .corrector
            .correct(problem, &mut v, &self.memory.row, metric, false, interrupt)?
        {
            Outcome::Converged(corrected) => corrected,
            Outcome::Failed => return Ok(Attempt::Failed),
        };
        if keep_parameter {
            v[n] = self.memory.scratch[n];
        }
        let mut point = Point::new(v, corrected, step);
        let here = &self.current;
        if metric.dot(&point.tangent, &here.tangent) < 0.0 {
            point.reverse();
        }
        // The tangent and the chord must keep the direction: a branch never reverses within a step.
        let chord = metric.distance(&point.v, &here.v);
        let along = metric.dot(&point.v, &here.tangent) - metric.dot(&here.v, &here.tangent);
        let cosine = |dot: f64, a: f64, b: f64| if a * b > 0.0 { dot / (a * b) } else { 1.0 };
        let lengths = (self.length, metric.norm(&point.tangent));
        let kept = cosine(metric.dot(&point.tangent, &here.tangent), lengths.0, lengths.1);
        let turned = kept < STRAIGHT;
        // A change of sense is a jump over corners. Only where other branches cross this one does it belong to the
        // straight continuation, however short the step.
        let jumped = point.positive != here.positive && (step > CORNER_STEP || kept < same_line(step));
        let back = cosine(along, chord, lengths.0) < STRAIGHT;
        let far = chord > 3.0 * step;
        let size = norm(point.unknowns());
        let error = self.prediction_error(&self.memory.scratch, &point, size, amplitude);
        // A smooth curve that another one crosses changes its sense, too, and a step over the crossing is well predicted.
        let crossed = self.steps.crosses_branches() && error <= CROSSED.0 && kept >= CROSSED.1;
        let jumped = jumped && !crossed;
        self.history
            .judge(&self.memory.scratch, &point, &self.memory.row, metric);
        // Only the end of a homotopy counts, not the loops before it.
        let sees_loops = self.surfaces.may_leave && step > CORNER_STEP;
        let skips = point.skips_folds_from(here)
            || (sees_loops
                && skips_folds_of_cubic(
                    [here, &point],
                    [lengths.0, lengths.1],
                    arc_cubic::arc_length(chord, kept),
                ));
        if turned || jumped || back || far || skips {
            return Ok(Attempt::Failed);
        }
        if !self.steps.accepts(error) {
            return Ok(Attempt::Poor { error });
        }
        if step > self.steps.smallest().max(CORNER_STEP)
            && let Some(share) = problem.resonance_between(
                &here.as_end(self.size, lengths.0),
                &point.as_end(size, lengths.1),
                chord,
            )
        {
            return Ok(Attempt::Passed { share });
        }
        Ok(Attempt::Good { point, error, kept })
    }

    /// Relative error of the prediction in the motion and in the observed amplitude.
    fn prediction_error(&self, predicted: &[f64], point: &Point, size: f64, amplitude: Complex64) -> f64 {
        let relative = |difference: f64, size: f64| if difference == 0.0 { 0.0 } else { difference / size };
        let n = predicted.len() - 1;
        let squares = predicted[..n].iter().zip(&point.v).map(|(a, b)| (a - b) * (a - b));
        let difference = squares.sum::<f64>().sqrt();
        let motion = relative(difference, size.max(self.least_size()));
        let observed = relative(
            (amplitude - point.amplitude).norm(),
            point.amplitude.norm().max(FLOOR * self.largest.1),
        );
        motion.max(observed)
    }
}

/// Whether the cubic between two points has two folds: a small loop that the parameters of the ends do not show.
fn skips_folds_of_cubic([a, b]: [&Point; 2], lengths: [f64; 2], arc: f64) -> bool {
    let n = a.v.len() - 1;
    let slopes = [a.tangent[n] * arc / lengths[0], b.tangent[n] * arc / lengths[1]];
    arc_cubic::turns_twice(b.parameter() - a.parameter(), slopes)
}

/// Smallest cosine between two directions, one step apart, that count as one line.
fn same_line(step: f64) -> f64 {
    (LINE * step).clamp(LINE_BOUNDS.0, LINE_BOUNDS.1).cos()
}

/// Makes the corrector for points of a branch with n unknowns.
fn corrector(n: usize, settings: &Settings) -> Result<Corrector> {
    let tolerance = settings.steps.tolerance(settings.tolerance);
    Corrector::new(n, tolerance, settings.max_iterations)
}

/// Ends a branch when no step is small enough: with the error of a callback, or without a known cause.
fn too_small(failure: Option<Error>) -> Result<Advance> {
    match failure {
        Some(e) if e.status == Status::Callback => Err(e),
        _ => Ok(Advance::Stopped(Status::StoppedStepTooSmall)),
    }
}
