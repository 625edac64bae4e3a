//! The damped Newton method on the lifted problem, stopped by its own next step.

use super::WHAT;
use crate::error::{Result, Status, try_copy, try_vec};
use crate::linalg::bordered::Bordered;
use crate::linalg::norm;
use crate::problem::{Linearisation, Problem};

/// Most Newton steps of a lift.
const MOST_STEPS: usize = 24;

/// Damping factor below which a step is taken as it is.
const SMALLEST_DAMPING: f64 = 1.0 / 64.0;

/// Where a lift ended.
pub(super) struct Lifted {
    /// Z, at which the problem was evaluated last.
    pub at: Vec<f64>,
    /// δ, the simplified Newton step from there.
    pub next: Vec<f64>,
    /// Whether δ is small enough.
    pub certified: bool,
    /// Newton steps taken, each with a factorisation.
    pub steps: usize,
}

impl Lifted {
    /// Z* = Z + δ
    pub fn corrected(&self) -> Result<Vec<f64>> {
        sum(&self.at, &self.next)
    }
}

fn sum(a: &[f64], b: &[f64]) -> Result<Vec<f64>> {
    let mut sum = try_copy(a, WHAT)?;
    for (s, b) in sum.iter_mut().zip(b) {
        *s += b;
    }
    Ok(sum)
}

/// Solves R(Z, p) = 0 from `start`, at which the problem was evaluated with the result in `at`, until `enough`
/// says that δ, given after the change Z + δ − start, is small. `None` where some evaluation or matrix fails.
///
/// # Errors
/// What the problem reports, but for singular matrices and what another motion may not meet.
pub(super) fn lift(
    problem: &mut dyn Problem,
    p: f64,
    start: &[f64],
    at: &mut Linearisation,
    enough: impl Fn(&[f64], &[f64]) -> bool,
) -> Result<Option<Lifted>> {
    let n = start.len();
    let mut newton = Newton {
        matrix: Bordered::new(n)?,
        row: try_vec(n + 1, 0.0, WHAT)?,
        column: try_vec(n, 0.0, WHAT)?,
    };
    newton.row[n] = 1.0;
    let mut z = try_copy(start, WHAT)?;
    let mut step = try_vec(n + 1, 0.0, WHAT)?;
    let mut next = try_vec(n + 1, 0.0, WHAT)?;
    let mut change = try_vec(n, 0.0, WHAT)?;
    let mut damping = 1.0_f64;
    for steps in 1..=MOST_STEPS {
        if !newton.factor(at)? {
            return Ok(None);
        }
        newton.step(at, &mut step);
        let size = norm(&step[..n]);
        damping = (4.0 * damping).min(1.0);
        let trial = loop {
            let mut trial = try_copy(&z, WHAT)?;
            for (t, d) in trial.iter_mut().zip(&step) {
                *t += damping * d;
            }
            let last = damping <= SMALLEST_DAMPING;
            if evaluates(problem, &trial, p, at)? {
                newton.step(at, &mut next);
                if last || norm(&next[..n]) <= (1.0 - 0.25 * damping) * size {
                    break Some(trial);
                }
            } else if last {
                break None;
            }
            damping *= 0.5;
        };
        let Some(trial) = trial else { return Ok(None) };
        z = trial;
        for (((c, z), d), s) in change.iter_mut().zip(&z).zip(&next).zip(start) {
            *c = z + d - s;
        }
        if !change.iter().all(|x| x.is_finite()) {
            return Ok(None);
        }
        let certified = enough(&change, &next[..n]);
        if certified || steps == MOST_STEPS {
            next.truncate(n);
            return Ok(Some(Lifted {
                at: z,
                next,
                certified,
                steps,
            }));
        }
    }
    Ok(None)
}

/// Newton's matrix at a fixed parameter.
struct Newton {
    matrix: Bordered,
    row: Vec<f64>,
    column: Vec<f64>,
}

impl Newton {
    fn factor(&mut self, at: &Linearisation) -> Result<bool> {
        let matrix = &mut self.matrix;
        match matrix.factor(&at.jacobian, &self.column, &at.active, (1.0, 1.0), &self.row) {
            Err(e) if e.status == Status::Singular => Ok(false),
            factored => factored.map(|()| true),
        }
    }

    /// −J⁻¹R with the matrix factored last.
    fn step(&mut self, at: &Linearisation, step: &mut [f64]) {
        for (s, r) in step.iter_mut().zip(&at.residual) {
            *s = -r;
        }
        step[at.residual.len()] = 0.0;
        self.matrix.solve(step);
    }
}

/// Evaluates the problem; `false` where that failed and may succeed elsewhere.
fn evaluates(problem: &mut dyn Problem, u: &[f64], p: f64, at: &mut Linearisation) -> Result<bool> {
    match problem.evaluate(u, p, at) {
        Err(e) if e.recoverable || e.status == Status::Singular => Ok(false),
        evaluated => evaluated.map(|()| at.residual.iter().all(|r| r.is_finite())),
    }
}
