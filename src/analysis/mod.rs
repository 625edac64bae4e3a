//! The crate's public face: each analysis puts the layers together.

mod adapt;
pub mod check_jacobian;
pub mod estimate;
mod follow;
mod forced_points;
pub mod forced_response;
pub mod harmonic_residual;
mod levels;
mod mode_points;
mod mode_rung;
pub mod nonlinear_mode;
pub mod synthesis;
pub mod time_response;
mod unbounded;
pub mod verify;

pub use check_jacobian::{JacobianGap, Tangent, check_jacobian};
pub use estimate::estimate_at;
pub use forced_response::forced_response;
pub use harmonic_residual::{contact_evaluate, forced_residual};
pub use nonlinear_mode::nonlinear_mode;
pub use synthesis::synthesise;
pub use time_response::time_response;
pub use verify::{Verification, verify};
