//! One curve of a forced response over a range of frequency.

#[cfg(test)]
mod lost_sense;

use crate::analysis::forced::coarse_start::CoarseStart;
use crate::analysis::forced::forced_discretised::{ForcedDiscretised, relative_motion};
use crate::analysis::forced::inside_start::{Entry, Inside, in_sense_of};
use crate::analysis::forced::odd_laws;
use crate::analysis::forced::sampling::{SampledModel, may_refine, required, with_samples};
use crate::analysis::forced::unbounded_response;
use crate::condense::blocks::more_harmonics;
use crate::condense::by_factors::flexibility::Workspace;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::{Condensed, FlexibilityWay, ModelCache, Reference, Resolution};
use crate::continuation::initial_point::{self, First, Way};
use crate::continuation::step_control::{Detail, StepControl};
use crate::continuation::{Point, Settings};
use crate::error::{Error, Result, Status, boxed, fail, try_copy, try_push, try_vec};
use crate::harmonics::discretised::{Discretised, Recorder};
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::{Interrupt, Phase};
use crate::linalg::norm;
use crate::model::Model;
use crate::options::Range;
use crate::options::{Content, Exchanged, ForcedOptions, Response, SolverOptions, check_highest, check_responses};
use crate::problem::InitialGuess;
use crate::results::{Branch, Descent};
use crate::tracing::branch_recorder::Ending;
use crate::tracing::branch_tracer::{BranchTracer, Course};
use crate::tracing::inner_ends::{Dropped, InnerEnds};
use crate::tracing::linear_resonances::linear_resonances;
use crate::tracing::resonance_bands::ResonanceBands;
use num_complex::Complex64;

/// Size of a first motion, over that under linear contacts, above which its bound is checked.
const LARGE: f64 = 1e6;

/// The curve of a forced response from the start of the range.
///
/// # Errors
/// As [`crate::analysis::forced_response()`].
pub(crate) fn alone(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    with_detail(model, solver, range, (Detail::Curve, None), (None, hooks))
}

