//! A normal load that follows the frequency of the response, N₀ + c (pω)².
//!
//! Friction and stops are homogeneous of degree 1 in motions and load: with the law f_r of a reference load N_r,
//!
//! > f(y; N) = r f_r(y/r),  r = |N|/N_r,  ∂f/∂r = f_r(Y) − ∂f_r/∂Y · Y,  Y = y/r,
//!
//! so that no law is made anew at a frequency. A load below zero is that of a contact with a gap at rest, which is
//! another law. Where the force alone is proportional to the load, f(y; N) = r f_r(y).

use crate::contact::{Contact, Law};
use crate::error::{Result, fail};
use crate::model::Model;
use crate::model::matrices::speed::{Speed, SpeedLoad};
use std::sync::Arc;

/// Smallest r: the motion over it stays finite.
/// Kind: rounding.
const TIED_LOAD_LEAST: f64 = 1e-100;

/// A normal load that depends on the frequency of the response.
#[derive(Clone, Debug)]
pub struct TiedLoad {
    /// Constant part N₀ of the load, the effect of a gap included.
    constant: f64,
    /// c p², the part of the load that grows with ω², over ω².
    per_omega2: f64,
    /// Reference load N_r, for which the law was made.
    reference: f64,
    /// The law of the load −N_r, where a load may be negative.
    open: Option<Arc<dyn Law>>,
    /// Whether the law sees the motion divided by r, too.
    scales_motion: bool,
    contact: Contact,
    description: SpeedLoad,
    p: f64,
}

/// A law together with the factor r of its load at a frequency.
#[derive(Clone, Copy)]
pub struct LoadedLaw<'a> {
    /// The law f_r of the reference load.
    pub law: &'a dyn Law,
    /// Factor r of the load over the reference load.
    pub factor: f64,
    /// dr/dω, change of the factor r by the angular frequency.
    pub slope: f64,
    /// Factor r of the motion where it scales with the load, else `None`.
    pub of_motion: Option<f64>,
    /// Whether the law is evaluated without scaling.
    pub is_plain: bool,
}

impl<'a> LoadedLaw<'a> {
    /// A law whose load does not depend on the frequency.
    pub fn plain(law: &'a dyn Law) -> Self {
        Self {
            law,
            factor: 1.0,
            slope: 0.0,
            of_motion: None,
            is_plain: true,
        }
    }
}

impl TiedLoad {
    /// The load of a contact of a model; `None` where it does not depend on the frequency.
    pub(crate) fn of(model: &Model, contact: usize, length: f64) -> Result<Option<Self>> {
        let Speed::PerOmega(p) = model.speed() else {
            return Ok(None);
        };
        let Some(load) = model.speed_loads().iter().find(|load| load.contact == contact) else {
            return Ok(None);
        };
        let number = contact;
        let contact = &model.contacts()[contact];
        if contact.is_placed() {
            return fail!(
                Unsupported,
                "contact {number}: the place of its slider is given, but its normal load follows the frequency; set a fixed speed"
            );
        }
        let reference = load.reference(contact, p);
        let constant = load.load_at_rest(contact);
        if p == 0.0 || reference == 0.0 {
            return Ok(None);
        }
        let open = if constant < 0.0 {
            Some(load.referred(contact, -reference).law(length)?)
        } else {
            None
        };
        Ok(Some(Self {
            constant,
            per_omega2: load.per_speed2 * p * p,
            reference,
            open,
            scales_motion: contact.load_scales_motion(),
            contact: contact.clone(),
            description: *load,
            p,
        }))
    }

    pub(crate) fn at<'a>(&'a self, law: &'a dyn Law, omega: f64) -> LoadedLaw<'a> {
        let load = self.constant + self.per_omega2 * omega * omega;
        let slope = 2.0 * self.per_omega2 * omega / self.reference;
        let factor = (load.abs() / self.reference).max(TIED_LOAD_LEAST);
        let (law, slope) = match &self.open {
            Some(open) if load < 0.0 => (&**open, -slope),
            _ => (law, slope),
        };
        LoadedLaw {
            law,
            factor,
            slope,
            of_motion: self.scales_motion.then_some(factor),
            is_plain: false,
        }
    }

    /// The contact under its load at an angular frequency.
    pub fn contact_at(&self, omega: f64) -> Contact {
        self.description.at(&self.contact, self.p * omega)
    }
}
