//! What a branch tells.

use super::boundary::{Blame, call, call_count, check_pointer, index};
use super::contact::exact_len;
use super::handles::{KeptBranch, free, read};
use super::sized::{Described, check_out, fill_out, init};
use super::told::Told;
use super::types::{hbvib_branch, hbvib_field, hbvib_scalar, hbvib_status, hbvib_view};
use crate::error::{Status, fail, try_vec};
use crate::results::mode_branch::ModeField;
use core::ptr;
use num_complex::Complex64;

/// What was removed from the problem before it was solved. Fill it by hbvib_reduction_init.
#[repr(C)]
#[derive(Clone, Copy)]
#[allow(non_camel_case_types)]
pub struct hbvib_reduction {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 0.
    pub reserved: i32,
    /// Sectors of the wheel; all but one are removed.
    pub sectors: i64,
    /// Degrees of freedom of one sector.
    pub degrees_of_freedom: i64,
    /// Relative contact coordinates that remain of them.
    pub coordinates: i64,
    /// Contacts in the model.
    pub contacts: i64,
    /// Contacts that became linear springs (infinite slip limit, no cubic term).
    pub never_slipping: i64,
    /// Contacts without force (no stiffness, or no slip limit).
    pub inert: i64,
    /// Highest harmonic number H of which the points tell: that asked for or, where the tolerance decided, the
    /// highest that one of them carries.
    pub harmonics_asked: i64,
    /// Number of harmonics carried, where most are.
    pub harmonics_carried: i64,
    /// Real unknowns of the nonlinear problem, where there are most.
    pub unknowns: i64,
    /// The degree of freedom whose amplitude was followed.
    pub response_dof: i64,
    /// 1 if the mean is carried, else 0.
    pub mean_carried: i32,
    /// 1 if even harmonics were left out because law and forcing are odd, else 0.
    pub even_removed: i32,
    /// Rigid-body modes of the mean motion that contacts alone hold; 0 where the mean is not carried.
    pub held_by_contacts: i64,
}

unsafe impl Described for hbvib_view {
    const NAME: &'static str = "hbvib_view";
    const FIRST: usize = 72;

    fn filled() -> Self {
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

unsafe impl Described for hbvib_reduction {
    const NAME: &'static str = "hbvib_reduction";
    const FIRST: usize = 96;

    fn filled() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            sectors: 0,
            degrees_of_freedom: 0,
            coordinates: 0,
            contacts: 0,
            never_slipping: 0,
            inert: 0,
            harmonics_asked: 0,
            harmonics_carried: 0,
            unknowns: 0,
            response_dof: 0,
            mean_carried: 0,
            even_removed: 0,
            held_by_contacts: 0,
        }
    }
}

/// Fills a view with nothing in it.
///
/// v          the struct; untouched on error.
/// size_of_v  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_view_init(v: *mut hbvib_view, size_of_v: usize) -> hbvib_status {
    call(|| unsafe { init(v, size_of_v) })
}

/// Fills a reduction with zeros.
///
/// r          the struct; untouched on error.
/// size_of_r  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_reduction_init(r: *mut hbvib_reduction, size_of_r: usize) -> hbvib_status {
    call(|| unsafe { init(r, size_of_r) })
}

/// Frees a branch and ends its views. NULL is nothing to free and a success.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_BUSY. Threads: any, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_free(branch: *mut hbvib_branch) -> hbvib_status {
    call(|| free::<KeptBranch>(branch, 1).map(|()| Status::Ok))
}

/// Number of points on the curve, or a negative status. Peaks, folds and the solutions wanted at
/// given frequencies or amplitudes are stored beside the curve and carry the numbers from there on.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_points(branch: *const hbvib_branch) -> i64 {
    call_count(|| Ok(read::<KeptBranch>(branch, 1)?.branch.points()))
}

/// Number of all stored points, those beside the curve included: point numbers are below it. Or a
/// negative status.
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
    call(|| Ok(Told::from(&read::<KeptBranch>(branch, 1)?.branch)))
}

