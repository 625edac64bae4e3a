//! Checks of the description of a contact: constants in their ranges, those of other laws zero, degrees
//! of freedom only along directions in which the law acts.

use crate::contact::description::Contact;
use crate::error::{Result, fail};

impl Contact {
    /// Checks the constants of the law.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the constant, its value and its range.
    pub fn check_constants(&self) -> Result<()> {
        for (name, value, may_be_infinite) in [
            ("kt", self.kt, self.ask(|law| law.may_be_rigid())),
            ("kn", self.kn, false),
            ("mu", self.mu, false),
            (
                "preload",
                self.preload,
                self.ask(|law| law.may_stick_for_ever() || !law.has_preload()),
            ),
            ("velocity", self.velocity, false),
        ] {
            if value.is_nan() || (value.is_infinite() && !may_be_infinite) {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number >= 0");
            }
            if value < 0.0 && name == "preload" && self.kn > 0.0 && self.ask(|law| law.constants().contains(&"gap")) {
                return fail!(
                    Argument,
                    "contact: preload = {value}, needs a number >= 0; gap = {} instead opens the contact as far",
                    self.gap - value / self.kn
                );
            }
            if value < 0.0 {
                return fail!(Argument, "contact: {name} = {value}, needs a number >= 0");
            }
        }
        for (name, value) in [("cubic", self.cubic), ("gap", self.gap)] {
            if !value.is_finite() {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number");
            }
        }
        self.check_slider()?;
        if self.kt.is_infinite() && self.preload.is_infinite() {
            return fail!(
                Argument,
                "contact: kt = inf under an infinite preload ties both sides; make what it connects one degree of freedom"
            );
        }
        let constants = [
            ("kt", self.kt),
            ("kn", self.kn),
            ("mu", self.mu),
            ("preload", self.preload),
            ("gap", self.gap),
            ("cubic", self.cubic),
            ("velocity", self.velocity),
        ];
        let (kind, used, motions) = self.ask(|law| (law.name(), law.constants(), law.motions()));
        for (name, value) in constants {
            if value != 0.0 && !used.contains(&name) {
                return fail!(Argument, "contact: {name} = {value}, needs 0 for a {kind}");
            }
        }
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

    /// Refuses a place of a slider that the law does not have, or whose force nothing limits.
    fn check_slider(&self) -> Result<()> {
        let sliders = self.sliders();
        for (k, &place) in self.slider.iter().enumerate() {
            let name = ["t1", "t2"][k];
            if !place.is_finite() {
                return fail!(
                    NotFinite,
                    "contact: place of the slider along {name} = {place}, needs a finite number"
                );
            }
            if place == 0.0 {
                continue;
            }
            if k >= sliders {
                return fail!(
                    Unsupported,
                    "contact: place of the slider along {name} = {place}, but a {} has none there",
                    self.law_name()
                );
            }
            if self.kt.is_infinite() {
                return fail!(
                    Unsupported,
                    "contact: place of the slider along {name} = {place} under kt = inf, needs a finite kt"
                );
            }
            if self.preload.is_infinite() {
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
