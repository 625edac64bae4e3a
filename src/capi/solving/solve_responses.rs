//! Section "Solve" of the header: the responses that a forced response watches.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::call;
use crate::capi::crossing::indices::{indices, number};
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail, try_push};
use crate::options::{Component, Measure, Response};
use core::ptr;

/// The number that is read from a response over a period.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum hbvib_measure {
    /// Amplitude of the fundamental: harmonic 1, or the one that hbvib_reduction names.
    HBVIB_MEASURE_FUNDAMENTAL = 0,
    /// Amplitude of one harmonic, 0 where the motion does not have it; harmonic 0 is the magnitude of
    /// the mean.
    HBVIB_MEASURE_HARMONIC = 1,
    /// Largest magnitude over the period.
    HBVIB_MEASURE_PEAK = 2,
    /// Root of the mean square over the period, mean included.
    HBVIB_MEASURE_RMS = 3,
    /// Largest value minus smallest one over the period.
    HBVIB_MEASURE_RANGE = 4,
}

/// The derivative of the motion by time that a response sees.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum hbvib_component {
    /// Displacement.
    HBVIB_DISPLACEMENT = 0,
    /// Velocity.
    HBVIB_VELOCITY = 1,
    /// Acceleration.
    HBVIB_ACCELERATION = 2,
}

/// A response: a gauge, the weighted sum of degrees of freedom of one sector, and what is read from
/// it over a period. Fill it by hbvib_response_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_response {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// A value of enum hbvib_measure.
    pub measure: i32,
    /// Number of the harmonic of HBVIB_MEASURE_HARMONIC; the others do not use it.
    pub harmonic: i64,
    /// Number of degrees of freedom; 0: the response degree of freedom of the solver options.
    pub n: i64,
    /// The degrees of freedom, from 0; NULL if n is 0.
    pub dofs: *const i64,
    /// Their weights, n numbers; NULL: 1 each.
    pub weights: *const f64,
    /// Sector of the wheel, from 0.
    pub sector: i64,
    /// A value of enum hbvib_component.
    pub component: i32,
    /// Must be 0.
    pub reserved: i32,
}

unsafe impl VersionedStruct for hbvib_response {
    const NAME: &'static str = "hbvib_response";
    const FIRST_SIZE: usize = 56;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            measure: hbvib_measure::HBVIB_MEASURE_FUNDAMENTAL as i32,
            harmonic: 1,
            n: 0,
            dofs: ptr::null(),
            weights: ptr::null(),
            sector: 0,
            component: hbvib_component::HBVIB_DISPLACEMENT as i32,
            reserved: 0,
        }
    }
}

/// Fills a response with the fundamental displacement of the response degree of freedom.
///
/// r          the struct; untouched on error.
/// size_of_r  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_response_init(r: *mut hbvib_response, size_of_r: usize) -> hbvib_status {
    call(|| unsafe { init(r, size_of_r) })
}

/// The responses of a caller, with their degrees of freedom in memory of their own.
#[derive(Default)]
pub(crate) struct Watched {
    given: Vec<(hbvib_response, Vec<usize>)>,
}

impl Watched {
    /// Reads the responses of argument `argument`, whose distance is the size that the first one states.
    ///
    /// # Safety
    /// The caller of the C function states that `n` structs with their arrays lie there.
    pub unsafe fn new(p: *const hbvib_response, n: i64, ndof: usize, argument: i32) -> Result<Self> {
        let n = count(n, argument, "responses_len")?;
        let mut given = Vec::new();
        if n == 0 {
            return Ok(Self { given });
        }
        check_pointer(p, argument, "responses")?;
        let distance = unsafe { p.cast::<u32>().read() } as usize;
        for i in 0..n {
            let one = unsafe { p.byte_add(i * distance) };
            let read = unsafe { load(one, argument) }.map_err(|e| e.at(format_args!("responses[{i}]")))?;
            if read.struct_size as usize != distance {
                return fail!(
                    StructSize,
                    "responses[{i}]: struct_size = {}, but that of the first is {distance}",
                    read.struct_size
                );
            }
            if read.reserved != 0 {
                return fail!(Argument, "responses[{i}]: reserved = {}, needs 0", read.reserved);
            }
            let dofs = unsafe { dofs(&read, ndof, argument) }.map_err(|e| e.at(format_args!("responses[{i}]")))?;
            try_push(&mut given, (read, dofs), "the responses")?;
        }
        Ok(Self { given })
    }

    /// The responses in the form of the library.
    ///
    /// # Safety
    /// The caller of the C function states that the weights lie where they are said to be.
    pub unsafe fn responses(&self, argument: i32) -> Result<Vec<Response<'_>>> {
        let mut list = Vec::new();
        for (i, (read, dofs)) in self.given.iter().enumerate() {
            let response =
                unsafe { response(read, dofs, argument) }.map_err(|e| e.at(format_args!("responses[{i}]")))?;
            try_push(&mut list, response, "the responses")?;
        }
        Ok(list)
    }
}

unsafe fn dofs(read: &hbvib_response, ndof: usize, argument: i32) -> Result<Vec<usize>> {
    let n = count(read.n, argument, "n")?;
    indices(
        unsafe { input(read.dofs, n, argument, "dofs") }?,
        ndof,
        argument,
        "dofs",
    )
}

unsafe fn response<'a>(read: &hbvib_response, dofs: &'a [usize], argument: i32) -> Result<Response<'a>> {
    use hbvib_measure as m;
    let measures = [
        (m::HBVIB_MEASURE_FUNDAMENTAL, Measure::Fundamental),
        (m::HBVIB_MEASURE_PEAK, Measure::Peak),
        (m::HBVIB_MEASURE_RMS, Measure::Rms),
        (m::HBVIB_MEASURE_RANGE, Measure::Range),
    ];
    let known = measures.into_iter().find(|(m, _)| *m as i32 == read.measure);
    let measure = match known {
        Some((_, measure)) => measure,
        None if read.measure == m::HBVIB_MEASURE_HARMONIC as i32 => {
            Measure::Harmonic(number(read.harmonic, "harmonic")?)
        }
        None => {
            return fail!(
                Argument,
                "measure = {}, needs a value of enum hbvib_measure",
                read.measure
            );
        }
    };
    let component = match read.component {
        0 => Component::Displacement,
        1 => Component::Velocity,
        2 => Component::Acceleration,
        other => return fail!(Argument, "component = {other}, needs a value of enum hbvib_component"),
    };
    let weights = if read.weights.is_null() {
        &[]
    } else {
        unsafe { input(read.weights, dofs.len(), argument, "weights") }?
    };
    Ok(Response {
        measure,
        dofs,
        weights,
        sector: number(read.sector, "sector")?,
        component,
    })
}
