//! Section "Cyclic structures" of the header: a sector from its faces.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::insert;
use crate::capi::crossing::indices::{GROUND, indices};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_reserved, init, load};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail, try_push};
use crate::model::Model;
use crate::model::matrices::sector_faces::{SectorDescription, SectorFrame};
use crate::model::matrices::structure::MAX_DOF;
use core::ptr;

/// Frame of the degrees of freedom of a sector with faces.
#[repr(C)]
pub enum hbvib_sector_frame {
    /// x, y and z of each node, and rotations about them: the axes of both faces are equal.
    HBVIB_CARTESIAN = 0,
    /// Any frame that turns with the sector, as radius, circumference and axis at each node.
    HBVIB_CYLINDRICAL = 1,
}

/// A sector with degrees of freedom on both faces, as a finite-element program writes it. The
/// right face of a sector is the left one of the next. Fill it by hbvib_sector_init, then set ndof,
/// sectors, engine_order and the faces.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_sector {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_CARTESIAN or HBVIB_CYLINDRICAL.
    pub frame: i32,
    /// Degrees of freedom of the sector, both faces and the fixed ones included, 1 .. 2^31.
    pub ndof: i64,
    /// Number of equal sectors N, 2 .. 2^20.
    pub sectors: i64,
    /// Engine order of the wave, see hbvib_cyclic_set_wave; its sign is the sense of the wave.
    pub engine_order: i64,
    /// Degrees of freedom of a node on a face: 3 (x, y, z) or 6 (and the rotations about them) in a
    /// Cartesian frame, any number in a cylindrical one.
    pub components: i64,
    /// Degrees of freedom of the left face, node after node, left_len numbers; -1 where a component
    /// is missing, which then does not move.
    pub left: *const i64,
    /// Entries in left.
    pub left_len: i64,
    /// Those of the right face, each the image of the entry of left at its place.
    pub right: *const i64,
    /// Entries in right.
    pub right_len: i64,
    /// Degrees of freedom that do not move, fixed_len numbers; or NULL.
    pub fixed: *const i64,
    /// Entries in fixed.
    pub fixed_len: i64,
    /// Axis of the wheel, of any length; it passes through the origin. The axis has no effect in a
    /// cylindrical frame without coordinates.
    pub axis: [f64; 3],
    /// 1: sector s + 1 follows at +2 pi / N about the axis; -1: at -2 pi / N. It decides about the
    /// axes of a Cartesian frame and about the check of coordinates, not about the wave.
    pub direction: i32,
    /// 0.
    pub reserved: i32,
    /// Cartesian positions of the nodes of the left face, three for each; NULL with that of the
    /// right one: not checked.
    pub left_coordinates: *const f64,
    /// Those of the right face.
    pub right_coordinates: *const f64,
}

unsafe impl VersionedStruct for hbvib_sector {
    const NAME: &'static str = "hbvib_sector";
    const FIRST_SIZE: usize = 136;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            frame: hbvib_sector_frame::HBVIB_CARTESIAN as i32,
            ndof: 0,
            sectors: 0,
            engine_order: 0,
            components: 3,
            left: ptr::null(),
            left_len: 0,
            right: ptr::null(),
            right_len: 0,
            fixed: ptr::null(),
            fixed_len: 0,
            axis: [0.0, 0.0, 1.0],
            direction: 1,
            reserved: 0,
            left_coordinates: ptr::null(),
            right_coordinates: ptr::null(),
        }
    }
}

/// Fills the description of a sector: a Cartesian frame with 3 components per node, the z axis,
/// direction 1; ndof, sectors, engine_order and the faces must be set.
///
/// s          the struct; untouched on error.
/// size_of_s  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_sector_init(s: *mut hbvib_sector, size_of_s: usize) -> hbvib_status {
    call(|| unsafe { init(s, size_of_s) })
}

