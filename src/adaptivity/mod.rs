//! The number of harmonics along a branch.

pub(crate) mod branch_tracer;
pub(crate) mod controller;
pub(crate) mod harmonic_levels;
