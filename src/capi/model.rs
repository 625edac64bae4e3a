//! Models: matrices, waves and forces in.

use super::boundary::{Blame, call, check_pointer, count, index};
use super::handles::{free, insert, read, write};
use super::matrix::{matrix_kind, with_matrix};
use super::types::{hbvib_contact_state, hbvib_matrix, hbvib_model, hbvib_status};
use crate::error::{Error, Result, Status, fail};
use crate::model::Model;
use crate::model::linear_modes::ContactState;
use num_complex::Complex64;

/// Creates a plain structure: all matrices zero, no contact, no force.
///
/// ndof  degrees of freedom, 1 .. 2^31.
/// out   receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION, HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_new(ndof: i64, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        check_pointer(out, 2, "out")?;
        let model = Model::new(count(ndof, 1, "ndof")?).blame(1)?;
        unsafe { out.write(insert(model)?) };
        Ok(Status::Ok)
    })
}

/// Creates a cyclic structure, described by one of its sectors, under engine order 0: all matrices
/// zero, no contact, no force.
///
/// ndof_sector  degrees of freedom of the sector, 1 .. 2^31.
/// sectors      number of equal sectors N, 1 .. 2^20.
/// out          receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION (ndof_sector), HBVIB_E_ARGUMENT (sectors), HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_new(ndof_sector: i64, sectors: i64, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        check_pointer(out, 3, "out")?;
        let ndof = count(ndof_sector, 1, "ndof_sector")?;
        let Ok(sectors) = usize::try_from(sectors) else {
            return fail!(Argument, "sectors = {sectors}, needs at least 1").blame(2);
        };
        let model = Model::cyclic(ndof, sectors);
        let model = model.map_err(|e| {
            let argument = if e.status == Status::Dimension { 1 } else { 2 };
            e.in_argument(argument)
        })?;
        unsafe { out.write(insert(model)?) };
        Ok(Status::Ok)
    })
}

/// Sets the mass, damping or stiffness matrix of a structure, or of a sector on itself.
///
/// which  HBVIB_MASS, HBVIB_DAMPING or HBVIB_STIFFNESS.
/// a      ndof x ndof. M must be symmetric or Hermitian; C and K may be HBVIB_GENERAL. Complex
///        entries act on all harmonics above zero, the mean sees their real part.
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
        unsafe { with_matrix(a, 3, model.ndof(), |a| model.set_matrix(which, a)) }?;
        Ok(Status::Ok)
    })
}

/// Adds alpha_mass * M + beta_stiffness * K to the damping; a later call replaces an earlier one.
/// K is the structure's, without contacts.
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
        model.set_rayleigh(alpha_mass, beta_stiffness).blame(argument)?;
        Ok(Status::Ok)
    })
}

/// Sets the coupling of a sector to the next one: rows of sector s, columns of s + 1. The coupling
/// to the previous sector is its transpose unless hbvib_cyclic_set_coupling_previous is called.
///
/// which    HBVIB_MASS, HBVIB_DAMPING or HBVIB_STIFFNESS.
/// to_next  ndof x ndof, any matrix whatever its `part` promises; of a triangle, the mirror image
///          is completed.
/// Where sector s + 1 lags by phi, harmonic p sees A0 + A1 exp(-i p phi) + A1^T exp(i p phi).
/// Errors: as hbvib_model_set_matrix; HBVIB_E_UNSUPPORTED for a plain structure.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_coupling(
    model: *mut hbvib_model,
    which: i32,
    to_next: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        unsafe { with_matrix(to_next, 3, model.ndof(), |a| model.set_coupling(which, a)) }?;
        Ok(Status::Ok)
    })
}

/// Sets the coupling of a sector (rows) to the previous one (columns), for damping and stiffness
/// without symmetry.
///
/// which        HBVIB_DAMPING or HBVIB_STIFFNESS.
/// to_previous  ndof x ndof, any matrix.
/// Errors: as hbvib_cyclic_set_coupling; HBVIB_E_UNSUPPORTED for the mass.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_coupling_previous(
    model: *mut hbvib_model,
    which: i32,
    to_previous: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        unsafe { with_matrix(to_previous, 3, model.ndof(), |a| model.set_coupling_previous(which, a)) }?;
        Ok(Status::Ok)
    })
}

