//! The error that the omitted harmonics cause at a solved point.

pub mod cutoff_harmonic;
mod doubling;
mod estimate;
mod extended_newton;
mod extended_system;
mod factored_harmonics;
pub mod forced_response_error;
mod jump_error;
mod kept_changes;
mod kept_ratio;
mod mode_doubling;
pub mod mode_error;
mod one_extension;
mod work;

pub(crate) use cutoff_harmonic::affordable;
pub(crate) use estimate::MARGIN;
pub use estimate::{Corrected, Estimate, Solved};
pub(crate) use work::{allow_point, is_allowed};
