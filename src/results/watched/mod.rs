//! Responses that are read at points.

pub(crate) mod read_responses;
pub(crate) mod response_series;
pub(crate) mod responses;
