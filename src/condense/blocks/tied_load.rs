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

/// A load that depends on the frequency.
#[derive(Clone, Debug)]
pub struct TiedLoad {
    /// N₀ with the gap counted in.
    constant: f64,
    /// c p²
    per_omega2: f64,
    /// N_r
    reference: f64,
    /// The law of the load −N_r, where a load may be negative.
    open: Option<Arc<dyn Law>>,
    /// Whether the motion scales with the load, too.
    scales_motion: bool,
    contact: Contact,
    description: SpeedLoad,
    p: f64,
}

/// A law with the factor of its load.
#[derive(Clone, Copy)]
pub struct LoadedLaw<'a> {
    /// f_r
    pub law: &'a dyn Law,
    /// r
    pub factor: f64,
    /// dr/dω
    pub slope: f64,
    /// Factor of the motion where that scales with the load: r.
    pub of_motion: Option<f64>,
    /// Whether the law is evaluated as it is.
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
