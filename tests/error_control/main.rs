//! Error estimates against true errors, and harmonics chosen from a tolerance.

#[path = "../common/mod.rs"]
mod common;

mod error_estimate;
mod error_estimate_laws;
mod error_estimate_modes;
mod error_estimate_waves;
mod error_estimate_wells;
mod falling_friction;
mod few_harmonics;
mod resonant_harmonics;
mod tolerance;
