//! Sectors with degrees of freedom on both faces: natural frequencies, contacts across the faces, refusals.

#[path = "../common/mod.rs"]
mod common;

mod blade_modes;
mod boundary_sector;
mod identified_wheel;
mod mistuned_wheel;
mod sector_contacts;
mod sector_frequencies;
mod sector_mode_rounding;
mod sector_refusals;
mod tuned_wheel;
mod wheel_of_faces;
