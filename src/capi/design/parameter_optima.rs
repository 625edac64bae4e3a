//! Section "Design studies" of the header: optima, turns and higher peaks of a result over a parameter.

use crate::capi::crossing::arrays::{Column, Entry, fill_list};
use crate::capi::crossing::boundary::call;
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::version_and_errors::hbvib_status;
use crate::results::{HigherPeak, Optimum, Turn};

/// Minima and maxima of the result over the parameter, refined on the solution, in the order of
/// the branch. Other branches have none.
///
/// capacity   numbers that fit into each array.
/// parameter  receives the values of the parameter, or NULL.
/// amplitude  receives the amplitudes, of a mode the damping ratios, or NULL.
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
        let columns = [
            Column::Reals(parameter, 3, "parameter"),
            Column::Reals(amplitude, 4, "amplitude"),
            Column::Numbers(maximum, 5, "maximum"),
            Column::Numbers(point, 6, "point"),
        ];
        let row = |o: &Optimum| {
            [
                Entry::Real(o.parameter),
                Entry::Real(o.amplitude),
                Entry::Number(i64::from(o.is_maximum)),
                Entry::Number(o.point as i64),
            ]
        };
        let found = kept.branch.optima();
        unsafe { fill_list(&columns, found.iter().map(row), (capacity, 2), (count, 7)) }
    })
}

/// Points at which a branch over a parameter turns, refined: beyond their values the result does
/// not exist. Over the force those with HBVIB_FOLLOW_PEAK_THROUGH_FOLDS are the forces at which a
/// detached curve is born (a minimum) or merges with another one (a maximum). A fold turns there,
/// too, and in a cusp. Other branches have none.
///
/// capacity   numbers that fit into each array.
/// parameter  receives the values of the parameter, or NULL.
/// omega      receives the angular frequencies, or NULL.
/// amplitude  receives the amplitudes, or NULL.
/// maximum    receives numbers: 1 where the parameter is largest, 0 where smallest; or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, numbers, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_turns(
    branch: *const hbvib_branch,
    capacity: i64,
    parameter: *mut f64,
    omega: *mut f64,
    amplitude: *mut f64,
    maximum: *mut i64,
    point: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let columns = [
            Column::Reals(parameter, 3, "parameter"),
            Column::Reals(omega, 4, "omega"),
            Column::Reals(amplitude, 5, "amplitude"),
            Column::Numbers(maximum, 6, "maximum"),
            Column::Numbers(point, 7, "point"),
        ];
        let row = |turn: &Turn| {
            [
                Entry::Real(turn.parameter),
                Entry::Real(turn.omega),
                Entry::Real(turn.amplitude),
                Entry::Number(i64::from(turn.is_maximum)),
                Entry::Number(turn.point as i64),
            ]
        };
        let found = kept.branch.turns();
        unsafe { fill_list(&columns, found.iter().map(row), (capacity, 2), (count, 8)) }
    })
}

/// Peaks that are higher than the followed one. At the first and the last point of the curve and
/// at the optima the response is swept over a tenth of the frequency below and above the followed
/// peak; a sweep that fails shows none. Other branches have none.
///
/// capacity   numbers that fit into each array.
/// parameter  receives the values of the parameter, or NULL.
/// omega      receives the angular frequencies of the higher peaks, or NULL.
/// amplitude  receives their amplitudes, or NULL.
/// point      receives the point numbers of the followed peak, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_branch_higher_peaks(
    branch: *const hbvib_branch,
    capacity: i64,
    parameter: *mut f64,
    omega: *mut f64,
    amplitude: *mut f64,
    point: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let kept = read::<KeptBranch>(branch, 1)?;
        let columns = [
            Column::Reals(parameter, 3, "parameter"),
            Column::Reals(omega, 4, "omega"),
            Column::Reals(amplitude, 5, "amplitude"),
            Column::Numbers(point, 6, "point"),
        ];
        let row = |peak: &HigherPeak| {
            [
                Entry::Real(peak.parameter),
                Entry::Real(peak.omega),
                Entry::Real(peak.amplitude),
                Entry::Number(peak.point as i64),
            ]
        };
        let found = kept.branch.higher_peaks();
        unsafe { fill_list(&columns, found.iter().map(row), (capacity, 2), (count, 7)) }
    })
}
