//! The angular frequencies for which a model is condensed.

/// A range of angular frequency, or one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// The first, at which the motion is scaled.
    pub start: f64,
    /// The last.
    pub stop: f64,
}

impl From<f64> for Sweep {
    fn from(omega: f64) -> Self {
        Self {
            start: omega,
            stop: omega,
        }
    }
}

impl From<(f64, f64)> for Sweep {
    fn from((start, stop): (f64, f64)) -> Self {
        Self { start, stop }
    }
}

impl Sweep {
    /// Whether it has more than one frequency.
    pub fn is_range(self) -> bool {
        self.start.to_bits() != self.stop.to_bits()
    }

    /// Its lower end, its middle and its upper end in harmonic `number`.
    pub fn of_harmonic(self, number: usize) -> [f64; 3] {
        let (low, high) = (self.start.min(self.stop), self.start.max(self.stop));
        [low, 0.5 * (low + high), high].map(|omega| omega * number as f64)
    }
}
