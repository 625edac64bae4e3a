//! Section "Cyclic structures" of the header: aerodynamic influence.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::{count, input, optional};
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::{read, write};
use crate::capi::crossing::indices::{indices, with_named_argument};
use crate::capi::structures::model::hbvib_model;
use crate::capi::structures::model_contents::fits;
use crate::capi::version_and_errors::hbvib_status;
use crate::error::{Error, Result, Status, fail, try_push};
use crate::model::Model;
use crate::model::matrices::aero::AeroForm;
use num_complex::Complex64;

/// Motion that aerodynamic forces follow.
#[repr(C)]
pub enum hbvib_aero_form {
    /// Displacements: coefficients are forces per displacement.
    HBVIB_AERO_DISPLACEMENT = 0,
    /// Velocities: coefficients are forces per velocity.
    HBVIB_AERO_VELOCITY = 1,
}

fn form_of(form: i32, argument: i32) -> Result<AeroForm> {
    const DISPLACEMENT: i32 = hbvib_aero_form::HBVIB_AERO_DISPLACEMENT as i32;
    const VELOCITY: i32 = hbvib_aero_form::HBVIB_AERO_VELOCITY as i32;
    match form {
        DISPLACEMENT => Ok(AeroForm::Displacement),
        VELOCITY => Ok(AeroForm::Velocity),
        other => fail!(Argument, "form = {other}, needs HBVIB_AERO_DISPLACEMENT = 0 or 1").with_argument(argument),
    }
}

/// Sets aerodynamic forces, which follow the motion of this and other sectors. On the right-hand
/// side f_i of sector s is the sum over k and j of c(k, i, j) x_j of sector s + offsets(k), or of
/// the velocities x_j'. In the wave in which sector s + 1 lags by 2 pi d / N the forces are A(d) x,
/// A(d) = sum c(k) exp(-i offsets(k) 2 pi d / N), per velocity i p omega A(d) x in harmonic p,
/// which belongs to d = p EO mod N. Natural modes and modal damping are those without aerodynamic
/// forces; all other analyses have them. A later call of the same form replaces an earlier one.
///
/// n_dofs        degrees of freedom that take part, >= 0; 0 removes the forces of this form.
/// dofs          their numbers, from 0, each once; n_dofs numbers. Fixed ones have no effect.
/// n_offsets     number of offsets, >= 0; 0 removes the forces of this form.
/// coefficients  complex force per displacement or velocity: for each offset a square matrix, rows
///               (forces) one after the other; 2 * n_offsets * n_dofs * n_dofs doubles, finite.
///               The mean has the real part. Imaginary parts mean nothing in time: time
///               integration, verification and stability refuse them.
/// offsets       sector of the motion counted from that of the force, 0 the same sector, each
///               sector once, -(N - 1) .. N - 1; n_offsets numbers.
/// form          HBVIB_AERO_DISPLACEMENT or HBVIB_AERO_VELOCITY.
/// Errors: HBVIB_E_UNSUPPORTED for a plain structure; HBVIB_E_INDEX (dofs), HBVIB_E_ARGUMENT (dofs
/// or offsets twice, form), HBVIB_E_NOT_FINITE (coefficients), HBVIB_E_DIMENSION (n_dofs,
/// n_offsets), after all of which the model is unchanged; HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_set_aero(
    model: *mut hbvib_model,
    n_dofs: i64,
    dofs: *const i64,
    n_offsets: i64,
    coefficients: *const f64,
    offsets: *const i64,
    form: i32,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let (dofs_len, offsets_len) = (count(n_dofs, 2, "n_dofs")?, count(n_offsets, 4, "n_offsets")?);
        let form = form_of(form, 7)?;
        let dofs = unsafe { input(dofs, dofs_len, 3, "dofs") }?;
        let dofs = indices(dofs, model.ndof(), 3, "dofs")?;
        let offsets = unsafe { input(offsets, offsets_len, 6, "offsets") }?;
        let doubles = dofs_len
            .checked_mul(dofs_len)
            .and_then(|square| square.checked_mul(offsets_len));
        let Some(doubles) = doubles.and_then(|entries| entries.checked_mul(2)) else {
            return Err(Error::new(
                Status::Dimension,
                format_args!("coefficients of {n_dofs} dofs and {n_offsets} offsets cannot lie in memory"),
            )
            .in_argument(2));
        };
        let given = unsafe { input(coefficients, doubles, 5, "coefficients") }?;
        let mut coefficients = Vec::new();
        for pair in given.chunks_exact(2) {
            try_push(
                &mut coefficients,
                Complex64::new(pair[0], pair[1]),
                "the aerodynamic influence",
            )?;
        }
        model.set_aero(&dofs, &coefficients, offsets, form).map_err(|e| {
            let arrays = [("coefficients[", 5), ("offsets[", 6), ("dofs[", 3), ("plain", 1)];
            with_named_argument(e, &arrays)
        })?;
        Ok(Status::Ok)
    })
}

/// The coefficients of the aerodynamic forces of a form, in the order in which they were given.
///
/// form         HBVIB_AERO_DISPLACEMENT or HBVIB_AERO_VELOCITY.
/// capacity     entries that fit into each array.
/// dof_force    receives numbers of the degrees of freedom of forces, or NULL.
/// dof_motion   receives numbers of the degrees of freedom of motions, or NULL.
/// offset       receives numbers of sectors from that of the force to that of the motion, or NULL.
/// coefficient  receives complex coefficients, 2 * capacity doubles, or NULL.
/// count        receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_ARGUMENT (form), HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY (being changed). Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_cyclic_aero(
    model: *const hbvib_model,
    form: i32,
    capacity: i64,
    dof_force: *mut i64,
    dof_motion: *mut i64,
    offset: *mut i64,
    coefficient: *mut f64,
    count: *mut i64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let influence = model.aero(form_of(form, 2)?);
        let force = optional((dof_force, 4), "dof_force")?;
        let motion = optional((dof_motion, 5), "dof_motion")?;
        let offset = optional((offset, 6), "offset")?;
        let coefficient = optional((coefficient, 7), "coefficient")?;
        let wanted = force.is_some() || motion.is_some() || offset.is_some() || coefficient.is_some();
        let entries = influence.map_or(0, |influence| influence.entries().len());
        if !unsafe { fits(entries, wanted, capacity, 3, (count, 8)) }? {
            return Ok(Status::Ok);
        }
        for (k, entry) in influence.iter().flat_map(|influence| influence.entries()).enumerate() {
            unsafe {
                if let Some(p) = force {
                    p.add(k).write(entry.force as i64);
                }
                if let Some(p) = motion {
                    p.add(k).write(entry.motion as i64);
                }
                if let Some(p) = offset {
                    p.add(k).write(entry.offset);
                }
                if let Some(p) = coefficient {
                    p.add(2 * k).write(entry.coefficient.re);
                    p.add(2 * k + 1).write(entry.coefficient.im);
                }
            }
        }
        Ok(Status::Ok)
    })
}
