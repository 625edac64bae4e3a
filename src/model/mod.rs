//! The model: structure, contacts, excitation. The analyses take their matrices and contact data from here.

pub mod aero;
mod blocks;
pub mod contents;
pub mod cyclic;
pub mod damped_mode;
pub mod degree_map;
pub mod excitation;
mod face_coordinates;
pub mod full_wheel;
pub mod linear_modes;
mod mechanical_model;
mod modal_damping;
pub mod mode_selection;
mod model_checks;
mod parameter_changes;
mod part_of_turn;
pub mod quadratic_modes;
pub mod reduced_wave;
pub mod repeated_modes;
pub mod resonances;
pub mod rotation;
mod saved_matrix;
mod saved_model;
mod saved_structure;
pub mod sector_faces;
mod sector_matrices;
pub mod sector_motion;
pub mod slip_capacity;
pub mod speed;
pub mod spring;
pub mod spring_stiffness;
pub mod static_tangents;
pub mod structure;
pub mod wave;

pub use mechanical_model::Model;
pub(crate) use mechanical_model::copy;
