//! Section "Contacts" of the header: one contact, described by a struct.

#![allow(non_camel_case_types)]

use crate::capi::crossing::arrays::check_pointer;
use crate::capi::crossing::boundary::{WithArgument, call};
use crate::capi::crossing::handles::write;
use crate::capi::crossing::indices::{self, GROUND, index};
use crate::capi::crossing::versioned_struct::{VersionedStruct, init, load};
use crate::capi::structures::model::hbvib_model;
use crate::capi::version_and_errors::hbvib_status;
use crate::contact::described::relative_motion::Frame;
use crate::contact::described::rigid_point::RigidPoint;
use crate::contact::forms::constants::Constant;
use crate::contact::{Contact, ContactKind};
use crate::error::{Result, Status, fail};
use crate::model::Model;

/// Contact laws.
#[repr(C)]
pub enum hbvib_contact_kind {
    /// Elastic Coulomb friction with constant normal load in one direction: a spring kt in series
    /// with a slider of limit mu * preload.
    HBVIB_JENKINS = 1,
    /// Elastic Coulomb friction in one tangential direction, t1, under the normal load
    /// N = max(preload + kn * (closing - gap), 0), closing = x_b - x_a along n: a spring kt in series
    /// with a slider of limit mu * N. N pushes the sides apart; where it is 0 the contact is open.
    HBVIB_FRICTION_2D = 2,
    /// The same in the plane of t1 and t2, where slip follows the direction of the force. Without a
    /// degree of freedom along n the load is the preload.
    HBVIB_FRICTION_3D = 3,
    /// Spring along the normal that opens: it pushes the sides apart with
    /// N = max(preload + kn * (closing - gap), 0), where closing = x_b - x_a along n.
    HBVIB_UNILATERAL = 4,
    /// Spring with a cubic term in one direction: f = kt * y + cubic * y^3.
    HBVIB_CUBIC = 5,
    /// Smoothed Coulomb friction in one direction:
    /// f = mu * preload * tanh(y' / velocity).
    HBVIB_REGULARISED = 6,
    /// Read back only (hbvib_model_contact): a spring by hbvib_model_add_table.
    HBVIB_TABLE = 7,
    /// Read back only: springs and dampers by hbvib_model_add_spring_damper, _add_polynomial or
    /// _add_stiffness_tensors.
    HBVIB_POLYNOMIAL = 8,
    /// Read back only: a force of the caller, by hbvib_model_add_user_force.
    HBVIB_CALLER_LAW = 9,
}

/// A contact between two degrees of freedom, or between one and the ground. Fill it by
/// hbvib_contact_init. The force acts on y = x_a - x_b, as +f on side a and -f on side b in
/// M x'' + C x' + K x + f = f_ex.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_contact {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_JENKINS .. HBVIB_REGULARISED.
    pub kind: i32,
    /// Side a: degrees of freedom from 0 in the directions t1, t2, n, or HBVIB_GROUND.
    /// HBVIB_FRICTION_2D acts along t1 and n, HBVIB_FRICTION_3D along all three, HBVIB_UNILATERAL
    /// along n, the others along t1; unused places must be HBVIB_GROUND. With `normal` all may be
    /// used.
    pub dof_a: [i64; 3],
    /// Side b, likewise.
    pub dof_b: [i64; 3],
    /// Cyclic models: side b lies in sector s + sector_offset, -(N - 1) .. N - 1. 0 in plain ones.
    pub sector_offset: i64,
    /// Tangential stiffness of HBVIB_JENKINS, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D, stiffness of
    /// HBVIB_CUBIC at small motion, force per length, >= 0; 0 for HBVIB_UNILATERAL and
    /// HBVIB_REGULARISED. Infinite: a HBVIB_JENKINS contact is rigid while it sticks, in forced
    /// responses.
    pub kt: f64,
    /// Normal stiffness, force per length, >= 0, of HBVIB_UNILATERAL; > 0 of HBVIB_FRICTION_2D and
    /// HBVIB_FRICTION_3D, but 0 under a constant load; 0 for others.
    pub kn: f64,
    /// Friction coefficient, >= 0; 0 for HBVIB_UNILATERAL and HBVIB_CUBIC.
    pub mu: f64,
    /// Normal load at rest where `gap` is 0, force, >= 0; infinite for HBVIB_JENKINS alone, a
    /// contact that never slips; 0 for HBVIB_CUBIC.
    pub preload: f64,
    /// Closing at which HBVIB_UNILATERAL, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D with a varying
    /// load begin to press if they have no preload, any sign: with a negative gap they press at
    /// rest. 0 for others.
    pub gap: f64,
    /// Stiffness per length squared (force / length^3) of HBVIB_CUBIC, any sign; 0 for others.
    pub cubic: f64,
    /// Velocity at which HBVIB_REGULARISED reaches 76 % (tanh 1) of its slip limit, > 0; 0 for
    /// others.
    pub velocity: f64,
    /// Direction n in the axes of the three degrees of freedom of each side, of any length. Zero,
    /// with `tangent`: the degrees of freedom lie along t1, t2 and n themselves.
    pub normal: [f64; 3],
    /// Direction t1, orthogonal to `normal`, of any length; t2 is n x t1. Zero: any in the plane,
    /// for HBVIB_FRICTION_3D and HBVIB_UNILATERAL alone.
    pub tangent: [f64; 3],
    /// Side a is a point of a rigid body: rotations of the body about the axes of `dof_a`, which are
    /// then the translations of its centre of mass, or HBVIB_GROUND; with `normal` only.
    pub rotation: [i64; 3],
    /// The point of the contact from the centre of mass of that body, in the axes of `dof_a`.
    pub arm: [f64; 3],
    /// Angle in radians by which the axes of `dof_b` are turned about the third one of `dof_a`; with
    /// `normal` only, which is in the axes of `dof_a`.
    pub turn: f64,
}

