//! Section "Design studies" of the header: the freedom of contacts that stick, and the band of a response over it.

#![allow(non_camel_case_types)]

use crate::analysis::{self, Band, BandEnd, BandOf, BandOptions, FreeSlider};
use crate::capi::crossing::arrays::{
    Column, Entry, Range, check_pointer, count, disjoint, fill_list, input, optional, output, put,
};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::branch_tree::insert_tree;
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::{index, indices};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init, load};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks, with_interrupt};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;
use core::ptr;

/// The sliders of a stored point of a forced response that stick through the period and change its
/// vibration: each may lie anywhere within the limit of its friction, and every such state is a
/// solution. None where no contact sticks all the time, or none of the others slips or opens.
///
/// model       the model of which the branch is a result, unchanged since.
/// point       number of a point of the curve, or of a peak, fold or requested solution.
/// capacity    numbers that fit into each array.
/// contact     receives the numbers of their contacts, numbers, or NULL.
/// direction   receives their directions, numbers, 0 for t1 and 1 for t2, or NULL.
/// place       receives their places in the solution, or NULL.
/// derivative  receives the derivatives of the amplitude by the places at a fixed frequency, while
///             the contacts stick; or NULL.
/// count       receives how many there are, also when `capacity` is too small.
/// hooks       phase, log and cancellation; progress is not called. NULL: none.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_ARGUMENT (another model), HBVIB_E_UNSUPPORTED (a
/// nonlinear mode), HBVIB_E_DIMENSION (capacity too small: the arrays are untouched),
/// HBVIB_E_CALLBACK, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads:
/// any number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_branch_freedom(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    capacity: i64,
    contact: *mut i64,
    direction: *mut i64,
    place: *mut f64,
    derivative: *mut f64,
    count: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let point = index(point, kept.branch.stored(), 3, "point")?;
        let hooks = unsafe { load_hooks(hooks, 10) }?;
        check_pointer(count, 9, "count")?;
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                analysis::freedom_with(&model, &kept.branch, point, interrupt)
            })
        }?;
        let columns = [
            Column::Numbers(contact, 5, "contact"),
            Column::Numbers(direction, 6, "direction"),
            Column::Reals(place, 7, "place"),
            Column::Reals(derivative, 8, "derivative"),
        ];
        let row = |one: &FreeSlider| {
            [
                Entry::Number(one.contact as i64),
                Entry::Number(one.direction as i64),
                Entry::Real(one.place),
                Entry::Real(one.derivative),
            ]
        };
        unsafe { fill_list(&columns, found.iter().map(row), (capacity, 4), (count, 9)) }
    })
}

/// Results that a band bounds.
#[repr(C)]
pub enum hbvib_band_of {
    /// The amplitude at the frequency of the point.
    HBVIB_BAND_AMPLITUDE = 0,
    /// The amplitude of a peak, which moves with the places of the sliders.
    HBVIB_BAND_PEAK_AMPLITUDE = 1,
    /// The angular frequency of a peak.
    HBVIB_BAND_PEAK_OMEGA = 2,
}

/// Options of hbvib_band. Fill it by hbvib_band_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_band_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// A value of enum hbvib_band_of; default HBVIB_BAND_AMPLITUDE.
    pub of: i32,
    /// Contacts whose sliders are free, or NULL: all of hbvib_branch_freedom.
    pub contacts: *const i64,
    /// Number of these contacts.
    pub contacts_len: i64,
    /// Starts of the search with several free sliders, 1 .. 1000; default 3. With one it has no
    /// effect.
    pub starts: i64,
}

unsafe impl VersionedStruct for hbvib_band_options {
    const NAME: &'static str = "hbvib_band_options";
    const FIRST_SIZE: usize = 32;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            of: hbvib_band_of::HBVIB_BAND_AMPLITUDE as i32,
            contacts: ptr::null(),
            contacts_len: 0,
            starts: 3,
        }
    }
}

/// Fills the options of a band: the amplitude, all free sliders.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_band_options_init(o: *mut hbvib_band_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Numbers of a band. Fill it by hbvib_band_info_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_band_info {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 1 if one slider was followed to both of its limits, or each search of several ended at an
    /// extremum; else 0. 0, too, where every contact is linear at the point and some stick: then
    /// states far from it were sampled.
    pub complete: i32,
    /// Number of free sliders, those of the point and then those that stick at an end; 0: the
    /// response has no band, and both ends are the point itself.
    pub sliders: i64,
    /// Number of states that were followed with one free slider at the point; else 0.
    pub states: i64,
    /// Number of solutions that were computed.
    pub solved: i64,
    /// The least result found.
    pub lower: f64,
    /// The largest result found.
    pub upper: f64,
    /// Angular frequency of the least result.
    pub lower_omega: f64,
    /// Angular frequency of the largest one.
    pub upper_omega: f64,
    /// Relative change of the least result that the linearised problem still foretells within a
    /// tenth of the distances over which the sliders can be dragged; 0 with one slider, NaN for a
    /// motion without a free slider.
    pub lower_gain: f64,
    /// The same of the largest one.
    pub upper_gain: f64,
    /// Contacts that are at the limit of their friction in the least result.
    pub lower_at_limit: i64,
    /// The same in the largest one.
    pub upper_at_limit: i64,
    /// Relative change of the least result by the last doubling of its harmonics, which bounds its
    /// error; NaN where it is unknown, as with fixed harmonics.
    pub lower_error: f64,
    /// The same of the largest one.
    pub upper_error: f64,
}

