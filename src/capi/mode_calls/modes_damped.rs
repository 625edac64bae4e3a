//! Section "Modes" of the header: damped modes, and the Campbell diagram of a structure that rotates.

#![allow(non_camel_case_types)]

use crate::analysis::linear::damped_modes::damped_modes;
use crate::analysis::linear::linear_contacts::LinearContacts;
use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{Reading, read};
use crate::capi::mode_calls::modes_linear::contact_state_of;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::structures::cyclic::nodal_diameter;
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;
use crate::studies::campbell::campbell;

/// A number of modes, 1 .. ndof.
pub(crate) fn modes(count: i64, model: &Model, argument: i32) -> Result<usize> {
    match usize::try_from(count) {
        Ok(modes) if modes > 0 && modes <= model.ndof() => Ok(modes),
        _ => fail!(Dimension, "count = {count}, needs 1 .. ndof = {}", model.ndof()).with_argument(argument),
    }
}

/// Damped natural modes at the speed of the model, in the order of rising frequency: eigenvalues
/// lambda in the upper half plane of lambda^2 M + lambda (C + Omega G) + K + Omega^2 K1 + i D.
/// Motions that do not oscillate are not counted unless they grow: their eigenvalue is real, above
/// zero, and they come first. A mode that grows is told to the log. Degrees of freedom whose
/// diagonal of the stiffness exceeds all beside it by 1/epsilon, as 1e36, are fixed.
///
/// diameter    signed nodal diameter d, modulo N: sector s + 1 lags by 2 pi d / N; 0 for a plain
///             structure. HBVIB_DIAMETER_OF_ENGINE_ORDER: that of the model's engine order.
/// contacts    HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count       number of requested modes, 1 .. ndof.
/// eigenvalue  receives `count` complex numbers: the damped angular frequency is the imaginary
///             part, the damping ratio minus the real part over the modulus.
/// shapes      receives `count` complex shapes of ndof numbers each, one after the other, with
///             phi^H M phi = 1 over one sector; or NULL.
/// direction   receives `count` numbers: 1 (forward) where the frequency rises with the speed at
///             fixed K1, -1 (backward) where it falls, 0 where neither; or NULL.
/// hooks       phase, log and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_ARGUMENT (diameter, contacts, a speed tied to the frequency), HBVIB_E_DIMENSION
/// (more modes than oscillate), HBVIB_E_NOT_POSITIVE_DEFINITE, HBVIB_E_SINGULAR,
/// HBVIB_E_NO_CONVERGENCE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_damped_modes(
    model: *const hbvib_model,
    diameter: i64,
    contacts: i32,
    count: i64,
    eigenvalue: *mut f64,
    shapes: *mut f64,
    direction: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 8) }?;
        let model = read::<Model>(model, 1)?;
        let diameter = nodal_diameter(&model, diameter, model.structure().engine_order(), 2)?;
        let state = contact_state_of(contacts, 3)?;
        let wanted = modes(count, &model, 4)?;
        check_pointer(eigenvalue, 5, "eigenvalue")?;
        if !shapes.is_null() {
            check_pointer(shapes, 6, "shapes")?;
        }
        if !direction.is_null() {
            check_pointer(direction, 7, "direction")?;
        }
        let found = unsafe { with_hooks(&hooks, |hooks| damped_modes(&model, diameter, state, wanted, hooks)) }?;
        if wanted > found.count() {
            return fail!(
                Dimension,
                "count = {count}, but only {} modes oscillate or grow",
                found.count()
            )
            .with_argument(4);
        }
        unsafe {
            eigenvalue.copy_from(found.eigenvalue.as_ptr().cast(), 2 * wanted);
            if !shapes.is_null() {
                shapes.copy_from(found.shapes.as_ptr().cast(), 2 * wanted * model.ndof());
            }
            if !direction.is_null() {
                direction.copy_from(found.direction.as_ptr(), wanted);
            }
        }
        Ok(Status::Ok)
    })
}

/// Campbell diagram: the lowest damped modes at each of some speeds of rotation. The speed of the
/// model has no effect.
///
/// n              number of speeds, at least 1.
/// speeds         rising speeds, rad per time unit; n numbers.
/// diameter       signed nodal diameter, as hbvib_damped_modes.
/// contacts       HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count          number of modes at each speed, 1 .. ndof.
/// omega          receives n * count damped angular frequencies, those of one speed rising, one
///                speed after the other; NaN where fewer motions oscillate.
/// damping_ratio  receives n * count damping ratios likewise; or NULL.
/// direction      receives n * count numbers likewise, as hbvib_damped_modes; or NULL.
/// hooks          phase and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_DIMENSION (n, count), HBVIB_E_NOT_FINITE or HBVIB_E_ARGUMENT (speeds), and those
/// of hbvib_damped_modes. Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_campbell(
    model: *const hbvib_model,
    n: i64,
    speeds: *const f64,
    diameter: i64,
    contacts: i32,
    count: i64,
    omega: *mut f64,
    damping_ratio: *mut f64,
    direction: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 10) }?;
        let (model, speeds, at) = unsafe { diagram(model, (n, speeds), (diameter, None), contacts, count) }?;
        check_pointer(omega, 7, "omega")?;
        if !damping_ratio.is_null() {
            check_pointer(damping_ratio, 8, "damping_ratio")?;
        }
        if !direction.is_null() {
            check_pointer(direction, 9, "direction")?;
        }
        let found = unsafe { with_hooks(&hooks, |hooks| campbell(&model, speeds, at, &[], hooks)) }.with_argument(3)?;
        unsafe {
            omega.copy_from(found.omega.as_ptr(), found.omega.len());
            if !damping_ratio.is_null() {
                damping_ratio.copy_from(found.damping_ratio.as_ptr(), found.damping_ratio.len());
            }
            if !direction.is_null() {
                direction.copy_from(found.direction.as_ptr(), found.direction.len());
            }
        }
        Ok(Status::Ok)
    })
}

