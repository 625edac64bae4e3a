//! Section "Results" of the header: the responses that a forced response was asked for.

#![allow(non_camel_case_types)]

use crate::at_a_point;
use crate::capi::crossing::arrays::{Range, check_pointer, count, disjoint, input, optional_len, output};
use crate::capi::crossing::boundary::{WithArgument, call, call_count};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::{at_least_1, index};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out};
use crate::capi::reading::results::hbvib_view;
use crate::capi::reading::results_special_points::Lists;
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::solving::solve_responses::{Watched, hbvib_response};
use crate::capi::structures::matrices::hbvib_scalar;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::options::check_responses;
use core::ptr;
use num_complex::Complex64;

/// Results of a response at each stored point.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum hbvib_reading {
    /// The measure.
    HBVIB_READING_VALUE = 0,
    /// Complex amplitude; NaN where the measure is none of a single harmonic.
    HBVIB_READING_COMPLEX = 1,
    /// Estimated relative error, of the complex amplitude where there is one. NaN where it is
    /// unknown, and everywhere without a tolerance and without estimate_error.
    HBVIB_READING_ERROR = 2,
    /// Phase omega t of the largest magnitude of a peak, or of the largest value of a range, in
    /// 0 .. 2 pi; NaN for other measures.
    HBVIB_READING_INSTANT = 3,
}

/// Number of the responses that were asked for in hbvib_forced_options, or a negative status.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_responses(branch: *const hbvib_branch) -> i64 {
    call_count(|| Ok(read::<KeptBranch>(branch, 1)?.branch.responses().len()))
}

/// Borrows the values of a response at all stored points: those of the curve, then those of the
/// peaks, folds and requested solutions beside it, so that the number of a point is its place.
///
/// response  number of the response, from 0.
/// reading   HBVIB_READING_VALUE and so on (enum hbvib_reading).
/// out       receives the view, whose memory stays valid until hbvib_branch_free; fill it by
///           hbvib_view_init before; untouched on error.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_ARGUMENT (reading), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_response(
    branch: *const hbvib_branch,
    response: i64,
    reading: i32,
    out: *mut hbvib_view,
) -> hbvib_status {
    use hbvib_reading as r;
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        unsafe { check_out(out, 4) }?;
        let all = kept.branch.responses();
        let of = &all[index(response, all.len(), 2, "response")?];
        let real = |values: &[f64]| (hbvib_scalar::HBVIB_REAL, values.as_ptr());
        let (scalar, data) = match reading {
            k if k == r::HBVIB_READING_VALUE as i32 => real(of.values()),
            k if k == r::HBVIB_READING_ERROR as i32 => real(of.errors()),
            k if k == r::HBVIB_READING_INSTANT as i32 => real(of.instants()),
            k if k == r::HBVIB_READING_COMPLEX as i32 => (hbvib_scalar::HBVIB_COMPLEX, of.complex().as_ptr().cast()),
            other => {
                return fail!(Argument, "reading = {other}, needs a value of enum hbvib_reading").with_argument(3);
            }
        };
        let points = of.values().len();
        let view = hbvib_view {
            scalar: scalar as i32,
            rank: 1,
            data: if points == 0 { ptr::null() } else { data },
            shape: [points as i64, 1, 1],
            ..hbvib_view::defaults()
        };
        unsafe { fill_out(out, view) };
        Ok(Status::Ok)
    })
}

/// Maxima of a response within the range, refined on the solution, in the order of the branch.
///
/// response   number of the response, from 0.
/// capacity   numbers that fit into each array.
/// omega      receives their angular frequencies, or NULL.
/// value      receives the measures there, or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, or NULL.
/// peaks      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity too small: the arrays are
/// untouched), HBVIB_E_NULL, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_response_peaks(
    branch: *const hbvib_branch,
    response: i64,
    capacity: i64,
    omega: *mut f64,
    value: *mut f64,
    point: *mut i64,
    peaks: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        check_pointer(peaks, 7, "peaks")?;
        let all = kept.branch.responses();
        let of = &all[index(response, all.len(), 2, "response")?];
        let lists = Lists {
            omega: (omega, 4),
            amplitude: (value, 5),
            point: (point, 6),
            count: (peaks, 7),
        };
        unsafe { lists.fill(of.peaks(), (capacity, 3)) }
    })
}

