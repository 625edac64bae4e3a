//! Section "Design studies" of the header: parameters from data of tests, and predictions with their uncertainty.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Range, check_pointer, disjoint, exact_len, input, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{insert, read};
use crate::capi::crossing::outcome::Outcome;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, check_reserved, fill_out, init, load};
use crate::capi::design::fit_data::{Described, hbvib_data};
use crate::capi::design::sensitivities::{all_parameters, hbvib_parameter, loaded, parameter_count};
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Error, Result, Status, fail, try_push};
use crate::model::Model;
use crate::studies::{self, Fit, FitOptions, Loss, Scale, Suspicion, Unknown};

/// Scale in which an unknown of a fit is changed.
#[repr(C)]
pub enum hbvib_scale {
    /// Logarithm for stiffnesses, friction, loads and factors that start above 0, else the value.
    HBVIB_SCALE_AUTOMATIC = 0,
    /// The value itself.
    HBVIB_SCALE_LINEAR = 1,
    /// Its logarithm: it stays above 0.
    HBVIB_SCALE_LOG = 2,
}

/// Units that data of a fit may have.
#[repr(C)]
pub enum hbvib_suspicion {
    /// Nothing is suspected.
    HBVIB_SUSPICION_NONE = 0,
    /// The responses of the data are a power of ten times those of the model.
    HBVIB_SUSPICION_RESPONSE = 1,
    /// The angular frequencies of the data are too small, or too large, by 2 pi.
    HBVIB_SUSPICION_FREQUENCY = 2,
}

/// A parameter as an unknown of a fit. Fill it by hbvib_unknown_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_unknown {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// A value of enum hbvib_scale.
    pub scale: i32,
    /// First value, if has_start is 1; otherwise that of the model.
    pub start: f64,
    /// Smallest value, if has_lower is 1; equal to the largest one the parameter is fixed.
    pub lower: f64,
    /// Largest value, if has_upper is 1.
    pub upper: f64,
    /// Mean of what is known of it beside the data.
    pub prior_mean: f64,
    /// Its standard deviation; 0: nothing is known.
    pub prior_sigma: f64,
    /// Number of an earlier parameter whose value it follows, in the ratio of their starts; -1: none.
    pub tied_to: i64,
    /// 1: start is given; 0: it is not.
    pub has_start: i32,
    /// 1: lower is given; 0: it is not.
    pub has_lower: i32,
    /// 1: upper is given; 0: it is not.
    pub has_upper: i32,
    /// Must be 0.
    pub reserved: i32,
    /// Number of the data set that alone has it, as each test its residual state; -1: all have it.
    pub data_set: i64,
}

unsafe impl VersionedStruct for hbvib_unknown {
    const NAME: &'static str = "hbvib_unknown";
    const FIRST_SIZE: usize = 80;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            scale: hbvib_scale::HBVIB_SCALE_AUTOMATIC as i32,
            start: 0.0,
            lower: 0.0,
            upper: 0.0,
            prior_mean: 0.0,
            prior_sigma: 0.0,
            tied_to: -1,
            has_start: 0,
            has_lower: 0,
            has_upper: 0,
            reserved: 0,
            data_set: -1,
        }
    }
}

/// Fills an unknown that starts at the value of the model, without bounds and prior.
///
/// u          the struct; untouched on error.
/// size_of_u  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_unknown_init(u: *mut hbvib_unknown, size_of_u: usize) -> hbvib_status {
    call(|| unsafe { init(u, size_of_u) })
}

/// Options of a fit. Fill it by hbvib_fit_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_fit_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 1: the covariance is multiplied by chi2 over the degrees of freedom, where standard deviations
    /// are known up to a factor; 0 (default): it is not.
    pub scale_covariance: i32,
    /// Standard deviations beyond which a residual counts by its magnitude instead of its square
    /// (Huber), 1.345 for example; 0 (default): all count by their squares.
    pub huber: f64,
    /// Points from which the search begins, 1 .. 1000; default 1: the given one, and others where
    /// that fits poorly.
    pub starts: i64,
    /// Largest number of iterations from each, 1 .. 10000; default 60.
    pub max_iterations: i64,
    /// Step in standard deviations at which the search ends; default 1e-6. With 200 numbers of
    /// data and more, as 100 complex points have, it ends at an estimated error of 1e-5, unless
    /// this is smaller than the default.
    pub step: f64,
}

