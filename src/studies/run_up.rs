//! A run-up through a resonance by the slow flow of a nonlinear mode, with the memory of sliders.
//!
//! The amplitude of the mode follows an oscillator whose frequency and damping depend on it. Contacts with sliders remember amplitudes
//! before, which is an effect of the first order in the rate: it is found by passing the motion of the slow flow through the laws, and
//! the slow flow is solved again with it, until it repeats. The turns around the largest displacement are then integrated in time.

mod chirp;
mod integrated;
pub(crate) mod mode_table;
pub(crate) mod other_modes;
mod slider_memory;
pub(crate) mod slow_flow;
mod slow_path;
mod steady_motion;

use crate::analysis::synthesis::{Load, SynthesisPeak, load_of, synthesise_with};
use crate::error::{Result, fail};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::options::{RunUpOptions, SynthesisOptions};
use crate::results::Branch;
use crate::studies::run_up::chirp::Chirp;
use crate::studies::run_up::integrated::integrate;
use crate::studies::run_up::mode_table::{ModeTable, Place};
use crate::studies::run_up::other_modes::OtherModes;
use crate::studies::run_up::slider_memory::{Defect, SliderMemory};
pub use crate::studies::run_up::slow_flow::RunUpTurn;
use crate::studies::run_up::slow_flow::SlowFlow;
use crate::studies::run_up::slow_path::SlowPath;
use crate::studies::run_up::steady_motion::largest_steady;
use crate::time_integration::System;
use std::f64::consts::TAU;

/// Most solutions of the slow flow with the memory of the one before.
/// Kind: cap.
const RUN_UP_MOST_REPEATS: usize = 8;

/// Change of the largest displacement, relative, at which the memory is known.
/// Kind: cap; below what the slow flow alone errs by, 2e-5 and more
/// on the oscillator of the stored runs.
const RUN_UP_REPEATED: f64 = 1e-5;

/// Phase over which the memory is averaged, two turns: the change of the amplitude in it is the share of the second order.
/// Kind: tuned; measured on: six
/// models, of three of which it bounds all errors: it decides about the estimate without integration alone.
const RUN_UP_AVERAGED: f64 = 2.0 * TAU;

/// A run-up by the slow flow.
#[derive(Clone, Debug)]
pub struct RunUp {
    /// Turns of the forces, one after the other.
    pub turns: Vec<RunUpTurn>,
    /// Largest displacement of the run-up.
    pub largest: f64,
    /// Angular frequency of the forces at that time.
    pub largest_omega: f64,
    /// Time of the largest displacement, from the beginning of the run-up.
    pub largest_time: f64,
    /// Relative error of the largest displacement: its change over three leads of the integration in time. Without
    /// integration it is an estimate that may be too small; NaN where the mode has no resonance under these forces to
    /// compare with.
    pub error: f64,
    /// The largest displacement by the slow flow alone.
    pub slow_flow: f64,
    /// Number of turns that were integrated in time: all turns of the run-up, some, or 0.
    pub integrated: usize,
    /// The largest displacement by the slow flow alone without the memory of sliders, under the work of the forces on the
    /// nonlinear mode; that of a mission with all harmonics and the other modes.
    pub without_memory: f64,
    /// Largest displacement of the highest steady resonance within the mode, measured as `largest`, with the mean and
    /// all harmonics; NaN without a resonance.
    pub steady: f64,
}

impl RunUp {
    /// Ratio of the largest displacement to that of the steady resonance. Both include the displacement by constant
    /// forces.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.largest / self.steady
    }
}

