//! Integration in time: periodic responses, verification, run-throughs.

pub(crate) mod record_peak;
pub mod run_through;
pub mod time_response;
pub(crate) mod verified_responses;
pub mod verify;
