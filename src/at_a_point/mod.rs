//! Residuals, derivatives and stability at one point, of the caller or stored.

pub mod check_jacobian;
pub mod complex_sensitivity;
pub(crate) mod evaluation_need;
pub mod floquet;
pub mod harmonic_residual;
pub(crate) mod residual_numbering;
pub mod response_of_motion;
pub mod sensitivity_analysis;

pub use crate::at_a_point::check_jacobian::{JacobianGap, Tangent, check_jacobian};
pub use crate::at_a_point::complex_sensitivity::complex_sensitivity_with;
pub use crate::at_a_point::floquet::floquet;
pub use crate::at_a_point::harmonic_residual::{contact_evaluate_with, forced_residual_with};
pub use crate::at_a_point::response_of_motion::response_of;
pub use crate::at_a_point::sensitivity_analysis::{Quantity, sensitivity_with};
