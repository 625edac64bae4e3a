//! Section "Modes" of the header: nonlinear modes.

#![allow(non_camel_case_types)]

use crate::analysis;
use crate::capi::crossing::arrays::{count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::solving::solve::{follow, hbvib_branch};
use crate::capi::solving::solve_hooks::hbvib_hooks;
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::cyclic::{hbvib_special_diameter, is_of_engine_order};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;
use crate::options::{Amplitude, DampingForm, ModeChoice, ModeGuess, ModeOptions};
use core::ptr;
use num_complex::Complex64;

/// Artificial damping that makes the motion of a damped structure periodic; D is its damping ratio.
#[repr(C)]
pub enum hbvib_damping_form {
    /// The term -2 D omega M x'.
    HBVIB_DAMPING_MASS = 0,
    /// The term -zeta K x', D = zeta omega / 2, K the structure's own stiffness without springs and
    /// contacts.
    HBVIB_DAMPING_STIFFNESS = 1,
}

/// Options of hbvib_nonlinear_mode. Fill it by hbvib_mode_options_init, then set the range.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_mode_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_DAMPING_MASS (default) or HBVIB_DAMPING_STIFFNESS.
    pub damping_form: i32,
    /// log10 of the first amplitude.
    pub log10_start: f64,
    /// log10 of the last amplitude, above the first.
    pub log10_stop: f64,
    /// HBVIB_DIAMETER_OF_ENGINE_ORDER (default): the wave of the model's engine order. Else a signed
    /// nodal diameter d, modulo N: the wave in which sector s + 1 lags by 2 pi d / N.
    pub diameter: i64,
    /// Number of the linear mode, contacts stuck, from 0 (default) by rising frequency.
    pub mode_index: i64,
    /// Above 0: the linear mode nearest to this angular frequency; mode_index must then be 0.
    /// 0: not used.
    pub near_omega: f64,
    /// The linear mode most similar to this shape, ndof complex numbers of one sector and of any
    /// size. NULL: not used. mode_index and near_omega must then be 0.
    pub shape: *const f64,
    /// Complex numbers in shape.
    pub shape_len: i64,
    /// Measure of the amplitude. -1 (default): sqrt(X_1^H M X_1) over one sector, length times
    /// square root of mass. Else a contact: |Y_1| of its relative motion, a peak length.
    pub amplitude_contact: i64,
    /// log10 of amplitudes within the range at which every solution is computed exactly, or NULL.
    pub at: *const f64,
    /// Number of these amplitudes.
    pub at_len: i64,
    /// Degree of freedom whose fundamental is real; -1 (default): the one that moves most in the
    /// linear mode.
    pub reference_dof: i64,
    /// Motion near the first point, complex (H + 1) x ndof, harmonic after harmonic with an H of
    /// its own, at least 1, or NULL: the linear mode, from small amplitudes on. Its amplitude and
    /// phase are made those of the first point. Harmonics that laws do not excite by themselves are
    /// carried where the guess has them. hbvib_reduction tells whether the first point was found
    /// from it.
    pub guess: *const f64,
    /// Complex numbers in guess.
    pub guess_len: i64,
    /// Angular frequency of the guess, > 0; 0 without one.
    pub guess_omega: f64,
    /// Damping ratio of the guess; 0 without one.
    pub guess_damping: f64,
    /// Further curves that are sought, for hbvib_branch_children: 0 (default) none; 1 those of its
    /// branch points, listed by hbvib_branch_bifurcations, with even harmonics carried along, and
    /// the one beyond a tongue of internal resonance.
    pub branches: i32,
    /// Largest number of generations of these curves, up to 8; 0 (default): 3.
    pub branch_depth: i32,
    /// Largest number of these curves; 0 (default): 32.
    pub most_branches: i64,
}

unsafe impl VersionedStruct for hbvib_mode_options {
    const NAME: &'static str = "hbvib_mode_options";
    const FIRST_SIZE: usize = 96;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            damping_form: hbvib_damping_form::HBVIB_DAMPING_MASS as i32,
            log10_start: 0.0,
            log10_stop: 0.0,
            diameter: hbvib_special_diameter::HBVIB_DIAMETER_OF_ENGINE_ORDER as i64,
            mode_index: 0,
            near_omega: 0.0,
            shape: ptr::null(),
            shape_len: 0,
            amplitude_contact: -1,
            at: ptr::null(),
            at_len: 0,
            reference_dof: -1,
            guess: ptr::null(),
            guess_len: 0,
            guess_omega: 0.0,
            guess_damping: 0.0,
            branches: 0,
            branch_depth: 0,
            most_branches: 0,
        }
    }
}

/// Fills the options of a nonlinear mode with their defaults: the lowest mode of the model's wave,
/// modal amplitude, damping of mass form. The range is empty and must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_mode_options_init(o: *mut hbvib_mode_options, size_of_o: usize) -> hbvib_status {
    call(|| unsafe { init(o, size_of_o) })
}

