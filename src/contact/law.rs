//! The vocabulary that every contact law speaks: what a solver asks of a law, and the forms in which
//! a law can answer.
//!
//! A law knows the motion of its relative coordinates and tells its force. How its Fourier
//! coefficients and Jacobian follow is the same for all laws of a [`Form`] and lives in
//! [`crate::aft`], which knows no law by name. All quantities are in the solver's units.

use crate::contact::contact_state::State;
use crate::contact::hysteretic_law::Hysteretic;
use crate::contact::laws::friction_2d::Friction2d;
use crate::contact::memoryless_law::Memoryless;
use crate::fourier::Extremum;
use crate::fourier::HarmonicSet;
use core::fmt::Debug;
use num_complex::Complex64;

/// The law of a contact.
pub trait Law: Debug + Send + Sync {
    /// Relative coordinates on which it acts.
    fn directions(&self) -> usize {
        1
    }

    /// Whether f(−x) = −f(x).
    fn is_odd(&self) -> bool;

    /// How the law is evaluated.
    fn form(&self) -> Form<'_>;

    /// The factor s from which on s·f(x/s) is (nearly) linear, for motions of the given ranges: friction
    /// sticks, a polynomial term is small against the stiffness `reference`.
    fn linearisation_scale(&self, ranges: &[Range], reference: f64) -> f64;

    /// Whether [`Self::linearisation_scale`] is known for any motion; else it is a guess from the size of
    /// the motions that matter.
    fn has_known_linear_range(&self) -> bool {
        true
    }
}

/// Range of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Range {
    /// (max − min)/2
    pub half: f64,
    /// Mean.
    pub mean: f64,
    /// A bound of the velocity.
    pub speed: f64,
}

impl Range {
    /// A bound of the motion's magnitude.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.half + self.mean.abs()
    }
}

/// Share of the reference stiffness below which a nonlinear term counts as small. From here the
/// homotopy may have to pass the resonance, at an amplitude Q times that of the linear structure,
/// where the term is larger by a power of Q; it must not be felt there, up to Q of a million for a
/// cubic one.
pub const SMALL: f64 = 1e-12;

/// The forms in which laws answer.
pub enum Form<'a> {
    /// Intervals on which the force is affine in the one relative motion: exact.
    PiecewiseLinear(&'a dyn PiecewiseLinear),
    /// A spectrum of the stiffness on one relative motion: exact.
    Spectral(&'a dyn Spectral),
    /// Friction in one direction under a normal load that varies: exact.
    Coupled(&'a Friction2d),
    /// Force, states and the derivatives of their steps, marched over equidistant times.
    Hysteretic(&'a dyn Hysteretic),
    /// Force and tangents at equidistant times, without memory.
    Memoryless(&'a dyn Memoryless),
}

/// A law on one relative motion whose force is affine in it between events.
pub trait PiecewiseLinear {
    /// Exact pieces over one turn (half a turn for sets of odd harmonics) from the turning points of the
    /// motion.
    fn pieces(&self, set: &HarmonicSet, motion: &[f64], turning_points: &[Extremum], pieces: &mut Vec<Piece>);

    /// Pieces in sample numbers over one turn from equidistant samples of the motion.
    fn sampled_pieces(&self, samples: &[f64], pieces: &mut Vec<Piece>);

    /// A bound of the number of pieces for motions up to the reduced harmonic `highest`, whose derivative
    /// has at most 2·highest roots per turn.
    fn most_pieces(&self, highest: usize) -> usize {
        4 * highest + 8
    }

    /// What the contact does on a piece of it.
    fn state(&self, piece: &Piece) -> State;

    /// Force and state at the motion x of a law without memory; `None` for one that remembers, whose
    /// force follows from its pieces.
    fn at(&self, x: f64) -> Option<(f64, State)>;
}

/// A law without events on one relative motion: linear·x plus a term that is homogeneous in x, f(s·x) =
/// s^degree·f(x).
pub trait Spectral {
    /// Fills Sₙ = (1/2π)∫ s(x(τ)) e^{−inτ} dτ, n ≥ 0, of the tangent stiffness s of the homogeneous term.
    fn spectrum(&self, set: &HarmonicSet, motion: &[f64], spectrum: &mut [Complex64]);

    /// Stiffness of the linear term.
    fn linear(&self) -> f64;

    /// Degree of the other term.
    fn degree(&self) -> f64;

    /// Force at the motion x.
    fn at(&self, x: f64) -> f64;
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
