//! Options of a batch of designs.

use crate::error::{Result, fail};
use crate::options::{ForcedOptions, Response};

/// Most threads of one batch.
/// Kind: cap.
pub const MOST_THREADS: usize = 1024;

/// Options of a batch of designs.
#[derive(Clone, Copy, Debug)]
pub struct BatchOptions<'a> {
    /// First angular frequency of the response of each design, rad per time unit, above zero.
    pub omega_start: f64,
    /// Last angular frequency; below the first for downward sweeps.
    pub omega_stop: f64,
    /// Number of threads, the calling one included, 1 .. 1,024. It changes no bit of a result.
    pub threads: usize,
    /// Whether the branch of each design is kept.
    pub keep: bool,
    /// Responses that are watched: the first one defines the peak of a design, and each has its own peak. Empty: the
    /// amplitude of the response degree of freedom.
    pub responses: &'a [Response<'a>],
}

impl Default for BatchOptions<'_> {
    fn default() -> Self {
        Self {
            omega_start: 0.0,
            omega_stop: 0.0,
            threads: 1,
            keep: false,
            responses: &[],
        }
    }
}

impl<'a> BatchOptions<'a> {
    /// The range of frequency.
    #[must_use]
    pub fn range(&self) -> ForcedOptions<'a> {
        ForcedOptions {
            omega_start: self.omega_start,
            omega_stop: self.omega_stop,
            responses: self.responses,
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
