//! The complex modal amplitude over the time of a run-up.

use crate::error::{Result, try_copy, try_push};
use num_complex::Complex64;

/// Amplitudes and their rates at rising times: cubic between them, steady before the first one.
#[derive(Clone, Debug, Default)]
pub(super) struct SlowPath {
    times: Vec<f64>,
    states: Vec<[Complex64; 2]>,
}

impl SlowPath {
    /// Appends amplitude and rate at a time after the last one.
    pub fn push(&mut self, time: f64, state: [Complex64; 2]) -> Result<()> {
        try_push(&mut self.times, time, "the slow flow")?;
        try_push(&mut self.states, state, "the slow flow")
    }

    /// A copy that returns an error if memory is short.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            times: try_copy(&self.times, "the slow flow")?,
            states: try_copy(&self.states, "the slow flow")?,
        })
    }

    /// Largest |q′|/(W|q|) between two times, with W over the time.
    pub fn growth(&self, (from, to): (f64, f64), omega: impl Fn(f64) -> f64) -> f64 {
        let inside = |(t, _): &(&f64, &[Complex64; 2])| (from..=to).contains(*t);
        let points = self.times.iter().zip(&self.states).filter(inside);
        points.fold(0.0, |most: f64, (&t, [q, rate])| {
            most.max(rate.norm() / (omega(t) * q.norm()).max(f64::MIN_POSITIVE))
        })
    }

    /// Largest distance of another path from this one between two times.
    pub fn distance(&self, other: &Self, (from, to): (f64, f64)) -> f64 {
        let inside = |(t, _): &(&f64, &[Complex64; 2])| (from..=to).contains(*t);
        let points = self.times.iter().zip(&self.states).filter(inside);
        points.fold(0.0, |most: f64, (&t, [q, _])| most.max((q - other.at(t)).norm()))
    }

    /// The amplitude at a time.
    pub fn at(&self, time: f64) -> Complex64 {
        let after = self.times.partition_point(|t| *t <= time);
        if after == 0 {
            return self.states.first().map_or(Complex64::ZERO, |s| s[0]);
        }
        if after == self.times.len() {
            return self.states[after - 1][0];
        }
        let (begin, end) = (self.times[after - 1], self.times[after]);
        cubic(
            (time - begin) / (end - begin),
            end - begin,
            &self.states[after - 1],
            &self.states[after],
        )
    }
}

impl SlowPath {
    /// First and second derivative of the amplitude at a time, the second one from differences of the first; 0 before
    /// the first time and after the last.
    pub fn motion(&self, time: f64) -> (Complex64, Complex64) {
        let n = self.times.len();
        let after = self.times.partition_point(|t| *t <= time);
        if after == 0 || after >= n {
            return (Complex64::ZERO, Complex64::ZERO);
        }
        let at = |k: usize| {
            let (low, high) = (k.saturating_sub(1), (k + 1).min(n - 1));
            (self.states[high][1] - self.states[low][1]) / (self.times[high] - self.times[low])
        };
        let length = self.times[after] - self.times[after - 1];
        let share = (time - self.times[after - 1]) / length;
        let (a, b) = (at(after - 1), at(after));
        // The rate is cubic, too.
        let rate = cubic(
            share,
            length,
            &[self.states[after - 1][1], a],
            &[self.states[after][1], b],
        );
        (rate, a * (1.0 - share) + b * share)
    }
}

/// The cubic at share `s` of an interval, through values and rates at its ends.
pub(super) fn cubic(s: f64, length: f64, a: &[Complex64; 2], b: &[Complex64; 2]) -> Complex64 {
    let r = 1.0 - s;
    a[0] * (r * r * (1.0 + 2.0 * s))
        + b[0] * (s * s * (3.0 - 2.0 * s))
        + (a[1] * (s * r * r) - b[1] * (s * s * r)) * length
}
