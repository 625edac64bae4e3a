//! Size of motions to which a residual is compared.
//!
//! It is that of the vibration. A mean motion, which may be far larger, counts by a small share, because its rounding limits
//! the residual: a body that nothing but friction holds may be turned by the mean of the friction forces, and at a distance of
//! thousands of vibrations a residual relative to that distance would hide forces in no balance.

use crate::fourier::HarmonicSet;

/// Share of a mean motion.
/// Kind: tuned; measured on: not recorded.
pub(super) const MEAN_SHARE: f64 = 1e-4;

/// Sums of squares of a motion: of its vibration, and of its mean.
#[derive(Clone, Copy, Default)]
pub(super) struct Squares {
    pub vibration: f64,
    pub mean: f64,
}

impl Squares {
    /// Sums of squares of packed motions.
    pub fn of(set: &HarmonicSet, packed: &[f64]) -> Self {
        let means = usize::from(set.has_mean());
        let squares = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>();
        let mut found = Self::default();
        for signal in packed.chunks_exact(set.packed_len().max(1)) {
            let (mean, vibration) = signal.split_at(means);
            found.mean += squares(mean);
            found.vibration += squares(vibration);
        }
        found
    }

    /// Size of two motions together, by their vibration; by their means where nothing vibrates.
    pub fn size(self, other: Self) -> f64 {
        let vibration = self.vibration.sqrt() + other.vibration.sqrt();
        let mean = self.mean.sqrt() + other.mean.sqrt();
        if vibration == 0.0 {
            mean
        } else {
            vibration + MEAN_SHARE * mean
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_counts_by_a_share_beside_a_vibration() {
        let set = HarmonicSet::all(1).unwrap();
        let size = |packed: &[f64]| Squares::of(&set, packed).size(Squares::default());
        for (packed, expected) in [
            (&[1e4, 3.0, 4.0][..], 6.0),
            (&[2.0, 0.0, 0.0], 2.0),
            (&[0.0, 0.0, 0.0, 0.0, 3.0, 4.0], 5.0),
        ] {
            assert!((size(packed) - expected).abs() < 1e-14, "{packed:?}");
        }
        assert!(size(&[f64::NAN, 1.0, 1.0]).is_nan());
    }
}
