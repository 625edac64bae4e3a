//! Section "Stability" of the header: the smallest kick that leads from a motion to another one.

#![allow(non_camel_case_types)]

use crate::analysis;
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{KeptBranch, read};
use crate::capi::crossing::indices::{index, number};
use crate::capi::crossing::stored_point::StoredPoint;
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out, init};
use crate::capi::solving::solve::hbvib_branch;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;

/// The smallest kick that was found. Fill it by hbvib_kick_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_kick {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// 1: integration in time with a tight tolerance confirmed that `impulse` leads to another motion
    /// and `returning` does not; 0: the estimate is all that is known.
    pub verified: i32,
    /// Impulse that leads to another motion, with its sign; NaN where none was found.
    pub impulse: f64,
    /// Impulse at the same phase after which the motion comes back.
    pub returning: f64,
    /// Phase of the forces at which it acts: omega t, 0 .. 2 pi.
    pub phase: f64,
    /// Smallest impulse to first order, from the left eigenvector of the saddle.
    pub estimate: f64,
    /// Its phase.
    pub estimate_phase: f64,
    /// Velocity that the impulse gives the degree of freedom.
    pub velocity: f64,
    /// Multiplier of the saddle in its unstable direction.
    pub multiplier: f64,
}

unsafe impl VersionedStruct for hbvib_kick {
    const NAME: &'static str = "hbvib_kick";
    const FIRST_SIZE: usize = 64;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            verified: 0,
            impulse: 0.0,
            returning: 0.0,
            phase: 0.0,
            estimate: 0.0,
            estimate_phase: 0.0,
            velocity: 0.0,
            multiplier: 0.0,
        }
    }
}

/// Fills the numbers of a kick with zeros.
///
/// k          the struct; untouched on error.
/// size_of_k  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_kick_init(k: *mut hbvib_kick, size_of_k: usize) -> hbvib_status {
    call(|| unsafe { init(k, size_of_k) })
}

/// Searches for the smallest impulse at one degree of freedom that leads from a stable point of a
/// forced response to another motion. Between the two lies an unstable one, a saddle: the left
/// eigenvector of its period map gives an estimate at each of `phases` times of the period, and
/// integration in time brackets the impulse to a thousandth, there and around the best of them.
/// Smaller kicks at other times, and in other directions, may exist.
///
/// model          the model of which both branches are results, not a cyclic one.
/// point          number of the stable point: of the curve, or a requested solution.
/// saddle_branch  the branch of the saddle, the same or another one.
/// saddle         number of an unstable point at the same frequency with one unstable direction.
/// dof            degree of freedom of the impulse.
/// phases         times of a period, 1 .. 10000; 16 are a good number.
/// hooks          progress, log and cancellation as in hbvib_time_response; NULL: none.
/// out            receives the kick; fill it by hbvib_kick_init before.
/// HBVIB_STOPPED_BY_CALLER: the kick found so far, not verified.
/// Errors: HBVIB_E_INDEX (point, saddle, dof), HBVIB_E_ARGUMENT (another model, two frequencies, a
/// saddle without one unstable direction, phases), HBVIB_E_UNSUPPORTED (a cyclic model, a nonlinear
/// mode; a model that hbvib_time_response refuses), HBVIB_E_NO_CONVERGENCE (shooting did not
/// converge from a point), HBVIB_E_NO_BOUNDED_SOLUTION, HBVIB_E_CALLBACK (a force callback
/// failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model and branch.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_smallest_kick(
    model: *const hbvib_model,
    branch: *const hbvib_branch,
    point: i64,
    saddle_branch: *const hbvib_branch,
    saddle: i64,
    dof: i64,
    phases: i64,
    hooks: *const hbvib_hooks,
    out: *mut hbvib_kick,
) -> hbvib_status {
    call(|| {
        let at = StoredPoint::read(model, branch, point)?;
        let kept = read::<KeptBranch>(saddle_branch, 4)?;
        let between = index(saddle, kept.branch.stored(), 5, "saddle")?;
        let dof = index(dof, at.model.ndof(), 6, "dof")?;
        let phases = number(phases, "phases").with_argument(7)?;
        let hooks = unsafe { load_hooks(hooks, 8) }?;
        unsafe { check_out(out, 9) }?;
        let found = unsafe {
            with_hooks(&hooks, |hooks| {
                let points = ((at.branch(), at.number), (&kept.branch, between));
                analysis::smallest_kick(&at.model, points.0, points.1, (dof, phases), hooks)
            })
        }?;
        let value = hbvib_kick {
            verified: i32::from(found.verified),
            impulse: found.impulse,
            returning: found.returning,
            phase: found.phase,
            estimate: found.estimate,
            estimate_phase: found.estimate_phase,
            velocity: found.velocity,
            multiplier: found.multiplier,
            ..hbvib_kick::defaults()
        };
        unsafe { fill_out(out, value) };
        Ok(found.status)
    })
}
