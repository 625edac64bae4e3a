//! The first point of a branch: damped Newton from the problem's initial guesses, then homotopies.
//!
//! The first homotopy follows the solution from small motion, where contacts stick, to the given problem, or from
//! rest under constant loads as the vibrating forces grow, by the same arc-length continuation that follows the
//! branch afterwards. If it fails, homotopies from an anchor follow, see [`crate::continuation::newton_homotopy`]:
//! they are slower, and reliable where solutions are bounded.

use crate::continuation::corrector::{Corrector, Outcome};
use crate::continuation::newton_homotopy::NewtonHomotopy;
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Continuation, Metric, Point, Settings};
use crate::error::{Error, Result, fail, try_copy, try_push, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::norm;
use crate::problem::{InitialGuess, Problem};

/// The first point of a branch, and how it was found.
#[derive(Debug)]
pub struct First {
    /// The solved first point.
    pub point: Point,
    /// The method that found it.
    pub way: Way,
}

/// Method that found a first point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Newton's method from an initial guess of the problem.
    Newton(InitialGuess),
    /// The homotopy that the problem itself provides.
    Homotopy,
    /// A Newton homotopy from an anchor.
    Anchor,
    /// From contacts as soft as the structure, which become as stiff as they are.
    Stiffened,
    /// Continuation of the branch from another parameter value.
    Branch,
    /// Newton's method from a solution with fewer harmonics.
    Transferred,
}

impl Way {
    /// Sentence of this method for a log.
    #[must_use]
    pub const fn sentence(self) -> &'static str {
        match self {
            Self::Newton(InitialGuess::Given) => "first point solved from the given start",
            Self::Newton(InitialGuess::Stuck) => "first point solved from small motion",
            Self::Newton(InitialGuess::Reference) => "first point solved from the contacts' reference stiffness",
            Self::Homotopy => "first point solved by a homotopy from small motion or rest",
            Self::Anchor => "first point solved by a homotopy from an anchor",
            Self::Stiffened => "first point solved with softer contacts, which become as stiff as they are",
            Self::Branch => "first point solved by following the branch",
            Self::Transferred => "first point solved from one with fewer harmonics",
        }
    }
}

const CONTEXT: &str = "the start";

/// Bounds of the work for a first point.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Largest number of points of a homotopy.
    pub points: usize,
    /// Number of Newton iterations after which no further homotopy is followed.
    pub iterations: usize,
    /// Number of operations, as the interrupt of the call has counted them since its begin, at which no further attempt begins.
    pub until: u64,
}

/// Bounds of the work for a first point: a homotopy that needs more points circulates among corners.
/// Kind: cap.
const INITIAL_POINT_MOST: Effort = Effort {
    points: 1_000,
    iterations: usize::MAX,
    until: u64::MAX,
};

/// Share of a homotopy that counts as progress.
/// Kind: tuned; measured on: not recorded.
const PROGRESS: f64 = 1e-3;

/// Longest step of a homotopy, of which only the end matters.
/// Kind: tuned; measured on: not recorded.
const LONG_STEP: f64 = 0.1;

/// Solves for the first point at `settings.start`. The reported iterations are those of all attempts, homotopies
/// included.
///
/// # Errors
/// `NoConvergence` if every method failed, or the failure of a law if that was the cause; `Singular` if the linear
/// structure has no solution; those of the problem; `StoppedByCaller`.
pub fn solve(problem: &mut dyn Problem, settings: &Settings, interrupt: &Interrupt<'_>) -> Result<First> {
    solve_within(problem, settings, INITIAL_POINT_MOST, interrupt)
}

/// Solves for the first point as `solve` does, with bounded work.
///
/// # Errors
/// Those of [`solve`].
pub fn solve_within(
    problem: &mut dyn Problem,
    settings: &Settings,
    effort: Effort,
    interrupt: &Interrupt<'_>,
) -> Result<First> {
    let tolerance = settings.steps.tolerance(settings.tolerance);
    let mut corrector = Corrector::new(problem.size(), tolerance, settings.max_iterations)?;
    let mut first = try_each_way(problem, settings, effort, &mut corrector, interrupt)?;
    first.point.iterations = corrector.steps_taken();
    Ok(first)
}

