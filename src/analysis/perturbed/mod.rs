//! Perturbed motions: stability of points, and kicks between motions.

pub(crate) mod branch_stability;
pub(crate) mod floquet_of_sliders;
pub(crate) mod floquet_on_modes;
pub(crate) mod kicked_motion;
pub(crate) mod perturbed_motion;
pub mod smallest_kick;
pub(crate) mod two_numbers_of_modes;
