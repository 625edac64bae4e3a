//! Section "Time" of the header: periodic responses by integration in time.

#![allow(non_camel_case_types)]

use crate::analysis;
use crate::capi::crossing::arrays::{Range, check_pointer, disjoint, exact_len, input, optional_len, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::indices::number;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init, load};
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail};
use crate::model::Model;
use crate::options::{SteadyMethod, TimeOptions};
use core::ptr;
use num_complex::Complex64;

/// Ways of finding a steady state in time.
#[repr(C)]
pub enum hbvib_steady_method {
    /// Newton's method on the map over a period, with marching where it fails. Where several
    /// solutions coexist it may find an unstable one.
    HBVIB_SHOOTING = 0,
    /// Period after period until the motion repeats.
    HBVIB_MARCHING = 1,
}

/// Options of hbvib_time_response. Fill it by hbvib_time_options_init, then set omega.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_time_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_SHOOTING or HBVIB_MARCHING.
    pub method: i32,
    /// Angular frequency of harmonic 1, > 0, rad per time unit.
    pub omega: f64,
    /// Highest harmonic of the results; it has no effect on the accuracy of the others.
    pub harmonics: i64,
    /// Equidistant times per period at which the motion is returned; 0: none.
    pub samples: i64,
    /// Largest change over a period, relative to the largest displacement and velocity, of a steady
    /// state; also the local error of a step where a law is smooth (HBVIB_CUBIC).
    pub tolerance: f64,
    /// Cap on the periods that are integrated.
    pub max_periods: i64,
    /// Motion to start from, complex (H + 1) x ndof of any H, harmonic after harmonic, such as a
    /// point of a branch; or NULL: rest.
    pub start: *const f64,
    /// Complex numbers in start.
    pub start_len: i64,
    /// Receives the place of the slider along t1 of each contact at the end, the residual state for
    /// hbvib_model_set_slider, 0 for contacts without slider; or NULL.
    pub places: *mut f64,
    /// Doubles in places: the number of contacts; 0 with NULL.
    pub places_len: i64,
}

unsafe impl VersionedStruct for hbvib_time_options {
    const NAME: &'static str = "hbvib_time_options";
    const FIRST_SIZE: usize = 64;

    fn defaults() -> Self {
        let defaults = TimeOptions::default();
        Self {
            struct_size: 0,
            method: hbvib_steady_method::HBVIB_SHOOTING as i32,
            omega: defaults.omega,
            harmonics: defaults.harmonics as i64,
            samples: defaults.samples as i64,
            tolerance: defaults.tolerance,
            max_periods: defaults.max_periods as i64,
            start: ptr::null(),
            start_len: 0,
            places: ptr::null_mut(),
            places_len: 0,
        }
    }
}

/// Fills the options of a response in time with their defaults: shooting from rest, harmonics = 9,
/// tolerance = 1e-11; omega must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_time_options_init(o: *mut hbvib_time_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Numbers of a periodic response in time. Fill it by hbvib_time_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_time_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// 2 pi / omega.
    pub period: f64,
    /// Largest change over a period, relative to the largest displacement and velocity; infinite
    /// where the caller stopped before the end of the first period.
    pub residual: f64,
    /// Number of periods that were integrated.
    pub periods: i64,
    /// Number of changes between stick, slip, open and closed, or between the lines of a table, in
    /// one period, all contacts of the model (of one sector) together.
    pub events: i64,
}

unsafe impl VersionedStruct for hbvib_time_info {
    const NAME: &'static str = "hbvib_time_info";
    const FIRST_SIZE: usize = 40;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            period: 0.0,
            residual: 0.0,
            periods: 0,
            events: 0,
        }
    }
}