unsafe impl VersionedStruct for hbvib_contact {
    const NAME: &'static str = "hbvib_contact";
    const FIRST_SIZE: usize = 104;

    fn defaults() -> Self {
        Self {
            struct_size: 0,
            kind: 0,
            dof_a: [GROUND; 3],
            dof_b: [GROUND; 3],
            sector_offset: 0,
            kt: 0.0,
            kn: 0.0,
            mu: 0.0,
            preload: 0.0,
            gap: 0.0,
            cubic: 0.0,
            velocity: 0.0,
            normal: [0.0; 3],
            tangent: [0.0; 3],
            rotation: [GROUND; 3],
            arm: [0.0; 3],
            turn: 0.0,
        }
    }
}

/// Fills a contact description: struct_size, every degree of freedom HBVIB_GROUND, the rest zero.
/// Then set kind, the degrees of freedom and the constants of the kind:
/// HBVIB_JENKINS      first places of dof_a and dof_b; kt, mu, preload;
/// HBVIB_FRICTION_2D  first and third places; kt, kn, mu, preload or gap;
/// HBVIB_FRICTION_3D  all places; kt, kn, mu, preload or gap; under a constant load the first and
///                    second places; kt, mu, preload;
/// HBVIB_UNILATERAL   third places; kn, gap or preload;
/// HBVIB_CUBIC        first places; kt, cubic;
/// HBVIB_REGULARISED  first places; mu, preload, velocity.
/// With normal (and tangent), whatever the kind, all places of a node that moves in three
/// directions.
///
/// c          the struct; untouched on error.
/// size_of_c  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_contact_init(c: *mut hbvib_contact, size_of_c: usize) -> hbvib_status {
    call(|| unsafe { init(c, size_of_c) })
}

/// Adds a contact. Equal contacts add up.
///
/// c   the description.
/// id  receives the number of the contact, counted from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT (kind, constants out of range, normal and
/// tangent that are not orthogonal directions, equal sides, a degree of freedom twice on one side,
/// sector_offset in a plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_add_contact(
    model: *mut hbvib_model,
    c: *const hbvib_contact,
    id: *mut i64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let c = unsafe { load(c, 2) }?;
        if !id.is_null() {
            check_pointer(id, 3, "id")?;
        }
        let law = law(&c).with_argument(2)?;
        let contact = Contact {
            frame: frame(&c, &law).with_argument(2)?,
            dof_a: side(c.dof_a, model.ndof(), "dof_a").with_argument(2)?,
            dof_b: side(c.dof_b, model.ndof(), "dof_b").with_argument(2)?,
            rigid: rigid(&c, model.ndof()).with_argument(2)?,
            ..law
        };
        let number = model.add_contact(&contact).with_argument(2)?;
        if !id.is_null() {
            unsafe { id.write(number as i64) };
        }
        Ok(Status::Ok)
    })
}

/// Changes the normal load of a contact. HBVIB_CUBIC, tables, polynomials and forces of the caller
/// have no normal load: HBVIB_E_ARGUMENT.
///
/// id       number from hbvib_model_add_contact or another function that adds contacts.
/// preload  force, >= 0; infinite for HBVIB_JENKINS alone, which then never slips.
/// Errors: HBVIB_E_INDEX (id), HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_preload(model: *mut hbvib_model, id: i64, preload: f64) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let id = index(id, model.contacts().len(), 2, "id")?;
        model.set_preload(id, preload).with_argument(3)?;
        Ok(Status::Ok)
    })
}

