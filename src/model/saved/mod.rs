//! Models as bytes, and their fingerprints.

pub mod contents;
pub(crate) mod fingerprint;
pub(crate) mod saved_matrix;
pub(crate) mod saved_model;
pub(crate) mod saved_structure;
