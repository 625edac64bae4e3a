//! A nonlinear mode as the tracer uses it: the equations at each resolution, and the records of its points.

use crate::analysis::modes::mode_equations::{Equations, LinearStart};
use crate::analysis::modes::mode_onset::OnsetSearch;
use crate::condense::Reduction;
use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::continuation::corrector::null_direction::null_direction;
use crate::continuation::resolve::resolve;
use crate::continuation::{Metric, Point, Settings};
use crate::error::{Result, boxed, try_copy};
use crate::harmonics::discretised::{Assessment, Discretised, Judged, LinearParts, Observed, Recorder};
use crate::harmonics::estimate_spacing::share_of_highest;
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::harmonics::mode_error::{ModeEstimator, ModeState, NO_DAMPING};
use crate::harmonics::resolutions::Resolutions;
use crate::harmonics::transfer::transferred_point;
use crate::harmonics::{Estimate, Solved};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::problem::Problem;
use crate::problem::epmc::Epmc;
use crate::results::stored::mode_branch::{ModeData, ModePoint};
use crate::results::{Branch, Record, SpecialKind};
use crate::tracing::branch_recorder::{BranchRecorder, Ending};
use num_complex::Complex64;

/// Share of the fundamental in the energy below which a motion is nearly that of another mode, with a part of the period. Its equations
/// for the fundamental are then near rounding, and have no branch point that is told.
/// Kind: tuned; measured on: not recorded.
pub(crate) const VANISHING_FUNDAMENTAL: f64 = 0.1;

/// A nonlinear mode in the form that the tracer follows.
pub(crate) struct ModeDiscretised<'a> {
    start: LinearStart<'a>,
    settings: Settings,
    resolutions: Resolutions<'a, Equations<'a>>,
    recorder: BranchRecorder<'a>,
    estimator: Option<Box<ModeEstimator<'a>>>,
    errors: ModeErrors,
    /// Largest modulus of the damping ratio so far.
    damping: f64,
    /// Fundamental of the previous point of the curve.
    before: Vec<Complex64>,
    guess_used: Option<bool>,
    onsets: OnsetSearch,
    /// Whether branch points are located.
    seeks_branches: bool,
}

/// Errors of frequency and damping at the point estimated last.
pub(crate) struct ModeErrors {
    /// Errors of frequency and damping ratio of the point estimated last, until it is recorded.
    estimated: Option<(f64, f64)>,
    /// Errors of frequency and damping ratio of the point estimated last.
    last: (f64, f64),
    /// Whether the caller requests the estimate of every point.
    each: bool,
}

/// Numbers of a point beside its motion.
struct Numbers {
    mode: ModePoint,
    omega: f64,
    amplitude: Complex64,
    sampling_error: f64,
    errors: (f64, f64),
}

impl<'a> ModeDiscretised<'a> {
    /// A nonlinear mode without points at a resolution.
    pub fn new(
        start: LinearStart<'a>,
        solver: &SolverOptions,
        settings: Settings,
        (levels, level): (&'a HarmonicLevels<'a>, usize),
        branch: Box<Branch>,
        estimator: Option<Box<ModeEstimator<'a>>>,
    ) -> Result<Self> {
        let resolution = levels.at(level)?;
        let equations = boxed(|| Equations::new(resolution, &start, &settings))?;
        Ok(Self {
            onsets: OnsetSearch::new(equations.problem.onset()?),
            resolutions: Resolutions::new(levels, level, equations)?,
            recorder: BranchRecorder::new(branch, solver.tolerance),
            start,
            settings,
            estimator,
            errors: ModeErrors {
                estimated: None,
                last: (f64::NAN, f64::NAN),
                each: solver.estimate_error,
            },
            damping: start.linear.damping.abs(),
            before: Vec::new(),
            guess_used: None,
            seeks_branches: false,
        })
    }

    /// Stores the data of the mode in its branch.
    pub fn set_mode(&mut self, data: ModeData) {
        self.recorder.branch_mut().set_mode(data);
    }

    /// Amplitudes, as log₁₀, up to which the mode is linear; see [`Epmc::linear_up_to`].
    pub fn linear_up_to(&mut self, first: f64) -> Result<(f64, f64)> {
        self.resolutions.current.problem.linear_up_to(first)
    }

    /// Seeks the first point of this resolution near given unknowns.
    pub fn set_guess(&mut self, guess: Vec<f64>) {
        self.resolutions.current.problem.set_guess(guess);
    }

    /// Locates the branch points of the curve.
    pub fn seek_branch_points(&mut self) {
        self.seeks_branches = true;
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
        null_direction(corrector, problem, &at.v, start, metric, interrupt)
    }

    /// Notes whether the first point was found from the given guess.
    pub fn note_guess(&mut self, used: bool) {
        self.guess_used = Some(used);
    }

    /// The linear mode as a point of the branch.
    pub fn linear_point(&mut self, p: f64) -> Result<Point> {
        self.resolutions.current.linear_point(p)
    }

