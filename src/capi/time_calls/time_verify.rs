//! Section "Time" of the header: points of forced responses compared with the motion in time.

#![allow(non_camel_case_types)]

use crate::analysis;
use crate::capi::crossing::arrays::{Range, disjoint, optional_len, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::indices::number;
use crate::capi::crossing::stored_point::StoredPoint;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init, load};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::structures::model::hbvib_model;
use crate::capi::time_calls::time::{hbvib_steady_method, steady_method};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Result;
use crate::options::VerifyOptions;
use num_complex::Complex64;

/// Options of hbvib_verify. Fill it by hbvib_verify_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_verify_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_SHOOTING, which finds the solution of the point also where it is unstable, or
    /// HBVIB_MARCHING.
    pub method: i32,
    /// As in hbvib_time_options.
    pub tolerance: f64,
    /// Cap on the periods that are integrated.
    pub max_periods: i64,
    /// Largest distance from the motion in time, relative to that motion, at which the point counts
    /// as the same solution.
    pub same_within: f64,
}

unsafe impl VersionedStruct for hbvib_verify_options {
    const NAME: &'static str = "hbvib_verify_options";
    const FIRST_SIZE: usize = 32;

    fn defaults() -> Self {
        let defaults = VerifyOptions::default();
        Self {
            struct_size: 0,
            method: hbvib_steady_method::HBVIB_SHOOTING as i32,
            tolerance: defaults.tolerance,
            max_periods: defaults.max_periods as i64,
            same_within: defaults.same_within,
        }
    }
}

/// Fills the options of a check in time with their defaults: shooting, tolerance = 1e-11,
/// same_within = 0.1.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_verify_options_init(o: *mut hbvib_verify_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Distance of a point from the periodic motion that integration in time finds from it. Norms are
/// root mean squares over the period and all degrees of freedom. Fill it by
/// hbvib_verification_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_verification {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 1 if the distance is at most same_within, else 0: the integration went to another solution,
    /// or the point has too few harmonics; a point with more harmonics decides which.
    pub same_solution: i32,
    /// 1 if Newton's method did not converge from the point and periods were marched, which departs
    /// from an unstable solution, else 0; always 1 with HBVIB_MARCHING.
    pub marched: i32,
    /// 0.
    pub reserved: i32,
    /// The harmonic h in which the response is compared: the lowest above the mean in which the
    /// point moves.
    pub harmonic: i64,
    /// X_h of the response degree of freedom in time, (re, im).
    pub response: [f64; 2],
    /// |X_h of the point - X_h in time| / |X_h in time|, the error that HBVIB_ERROR_ESTIMATE
    /// estimates.
    pub response_error: f64,
    /// Distance of the harmonics 0 .. H of all degrees of freedom, relative to the motion in time.
    pub motion_error: f64,
    /// Share of the motion in time above H.
    pub above: f64,
    /// Distance of the whole motions, relative to the motion in time; its square is the sum of the
    /// squares of motion_error and above.
    pub distance: f64,
    /// Largest displacement of the response degree of freedom over the period in time.
    pub peak: f64,
    /// Difference of the largest displacement of the point from it, relative to it.
    pub peak_error: f64,
    /// Largest change over a period of the motion in time, relative to its largest displacement and
    /// velocity: the size of the errors of the integration.
    pub residual: f64,
    /// Number of periods that were integrated.
    pub periods: i64,
    /// Number of changes of the contacts in one period, as in hbvib_time_info.
    pub events: i64,
    /// Number of the response of the branch with the largest error, from 0; -1 where it has none.
    pub worst_response: i64,
    /// Its error: the distance of the measure of the point from that in time, relative to it; of
    /// complex amplitudes where the measure has one. NaN where the branch has no responses.
    pub worst_response_error: f64,
}

unsafe impl VersionedStruct for hbvib_verification {
    const NAME: &'static str = "hbvib_verification";
    const FIRST_SIZE: usize = 112;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            same_solution: 0,
            marched: 0,
            reserved: 0,
            harmonic: 0,
            response: [0.0; 2],
            response_error: 0.0,
            motion_error: 0.0,
            above: 0.0,
            distance: 0.0,
            peak: 0.0,
            peak_error: 0.0,
            residual: 0.0,
            periods: 0,
            events: 0,
            worst_response: 0,
            worst_response_error: 0.0,
        }
    }
}

/// Fills the result of a check in time with zeros.
///
/// v          the struct; untouched on error.
/// size_of_v  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_verification_init(v: *mut hbvib_verification, size_of_v: usize) -> hbvib_status {
    call(|| unsafe { init(v, size_of_v) })
}

