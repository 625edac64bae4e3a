//! Section "Model" of the header: damping by numbers.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::write;
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::Status;
use crate::model::Model;

/// Sets the loss factor eta of structural damping i eta K in harmonics above 0; a later call
/// replaces an earlier one, 0 removes it. K is the stiffness of the structure, couplings and
/// matrices per nodal diameter included, springs and contacts not. A structure without contacts
/// has the damping ratio eta / 2 at each resonance. Structural damping has no meaning in time:
/// integration and verification refuse it.
///
/// loss_factor  at least 0.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_ARGUMENT, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_loss_factor(model: *mut hbvib_model, loss_factor: f64) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        model.set_loss_factor(loss_factor).with_argument(2)?;
        Ok(Status::Ok)
    })
}

/// Damps the lowest natural modes of each nodal diameter by given ratios, as the viscous matrix sum
/// of 2 ratio omega (M phi)(M phi)^H; other motions are not damped. The modes are those without
/// contacts, with springs. A later call replaces an earlier one, n = 0 removes the damping. Call it
/// when mass, stiffness, springs and fixed degrees of freedom are complete.
///
/// n       number of modes, 0 .. ndof.
/// ratios  damping ratio of each mode in the order of rising frequency, at least 0; n numbers.
/// Errors: HBVIB_E_DIMENSION (n), HBVIB_E_NOT_FINITE or HBVIB_E_ARGUMENT (ratios),
/// HBVIB_E_UNSUPPORTED (more than 2000 degrees of freedom), those of hbvib_linear_modes, after all
/// of which the model is unchanged; HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_modal_damping(
    model: *mut hbvib_model,
    n: i64,
    ratios: *const f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let n = count(n, 2, "n")?;
        let ratios = unsafe { input(ratios, n, 3, "ratios") }?;
        model.set_modal_damping(ratios).with_argument(3)?;
        Ok(Status::Ok)
    })
}
