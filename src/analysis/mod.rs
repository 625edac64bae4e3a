//! The crate's public face: each analysis puts the layers together.

mod follow;
pub mod forced_response;
pub mod harmonic_residual;
pub mod nonlinear_mode;

pub use forced_response::forced_response;
pub use harmonic_residual::{contact_evaluate, forced_residual};
pub use nonlinear_mode::nonlinear_mode;
