//! Checks of what a caller says of a contact: constants in their ranges, those of other laws zero, degrees
//! of freedom only along directions in which the law acts.

use crate::contact::laws::regularised::TanhFriction;
use crate::contact::{Contact, ContactKind, Law};
use crate::error::{Result, fail};

impl Contact {
    /// Checks the constants of the law.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the constant, its value and its range.
    pub fn check_constants(&self) -> Result<()> {
        for (name, value, may_be_infinite) in [
            ("kt", self.kt, false),
            ("kn", self.kn, false),
            ("mu", self.mu, false),
            ("preload", self.preload, self.may_stick_for_ever()),
            ("velocity", self.velocity, false),
        ] {
            if value.is_nan() || (value.is_infinite() && !may_be_infinite) {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number >= 0");
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
        let (kt, kn, mu) = (("kt", self.kt), ("kn", self.kn), ("mu", self.mu));
        let (preload, gap, cubic) = (("preload", self.preload), ("gap", self.gap), ("cubic", self.cubic));
        let velocity = ("velocity", self.velocity);
        let (unused, kind): (&[(&str, f64)], _) = match &self.kind {
            ContactKind::Jenkins => (&[kn, gap, cubic, velocity], "Jenkins contact"),
            ContactKind::Cubic => (&[kn, mu, preload, gap, velocity], "cubic spring"),
            ContactKind::Unilateral => (&[kt, mu, cubic, velocity], "unilateral spring"),
            ContactKind::Friction2d | ContactKind::Friction3d => (&[cubic, velocity], "friction contact"),
            ContactKind::Regularised => (&[kt, kn, gap, cubic], "regularised friction"),
            ContactKind::Table(_) => (&[kt, kn, mu, preload, gap, cubic, velocity], "table"),
            ContactKind::Polynomial(_) => (&[kt, kn, mu, preload, gap, cubic, velocity], "polynomial"),
            ContactKind::User(_) => (&[kt, kn, mu, preload, gap, cubic, velocity], "law of the host"),
        };
        for &(name, value) in unused {
            if value != 0.0 {
                return fail!(Argument, "contact: {name} = {value}, needs 0 for a {kind}");
            }
        }
        self.check_normal()?;
        if let ContactKind::Regularised = self.kind {
            TanhFriction::new(self.slip_limit(), self.velocity)?;
        }
        let wanted = match &self.kind {
            ContactKind::Polynomial(law) => law.directions(),
            ContactKind::User(law) => law.directions(),
            _ => self.places().len(),
        };
        let over_dofs = matches!(self.kind, ContactKind::Polynomial(_) | ContactKind::User(_));
        if self.directions() != wanted || !(self.dofs.is_empty() || over_dofs) {
            return fail!(
                Dimension,
                "contact: {} degrees of freedom for a {kind} of {wanted} motions",
                self.directions()
            );
        }
        self.check_places(kind)
    }

    /// Whether an infinite load makes sense, or no load at all.
    fn may_stick_for_ever(&self) -> bool {
        matches!(self.kind, ContactKind::Jenkins) || self.without_load().is_some()
    }

    /// The normal direction of friction: with a stiffness, or none at all. Without any force, such as
    /// that of no area, it needs none.
    fn check_normal(&self) -> Result<()> {
        let plane = matches!(self.kind, ContactKind::Friction3d);
        let needs_stiffness = matches!(self.kind, ContactKind::Friction2d) || (plane && self.has_normal());
        if needs_stiffness && self.kn == 0.0 && (self.kt != 0.0 || self.preload != 0.0) {
            return fail!(
                Argument,
                "contact: kn = 0, needs a number > 0 for friction under a load that varies"
            );
        }
        if plane && !self.has_normal() && (self.kn != 0.0 || self.gap != 0.0) {
            return fail!(
                Argument,
                "contact: kn = {}, gap = {}, need 0 for friction without a degree of freedom along n",
                self.kn,
                self.gap
            );
        }
        Ok(())
    }

    /// Degrees of freedom along directions in which the law does not act are a mistake.
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
