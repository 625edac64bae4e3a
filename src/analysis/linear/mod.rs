//! Linear analyses: damped modes and static states.

pub mod damped_modes;
pub mod linear_contacts;
pub mod static_history;
pub(crate) mod static_solution;