/// The speeds at which an engine order meets a mode of the wave that it excites, omega =
/// engine_order * Omega, found between neighbours of the given speeds and then to rounding. The
/// wave has the signed nodal diameter engine_order mod N: engine order 9 of 10 sectors meets the
/// modes of -1.
///
/// n             number of speeds, at least 1.
/// speeds        rising speeds, rad per time unit; n numbers.
/// diameter      nodal diameter of the diagram, of either sense: an engine order that excites
///               another one meets no mode of it. HBVIB_DIAMETER_OF_ENGINE_ORDER: its own.
/// contacts      HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count         number of modes at each speed, 1 .. ndof.
/// engine_order  at least 1.
/// capacity      room of each of the arrays, >= 0; n * count is enough.
/// speed         receives the speeds, rising, `found` numbers; or NULL if capacity = 0.
/// omega         receives the angular frequencies, `found` numbers; or NULL if capacity = 0.
/// direction     receives the directions, as hbvib_damped_modes, `found` numbers; or NULL.
/// found         receives the number of crossings; if it is above the capacity, no array is filled.
/// hooks         phase and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_DIMENSION (n, count, capacity), HBVIB_E_NOT_FINITE (speeds), HBVIB_E_ARGUMENT
/// (speeds, engine_order), and those of hbvib_damped_modes. Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_campbell_crossings(
    model: *const hbvib_model,
    n: i64,
    speeds: *const f64,
    diameter: i64,
    contacts: i32,
    count: i64,
    engine_order: i64,
    capacity: i64,
    speed: *mut f64,
    omega: *mut f64,
    direction: *mut i64,
    found: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 13) }?;
        let (model, speeds, at) =
            unsafe { diagram(model, (n, speeds), (diameter, Some(engine_order)), contacts, count) }?;
        if engine_order < 1 {
            return fail!(Argument, "engine_order = {engine_order}, needs at least 1").with_argument(7);
        }
        let capacity = self::count(capacity, 8, "capacity")?;
        if capacity > 0 {
            check_pointer(speed, 9, "speed")?;
            check_pointer(omega, 10, "omega")?;
        }
        if !direction.is_null() {
            check_pointer(direction, 11, "direction")?;
        }
        check_pointer(found, 12, "found")?;
        let crossings = unsafe { with_hooks(&hooks, |hooks| campbell(&model, speeds, at, &[engine_order], hooks)) }
            .with_argument(3)?
            .crossings;
        unsafe { found.write(crossings.len() as i64) };
        if crossings.len() > capacity {
            return Ok(Status::Ok);
        }
        for (i, crossing) in crossings.iter().enumerate() {
            unsafe {
                speed.add(i).write(crossing.speed);
                omega.add(i).write(crossing.omega);
                if !direction.is_null() {
                    direction.add(i).write(crossing.direction);
                }
            }
        }
        Ok(Status::Ok)
    })
}

/// Nodal diameter, state of the contacts and number of modes.
type Requested = (i64, LinearContacts, usize);

/// The model, the speeds, and what is requested at each:
/// arguments 1 to 6 of the functions of a Campbell diagram.
///
/// # Safety
/// The caller of the C function states that `n` readable speeds lie at the pointer.
unsafe fn diagram<'a>(
    model: *const hbvib_model,
    (n, speeds): (i64, *const f64),
    (diameter, engine_order): (i64, Option<i64>),
    contacts: i32,
    count: i64,
) -> Result<(Reading<Model>, &'a [f64], Requested)> {
    let model = read::<Model>(model, 1)?;
    let n = self::count(n, 2, "n")?;
    let speeds = unsafe { input(speeds, n, 3, "speeds") }?;
    let engine_order = engine_order.unwrap_or(model.structure().engine_order());
    let diameter = nodal_diameter(&model, diameter, engine_order, 4)?;
    let state = contact_state_of(contacts, 5)?;
    let wanted = modes(count, &model, 6)?;
    Ok((model, speeds, (diameter, state, wanted)))
}
