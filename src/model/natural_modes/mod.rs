//! Natural modes and resonances of the structure with its contacts stuck or removed.

pub(crate) mod all_undamped;
pub(crate) mod contact_modes;
pub mod damped_mode;
pub mod linear_modes;
pub mod mode_selection;
pub mod quadratic_modes;
pub mod quadratic_problem;
pub mod quadratic_search;
pub mod repeated_modes;
pub mod resonances;
pub(crate) mod shifted_factors;
pub mod slip_capacity;
pub mod static_tangents;
