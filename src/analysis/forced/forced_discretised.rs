//! A forced response as the tracer uses it: the equations at each resolution, and the records of its points.

use crate::analysis::forced::fine_motion::FineMotion;
use crate::analysis::forced::forced_equations::Equations;
use crate::analysis::forced::linear_response::LinearResponse;
use crate::analysis::forced::point_error::observed;
use crate::analysis::forced::watched_responses::WatchedResponses;
use crate::analysis::perturbed::branch_stability::BranchStability;
use crate::condense::FlexibilityWay;
use crate::condense::blocks::reduction::reduction;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::reduced_resonances;
use crate::condense::{ModelCache, Reduction, Reference};
use crate::continuation::corrector::Outcome;
use crate::continuation::corrector::deflated;
use crate::continuation::corrector::null_direction::null_direction;
use crate::continuation::resolve::resolve;
use crate::continuation::{Metric, ONE_SOLUTION, Point, PointAt, Settings};
use crate::error::{Result, boxed, try_copy, try_extend, try_vec};
use crate::harmonics::discretised::{Assessment, Discretised, Judged, LinearParts, Observed};
use crate::harmonics::estimate_spacing::share_of_highest;
use crate::harmonics::forced_response_error::ForcedEstimator;
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::harmonics::resolutions::Resolutions;
use crate::harmonics::transfer::transferred_point;
use crate::harmonics::{Estimate, Solved};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::model::Model;
use crate::model::matrices::spring::along;
use crate::model::natural_modes::linear_modes::ContactState;
use crate::model::natural_modes::resonances::Resonance;
use crate::options::Range;
use crate::options::{Measure, Response, SolverOptions};
use crate::problem::Problem;
use crate::problem::gauges::Seen;
use crate::results::{Branch, Resolution, Verdict};
use crate::tracing::branch_recorder::{BranchRecorder, Ending};
use num_complex::Complex64;

mod forced_records;

/// A forced response in the form that the tracer follows.
pub(crate) struct ForcedDiscretised<'a> {
    model: &'a Model,
    settings: Settings,
    interrupt: &'a Interrupt<'a>,
    resolutions: Resolutions<'a, Equations<'a>>,
    linear_response: LinearResponse<'a>,
    recorder: BranchRecorder<'a>,
    estimator: Option<Box<ForcedEstimator<'a>>>,
    state: PointState,
    errors: ForcedErrors,
    responses: WatchedResponses<'a>,
    told: ForcedTold,
    verdicts: ForcedStability<'a>,
}

/// Errors of the point estimated last.
pub(crate) struct ForcedErrors {
    /// Error of the point estimated last, until it is recorded.
    estimated: Option<f64>,
    /// Error of the point estimated last; and errors of the requested responses.
    last: f64,
    of_responses: Vec<f64>,
    /// Whether the caller requests the estimate of every point.
    each: bool,
}

/// Stability, and motions with more harmonics for it.
pub(crate) struct ForcedStability<'a> {
    of_points: Option<BranchStability<'a>>,
    /// Motions with more harmonics, as starts of shooting for stability.
    fine: Option<FineMotion<'a>>,
}

/// Facts of a run that are told.
pub(crate) struct ForcedTold {
    /// Newton iterations of the first point.
    first_iterations: usize,
    guess_used: Option<bool>,
    flexibility_way: FlexibilityWay,
}

/// State of the problem and of the point recorded last.
pub(crate) struct PointState {
    /// Whether the current problem may have been evaluated last at another point than the current one.
    stale: bool,
    /// Whether every contact was linear at the point of the curve recorded last.
    linear: bool,
}

