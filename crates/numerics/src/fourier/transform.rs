//! Real Fourier series at equidistant samples and back, by a table of sines or by a fast transform.
//!
//! The n-th harmonic of samples sⱼ is (1/N)·Σ sⱼ e^{−inτⱼ}, τⱼ = 2πj/N. Where the second half of the turn repeats
//! the first, with equal or opposite sign, only the first is stored.

use crate::error::{Result, check_memory, try_vec};
use crate::fourier::HarmonicSet;
use crate::linalg::dot;
use num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Products (samples times harmonics) up to which a table is quicker than a transform, as measured.
/// Kind: tuned; measured on: not recorded.
const TRANSFORM_TABLE_LIMIT: usize = 1 << 12;

/// Relation of the second half of a turn to the first, where only the first is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Half {
    /// Opposite sign: the signal has odd harmonics only.
    Opposite,
    /// Equal sign: the signal has even harmonics only.
    Repeats,
}

/// Positions of the samples of one signal in an array of several: `first + j·step`.
#[derive(Clone, Copy, Debug)]
pub struct Lane {
    /// Index of the first sample.
    pub first: usize,
    /// Distance from one sample to the next.
    pub step: usize,
}

impl Lane {
    fn of(self, values: &[f64]) -> impl Iterator<Item = f64> + '_ {
        values[self.first..].iter().step_by(self.step).copied()
    }
}

/// Tables and memory for the signals of one harmonic set.
pub struct Transform {
    /// Number of samples of a whole turn.
    turn: usize,
    /// Number of stored samples: all, or the first half.
    held: usize,
    kind: Kind,
}

enum Kind {
    /// Per n = 0 ..= 2·highest, the rows cos(nτⱼ) and sin(nτⱼ).
    Table { rows: Vec<f64>, signal: Vec<f64> },
    /// Transforms over the whole turn.
    Fast {
        inverse: Arc<dyn Fft<f64>>,
        forward: Arc<dyn Fft<f64>>,
        buffer: Vec<Complex64>,
        scratch: Vec<Complex64>,
    },
}

impl Transform {
    /// Memory for at least `requested` samples per turn, of which only the first half is stored if `half`. A fast
    /// transform takes the next number with small factors.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(set: &HarmonicSet, requested: usize, half: bool) -> Result<Self> {
        // Memory for an excessive number of samples is refused before any arithmetic with it.
        check_memory::<Complex64>(requested.saturating_mul(8), "samples")?;
        // Half a turn is a whole number of samples.
        let turn = if half { requested.next_multiple_of(2) } else { requested };
        // Half a turn determines every other harmonic only.
        let part = if half { 4 } else { 1 };
        let products = turn.saturating_mul(2 * set.highest_reduced() + 1) / part;
        if products <= TRANSFORM_TABLE_LIMIT {
            Self::with_table(set, turn, half)
        } else {
            Self::fast(smooth_number(turn), half)
        }
    }

    fn with_table(set: &HarmonicSet, turn: usize, half: bool) -> Result<Self> {
        let held = if half { turn / 2 } else { turn };
        let harmonics = 2 * set.highest_reduced() + 1;
        let mut rows = try_vec(2 * harmonics * held, 0.0, "a table of sines")?;
        for (n, pair) in rows.chunks_exact_mut(2 * held).enumerate() {
            let (cosines, sines) = pair.split_at_mut(held);
            for (j, (c, s)) in cosines.iter_mut().zip(sines).enumerate() {
                // The angle is reduced exactly: n·j modulo the samples of a turn.
                (*s, *c) = (TAU * ((n * j) % turn) as f64 / turn as f64).sin_cos();
            }
        }
        let signal = try_vec(held, 0.0, "samples")?;
        Ok(Self {
            turn,
            held,
            kind: Kind::Table { rows, signal },
        })
    }

    /// Fast transform over `turn` samples; `turn` is even where half of it is stored.
    fn fast(turn: usize, half: bool) -> Result<Self> {
        // The planner allocates a few arrays of this length itself.
        check_memory::<Complex64>(turn.saturating_mul(8), "a transform")?;
        let mut planner = FftPlanner::new();
        let inverse = planner.plan_fft_inverse(turn);
        let forward = planner.plan_fft_forward(turn);
        let scratch = inverse.get_inplace_scratch_len().max(forward.get_inplace_scratch_len());
        Ok(Self {
            turn,
            held: if half { turn / 2 } else { turn },
            kind: Kind::Fast {
                inverse,
                forward,
                buffer: try_vec(turn, Complex64::ZERO, "a transform")?,
                scratch: try_vec(scratch, Complex64::ZERO, "a transform")?,
            },
        })
    }

    /// Number of stored samples.
    #[must_use]
    pub fn held(&self) -> usize {
        self.held
    }

    /// Writes the samples of a packed signal.
    pub fn synthesise(&mut self, set: &HarmonicSet, packed: &[f64], values: &mut [f64], lane: Lane) {
        let (mean, rest) = packed.split_at(usize::from(set.has_mean()));
        let mean = mean.first().copied().unwrap_or(0.0);
        let targets = values[lane.first..].iter_mut().step_by(lane.step);
        match &mut self.kind {
            Kind::Table { rows, signal } => {
                signal.fill(mean);
                for (k, x) in rest.chunks_exact(2).enumerate() {
                    let at = 2 * set.reduced(k) * self.held;
                    let (cosines, sines) = rows[at..at + 2 * self.held].split_at(self.held);
                    for ((s, c), q) in signal.iter_mut().zip(cosines).zip(sines) {
                        *s += x[0] * c - x[1] * q;
                    }
                }
                for (target, s) in targets.zip(signal.iter()) {
                    *target = *s;
                }
            }
            Kind::Fast {
                inverse,
                buffer,
                scratch,
                ..
            } => {
                buffer.fill(Complex64::ZERO);
                buffer[0] = mean.into();
                for (k, x) in rest.chunks_exact(2).enumerate() {
                    buffer[set.reduced(k) % self.turn] += Complex64::new(x[0], x[1]);
                }
                inverse.process_with_scratch(buffer, scratch);
                for (target, z) in targets.zip(buffer[..self.held].iter()) {
                    *target = z.re;
                }
            }
        }
    }

    /// Writes the harmonics n = 0, 1, … of a real signal, as many as `harmonics` holds, at most 2·highest + 1.
    /// Where half a turn is stored, `half` selects the harmonics that exist; the others are 0.
    pub fn analyse(&mut self, values: &[f64], lane: Lane, half: Half, harmonics: &mut [Complex64]) {
        let folded = self.held < self.turn;
        let first = usize::from(folded && half == Half::Opposite);
        let stride = if folded { 2 } else { 1 };
        match &mut self.kind {
            Kind::Table { rows, signal } => {
                harmonics.fill(Complex64::ZERO);
                for (s, value) in signal.iter_mut().zip(lane.of(values)) {
                    *s = value;
                }
                let share = 1.0 / self.held as f64;
                for (n, z) in harmonics.iter_mut().enumerate().skip(first).step_by(stride) {
                    let at = 2 * n * self.held;
                    let (cosines, sines) = rows[at..at + 2 * self.held].split_at(self.held);
                    *z = Complex64::new(share * dot(signal, cosines), -share * dot(signal, sines));
                }
            }
            Kind::Fast {
                forward,
                buffer,
                scratch,
                ..
            } => {
                for (z, value) in buffer.iter_mut().zip(lane.of(values)).take(self.held) {
                    *z = value.into();
                }
                if folded {
                    let sign = if half == Half::Opposite { -1.0 } else { 1.0 };
                    let (begin, end) = buffer.split_at_mut(self.held);
                    for (z, a) in end.iter_mut().zip(begin.iter()) {
                        *z = sign * a;
                    }
                }
                forward.process_with_scratch(buffer, scratch);
                harmonics.fill(Complex64::ZERO);
                let share = 1.0 / self.turn as f64;
                for (n, z) in harmonics.iter_mut().enumerate().skip(first).step_by(stride) {
                    *z = share * buffer[n % self.turn];
                }
            }
        }
    }
}

