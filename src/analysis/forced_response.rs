//! Forced response over a range of frequency.

use super::estimate::observed;
use super::follow::{Ending, Keeper, Task};
use super::unbounded;
use crate::branch::{Branch, Record, SpecialKind};
use crate::condense::Condensed;
use crate::condense::flexibility::Workspace;
use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::start::{self, First};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Metric, Point, Settings};
use crate::error::{Error, Result, Status, fail, try_copy, try_push, try_vec};
use crate::error_estimate::Solved;
use crate::error_estimate::forced::ForcedEstimator;
use crate::hooks::{Hooks, LogLevel};
use crate::linalg::norm;
use crate::model::Model;
use crate::model::spring::along;
use crate::options::{ForcedOptions, SolverOptions};
use crate::problem::Problem;
use crate::problem::forced::Forced;
use num_complex::Complex64;
use std::sync::Arc;

/// Follows the periodic response of `model` to its forces from `range.omega_start` to
/// `range.omega_stop` by harmonic balance and arc-length continuation.
///
/// A branch that ends early is returned with a positive [`Branch::status`] and every point found.
///
/// # Errors
/// Bad options and models (see [`SolverOptions::check`], [`ForcedOptions::check`],
/// [`Condensed::new`]), `NoConvergence` when no first point was found, `NoBoundedSolution` when it is known that there is none
/// (see [`Model::overload`]), `Callback` when that is a callback's
/// doing.
pub fn forced_response(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    solver.check()?;
    range.check((solver.harmonics + 1).saturating_mul(model.ndof()))?;
    if let Some(dof) = solver.response_dof.filter(|&d| d >= model.ndof()) {
        return fail!(Index, "response_dof = {dof}, needs 0 .. {}", model.ndof() - 1);
    }
    let condensed = Arc::new(Condensed::new(model, solver, range.omega_start)?);
    let response = match solver.response_dof {
        Some(dof) => dof,
        // At the lower end, so that both directions follow the same one.
        None => forced_dof_that_moves_most(model, &condensed, range.omega_start.min(range.omega_stop))?,
    };
    let given = match range.guess {
        Some(guess) => Some(relative_motion(&condensed, guess)?),
        None => None,
    };
    let settings = Settings {
        start: range.omega_start,
        end: range.omega_stop,
        tolerance: solver.tol_residual,
        max_iterations: solver.max_newton,
        steps: StepControl::new(solver.step, solver.step_min, solver.step_max),
    };
    let mut problem = Forced::new(
        &condensed,
        response,
        (range.omega_start, range.omega_stop),
        solver.samples,
        given,
    )?;
    let reduction = condensed.reduction(model, solver)?;
    let branch = Branch::new(
        Arc::clone(&condensed),
        reduction,
        solver.samples,
        solver.harmonics,
        response,
    );
    let held = reduction.held_by_contacts;
    let start = start::solve(&mut problem, &settings, hooks.cancelled);
    let first = match start.map_err(|e| tell_why(e, model, range.omega_start, &condensed, held))? {
        First::Found(point, way) => Some((point, way)),
        First::Cancelled => None,
    };
    let mut points = Points {
        corrector: Corrector::new(problem.size(), settings.tolerance, settings.max_iterations)?,
        branch,
        settings,
        problem,
        specials: Vec::new(),
        condensed: &condensed,
        estimator: solver
            .estimate_error
            .then(|| ForcedEstimator::new(model, solver, response)),
        response: try_vec(condensed.blocks().len(), Complex64::ZERO, "the response")?,
        stalled: false,
    };
    let task = Task {
        settings,
        range: (range.omega_start, range.omega_stop),
        at: range.at,
        max_points: solver.max_points,
        // As far again as the range is long, but never near zero frequency.
        before: Some((2.0 * range.omega_start - range.omega_stop).max(0.5 * range.omega_start)),
    };
    let outcome = match first {
        Some((first, way)) => {
            hooks.log(LogLevel::Info, way.sentence());
            task.run(&mut points, first, hooks)
        }
        None => Ok(Status::StoppedByCaller),
    };
    let mut ending = Ending::of(outcome, &points.branch)?;
    if ending.status == Status::StoppedStepTooSmall && ending.reason.is_none() {
        let last = points.branch.omega().last();
        ending.reason = last.and_then(|&omega| unbounded::reason(model, omega));
    }
    points.finish(&ending)
}

/// Why no first point was found, as far as it is known: there is none, or, where contacts press at rest, it comes
/// from the static solution.
fn tell_why(e: Error, model: &Model, omega: f64, condensed: &Condensed, held: usize) -> Error {
    if e.status != Status::NoConvergence {
        return e;
    }
    if let Some(reason) = unbounded::reason(model, omega) {
        return reason;
    }
    if !condensed.is_preloaded() {
        return e;
    }
    Error::new(
        Status::NoConvergence,
        format_args!(
            "contacts press at rest, and the static solution under constant loads, or the growth of the \
             vibrating ones from it, was not found; {held} rigid-body modes are held by contacts alone"
        ),
    )
}

/// Collects the points of one run.
struct Points<'a> {
    branch: Branch,
    problem: Forced<'a>,
    settings: Settings,
    condensed: &'a Condensed,
    estimator: Option<ForcedEstimator<'a>>,
    specials: Vec<Kept>,
    corrector: Corrector,
    response: Vec<Complex64>,
    stalled: bool,
}

