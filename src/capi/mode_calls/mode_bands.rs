//! Section "Design studies" of the header: the band of a nonlinear mode.

#![allow(non_camel_case_types)]

use crate::analysis::{self, ModeBandOf, ModeBandState};
use crate::capi::crossing::arrays::{check_pointer, count as length, input, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::{index, indices};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, load};
use crate::capi::design::band::hbvib_band_info;
use crate::capi::mode_calls::modes::{hbvib_mode_options, mode_options};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::model::Model;

/// Results of a nonlinear mode that a band bounds.
#[repr(C)]
pub enum hbvib_mode_band_of {
    /// The damping ratio at the amplitude of the point.
    HBVIB_MODE_BAND_DAMPING = 0,
    /// The angular frequency there.
    HBVIB_MODE_BAND_OMEGA = 1,
}

/// Number of results of a state behind its places.
const RESULTS: usize = 2;

/// The band of a stored point of a nonlinear mode: the least and the largest damping ratio or
/// frequency at its amplitude over all places of the sliders that stick through its period, and the
/// states that attain them. With one slider all of its places are scanned and each end is refined;
/// with several one after another is, until nothing is gained: the bounds are attained ones, beyond
/// which others may lie. A mode of the model with hbvib_model_set_slider of the places has them.
///
/// model            the model of which the branch is a result, unchanged since.
/// branch           a nonlinear mode.
/// point            number of a stored point.
/// solver           options; NULL: the defaults. Harmonics and tolerance have no effect.
/// mode             options of the mode, whose amplitudes have no effect; NULL: the defaults.
/// of               a value of enum hbvib_mode_band_of.
/// contacts_len     number of contacts whose sliders are free; 0: all that stick.
/// contacts         their numbers, or NULL with 0.
/// hooks            log, phase and cancellation; NULL: none.
/// info             receives the numbers of the band.
/// capacity         numbers that fit into contact and direction, at least twice as many as the
///                  model has
///                  contacts, unless these and the states are NULL.
/// contact          receives the contacts of the free sliders, numbers, or NULL.
/// direction        receives their directions, numbers, or NULL.
/// ends             receives for the least result, then the largest, the places of the sliders,
///                  angular
///                  frequency and damping ratio, 2 * (capacity + 2) doubles, each place at the
///                  number of
///                  its slider, the results behind `capacity` places; or NULL.
/// states_capacity  states that fit into the next array.
/// states           receives place, angular frequency and damping ratio of each state of one
///                  slider that
///                  was scanned, three numbers a state, as many as fit; or NULL.
/// Errors: HBVIB_E_INDEX (point, contacts), HBVIB_E_ARGUMENT (another model, of),
/// HBVIB_E_UNSUPPORTED (a forced response), HBVIB_E_DIMENSION (capacity), those of
/// hbvib_nonlinear_mode; nothing is written then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any
/// number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_mode_band(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    solver: *const hbvib_solver_options,
    mode: *const hbvib_mode_options,
    of: i32,
    contacts_len: i64,
    contacts: *const i64,
    hooks: *const hbvib_hooks,
    info: *mut hbvib_band_info,
    capacity: i64,
    contact: *mut i64,
    direction: *mut i64,
    ends: *mut f64,
    states_capacity: i64,
    states: *mut f64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let kept = read::<KeptBranch>(branch, 2)?;
        let point = index(point, kept.branch.stored(), 3, "point")?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let given = if mode.is_null() {
            hbvib_mode_options::defaults()
        } else {
            unsafe { load(mode, 5) }?
        };
        let given = hbvib_mode_options {
            log10_start: 0.0,
            log10_stop: 1.0,
            at_len: 0,
            ..given
        };
        let range = unsafe { mode_options(&given, &model) }.with_argument(5)?;
        let of = match of {
            0 => ModeBandOf::Damping,
            1 => ModeBandOf::Omega,
            other => return fail!(Argument, "of = {other}, needs HBVIB_MODE_BAND_DAMPING = 0 or 1").with_argument(6),
        };
        let contacts_len = length(contacts_len, 7, "contacts_len")?;
        let chosen = unsafe { input(contacts, contacts_len, 8, "contacts") }?;
        let chosen = indices(chosen, model.contacts().len(), 8, "contacts")?;
        let hooks = unsafe { load_hooks(hooks, 9) }?;
        unsafe { check_out(info, 10) }?;
        let room = length(capacity, 11, "capacity")?;
        let needed = 2 * model.contacts().len();
        if !(contact.is_null() && direction.is_null() && ends.is_null()) && room < needed {
            return fail!(Dimension, "capacity = {room}, needs {needed}").with_argument(11);
        }
        for (p, argument, name) in [(contact, 12, "contact"), (direction, 13, "direction")] {
            if !p.is_null() {
                check_pointer(p, argument, name)?;
            }
        }
        let fits = length(states_capacity, 15, "states_capacity")?;
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                analysis::mode_band(&model, &kept.branch, point, (of, &chosen), &solver, &range, hooks)
            })
        }
        .map_err(|e| match e.status {
            Status::Index if e.argument == 0 => e.in_argument(5),
            _ => e,
        })?;
        let value = |state: &ModeBandState| match of {
            ModeBandOf::Damping => state.damping_ratio,
            ModeBandOf::Omega => state.omega,
        };
        unsafe {
            for (i, (number, which)) in found.sliders.iter().enumerate() {
                for (p, number) in [(contact, number), (direction, which)] {
                    if !p.is_null() {
                        p.add(i).write(*number as i64);
                    }
                }
            }
            if !ends.is_null() {
                let rows = output(ends, 2 * (room + RESULTS), 14, "ends")?;
                for (row, state) in rows.chunks_exact_mut(room + RESULTS).zip([&found.lower, &found.upper]) {
                    row[..state.places.len()].copy_from_slice(&state.places);
                    row[room..].copy_from_slice(&[state.omega, state.damping_ratio]);
                }
            }
            if !states.is_null() && fits > 0 {
                let rows = output(states, 3 * fits, 16, "states")?;
                for (row, state) in rows.chunks_exact_mut(3).zip(&found.states) {
                    row.copy_from_slice(&[state.places[0], state.omega, state.damping_ratio]);
                }
            }
            let numbers = hbvib_band_info {
                complete: i32::from(found.is_complete),
                sliders: found.sliders.len() as i64,
                states: found.states.len() as i64,
                solved: found.solved as i64,
                lower: value(&found.lower),
                upper: value(&found.upper),
                lower_omega: found.lower.omega,
                upper_omega: found.upper.omega,
                ..hbvib_band_info::defaults()
            };
            fill_out(info, numbers);
        }
        Ok(Status::Ok)
    })
}
