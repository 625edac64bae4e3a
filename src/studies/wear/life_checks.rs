//! Checks of the options of a life for a model.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, fail, try_copy};
use crate::model::Model;
use crate::options::{LifeFollow, LifeOptions, MOST_WORN};

/// Difference of an entry of the static stiffness from its mirrored one, relative to the largest entry.
/// Kind: rounding; of condensed stiffnesses.
const LIFE_SYMMETRY: f64 = 1e-6;

/// Pivot over its diagonal entry that is taken for zero.
/// Kind: rounding; some hundred contacts lose six digits.
const LIFE_SEMIDEFINITE: f64 = 1e-9;

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
        if !(1e-12..=0.1).contains(&self.tolerance) {
            return fail!(Argument, "tolerance = {:?}, needs 1e-12 .. 0.1", self.tolerance);
        }
        if !(self.limit.is_finite() && self.limit >= 0.0) {
            return fail!(
                Argument,
                "limit = {:?}, needs a finite amplitude > 0, or 0 for none",
                self.limit
            );
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
                if model.contacts()[wear.contact].constant(Constant::Kn) <= 0.0 {
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
        let most = self.stiffness.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
        for j in 0..n {
            for i in 0..j {
                let (s, mirrored) = (self.stiffness[j * n + i], self.stiffness[i * n + j]);
                if (s - mirrored).abs() > LIFE_SYMMETRY * most {
                    return fail!(
                        Argument,
                        "stiffness[{i},{j}] = {s:?}, but stiffness[{j},{i}] = {mirrored:?}: a static stiffness is symmetric"
                    );
                }
            }
        }
        if let Some((j, pivot)) = negative_pivot(self.stiffness, n)? {
            return fail!(
                Argument,
                "stiffness is not positive semidefinite: pivot {j}, contact {}, is {pivot:.3e}; loads would grow by wear",
                self.wear[j].contact
            );
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

/// The first pivot, with its value, of a symmetric matrix (without exchange) that is negative beyond rounding; a zero
/// pivot with a nonzero row counts as negative. `None` where the matrix is positive semidefinite.
fn negative_pivot(matrix: &[f64], n: usize) -> Result<Option<(usize, f64)>> {
    let mut a = try_copy(matrix, "the static stiffness of a life")?;
    for j in 0..n {
        let (pivot, own) = (a[j * n + j], matrix[j * n + j]);
        let rounding = LIFE_SEMIDEFINITE * own.abs();
        if pivot < -rounding || own < 0.0 {
            return Ok(Some((j, pivot)));
        }
        let (left, right) = a.split_at_mut((j + 1) * n);
        let column = &left[j * n..];
        if pivot <= rounding {
            // In a semidefinite matrix what is left of such a row is rounding, too: |a_ij|² <= a_ii a_jj.
            for i in j + 1..n {
                let bound = LIFE_SEMIDEFINITE.sqrt() * (own * matrix[i * n + i].abs()).sqrt();
                if column[i].abs() > bound {
                    return Ok(Some((j, pivot)));
                }
            }
            continue;
        }
        for (k, other) in right.chunks_exact_mut(n).enumerate() {
            let factor = column[j + 1 + k] / pivot;
            for (x, l) in other[j + 1..].iter_mut().zip(&column[j + 1..]) {
                *x -= factor * l;
            }
        }
    }
    Ok(None)
}
