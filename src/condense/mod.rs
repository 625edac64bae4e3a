//! Exact condensation of the linear degrees of freedom onto the relative motions of the contacts.

mod basis_outlook;
mod certificate;
mod chosen_blocks;
mod condensation;
mod condensed;
pub mod contact_classes;
pub mod dynamic_stiffness;
pub mod exchange;
mod exchanged_motions;
mod few_directions;
pub mod flexibility;
mod flexibility_slopes;
mod flexibility_way;
pub mod frequency_cache;
pub mod harmonic_block;
mod krylov_wave;
mod low_rank;
pub(crate) mod memory_limit;
pub mod modal_rows;
mod modal_slopes;
pub mod modal_table;
pub mod mode_flexibility;
mod mode_sums;
mod model_cache;
mod more_harmonics;
pub mod near_rigid_motion;
mod quadratic_poles;
mod reduced_block;
mod reduced_resonances;
mod reduction;
mod reference_stiffness;
mod refined_modes;
mod relative_coordinates;
mod residual_directions;
mod resolution;
mod single_contact;
mod single_contact_lanes;
mod sum_terms;
mod sweep;
mod tied_load;
mod tuned_basis;
mod tuned_factors;
mod tuned_plan;
mod tuned_ring;
mod tuned_table;
mod under_force;
pub mod wave_cache;
mod wave_matrices;
pub mod wave_modes;
mod wave_poles;
mod wave_reduction;

pub use condensed::{AssembledLaw, Condensed, Reference};
pub use flexibility_way::FlexibilityWay;
pub use harmonic_block::{Artificial, HarmonicBlock};
pub use model_cache::ModelCache;
pub use reduced_resonances::reduced_resonances;
pub use reduction::Reduction;
pub use resolution::Resolution;
pub use sweep::Sweep;
pub use tied_load::{LoadedLaw, TiedLoad};

#[cfg(test)]
pub(crate) mod test_chains;

#[cfg(test)]
mod tuned_tests;
