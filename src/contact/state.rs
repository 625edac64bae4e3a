//! What a contact does at one time of a motion: whether it sticks, slips or is open, the force of laws
//! without memory, and the normal load.

use super::{Contact, ContactKind, Law, Piece, Role};

/// What a contact does at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It sticks, or presses. Laws without states (cubic springs) and contacts that are linear at any
    /// motion are always here.
    Stick,
    /// It slips: the force is at the slip limit.
    Slip,
    /// It is open: without force.
    Open,
}

impl Law {
    /// Force and state at the motion x of a law without memory; `None` for one that remembers, whose
    /// force follows from its pieces.
    #[must_use]
    pub fn at(&self, x: f64) -> Option<(f64, State)> {
        match self {
            Self::Jenkins(_) => None,
            Self::Cubic(law) => Some((x * (law.linear + law.cubic * x * x), State::Stick)),
            Self::Unilateral(law) => Some(if x < -law.gap {
                (law.stiffness * (x + law.gap), State::Stick)
            } else {
                (0.0, State::Open)
            }),
        }
    }

    /// The state on a piece of the law.
    #[must_use]
    pub fn state(&self, piece: &Piece) -> State {
        match self {
            _ if piece.slope != 0.0 => State::Stick,
            Self::Jenkins(_) => State::Slip,
            Self::Unilateral(_) => State::Open,
            Self::Cubic(_) => State::Stick,
        }
    }
}

impl Contact {
    /// Stiffness of a contact that is linear at any motion; 0 without force.
    #[must_use]
    pub fn stiffness_as_spring(&self) -> f64 {
        if self.role() == Role::Inert { 0.0 } else { self.kt }
    }

    /// Normal load at the relative motion y, side a minus side b; that at rest for a contact whose
    /// load does not change, 0 for one that has none.
    #[must_use]
    pub fn normal_load(&self, y: f64) -> f64 {
        match self.kind {
            ContactKind::Jenkins => self.preload,
            ContactKind::Unilateral if self.role() == Role::Active => (self.kn * (-y - self.clearance())).max(0.0),
            ContactKind::Unilateral | ContactKind::Cubic => 0.0,
        }
    }
}
