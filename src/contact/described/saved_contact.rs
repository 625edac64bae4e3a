//! A contact as bytes.

use crate::byte_stream::{ByteReader, ByteWriter};
use crate::contact::described::description::Contact;
use crate::contact::described::relative_motion::Frame;
use crate::contact::described::rigid_point::RigidPoint;
use crate::contact::forms::constants::Constant;
use crate::contact::laws::ContactKind;
use crate::error::{Result, try_push};

/// Largest deviation of the products of the axes of a frame from those of unit vectors.
/// Kind: rounding.
const SAVED_CONTACT_SQUARE: f64 = 1e-9;

/// Bytes that a contact has at least: kind, sides, frame, offset, seven constants and the length of its list.
/// Kind: fixed.
pub(crate) const CONTACT_LEAST_BYTES: usize = 1 + 48 + 1 + 8 + 56 + 8;

/// Writes the contact.
///
/// # Errors
/// `Unsupported` for a law of the caller.
pub(crate) fn save_to(contact: &Contact, out: &mut ByteWriter<'_>) -> Result<()> {
    contact.kind.save_to(out)?;
    places_to(contact, out);
    Ok(())
}

/// Writes all but the kind.
pub(crate) fn places_to(contact: &Contact, out: &mut ByteWriter<'_>) {
    for dof in contact.dof_a.iter().chain(&contact.dof_b) {
        out.optional(*dof);
    }
    out.bool(contact.frame.is_some());
    if let Some(frame) = &contact.frame {
        for &x in frame.axes().iter().flatten() {
            out.f64(x);
        }
    }
    out.i64(contact.sector_offset);
    for constant in Constant::DESCRIBED {
        out.f64(contact.constant(constant));
    }
    out.count(contact.dofs.len());
    for &dof in &contact.dofs {
        out.count(dof);
    }
}

/// Writes the rigid body of side a.
pub(crate) fn rigid_to(contact: &Contact, out: &mut ByteWriter<'_>) {
    out.bool(contact.rigid.is_some());
    let Some(rigid) = &contact.rigid else { return };
    for dof in rigid.rotations {
        out.optional(dof);
    }
    for x in rigid.arm.iter().chain([&rigid.turn]) {
        out.f64(*x);
    }
}

/// Reads the rigid body of side a.
///
/// # Errors
/// `Argument` for bytes that are none.
pub(crate) fn load_rigid(contact: &mut Contact, input: &mut ByteReader<'_>) -> Result<()> {
    if !input.bool()? {
        return Ok(());
    }
    let mut rigid = RigidPoint::default();
    for dof in &mut rigid.rotations {
        *dof = input.optional()?;
    }
    for x in rigid.arm.iter_mut().chain([&mut rigid.turn]) {
        *x = input.finite()?;
    }
    contact.rigid = Some(rigid);
    Ok(())
}

/// Reads a contact; its model checks constants and degrees of freedom.
///
/// # Errors
/// `Argument` for bytes that are no contact; `OutOfMemory`.
pub(crate) fn load_from(input: &mut ByteReader<'_>) -> Result<Contact> {
    let kind = ContactKind::load_from(input)?;
    let mut sides = [[None; 3]; 2];
    for dof in sides.iter_mut().flatten() {
        *dof = input.optional()?;
    }
    let frame = if input.bool()? {
        let mut axes = [[0.0; 3]; 3];
        for x in axes.iter_mut().flatten() {
            *x = input.finite()?;
        }
        let Some(frame) = Frame::of_axes(axes, SAVED_CONTACT_SQUARE) else {
            return Err(input.damaged("the directions of a contact are not orthogonal"));
        };
        Some(frame)
    } else {
        None
    };
    let sector_offset = input.i64()?;
    let mut constants = [0.0; Constant::DESCRIBED.len()];
    for value in &mut constants {
        *value = input.f64()?;
    }
    let mut dofs = Vec::new();
    for _ in 0..input.entries(8)? {
        try_push(&mut dofs, input.count()?, "a loaded contact")?;
    }
    let [dof_a, dof_b] = sides;
    let mut contact = Contact {
        frame,
        sector_offset,
        dofs,
        ..Contact::of_sides(kind, dof_a, dof_b)
    };
    for (constant, value) in Constant::DESCRIBED.into_iter().zip(constants) {
        contact.set(constant, value)?;
    }
    Ok(contact)
}
