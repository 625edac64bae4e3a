//! Section "Results" of the header: the curve of a branch, its fields and motions.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, exact_len};
use crate::capi::crossing::boundary::{WithArgument, call, call_count, call_to_free};
use crate::capi::crossing::branch_tree::free_tree;
use crate::capi::crossing::handles::{KeptBranch, free, read};
use crate::capi::crossing::indices::{index, times};
use crate::capi::crossing::outcome::Outcome;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::matrices::hbvib_scalar;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail, try_vec};
use crate::results::stored::mode_branch::ModeField;
use crate::results::{Branch, PointField};
use core::ptr;
use num_complex::Complex64;

/// Frees a branch with its children; their views become invalid. NULL is accepted and does nothing.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_ARGUMENT (a child, which its parent
/// frees), HBVIB_E_BUSY. Threads: any, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_free(branch: *mut hbvib_branch) -> hbvib_status {
    call_to_free(|| {
        if branch.is_null() {
            return Ok(Status::Ok);
        }
        let kept = read::<KeptBranch>(branch, 1)?;
        if kept.is_child {
            return fail!(
                Argument,
                "the branch is a child: hbvib_branch_free of its parent frees it"
            )
            .with_argument(1);
        }
        if kept.children.is_empty() {
            drop(kept);
            return free::<KeptBranch>(branch, 1).map(|()| Status::Ok);
        }
        drop(kept);
        free_tree(branch).map(|()| Status::Ok)
    })
}

/// Number of points on the curve, or a negative status. Peaks, folds and the solutions requested at
/// given frequencies or amplitudes are stored beside the curve; their point numbers follow those of
/// the curve.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_points(branch: *const hbvib_branch) -> i64 {
    call_count(|| Ok(read::<KeptBranch>(branch, 1)?.branch.points()))
}

/// Number of all stored points, those beside the curve included, so that point numbers are below
/// it; or a negative status.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_stored(branch: *const hbvib_branch) -> i64 {
    call_count(|| Ok(read::<KeptBranch>(branch, 1)?.branch.stored()))
}

/// The status with which the solve that made the branch returned: HBVIB_OK if the whole range was
/// covered, positive if it stopped early.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_status(branch: *const hbvib_branch) -> hbvib_status {
    call(|| Ok(Outcome::from(&read::<KeptBranch>(branch, 1)?.branch)))
}

/// Results that a branch holds for each point of the curve. Energies are of one sector. All are
/// finite, except for errors, stability and freedom that are unknown, or not there: those are NaN.
#[repr(C)]
pub enum hbvib_field {
    /// Angular frequency.
    HBVIB_OMEGA = 0,
    /// Peak amplitude of the response degree of freedom: of the fundamental, or of the harmonic that
    /// hbvib_reduction names. With responses in hbvib_forced_options the measure of the first one;
    /// where forces act in several harmonics and none in the first, the RMS of that degree of
    /// freedom.
    HBVIB_AMPLITUDE = 1,
    /// Nonlinear modes only: damping ratio D.
    HBVIB_DAMPING_RATIO = 2,
    /// Nonlinear modes only: T, sum over h > 0 of (h omega)^2 X_h^H M_h X_h / 2, which is twice the
    /// mean kinetic energy.
    HBVIB_ENERGY = 3,
    /// Nonlinear modes only: work of friction per cycle.
    HBVIB_DISSIPATION = 4,
    /// Relative residual.
    HBVIB_RESIDUAL = 5,
    /// Newton iterations.
    HBVIB_NEWTON_ITERATIONS = 6,
    /// Estimated relative error of the complex fundamental of the response degree of freedom (in a
    /// nonlinear mode: of the frequency) by the harmonics left out. NaN where it is unknown, and
    /// everywhere without a tolerance and without estimate_error.
    HBVIB_ERROR_ESTIMATE = 7,
    /// Highest harmonic number carried.
    HBVIB_HARMONICS_USED = 8,
    /// Share of the period that each contact slips: points x contacts. An open contact does not
    /// slip, so that springs have 0, HBVIB_UNILATERAL too.
    HBVIB_SLIP_FRACTION = 9,
    /// Nonlinear modes only: log10 of the amplitude, the parameter.
    HBVIB_LOG10_AMPLITUDE = 10,
    /// Nonlinear modes only: modal amplitude sqrt(X_1^H M X_1).
    HBVIB_MODAL_AMPLITUDE = 11,
    /// Nonlinear modes only: work of the structure's damping per cycle.
    HBVIB_STRUCTURAL_LOSS = 12,
    /// Nonlinear modes only: |X_1^H M Y_1|^2 / (X_1^H M X_1 Y_1^H M Y_1) with the fundamental Y_1
    /// of the point before; 1 for the first.
    HBVIB_MODAL_ASSURANCE = 13,
    /// Aliasing check of laws that are sampled: relative change of their force harmonics with half
    /// the samples (twice as many where half are too few). 0 where all laws are exact, NaN where a
    /// law failed at the other samples. It estimates the error by sampling and is no bound of it.
    HBVIB_SAMPLING_ERROR = 14,
    /// Nonlinear modes only: estimated absolute error of the damping ratio, NaN as
    /// HBVIB_ERROR_ESTIMATE.
    HBVIB_DAMPING_ERROR_ESTIMATE = 15,
    /// Forced responses with the solver option `stability` only: largest modulus of the ordinary
    /// Floquet multipliers of the motion. NaN where the motion touches an event, or its perturbations
    /// could not be followed.
    HBVIB_FLOQUET_RADIUS = 16,
    /// The same: number of ordinary multipliers outside the unit circle; 0 for a stable motion.
    HBVIB_UNSTABLE_DIRECTIONS = 17,
    /// Parameter responses only: value of the parameter.
    HBVIB_PARAMETER_VALUE = 18,
    /// Parameter responses only: total derivative of the amplitude by the parameter, NaN where there
    /// is none, and in those of a mode.
    HBVIB_D_AMPLITUDE = 19,
    /// Parameter responses of the largest damping ratio of a mode only: total derivative of that
    /// ratio by the parameter.
    HBVIB_D_DAMPING = 20,
    /// Forced responses with the solver option `freedom` only: number of free sliders, as
    /// hbvib_branch_freedom lists them; 0 where none is free nearby. NaN where it is unknown.
    HBVIB_FREE_SLIDERS = 21,
    /// The same: derivative of the amplitude by the place of each slider at a fixed frequency,
    /// points x contacts x 2 for t1 and t2. NaN where the slider is not free.
    HBVIB_D_AMPLITUDE_BY_PLACE = 22,
}