impl<'a> ForcedDiscretised<'a> {
    /// A forced response without points at a resolution, whose problem may have an initial guess.
    pub fn new(
        model: &'a Model,
        solver: &SolverOptions,
        settings: Settings,
        (levels, stuck, extended): (
            &'a HarmonicLevels<'a>,
            &'a HarmonicLevels<'a>,
            (&'a ModelCache, &'a SharedWaves),
        ),
        (level, guess): (usize, Option<Vec<f64>>),
        (responses, together, response): (&'a [Response<'a>], bool, usize),
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let resolution = levels.at(level)?;
        let reported = if levels.is_automatic() { 0 } else { solver.harmonics };
        let reduction = reduction(&resolution.condensed, model, solver, interrupt)?;
        let mut branch = boxed(|| Branch::new(resolution, reduction, reported, response))?;
        if solver.stability.is_some() {
            branch.tell_stability();
        }
        let responses = WatchedResponses::new(responses, together);
        branch.watch((responses.list, together), responses.is_observed())?;
        let estimates = solver.estimate_error || levels.is_automatic();
        let stability = match solver.stability {
            Some(waves) => Some(BranchStability::new(model, waves, settings.start, interrupt)?),
            None => None,
        };
        let equations = boxed(|| Equations::new(resolution, &settings, (responses.list, response), guess, interrupt))?;
        Ok(Self {
            told: ForcedTold {
                first_iterations: 0,
                guess_used: None,
                flexibility_way: equations.problem.flexibility_way(),
            },
            recorder: BranchRecorder::new(branch, solver.tolerance),
            resolutions: Resolutions::new(levels, level, equations)?,
            linear_response: LinearResponse::new(stuck),
            model,
            settings,
            interrupt,
            estimator: estimates
                .then(|| {
                    let estimator = ForcedEstimator::new(model, solver, response, extended, interrupt);
                    boxed(|| {
                        Ok(estimator
                            .over(Range::new(settings.start, settings.end))
                            .watching(responses.list))
                    })
                })
                .transpose()?,
            state: PointState {
                stale: false,
                linear: false,
            },
            errors: ForcedErrors {
                estimated: None,
                last: f64::NAN,
                of_responses: Vec::new(),
                each: solver.estimate_error,
            },
            responses,
            verdicts: ForcedStability {
                fine: match &stability {
                    Some(stability) if stability.on_all_degrees => {
                        let observed = (response, Range::new(settings.start, settings.end));
                        Some(FineMotion::new(model, solver, observed, extended, interrupt)?)
                    }
                    _ => None,
                },
                of_points: stability,
            },
        })
    }

    /// Notes the first point: its iterations bound the work of an estimate.
    pub fn note_first(&mut self, first: &Point) {
        self.told.first_iterations = first.iterations;
    }

    /// Notes whether the first point was found from the given guess, if there was one.
    pub fn note_guess(&mut self, used: Option<bool>) {
        self.told.guess_used = used;
    }

    /// The null vector of the Jacobian at a point of the current resolution, by inverse iteration from a start, and the size of its
    /// eigenvalue.
    pub fn null_direction(
        &mut self,
        at: &Point,
        start: &[f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<(Vec<f64>, f64)>> {
        let Equations { problem, corrector, .. } = &mut *self.resolutions.current;
        let metric = Metric::along(norm(at.unknowns()), &self.settings);
        self.state.stale = true;
        null_direction(corrector, problem, &at.v, start, metric, interrupt)
    }

    /// Packed relative motions of the contacts in the current harmonics, from a motion of all degrees of freedom.
    pub fn packed(&self, motion: &[Complex64]) -> Result<Vec<f64>> {
        relative_motion(self.resolutions.current.resolution, motion)
    }

    /// Solves at the parameter of a start, wherever the solution lies; `None` where Newton's method fails.
    pub fn solve_at(&mut self, near: &Point, interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        let Equations { problem, corrector, .. } = &mut *self.resolutions.current;
        let n = near.unknowns().len();
        let mut row = try_vec(n + 1, 0.0, "a start")?;
        row[n] = 1.0;
        let mut v = try_copy(&near.v, "a start")?;
        let metric = Metric::along(norm(near.unknowns()), &self.settings);
        self.state.stale = true;
        let outcome = corrector.correct(problem, &mut v, &row, metric, true, interrupt)?;
        let Outcome::Converged(corrected) = outcome else {
            return Ok(None);
        };
        v[n] = near.parameter();
        Ok(Some(Point::new(v, corrected, 0.0)))
    }

    /// Solves at the parameter of a start, away from known solutions; `None` where deflated steps do not converge, or
    /// lead to one of these all the same.
    pub fn solve_beside(
        &mut self,
        near: &Point,
        known: &[Vec<f64>],
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<Point>> {
        let mut beside = near.try_clone()?;
        let metric = Metric::along(norm(near.unknowns()), &self.settings);
        self.state.stale = true;
        let Equations { problem, corrector, .. } = &mut *self.resolutions.current;
        if !deflated::leave_known(corrector, problem, &mut beside.v, known, metric, interrupt)? {
            return Ok(None);
        }
        let Some(found) = self.solve_at(&beside, interrupt)? else {
            return Ok(None);
        };
        let u = found.unknowns();
        let is_one = |known: &Vec<f64>| {
            let gap = u.iter().zip(known).fold(0.0_f64, |gap, (u, k)| gap.hypot(u - k));
            gap <= ONE_SOLUTION * norm(known)
        };
        let is_known = known.iter().any(is_one);
        Ok((!is_known).then_some(found))
    }

    /// How the flexibility is made along the branch, and why in this way.
    pub fn flexibility_way(&self) -> FlexibilityWay {
        self.told.flexibility_way
    }

    /// Completes the branch: its ending, its reduction, and its special points.
    pub fn finish(
        self: Box<Self>,
        model: &Model,
        solver: &SolverOptions,
        ending: &Ending,
        estimates: usize,
    ) -> Result<Box<Branch>> {
        let reduction = Reduction {
            guess_used: self.told.guess_used,
            flexibility_way: self.told.flexibility_way,
            ..self
                .resolutions
                .reduction(model, solver, self.recorder.branch().reduction())?
        };
        self.recorder.finish(ending, reduction, estimates)
    }

    /// Evaluates the problem at a point, unless this was the last point of evaluation.
    fn refresh(&mut self, point: &Point) -> Result<()> {
        if self.state.stale {
            let Equations { problem, corrector, .. } = &mut *self.resolutions.current;
            corrector.evaluate(problem, &point.v)?;
            self.state.stale = false;
        }
        Ok(())
    }

    /// Estimate of the point evaluated last, `again`: the second one.
    fn estimate_error(&mut self, point: &Point, again: bool) -> Result<Option<Estimate>> {
        let Some(estimator) = &mut self.estimator else {
            return Ok(None);
        };
        let index = self.resolutions.index();
        let Equations {
            resolution, problem, ..
        } = &mut *self.resolutions.current;
        self.responses
            .read(problem, (point, index), resolution.condensed.length())?;
        let solved = Solved {
            watched: &self.responses.watched,
            together: self.responses.together,
            ..solved(&mut self.resolutions.current, point, self.told.first_iterations)
        };
        if again {
            return estimator.again(&solved);
        }
        estimator.at(&solved).map(Some)
    }

    /// Keeps an estimate until its point is recorded.
    fn keep(&mut self, estimate: Estimate) -> Result<Assessment> {
        self.errors.estimated = Some(estimate.response);
        self.errors.last = estimate.response;
        self.errors.of_responses.clear();
        try_extend(&mut self.errors.of_responses, &estimate.responses, "the responses")?;
        Ok(Assessment {
            error: estimate.response,
            estimate,
        })
    }

    /// The motion of the point evaluated last with more harmonics, where stability needs it and it is certified.
    fn fine_motion(&mut self, point: &Point) -> Result<Option<Vec<Complex64>>> {
        let Some(fine) = &mut self.verdicts.fine else {
            return Ok(None);
        };
        let iterations = self.told.first_iterations;
        fine.at(&solved(&mut self.resolutions.current, point, iterations))
    }

    /// Estimated relative error of the response amplitude; NaN if unknown or not requested.
    fn error(&mut self, point: &Point) -> Result<f64> {
        if let Some(error) = self.errors.estimated.take() {
            return Ok(error);
        }
        let found = self.estimate_error(point, false)?;
        self.errors.of_responses.clear();
        let Some(found) = found else { return Ok(f64::NAN) };
        try_extend(&mut self.errors.of_responses, &found.responses, "the responses")?;
        Ok(found.response)
    }

    /// A response at a point of a resolution, possibly from an earlier reading. The current resolution is kept.
    fn read_response(&mut self, response: usize, at: PointAt<'_>) -> Result<Option<Seen>> {
        let current = self.resolutions.index();
        let is_known = self.responses.has_read(at);
        if !is_known {
            self.select(at.1)?;
        }
        let problem = &mut self.resolutions.current.problem;
        let found = self.responses.read_at(problem, at)?.get(response).copied();
        if !is_known {
            self.select(current)?;
        }
        Ok(found)
    }
}

impl Discretised for ForcedDiscretised<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        &mut self.resolutions.current.problem
    }

    fn levels(&self) -> &HarmonicLevels<'_> {
        self.resolutions.levels
    }

    fn resolution(&self) -> usize {
        self.resolutions.index()
    }

    fn select(&mut self, resolution: usize) -> Result<()> {
        self.state.stale |= resolution != self.resolutions.index();
        let (settings, response) = (&self.settings, self.recorder.branch().response_dof());
        let (interrupt, responses) = (self.interrupt, self.responses.list);
        self.resolutions.select(resolution, |level| {
            Equations::new(level, settings, (responses, response), None, interrupt)
        })
    }

    fn transfer(&self, point: &Point, from: usize) -> Result<Point> {
        self.resolutions.transfer(point, from, 1, true)
    }

    fn transfer_corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point> {
        let to = &self.resolutions.current.resolution.condensed;
        let mut start = self.transfer(point, from)?;
        let n = to.unknowns();
        let corrected = &estimate.corrected;
        to.set()
            .transfer(&corrected.set, &corrected.motion, 1.0 / to.length(), &mut start.v[..n]);
        Ok(start)
    }

    fn resolve(&mut self, near: &Point, keep_parameter: bool, interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        let Equations { problem, corrector, .. } = &mut *self.resolutions.current;
        let found = resolve(problem, corrector, &self.settings, near, keep_parameter, interrupt)?;
        self.state.stale = found.is_none();
        Ok(found)
    }

    fn share_work(&mut self) {
        if let Some(estimator) = &mut self.estimator {
            estimator.share_work();
        }
    }

    fn estimate(&mut self, point: &Point) -> Result<Option<Assessment>> {
        self.errors.estimated = None;
        self.refresh(point)?;
        let found = self.estimate_error(point, false)?;
        found.map(|estimate| self.keep(estimate)).transpose()
    }

    fn estimate_again(&mut self, point: &Point) -> Result<Option<Assessment>> {
        self.refresh(point)?;
        let found = self.estimate_error(point, true)?;
        found.map(|estimate| self.keep(estimate)).transpose()
    }

    fn share_of_highest(&self, point: &Point) -> f64 {
        share_of_highest(self.resolutions.current.resolution.condensed.set(), point.unknowns())
    }

    fn take_over_estimate(&mut self, point: &Point, factor: f64) -> Result<bool> {
        self.refresh(point)?;
        if self.errors.each || self.resolutions.current.problem.forces().all_stuck() {
            return Ok(false);
        }
        self.errors.estimated = Some(self.errors.last * factor);
        for error in &mut self.errors.of_responses {
            *error *= factor;
        }
        Ok(true)
    }
}