/// Follows a nonlinear mode over a range of amplitude, from contacts that stick to contacts that
/// slide, by the extended periodic motion concept (EPMC, Krack 2015) and arc-length continuation:
/// artificial damping balances the loss in friction and structure, and its damping ratio D belongs
/// to the result. The mode vibrates about the static state under the constant forces of the model
/// and the preload of its contacts; amplitude and potential energy count from it. Vibrating forces
/// have no effect. Turns in amplitude are passed, largest damping ratios refined.
///
/// solver  options; NULL: the defaults. harmonics must be at least 1.
/// mode    the linear mode to start from, the measure of the amplitude, its range.
/// hooks   progress, log and cancellation; NULL: none.
/// out     receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early; the branch then has all points found, possibly
/// none.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_DIMENSION, HBVIB_E_INDEX and HBVIB_E_NOT_FINITE for options
/// out of range, a mode that moves no contact, a mode of frequency 0, and a reference at a node of
/// the mode; HBVIB_E_NOT_POSITIVE_DEFINITE and HBVIB_E_NOT_HERMITIAN for matrices, also missing
/// ones; HBVIB_E_NO_CONVERGENCE where no static state or no first point was found;
/// HBVIB_E_SINGULAR, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may solve one model at a time, with the same results as one alone; changing
/// or freeing it meanwhile is HBVIB_E_BUSY.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_nonlinear_mode(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    mode: *const hbvib_mode_options,
    hooks: *const hbvib_hooks,
    out: *mut *mut hbvib_branch,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let mode = unsafe { load(mode, 3) }?;
        let mode = unsafe { mode_options(&mode, &model) }.with_argument(3)?;
        let found = unsafe {
            follow(hooks, out, mode.at.len(), |hooks| {
                analysis::nonlinear_mode(&model, &solver, &mode, hooks)
            })
        };
        match found {
            // The number of modes is known only during the analysis.
            Err(e) if e.status == Status::Index => Err(e).with_argument(3),
            found => found,
        }
    })
}

pub(crate) unsafe fn mode_options<'a>(o: &hbvib_mode_options, model: &Model) -> Result<ModeOptions<'a>> {
    const MASS: i32 = hbvib_damping_form::HBVIB_DAMPING_MASS as i32;
    const STIFFNESS: i32 = hbvib_damping_form::HBVIB_DAMPING_STIFFNESS as i32;
    let damping_form = match o.damping_form {
        MASS => DampingForm::Mass,
        STIFFNESS => DampingForm::Stiffness,
        other => {
            return fail!(
                Argument,
                "damping_form = {other}, needs HBVIB_DAMPING_MASS = 0 or HBVIB_DAMPING_STIFFNESS = 1"
            );
        }
    };
    let sectors = model.structure().sectors();
    let diameter = match o.diameter {
        own if is_of_engine_order(own) => None,
        other => Some(other),
    };
    let at_len = count(o.at_len, 3, "at_len")?;
    let contact = optional(
        o.amplitude_contact,
        model.contacts().len(),
        "amplitude_contact",
        "modal amplitude",
    )?;
    let options = ModeOptions {
        choice: unsafe { choice(o, model.ndof()) }?,
        diameter,
        amplitude: contact.map_or(Amplitude::Modal, Amplitude::Contact),
        log10_start: o.log10_start,
        log10_stop: o.log10_stop,
        at: unsafe { input(o.at, at_len, 3, "at") }?,
        damping_form,
        reference_dof: optional(o.reference_dof, model.ndof(), "reference_dof", "automatic")?,
        guess: unsafe { guess(o) }?,
        branches: count(i64::from(o.branches), 3, "branches")?,
        branch_depth: count(i64::from(o.branch_depth), 3, "branch_depth")?,
        most_branches: count(o.most_branches, 3, "most_branches")?,
    };
    options.check(model.ndof(), model.contacts().len(), sectors)?;
    Ok(options)
}

unsafe fn guess<'a>(o: &hbvib_mode_options) -> Result<Option<ModeGuess<'a>>> {
    let count = count(o.guess_len, 3, "guess_len")?;
    if o.guess.is_null() && count == 0 {
        for (name, value) in [("guess_omega", o.guess_omega), ("guess_damping", o.guess_damping)] {
            if value != 0.0 {
                return fail!(Argument, "{name} = {value} without a guess, needs 0");
            }
        }
        return Ok(None);
    }
    Ok(Some(ModeGuess {
        motion: unsafe { input::<Complex64>(o.guess.cast(), count, 3, "guess") }?,
        omega: o.guess_omega,
        damping_ratio: o.guess_damping,
    }))
}

unsafe fn choice<'a>(o: &hbvib_mode_options, ndof: usize) -> Result<ModeChoice<'a>> {
    let shape_len = count(o.shape_len, 3, "shape_len")?;
    let Ok(mode_index) = usize::try_from(o.mode_index) else {
        return fail!(Index, "mode_index = {}, needs a number >= 0", o.mode_index);
    };
    let near = o.near_omega != 0.0;
    if mode_index != 0 && (near || !o.shape.is_null()) {
        return fail!(
            Argument,
            "mode_index = {mode_index} beside {}: both choose the mode; set mode_index = 0",
            if near { "near_omega" } else { "shape" }
        );
    }
    if o.shape.is_null() && shape_len == 0 {
        return Ok(if near {
            ModeChoice::Near(o.near_omega)
        } else {
            ModeChoice::Index(mode_index)
        });
    }
    if near {
        return fail!(
            Argument,
            "near_omega = {} and shape both choose the mode; set near_omega = 0 or shape = NULL",
            o.near_omega
        );
    }
    if shape_len != ndof {
        return fail!(Dimension, "shape_len = {shape_len}, needs ndof = {ndof}");
    }
    let shape = unsafe { input::<Complex64>(o.shape.cast(), shape_len, 3, "shape") }?;
    Ok(ModeChoice::Shape(shape))
}

/// A number of the caller from 0 below `limit`, or -1 for `none`.
fn optional(value: i64, limit: usize, name: &str, none: &str) -> Result<Option<usize>> {
    match usize::try_from(value) {
        Ok(i) if i < limit => Ok(Some(i)),
        _ if value == -1 => Ok(None),
        _ if limit == 0 => fail!(Index, "{name} = {value}, needs -1 ({none}): there is no other"),
        _ => fail!(Index, "{name} = {value}, needs 0 .. {} or -1 ({none})", limit - 1),
    }
}