/// A borrowed array of results, valid until hbvib_branch_free. Fill it by hbvib_view_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_view {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_REAL or HBVIB_COMPLEX.
    pub scalar: i32,
    /// Number of dimensions, 1 to 3.
    pub rank: i32,
    /// 0.
    pub reserved: i32,
    /// First number; NULL where there is none.
    pub data: *const f64,
    /// Length of each dimension; 1 beyond the rank.
    pub shape: [i64; 3],
    /// Distance of neighbours in each dimension, in numbers of the view's kind.
    pub stride: [i64; 3],
}

unsafe impl VersionedStruct for hbvib_view {
    const NAME: &'static str = "hbvib_view";
    const FIRST_SIZE: usize = 72;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            scalar: hbvib_scalar::HBVIB_REAL as i32,
            rank: 0,
            reserved: 0,
            data: ptr::null(),
            shape: [1; 3],
            stride: [1; 3],
        }
    }
}

/// Fills an empty view.
///
/// v          the struct; untouched on error.
/// size_of_v  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_view_init(v: *mut hbvib_view, size_of_v: usize) -> hbvib_status {
    call(|| unsafe { init(v, size_of_v) })
}

/// Borrows the values of a field at the points of the curve, in the order in which it was followed.
///
/// field  HBVIB_OMEGA and so on (enum hbvib_field): one double per point, but HBVIB_SLIP_FRACTION
///        points x contacts, 0 for a contact that never slips, and HBVIB_D_AMPLITUDE_BY_PLACE
///        points x contacts x 2. A forced response does not have the fields of nonlinear modes, and
///        those of stability and freedom with these options only; parameter responses alone have
///        those of a parameter.
/// out    receives the view, whose memory stays valid until hbvib_branch_free; fill it by
///        hbvib_view_init before; untouched on error.
/// Errors: HBVIB_E_ARGUMENT (field), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE.
/// Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_field(
    branch: *const hbvib_branch,
    field: i32,
    out: *mut hbvib_view,
) -> hbvib_status {
    call(|| unsafe { lend(branch, field, Branch::points, out) })
}

/// Borrows the values of a field at all stored points: those of the curve as hbvib_branch_field has
/// them, then those of the peaks, folds and requested solutions beside it, so that the number of a
/// point is its place.
///
/// field  as in hbvib_branch_field; the stability of points beside the curve is NaN.
/// out    receives the view, whose memory stays valid until hbvib_branch_free; fill it by
///        hbvib_view_init before; untouched on error.
/// Errors: HBVIB_E_ARGUMENT (field), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE.
/// Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_stored_field(
    branch: *const hbvib_branch,
    field: i32,
    out: *mut hbvib_view,
) -> hbvib_status {
    call(|| unsafe { lend(branch, field, Branch::stored, out) })
}

