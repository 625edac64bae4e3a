//! Checks of the options of a life for a model.

use crate::error::{Result, fail};
use crate::model::Model;
use crate::options::{LifeFollow, LifeOptions, MOST_WORN};

impl LifeOptions<'_> {
    /// Checks the options for a model.
    ///
    /// # Errors
    /// `Argument`, `Index`, `Dimension` or `NotFinite`, naming the field, its value and its range.
    pub fn check(&self, model: &Model) -> Result<()> {
        self.check_contacts(model)?;
        self.check_stiffness(model)?;
        let n = self.wear.len();
        if !self.worn.is_empty() && self.worn.len() != n {
            return fail!(Dimension, "{} worn depths of {n} contacts", self.worn.len());
        }
        if let Some(i) = self.worn.iter().position(|h| !(h.is_finite() && *h >= 0.0)) {
            return fail!(Argument, "worn[{i}] = {}, needs a finite number >= 0", self.worn[i]);
        }
        if self.cycles.is_empty() {
            return fail!(Dimension, "no cycles, needs at least the end of the life");
        }
        let mut last = 0.0;
        for (i, &n) in self.cycles.iter().enumerate() {
            if !(n.is_finite() && n >= last) {
                return fail!(
                    Argument,
                    "cycles[{i}] = {n}, needs a finite number >= {last}, in ascending order"
                );
            }
            last = n;
        }
        for (name, value, low, high) in [
            ("tolerance", self.tolerance, 1e-12, 0.1),
            ("limit", self.limit, 0.0, f64::MAX),
        ] {
            if !(value >= low && value <= high) {
                return fail!(Argument, "{name} = {value}, needs {low} .. {high}");
            }
        }
        if self.most_steps == 0 {
            return fail!(Argument, "most_steps = 0, needs at least 1");
        }
        self.check_follow()
    }

    fn check_contacts(&self, model: &Model) -> Result<()> {
        let count = model.contacts().len();
        if self.wear.is_empty() || self.wear.len() > MOST_WORN {
            return fail!(Dimension, "{} contacts wear, needs 1 .. {MOST_WORN}", self.wear.len());
        }
        for (i, wear) in self.wear.iter().enumerate() {
            let Some(contact) = model.contacts().get(wear.contact) else {
                return fail!(Index, "wear[{i}]: contact = {}, needs 0 .. {count}", wear.contact);
            };
            if let Some(kind) = contact.without_load() {
                return fail!(
                    Unsupported,
                    "wear[{i}]: contact {} is a {kind}, which has no normal load",
                    wear.contact
                );
            }
            if !contact.load().is_finite() {
                return fail!(
                    Argument,
                    "wear[{i}]: the load of contact {} is {}, needs a finite number",
                    wear.contact,
                    contact.load()
                );
            }
            if self.wear[..i].iter().any(|other| other.contact == wear.contact) {
                return fail!(Argument, "wear[{i}]: contact {} is given twice", wear.contact);
            }
            for (name, value, zero) in [("rate", wear.rate, true), ("area", wear.area, false)] {
                if !(value.is_finite() && (value > 0.0 || (zero && value == 0.0))) {
                    let least = if zero { ">= 0" } else { "> 0" };
                    return fail!(Argument, "wear[{i}]: {name} = {value}, needs a finite number {least}");
                }
            }
        }
        Ok(())
    }

    fn check_stiffness(&self, model: &Model) -> Result<()> {
        let n = self.wear.len();
        if self.stiffness.is_empty() {
            for (i, wear) in self.wear.iter().enumerate() {
                if model.contacts()[wear.contact].kn <= 0.0 {
                    return fail!(
                        Argument,
                        "wear[{i}]: contact {} has no normal stiffness of its own; needs `stiffness`",
                        wear.contact
                    );
                }
            }
            return Ok(());
        }
        if self.stiffness.len() != n * n {
            return fail!(
                Dimension,
                "stiffness has {} numbers, needs {n} x {n} for the contacts that wear",
                self.stiffness.len()
            );
        }
        if let Some(i) = self.stiffness.iter().position(|s| !s.is_finite()) {
            return fail!(
                NotFinite,
                "stiffness[{i}] = {}, needs a finite number",
                self.stiffness[i]
            );
        }
        for j in 0..n {
            if self.stiffness[j * n + j] < 0.0 {
                return fail!(
                    Argument,
                    "stiffness of contact {} is {}, needs a number >= 0",
                    self.wear[j].contact,
                    self.stiffness[j * n + j]
                );
            }
        }
        Ok(())
    }

    fn check_follow(&self) -> Result<()> {
        let duties = match self.follow {
            LifeFollow::Peak {
                omega_start,
                omega_stop,
            } => {
                for (name, value) in [("omega_start", omega_start), ("omega_stop", omega_stop)] {
                    if !(value.is_finite() && value > 0.0) {
                        return fail!(Argument, "{name} = {value}, needs an angular frequency > 0");
                    }
                }
                return Ok(());
            }
            LifeFollow::Duties(duties) => duties,
        };
        if duties.is_empty() {
            return fail!(Dimension, "no duties, needs at least one frequency");
        }
        for (i, duty) in duties.iter().enumerate() {
            for (name, value, zero) in [
                ("omega", duty.omega, false),
                ("force", duty.force, true),
                ("share", duty.share, true),
            ] {
                if !(value.is_finite() && (value > 0.0 || (zero && value == 0.0))) {
                    let least = if zero { ">= 0" } else { "> 0" };
                    return fail!(Argument, "duty {i}: {name} = {value}, needs a finite number {least}");
                }
            }
        }
        if duties.iter().all(|duty| duty.share == 0.0) {
            return fail!(Argument, "all shares of the duties are 0, needs one > 0");
        }
        Ok(())
    }
}
