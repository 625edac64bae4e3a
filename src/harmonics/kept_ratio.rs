//! Ratio of the whole change of the response to that of the first extension: it changes little along a branch, and serves some
//! of the following estimates with the same harmonics.

/// Estimates that a ratio serves before it is found anew: the first one, and the most while it does not change.
/// Kind: tuned; measured on: not recorded.
const USES: (usize, usize) = (3, 12);

/// Relative change of a ratio up to which the next one serves twice as many estimates.
/// Kind: tuned; measured on: not recorded.
const STEADY: f64 = 0.25;

/// Largest error, relative to the tolerance, that a ratio tells well enough: one found for the first time, and one that changed
/// little.
/// Kind: tuned; measured on: not recorded.
const SURE: (f64, f64) = (0.5, 0.6);

/// Ratio of the whole change of the response to the change by the first extension.
#[derive(Clone, Copy)]
struct Ratio {
    value: f64,
    /// Highest harmonic of the first extension.
    least: usize,
    /// Number of estimates for which the ratio may be used, and how many have used it.
    uses: usize,
    used: usize,
    /// Whether the ratio is close to the one before.
    steady: bool,
}

/// The ratio found last; `None` before the first one.
#[derive(Default)]
pub(super) struct KeptRatio(Option<Ratio>);

impl KeptRatio {
    /// The ratio for points with these harmonics, as long as it may be used, and the largest error, relative to the
    /// tolerance, that it estimates well enough.
    pub fn at(&mut self, least: usize) -> Option<(f64, f64)> {
        let ratio = self.0.as_mut()?;
        if ratio.least != least || ratio.used == ratio.uses {
            return None;
        }
        ratio.used += 1;
        Some((ratio.value, if ratio.steady { SURE.1 } else { SURE.0 }))
    }

    /// Keeps a ratio for the following estimates; for more of them where it is close to the one before.
    pub fn note(&mut self, least: usize, value: f64) {
        let before = self.0.filter(|before| before.least == least);
        let steady = before.filter(|before| (value / before.value - 1.0).abs() <= STEADY);
        let uses = steady.map_or(USES.0, |before| (2 * before.uses).min(USES.1));
        self.0 = Some(Ratio {
            value,
            least,
            uses,
            used: 0,
            steady: steady.is_some(),
        });
    }
}
