//! Section "Design studies" of the header: the peaks of many designs.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{Range, check_pointer, count, disjoint, input, output};
use crate::capi::crossing::boundary::{WithArgument, call, call_count, call_to_free, within};
use crate::capi::crossing::branch_tree::insert_tree;
use crate::capi::crossing::handles::{Kept, Object, free, insert, read, write};
use crate::capi::crossing::indices::index;
use crate::capi::crossing::outcome::Outcome;
use crate::capi::crossing::thread_start::together;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_reserved, init, load};
use crate::capi::design::sensitivities::{all_parameters, hbvib_parameter, loaded, parameter_count};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::solving::solve_responses::{Watched, hbvib_response};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;
use crate::options::{BatchOptions, MOST_THREADS, Response, check_responses};
use crate::studies::DesignPeak;
use crate::studies::batch::{Batch, Surroundings, batch_within};

/// The peaks of many designs, created by hbvib_batch_solve.
pub struct hbvib_batch(());

impl Kept for Batch {
    type Opaque = hbvib_batch;
    const TAG: u64 = 3;
    const NAME: &'static str = "batch";

    fn wrap(object: Vec<Self>) -> Object {
        Object::Batch(object)
    }

    fn pick(object: &mut Object) -> Option<*mut Self> {
        match object {
            Object::Batch(one) => Some(one.as_mut_ptr()),
            _ => None,
        }
    }

    fn holds(object: &Object) -> bool {
        matches!(object, Object::Batch(_))
    }
}

/// Options of hbvib_batch_solve. Fill it by hbvib_batch_options_init, then set the range.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_batch_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Threads, the calling one included, 1 .. 1024; default 1. Their number changes no bit of a
    /// result.
    pub threads: i32,
    /// First angular frequency of each response, > 0, rad per time unit.
    pub omega_start: f64,
    /// Last angular frequency: below the first for downward sweeps.
    pub omega_stop: f64,
    /// 1: the branch of each design is kept, for hbvib_batch_branch; 0 (default): it is not, and the
    /// solver options estimate_error, stability and freedom have no effect.
    pub keep: i32,
    /// Must be 0.
    pub reserved: i32,
    /// Array of the responses that are watched, struct_size of the first apart, or NULL: the
    /// amplitude of the response degree of freedom. The first leads the peak of a design, and each
    /// has its own: hbvib_batch_response_peaks.
    pub responses: *const hbvib_response,
    /// Number of responses.
    pub responses_len: i64,
}

unsafe impl VersionedStruct for hbvib_batch_options {
    const NAME: &'static str = "hbvib_batch_options";
    const FIRST_SIZE: usize = 32;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            threads: 1,
            omega_start: 0.0,
            omega_stop: 0.0,
            keep: 0,
            reserved: 0,
            responses: core::ptr::null(),
            responses_len: 0,
        }
    }
}

/// Fills the options of a batch: one thread, no branch kept. The frequencies must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_options_init(o: *mut hbvib_batch_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Finds the highest peak of the response of each design within a range of frequency. A design is
/// the model with values of its parameters: constants of contacts and the speed are set, factors
/// multiply, and directions are added times the value, after the factors wherever they stand in the
/// list. Each design is solved by itself, so that its result depends on no other, on their order or
/// on the number of threads. Designs that change constants of contacts and forces alone share the
/// structure of the model.
///
/// model       stays as it is.
/// solver      options; NULL: the defaults. A fixed response_dof makes peaks comparable.
/// options     range of frequency, threads.
/// hooks       progress, called after each design that the calling thread has solved, with the
///             number of designs done in `point` and the peak in `parameter` and `amplitude`; phase
///             and cancellation. All callbacks run on the calling thread. NULL: none.
/// parameters  array of parameters, struct_size of the first apart.
/// count       how many, >= 1.
/// designs     number of designs, >= 0.
/// values      values of the parameters, designs x count, design after design.
/// out         receives the batch; untouched on error. Free it by hbvib_batch_free.
/// A design that fails has a status of its own and NaN for its peak; the others are solved.
/// HBVIB_STOPPED_BY_CALLER: designs that were not solved have that status.
/// Errors: HBVIB_E_INDEX, HBVIB_E_UNSUPPORTED (a parameter that the model does not have; several
/// threads for a model with a force of the caller), HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE (options),
/// HBVIB_E_DIMENSION, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_batch_solve(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    options: *const hbvib_batch_options,
    hooks: *const hbvib_hooks,
    parameters: *const hbvib_parameter,
    count: i64,
    designs: i64,
    values: *const f64,
    out: *mut *mut hbvib_batch,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let o = unsafe { load(options, 3) }?;
        let watched = unsafe { Watched::new(o.responses, o.responses_len, model.ndof(), 3) }.with_argument(3)?;
        let responses = unsafe { watched.responses(3) }.with_argument(3)?;
        check_responses(&responses, model.ndof(), model.structure().sectors()).with_argument(3)?;
        let options = batch_options(&o, &responses).with_argument(3)?;
        let hooks = unsafe { load_hooks(hooks, 4) }?;
        let count = parameter_count(count)?;
        let given = unsafe { loaded(parameters, count) }?;
        let described = unsafe { all_parameters(&given, &model) }?;
        let designs = crate::capi::crossing::arrays::count(designs, 7, "designs")?;
        let values = unsafe { input(values, designs.saturating_mul(count), 8, "values") }?;
        check_pointer(out, 9, "out")?;
        let surroundings = |work: &mut dyn FnMut()| within(work);
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                let threads = (&surroundings as &Surroundings<'_>, together());
                batch_within(&model, &solver, &options, (&described, values), hooks, threads)
            })
        }
        .map_err(|e| match e.status {
            Status::Unsupported | Status::Index if e.argument == 0 => e.in_argument(5),
            _ => e,
        })?;
        let status = found.status();
        unsafe { out.write(insert(found)?) };
        Ok(status)
    })
}

