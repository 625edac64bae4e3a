//! Section "Cyclic structures" of the header.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{insert, read, write};
use crate::capi::structures::matrices::{hbvib_matrix, matrix_kind, with_matrix};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;

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
            return fail!(Argument, "sectors = {sectors}, needs at least 1").with_argument(2);
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

/// Sets the coupling of a sector to the next one: rows of sector s, columns of s + 1. The coupling
/// to the previous sector is its transpose unless hbvib_cyclic_set_coupling_previous is called.
///
/// which    HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2; the coupling of HBVIB_GYROSCOPIC to the previous
///          sector is minus the transpose.
/// to_next  ndof x ndof, any matrix: `part` is no promise of symmetry here; a triangle is completed
///          by its mirror image.
/// Where sector s + 1 lags by phi, harmonic p has the matrix A0 + A1 exp(-i p phi) + A1^T exp(i p
/// phi).
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
        unsafe {
            with_matrix(to_next, (coupling(which), 3), model.ndof(), |a| {
                model.set_coupling(which, a)
            })
        }?;
        Ok(Status::Ok)
    })
}

/// Sets the coupling of a sector (rows) to the previous one (columns), for damping and stiffness
/// without symmetry.
///
/// which        any but HBVIB_MASS and HBVIB_GYROSCOPIC, which have a symmetry.
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
        unsafe {
            with_matrix(to_previous, (coupling(which), 3), model.ndof(), |a| {
                model.set_coupling_previous(which, a)
            })
        }?;
        Ok(Status::Ok)
    })
}

/// Sets the matrix of the wave in which sector s + 1 lags by 2 pi diameter / N, instead of sector
/// blocks. A wave of which only the other sense was given has the conjugate of that. A solve that
/// needs a harmonic without a matrix of its nodal diameter is refused.
///
/// which     HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2.
/// diameter  signed nodal diameter, modulo N: -N/2 < d <= N/2; 0 for a plain structure.
/// a         ndof x ndof, Hermitian; all but M may be HBVIB_GENERAL or HBVIB_SYMMETRIC.
/// Errors: as hbvib_model_set_matrix; HBVIB_E_ARGUMENT for a diameter of a plain structure
/// and for matrices that were given by sector blocks. Threads: one at a time per model.
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
        if is_of_engine_order(diameter) {
            return fail!(
                Argument,
                "diameter = {diameter}, needs a number of waves: a matrix belongs to one"
            )
            .with_argument(3);
        }
        model.structure().check_diameter(diameter).with_argument(3)?;
        unsafe {
            with_matrix(a, (which.name(), 4), model.ndof(), |a| {
                model.set_diameter(which, diameter, a)
            })
        }?;
        Ok(Status::Ok)
    })
}

/// A nodal diameter that is no number of waves; these are signed and count modulo N.
#[repr(C)]
pub enum hbvib_special_diameter {
    /// The wave that the engine order of the model excites, or that of the same call.
    HBVIB_DIAMETER_OF_ENGINE_ORDER = -2_147_483_647,
}

/// Whether a nodal diameter is that of the engine order.
pub(crate) fn is_of_engine_order(diameter: i64) -> bool {
    diameter == hbvib_special_diameter::HBVIB_DIAMETER_OF_ENGINE_ORDER as i64
}

/// The signed nodal diameter of a number of waves per turn, or of an engine order.
pub(crate) fn nodal_diameter(model: &Model, diameter: i64, engine_order: i64, argument: i32) -> Result<i64> {
    let structure = model.structure();
    if is_of_engine_order(diameter) {
        return Ok(structure.signed_diameter(engine_order));
    }
    structure.check_diameter(diameter).with_argument(argument)?;
    Ok(structure.signed_diameter(diameter))
}

/// The signed nodal diameter of a number of waves per turn, as results have it: waves mod N in
/// -N/2 < d <= N/2. It is the wave that the engine order `waves` excites; in harmonic p that of
/// p waves. 0 for a plain structure.
///
/// diameter  receives it.
/// Errors: HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one
/// model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_signed_diameter(
    model: *const hbvib_model,
    waves: i64,
    diameter: *mut i64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        check_pointer(diameter, 3, "diameter")?;
        unsafe { diameter.write(model.structure().signed_diameter(waves)) };
        Ok(Status::Ok)
    })
}

/// Sets the engine order EO of the excitation: sector s + 1 lags behind sector s by 2 pi EO / N per
/// harmonic, so that harmonic p has the nodal diameter p EO mod N. Any sign and size; without
/// effect on a plain structure.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_wave(model: *mut hbvib_model, engine_order: i64) -> hbvib_status {
    call(|| {
        write::<Model>(model, 1)?.set_wave(engine_order);
        Ok(Status::Ok)
    })
}

/// Name of a coupling in errors.
fn coupling(which: MatrixKind) -> &'static str {
    match which {
        MatrixKind::Mass => "coupling of the mass",
        MatrixKind::Damping => "coupling of the damping",
        MatrixKind::Stiffness => "coupling of the stiffness",
        MatrixKind::Structural => "coupling of the structural damping",
        MatrixKind::Gyroscopic => "coupling of the gyroscopic matrix",
        MatrixKind::StiffnessSpeed2 => "coupling of stiffness_speed2",
    }
}
