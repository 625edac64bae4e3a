//! Section "Model" of the header: speed of rotation and what follows from it.

#![allow(non_camel_case_types)]

use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::write;
use crate::capi::crossing::indices::{index, with_named_argument};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Status;
use crate::model::Model;
use crate::model::matrices::rotation::Speed;

/// Sets a fixed speed of rotation Omega: M x'' + (C + Omega G) x' + (K + Omega^2 K1) x + f = f_ex
/// with the matrices HBVIB_GYROSCOPIC and HBVIB_STIFFNESS_SPEED2, and the loads of
/// hbvib_model_set_preload_at_speed. Rayleigh damping and the loss factor use K without K1.
///
/// speed  rad per time unit, finite, of any sign.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_speed(model: *mut hbvib_model, speed: f64) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        model.set_speed(Speed::Fixed(speed)).with_argument(2)?;
        Ok(Status::Ok)
    })
}

/// Ties the speed of rotation to the angular frequency omega of the response: Omega = per_omega *
/// omega, along a whole sweep or mode. An excitation of engine order EO has per_omega = 1 / EO.
///
/// per_omega  finite, of any sign.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_ARGUMENT (a load that decreases with the speed),
/// HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_speed_per_omega(model: *mut hbvib_model, per_omega: f64) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        model.set_speed(Speed::PerOmega(per_omega)).with_argument(2)?;
        Ok(Status::Ok)
    })
}

/// Sets the normal load of a contact to preload + per_speed2 * Omega^2; a later call, or one of
/// hbvib_model_set_preload, replaces it. A ring of mass m at the radius R has per_speed2 = m R. A
/// load below zero opens a contact with a normal stiffness, others lose their friction.
///
/// id          number from hbvib_model_add_contact or another function that adds contacts.
/// preload     force at rest, >= 0 and finite.
/// per_speed2  force times time^2, finite; at least 0 where the speed is tied to the frequency.
/// Errors: HBVIB_E_INDEX (id), HBVIB_E_ARGUMENT (no normal load, a negative number),
/// HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_preload_at_speed(
    model: *mut hbvib_model,
    id: i64,
    preload: f64,
    per_speed2: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let id = index(id, model.contacts().len(), 2, "id")?;
        let found = model.set_preload_at_speed(id, preload, per_speed2);
        found.map_err(|e| {
            let arrays = [("per_speed2", 4), ("preload", 3)];
            with_named_argument(e, &arrays)
        })?;
        Ok(Status::Ok)
    })
}

/// Adds the constant force mass_radius * Omega^2 on a degree of freedom, the centrifugal force of a
/// mass at a radius, at the speed Omega of the model. hbvib_model_clear_forces removes it, too.
///
/// dof          0 .. ndof - 1.
/// mass_radius  mass times radius, finite, of any sign.
/// Errors: HBVIB_E_INDEX (dof), HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_centrifugal(
    model: *mut hbvib_model,
    dof: i64,
    mass_radius: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let dof = index(dof, model.ndof(), 2, "dof")?;
        model.add_centrifugal(dof, mass_radius).with_argument(3)?;
        Ok(Status::Ok)
    })
}

/// Adds the force of an unbalance that rotates with the frequency omega of the response:
/// m_e omega^2 cos(omega t + phase) on dof_x and m_e omega^2 sin(omega t + phase) on dof_y.
/// hbvib_model_clear_forces removes it, too.
///
/// dof_x, dof_y  two degrees of freedom, 0 .. ndof - 1.
/// m_e           mass times eccentricity, finite.
/// phase         radians, finite.
/// Errors: HBVIB_E_INDEX (dof_x, dof_y), HBVIB_E_ARGUMENT (the same degree of freedom twice),
/// HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_unbalance(
    model: *mut hbvib_model,
    dof_x: i64,
    dof_y: i64,
    m_e: f64,
    phase: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let x = index(dof_x, model.ndof(), 2, "dof_x")?;
        let y = index(dof_y, model.ndof(), 3, "dof_y")?;
        let argument = match (m_e.is_finite(), phase.is_finite()) {
            (false, _) => 4,
            (_, false) => 5,
            _ => 3,
        };
        model.add_unbalance(x, y, m_e, phase).with_argument(argument)?;
        Ok(Status::Ok)
    })
}
