//! How many harmonics a point carries, and the error that the omitted ones cause.
//!
//! `controller` chooses among the levels of `harmonic_levels` by a tolerance: it collects the signs of a point, asks the table of
//! `decision`, which also sees the state of the branch from `harmonic_history`, and carries out the answer.
//! `estimate_spacing` tells which points need an estimate. An analysis implements the five traits of `discretised`;
//! `resolutions` stores the equations at the levels of a run, and `transfer` converts points from one to another.
//!
//! `estimate` has the error of a solved point: `forced_response_error` and `mode_error` make it, from solutions of the
//! `extended_system` up to the `cutoff_harmonic` or the last of the `resonant_harmonics`, within the `work` that a point may take; a `second_estimate` follows where it does not
//! tell the error.

mod carried_harmonics;
pub(crate) mod controller;
pub mod cutoff_harmonic;
mod decision;
pub(crate) mod discretised;
mod doubling;
mod estimate;
pub(crate) mod estimate_spacing;
mod extended_newton;
mod extended_system;
mod factored_harmonics;
pub mod forced_response_error;
mod harmonic_history;
pub(crate) mod harmonic_levels;
mod jump_error;
mod kept_changes;
mod kept_ratio;
mod mode_doubling;
pub mod mode_error;
mod one_extension;
pub(crate) mod resolutions;
mod resonant_harmonics;
mod second_estimate;
pub(crate) mod transfer;
mod work;

pub(crate) use cutoff_harmonic::affordable;
pub(crate) use estimate::ESTIMATE_MARGIN;
pub use estimate::{Corrected, Estimate, Solved};
pub(crate) use work::{allow_point, is_allowed};
