//! The points of a nonlinear mode: what is measured and stored of each.

use crate::adaptivity::branch_tracer::{Ending, Keeper};
use crate::adaptivity::controller::{AdaptivityController, Assessment, meets_tolerance};
use crate::adaptivity::harmonic_levels::{HarmonicLevels, Resolutions};
use crate::analysis::mode_resolution::{AtResolution, InitialGuess};
use crate::condense::Reduction;
use crate::continuation::resolve::resolve;
use crate::continuation::{Point, Settings};
use crate::error::{Result, try_copy, try_push};
use crate::error_estimate::mode_error::ModeEstimator;
use crate::error_estimate::{Estimate, Solved};
use crate::model::Model;
use crate::options::SolverOptions;
use crate::problem::Problem;
use crate::problem::epmc::{Epmc, LinearMode};
use crate::results::mode_branch::{ModeData, ModePoint};
use crate::results::{Branch, Record, Resolution, SpecialKind};
use num_complex::Complex64;

const CONTEXT: &str = "the nonlinear mode";

/// Collects the points of one run.
pub(super) struct ModePoints<'a> {
    start: InitialGuess<'a>,
    settings: Settings,
    resolutions: Resolutions<'a, AtResolution<'a>>,
    choice: AdaptivityController,
    branch: Branch,
    specials: Vec<Kept<'a>>,
    estimator: Option<ModeEstimator<'a>>,
    /// Errors of the point assessed last, until it is kept.
    assessed: Option<(f64, f64)>,
    /// Largest damping ratio met, in size.
    damping: f64,
    /// Fundamental of the point of the curve before.
    before: Vec<Complex64>,
    /// Whether some point misses the tolerance.
    missed: bool,
    stalled: bool,
}

/// A special point until the curve is complete.
struct Kept<'a> {
    kind: SpecialKind,
    level: &'a Resolution,
    point: Point,
    motion: Vec<f64>,
    response: Vec<Complex64>,
    slip_fractions: Vec<f64>,
    numbers: Numbers,
    mode: ModePoint,
}

/// Beside the motion: amplitude, sampling error and error estimates.
type Numbers = (Complex64, f64, (f64, f64));

impl<'a> ModePoints<'a> {
    /// An empty collection on a resolution.
    pub fn new(
        start: InitialGuess<'a>,
        solver: &SolverOptions,
        settings: Settings,
        (harmonic_levels, resolution): (&'a HarmonicLevels<'a>, usize),
        branch: Branch,
        estimator: Option<ModeEstimator<'a>>,
    ) -> Result<Self> {
        let level = harmonic_levels.level(resolution)?;
        Ok(Self {
            resolutions: Resolutions::new(
                harmonic_levels,
                resolution,
                AtResolution::new(level, &start, &settings)?,
            )?,
            start,
            settings,
            choice: AdaptivityController::new(solver.tolerance),
            specials: Vec::new(),
            estimator,
            assessed: None,
            damping: start.linear.damping.abs(),
            before: Vec::new(),
            missed: false,
            stalled: false,
            branch,
        })
    }

    /// Tells the branch of its mode.
    pub fn set_mode(&mut self, data: ModeData) {
        self.branch.set_mode(data);
    }

    /// log₁₀ of the amplitudes up to which the mode is linear, see [`Epmc::linear_up_to`].
    pub fn linear_up_to(&mut self, first: f64) -> Result<(f64, f64)> {
        self.resolutions.here.problem.linear_up_to(first)
    }

    /// The linear mode as a point of the branch.
    pub fn linear_point(&mut self, p: f64) -> Result<Point> {
        self.resolutions.here.linear_point(p)
    }

    /// Evaluates the problem at a point.
    fn evaluate(&mut self, point: &Point) -> Result<()> {
        self.resolutions.here.evaluate(point, self.branch.response_dof())
    }

