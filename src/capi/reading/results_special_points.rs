//! Section "Results" of the header: peaks, folds and requested solutions, which a branch stores beside
//! its curve.

use crate::capi::crossing::arrays::{Column, Entry, fill_list};
use crate::capi::crossing::boundary::call;
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::index;
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status};
use crate::results::Special;
use core::ptr;

/// Maxima of the amplitude of the response degree of freedom within the range; in a nonlinear mode
/// the points of largest damping ratio. Refined on the solution, in the order of the branch.
///
/// capacity   numbers that fit into each array.
/// omega      receives their angular frequencies, or NULL.
/// amplitude  receives their amplitudes, or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_peaks(
    branch: *const hbvib_branch,
    capacity: i64,
    omega: *mut f64,
    amplitude: *mut f64,
    point: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let lists = Lists::after_capacity(omega, amplitude, point, count);
        unsafe { lists.fill(kept.branch.peaks(), (capacity, 2)) }
    })
}

/// Turning points in frequency, in a nonlinear mode in amplitude, refined on the solution, in the
/// order of the branch.
///
/// Arguments, errors and threads as for hbvib_branch_peaks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_folds(
    branch: *const hbvib_branch,
    capacity: i64,
    omega: *mut f64,
    amplitude: *mut f64,
    point: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let lists = Lists::after_capacity(omega, amplitude, point, count);
        unsafe { lists.fill(kept.branch.folds(), (capacity, 2)) }
    })
}

/// Every solution that was found at one of the frequencies in hbvib_forced_options.at, or of the
/// amplitudes in hbvib_mode_options.at.
///
/// wanted     index into `at`, from 0.
/// capacity   numbers that fit into each array.
/// amplitude  receives their amplitudes, or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, or NULL.
/// count      receives how many there are, as for hbvib_branch_peaks; several where the branch is
///            folded, none where it ended before.
/// Errors: HBVIB_E_INDEX (wanted), else as for hbvib_branch_peaks. Threads: any number on one
/// branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_at(
    branch: *const hbvib_branch,
    wanted: i64,
    capacity: i64,
    amplitude: *mut f64,
    point: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let wanted = index(wanted, kept.requested, 2, "wanted")?;
        let lists = Lists {
            omega: (ptr::null_mut(), 0),
            amplitude: (amplitude, 4),
            point: (point, 5),
            count: (count, 6),
        };
        unsafe { lists.fill(kept.branch.at(wanted), (capacity, 3)) }
    })
}

/// Output arrays for special points, each optional, with the numbers of their arguments.
pub(crate) struct Lists {
    pub(crate) omega: (*mut f64, i32),
    pub(crate) amplitude: (*mut f64, i32),
    pub(crate) point: (*mut i64, i32),
    pub(crate) count: (*mut i64, i32),
}

impl Lists {
    /// The arrays of a function whose arguments begin with a branch and a capacity.
    fn after_capacity(omega: *mut f64, amplitude: *mut f64, point: *mut i64, count: *mut i64) -> Self {
        Self {
            omega: (omega, 3),
            amplitude: (amplitude, 4),
            point: (point, 5),
            count: (count, 6),
        }
    }

    /// Writes the special points if `capacity`, the argument of the given number, suffices.
    ///
    /// # Safety
    /// The caller of the C function states that `capacity` values fit into each array.
    pub(crate) unsafe fn fill(&self, specials: &[Special], capacity: (i64, i32)) -> Result<Status> {
        let columns = [
            Column::Reals(self.omega.0, self.omega.1, "omega"),
            Column::Reals(self.amplitude.0, self.amplitude.1, "amplitude"),
            Column::Numbers(self.point.0, self.point.1, "point"),
        ];
        let row = |s: &Special| {
            [
                Entry::Real(s.omega),
                Entry::Real(s.amplitude),
                Entry::Number(s.point as i64),
            ]
        };
        unsafe { fill_list(&columns, specials.iter().map(row), capacity, self.count) }
    }
}
