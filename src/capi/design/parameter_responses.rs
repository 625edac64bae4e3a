//! Section "Design studies" of the header: a result over a parameter of the model.

#![allow(non_camel_case_types)]

use crate::analysis::{self, Follow, ParameterRange};
use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::design::sensitivities::{hbvib_parameter, parameter};
use crate::capi::solving::solve::{follow, hbvib_branch};
use crate::capi::solving::solve_hooks::hbvib_hooks;
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::solving::solve_responses::{Watched, hbvib_response};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail};
use crate::model::Model;
use core::ptr;

/// Result that a parameter response follows.
#[repr(C)]
pub enum hbvib_follow {
    /// The response at a fixed frequency.
    HBVIB_FOLLOW_OMEGA = 0,
    /// A peak of the response.
    HBVIB_FOLLOW_PEAK = 1,
    /// A fold of the response over the frequency.
    HBVIB_FOLLOW_FOLD = 2,
    /// The largest damping ratio along a nonlinear mode.
    HBVIB_FOLLOW_MODE_MAX_DAMPING = 3,
    /// A peak, which is also followed where it turns into the minimum that it meets.
    HBVIB_FOLLOW_PEAK_THROUGH_FOLDS = 4,
}

/// Range of a parameter response. Fill it by hbvib_parameter_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_parameter_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// A value of enum hbvib_follow.
    pub follow: i32,
    /// The parameter: must be set.
    pub parameter: *const hbvib_parameter,
    /// First value: of a constant or the speed the value itself, of a factor 1 as at present, of a
    /// direction its coefficient.
    pub start: f64,
    /// Last value; below the first for a downward response.
    pub stop: f64,
    /// Angular frequency: the fixed one, or one within a tenth of which the peak or fold next to it
    /// is sought at the first value. With HBVIB_FOLLOW_MODE_MAX_DAMPING the mode is the one whose
    /// linear mode with stuck contacts is next to it.
    pub omega: f64,
    /// Values at which every solution is computed exactly, or NULL.
    pub at: *const f64,
    /// Number of these values.
    pub at_len: i64,
    /// HBVIB_FOLLOW_MODE_MAX_DAMPING only, 0 for others: log10 of the modal amplitude from which
    /// the maximum of damping is sought at the first value. Equal to log10_stop, as 0 and 0: from
    /// the onset of slip to a thousand times its amplitude.
    pub log10_start: f64,
    /// The same up to which it is sought.
    pub log10_stop: f64,
    /// The response that is followed, not with HBVIB_FOLLOW_MODE_MAX_DAMPING; NULL: the amplitude
    /// of the response degree of freedom.
    pub response: *const hbvib_response,
}

unsafe impl VersionedStruct for hbvib_parameter_options {
    const NAME: &'static str = "hbvib_parameter_options";
    const FIRST_SIZE: usize = 56;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            follow: hbvib_follow::HBVIB_FOLLOW_OMEGA as i32,
            parameter: ptr::null(),
            start: 0.0,
            stop: 0.0,
            omega: 0.0,
            at: ptr::null(),
            at_len: 0,
            log10_start: 0.0,
            log10_stop: 0.0,
            response: ptr::null(),
        }
    }
}

/// Fills the options of a parameter response with zeros: parameter, range and omega must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_parameter_options_init(
    o: *mut hbvib_parameter_options,
    size_of_o: usize,
) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Follows a result over a parameter by arc-length continuation: the amplitude of a forced
/// response, or the response of the options, at a fixed frequency, in a peak or in a fold, or the
/// largest damping ratio of a nonlinear mode. Folds over the parameter are passed
/// (hbvib_branch_turns), minima and maxima refined (hbvib_branch_optima). The harmonics are
/// chosen at each point by the tolerance of the solver, or the same at all points with a
/// tolerance of 0. The branch has the fields HBVIB_PARAMETER_VALUE and HBVIB_D_AMPLITUDE, of a
/// mode HBVIB_D_DAMPING and those of a mode; its points belong to different models, so that
/// functions of a model and a branch refuse it.
///
/// solver   options of the solver; NULL: the defaults.
/// options  parameter, range, and the result to follow.
/// hooks    progress, log and cancellation; NULL: none.
/// out      receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early: HBVIB_STOPPED_PEAK_VANISHED where a peak or
/// a maximum of damping met a minimum (HBVIB_FOLLOW_PEAK_THROUGH_FOLDS goes on there). Two folds
/// that meet in a cusp are one curve, which comes back: HBVIB_STOPPED_LEFT_RANGE. A peak that is
/// no longer the highest is told by hbvib_branch_higher_peaks.
/// Errors: those of hbvib_forced_response, hbvib_nonlinear_mode and of the parameters of
/// hbvib_sensitivity; HBVIB_E_NO_CONVERGENCE also where there is no peak, fold or maximum of
/// damping near the frequency. Threads: as for hbvib_forced_response.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_parameter_response(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    options: *const hbvib_parameter_options,
    hooks: *const hbvib_hooks,
    out: *mut *mut hbvib_branch,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let o = unsafe { load(options, 3) }?;
        check_pointer(o.parameter, 3, "hbvib_parameter_options: parameter")?;
        let described = unsafe { load(o.parameter, 3) }?;
        let changed = unsafe { parameter(&described, model.ndof()) }.map_err(|e| e.in_argument(3))?;
        let given = i64::from(!o.response.is_null());
        let watched = unsafe { Watched::new(o.response, given, model.ndof(), 3) }.with_argument(3)?;
        let responses = unsafe { watched.responses(3) }.with_argument(3)?;
        let range = ParameterRange {
            response: responses.first().copied(),
            ..unsafe { parameter_range(&o) }.with_argument(3)?
        };
        unsafe {
            follow(hooks, out, range.at.len(), |hooks| {
                analysis::parameter_response(&model, &solver, changed, &range, hooks)
            })
        }
    })
}

unsafe fn parameter_range<'a>(o: &hbvib_parameter_options) -> Result<ParameterRange<'a>> {
    let at_len = count(o.at_len, 3, "at_len")?;
    let range = ParameterRange {
        start: o.start,
        stop: o.stop,
        at: unsafe { input(o.at, at_len, 3, "at") }?,
        follow: match o.follow {
            0 => Follow::Omega(o.omega),
            1 => Follow::Peak(o.omega),
            2 => Follow::Fold(o.omega),
            3 => Follow::ModeMaxDamping {
                omega: o.omega,
                log10_range: (o.log10_start.to_bits() != o.log10_stop.to_bits())
                    .then_some((o.log10_start, o.log10_stop)),
            },
            4 => Follow::PeakThroughFolds(o.omega),
            other => return fail!(Argument, "follow = {other}, needs a value of enum hbvib_follow: 0 .. 4"),
        },
        response: None,
    };
    range.check()?;
    if !matches!(range.follow, Follow::ModeMaxDamping { .. }) {
        for (name, value) in [("log10_start", o.log10_start), ("log10_stop", o.log10_stop)] {
            if value != 0.0 {
                return fail!(
                    Argument,
                    "{name} = {value}, needs 0: only HBVIB_FOLLOW_MODE_MAX_DAMPING has it"
                );
            }
        }
    }
    Ok(range)
}
