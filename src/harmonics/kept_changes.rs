//! Changes that extensions made at one point, as guesses for those of the next points along the branch.
//!
//! The change Z* − W of a motion by more harmonics varies slowly from point to point, but for the phase and the size of
//! the motion: with c = Σ conj(W₁) W₁′/Σ|W₁|² over the lowest harmonics of two points, harmonic h of the change is
//! multiplied by |c| e^{ih arg c}. A guess that errs costs steps of Newton's method, and no accuracy.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::estimate::CONTEXT;
use num_complex::Complex64;

/// Ratios of the sizes of two motions within which one serves for the other.
/// Kind: tuned; measured on: not recorded.
const KEPT_CHANGES_ALIKE: (f64, f64) = (0.5, 2.0);

/// Most changes that are kept.
/// Kind: tuned; measured on: not recorded.
const KEPT_CHANGES_MOST: usize = 6;

/// Kind of an extension: highest harmonic of the point, and slot of the extended model.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Extension {
    pub highest: usize,
    pub slot: usize,
}

/// Changes of the motion by extensions, the latest of each kind.
#[derive(Default)]
pub(super) struct KeptChanges {
    changes: Vec<Change>,
}

struct Change {
    extension: Extension,
    /// Lowest harmonic of each coordinate before the extension.
    lowest: Vec<Complex64>,
    /// Packed change of the motion in the extended harmonics, in the unit of the extended model.
    moved: Vec<f64>,
}

impl KeptChanges {
    /// A packed motion plus the guess for its change; `None` where no change is known.
    pub fn guess(&self, extension: Extension, set: &HarmonicSet, motion: &[f64]) -> Result<Option<Vec<f64>>> {
        let Some(known) = self.changes.iter().find(|known| known.extension == extension) else {
            return Ok(None);
        };
        let Some(lowest) = lowest(set) else { return Ok(None) };
        let m = set.packed_len();
        let mut product = Complex64::ZERO;
        let mut square = 0.0;
        for (before, y) in known.lowest.iter().zip(motion.chunks_exact(m)) {
            product += before.conj() * set.get(y, lowest);
            square += before.norm_sqr();
        }
        let turn = product / square;
        let size = turn.norm();
        if !(KEPT_CHANGES_ALIKE.0..=KEPT_CHANGES_ALIKE.1).contains(&size) {
            return Ok(None);
        }
        let mut guess = try_copy(motion, CONTEXT)?;
        let angle = turn.arg() / set.numbers()[lowest] as f64;
        for (i, &h) in set.numbers().iter().enumerate() {
            let factor = Complex64::from_polar(size, h as f64 * angle);
            for (y, change) in guess.chunks_exact_mut(m).zip(known.moved.chunks_exact(m)) {
                let moved = set.get(y, i) + factor * set.get(change, i);
                set.set(y, i, moved);
            }
        }
        Ok(Some(guess))
    }

    /// Keeps the change between two packed motions.
    pub fn keep(&mut self, extension: Extension, set: &HarmonicSet, (from, to): (&[f64], &[f64])) -> Result<()> {
        let Some(lowest) = lowest(set) else { return Ok(()) };
        let mut known = match self.changes.iter().position(|known| known.extension == extension) {
            Some(at) => self.changes.remove(at),
            None => Change {
                extension,
                lowest: try_vec(from.len() / set.packed_len().max(1), Complex64::ZERO, CONTEXT)?,
                moved: try_copy(from, CONTEXT)?,
            },
        };
        for (kept, y) in known.lowest.iter_mut().zip(from.chunks_exact(set.packed_len())) {
            *kept = set.get(y, lowest);
        }
        for ((kept, to), from) in known.moved.iter_mut().zip(to).zip(from) {
            *kept = to - from;
        }
        if self.changes.len() == KEPT_CHANGES_MOST {
            self.changes.remove(0);
        }
        try_push(&mut self.changes, known, CONTEXT)
    }
}

/// The lowest carried harmonic above zero.
fn lowest(set: &HarmonicSet) -> Option<usize> {
    set.numbers().iter().position(|&h| h > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_later_and_larger_is_guessed_exactly() {
        // Two coordinates with harmonics 0 to 3; the second motion is the first one 1.3 times as large and later by a phase.
        let set = HarmonicSet::all(3).unwrap();
        let m = set.packed_len();
        let signal = |size: f64, phase: f64, highest: usize| {
            let mut packed = vec![0.0; 2 * m];
            for (c, y) in packed.chunks_exact_mut(m).enumerate() {
                for i in 0..=highest {
                    let z = Complex64::new(1.0 + c as f64, 0.3 * i as f64) * size * Complex64::cis(i as f64 * phase);
                    set.set(y, i, z);
                }
            }
            packed
        };
        let extension = Extension { highest: 1, slot: 4 };
        let mut kept = KeptChanges::default();
        kept.keep(extension, &set, (&signal(1.0, 0.0, 1), &signal(1.0, 0.0, 3)))
            .unwrap();
        let guess = |extension, motion: &[f64]| kept.guess(extension, &set, motion).unwrap();
        let point = signal(1.3, 0.4, 1);
        for (guess, exact) in guess(extension, &point).unwrap().iter().zip(signal(1.3, 0.4, 3)) {
            assert!((guess - exact).abs() < 1e-14);
        }
        let other = Extension { highest: 1, slot: 5 };
        assert!(guess(other, &point).is_none());
        assert!(guess(extension, &signal(5.0, 0.0, 1)).is_none());
    }
}
