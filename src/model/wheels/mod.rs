//! Wheels as plain models of all sectors, and their mistuning.

pub(crate) mod blade_basis;
pub mod blade_modes;
pub mod full_wheel;
pub mod mistuning;
pub mod sector_digest;
pub(crate) mod wheel;
