//! The responses of a branch.

use crate::condense::Resolution;
use crate::error::{Result, try_push};
use crate::options::Response;
use crate::results::stored::branch::Branch;
use crate::results::watched::response_series::ResponseSeries;

/// Relative size of a response that is rounding.
/// Kind: rounding.
const ROUNDING_OF_RESPONSES: f64 = 1e-12;

impl Branch {
    /// The responses that were requested in the options, in their order.
    #[must_use]
    pub fn responses(&self) -> &[ResponseSeries] {
        &self.responses
    }

    /// Whether the error of a point is the one of the norm of all responses.
    pub(crate) fn together(&self) -> bool {
        self.run.together
    }

    /// Index of the response with the largest error at a stored point, in the norm of the tolerance; `None` where no
    /// error is known.
    #[must_use]
    pub fn leading_response(&self, point: usize) -> Option<usize> {
        let error = |of: &ResponseSeries| -> f64 {
            let unit = if self.run.together {
                of.values().get(point).map_or(f64::NAN, |x| x.abs())
            } else {
                1.0
            };
            of.errors().get(point).map_or(f64::NAN, |e| e * unit)
        };
        let known = self
            .responses
            .iter()
            .map(error)
            .enumerate()
            .filter(|(_, e)| !e.is_nan());
        known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(r, _)| r)
    }

    /// Whether a value of a response, in the units of a resolution, is rounding against its largest one on the curve,
    /// so that a peak of this size does not count.
    pub(crate) fn is_rounding(&self, response: usize, value: f64, resolution: &Resolution) -> bool {
        let values = self.responses.get(response).map_or(&[][..], |of| of.values());
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(*x));
        value * resolution.condensed.length() <= ROUNDING_OF_RESPONSES * largest
    }

    /// Notes the responses before the first point; `observed`: the first one is the amplitude that the branch
    /// observes anyway.
    pub(crate) fn watch(&mut self, (responses, together): (&[Response<'_>], bool), observed: bool) -> Result<()> {
        self.run.together = together;
        for (i, response) in responses.iter().enumerate() {
            let series = ResponseSeries::new(response, self.run.response_dof, observed && i == 0)?;
            try_push(&mut self.responses, series, "the responses")?;
        }
        Ok(())
    }
}