/// Creates a cyclic structure from a sector with faces: all matrices zero, no contact, no force.
/// Its couplings follow from the matrices of the sector alone, which hbvib_model_set_matrix sets:
/// K0 = T0^T K T0 + T1^T K T1 and K1 = T0^T K T1, where u = T0 q(s) + T1 q(s + 1) is the motion of
/// sector s (Thomas 1979, doi:10.1002/nme.1620140107).
///
/// The numbering of the sector is kept for all that follows: matrices, contacts, forces, options
/// and results. Fixed degrees of freedom have results 0; those on the right face move and are
/// loaded with the phase of the next sector. In a Cartesian frame, side b of a contact in another
/// sector is turned into the axes of side a; unless all nodes have consecutive degrees of freedom
/// as those of the faces have, such a contact needs a normal, and x, y, z of both nodes.
/// Superelements (Craig-Bampton) are sectors as well: their modal degrees of freedom are on no
/// face.
///
/// sector  the description; it is copied.
/// out     receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION (ndof, faces of different length, components), HBVIB_E_INDEX (left,
/// right, fixed), HBVIB_E_ARGUMENT (sectors, frame, direction, axis; a degree of freedom in both
/// faces or twice in one, a pair fixed on one side only, a node on the axis, coordinates that
/// contradict direction or sectors), HBVIB_E_NOT_FINITE, naming pair and degree of freedom;
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_from_sector(
    sector: *const hbvib_sector,
    out: *mut *mut hbvib_model,
) -> hbvib_status {
    call(|| {
        let s = unsafe { load(sector, 1) }?;
        check_pointer(out, 2, "out")?;
        let model = unsafe { model(&s) }.with_argument(1)?;
        unsafe { out.write(insert(model)?) };
        Ok(Status::Ok)
    })
}

/// # Safety
/// The arrays of the description have their stated lengths.
unsafe fn model(s: &hbvib_sector) -> Result<Model> {
    const CARTESIAN: i32 = hbvib_sector_frame::HBVIB_CARTESIAN as i32;
    const CYLINDRICAL: i32 = hbvib_sector_frame::HBVIB_CYLINDRICAL as i32;
    let frame = match s.frame {
        CARTESIAN => SectorFrame::Cartesian,
        CYLINDRICAL => SectorFrame::Cylindrical,
        other => {
            return fail!(
                Argument,
                "frame = {other}, needs HBVIB_CARTESIAN = 0 or HBVIB_CYLINDRICAL = 1"
            );
        }
    };
    let forward = match s.direction {
        1 => true,
        -1 => false,
        other => return fail!(Argument, "direction = {other}, needs 1 or -1"),
    };
    check_reserved(s.reserved, 1, "hbvib_sector")?;
    let ndof = count(s.ndof, 1, "ndof")?;
    if ndof == 0 || ndof > MAX_DOF {
        return fail!(Dimension, "ndof = {ndof}, needs 1 .. {MAX_DOF}");
    }
    let Ok(sectors) = usize::try_from(s.sectors) else {
        return fail!(Argument, "sectors = {}, needs at least 2", s.sectors);
    };
    let components = count(s.components, 1, "components")?;
    let (left_len, right_len) = (count(s.left_len, 1, "left_len")?, count(s.right_len, 1, "right_len")?);
    let left = face(unsafe { input(s.left, left_len, 1, "left") }?, ndof, "left")?;
    let right = face(unsafe { input(s.right, right_len, 1, "right") }?, ndof, "right")?;
    let fixed_len = count(s.fixed_len, 1, "fixed_len")?;
    let fixed = indices(unsafe { input(s.fixed, fixed_len, 1, "fixed") }?, ndof, 1, "fixed")?;
    let coordinates = if s.left_coordinates.is_null() && s.right_coordinates.is_null() {
        None
    } else {
        let nodes = |len: usize| len / components.max(1);
        let read = |p, len, name| unsafe { input::<f64>(p, 3 * nodes(len), 1, name) };
        let left = read(s.left_coordinates, left_len, "left_coordinates")?;
        let right = read(s.right_coordinates, right_len, "right_coordinates")?;
        Some((left.as_chunks().0, right.as_chunks().0))
    };
    Model::sector(&SectorDescription {
        ndof,
        sectors,
        engine_order: s.engine_order,
        components,
        left: &left,
        right: &right,
        fixed: &fixed,
        frame,
        axis: s.axis,
        forward,
        coordinates,
    })
}

/// Degrees of freedom of a face.
fn face(dofs: &[i64], ndof: usize, name: &str) -> Result<Vec<Option<usize>>> {
    let mut face = Vec::new();
    for (i, &dof) in dofs.iter().enumerate() {
        let dof = match usize::try_from(dof) {
            Ok(dof) if dof < ndof => Some(dof),
            _ if dof == GROUND => None,
            _ => return fail!(Index, "{name}[{i}] = {dof}, needs 0 .. {} or -1", ndof - 1),
        };
        try_push(&mut face, dof, name)?;
    }
    Ok(face)
}
