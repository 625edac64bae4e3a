//! Contacts of a model, and a law on a motion of the caller's.

use super::boundary::{Blame, Range, call, check_pointer, count, disjoint, index, input, output};
use super::contact_types::{hbvib_contact, kind};
use super::handles::write;
use super::sized::{Described, init, load};
use super::tables;
use super::types::{hbvib_model, hbvib_special_dof, hbvib_status};
use crate::analysis;
use crate::contact::relative_motion::Frame;
use crate::contact::{Contact, ContactKind};
use crate::error::{Result, Status, fail};
use crate::model::Model;

const GROUND: i64 = hbvib_special_dof::HBVIB_GROUND as i64;

unsafe impl Described for hbvib_contact {
    const NAME: &'static str = "hbvib_contact";
    const FIRST: usize = 104;

    fn filled() -> Self {
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
        }
    }
}

/// The law of a description: neither its degrees of freedom, which need a model to make sense, nor
/// its directions.
pub(super) fn law(c: &hbvib_contact) -> Result<Contact> {
    Ok(Contact {
        kind: kind(c.kind)?,
        dof_a: [None; 3],
        dof_b: [None; 3],
        frame: None,
        sector_offset: c.sector_offset,
        kt: c.kt,
        kn: c.kn,
        mu: c.mu,
        preload: c.preload,
        gap: c.gap,
        cubic: c.cubic,
        velocity: c.velocity,
        dofs: Vec::new(),
    })
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

/// The degrees of freedom of one side.
fn side(dofs: [i64; 3], ndof: usize, name: &str) -> Result<[Option<usize>; 3]> {
    let mut side = [None; 3];
    for (i, (place, &dof)) in side.iter_mut().zip(&dofs).enumerate() {
        *place = tables::side(dof, ndof, 2, format_args!("hbvib_contact: {name}[{i}]"))?;
    }
    Ok(side)
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
/// With normal (and tangent), whatever the kind, all places of a node that moves in three directions.
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
/// tangent that are no directions at a right angle, both sides the same, a degree of freedom twice on
/// one side, sector_offset in a plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_STRUCT_SIZE,
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
        let law = law(&c).blame(2)?;
        let contact = Contact {
            frame: frame(&c, &law).blame(2)?,
            dof_a: side(c.dof_a, model.ndof(), "dof_a").blame(2)?,
            dof_b: side(c.dof_b, model.ndof(), "dof_b").blame(2)?,
            ..law
        };
        let number = model.add_contact(&contact).blame(2)?;
        if !id.is_null() {
            unsafe { id.write(number as i64) };
        }
        Ok(Status::Ok)
    })
}

/// Changes the normal load of a contact. HBVIB_CUBIC, tables, polynomials and forces of the caller
/// have none, which is HBVIB_E_ARGUMENT.
///
/// id       number from hbvib_model_add_contact, or of another function that adds contacts.
/// preload  force, >= 0; infinite, of HBVIB_JENKINS alone, sticks for ever.
/// Errors: HBVIB_E_INDEX (id), HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: one at a time per model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hbvib_model_set_preload(model: *mut hbvib_model, id: i64, preload: f64) -> hbvib_status {
    call(|| {
        let mut model = write::<Model>(model, 1)?;
        let id = index(id, model.contacts().len(), 2, "id")?;
        model.set_preload(id, preload).blame(3)?;
        Ok(Status::Ok)
    })
}

