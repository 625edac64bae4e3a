//! A result as a function of a parameter of the model.

pub(crate) mod damping_maximum;
pub(crate) mod followed;
pub(crate) mod optimum_search;
pub(crate) mod parameter_curve;
pub mod parameter_range;
pub mod parameter_response;
pub(crate) mod tracked_damping;
