//! Newton's method on R(u, p) = 0 with one linear condition on (u, p): the corrector of the continuation, and with
//! damping the solver of the first point.

mod contraction;
mod damped_step;
pub(crate) mod deflated;
mod last_evaluation;
mod moved_tangent;
pub(crate) mod null_direction;

use crate::continuation::Metric;
pub(crate) use crate::continuation::corrector::contraction::Foresight;
use crate::continuation::corrector::contraction::{Contraction, Sizes};
use crate::continuation::corrector::moved_tangent::slope_weights;
use crate::error::{Error, Result, Status, try_extend, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::automatic::AutomaticSystem;
use crate::linalg::newton::linear_system::{Border, LinearSystem};
use crate::linalg::norm;
use crate::problem::{Problem, Residual};
use num_complex::Complex64;

/// Data of a converged correction.
#[derive(Clone, Debug)]
pub struct Corrected {
    /// Number of Newton iterations taken; one more where their end was foreseen from two of them.
    pub iterations: usize,
    /// Relative residual before the last correction; or a bound of the residual after it, where that was foreseen.
    pub residual: f64,
    /// Whether round-off stopped the residual above the requested tolerance.
    pub stalled: bool,
    /// Observed amplitude at the point.
    pub amplitude: Complex64,
    /// Derivative of the amplitude along the tangent.
    pub slope: Complex64,
    /// Unit tangent in the metric used, in unscaled numbers, pointing along the row.
    pub tangent: Vec<f64>,
    /// Whether det [J r; tangentᵀ] is positive.
    pub positive: bool,
}

/// Outcome of a correction.
#[derive(Debug)]
pub enum Outcome {
    /// The correction converged to a solution.
    Converged(Corrected),
    /// The correction found no solution.
    Failed,
}

/// Which matrix the stored factors belong to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Factors {
    /// No usable factors are stored.
    None,
    /// Factors of the matrix of an earlier iteration.
    Earlier,
    /// Factors of the current matrix.
    Own,
}

/// Newton's method with its memory.
pub struct Corrector {
    at: Residual,
    system: AutomaticSystem,
    factors: Factors,
    memory: StepMemory,
    /// Points of the matrices that the linear system took over last, the newest first; NaN where they are not known.
    matrices_at: [Vec<f64>; 3],
    limits: Limits,
    /// Newton steps taken so far, over all corrections.
    steps_taken: usize,
    failure: Option<Error>,
    /// Whether a correction may end with the factors of the iteration before.
    may_end_early: bool,
    /// Contraction of the corrections before; and from what the end of a correction is foreseen.
    contraction: Contraction,
    foresight: Foresight,
}

/// Memory of steps and tangents.
pub struct StepMemory {
    step: Vec<f64>,
    trial: Vec<f64>,
    next: Vec<f64>,
    /// Memory of the next tangent.
    unused: Vec<f64>,
    change: Vec<f64>,
}

/// When a correction ends.
pub struct Limits {
    tolerance: f64,
    min_iterations: usize,
    max_iterations: usize,
}

/// Relative size of a Newton step that is round-off: no further progress is possible.
/// Kind: rounding.
const CORRECTOR_ROUND_OFF: f64 = 1e-13;

/// Largest relative Newton step from a solution. Where the equations are nearly singular, as at a resonance without
/// damping, a point with a residual within the tolerance may be far from any solution: the last step shows that.
/// Kind: tuned; measured on: not recorded.
const NEAR: f64 = 1e-3;

/// Relative errors of a Newton step and of a tangent that are found by iteration, or with the factors of an earlier
/// one. The error of a step is far below the correction of the next iteration; the error of a tangent is as small as
/// round-off.
/// Kind: tuned; measured on: not recorded.
const STEP_ERROR: f64 = 1e-4;
/// Relative error of a tangent that is found so: it is as small as round-off.
/// Kind: rounding.
const TANGENT_ERROR: f64 = 1e-12;

/// Smallest damping factor.
/// Kind: cap.
const SMALLEST_DAMPING: f64 = 1.0 / 1024.0;

