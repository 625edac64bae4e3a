//! Section "Modes" of the header: natural modes of the linear structure.

#![allow(non_camel_case_types)]

use crate::analysis::linear::linear_contacts::{LinearContacts, linear_modes};
use crate::capi::crossing::arrays::check_pointer;
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::cyclic::nodal_diameter;
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;

/// State of the contacts in a linear analysis.
#[repr(C)]
pub enum hbvib_contact_state {
    /// Without force.
    HBVIB_CONTACTS_FREE = 0,
    /// Linear springs, as at small motion: kt of contacts that stick and kn of contacts that press
    /// at rest, the slopes of tables and polynomials; HBVIB_REGULARISED has none.
    HBVIB_CONTACTS_STUCK = 1,
    /// Linear springs of their tangent stiffness at the static state under constant forces and
    /// preload; as stuck where nothing loads the model.
    HBVIB_CONTACTS_STATIC = 2,
}

/// Undamped natural modes, in ascending order of frequency. A singular mass matrix has fewer modes
/// than degrees of freedom. Where the stiffness is negative in some direction, a motion grows: its
/// omega is negative, minus the rate of growth, -sqrt(-lambda) of the eigenvalue lambda = omega^2.
/// Degrees of freedom whose diagonal of the stiffness exceeds all beside it by 1/epsilon, as 1e36,
/// are fixed: they have no mode.
///
/// diameter  signed nodal diameter d, modulo N: sector s + 1 lags by 2 pi d / N; 0 for a plain
///           structure. HBVIB_DIAMETER_OF_ENGINE_ORDER: that of the model's engine order.
/// contacts  HBVIB_CONTACTS_FREE, _STUCK (linear springs kt) or _STATIC (about the static state).
/// count     number of requested modes, at least 1.
/// omega     receives `count` natural angular frequencies; below zero: minus a rate of growth.
/// shapes    receives `count` complex shapes of ndof numbers each, one after the other, with
///           phi^H M phi = 1 over one sector; or NULL.
/// Errors: HBVIB_E_ARGUMENT (diameter, contacts), HBVIB_E_DIMENSION (more modes requested than
/// exist), HBVIB_E_NOT_HERMITIAN, HBVIB_E_NOT_POSITIVE_DEFINITE, HBVIB_E_SINGULAR,
/// HBVIB_E_NO_CONVERGENCE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_linear_modes(
    model: *const hbvib_model,
    diameter: i64,
    contacts: i32,
    count: i64,
    omega: *mut f64,
    shapes: *mut f64,
) -> hbvib_status {
    unsafe { hbvib_linear_modes_with_hooks(model, diameter, contacts, count, omega, shapes, core::ptr::null()) }
}

/// The same as hbvib_linear_modes; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// diameter  signed nodal diameter d, modulo N: sector s + 1 lags by 2 pi d / N; 0 for a plain
///           structure. HBVIB_DIAMETER_OF_ENGINE_ORDER: that of the model's engine order.
/// contacts  HBVIB_CONTACTS_FREE, _STUCK (linear springs kt) or _STATIC (about the static state).
/// count     number of requested modes, at least 1.
/// omega     receives `count` natural angular frequencies; below zero: minus a rate of growth.
/// shapes    receives `count` complex shapes of ndof numbers each, one after the other, with
///           phi^H M phi = 1 over one sector; or NULL.
/// hooks     phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_linear_modes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_linear_modes_with_hooks(
    model: *const hbvib_model,
    diameter: i64,
    contacts: i32,
    count: i64,
    omega: *mut f64,
    shapes: *mut f64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 7) }?;
        let model = read::<Model>(model, 1)?;
        let diameter = nodal_diameter(&model, diameter, model.structure().engine_order(), 2)?;
        let state = contact_state_of(contacts, 3)?;
        let wanted = usize::try_from(count).unwrap_or(0);
        check_pointer(omega, 5, "omega")?;
        if !shapes.is_null() {
            check_pointer(shapes, 6, "shapes")?;
        }
        if wanted == 0 || wanted > model.ndof() {
            return fail!(Dimension, "count = {count}, needs 1 .. ndof = {}", model.ndof()).with_argument(4);
        }
        let modes = unsafe {
            with_interrupt(&hooks, |interrupt| {
                linear_modes(&model, diameter, state, wanted, interrupt)
            })
        }?;
        if wanted > modes.omega.len() {
            return fail!(
                Dimension,
                "count = {count}, but only {} modes have mass",
                modes.omega.len()
            )
            .with_argument(4);
        }
        unsafe {
            omega.copy_from(modes.omega.as_ptr(), wanted);
            if !shapes.is_null() {
                shapes.copy_from(modes.shapes.as_ptr().cast(), 2 * wanted * model.ndof());
            }
        }
        Ok(Status::Ok)
    })
}

/// The state of contacts by its number.
pub(crate) fn contact_state_of(value: i32, argument: i32) -> Result<LinearContacts> {
    const FREE: i32 = hbvib_contact_state::HBVIB_CONTACTS_FREE as i32;
    const STUCK: i32 = hbvib_contact_state::HBVIB_CONTACTS_STUCK as i32;
    const STATIC: i32 = hbvib_contact_state::HBVIB_CONTACTS_STATIC as i32;
    match value {
        FREE => Ok(LinearContacts::Free),
        STUCK => Ok(LinearContacts::Stuck),
        STATIC => Ok(LinearContacts::Static),
        _ => fail!(
            Argument,
            "contacts = {value}, needs HBVIB_CONTACTS_FREE = 0, HBVIB_CONTACTS_STUCK = 1 or HBVIB_CONTACTS_STATIC = 2"
        ),
    }
    .with_argument(argument)
}
