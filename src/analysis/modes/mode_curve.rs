//! One curve of a nonlinear mode over a range of amplitude.

use crate::analysis::forced::inside_start::in_sense_of;
use crate::analysis::forced::odd_laws;
use crate::analysis::forced::sampling::{SampledModel, required, with_samples};
use crate::analysis::modes::mode_discretised::ModeDiscretised;
use crate::analysis::modes::mode_entry::{EntryWay, ModeEntry};
use crate::analysis::modes::mode_equations::LinearStart;
use crate::analysis::modes::mode_guess;
use crate::analysis::modes::mode_path::{Onset, course, trace};
use crate::analysis::modes::mode_start::ModeStart;
use crate::condense::blocks::reduction::reduction;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::{Condensed, ModelCache};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Point, Settings};
use crate::error::{Error, Result, Status, boxed, fail};
use crate::harmonics::discretised::{Discretised, Recorder};
use crate::harmonics::harmonic_levels::HarmonicLevels;
use crate::harmonics::mode_error::ModeEstimator;
use crate::hooks::Hooks;
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::model::natural_modes::repeated_modes::Multiple;
use crate::options::Range;
use crate::options::{Content, Flexibility, ModeOptions, SolverOptions, check_highest};
use crate::problem::epmc::{Gauge, LinearMode};
use crate::problem::static_state::StaticState;
use crate::results::stored::mode_branch::{ModeData, ModeInfo};
use crate::results::{Branch, Descent};
use crate::tracing::branch_recorder::Ending;
use crate::tracing::branch_tracer::{BranchTracer, Course};
use crate::tracing::inner_ends::InnerEnds;

/// One curve of a nonlinear mode: from its linear mode, from a guess, or entered at a known point.
///
/// # Errors
/// As [`crate::analysis::modes::nonlinear_mode()`].
pub(crate) fn alone(
    model: &Model,
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
    entry: Option<&ModeEntry<'_>>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    solver.check()?;
    let sectors = model.structure().sectors();
    range.check(model.ndof(), model.contacts().len(), sectors)?;
    model.check_matrices(true)?;
    if solver.harmonics == 0 {
        return fail!(Argument, "harmonics = 0, a nonlinear mode needs at least 1");
    }
    if solver.stability.is_some() {
        return fail!(
            Argument,
            "stability: only a forced response has it along its curve; a nonlinear mode has Floquet multipliers at its limit cycles"
        );
    }
    if solver.freedom {
        return fail!(
            Argument,
            "freedom: only a forced response has it along its curve; a nonlinear mode has hbvib_mode_band"
        );
    }
    if solver.flexibility != Flexibility::Automatic {
        return fail!(
            Argument,
            "flexibility: only a forced response has a choice of it; a nonlinear mode needs the automatic one"
        );
    }
    model.check_response_dof(solver.response_dof)?;
    let other_wave;
    let given = model;
    let model = match range.diameter {
        None => model,
        Some(diameter) => {
            let mut model = model.try_clone()?;
            model.set_wave(model.structure().signed_diameter(diameter));
            other_wave = model;
            &other_wave
        }
    };
    let separate = model.with_separate_loss()?;
    let model = &*separate;
    let interrupt = hooks.interrupt();
    let mut with_content = *solver;
    if let Some(guess) = &range.guess {
        let (content, highest) = Content::of(guess.motion, &model.felt_by_contacts()?);
        check_highest(highest, solver)?;
        with_content.content = content;
    }
    if range.branches > 0 {
        // A broken symmetry is a branch point where the equations have the harmonics that it adds.
        with_content.content = Content { base: 1, even: true };
    }
    let solver = &with_content;
    match with_samples(solver, |solver| on_wave(model, solver, range, entry, hooks, &interrupt)) {
        Err(e) if e.status == Status::StoppedByCaller => stopped(model, solver, range),
        outcome => outcome.map(|branch| *branch),
    }
    .and_then(|mut branch| {
        branch.set_origin(given, range.diameter.is_none());
        odd_laws::check(model, &mut branch)?;
        Ok(branch)
    })
}

/// The mode of a run that was stopped before its linear mode was known: its numbers are zero.
fn stopped(model: &Model, solver: &SolverOptions, range: &ModeOptions<'_>) -> Result<Branch> {
    let mut branch = Branch::stopped(model, solver)?;
    let info = ModeInfo {
        index: 0,
        omega: 0.0,
        multiplicity: 0,
        multiple: Multiple::Single,
        reference_dof: 0,
        engine_order: model.structure().engine_order(),
        amplitude: range.amplitude,
        linear_up_to: f64::NEG_INFINITY,
        slip_from: f64::INFINITY,
        lift_off_from: f64::INFINITY,
        stuck: Vec::new(),
        free: Vec::new(),
    };
    let linear = LinearMode {
        omega: 0.0,
        damping: 0.0,
        shape: Vec::new(),
        rest: StaticState::default(),
    };
    let gauge = Gauge {
        contact: None,
        reference_dof: 0,
    };
    let ends = Range::new(range.log10_start, range.log10_stop);
    branch.set_mode(ModeData::new(info, linear, gauge, ends));
    Ok(branch)
}

