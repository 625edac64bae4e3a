//! Cases on which programs for harmonic balance fail, and thousands of random ones.

#[path = "../common/mod.rs"]
mod common;

mod changing_harmonics;
mod closed_curves;
mod finite_fields;
mod hard_cases;
mod hard_modes;
mod hard_sweeps;
mod interrupts;
mod linear_stretches;
mod near_rigid;
mod near_rigid_chains;
mod near_rigid_slip;
mod near_rigid_stuck;
mod other_curves;
mod passed_resonances;
mod random_chains;
mod random_points;
mod random_problems;
mod requested_frequencies;
mod saved_models;
