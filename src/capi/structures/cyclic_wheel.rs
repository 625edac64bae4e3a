//! Section "Cyclic structures" of the header: the whole wheel, and patterns of mistuning.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{insert, read, write};
use crate::capi::crossing::indices::{index, indices};
use crate::capi::structures::matrices::{hbvib_matrix, with_matrix};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;
use crate::model::matrices::structure::MatrixKind;
use crate::model::wheels::mistuning::{BladeProperty, Mistuning};

/// Makes the whole wheel of a cyclic model as a plain model, for every analysis. Degree of freedom
/// i of sector s is s * ndof + i and contact c is s * contacts + c, with ndof degrees of freedom
/// and `contacts` contacts of a sector; sectors count from 0. The phases of the engine order are
/// in the forces. Forces of several engine orders e at one speed are those in harmonics e of a
/// model under engine order 1. A degree of freedom on the right face of a sector keeps its number;
/// the left face of the next sector moves it, each in the frame of its own sector.
///
/// cyclic  model of a sector; later changes of it have no effect on the wheel.
/// out     receives the wheel; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_UNSUPPORTED (a plain model, complex aerodynamic forces, aerodynamic forces per
/// displacement with damping by stiffness, a contact or spring with another sector in a Cartesian
/// frame), HBVIB_E_ARGUMENT (a nodal diameter without matrix), HBVIB_E_DIMENSION (too large),
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one
/// model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_wheel_new(cyclic: *const hbvib_model, out: *mut *mut hbvib_model) -> hbvib_status {
    call(|| {
        let cyclic = read::<Model>(cyclic, 1)?;
        check_pointer(out, 2, "out")?;
        let wheel = cyclic.wheel().with_argument(1)?;
        unsafe { out.write(insert(wheel)?) };
        Ok(Status::Ok)
    })
}

/// Quantities that differ between the sectors of a wheel, by delta of each.
#[repr(C)]
pub enum hbvib_mistuning {
    /// Stiffness of the blade times 1 + delta.
    HBVIB_MISTUNING_STIFFNESS = 0,
    /// Frequencies of the blade, clamped where it is attached, times 1 + delta.
    HBVIB_MISTUNING_FREQUENCY = 1,
    /// Mass of the degrees of freedom of the blade times 1 + delta.
    HBVIB_MISTUNING_MASS = 2,
    /// Damping of the blade over its attachment times 1 + delta: damping matrix, Rayleigh damping.
    HBVIB_MISTUNING_DAMPING = 3,
    /// Normal load of a contact times 1 + delta.
    HBVIB_MISTUNING_PRELOAD = 4,
    /// Forces on the sector times 1 + delta.
    HBVIB_MISTUNING_FORCE = 5,
}

/// Mistunes a wheel. Changes of matrices refer to the cyclic model, and several calls add up; loads
/// and forces are multiplied. A blade is given by its degrees of freedom: its stiffness is that of
/// its motion relative to the one that its attachment carries along, so that a rigid motion of a
/// free blade has none and the clamped blade has all of it. Rayleigh damping follows the matrices.
///
/// wheel      made by hbvib_wheel_new of `cyclic`; unchanged on error.
/// cyclic     the model of the sector.
/// kind       a value of enum hbvib_mistuning.
/// n_dofs     degrees of freedom of the blade of a sector, 0 with a direction and for
///            HBVIB_MISTUNING_PRELOAD and HBVIB_MISTUNING_FORCE.
/// dofs       their numbers, n_dofs numbers, each once, none on the right face.
/// direction  matrix of a sector, delta times which is added to stiffness, mass or damping, instead
///            of a blade; not with HBVIB_MISTUNING_FREQUENCY. Or NULL.
/// contact    contact of the sector for HBVIB_MISTUNING_PRELOAD, -1: all with a normal load; else
///            without effect.
/// sectors    length of delta, the number of sectors.
/// delta      of each sector, finite; with dofs at least -1.
/// Errors: HBVIB_E_ARGUMENT (kind, dofs twice or none that moves, neither dofs nor direction, or
/// both; delta with dofs; a load below 0; matrices of `cyclic` that the wheel was not made of),
/// HBVIB_E_INDEX (dofs, contact), HBVIB_E_DIMENSION (another model or number of sectors, n_dofs),
/// HBVIB_E_NOT_FINITE (delta), HBVIB_E_SINGULAR (the stiffness of the clamped blade),
/// HBVIB_E_UNSUPPORTED (a stiffness without symmetry, an attachment that is too large), those of
/// hbvib_model_set_matrix for the direction; HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per wheel.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_wheel_mistune(
    wheel: *mut hbvib_model,
    cyclic: *const hbvib_model,
    kind: i32,
    n_dofs: i64,
    dofs: *const i64,
    direction: *const hbvib_matrix,
    contact: i64,
    sectors: i64,
    delta: *const f64,
) -> hbvib_status {
    call(|| {
        let n_dofs = count(n_dofs, 4, "n_dofs")?;
        let dofs = unsafe { input(dofs, n_dofs, 5, "dofs") }?;
        let sectors = count(sectors, 8, "sectors")?;
        let delta = unsafe { input(delta, sectors, 9, "delta") }?;
        let mut wheel = write::<Model>(wheel, 1)?;
        let cyclic = read::<Model>(cyclic, 2)?;
        let kind = quantity(kind).with_argument(3)?;
        let dofs = indices(dofs, cyclic.ndof(), 5, "dofs")?;
        let (property, which) = match kind {
            Quantity::Blade(property, which) => (property, which),
            Quantity::Preload if contact == -1 => {
                return changed(&mut wheel, &cyclic, &Mistuning::Preload(None), delta);
            }
            Quantity::Preload => {
                let id = index(contact, cyclic.contacts().len(), 7, "contact")?;
                return changed(&mut wheel, &cyclic, &Mistuning::Preload(Some(id)), delta);
            }
            Quantity::Force => return changed(&mut wheel, &cyclic, &Mistuning::Force, delta),
        };
        unsafe {
            with_blade((property, which), (&dofs, 4), (direction, 6), cyclic.ndof(), |what| {
                changed(&mut wheel, &cyclic, what, delta)
            })
        }
    })
}

