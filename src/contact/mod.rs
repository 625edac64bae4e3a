//! Contact laws: what a host says of a contact, and the vocabulary that every law speaks.
//!
//! A law turns a periodic motion into [`Piece`]s, intervals on which its force is affine in the
//! motion. Everything after that (Fourier coefficients, Jacobian) is the same for all laws and
//! lives in [`crate::aft`].

pub mod jenkins;

use crate::error::{Result, fail};
use crate::fourier::Extremum;
use crate::harmonics::HarmonicSet;
use jenkins::Jenkins;

/// Which law a contact obeys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactKind {
    /// Elastic Coulomb friction with constant normal load in one direction.
    Jenkins,
}

/// A contact between two degrees of freedom, or between one and the ground.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// The law.
    pub kind: ContactKind,
    /// Degree of freedom on side a; `None` is the ground.
    pub dof_a: Option<usize>,
    /// Degree of freedom on side b; `None` is the ground.
    pub dof_b: Option<usize>,
    /// Side b lies in sector s + offset (cyclic models).
    pub sector_offset: i64,
    /// Tangential stiffness, force per length, at least 0.
    pub kt: f64,
    /// Friction coefficient, at least 0.
    pub mu: f64,
    /// Normal load, force, at least 0; infinite sticks for ever.
    pub preload: f64,
}

impl Contact {
    /// A Jenkins contact between degree of freedom `a` and `b` (or the ground).
    #[must_use]
    pub fn jenkins(a: usize, b: Option<usize>, kt: f64, mu: f64, preload: f64) -> Self {
        Self {
            kind: ContactKind::Jenkins,
            dof_a: Some(a),
            dof_b: b,
            sector_offset: 0,
            kt,
            mu,
            preload,
        }
    }

    /// Slip limit μN₀; zero without friction, whatever the load.
    #[must_use]
    pub fn slip_limit(&self) -> f64 {
        if self.mu == 0.0 { 0.0 } else { self.mu * self.preload }
    }

    /// Checks the constants of the law.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the constant, its value and its range.
    pub fn check_constants(&self) -> Result<()> {
        for (name, value, may_be_infinite) in [
            ("kt", self.kt, false),
            ("mu", self.mu, false),
            ("preload", self.preload, true),
        ] {
            if value.is_nan() || (value.is_infinite() && !may_be_infinite) {
                return fail!(NotFinite, "contact: {name} = {value}, needs a finite number >= 0");
            }
            if value < 0.0 {
                return fail!(Argument, "contact: {name} = {value}, needs a number >= 0");
            }
        }
        Ok(())
    }
}

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
    /// Where the motion is measured from; `None`: from zero.
    pub anchor: Option<f64>,
    /// Force at the anchor.
    pub offset: f64,
}

/// Law of one scalar relative motion. All quantities are in the solver's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Elastic Coulomb friction.
    Jenkins(Jenkins),
}

impl Law {
    /// The law of a contact, with lengths in units of `length` and forces in units of
    /// `length` times the caller's stiffness.
    #[must_use]
    pub fn new(contact: &Contact, length: f64) -> Self {
        match contact.kind {
            ContactKind::Jenkins => Self::Jenkins(Jenkins {
                stiffness: contact.kt,
                limit: contact.slip_limit() / length,
            }),
        }
    }

    /// Whether f(−x) = −f(x).
    #[must_use]
    pub fn is_odd(&self) -> bool {
        match self {
            Self::Jenkins(_) => true,
        }
    }

    /// The same law with its slip limit multiplied by `factor`, the homotopy from stuck (large
    /// factor) to the law as given (1).
    #[must_use]
    pub fn eased(&self, factor: f64) -> Self {
        match *self {
            Self::Jenkins(law) => Self::Jenkins(Jenkins {
                limit: law.limit * factor,
                ..law
            }),
        }
    }

    /// The factor at which a motion of the given half range just sticks.
    #[must_use]
    pub fn sticking_factor(&self, half_range: f64) -> f64 {
        match self {
            Self::Jenkins(law) => law.stiffness * half_range / law.limit,
        }
    }

    /// Exact pieces over one turn (half a turn for sets of odd harmonics) from the reversals of
    /// the motion.
    pub fn pieces(&self, set: &HarmonicSet, motion: &[f64], reversals: &[Extremum], pieces: &mut Vec<Piece>) {
        pieces.clear();
        match self {
            Self::Jenkins(law) => law.pieces(set, motion, reversals, pieces),
        }
    }

    /// Pieces in sample numbers over one turn from equidistant samples of the motion.
    pub fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>) {
        pieces.clear();
        match self {
            Self::Jenkins(law) => law.sampled_pieces(samples, pieces),
        }
    }
}
