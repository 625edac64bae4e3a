//! A nonlinear mode over a range of amplitude: its frequency and damping from contacts that stick to contacts that
//! slide.

use crate::adaptivity::branch_recorder::Ending;
use crate::adaptivity::branch_tracer::{BranchTracer, Course};
use crate::adaptivity::discretised::{Discretised, Recorder};
use crate::adaptivity::harmonic_levels::HarmonicLevels;
use crate::analysis::mode_discretised::ModeDiscretised;
use crate::analysis::mode_equations::LinearStart;
use crate::analysis::sampling::{Sampled, may_refine, required, with_samples};
use crate::analysis::static_solution::{NEEDS_SPEED, static_state};
use crate::condense::Condensed;
use crate::condense::wave_cache::SharedWaves;
use crate::continuation::initial_point::{self, First, Way};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Advance, Continuation, Point, Settings};
use crate::error::{Error, Result, Status, boxed, fail, try_copy};
use crate::error_estimate::mode_error::ModeEstimator;
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::model::linear_modes::ContactState;
use crate::model::mode_selection::SelectedMode;
use crate::model::repeated_modes::Multiple;
use crate::model::spring::along;
use crate::options::{Amplitude, ModeOptions, SolverOptions};
use crate::problem::Problem;
use crate::problem::epmc::{Gauge, LinearMode};
use crate::problem::static_state::StaticState;
use crate::results::mode_branch::{ModeData, ModeInfo};
use crate::results::{Branch, SpecialKind};

/// Motion that counts as zero, relative to the largest of the mode.
const NODE: f64 = 1e-9;

/// First amplitude beyond the onset of slip that is solved for, relative to the onset. At the onset itself the branch
/// has a corner, and where modes share a frequency no solution is isolated.
const BEYOND_ONSET: f64 = 1.02;

/// Distance below the onset, in log₁₀, to which a branch that began to slip may come back before it reaches an
/// amplitude above the onset.
const BELOW_ONSET: f64 = 3.0;

/// Follows a nonlinear mode of `model` from `range.log10_start` to `range.log10_stop`.
///
/// The mode vibrates about the static state under the constant forces of the model and the preload of its contacts;
/// vibrating forces have no effect. A branch that ends early is returned with a positive [`Branch::status`]
/// and every point found. Its peaks are the points of largest damping ratio, its folds those where the amplitude
/// turns.
///
/// # Errors
/// Bad options and models ([`SolverOptions::check`], [`ModeOptions::check`], [`Model::select_mode`]), `Argument` for
/// a mode that moves no contact and for a reference degree of freedom at a node of the mode, `NoConvergence` if no
/// static state or no first point was found.
///
/// # Example
/// The frequency falls from √2, where the contact of the mass sticks, to 1, where it slides.
///
/// ```
/// # use hbvib::{Contact, MatrixKind, MatrixView, Model};
/// use hbvib::{Hooks, ModeOptions, SolverOptions, nonlinear_mode};
///
/// # let mut model = Model::new(1)?;
/// # model.set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[1.0]))?;
/// # model.set_rayleigh(0.0, 0.02)?;
/// # model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0))?;
/// # model.add_force(0, 1, 0.2.into())?;
/// let range = ModeOptions { log10_start: -2.0, log10_stop: 1.0, ..ModeOptions::default() };
/// let mode = nonlinear_mode(&model, &SolverOptions::default(), &range, &mut Hooks::default())?;
/// let (first, last) = (mode.omega()[0], mode.omega()[mode.points() - 1]);
/// assert!((first - 2f64.sqrt()).abs() < 1e-6 && last < 1.01);
/// # Ok::<(), hbvib::Error>(())
/// ```
pub fn nonlinear_mode(
    model: &Model,
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
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
    model.check_response_dof(solver.response_dof)?;
    let other_wave;
    let model = match range.diameter {
        None => model,
        Some(diameter) => {
            let mut model = model.try_clone()?;
            model.set_wave(diameter as i64);
            other_wave = model;
            &other_wave
        }
    };
    let separate = model.with_separate_loss()?;
    let model = &*separate;
    let interrupt = hooks.interrupt();
    match with_samples(solver, |solver| on_wave(model, solver, range, hooks, &interrupt)) {
        Err(e) if e.status == Status::StoppedByCaller => stopped(model, solver, range),
        outcome => outcome.map(|branch| *branch),
    }
}

