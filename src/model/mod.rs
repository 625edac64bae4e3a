//! The model: structure, contacts, excitation. The analyses take their matrices and contact data from here.

pub mod damper;
pub mod excitation;
pub mod few_motions;
mod longer_period;
pub mod matrices;
mod mechanical_model;
mod model_checks;
mod model_methods;
pub mod natural_modes;
mod parameter_changes;
pub mod saved;
pub mod wheels;

pub use mechanical_model::Model;
pub(crate) use mechanical_model::copy;