impl Corrector {
    /// Memory for `n` unknowns.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(n: usize, tolerance: f64, max_iterations: usize) -> Result<Self> {
        let point = || try_vec(n + 1, 0.0, "Newton's method");
        Ok(Self {
            at: Residual::new(n)?,
            system: AutomaticSystem::new(n)?,
            factors: Factors::None,
            memory: StepMemory {
                step: point()?,
                trial: point()?,
                next: point()?,
                unused: Vec::new(),
                change: point()?,
            },
            matrices_at: [point()?, point()?, point()?],
            limits: Limits {
                tolerance,
                min_iterations: 0,
                max_iterations,
            },
            steps_taken: 0,
            failure: None,
            may_end_early: true,
            contraction: Contraction::UNKNOWN,
            foresight: Foresight::None,
        })
    }

    /// Newton steps of all corrections so far.
    #[must_use]
    pub fn steps_taken(&self) -> usize {
        self.steps_taken
    }

    /// Adds the steps of another corrector, which prepared a correction of this one.
    pub fn count_steps(&mut self, of_other: usize) {
        self.steps_taken += of_other;
    }

    /// Sets from what the end of the next correction may be foreseen.
    pub(crate) fn set_foresight(&mut self, foresight: Foresight) {
        self.foresight = foresight;
    }

    /// Takes over memory that is no longer used, for the next tangent.
    pub fn recycle(&mut self, unused: Vec<f64>) {
        self.memory.unused = unused;
    }

    /// Sets the least and the largest number of Newton iterations, and returns the former bounds.
    pub fn limit(&mut self, iterations: (usize, usize)) -> (usize, usize) {
        let before = (self.limits.min_iterations, self.limits.max_iterations);
        (self.limits.min_iterations, self.limits.max_iterations) = iterations;
        before
    }

    /// The failure of the last correction, if a law could not evaluate its force at some motion.
    #[must_use]
    pub fn failure(&self) -> Option<Error> {
        self.failure.clone()
    }

    /// Corrects `v` = (u, p) within the plane through it whose normal is `row` (in scaled unknowns); a row (0, …, 0,
    /// 1) keeps p.
    ///
    /// `damped` applies the natural monotonicity test (Deuflhard, Newton Methods for Nonlinear Problems, 2004, §3.3):
    /// a step of length λ is taken when the simplified Newton step there has shrunk by 1 − λ/4.
    ///
    /// # Errors
    /// Those of the problem, except for singular matrices and laws that another motion may not fail: those end as
    /// [`Outcome::Failed`]. `StoppedByCaller`.
    pub fn correct(
        &mut self,
        problem: &mut dyn Problem,
        v: &mut [f64],
        row: &[f64],
        metric: Metric,
        damped: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<Outcome> {
        self.failure = None;
        let outcome = self.iterate(problem, v, row, metric, damped, interrupt)?;
        if matches!(outcome, Outcome::Failed) {
            self.contraction = Contraction::UNKNOWN;
        }
        Ok(outcome)
    }

    fn iterate(
        &mut self,
        problem: &mut dyn Problem,
        v: &mut [f64],
        row: &[f64],
        metric: Metric,
        damped: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<Outcome> {
        if !self.evaluates(problem, v)? {
            return Ok(Outcome::Failed);
        }
        let mut damping = 1.0;
        let (mut last_size, mut last) = (f64::INFINITY, [f64::INFINITY; 2]);
        let n = v.len() - 1;
        for iteration in 0..=self.limits.max_iterations {
            interrupt.check()?;
            let residual = self.relative_residual();
            let is_last = iteration > self.limits.min_iterations && residual <= self.attainable();
            if is_last
                && self.may_end_early
                && self.ends_by_earlier_factors(problem, v, last[1], (metric, row), interrupt)?
            {
                if iteration == 1 {
                    let sizes = [residual, self.step_length(metric) / norm(&v[..n])];
                    self.contraction.measure(last, sizes);
                }
                return self.finish(problem, v, metric, iteration, residual);
            }
            // The damping test compares steps by one matrix, that of the iteration: an iterative solution is by it with any factors.
            let reuse = iteration > 0 && (!damped || !self.system.is_direct());
            if !residual.is_finite() || !self.newton_step(problem, metric, row, reuse, interrupt)? {
                return Ok(Outcome::Failed);
            }
            self.matrices_at[0].copy_from_slice(v);
            let size = norm(&self.memory.step);
            if !size.is_finite() {
                return Ok(Outcome::Failed);
            }
            let (length, motion) = (self.step_length(metric), norm(&v[..n]));
            // The metric does not measure that: its unit may be far above unknowns that were large elsewhere on the branch.
            let round_off = length <= CORRECTOR_ROUND_OFF * motion
                && self.memory.step[n].abs() * metric.p <= CORRECTOR_ROUND_OFF * (v[n].abs() + metric.p);
            let near = length <= NEAR * motion;
            let sizes = [residual, length / motion];
            let foreseen = if residual > self.limits.tolerance && !damped {
                let within = (iteration > 0).then(|| Contraction::between(last, sizes));
                self.foresee(problem, within, sizes)
            } else {
                None
            };
            if iteration == 1 {
                self.contraction.measure(last, sizes);
            }
            // A step that is round-off of all unknowns may still matter to the small motion of a stiff contact.
            let shrinks = !damped && iteration < self.limits.max_iterations && size < 0.5 * last_size;
            let met = residual <= self.attainable() || foreseen.is_some();
            let converged = (met && near) || (round_off && !shrinks);
            if converged && iteration >= self.limits.min_iterations {
                // Near-rigid contacts have matrices whose rounding would be amplified.
                let slope = if iteration == 0 && !problem.has_kinks() && self.at.rounding == 0.0 {
                    slope_weights(&self.matrices_at, norm(&self.memory.step), metric, row)
                } else {
                    None
                };
                if !self.solve_for_tangent(problem, metric, row, slope, interrupt)? {
                    return Ok(Outcome::Failed);
                }
                // A step whose end two others foresee counts as it would with its evaluation: iterations bound the work of estimates.
                let taken = iteration + usize::from(foreseen.is_some() && iteration > 0);
                return self.finish(problem, v, metric, taken, foreseen.unwrap_or(residual));
            }
            // Where a near-rigid contact begins to close, the residual falls while small steps are dominated by rounding. A step found by
            // iteration leaves a share of the residual, which near a singular matrix is a long step.
            let may_grow = !self.system.is_direct() || (self.at.rounding > 0.0 && near);
            let falls = may_grow && residual < 0.5 * last[0];
            if iteration == self.limits.max_iterations || (!damped && size > last_size && !falls) {
                break;
            }
            (last_size, last) = (size, sizes);
            self.steps_taken += 1;
            if damped {
                match self.damped_step(problem, v, metric, (size, damping), interrupt)? {
                    Some(used) => damping = used,
                    None => break,
                }
            } else {
                metric.add(v, 1.0, &self.memory.step);
                if !self.evaluates(problem, v)? {
                    break;
                }
            }
        }
        Ok(Outcome::Failed)
    }

    /// Evaluates the problem at `v`, so that its queries refer to this point.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn evaluate(&mut self, problem: &mut dyn Problem, v: &[f64]) -> Result<()> {
        let n = v.len() - 1;
        problem.evaluate(&v[..n], v[n], &mut self.at)
    }

    /// Evaluates the problem at `v`; `false` where that failed and may succeed elsewhere.
    fn evaluates(&mut self, problem: &mut dyn Problem, v: &[f64]) -> Result<bool> {
        let n = v.len() - 1;
        if !v.iter().all(|x| x.is_finite()) {
            return Ok(false);
        }
        let outcome = problem.evaluate(&v[..n], v[n], &mut self.at);
        self.failure = outcome.as_ref().err().filter(|e| e.recoverable).cloned();
        tolerate(outcome)
    }

    /// ‖R‖ over the problem's scale; 0 where both vanish.
    fn relative_residual(&self) -> f64 {
        let r = norm(&self.at.values);
        if r == 0.0 { 0.0 } else { r / self.at.scale }
    }

    /// Residual that can be reached: the tolerance, or rounding where that is larger.
    fn attainable(&self) -> f64 {
        if self.at.rounding > 0.0 {
            self.limits.tolerance.max(self.at.rounding / self.at.scale)
        } else {
            self.limits.tolerance
        }
    }

    /// Updates the linear system with Newton's matrix at the point evaluated last.
    fn update(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        row: &[f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<()> {
        // NaN until it is known that the matrix is one of a correction.
        self.matrices_at.rotate_right(1);
        self.matrices_at[0].fill(f64::NAN);
        let border = Border {
            column: &self.at.d_parameter,
            scales: (metric.u, metric.p),
            row,
        };
        self.system.update(problem, border, interrupt)
    }

    /// Factors the current matrix; `false` where it is singular.
    fn factor(&mut self, problem: &mut dyn Problem, interrupt: &Interrupt<'_>) -> Result<bool> {
        let factored = tolerate(self.system.factor(problem, interrupt))?;
        self.factors = if factored { Factors::Own } else { Factors::None };
        Ok(factored)
    }

    /// Length of the step in the unknowns, without the parameter.
    fn step_length(&self, metric: Metric) -> f64 {
        norm(&self.memory.step[..self.memory.step.len() - 1]) * metric.u
    }

    /// Bound of the residual after a step from these sizes, if it is known to lead to a solution; `within` is the contraction of
    /// this correction, `None` at its first step.
    fn foresee(&mut self, problem: &mut dyn Problem, within: Option<Contraction>, sizes: Sizes) -> Option<f64> {
        // Iterative solutions and near-rigid contacts leave other residuals, and sampled laws have other matrices everywhere.
        if !self.system.is_direct() || problem.has_kinks() || self.at.rounding > 0.0 {
            return None;
        }
        match (self.foresight, within) {
            (Foresight::AlongBranch, None) => self.contraction.foresee(sizes, self.limits.tolerance),
            (Foresight::WithinCorrection, Some(contraction)) => {
                // A step by earlier factors leaves a share of the residual.
                let left = if self.factors == Factors::Own { 0.0 } else { STEP_ERROR };
                contraction.foresee_within(sizes, left, self.limits.tolerance)
            }
            _ => None,
        }
    }

    /// step ← −(R, 0).
    fn negate_residual(&mut self) {
        let n = self.memory.step.len() - 1;
        for (s, r) in self.memory.step.iter_mut().zip(&self.at.values) {
            *s = -r;
        }
        self.memory.step[n] = 0.0;
    }

    /// step ← −[J r; row]⁻¹ (R, 0) in scaled unknowns; `false` where the matrix is singular. The factors of an
    /// earlier iteration may be reused where the matrix has hardly changed.
    fn newton_step(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        row: &[f64],
        reuse: bool,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        self.negate_residual();
        self.factors = if reuse { Factors::Earlier } else { Factors::None };
        self.update(problem, metric, row, interrupt)?;
        self.solve(problem, (metric, row), STEP_ERROR, interrupt)
    }

    /// Solves for `step` with the current matrix, to a relative error that allows factors of an earlier one; `false`
    /// where it is singular. The problem must have been evaluated at the point of the matrix.
    fn solve(
        &mut self,
        problem: &mut dyn Problem,
        (metric, row): (Metric, &[f64]),
        error: f64,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        if self.factors == Factors::Earlier
            && self
                .system
                .solve_by_earlier_factors(problem, error, &mut self.memory.step, interrupt)?
        {
            return Ok(true);
        }
        if self.factors != Factors::Own && !self.factor(problem, interrupt)? {
            return Ok(false);
        }
        if self.system.solve(problem, error, &mut self.memory.step, interrupt)? {
            return Ok(true);
        }
        if !self.system.solve_directly() {
            return Ok(false);
        }
        self.update(problem, metric, row, interrupt)?;
        Ok(self.factor(problem, interrupt)? && self.system.solve(problem, error, &mut self.memory.step, interrupt)?)
    }

    /// Applies the last Newton step, in `step`, without another evaluation: the error is the square of a residual
    /// already below the tolerance. The tangent is taken from `next`.
    fn finish(
        &mut self,
        problem: &mut dyn Problem,
        v: &mut [f64],
        metric: Metric,
        iterations: usize,
        residual: f64,
    ) -> Result<Outcome> {
        let n = v.len() - 1;
        let mut tangent = core::mem::take(&mut self.memory.unused);
        tangent.clear();
        try_extend(&mut tangent, &self.memory.step, "Newton's method")?;
        metric.unscale(&mut tangent);
        let (at_residual, mut correction) = problem.observe(&v[..n], &tangent);
        if residual <= self.limits.tolerance {
            metric.add(v, 1.0, &self.memory.step);
        } else {
            correction = Complex64::ZERO;
        }
        self.unit_tangent(metric, &mut tangent);
        let (_, slope) = problem.observe(&v[..n], &tangent);
        // A point with a number that is not finite is no solution, however it came about.
        let numbers = v.iter().chain(&tangent).all(|x| x.is_finite());
        if !(numbers && (at_residual + correction).is_finite() && slope.is_finite()) {
            return Ok(Outcome::Failed);
        }
        Ok(Outcome::Converged(Corrected {
            iterations,
            residual,
            stalled: residual > self.attainable(),
            amplitude: at_residual + correction,
            slope,
            tangent,
            positive: self.system.is_positive(),
        }))
    }

    /// Computes the tangent of the current matrix in scaled numbers, of any length, into `next`; `false` where the
    /// matrix is singular. With weights of `slope_weights` it is the tangent after the Newton step.
    fn solve_for_tangent(
        &mut self,
        problem: &mut dyn Problem,
        metric: Metric,
        row: &[f64],
        slope: Option<[f64; 3]>,
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = self.memory.step.len() - 1;
        core::mem::swap(&mut self.memory.step, &mut self.memory.next);
        if !slope.is_some_and(|slope| {
            self.system
                .apply_last(slope.map(|w| -w), &self.memory.next, &mut self.memory.step)
        }) {
            self.memory.step.fill(0.0);
        }
        self.memory.step[n] = 1.0;
        let solved = self.solve(problem, (metric, row), TANGENT_ERROR, interrupt);
        core::mem::swap(&mut self.memory.step, &mut self.memory.next);
        solved
    }

    /// Fills in the unit tangent, in unscaled numbers, from the one in `next`.
    fn unit_tangent(&self, metric: Metric, tangent: &mut [f64]) {
        let inverse = 1.0 / norm(&self.memory.next);
        for (t, s) in tangent.iter_mut().zip(&self.memory.next) {
            *t = s * inverse;
        }
        metric.unscale(tangent);
    }

    /// Fills `tangent` with the direction in which the linearisation at `v` keeps the residual, whether `v` is a
    /// solution or not; it points along the row. Returns whether det [J r; tangentᵀ] is positive; `None` where the
    /// matrix is singular.
    ///
    /// # Errors
    /// Those of the problem.
    pub fn direction_at(
        &mut self,
        problem: &mut dyn Problem,
        v: &[f64],
        row: &[f64],
        metric: Metric,
        tangent: &mut [f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<bool>> {
        if !self.evaluates(problem, v)? {
            return Ok(None);
        }
        self.update(problem, metric, row, interrupt)?;
        if !self.factor(problem, interrupt)? || !self.solve_for_tangent(problem, metric, row, None, interrupt)? {
            return Ok(None);
        }
        self.unit_tangent(metric, tangent);
        Ok(Some(self.system.is_positive()))
    }
}

/// Turns a singular matrix, and a law that another motion may not fail, into a failed attempt; other errors are
/// returned.
fn tolerate(result: Result<()>) -> Result<bool> {
    result.map(|()| true).or_else(|e| {
        if e.status == Status::Singular || e.recoverable {
            Ok(false)
        } else {
            Err(e)
        }
    })
}
