//! The number that is read from a periodic signal, with its exact derivative by the harmonics.
//!
//! With x(τ) = Re Σ X_h e^{ihτ} every measure m has weights c_h, dm = Σ Re(c̄_h dX_h):
//!
//! > |X_h|: c_h = X_h/|X_h|;  rms: c₀ = X₀/rms, c_h = X_h/(2 rms);  x(τ*): c_h = e^{−ihτ*}.
//!
//! The last is the envelope theorem: τ* is stationary, so that its own change counts for nothing. A peak is ± x(τ*) with the
//! larger magnitude, a range x(τ*₁) − x(τ*₂).

use crate::error::{Error, Result, try_vec};
use crate::fourier::{Extremum, HarmonicSet, TurningPoints};
use crate::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

const CONTEXT: &str = "a response";

/// Relative difference of extremes that rounding makes.
/// Kind: rounding.
const SAME_SIZE: f64 = 1e-12;

/// Number that is read from a signal over a period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Measure {
    /// Amplitude, with phase, of the fundamental: harmonic 1, or the lowest one above zero that the motion has.
    #[default]
    Fundamental,
    /// Amplitude, with phase, of one harmonic; 0 where the motion does not have it.
    Harmonic(usize),
    /// Largest magnitude over the period.
    Peak,
    /// Root of the mean square over the period, the mean included.
    Rms,
    /// Largest value minus smallest one over the period.
    Range,
}

/// Value of a measure, as read from a signal.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// Value of the measure.
    pub value: f64,
    /// Complex amplitude of a single harmonic; NaN for other measures.
    pub complex: Complex64,
    /// Reduced time τ in [0, 2π) of the largest magnitude, or of a range's largest value; NaN for other measures.
    pub instant: f64,
}

/// Memory for reading signals of one harmonic set.
pub struct Reader {
    turning_points: TurningPoints,
    extrema: Vec<Extremum>,
    weights: Vec<Complex64>,
    /// Instants of the extremes read last, as reduced times; NaN for measures without extremes.
    instants: [f64; 2],
    /// Where the carried harmonics have gaps, the set without them and a signal of it.
    whole: Option<(HarmonicSet, Vec<f64>)>,
}