/// Sets the matrix of the wave in which sector s + 1 lags by 2 pi diameter / N, instead of sector
/// blocks. Waves that run the other way see its conjugate. A harmonic whose diameter was not given
/// is an error when it is needed.
///
/// which     HBVIB_MASS, HBVIB_DAMPING or HBVIB_STIFFNESS.
/// diameter  nodal diameter, 0 .. N/2.
/// a         ndof x ndof, Hermitian; C and K may be HBVIB_GENERAL.
/// Errors: as hbvib_model_set_matrix; HBVIB_E_ARGUMENT for a diameter out of range and for
/// matrices that were given by sector blocks. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_diameter(
    model: *mut hbvib_model,
    which: i32,
    diameter: i64,
    a: *const hbvib_matrix,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let which = matrix_kind(which)?;
        let diameter = nodal_diameter(&model, diameter, 3)?;
        unsafe { with_matrix(a, 4, model.ndof(), |a| model.set_diameter(which, diameter, a)) }?;
        Ok(Status::Ok)
    })
}

fn nodal_diameter(model: &Model, diameter: i64, argument: i32) -> Result<usize> {
    let sectors = model.structure().sectors();
    match usize::try_from(diameter) {
        Ok(d) if d <= sectors / 2 => Ok(d),
        _ => Err(Error::new(
            Status::Argument,
            format_args!(
                "diameter = {diameter}, needs 0 .. {} for {sectors} sectors; a wave of {diameter} diameters is that of {}",
                sectors / 2,
                model.structure().fold(diameter).0
            ),
        )
        .in_argument(argument)),
    }
}

/// Sets the engine order of the excitation: sector s + 1 lags behind sector s by 2 pi EO / N per
/// harmonic, so that harmonic p lives on nodal diameter p EO mod N. Any sign and size; a plain
/// structure does not notice.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_wave(model: *mut hbvib_model, engine_order: i64) -> hbvib_status {
    call(|| {
        write::<Model>(model, 1)?.set_wave(engine_order);
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

/// Frees a model. Branches solved from it stay. NULL is nothing to free and a success.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_BUSY (a call is using it: the model
/// stays alive). Threads: any, once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_free(model: *mut hbvib_model) -> hbvib_status {
    call(|| free::<Model>(model, 1).map(|()| Status::Ok))
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
            return fail!(Argument, "harmonic = {harmonic}, needs at least 0").blame(3);
        };
        let argument = match (re.is_finite(), im.is_finite()) {
            (false, _) => 4,
            (_, false) => 5,
            _ if harmonic == 0 => 5,
            _ => 3,
        };
        model.add_force(dof, harmonic, Complex64::new(re, im)).blame(argument)?;
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

/// Undamped natural modes, in ascending order of frequency. Motion without mass has no mode, so a
/// singular mass matrix gives fewer modes than degrees of freedom.
///
/// diameter  nodal diameter 0 .. N/2 of the wave whose sector s + 1 lags; 0 for a plain structure.
/// contacts  HBVIB_CONTACTS_FREE, or HBVIB_CONTACTS_STUCK: linear springs kt.
/// count     modes wanted, at least 1.
/// omega     receives `count` natural angular frequencies.
/// shapes    receives `count` complex shapes of ndof numbers each, one after the other, with
///           phi^H M phi = 1 over one sector; or NULL.
/// Errors: HBVIB_E_ARGUMENT (diameter, contacts), HBVIB_E_DIMENSION (more modes wanted than there
/// are), HBVIB_E_NOT_HERMITIAN, HBVIB_E_NOT_POSITIVE_DEFINITE, HBVIB_E_SINGULAR,
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
    call(|| {
        let model = read::<Model>(model, 1)?;
        let diameter = nodal_diameter(&model, diameter, 2)?;
        let state = contact_state(contacts)?;
        let wanted = usize::try_from(count).unwrap_or(0);
        check_pointer(omega, 5, "omega")?;
        if !shapes.is_null() {
            check_pointer(shapes, 6, "shapes")?;
        }
        if wanted == 0 || wanted > model.ndof() {
            return fail!(Dimension, "count = {count}, needs 1 .. ndof = {}", model.ndof()).blame(4);
        }
        let modes = model.lowest_modes(diameter, state, wanted)?;
        if wanted > modes.omega.len() {
            return fail!(
                Dimension,
                "count = {count}, but only {} modes have mass",
                modes.omega.len()
            )
            .blame(4);
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

fn contact_state(value: i32) -> Result<ContactState> {
    const FREE: i32 = hbvib_contact_state::HBVIB_CONTACTS_FREE as i32;
    const STUCK: i32 = hbvib_contact_state::HBVIB_CONTACTS_STUCK as i32;
    match value {
        FREE => Ok(ContactState::Free),
        STUCK => Ok(ContactState::Stuck),
        _ => fail!(
            Argument,
            "contacts = {value}, needs HBVIB_CONTACTS_FREE = 0 or HBVIB_CONTACTS_STUCK = 1"
        ),
    }
    .blame(3)
}