unsafe impl VersionedStruct for hbvib_fit_options {
    const NAME: &'static str = "hbvib_fit_options";
    const FIRST_SIZE: usize = 40;

    fn defaults() -> Self {
        let options = FitOptions::default();
        Self {
            struct_size: 0,
            scale_covariance: 0,
            huber: 0.0,
            starts: options.starts as i64,
            max_iterations: options.max_iterations as i64,
            step: options.step,
        }
    }
}

/// Fills the options of a fit with their defaults.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_fit_options_init(o: *mut hbvib_fit_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Numbers of a fit. Fill it by hbvib_fit_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_fit_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// A value of enum hbvib_suspicion.
    pub suspicion: i32,
    /// Sum of the squares of the residuals of data and priors, in standard deviations.
    pub chi2: f64,
    /// The loss that was minimised: chi2 unless it is robust.
    pub loss: f64,
    /// Number of data and priors minus the number of free unknowns.
    pub degrees_of_freedom: i64,
    /// Number of data, two for a complex amplitude.
    pub data: i64,
    /// Number of free unknowns.
    pub free: i64,
    /// Iterations from the start that led to the result.
    pub iterations: i64,
    /// Starts from which was searched.
    pub starts: i64,
    /// Number of parameters at a bound, whose variance is 0.
    pub at_bound: i64,
    /// Number of contacts that slip at any point of the data.
    pub slipping: i64,
    /// Criterion of Akaike, chi2 + 2 free.
    pub aic: f64,
    /// Criterion of Schwarz, chi2 + free ln data.
    pub bic: f64,
    /// Largest over smallest eigenvalue of the matrix of the fit with unit diagonal.
    pub condition: f64,
    /// Largest estimated error by harmonics over the standard deviation of its datum; NaN where none
    /// was estimated.
    pub harmonic_error: f64,
    /// Responses of the data over those of the model, or the factor that the angular frequencies of
    /// the data need; 1 where nothing is suspected.
    pub suspected_factor: f64,
}

unsafe impl VersionedStruct for hbvib_fit_info {
    const NAME: &'static str = "hbvib_fit_info";
    const FIRST_SIZE: usize = 120;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            suspicion: hbvib_suspicion::HBVIB_SUSPICION_NONE as i32,
            chi2: 0.0,
            loss: 0.0,
            degrees_of_freedom: 0,
            data: 0,
            free: 0,
            iterations: 0,
            starts: 0,
            at_bound: 0,
            slipping: 0,
            aic: 0.0,
            bic: 0.0,
            condition: 0.0,
            harmonic_error: 0.0,
            suspected_factor: 1.0,
        }
    }
}

