//! The crate's public face: each analysis puts the layers together.

pub mod forced_response;
pub mod harmonic_residual;

pub use forced_response::forced_response;
pub use harmonic_residual::{contact_evaluate, forced_residual};