unsafe impl VersionedStruct for hbvib_band_info {
    const NAME: &'static str = "hbvib_band_info";
    const FIRST_SIZE: usize = 96;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            complete: 0,
            sliders: 0,
            states: 0,
            solved: 0,
            lower: 0.0,
            upper: 0.0,
            lower_omega: 0.0,
            upper_omega: 0.0,
            lower_gain: 0.0,
            upper_gain: 0.0,
            lower_at_limit: 0,
            upper_at_limit: 0,
            lower_error: 0.0,
            upper_error: 0.0,
        }
    }
}

/// Fills the numbers of a band with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_band_info_init(i: *mut hbvib_band_info, size_of_i: usize) -> hbvib_status {
    call(|| unsafe { init(i, size_of_i) })
}

/// The band of a stored point of a forced response: the least and the largest result over all
/// places of the sliders that stick through the period, and the states that attain them. With one
/// free slider all states that are joined to that of the point, from one limit of its friction to
/// the other, are followed, with every extremum between. With several, a search from each start
/// goes to an extremum; the bounds are attained ones, beyond which others may lie. Where every
/// contact is linear at the point, states with sliders at the corners of their limits are tried, at
/// which others may slip or open.
/// The harmonics are those of the point. Where a tolerance has chosen these, the ends and the
/// limits of one free slider are searched again with twice as many, until their results change by
/// less than the tolerance of `solver`.
///
/// model            the model of which the branch is a result, unchanged since.
/// point            number of a stored point; of a peak where the band is one of a peak.
/// solver           options; NULL: the defaults. `harmonics` has no effect; `tolerance` is that of
///                  the ends of a point whose harmonics a tolerance has chosen.
/// options          the result and what is free; NULL: the defaults.
/// hooks            log, phase and cancellation; NULL: none.
/// info             receives the numbers of the band.
/// capacity         numbers that fit into each array of sliders: at least twice as many as the
///                  model has contacts, unless all four are NULL.
/// contact          receives the contacts of the free sliders, numbers, or NULL.
/// direction        receives their directions, numbers, or NULL.
/// lower_place      receives their places in the least result, for hbvib_model_set_slider; or NULL.
/// upper_place      receives those in the largest result; or NULL.
/// states_capacity  states that fit into the next array.
/// states           receives place, result, its derivative by the place and angular frequency of
///                  each state of one free slider, four numbers a state, as many states as fit;
///                  or NULL.
/// lower            receives the least state, a branch of one point on the model with its places;
///                  a null handle where there is no band; or NULL. Free it by hbvib_branch_free.
/// upper            receives the largest one in the same way; or NULL.
/// Errors: HBVIB_E_INDEX (point, contacts), HBVIB_E_ARGUMENT (another model, options out of their
/// range, a point that is no peak, overlapping arrays), HBVIB_E_UNSUPPORTED (a nonlinear mode),
/// HBVIB_E_DIMENSION (capacity), HBVIB_E_NO_CONVERGENCE, HBVIB_E_CALLBACK, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; nothing is written
/// then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_band(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    solver: *const hbvib_solver_options,
    options: *const hbvib_band_options,
    hooks: *const hbvib_hooks,
    info: *mut hbvib_band_info,
    capacity: i64,
    contact: *mut i64,
    direction: *mut i64,
    lower_place: *mut f64,
    upper_place: *mut f64,
    states_capacity: i64,
    states: *mut f64,
    lower: *mut *mut hbvib_branch,
    upper: *mut *mut hbvib_branch,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let point = index(point, kept.branch.stored(), 3, "point")?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let (of, free, starts) = unsafe { band_options(options, model.contacts().len(), 5) }?;
        let options = BandOptions {
            of,
            contacts: &free,
            starts,
        };
        let hooks = unsafe { load_hooks(hooks, 6) }?;
        unsafe { check_out(info, 7) }?;
        let room = count(capacity, 8, "capacity")?;
        let given = !(contact.is_null() && direction.is_null() && lower_place.is_null() && upper_place.is_null());
        let needed = 2 * model.contacts().len();
        if given && room < needed {
            return fail!(Dimension, "capacity = {room}, needs {needed}").with_argument(8);
        }
        let fits = count(states_capacity, 13, "states_capacity")?;
        let numbers = if states.is_null() { 0 } else { fits.saturating_mul(4) };
        for (p, argument, name) in [(contact, 9, "contact"), (direction, 10, "direction")] {
            optional((p, argument), name)?;
        }
        for (p, argument, name) in [
            (lower_place, 11, "lower_place"),
            (upper_place, 12, "upper_place"),
            (states, 14, "states"),
        ] {
            optional((p, argument), name)?;
        }
        disjoint(
            &[],
            &[
                Range::new(contact, needed, 9, "contact")?,
                Range::new(direction, needed, 10, "direction")?,
                Range::new(lower_place, needed, 11, "lower_place")?,
                Range::new(upper_place, needed, 12, "upper_place")?,
                Range::new(states, numbers, 14, "states")?,
            ],
        )?;
        for (p, argument, name) in [(lower, 15, "lower"), (upper, 16, "upper")] {
            if !p.is_null() {
                check_pointer(p, argument, name)?;
            }
        }
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                analysis::band(&model, &kept.branch, point, &solver, &options, hooks)
            })
        };
        let mut found = found.map_err(|e| match e.status {
            Status::Argument | Status::Index if e.argument == 0 => e.in_argument(5),
            _ => e,
        })?;
        let column = |k: usize| {
            found
                .sliders
                .iter()
                .map(move |one| if k == 0 { one.0 } else { one.1 } as i64)
        };
        unsafe {
            for (i, (number, which)) in column(0).zip(column(1)).enumerate() {
                put(contact, i, number);
                put(direction, i, which);
            }
            for (p, end) in [(lower_place, &found.lower), (upper_place, &found.upper)] {
                for (i, place) in end.places.iter().enumerate() {
                    put(p, i, *place);
                }
            }
            if numbers > 0 {
                let rows = output(states, numbers, 14, "states")?;
                for (row, state) in rows.chunks_exact_mut(4).zip(&found.states) {
                    row.copy_from_slice(&[state.place, state.value, state.derivative, state.omega]);
                }
            }
            give(&mut found.lower, lower)?;
            give(&mut found.upper, upper)?;
            fill_out(info, numbers_of(&found));
        }
        Ok(Status::Ok)
    })
}

