//! The contact laws, one file each, and the [`registry`] that lists them; [`iwan`] joints are made of Jenkins contacts.

pub mod cubic;
pub mod friction_2d;
pub mod friction_3d;
pub mod iwan;
pub mod jenkins;
pub mod polynomial;
pub mod registry;
pub mod regularised;
pub mod saturated;
pub mod sliding_mass;
pub mod table;
pub mod unilateral;
pub mod user_law;
