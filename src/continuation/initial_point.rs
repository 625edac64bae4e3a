//! The first point of a branch: damped Newton from the problem's own starts, then homotopies.
//!
//! The first homotopy follows the solution from small motion, where contacts stick, to the given problem, or
//! from rest under constant loads as the vibrating forces grow, by the same arc-length continuation
//! that follows the branch afterwards. What it misses is tied to an anchor and let loose, see
//! [`crate::continuation::newton_homotopy`]: slower, and sure where solutions are bounded.

use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::newton_homotopy::NewtonHomotopy;
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Continuation, Metric, Point, Settings};
use crate::error::{Error, Result, fail, try_copy, try_push, try_vec};
use crate::linalg::norm;
use crate::problem::{InitialGuess, Problem};

/// How the search for the first point ended.
#[derive(Debug)]
pub enum First {
    /// With a point, and the way that led to it.
    Found(Point, Way),
    /// On the caller's wish.
    Cancelled,
}

/// What led to a first point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Newton's method from a start of the problem's own.
    Newton(InitialGuess),
    /// The problem's homotopy.
    Homotopy,
    /// The homotopy from an anchor.
    Anchor,
    /// The branch itself, from another parameter.
    Branch,
}

impl Way {
    /// What a log says of it.
    #[must_use]
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::Newton(InitialGuess::Given) => "first point solved from the given start",
            Self::Newton(InitialGuess::Stuck) => "first point solved from small motion",
            Self::Newton(InitialGuess::Reference) => "first point solved from the contacts' reference stiffness",
            Self::Homotopy => "first point solved by a homotopy from small motion or rest",
            Self::Anchor => "first point solved by a homotopy from an anchor",
            Self::Branch => "first point solved by following the branch",
        }
    }
}

const CONTEXT: &str = "the start";

/// Most points that a homotopy may take; one that needs more has lost its way among corners.
const MAX_HOMOTOPY_POINTS: usize = 1_000;

/// Longest step of a homotopy, whose way matters only for its end.
const LONG_STEP: f64 = 0.1;

/// Motions so many times those under linear contacts leave of the forces, in double precision, less
/// than four digits.
const FAR: f64 = 1e12;

/// Residual, in units of the motion under linear contacts, that leaves the forces unbalanced however small
/// it is against a large motion.
const UNBALANCED: f64 = 1e-2;

/// Solves for the first point at `settings.start`.
///
/// # Errors
/// `NoConvergence` when every way failed, or what kept a law from telling its force where that was the
/// cause; `Singular` when the linear structure has no solution,
/// and what the problem reports.
pub fn solve(problem: &mut dyn Problem, settings: &Settings, cancelled: Option<&dyn Fn() -> bool>) -> Result<First> {
    let n = problem.size();
    let p = settings.start;
    let mut corrector = Corrector::new(n, settings.tolerance, settings.max_iterations)?;
    let mut v = try_vec(n + 1, 0.0, CONTEXT)?;
    let mut failure = None;
    for kind in [InitialGuess::Given, InitialGuess::Stuck, InitialGuess::Reference] {
        let exists = attempt(problem.initial_guess(kind, p, &mut v[..n]), false, &mut failure)?;
        let mut easy = None;
        if kind == InitialGuess::Stuck {
            if !exists {
                v[..n].fill(0.0);
            }
            easy = Some(try_copy(&v[..n], CONTEXT)?);
        }
        if exists {
            v[n] = p;
            match at_fixed(problem, settings, &mut corrector, &mut v, cancelled)? {
                Outcome::Converged(corrected) if !is_far(problem, &v[..n], p, corrected.residual)? => {
                    v[n] = p;
                    return Ok(First::Found(Point::new(v, corrected, 0.0), Way::Newton(kind)));
                }
                Outcome::Cancelled => return Ok(First::Cancelled),
                Outcome::Converged(_) | Outcome::Failed => failure = corrector.failure().or(failure),
            }
        }
        // The homotopy is surer than a poorer start.
        if let Some(u) = &easy {
            let reached = homotopy(problem, settings, u, &mut corrector, cancelled);
            if let Some(first) = attempt(reached, None, &mut failure)? {
                return Ok(first);
            }
            failure = corrector.failure().or(failure);
        }
    }
    if problem.is_bounded() {
        let reached = from_anchors(problem, settings, &mut corrector, cancelled);
        if let Some(first) = attempt(reached, None, &mut failure)? {
            return Ok(first);
        }
    }
    if let Some(e) = failure {
        return Err(e.at(format_args!("no solution was found at the start, parameter {p}")));
    }
    fail!(
        NoConvergence,
        "no solution was found at the start, parameter {p}: Newton's method and the homotopies failed; start elsewhere, or raise max_newton"
    )
}

/// The outcome of an attempt; `failed` where another motion may not meet its error, which is kept.
fn attempt<T>(outcome: Result<T>, failed: T, failure: &mut Option<Error>) -> Result<T> {
    match outcome {
        Err(e) if e.recoverable => {
            *failure = Some(e);
            Ok(failed)
        }
        outcome => outcome,
    }
}