/// The smallest even number from `n` on without prime factors above 5.
fn smooth_number(n: usize) -> usize {
    let smooth = |mut rest: usize| {
        for factor in [2, 3, 5] {
            while rest.is_multiple_of(factor) {
                rest /= factor;
            }
        }
        rest == 1
    };
    let power = n.max(2).next_power_of_two();
    (n.max(2)..power).find(|&n| n % 2 == 0 && smooth(n)).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(len: usize, seed: usize) -> Vec<f64> {
        (0..len).map(|i| ((i * 37 + seed) as f64 * 0.7).sin()).collect()
    }

    #[test]
    fn fast_transforms_have_small_factors() {
        let found = [0, 2, 7, 11, 97, 126, 243, 1021].map(smooth_number);
        assert_eq!(found, [2, 2, 8, 12, 100, 128, 250, 1024]);
    }

    #[test]
    fn table_and_fast_transform_agree() {
        for highest in [0, 1, 3, 8] {
            for odd in [false, true] {
                let set = HarmonicSet::excited(&[1], highest.max(1), true, odd, false).unwrap();
                let set = if highest == 0 {
                    HarmonicSet::all(0).unwrap()
                } else {
                    set
                };
                let highest = set.highest_reduced();
                // Also with so few samples that aliasing occurs.
                for turn in [2 * highest + 2, 4 * highest + 2, 6 * highest + 8, 128] {
                    for half in [false, set.is_odd()] {
                        let mut ways = [
                            Transform::with_table(&set, turn, half).unwrap(),
                            Transform::fast(turn, half).unwrap(),
                        ];
                        let held = ways[0].held();
                        let packed = wave(set.packed_len(), turn);
                        let lane = Lane { first: 1, step: 3 };
                        let signal = wave(3 * held, 5);
                        let results = ways.each_mut().map(|way| {
                            let mut samples = vec![0.0; 3 * held];
                            way.synthesise(&set, &packed, &mut samples, lane);
                            let mut all = vec![Complex64::ZERO; 2 * highest + 1];
                            let mut some = vec![Complex64::ZERO; highest + 1];
                            way.analyse(&signal, lane, Half::Repeats, &mut all);
                            way.analyse(&signal, lane, Half::Opposite, &mut some);
                            samples.into_iter().map(Complex64::from).chain(all).chain(some)
                        });
                        let [a, b] = results;
                        let gap = a.zip(b).fold(0.0, |m: f64, (a, b)| m.max((a - b).norm()));
                        assert!(gap < 1e-14, "H {highest}, {turn} samples, half {half}: {gap:e}");
                    }
                }
            }
        }
    }
}
