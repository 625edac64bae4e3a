//! Section "Contacts" of the header: many friction contacts in one call.

use crate::capi::crossing::arrays::{check_pointer, count, input};
use crate::capi::crossing::boundary::call;
use crate::capi::crossing::handles::write;
use crate::capi::crossing::indices::{Sides, side, with_named_argument};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::Contact;
use crate::contact::described::iwan::Iwan;
use crate::error::{Status, try_room};
use crate::model::Model;

/// Adds many Jenkins contacts from arrays; entry i of each array describes contact i. All contacts
/// are checked before one is added.
///
/// n              number of contacts, >= 0.
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND; n each.
/// sector_offset  sector of side b counted from that of side a, n numbers; NULL: all 0.
/// kt, mu, preload  tangential stiffness, friction coefficient, normal load; n each.
/// first_id       receives the number of the first contact, the others follow; may be NULL.
/// Errors: as hbvib_model_add_contact, naming the entry; HBVIB_E_DIMENSION (n).
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_model_add_jenkins(
    model: *mut hbvib_model,
    n: i64,
    dof_a: *const i64,
    dof_b: *const i64,
    sector_offset: *const i64,
    kt: *const f64,
    mu: *const f64,
    preload: *const f64,
    first_id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let n = count(n, 2, "n")?;
        let sides = unsafe { Sides::new(dof_a, dof_b, sector_offset, n, model.ndof()) }?;
        let kt = unsafe { input(kt, n, 6, "kt") }?;
        let mu = unsafe { input(mu, n, 7, "mu") }?;
        let preload = unsafe { input(preload, n, 8, "preload") }?;
        if !first_id.is_null() {
            check_pointer(first_id, 9, "first_id")?;
        }
        let mut contacts = try_room(n, "the contacts")?;
        for i in 0..n {
            let mut contact = Contact::jenkins(0, None, kt[i], mu[i], preload[i]);
            (contact.dof_a[0], contact.dof_b[0], contact.sector_offset) = sides.entry(i)?;
            contacts.push(contact);
        }
        let first = model.add_contacts(&contacts).map_err(|e| {
            let arrays = [("kt", 6), ("mu", 7), ("preload", 8), ("sector_offset", 5), ("dof_a", 3)];
            with_named_argument(e, &arrays)
        })?;
        if !first_id.is_null() {
            unsafe { first_id.write(first as i64) };
        }
        Ok(Status::Ok)
    })
}

/// Adds an Iwan joint with four parameters (Segalman 2005): Jenkins contacts in parallel whose slip
/// limits are distributed so that the loss per cycle grows with the power 3 + chi of the amplitude.
///
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND.
/// sector_offset  sector of side b counted from that of side a; 0 in plain models.
/// slip_force     force at which the whole joint slips, > 0.
/// stiffness      tangent stiffness at rest, force per length, > 0.
/// chi            -1 < chi <= 0.
/// beta           ratio of the stiffness that slips last to the rest of the stiffness, >= 0.
/// elements       number of Jenkins contacts, 2 .. 10000; they span five decades of displacement.
/// first_id       receives the number of the first of them, the others follow; may be NULL.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT and HBVIB_E_NOT_FINITE (parameters, equal
/// sides, sector_offset in a plain structure), HBVIB_E_DIMENSION (elements < 0),
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_model_add_iwan(
    model: *mut hbvib_model,
    dof_a: i64,
    dof_b: i64,
    sector_offset: i64,
    slip_force: f64,
    stiffness: f64,
    chi: f64,
    beta: f64,
    elements: i64,
    first_id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let ndof = model.ndof();
        let between = Contact {
            dof_a: [side(dof_a, ndof, 2, format_args!("dof_a"))?, None, None],
            dof_b: [side(dof_b, ndof, 3, format_args!("dof_b"))?, None, None],
            sector_offset,
            ..Contact::jenkins(0, None, 0.0, 0.0, 0.0)
        };
        let joint = Iwan {
            slip_force,
            stiffness,
            chi,
            beta,
        };
        let elements = count(elements, 9, "elements")?;
        if !first_id.is_null() {
            check_pointer(first_id, 10, "first_id")?;
        }
        let first = model.add_iwan(&between, &joint, elements).map_err(|e| {
            let names = [
                ("slip_force", 5),
                ("stiffness", 6),
                ("chi", 7),
                ("beta", 8),
                ("elements", 9),
                ("sector_offset", 4),
                ("dof_a", 2),
            ];
            with_named_argument(e, &names)
        })?;
        if !first_id.is_null() {
            unsafe { first_id.write(first as i64) };
        }
        Ok(Status::Ok)
    })
}
