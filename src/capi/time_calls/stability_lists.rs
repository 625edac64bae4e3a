//! Section "Stability" of the header: bifurcations of forced responses, and limit cycles of nonlinear modes.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Column, Entry, fill_list};
use crate::capi::crossing::boundary::call;
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::version_and_errors::hbvib_status;
use crate::results::{Bifurcation, BifurcationKind, LimitCycle};

/// Kinds of bifurcations.
#[repr(C)]
pub enum hbvib_bifurcation {
    /// The branch turns in frequency; a multiplier passes 1.
    HBVIB_BIFURCATION_FOLD = 0,
    /// A multiplier passes -1: a motion of twice the period branches off.
    HBVIB_BIFURCATION_PERIOD_DOUBLING = 1,
    /// A pair of conjugate multipliers passes the unit circle: a motion with a second frequency
    /// branches off.
    HBVIB_BIFURCATION_NEIMARK_SACKER = 2,
    /// A multiplier passes 1 where the branch does not turn: another motion of the same period
    /// branches off.
    HBVIB_BIFURCATION_BRANCH_POINT = 3,
}

/// Bifurcations of a forced response in the order of the branch: its folds and, with the solver
/// option `stability`, the points where a Floquet multiplier passes the unit circle, located on the
/// branch. A multiplier that jumps over the circle, as where slip sets in, is none of these kinds:
/// HBVIB_UNSTABLE_DIRECTIONS then changes without a bifurcation. A nonlinear mode has the branch
/// points of its curve, with the option `branches` of hbvib_mode_options.
///
/// capacity         numbers that fit into each array.
/// omega            receives their angular frequencies, or NULL.
/// amplitude        receives their amplitudes, or NULL.
/// kind             receives their kinds, numbers of hbvib_bifurcation, or NULL.
/// point            receives their point numbers for hbvib_floquet and others, numbers, or NULL.
/// unstable_before  receives the numbers of unstable directions before them along the branch, -1
///                  where unknown, numbers, or NULL.
/// unstable_after   receives the numbers after them, or NULL.
/// count            receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_bifurcations(
    branch: *const hbvib_branch,
    capacity: i64,
    omega: *mut f64,
    amplitude: *mut f64,
    kind: *mut i64,
    point: *mut i64,
    unstable_before: *mut i64,
    unstable_after: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let found = kept.branch.bifurcations()?;
        let columns = [
            Column::Reals(omega, 3, "omega"),
            Column::Reals(amplitude, 4, "amplitude"),
            Column::Numbers(kind, 5, "kind"),
            Column::Numbers(point, 6, "point"),
            Column::Numbers(unstable_before, 7, "unstable_before"),
            Column::Numbers(unstable_after, 8, "unstable_after"),
        ];
        let row = |b: &Bifurcation| {
            let number = |count: Option<usize>| Entry::Number(count.map_or(-1, |count| count as i64));
            [
                Entry::Real(b.omega),
                Entry::Real(b.amplitude),
                Entry::Number(kind_number(b.kind)),
                Entry::Number(b.point as i64),
                number(b.unstable[0]),
                number(b.unstable[1]),
            ]
        };
        unsafe { fill_list(&columns, found.iter().map(row), (capacity, 2), (count, 9)) }
    })
}

pub(crate) fn kind_number(kind: BifurcationKind) -> i64 {
    use hbvib_bifurcation as b;
    let kind = match kind {
        BifurcationKind::Fold => b::HBVIB_BIFURCATION_FOLD,
        BifurcationKind::PeriodDoubling => b::HBVIB_BIFURCATION_PERIOD_DOUBLING,
        BifurcationKind::NeimarkSacker => b::HBVIB_BIFURCATION_NEIMARK_SACKER,
        BifurcationKind::BranchPoint => b::HBVIB_BIFURCATION_BRANCH_POINT,
    };
    kind as i64
}

/// Limit cycles on a nonlinear mode, where its damping ratio is zero: periodic motions of the model
/// without forces. Refined on the solution, in the order of the branch. hbvib_floquet tells whether
/// one is stable; with a negative slope it is not.
///
/// capacity         numbers that fit into each array.
/// omega            receives their angular frequencies, or NULL.
/// log10_amplitude  receives log10 of their amplitudes, the parameter of the mode, or NULL.
/// slope            receives the derivatives of the damping ratio by log10 of the amplitude, or
///                  NULL.
/// point            receives their point numbers for hbvib_floquet and others, numbers, or NULL.
/// count            receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned. A forced response has none.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_limit_cycles(
    branch: *const hbvib_branch,
    capacity: i64,
    omega: *mut f64,
    log10_amplitude: *mut f64,
    slope: *mut f64,
    point: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let found = kept.branch.limit_cycles()?;
        let columns = [
            Column::Reals(omega, 3, "omega"),
            Column::Reals(log10_amplitude, 4, "log10_amplitude"),
            Column::Reals(slope, 5, "slope"),
            Column::Numbers(point, 6, "point"),
        ];
        let row = |cycle: &LimitCycle| {
            [
                Entry::Real(cycle.omega),
                Entry::Real(cycle.log10_amplitude),
                Entry::Real(cycle.slope),
                Entry::Number(cycle.point as i64),
            ]
        };
        unsafe { fill_list(&columns, found.iter().map(row), (capacity, 2), (count, 7)) }
    })
}
