//! Motion in time while the frequency of the forces changes at a constant rate, as in a run-up.
//!
//! The phase of harmonic 1 is φ(t) = ω_a t + ω′t²/2 from the periodic motion at ω_a on. The motion is integrated turn after
//! turn, each from event to event as a periodic one: exactly between events where the contacts are linear between them.

use crate::error::{Result, Status, fail, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::options::SweepOptions;
use crate::time_integration::event_loop::{EventLoop, Observers, State};
use crate::time_integration::initial_state::state_of;
use crate::time_integration::largest_motion::LargestMotion;
use crate::time_integration::shooting::{SteadySearch, check_shooting};
use crate::time_integration::unrolled_structure::System;
use num_complex::Complex64;
use std::f64::consts::TAU;

const CONTEXT: &str = "a sweep in time";

/// Data of one turn of the forces in a sweep.
#[derive(Clone, Copy, Debug)]
pub struct SweepTurn {
    /// Time at the beginning of the turn.
    pub time: f64,
    /// Angular frequency of the forces at the beginning of the turn.
    pub omega: f64,
    /// Largest displacement within the turn.
    pub amplitude: f64,
}

/// Displacement over a sweep of the frequency.
#[derive(Clone, Debug)]
pub struct FrequencySweep {
    /// Status: `Ok`, or `StoppedByCaller` with the turns so far.
    pub status: Status,
    /// Turns of the forces, one after the other.
    pub turns: Vec<SweepTurn>,
    /// Largest displacement of the sweep.
    pub largest: f64,
    /// Angular frequency of the forces at the largest displacement.
    pub largest_omega: f64,
    /// Time of the largest displacement, from the beginning of the sweep.
    pub largest_time: f64,
    /// Number of changes of contacts between their states.
    pub events: usize,
    /// Place of each slider that has not moved in both directions between the periodic motion at the first frequency
    /// and the turn of the largest displacement, so that it depends on the search for that motion; `None` for the
    /// others.
    pub(crate) held: Vec<Option<f64>>,
    /// Contact and place of each slider that does not move in both directions in the periodic motion at the first
    /// frequency; `None` for the others.
    pub(crate) resting: Vec<Option<(usize, f64)>>,
}

/// Carries out [`crate::analysis::sweep`], with options that have been checked.
///
/// # Errors
/// As [`crate::analysis::sweep`].
pub fn run_through(model: &Model, options: &SweepOptions<'_>, hooks: &mut Hooks<'_>) -> Result<FrequencySweep> {
    let structure = model.structure();
    if structure.sectors() > 1 {
        return fail!(
            Unsupported,
            "a sweep in time needs a plain model; a wheel makes one of a cyclic model"
        );
    }
    if model.excitation().has_unbalance() || matches!(model.speed(), Speed::PerOmega(_)) {
        return fail!(
            Unsupported,
            "an unbalance or a speed follows the frequency, which changes"
        );
    }
    check_shooting(structure.ndof())?;
    let interrupt = hooks.interrupt();
    let mut system = System::new(model, options.omega_start, &interrupt)?;
    let mut event_loop = EventLoop::new(&system, options.tolerance)?;
    let start = match options.start {
        Some(harmonics) => state_of(model, &system, harmonics)?,
        None => State::rest(&system)?,
    };
    let first = options.first();
    let mut found = FrequencySweep {
        status: Status::Ok,
        turns: Vec::new(),
        largest: 0.0,
        largest_omega: options.omega_start,
        largest_time: 0.0,
        events: 0,
        held: try_vec(system.elements.len(), None, CONTEXT)?,
        resting: try_vec(system.elements.len(), None, CONTEXT)?,
    };
    let mut quiet = hooks.quiet();
    let steady = SteadySearch::new(&mut system, &mut event_loop, &first, &mut quiet, start)?.run()?;
    if steady.status != Status::Ok {
        found.status = steady.status;
        return Ok(found);
    }
    hooks.log(LogLevel::Info, "the periodic motion at the first frequency is found");
    let period = TAU / options.omega_start;
    find_resting(&mut system, &mut event_loop, &steady.state, period, &mut found.resting)?;
    event_loop.clear_moved();
    let mut observed = Vec::new();
    for term in system.degrees.image(options.dof).1 {
        try_push(&mut observed, term, CONTEXT)?;
    }
    let mut walk = SweepWalk {
        bases: Vec::new(),
        down: options.omega_stop < options.omega_start,
        options,
        observed: &observed,
        state: steady.state,
    };
    for load in &system.loads {
        try_push(&mut walk.bases, load.value, CONTEXT)?;
    }
    match walk.run(&mut system, &mut event_loop, &mut found, hooks) {
        Err(e) if e.status == Status::StoppedByCaller => found.status = e.status,
        outcome => outcome?,
    }
    Ok(found)
}

/// Finds the sliders that do not move in both directions in a periodic motion, by one period of it.
fn find_resting(
    system: &mut System<'_>,
    event_loop: &mut EventLoop,
    steady: &State,
    period: f64,
    resting: &mut [Option<(usize, f64)>],
) -> Result<()> {
    if system.elements.iter().all(|element| element.slider().is_none()) {
        return Ok(());
    }
    let mut state = steady.try_clone()?;
    event_loop.clear_moved();
    event_loop.run_for(system, &mut state, period, Observers::default())?;
    for (i, (place, element)) in resting.iter_mut().zip(&system.elements).enumerate() {
        let rests = element.slider().is_some() && event_loop.directions[i] != [true; 2];
        *place = rests.then(|| (element.family, element.relative(&state.x)[0] - state.e[i]));
    }
    Ok(())
}

struct SweepWalk<'a> {
    /// Complex values of the loads at phase 0.
    bases: Vec<Complex64>,
    down: bool,
    options: &'a SweepOptions<'a>,
    /// Terms of the observed degree of freedom in the independent ones.
    observed: &'a [(usize, f64)],
    state: State,
}