/// Fills the numbers of a fit with zeros, and the factor with 1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_fit_info_init(i: *mut hbvib_fit_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// Fits parameters of a model to data of tests: the values of least loss, and their covariance.
/// The derivatives of the data by the parameters are exact. Where a set of data is followed
/// through folds, the solution nearest to each datum counts. With a tolerance of the solver it
/// is lowered where errors by harmonics would exceed a third of the standard deviations.
///
/// model          stays as it is.
/// solver         options; NULL: the defaults.
/// options        loss, starts; NULL: the defaults.
/// hooks          progress, called at each iteration with its number in `point`, the loss in
///                `parameter` and the first parameter in `amplitude`; log, phase and
///                cancellation. NULL: none.
/// parameters     array of parameters, struct_size of the first apart. Constants and the speed
///                are values, factors multiply those of the model.
/// count          how many, >= 1.
/// unknowns       array of as many unknowns, struct_size of the first apart; or NULL: the
///                defaults.
/// data           array of data sets, struct_size of the first apart.
/// data_len       how many, >= 1.
/// info           receives the numbers of the fit; fill it by hbvib_fit_info_init before.
/// theta          receives the values of the parameters, count numbers.
/// covariance     receives their covariance, count x count numbers; or NULL.
/// residuals_len  numbers in the next two arrays: twice the number of data points of all sets;
///                0 where both are NULL.
/// residuals      receives the residuals in standard deviations, two for each point, set after
///                set, 0 for a number that is no datum; or NULL.
/// values         receives the numbers of the model, likewise; or NULL.
/// out            receives the model with the values that all data sets have; or NULL. Free it by
///                hbvib_model_free.
/// HBVIB_STOPPED_MAX_POINTS: the iterations did not suffice; HBVIB_STOPPED_STALLED: no step
/// lowers the loss any more; HBVIB_STOPPED_BY_CALLER: by progress, with the best values so far;
/// by other hooks nothing is written. Many data are searched by a share of them first: a fit that
/// is stopped there has the numbers of that share, and residuals and values NaN elsewhere.
/// Errors: HBVIB_E_SINGULAR (the data do not tell the unknowns; the sentence says which and why),
/// HBVIB_E_NO_CONVERGENCE (no solution for all data at the start), HBVIB_E_ARGUMENT,
/// HBVIB_E_NOT_FINITE, HBVIB_E_DIMENSION, HBVIB_E_INDEX, HBVIB_E_UNSUPPORTED (options,
/// unknowns, data, parameters), HBVIB_E_CALLBACK, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_fit(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    options: *const hbvib_fit_options,
    hooks: *const hbvib_hooks,
    parameters: *const hbvib_parameter,
    count: i64,
    unknowns: *const hbvib_unknown,
    data: *const hbvib_data,
    data_len: i64,
    info: *mut hbvib_fit_info,
    theta: *mut f64,
    covariance: *mut f64,
    residuals_len: i64,
    residuals: *mut f64,
    values: *mut f64,
    out: *mut *mut hbvib_model,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let options = unsafe { chosen_options(options) }?;
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let count = parameter_count(count)?;
        let given = unsafe { loaded(parameters, count) }?;
        let described = unsafe { all_parameters(&given, &model) }?;
        let unknowns = unsafe { all_unknowns(unknowns, count) }?;
        let read = unsafe { Described::listed(data, data_len, model.ndof()) }?;
        unsafe { check_out(info, 10) }?;
        check_pointer(theta, 11, "theta")?;
        let listed = unsafe { Described::sets(&read, true, 8) }?;
        let numbers = 2 * listed.iter().map(|set| set.x.len()).sum::<usize>();
        let wanted = if residuals.is_null() && values.is_null() {
            0
        } else {
            numbers
        };
        exact_len(residuals_len, wanted, 13, "residuals_len")?;
        let room = |p: *mut f64, n: usize| if p.is_null() { 0 } else { n };
        disjoint(
            &[],
            &[
                Range::new(theta, count, 11, "theta")?,
                Range::new(covariance, room(covariance, count * count), 12, "covariance")?,
                Range::new(residuals, room(residuals, numbers), 14, "residuals")?,
                Range::new(values, room(values, numbers), 15, "values")?,
            ],
        )?;
        if !out.is_null() {
            check_pointer(out, 16, "out")?;
        }
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                studies::fit(&model, (&described, &unknowns), &listed, &solver, &options, hooks)
            })
        }?;
        unsafe {
            for (p, argument, name, from) in [
                (theta, 11, "theta", &found.theta),
                (covariance, 12, "covariance", &found.covariance),
                (residuals, 14, "residuals", &found.residuals),
                (values, 15, "values", &found.values),
            ] {
                if !p.is_null() {
                    output(p, from.len(), argument, name)?.copy_from_slice(from);
                }
            }
            fill_out(info, numbers_of(&found));
            let status = found.status;
            let early = found.early_end();
            let reason = (!early.is_empty()).then(|| Error::new(status, format_args!("{early}")));
            if !out.is_null() {
                out.write(insert(found.model)?);
            }
            Ok(Outcome { status, reason })
        }
    })
}

