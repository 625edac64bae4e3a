//! Section "Laws of the caller" of the header: the check of the derivatives that a callback writes.

#![allow(non_camel_case_types)]

use crate::at_a_point::{self, JacobianGap, Tangent};
use crate::capi::crossing::arrays::{count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::indices::index;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::ContactKind;
use crate::error::{Error, Status, fail};
use crate::model::Model;

/// Derivatives that a force callback writes.
#[repr(C)]
pub enum hbvib_tangent {
    /// df_du
    HBVIB_DF_DU = 0,
    /// df_dv
    HBVIB_DF_DV = 1,
    /// df_dz
    HBVIB_DF_DZ = 2,
    /// dz_dz
    HBVIB_DZ_DZ = 3,
    /// dz_du_before
    HBVIB_DZ_DU_BEFORE = 4,
    /// dz_du
    HBVIB_DZ_DU = 5,
    /// dz_dv_before
    HBVIB_DZ_DV_BEFORE = 6,
    /// dz_dv
    HBVIB_DZ_DV = 7,
    /// dz_domega
    HBVIB_DZ_DOMEGA = 8,
}

/// The derivative with the largest distance from its difference quotient. Fill it by
/// hbvib_jacobian_gap_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_jacobian_gap {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_DF_DU and so on (enum hbvib_tangent).
    pub tangent: i32,
    /// |given - difference| times the size of the argument, relative to the size of the function
    /// value: below 1e-6 for right derivatives of a smooth force, 2 for a wrong sign.
    pub gap: f64,
    /// Sample of the test motion.
    pub sample: i64,
    /// Row of the entry.
    pub row: i64,
    /// Column of the entry; for HBVIB_DF_DZ the state that was changed before the step.
    pub column: i64,
    /// Derivative that the callback wrote; for HBVIB_DF_DZ the change of force that follows from
    /// it.
    pub given: f64,
    /// Difference quotient of the callback's own f and z.
    pub difference: f64,
}

unsafe impl VersionedStruct for hbvib_jacobian_gap {
    const NAME: &'static str = "hbvib_jacobian_gap";
    const FIRST_SIZE: usize = 56;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            tangent: 0,
            gap: 0.0,
            sample: 0,
            row: 0,
            column: 0,
            given: 0.0,
            difference: 0.0,
        }
    }
}

/// Fills a gap with zeros.
///
/// gap          the struct; untouched on error.
/// size_of_gap  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_jacobian_gap_init(gap: *mut hbvib_jacobian_gap, size_of_gap: usize) -> hbvib_status {
    call(|| unsafe { init(gap, size_of_gap) })
}

/// Compares every derivative that a force of the caller writes with central differences of its own
/// f and z, on a built-in motion with a mean and the harmonics 1 and 3. The status is HBVIB_OK also
/// for a large gap: check its value. A solve with wrong derivatives ends in HBVIB_E_NO_CONVERGENCE
/// or needs many iterations.
///
/// contact        number from hbvib_model_add_user_force.
/// omega          angular frequency, > 0.
/// amplitude      about the largest motion of each degree of freedom of the force, > 0: the motion
///                should reach all regimes of the force.
/// amplitude_len  number of the amplitudes: one for each degree of freedom of the force.
/// out            receives the worst entry; untouched on error.
/// Errors: HBVIB_E_INDEX (contact), HBVIB_E_ARGUMENT (not a force of the caller, omega, amplitude),
/// HBVIB_E_DIMENSION (amplitude_len), HBVIB_E_CALLBACK, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_check_jacobian(
    model: *const hbvib_model,
    contact: i64,
    omega: f64,
    amplitude: *const f64,
    amplitude_len: i64,
    out: *mut hbvib_jacobian_gap,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let contact = index(contact, model.contacts().len(), 2, "contact")?;
        if !matches!(model.contacts()[contact].kind, ContactKind::User(_)) {
            return fail!(Argument, "contact {contact} is not a force of the caller's").with_argument(2);
        }
        let len = count(amplitude_len, 5, "amplitude_len")?;
        let amplitudes = unsafe { input(amplitude, len, 4, "amplitude") }?;
        unsafe { check_out(out, 6) }?;
        let found = at_a_point::check_jacobian(&model, contact, omega, amplitudes);
        let gap = found.map_err(|e| with_checked_argument(e, omega))?;
        unsafe { fill_out(out, gap.into()) };
        Ok(Status::Ok)
    })
}

/// Attributes an error that only the analysis finds to its argument.
fn with_checked_argument(e: Error, omega: f64) -> Error {
    match e.status {
        Status::Dimension => e.in_argument(5),
        Status::Argument if !(omega > 0.0 && omega.is_finite()) => e.in_argument(3),
        Status::Argument => e.in_argument(4),
        _ => e,
    }
}

impl From<JacobianGap> for hbvib_jacobian_gap {
    fn from(found: JacobianGap) -> Self {
        let tangent = match found.tangent {
            Tangent::ForceByMotion => hbvib_tangent::HBVIB_DF_DU,
            Tangent::ForceByVelocity => hbvib_tangent::HBVIB_DF_DV,
            Tangent::ForceByState => hbvib_tangent::HBVIB_DF_DZ,
            Tangent::StateByState => hbvib_tangent::HBVIB_DZ_DZ,
            Tangent::StateByMotionBefore => hbvib_tangent::HBVIB_DZ_DU_BEFORE,
            Tangent::StateByMotion => hbvib_tangent::HBVIB_DZ_DU,
            Tangent::StateByVelocityBefore => hbvib_tangent::HBVIB_DZ_DV_BEFORE,
            Tangent::StateByVelocity => hbvib_tangent::HBVIB_DZ_DV,
            Tangent::StateByFrequency => hbvib_tangent::HBVIB_DZ_DOMEGA,
        };
        Self {
            struct_size: 0,
            tangent: tangent as i32,
            gap: found.gap,
            sample: found.sample as i64,
            row: found.row as i64,
            column: found.column as i64,
            given: found.given,
            difference: found.difference,
        }
    }
}
