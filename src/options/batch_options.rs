//! Options of a batch of designs.

use crate::error::{Result, fail};
use crate::options::ForcedOptions;

/// Most threads of one batch.
pub const MOST_THREADS: usize = 1024;

/// Options of a batch of designs.
#[derive(Clone, Copy, Debug)]
pub struct BatchOptions {
    /// First angular frequency of the response of each design, rad per time unit, above zero.
    pub omega_start: f64,
    /// Last angular frequency; below the first for downward sweeps.
    pub omega_stop: f64,
    /// Threads, the calling one included, 1 .. [`MOST_THREADS`]. Their number changes no bit of a result.
    pub threads: usize,
    /// Whether the branch of each design is kept.
    pub keep: bool,
}

impl Default for BatchOptions {
    fn default() -> Self {
        Self {
            omega_start: 0.0,
            omega_stop: 0.0,
            threads: 1,
            keep: false,
        }
    }
}

impl BatchOptions {
    /// The range of frequency.
    #[must_use]
    pub fn range(&self) -> ForcedOptions<'static> {
        ForcedOptions {
            omega_start: self.omega_start,
            omega_stop: self.omega_stop,
            ..ForcedOptions::default()
        }
    }

    /// Checks range and threads.
    ///
    /// # Errors
    /// `Argument` or `NotFinite`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        self.range().check()?;
        if self.threads == 0 || self.threads > MOST_THREADS {
            return fail!(Argument, "threads = {}, needs 1 .. {MOST_THREADS}", self.threads);
        }
        Ok(())
    }
}
