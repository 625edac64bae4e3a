//! The responses of a branch.

use crate::condense::Resolution;
use crate::error::{Result, try_push};
use crate::options::Response;
use crate::results::branch::Branch;
use crate::results::response_series::ResponseSeries;

/// Relative size of a response that is rounding.
const ROUNDING_OF_RESPONSES: f64 = 1e-12;

impl Branch {
    /// The responses that were asked for in the options, in their order.
    #[must_use]
    pub fn responses(&self) -> &[ResponseSeries] {
        &self.responses
    }

    /// Whether a value of a response, in the units of a resolution, is rounding against its largest one on the curve: a peak
    /// there is none.
    pub(crate) fn is_rounding(&self, response: usize, value: f64, resolution: &Resolution) -> bool {
        let values = self.responses.get(response).map_or(&[][..], |of| of.values());
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(*x));
        value * resolution.condensed.length() <= ROUNDING_OF_RESPONSES * largest
    }

    /// Notes the responses before the first point. `observed`: the first is the amplitude that the branch has by itself.
    pub(crate) fn watch(&mut self, responses: &[Response<'_>], observed: bool) -> Result<()> {
        for (i, response) in responses.iter().enumerate() {
            let series = ResponseSeries::new(response, self.response_dof, observed && i == 0)?;
            try_push(&mut self.responses, series, "the responses")?;
        }
        Ok(())
    }
}