/// The mode of a run that was stopped before its linear mode was known: zeros in place of its numbers.
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
    let ends = (range.log10_start, range.log10_stop);
    branch.set_mode(ModeData::new(info, linear, gauge, ends));
    Ok(branch)
}

/// The linear mode from which the nonlinear one starts, and how it was selected.
struct Start {
    linear: LinearMode,
    gauge: Gauge,
    chosen: SelectedMode,
}

impl Start {
    /// The mode that the options select, about the static state.
    fn new(model: &Model, solver: &SolverOptions, range: &ModeOptions<'_>, interrupt: &Interrupt<'_>) -> Result<Self> {
        let rest = static_state(model, solver, NEEDS_SPEED, interrupt)?;
        // Natural modes are those of a potential; the damped mode has the other forces of laws of the caller, too.
        let symmetric = rest.tangents.symmetric()?;
        let [natural, contacts] = [&symmetric, &rest.tangents].map(|tangents| {
            if rest.is_loaded() {
                ContactState::AboutStatic(tangents)
            } else {
                ContactState::Stuck
            }
        });
        let chosen = model.select_mode_with(range.choice, natural, interrupt)?;
        let damped = model.damped_mode_with(&chosen, contacts, range.damping_form, interrupt)?;
        let mut linear = LinearMode {
            omega: damped.omega,
            damping: damped.damping,
            shape: damped.shape,
            rest,
        };
        let gauge = gauge(model, range, &mut linear)?;
        Ok(Self { linear, gauge, chosen })
    }

    /// Refuses a mode that moves no contact.
    fn check_motion(&self, condensed: &Condensed) -> Result<()> {
        let i = condensed.set().fundamental();
        let shape = &self.linear.shape;
        let moved = condensed.blocks()[i].rows.iter().map(|row| row.along(shape).norm());
        let motion = moved.fold(0.0, f64::max);
        let largest = shape.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        if condensed.coordinates() == 0 || motion <= NODE * largest {
            return fail!(
                Argument,
                "mode {} (angular frequency {}) moves no contact that can slip: largest relative motion {motion} of {largest}; it is linear",
                self.chosen.index,
                self.chosen.omega
            );
        }
        Ok(())
    }

    /// The data of the mode. Like all parts of a run it is a function of its own, so that they take their share of a small
    /// stack one after the other.
    #[inline(never)]
    fn data(&self, model: &Model, range: &ModeOptions<'_>, linear_up_to: f64) -> Result<ModeData> {
        const CONTEXT: &str = "the nonlinear mode";
        let info = ModeInfo {
            index: self.chosen.index,
            omega: self.chosen.omega,
            multiplicity: self.chosen.multiplicity,
            multiple: self.chosen.multiple,
            reference_dof: model.structure().degrees().origin(self.gauge.reference_dof),
            engine_order: model.structure().engine_order(),
            amplitude: range.amplitude,
            linear_up_to,
            slip_from: f64::INFINITY,
            lift_off_from: f64::INFINITY,
            stuck: try_copy(&self.chosen.stuck, CONTEXT)?,
            free: try_copy(&self.chosen.free, CONTEXT)?,
        };
        let ends = (range.log10_start, range.log10_stop);
        Ok(ModeData::new(info, self.linear.clone(), self.gauge.clone(), ends))
    }
}

