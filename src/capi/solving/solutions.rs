//! Section "Solve" of the header: solutions that a sweep does not show, as children of a branch.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count as length};
use crate::capi::crossing::boundary::{WithArgument, call, call_count};
use crate::capi::crossing::handles::{KeptBranch, insert, read};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::structures::model::hbvib_model;
use crate::capi::time_calls::stability_lists::kind_number;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::model::Model;

/// Number of the children of a branch: the branches that branch off from it, and the detached
/// curves beside it, as far as `branches` of hbvib_forced_options or hbvib_mode_options sought
/// them; or a negative status.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_children(branch: *const hbvib_branch) -> i64 {
    call_count(|| Ok(read::<KeptBranch>(branch, 1)?.children.len()))
}

/// A child of a branch. It is a branch as any other, with children of its own; it belongs to its
/// parent, and hbvib_branch_free of the parent frees it. Where the period doubles its frequencies
/// are those of its parent over 2, and its harmonic 2 is that of the fundamental of its parent:
/// results that need the model take that of hbvib_model_longer_period.
///
/// number  of the child, 0 .. hbvib_branch_children - 1.
/// out     receives the child, the same handle each time; untouched on error.
/// Errors: HBVIB_E_INDEX, HBVIB_E_NULL, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_child(
    branch: *const hbvib_branch,
    number: i64,
    out: *mut *mut hbvib_branch,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        check_pointer(out, 3, "out")?;
        let found = usize::try_from(number).ok().and_then(|i| kept.children.get(i));
        let Some(child) = found else {
            return fail!(
                Index,
                "number = {number}, but the branch has {} children",
                kept.children.len()
            )
            .with_argument(2);
        };
        unsafe { out.write(core::ptr::without_provenance_mut(*child)) };
        Ok(Status::Ok)
    })
}

/// Origin of a child. Fill it by hbvib_descent_init, then by hbvib_branch_descent.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_descent {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Kind of the bifurcation of its parent from which it branches off, a value of enum
    /// hbvib_bifurcation; -1 for a detached curve.
    pub kind: i32,
    /// Place of that bifurcation in hbvib_branch_bifurcations of the parent; -1 for a detached
    /// curve.
    pub bifurcation: i64,
    /// Periods of the parent in one of its own; its frequencies are those of the parent over that.
    pub periods: i64,
    /// Frequency, its own, at which it comes back to its parent; 0 where it does not.
    pub merges_at: f64,
    /// Number of the linear mode along whose nonlinear mode a detached curve was found; -1
    /// otherwise.
    pub mode: i64,
    /// Factor of all forces at which a detached curve is born, as its nonlinear mode predicts it, or
    /// as a curve over the force turns; 0 where it is not known.
    pub born_at_force: f64,
    /// The same at which it merges with the curve beneath.
    pub merges_at_force: f64,
    /// Order n of the n:1 internal resonance beyond whose tongue a curve of a nonlinear mode lies;
    /// 0 otherwise.
    pub internal_resonance: i64,
}

unsafe impl VersionedStruct for hbvib_descent {
    const NAME: &'static str = "hbvib_descent";
    const FIRST_SIZE: usize = 56;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            kind: -1,
            bifurcation: -1,
            periods: 1,
            merges_at: 0.0,
            mode: -1,
            born_at_force: 0.0,
            merges_at_force: 0.0,
            internal_resonance: 0,
        }
    }
}

/// Fills a descent with that of a branch that was asked for.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_descent_init(o: *mut hbvib_descent, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Origin of a branch: where a child comes from. A branch that was asked for has the values of
/// hbvib_descent_init.
///
/// out  receives it; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_descent(branch: *const hbvib_branch, out: *mut hbvib_descent) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        unsafe { check_out(out, 2) }?;
        let mut value = hbvib_descent::defaults();
        if let Some(descent) = kept.branch.descent() {
            let index = |number: Option<usize>| number.map_or(-1, |number| number as i64);
            let known = |value: f64| if value.is_nan() { 0.0 } else { value };
            value.kind = descent.kind.map_or(-1, |kind| kind_number(kind) as i32);
            value.bifurcation = index(descent.bifurcation);
            value.periods = descent.periods as i64;
            value.merges_at = known(descent.merges_at);
            value.mode = index(descent.mode);
            value.born_at_force = known(descent.born_at_force);
            value.merges_at_force = known(descent.merges_at_force);
            value.internal_resonance = descent.internal_resonance as i64;
        }
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}

