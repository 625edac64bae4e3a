//! Section "Design studies" of the header: the pattern of a mistuned wheel from its measured modes.

use crate::capi::crossing::arrays::{Range, count, disjoint, exact_len, input, optional, output};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::crossing::indices::indices;
use crate::capi::mode_calls::modes_linear::contact_state_of;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_interrupt};
use crate::capi::structures::cyclic_wheel::with_quantity;
use crate::capi::structures::matrices::hbvib_matrix;
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::model::Model;
use crate::studies::MeasuredModes;
use crate::studies::wheel_identify;
use num_complex::Complex64;

/// The pattern of a mistuned wheel from measured modes, with its covariance: that of the greatest
/// likelihood under normal noise of frequencies and shapes. Modes without damping of the wheel are
/// sought in the space of the tuned ones (component mode mistuning); families + 1 instead of
/// families shows what that leaves out.
///
/// cyclic       the model of the tuned sector.
/// kind         HBVIB_MISTUNING_STIFFNESS, _FREQUENCY or _MASS.
/// n_dofs       degrees of freedom of the blade of a sector, 0 with a direction.
/// dofs         their numbers, n_dofs numbers, each once.
/// direction    matrix of a sector instead of a blade, as for hbvib_wheel_mistune; or NULL.
/// contacts     their state in the measurement: HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// families     tuned modes of each nodal diameter, from the lowest, that span those of the wheel:
///              up to the measured ones, and some more.
/// n_points     degrees of freedom of each sector that were measured, at least 1.
/// points       their numbers in the sector.
/// n_modes      number of measured modes, at least 1.
/// omega        their angular frequencies, n_modes numbers above 0.
/// sigma_omega  standard deviations of these, above 0.
/// shapes       complex numbers (real part, imaginary part) of the shapes, of any scale and phase:
///              mode after mode, sector after sector, point after point.
/// sigma_shape  standard deviation of each part of a number of a shape, in its scale: one for each
///              mode, above 0.
/// hooks        phase, log and cancellation; progress is not called. NULL: none.
/// sectors      number of sectors: length of delta.
/// delta        receives delta of each sector, as hbvib_wheel_mistune takes it.
/// covariance   receives sectors * sectors numbers, or NULL.
/// chi2         receives the sum of the squares of residuals over standard deviations, or NULL:
///              about the number that degrees receives where noise is all that is left.
/// degrees      receives the number of data less that of unknowns, or NULL.
/// Errors: HBVIB_E_ARGUMENT (kind, families, a standard deviation, a shape that is zero, a fixed
/// point), HBVIB_E_INDEX (dofs, points), HBVIB_E_DIMENSION (numbers), HBVIB_E_NOT_FINITE,
/// HBVIB_E_SINGULAR (the modes do not tell the pattern), HBVIB_E_NO_CONVERGENCE,
/// HBVIB_E_UNSUPPORTED (a plain model, gyroscopic forces, complex matrices, damping), those of
/// hbvib_linear_modes and hbvib_wheel_mistune. Threads: any number on one model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_wheel_identify(
    cyclic: *const hbvib_model,
    kind: i32,
    n_dofs: i64,
    dofs: *const i64,
    direction: *const hbvib_matrix,
    contacts: i32,
    families: i64,
    n_points: i64,
    points: *const i64,
    n_modes: i64,
    omega: *const f64,
    sigma_omega: *const f64,
    shapes: *const f64,
    sigma_shape: *const f64,
    hooks: *const hbvib_hooks,
    sectors: i64,
    delta: *mut f64,
    covariance: *mut f64,
    chi2: *mut f64,
    degrees: *mut i64,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 15) }?;
        let cyclic = read::<Model>(cyclic, 1)?;
        let (n, all) = (cyclic.ndof(), cyclic.structure().sectors());
        let dofs = unsafe { input(dofs, count(n_dofs, 3, "n_dofs")?, 4, "dofs") }?;
        let points = unsafe { input(points, count(n_points, 8, "n_points")?, 9, "points") }?;
        let modes = count(n_modes, 10, "n_modes")?;
        let real = |p, argument, name| unsafe { input::<f64>(p, modes, argument, name) };
        let (omega, sigma_omega) = (real(omega, 11, "omega")?, real(sigma_omega, 12, "sigma_omega")?);
        let sigma_shape = real(sigma_shape, 14, "sigma_shape")?;
        let Some(numbers) = modes.checked_mul(all).and_then(|k| k.checked_mul(points.len())) else {
            return fail!(Dimension, "n_modes = {modes}, which is too large").with_argument(10);
        };
        let shapes = unsafe { input(shapes.cast::<Complex64>(), numbers, 13, "shapes") }?;
        let sectors = exact_len(sectors, all, 16, "sectors")?;
        let squared = sectors.saturating_mul(sectors);
        disjoint(
            &[
                Range::new(omega.as_ptr(), modes, 11, "omega")?,
                Range::new(sigma_omega.as_ptr(), modes, 12, "sigma_omega")?,
                Range::new(shapes.as_ptr(), numbers, 13, "shapes")?,
                Range::new(sigma_shape.as_ptr(), modes, 14, "sigma_shape")?,
            ],
            &[
                Range::new(delta, sectors, 17, "delta")?,
                Range::new(covariance, squared, 18, "covariance")?,
                Range::new(chi2, 1, 19, "chi2")?,
                Range::new(degrees, 1, 20, "degrees")?,
            ],
        )?;
        let delta = unsafe { output(delta, sectors, 17, "delta") }?;
        let covariance = optional((covariance, 18), "covariance")?;
        let (chi2, degrees) = (optional((chi2, 19), "chi2")?, optional((degrees, 20), "degrees")?);
        let dofs = indices(dofs, n, 4, "dofs")?;
        let contacts = contact_state_of(contacts, 6)?;
        let families = count(families, 7, "families")?;
        let points = indices(points, n, 9, "points")?;
        let measured = MeasuredModes {
            points: &points,
            omega,
            sigma_omega,
            shapes,
            sigma_shape,
        };
        let found = unsafe {
            with_quantity((kind, 2), (&dofs, 3), (direction, 5), n, |what| {
                with_interrupt(&hooks, |interrupt| {
                    wheel_identify(&cyclic, what, &measured, (contacts, families), interrupt).with_argument(1)
                })
            })
        }?;
        delta.copy_from_slice(&found.delta);
        unsafe {
            if let Some(covariance) = covariance {
                covariance.copy_from_nonoverlapping(found.covariance.as_ptr(), squared);
            }
            if let Some(chi2) = chi2 {
                chi2.write(found.chi2);
            }
            if let Some(degrees) = degrees {
                degrees.write(found.degrees as i64);
            }
        }
        Ok(Status::Ok)
    })
}
