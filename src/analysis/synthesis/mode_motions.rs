//! Motions of a mode at its resonances under a force, and the extrema of the force along the mode.

use crate::analysis::synthesis::oscillator::State;
use crate::analysis::synthesis::resonance::Refinement;
use crate::error::{Result, try_push};
use num_complex::Complex64;

/// An extremum of the force along a mode: there the resonances of a detached curve meet, or those of two curves.
#[derive(Clone, Copy, Debug)]
pub struct ForceExtremum {
    pub log10_amplitude: f64,
    /// Factor of all forces at the extremum.
    pub factor: f64,
    pub is_maximum: bool,
}

/// The motion of a mode at a synthesised resonance, with the phase of the response.
pub struct ModeMotion {
    /// Angular frequency of the force.
    pub omega: f64,
    pub log10_amplitude: f64,
    /// Harmonics of all degrees of freedom: complex, (H + 1) × ndof, harmonic after harmonic.
    pub harmonics: Vec<Complex64>,
}

/// The motions at the resonances, and the extrema of the force along the mode.
#[derive(Default)]
pub struct Motions {
    pub resonances: Vec<ModeMotion>,
    pub extrema: Vec<ForceExtremum>,
}

impl Motions {
    /// Appends the motion of the state that was solved last, at a resonance.
    pub(super) fn push(&mut self, refinement: &Refinement<'_>, state: &State, omega: f64) -> Result<()> {
        let motion = ModeMotion {
            omega,
            log10_amplitude: state.log10,
            harmonics: refinement.harmonics(state, state.turn(omega))?,
        };
        try_push(&mut self.resonances, motion, "the motions of a mode")
    }
}
