//! The four-parameter Iwan model of a bolted joint (Segalman 2005, doi:10.1115/1.1989354): infinitely many
//! Jenkins elements in parallel, of which ρ(φ) dφ of stiffness slip at the displacement φ,
//!
//! > ρ(φ) = R φ^χ for 0 < φ < φ_max, and a stiffness S that slips at φ_max.
//!
//! Loss per cycle then grows with the power 3 + χ of the amplitude, until the joint slips as a whole.
//! For the solver it is a finite number of Jenkins contacts: each takes stiffness and slip force of an
//! interval of φ, so that the stiffness at rest and the force of the joint in full slip are exact.

use crate::contact::Contact;
use crate::error::{Result, fail, try_push};

/// Parameters of the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iwan {
    /// Force at which the whole joint slips, > 0.
    pub slip_force: f64,
    /// Tangent stiffness at rest, > 0.
    pub stiffness: f64,
    /// Power of the loss beyond 3, −1 < χ ≤ 0.
    pub chi: f64,
    /// Stiffness that slips at φ_max over the rest of it, ≥ 0.
    pub beta: f64,
}

/// Elements that one joint may have.
/// Kind: cap.
pub const MAX_ELEMENTS: usize = 10_000;

/// Smallest interval of φ over φ_max: below that displacement nothing slips.
/// Kind: rounding.
const IWAN_SMALLEST: f64 = 1e-5;

impl Iwan {
    /// Checks the parameters.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the parameter, its value and its range.
    pub fn check(&self) -> Result<()> {
        for (name, value) in [
            ("slip_force", self.slip_force),
            ("stiffness", self.stiffness),
            ("chi", self.chi),
            ("beta", self.beta),
        ] {
            if !value.is_finite() {
                return fail!(NotFinite, "Iwan joint: {name} = {value}, needs a finite number");
            }
        }
        for (name, value) in [("slip_force", self.slip_force), ("stiffness", self.stiffness)] {
            if value <= 0.0 {
                return fail!(Argument, "Iwan joint: {name} = {value}, needs a number > 0");
            }
        }
        if !(self.chi > -1.0 && self.chi <= 0.0) {
            return fail!(Argument, "Iwan joint: chi = {}, needs -1 < chi <= 0", self.chi);
        }
        if self.beta < 0.0 {
            return fail!(Argument, "Iwan joint: beta = {}, needs a number >= 0", self.beta);
        }
        Ok(())
    }

    /// φ_max, the displacement at which the whole joint slips.
    #[must_use]
    pub fn largest_displacement(&self) -> f64 {
        let share = (self.chi + 1.0) / (self.chi + 2.0);
        self.slip_force * (1.0 + self.beta) / (self.stiffness * (self.beta + share))
    }

    /// Loss per cycle of amplitude `a` ≤ φ_max: 4R a^{3+χ}/((2 + χ)(3 + χ)).
    #[must_use]
    pub fn loss(&self, a: f64) -> f64 {
        4.0 * self.density() * a.powf(3.0 + self.chi) / ((2.0 + self.chi) * (3.0 + self.chi))
    }

    /// R
    fn density(&self) -> f64 {
        let power = self.chi + 1.0;
        self.stiffness * power / ((1.0 + self.beta) * self.largest_displacement().powf(power))
    }

    /// The joint as `n` Jenkins contacts between the sides of `between`, the weakest first. The
    /// intervals of φ grow geometrically over five decades up to φ_max.
    ///
    /// # Errors
    /// Those of [`Self::check`]; `Argument` for n out of 2 .. 10,000; `OutOfMemory`.
    pub fn elements(&self, between: &Contact, n: usize) -> Result<Vec<Contact>> {
        self.check()?;
        if !(2..=MAX_ELEMENTS).contains(&n) {
            return fail!(Argument, "Iwan joint: elements = {n}, needs 2 .. {MAX_ELEMENTS}");
        }
        let last = usize::from(self.beta > 0.0);
        let intervals = n - last;
        let largest = self.largest_displacement();
        let bound = |i: usize| match i {
            0 => 0.0,
            i => largest * IWAN_SMALLEST.powf((intervals - i) as f64 / intervals as f64),
        };
        let (r, p) = (self.density(), self.chi + 1.0);
        let mut contacts = Vec::new();
        for i in 0..n {
            let (kt, slip) = if i < intervals {
                let (a, b) = (bound(i), bound(i + 1));
                let part = |power: f64| r * (b.powf(power) - a.powf(power)) / power;
                (part(p), part(p + 1.0))
            } else {
                let kt = self.beta * self.stiffness / (1.0 + self.beta);
                (kt, kt * largest)
            };
            let contact = Contact {
                dof_a: between.dof_a,
                dof_b: between.dof_b,
                frame: between.frame,
                rigid: between.rigid,
                sector_offset: between.sector_offset,
                ..Contact::jenkins(0, None, kt, 1.0, slip)
            };
            try_push(&mut contacts, contact, "the contacts")?;
        }
        Ok(contacts)
    }
}
