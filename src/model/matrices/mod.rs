//! The linear structure: its matrices, degrees of freedom, waves, damping and rotation.

pub mod aero;
pub(crate) mod blocks;
pub(crate) mod complex_stiffness;
pub mod cyclic;
pub mod degree_map;
pub(crate) mod face_coordinates;
pub mod influence;
pub(crate) mod modal_damping;
pub(crate) mod modal_directions;
pub(crate) mod part_of_turn;
pub mod rotation;
pub mod sector_faces;
pub(crate) mod sector_matrices;
pub mod sector_motion;
pub(crate) mod senses;
pub mod speed;
pub mod spring;
pub mod spring_stiffness;
pub mod structure;
mod structure_methods;
pub mod wave;
pub mod wave_matrix;
