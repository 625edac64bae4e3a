//! Models on few motions of a structure.

pub(crate) mod on_modes;
pub mod reduced_wave;
pub(crate) mod shape_basis;
pub(crate) mod stuck_shapes;
pub(crate) mod tuned_family;