/// The curve that is entered inside the range near the guess; and the harmonics that it has but the branch that it
/// leaves has not. Where it comes back to that branch, its descent holds the frequency. `None`: the curve is known.
///
/// # Errors
/// As [`crate::analysis::forced_response()`].
pub(crate) fn forced_from_inside(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    inside: &Inside<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Option<(Branch, Option<Dropped>)>> {
    let outcome = with_detail(model, solver, range, (Detail::Curve, Some(inside)), (None, hooks));
    match (outcome, inside.entry.get()) {
        (Err(_), Entry::Known) => Ok(None),
        (Ok(branch), Entry::Followed(dropped)) => Ok(Some((branch, dropped))),
        (Ok(branch), _) => Ok(Some((branch, None))),
        (Err(e), _) => Err(e),
    }
}

/// The curve followed for its special points alone, which are as exact as those of [`alone`]. The points between are
/// fewer and less exact, and do not suffice to draw the curve.
///
/// # Errors
/// As [`crate::analysis::forced_response()`].
pub(crate) fn special_points(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    with_detail(model, solver, range, (Detail::SpecialPoints, None), (None, hooks))
}

/// The curve for its special points alone, with the modes in `waves` that other curves of this structure, contacts
/// and response degree of freedom have computed.
///
/// # Errors
/// As [`crate::analysis::forced_response()`].
pub(crate) fn special_points_with(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    (waves, hooks): (&SharedWaves, &mut Hooks<'_>),
) -> Result<Branch> {
    with_detail(
        model,
        solver,
        range,
        (Detail::SpecialPoints, None),
        (Some(waves), hooks),
    )
}

fn with_detail(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    (detail, inside): (Detail, Option<&Inside<'_>>),
    (waves, hooks): (Option<&SharedWaves>, &mut Hooks<'_>),
) -> Result<Branch> {
    solver.check()?;
    range.check()?;
    range.check_guess(model.ndof())?;
    model.check_response_dof(solver.response_dof)?;
    check_responses(range.responses, model.ndof(), model.structure().sectors())?;
    let automatic = [Response::of_no_fundamental()];
    let by_itself = ForcedOptions {
        responses: &automatic,
        ..*range
    };
    let is_missing = range.responses.is_empty() && misses_fundamental(&forced_harmonics(model)?);
    let range = if is_missing { &by_itself } else { range };
    let leading = with_leading_response(solver, range)?;
    let solver = &leading;
    let interrupt = hooks.interrupt();
    let with_guess;
    let solver = match range.guess {
        Some(guess) => {
            let (content, highest) = Content::of(guess, &model.felt_by_contacts()?);
            check_highest(highest, solver)?;
            let content = inside.map_or(content, |inside| inside.content);
            with_guess = SolverOptions { content, ..*solver };
            &with_guess
        }
        None => solver,
    };
    // With fixed harmonics the motions of the contacts are cut off, as in the residual of a caller's point.
    let exchange = if solver.samples > 0 || solver.stability.is_some() {
        Exchanged::None
    } else if solver.tolerance > 0.0 {
        Exchanged::NearRigid
    } else {
        Exchanged::Rigid
    };
    let with_exchange = SolverOptions { exchange, ..*solver };
    let outcome = with_samples(&with_exchange, |solver| {
        let is_fixed = solver.tolerance == 0.0 && !solver.estimate_error && solver.stability.is_none();
        let own = if is_fixed {
            SharedWaves::of_one_sweep(Range::new(range.omega_start, range.omega_stop))
        } else {
            SharedWaves::default()
        };
        let waves = waves.unwrap_or(&own);
        follow(
            model,
            solver,
            (range, detail, inside),
            (waves, hooks),
            &interrupt,
            trace,
        )
    });
    completed(outcome, model, solver)
}

/// The branch of a call that ended or was stopped. It is a function of its own so that its copies of a branch do not
/// lie on the stack under the call.
#[inline(never)]
fn completed(outcome: Result<Box<Branch>>, model: &Model, solver: &SolverOptions) -> Result<Branch> {
    let mut branch = match outcome {
        Err(e) if e.status == Status::StoppedByCaller => Branch::stopped(model, solver)?,
        outcome => *outcome?,
    };
    branch.set_origin(model, true);
    odd_laws::check(model, &mut branch)?;
    Ok(branch)
}

/// Whether forces act in several harmonics and none in the fundamental: no single harmonic is the response.
pub(crate) fn misses_fundamental(forced: &[usize]) -> bool {
    let mut vibrating = forced.iter().filter(|h| **h > 0);
    let first = vibrating.next();
    !forced.contains(&1) && vibrating.any(|h| Some(h) != first)
}

/// The options with the response degree of freedom of the first response, where that response has a single one.
fn with_leading_response(solver: &SolverOptions, range: &ForcedOptions<'_>) -> Result<SolverOptions> {
    let leading = range.responses.first().filter(|response| response.is_plain());
    let Some(&[dof]) = leading.map(|response| response.dofs) else {
        return Ok(*solver);
    };
    match solver.response_dof {
        Some(other) if other != dof => fail!(
            Argument,
            "response_dof = {other}, but the first of the responses is that of {dof}; leave one of them out"
        ),
        _ => Ok(SolverOptions {
            response_dof: Some(dof),
            ..*solver
        }),
    }
}

/// Records the branch from its first point on.
fn trace(
    tracer: &mut BranchTracer<'_>,
    response: &mut ForcedDiscretised<'_>,
    first: Point,
    hooks: &mut Hooks<'_>,
) -> Result<Status> {
    tracer.trace(response, first, hooks)
}

/// Condenses the model and follows the branch, whose points `trace` records; or returns the factor by which more
/// samples are required. A stop before there is a branch is an error.
fn follow(
    model: &Model,
    solver: &SolverOptions,
    (range, detail, inside): (&ForcedOptions<'_>, Detail, Option<&Inside<'_>>),
    (waves, hooks): (&SharedWaves, &mut Hooks<'_>),
    interrupt: &Interrupt<'_>,
    trace: impl FnOnce(&mut BranchTracer<'_>, &mut ForcedDiscretised<'_>, Point, &mut Hooks<'_>) -> Result<Status>,
) -> Result<SampledModel> {
    let since = interrupt.operations();
    interrupt.phase(Phase::Setup, 0.0)?;
    let sweep = Range::new(range.omega_start, range.omega_stop);
    let forced = forced_harmonics(model)?;
    let condensed = |harmonics, reference, fewer: Option<&Condensed>| {
        let options = SolverOptions { harmonics, ..*solver };
        condensed((model, &options), sweep, (reference, fewer), waves, interrupt)
    };
    let levels = HarmonicLevels::new(model, solver, &forced, |highest, fewer| condensed(highest, None, fewer))?;
    let stuck = |highest, fewer: Option<&Condensed>| condensed(highest, Some(Reference::Stuck), fewer);
    let stuck = HarmonicLevels::new(model, solver, &forced, stuck)?;
    // With few harmonics the first point is found quickly; its error tells how many it requires. A guess has its own.
    let level = first_level(model, solver, range, &levels)?;
    let resolution = levels.at(level)?;
    let length = resolution.condensed.length();
    // The lower end is used, so that both directions follow the same degree of freedom.
    let response_dof = match solver.response_dof {
        Some(dof) => dof,
        None => forced_dof_with_largest_motion(model, &resolution.condensed, sweep.low(), interrupt)?,
    };
    let mut settings = settings_of(solver, sweep, detail);
    if inside.is_some() || range.branches > 0 {
        settings.steps = settings.steps.crossing_branches();
    }
    let coarse = if levels.is_automatic() || range.guess.is_some() {
        None
    } else {
        CoarseStart::new(model, solver, &settings, (&forced, response_dof), interrupt)?
    };
    let given = given_start(range, resolution, coarse.as_ref())?;
    let entry = given.as_deref().filter(|_| inside.is_some());
    let entry = entry.map(|guess| try_copy(guess, "the guess")).transpose()?;
    let extended = extended_models(solver.stability.is_some() || solver.estimate_error || levels.is_automatic())?;
    let models = (&levels, &stuck, (&extended, waves));
    let mut response = boxed(|| {
        ForcedDiscretised::new(
            model,
            solver,
            settings,
            models,
            (level, given),
            (range.responses, range.together, response_dof),
            interrupt,
        )
    })?;
    hooks.log(
        LogLevel::Info,
        &sentence(response.flexibility_way(), response.branch().reduction().basis),
    );
    let held = response.branch().reduction().held_by_contacts;
    let mut course = Course {
        bands: bands(model, (solver, detail), (&forced, sweep), interrupt)?,
        resonances: linear_resonances(model, sweep, interrupt)?,
        since,
        ..course_of(solver, range, settings)
    };
    let first = match inside {
        None => first_point(&mut response, &settings, solver.harmonics, interrupt),
        Some(inside) => enter(
            inside,
            &mut response,
            entry.as_deref().unwrap_or(&[]),
            &mut course,
            interrupt,
        ),
    };
    let mut tracer = BranchTracer::new(course, solver.tolerance, interrupt);
    let outcome = match first {
        Ok(First { mut point, mut way }) => {
            if let Some(coarse) = &coarse {
                coarse.count(&mut point, &mut way);
            }
            // Round-off may hide the imbalance of a large motion, but not that forces exceed what contacts take.
            if norm(point.unknowns()) > LARGE
                && let Some(reason) = unbounded_response::reason(model, range.omega_start, interrupt)?
            {
                return Err(reason);
            }
            let used = told_way(way, range.guess.is_some(), hooks);
            response.note_guess(range.guess.map(|_| used));
            response.note_first(&point);
            trace(&mut tracer, &mut response, point, hooks)
        }
        Err(e) if e.status == Status::StoppedByCaller => Err(e),
        Err(e) if inside.is_some() => return Err(e),
        Err(e) => {
            let at = (model, range.omega_start, &*resolution.condensed);
            return Err(with_reason(e, at, held, interrupt));
        }
    };
    if let Some(factor) = required(solver, &*response) {
        return Ok(Err(factor));
    }
    let ending = ending_of(
        outcome,
        response.branch(),
        (model, &forced, inside.is_some()),
        interrupt,
    )?;
    let mut branch = response.finish(model, solver, &ending, tracer.estimates())?;
    let bounds = (length, tracer.unbounded_at());
    tell_end(&mut branch, bounds, inside.map(|_| tracer.merged_at()));
    Ok(Ok(branch))
}

/// Reports whether a complete branch is unbounded, and where a curve that was entered inside the range came back to
/// its parent.
fn tell_end(branch: &mut Branch, (length, unbounded_at): (f64, Option<f64>), merged_at: Option<f64>) {
    if branch.status() == Status::Ok {
        let reason = match unbounded_at {
            Some(omega) => Some(unbounded_response::at(omega)),
            None => unbounded_response::in_branch(branch, length),
        };
        if let Some(reason) = reason {
            branch.set_ending(Status::StoppedUnbounded, Some(reason), (false, false));
        }
    }
    if let Some(at) = merged_at {
        branch.set_descent(Descent::merging_at(at));
    }
}

fn settings_of(solver: &SolverOptions, range: Range, detail: Detail) -> Settings {
    Settings {
        start: range.start,
        end: range.stop,
        tolerance: solver.tol_residual,
        max_iterations: solver.max_newton,
        steps: StepControl::with_detail(solver.step, solver.step_min, solver.step_max, detail),
    }
}

/// The course from the start of the range, without bounds on the steps.
fn course_of<'a>(solver: &SolverOptions, range: &ForcedOptions<'a>, settings: Settings) -> Course<'a> {
    Course {
        settings,
        range: Range::new(range.omega_start, range.omega_stop),
        at: range.at,
        max_points: solver.max_points,
        may_refine: may_refine(solver),
        // The branch is followed before its start as far as the range is long, but not near zero frequency.
        before: Some((2.0 * range.omega_start - range.omega_stop).max(0.5 * range.omega_start)),
        starts_again: range.guess.is_none().then_some(solver.harmonics),
        bands: None,
        resonances: Vec::new(),
        ends: None,
        since: 0,
    }
}

/// The packed relative motions of the guess or, without one, of the solution with few harmonics.
fn given_start(
    range: &ForcedOptions<'_>,
    resolution: &Resolution,
    coarse: Option<&CoarseStart>,
) -> Result<Option<Vec<f64>>> {
    match (range.guess, coarse) {
        (Some(guess), _) => relative_motion(resolution, guess).map(Some),
        (None, Some(coarse)) => coarse.at(&resolution.condensed).map(Some),
        (None, None) => Ok(None),
    }
}

/// The first point of a curve that is entered inside the range. It becomes the start of the course.
fn enter(
    inside: &Inside<'_>,
    response: &mut ForcedDiscretised<'_>,
    guess: &[f64],
    course: &mut Course<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<First> {
    let entered = inside.enter(response, guess, &course.settings, interrupt)?;
    course.settings = in_sense_of(&entered.point, course.settings);
    course.before = None;
    course.ends = Some(InnerEnds::new(&entered.point, response.resolution(), entered.dropped)?);
    Ok(First {
        point: entered.point,
        way: Way::Newton(InitialGuess::Given),
    })
}

/// How a run ended that has recorded `branch`.
fn ending_of(
    outcome: Result<Status>,
    branch: &Branch,
    (model, forced, from_inside): (&Model, &[usize], bool),
    interrupt: &Interrupt<'_>,
) -> Result<Ending> {
    let mut ending = Ending::of(outcome, branch)?;
    if from_inside && ending.status == Status::StoppedLeftRange {
        // Both ends of the range are ends of a curve that was entered inside.
        ending.status = Status::Ok;
    }
    if ending.status == Status::StoppedStepTooSmall
        && ending.reason.is_none()
        && let Some(&omega) = branch.omega().last()
    {
        match unbounded_response::reason(model, omega, interrupt) {
            Ok(reason) => ending.reason = reason,
            Err(e) => ending.status = e.status,
        }
    }
    if ending.status == Status::Ok && forced.is_empty() {
        ending.status = Status::StoppedNoForce;
    }
    Ok(ending)
}

/// The level of harmonics of the first point.
fn first_level(
    model: &Model,
    solver: &SolverOptions,
    range: &ForcedOptions<'_>,
    levels: &HarmonicLevels<'_>,
) -> Result<usize> {
    Ok(match range.guess {
        Some(guess) if levels.is_automatic() => levels.level_with(Content::of(guess, &model.felt_by_contacts()?).1),
        _ if levels.is_automatic() => 0,
        _ => levels.first(solver.harmonics),
    })
}

/// Logs how the first point was found; returns whether it was from the guess.
pub(crate) fn told_way(way: Way, has_guess: bool, hooks: &mut Hooks<'_>) -> bool {
    let used = way == Way::Newton(InitialGuess::Given);
    if has_guess && !used {
        hooks.log(
            LogLevel::Warn,
            "no solution was found from the given start; another way found this first point",
        );
    }
    hooks.log(LogLevel::Info, way.sentence());
    used
}

/// Log sentence that tells how the flexibility is made.
fn sentence(way: FlexibilityWay, basis: usize) -> String {
    if basis == 0 {
        return format!("flexibility of the contacts: {way}");
    }
    format!("flexibility of the contacts, on a basis of {basis} coordinates: {way}")
}

/// The first point, with the current harmonics. If that fails and a tolerance selects them, it is tried with the
/// fewest harmonics, and with those of the options.
#[inline(never)]
fn first_point(
    response: &mut ForcedDiscretised<'_>,
    settings: &Settings,
    harmonics: usize,
    interrupt: &Interrupt<'_>,
) -> Result<First> {
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    let mut failure = match initial_point::solve(response.problem(), settings, interrupt) {
        Err(e) if e.status == Status::NoConvergence && response.levels().is_automatic() => e,
        found => return found,
    };
    for level in [0, response.levels().first(harmonics).min(response.levels().last())] {
        if level == response.resolution() {
            continue;
        }
        response.select(level)?;
        match initial_point::solve(response.problem(), settings, interrupt) {
            Err(e) if e.status == Status::NoConvergence => failure = e,
            found => return found,
        }
    }
    Err(failure)
}

/// Bounds of the steps, where the branch is followed for its special points alone and the caller gives none.
fn bands(
    model: &Model,
    (solver, detail): (&SolverOptions, Detail),
    (forced, sweep): (&[usize], Range),
    interrupt: &Interrupt<'_>,
) -> Result<Option<ResonanceBands>> {
    if detail == Detail::Curve || solver.step_max > 0.0 {
        return Ok(None);
    }
    ResonanceBands::new(model, forced, sweep, interrupt).map(Some)
}

/// Cache of condensed models for error estimates; empty unless they are `wanted`.
fn extended_models(wanted: bool) -> Result<ModelCache> {
    if wanted {
        ModelCache::for_estimates()
    } else {
        ModelCache::new(core::iter::empty())
    }
}

/// The harmonics in which forces act.
pub(crate) fn forced_harmonics(model: &Model) -> Result<Vec<usize>> {
    let mut forced = Vec::new();
    for force in model.acting_forces() {
        try_push(&mut forced, force.harmonic, "the forces")?;
    }
    Ok(forced)
}

/// The model condensed for a sweep, with the modes of its waves where it has some; reuses one with fewer harmonics,
/// where there is one.
fn condensed(
    (model, options): (&Model, &SolverOptions),
    sweep: Range,
    (reference, fewer): (Option<Reference>, Option<&Condensed>),
    waves: &SharedWaves,
    interrupt: &Interrupt<'_>,
) -> Result<Condensed> {
    let shared = match fewer {
        Some(fewer) => more_harmonics::with_more_harmonics(fewer, model, options, interrupt)?,
        None => None,
    };
    let condensed = match shared {
        Some(shared) => shared,
        None => Condensed::with_reference(model, options, sweep, reference, interrupt)?,
    };
    if sweep.is_single() {
        return Ok(condensed);
    }
    waves.attach(model, condensed, interrupt)
}

/// The error with its reason, as far as this is known: no bounded solution exists, or, with preloaded contacts, the
/// static solution or the load path from it was not found.
#[inline(never)]
fn with_reason(
    e: Error,
    (model, omega, condensed): (&Model, f64, &Condensed),
    held: usize,
    interrupt: &Interrupt<'_>,
) -> Error {
    if e.status != Status::NoConvergence {
        return e;
    }
    match unbounded_response::reason(model, omega, interrupt) {
        Err(reason) | Ok(Some(reason)) => return reason,
        Ok(None) => {}
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

/// The forced degree of freedom with the largest fundamental at `omega`, with every contact at its reference
/// stiffness.
#[inline(never)]
fn forced_dof_with_largest_motion(
    model: &Model,
    condensed: &Condensed,
    omega: f64,
    interrupt: &Interrupt<'_>,
) -> Result<usize> {
    let set = condensed.set();
    let observed = set.watched();
    let mut x = try_vec(condensed.ndof(), Complex64::ZERO, "the response")?;
    let rest = try_vec(condensed.coordinates(), Complex64::ZERO, "the response")?;
    Workspace::new(condensed, None)?.recover(condensed, observed, omega, &rest, &mut x, interrupt)?;
    let mut best = 0;
    let mut most = None;
    let moved = |dof| !model.structure().degrees().is_fixed(dof);
    for force in model.excitation().forces().iter().filter(|f| moved(f.dof)) {
        let motion = condensed.motion_row(observed, force.dof)?.along(&x).norm();
        if force.value != Complex64::ZERO && most.is_none_or(|most| motion > most) {
            best = force.dof;
            most = Some(motion);
        }
    }
    Ok(best)
}
