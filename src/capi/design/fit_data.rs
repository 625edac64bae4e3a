//! Section "Design studies" of the header: data of tests.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::solving::solve_responses::{Watched, hbvib_response};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail, try_push};
use crate::options::Response;
use crate::studies::{DataKind, FitData};
use core::ptr;
use num_complex::Complex64;

/// Kinds of data.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum hbvib_data_kind {
    /// Complex amplitude of a response at angular frequencies.
    HBVIB_DATA_RESPONSE = 0,
    /// Measure of a response at angular frequencies.
    HBVIB_DATA_AMPLITUDE = 1,
    /// Measure of a response at the peak nearest to an angular frequency, and where it is.
    HBVIB_DATA_PEAK = 2,
    /// Angular frequency and damping ratio of a nonlinear mode at log10 of its modal amplitude.
    HBVIB_DATA_BACKBONE = 3,
    /// Angular frequency and damping ratio of the mode in which all contacts stick.
    HBVIB_DATA_LINEAR_MODE = 4,
}

/// Data of one kind at one level of the force. Fill it by hbvib_data_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_data {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// A value of enum hbvib_data_kind.
    pub kind: i32,
    /// Factor on all forces of the model; default 1.
    pub force_factor: f64,
    /// The response of the first three kinds; NULL: the fundamental of the response degree of
    /// freedom.
    pub response: *const hbvib_response,
    /// Number of the linear mode with stuck contacts, from 0, of the other kinds.
    pub mode: i64,
    /// First angular frequency that is followed; 0 with omega_stop 0: as far as the data need.
    pub omega_start: f64,
    /// Last one.
    pub omega_stop: f64,
    /// Number of data points.
    pub n: i64,
    /// Angular frequencies, or log10 of modal amplitudes, n numbers. A linear mode does not use them.
    pub x: *const f64,
    /// Complex amplitudes, re and im, 2 n doubles; of other kinds re is the measure, or the angular
    /// frequency of a mode, and im the angular frequency of a peak, or the damping ratio. NULL in
    /// hbvib_predict.
    pub value: *const f64,
    /// Standard deviations, n numbers: of |X|, which is sqrt(2) times that of each part; of the
    /// measure or the angular frequency of a mode. NULL in hbvib_predict.
    pub sigma: *const f64,
    /// Standard deviations of angular frequencies of peaks, or of damping ratios, n numbers; NULL:
    /// these are not data.
    pub second_sigma: *const f64,
}

unsafe impl VersionedStruct for hbvib_data {
    const NAME: &'static str = "hbvib_data";
    const FIRST_SIZE: usize = 88;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            kind: hbvib_data_kind::HBVIB_DATA_RESPONSE as i32,
            force_factor: 1.0,
            response: ptr::null(),
            mode: 0,
            omega_start: 0.0,
            omega_stop: 0.0,
            n: 0,
            x: ptr::null(),
            value: ptr::null(),
            sigma: ptr::null(),
            second_sigma: ptr::null(),
        }
    }
}

/// Fills a data set: complex amplitudes at the forces of the model, without points.
///
/// d          the struct; untouched on error.
/// size_of_d  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_data_init(d: *mut hbvib_data, size_of_d: usize) -> hbvib_status {
    call(|| unsafe { init(d, size_of_d) })
}

/// A data set of the caller, with its response in memory of its own.
pub(crate) struct Described {
    data: hbvib_data,
    watched: Watched,
}

impl Described {
    /// Reads the data sets of arguments 8 and 9.
    ///
    /// # Safety
    /// As [`Described::all`].
    pub unsafe fn listed(data: *const hbvib_data, data_len: i64, ndof: usize) -> Result<Vec<Self>> {
        let sets = count(data_len, 9, "data_len")?;
        if sets == 0 {
            return fail!(Dimension, "data_len = 0, needs at least one set").with_argument(9);
        }
        check_pointer(data, 8, "data")?;
        unsafe { Self::all(data, sets, ndof, 8) }
    }

