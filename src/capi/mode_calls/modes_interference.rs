//! Section "Modes" of the header: the interference diagram of a wheel.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::check_pointer;
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::read;
use crate::capi::mode_calls::modes_damped::modes;
use crate::capi::mode_calls::modes_linear::contact_state_of;
use crate::capi::solving::solve_hooks::{hbvib_hooks, load_hooks, with_hooks};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Status, fail};
use crate::model::Model;
use crate::studies::interference::interference;

/// Interference (SAFE) diagram: the lowest damped modes of all N waves of a wheel at the speed of
/// the model, as hbvib_damped_modes. Together they are the modes of the wheel, each once. Both
/// senses of a diameter are computed where they differ: with gyroscopic or aerodynamic forces and
/// with unsymmetric matrices. The waves that grow are told to the log.
///
/// contacts       HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count          number of modes of each wave, 1 .. ndof.
/// capacity       room of the arrays in waves, at least N.
/// diameter       receives N numbers: signed nodal diameters -N/2 < d <= N/2, rising.
/// omega          receives N * count damped angular frequencies, those of one wave rising, one wave
///                after the other; NaN where fewer motions oscillate.
/// damping_ratio  receives N * count damping ratios likewise, negative where the motion grows; or
///                NULL.
/// direction      receives N * count numbers likewise, as hbvib_damped_modes; or NULL.
/// equal_senses   receives 1 where both senses of each diameter have the same frequencies and
///                damping ratios, else 0; or NULL.
/// hooks          phase, log and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_UNSUPPORTED for a plain structure; HBVIB_E_DIMENSION (count, capacity), and
/// those of hbvib_damped_modes. Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_interference(
    model: *const hbvib_model,
    contacts: i32,
    count: i64,
    capacity: i64,
    diameter: *mut i64,
    omega: *mut f64,
    damping_ratio: *mut f64,
    direction: *mut i64,
    equal_senses: *mut i64,
    hooks: *const hbvib_hooks,
) -> hbvib_status {
    call(|| {
        let hooks = unsafe { load_hooks(hooks, 10) }?;
        let model = read::<Model>(model, 1)?;
        let state = contact_state_of(contacts, 2)?;
        let wanted = modes(count, &model, 3)?;
        let sectors = model.structure().sectors();
        if usize::try_from(capacity).map_or(true, |room| room < sectors) {
            return fail!(
                Dimension,
                "capacity = {capacity}, needs at least {sectors}: one for each sector"
            )
            .with_argument(4);
        }
        check_pointer(diameter, 5, "diameter")?;
        check_pointer(omega, 6, "omega")?;
        if !damping_ratio.is_null() {
            check_pointer(damping_ratio, 7, "damping_ratio")?;
        }
        if !direction.is_null() {
            check_pointer(direction, 8, "direction")?;
        }
        if !equal_senses.is_null() {
            check_pointer(equal_senses, 9, "equal_senses")?;
        }
        let found = unsafe { with_hooks(&hooks, |hooks| interference(&model, state, wanted, hooks)) }?;
        unsafe {
            diameter.copy_from(found.diameters.as_ptr(), found.diameters.len());
            omega.copy_from(found.omega.as_ptr(), found.omega.len());
            if !damping_ratio.is_null() {
                damping_ratio.copy_from(found.damping_ratio.as_ptr(), found.damping_ratio.len());
            }
            if !direction.is_null() {
                direction.copy_from(found.direction.as_ptr(), found.direction.len());
            }
            if !equal_senses.is_null() {
                equal_senses.write(i64::from(found.has_equal_senses));
            }
        }
        Ok(Status::Ok)
    })
}
