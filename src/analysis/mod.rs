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

pub use crate::analysis::forced::point_error::estimate_at;
pub use crate::analysis::forced_response::forced_response;
pub use crate::analysis::in_time::run_through::sweep;
pub use crate::analysis::in_time::time_response::time_response;
pub use crate::analysis::in_time::verify::{Verification, verify};
pub use crate::analysis::linear::static_history::{LoadHistory, StaticStep, static_history};
pub use crate::analysis::modes::nonlinear_mode::nonlinear_mode;
pub use crate::analysis::over_parameter::parameter_range::{Follow, ParameterRange};
pub use crate::analysis::over_parameter::parameter_response::parameter_response;
pub use crate::analysis::perturbed::smallest_kick::{Kick, smallest_kick};
pub use crate::analysis::residual_states::band::{Band, BandEnd, BandOf, BandOptions, BandState, band};
pub use crate::analysis::residual_states::band_curve::{BandPoint, band_curve};
pub use crate::analysis::residual_states::freedom::{FreeSlider, freedom, freedom_with};
pub use crate::analysis::residual_states::mode_band::{ModeBand, ModeBandOf, ModeBandState, mode_band};
pub use crate::analysis::synthesis::{synthesise, synthesise_with};