/// Predicts numbers of a fitted model with their standard deviations, by the exact derivatives
/// and the covariance of the parameters (delta method).
///
/// model       the model that was fitted, not the fitted one: factors multiply its matrices.
/// solver      options; NULL: the defaults.
/// wanted      a data set without values and sigmas: the kind, x, response, force and range.
/// hooks       log, phase and cancellation; NULL: none.
/// parameters  array of parameters, struct_size of the first apart.
/// count       how many, >= 1.
/// theta       their values, count numbers.
/// covariance  their covariance, count x count numbers.
/// capacity    numbers in the next arrays: twice the number of x.
/// values      receives two numbers for each x, as the value of a data set has them.
/// sigma       receives their standard deviations; or NULL.
/// shift       receives the shift of their means by the second order: where it is not small
///             against sigma, the delta method is not enough; NaN where one standard deviation
///             aside there is no solution; or NULL.
/// Errors: HBVIB_E_NO_CONVERGENCE (no solution at each x), HBVIB_E_DIMENSION, HBVIB_E_ARGUMENT,
/// HBVIB_E_NOT_FINITE, HBVIB_E_INDEX, HBVIB_E_UNSUPPORTED, HBVIB_E_CALLBACK, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; nothing is written
/// then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_predict(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    wanted: *const hbvib_data,
    hooks: *const hbvib_hooks,
    parameters: *const hbvib_parameter,
    count: i64,
    theta: *const f64,
    covariance: *const f64,
    capacity: i64,
    values: *mut f64,
    sigma: *mut f64,
    shift: *mut f64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        check_pointer(wanted, 3, "wanted")?;
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let count = parameter_count(count)?;
        let given = unsafe { loaded(parameters, count) }?;
        let described = unsafe { all_parameters(&given, &model) }?;
        let theta = unsafe { input(theta, count, 7, "theta") }?;
        let covariance = unsafe { input(covariance, count * count, 8, "covariance") }?;
        check_pointer(values, 10, "values")?;
        let read = unsafe { Described::all(wanted, 1, model.ndof(), 3) }?;
        let listed = unsafe { Described::sets(&read, false, 3) }?;
        let numbers = exact_len(capacity, 2 * listed[0].x.len(), 9, "capacity")?;
        let room = |p: *mut f64| if p.is_null() { 0 } else { numbers };
        disjoint(
            &[],
            &[
                Range::new(values, numbers, 10, "values")?,
                Range::new(sigma, room(sigma), 11, "sigma")?,
                Range::new(shift, room(shift), 12, "shift")?,
            ],
        )?;
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                studies::predict(&model, &described, (theta, covariance), &listed[0], &solver, hooks)
            })
        }?;
        for (p, argument, name, from) in [
            (values, 10, "values", &found.values),
            (sigma, 11, "sigma", &found.sigma),
            (shift, 12, "shift", &found.shift),
        ] {
            if !p.is_null() {
                unsafe { output(p, from.len(), argument, name)? }.copy_from_slice(from);
            }
        }
        Ok(Status::Ok)
    })
}

/// The options of argument 3; NULL: the defaults.
///
/// # Safety
/// The caller of the C function states that they lie there.
pub(crate) unsafe fn chosen_options(options: *const hbvib_fit_options) -> Result<FitOptions> {
    let given = if options.is_null() {
        hbvib_fit_options::defaults()
    } else {
        unsafe { load(options, 3) }?
    };
    fit_options(&given).with_argument(3)
}

fn fit_options(o: &hbvib_fit_options) -> Result<FitOptions> {
    if !matches!(o.scale_covariance, 0 | 1) {
        return fail!(Argument, "scale_covariance = {}, needs 0 or 1", o.scale_covariance);
    }
    let whole = |name: &str, value: i64| match usize::try_from(value) {
        Ok(value) => Ok(value),
        Err(_) => fail!(Argument, "{name} = {value}, needs a number >= 1"),
    };
    let options = FitOptions {
        loss: if o.huber == 0.0 {
            Loss::Square
        } else {
            Loss::Huber(o.huber)
        },
        starts: whole("starts", o.starts)?,
        max_iterations: whole("max_iterations", o.max_iterations)?,
        step: o.step,
        scale_covariance: o.scale_covariance == 1,
    };
    options.check()?;
    Ok(options)
}

