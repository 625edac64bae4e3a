//! The crate's public face: each analysis puts the layers together.

pub mod batch;
mod branch_stability;
pub mod campbell;
pub mod check_jacobian;
mod coarse_start;
pub mod damped_modes;
mod damping_maximum;
pub mod design_peak;
mod evaluation_need;
pub mod floquet;
mod floquet_on_modes;
mod followed;
mod forced_discretised;
mod forced_equations;
pub mod forced_response;
pub mod further_threads;
pub mod harmonic_residual;
pub mod interference;
pub mod linear_contacts;
mod mode_discretised;
mod mode_equations;
mod mode_onset;
mod mode_path;
mod mode_start;
pub mod nonlinear_mode;
mod parameter_curve;
pub mod parameter_range;
pub mod parameter_response;
mod perturbed_motion;
pub mod point_error;
mod residual_numbering;
mod sampling;
pub mod sensitivity_analysis;
mod static_solution;
pub mod synthesis;
pub mod time_response;
mod tracked_damping;
mod unbounded_response;
pub mod verify;

pub use crate::analysis::batch::{Batch, batch};
pub use crate::analysis::check_jacobian::{JacobianGap, Tangent, check_jacobian};
pub use crate::analysis::design_peak::DesignPeak;
pub use crate::analysis::floquet::floquet;
pub use crate::analysis::forced_response::forced_response;
pub use crate::analysis::harmonic_residual::{
    contact_evaluate, contact_evaluate_with, forced_residual, forced_residual_with,
};
pub use crate::analysis::nonlinear_mode::nonlinear_mode;
pub use crate::analysis::parameter_range::{Follow, ParameterRange};
pub use crate::analysis::parameter_response::parameter_response;
pub use crate::analysis::point_error::estimate_at;
pub use crate::analysis::sensitivity_analysis::{Quantity, Sensitivities, sensitivity, sensitivity_with};
pub use crate::analysis::synthesis::{synthesise, synthesise_with};
pub use crate::analysis::time_response::time_response;
pub use crate::analysis::verify::{Verification, verify};
