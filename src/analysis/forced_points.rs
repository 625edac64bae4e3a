//! The points of a forced response: what is measured and stored of each, and the harmonics that they are solved with.

use crate::adaptivity::branch_tracer::{Ending, Keeper};
use crate::adaptivity::controller::{AdaptivityController, Assessment, meets_tolerance};
use crate::adaptivity::harmonic_levels::{HarmonicLevels, Resolutions};
use crate::analysis::point_error::observed;
use crate::condense::Reduction;
use crate::continuation::corrector::Corrector;
use crate::continuation::resolve::resolve;
use crate::continuation::{Point, Settings};
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::error_estimate::forced_response_error::ForcedEstimator;
use crate::error_estimate::{Estimate, ExtendedModels, Solved};
use crate::model::Model;
use crate::model::spring::along;
use crate::options::SolverOptions;
use crate::problem::Problem;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::results::{Branch, Record, Resolution, SpecialKind};
use num_complex::Complex64;

/// The problem with the harmonics of one resolution.
struct AtResolution<'a> {
    level: &'a Resolution,
    problem: HarmonicBalance<'a>,
    corrector: Corrector,
    response: Vec<Complex64>,
}

impl<'a> AtResolution<'a> {
    fn new(level: &'a Resolution, settings: &Settings, response: usize, given: Option<Vec<f64>>) -> Result<Self> {
        let range = (settings.start, settings.end);
        let problem = HarmonicBalance::new(&level.condensed, response, range, level.samples, given)?;
        Ok(Self {
            corrector: Corrector::new(problem.unknowns(), settings.tolerance, settings.max_iterations)?,
            response: try_vec(level.condensed.blocks().len(), Complex64::ZERO, "the response")?,
            problem,
            level,
        })
    }
}

/// Collects the points of one run.
pub(super) struct ForcedPoints<'a> {
    branch: Branch,
    settings: Settings,
    resolutions: Resolutions<'a, AtResolution<'a>>,
    choice: AdaptivityController,
    estimator: Option<ForcedEstimator<'a>>,
    /// Whether the problem at hand may have been evaluated elsewhere than at the point at hand.
    stale: bool,
    /// Error of the point assessed last, until it is kept.
    assessed: Option<f64>,
    specials: Vec<Kept<'a>>,
    /// Whether some point misses the tolerance.
    missed: bool,
    stalled: bool,
}

/// A special point until the curve is complete.
struct Kept<'a> {
    kind: SpecialKind,
    level: &'a Resolution,
    point: Point,
    response: Vec<Complex64>,
    slip_fractions: Vec<f64>,
    sampling_error: f64,
    error: f64,
}

