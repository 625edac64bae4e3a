//! The damped Newton method on the extended problem; the size of its next step stops it.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::harmonics::estimate::{CONTEXT, ESTIMATE_SHARE};
use crate::harmonics::extended_system::ExtendedSystem;
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::norm;
use crate::problem::Problem;

/// Most Newton steps.
/// Kind: cap.
const EXTENDED_NEWTON_MOST_STEPS: usize = 24;

/// Relative size of a first step that suffices where the extended harmonics are weak.
/// Kind: tuned; measured on: not recorded.
const SHORT: f64 = 0.1;

/// Size of a first step, relative to the change, up to which a guess is as good as a point that a step has reached.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_NEWTON_CLOSE: f64 = 0.3;

/// Share of the residual of the start above which the next step is not yet the last one, and need not be found exactly, and the
/// damping factor up to which that is so: a shorter one changes the step too little.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_NEWTON_FAR: f64 = 0.3;
const LONG: f64 = 0.25;

/// Share of the residual before a step that shows it to be right, whatever the next one is: where a contact grazes, the matrix
/// changes with the side, and the simplified step is long on both.
/// Kind: tuned; measured on: not recorded.
const FALLEN: f64 = 0.25;

/// Share of a damped step by which the residual of monotone equations falls where the step is right: they have one solution, to which
/// every descent leads.
/// Kind: tuned; measured on: not recorded.
const LEAST_DESCENT: f64 = 0.1;

/// Damping factor below which a step is accepted without the monotonicity test.
/// Kind: tuned; measured on: not recorded.
const EXTENDED_NEWTON_SMALLEST_DAMPING: f64 = 1.0 / 64.0;

/// Whether a short first step is accepted as the correction δ because the next one would be far shorter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FirstStep {
    /// Only if the next step confirms it.
    Checked,
    /// Yes: the extended harmonics are known to be weak, kt|G_h| < ½.
    Suffices,
    /// Yes, with the step solved to few digits, where it only has to show that the missing part is small.
    SufficesRoughly,
}

/// The result of the damped Newton method.
pub(super) struct ExtendedSolution {
    /// Motion Z, at which the problem was evaluated last.
    pub at: Vec<f64>,
    /// δ, the simplified Newton step from Z, followed by 0 for the parameter.
    pub next: Vec<f64>,
    /// Whether δ is so small that the solution is certified.
    pub certified: bool,
    /// Number of Newton steps taken, each with a factorisation.
    pub steps: usize,
    /// Share of δ that may still be missing in Z*.
    pub missing: f64,
}

impl ExtendedSolution {
    /// Corrected solution Z* = Z + δ.
    pub fn corrected(&self) -> Result<Vec<f64>> {
        sum(&self.at, &self.next)
    }
}

fn with_parameter(mut step: Vec<f64>) -> Result<Vec<f64>> {
    try_push(&mut step, 0.0, CONTEXT)?;
    Ok(step)
}

fn sum(a: &[f64], b: &[f64]) -> Result<Vec<f64>> {
    let mut sum = try_copy(a, CONTEXT)?;
    for (s, b) in sum.iter_mut().zip(b) {
        *s += b;
    }
    Ok(sum)
}

/// change = Z + δ − W
fn change_from(point: &[f64], (z, next): (&[f64], &[f64]), change: &mut [f64]) {
    for (((c, z), d), w) in change.iter_mut().zip(z).zip(next).zip(point) {
        *c = z + d - w;
    }
}

/// Solves R(Z) = 0 from `start`, at which the system was evaluated, until `enough(problem, Z, change, δ)` accepts δ
/// as small against the change Z + δ − W from the point W. δ ends with a 0 for the parameter. `None` where an
/// evaluation or a matrix fails.
///
/// A start other than W is a guess: the first step from it may be δ.
///
/// # Errors
/// Those of the system, except for singular matrices and laws that another motion may not fail.
pub(super) fn extend<P: Problem>(
    system: &mut ExtendedSystem<P>,
    (start, point): (&[f64], &[f64]),
    enough: impl Fn(&P, &[f64], &[f64], &[f64]) -> bool,
    first_step: FirstStep,
    interrupt: &Interrupt<'_>,
) -> Result<Option<ExtendedSolution>> {
    let n = start.len();
    let mut z = try_copy(start, CONTEXT)?;
    let mut step = try_vec(n, 0.0, CONTEXT)?;
    let mut next = try_vec(n + 1, 0.0, CONTEXT)?;
    let mut change = try_vec(n, 0.0, CONTEXT)?;
    let mut trial = try_vec(n, 0.0, CONTEXT)?;
    let is_guess = start != point;
    let first = system.residual();
    let mut damping = 1.0_f64;
    for steps in 1..=EXTENDED_NEWTON_MOST_STEPS {
        interrupt.part(Phase::Estimate, steps - 1, EXTENDED_NEWTON_MOST_STEPS)?;
        let is_rough = steps == 1 && first_step == FirstStep::SufficesRoughly;
        if !system.factor(interrupt)? || !system.step(&mut step, is_rough, interrupt)? {
            return Ok(None);
        }
        let size = norm(&step);
        let before = system.residual();
        if first_step != FirstStep::Checked && steps == 1 && size <= SHORT * norm(start) {
            return Ok(Some(ExtendedSolution {
                at: z,
                next: with_parameter(step)?,
                certified: true,
                steps,
                missing: ESTIMATE_SHARE,
            }));
        }
        if is_guess && steps == 1 {
            next[..n].copy_from_slice(&step);
            change_from(point, (&z, &next), &mut change);
            if size <= EXTENDED_NEWTON_CLOSE * norm(&change) && enough(&system.problem, &z, &change, &next) {
                return Ok(Some(ExtendedSolution {
                    at: z,
                    next,
                    certified: true,
                    steps,
                    missing: 1.0,
                }));
            }
        }
        damping = (4.0 * damping).min(1.0);
        let mut is_rough;
        loop {
            for ((t, z), d) in trial.iter_mut().zip(&z).zip(&step) {
                *t = z + damping * d;
            }
            let last = damping <= EXTENDED_NEWTON_SMALLEST_DAMPING;
            if system.evaluate(&trial)? {
                is_rough = damping >= LONG && system.iterates_long() && system.residual() > EXTENDED_NEWTON_FAR * first;
                if !system.step(&mut next[..n], is_rough, interrupt)? {
                    return Ok(None);
                }
                let falls = norm(&next) <= (1.0 - 0.25 * damping) * size
                    || system.residual() <= FALLEN * before
                    || (system.is_monotone && system.residual() <= (1.0 - LEAST_DESCENT * damping) * before);
                if last || falls {
                    break;
                }
            } else if last {
                return Ok(None);
            }
            damping *= 0.5;
        }
        z.copy_from_slice(&trial);
        change_from(point, (&z, &next), &mut change);
        if !change.iter().all(|x| x.is_finite()) {
            return Ok(None);
        }
        let mut certified = enough(&system.problem, &z, &change, &next);
        if certified && is_rough {
            if !system.step(&mut next[..n], false, interrupt)? {
                return Ok(None);
            }
            change_from(point, (&z, &next), &mut change);
            certified = enough(&system.problem, &z, &change, &next);
        }
        if certified || steps == EXTENDED_NEWTON_MOST_STEPS {
            return Ok(Some(ExtendedSolution {
                at: z,
                next,
                certified,
                steps,
                missing: 1.0,
            }));
        }
    }
    Ok(None)
}