/// Kinks of a peak or a range, where another instant of the period takes the lead and the slope of
/// the measure jumps. Derivatives at the two points of a kink are those of its two sides.
///
/// response   number of the response, from 0.
/// capacity   numbers that fit into each array.
/// omega      receives their angular frequencies, or NULL.
/// value      receives the measures there, or NULL.
/// before     receives the numbers of the last points before them, or NULL.
/// after      receives the numbers of the first points behind them, or NULL.
/// kinks      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity too small: the arrays are
/// untouched), HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_NULL, HBVIB_E_HANDLE. Threads: any
/// number on one branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_response_kinks(
    branch: *const hbvib_branch,
    response: i64,
    capacity: i64,
    omega: *mut f64,
    value: *mut f64,
    before: *mut i64,
    after: *mut i64,
    kinks: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        check_pointer(kinks, 8, "kinks")?;
        let all = kept.branch.responses();
        let of = &all[index(response, all.len(), 2, "response")?];
        let n = of.kinks().len();
        let capacity = count(capacity, 3, "capacity")?;
        unsafe { kinks.write(n as i64) };
        let none = omega.is_null() && value.is_null() && before.is_null() && after.is_null();
        if none {
            return Ok(Status::Ok);
        }
        if capacity < n {
            return fail!(Dimension, "capacity = {capacity}, needs {n}").with_argument(3);
        }
        disjoint(
            &[],
            &[
                Range::new(omega, n, 4, "omega")?,
                Range::new(value, n, 5, "value")?,
                Range::new(before, n, 6, "before")?,
                Range::new(after, n, 7, "after")?,
            ],
        )?;
        for (i, (first, last)) in of.kinks().enumerate() {
            unsafe {
                if !omega.is_null() {
                    omega.add(i).write(first.omega);
                }
                if !value.is_null() {
                    value.add(i).write(first.amplitude);
                }
                if !before.is_null() {
                    before.add(i).write(first.point as i64);
                }
                if !after.is_null() {
                    after.add(i).write(last.point as i64);
                }
            }
        }
        Ok(Status::Ok)
    })
}

/// Number of the response with the largest error at a stored point, in the norm that the tolerance
/// has; HBVIB_E_INDEX where there is no such point, HBVIB_E_ARGUMENT where no error is known.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// Errors: HBVIB_E_HANDLE also. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_leading_response(branch: *const hbvib_branch, point: i64) -> i64 {
    call_count(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let point = index(point, kept.branch.stored(), 2, "point")?;
        match kept.branch.leading_response(point) {
            Some(response) => Ok(response),
            None => fail!(Argument, "no error of a response is known at point {point}").with_argument(2),
        }
    })
}

