//! A response that a run was asked for, at each stored point, with its peaks.

use crate::error::{Result, try_copy, try_push};
use crate::options::{Component, Measure, Response};
use crate::problem::gauges::Seen;
use crate::results::stored::special::Special;
use num_complex::Complex64;

const CONTEXT: &str = "the responses";

/// A response at a point, with its estimated relative error.
#[derive(Clone, Copy, Debug)]
pub struct SeenWithError {
    /// Value of the response and its derivatives.
    pub seen: Seen,
    /// Estimated relative error; NaN where it is unknown.
    pub error: f64,
}

/// A requested response, over the stored points of a branch.
#[derive(Clone, Debug)]
pub struct ResponseSeries {
    measure: Measure,
    component: Component,
    dofs: Vec<usize>,
    weights: Vec<f64>,
    sector: usize,
    /// Whether the response is the amplitude that every forced response observes.
    is_observed: bool,
    value: Vec<f64>,
    complex: Vec<Complex64>,
    error: Vec<f64>,
    instant: Vec<f64>,
    peaks: Vec<Special>,
    /// Kinks of the response, by the stored points on both sides of each.
    kinks: Vec<Special>,
}

impl ResponseSeries {
    /// A series of a response without points; a response without degrees of freedom reads the degree of freedom
    /// `default`.
    pub(crate) fn new(response: &Response<'_>, default: usize, is_observed: bool) -> Result<Self> {
        let only = [default];
        let dofs = if response.dofs.is_empty() { &only } else { response.dofs };
        Ok(Self {
            measure: response.measure,
            component: response.component,
            dofs: try_copy(dofs, CONTEXT)?,
            weights: try_copy(response.weights, CONTEXT)?,
            sector: response.sector,
            is_observed,
            value: Vec::new(),
            complex: Vec::new(),
            error: Vec::new(),
            instant: Vec::new(),
            peaks: Vec::new(),
            kinks: Vec::new(),
        })
    }

    /// Whether the response is the amplitude that every forced response observes.
    pub(crate) fn is_observed(&self) -> bool {
        self.is_observed
    }

    /// Appends a stored point, whose values are in the solver's unit `length`.
    pub(crate) fn push(&mut self, of_point: &SeenWithError, length: f64) -> Result<()> {
        let reading = of_point.seen.reading;
        try_push(&mut self.value, reading.value * length, CONTEXT)?;
        try_push(&mut self.complex, reading.complex * length, CONTEXT)?;
        try_push(&mut self.error, of_point.error, CONTEXT)?;
        try_push(&mut self.instant, reading.instant, CONTEXT)
    }

    pub(crate) fn push_peak(&mut self, peak: Special) -> Result<()> {
        try_push(&mut self.peaks, peak, CONTEXT)
    }

    pub(crate) fn push_kink(&mut self, side: Special) -> Result<()> {
        try_push(&mut self.kinks, side, CONTEXT)
    }

    /// The response as it was requested.
    #[must_use]
    pub fn response(&self) -> Response<'_> {
        Response {
            measure: self.measure,
            dofs: &self.dofs,
            weights: &self.weights,
            sector: self.sector,
            component: self.component,
        }
    }

    /// Value of the measure at each stored point: first the points of the curve, then the special ones.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.value
    }

    /// Complex amplitude at each stored point; NaN where the measure has none.
    #[must_use]
    pub fn complex(&self) -> &[Complex64] {
        &self.complex
    }

    /// Estimated relative error at each stored point; NaN where it is unknown.
    #[must_use]
    pub fn errors(&self) -> &[f64] {
        &self.error
    }

    /// Instant of a peak's largest magnitude, or of a range's largest value, at each stored point: the phase ωt of
    /// the period, in [0, 2π); NaN for other measures.
    #[must_use]
    pub fn instants(&self) -> &[f64] {
        &self.instant
    }

    /// Kinks of a peak or a range, where another instant of the period takes the lead: the last solution before and
    /// the first one after, in the order of the branch. Derivatives at these points belong to the two sides.
    #[must_use]
    pub fn kinks(&self) -> impl ExactSizeIterator<Item = (Special, Special)> {
        self.kinks.chunks_exact(2).map(|sides| (sides[0], sides[1]))
    }

    /// Maxima of the measure, refined on the solution, in the order of the branch.
    #[must_use]
    pub fn peaks(&self) -> &[Special] {
        &self.peaks
    }
}
