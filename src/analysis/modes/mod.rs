//! A nonlinear mode: its equations, its first point, its curves.

pub(crate) mod mode_branches;
pub(crate) mod mode_curve;
pub(crate) mod mode_discretised;
pub(crate) mod mode_entry;
pub(crate) mod mode_equations;
pub(crate) mod mode_guess;
pub(crate) mod mode_onset;
pub(crate) mod mode_path;
pub(crate) mod mode_start;
pub mod nonlinear_mode;