/// Fills the view of a field at so many points.
///
/// # Safety
/// The caller of the C function states that the pointers are what they are said to be.
unsafe fn lend(
    branch: *const hbvib_branch,
    field: i32,
    points: impl Fn(&Branch) -> usize,
    out: *mut hbvib_view,
) -> Result<Status> {
    let kept = read::<KeptBranch>(branch, 1)?;
    let branch = &kept.branch;
    unsafe { check_out(out, 3) }?;
    let Some(known) = point_field(field) else {
        return fail!(Argument, "field = {field}, needs a value of enum hbvib_field").with_argument(2);
    };
    let Some(data) = branch.stored_field(known) else {
        return fail!(Argument, "field = {field}: {}", owner(known)).with_argument(2);
    };
    let points = points(branch) as i64;
    let mut view = hbvib_view {
        rank: 1,
        data: if points == 0 || data.is_empty() {
            ptr::null()
        } else {
            data.as_ptr()
        },
        shape: [points, 1, 1],
        ..hbvib_view::defaults()
    };
    if known == PointField::SlipFraction {
        let contacts = branch.contacts() as i64;
        view.rank = 2;
        view.shape[1] = contacts;
        view.stride[0] = contacts;
    }
    if known == PointField::ByPlace {
        let contacts = branch.contacts() as i64;
        view.rank = 3;
        (view.shape, view.stride) = ([points, contacts, 2], [2 * contacts, 2, 1]);
    }
    unsafe { fill_out(out, view) };
    Ok(Status::Ok)
}

/// The branches that have a field.
fn owner(field: PointField) -> &'static str {
    match field {
        PointField::FloquetRadius | PointField::UnstableDirections => {
            "only a forced response with the solver option stability has it"
        }
        PointField::FreeSliders | PointField::ByPlace => "only a forced response with the solver option freedom has it",
        PointField::Parameter | PointField::DAmplitude | PointField::DDamping => {
            "only a parameter response has it, the derivative of damping one of a mode"
        }
        _ => "only a nonlinear mode has it",
    }
}

/// The field of a number of the enumeration.
fn point_field(field: i32) -> Option<PointField> {
    use hbvib_field as f;
    [
        (f::HBVIB_OMEGA, PointField::Omega),
        (f::HBVIB_AMPLITUDE, PointField::Amplitude),
        (f::HBVIB_RESIDUAL, PointField::Residual),
        (f::HBVIB_NEWTON_ITERATIONS, PointField::NewtonIterations),
        (f::HBVIB_HARMONICS_USED, PointField::HarmonicsUsed),
        (f::HBVIB_SLIP_FRACTION, PointField::SlipFraction),
        (f::HBVIB_SAMPLING_ERROR, PointField::SamplingError),
        (f::HBVIB_ERROR_ESTIMATE, PointField::ErrorEstimate),
        (f::HBVIB_DAMPING_ERROR_ESTIMATE, PointField::DampingErrorEstimate),
        (f::HBVIB_FLOQUET_RADIUS, PointField::FloquetRadius),
        (f::HBVIB_UNSTABLE_DIRECTIONS, PointField::UnstableDirections),
        (f::HBVIB_FREE_SLIDERS, PointField::FreeSliders),
        (f::HBVIB_D_AMPLITUDE_BY_PLACE, PointField::ByPlace),
        (f::HBVIB_PARAMETER_VALUE, PointField::Parameter),
        (f::HBVIB_D_AMPLITUDE, PointField::DAmplitude),
        (f::HBVIB_D_DAMPING, PointField::DDamping),
        (f::HBVIB_DAMPING_RATIO, PointField::Mode(ModeField::DampingRatio)),
        (f::HBVIB_ENERGY, PointField::Mode(ModeField::Energy)),
        (f::HBVIB_DISSIPATION, PointField::Mode(ModeField::FrictionLoss)),
        (f::HBVIB_LOG10_AMPLITUDE, PointField::Mode(ModeField::Log10Amplitude)),
        (f::HBVIB_MODAL_AMPLITUDE, PointField::Mode(ModeField::ModalAmplitude)),
        (f::HBVIB_STRUCTURAL_LOSS, PointField::Mode(ModeField::StructuralLoss)),
        (f::HBVIB_MODAL_ASSURANCE, PointField::Mode(ModeField::Assurance)),
    ]
    .into_iter()
    .find_map(|(constant, known)| (constant as i32 == field).then_some(known))
}

