//! Section "Contacts" of the header: a contact of a model, read back.

use crate::capi::contact_calls::contacts::{hbvib_contact, number};
use crate::capi::crossing::arrays::check_pointer;
use crate::capi::crossing::boundary::call;
use crate::capi::crossing::handles::read;
use crate::capi::crossing::indices::{GROUND, index};
use crate::capi::crossing::versioned_struct::{VersionedStruct, check_out, fill_out};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::forms::constants::Constant;
use crate::error::Status;
use crate::model::Model;

/// Describes a contact of a model as hbvib_model_add_contact takes it: preload and gap as they were
/// given, whatever the speed; normal and tangent as unit vectors; contacts of an Iwan joint or a
/// patch one by one. HBVIB_TABLE, HBVIB_POLYNOMIAL and HBVIB_CALLER_LAW have no constants; those on
/// a list of degrees of freedom have no sides.
///
/// id          number from hbvib_model_add_contact or another function that adds contacts.
/// out         receives the description; fill it by hbvib_contact_init before; untouched on error.
/// per_speed2  receives the load per speed squared of hbvib_model_set_preload_at_speed, or NULL.
/// Errors: HBVIB_E_INDEX (id), HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: any number on one model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_contact(
    model: *const hbvib_model,
    id: i64,
    out: *mut hbvib_contact,
    per_speed2: *mut f64,
) -> hbvib_status {
    call(|| {
        let model = read::<Model>(model, 1)?;
        let id = index(id, model.contacts().len(), 2, "id")?;
        unsafe { check_out(out, 3) }?;
        if !per_speed2.is_null() {
            check_pointer(per_speed2, 4, "per_speed2")?;
        }
        let contact = &model.contacts()[id];
        let (preload, coefficient, gap) = model.given_load(id).unwrap_or_default();
        let places = |side: [Option<usize>; 3]| side.map(|dof| dof.map_or(GROUND, |dof| dof as i64));
        let rigid = contact.rigid.unwrap_or_default();
        let [tangent, _, normal] = contact.frame.map_or([[0.0; 3]; 3], |frame| *frame.axes());
        let value = hbvib_contact {
            kind: number(&contact.kind) as i32,
            dof_a: places(contact.dof_a),
            dof_b: places(contact.dof_b),
            sector_offset: contact.sector_offset,
            kt: contact.constant(Constant::Kt),
            kn: contact.constant(Constant::Kn),
            mu: contact.constant(Constant::Mu),
            preload,
            gap,
            cubic: contact.constant(Constant::Cubic),
            velocity: contact.constant(Constant::Velocity),
            normal,
            tangent,
            rotation: places(rigid.rotations),
            arm: rigid.arm,
            turn: rigid.turn,
            ..hbvib_contact::defaults()
        };
        unsafe { fill_out(out, value) };
        if !per_speed2.is_null() {
            unsafe { per_speed2.write(coefficient) };
        }
        Ok(Status::Ok)
    })
}