/// Places the slider of a friction contact before any motion: the residual state that an assembly
/// or an earlier load has left. A contact that sticks through the period has the tangential force
/// kt (x - place); a place from which its limit would drag the slider acts as the nearest one
/// within. A contact that slips or opens in every period forgets it.
///
/// id         number from hbvib_model_add_contact or another function that adds contacts.
/// direction  0 for t1; 1 for t2, of HBVIB_FRICTION_3D alone.
/// place      length, finite; 0 at first.
/// Errors: HBVIB_E_INDEX (id, direction), HBVIB_E_UNSUPPORTED (the contact has no slider there, or
/// an infinite preload), HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time
/// per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_slider(
    model: *mut hbvib_model,
    id: i64,
    direction: i64,
    place: f64,
) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let id = index(id, model.contacts().len(), 2, "id")?;
        let direction = index(direction, 2, 3, "direction")?;
        let argument = if place.is_finite() { 3 } else { 4 };
        model.set_slider(id, direction, place).with_argument(argument)?;
        Ok(Status::Ok)
    })
}

/// The law of a kind of the header, its constants 0.
fn kind(requested: i32) -> Result<ContactKind> {
    const FIRST: i32 = hbvib_contact_kind::HBVIB_JENKINS as i32;
    const LAST: i32 = hbvib_contact_kind::HBVIB_REGULARISED as i32;
    let mut laws = ContactKind::named().into_iter();
    let Some(kind) = laws.find(|kind| number(kind) as i32 == requested) else {
        return fail!(
            Argument,
            "hbvib_contact: kind = {requested}, needs {FIRST} .. {LAST} = HBVIB_JENKINS .. HBVIB_REGULARISED"
        );
    };
    Ok(kind)
}

/// The kind of the header.
pub(crate) fn number(kind: &ContactKind) -> hbvib_contact_kind {
    match kind {
        ContactKind::Jenkins(_) => hbvib_contact_kind::HBVIB_JENKINS,
        ContactKind::Friction2d(_) => hbvib_contact_kind::HBVIB_FRICTION_2D,
        ContactKind::Friction3d(_) => hbvib_contact_kind::HBVIB_FRICTION_3D,
        ContactKind::Unilateral(_) => hbvib_contact_kind::HBVIB_UNILATERAL,
        ContactKind::Cubic(_) => hbvib_contact_kind::HBVIB_CUBIC,
        ContactKind::Regularised(_) => hbvib_contact_kind::HBVIB_REGULARISED,
        ContactKind::Table(_) => hbvib_contact_kind::HBVIB_TABLE,
        ContactKind::Polynomial(_) => hbvib_contact_kind::HBVIB_POLYNOMIAL,
        ContactKind::User(_) => hbvib_contact_kind::HBVIB_CALLER_LAW,
    }
}

/// The law of a description, without its degrees of freedom, which only a model can check, and
/// without its directions.
pub(crate) fn law(c: &hbvib_contact) -> Result<Contact> {
    let mut contact = Contact {
        sector_offset: c.sector_offset,
        ..Contact::of_sides(kind(c.kind)?, [None; 3], [None; 3])
    };
    for (constant, value) in [
        (Constant::Kt, c.kt),
        (Constant::Kn, c.kn),
        (Constant::Mu, c.mu),
        (Constant::Preload, c.preload),
        (Constant::Gap, c.gap),
        (Constant::Cubic, c.cubic),
        (Constant::Velocity, c.velocity),
    ] {
        contact.set(constant, value)?;
    }
    Ok(contact)
}

/// The directions of a description; none where normal and tangent are zero.
fn frame(c: &hbvib_contact, law: &Contact) -> Result<Option<Frame>> {
    let zero = |v: [f64; 3]| v.iter().all(|&x| x == 0.0);
    if zero(c.normal) && zero(c.tangent) {
        return Ok(None);
    }
    let tangent = if zero(c.tangent) { None } else { Some(c.tangent) };
    if tangent.is_none() && law.needs_tangent() {
        return fail!(
            Argument,
            "hbvib_contact: tangent is zero, needs a direction; kind = {} acts in one tangential direction",
            c.kind
        );
    }
    match Frame::new(c.normal, tangent) {
        Ok(frame) => Ok(Some(frame)),
        Err(e) => Err(e.at(format_args!("hbvib_contact"))),
    }
}

/// The rigid body of side a; none where nothing turns.
fn rigid(c: &hbvib_contact, ndof: usize) -> Result<Option<RigidPoint>> {
    let rigid = RigidPoint {
        rotations: side(c.rotation, ndof, "rotation")?,
        arm: c.arm,
        turn: c.turn,
    };
    Ok((!rigid.is_plain()).then_some(rigid))
}

/// The degrees of freedom of one side.
fn side(dofs: [i64; 3], ndof: usize, name: &str) -> Result<[Option<usize>; 3]> {
    let mut side = [None; 3];
    for (i, (place, &dof)) in side.iter_mut().zip(&dofs).enumerate() {
        *place = indices::side(dof, ndof, 2, format_args!("hbvib_contact: {name}[{i}]"))?;
    }
    Ok(side)
}
