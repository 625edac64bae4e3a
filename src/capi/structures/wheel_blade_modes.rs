//! Section "Design studies" of the header: a sector on the cantilever modes of its blade.

use crate::capi::crossing::arrays::{Range, check_pointer, count, disjoint, exact_len, input, optional, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{insert, read};
use crate::capi::crossing::indices::indices;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::model::Model;

/// Makes a sector whose blade moves in its lowest cantilever modes, with everything else held, and
/// as the rest carries it along (Craig and Bampton): 10 to 20 modes of a finite-element blade. In
/// the wheel of it a pattern of the modes (hbvib_wheel_mistune with their numbers as dofs) is
/// exactly one of the stiffness of the blade, of a rank of modes a blade. The new sector has the
/// degrees of freedom that are left, in their order, then the modes; right faces and fixed degrees
/// of freedom have no number there. Contacts, springs, damping, wave and speed are taken over, and
/// forces on the blade act on the modes.
///
/// cyclic       the model of the sector; stays as it is.
/// n_dofs       number of degrees of freedom of the blade.
/// dofs         all of them but those of its root and those with contacts and springs.
/// modes        number of modes, 1 .. n_dofs - 1.
/// families     tuned modes of each nodal diameter whose error is told, at least 1.
/// hooks        phase and cancellation; NULL: none.
/// n_points     number of degrees of freedom whose motion is asked for, 0 with points NULL.
/// points       their numbers in `cyclic`, for responses as the tip of a blade.
/// weights_len  numbers that fit into weights, at least n_points times the degrees of freedom of
///              the new sector: for each point ndof - n_dofs + modes are enough.
/// weights      receives the weights of these that make the motion of each point, point after
///              point; or NULL.
/// ndof         degrees of freedom of `cyclic`: length of numbers.
/// numbers      receives the new number of each, -1 where it has none; or NULL.
/// first        receives the number of the first mode, or NULL.
/// left_out     receives the largest relative error of a frequency of the tuned modes by the modes
///              of the blade that are left out, as estimated, with all contacts stuck and with all
///              of them free; infinity where one lies above the first of these; NaN, unknown, where
///              matrices of a speed act: compare natural frequencies of both sectors; or NULL.
/// out          receives the new sector; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_ARGUMENT (modes, families; dofs twice, fixed, on the right face, with a contact
/// or spring, or coupled to another sector), HBVIB_E_INDEX, HBVIB_E_DIMENSION (lengths),
/// HBVIB_E_SINGULAR (a blade that is not held), HBVIB_E_UNSUPPORTED (matrices of single diameters,
/// modal damping, aerodynamic forces, a stiffness without symmetry), those of hbvib_linear_modes;
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one
/// model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_wheel_blade_modes(
    cyclic: *const hbvib_model,
    n_dofs: i64,
    dofs: *const i64,
    modes: i64,
    families: i64,
    hooks: *const hbvib_hooks,
    n_points: i64,
    points: *const i64,
    weights_len: i64,
    weights: *mut f64,
    ndof: i64,
    numbers: *mut i64,
    first: *mut i64,
    left_out: *mut f64,
    out: *mut *mut hbvib_model,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 6) }?;
        let cyclic = read::<Model>(cyclic, 1)?;
        let n = cyclic.ndof();
        let dofs = unsafe { input(dofs, count(n_dofs, 2, "n_dofs")?, 3, "dofs") }?;
        let points = unsafe { input(points, count(n_points, 7, "n_points")?, 8, "points") }?;
        let modes = count(modes, 4, "modes")?;
        let families = count(families, 5, "families")?;
        if families == 0 {
            return fail!(Argument, "families = 0, needs at least 1").with_argument(5);
        }
        check_pointer(out, 15, "out")?;
        let length = count(weights_len, 9, "weights_len")?;
        let room = exact_len(ndof, n, 11, "ndof")?;
        disjoint(
            &[],
            &[
                Range::new(weights, if weights.is_null() { 0 } else { length }, 10, "weights")?,
                Range::new(numbers, if numbers.is_null() { 0 } else { room }, 12, "numbers")?,
            ],
        )?;
        let (first, left_out) = (optional((first, 13), "first")?, optional((left_out, 14), "left_out")?);
        let dofs = indices(dofs, n, 3, "dofs")?;
        let points = indices(points, n, 8, "points")?;
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                cyclic
                    .on_blade_modes(&dofs, (modes, families), interrupt)
                    .with_argument(1)
            })
        }?;
        if !weights.is_null() {
            let needed = points.len().saturating_mul(found.model.ndof());
            if length < needed {
                return fail!(
                    Dimension,
                    "weights_len = {length}, needs at least n_points times the {} degrees of freedom of the new sector, {needed}",
                    found.model.ndof()
                )
                .with_argument(9);
            }
            if needed > 0 {
                let weights = unsafe { output(weights, needed, 10, "weights") }?;
                for (weights, &point) in weights.chunks_exact_mut(found.model.ndof()).zip(&points) {
                    weights.copy_from_slice(&found.weights(&cyclic, point).with_argument(8)?);
                }
            }
        }
        if !numbers.is_null() {
            let numbers = unsafe { output(numbers, room, 12, "numbers") }?;
            for (to, number) in numbers.iter_mut().zip(&found.numbers) {
                *to = number.map_or(-1, |number| number as i64);
            }
        }
        unsafe {
            if let Some(to) = first {
                to.write(found.first as i64);
            }
            if let Some(to) = left_out {
                to.write(found.left_out);
            }
            out.write(insert(found.model)?);
        }
        Ok(Status::Ok)
    })
}
