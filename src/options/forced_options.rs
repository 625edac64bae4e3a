//! Options of a forced response.

use crate::error::{Result, fail};
use num_complex::Complex64;

/// Options of a forced response over a range of frequency.
#[derive(Clone, Copy, Debug, Default)]
pub struct ForcedOptions<'a> {
    /// First angular frequency, rad per time unit, above zero.
    pub omega_start: f64,
    /// Last angular frequency; below the first for a downward sweep, equal to it for one point.
    pub omega_stop: f64,
    /// Angular frequencies within the range at which every solution on the branch is stored.
    pub at: &'a [f64],
    /// Initial guess: complex, (H + 1) × ndof, harmonic by harmonic; `None`: the solution with stuck contacts.
    pub guess: Option<&'a [Complex64]>,
}

impl ForcedOptions<'_> {
    /// Checks range, requested frequencies and guess (against `(harmonics + 1) * ndof`).
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Dimension`, naming the field, its value and its range.
    pub fn check(&self, guess_len: usize) -> Result<()> {
        for (name, value) in [("omega_start", self.omega_start), ("omega_stop", self.omega_stop)] {
            if !value.is_finite() {
                return fail!(NotFinite, "{name} = {value}, needs a finite angular frequency > 0");
            }
            if value <= 0.0 {
                return fail!(Argument, "{name} = {value}, needs an angular frequency > 0");
            }
        }
        let (low, high) = (
            self.omega_start.min(self.omega_stop),
            self.omega_start.max(self.omega_stop),
        );
        for (i, &w) in self.at.iter().enumerate() {
            if !w.is_finite() {
                return fail!(NotFinite, "at[{i}] = {w}, needs a finite angular frequency");
            }
            if w < low || w > high {
                return fail!(Argument, "at[{i}] = {w}, needs a frequency within {low} .. {high}");
            }
        }
        if let Some(guess) = self.guess {
            if guess.len() != guess_len {
                return fail!(
                    Dimension,
                    "guess has {} complex entries, needs (harmonics+1)*ndof = {guess_len}",
                    guess.len()
                );
            }
            if let Some(i) = guess.iter().position(|z| !z.is_finite()) {
                return fail!(NotFinite, "guess[{i}] is not finite");
            }
        }
        Ok(())
    }
}