/// Damped Newton at the fixed parameter in `v`.
fn at_fixed(
    problem: &mut dyn Problem,
    settings: &Settings,
    corrector: &mut Corrector,
    v: &mut [f64],
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Outcome> {
    let n = v.len() - 1;
    let mut row = try_vec(n + 1, 0.0, CONTEXT)?;
    row[n] = 1.0;
    let metric = Metric::along(norm(&v[..n]), settings);
    corrector.correct(problem, v, &row, metric, true, cancelled)
}

/// From the easy problem, near `u`, to the given one.
fn homotopy(
    problem: &mut dyn Problem,
    settings: &Settings,
    u: &[f64],
    corrector: &mut Corrector,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<First>> {
    let Some(mut homotopy) = problem.homotopy(settings.start, u)? else {
        return Ok(None);
    };
    let way = Settings {
        start: homotopy.start,
        end: homotopy.end,
        steps: StepControl::new(0.0, 0.0, LONG_STEP),
        ..*settings
    };
    let reached = follow(&mut *homotopy.problem, &way, u, corrector, cancelled);
    drop(homotopy);
    let Reached::End(v) = reached? else { return Ok(None) };
    at_last(problem, settings, v, Way::Homotopy, corrector, cancelled)
}

/// Newton's method on the problem itself from the end of a homotopy.
fn at_last(
    problem: &mut dyn Problem,
    settings: &Settings,
    mut v: Vec<f64>,
    way: Way,
    corrector: &mut Corrector,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<First>> {
    let n = v.len() - 1;
    v[n] = settings.start;
    Ok(match at_fixed(problem, settings, corrector, &mut v, cancelled)? {
        Outcome::Converged(corrected) if !is_far(problem, &v[..n], settings.start, corrected.residual)? => {
            v[n] = settings.start;
            Some(First::Found(Point::new(v, corrected, 0.0), way))
        }
        Outcome::Cancelled => Some(First::Cancelled),
        Outcome::Converged(_) | Outcome::Failed => None,
    })
}

/// Anchors, each a start times a factor.
const ANCHORS: [(InitialGuess, f64); 3] = [
    (InitialGuess::Reference, 1.0),
    (InitialGuess::Stuck, 1.0),
    (InitialGuess::Reference, 0.0),
];

/// By homotopies from one anchor after the other.
fn from_anchors(
    problem: &mut dyn Problem,
    settings: &Settings,
    corrector: &mut Corrector,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Option<First>> {
    let p = settings.start;
    let mut anchor = try_vec(problem.size(), 0.0, CONTEXT)?;
    let loosened = Settings {
        start: 0.0,
        end: 1.0,
        steps: StepControl::new(0.0, 0.0, LONG_STEP),
        ..*settings
    };
    for (kind, factor) in ANCHORS {
        if !problem.initial_guess(kind, p, &mut anchor)? {
            continue;
        }
        for a in &mut anchor {
            *a *= factor;
        }
        let mut tied = NewtonHomotopy::new(problem, p, &anchor)?;
        let reached = match follow(&mut tied, &loosened, &anchor, corrector, cancelled) {
            Err(e) if e.recoverable => Reached::Nothing,
            reached => reached?,
        };
        // From where a way ended early Newton's method may still arrive.
        if let Reached::End(v) | Reached::Part(v) = reached
            && let Some(first) = at_last(problem, settings, v, Way::Anchor, corrector, cancelled)?
        {
            return Ok(Some(first));
        }
    }
    Ok(None)
}

/// Whether a solution lies so far out that the forces are lost in the rounding of what the motion
/// asks for: nothing is known then of their balance. An undamped structure at its resonance comes here
/// when friction does not hold it.
fn is_far(problem: &mut dyn Problem, u: &[f64], p: f64, residual: f64) -> Result<bool> {
    if !problem.is_bounded() {
        return Ok(false);
    }
    let mut linear = try_vec(u.len(), 0.0, CONTEXT)?;
    let known = matches!(problem.initial_guess(InitialGuess::Reference, p, &mut linear), Ok(true));
    let (far, scale) = (norm(u), norm(&linear));
    Ok(known && scale > 0.0 && (far > FAR * scale || residual * far > UNBALANCED * scale))
}

/// How far a homotopy led.
enum Reached {
    /// To its end.
    End(Vec<f64>),
    /// Not so far; the point nearest to the end.
    Part(Vec<f64>),
    Nothing,
}

/// Follows a homotopy.
fn follow(
    problem: &mut dyn Problem,
    settings: &Settings,
    u: &[f64],
    corrector: &mut Corrector,
    cancelled: Option<&dyn Fn() -> bool>,
) -> Result<Reached> {
    let mut v = try_copy(u, CONTEXT)?;
    try_push(&mut v, settings.start, CONTEXT)?;
    let Outcome::Converged(corrected) = at_fixed(problem, settings, corrector, &mut v, cancelled)? else {
        return Ok(Reached::Nothing);
    };
    let left = |v: &[f64]| (settings.end - v[v.len() - 1]).abs();
    let mut nearest = try_copy(&v, CONTEXT)?;
    let mut continuation = Continuation::new(*settings, Point::new(v, corrected, 0.0))?;
    for _ in 0..MAX_HOMOTOPY_POINTS {
        match continuation.advance(problem, cancelled)? {
            Advance::Accepted { point, last: true } => return Ok(Reached::End(point.v)),
            Advance::Accepted { point, .. } => {
                if left(&point.v) < left(&nearest) {
                    nearest = point.v;
                }
            }
            Advance::LeftAtStart { .. } | Advance::Stopped(_) => break,
        }
    }
    Ok(Reached::Part(nearest))
}