/// Force of one contact law on prescribed relative motions y(t) = Re sum Y_h exp(i h omega t), once
/// it has become periodic, and its Jacobian. Degrees of freedom and directions in the description are
/// not looked at. The law has d motions, side a minus side b: t1 and n of HBVIB_FRICTION_2D, d = 2;
/// t1, t2 and n of HBVIB_FRICTION_3D, d = 3, but t1 and t2 under a constant load, which kn = 0
/// states, d = 2; n of HBVIB_UNILATERAL and t1 of the others, d = 1. The force along n is -N.
///
/// c           the law and its constants.
/// harmonics   highest harmonic number H, 0 .. 100000.
/// samples     0: events are located exactly where the law has them; else samples per period, at
///             least 2H + 1. HBVIB_CUBIC and HBVIB_FRICTION_2D are exact either way;
///             HBVIB_FRICTION_3D and HBVIB_REGULARISED have samples always, 0: a number by H.
/// omega       angular frequency, >= 0; matters to laws that know velocities.
/// motion      d (H + 1) complex numbers, Y_0 .. Y_H of one motion after the other; the imaginary
///             part of Y_0 has no effect.
/// motion_len  complex numbers in it, d (H + 1).
/// force       receives d (H + 1) complex numbers, F_0 .. F_H of one direction after the other.
/// force_len   complex numbers in it, d (H + 1).
/// jac         receives d F / d Y over the pairs (re, im), real, column-major of order 2 d (H + 1);
///             or NULL.
/// jac_len     doubles in it, (2 d (H + 1))^2; 0 with NULL.
/// Errors: HBVIB_E_ARGUMENT (kind, constants, harmonics, samples, omega, overlapping arrays),
/// HBVIB_E_DIMENSION (lengths), HBVIB_E_NOT_FINITE, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any.
#[unsafe(no_mangle)]
#[allow(clippy::too_many_arguments)]
pub unsafe extern "C" fn hbvib_contact_evaluate(
    c: *const hbvib_contact,
    harmonics: i64,
    samples: i64,
    omega: f64,
    motion: *const f64,
    motion_len: i64,
    force: *mut f64,
    force_len: i64,
    jac: *mut f64,
    jac_len: i64,
) -> hbvib_status {
    call(|| {
        let mut contact = law(&unsafe { load(c, 1) }?).blame(1)?;
        if matches!(contact.kind, ContactKind::Friction3d) && contact.kn != 0.0 {
            // A place along n says that the load varies.
            contact.dof_a[2] = Some(0);
        }
        contact.check_constants().blame(1)?;
        let (harmonics, samples) = super::solve::harmonics_and_samples(harmonics, samples, (2, 3))?;
        if !omega.is_finite() || omega < 0.0 {
            return fail!(Argument, "omega = {omega}, needs a finite angular frequency >= 0").blame(4);
        }
        let needed = (harmonics + 1) * contact.directions();
        let motion_len = exact_len(motion_len, needed, 6, "motion_len = d (harmonics + 1)")?;
        let force_len = exact_len(force_len, needed, 8, "force_len = d (harmonics + 1)")?;
        let jac_len = if jac.is_null() && jac_len == 0 {
            0
        } else {
            exact_len(
                jac_len,
                (2 * needed).saturating_mul(2 * needed),
                10,
                "jac_len = (2 d (harmonics + 1))^2",
            )?
        };
        check_pointer(motion, 5, "motion")?;
        check_pointer(force, 7, "force")?;
        disjoint(
            &[Range::new(motion, 2 * motion_len, 5, "motion")?],
            &[
                Range::new(force, 2 * force_len, 7, "force")?,
                Range::new(jac, jac_len, 9, "jac")?,
            ],
        )?;
        let motion = unsafe { input(motion.cast(), motion_len, 5, "motion") }?;
        let force = unsafe { output(force.cast(), force_len, 7, "force") }?;
        let jac = match jac_len {
            0 => None,
            len => Some(unsafe { output(jac, len, 9, "jac") }?),
        };
        analysis::contact_evaluate(&contact, harmonics, samples, omega, motion, force, jac).blame(5)?;
        Ok(Status::Ok)
    })
}

/// A length of the caller that must be `needed`.
pub(super) fn exact_len(len: i64, needed: usize, argument: i32, name: &str) -> Result<usize> {
    match count(len, argument, name) {
        Ok(len) if len == needed => Ok(len),
        _ => fail!(Dimension, "length = {len}, needs {name} = {needed}").blame(argument),
    }
}
