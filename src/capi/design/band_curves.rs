//! Section "Design studies" of the header: the lower and the upper curve of a response.

#![allow(non_camel_case_types)]

use crate::analysis::{self, BandOptions, BandPoint};
use crate::capi::crossing::arrays::{Column, Entry, check_pointer, count as length, fill_list, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::indices;
use crate::capi::design::band::{band_options, hbvib_band_options};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::model::Model;

/// The lower and the upper curve of a forced response: the band of the amplitude (hbvib_band) at
/// points of a branch, in their order.
///
/// model       the model of which the branch is a result, unchanged since.
/// points_len  number of points; 0: all points of the curve.
/// points      numbers of points of the curve, or of peaks, folds or requested solutions; NULL with
///             0.
/// solver      options; NULL: the defaults. Harmonics and tolerance have no effect.
/// options     the amplitude and what is free; NULL: the defaults.
/// hooks       log, phase and cancellation; NULL: none.
/// capacity    numbers that fit into each array: at least points_len, or all points of the curve.
/// omega       receives the angular frequencies, or NULL.
/// lower       receives the least amplitudes found, or NULL.
/// upper       receives the largest ones, or NULL.
/// sliders     receives numbers of free sliders, 0 where there is no band; or NULL.
/// complete    receives numbers, 1 where one slider was followed to both of its limits, or each
///             search ended at an extremum, else 0; or NULL.
/// count       receives how many points there are, also when `capacity` is too small.
/// Errors: those of hbvib_band, naming the point; HBVIB_E_DIMENSION (capacity too small: the arrays
/// are untouched). HBVIB_STOPPED_BY_CALLER: nothing is written. Threads: any number on one model
/// and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_band_curve(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    points_len: i64,
    points: *const i64,
    solver: *const hbvib_solver_options,
    options: *const hbvib_band_options,
    hooks: *const hbvib_hooks,
    capacity: i64,
    omega: *mut f64,
    lower: *mut f64,
    upper: *mut f64,
    sliders: *mut i64,
    complete: *mut i64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let points_len = length(points_len, 3, "points_len")?;
        let points = unsafe { input(points, points_len, 4, "points") }?;
        let points = indices(points, kept.branch.stored(), 4, "points")?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let (of, free, starts) = unsafe { band_options(options, model.contacts().len(), 6) }?;
        let options = BandOptions {
            of,
            contacts: &free,
            starts,
        };
        let hooks = unsafe { load_hooks(hooks, 7) }?;
        check_pointer(count, 14, "count")?;
        let columns = [
            Column::Reals(omega, 9, "omega"),
            Column::Reals(lower, 10, "lower"),
            Column::Reals(upper, 11, "upper"),
            Column::Numbers(sliders, 12, "sliders"),
            Column::Numbers(complete, 13, "complete"),
        ];
        // A list that does not fit is refused before it is computed.
        let expected = if points.is_empty() {
            kept.branch.omega().len()
        } else {
            points.len()
        };
        let wanted = [omega, lower, upper].iter().any(|p| !p.is_null()) || !(sliders.is_null() && complete.is_null());
        if wanted && length(capacity, 8, "capacity")? < expected {
            unsafe { count.write(expected as i64) };
            return fail!(Dimension, "capacity = {capacity}, needs {expected}").with_argument(8);
        }
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                analysis::band_curve(&model, &kept.branch, &points, &solver, &options, hooks)
            })
        };
        let found = found.map_err(|e| match e.status {
            Status::Argument | Status::Index if e.argument == 0 => e.in_argument(6),
            _ => e,
        })?;
        let row = |one: &BandPoint| {
            [
                Entry::Real(one.omega),
                Entry::Real(one.lower),
                Entry::Real(one.upper),
                Entry::Number(one.sliders as i64),
                Entry::Number(i64::from(one.is_complete)),
            ]
        };
        unsafe { fill_list(&columns, found.iter().map(row), (capacity, 8), (count, 14)) }
    })
}
