//! The condensed model: contacts, relative coordinates, and one block a harmonic.

pub(crate) mod condensed;
pub mod contact_classes;
pub mod exchange;
pub(crate) mod flexibility_way;
pub mod harmonic_block;
pub(crate) mod memory_limit;
pub(crate) mod model_cache;
pub(crate) mod more_harmonics;
pub(crate) mod reduction;
pub(crate) mod reference_stiffness;
pub(crate) mod relative_coordinates;
pub(crate) mod resolution;
pub(crate) mod tied_load;
pub(crate) mod under_force;