enum Quantity {
    Blade(BladeProperty, Option<MatrixKind>),
    Preload,
    Force,
}

fn quantity(kind: i32) -> Result<Quantity> {
    Ok(match kind {
        0 => Quantity::Blade(BladeProperty::Stiffness, Some(MatrixKind::Stiffness)),
        1 => Quantity::Blade(BladeProperty::Frequency, None),
        2 => Quantity::Blade(BladeProperty::Mass, Some(MatrixKind::Mass)),
        3 => Quantity::Blade(BladeProperty::Damping, Some(MatrixKind::Damping)),
        4 => Quantity::Preload,
        5 => Quantity::Force,
        other => return fail!(Argument, "kind = {other}, needs HBVIB_MISTUNING_STIFFNESS = 0 .. 5"),
    })
}

/// Passes a property of the blades, by their degrees of freedom or by a direction, to `then`. Each has the number of its argument.
unsafe fn with_blade<T>(
    (property, which): (BladeProperty, Option<MatrixKind>),
    (dofs, n_dofs_at): (&[usize], i32),
    (direction, at): (*const hbvib_matrix, i32),
    n: usize,
    then: impl FnOnce(&Mistuning<'_>) -> Result<T>,
) -> Result<T> {
    match (dofs.is_empty(), direction.is_null(), which) {
        (false, true, _) => then(&Mistuning::Blade(property, dofs)),
        (true, false, Some(which)) => unsafe {
            with_matrix(direction, ("direction", at), n, |a| then(&Mistuning::Matrix(which, a)))
        },
        (true, false, None) => {
            fail!(Argument, "a direction for frequencies; needs the dofs of a blade").with_argument(at)
        }
        (true, true, _) => fail!(Argument, "n_dofs = 0 and no direction; needs one of them").with_argument(n_dofs_at),
        (false, false, _) => fail!(Argument, "dofs and a direction; needs one of them").with_argument(at),
    }
}

/// The same by the number of a kind, which is one of the blades.
///
/// # Safety
/// As for [`with_matrix`].
pub(crate) unsafe fn with_quantity<T>(
    (kind, kind_at): (i32, i32),
    dofs: (&[usize], i32),
    direction: (*const hbvib_matrix, i32),
    n: usize,
    then: impl FnOnce(&Mistuning<'_>) -> Result<T>,
) -> Result<T> {
    let Quantity::Blade(property, which) = quantity(kind).with_argument(kind_at)? else {
        return fail!(
            Unsupported,
            "kind = {kind}: modes show no loads and forces; needs a stiffness, frequency or mass"
        )
        .with_argument(kind_at);
    };
    unsafe { with_blade((property, which), dofs, direction, n, then) }
}

fn changed(wheel: &mut Model, cyclic: &Model, what: &Mistuning<'_>, delta: &[f64]) -> Result<Status> {
    wheel.mistune(cyclic, what, delta).with_argument(9)?;
    Ok(Status::Ok)
}