/// Reads responses at all stored points of any branch, whatever it was asked for: of a nonlinear
/// mode, of a result over a parameter, or further gauges of a forced response. A hook or the cancel
/// flag may stop it: the status is then HBVIB_STOPPED_BY_CALLER, and the arrays are untouched.
///
/// responses      array of responses, struct_size of the first apart; one without degrees of
///                freedom is that of the response degree of freedom.
/// responses_len  how many.
/// values         receives the measures, responses_len x stored points; or NULL.
/// values_len     numbers in it; 0 with NULL.
/// complex        receives complex amplitudes, NaN where a measure has none; or NULL.
/// complex_len    complex numbers in it; 0 with NULL.
/// instants       receives phases as HBVIB_READING_INSTANT; or NULL.
/// instants_len   numbers in it; 0 with NULL.
/// hooks          phase, log and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_DIMENSION (lengths, weights), HBVIB_E_INDEX (dofs, sector), HBVIB_E_ARGUMENT
/// (fields, overlapping arrays), HBVIB_E_NOT_FINITE, HBVIB_E_SINGULAR, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_CALLBACK, HBVIB_E_OUT_OF_MEMORY. Threads: any
/// number on one branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_read_responses(
    branch: *const hbvib_branch,
    responses: *const hbvib_response,
    responses_len: i64,
    values: *mut f64,
    values_len: i64,
    complex: *mut f64,
    complex_len: i64,
    instants: *mut f64,
    instants_len: i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 10) }?;
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        check_pointer(responses, 2, "responses")?;
        let watched = unsafe { Watched::new(responses, responses_len, branch.ndof(), 2) }.with_argument(2)?;
        let list = unsafe { watched.responses(2) }.with_argument(2)?;
        check_responses(&list, branch.ndof(), branch.reduction().sectors).with_argument(2)?;
        let points = branch.stored();
        let needed = list.len().saturating_mul(points);
        let lengths = "responses_len * stored points";
        let values_len = optional_len(values, values_len, needed, 4, lengths)?;
        let complex_len = optional_len(complex, complex_len, needed, 6, lengths)?;
        let instants_len = optional_len(instants, instants_len, needed, 8, lengths)?;
        disjoint(
            &[],
            &[
                Range::new(values, values_len, 4, "values")?,
                Range::new::<Complex64>(complex.cast(), complex_len, 6, "complex")?,
                Range::new(instants, instants_len, 8, "instants")?,
            ],
        )?;
        let found = unsafe { with_interrupt(&hooks, |interrupt| branch.read_responses_with(&list, interrupt)) }?;
        for (i, one) in found.iter().enumerate() {
            let place = i * points..(i + 1) * points;
            unsafe {
                if values_len > 0 {
                    output(values, values_len, 4, "values")?[place.clone()].copy_from_slice(one.values());
                }
                if complex_len > 0 {
                    let all = output::<Complex64>(complex.cast(), complex_len, 6, "complex")?;
                    all[place.clone()].copy_from_slice(one.complex());
                }
                if instants_len > 0 {
                    output(instants, instants_len, 8, "instants")?[place].copy_from_slice(one.instants());
                }
            }
        }
        Ok(Status::Ok)
    })
}

/// Reads a response from any periodic motion: of a nonlinear mode, a synthesis, an integration in
/// time. The fundamental is harmonic 1, and the sector must be 0.
///
/// r          the response; it needs degrees of freedom of its own.
/// ndof       degrees of freedom of the motion, at least 1.
/// omega      angular frequency, for velocities and accelerations.
/// x          complex harmonics 0 .. H of the motion, (H + 1) x ndof, harmonic after harmonic.
/// x_len      complex numbers in it.
/// value      receives the measure; untouched on error.
/// amplitude  receives the complex amplitude, re and im, NaN where the measure has none; or NULL.
/// instant    receives the phase omega t of the largest magnitude of a peak, or of the largest
///            value of a range, else NaN; or NULL.
/// Errors: HBVIB_E_DIMENSION (ndof, x_len, weights), HBVIB_E_INDEX (dofs, sector),
/// HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_response_of(
    r: *const hbvib_response,
    ndof: i64,
    omega: f64,
    x: *const f64,
    x_len: i64,
    value: *mut f64,
    amplitude: *mut f64,
    instant: *mut f64,
) -> hbvib_status {
    call(|| {
        let ndof = at_least_1(ndof, 2, "ndof")?;
        let watched = unsafe { Watched::new(r, 1, ndof, 1) }.with_argument(1)?;
        let responses = unsafe { watched.responses(1) }.with_argument(1)?;
        let x_len = count(x_len, 5, "x_len")?;
        let x = unsafe { input::<Complex64>(x.cast(), x_len, 4, "x") }?;
        check_pointer(value, 6, "value")?;
        for (p, argument, name) in [(amplitude, 7, "amplitude"), (instant, 8, "instant")] {
            if !p.is_null() {
                check_pointer(p, argument, name)?;
            }
        }
        let found = at_a_point::response_of(&responses[0], ndof, omega, x)?;
        unsafe {
            value.write(found.value);
            if !amplitude.is_null() {
                amplitude.write(found.complex.re);
                amplitude.add(1).write(found.complex.im);
            }
            if !instant.is_null() {
                instant.write(found.instant);
            }
        }
        Ok(Status::Ok)
    })
}
