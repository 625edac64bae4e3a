//! Exact condensation of the linear degrees of freedom onto the relative motions of the contacts.

mod condensation;
mod condensed;
pub mod contact_classes;
pub mod dynamic_stiffness;
pub mod flexibility;
pub mod frequency_cache;
pub mod frequency_interpolation;
pub mod harmonic_block;
pub mod modal_flexibility;
pub mod modal_table;
mod model_cache;
pub mod near_rigid_motion;
mod reduction;
mod reference_stiffness;
mod relative_coordinates;
mod resolution;
pub mod resonance_poles;
mod under_force;
pub mod wave_modes;

pub use condensed::{Condensed, Reference};
pub use harmonic_block::{Artificial, HarmonicBlock};
pub use model_cache::ModelCache;
pub use reduction::Reduction;
pub use resolution::Resolution;