/// The nonlinear mode on the wave of the model's engine order, or the factor by which more samples are required.
fn on_wave(
    model: &Model,
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
    entry: Option<&ModeEntry<'_>>,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<SampledModel> {
    interrupt.phase(Phase::Setup, 0.0)?;
    let start = boxed(|| ModeStart::new(model, solver, range, interrupt))?;
    let (linear, gauge) = (&start.linear, &start.gauge);
    let waves = SharedWaves::default();
    let levels = HarmonicLevels::new(model, solver, &[1], |harmonics, _| {
        let options = SolverOptions { harmonics, ..*solver };
        let form = (range.damping_form, linear.rest.is_loaded());
        let (condensed, _) = Condensed::for_mode(model, &options, form, &linear.shape, interrupt)?;
        waves.attach(model, condensed, interrupt)
    })?;
    let level = match (&range.guess, entry) {
        (_, Some(entry)) => levels.level_of(entry.from.set()),
        (Some(guess), None) if levels.is_automatic() => {
            levels.level_with(Content::of(guess.motion, &model.felt_by_contacts()?).1)
        }
        _ => levels.first(solver.harmonics),
    };
    let resolution = levels.at(level)?;
    start.check_motion(&resolution.condensed)?;
    let reference_dof = model.structure().degrees().origin(gauge.reference_dof);
    let response = solver.response_dof.unwrap_or(reference_dof);
    let reported = if levels.is_automatic() { 0 } else { solver.harmonics };
    let branch = boxed(|| {
        let reduction = reduction(&resolution.condensed, model, solver, interrupt)?;
        Branch::new(resolution, reduction, reported, response)
    })?;
    let estimates = solver.estimate_error || levels.is_automatic();
    let extended = ModelCache::for_estimates()?;
    let make = || {
        let start = (linear, gauge);
        let form = range.damping_form;
        let models = (&extended, &waves);
        Ok(ModeEstimator::new(
            (model, solver),
            form,
            start,
            response,
            models,
            interrupt,
        ))
    };
    let estimator = estimates.then(|| boxed(make)).transpose()?;
    let mut steps = StepControl::new(solver.step, solver.step_min, solver.step_max);
    if range.branches > 0 {
        steps = steps.crossing_branches();
    }
    let settings = Settings {
        start: range.log10_start,
        end: range.log10_stop,
        tolerance: solver.tol_residual,
        max_iterations: solver.max_newton,
        steps,
    };
    let begin = LinearStart {
        linear,
        gauge,
        is_repeated: start.is_repeated(),
        interrupt,
    };
    let mut mode = boxed(|| ModeDiscretised::new(begin, solver, settings, (&levels, level), branch, estimator))?;
    let guess = range
        .guess
        .map(|guess| mode_guess::unknowns(resolution, (linear, gauge), &guess))
        .transpose()?;
    let (linear_up_to, nearly) = if guess.is_some() || entry.is_some() {
        // All of the range is nonlinear.
        (f64::NEG_INFINITY, f64::NEG_INFINITY)
    } else {
        mode.linear_up_to(range.log10_start)?
    };
    mode.set_mode(start.data(model, range, linear_up_to)?);
    let onset = Onset { linear_up_to, nearly };
    let (mut course, settings) = course(solver, range, settings, onset);
    if range.branches > 0 {
        mode.seek_branch_points();
    }
    let entered = match entry {
        Some(entry) => Some(enter(entry, &mut mode, &mut course, interrupt)?),
        None => None,
    };
    let mut tracer = BranchTracer::new(course, solver.tolerance, interrupt);
    let outcome = match entered {
        Some(first) => tracer.trace(&mut *mode, first, hooks),
        None => trace(&mut mode, &mut tracer, (settings, onset), guess, hooks, interrupt)
            .map_err(|e| if linear.rest.is_loaded() { about_static(e) } else { e }),
    };
    if let Some(factor) = required(solver, &*mode) {
        return Ok(Err(factor));
    }
    let mut ending = Ending::of(outcome, mode.branch())?;
    if entry.is_some() && ending.status == Status::StoppedLeftRange {
        // Both ends of the range are ends of a curve that was entered inside.
        ending.status = Status::Ok;
    }
    let mut branch = mode.finish(model, solver, &ending, tracer.estimates())?;
    if entry.is_some() {
        branch.set_descent(Descent::merging_at(tracer.merged_at()));
    }
    Ok(Ok(branch))
}

/// The first point of a further curve. It becomes the start of the course.
fn enter(
    entry: &ModeEntry<'_>,
    mode: &mut ModeDiscretised<'_>,
    course: &mut Course<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Point> {
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    let entered = entry.enter(mode, &course.settings, interrupt)?;
    if matches!(entry.way, EntryWay::BranchPoint { .. }) {
        course.settings = in_sense_of(&entered.point, course.settings);
        course.ends = Some(InnerEnds::new(&entered.point, mode.resolution(), entered.dropped)?);
    }
    Ok(entered.point)
}

/// The error of a nonlinear mode; if no solution was found, it says that the mode is about a loaded static state.
fn about_static(e: Error) -> Error {
    if e.status != Status::NoConvergence {
        return e;
    }
    Error::new(
        e.status,
        format_args!(
            "no vibration about the static state was found at the first amplitude: a body that friction alone holds may have \
             none, hold it by soft springs; constant forces that balance the preload keep contacts from slipping at rest"
        ),
    )
}