    /// Estimate of the point evaluated last.
    fn estimate(&mut self, point: &Point) -> Result<Option<Estimate>> {
        let Some(estimator) = &mut self.estimator else {
            return Ok(None);
        };
        let here = &self.resolutions.here;
        let condensed = &here.level.condensed;
        let (omega, damping) = Epmc::frequency_and_damping(self.start.linear, point.unknowns());
        let solved = Solved {
            condensed,
            motion: &here.motion,
            omega,
            response: here.response[condensed.set().fundamental()] * condensed.length(),
            sticks: Some(here.problem.forces().all_stuck()),
        };
        estimator.at(&solved, point.parameter(), damping).map(Some)
    }

    /// Fundamental of the response and the errors of the point evaluated last.
    fn numbers(&mut self, point: &Point) -> Result<Numbers> {
        let omega = Epmc::frequency_and_damping(self.start.linear, point.unknowns()).0;
        let here = &mut self.resolutions.here;
        let amplitude = here.response[here.level.condensed.set().fundamental()];
        let sampling_error = here.problem.sampling_error(&here.motion, omega)?;
        let errors = match self.assessed.take() {
            Some(errors) => errors,
            None => self
                .estimate(point)?
                .map_or((f64::NAN, f64::NAN), |e| (e.frequency, e.damping)),
        };
        Ok((amplitude, sampling_error, errors))
    }

    /// An error of a damping ratio over the largest one so far.
    fn of_largest(&self, error: f64, damping: f64) -> f64 {
        if error == 0.0 {
            0.0
        } else {
            error / self.damping.max(damping.abs())
        }
    }

    /// Whether the errors of frequency and damping ratio at a point miss the tolerance.
    fn misses(&self, (frequency, damping): (f64, f64), ratio: f64) -> bool {
        self.choice.is_missed_by(frequency) || self.choice.is_missed_by(self.of_largest(damping, ratio))
    }

    /// What was removed from the problem that has the most harmonics.
    pub fn reduction(&self, model: &Model, solver: &SolverOptions) -> Result<Reduction> {
        self.resolutions.reduction(model, solver)
    }

    /// Numbers the special points after the curve.
    pub fn finish(mut self, ending: &Ending, reduction: Reduction) -> Result<Branch> {
        for kept in &self.specials {
            let record = record(
                (self.start.linear, kept.level),
                &kept.point,
                &kept.motion,
                &kept.response,
                &kept.slip_fractions,
                kept.numbers,
            );
            self.branch.push_special(kept.kind, &record)?;
            if let Some(data) = self.branch.mode_data_mut() {
                data.push(kept.mode)?;
            }
        }
        self.branch.set_reduction(reduction);
        self.branch.set_estimates(self.choice.estimates);
        self.branch
            .set_ending(ending.status, ending.reason, (self.stalled, self.missed));
        Ok(self.branch)
    }
}