    /// Completes the branch: its ending, its reduction, and its special points.
    pub fn finish(
        mut self: Box<Self>,
        model: &Model,
        solver: &SolverOptions,
        ending: &Ending,
        estimates: usize,
    ) -> Result<Box<Branch>> {
        if let Some(data) = self.recorder.branch_mut().mode_data_mut() {
            [data.info.slip_from, data.info.lift_off_from] = self.onsets.found();
        }
        let reduction = Reduction {
            guess_used: self.guess_used,
            ..self
                .resolutions
                .reduction(model, solver, self.recorder.branch().reduction())?
        };
        self.recorder.finish(ending, reduction, estimates)
    }

    /// Evaluates the problem at a point.
    fn evaluate(&mut self, point: &Point) -> Result<()> {
        let response_dof = self.branch().response_dof();
        self.resolutions.current.evaluate(point, response_dof)
    }

    /// Locates onsets between the point evaluated last and the one recorded before.
    fn note_onsets(&mut self, point: &Point) -> Result<()> {
        let Self {
            onsets,
            resolutions,
            settings,
            start,
            ..
        } = self;
        let (levels, index) = (resolutions.levels, resolutions.index());
        let transfer = |before: &Point, from: usize| {
            let (from, to) = (levels.at(from)?, levels.at(index)?);
            transferred_point(before, &from.condensed, &to.condensed, 3, false)
        };
        let problem = &mut resolutions.current.problem;
        if onsets.note(problem, (point, index), transfer, settings, start.interrupt)? {
            self.evaluate(point)?;
        }
        Ok(())
    }

    /// Error estimate of the point evaluated last; `None` unless requested.
    fn estimate_error(&mut self, point: &Point) -> Result<Option<Estimate>> {
        let Some(estimator) = &mut self.estimator else {
            return Ok(None);
        };
        let equations = &self.resolutions.current;
        let condensed = &equations.resolution.condensed;
        let DampedFrequency { omega, damping } = Epmc::frequency_and_damping(self.start.linear, point.unknowns());
        let solved = Solved {
            condensed,
            motion: &equations.vibration,
            omega,
            response: equations.response[condensed.set().fundamental()] * condensed.length(),
            watched: &[],
            together: false,
            sticks: Some(equations.problem.forces().all_stuck()),
            iterations: 0,
        };
        let state = ModeState {
            log10_amplitude: point.parameter(),
            damping,
            damping_unit: self.damping.max(damping.abs()).max(NO_DAMPING),
        };
        estimator.at(&solved, state).map(Some)
    }

    /// Numbers of the point evaluated last. Its errors are unknown where the solution is not isolated, as at a fold.
    fn measure(&mut self, point: &Point, is_singular: bool) -> Result<Numbers> {
        let mode = self.resolutions.current.measure(point, self.start.linear, &self.before);
        let omega = Epmc::frequency_and_damping(self.start.linear, point.unknowns()).omega;
        let equations = &mut *self.resolutions.current;
        let amplitude = equations.response[equations.resolution.condensed.set().fundamental()];
        let sampling_error = equations.problem.sampling_error(&equations.motion, omega)?;
        let errors = match self.errors.estimated.take() {
            _ if is_singular => (f64::NAN, f64::NAN),
            Some(errors) => errors,
            None => self
                .estimate_error(point)?
                .map_or((f64::NAN, f64::NAN), |e| (e.frequency, e.damping)),
        };
        if !is_singular {
            let error = self.bounded_error(errors, mode.damping_ratio);
            self.recorder.note_error(error);
        }
        Ok(Numbers {
            mode,
            omega,
            amplitude,
            sampling_error,
            errors,
        })
    }

    /// The error that the tolerance bounds: the larger of the frequency's relative error and the damping ratio's
    /// error over the largest ratio so far. NaN if either is unknown. Where a mode has no damping, the ratio counts
    /// as its round-off at least.
    fn bounded_error(&self, (of_frequency, of_damping): (f64, f64), damping: f64) -> f64 {
        let of_damping = if of_damping == 0.0 {
            0.0
        } else {
            of_damping / self.damping.max(damping.abs()).max(NO_DAMPING)
        };
        if of_frequency.is_nan() || of_damping.is_nan() {
            return f64::NAN;
        }
        of_damping.max(of_frequency)
    }
}