impl LinearParts for ForcedDiscretised<'_> {
    fn resonances(&mut self, range: Range) -> Result<Option<Vec<Resonance>>> {
        let condensed = &self.resolutions.current.resolution.condensed;
        if condensed.is_reduced() {
            return reduced_resonances(self.model, condensed, range, self.interrupt);
        }
        self.model.forced_resonances(range, ContactState::Stuck, self.interrupt)
    }

    fn linear_at(&mut self, near: &Point, parameter: f64, interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        let index = self.resolutions.index();
        let response = self.recorder.branch().response_dof();
        let condensed = &self.resolutions.current.resolution.condensed;
        let needed = condensed.coordinates() > 0
            && condensed.reference() == Reference::Complex
            && self.model.structure().is_damped();
        let own = self.linear_response.equations(needed, index, |resolution| {
            Equations::new(resolution, &self.settings, (&[], response), None, self.interrupt)
        });
        let settings = &self.settings;
        let current = &mut *self.resolutions.current;
        self.state.stale = true;
        let Some(own) = own? else {
            let found = current.linear_at(settings, (near, parameter), interrupt)?;
            self.state.stale = found.is_none();
            return Ok(found);
        };
        let (to, from) = (&current.resolution.condensed, &own.resolution.condensed);
        let start = transferred_point(near, to, from, 1, true)?;
        let found = own.linear_at(settings, (&start, parameter), interrupt)?;
        self.linear_response.solved = found.is_some().then_some(parameter);
        match found {
            Some(point) => transferred_point(&point, from, to, 1, true).map(Some),
            None => Ok(None),
        }
    }

    fn linear_share(&mut self, point: &Point) -> Result<f64> {
        let problem = &mut self.resolutions.current.problem;
        problem.linear_share(point.unknowns(), point.parameter())
    }

    fn is_linear(&self) -> bool {
        self.state.linear
    }
}