impl Keeper for ModePoints<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        &mut self.resolutions.here.problem
    }

    fn branch(&self) -> &Branch {
        &self.branch
    }

    fn keep(&mut self, point: &Point) -> Result<()> {
        self.evaluate(point)?;
        let mode = self.resolutions.here.measure(point, self.start.linear, &self.before);
        // All that may fail comes before anything is kept.
        let numbers = self.numbers(point)?;
        self.missed |= self.misses(numbers.2, mode.damping_ratio);
        self.stalled |= point.stalled;
        self.damping = self.damping.max(mode.damping_ratio.abs());
        if let Some(data) = self.branch.mode_data_mut() {
            data.push_state(&point.v, &point.tangent)?;
            data.push(mode)?;
        }
        let here = &self.resolutions.here;
        let slip = here.problem.forces().slip_fractions();
        let i = here.level.condensed.set().fundamental();
        let of = (self.start.linear, here.level);
        let record = record(of, point, &here.motion, &here.response, slip, numbers);
        self.branch.push_curve(&record)?;
        let dofs = here.level.condensed.ndof();
        self.before = try_copy(&here.problem.shape()[i * dofs..(i + 1) * dofs], CONTEXT)?;
        self.resolutions.note_kept();
        Ok(())
    }

    fn keep_special(&mut self, kind: SpecialKind, point: Point, must: bool) -> Result<bool> {
        self.evaluate(&point)?;
        if !must && !meets_tolerance(self, kind, &point)? {
            return Ok(false);
        }
        let mode = self.resolutions.here.measure(&point, self.start.linear, &self.before);
        let mut numbers = self.numbers(&point)?;
        if kind.is_fold() {
            numbers.2 = (f64::NAN, f64::NAN);
        } else {
            self.missed |= self.misses(numbers.2, mode.damping_ratio);
        }
        let here = &self.resolutions.here;
        let kept = Kept {
            numbers,
            kind,
            level: here.level,
            motion: try_copy(&here.motion, "the special points")?,
            response: try_copy(&here.response, "the special points")?,
            slip_fractions: try_copy(here.problem.forces().slip_fractions(), "the special points")?,
            mode,
            point,
        };
        self.choice.folded |= kind.is_fold();
        try_push(&mut self.specials, kept, "the special points")?;
        self.resolutions.note_kept();
        Ok(true)
    }

    fn harmonic_levels(&self) -> &HarmonicLevels<'_> {
        self.resolutions.harmonic_levels
    }

    fn resolution(&self) -> usize {
        self.resolutions.resolution()
    }

    fn go_to(&mut self, resolution: usize) -> Result<()> {
        let (start, settings) = (&self.start, &self.settings);
        self.resolutions
            .go_to(resolution, |level| AtResolution::new(level, start, settings))
    }

    fn choice(&mut self) -> &mut AdaptivityController {
        &mut self.choice
    }

    /// The error is that of the frequency, relative, or of the damping ratio, over the largest one so far.
    fn assess(&mut self, point: &Point) -> Result<Option<Assessment>> {
        self.assessed = None;
        self.evaluate(point)?;
        let Some(estimate) = self.estimate(point)? else {
            return Ok(None);
        };
        self.assessed = Some((estimate.frequency, estimate.damping));
        let damping = Epmc::frequency_and_damping(self.start.linear, point.unknowns()).1;
        let of_damping = self.of_largest(estimate.damping, damping);
        // Both are unknown, or none.
        let error = if estimate.certified {
            of_damping.max(estimate.frequency)
        } else {
            f64::NAN
        };
        Ok(Some(Assessment { error, estimate }))
    }

    fn transfer(&self, point: &Point, from: usize) -> Result<Point> {
        self.resolutions.transfer(point, from, 3, false)
    }

    fn corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point> {
        let to = &self.resolutions.here.level.condensed;
        let mut start = self.transfer(point, from)?;
        let n = to.unknowns();
        let corrected = &estimate.corrected;
        let unit = 10f64.powf(point.parameter()) * to.length();
        to.set()
            .transfer(&corrected.set, &corrected.motion, 1.0 / unit, &mut start.v[..n]);
        let both = (corrected.omega, corrected.damping);
        Epmc::set_frequency_and_damping(self.start.linear, both, &mut start.v[..n + 2]);
        Ok(start)
    }

    fn resolve(
        &mut self,
        near: &Point,
        keep_parameter: bool,
        cancelled: Option<&dyn Fn() -> bool>,
    ) -> Result<Option<Point>> {
        let here = &mut self.resolutions.here;
        let (problem, corrector) = (&mut here.problem, &mut here.corrector);
        resolve(problem, corrector, &self.settings, near, keep_parameter, cancelled)
    }
}

fn record<'a>(
    (linear, level): (&LinearMode, &'a Resolution),
    point: &'a Point,
    motion: &'a [f64],
    response: &'a [Complex64],
    slip_fractions: &'a [f64],
    (amplitude, sampling_error, errors): Numbers,
) -> Record<'a> {
    Record {
        resolution: level,
        omega: Epmc::frequency_and_damping(linear, point.unknowns()).0,
        motion,
        amplitude,
        response,
        residual: point.residual,
        iterations: point.iterations,
        slip_fractions,
        sampling_error,
        errors,
    }
}
