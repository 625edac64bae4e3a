//! Forced response over a range of frequency.

use crate::branch::{Branch, Record, SpecialKind};
use crate::condense::Condensed;
use crate::condense::flexibility::Workspace;
use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::events::{Event, Locator};
use crate::continuation::start::{self, First};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Continuation, Metric, Point, Settings};
use crate::error::{Result, Status, fail, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::linalg::norm;
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions};
use crate::problem::Problem;
use crate::problem::forced::Forced;
use num_complex::Complex64;

/// Follows the periodic response of `model` to its forces from `range.omega_start` to
/// `range.omega_stop` by harmonic balance and arc-length continuation.
///
/// A branch that ends early is returned with a positive [`Branch::status`] and every point found.
///
/// # Errors
/// Bad options and models (see [`SolverOptions::check`], [`ForcedOptions::check`],
/// [`Condensed::new`]), `NoConvergence` when no first point was found.
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
    let condensed = Condensed::new(model, solver, range.omega_start)?;
    let response = match solver.response_dof {
        Some(dof) => dof,
        None => forced_dof_that_moves_most(model, &condensed, range.omega_start)?,
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
    let reduction = condensed.reduction(model, solver);
    let branch = Branch::new(condensed.clone(), reduction, solver.samples, solver.harmonics, response);
    let mut follower = Follower {
        branch,
        settings,
        range: *range,
        max_points: solver.max_points,
        specials: Vec::new(),
        corrector: Corrector::new(problem.size(), settings.tolerance, settings.max_iterations)?,
        response: try_vec(condensed.blocks().len(), Complex64::ZERO, "the response")?,
        stalled: false,
    };
    let status = follower.run(&mut problem, hooks)?;
    follower.finish(status)
}

/// Collects the points of one run.
struct Follower<'a> {
    branch: Branch,
    settings: Settings,
    range: ForcedOptions<'a>,
    max_points: usize,
    specials: Vec<Kept>,
    corrector: Corrector,
    response: Vec<Complex64>,
    stalled: bool,
}