/// Fills the numbers of a response in time with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_time_info_init(i: *mut hbvib_time_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// Finds the periodic response of a model to its forces at one angular frequency by integration in
/// time from event to event: exact to rounding where contacts are linear between events, by
/// adaptive implicit steps where a law is smooth. Nothing is truncated: harmonic balance tends to
/// this response as the number of its harmonics grows, so that it checks any point of a branch. A
/// cyclic model moves in the wave of its engine order. The progress hook is called after each
/// integrated period (in a wave after each part of it), with the largest displacement as amplitude.
/// A force callback is called for one time at once: samples is 1.
///
/// options        set omega; a point of a branch as start checks this solution.
/// hooks          progress, log and cancellation; NULL: none.
/// harmonics      receives (harmonics + 1) x ndof complex numbers, harmonic after harmonic; or
///                NULL.
/// harmonics_len  complex numbers in it; 0 with NULL.
/// samples        receives samples x ndof displacements, time after time from t = 0; or NULL.
/// samples_len    doubles in it; 0 with NULL.
/// info           receives numbers of the response; fill it by hbvib_time_info_init before; or
///                NULL.
/// HBVIB_STOPPED_BY_CALLER: the results are those of the last period, which is not steady.
/// Errors: HBVIB_E_ARGUMENT and HBVIB_E_NOT_FINITE (options, overlapping arrays), HBVIB_E_DIMENSION
/// (a length, with the one needed), HBVIB_E_UNSUPPORTED (a degree of freedom without mass, complex
/// matrices, HBVIB_FRICTION_3D, a force of the caller with states), HBVIB_E_NO_CONVERGENCE (no
/// steady state found), HBVIB_E_NO_BOUNDED_SOLUTION (the motion grows without bound),
/// HBVIB_E_CALLBACK (a force callback failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_time_response(
    model: *const hbvib_model,
    options: *const hbvib_time_options,
    hooks: *const hbvib_hooks,
    harmonics: *mut f64,
    harmonics_len: i64,
    samples: *mut f64,
    samples_len: i64,
    info: *mut hbvib_time_info,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let given = unsafe { load(options, 2) }?;
        let options = unsafe { time_options(&given, model.ndof()) }.with_argument(2)?;
        let contacts = model.contacts().len();
        let places_len = if given.places.is_null() && given.places_len == 0 {
            0
        } else {
            check_pointer(given.places, 2, "places")?;
            exact_len(given.places_len, contacts, 2, "the number of contacts")?
        };
        let hooks = unsafe { load_hooks(hooks, 3) }?;
        let coefficients = (options.harmonics + 1).saturating_mul(model.ndof());
        let harmonics_len = optional_len(harmonics, harmonics_len, coefficients, 4, "(harmonics + 1) * ndof")?;
        let displacements = options.samples.saturating_mul(model.ndof());
        let samples_len = optional_len(samples, samples_len, displacements, 6, "samples * ndof")?;
        if !info.is_null() {
            unsafe { check_out(info, 8) }?;
        }
        let start = options.start.unwrap_or(&[]);
        disjoint(
            &[Range::new(start.as_ptr(), start.len(), 2, "start")?],
            &[
                Range::new::<Complex64>(harmonics.cast(), harmonics_len, 4, "harmonics")?,
                Range::new(samples, samples_len, 6, "samples")?,
                Range::new(given.places, places_len, 2, "places")?,
            ],
        )?;
        let found = unsafe { with_hooks(&hooks, |hooks| analysis::time_response(&model, &options, hooks)) }?;
        if harmonics_len > 0 {
            unsafe { output::<Complex64>(harmonics.cast(), harmonics_len, 4, "harmonics") }?
                .copy_from_slice(&found.harmonics);
        }
        if samples_len > 0 {
            unsafe { output(samples, samples_len, 6, "samples") }?.copy_from_slice(&found.samples);
        }
        if places_len > 0 {
            unsafe { output(given.places, places_len, 2, "places") }?.copy_from_slice(&found.places);
        }
        if !info.is_null() {
            let value = hbvib_time_info {
                period: found.period,
                residual: found.residual,
                periods: found.periods as i64,
                events: found.events as i64,
                ..hbvib_time_info::defaults()
            };
            unsafe { fill_out(info, value) };
        }
        Ok(found.status)
    })
}

unsafe fn time_options<'a>(o: &hbvib_time_options, ndof: usize) -> Result<TimeOptions<'a>> {
    let start = if o.start.is_null() && o.start_len == 0 {
        None
    } else {
        let len = number(o.start_len, "start_len")?;
        Some(unsafe { input::<Complex64>(o.start.cast(), len, 2, "start") }?)
    };
    let options = TimeOptions {
        omega: o.omega,
        method: steady_method(o.method)?,
        harmonics: number(o.harmonics, "harmonics")?,
        samples: number(o.samples, "samples")?,
        tolerance: o.tolerance,
        max_periods: number(o.max_periods, "max_periods")?,
        start,
    };
    options.check(ndof)?;
    Ok(options)
}

/// The method of a number.
pub(crate) fn steady_method(method: i32) -> Result<SteadyMethod> {
    match method {
        0 => Ok(SteadyMethod::Shooting),
        1 => Ok(SteadyMethod::Marching),
        other => fail!(
            Argument,
            "method = {other}, needs HBVIB_SHOOTING = 0 or HBVIB_MARCHING = 1"
        ),
    }
}
