//! Section "Time" of the header: the motion while the frequency of the forces changes.

#![allow(non_camel_case_types)]

use crate::analysis;
use crate::capi::crossing::arrays::{Column, Entry, check_pointer, fill_list, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::indices::{index, number};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, check_reserved, fill_out, init, load};
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Error;
use crate::model::Model;
use crate::options::SweepOptions;
use core::ptr;
use num_complex::Complex64;

/// Options of hbvib_time_sweep. Fill it by hbvib_sweep_options_init, then set frequencies and rate.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_sweep_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Must be 0.
    pub reserved: i32,
    /// First angular frequency of harmonic 1, > 0, rad per time unit.
    pub omega_start: f64,
    /// Last one, > 0; below the first for a run-down.
    pub omega_stop: f64,
    /// Change of the angular frequency per time, > 0 in both senses.
    pub rate: f64,
    /// Degree of freedom whose displacement is observed; default 0.
    pub dof: i64,
    /// As of hbvib_time_options, for the first periodic motion and the steps of smooth laws.
    pub tolerance: f64,
    /// Cap on the periods that the first periodic motion takes.
    pub max_periods: i64,
    /// Motion to find the first periodic one from, complex (H + 1) x ndof, as in
    /// hbvib_time_options; or NULL: rest.
    pub start: *const f64,
    /// Complex numbers in start.
    pub start_len: i64,
}

unsafe impl VersionedStruct for hbvib_sweep_options {
    const NAME: &'static str = "hbvib_sweep_options";
    const FIRST_SIZE: usize = 72;

    fn defaults() -> Self {
        let defaults = SweepOptions::default();
        Self {
            struct_size: 0,
            reserved: 0,
            omega_start: defaults.omega_start,
            omega_stop: defaults.omega_stop,
            rate: defaults.rate,
            dof: 0,
            tolerance: defaults.tolerance,
            max_periods: defaults.max_periods as i64,
            start: ptr::null(),
            start_len: 0,
        }
    }
}

/// Fills the options of a sweep in time: degree of freedom 0, tolerance = 1e-11.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_sweep_options_init(o: *mut hbvib_sweep_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Numbers of a sweep in time. Fill it by hbvib_sweep_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_sweep_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Largest displacement of the sweep.
    pub largest: f64,
    /// Angular frequency at its time.
    pub largest_omega: f64,
    /// Its time, from the begin of the sweep.
    pub largest_time: f64,
    /// Changes between stick, slip, open and closed, or between the lines of a table, of all
    /// contacts.
    pub events: i64,
}

unsafe impl VersionedStruct for hbvib_sweep_info {
    const NAME: &'static str = "hbvib_sweep_info";
    const FIRST_SIZE: usize = 40;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            largest: 0.0,
            largest_omega: 0.0,
            largest_time: 0.0,
            events: 0,
        }
    }
}

/// Fills the numbers of a sweep in time with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_sweep_info_init(i: *mut hbvib_sweep_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// Integrates the motion in time while the frequency of the forces changes at a constant rate, as
/// in a run-up: the phase of harmonic 1 is omega_start t +- rate t^2 / 2, from the periodic motion
/// at omega_start on, at phase 0. Exact events as in hbvib_time_response, and its models, plain
/// ones alone.
///
/// model      a plain model; a wheel from hbvib_wheel_new is one.
/// options    frequencies, rate, observed degree of freedom.
/// hooks      progress, called after each turn with its frequency in `parameter`; log, phase and
///            cancellation. NULL: none.
/// capacity   turns of the phase by 2 pi that fit into each array.
/// time       receives the times at which turns begin, from 0; or NULL.
/// omega      receives the angular frequencies there; or NULL.
/// amplitude  receives the largest displacements within turns; or NULL.
/// count      receives the number of turns, also when `capacity` is too small; or NULL.
/// info       receives the largest displacement; fill it by hbvib_sweep_info_init before; or NULL.
/// HBVIB_STOPPED_BY_CALLER: the turns so far.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_INDEX (options), HBVIB_E_DIMENSION (start,
/// capacity: the arrays are untouched), HBVIB_E_UNSUPPORTED (a cyclic model, an unbalance, a speed
/// tied to the frequency, what hbvib_time_response refuses), HBVIB_E_NO_CONVERGENCE,
/// HBVIB_E_NO_BOUNDED_SOLUTION, HBVIB_E_CALLBACK, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_time_sweep(
    model: *const hbvib_model,
    options: *const hbvib_sweep_options,
    hooks: *const hbvib_hooks,
    capacity: i64,
    time: *mut f64,
    omega: *mut f64,
    amplitude: *mut f64,
    count: *mut i64,
    info: *mut hbvib_sweep_info,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let o = unsafe { load(options, 2) }?;
        check_reserved(o.reserved, 2, "hbvib_sweep_options")?;
        let start = if o.start.is_null() {
            None
        } else {
            let n = crate::capi::crossing::arrays::count(o.start_len, 2, "start_len")?;
            Some(unsafe { input(o.start.cast::<Complex64>(), n, 2, "start") }?)
        };
        let options = SweepOptions {
            omega_start: o.omega_start,
            omega_stop: o.omega_stop,
            rate: o.rate,
            dof: index(o.dof, model.ndof(), 2, "dof")?,
            tolerance: o.tolerance,
            max_periods: number(o.max_periods, "max_periods").with_argument(2)?,
            start,
        };
        options.check(model.ndof()).with_argument(2)?;
        let hooks = unsafe { load_hooks(hooks, 3) }?;
        if !info.is_null() {
            unsafe { check_out(info, 9) }?;
        }
        let mut unused = 0_i64;
        let count = if count.is_null() { &raw mut unused } else { count };
        check_pointer(count, 8, "count")?;
        let columns = [
            Column::Reals(time, 5, "time"),
            Column::Reals(omega, 6, "omega"),
            Column::Reals(amplitude, 7, "amplitude"),
        ];
        let found = unsafe { with_hooks(&hooks, |hooks| analysis::sweep(&model, &options, hooks)) }
            .map_err(|e: Error| if e.argument == 0 { e.in_argument(1) } else { e })?;
        let turns = found.turns.iter().map(|turn| {
            [
                Entry::Real(turn.time),
                Entry::Real(turn.omega),
                Entry::Real(turn.amplitude),
            ]
        });
        let wanted = [time, omega, amplitude].iter().any(|p| !p.is_null());
        let room = if wanted { capacity } else { found.turns.len() as i64 };
        unsafe { fill_list(&columns, turns, (room, 4), (count, 8)) }?;
        if !info.is_null() {
            let value = hbvib_sweep_info {
                largest: found.largest,
                largest_omega: found.largest_omega,
                largest_time: found.largest_time,
                events: found.events as i64,
                ..hbvib_sweep_info::defaults()
            };
            unsafe { fill_out(info, value) };
        }
        Ok(found.status)
    })
}