/// Recovers harmonics 0 .. H of a range of degrees of freedom at a stored point, in the caller's
/// unit of length. H is harmonics_asked of hbvib_branch_reduction; harmonics that are
/// not carried are zero.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// first_dof  first degree of freedom of the range, from 0.
/// n_dof      number of degrees of freedom, at least 1.
/// x          receives (H + 1) x n_dof complex numbers, harmonic after harmonic; untouched on
///            error.
/// x_len      complex numbers in it.
/// Errors: HBVIB_E_INDEX (point, first_dof), HBVIB_E_DIMENSION (n_dof, x_len, with the value
/// needed), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_harmonics(
    branch: *const hbvib_branch,
    point: i64,
    first_dof: i64,
    n_dof: i64,
    x: *mut f64,
    x_len: i64,
) -> hbvib_status {
    unsafe { hbvib_branch_harmonics_with_hooks(branch, point, first_dof, n_dof, x, x_len, core::ptr::null()) }
}

/// The same as hbvib_branch_harmonics; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// first_dof  first degree of freedom of the range, from 0.
/// n_dof      number of degrees of freedom, at least 1.
/// x          receives (H + 1) x n_dof complex numbers, harmonic after harmonic; untouched on
///            error.
/// x_len      complex numbers in it.
/// hooks      phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_harmonics.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_harmonics_with_hooks(
    branch: *const hbvib_branch,
    point: i64,
    first_dof: i64,
    n_dof: i64,
    x: *mut f64,
    x_len: i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 7) }?;
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        let n = branch.ndof();
        let point = index(point, branch.stored(), 2, "point")?;
        let first = index(first_dof, n, 3, "first_dof")?;
        let dofs = usize::try_from(n_dof).unwrap_or(0);
        if dofs == 0 || dofs > n - first {
            return fail!(Dimension, "n_dof = {n_dof}, needs 1 .. {}", n - first).with_argument(4);
        }
        check_pointer(x, 5, "x")?;
        let rows = branch.harmonics() + 1;
        exact_len(x_len, rows.saturating_mul(dofs), 6, "(harmonics + 1) * n_dof")?;
        let mut all = try_vec(rows.saturating_mul(n), Complex64::ZERO, "the harmonics")?;
        unsafe { with_interrupt(&hooks, |interrupt| branch.harmonics_at_with(point, &mut all, interrupt)) }?;
        for (h, row) in all.chunks_exact(n).enumerate() {
            let part = &row[first..first + dofs];
            unsafe { x.add(2 * h * dofs).copy_from(part.as_ptr().cast(), 2 * dofs) };
        }
        Ok(Status::Ok)
    })
}

/// Motion of a degree of freedom over one period of the fundamental at a stored point, in the
/// caller's unit of length: entry j at omega t = 2 pi j / n.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// dof    degree of freedom, from 0.
/// n      number of times, 1 .. 2^24.
/// x      receives n doubles; untouched on error.
/// Errors: HBVIB_E_INDEX (point, dof), HBVIB_E_DIMENSION (n), HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_time_history(
    branch: *const hbvib_branch,
    point: i64,
    dof: i64,
    n: i64,
    x: *mut f64,
) -> hbvib_status {
    unsafe { hbvib_branch_time_history_with_hooks(branch, point, dof, n, x, core::ptr::null()) }
}

/// The same as hbvib_branch_time_history; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// dof    degree of freedom, from 0.
/// n      number of times, 1 .. 2^24.
/// x      receives n doubles; untouched on error.
/// hooks  phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_time_history.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_time_history_with_hooks(
    branch: *const hbvib_branch,
    point: i64,
    dof: i64,
    n: i64,
    x: *mut f64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 6) }?;
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        let point = index(point, branch.stored(), 2, "point")?;
        let dof = index(dof, branch.ndof(), 3, "dof")?;
        let n = times(n, 4)?;
        check_pointer(x, 5, "x")?;
        let found = unsafe { with_interrupt(&hooks, |interrupt| branch.time_history_with(point, dof, n, interrupt)) }?;
        unsafe { x.copy_from(found.as_ptr(), found.len()) };
        Ok(Status::Ok)
    })
}

/// Shares of the period that each contact slips at a stored point.
///
/// point       number of a point of the curve, or of a peak, fold or requested solution.
/// shares      receives one double per contact of the model, 0 for one that never slips; may be
///             NULL where there is no contact.
/// shares_len  doubles in it.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_DIMENSION (shares_len), HBVIB_E_NULL, HBVIB_E_HANDLE.
/// Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_slip_fraction(
    branch: *const hbvib_branch,
    point: i64,
    shares: *mut f64,
    shares_len: i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        let point = index(point, branch.stored(), 2, "point")?;
        exact_len(shares_len, branch.contacts(), 4, "the number of contacts")?;
        let found = branch.slip_fraction_at(point).unwrap_or(&[]);
        if !found.is_empty() {
            check_pointer(shares, 3, "shares")?;
            unsafe { shares.copy_from(found.as_ptr(), found.len()) };
        }
        Ok(Status::Ok)
    })
}
