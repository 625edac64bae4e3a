//! Floquet multipliers of a stored point, by the variational equations along the motion in time.

use crate::analysis::perturbed::floquet_on_modes::{KeptModes, floquet_of};
use crate::analysis::perturbed::perturbed_motion::Motion;
use crate::error::{Result, Status, fail};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::FloquetOptions;
use crate::results::{Branch, Floquet, Recovery};

/// Largest |D| of a point of a nonlinear mode that counts as a limit cycle.
/// Kind: rounding.
const LIMIT_CYCLE: f64 = 1e-7;

/// Computes the Floquet multipliers of a stored point: the factors by which small perturbations of its motion grow in
/// one period. `model` is the one that the branch was computed with. The point is not changed.
///
/// The monodromy matrix is exact: the variational equations are integrated along the exact path from event to event,
/// and sliders that slip pass on what they remember of the motion. All laws that [`time_response`](crate::time_response)
/// supports are supported. A point of a nonlinear mode must be a limit cycle, damping ratio zero.
///
/// Large structures are computed on the degrees of freedom of their contacts and on modes of the structure with stuck
/// contacts, see [`FloquetOptions::modes`], and once more with half as many modes: both must agree.
///
/// # Errors
/// `Index` for an unknown point, `Argument` for another model than that of the branch or bad options, `Unsupported`
/// for a point of a mode that is no limit cycle, and for what `time_response` does not support; `NoConvergence` if
/// shooting does not converge from the point, or numbers of modes differ in their verdict; `NoBoundedSolution`, `Callback`, `OutOfMemory`.
pub fn floquet(
    model: &Model,
    branch: &Branch,
    point: usize,
    options: &FloquetOptions,
    hooks: &mut Hooks<'_>,
) -> Result<Floquet> {
    options.check()?;
    branch.check_model(model)?;
    model.check_matrices(false)?;
    let Some(omega) = branch.omega_at(point) else {
        return fail!(
            Index,
            "point = {point}, needs 0 .. {} (points and special points)",
            branch.stored()
        );
    };
    if let Some(mode) = branch.mode_at(point)
        && mode.damping_ratio.abs() > LIMIT_CYCLE
    {
        return fail!(
            Unsupported,
            "point = {point} of a nonlinear mode has the damping ratio {:.3e}: only artificial damping keeps its motion periodic; take a point where it is zero, a limit cycle",
            mode.damping_ratio
        );
    }
    let interrupt = hooks.interrupt();
    let mut found = || -> Result<Floquet> {
        let harmonics = Recovery::at(branch, point, &interrupt)?.all(branch.harmonics())?;
        let motion = Motion {
            omega,
            harmonics: &harmonics,
            autonomous: branch.mode().is_some(),
            compared: true,
            fine: None,
            difference: None,
            quick: false,
        };
        let mut kept = KeptModes::default();
        Ok(floquet_of(model, &motion, options, hooks, &mut kept, &interrupt)?.stability)
    };
    match found() {
        Err(e) if e.status == Status::StoppedByCaller => Ok(Floquet::stopped(omega)),
        outcome => outcome,
    }
}
