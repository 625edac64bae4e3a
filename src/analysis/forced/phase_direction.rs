//! The direction in which the phase of a motion changes.
//!
//! At a resonance it is the direction of the branch, whichever way this bends: across it solutions exist where none has the frequency,
//! or the amplitude, of a motion nearby.

use crate::error::{Result, try_vec};
use crate::fourier::HarmonicSet;
use num_complex::Complex64;

/// Derivative i h X_h of a packed motion by its phase, followed by a zero for the frequency.
pub(crate) fn phase_direction(set: &HarmonicSet, motion: &[f64]) -> Result<Vec<f64>> {
    let mut direction = try_vec(motion.len() + 1, 0.0, "the direction of the phase")?;
    let packed = set.packed_len().max(1);
    for (to, from) in direction.chunks_exact_mut(packed).zip(motion.chunks_exact(packed)) {
        for (i, &h) in set.numbers().iter().enumerate().filter(|(_, h)| **h > 0) {
            set.set(to, i, set.get(from, i) * Complex64::new(0.0, h as f64));
        }
    }
    Ok(direction)
}
