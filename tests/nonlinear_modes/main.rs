//! Nonlinear modes: equations and their derivatives, reference data, closed forms, ranges and synthesised
//! responses.

#[path = "../common/mod.rs"]
mod common;

mod derivatives_of_modes;
mod equal_pairs;
mod mode_about_static;
mod mode_balance;
mod mode_bands;
mod mode_branches;
mod mode_closed_forms;
mod mode_conservative;
mod mode_decay;
mod mode_few_dampers;
mod mode_forced;
mod mode_linear_range;
mod mode_range;
mod mode_reference;
mod mode_static_energy;
mod mode_static_laws;
mod mode_stop;
mod mode_structural;
mod mode_synthesis;
mod mode_synthesis_error;
mod mode_turning;
mod mode_veering;
mod mode_wheel;
