//! Exact condensation of the linear degrees of freedom onto the relative motions of the contacts.

pub mod blocks;
pub mod by_factors;
pub mod by_modes;
mod chosen_blocks;
mod condensation;
pub mod frequency_cache;
pub(crate) mod on_a_basis;
pub(crate) mod tuned_wheel;

pub use blocks::condensed::{AssembledLaw, Condensed, Reference};
pub use blocks::flexibility_way::FlexibilityWay;
pub use blocks::harmonic_block::{Artificial, HarmonicBlock};
pub use blocks::model_cache::ModelCache;
pub use blocks::reduction::Reduction;
pub use blocks::resolution::Resolution;
pub use blocks::tied_load::LoadedLaw;
pub use on_a_basis::reduced_resonances::reduced_resonances;

#[cfg(test)]
pub(crate) mod test_chains;