/// Checks a stored point of a forced response against integration in time, which starts from the
/// motion of the point and finds a periodic motion at its frequency (see hbvib_time_response):
/// their difference is the error of the point. The branch is not changed. Where several solutions
/// coexist the integration may end in another one: see same_solution, distance and marched.
///
/// model          the model of which the branch is a result.
/// point          number of a point of the curve, or of a peak, fold or requested solution.
/// options        NULL: the defaults.
/// hooks          progress, log and cancellation as in hbvib_time_response; NULL: none.
/// harmonics      receives the harmonics in time, (H + 1) x ndof complex numbers as
///                hbvib_branch_harmonics gives those of the point; or NULL.
/// harmonics_len  complex numbers in it; 0 with NULL.
/// errors         receives the parts of motion_error in each harmonic 0 .. H, whose squares add up;
///                or NULL.
/// errors_len     doubles in it; 0 with NULL.
/// out            receives the distances; fill it by hbvib_verification_init before; or NULL.
/// HBVIB_STOPPED_BY_CALLER: the results compare with the last period, which is not steady.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_UNSUPPORTED (branch is a nonlinear mode; a model that
/// hbvib_time_response refuses), HBVIB_E_ARGUMENT (another model, options, overlapping arrays),
/// HBVIB_E_NOT_FINITE (options), HBVIB_E_DIMENSION (a length, with the one needed),
/// HBVIB_E_NO_CONVERGENCE (no steady state found), HBVIB_E_NO_BOUNDED_SOLUTION (the motion grows
/// without bound), HBVIB_E_CALLBACK (a force callback failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model and
/// branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_verify(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    options: *const hbvib_verify_options,
    hooks: *const hbvib_hooks,
    harmonics: *mut f64,
    harmonics_len: i64,
    errors: *mut f64,
    errors_len: i64,
    out: *mut hbvib_verification,
) -> hbvib_status {
    call(|| {
        let at = StoredPoint::read(model, branch, point)?;
        let branch = at.branch();
        let options = unsafe { verify_options(options) }?;
        let hooks = unsafe { load_hooks(hooks, 5) }?;
        let rows = branch.harmonics() + 1;
        let coefficients = rows.saturating_mul(branch.ndof());
        let harmonics_len = optional_len(harmonics, harmonics_len, coefficients, 6, "(harmonics + 1) * ndof")?;
        let errors_len = optional_len(errors, errors_len, rows, 8, "harmonics + 1")?;
        if !out.is_null() {
            unsafe { check_out(out, 10) }?;
        }
        disjoint(
            &[],
            &[
                Range::new::<Complex64>(harmonics.cast(), harmonics_len, 6, "harmonics")?,
                Range::new(errors, errors_len, 8, "errors")?,
            ],
        )?;
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                analysis::verify(&at.model, branch, at.number, &options, hooks)
            })
        }
        .map_err(|e| at.blame(e, 2))?;
        if harmonics_len > 0 {
            unsafe { output::<Complex64>(harmonics.cast(), harmonics_len, 6, "harmonics") }?
                .copy_from_slice(&found.harmonics);
        }
        if errors_len > 0 {
            unsafe { output(errors, errors_len, 8, "errors") }?.copy_from_slice(&found.harmonic_errors);
        }
        if !out.is_null() {
            let worst = found.worst_response();
            let value = hbvib_verification {
                worst_response: worst.map_or(-1, |(r, _)| r as i64),
                worst_response_error: worst.map_or(f64::NAN, |(_, error)| error),
                same_solution: i32::from(found.same),
                marched: i32::from(found.marched),
                harmonic: found.harmonic as i64,
                response: [found.response.re, found.response.im],
                response_error: found.response_error,
                motion_error: found.motion_error,
                above: found.above,
                distance: found.distance,
                peak: found.peak,
                peak_error: found.peak_error,
                residual: found.residual,
                periods: found.periods as i64,
                events: found.events as i64,
                ..hbvib_verification::defaults()
            };
            unsafe { fill_out(out, value) };
        }
        Ok(found.status)
    })
}

unsafe fn verify_options(p: *const hbvib_verify_options) -> Result<VerifyOptions> {
    if p.is_null() {
        return Ok(VerifyOptions::default());
    }
    let o = unsafe { load(p, 4) }?;
    let chosen = || -> Result<VerifyOptions> {
        let options = VerifyOptions {
            method: steady_method(o.method)?,
            tolerance: o.tolerance,
            max_periods: number(o.max_periods, "max_periods")?,
            same_within: o.same_within,
        };
        options.check()?;
        Ok(options)
    };
    chosen().with_argument(4)
}
