//! Section "Contacts" of the header: contact patches, node pairs of two surfaces.

use crate::capi::contact_calls::contacts::{self, hbvib_contact};
use crate::capi::crossing::arrays::{count, input};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::write;
use crate::capi::crossing::indices::{check_id, side, with_named_argument};
use crate::capi::crossing::versioned_struct::load;
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::described::patch::Patch;
use crate::error::{Result, Status, fail, try_push};
use crate::model::Model;

/// Adds a contact patch as n contacts: n node pairs of two surfaces, each with its share of the
/// area. All contacts are checked before one is added.
///
/// law       the law per unit of area: kt and kn are force per length and area, cubic is force per
///           length^3 and area, preload is a pressure. Its sector_offset is that of all pairs; its
///           degrees of freedom, normal and tangent are ignored. Fill it by hbvib_contact_init.
/// n         number of pairs, >= 0.
/// dof_a     degrees of freedom of the nodes on side a along three orthogonal axes, 3 n numbers,
///           node after node; or HBVIB_GROUND.
/// dof_b     the same on side b; NULL: the ground.
/// normal    directions n in these axes, of any length, 3 n numbers. Closing is x_b - x_a along n:
///           n points from side b to side a.
/// tangent   directions t1, orthogonal to n, of any length, 3 n numbers; NULL: any in the plane,
///           for HBVIB_FRICTION_3D and HBVIB_UNILATERAL alone.
/// area      >= 0; n numbers.
/// pressure  pressure at rest, >= 0, n numbers; NULL: preload of the law.
/// gap       closing at which a pair without pressure begins to press, any sign, n numbers; NULL:
///           gap of the law.
/// first_id  receives the number of the first contact, the others follow; may be NULL; untouched on
///           error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_DIMENSION (n), HBVIB_E_ARGUMENT (law, directions,
/// area, pressure, equal sides, a degree of freedom twice on one side), HBVIB_E_NOT_FINITE,
/// naming the entry; HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments, clippy::similar_names)]
pub unsafe extern "C" fn hbvib_model_add_patch(
    model: *mut hbvib_model,
    law: *const hbvib_contact,
    n: i64,
    dof_a: *const i64,
    dof_b: *const i64,
    normal: *const f64,
    tangent: *const f64,
    area: *const f64,
    pressure: *const f64,
    gap: *const f64,
    first_id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let law = contacts::law(&unsafe { load(law, 2) }?).with_argument(2)?;
        let n = count(n, 3, "n")?;
        let dof_a = unsafe { triples(dof_a, n, 4, "dof_a") }?;
        let dof_b = given(dof_b, |p| unsafe { triples(p, n, 5, "dof_b") })?;
        let normal = unsafe { triples(normal, n, 6, "normal") }?;
        let tangent = given(tangent, |p| unsafe { triples(p, n, 7, "tangent") })?;
        let area = unsafe { input(area, n, 8, "area") }?;
        let pressure = given(pressure, |p| unsafe { input(p, n, 9, "pressure") })?;
        let gap = given(gap, |p| unsafe { input(p, n, 10, "gap") })?;
        check_id(first_id, 11, "first_id")?;
        let ndof = model.ndof();
        let nodes_a = nodes(dof_a, ndof, 4, "dof_a")?;
        let nodes_b = match dof_b {
            Some(dofs) => Some(nodes(dofs, ndof, 5, "dof_b")?),
            None => None,
        };
        let patch = Patch {
            law: &law,
            dof_a: &nodes_a,
            dof_b: nodes_b.as_deref(),
            normal,
            tangent,
            area,
            pressure,
            gap,
        };
        let first = model.add_patch(&patch).map_err(|e| {
            if e.status == Status::OutOfMemory {
                return e;
            }
            let names = [
                ("law:", 2),
                ("sector_offset", 2),
                ("tangent", 7),
                ("normal", 6),
                ("area", 8),
                ("pressure", 9),
                ("gap =", 10),
                ("dof_b[", 5),
                ("dof_a", 4),
                ("preload", if pressure.is_some() { 9 } else { 2 }),
                ("", 2),
            ];
            with_named_argument(e, &names)
        })?;
        if !first_id.is_null() {
            unsafe { first_id.write(first as i64) };
        }
        Ok(Status::Ok)
    })
}

/// Three numbers for each pair.
///
/// # Safety
/// Those of [`input`].
unsafe fn triples<'a, T>(p: *const T, n: usize, argument: i32, name: &str) -> Result<&'a [[T; 3]]> {
    let Some(len) = n.checked_mul(3) else {
        return fail!(Dimension, "{name}: 3 x {n} entries cannot lie in memory").with_argument(argument);
    };
    Ok(unsafe { input(p, len, argument, name) }?.as_chunks().0)
}

/// An array that may be NULL.
fn given<T, A>(p: *const T, read: impl FnOnce(*const T) -> Result<A>) -> Result<Option<A>> {
    if p.is_null() { Ok(None) } else { read(p).map(Some) }
}

/// The nodes of one surface.
fn nodes(dofs: &[[i64; 3]], ndof: usize, argument: i32, name: &str) -> Result<Vec<[Option<usize>; 3]>> {
    let mut nodes = Vec::new();
    for (i, dofs) in dofs.iter().enumerate() {
        let mut node = [None; 3];
        for (k, (place, &dof)) in node.iter_mut().zip(dofs).enumerate() {
            *place = side(dof, ndof, argument, format_args!("{name}[{}]", 3 * i + k))?;
        }
        try_push(&mut nodes, node, "the nodes of a patch")?;
    }
    Ok(nodes)
}
