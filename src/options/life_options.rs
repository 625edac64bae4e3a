//! Options of a life with wear.

use crate::error::{Result, fail};
use crate::model::Model;

/// A contact that wears: its worn depth grows per cycle by h′ = αE/A with the work E of a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Wear {
    /// Number of the contact, whose law has a normal load.
    pub contact: usize,
    /// α: worn volume per work.
    pub rate: f64,
    /// A: area of the contact.
    pub area: f64,
}

/// A steady state in which a machine spends a share of its time.
#[derive(Clone, Copy, Debug)]
pub struct Duty {
    /// Angular frequency of the forces, rad per time unit.
    pub omega: f64,
    /// Factor on the forces.
    pub force: f64,
    /// Share of the time; shares are relative to their sum.
    pub share: f64,
}

/// State of vibration that wears the contacts.
#[derive(Clone, Copy, Debug)]
pub enum LifeFollow<'a> {
    /// Steady states of given frequencies and forces, one after the other so often that wear between them is small.
    Duties(&'a [Duty]),
    /// The peak of the response, the highest one within the range of angular frequency at the beginning; it is followed as the contacts
    /// wear.
    Peak {
        /// First angular frequency.
        omega_start: f64,
        /// Last angular frequency.
        omega_stop: f64,
    },
}

/// Options of a life.
#[derive(Clone, Copy, Debug)]
pub struct LifeOptions<'a> {
    /// Contacts that wear.
    pub wear: &'a [Wear],
    /// Static stiffness S between the normals of these contacts, n × n, symmetric: their loads are N = N₀ − S h. Empty: the normal
    /// stiffness of each contact by itself, which its law then has.
    pub stiffness: &'a [f64],
    /// Vibration.
    pub follow: LifeFollow<'a>,
    /// Cycles at which the state is wanted, in ascending order; the last is the end of the life.
    pub cycles: &'a [f64],
    /// Depths worn at the beginning; empty: none.
    pub worn: &'a [f64],
    /// Error that is allowed, of the loads relative to the largest load of a contact at the beginning, and of the amplitude.
    pub tolerance: f64,
    /// Amplitude whose crossing is told; 0: none.
    pub limit: f64,
    /// Largest number of steps.
    pub most_steps: usize,
}

/// Default tolerance of a life.
pub const LIFE_TOLERANCE: f64 = 1e-4;

/// Default of the largest number of steps of a life.
pub const LIFE_MOST_STEPS: usize = 10_000;

/// Largest number of contacts that wear: the integrator factorises matrices of that order.
pub const MOST_WORN: usize = 2_000;

impl Default for LifeOptions<'_> {
    fn default() -> Self {
        Self {
            wear: &[],
            stiffness: &[],
            follow: LifeFollow::Duties(&[]),
            cycles: &[],
            worn: &[],
            tolerance: LIFE_TOLERANCE,
            limit: 0.0,
            most_steps: LIFE_MOST_STEPS,
        }
    }
}

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