/// Borrows the values of a field at the points of the curve, in the order in which it was followed.
///
/// field  HBVIB_OMEGA and so on (enum hbvib_field): one double per point, but HBVIB_SLIP_FRACTION
///        points x contacts, a contact that sticks throughout being 0. A forced response has none of
///        the fields that belong to nonlinear modes.
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
    const OMEGA: i32 = hbvib_field::HBVIB_OMEGA as i32;
    const AMPLITUDE: i32 = hbvib_field::HBVIB_AMPLITUDE as i32;
    const RESIDUAL: i32 = hbvib_field::HBVIB_RESIDUAL as i32;
    const NEWTON_ITERATIONS: i32 = hbvib_field::HBVIB_NEWTON_ITERATIONS as i32;
    const HARMONICS_USED: i32 = hbvib_field::HBVIB_HARMONICS_USED as i32;
    const SAMPLING_ERROR: i32 = hbvib_field::HBVIB_SAMPLING_ERROR as i32;
    const ERROR_ESTIMATE: i32 = hbvib_field::HBVIB_ERROR_ESTIMATE as i32;
    const DAMPING_ERROR: i32 = hbvib_field::HBVIB_DAMPING_ERROR_ESTIMATE as i32;
    const SLIP_FRACTION: i32 = hbvib_field::HBVIB_SLIP_FRACTION as i32;
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        unsafe { check_out(out, 3) }?;
        let points = branch.points() as i64;
        let contacts = branch.contacts() as i64;
        let data = match field {
            OMEGA => branch.omega(),
            AMPLITUDE => branch.amplitude(),
            RESIDUAL => branch.residual(),
            NEWTON_ITERATIONS => branch.newton_iterations(),
            HARMONICS_USED => branch.harmonics_used(),
            SAMPLING_ERROR => branch.sampling_error(),
            ERROR_ESTIMATE => branch.error_estimate(),
            DAMPING_ERROR if branch.mode().is_some() => branch.damping_error_estimate(),
            DAMPING_ERROR => return fail!(Argument, "field = {field}: only a nonlinear mode has it").blame(2),
            SLIP_FRACTION => branch.slip_fraction(),
            _ => match mode_field(field).map(|f| branch.mode_field(f)) {
                Some(Some(data)) => data,
                Some(None) => return fail!(Argument, "field = {field}: only a nonlinear mode has it").blame(2),
                None => return fail!(Argument, "field = {field}, needs a value of enum hbvib_field").blame(2),
            },
        };
        let mut view = hbvib_view {
            rank: 1,
            data: if data.is_empty() { ptr::null() } else { data.as_ptr() },
            shape: [points, 1, 1],
            ..hbvib_view::filled()
        };
        if field == SLIP_FRACTION {
            view.rank = 2;
            view.shape[1] = contacts;
            view.stride[0] = contacts;
        }
        unsafe { fill_out(out, view) };
        Ok(Status::Ok)
    })
}

/// The fields that only nonlinear modes have.
fn mode_field(field: i32) -> Option<ModeField> {
    [
        (hbvib_field::HBVIB_DAMPING_RATIO, ModeField::DampingRatio),
        (hbvib_field::HBVIB_ENERGY, ModeField::Energy),
        (hbvib_field::HBVIB_DISSIPATION, ModeField::FrictionLoss),
        (hbvib_field::HBVIB_LOG10_AMPLITUDE, ModeField::Log10Amplitude),
        (hbvib_field::HBVIB_MODAL_AMPLITUDE, ModeField::ModalAmplitude),
        (hbvib_field::HBVIB_STRUCTURAL_LOSS, ModeField::StructuralLoss),
        (hbvib_field::HBVIB_MODAL_ASSURANCE, ModeField::Assurance),
    ]
    .into_iter()
    .find_map(|(constant, known)| (constant as i32 == field).then_some(known))
}

/// Recovers harmonics 0 .. H of a range of degrees of freedom at a stored point, in the caller's
/// unit of length. H is harmonics_asked of hbvib_branch_reduction; harmonics that are not carried are zero.
///
/// point      number of a point of the curve, or of a peak, fold or solution wanted.
/// first_dof  first degree of freedom of the range, from 0.
/// n_dof      number of them, at least 1.
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
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let branch = &kept.branch;
        let n = branch.ndof();
        let point = index(point, branch.stored(), 2, "point")?;
        let first = index(first_dof, n, 3, "first_dof")?;
        let dofs = usize::try_from(n_dof).unwrap_or(0);
        if dofs == 0 || dofs > n - first {
            return fail!(Dimension, "n_dof = {n_dof}, needs 1 .. {}", n - first).blame(4);
        }
        check_pointer(x, 5, "x")?;
        let rows = branch.harmonics() + 1;
        exact_len(x_len, rows.saturating_mul(dofs), 6, "(harmonics + 1) * n_dof")?;
        let mut all = try_vec(rows.saturating_mul(n), Complex64::ZERO, "the harmonics")?;
        branch.harmonics_at(point, &mut all)?;
        for (h, row) in all.chunks_exact(n).enumerate() {
            let part = &row[first..first + dofs];
            unsafe { x.add(2 * h * dofs).copy_from(part.as_ptr().cast(), 2 * dofs) };
        }
        Ok(Status::Ok)
    })
}

/// Shares of the period that each contact slips at a stored point.
///
/// point       number of a point of the curve, or of a peak, fold or solution wanted.
/// shares      receives one double per contact of the model, 0 for one that sticks throughout;
///             NULL is allowed where there is no contact.
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

/// What was removed from the problem before it was solved, and which degree of freedom was
/// followed.
///
/// out  receives the numbers; fill it by hbvib_reduction_init before; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_reduction(
    branch: *const hbvib_branch,
    out: *mut hbvib_reduction,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        unsafe { check_out(out, 2) }?;
        let r = kept.branch.reduction();
        let value = hbvib_reduction {
            sectors: r.sectors as i64,
            degrees_of_freedom: r.degrees_of_freedom as i64,
            coordinates: r.coordinates as i64,
            contacts: r.contacts as i64,
            never_slipping: r.never_slipping as i64,
            inert: r.inert as i64,
            harmonics_asked: r.harmonics_asked as i64,
            harmonics_carried: r.harmonics_carried as i64,
            unknowns: r.unknowns as i64,
            response_dof: kept.branch.response_dof() as i64,
            mean_carried: i32::from(r.mean_carried),
            even_removed: i32::from(r.even_removed),
            held_by_contacts: r.held_by_contacts as i64,
            ..hbvib_reduction::filled()
        };
        unsafe { fill_out(out, value) };
        Ok(Status::Ok)
    })
}