/// The mode on the wave of the model's engine order, or the factor by which more samples are required.
fn on_wave(
    model: &Model,
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Sampled> {
    interrupt.phase(Phase::Setup, 0.0)?;
    let start = boxed(|| Start::new(model, solver, range, interrupt))?;
    let (linear, gauge) = (&start.linear, &start.gauge);
    let waves = SharedWaves::default();
    let levels = HarmonicLevels::new(model, solver, &[1], |harmonics| {
        let options = SolverOptions { harmonics, ..*solver };
        let form = (range.damping_form, linear.rest.is_loaded());
        let (condensed, _) = Condensed::for_mode(model, &options, form, &linear.shape, interrupt)?;
        waves.attach(model, condensed, interrupt)
    })?;
    let level = levels.first(solver.harmonics);
    let resolution = levels.at(level)?;
    start.check_motion(&resolution.condensed)?;
    let reference_dof = model.structure().degrees().origin(gauge.reference_dof);
    let response = solver.response_dof.unwrap_or(reference_dof);
    let reported = if levels.is_automatic() { 0 } else { solver.harmonics };
    let branch = boxed(|| {
        let reduction = resolution.condensed.reduction(model, solver, interrupt)?;
        Branch::new(resolution, reduction, reported, response)
    })?;
    let estimates = solver.estimate_error || levels.is_automatic();
    let make = || {
        let start = (linear, gauge);
        let form = range.damping_form;
        Ok(ModeEstimator::new(model, solver, form, start, response, interrupt))
    };
    let estimator = estimates.then(|| boxed(make)).transpose()?;
    let settings = Settings {
        start: range.log10_start,
        end: range.log10_stop,
        tolerance: solver.tol_residual,
        max_iterations: solver.max_newton,
        steps: StepControl::new(solver.step, solver.step_min, solver.step_max),
    };
    let begin = LinearStart {
        linear,
        gauge,
        interrupt,
    };
    let mut mode = boxed(|| ModeDiscretised::new(begin, solver, settings, (&levels, level), branch, estimator))?;
    let (linear_up_to, nearly) = mode.linear_up_to(range.log10_start)?;
    mode.set_mode(start.data(model, range, linear_up_to)?);
    let onset = Onset { linear_up_to, nearly };
    let (course, settings) = course(solver, range, settings, onset);
    let mut tracer = BranchTracer::new(course, solver.tolerance, interrupt);
    let outcome = trace(&mut mode, &mut tracer, (settings, onset), hooks, interrupt)
        .map_err(|e| if linear.rest.is_loaded() { about_static(e) } else { e });
    if let Some(factor) = required(solver, &*mode) {
        return Ok(Err(factor));
    }
    let ending = Ending::of(outcome, mode.branch())?;
    mode.finish(model, solver, &ending, tracer.estimates()).map(Ok)
}

/// The error of a mode about a loaded static state.
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

/// Selects the degree of freedom of the phase and scales the linear mode to amplitude 1.
fn gauge(model: &Model, range: &ModeOptions<'_>, linear: &mut LinearMode) -> Result<Gauge> {
    let shape = &mut linear.shape;
    let mut most = 0;
    for (dof, z) in shape.iter().enumerate() {
        // Among degrees of freedom that move alike, up to round-off, the first is selected.
        if z.norm() > (1.0 + 1e-9) * shape[most].norm() {
            most = dof;
        }
    }
    let largest = shape[most].norm();
    let degrees = model.structure().degrees();
    let reference_dof = match range.reference_dof {
        None => most,
        Some(dof) => match degrees.number(dof) {
            Some(number) => number,
            None if degrees.is_fixed(dof) => return fail!(Argument, "reference_dof = {dof} is fixed: it has no phase"),
            None => {
                return fail!(
                    Argument,
                    "reference_dof = {dof} lies on the right face: name its image on the left one"
                );
            }
        },
    };
    if shape[reference_dof].norm() <= NODE * largest {
        return fail!(
            Argument,
            "reference_dof = {} is a node of the mode: it moves {} where dof {} moves {largest}",
            degrees.origin(reference_dof),
            shape[reference_dof].norm(),
            degrees.origin(most)
        );
    }
    let contact = match range.amplitude {
        Amplitude::Modal => None,
        Amplitude::Contact(id) => {
            let contact = &model.contacts()[id];
            let row = model.structure().contact_row(contact, 0, 1);
            let motion = along(&row, shape).norm();
            if motion <= NODE * largest {
                return fail!(
                    Argument,
                    "amplitude_contact = {id}: the mode does not move this contact: relative motion {motion} of {largest}"
                );
            }
            for z in shape.iter_mut() {
                *z /= motion;
            }
            Some(row)
        }
    };
    Ok(Gauge { contact, reference_dof })
}

/// log₁₀ of the amplitudes up to which the mode is linear, and up to which it nearly is.
#[derive(Clone, Copy)]
struct Onset {
    linear_up_to: f64,
    nearly: f64,
}

impl Onset {
    /// Amplitude just beyond the onset of slip.
    fn beyond(self) -> f64 {
        self.linear_up_to + BEYOND_ONSET.log10()
    }
}

/// The course of the nonlinear part of the branch, and the settings of its first point.
fn course<'a>(
    solver: &SolverOptions,
    range: &ModeOptions<'a>,
    settings: Settings,
    onset: Onset,
) -> (Course<'a>, Settings) {
    let (start, end) = (range.log10_start, range.log10_stop);
    let from = if start <= onset.linear_up_to {
        onset.beyond().min(end)
    } else {
        start
    };
    let settings = Settings {
        start: from,
        ..settings
    };
    let course = Course {
        settings: Settings {
            // The branch may come back to amplitudes below the onset, with slip.
            start: if from < end { start } else { from },
            ..settings
        },
        range: (start, end),
        at: range.at,
        max_points: solver.max_points,
        may_refine: may_refine(solver),
        before: None,
        starts_again: None,
        bands: None,
    };
    (course, settings)
}

