//! Section "Design studies" of the header: a forced response over a parameter of the model, and its optima.

#![allow(non_camel_case_types)]

use super::arrays::{check_pointer, count, input, optional};
use super::boundary::{WithArgument, call};
use super::handles::{KeptBranch, read};
use super::model::hbvib_model;
use super::sensitivities::{hbvib_parameter, parameter};
use super::solve::{follow, hbvib_branch};
use super::solve_hooks::hbvib_hooks;
use super::solve_options::{hbvib_solver_options, solver_options};
use super::version_and_errors::hbvib_status;
use super::versioned_struct::{VersionedStruct, init, load};
use crate::analysis::{self, Follow, ParameterRange};
use crate::error::{Result, Status, fail};
use crate::model::Model;
use core::ptr;

/// Quantity that a parameter response follows.
#[repr(C)]
pub enum hbvib_follow {
    /// The response at a fixed frequency.
    HBVIB_FOLLOW_OMEGA = 0,
    /// A peak of the response.
    HBVIB_FOLLOW_PEAK = 1,
}

/// Range of a parameter response. Fill it by hbvib_parameter_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_parameter_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_FOLLOW_OMEGA or HBVIB_FOLLOW_PEAK.
    pub follow: i32,
    /// The parameter: must be set.
    pub parameter: *const hbvib_parameter,
    /// First value: of a constant or the speed the value itself, of a factor 1 as at present, of a
    /// direction its coefficient.
    pub start: f64,
    /// Last value; below the first for a downward response.
    pub stop: f64,
    /// Angular frequency: the fixed one, or one within a tenth of which the peak next to it is
    /// sought at the first value.
    pub omega: f64,
    /// Values at which every solution is computed exactly, or NULL.
    pub at: *const f64,
    /// Number of these values.
    pub at_len: i64,
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

/// Follows the amplitude of a forced response over a parameter, at a fixed frequency or in a peak,
/// by arc-length continuation: folds are passed, minima and maxima refined. All points have the
/// same harmonics, so that the tolerance of the solver must be 0. The branch has the fields
/// HBVIB_PARAMETER_VALUE and HBVIB_D_AMPLITUDE, and hbvib_branch_optima; its points belong to
/// different models, so that functions of a model and a branch refuse it.
///
/// solver   options, with tolerance = 0.
/// options  parameter, range, and what is followed.
/// hooks    progress, log and cancellation; NULL: none.
/// out      receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early; a peak that vanishes in a fold ends with
/// HBVIB_STOPPED_STEP_TOO_SMALL.
/// Errors: those of hbvib_forced_response and of the parameters of hbvib_sensitivity;
/// HBVIB_E_UNSUPPORTED also for a tolerance above 0; HBVIB_E_NO_CONVERGENCE also where there is no
/// peak near the frequency. Threads: as for hbvib_forced_response.
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
        let range = unsafe { parameter_range(&o) }.with_argument(3)?;
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
            other => {
                return fail!(
                    Argument,
                    "follow = {other}, needs HBVIB_FOLLOW_OMEGA = 0 or HBVIB_FOLLOW_PEAK = 1"
                );
            }
        },
    };
    range.check()?;
    Ok(range)
}

/// Minima and maxima of the amplitude over the parameter, refined on the solution, in the order of
/// the branch. Other branches have none.
///
/// capacity   numbers that fit into each array.
/// parameter  receives the values of the parameter, or NULL.
/// amplitude  receives the amplitudes, or NULL.
/// maximum    receives numbers: 1 for a maximum, 0 for a minimum; or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, numbers, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_optima(
    branch: *const hbvib_branch,
    capacity: i64,
    parameter: *mut f64,
    amplitude: *mut f64,
    maximum: *mut i64,
    point: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let capacity = super::arrays::count(capacity, 2, "capacity")?;
        let reals = [
            optional((parameter, 3), "parameter")?,
            optional((amplitude, 4), "amplitude")?,
        ];
        let whole = [optional((maximum, 5), "maximum")?, optional((point, 6), "point")?];
        check_pointer(count, 7, "count")?;
        let found = kept.branch.optima();
        unsafe { count.write(found.len() as i64) };
        if reals.iter().all(Option::is_none) && whole.iter().all(Option::is_none) {
            return Ok(Status::Ok);
        }
        if capacity < found.len() {
            return fail!(Dimension, "capacity = {capacity}, needs {}", found.len()).with_argument(2);
        }
        for (i, optimum) in found.iter().enumerate() {
            for (column, value) in reals.iter().zip([optimum.parameter, optimum.amplitude]) {
                if let Some(p) = column {
                    unsafe { p.add(i).write(value) };
                }
            }
            let numbers = [i64::from(optimum.is_maximum), optimum.point as i64];
            for (column, value) in whole.iter().zip(numbers) {
                if let Some(p) = column {
                    unsafe { p.add(i).write(value) };
                }
            }
        }
        Ok(Status::Ok)
    })
}