/// Follows the amplitude of a plain model while the frequency of its forces changes at a constant rate. It starts
/// from the steady motion at the first frequency, and uses the slow flow of the model's nonlinear mode.
///
/// # Errors
/// Those of [`RunUpOptions::check`] and of [`synthesise`](crate::synthesise); `Unsupported` for a cyclic model, an unbalance or a
/// speed that
/// follows the frequency, and laws that are not integrated in time; `Argument` where the amplitude leaves those of the mode;
/// `StoppedByCaller`.
pub fn run_up(branch: &Branch, model: &Model, options: &RunUpOptions, interrupt: &Interrupt<'_>) -> Result<RunUp> {
    options.check(model.ndof())?;
    let structure = model.structure();
    if structure.sectors() > 1 {
        return fail!(
            Unsupported,
            "a run-up needs a plain model; a wheel makes one of a cyclic model"
        );
    }
    if model.excitation().has_unbalance() || matches!(model.speed(), Speed::PerOmega(_)) {
        return fail!(
            Unsupported,
            "an unbalance or a speed follows the frequency, which changes"
        );
    }
    let (load, highest) = loaded(branch, model, &options.synthesis, interrupt)?;
    let system = System::unforced(model, options.omega_start, interrupt)?;
    let dof = options.dof.unwrap_or_else(|| branch.response_dof());
    let number = branch.mode_data().map_or(0, |data| data.info.index);
    let watched = (dof, &system.elements[..]);
    let others = OtherModes::new(model, &load, number, watched, interrupt)?;
    let table = ModeTable::new(branch, model, (&load, &others), watched, interrupt)?;
    let chirp = Chirp::new(options.omega_start, options.omega_stop, options.rate);
    let flow = SlowFlow {
        table: &table,
        others: &others,
        chirp: &chirp,
        interrupt,
    };
    // The solution of the first order, then that with q″, then that with the memory.
    let mut memory = SliderMemory::new(&table, &others, &system.elements)?;
    let mut defect = Defect::default();
    let (mut path, mut seen) = flow.run(&defect, &SlowPath::default())?;
    let mut change = 0.0;
    let (mut without_memory, mut simple) = (seen.largest, SlowPath::default());
    for repeat in 0..RUN_UP_MOST_REPEATS {
        if repeat > 1 && !memory.is_empty() {
            defect = memory.along(&path, &chirp, interrupt)?;
        }
        let before = seen.largest;
        (path, seen) = flow.run(&defect, &path)?;
        change = (seen.largest - before).abs();
        if repeat == 1 {
            simple = path.try_clone()?;
        }
        if repeat < 2 {
            without_memory = seen.largest;
        } else if change <= RUN_UP_REPEATED * seen.largest {
            break;
        }
    }
    if !others.is_empty() {
        // The force along the linear shape is whole only together with the defect, which has contact forces by the other modes beside the
        // memory.
        without_memory = by_the_whole_mode(&flow)?;
    }
    let steady = match &highest {
        Some(peak) => largest_steady(&table, &others, &peak.at)?,
        None => f64::NAN,
    };
    let of_steady = highest
        .as_ref()
        .map_or(f64::NAN, |peak| peak.validity.error.abs() * steady);
    // The change by the memory in the last time that the flow remembers, phase and amplitude, and how quickly the amplitude changes in it.
    let mut place = Place::default();
    let amplitude = path.at(seen.largest_time).norm();
    table.find(amplitude, &mut place)?;
    let decay = table.oscillator(&place).decay().abs();
    let last = (
        seen.largest_time - 1.0 / decay.max(f64::MIN_POSITIVE),
        seen.largest_time,
    );
    let growth = path.growth(last, |time| chirp.omega(time));
    let of_memory = path.distance(&simple, last) / amplitude.max(f64::MIN_POSITIVE) * seen.largest;
    let slow_flow = seen.largest;
    let mut found = RunUp {
        largest_omega: chirp.omega(seen.largest_time),
        largest: slow_flow,
        largest_time: seen.largest_time,
        error: (change + of_steady + seen.beside + of_memory * (RUN_UP_AVERAGED * growth).min(1.0)) / slow_flow,
        slow_flow,
        integrated: 0,
        without_memory,
        steady,
        turns: Vec::new(),
    };
    let cost = (system.operations(), interrupt);
    if let Some(part) = integrate(model, (&table, &mut seen), (options, &chirp, dof), cost)? {
        found.largest = part.largest;
        found.largest_time = part.largest_time;
        found.largest_omega = part.largest_omega;
        found.error = if part.turns > 0 {
            part.error
        } else {
            part.error.max(found.error)
        };
        found.integrated = part.turns;
    }
    found.turns = seen.turns;
    Ok(found)
}

/// Largest displacement of the slow flow under the work of the forces on the whole nonlinear mode, without defect: the solution of the
/// first order, then twice that with q″.
///
/// # Errors
/// Those of [`SlowFlow::run`].
fn by_the_whole_mode(flow: &SlowFlow<'_>) -> Result<f64> {
    let table = flow.table.under_whole_force()?;
    let flow = SlowFlow { table: &table, ..*flow };
    let mut path = SlowPath::default();
    let mut largest = 0.0;
    for _ in 0..3 {
        let (next, seen) = flow.run(&Defect::default(), &path)?;
        (path, largest) = (next, seen.largest);
    }
    Ok(largest)
}

/// Forces and damping on a mode, and its highest steady resonance under them, compared with the computed one; `None`
/// in its place without a resonance.
///
/// # Errors
/// Those of [`synthesise`](crate::synthesise); `Argument` for a mode without points.
pub(crate) fn loaded(
    branch: &Branch,
    model: &Model,
    options: &SynthesisOptions,
    interrupt: &Interrupt<'_>,
) -> Result<(Load, Option<SynthesisPeak>)> {
    let Some(load) = load_of(branch, model, options)? else {
        return fail!(Argument, "the mode has no points");
    };
    let compared = SynthesisOptions {
        compare: true,
        ..*options
    };
    let peaks = synthesise_with(branch, model, &compared, interrupt)?.peaks;
    let highest = peaks
        .into_iter()
        .max_by(|a, b| a.at.response.norm().total_cmp(&b.at.response.norm()));
    Ok((load, highest))
}
