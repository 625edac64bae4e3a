//! The responses of a branch.

use crate::error::{Result, try_push};
use crate::options::Response;
use crate::results::branch::Branch;
use crate::results::response_series::ResponseSeries;

impl Branch {
    /// The responses that were asked for in the options, in their order.
    #[must_use]
    pub fn responses(&self) -> &[ResponseSeries] {
        &self.responses
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
