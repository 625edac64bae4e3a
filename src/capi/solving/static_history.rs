//! Section "Design studies" of the header: static states along a load history, and the residual state that it leaves.

use crate::analysis::{self, LoadHistory};
use crate::capi::crossing::arrays::{Range, check_pointer, count, disjoint, exact_len, input, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::solving::solve_options::{hbvib_solver_options, solver_options};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Result, Status, fail};
use crate::model::Model;

/// Static states of a model along a load history, with friction: constant forces and speeds that
/// rise and fall, between straight steps. Sliders begin at the places of hbvib_model_set_slider and
/// are dragged along; the places of a step are the residual state that the history has left there,
/// for hbvib_model_set_slider. The first load is reached at once. Vibrating forces have no effect.
///
/// solver     options; NULL: the defaults.
/// steps      number of loads, >= 1.
/// factors    factors of the constant forces, one for each step, or NULL: 1.
/// speeds     fixed speeds of rotation, one for each step, or NULL: that of the model.
/// hooks      phase, log and cancellation; progress is not called. NULL: none.
/// motion     receives the displacements, steps x ndof, step after step; or NULL.
/// motion_len numbers in it: steps x ndof.
/// places     receives the places of the sliders along t1 and t2, steps x contacts x 2; or NULL.
/// places_len numbers in it: steps x contacts x 2.
/// forces     receives the forces of the contacts along t1, t2 and n, steps x contacts x 3, in the
///            sense in which they act against the relative motion, so that the one along n is minus
///            the normal load; or NULL.
/// forces_len numbers in it: steps x contacts x 3.
/// Errors: HBVIB_E_DIMENSION (steps, lengths), HBVIB_E_NOT_FINITE, HBVIB_E_UNSUPPORTED (a speed
/// that is tied to the frequency, and loads that follow it), HBVIB_E_NO_CONVERGENCE or
/// HBVIB_E_SINGULAR where there is no equilibrium, HBVIB_E_ARGUMENT (overlapping arrays),
/// HBVIB_E_CALLBACK,
/// HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; the
/// arrays are untouched then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_static_history(
    model: *const hbvib_model,
    solver: *const hbvib_solver_options,
    steps: i64,
    factors: *const f64,
    speeds: *const f64,
    hooks: *const hbvib_hooks,
    motion: *mut f64,
    motion_len: i64,
    places: *mut f64,
    places_len: i64,
    forces: *mut f64,
    forces_len: i64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let solver = unsafe { solver_options(solver, model.ndof()) }?;
        let n = count(steps, 3, "steps")?;
        if n == 0 {
            return fail!(Dimension, "steps = 0, needs at least 1").with_argument(3);
        }
        let one = [1.0];
        let list = |p: *const f64, argument: i32, name: &str| -> Result<&[f64]> {
            if p.is_null() {
                return Ok(&[]);
            }
            check_pointer(p, argument, name)?;
            unsafe { input(p, n, argument, name) }
        };
        let (given, speeds) = (list(factors, 4, "factors")?, list(speeds, 5, "speeds")?);
        // Without both lists the load is that of the model, once.
        let factors = if given.is_empty() && speeds.is_empty() {
            if n > 1 {
                return fail!(Dimension, "steps = {n}, but neither factors nor speeds are given").with_argument(3);
            }
            &one[..]
        } else {
            given
        };
        let hooks = unsafe { load_hooks(hooks, 6) }?;
        let contacts = model.contacts().len();
        let length = |p: *mut f64, len: i64, each: usize, argument: i32, name: &str| -> Result<usize> {
            if p.is_null() {
                return Ok(0);
            }
            check_pointer(p, argument, name)?;
            exact_len(len, n.saturating_mul(each), argument + 1, "steps x numbers of a step")
        };
        let lengths = [
            length(motion, motion_len, model.ndof(), 7, "motion")?,
            length(places, places_len, 2 * contacts, 9, "places")?,
            length(forces, forces_len, 3 * contacts, 11, "forces")?,
        ];
        disjoint(
            &[
                Range::new(given.as_ptr(), given.len(), 4, "factors")?,
                Range::new(speeds.as_ptr(), speeds.len(), 5, "speeds")?,
            ],
            &[
                Range::new(motion, lengths[0], 7, "motion")?,
                Range::new(places, lengths[1], 9, "places")?,
                Range::new(forces, lengths[2], 11, "forces")?,
            ],
        )?;
        let history = LoadHistory { factors, speeds };
        let found = unsafe {
            with_interrupt(&hooks, |interrupt| {
                analysis::static_history(&model, &solver, &history, interrupt)
            })
        }?;
        if lengths[0] > 0 {
            let to = unsafe { output(motion, lengths[0], 7, "motion") }?;
            for (to, step) in to.chunks_exact_mut(model.ndof()).zip(&found) {
                to.copy_from_slice(&step.motion);
            }
        }
        if lengths[1] > 0 {
            let to = unsafe { output(places, lengths[1], 9, "places") }?;
            for (to, x) in to.iter_mut().zip(found.iter().flat_map(|s| s.places.iter().flatten())) {
                *to = *x;
            }
        }
        if lengths[2] > 0 {
            let to = unsafe { output(forces, lengths[2], 11, "forces") }?;
            for (to, x) in to.iter_mut().zip(found.iter().flat_map(|s| s.forces.iter().flatten())) {
                *to = *x;
            }
        }
        Ok(Status::Ok)
    })
}
