//! The contact laws, one file each. The [`registry`] declares and lists them; declared here are the parts of laws
//! that have files of their own, and the [`iwan`] joint, which is made of Jenkins contacts.

mod friction_2d_events;
mod friction_2d_slider;
mod friction_3d_path;
mod friction_3d_period;
mod friction_3d_slip;
mod friction_3d_stuck;
pub mod iwan;
mod polynomial_terms;
pub mod registry;
pub mod saturated;
mod user_states;

pub use registry::*;
