//! A contact patch: many node pairs between two surfaces, each with the share of area that it stands
//! for.

use super::Contact;
use super::sides::Frame;
use crate::error::{Result, fail, try_push};

/// Node pairs of two surfaces. All arrays have one entry per pair; `None` takes the value of `law`.
#[derive(Clone, Copy, Debug)]
pub struct Patch<'a> {
    /// The law per unit of area: kt and kn are force per length and area, preload is a pressure. Its
    /// degrees of freedom and frame are not looked at.
    pub law: &'a Contact,
    /// Degrees of freedom of the nodes on side a in three orthogonal axes; `None` does not move.
    pub dof_a: &'a [[Option<usize>; 3]],
    /// The same on side b; `None`: the ground.
    pub dof_b: Option<&'a [[Option<usize>; 3]]>,
    /// Normals of the contacts in those axes, of any length. Closing is the motion of side b over that of
    /// side a along the normal, which therefore points from b to a where the bodies lie that way.
    pub normal: &'a [[f64; 3]],
    /// First tangential direction, orthogonal to the normal; `None`: any. A law that acts in one
    /// tangential direction alone needs it.
    pub tangent: Option<&'a [[f64; 3]]>,
    /// Area of each pair, at least 0.
    pub area: &'a [f64],
    /// Pressure at rest.
    pub pressure: Option<&'a [f64]>,
    /// Gap at rest, length.
    pub gap: Option<&'a [f64]>,
}

impl Patch<'_> {
    /// The contacts of the patch, pair after pair.
    ///
    /// # Errors
    /// `Dimension` for arrays of different lengths; `Argument` or `NotFinite` naming the array and the
    /// entry; `OutOfMemory`.
    pub fn contacts(&self) -> Result<Vec<Contact>> {
        let n = self.dof_a.len();
        for (name, len) in [
            ("dof_b", self.dof_b.map(<[_]>::len)),
            ("normal", Some(self.normal.len())),
            ("tangent", self.tangent.map(<[_]>::len)),
            ("area", Some(self.area.len())),
            ("pressure", self.pressure.map(<[_]>::len)),
            ("gap", self.gap.map(<[_]>::len)),
        ] {
            if let Some(len) = len.filter(|&len| len != n) {
                return fail!(Dimension, "patch: {name} has {len} entries, needs {n} as dof_a has");
            }
        }
        if self.tangent.is_none() && self.law.needs_tangent() {
            return fail!(
                Argument,
                "patch: tangent is missing; the law acts in one tangential direction, which must be given"
            );
        }
        let mut contacts = Vec::new();
        for i in 0..n {
            let contact = self.contact(i).map_err(|e| e.at(format_args!("patch, entry {i}")))?;
            try_push(&mut contacts, contact, "the contacts")?;
        }
        Ok(contacts)
    }

    fn contact(&self, i: usize) -> Result<Contact> {
        let area = self.area[i];
        if !area.is_finite() {
            return fail!(NotFinite, "area = {area}, needs a finite number >= 0");
        }
        if area < 0.0 {
            return fail!(Argument, "area = {area}, needs a number >= 0");
        }
        let frame = Frame::new(self.normal[i], self.tangent.map(|t| t[i]))?;
        Ok(Contact {
            dof_a: self.dof_a[i],
            dof_b: self.dof_b.map_or([None; 3], |b| b[i]),
            frame: Some(frame),
            kt: self.law.kt * area,
            kn: self.law.kn * area,
            preload: self.pressure.map_or(self.law.preload, |p| p[i]) * area,
            gap: self.gap.map_or(self.law.gap, |g| g[i]),
            ..self.law.clone()
        })
    }
}
