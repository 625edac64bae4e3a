//! What the C interface says of a contact.
#![allow(non_camel_case_types)]

use crate::contact::ContactKind;
use crate::error::{Result, fail};

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
    /// The same in the plane of t1 and t2, where slip goes along the force. Without a degree of freedom
    /// along n the load is the preload.
    HBVIB_FRICTION_3D = 3,
    /// Spring along the normal that opens: it pushes the sides apart with
    /// N = max(preload + kn * (closing - gap), 0), where closing = x_b - x_a along n.
    HBVIB_UNILATERAL = 4,
    /// Spring with a cubic term in one direction: f = kt * y + cubic * y^3.
    HBVIB_CUBIC = 5,
    /// Friction with Coulomb's jump smoothed, in one direction:
    /// f = mu * preload * tanh(y' / velocity).
    HBVIB_REGULARISED = 6,
}

/// The kind of a contact by its number in the header.
pub(super) fn kind(number: i32) -> Result<ContactKind> {
    use hbvib_contact_kind as known;
    const JENKINS: i32 = known::HBVIB_JENKINS as i32;
    const FRICTION_2D: i32 = known::HBVIB_FRICTION_2D as i32;
    const FRICTION_3D: i32 = known::HBVIB_FRICTION_3D as i32;
    const UNILATERAL: i32 = known::HBVIB_UNILATERAL as i32;
    const CUBIC: i32 = known::HBVIB_CUBIC as i32;
    const REGULARISED: i32 = known::HBVIB_REGULARISED as i32;
    Ok(match number {
        JENKINS => ContactKind::Jenkins,
        FRICTION_2D => ContactKind::Friction2d,
        FRICTION_3D => ContactKind::Friction3d,
        UNILATERAL => ContactKind::Unilateral,
        CUBIC => ContactKind::Cubic,
        REGULARISED => ContactKind::Regularised,
        other => {
            return fail!(
                Argument,
                "hbvib_contact: kind = {other}, needs {JENKINS} .. {REGULARISED} = HBVIB_JENKINS .. HBVIB_REGULARISED"
            );
        }
    })
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
    /// HBVIB_FRICTION_2D acts along t1 and n, HBVIB_FRICTION_3D along all three, HBVIB_UNILATERAL along
    /// n, the others along t1; places not used must be HBVIB_GROUND. With `normal` all may be used.
    pub dof_a: [i64; 3],
    /// Side b, likewise.
    pub dof_b: [i64; 3],
    /// Cyclic models: side b lies in sector s + sector_offset. 0 in plain ones.
    pub sector_offset: i64,
    /// Tangential stiffness of HBVIB_JENKINS, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D, stiffness of
    /// HBVIB_CUBIC at small motion, force per length, >= 0; 0 for HBVIB_UNILATERAL and
    /// HBVIB_REGULARISED.
    pub kt: f64,
    /// Normal stiffness, force per length, >= 0, of HBVIB_UNILATERAL; > 0 of HBVIB_FRICTION_2D and
    /// HBVIB_FRICTION_3D, but 0 under a constant load; 0 for others.
    pub kn: f64,
    /// Friction coefficient, >= 0; 0 for HBVIB_UNILATERAL and HBVIB_CUBIC.
    pub mu: f64,
    /// Normal load at rest where `gap` is 0, force, >= 0, finite but for HBVIB_JENKINS, where infinite
    /// sticks for ever; 0 for HBVIB_CUBIC.
    pub preload: f64,
    /// Closing at which HBVIB_UNILATERAL, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D of a load that
    /// varies begin to press if they have no preload, any sign: a negative one presses at rest. 0 for
    /// others.
    pub gap: f64,
    /// Stiffness per length squared (force / length^3) of HBVIB_CUBIC, any sign; 0 for others.
    pub cubic: f64,
    /// Velocity at which HBVIB_REGULARISED has 76 % (tanh 1) of its slip limit, > 0; 0 for others.
    pub velocity: f64,
    /// Direction n in the axes of the three degrees of freedom of each side, of any length. Zero, with
    /// `tangent`: the degrees of freedom lie along t1, t2 and n themselves.
    pub normal: [f64; 3],
    /// Direction t1, orthogonal to `normal`, of any length; t2 is n x t1. Zero: any in the plane, for
    /// HBVIB_FRICTION_3D and HBVIB_UNILATERAL alone.
    pub tangent: [f64; 3],
}
