//! A reference solution in time: a periodic response by integration from event to event, without a harmonic
//! series.
//!
//! `unrolled_structure` holds the structure with as many sectors as a travelling wave needs, `event_law` its
//! contacts, whose events come from their laws, `smooth_laws` the evaluation of laws without events;
//! `linear_step` makes exact steps where all laws are linear between events, `implicit_step` adaptive ones where
//! a law is smooth; `step_polynomial` locates events within a step; `event_loop` runs from event to event
//! through a lapse; `shooting` closes the period; `harmonic_analysis` turns the motion into harmonics, free of
//! the truncation of harmonic balance; `initial_state` is the state of a motion given by its harmonics.

use crate::error::{Result, Status, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{SteadyMethod, TimeOptions};
use crate::time_integration::event_loop::{EventLoop, Observers, State};
use crate::time_integration::harmonic_analysis::HarmonicAnalysis;
use crate::time_integration::initial_state::state_of;
use crate::time_integration::shooting::{SteadySearch, check_shooting};
use crate::time_integration::unrolled_structure::System;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// A periodic response found by integration in time.
#[derive(Clone, Debug)]
pub struct TimeResponse {
    /// Status: `Ok`, or `StoppedByCaller`. In the latter case harmonics and samples belong to a period that is not
    /// steady; after a stop by the cancel flag no period is integrated, and they are NaN.
    pub status: Status,
    /// Period T = 2π/ω.
    pub period: f64,
    /// Largest change of a displacement, velocity or slider over one period, relative to the largest displacement or
    /// velocity. In a travelling wave the comparison is made after the part of the period after which another sector
    /// has the same motion. Infinite if the caller stopped before.
    pub residual: f64,
    /// Number of periods that were integrated, rounded up.
    pub periods: usize,
    /// Whether periods were marched: with shooting, if Newton's method did not converge from the start. Marching
    /// leaves an unstable solution.
    pub marched: bool,
    /// Changes of a contact between stick, slip, open and closed, or between the lines of a table, in one
    /// period, all contacts of one sector together.
    pub events: usize,
    /// Number of degrees of freedom of one sector.
    pub ndof: usize,
    /// Harmonic coefficients 0 ..= H of every degree of freedom (of sector 1), harmonic by harmonic, computed from
    /// the motion itself.
    pub harmonics: Vec<Complex64>,
    /// Displacements at equidistant times from 0 on, time by time.
    pub samples: Vec<f64>,
    /// Places of the slider along t1 of each contact (of sector 1) at the end, for [`Model::set_slider`]; 0 for contacts
    /// without slider. NaN if the caller stopped before.
    pub places: Vec<f64>,
}

/// Integrates the response of a model to its forces until it is periodic.
///
/// # Errors
/// `Unsupported` for degrees of freedom without mass, complex matrices and friction in a plane, `NoConvergence` if no
/// steady state was found, `NoBoundedSolution` if the motion grows without bound, `OutOfMemory`.
pub fn solve(model: &Model, options: &TimeOptions<'_>, hooks: &mut Hooks<'_>) -> Result<TimeResponse> {
    solve_disturbed(model, options, 0.0, hooks)
}

/// Integrates the response as `solve` does, from a start that is disturbed by a share of its size, so that marching
/// leaves an unstable motion even where the start has its symmetry.
///
/// # Errors
/// As [`solve`].
pub(crate) fn solve_disturbed(
    model: &Model,
    options: &TimeOptions<'_>,
    disturbance: f64,
    hooks: &mut Hooks<'_>,
) -> Result<TimeResponse> {
    let interrupt = hooks.interrupt();
    match integrate(model, options, disturbance, hooks, &interrupt) {
        Err(e) if e.status == Status::StoppedByCaller => TimeResponse::stopped(model, options),
        outcome => outcome,
    }
}

impl TimeResponse {
    /// The response of a run that was stopped before a period was recorded: its harmonics and samples are NaN.
    pub(crate) fn stopped(model: &Model, options: &TimeOptions<'_>) -> Result<Self> {
        let ndof = model.ndof();
        let nothing = Complex64::new(f64::NAN, f64::NAN);
        Ok(Self {
            status: Status::StoppedByCaller,
            period: TAU / options.omega,
            residual: f64::INFINITY,
            periods: 0,
            marched: false,
            events: 0,
            ndof,
            harmonics: try_vec((options.harmonics + 1).saturating_mul(ndof), nothing, "the harmonics")?,
            samples: try_vec(options.samples.saturating_mul(ndof), f64::NAN, "the samples")?,
            places: try_vec(model.contacts().len(), f64::NAN, "the places of sliders")?,
        })
    }
}

fn integrate(
    model: &Model,
    options: &TimeOptions<'_>,
    disturbance: f64,
    hooks: &mut Hooks<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<TimeResponse> {
    if options.method == SteadyMethod::Shooting {
        let structure = model.structure();
        check_shooting(structure.ndof() * structure.repeating_sectors())?;
    }
    let mut system = System::new(model, options.omega, interrupt)?;
    let mut event_loop = EventLoop::new(&system, options.tolerance)?;
    let mut start = match options.start {
        Some(harmonics) => state_of(model, &system, harmonics)?,
        None => State::rest(&system)?,
    };
    if disturbance > 0.0 {
        start.disturb(disturbance, options.omega);
    }
    hooks.log(LogLevel::Info, "the structure in time is set up");
    let mut steady = SteadySearch::new(&mut system, &mut event_loop, options, hooks, start)?.run()?;
    let mut recorder = HarmonicAnalysis::new(&system, options.harmonics, options.samples)?;
    let observers = Observers {
        recorder: Some(&mut recorder),
        ..Observers::default()
    };
    let recorded = event_loop.run(&mut system, &mut steady.state, observers);
    let summary = match recorded {
        Ok(summary) => summary,
        // A part of a period has no harmonics; its samples are not kept beside those of the answer.
        Err(e) if e.status == Status::StoppedByCaller => {
            drop(recorder);
            return Ok(TimeResponse {
                residual: steady.residual,
                periods: steady.periods,
                marched: steady.marched,
                ..TimeResponse::stopped(model, options)?
            });
        }
        Err(e) => return Err(e),
    };
    let mut places = try_vec(model.contacts().len(), 0.0, "the places of sliders")?;
    for (element, stretch) in system.elements.iter().zip(&steady.state.e) {
        if element.sector == 0 && element.slider().is_some() {
            places[element.family] = element.relative(&steady.state.x)[0] - stretch;
        }
    }
    let (harmonics, samples) = recorder.finish_all(&system, model)?;
    Ok(TimeResponse {
        status: steady.status,
        period: TAU / options.omega,
        residual: steady.residual,
        periods: steady.periods,
        marched: steady.marched,
        // In a lapse all sectors together move as one of them does in a period.
        events: summary.events,
        ndof: model.ndof(),
        harmonics,
        samples,
        places,
    })
}