impl Judged for ForcedDiscretised<'_> {
    fn verdict(&mut self, point: &Point) -> Result<Option<Verdict>> {
        self.state.stale |= self.verdicts.fine.is_some();
        self.refresh(point)?;
        let fine = self.fine_motion(point)?;
        let resolution = self.resolutions.current.resolution;
        let found = self
            .verdicts
            .of_points
            .as_mut()
            .map(|s| s.at(resolution, point, fine.as_deref()));
        found.transpose()
    }

    fn may_start_anywhere(&self) -> bool {
        true
    }

    fn take_verdicts(&mut self) -> Option<(Verdict, Verdict)> {
        self.verdicts.of_points.as_mut()?.take_last()
    }
}

impl Observed for ForcedDiscretised<'_> {
    fn further_responses(&self) -> core::ops::Range<usize> {
        usize::from(self.responses.is_observed())..self.responses.list.len()
    }

    fn responses(&self) -> usize {
        self.responses.list.len()
    }

    fn reading_of(&mut self, response: usize, at: PointAt<'_>) -> Result<Option<Seen>> {
        let has_instant = |one: &Response<'_>| matches!(one.measure, Measure::Peak | Measure::Range);
        if !self.responses.list.get(response).is_some_and(has_instant) {
            return Ok(None);
        }
        self.read_response(response, at)
    }

    fn observes_peaks(&self) -> bool {
        self.responses.list.is_empty() || self.responses.is_observed()
    }

    fn seen_by(&mut self, response: usize, at: PointAt<'_>) -> Result<Point> {
        let mut seen = at.0.try_clone()?;
        if let Some(found) = self.read_response(response, at)? {
            (seen.amplitude, seen.slope) = found.observed();
        }
        Ok(seen)
    }
}

