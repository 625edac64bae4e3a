//! A contact patch: many node pairs between two surfaces, each with its share of the area.

use crate::contact::described::description::Contact;
use crate::contact::described::relative_motion::Frame;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail, try_push};

/// Node pairs of two surfaces. All arrays have one entry per pair; `None` takes the value of `law`.
#[derive(Clone, Copy, Debug)]
pub struct Patch<'a> {
    /// The law per unit of area: kt and kn are force per length and area, cubic force per length cubed
    /// and area, preload is a pressure. Its degrees of freedom and frame are ignored.
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
    /// Area of each pair, at least 0; without area a pair has no force.
    pub area: &'a [f64],
    /// Pressure at rest, at least 0.
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
        self.check_law().map_err(|e| e.at(format_args!("patch, law")))?;
        if n > 0 && self.tangent.is_none() && self.law.needs_tangent() {
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

    /// Checks the law by itself, so that its errors do not name an entry.
    fn check_law(&self) -> Result<()> {
        let law = self.law;
        let (per_area, kind) = law.ask(|law| (law.is_per_area(), law.name()));
        if !per_area {
            return fail!(Unsupported, "a {kind} is no law per unit of area");
        }
        // Between a node that moves along t1, t2 and n, and the ground.
        let frame = Frame::new([0.0, 0.0, 1.0], Some([1.0, 0.0, 0.0]))?;
        let contact = Contact {
            frame: Some(frame),
            ..Contact::of_sides(law.kind.clone(), [Some(0), Some(1), Some(2)], [None; 3])
        };
        let given = |array: Option<&[f64]>, constant| array.map_or(law.constant(constant), |_| 0.0);
        let (preload, gap) = (given(self.pressure, Constant::Preload), given(self.gap, Constant::Gap));
        contact
            .with(Constant::Preload, preload)?
            .with(Constant::Gap, gap)?
            .check_constants()
    }

    fn contact(&self, i: usize) -> Result<Contact> {
        let at_least_0 = |name: &str, value: f64, may_be_infinite: bool| {
            if value.is_nan() || (value.is_infinite() && !may_be_infinite) {
                return fail!(NotFinite, "{name} = {value}, needs a finite number >= 0");
            }
            if value < 0.0 {
                return fail!(Argument, "{name} = {value}, needs a number >= 0");
            }
            Ok(value)
        };
        let (law, area) = (self.law, at_least_0("area", self.area[i], false)?);
        let pressure = match self.pressure {
            Some(pressure) => at_least_0(
                "pressure",
                pressure[i],
                law.ask(|law| law.may_be_infinite(Constant::Preload)),
            )?,
            None => law.constant(Constant::Preload),
        };
        let gap = self.gap.map_or(law.constant(Constant::Gap), |gap| gap[i]);
        if !gap.is_finite() {
            return fail!(NotFinite, "gap = {gap}, needs a finite number");
        }
        let mut contact = Contact {
            frame: Some(Frame::new(self.normal[i], self.tangent.map(|t| t[i]))?),
            sector_offset: law.sector_offset,
            ..Contact::of_sides(law.kind.clone(), self.dof_a[i], self.dof_b.map_or([None; 3], |b| b[i]))
        };
        for constant in Constant::DESCRIBED
            .into_iter()
            .filter(|constant| constant.is_per_area())
        {
            contact.set(constant, law.constant(constant) * area)?;
        }
        // An infinite pressure on no area is no load.
        contact.set(Constant::Preload, if area == 0.0 { 0.0 } else { pressure * area })?;
        contact.with(Constant::Gap, gap)
    }
}