/// Solutions beside a branch that were sought. The list of children is not complete: a solution
/// that none of these searches leads to is not found. Fill it by hbvib_searched_init, then by
/// hbvib_branch_searched.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_searched {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Bifurcations of all generations from which a branch was sought.
    pub bifurcations: i64,
    /// Those from which none was found.
    pub lost: i64,
    /// Bifurcations from which none was sought, beyond branch_depth or most_branches.
    pub left: i64,
    /// Nonlinear modes along which detached curves were sought.
    pub modes: i64,
    /// Those that could not be followed through the range of amplitude.
    pub incomplete_modes: i64,
    /// Resonances within the range of frequency that these modes predict.
    pub resonances: i64,
    /// Those near which no solution was found.
    pub lost_resonances: i64,
    /// Smallest modal amplitude to which modes were followed; 0 without modes.
    pub amplitude_min: f64,
    /// Largest one.
    pub amplitude_max: f64,
    /// Nets of starts of subharmonic curves.
    pub starts: i64,
    /// Curves of peaks and folds that were followed over the force, between a tenth and ten times it.
    pub force_curves: i64,
    /// Those that ended early.
    pub incomplete_force_curves: i64,
    /// Solutions at the force itself on these curves, beside those that they begin at.
    pub crossings: i64,
    /// Points of the response beside which deflation sought solutions.
    pub deflations: i64,
    /// Curves that it found.
    pub deflated: i64,
}

unsafe impl VersionedStruct for hbvib_searched {
    const NAME: &'static str = "hbvib_searched";
    const FIRST_SIZE: usize = 88;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            bifurcations: 0,
            lost: 0,
            left: 0,
            modes: 0,
            incomplete_modes: 0,
            resonances: 0,
            lost_resonances: 0,
            amplitude_min: 0.0,
            amplitude_max: 0.0,
            starts: 0,
            force_curves: 0,
            incomplete_force_curves: 0,
            crossings: 0,
            deflations: 0,
            deflated: 0,
        }
    }
}

/// Fills a search with zeros.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_searched_init(o: *mut hbvib_searched, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// The solutions that were sought beside a forced response; zeros where none were.
///
/// out  receives them; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_searched(branch: *const hbvib_branch, out: *mut hbvib_searched) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        unsafe { check_out(out, 2) }?;
        let searched = kept.branch.searched().unwrap_or_default();
        let value = hbvib_searched {
            bifurcations: searched.bifurcations as i64,
            lost: searched.lost as i64,
            left: searched.left as i64,
            modes: searched.modes as i64,
            incomplete_modes: searched.incomplete_modes as i64,
            resonances: searched.resonances as i64,
            lost_resonances: searched.lost_resonances as i64,
            amplitude_min: searched.amplitudes.0,
            amplitude_max: searched.amplitudes.1,
            starts: searched.starts as i64,
            force_curves: searched.force_curves as i64,
            incomplete_force_curves: searched.incomplete_force_curves as i64,
            crossings: searched.crossings as i64,
            deflations: searched.deflations as i64,
            deflated: searched.deflated as i64,
            ..hbvib_searched::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}

/// Copies a model for motions with a multiple of the period of its forces: forces in harmonic h act
/// in harmonic `periods` * h of the copy, whose frequencies are those of the model over `periods`.
/// A speed that is tied to the frequency and unbalances remain what they are.
///
/// periods  at least 1; 2 for the children of a period doubling.
/// out      receives the copy; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_UNSUPPORTED (no wave of the sectors has that period),
/// HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed), HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may copy and solve one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_longer_period(
    model: *const hbvib_model,
    periods: i64,
    out: *mut *mut hbvib_model,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let periods = length(periods, 2, "periods")?;
        check_pointer(out, 3, "out")?;
        let longer = model.with_longer_period(periods).with_argument(2)?;
        unsafe { out.write(insert(longer)?) };
        Ok(Status::Ok)
    })
}
