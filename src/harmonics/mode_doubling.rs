//! Frequency and damping ratio of a point of a nonlinear mode as its harmonics are doubled; see
//! [`crate::harmonics::doubling`].
//!
//! Each is taken over the size to which its error is relative: that of the damping ratio is a unit of the branch, since along a
//! backbone the ratio passes through zero.

use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::error::Result;
use crate::harmonics::doubling::Doubling;
use crate::harmonics::estimate::Estimate;
use crate::harmonics::kept_ratio::KeptRatio;
use num_complex::Complex64;

/// Frequency and damping ratio of a point and of its extensions to more harmonics.
pub(super) struct ModeSeries {
    /// Frequency and damping ratio of the point, and the unit of the damping ratio.
    omega: f64,
    damping: f64,
    unit: f64,
    tolerance: f64,
    of: [Doubling; 2],
}

/// Ratios of whole change to first change, found before: for frequency and damping ratio.
#[derive(Default)]
pub(super) struct ModeRatios([KeptRatio; 2]);

impl ModeSeries {
    /// Starts with a point, the unit of its damping ratio, and the tolerance of both numbers.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(DampedFrequency { omega, damping }: DampedFrequency, unit: f64, tolerance: f64) -> Result<Self> {
        let start = || Doubling::new(&[1.0.into()], false);
        Ok(Self {
            omega,
            damping,
            unit,
            tolerance,
            of: [start()?, start()?],
        })
    }

    /// Adds frequency and damping ratio of the next extension.
    pub fn add(&mut self, estimate: &Estimate) {
        let (omega, damping) = (estimate.corrected.omega, estimate.corrected.damping);
        // A change across 1 leaves the size to which it is relative.
        let across = |change: f64| [Complex64::new(1.0, change)];
        self.of[0].add(&across(omega / self.omega - 1.0));
        self.of[1].add(&across((damping - self.damping) / self.unit));
    }

    /// Number of extensions added.
    pub fn extensions(&self) -> usize {
        self.of[0].extensions()
    }

    /// Whether frequency and damping ratio have settled, or the one that has not does not matter.
    pub fn has_settled(&self) -> bool {
        self.of
            .iter()
            .all(|of| of.has_settled() || of.is_harmless(self.tolerance))
    }

    /// Whether both numbers are known well enough if no further extension is possible.
    pub fn suffices(&self) -> bool {
        self.of.iter().all(|of| of.suffices() || of.is_harmless(self.tolerance))
    }

    /// Whether one number surely misses the tolerance: a further extension would not change what follows.
    pub fn misses(&self) -> bool {
        self.suffices() && self.of.iter().any(|of| of.misses(self.tolerance))
    }

    /// Whether both numbers meet the tolerance with all that may be missing.
    pub fn is_harmless(&self) -> bool {
        self.of.iter().all(|of| of.is_harmless(self.tolerance))
    }

    /// The estimate of the last extension, with the predicted missing changes added.
    pub fn completed(&self, mut estimate: Estimate) -> Estimate {
        let [of_frequency, of_damping] = &self.of;
        let whole = |of: &Doubling| {
            if of.suffices() {
                of.whole() * (1.0 + of.next())
            } else {
                of.whole() + of.missing()
            }
        };
        estimate.frequency = whole(of_frequency);
        estimate.damping = whole(of_damping) * self.unit;
        // The response follows both.
        let missing = |of: &Doubling| if of.suffices() { of.next() } else { 0.0 };
        estimate.response *= 1.0 + missing(of_frequency).max(missing(of_damping));
        estimate
    }

    /// The estimate of the first extension by the ratios found before, where it surely meets the tolerance; else
    /// `None`.
    pub fn scaled(&self, ratios: &mut ModeRatios, least: usize, estimate: &Estimate) -> Option<Estimate> {
        let mut errors = [0.0; 2];
        for ((error, of), kept) in errors.iter_mut().zip(&self.of).zip(&mut ratios.0) {
            let (ratio, sure) = kept.at(least)?;
            *error = of.scaled(ratio);
            if *error > sure * self.tolerance {
                return None;
            }
        }
        Some(Estimate {
            frequency: errors[0],
            damping: errors[1] * self.unit,
            ..estimate.clone()
        })
    }

    /// Keeps the ratios of both numbers for the following estimates.
    pub fn note(&self, ratios: &mut ModeRatios, least: usize) {
        for (kept, of) in ratios.0.iter_mut().zip(&self.of) {
            let ratio = if of.suffices() {
                Some(of.ratio())
            } else {
                of.bounded_ratio()
            };
            if let Some(ratio) = ratio.filter(|ratio| ratio.is_finite()) {
                kept.note(least, ratio);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fourier::HarmonicSet;
    use crate::harmonics::Corrected;

    fn estimate(omega: f64, damping: f64) -> Estimate {
        Estimate {
            certified: true,
            too_large: false,
            motion: 0.0,
            response: 1e-3,
            responses: Vec::new(),
            frequency: f64::NAN,
            damping: f64::NAN,
            harmonics: 1,
            steps: 1,
            change: 0.0,
            tail: Vec::new(),
            corrected: Corrected {
                set: HarmonicSet::all(1).unwrap(),
                motion: Vec::new(),
                response: 1.0.into(),
                watched: Vec::new(),
                rates: Vec::new(),
                omega,
                damping,
            },
        }
    }

    /// A frequency whose error falls to a third with each doubling, and a damping ratio whose error falls to a fifth and passes
    /// through zero.
    #[test]
    fn the_errors_of_falling_series_are_those_to_their_limits() {
        let (omega, damping, unit) = (3.0, 1e-4, 2e-3);
        let (d_omega, d_damping) = (1e-4, -3e-4);
        let at = |k: i32| {
            let (a, b) = (d_omega * 3f64.powi(-k), d_damping * 5f64.powi(-k));
            estimate(omega + d_omega - a, damping + d_damping - b)
        };
        let mut series = ModeSeries::new(DampedFrequency { omega, damping }, unit, 0.0).unwrap();
        let mut extensions = 0;
        while !series.has_settled() {
            extensions += 1;
            series.add(&at(extensions));
            assert!(extensions < 6);
        }
        assert!(series.extensions() as i32 == extensions && extensions > 1);
        let found = series.completed(at(extensions));
        assert!((found.frequency / (d_omega / omega) - 1.0).abs() < 0.1, "{found:?}");
        assert!((found.damping / d_damping.abs() - 1.0).abs() < 0.1, "{found:?}");
        // The ratios then tell both errors from the first extension of the next point, which is not used where it is no sure thing.
        let mut ratios = ModeRatios::default();
        series.note(&mut ratios, 3);
        for (tolerance, serves) in [(0.5, true), (1e-3, false)] {
            let mut next = ModeSeries::new(DampedFrequency { omega, damping }, unit, tolerance).unwrap();
            next.add(&at(1));
            let scaled = next.scaled(&mut ratios, 3, &at(1));
            assert_eq!(scaled.is_some(), serves);
            if let Some(scaled) = scaled {
                assert!((scaled.damping / d_damping.abs() - 1.0).abs() < 0.1, "{scaled:?}");
            }
        }
    }
}
