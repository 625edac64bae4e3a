//! Section "Design studies" of the header: the peaks of all blades of a wheel.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Column, Entry, check_pointer, fill_list};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::branch_tree::insert_tree;
use crate::capi::crossing::handles::read;
use crate::capi::crossing::outcome::Outcome;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::solving::solve_responses::{Watched, hbvib_response};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Status;
use crate::model::Model;
use crate::options::{ForcedOptions, Response};
use crate::studies::{self, BladePeak};

/// Numbers of the peaks of a wheel. Fill it by hbvib_wheel_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_wheel_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Blade with the highest peak, from 0; -1 without any.
    pub blade: i64,
    /// That peak; NaN without one.
    pub largest: f64,
    /// Peak of the tuned wheel; NaN without one within the range.
    pub tuned: f64,
    /// Angular frequency of the peak of the tuned wheel.
    pub tuned_omega: f64,
    /// Amplification factor: largest over tuned; NaN where one of both lies beyond an end of the
    /// range.
    pub amplification: f64,
    /// Blades whose response is larger at an end of the range than at each of their peaks.
    pub beyond: i64,
    /// Largest response of a blade at an end of the range: above `largest`, the highest peak of the
    /// wheel lies beyond that end.
    pub end_amplitude: f64,
    /// Angular frequency of that end.
    pub end_omega: f64,
}

unsafe impl VersionedStruct for hbvib_wheel_info {
    const NAME: &'static str = "hbvib_wheel_info";
    const FIRST_SIZE: usize = 48;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            blade: 0,
            largest: 0.0,
            tuned: 0.0,
            tuned_omega: 0.0,
            amplification: 0.0,
            beyond: 0,
            end_amplitude: 0.0,
            end_omega: 0.0,
        }
    }
}

/// Fills the numbers of the peaks of a wheel with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_wheel_info_init(i: *mut hbvib_wheel_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// The highest peak of each blade of a wheel within a range of frequency, and the amplification
/// against the tuned wheel. All blades are watched in one response, so that a tolerance holds for
/// each of them; the tuned wheel is the wave of its sector.
///
/// wheel        made by hbvib_wheel_new of `cyclic`, mistuned or not.
/// cyclic       the model of the sector.
/// blade        response of a sector that is watched, in degrees of freedom of the sector; NULL:
///              the fundamental of the response degree of freedom of the solver.
/// solver       options, the response degree of freedom is one of the sector; NULL: the defaults.
/// omega_start  first angular frequency of the range, > 0.
/// omega_stop   last one.
/// hooks        progress, log, phase and cancellation; NULL: none.
/// capacity     numbers that fit into each array: at least the number of sectors.
/// amplitude    receives the peaks, NaN where a blade has none; or NULL.
/// omega        receives their angular frequencies, or NULL.
/// error        receives their estimated relative errors, NaN where no tolerance asked for them; or
///              NULL.
/// count        receives the number of sectors, also when `capacity` is too small.
/// info         receives the numbers of the largest one; fill it by hbvib_wheel_info_init before;
///              or NULL.
/// out          receives the response of the wheel, whose response s is that of blade s; or NULL.
/// HBVIB_STOPPED_NO_PEAK: the highest peak of the wheel, or of the tuned one, lies beyond an end of
/// the range, as a blade is larger there than at each peak within; everything is written, and the
/// amplification is NaN. Other positive statuses are those of hbvib_forced_response, of the
/// response of the wheel.
/// Errors: HBVIB_E_DIMENSION (the wheel of another model, capacity), HBVIB_E_INDEX (blade),
/// HBVIB_E_ARGUMENT (range; the wheel of another model), those of hbvib_forced_response. Threads:
/// any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_wheel_peaks(
    wheel: *const hbvib_model,
    cyclic: *const hbvib_model,
    blade: *const hbvib_response,
    solver: *const hbvib_solver_options,
    omega_start: f64,
    omega_stop: f64,
    hooks: *const hbvib_hooks,
    capacity: i64,
    amplitude: *mut f64,
    omega: *mut f64,
    error: *mut f64,
    count: *mut i64,
    info: *mut hbvib_wheel_info,
    out: *mut *mut hbvib_branch,
) -> hbvib_status {
    call(|| {
        let wheel = read::<Model>(wheel, 1)?;
        let cyclic = read::<Model>(cyclic, 2)?;
        let watched = unsafe { Watched::new(blade, i64::from(!blade.is_null()), cyclic.ndof(), 3) }?;
        let responses = unsafe { watched.responses(3) }.with_argument(3)?;
        let blade = responses.first().copied().unwrap_or_else(Response::default);
        let solver = unsafe { solver_options(solver, cyclic.ndof()) }?;
        let options = ForcedOptions {
            omega_start,
            omega_stop,
            ..ForcedOptions::default()
        };
        check_pointer(count, 12, "count")?;
        options.check().with_argument(5)?;
        let hooks = unsafe { load_hooks(hooks, 7) }?;
        if !info.is_null() {
            unsafe { check_out(info, 13) }?;
        }
        if !out.is_null() {
            check_pointer(out, 14, "out")?;
        }
        let columns = [
            Column::Reals(amplitude, 9, "amplitude"),
            Column::Reals(omega, 10, "omega"),
            Column::Reals(error, 11, "error"),
        ];
        // A capacity that is too small is refused before the solve.
        let sectors = cyclic.structure().sectors();
        let nothing = [Entry::Real(f64::NAN); 3];
        if capacity < sectors as i64 {
            unsafe { fill_list(&columns, (0..sectors).map(|_| nothing), (capacity, 8), (count, 12)) }?;
        }
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                studies::wheel_peaks(&wheel, &cyclic, &blade, &solver, &options, hooks)
            })
        }?;
        let mut outcome = Outcome::from(&found.branch);
        if outcome.status == Status::Ok
            && let Some(outside) = found.outside()
        {
            outcome = Outcome {
                status: outside.status,
                reason: Some(outside),
            };
        }
        let row = |one: &BladePeak| {
            [
                Entry::Real(one.amplitude),
                Entry::Real(one.omega),
                Entry::Real(one.error),
            ]
        };
        unsafe { fill_list(&columns, found.blades.iter().map(row), (capacity, 8), (count, 12)) }?;
        if !info.is_null() {
            let end = (found.blades.iter()).fold((f64::NAN, f64::NAN), |most, blade| {
                if blade.end.0 <= most.0 { most } else { blade.end }
            });
            let value = hbvib_wheel_info {
                blade: found.largest.map_or(-1, |blade| blade as i64),
                largest: found.largest.map_or(f64::NAN, |blade| found.blades[blade].amplitude),
                tuned: found.tuned.amplitude,
                tuned_omega: found.tuned.omega,
                amplification: found.amplification(),
                beyond: found.blades.iter().filter(|blade| blade.is_beyond()).count() as i64,
                end_amplitude: end.0,
                end_omega: end.1,
                ..hbvib_wheel_info::defaults()
            };
            unsafe { fill_out(info, value) };
        }
        if !out.is_null() {
            unsafe { out.write(insert_tree(found.branch, 0, false)?) };
        }
        Ok(outcome)
    })
}
