//! Options of a time integration.

use crate::error::{Result, fail};
use crate::options::solver_options::{MAX_HARMONIC, MAX_SAMPLES};
use num_complex::Complex64;

/// Method that finds a steady state in time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SteadyMethod {
    /// Newton's method on the map from the beginning of a period to its end; where it fails, some periods are
    /// marched before the next attempt.
    #[default]
    Shooting,
    /// Period after period until the motion repeats: the state that a machine would reach.
    Marching,
}

/// Options of a periodic response by time integration.
#[derive(Clone, Copy, Debug)]
pub struct TimeOptions<'a> {
    /// Angular frequency of harmonic 1, rad per time unit, above zero.
    pub omega: f64,
    /// Method that finds the steady state.
    pub method: SteadyMethod,
    /// Highest harmonic that is returned; it does not affect the accuracy of the others.
    pub harmonics: usize,
    /// Number of equidistant times per period at which the motion is returned; 0: none.
    pub samples: usize,
    /// Largest change of a steady state over one period, relative to the largest displacement and velocity. With
    /// [`SteadyMethod::Shooting`] a last Newton correction follows. It also bounds the local error of each step
    /// where a smooth law is integrated; otherwise steps are exact to rounding.
    pub tolerance: f64,
    /// Largest number of integrated periods.
    pub max_periods: usize,
    /// Initial motion: complex, (H + 1) × ndof of any H, harmonic by harmonic, as at a point of a branch; `None`:
    /// zero displacement and velocity.
    pub start: Option<&'a [Complex64]>,
}

impl Default for TimeOptions<'_> {
    fn default() -> Self {
        Self {
            omega: 0.0,
            method: SteadyMethod::Shooting,
            harmonics: 9,
            samples: 0,
            tolerance: 1e-11,
            max_periods: 10_000,
            start: None,
        }
    }
}

impl TimeOptions<'_> {
    /// Checks the values of all options for a model of `ndof` degrees of freedom per sector.
    ///
    /// # Errors
    /// `Argument`, `NotFinite` or `Dimension`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize) -> Result<()> {
        if !self.omega.is_finite() {
            return fail!(
                NotFinite,
                "omega = {}, needs a finite angular frequency > 0",
                self.omega
            );
        }
        if self.omega <= 0.0 {
            return fail!(Argument, "omega = {}, needs an angular frequency > 0", self.omega);
        }
        if self.harmonics > MAX_HARMONIC {
            return fail!(Argument, "harmonics = {}, needs 0 .. {MAX_HARMONIC}", self.harmonics);
        }
        if self.samples > MAX_SAMPLES {
            return fail!(Argument, "samples = {}, needs 0 .. {MAX_SAMPLES}", self.samples);
        }
        check_search(self.tolerance, self.max_periods)?;
        if let Some(start) = self.start {
            if start.is_empty() || start.len() % ndof != 0 || start.len() / ndof > MAX_HARMONIC + 1 {
                return fail!(
                    Dimension,
                    "start has {} numbers, needs (H + 1) * ndof with ndof = {ndof} and H = 0 .. {MAX_HARMONIC}",
                    start.len()
                );
            }
            if let Some(i) = start.iter().position(|z| !z.is_finite()) {
                return fail!(NotFinite, "start[{i}] is not finite");
            }
        }
        Ok(())
    }
}

pub(super) fn check_search(tolerance: f64, max_periods: usize) -> Result<()> {
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return fail!(Argument, "tolerance = {tolerance}, needs 0 < tolerance < 1");
    }
    if max_periods == 0 {
        return fail!(Argument, "max_periods = 0, needs at least 1");
    }
    Ok(())
}

/// Options of the check of a point by integration in time.
#[derive(Clone, Copy, Debug)]
pub struct VerifyOptions {
    /// Method that finds the steady state. Shooting finds the point's own solution where it is unstable, too.
    pub method: SteadyMethod,
    /// Tolerance of the integration, as [`TimeOptions::tolerance`].
    pub tolerance: f64,
    /// Largest number of integrated periods.
    pub max_periods: usize,
    /// Largest distance from the motion found in time, relative to that motion, at which the point counts as
    /// the same solution.
    pub same_within: f64,
}

impl Default for VerifyOptions {
    fn default() -> Self {
        let time = TimeOptions::default();
        Self {
            method: time.method,
            tolerance: time.tolerance,
            max_periods: time.max_periods,
            same_within: 0.1,
        }
    }
}

impl VerifyOptions {
    /// Checks the values of all options.
    ///
    /// # Errors
    /// `Argument` or `NotFinite`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        check_search(self.tolerance, self.max_periods)?;
        if !self.same_within.is_finite() {
            return fail!(
                NotFinite,
                "same_within = {}, needs a finite distance > 0",
                self.same_within
            );
        }
        if self.same_within <= 0.0 {
            return fail!(Argument, "same_within = {}, needs a distance > 0", self.same_within);
        }
        Ok(())
    }
}
