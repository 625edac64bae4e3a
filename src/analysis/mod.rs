//! The crate's public face: each analysis puts the layers together.

pub mod forced;
pub mod forced_response;
pub mod in_time;
pub mod linear;
pub mod modes;
pub(crate) mod other_solutions;
pub mod over_parameter;
pub mod perturbed;
pub mod residual_states;
pub mod synthesis;

pub use crate::analysis::forced_response::forced_response;
pub use crate::analysis::in_time::run_through::sweep;
pub use crate::analysis::in_time::time_response::time_response;
pub use crate::analysis::in_time::verify::verify;
pub use crate::analysis::linear::static_history::{LoadHistory, static_history};
pub use crate::analysis::modes::nonlinear_mode::nonlinear_mode;
pub use crate::analysis::over_parameter::parameter_range::{Follow, ParameterRange};
pub use crate::analysis::over_parameter::parameter_response::parameter_response;
pub use crate::analysis::perturbed::smallest_kick::smallest_kick;
pub use crate::analysis::residual_states::band::{Band, BandEnd, BandOf, BandOptions, band};
pub use crate::analysis::residual_states::band_curve::{BandPoint, band_curve};
pub use crate::analysis::residual_states::freedom::{FreeSlider, freedom_with};
pub use crate::analysis::residual_states::mode_band::{ModeBandOf, ModeBandState, mode_band};