fn trace(
    mode: &mut ModeDiscretised<'_>,
    tracer: &mut BranchTracer<'_>,
    (settings, onset): (Settings, Onset),
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Status> {
    let (start, end) = tracer.course().range;
    let max_points = tracer.course().max_points;
    let linear_up_to = onset.linear_up_to;
    let level = mode.resolution();
    if start <= linear_up_to {
        // Nothing but the fundamental vibrates there.
        if mode.levels().is_automatic() {
            mode.select(0)?;
        }
        if let Some(status) = linear_range(mode, tracer, linear_up_to.min(end), hooks, interrupt)? {
            return Ok(status);
        }
        requested_below(mode, tracer, (settings, level), linear_up_to, interrupt)?;
        if end <= linear_up_to {
            return Ok(Status::Ok);
        }
        if mode.branch().points() >= max_points {
            return Ok(Status::StoppedMaxPoints);
        }
    }
    mode.select(level)?;
    let corner = if linear_up_to.is_finite() {
        Some(mode.linear_point(linear_up_to)?)
    } else {
        None
    };
    let near = if corner.is_some() { onset.beyond() } else { onset.nearly };
    interrupt.phase(Phase::FirstPoint, 0.0)?;
    match first_nonlinear(mode.problem(), &settings, near, corner.as_ref(), max_points, interrupt) {
        Ok(first) => {
            hooks.log(LogLevel::Info, "first point with slip or a nonlinear force solved");
            tracer.trace(mode, first.point, hooks)
        }
        Err(e) => match corner {
            // The amplitude turns as soon as contacts slip: the path leads around the corner.
            Some(corner) if e.status == Status::NoConvergence && start <= linear_up_to => {
                hooks.log(LogLevel::Info, "the amplitude turns at the onset of slip");
                tracer.trace_from(mode, corner, hooks)
            }
            _ => Err(e),
        },
    }
}

/// Solutions at the requested amplitudes of the linear range, and of the gap between it and the first point beyond.
fn requested_below(
    mode: &mut ModeDiscretised<'_>,
    tracer: &mut BranchTracer<'_>,
    (settings, level): (Settings, usize),
    linear_up_to: f64,
    interrupt: &Interrupt<'_>,
) -> Result<()> {
    let requested = tracer.course().at;
    for (i, &p) in requested.iter().enumerate() {
        if p <= linear_up_to {
            let point = mode.linear_point(p)?;
            tracer.record_special(mode, SpecialKind::At(i), &point)?;
        } else if p < settings.start {
            mode.select(level)?;
            let at_it = Settings { start: p, ..settings };
            // The loop ends when the point requires no more harmonics.
            loop {
                let first = initial_point::solve(mode.problem(), &at_it, interrupt)?;
                if tracer.record_special(mode, SpecialKind::At(i), &first.point)? {
                    break;
                }
            }
        }
    }
    Ok(())
}

/// The point at `settings.start`, beyond the linear range. Newton's method from a linear mode far below may find
/// another mode, so the branch is followed from `near`, where the linear mode is a reliable initial guess: just
/// beyond the onset of slip, or where smooth laws are nearly linear.
fn first_nonlinear(
    problem: &mut dyn Problem,
    settings: &Settings,
    near: f64,
    onset: Option<&Point>,
    max_points: usize,
    interrupt: &Interrupt<'_>,
) -> Result<First> {
    if settings.start <= near || !near.is_finite() {
        return initial_point::solve(problem, settings, interrupt);
    }
    let at_near = Settings {
        start: near,
        end: settings.start,
        ..*settings
    };
    let first = match initial_point::solve(problem, &at_near, interrupt) {
        Ok(first) => first.point,
        // The amplitude turns as soon as contacts slip: the path leads around the corner.
        Err(e) => match onset {
            Some(onset) if e.status == Status::NoConvergence => onset.try_clone()?,
            _ => return Err(e),
        },
    };
    // The branch may come back to amplitudes below the onset.
    let path = Settings {
        start: near - BELOW_ONSET,
        ..at_near
    };
    let mut continuation = Continuation::new(path, first)?;
    for _ in 0..max_points {
        match continuation.advance(problem, interrupt)? {
            Advance::Accepted { point, last: true } => {
                return Ok(First {
                    point,
                    way: Way::Branch,
                });
            }
            Advance::Accepted { .. } => {}
            Advance::LeftAtStart { .. } | Advance::Stopped(_) => break,
        }
    }
    fail!(
        NoConvergence,
        "log10_start = {} was not reached from where the mode ceases to be linear, {near}; start below that, or raise max_newton or max_points",
        settings.start
    )
}

/// Records points from the start of the range to `end`, below which all contacts stick: no equation need be solved
/// there. They are as dense as the largest steps of the continuation.
fn linear_range(
    mode: &mut ModeDiscretised<'_>,
    tracer: &BranchTracer<'_>,
    end: f64,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Option<Status>> {
    let course = tracer.course();
    let (start, stop) = course.range;
    let spacing = course.settings.steps.largest() * (stop - start);
    let steps = ((end - start) / spacing).ceil().max(1.0);
    let count = if end > start { steps as usize + 1 } else { 1 };
    for k in 0..count {
        if mode.branch().points() >= course.max_points {
            return Ok(Some(Status::StoppedMaxPoints));
        }
        let p = if k + 1 == count && count > 1 {
            end
        } else {
            start + (end - start) * (k as f64 / steps)
        };
        let point = mode.linear_point(p)?;
        mode.record(&point)?;
        if tracer.report(mode, hooks, &point) {
            return Ok(Some(Status::StoppedByCaller));
        }
        interrupt.check()?;
    }
    Ok(None)
}
