//! Checks of the description of a contact: constants in their ranges, degrees of freedom only along directions in which the
//! law acts.

use crate::contact::described::description::Contact;
use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail};

impl Contact {
    /// Checks the constants of the law.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the constant, its value and its range.
    pub fn check_constants(&self) -> Result<()> {
        for constant in Constant::DESCRIBED
            .into_iter()
            .filter(|constant| !constant.has_any_sign())
        {
            let (name, value) = (constant.name(), self.constant(constant));
            if value.is_nan() || (value.is_infinite() && !self.ask(|law| law.may_be_infinite(constant))) {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number >= 0");
            }
            let (kn, gap) = (self.constant(Constant::Kn), self.constant(Constant::Gap));
            if value < 0.0 && constant == Constant::Preload && kn > 0.0 {
                return fail!(
                    Argument,
                    "contact: preload = {value}, needs a number >= 0; gap = {} instead opens the contact as far",
                    gap - value / kn
                );
            }
            if value < 0.0 {
                return fail!(Argument, "contact: {name} = {value}, needs a number >= 0");
            }
        }
        for constant in [Constant::Cubic, Constant::Gap] {
            let (name, value) = (constant.name(), self.constant(constant));
            if !value.is_finite() {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number");
            }
        }
        self.check_slider()?;
        if self.constant(Constant::Kt).is_infinite() && self.constant(Constant::Preload).is_infinite() {
            return fail!(
                Argument,
                "contact: kt = inf under an infinite preload ties both sides; make what it connects one degree of freedom"
            );
        }
        let (kind, motions) = self.ask(|law| (law.name(), law.motions()));
        self.ask(|law| law.check())?;
        let needed = motions.unwrap_or(self.places().len());
        if self.directions() != needed || !(self.dofs.is_empty() || motions.is_some()) {
            return fail!(
                Dimension,
                "contact: {} degrees of freedom for a {kind} of {needed} motions",
                self.directions()
            );
        }
        self.check_places(kind)
    }

    /// Refuses a contact that has no force at any motion for want of a stiffness. A slip limit of zero is none of
    /// this: a preload may be changed later.
    ///
    /// # Errors
    /// `Argument`, naming the constant.
    pub fn check_stiffness(&self) -> Result<()> {
        self.ask(|law| law.check_stiffness())
    }

    /// Refuses a place of a slider whose force nothing limits.
    fn check_slider(&self) -> Result<()> {
        for (name, place) in ["t1", "t2"].into_iter().zip(self.slider()) {
            if !place.is_finite() {
                return fail!(
                    NotFinite,
                    "contact: place of the slider along {name} = {place}, needs a finite number"
                );
            }
            if place == 0.0 {
                continue;
            }
            if self.constant(Constant::Kt).is_infinite() {
                return fail!(
                    Unsupported,
                    "contact: place of the slider along {name} = {place} under kt = inf, needs a finite kt"
                );
            }
            if self.constant(Constant::Preload).is_infinite() {
                return fail!(
                    Unsupported,
                    "contact: place of the slider along {name} = {place} under an infinite preload, which is a linear spring; give its force \
                     as a constant one"
                );
            }
        }
        Ok(())
    }

    /// Refuses degrees of freedom along directions in which the law does not act.
    fn check_places(&self, kind: &str) -> Result<()> {
        if self.frame.is_some() {
            return Ok(());
        }
        for (name, dofs) in [("dof_a", self.dof_a), ("dof_b", self.dof_b)] {
            for (i, dof) in dofs.iter().enumerate() {
                if let Some(dof) = dof.filter(|_| !self.places().contains(&i)) {
                    return fail!(
                        Argument,
                        "contact: {name}[{i}] = {dof}, needs to be empty; a {kind} does not act along {}",
                        ["t1", "t2", "n"][i]
                    );
                }
            }
        }
        Ok(())
    }
}