impl Reader {
    /// Memory for signals of `set`.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet) -> Result<Self> {
        let whole = match set.without_gaps()? {
            Some(whole) => {
                let signal = try_vec(whole.packed_len(), 0.0, CONTEXT)?;
                Some((whole, signal))
            }
            None => None,
        };
        let scanned = whole.as_ref().map_or(set, |(whole, _)| whole);
        let mut extrema = Vec::new();
        extrema
            .try_reserve_exact(2 * scanned.highest_reduced() + 4)
            .map_err(|_| Error::out_of_memory(CONTEXT))?;
        Ok(Self {
            turning_points: TurningPoints::new(scanned)?,
            extrema,
            weights: try_vec(set.numbers().len(), Complex64::ZERO, CONTEXT)?,
            instants: [f64::NAN; 2],
            whole,
        })
    }

    /// The weights of the measure read last, one per carried harmonic.
    #[must_use]
    pub fn weights(&self) -> &[Complex64] {
        &self.weights
    }

    /// The derivative of the measure read last along a change of the signal.
    #[must_use]
    pub fn along(&self, set: &HarmonicSet, change: &[f64]) -> f64 {
        let part = |(i, c): (usize, &Complex64)| (c.conj() * set.get(change, i)).re;
        self.weights.iter().enumerate().map(part).sum()
    }

    /// Reduced times of the extremes read last, and their derivatives −ẋ′/ẍ along a change of the signal; NaN for
    /// measures without extremes.
    #[must_use]
    pub fn instants(&self, set: &HarmonicSet, packed: &[f64], change: &[f64]) -> ([f64; 2], [f64; 2]) {
        let rates = self.instants.map(|tau| {
            let (mut moved, mut bend) = (0.0, 0.0);
            for (i, number) in set.numbers().iter().enumerate() {
                let p = (number / set.base().max(1)) as f64;
                let turn = Complex64::cis(p * tau);
                moved += (Complex64::new(0.0, p) * set.get(change, i) * turn).re;
                bend -= (p * p * set.get(packed, i) * turn).re;
            }
            -moved / bend
        });
        (self.instants, rates)
    }

    /// Reads a measure from a packed signal.
    ///
    /// # Errors
    /// `StoppedByCaller`.
    pub fn read(
        &mut self,
        set: &HarmonicSet,
        measure: Measure,
        packed: &[f64],
        interrupt: &Interrupt<'_>,
    ) -> Result<Reading> {
        self.weights.fill(Complex64::ZERO);
        self.instants = [f64::NAN; 2];
        let nothing = Complex64::new(f64::NAN, f64::NAN);
        Ok(match measure {
            Measure::Fundamental => self.harmonic(set, set.numbers().get(set.watched()).copied().unwrap_or(0), packed),
            Measure::Harmonic(number) => self.harmonic(set, number, packed),
            Measure::Rms => {
                let mut sum = 0.0;
                for (i, number) in set.numbers().iter().enumerate() {
                    sum += set.get(packed, i).norm_sqr() * if *number == 0 { 1.0 } else { 0.5 };
                }
                let value = sum.sqrt();
                if value > 0.0 {
                    for (i, (c, number)) in self.weights.iter_mut().zip(set.numbers()).enumerate() {
                        *c = set.get(packed, i) * (if *number == 0 { 1.0 } else { 0.5 } / value);
                    }
                }
                Reading {
                    value,
                    complex: nothing,
                    instant: f64::NAN,
                }
            }
            Measure::Peak => {
                let first = self.extremes(set, packed, interrupt, f64::abs)?;
                self.instants[0] = first.tau;
                self.add_instant(set, first.tau, if first.x < 0.0 { -1.0 } else { 1.0 });
                Reading {
                    value: first.x.abs(),
                    complex: nothing,
                    instant: first.tau,
                }
            }
            Measure::Range => {
                let high = self.extremes(set, packed, interrupt, |x| x)?;
                let low = self.extremes(set, packed, interrupt, |x| -x)?;
                self.instants = [high.tau, low.tau];
                self.add_instant(set, high.tau, 1.0);
                self.add_instant(set, low.tau, -1.0);
                Reading {
                    value: high.x - low.x,
                    complex: nothing,
                    instant: high.tau,
                }
            }
        })
    }

    /// Reads the amplitude of one harmonic.
    fn harmonic(&mut self, set: &HarmonicSet, number: usize, packed: &[f64]) -> Reading {
        let mut complex = Complex64::ZERO;
        if let Ok(i) = set.numbers().binary_search(&number) {
            complex = set.get(packed, i);
            let size = complex.norm();
            self.weights[i] = if size > 0.0 { complex / size } else { Complex64::ZERO };
        }
        Reading {
            value: complex.norm(),
            complex,
            instant: f64::NAN,
        }
    }

    /// The extremum of the signal at which `size` of its value is largest.
    fn extremes(
        &mut self,
        set: &HarmonicSet,
        packed: &[f64],
        interrupt: &Interrupt<'_>,
        size: impl Fn(f64) -> f64,
    ) -> Result<Extremum> {
        let (set, packed) = match &mut self.whole {
            Some((whole, signal)) => {
                whole.transfer(set, packed, 1.0, signal);
                (&*whole, &**signal)
            }
            None => (set, packed),
        };
        self.turning_points.find(set, packed, &mut self.extrema, interrupt)?;
        let mean = if set.has_mean() { packed[0] } else { 0.0 };
        let mut best = Extremum { tau: 0.0, x: mean };
        let mut largest = f64::NEG_INFINITY;
        let mirrored = |e: &Extremum| Extremum {
            tau: (e.tau + PI) % TAU,
            x: -e.x,
        };
        for e in &self.extrema {
            // An odd motion was scanned over half a turn; its mirror image is as large.
            let e = if set.is_odd() && size(-e.x) > size(e.x) {
                mirrored(e)
            } else {
                *e
            };
            let of = size(e.x);
            // The first one leads among images of each other, which differ by rounding.
            if largest == f64::NEG_INFINITY || of > largest + SAME_SIZE * largest.abs() {
                (best, largest) = (e, of);
            }
        }
        Ok(best)
    }

    /// Adds the weights of the value at the instant `tau`, times `sign`.
    fn add_instant(&mut self, set: &HarmonicSet, tau: f64, sign: f64) {
        for (c, number) in self.weights.iter_mut().zip(set.numbers()) {
            let p = (number / set.base().max(1)) as f64;
            *c += Complex64::cis(-p * tau) * sign;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEASURES: [Measure; 6] = [
        Measure::Fundamental,
        Measure::Harmonic(3),
        Measure::Harmonic(50),
        Measure::Peak,
        Measure::Rms,
        Measure::Range,
    ];

    fn sets() -> Vec<HarmonicSet> {
        let mut sets = Vec::new();
        for highest in [3, 9, 31] {
            for odd in [false, true] {
                sets.push(HarmonicSet::excited(&[1], highest, true, odd, false).unwrap());
            }
        }
        sets.push(HarmonicSet::excited(&[2, 4], 12, true, false, false).unwrap());
        // Forces of a linear structure, which leave harmonics out.
        for forced in [&[1, 4][..], &[3, 5], &[0, 1, 3], &[2, 3]] {
            sets.push(HarmonicSet::excited(forced, 12, false, true, false).unwrap());
        }
        sets
    }

    fn signal(set: &HarmonicSet, salt: usize) -> Vec<f64> {
        (0..set.packed_len())
            .map(|i| ((i * 37 + 11 * salt) as f64 * 0.7).sin() / (1.0 + 0.4 * i as f64))
            .collect()
    }

    fn at(set: &HarmonicSet, packed: &[f64], tau: f64) -> f64 {
        let values = set.numbers().iter().enumerate();
        values
            .map(|(i, number)| (set.get(packed, i) * Complex64::cis((number / set.base()) as f64 * tau)).re)
            .sum()
    }

    #[test]
    fn every_measure_is_that_of_a_time_history() {
        let n = 100_000;
        for (salt, set) in sets().iter().enumerate() {
            let packed = signal(set, salt);
            let history: Vec<f64> = (0..n)
                .map(|j| at(set, &packed, TAU * f64::from(j) / f64::from(n)))
                .collect();
            let high = history.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let low = history.iter().copied().fold(f64::INFINITY, f64::min);
            let mut reader = Reader::new(set).unwrap();
            let mut read = |measure| reader.read(set, measure, &packed, &Interrupt::none()).unwrap().value;
            // A sampled extreme misses by the curvature and half a sample.
            let highest = set.numbers()[set.numbers().len() - 1] / set.base();
            let bend = (highest as f64 * TAU / f64::from(n)).powi(2) * (high - low);
            assert!((read(Measure::Peak) - high.max(-low)).abs() <= bend);
            assert!(read(Measure::Peak) >= high.max(-low) - 1e-14);
            assert!((read(Measure::Range) - (high - low)).abs() <= 2.0 * bend);
            let mean_square = history.iter().map(|x| x * x).sum::<f64>() / f64::from(n);
            assert!((read(Measure::Rms) - mean_square.sqrt()).abs() < 1e-12);
            for (measure, number) in [
                (Measure::Fundamental, set.numbers()[set.watched()]),
                (Measure::Harmonic(3 * set.base()), 3 * set.base()),
            ] {
                let p = (number / set.base()) as f64;
                let sum: Complex64 = (0..n)
                    .map(|j| history[j as usize] * Complex64::cis(-p * TAU * f64::from(j) / f64::from(n)))
                    .sum();
                assert!((read(measure) - 2.0 * sum.norm() / f64::from(n)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        for (salt, set) in sets().iter().enumerate() {
            let (packed, change) = (signal(set, salt), signal(set, salt + 5));
            let mut reader = Reader::new(set).unwrap();
            for measure in MEASURES {
                let mut moved = |by: f64| {
                    let there: Vec<f64> = packed.iter().zip(&change).map(|(x, d)| x + by * d).collect();
                    reader.read(set, measure, &there, &Interrupt::none()).unwrap().value
                };
                let step = 1e-5;
                let difference = (moved(step) - moved(-step)) / (2.0 * step);
                moved(0.0);
                let exact = reader.along(set, &change);
                assert!(
                    (exact - difference).abs() < 1e-7 * (1.0 + exact.abs()),
                    "{measure:?} of {salt}: {exact} {difference}"
                );
            }
        }
    }

    #[test]
    fn a_signal_at_rest_reads_as_its_mean() {
        let set = HarmonicSet::all(3).unwrap();
        let packed = [-0.7, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut reader = Reader::new(&set).unwrap();
        for (measure, value, slope) in [
            (Measure::Peak, 0.7, -1.0),
            (Measure::Rms, 0.7, -1.0),
            (Measure::Range, 0.0, 0.0),
            (Measure::Fundamental, 0.0, 0.0),
            (Measure::Harmonic(0), 0.7, -1.0),
        ] {
            let read = reader.read(&set, measure, &packed, &Interrupt::none()).unwrap().value;
            assert!((read - value).abs() < 1e-15, "{measure:?}");
            let along = reader.along(&set, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
            assert!((along - slope).abs() < 1e-15, "{measure:?}: {along}");
        }
    }
}