/// Gives the branch of an end to the caller, unless it wants none.
unsafe fn give(end: &mut BandEnd, to: *mut *mut hbvib_branch) -> Result<()> {
    if to.is_null() {
        return Ok(());
    }
    let handle = match end.branch.take() {
        Some(branch) => insert_tree(branch, 0, false)?,
        None => ptr::null_mut(),
    };
    unsafe { to.write(handle) };
    Ok(())
}

fn numbers_of(found: &Band) -> hbvib_band_info {
    hbvib_band_info {
        struct_size: 0,
        complete: i32::from(found.is_complete),
        sliders: found.sliders.len() as i64,
        states: found.states.len() as i64,
        solved: found.solved as i64,
        lower: found.lower.value,
        upper: found.upper.value,
        lower_omega: found.lower.omega,
        upper_omega: found.upper.omega,
        lower_gain: found.lower.gain,
        upper_gain: found.upper.gain,
        lower_at_limit: found.lower.at_limit.len() as i64,
        upper_at_limit: found.upper.at_limit.len() as i64,
        lower_error: found.lower.error,
        upper_error: found.upper.error,
    }
}

/// The result, the contacts and the number of starts of the options, argument `argument`; NULL: the defaults.
///
/// # Safety
/// The caller of the C function states that the struct and its array lie there.
pub(crate) unsafe fn band_options(
    options: *const hbvib_band_options,
    contacts: usize,
    argument: i32,
) -> Result<(BandOf, Vec<usize>, usize)> {
    let o = if options.is_null() {
        hbvib_band_options::defaults()
    } else {
        unsafe { load(options, argument) }?
    };
    let n = count(o.contacts_len, argument, "contacts_len")?;
    let given = unsafe { input(o.contacts, n, argument, "contacts") }?;
    let free = indices(given, contacts, argument, "contacts")?;
    let of = band_of(o.of).with_argument(argument)?;
    Ok((of, free, usize::try_from(o.starts).unwrap_or(0)))
}

fn band_of(of: i32) -> Result<BandOf> {
    Ok(match of {
        0 => BandOf::Amplitude,
        1 => BandOf::PeakAmplitude,
        2 => BandOf::PeakOmega,
        other => {
            return fail!(
                Argument,
                "hbvib_band_options: of = {other}, needs HBVIB_BAND_AMPLITUDE = 0 .. HBVIB_BAND_PEAK_OMEGA = 2"
            );
        }
    })
}