impl Keeper for Points<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        &mut self.problem
    }

    fn branch(&self) -> &Branch {
        &self.branch
    }

    fn keep(&mut self, point: &Point) -> Result<()> {
        self.stalled |= point.stalled;
        self.problem.response(point.unknowns(), &mut self.response);
        let sampling_error = self.problem.sampling_error(point.unknowns(), point.parameter())?;
        let error = self.estimate(point)?;
        let slips = self.problem.slip_fractions();
        self.branch
            .push_curve(&record(point, &self.response, slips, (sampling_error, error)))
    }

    /// The point is solved once more at its frequency with the flexibility factorised there: along
    /// the sweep it may have been interpolated.
    fn keep_special(&mut self, kind: SpecialKind, mut point: Point) -> Result<()> {
        let n = point.unknowns().len();
        let p = point.parameter();
        let metric = Metric::along(norm(point.unknowns()), &self.settings);
        let mut row = try_vec(n + 1, 0.0, "the special points")?;
        row[n] = 1.0;
        let mut v = try_copy(&point.v, "the special points")?;
        // At a fold the solution at a fixed frequency is not isolated.
        let outcome = if matches!(kind, SpecialKind::Fold) {
            Ok(Outcome::Failed)
        } else {
            self.problem.set_pointwise(true);
            let outcome = self
                .corrector
                .correct(&mut self.problem, &mut v, &row, metric, true, None);
            self.problem.set_pointwise(false);
            outcome
        };
        if let Outcome::Converged(corrected) = outcome? {
            v[n] = p;
            point.v = v;
            point.amplitude = corrected.amplitude;
            point.residual = corrected.residual;
        } else {
            self.corrector.evaluate(&mut self.problem, &point.v)?;
        }
        self.problem.response(point.unknowns(), &mut self.response);
        let kept = Kept {
            kind,
            sampling_error: self.problem.sampling_error(point.unknowns(), point.parameter())?,
            error: self.estimate(&point)?,
            response: try_copy(&self.response, "the special points")?,
            slip_fractions: try_copy(self.problem.slip_fractions(), "the special points")?,
            point,
        };
        try_push(&mut self.specials, kept, "the special points")
    }
}

impl Points<'_> {
    /// Estimated relative error of the response amplitude; NaN where it is unknown or not asked for.
    fn estimate(&mut self, point: &Point) -> Result<f64> {
        let Some(estimator) = &mut self.estimator else {
            return Ok(f64::NAN);
        };
        let solved = Solved {
            condensed: self.condensed,
            motion: point.unknowns(),
            omega: point.parameter(),
            response: self.response[observed(self.condensed)] * self.condensed.length(),
        };
        Ok(estimator.at(&solved)?.response)
    }

    /// Numbers the special points after the curve.
    fn finish(mut self, ending: &Ending) -> Result<Branch> {
        for kept in &self.specials {
            let record = record(
                &kept.point,
                &kept.response,
                &kept.slip_fractions,
                (kept.sampling_error, kept.error),
            );
            self.branch.push_special(kept.kind, &record)?;
        }
        self.branch.set_ending(ending.status, ending.reason, self.stalled);
        Ok(self.branch)
    }
}

/// A special point until the curve is complete.
struct Kept {
    kind: SpecialKind,
    point: Point,
    response: Vec<Complex64>,
    slip_fractions: Vec<f64>,
    sampling_error: f64,
    error: f64,
}

fn record<'a>(
    point: &'a Point,
    response: &'a [Complex64],
    slip_fractions: &'a [f64],
    (sampling_error, error): (f64, f64),
) -> Record<'a> {
    Record {
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

/// The forced degree of freedom with the largest fundamental at `omega`, with every contact at its
/// reference stiffness.
fn forced_dof_that_moves_most(model: &Model, condensed: &Condensed, omega: f64) -> Result<usize> {
    let set = condensed.set();
    let observed = set.numbers().iter().position(|&h| h > 0).unwrap_or(0);
    let n = model.ndof();
    let mut x = try_vec(n, Complex64::ZERO, "the response")?;
    let rest = try_vec(condensed.coordinates(), Complex64::ZERO, "the response")?;
    Workspace::new(condensed, None)?.recover(condensed, observed, omega, &rest, &mut x)?;
    let mut best = 0;
    let mut found = false;
    for force in model.excitation().forces() {
        let moves_more = !found || x[force.dof].norm() > x[best].norm();
        if force.value != Complex64::ZERO && moves_more {
            best = force.dof;
            found = true;
        }
    }
    Ok(best)
}

/// Packed relative motions of a guess given for all degrees of freedom.
fn relative_motion(condensed: &Condensed, guess: &[Complex64]) -> Result<Vec<f64>> {
    let set = condensed.set();
    let m = set.packed_len();
    let n = condensed.ndof();
    let mut packed = try_vec(condensed.coordinates() * m, 0.0, "the guess")?;
    for (i, block) in condensed.blocks().iter().enumerate() {
        let x = &guess[block.number * n..(block.number + 1) * n];
        for (c, row) in block.rows.iter().enumerate() {
            let y = along(row, x);
            set.set(&mut packed[c * m..(c + 1) * m], i, y / condensed.length());
        }
    }
    Ok(packed)
}
