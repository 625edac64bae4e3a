//! Section "Contacts" of the header: dampers under the platforms of blades.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::write;
use crate::capi::crossing::indices::{self, GROUND};
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail, try_push};
use crate::model::Model;
use crate::model::damper::{Damper, DamperFace};
use core::ptr;

/// A face of a damper on a platform. Fill it by hbvib_damper_face_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_damper_face {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Must be 0.
    pub reserved: i32,
    /// Degrees of freedom of the platform along x, y and z of the damper, or HBVIB_GROUND.
    pub dofs: [i64; 3],
    /// Cyclic models: the platform belongs to sector s + sector_offset.
    pub sector_offset: i64,
    /// Angle between the platform and the direction along the wheel in radians: positive on the side
    /// of the next sector, negative on the other one.
    pub angle: f64,
    /// Angle in radians by which the axes of `dofs` are turned about z against those of the damper.
    pub turn: f64,
    /// Middle of the face from the centre of mass; without effect on a cylinder.
    pub centre: [f64; 3],
    /// Width across z, over which points are spread; without effect on a cylinder.
    pub width: f64,
    /// Points across z, >= 1; one on a cylinder.
    pub points_across: i64,
    /// Points along z, >= 1; one with 3 motions.
    pub points_along: i64,
    /// Tangential stiffness of the whole face, force per length, >= 0.
    pub kt: f64,
    /// Normal stiffness of the whole face, force per length, > 0.
    pub kn: f64,
    /// Friction coefficient, >= 0.
    pub mu: f64,
    /// Play along the normal, of any sign.
    pub gap: f64,
}

unsafe impl VersionedStruct for hbvib_damper_face {
    const NAME: &'static str = "hbvib_damper_face";
    const FIRST_SIZE: usize = 136;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            reserved: 0,
            dofs: [GROUND; 3],
            sector_offset: 0,
            angle: 0.0,
            turn: 0.0,
            centre: [0.0; 3],
            width: 0.0,
            points_across: 1,
            points_along: 1,
            kt: 0.0,
            kn: 0.0,
            mu: 0.0,
            gap: 0.0,
        }
    }
}

/// Fills a face: the ground, one point, the rest zero.
///
/// f          the struct; untouched on error.
/// size_of_f  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_damper_face_init(f: *mut hbvib_damper_face, size_of_f: usize) -> hbvib_status {
    call(|| unsafe { init(f, size_of_f) })
}

/// A damper under platforms, a rigid body. Its axes: x along the wheel towards the next sector, y
/// outward, z along the axis of rotation. Fill it by hbvib_damper_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_damper {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 3: motions along x and y and the roll about z; 6: translations along x, y and z and rotations
    /// about them.
    pub motions: i32,
    /// Mass, > 0.
    pub mass: f64,
    /// Moments of inertia about x, y and z through the centre of mass; all zero: those of a solid
    /// cylinder of radius and length.
    pub inertia: [f64; 3],
    /// Radius of a cylinder, whose faces are lines; 0: faces have their centres and widths.
    pub radius: f64,
    /// Length along z, over which points are spread.
    pub length: f64,
    /// Distance of the centre of mass from the axis of rotation: the force mass * orbit * Omega^2
    /// acts outward.
    pub orbit: f64,
    /// Stiffness between the ground and each translation, and each rotation, >= 0.
    pub support: [f64; 2],
    /// Damping constants of the same, >= 0.
    pub support_damping: [f64; 2],
    /// Faces, at least one.
    pub faces: *const hbvib_damper_face,
    /// Number of faces.
    pub faces_len: i64,
}

unsafe impl VersionedStruct for hbvib_damper {
    const NAME: &'static str = "hbvib_damper";
    const FIRST_SIZE: usize = 112;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            motions: 3,
            mass: 0.0,
            inertia: [0.0; 3],
            radius: 0.0,
            length: 0.0,
            orbit: 0.0,
            support: [0.0; 2],
            support_damping: [0.0; 2],
            faces: ptr::null(),
            faces_len: 0,
        }
    }
}