impl Discretised for ModeDiscretised<'_> {
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
        let (start, settings) = (&self.start, &self.settings);
        self.resolutions
            .select(resolution, |level| Equations::new(level, start, settings))
    }

    fn transfer(&self, point: &Point, from: usize) -> Result<Point> {
        self.resolutions.transfer(point, from, 3, false)
    }

    fn transfer_corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point> {
        let to = &self.resolutions.current.resolution.condensed;
        let mut start = self.transfer(point, from)?;
        let n = to.unknowns();
        let corrected = &estimate.corrected;
        let unit = 10f64.powf(point.parameter()) * to.length();
        to.set()
            .transfer(&corrected.set, &corrected.motion, 1.0 / unit, &mut start.v[..n]);
        let both = DampedFrequency::new(corrected.omega, corrected.damping);
        Epmc::set_frequency_and_damping(self.start.linear, both, &mut start.v[..n + 2]);
        Ok(start)
    }

    fn resolve(&mut self, near: &Point, keep_parameter: bool, interrupt: &Interrupt<'_>) -> Result<Option<Point>> {
        let Equations { problem, corrector, .. } = &mut *self.resolutions.current;
        resolve(problem, corrector, &self.settings, near, keep_parameter, interrupt)
    }

    fn estimate(&mut self, point: &Point) -> Result<Option<Assessment>> {
        self.errors.estimated = None;
        self.evaluate(point)?;
        let Some(estimate) = self.estimate_error(point)? else {
            return Ok(None);
        };
        let errors = (estimate.frequency, estimate.damping);
        self.errors.estimated = Some(errors);
        self.errors.last = errors;
        let damping = Epmc::frequency_and_damping(self.start.linear, point.unknowns()).damping;
        Ok(Some(Assessment {
            error: self.bounded_error(errors, damping),
            estimate,
        }))
    }

    fn share_of_highest(&self, point: &Point) -> f64 {
        let condensed = &self.resolutions.current.resolution.condensed;
        share_of_highest(condensed.set(), &point.unknowns()[..condensed.unknowns()])
    }

    fn take_over_estimate(&mut self, point: &Point, factor: f64) -> Result<bool> {
        self.evaluate(point)?;
        if self.errors.each || self.resolutions.current.problem.forces().all_stuck() {
            return Ok(false);
        }
        let (of_frequency, of_damping) = self.errors.last;
        self.errors.estimated = Some((of_frequency * factor, of_damping * factor));
        Ok(true)
    }
}

impl LinearParts for ModeDiscretised<'_> {}

impl Judged for ModeDiscretised<'_> {
    fn seeks_branch_points(&self) -> bool {
        let branch = self.recorder.branch();
        let last = branch.points().checked_sub(1).and_then(|last| branch.mode_at(last));
        self.seeks_branches && last.is_some_and(|last| last.fundamental_share >= VANISHING_FUNDAMENTAL)
    }

    /// The damping ratio is observed. Where it is zero, the model vibrates freely with this motion.
    fn level_of_limit_cycles(&self) -> Option<f64> {
        let linear = self.start.linear;
        let mut unknowns = [0.0; 2];
        Epmc::set_frequency_and_damping(linear, DampedFrequency::new(linear.omega, 0.0), &mut unknowns);
        Some(1.0 + unknowns[1])
    }
}

impl Observed for ModeDiscretised<'_> {}

impl Recorder for ModeDiscretised<'_> {
    fn record(&mut self, point: &Point) -> Result<()> {
        self.evaluate(point)?;
        self.note_onsets(point)?;
        // Every step that may fail comes before the storage.
        let numbers = self.measure(point, false)?;
        self.damping = self.damping.max(numbers.mode.damping_ratio.abs());
        if let Some(data) = self.recorder.branch_mut().mode_data_mut() {
            data.push_state(&point.v, &point.tangent)?;
            data.push(numbers.mode)?;
        }
        let equations = &self.resolutions.current;
        let record = record(equations, point, &numbers);
        self.recorder.record(&record, point.stalled)?;
        self.before = try_copy(equations.fundamental(), "the nonlinear mode")?;
        self.resolutions.note_recorded();
        Ok(())
    }

    /// Nothing to do: modes are factorised at each point of the curve, and no evaluation is more accurate.
    fn sharpen(&mut self, _kind: SpecialKind, point: &mut Point) -> Result<()> {
        self.evaluate(point)
    }

    fn record_special(&mut self, kind: SpecialKind, point: &Point) -> Result<()> {
        let is_branch_point = matches!(kind, SpecialKind::Bifurcation(..));
        let numbers = self.measure(point, kind.is_fold() || is_branch_point)?;
        if let Some(data) = self.recorder.branch_mut().mode_data_mut().filter(|_| is_branch_point) {
            data.push_branch_point(&point.v, &point.tangent)?;
        }
        let kind = match kind {
            SpecialKind::LimitCycle { .. } => {
                let along = point.tangent.last().copied().unwrap_or(f64::NAN);
                let slope = Epmc::damping_of_change(&[point.slope.re]) / along;
                SpecialKind::LimitCycle { slope }
            }
            kind => kind,
        };
        let equations = &self.resolutions.current;
        let record = record(equations, point, &numbers);
        self.recorder
            .record_special(kind, equations.resolution, &record, Some(numbers.mode))?;
        self.resolutions.note_recorded();
        Ok(())
    }

    fn sampling_factor(&self) -> usize {
        self.recorder.sampling_factor()
    }

    fn branch(&self) -> &Branch {
        self.recorder.branch()
    }
}

fn record<'b>(equations: &'b Equations<'_>, point: &Point, numbers: &Numbers) -> Record<'b> {
    Record {
        resolution: equations.resolution,
        omega: numbers.omega,
        motion: &equations.motion,
        amplitude: numbers.amplitude,
        response: &equations.response,
        residual: point.residual,
        iterations: point.iterations,
        slip_fractions: equations.problem.forces().slip_fractions(),
        sampling_error: numbers.sampling_error,
        errors: numbers.errors,
        seen: &[],
    }
}