/// The point evaluated last, for an estimate of its amplitude alone.
fn solved<'p>(current: &'p mut Equations<'_>, point: &'p Point, iterations: usize) -> Solved<'p> {
    let Equations {
        resolution,
        problem,
        response,
        ..
    } = current;
    let condensed = &resolution.condensed;
    problem.response(point.unknowns(), point.parameter(), response);
    Solved {
        condensed,
        motion: point.unknowns(),
        omega: point.parameter(),
        response: response[observed(condensed)] * condensed.length(),
        watched: &[],
        together: false,
        sticks: Some(problem.forces().all_stuck()),
        iterations,
    }
}

/// Packed relative motions of a guess given for all degrees of freedom.
pub(crate) fn relative_motion(resolution: &Resolution, guess: &[Complex64]) -> Result<Vec<f64>> {
    let condensed = &resolution.condensed;
    let degrees = condensed.degrees();
    let mut x = try_vec(degrees.independent(), Complex64::ZERO, "the guess")?;
    let set = condensed.set();
    let m = set.packed_len();
    let mut packed = try_vec(condensed.unknowns(), 0.0, "the guess")?;
    for (i, block) in condensed.blocks().iter().enumerate() {
        let Some(all) = guess.chunks_exact(degrees.given()).nth(block.number) else {
            continue;
        };
        degrees.restrict(all, &mut x);
        for (c, row) in block.motions.structural_rows.iter().enumerate() {
            let y = along(row, &x);
            set.set(&mut packed[c * m..(c + 1) * m], i, y / condensed.length());
        }
    }
    condensed.exchange_start(&mut packed);
    Ok(packed)
}