/// Fills a damper: 3 motions, the rest zero.
///
/// d          the struct; untouched on error.
/// size_of_d  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_damper_init(d: *mut hbvib_damper, size_of_d: usize) -> hbvib_status {
    call(|| unsafe { init(d, size_of_d) })
}

/// Adds a damper under platforms: its motions are new degrees of freedom behind all others, so that
/// the model has `motions` more, and matrices that are set later have the new size. Its faces are
/// contacts HBVIB_FRICTION_2D (3 motions) or HBVIB_FRICTION_3D under the load that presses them.
/// Its mass, support and centrifugal force are added. In a cyclic model each sector has one.
/// Rayleigh damping applies to its mass and support as well.
///
/// damper         the description.
/// first_dof      receives the number of its first motion; the others follow. Or NULL.
/// first_contact  receives the number of its first contact; the others follow, face after face,
///                across z and then along it. Or NULL.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE and HBVIB_E_INDEX (fields of the damper or of a
/// face, which is named), HBVIB_E_DIMENSION (too many degrees of freedom), HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; the model is unchanged then.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_damper(
    model: *mut hbvib_model,
    damper: *const hbvib_damper,
    first_dof: *mut i64,
    first_contact: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let d = unsafe { load(damper, 2) }?;
        for (p, argument, name) in [(first_dof, 3, "first_dof"), (first_contact, 4, "first_contact")] {
            if !p.is_null() {
                check_pointer(p, argument, name)?;
            }
        }
        let faces = unsafe { faces(&d, model.ndof()) }.with_argument(2)?;
        let damper = Damper {
            motions: usize::try_from(d.motions).unwrap_or(0),
            mass: d.mass,
            inertia: d.inertia,
            radius: d.radius,
            length: d.length,
            orbit: d.orbit,
            support: d.support,
            support_damping: d.support_damping,
            faces: &faces,
        };
        let place = model.add_damper(&damper).with_argument(2)?;
        for (p, value) in [(first_dof, place.dofs.start), (first_contact, place.contacts.start)] {
            if !p.is_null() {
                unsafe { p.write(value as i64) };
            }
        }
        Ok(Status::Ok)
    })
}

/// The faces of a description, whose distance is the size that the first one states.
unsafe fn faces(d: &hbvib_damper, ndof: usize) -> Result<Vec<DamperFace>> {
    let n = count(d.faces_len, 2, "faces_len")?;
    let mut faces = Vec::new();
    if n == 0 {
        return Ok(faces);
    }
    check_pointer(d.faces, 2, "faces")?;
    let distance = unsafe { d.faces.cast::<u32>().read() } as usize;
    for i in 0..n {
        let one = unsafe { load(d.faces.byte_add(i * distance), 2) }.map_err(|e| e.at(format_args!("faces[{i}]")))?;
        if one.struct_size as usize != distance || one.reserved != 0 {
            return fail!(
                StructSize,
                "faces[{i}]: struct_size = {}, reserved = {}, needs {distance} as the first, and 0",
                one.struct_size,
                one.reserved
            );
        }
        try_push(&mut faces, face(&one, i, ndof)?, "the faces of a damper")?;
    }
    Ok(faces)
}

fn face(f: &hbvib_damper_face, i: usize, ndof: usize) -> Result<DamperFace> {
    let mut dofs = [None; 3];
    for (k, (place, &dof)) in dofs.iter_mut().zip(&f.dofs).enumerate() {
        *place = indices::side(dof, ndof, 2, format_args!("faces[{i}]: dofs[{k}]"))?;
    }
    Ok(DamperFace {
        dofs,
        sector_offset: f.sector_offset,
        angle: f.angle,
        turn: f.turn,
        centre: f.centre,
        width: f.width,
        points: [f.points_across, f.points_along].map(|n| usize::try_from(n).unwrap_or(0)),
        stiffness: [f.kt, f.kn],
        mu: f.mu,
        gap: f.gap,
    })
}
