//! The speed of rotation Ω, fixed or tied to the frequency of the response, and normal loads N₀ + cΩ².

use crate::contact::Contact;
use crate::contact::forms::constants::Constant;

/// Speed of rotation Ω in rad per time unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// Constant speed Ω.
    Fixed(f64),
    /// Ω = pω with the angular frequency ω of the response: p = 1/EO for an excitation of engine order EO.
    PerOmega(f64),
}

impl Speed {
    /// Speed Ω at the angular frequency ω of the response.
    #[must_use]
    pub fn at(self, omega: f64) -> f64 {
        match self {
            Self::Fixed(speed) => speed,
            Self::PerOmega(p) => p * omega,
        }
    }
}

/// A normal load that depends on the speed: N₀ + cΩ².
#[derive(Clone, Copy, Debug)]
pub struct SpeedLoad {
    /// Index of the contact.
    pub contact: usize,
    /// Load N₀ without rotation.
    pub preload: f64,
    /// Gap of the contact as the caller gave it.
    pub gap: f64,
    /// Coefficient c of the load over Ω².
    pub per_speed2: f64,
}

impl SpeedLoad {
    /// The contact under the load at a speed. A negative load opens a gap, or leaves friction under a constant load
    /// without force.
    #[must_use]
    pub fn at(&self, contact: &Contact, speed: f64) -> Contact {
        self.under(contact, self.preload + self.per_speed2 * speed * speed)
    }

    fn under(&self, contact: &Contact, load: f64) -> Contact {
        let kn = contact.constant(Constant::Kn);
        let opening = if load < 0.0 && kn > 0.0 { -load / kn } else { 0.0 };
        contact.under(load.max(0.0), self.gap + opening)
    }

    /// Constant part n₀ of a load n₀ + c Ω², with the effect of the gap.
    pub fn load_at_rest(&self, contact: &Contact) -> f64 {
        self.preload - contact.constant(Constant::Kn) * self.gap
    }

    /// A positive load that represents all speeds Ω = pω: |n₀| + |c|p².
    pub fn reference(&self, contact: &Contact, p: f64) -> f64 {
        self.load_at_rest(contact).abs() + (self.per_speed2 * p * p).abs()
    }

    /// The contact with the given load (either sign), without any other gap.
    pub fn referred(&self, contact: &Contact, load: f64) -> Contact {
        Self { gap: 0.0, ..*self }.under(contact, load)
    }
}
