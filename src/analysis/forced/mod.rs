//! A forced response: its equations, its first point, one curve.

pub(crate) mod coarse_start;
pub(crate) mod deflation;
pub(crate) mod fine_motion;
pub(crate) mod forced_curve;
pub(crate) mod forced_discretised;
pub(crate) mod forced_equations;
pub(crate) mod inside_start;
pub(crate) mod known_curve;
mod linear_response;
pub(crate) mod odd_laws;
pub(crate) mod phase_direction;
pub mod point_error;
pub(crate) mod sampling;
pub(crate) mod start_net;
pub(crate) mod unbounded_response;
pub(crate) mod watched_responses;
