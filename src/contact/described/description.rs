//! The description of a contact by the caller.
//!
//! A [`Contact`] names the degrees of freedom of its sides, and its kind carries the law with its constants in the
//! caller's units; the law answers for its role in the model, and [`Contact::law`] makes of it the [`Law`] that a
//! solver evaluates, in the solver's units.

use crate::contact::described::relative_motion::{Direction, Frame};
use crate::contact::described::rigid_point::RigidPoint;
use crate::contact::forms::constants::{Constant, Role, clearance, load, slip_limit};
use crate::contact::forms::force_derivative::ForceDerivative;
use crate::contact::forms::law::{ContactLaw, Law, LawInTime};
use crate::contact::laws::ContactKind;
use crate::error::{Result, fail};
use std::sync::Arc;

/// A contact between two sides, one of which may be the ground.
#[derive(Clone, Debug)]
pub struct Contact {
    /// The law with its constants.
    pub kind: ContactKind,
    /// Degrees of freedom of side a along t1, t2 and n; `None` is the ground. A unilateral spring acts
    /// along n, laws of one direction along t1; places that are not used are `None`.
    pub dof_a: [Option<usize>; 3],
    /// Degrees of freedom of side b, likewise.
    pub dof_b: [Option<usize>; 3],
    /// Directions t1, t2 and n in the axes of the three degrees of freedom of each side, all of which
    /// may then be used; `None`: the degrees of freedom lie along t1, t2 and n themselves.
    pub frame: Option<Frame>,
    /// Side b lies in sector s + offset (cyclic models).
    pub sector_offset: i64,
    /// Degrees of freedom on whose motions over the ground a law of the caller or a polynomial acts, in its
    /// order. Empty: the law acts on one motion, that between `dof_a` and `dof_b` along t1.
    pub dofs: Vec<usize>,
    /// Side a is a point of a rigid body that turns, or the axes of side b are turned; it needs a frame. `None`: two nodes.
    pub rigid: Option<RigidPoint>,
}

impl Contact {
    /// A constant of the law; 0 for one that it does not have.
    #[must_use]
    pub fn constant(&self, constant: Constant) -> f64 {
        self.kind.data().constant(constant).unwrap_or(0.0)
    }

    /// Changes a constant of the law. One that it does not have is 0.
    ///
    /// # Errors
    /// `NotFinite` or `Argument` for a constant that the law does not have, unless the value is 0.
    pub fn set(&mut self, constant: Constant, value: f64) -> Result<()> {
        if let Some(place) = self.kind.data_mut().constant_mut(constant) {
            *place = value;
        } else if value != 0.0 {
            let (name, kind) = (constant.name(), self.law_name());
            if value.is_nan() {
                return fail!(NotFinite, "contact: {name} = {value}, needs 0 for a {kind}");
            }
            return fail!(Argument, "contact: {name} = {value}, needs 0 for a {kind}");
        }
        Ok(())
    }

    /// The contact with another value of a constant.
    ///
    /// # Errors
    /// Those of [`Self::set`].
    pub fn with(mut self, constant: Constant, value: f64) -> Result<Self> {
        self.set(constant, value)?;
        Ok(self)
    }

    /// The contact under another normal load and gap, as far as its law has them.
    pub(crate) fn under(&self, preload: f64, gap: f64) -> Self {
        let mut changed = self.clone();
        for (constant, value) in [(Constant::Preload, preload), (Constant::Gap, gap)] {
            if let Some(place) = changed.kind.data_mut().constant_mut(constant) {
                *place = value;
            }
        }
        changed
    }

    /// Places of the sliders of friction along t1 and t2 before any motion; 0 where there is none.
    #[must_use]
    pub fn slider(&self) -> [f64; 2] {
        [0, 1].map(|k| self.constant(Constant::Slider(k)))
    }

    /// Answer of the law to a question.
    pub(super) fn ask<R>(&self, question: impl FnOnce(&dyn ContactLaw) -> R) -> R {
        self.kind.ask(self.has_normal(), question)
    }

