//! Periodic responses by integration in time from event to event, without a harmonic series.

mod event_law;
mod event_loop;
mod gauss;
mod harmonic_analysis;
mod implicit_step;
mod linear_step;
mod periodic_response;
mod shooting;
mod smooth_laws;
mod step_polynomial;
mod unrolled_structure;

pub use periodic_response::{TimeResponse, solve};
