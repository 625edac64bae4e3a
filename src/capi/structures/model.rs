//! Section "Model" of the header: a structure, its matrices, springs and forces.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call, call_count, call_to_free};
use crate::capi::crossing::handles::{Kept, Object, free, insert, read, write};
use crate::capi::crossing::indices::{GROUND, Sides, index, indices, with_named_argument};
use crate::capi::structures::matrices::{hbvib_matrix, matrix_kind, with_matrix};
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail, try_push};
use crate::model::Model;
use crate::model::matrices::spring::Spring;
use num_complex::Complex64;

/// A structure with its contacts and forces, created by hbvib_model_new or hbvib_cyclic_new.
pub struct hbvib_model(());

impl Kept for Model {
    type Opaque = hbvib_model;
    const TAG: u64 = 1;
    const NAME: &'static str = "model";

    fn wrap(object: Vec<Self>) -> Object {
        Object::Model(object)
    }

    fn pick(object: &mut Object) -> Option<*mut Self> {
        match object {
            Object::Model(one) => Some(one.as_mut_ptr()),
            _ => None,
        }
    }

    fn holds(object: &Object) -> bool {
        matches!(object, Object::Model(_))
    }
}

const _: () = assert!(hbvib_special_dof::HBVIB_GROUND as i64 == GROUND);

/// Special degrees of freedom.
#[repr(C)]
pub enum hbvib_special_dof {
    /// The ground, which does not move.
    HBVIB_GROUND = -1,
}

/// Creates a plain structure: all matrices zero, no contact, no force.
///
/// ndof  degrees of freedom, 1 .. 2^31.
/// out   receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION, HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_new(ndof: i64, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        check_pointer(out, 2, "out")?;
        let model = Model::new(count(ndof, 1, "ndof")?).with_argument(1)?;
        unsafe { out.write(insert(model)?) };
        Ok(Status::Ok)
    })
}

/// Copies a model.
///
/// out  receives the copy; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed), HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may copy and solve one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_clone(model: *const hbvib_model, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        check_pointer(out, 2, "out")?;
        unsafe { out.write(insert(model.try_clone()?)?) };
        Ok(Status::Ok)
    })
}

/// Frees a model. Branches solved from it stay. NULL is accepted and does nothing.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_BUSY (a call uses the model, which
/// then stays). Threads: any, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_free(model: *mut hbvib_model) -> hbvib_status {
    call_to_free(|| free::<Model>(model, 1).map(|()| Status::Ok))
}

/// Number of degrees of freedom of a model, of one sector if it is cyclic; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_dofs(model: *const hbvib_model) -> i64 {
    call_count(|| Ok(read::<Model>(model, 1)?.ndof()))
}

/// Number of sectors of a model, 1 for a plain structure; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_sectors(model: *const hbvib_model) -> i64 {
    call_count(|| Ok(read::<Model>(model, 1)?.structure().sectors()))
}

/// Number of contacts of a model, including tables, polynomials and forces of the caller; or a
/// negative status. Contacts are numbered from 0 in the order in which they were added.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_contacts(model: *const hbvib_model) -> i64 {
    call_count(|| Ok(read::<Model>(model, 1)?.contacts().len()))
}

/// Sets a matrix of a structure, or of a sector on itself.
///
/// which  HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2.
/// a      ndof x ndof. M must be symmetric or Hermitian, HBVIB_GYROSCOPIC skew-symmetric (in full,
///        which is checked, or one triangle); the others may be HBVIB_GENERAL or HBVIB_SYMMETRIC.
///        Complex entries act on all harmonics above zero, the mean sees their
///        real part, and no structural damping.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_NOT_HERMITIAN, HBVIB_E_INDEX, each naming the entry;
/// HBVIB_E_DIMENSION, HBVIB_E_ARGUMENT, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_NOT_POSITIVE_DEFINITE (negative diagonal mass), HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_matrix(
    model: *mut hbvib_model,
    which: i32,
    a: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        unsafe { with_matrix(a, (which.name(), 3), model.ndof(), |a| model.set_matrix(which, a)) }?;
        Ok(Status::Ok)
    })
}

