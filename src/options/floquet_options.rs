//! Options of Floquet multipliers.

use crate::error::Result;
use crate::options::time_options::check_search;
use crate::options::waves::Waves;

/// Options of the Floquet multipliers of a point.
#[derive(Clone, Copy, Debug)]
pub struct FloquetOptions {
    /// Perturbations of a cyclic model that are computed; a plain structure has one block only.
    pub waves: Waves,
    /// Whether to find the periodic motion in time by shooting first. A motion of harmonic balance is truncated, and
    /// its multipliers belong to a path that does not quite close.
    pub refine: bool,
    /// Tolerance of shooting, as [`TimeOptions::tolerance`](crate::options::TimeOptions::tolerance).
    pub tolerance: f64,
    /// Largest number of periods integrated by shooting.
    pub max_periods: usize,
    /// Modes of each nodal diameter, with contacts stuck, on which a large structure is computed, and with half as many
    /// once more. `Some(0)`: on all degrees of freedom. `None`: on all unless that counts more than 1e11 operations, a
    /// few minutes of one core; then on as many modes as are needed for agreement.
    pub modes: Option<usize>,
}

impl Default for FloquetOptions {
    fn default() -> Self {
        Self {
            waves: Waves::Wave,
            refine: true,
            tolerance: 1e-11,
            max_periods: 10_000,
            modes: None,
        }
    }
}

impl FloquetOptions {
    /// Checks the values of all options.
    ///
    /// # Errors
    /// `Argument`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        check_search(self.tolerance, self.max_periods)
    }
}