fn batch_options<'a>(o: &hbvib_batch_options, responses: &'a [Response<'a>]) -> Result<BatchOptions<'a>> {
    check_reserved(o.reserved, 3, "hbvib_batch_options")?;
    if !matches!(o.keep, 0 | 1) {
        return fail!(Argument, "keep = {}, needs 0 or 1", o.keep);
    }
    let Ok(threads) = usize::try_from(o.threads) else {
        return fail!(Argument, "threads = {}, needs 1 .. {MOST_THREADS}", o.threads);
    };
    let options = BatchOptions {
        responses,
        omega_start: o.omega_start,
        omega_stop: o.omega_stop,
        threads,
        keep: o.keep == 1,
    };
    options.check()?;
    Ok(options)
}

/// Frees a batch; branches that were taken from it stay. NULL is accepted and does nothing.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_BUSY. Threads: any, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_free(batch: *mut hbvib_batch) -> hbvib_status {
    call_to_free(|| free::<Batch>(batch, 1).map(|()| Status::Ok))
}

/// Number of designs of a batch; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (a branch is being taken). Threads: any number on a batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_designs(batch: *const hbvib_batch) -> i64 {
    call_count(|| Ok(read::<Batch>(batch, 1)?.peaks().len()))
}

/// The highest peak of each design, in the order of their values.
///
/// capacity        numbers that fit into each array: at least the number of designs.
/// peak_amplitude  receives amplitudes, NaN without a maximum; or NULL.
/// peak_omega      receives angular frequencies, NaN without a maximum; or NULL.
/// statuses        receives numbers of hbvib_status, as of hbvib_batch_status; or NULL.
/// points          receives numbers of points of each curve; or NULL.
/// Errors: HBVIB_E_DIMENSION (capacity: the arrays are untouched), HBVIB_E_ARGUMENT (overlapping
/// arrays), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any number on one batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_peaks(
    batch: *const hbvib_batch,
    capacity: i64,
    peak_amplitude: *mut f64,
    peak_omega: *mut f64,
    statuses: *mut i64,
    points: *mut i64,
) -> hbvib_status {
    call(|| {
        let batch = read::<Batch>(batch, 1)?;
        let peaks = batch.peaks();
        let n = peaks.len();
        if count(capacity, 2, "capacity")? < n {
            return fail!(Dimension, "capacity = {capacity}, needs {n}").with_argument(2);
        }
        disjoint(
            &[],
            &[
                Range::new(peak_amplitude, n, 3, "peak_amplitude")?,
                Range::new(peak_omega, n, 4, "peak_omega")?,
                Range::new(statuses, n, 5, "statuses")?,
                Range::new(points, n, 6, "points")?,
            ],
        )?;
        unsafe {
            fill(peak_amplitude, peaks, (3, "peak_amplitude"), |peak| peak.amplitude)?;
            fill(peak_omega, peaks, (4, "peak_omega"), |peak| peak.omega)?;
            fill(statuses, peaks, (5, "statuses"), |peak| peak.status as i64)?;
            fill(points, peaks, (6, "points"), |peak| peak.points as i64)?;
        }
        Ok(Status::Ok)
    })
}

/// Fills an array of the caller, unless it is NULL.
unsafe fn fill<T>(
    p: *mut T,
    peaks: &[DesignPeak],
    (argument, name): (i32, &str),
    value: impl Fn(&DesignPeak) -> T,
) -> Result<()> {
    if p.is_null() || peaks.is_empty() {
        return Ok(());
    }
    let array = unsafe { output(p, peaks.len(), argument, name) }?;
    for (to, peak) in array.iter_mut().zip(peaks) {
        *to = value(peak);
    }
    Ok(())
}

