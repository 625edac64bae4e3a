//! Options of a sweep of the frequency in time.

use crate::error::{Result, fail};
use crate::options::time_options::TimeOptions;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Most turns of a sweep.
/// Kind: cap.
const MOST_TURNS: f64 = 1e8;

/// Options of a sweep of the frequency in time.
#[derive(Clone, Copy, Debug)]
pub struct SweepOptions<'a> {
    /// First angular frequency of harmonic 1, rad per time unit, above zero.
    pub omega_start: f64,
    /// Last angular frequency of harmonic 1; below the first for a run-down.
    pub omega_stop: f64,
    /// Rate |dω/dt| of the frequency, above zero.
    pub rate: f64,
    /// Degree of freedom whose displacement is observed.
    pub dof: usize,
    /// Tolerance as [`TimeOptions::tolerance`], for the first periodic motion and the steps of smooth laws.
    pub tolerance: f64,
    /// Largest number of periods that the search for the first periodic motion may integrate.
    pub max_periods: usize,
    /// Guess of the first periodic motion, as [`TimeOptions::start`]; `None`: zero displacement and velocity.
    pub start: Option<&'a [Complex64]>,
}

impl Default for SweepOptions<'_> {
    fn default() -> Self {
        let time = TimeOptions::default();
        Self {
            omega_start: 0.0,
            omega_stop: 0.0,
            rate: 0.0,
            dof: 0,
            tolerance: time.tolerance,
            max_periods: time.max_periods,
            start: None,
        }
    }
}

impl<'a> SweepOptions<'a> {
    /// Options of the first periodic motion.
    pub(crate) fn first(&self) -> TimeOptions<'a> {
        TimeOptions {
            omega: self.omega_start,
            tolerance: self.tolerance,
            max_periods: self.max_periods,
            start: self.start,
            ..TimeOptions::default()
        }
    }

    /// Checks the values of all options for a model of `ndof` degrees of freedom.
    ///
    /// # Errors
    /// `Argument`, `NotFinite`, `Index` or `Dimension`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize) -> Result<()> {
        check_passage(self.omega_start, self.omega_stop, self.rate)?;
        if self.dof >= ndof {
            return fail!(Index, "dof = {}, needs 0 .. {}", self.dof, ndof.saturating_sub(1));
        }
        let turns = (self.omega_stop.powi(2) - self.omega_start.powi(2)).abs() / (2.0 * TAU * self.rate);
        if turns > MOST_TURNS {
            return fail!(
                Argument,
                "rate = {:e}: the sweep has {turns:.3e} turns, needs at most {MOST_TURNS:e}",
                self.rate
            );
        }
        self.first().check(ndof)
    }
}

/// Checks the frequencies of a passage and its rate.
///
/// # Errors
/// `Argument` or `NotFinite`, naming the field, its value and its range.
pub(super) fn check_passage(start: f64, stop: f64, rate: f64) -> Result<()> {
    for (name, value) in [("omega_start", start), ("omega_stop", stop), ("rate", rate)] {
        if !value.is_finite() {
            return fail!(NotFinite, "{name} = {value}, needs a finite number > 0");
        }
        if value <= 0.0 {
            return fail!(Argument, "{name} = {value:?}, needs a number > 0");
        }
    }
    if start.to_bits() == stop.to_bits() {
        return fail!(
            Argument,
            "omega_start = omega_stop = {start:?}, needs two different angular frequencies; at one the motion is steady"
        );
    }
    Ok(())
}
