//! Ratio of the whole change of the response to that of the first extension: it changes little along a branch, and serves some
//! of the following estimates with the same harmonics.

/// Estimates that a ratio serves before it is found anew: the first one, and the most while it does not change.
const USES: (usize, usize) = (3, 12);

/// Relative change of a ratio up to which the next one serves twice as many estimates.
const STEADY: f64 = 0.25;

/// Ratio of the whole change of the response to that of the first extension.
#[derive(Clone, Copy)]
struct Ratio {
    value: f64,
    /// Harmonic of the first extension.
    least: usize,
    /// Estimates that it serves, and how many of them were made.
    uses: usize,
    used: usize,
}

/// The ratio found last.
#[derive(Default)]
pub(super) struct KeptRatio(Option<Ratio>);

impl KeptRatio {
    /// The ratio found for points with these harmonics, as long as it serves.
    pub fn at(&mut self, least: usize) -> Option<f64> {
        let ratio = self.0.as_mut()?;
        if ratio.least != least || ratio.used == ratio.uses {
            return None;
        }
        ratio.used += 1;
        Some(ratio.value)
    }

    /// Keeps a ratio for the following estimates: for more of them where it is about the one before.
    pub fn note(&mut self, least: usize, value: f64) {
        let uses = match self.0 {
            Some(before) if before.least == least && (value / before.value - 1.0).abs() <= STEADY => {
                (2 * before.uses).min(USES.1)
            }
            _ => USES.0,
        };
        self.0 = Some(Ratio {
            value,
            least,
            uses,
            used: 0,
        });
    }
}
