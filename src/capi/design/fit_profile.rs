//! Section "Design studies" of the header: profiles of the likelihood of a fit.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Range, count, disjoint, input, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::design::fit::{all_unknowns, chosen_options, hbvib_fit_options, hbvib_unknown};
use crate::capi::design::fit_data::{Described, hbvib_data};
use crate::capi::design::sensitivities::{all_parameters, hbvib_parameter, loaded, parameter_count};
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, fail};
use crate::model::Model;
use crate::studies::{self, FitProfile, Profiled};

/// Numbers of a profile. Fill it by hbvib_fit_profile_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_fit_profile_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Must be 0.
    pub reserved: i32,
    /// Loss of the fit; chi2 unless it is robust.
    pub best: f64,
    /// Rise of the loss that is one standard deviation: 1, or chi2 over the degrees of freedom with
    /// scale_covariance.
    pub unit: f64,
    /// Lower end of the interval; -infinity where the values do not reach it.
    pub lower: f64,
    /// Upper end; infinity where the values do not reach it.
    pub upper: f64,
    /// Number of values at which a fit was found.
    pub found: i64,
}

unsafe impl VersionedStruct for hbvib_fit_profile_info {
    const NAME: &'static str = "hbvib_fit_profile_info";
    const FIRST_SIZE: usize = 48;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            best: 0.0,
            unit: 1.0,
            lower: 0.0,
            upper: 0.0,
            found: 0,
        }
    }
}

/// Fills the numbers of a profile with zeros, and the unit with 1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_fit_profile_info_init(i: *mut hbvib_fit_profile_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// Least loss of a fit over the values of one parameter, all others fitted again, and the interval
/// that it gives: it holds where the data depend on the parameters so strongly curved that the
/// covariance does not.
///
/// model       the model that was fitted, not the fitted one.
/// solver      options of the fit; NULL: the defaults.
/// options     options of the fit; NULL: the defaults.
/// hooks       as those of a fit, for each value anew; NULL: none. A loss below that of the fit is
///             told by a warning of the log.
/// parameters  array of the parameters of the fit, struct_size of the first apart.
/// count       how many, >= 1.
/// unknowns    array of as many unknowns of the fit, struct_size of the first apart; starts are not
///             used. NULL: the defaults.
/// data        array of the data sets of the fit, struct_size of the first apart.
/// data_len    how many, >= 1.
/// theta       the fitted values, count numbers.
/// number      number of the scanned parameter; those that are tied to it go with it.
/// values_len  how many values, >= 1.
/// values      values of the parameter in ascending order.
/// rise        rise of the loss at the ends of the interval, in units of one standard deviation:
///             3.841 for 95 %, 1 for one deviation; > 0. Between two values the root of the loss
///             is taken for a line.
/// info        receives loss, unit and interval; fill it by hbvib_fit_profile_info_init before.
/// loss        receives the least loss at each value, priors included, values_len numbers; NaN
///             where no fit was found; or NULL.
/// profiled    receives the values of all parameters at each, values_len x count numbers, row after
///             row; NaN where no fit was found; or NULL.
/// HBVIB_STOPPED_BY_CALLER: by progress, with the values so far; by other hooks nothing is written.
/// Errors: HBVIB_E_NO_CONVERGENCE (no solution for all data at theta), and those of hbvib_fit.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_fit_profile(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    options: *const hbvib_fit_options,
    hooks: *const hbvib_hooks,
    parameters: *const hbvib_parameter,
    count: i64,
    unknowns: *const hbvib_unknown,
    data: *const hbvib_data,
    data_len: i64,
    theta: *const f64,
    number: i64,
    values_len: i64,
    values: *const f64,
    rise: f64,
    info: *mut hbvib_fit_profile_info,
    loss: *mut f64,
    profiled: *mut f64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let options = unsafe { chosen_options(options) }?;
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let p = parameter_count(count)?;
        let given = unsafe { loaded(parameters, p) }?;
        let described = unsafe { all_parameters(&given, &model) }?;
        let unknowns = unsafe { all_unknowns(unknowns, p) }?;
        let theta = unsafe { input(theta, p, 10, "theta") }?;
        let number = scanned(number, p)?;
        let values = unsafe { scan(values_len, values) }?;
        if !(rise > 0.0 && rise.is_finite()) {
            return fail!(Argument, "rise = {rise}, needs a finite number > 0").with_argument(14);
        }
        unsafe { check_out(info, 15) }?;
        let read = unsafe { Described::listed(data, data_len, model.ndof()) }?;
        let listed = unsafe { Described::sets(&read, true, 8) }?;
        let n = values.len();
        let room = |to: *mut f64, n: usize| if to.is_null() { 0 } else { n };
        disjoint(
            &[],
            &[
                Range::new(loss, room(loss, n), 16, "loss")?,
                Range::new(profiled, room(profiled, n * p), 17, "profiled")?,
            ],
        )?;
        let of = Profiled { theta, number, values };
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                studies::fit_profile(
                    &model,
                    (&described, &unknowns),
                    &listed,
                    (&solver, &options),
                    &of,
                    hooks,
                )
            })
        }?;
        unsafe {
            for (to, argument, name, from) in [
                (loss, 16, "loss", &found.loss),
                (profiled, 17, "profiled", &found.theta),
            ] {
                if !to.is_null() {
                    output(to, from.len(), argument, name)?.copy_from_slice(from);
                }
            }
            fill_out(info, numbers_of(&found, rise));
        }
        Ok(found.status)
    })
}

fn scanned(number: i64, p: usize) -> Result<usize> {
    match usize::try_from(number) {
        Ok(number) if number < p => Ok(number),
        _ => fail!(Index, "number = {number}, needs 0 .. {}", p - 1).with_argument(11),
    }
}

/// The values of arguments 12 and 13.
///
/// # Safety
/// The caller of the C function states that they lie there.
unsafe fn scan<'a>(len: i64, values: *const f64) -> Result<&'a [f64]> {
    let n = count(len, 12, "values_len")?;
    if n == 0 {
        return fail!(Dimension, "values_len = 0, needs at least one value").with_argument(12);
    }
    unsafe { input(values, n, 13, "values") }
}

fn numbers_of(found: &FitProfile, rise: f64) -> hbvib_fit_profile_info {
    let (lower, upper) = found.interval(rise);
    hbvib_fit_profile_info {
        best: found.best,
        unit: found.unit,
        lower,
        upper,
        found: found.loss.iter().filter(|loss| loss.is_finite()).count() as i64,
        ..hbvib_fit_profile_info::defaults()
    }
}
