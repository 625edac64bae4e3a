//! Linear modes: natural frequencies, the modes from which nonlinear modes start, and damped structures.

#[path = "../common/mod.rs"]
mod common;

mod blade_families;
mod damped_mode;
mod families;
mod free_bodies;
mod modal_ratios;
mod natural_frequencies;
mod penalties;
mod rotating_modes;
mod rotating_wheel;
mod senses_of_crossings;
mod signed_diameters;
mod start_mode;
mod strong_dampers;
mod units;
mod unstable_and_held;