impl SweepWalk<'_> {
    fn run(
        &mut self,
        system: &mut System<'_>,
        event_loop: &mut EventLoop,
        found: &mut FrequencySweep,
        hooks: &mut Hooks<'_>,
    ) -> Result<()> {
        let options = self.options;
        let rate = if self.down { -options.rate } else { options.rate };
        let whole = (options.omega_stop - options.omega_start) / rate;
        let mut time = 0.0;
        while time < whole {
            let omega = options.omega_start + rate * time;
            // The phase of the exact time, not a sum of turns.
            let phase = time * (options.omega_start + 0.5 * rate * time);
            system.omega = omega;
            system.omega_rate = rate;
            for (load, base) in system.loads.iter_mut().zip(&self.bases) {
                load.value = base * Complex64::cis((load.harmonic as f64 * phase) % TAU);
            }
            // ωT + ω′T²/2 = 2π; the last turn of a run-down may have no end.
            let root = (omega * omega + 2.0 * rate * TAU).max(0.0).sqrt();
            let turn = 2.0 * TAU / (omega + root);
            let is_last = turn >= whole - time;
            let length = if is_last { whole - time } else { turn };
            let mut largest = LargestMotion::new(self.observed);
            let observers = Observers {
                largest: Some(&mut largest),
                ..Observers::default()
            };
            let summary = event_loop.run_for(system, &mut self.state, length, observers)?;
            found.events += summary.events;
            let turn = SweepTurn {
                time,
                omega,
                amplitude: largest.size,
            };
            try_push(&mut found.turns, turn, CONTEXT)?;
            if largest.size > found.largest {
                found.largest = largest.size;
                found.largest_time = time + largest.time;
                found.largest_omega = omega + rate * largest.time;
                for (i, (place, element)) in found.held.iter_mut().zip(&system.elements).enumerate() {
                    let rests = element.slider().is_some() && event_loop.directions[i] != [true; 2];
                    *place = rests.then(|| element.relative(&self.state.x)[0] - self.state.e[i]);
                }
            }
            let progress = Progress {
                point: found.turns.len(),
                parameter: omega,
                amplitude: largest.size,
                fraction_done: (time / whole).min(1.0),
                ..Progress::default()
            };
            if hooks.report(&progress) {
                return fail!(StoppedByCaller, "stopped by the caller at omega = {omega}");
            }
            time = if is_last { whole } else { time + length };
        }
        Ok(())
    }
}