fn try_each_way(
    problem: &mut dyn Problem,
    settings: &Settings,
    effort: Effort,
    corrector: &mut Corrector,
    interrupt: &Interrupt<'_>,
) -> Result<First> {
    let n = problem.size();
    let p = settings.start;
    let mut v = try_vec(n + 1, 0.0, CONTEXT)?;
    let mut failure = None;
    for kind in [InitialGuess::Given, InitialGuess::Stuck, InitialGuess::Reference] {
        if interrupt.operations() >= effort.until {
            break;
        }
        let exists = attempt(problem.initial_guess(kind, p, &mut v[..n]), false, &mut failure)?;
        let mut homotopy_guess = None;
        if kind == InitialGuess::Stuck {
            if !exists {
                v[..n].fill(0.0);
            }
            homotopy_guess = Some(try_copy(&v[..n], CONTEXT)?);
        }
        if exists {
            v[n] = p;
            match at_fixed(problem, settings, corrector, &mut v, interrupt)? {
                Outcome::Converged(corrected) if !problem.is_far(&v[..n], p, corrected.residual)? => {
                    v[n] = p;
                    return Ok(First {
                        point: Point::new(v, corrected, 0.0),
                        way: Way::Newton(kind),
                    });
                }
                Outcome::Converged(_) | Outcome::Failed => failure = corrector.failure().or(failure),
            }
        }
        // The homotopy is more reliable than a poorer initial guess.
        if let Some(u) = &homotopy_guess {
            let reached = homotopy(problem, settings, effort, u, corrector, interrupt);
            if let Some(first) = attempt(reached, None, &mut failure)? {
                return Ok(first);
            }
            failure = corrector.failure().or(failure);
        }
    }
    if problem.is_bounded() {
        let reached = try_anchors(problem, settings, effort, corrector, interrupt);
        if let Some(first) = attempt(reached, None, &mut failure)? {
            return Ok(first);
        }
    }
    if let Some(by) = problem.softened_by() {
        let reached = from_softened(problem, settings, effort, by, corrector, interrupt);
        problem.soften(0.0);
        if let Some(v) = attempt(reached, None, &mut failure)?
            && let Some(first) = finish(problem, settings, v, Way::Stiffened, corrector, interrupt)?
        {
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

/// The value of an attempt; `failed` if another motion may avoid its error, which is then stored.
fn attempt<T>(outcome: Result<T>, failed: T, failure: &mut Option<Error>) -> Result<T> {
    match outcome {
        Err(e) if e.recoverable => {
            *failure = Some(e);
            Ok(failed)
        }
        outcome => outcome,
    }
}

/// Solves by damped Newton steps at the fixed parameter in `v`.
fn at_fixed(
    problem: &mut dyn Problem,
    settings: &Settings,
    corrector: &mut Corrector,
    v: &mut [f64],
    interrupt: &Interrupt<'_>,
) -> Result<Outcome> {
    let n = v.len() - 1;
    let mut row = try_vec(n + 1, 0.0, CONTEXT)?;
    row[n] = 1.0;
    let metric = Metric::along(norm(&v[..n]), settings);
    corrector.correct(problem, v, &row, metric, true, interrupt)
}

/// Follows the problem's homotopy, from near `u` to the given problem.
fn homotopy(
    problem: &mut dyn Problem,
    settings: &Settings,
    effort: Effort,
    u: &[f64],
    corrector: &mut Corrector,
    interrupt: &Interrupt<'_>,
) -> Result<Option<First>> {
    let Some(mut homotopy) = problem.homotopy(settings.start, u)? else {
        return Ok(None);
    };
    let path = Settings {
        start: homotopy.start,
        end: homotopy.end,
        steps: StepControl::new(0.0, 0.0, LONG_STEP),
        ..*settings
    };
    let points = (effort, homotopy.patience);
    let reached = follow(&mut *homotopy.problem, &path, points, u, corrector, interrupt);
    drop(homotopy);
    let Reached::End(v) = reached? else { return Ok(None) };
    finish(problem, settings, v, Way::Homotopy, corrector, interrupt)
}

/// Solves the problem itself by Newton's method from the end of a homotopy.
fn finish(
    problem: &mut dyn Problem,
    settings: &Settings,
    mut v: Vec<f64>,
    way: Way,
    corrector: &mut Corrector,
    interrupt: &Interrupt<'_>,
) -> Result<Option<First>> {
    let n = v.len() - 1;
    v[n] = settings.start;
    Ok(match at_fixed(problem, settings, corrector, &mut v, interrupt)? {
        Outcome::Converged(corrected) if !problem.is_far(&v[..n], settings.start, corrected.residual)? => {
            v[n] = settings.start;
            Some(First {
                point: Point::new(v, corrected, 0.0),
                way,
            })
        }
        Outcome::Converged(_) | Outcome::Failed => None,
    })
}

/// Anchors of homotopies: initial guesses, each with a factor.
const ANCHORS: [(InitialGuess, f64); 3] = [
    (InitialGuess::Reference, 1.0),
    (InitialGuess::Stuck, 1.0),
    (InitialGuess::Reference, 0.0),
];

/// Tries homotopies from one anchor after the other.
fn try_anchors(
    problem: &mut dyn Problem,
    settings: &Settings,
    effort: Effort,
    corrector: &mut Corrector,
    interrupt: &Interrupt<'_>,
) -> Result<Option<First>> {
    let p = settings.start;
    let mut anchor = try_vec(problem.size(), 0.0, CONTEXT)?;
    let path = Settings {
        start: 0.0,
        end: 1.0,
        steps: StepControl::new(0.0, 0.0, LONG_STEP),
        ..*settings
    };
    for (kind, factor) in ANCHORS {
        let is_over = corrector.steps_taken() >= effort.iterations || interrupt.operations() >= effort.until;
        if is_over || !problem.initial_guess(kind, p, &mut anchor)? {
            continue;
        }
        for a in &mut anchor {
            *a *= factor;
        }
        let mut homotopy = NewtonHomotopy::new(problem, p, &anchor)?;
        let reached = match follow(
            &mut homotopy,
            &path,
            (effort, effort.points),
            &anchor,
            corrector,
            interrupt,
        ) {
            Err(e) if e.recoverable => Reached::Nothing,
            reached => reached?,
        };
        // Newton's method may converge even from where a path ended early.
        if let Reached::End(v) | Reached::Part(v) = reached
            && let Some(first) = finish(problem, settings, v, Way::Anchor, corrector, interrupt)?
        {
            return Ok(Some(first));
        }
    }
    Ok(None)
}

/// Solves with contacts as soft as `by` says, ln σ, and follows the solution until they are as stiff as they are.
fn from_softened(
    problem: &mut dyn Problem,
    settings: &Settings,
    effort: Effort,
    by: f64,
    corrector: &mut Corrector,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Vec<f64>>> {
    problem.soften(by);
    let mut u = try_vec(problem.size(), 0.0, CONTEXT)?;
    let first = match homotopy(problem, settings, effort, &u, corrector, interrupt)? {
        None => try_anchors(problem, settings, effort, corrector, interrupt)?,
        first => first,
    };
    let Some(first) = first else { return Ok(None) };
    u.copy_from_slice(first.point.unknowns());
    let Some(mut path) = problem.stiffening(by, settings.start) else {
        return Ok(None);
    };
    let along = Settings {
        start: path.start,
        end: path.end,
        steps: StepControl::new(0.0, 0.0, LONG_STEP),
        ..*settings
    };
    let points = (effort, path.patience);
    Ok(
        match follow(&mut *path.problem, &along, points, &u, corrector, interrupt)? {
            Reached::End(v) | Reached::Part(v) => Some(v),
            Reached::Nothing => None,
        },
    )
}

/// Where a homotopy path stopped.
enum Reached {
    /// The end of the homotopy, with the unknowns of its solution.
    End(Vec<f64>),
    /// A point before the end; the one nearest to it.
    Part(Vec<f64>),
    Nothing,
}

/// Follows a homotopy with bounded work; at most `patience` successive points may make no progress.
fn follow(
    problem: &mut dyn Problem,
    settings: &Settings,
    (effort, patience): (Effort, usize),
    u: &[f64],
    corrector: &mut Corrector,
    interrupt: &Interrupt<'_>,
) -> Result<Reached> {
    let mut v = try_copy(u, CONTEXT)?;
    try_push(&mut v, settings.start, CONTEXT)?;
    let Outcome::Converged(corrected) = at_fixed(problem, settings, corrector, &mut v, interrupt)? else {
        return Ok(Reached::Nothing);
    };
    let left = |v: &[f64]| (settings.end - v[v.len() - 1]).abs();
    let mut nearest = try_copy(&v, CONTEXT)?;
    let mut continuation = Continuation::new(*settings, Point::new(v, corrected, 0.0))?;
    let path = (settings.end - settings.start).abs();
    let (mut reference, mut since) = (left(&nearest), 0);
    for _ in 0..effort.points {
        let steps = corrector.steps_taken() + continuation.steps_taken();
        if since >= patience || steps >= effort.iterations || interrupt.operations() >= effort.until {
            break;
        }
        match continuation.advance(problem, interrupt)? {
            Advance::Accepted { point, last: true } => {
                corrector.count_steps(continuation.steps_taken());
                return Ok(Reached::End(point.v));
            }
            Advance::Accepted { point, .. } => {
                since += 1;
                if (left(&point.v) - reference).abs() > PROGRESS * path {
                    (reference, since) = (left(&point.v), 0);
                }
                if left(&point.v) < left(&nearest) {
                    nearest = point.v;
                }
            }
            Advance::LeftAtStart { .. } | Advance::Stopped(_) => break,
        }
    }
    corrector.count_steps(continuation.steps_taken());
    Ok(Reached::Part(nearest))
}
