//! Data of tests that a fit explains: each set has a kind, a level of the force, and values with their standard deviations.

use crate::error::{Result, fail};
use crate::model::Model;
use crate::options::{Measure, Response};
use num_complex::Complex64;

/// Kind of the data of a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DataKind {
    /// Complex amplitudes of a response at angular frequencies.
    Response,
    /// Measures of a response at angular frequencies.
    Amplitude,
    /// Highest measures of a response near angular frequencies, and the angular frequencies of these peaks.
    Peak,
    /// Angular frequencies and damping ratios of a nonlinear mode at log₁₀ of its modal amplitude.
    Backbone,
    /// Angular frequency and damping ratio of the mode in which all contacts stick.
    LinearMode,
}

/// Data of one kind at one level of the force.
#[derive(Clone, Copy, Debug)]
pub struct FitData<'a> {
    /// Kind of the data.
    pub kind: DataKind,
    /// Factor on all forces of the model.
    pub force_factor: f64,
    /// Response that was measured, for the first three kinds.
    pub response: Response<'a>,
    /// Index of the linear mode with stuck contacts, for the other kinds.
    pub mode: usize,
    /// Range of angular frequency that is followed; `None`: the range of `x`, for a peak 0.7 to 1.3 times `x`.
    pub range: Option<(f64, f64)>,
    /// Angular frequencies, or log₁₀ of modal amplitudes; a linear mode does not use them.
    pub x: &'a [f64],
    /// Data by kind: complex amplitudes; measures as real parts; peaks with their angular frequency as imaginary
    /// part; angular frequencies of a mode with its damping ratio as imaginary part.
    pub value: &'a [Complex64],
    /// Standard deviations: for complex amplitudes of |X|, √2 times that of each part; for measures and peaks of the
    /// measure; for modes of the angular frequency.
    pub sigma: &'a [f64],
    /// Standard deviations of the angular frequency of a peak, or of the damping ratio of a mode; empty: these
    /// numbers are not used as data.
    pub second_sigma: &'a [f64],
}

impl Default for FitData<'_> {
    fn default() -> Self {
        Self {
            kind: DataKind::Response,
            force_factor: 1.0,
            response: Response::default(),
            mode: 0,
            range: None,
            x: &[],
            value: &[],
            sigma: &[],
            second_sigma: &[],
        }
    }
}

impl FitData<'_> {
    /// Checks a data set; one that is to be predicted needs no values.
    ///
    /// # Errors
    /// `Dimension`, `NotFinite` or `Argument`, naming the field; those of [`Response::check`].
    pub(super) fn check(&self, model: &Model, has_values: bool) -> Result<()> {
        self.response.check(model.ndof(), model.structure().sectors())?;
        if !self.force_factor.is_finite() {
            return fail!(NotFinite, "force_factor = {}, needs a finite number", self.force_factor);
        }
        let n = self.x.len();
        if n == 0 {
            return fail!(Dimension, "x is empty, needs at least one number");
        }
        for (i, x) in self.x.iter().enumerate() {
            if !x.is_finite() {
                return fail!(NotFinite, "x[{i}] = {x}, needs a finite number");
            }
            if *x <= 0.0 && self.is_forced() {
                return fail!(Argument, "x[{i}] = {x}, needs an angular frequency > 0");
            }
        }
        if self.kind == DataKind::Response
            && !matches!(self.response.measure, Measure::Fundamental | Measure::Harmonic(_))
        {
            return fail!(
                Argument,
                "the measure of the response has no complex amplitude; needs the fundamental or a harmonic"
            );
        }
        if let Some((low, high)) = self.range
            && !(low > 0.0 && high > low && high.is_finite())
        {
            return fail!(Argument, "range = {low} .. {high}, needs 0 < first < last");
        }
        if !has_values {
            return Ok(());
        }
        for (name, len) in [("value", self.value.len()), ("sigma", self.sigma.len())] {
            if len != n {
                return fail!(Dimension, "{name} has {len} numbers, needs {n} as x");
            }
        }
        if !self.second_sigma.is_empty() && self.second_sigma.len() != n {
            return fail!(
                Dimension,
                "second_sigma has {} numbers, needs {n} as x, or none",
                self.second_sigma.len()
            );
        }
        if let Some(i) = self.value.iter().position(|z| !z.is_finite()) {
            return fail!(NotFinite, "value[{i}] is not finite");
        }
        for (name, sigmas) in [("sigma", self.sigma), ("second_sigma", self.second_sigma)] {
            if let Some(i) = sigmas.iter().position(|s| !(*s > 0.0 && s.is_finite())) {
                return fail!(Argument, "{name}[{i}] = {}, needs a finite number > 0", sigmas[i]);
            }
        }
        Ok(())
    }

    /// Whether the set is of a forced response.
    pub(super) fn is_forced(&self) -> bool {
        matches!(self.kind, DataKind::Response | DataKind::Amplitude | DataKind::Peak)
    }

    /// Weights of both numbers of a datum: 1/σ of its standard deviation, or 0 for a number that is not used.
    pub(super) fn weights(&self, i: usize) -> [f64; 2] {
        let first = 1.0 / self.sigma[i];
        match self.kind {
            DataKind::Response => [std::f64::consts::SQRT_2 * first; 2],
            DataKind::Amplitude => [first, 0.0],
            DataKind::Peak | DataKind::Backbone | DataKind::LinearMode => {
                [first, self.second_sigma.get(i).map_or(0.0, |s| 1.0 / s)]
            }
        }
    }

    /// Range of angular frequency in which the response is followed.
    pub(super) fn followed(&self) -> (f64, f64) {
        let low = self.x.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        let high = self.x.iter().fold(0.0_f64, |a, b| a.max(*b));
        match (self.range, self.kind) {
            (Some((a, b)), DataKind::Peak) => (a, b),
            (Some((a, b)), _) => (a.min(low), b.max(high)),
            (None, DataKind::Peak) => (0.7 * low, 1.3 * high),
            (None, _) => (low, high),
        }
    }
}