    /// Whether a side can move along n.
    fn has_normal(&self) -> bool {
        let place = |dofs: [Option<usize>; 3]| match &self.frame {
            None => dofs[2].is_some(),
            Some(frame) => frame.side(dofs, 2).iter().any(Option::is_some),
        };
        place(self.dof_a) || place(self.dof_b)
    }

    /// Closing at which a unilateral spring begins to press, the preload counted in; negative for one
    /// that presses at rest.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        clearance(
            self.constant(Constant::Kn),
            self.constant(Constant::Preload),
            self.constant(Constant::Gap),
        )
    }

    /// n₀ of a load N = max(n₀ − kn·y, 0) that varies; negative where a gap is open at rest.
    #[must_use]
    pub fn load(&self) -> f64 {
        load(
            self.constant(Constant::Kn),
            self.constant(Constant::Preload),
            self.constant(Constant::Gap),
        )
    }

    /// Whether the contact is rigid while it sticks, kt infinite.
    #[must_use]
    pub fn is_rigid(&self) -> bool {
        self.constant(Constant::Kt).is_infinite() && self.role() == Role::Active
    }

    /// Slip limit μN₀; zero without friction under any load.
    #[must_use]
    pub fn slip_limit(&self) -> f64 {
        slip_limit(self.constant(Constant::Mu), self.constant(Constant::Preload))
    }

    /// Whether the contact presses at rest: then it loads the structure without vibration.
    #[must_use]
    pub fn is_preloaded(&self) -> bool {
        self.ask(|law| law.is_preloaded())
    }

    /// The places (t1, t2, n as 0, 1, 2) in which the law acts, in the order of its motions.
    #[must_use]
    pub fn places(&self) -> &'static [usize] {
        match self.ask(|law| law.places()) {
            // Over a list of degrees of freedom instead.
            [0] if !self.dofs.is_empty() => &[],
            places => places,
        }
    }

    /// Number of relative motions on which the law acts.
    #[must_use]
    pub fn directions(&self) -> usize {
        self.places().len().max(self.dofs.len())
    }

    /// The k-th of them.
    #[must_use]
    pub fn direction(&self, k: usize) -> Direction {
        if let Some(&dof) = self.dofs.get(k) {
            return Direction::between(Some(dof), None);
        }
        let place = self.places()[k];
        match &self.frame {
            None => Direction::between(self.dof_a[place], self.dof_b[place]),
            Some(frame) => {
                let rigid = self.rigid.unwrap_or_default();
                Direction {
                    a: rigid.side_a(frame, self.dof_a, place),
                    b: frame.seen_from(rigid.turn).side(self.dof_b, place),
                }
            }
        }
    }

    /// Place among the motions of the one along the normal, for contacts whose load varies with it.
    #[must_use]
    pub fn normal_direction(&self) -> Option<usize> {
        self.places().iter().position(|place| *place == 2)
    }

    /// The law, with lengths in units of `length` and forces in units of `length` times the caller's
    /// stiffness.
    ///
    /// # Errors
    /// Those of [`Self::check_constants`].
    #[doc(hidden)]
    pub fn law(&self, length: f64) -> Result<Arc<dyn Law>> {
        self.ask(|law| law.law(length))
    }

    /// The same force over the exchanged motion with its stiffness, that of a mass or of a rate; `None` where the law has none.
    #[doc(hidden)]
    pub(crate) fn exchanged(&self, by: (f64, Option<f64>), length: f64) -> Option<Arc<dyn Law>> {
        self.ask(|law| law.exchanged(by, length))
    }

    /// The law of an active contact in an integration in time, in the caller's units.
    ///
    /// # Errors
    /// `Unsupported` for laws that cannot be integrated in time.
    #[doc(hidden)]
    pub fn in_time(&self) -> Result<LawInTime> {
        self.ask(|law| law.in_time())
    }

    /// Stiffness of the force in the k-th direction by the l-th motion at small motion. A law of the
    /// caller is not evaluated, and counts as 0.
    #[must_use]
    pub fn stiffness_at_small_motion(&self, k: usize, l: usize) -> f64 {
        self.ask(|law| law.stiffness_at_small_motion(k, l))
    }

    /// Largest stiffness along the k-th motion, but for terms that grow with the motion.
    #[must_use]
    pub fn stiffness(&self, k: usize) -> f64 {
        self.ask(|law| law.stiffness(k))
    }

    /// Whether the force is a law of the caller.
    pub(crate) fn is_of_caller(&self) -> bool {
        self.kind.user().is_some()
    }

    /// Largest change of the force by the relative velocity, N s/m; 0 for a law of the motion alone or of the caller.
    pub(crate) fn resistance(&self) -> f64 {
        self.ask(|law| law.resistance())
    }

    /// Stiffness of a contact that is linear at any motion; 0 without force.
    #[must_use]
    pub fn stiffness_as_spring(&self) -> f64 {
        if self.role() == Role::Inert {
            0.0
        } else {
            self.constant(Constant::Kt)
        }
    }

    /// Whether the law needs the direction t1, not just the plane of it.
    #[must_use]
    pub fn needs_tangent(&self) -> bool {
        self.places().contains(&0) && !self.places().contains(&1)
    }

    /// Whether every motion meets exactly [`Self::stiffness`] while the contact sticks (along the normal:
    /// while it is closed), as with friction.
    #[must_use]
    pub fn may_stick(&self) -> bool {
        self.sliders() > 0
    }

    /// Whether the stiffness may grow beyond [`Self::stiffness`], or that be zero.
    #[must_use]
    pub fn is_spring(&self) -> bool {
        self.ask(|law| law.is_spring())
    }

    /// Role that the constants of the law give the contact.
    #[must_use]
    #[doc(hidden)]
    pub fn role(&self) -> Role {
        self.ask(|law| law.role())
    }

    /// Number of directions in which the contact has a slider; 0 for laws without.
    #[must_use]
    pub fn sliders(&self) -> usize {
        let has = |k: &usize| self.kind.data().constant(Constant::Slider(*k)).is_some();
        (0..2).filter(has).count()
    }

    /// Whether the place of a slider is given.
    #[must_use]
    pub fn is_placed(&self) -> bool {
        self.slider().iter().any(|place| *place != 0.0)
    }

    /// Name of the contact if it has no normal load.
    #[must_use]
    pub fn without_load(&self) -> Option<&'static str> {
        let has_load = self.kind.data().constant(Constant::Preload).is_some();
        (!has_load).then(|| self.law_name())
    }

    /// Whether motion and normal load scale together; if not, the force is proportional to the load.
    #[must_use]
    pub fn load_scales_motion(&self) -> bool {
        self.ask(|law| law.load_scales_motion())
    }

    /// Name of the law in messages.
    #[must_use]
    pub fn law_name(&self) -> &'static str {
        self.ask(|law| law.name())
    }

    /// The derivative of the force by a constant of the law; `None` for a constant that it does not have.
    #[must_use]
    #[doc(hidden)]
    pub fn by_constant(&self, constant: Constant) -> Option<ForceDerivative> {
        self.ask(|law| law.by_constant(constant))
    }

    /// A bound of the force in each direction over all motions; infinite where there is none.
    #[must_use]
    pub fn largest_force(&self) -> f64 {
        self.ask(|law| match law.role() {
            Role::Inert => 0.0,
            _ => law.largest_force(),
        })
    }

    /// Normal load at the relative motion y along the normal, side a minus side b; that at rest for a
    /// contact whose load does not change, 0 for one that has none.
    #[must_use]
    pub fn normal_load(&self, y: f64) -> f64 {
        self.ask(|law| law.normal_load(y))
    }
}
