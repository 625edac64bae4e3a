//! What a contact does at one time of a motion: whether it sticks, slips or is open, the force of laws
//! without memory, and the normal load.

use crate::contact::{Contact, ContactKind, Role};

/// What a contact does at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It sticks, or presses. Laws without states (springs but the unilateral one, regularised friction,
    /// laws of the caller) and contacts that are linear at any motion are always here.
    Stick,
    /// It slips: the force is at the slip limit.
    Slip,
    /// It is open: without force.
    Open,
}

impl Contact {
    /// Stiffness of a contact that is linear at any motion; 0 without force.
    #[must_use]
    pub fn stiffness_as_spring(&self) -> f64 {
        if self.role() == Role::Inert { 0.0 } else { self.kt }
    }

    /// Place among the motions of the one along the normal, for contacts whose load varies with it.
    #[must_use]
    pub fn normal_direction(&self) -> Option<usize> {
        self.places().iter().position(|place| *place == 2)
    }

    /// Normal load at the relative motion y along the normal, side a minus side b; that at rest for a
    /// contact whose load does not change, 0 for one that has none.
    #[must_use]
    pub fn normal_load(&self, y: f64) -> f64 {
        match &self.kind {
            ContactKind::Jenkins | ContactKind::Regularised => self.preload,
            ContactKind::Friction3d if self.normal_direction().is_none() => self.preload,
            ContactKind::Friction2d | ContactKind::Friction3d => (self.load() - self.kn * y).max(0.0),
            ContactKind::Unilateral if self.role() == Role::Active => (self.kn * (-y - self.clearance())).max(0.0),
            _ => 0.0,
        }
    }
}
