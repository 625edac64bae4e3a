//! Wheels as plain models of all sectors, and their mistuning.

pub mod full_wheel;
pub mod mistuning;
pub(crate) mod wheel;