impl<'a> ForcedPoints<'a> {
    /// An empty collection, on a resolution whose problem may be given a start.
    pub fn new(
        model: &'a Model,
        solver: &SolverOptions,
        settings: Settings,
        (harmonic_levels, extended_models): (&'a HarmonicLevels<'a>, &'a ExtendedModels),
        (resolution, given): (usize, Option<Vec<f64>>),
        response: usize,
    ) -> Result<Self> {
        let level = harmonic_levels.level(resolution)?;
        let reported = if harmonic_levels.is_automatic() {
            0
        } else {
            solver.harmonics
        };
        let branch = Branch::new(level, level.condensed.reduction(model, solver)?, reported, response)?;
        let estimates = solver.estimate_error || harmonic_levels.is_automatic();
        Ok(Self {
            branch,
            resolutions: Resolutions::new(
                harmonic_levels,
                resolution,
                AtResolution::new(level, &settings, response, given)?,
            )?,
            settings,
            choice: AdaptivityController::new(solver.tolerance),
            estimator: estimates.then(|| ForcedEstimator::new(model, solver, response, extended_models)),
            stale: false,
            assessed: None,
            specials: Vec::new(),
            missed: false,
            stalled: false,
        })
    }

    /// What was removed from the problem that has the most harmonics.
    pub fn reduction(&self, model: &Model, solver: &SolverOptions) -> Result<Reduction> {
        self.resolutions.reduction(model, solver)
    }

    /// Evaluates the problem at a point, unless that was the last thing done on this resolution.
    fn refresh(&mut self, point: &Point) -> Result<()> {
        if self.stale {
            self.resolutions
                .here
                .corrector
                .evaluate(&mut self.resolutions.here.problem, &point.v)?;
            self.stale = false;
        }
        Ok(())
    }

    /// Estimate of a point that was evaluated last.
    fn estimate(&mut self, point: &Point) -> Result<Option<Estimate>> {
        let Some(estimator) = &mut self.estimator else {
            return Ok(None);
        };
        let here = &mut self.resolutions.here;
        let condensed = &here.level.condensed;
        here.problem.response(point.unknowns(), &mut here.response);
        let solved = Solved {
            condensed,
            motion: point.unknowns(),
            omega: point.parameter(),
            response: here.response[observed(condensed)] * condensed.length(),
            sticks: Some(here.problem.forces().all_stuck()),
        };
        estimator.at(&solved).map(Some)
    }

    /// Estimated relative error of the response amplitude; NaN where it is unknown or not asked for.
    fn error(&mut self, point: &Point) -> Result<f64> {
        match self.assessed.take() {
            Some(error) => Ok(error),
            None => Ok(self.estimate(point)?.map_or(f64::NAN, |e| e.response)),
        }
    }

    /// Numbers the special points after the curve.
    pub fn finish(mut self, ending: &Ending, reduction: Reduction) -> Result<Branch> {
        for kept in &self.specials {
            let errors = (kept.sampling_error, kept.error);
            let record = record(kept.level, &kept.point, &kept.response, &kept.slip_fractions, errors);
            self.branch.push_special(kept.kind, &record)?;
        }
        self.branch.set_reduction(reduction);
        self.branch.set_estimates(self.choice.estimates);
        self.branch
            .set_ending(ending.status, ending.reason, (self.stalled, self.missed));
        Ok(self.branch)
    }
}

impl Keeper for ForcedPoints<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        &mut self.resolutions.here.problem
    }

    fn branch(&self) -> &Branch {
        &self.branch
    }

    fn keep(&mut self, point: &Point) -> Result<()> {
        self.refresh(point)?;
        self.stalled |= point.stalled;
        let error = self.error(point)?;
        self.missed |= self.choice.is_missed_by(error);
        let here = &mut self.resolutions.here;
        here.problem.response(point.unknowns(), &mut here.response);
        let sampling_error = here.problem.sampling_error(point.unknowns(), point.parameter())?;
        let slips = here.problem.slip_fractions();
        let record = record(here.level, point, &here.response, slips, (sampling_error, error));
        self.branch.push_curve(&record)?;
        self.resolutions.note_kept();
        Ok(())
    }

    /// The point is solved once more at its frequency with the flexibility factorised there: along
    /// the sweep it may have been interpolated.
    fn keep_special(&mut self, kind: SpecialKind, mut point: Point, must: bool) -> Result<bool> {
        self.stale = false;
        let here = &mut self.resolutions.here;
        // At a fold the solution at a fixed frequency is not isolated.
        let mut found = None;
        if !kind.is_fold() {
            here.problem.set_pointwise(true);
            let again = resolve(
                &mut here.problem,
                &mut here.corrector,
                &self.settings,
                &point,
                true,
                None,
            );
            here.problem.set_pointwise(false);
            found = again?;
        }
        if let Some(found) = found {
            point.v = found.v;
            point.amplitude = found.amplitude;
            point.residual = found.residual;
        } else {
            here.corrector.evaluate(&mut here.problem, &point.v)?;
        }
        if !must && !meets_tolerance(self, kind, &point)? {
            return Ok(false);
        }
        let error = if kind.is_fold() { f64::NAN } else { self.error(&point)? };
        self.missed |= !kind.is_fold() && self.choice.is_missed_by(error);
        let here = &mut self.resolutions.here;
        here.problem.response(point.unknowns(), &mut here.response);
        let kept = Kept {
            kind,
            level: here.level,
            sampling_error: here.problem.sampling_error(point.unknowns(), point.parameter())?,
            error,
            response: try_copy(&here.response, "the special points")?,
            slip_fractions: try_copy(here.problem.slip_fractions(), "the special points")?,
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
        self.stale |= resolution != self.resolutions.resolution();
        let (settings, response) = (&self.settings, self.branch.response_dof());
        self.resolutions
            .go_to(resolution, |level| AtResolution::new(level, settings, response, None))
    }

    fn choice(&mut self) -> &mut AdaptivityController {
        &mut self.choice
    }

    fn assess(&mut self, point: &Point) -> Result<Option<Assessment>> {
        self.assessed = None;
        self.refresh(point)?;
        let Some(estimate) = self.estimate(point)? else {
            return Ok(None);
        };
        self.assessed = Some(estimate.response);
        Ok(Some(Assessment {
            error: estimate.response,
            estimate,
        }))
    }

    fn transfer(&self, point: &Point, from: usize) -> Result<Point> {
        self.resolutions.transfer(point, from, 1, true)
    }

    fn corrected(&self, point: &Point, from: usize, estimate: &Estimate) -> Result<Point> {
        let to = &self.resolutions.here.level.condensed;
        let mut start = self.transfer(point, from)?;
        let n = to.unknowns();
        let corrected = &estimate.corrected;
        to.set()
            .transfer(&corrected.set, &corrected.motion, 1.0 / to.length(), &mut start.v[..n]);
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
        let found = resolve(problem, corrector, &self.settings, near, keep_parameter, cancelled)?;
        self.stale = found.is_none();
        Ok(found)
    }
}

fn record<'a>(
    level: &'a Resolution,
    point: &'a Point,
    response: &'a [Complex64],
    slip_fractions: &'a [f64],
    (sampling_error, error): (f64, f64),
) -> Record<'a> {
    Record {
        resolution: level,
        omega: point.parameter(),
        motion: point.unknowns(),
        amplitude: point.amplitude,
        response,
        residual: point.residual,
        iterations: point.iterations,
        slip_fractions,
        sampling_error,
        errors: (error, f64::NAN),
    }
}

/// Packed relative motions of a guess given for all degrees of freedom.
pub(super) fn relative_motion(level: &Resolution, ndof: usize, guess: &[Complex64]) -> Result<Vec<f64>> {
    let condensed = &level.condensed;
    let set = condensed.set();
    let m = set.packed_len();
    let mut packed = try_vec(condensed.unknowns(), 0.0, "the guess")?;
    for (i, block) in condensed.blocks().iter().enumerate() {
        let Some(x) = guess.chunks_exact(ndof).nth(block.number) else {
            continue;
        };
        for (c, row) in block.rows.iter().enumerate() {
            let y = along(row, x);
            set.set(&mut packed[c * m..(c + 1) * m], i, y / condensed.length());
        }
    }
    Ok(packed)
}
