//! Pieces: intervals of the period on which a contact force is affine in the relative motions.

use crate::contact::forms::contact_state::State;

/// An interval on which the force is f(τ) = slope·(x(τ) − x(anchor)) + offset.
///
/// With exact events `start`, `end` and `anchor` are times in τ; with sampling they are sample
/// numbers, and the piece holds the samples start ≤ j < end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Begin of the interval.
    pub start: f64,
    /// End of the interval.
    pub end: f64,
    /// Tangent stiffness.
    pub slope: f64,
    /// Time from whose motion the force is measured; `None`: from zero motion.
    pub anchor: Option<f64>,
    /// Force at the anchor.
    pub offset: f64,
}

impl Piece {
    /// Whether a normal force is closed on this piece of it.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.slope != 0.0 || self.offset != 0.0
    }
}

/// An interval on which the tangential force under a varying normal load is
/// f(τ) = of_x·x(τ) + of_y·y(τ) + at_x·x(r) + at_y·y(r) + constant, with the anchor r.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledPiece {
    /// Begin of the interval.
    pub start: f64,
    /// End of the interval.
    pub end: f64,
    /// Tangent stiffness in the tangential motion.
    pub of_x: f64,
    /// Tangent stiffness in the normal motion.
    pub of_y: f64,
    /// The time r that the force remembers; `None`: at_x, at_y and moved_y are 0.
    pub anchor: Option<f64>,
    /// Factor of x(r).
    pub at_x: f64,
    /// Factor of y(r).
    pub at_y: f64,
    /// The constant part.
    pub constant: f64,
    /// Derivative of the force by y(r) beyond at_y. Where r is the time of closing, N(r) = 0, the
    /// normal motion moves it: dr = −dy(r)/y′(r), and −kt·x(r) changes by kt·x′(r)/y′(r)·dy(r). At other
    /// anchors, which are extrema of the remembered signal, this is 0.
    pub moved_y: f64,
    /// State of the contact.
    pub state: State,
}

impl CoupledPiece {
    /// A piece without force, of no length.
    pub const OPEN: Self = Self {
        start: 0.0,
        end: 0.0,
        of_x: 0.0,
        of_y: 0.0,
        anchor: None,
        at_x: 0.0,
        at_y: 0.0,
        constant: 0.0,
        moved_y: 0.0,
        state: State::Open,
    };
}