impl Follower<'_> {
    fn run(&mut self, problem: &mut Forced<'_>, hooks: &mut Hooks<'_>) -> Result<Status> {
        let cancelled = hooks.cancelled;
        let first = match start::solve(problem, &self.settings, cancelled)? {
            First::Found(point) => point,
            First::Cancelled => return Ok(Status::StoppedByCaller),
        };
        hooks.log(LogLevel::Info, "first point solved");
        self.keep(problem, &first)?;
        if self.report(hooks, &first) {
            return Ok(Status::StoppedByCaller);
        }
        let single = self.settings.start.to_bits() == self.settings.end.to_bits();
        if single {
            for i in 0..self.range.at.len() {
                self.keep_special(problem, SpecialKind::At(i), first.clone())?;
            }
            return Ok(Status::Ok);
        }
        let n = first.unknowns().len();
        let mut locator = Locator::new(n, self.settings)?;
        let mut continuation = Continuation::new(self.settings, first)?;
        loop {
            if self.branch.points() >= self.max_points {
                return Ok(Status::StoppedMaxPoints);
            }
            let (point, end) = match continuation.advance(problem, cancelled)? {
                Advance::Accepted { point, last } => (point, last.then_some(Status::Ok)),
                Advance::LeftAtStart { point } => (point, Some(Status::StoppedLeftRange)),
                Advance::Stopped(status) => return Ok(status),
            };
            self.keep(problem, &point)?;
            let stop = self.report(hooks, &point);
            if let Some(before) = continuation.previous() {
                self.events(problem, &mut locator, before, &point, end.is_some())?;
            }
            if stop {
                return Ok(Status::StoppedByCaller);
            }
            if let Some(status) = end {
                return Ok(status);
            }
        }
    }

    /// Stores a point of the curve; the problem was last evaluated there.
    fn keep(&mut self, problem: &Forced<'_>, point: &Point) -> Result<()> {
        self.stalled |= point.stalled;
        problem.response(point.unknowns(), &mut self.response);
        self.branch
            .push_curve(&record(point, &self.response, problem.slip_fractions()))
    }

    fn report(&self, hooks: &mut Hooks<'_>, point: &Point) -> bool {
        let (start, end) = (self.settings.start, self.settings.end);
        let range = end - start;
        hooks.report(&Progress {
            point: self.branch.points(),
            parameter: point.parameter(),
            amplitude: self.branch.amplitude().last().copied().unwrap_or(0.0),
            residual: point.residual,
            step: point.step,
            fraction_done: if range == 0.0 {
                1.0
            } else {
                ((point.parameter() - start) / range).clamp(0.0, 1.0)
            },
            newton_iterations: point.iterations,
        })
    }

    /// Looks for folds, peaks and wanted frequencies between two neighbours.
    fn events(
        &mut self,
        problem: &mut Forced<'_>,
        locator: &mut Locator,
        a: &Point,
        b: &Point,
        last: bool,
    ) -> Result<()> {
        if Event::Peak.between(a, b)
            && let Some(peak) = locator.locate(problem, Event::Peak, a, b)?
        {
            self.keep_special(problem, SpecialKind::Peak, peak)?;
        }
        let fold = if Event::Fold.between(a, b) {
            locator.locate(problem, Event::Fold, a, b)?
        } else {
            None
        };
        if let Some(fold) = &fold {
            self.keep_special(problem, SpecialKind::Fold, fold.clone())?;
            self.wanted(problem, locator, a, fold, false)?;
            self.wanted(problem, locator, fold, b, last)
        } else {
            self.wanted(problem, locator, a, b, last)
        }
    }

    /// Solves at the wanted frequencies on the arc from `a` (included) to `b` (with the last
    /// point of the branch included), which has no fold inside.
    fn wanted(
        &mut self,
        problem: &mut Forced<'_>,
        locator: &mut Locator,
        a: &Point,
        b: &Point,
        last: bool,
    ) -> Result<()> {
        for (i, &p) in self.range.at.iter().enumerate() {
            let (pa, pb) = (a.parameter(), b.parameter());
            let inside = (pa <= p && p < pb) || (pb < p && p <= pa);
            let inside = inside || (last && p.to_bits() == pb.to_bits());
            if inside && let Some(point) = locator.at_parameter(problem, a, b, p)? {
                self.keep_special(problem, SpecialKind::At(i), point)?;
            }
        }
        Ok(())
    }

    /// Keeps a special point, solved once more at its frequency with the flexibility factorised
    /// there: along the sweep it may have been interpolated.
    fn keep_special(&mut self, problem: &mut Forced<'_>, kind: SpecialKind, mut point: Point) -> Result<()> {
        let n = point.unknowns().len();
        let p = point.parameter();
        let metric = Metric::along(norm(point.unknowns()), &self.settings);
        let mut row = try_vec(n + 1, 0.0, "the special points")?;
        row[n] = 1.0;
        let mut v = point.v.clone();
        // At a fold the solution at a fixed frequency is not isolated.
        let outcome = if matches!(kind, SpecialKind::Fold) {
            Ok(Outcome::Failed)
        } else {
            problem.set_pointwise(true);
            let outcome = self.corrector.correct(problem, &mut v, &row, metric, true, None);
            problem.set_pointwise(false);
            outcome
        };
        if let Outcome::Converged(corrected) = outcome? {
            v[n] = p;
            point.v = v;
            point.amplitude = corrected.amplitude;
            point.residual = corrected.residual;
        } else {
            self.corrector.evaluate(problem, &point.v)?;
        }
        problem.response(point.unknowns(), &mut self.response);
        let kept = Kept {
            kind,
            response: self.response.clone(),
            slip_fractions: problem.slip_fractions().to_vec(),
            point,
        };
        try_push(&mut self.specials, kept, "the special points")
    }

    /// Numbers the special points after the curve.
    fn finish(mut self, status: Status) -> Result<Branch> {
        for kept in &self.specials {
            let record = record(&kept.point, &kept.response, &kept.slip_fractions);
            self.branch.push_special(kept.kind, &record)?;
        }
        let stalled = status == Status::Ok && self.stalled;
        self.branch
            .set_status(if stalled { Status::StoppedStalled } else { status });
        Ok(self.branch)
    }
}

/// A special point until the curve is complete.
struct Kept {
    kind: SpecialKind,
    point: Point,
    response: Vec<Complex64>,
    slip_fractions: Vec<f64>,
}

fn record<'a>(point: &'a Point, response: &'a [Complex64], slip_fractions: &'a [f64]) -> Record<'a> {
    Record {
        omega: point.parameter(),
        motion: point.unknowns(),
        amplitude: point.amplitude,
        response,
        residual: point.residual,
        iterations: point.iterations,
        slip_fractions,
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
            let y: Complex64 = row.iter().flatten().map(|&(p, a)| a * x[p]).sum();
            set.set(&mut packed[c * m..(c + 1) * m], i, y / condensed.length());
        }
    }
    Ok(packed)
}
