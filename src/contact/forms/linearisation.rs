//! Ranges of motions, and the size below which the nonlinear part of a law is negligible.

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

/// Share of the reference stiffness below which a nonlinear term counts as small. A homotopy that starts
/// from such a term may have to pass the resonance, at an amplitude Q times that of the linear structure,
/// where the term is larger by a power of Q; the term must stay negligible there, up to Q of a million for a
/// cubic one.
/// Kind: rounding.
pub const LINEARISATION_SMALL: f64 = 1e-12;
