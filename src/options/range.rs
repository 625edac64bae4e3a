//! The values of a parameter that an analysis passes.

/// A range of a parameter, from its first value to its last, which may lie below; or one value, where both are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// First value; forced responses are scaled at this angular frequency.
    pub start: f64,
    /// Last value.
    pub stop: f64,
}

impl From<f64> for Range {
    fn from(value: f64) -> Self {
        Self {
            start: value,
            stop: value,
        }
    }
}

impl From<(f64, f64)> for Range {
    fn from((start, stop): (f64, f64)) -> Self {
        Self { start, stop }
    }
}

impl Range {
    /// Range from `start` to `stop`.
    #[must_use]
    pub const fn new(start: f64, stop: f64) -> Self {
        Self { start, stop }
    }

    /// Whether it holds one value only.
    #[must_use]
    pub fn is_single(self) -> bool {
        self.start.to_bits() == self.stop.to_bits()
    }

    /// Smallest value.
    #[must_use]
    pub const fn low(self) -> f64 {
        self.start.min(self.stop)
    }

    /// Largest value.
    #[must_use]
    pub const fn high(self) -> f64 {
        self.start.max(self.stop)
    }

    /// Distance between the ends, not negative.
    #[must_use]
    pub const fn width(self) -> f64 {
        (self.stop - self.start).abs()
    }

    /// Angular frequencies of harmonic `number` at the lower end, in the middle and at the upper end.
    #[must_use]
    pub fn of_harmonic(self, number: usize) -> [f64; 3] {
        let (low, high) = (self.low(), self.high());
        [low, 0.5 * (low + high), high].map(|omega| omega * number as f64)
    }
}