/// The highest peak of a response of each design, in the order of their values.
///
/// response   number of the response of hbvib_batch_options, from 0.
/// capacity   numbers that fit into each array: at least the number of designs.
/// amplitude  receives measures, NaN without a maximum or where the design failed; or NULL.
/// omega      receives angular frequencies; or NULL.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity: the arrays are untouched),
/// HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any
/// number on one batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_response_peaks(
    batch: *const hbvib_batch,
    response: i64,
    capacity: i64,
    amplitude: *mut f64,
    omega: *mut f64,
) -> hbvib_status {
    call(|| unsafe { fill_pairs((batch, response, capacity), |peak| &peak.responses, amplitude, omega) })
}

/// The larger value of a response of each design at the two ends of the range, in the order of
/// their values. Where it is above the highest peak of hbvib_batch_response_peaks, or there is
/// none, the highest peak lies beyond that end.
///
/// response   number of the response of hbvib_batch_options, from 0.
/// capacity   numbers that fit into each array: at least the number of designs.
/// amplitude  receives measures, NaN where the design failed; or NULL.
/// omega      receives the angular frequency of the end; or NULL.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity: the arrays are untouched),
/// HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any
/// number on one batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_response_ends(
    batch: *const hbvib_batch,
    response: i64,
    capacity: i64,
    amplitude: *mut f64,
    omega: *mut f64,
) -> hbvib_status {
    call(|| unsafe { fill_pairs((batch, response, capacity), |peak| &peak.ends, amplitude, omega) })
}

/// Fills arguments 4 and 5 with a pair of each design, for a batch, a response and a capacity as arguments 1 to 3.
unsafe fn fill_pairs(
    (batch, response, capacity): (*const hbvib_batch, i64, i64),
    pairs: impl Fn(&DesignPeak) -> &Vec<(f64, f64)>,
    amplitude: *mut f64,
    omega: *mut f64,
) -> Result<Status> {
    let batch = read::<Batch>(batch, 1)?;
    let response = index(response, batch.responses(), 2, "response")?;
    let peaks = batch.peaks();
    if count(capacity, 3, "capacity")? < peaks.len() {
        return fail!(Dimension, "capacity = {capacity}, needs {}", peaks.len()).with_argument(3);
    }
    let n = peaks.len();
    disjoint(
        &[],
        &[
            Range::new(amplitude, n, 4, "amplitude")?,
            Range::new(omega, n, 5, "omega")?,
        ],
    )?;
    let of = |peak: &DesignPeak| pairs(peak).get(response).copied().unwrap_or((f64::NAN, f64::NAN));
    unsafe {
        fill(amplitude, peaks, (4, "amplitude"), |peak| of(peak).0)?;
        fill(omega, peaks, (5, "omega"), |peak| of(peak).1)?;
    }
    Ok(Status::Ok)
}

/// The status of a design, whose sentence hbvib_last_error then has: HBVIB_OK;
/// HBVIB_STOPPED_NO_PEAK without a maximum; another positive number where the branch ended early
/// and may have higher maxima beyond; HBVIB_STOPPED_BY_CALLER where it was not solved; negative
/// where it failed.
///
/// design  number from 0, in the order of the values.
/// Errors: HBVIB_E_INDEX, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any number on one batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_status(batch: *const hbvib_batch, design: i64) -> hbvib_status {
    call(|| {
        let batch = read::<Batch>(batch, 1)?;
        let design = index(design, batch.peaks().len(), 2, "design")?;
        let peak = &batch.peaks()[design];
        Ok(Outcome {
            status: peak.status,
            reason: peak.reason.clone(),
        })
    })
}

/// Takes the branch of a design out of the batch, which must have been solved with keep = 1.
///
/// design  number from 0, in the order of the values.
/// out     receives the branch; untouched on error. Free it by hbvib_branch_free.
/// Errors: HBVIB_E_ARGUMENT (branches were not kept, this one was taken before, or the design has
/// none because it failed), HBVIB_E_INDEX, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per batch.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_batch_branch(
    batch: *mut hbvib_batch,
    design: i64,
    out: *mut *mut hbvib_branch,
) -> hbvib_status {
    call(|| {
        let mut batch = write::<Batch>(batch, 1)?;
        let design = index(design, batch.peaks().len(), 2, "design")?;
        check_pointer(out, 3, "out")?;
        let Some(branch) = batch.take_branch(design) else {
            return fail!(
                Argument,
                "design {design} has no branch: branches were not kept (keep = 1), it was taken before, or the design failed"
            )
            .with_argument(2);
        };
        let outcome = Outcome::from(&branch);
        unsafe { out.write(insert_tree(branch, 0, false)?) };
        Ok(outcome)
    })
}