    /// Reads sets whose distance is the size that the first one states.
    ///
    /// # Safety
    /// The caller of the C function states that `n` structs lie there.
    pub unsafe fn all(p: *const hbvib_data, n: usize, ndof: usize, argument: i32) -> Result<Vec<Self>> {
        let distance = unsafe { p.cast::<u32>().read() } as usize;
        let mut list = Vec::new();
        for i in 0..n {
            let one = unsafe { p.byte_add(i * distance) };
            let data: hbvib_data =
                unsafe { load(one, argument) }.map_err(|e| e.at(format_args!("data[{i}]")).in_argument(argument))?;
            if data.struct_size as usize != distance {
                return fail!(
                    StructSize,
                    "data[{i}]: struct_size = {}, but that of the first is {distance}",
                    data.struct_size
                )
                .with_argument(argument);
            }
            let with = i64::from(!data.response.is_null());
            let watched = unsafe { Watched::new(data.response, with, ndof, argument) }.with_argument(argument)?;
            try_push(&mut list, Self { data, watched }, "the data")?;
        }
        Ok(list)
    }

    /// The sets in the form of the library; without `with_values` their values are not read.
    ///
    /// # Safety
    /// The caller of the C function states that the arrays lie where they are said to be.
    pub unsafe fn sets(all: &[Self], with_values: bool, argument: i32) -> Result<Vec<FitData<'_>>> {
        let mut list = Vec::new();
        for (i, one) in all.iter().enumerate() {
            let set = unsafe { one.set(with_values, argument) }
                .map_err(|e| e.at(format_args!("data[{i}]")).in_argument(argument))?;
            try_push(&mut list, set, "the data")?;
        }
        Ok(list)
    }

    unsafe fn set(&self, with_values: bool, argument: i32) -> Result<FitData<'_>> {
        use hbvib_data_kind as k;
        let d = &self.data;
        let kinds = [
            (k::HBVIB_DATA_RESPONSE, DataKind::Response),
            (k::HBVIB_DATA_AMPLITUDE, DataKind::Amplitude),
            (k::HBVIB_DATA_PEAK, DataKind::Peak),
            (k::HBVIB_DATA_BACKBONE, DataKind::Backbone),
            (k::HBVIB_DATA_LINEAR_MODE, DataKind::LinearMode),
        ];
        let kind = kinds.into_iter().find(|(number, _)| *number as i32 == d.kind);
        let Some((_, kind)) = kind else {
            return fail!(
                Argument,
                "kind = {}, needs HBVIB_DATA_RESPONSE = 0 .. HBVIB_DATA_LINEAR_MODE = 4",
                d.kind
            );
        };
        let Ok(mode) = usize::try_from(d.mode) else {
            return fail!(Argument, "mode = {}, needs the number of a mode from 0", d.mode);
        };
        let n = count(d.n, argument, "n")?;
        if n == 0 {
            return fail!(Dimension, "n = 0, needs at least one data point");
        }
        check_pointer(d.x, argument, "x")?;
        let response = unsafe { self.watched.responses(argument) }?.first().copied();
        let mut set = FitData {
            kind,
            force_factor: d.force_factor,
            response: response.unwrap_or_else(Response::default),
            mode,
            range: (d.omega_start != 0.0 || d.omega_stop != 0.0).then_some((d.omega_start, d.omega_stop)),
            x: unsafe { input(d.x, n, argument, "x") }?,
            ..FitData::default()
        };
        if with_values {
            check_pointer(d.value, argument, "value")?;
            check_pointer(d.sigma, argument, "sigma")?;
            set.value = unsafe { input::<Complex64>(d.value.cast(), n, argument, "value") }?;
            set.sigma = unsafe { input(d.sigma, n, argument, "sigma") }?;
            if !d.second_sigma.is_null() {
                set.second_sigma = unsafe { input(d.second_sigma, n, argument, "second_sigma") }?;
            }
        }
        Ok(set)
    }
}