/// The unknowns of argument 7, whose distance is the size that the first one states; NULL: the
/// defaults.
pub(crate) unsafe fn all_unknowns(p: *const hbvib_unknown, count: usize) -> Result<Vec<Unknown>> {
    let mut list = Vec::new();
    if p.is_null() {
        for _ in 0..count {
            try_push(&mut list, Unknown::default(), "the unknowns")?;
        }
        return Ok(list);
    }
    check_pointer(p, 7, "unknowns")?;
    let distance = unsafe { p.cast::<u32>().read() } as usize;
    for i in 0..count {
        let one = unsafe { p.byte_add(i * distance) };
        let read = unsafe { load(one, 7) }.map_err(|e| e.at(format_args!("unknowns[{i}]")).in_argument(7))?;
        if read.struct_size as usize != distance {
            return fail!(
                StructSize,
                "unknowns[{i}]: struct_size = {}, but that of the first is {distance}",
                read.struct_size
            )
            .with_argument(7);
        }
        let unknown = unknown(&read).map_err(|e| e.at(format_args!("unknowns[{i}]")).in_argument(7))?;
        try_push(&mut list, unknown, "the unknowns")?;
    }
    Ok(list)
}

fn unknown(u: &hbvib_unknown) -> Result<Unknown> {
    const AUTOMATIC: i32 = hbvib_scale::HBVIB_SCALE_AUTOMATIC as i32;
    const LINEAR: i32 = hbvib_scale::HBVIB_SCALE_LINEAR as i32;
    const LOG: i32 = hbvib_scale::HBVIB_SCALE_LOG as i32;
    check_reserved(u.reserved, 7, "hbvib_unknown")?;
    let flag = |name: &str, flag: i32, value: f64| match flag {
        0 => Ok(None),
        1 => Ok(Some(value)),
        _ => fail!(Argument, "{name} = {flag}, needs 0 or 1"),
    };
    if !u.prior_sigma.is_finite() || u.prior_sigma < 0.0 {
        return fail!(Argument, "prior_sigma = {}, needs a finite number >= 0", u.prior_sigma);
    }
    Ok(Unknown {
        start: flag("has_start", u.has_start, u.start)?,
        lower: flag("has_lower", u.has_lower, u.lower)?,
        upper: flag("has_upper", u.has_upper, u.upper)?,
        prior: (u.prior_sigma > 0.0).then_some((u.prior_mean, u.prior_sigma)),
        scale: match u.scale {
            AUTOMATIC => Scale::Automatic,
            LINEAR => Scale::Linear,
            LOG => Scale::Log,
            other => {
                return fail!(
                    Argument,
                    "scale = {other}, needs HBVIB_SCALE_AUTOMATIC = 0 .. HBVIB_SCALE_LOG = 2"
                );
            }
        },
        tied_to: match u.tied_to {
            -1 => None,
            other => match usize::try_from(other) {
                Ok(number) => Some(number),
                Err(_) => return fail!(Argument, "tied_to = {other}, needs the number of a parameter, or -1"),
            },
        },
        data_set: match u.data_set {
            -1 => None,
            other => match usize::try_from(other) {
                Ok(number) => Some(number),
                Err(_) => return fail!(Argument, "data_set = {other}, needs the number of a data set, or -1"),
            },
        },
    })
}

fn numbers_of(found: &Fit) -> hbvib_fit_info {
    use hbvib_suspicion as s;
    let (suspicion, factor) = match found.suspicion {
        Suspicion::None => (s::HBVIB_SUSPICION_NONE, 1.0),
        Suspicion::Response(factor) => (s::HBVIB_SUSPICION_RESPONSE, factor),
        Suspicion::Frequency(factor) => (s::HBVIB_SUSPICION_FREQUENCY, factor),
    };
    let count = |flags: &[bool]| flags.iter().filter(|flag| **flag).count() as i64;
    hbvib_fit_info {
        suspicion: suspicion as i32,
        chi2: found.chi2,
        loss: found.loss,
        degrees_of_freedom: found.degrees_of_freedom,
        data: found.data as i64,
        free: found.free as i64,
        iterations: found.iterations as i64,
        starts: found.starts as i64,
        at_bound: count(&found.at_bound),
        slipping: count(&found.slips),
        aic: found.aic(),
        bic: found.bic(),
        condition: found.condition,
        harmonic_error: found.harmonic_error,
        suspected_factor: factor,
        ..hbvib_fit_info::defaults()
    }
}