/// Fixes degrees of freedom: they do not move, whatever matrices, contacts and forces say, now or
/// later. All numbers of degrees of freedom stay as they are; results of fixed ones are 0. On a
/// sector with faces, a pair is fixed on both sides by the same call.
///
/// n     number of entries, >= 0.
/// dofs  degrees of freedom from 0, n numbers.
/// Errors: HBVIB_E_INDEX (dofs), HBVIB_E_ARGUMENT (a pair fixed on one side only, no degree of
/// freedom left, a contact or spring both sides of which would be fixed), HBVIB_E_DIMENSION (n),
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; the model is then unchanged.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_fix(model: *mut hbvib_model, n: i64, dofs: *const i64) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let n = count(n, 2, "n")?;
        let dofs = unsafe { input(dofs, n, 3, "dofs") }?;
        let dofs = indices(dofs, model.ndof(), 3, "dofs")?;
        model.fix(&dofs).with_argument(3)?;
        Ok(Status::Ok)
    })
}

/// Adds alpha_mass * M + beta_stiffness * K to the damping; a later call replaces an earlier one. K
/// is the stiffness of the structure without contacts.
///
/// alpha_mass, beta_stiffness  finite, 1 / time and time.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_rayleigh(
    model: *mut hbvib_model,
    alpha_mass: f64,
    beta_stiffness: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let argument = if alpha_mass.is_finite() { 3 } else { 2 };
        model.set_rayleigh(alpha_mass, beta_stiffness).with_argument(argument)?;
        Ok(Status::Ok)
    })
}

/// Adds many linear springs from arrays; they take no part in Rayleigh damping. All springs are
/// checked before one is added.
///
/// n              number of springs, >= 0.
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND; n each.
/// sector_offset  sector of side b counted from that of side a, n numbers; NULL: all 0.
/// stiffness      force per length, of any sign; n numbers.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT (both sides the same, sector_offset in a
/// plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_DIMENSION (n), HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY, naming the entry.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_springs(
    model: *mut hbvib_model,
    n: i64,
    dof_a: *const i64,
    dof_b: *const i64,
    sector_offset: *const i64,
    stiffness: *const f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let n = count(n, 2, "n")?;
        let sides = unsafe { Sides::new(dof_a, dof_b, sector_offset, n, model.ndof()) }?;
        let stiffness = unsafe { input(stiffness, n, 6, "stiffness") }?;
        let mut springs = Vec::new();
        for (i, &stiffness) in stiffness.iter().enumerate() {
            let (dof_a, dof_b, sector_offset) = sides.entry(i)?;
            let spring = Spring {
                dof_a,
                dof_b,
                sector_offset,
                stiffness,
            };
            try_push(&mut springs, spring, "the springs")?;
        }
        model.add_springs(&springs).map_err(|e| {
            let arrays = [("stiffness", 6), ("sector_offset", 5), ("dof_a", 3)];
            with_named_argument(e, &arrays)
        })?;
        Ok(Status::Ok)
    })
}

/// Adds the force Re((re + i im) exp(i harmonic omega t)) on a degree of freedom (of sector 1; the
/// others lag with the wave). Forces on the same degree of freedom and harmonic add up.
///
/// dof       0 .. ndof - 1.
/// harmonic  harmonic number, 0 .. 100000; 0 is a constant force.
/// re, im    finite, force, peak; im must be 0 for a constant force.
/// Errors: HBVIB_E_INDEX (dof), HBVIB_E_ARGUMENT (harmonic, im), HBVIB_E_NOT_FINITE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_force(
    model: *mut hbvib_model,
    dof: i64,
    harmonic: i64,
    re: f64,
    im: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let dof = index(dof, model.ndof(), 2, "dof")?;
        let Ok(harmonic) = usize::try_from(harmonic) else {
            return fail!(Argument, "harmonic = {harmonic}, needs at least 0").with_argument(3);
        };
        let argument = match (re.is_finite(), im.is_finite()) {
            (false, _) => 4,
            (_, false) => 5,
            _ if harmonic == 0 => 5,
            _ => 3,
        };
        model
            .add_force(dof, harmonic, Complex64::new(re, im))
            .with_argument(argument)?;
        Ok(Status::Ok)
    })
}

/// Removes all forces.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_clear_forces(model: *mut hbvib_model) -> hbvib_status {
    call(|| {
        write::<Model>(model, 1)?.clear_forces();
        Ok(Status::Ok)
    })
}
