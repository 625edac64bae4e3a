//! Reduced models.

pub(crate) mod basis_motions;
pub(crate) mod craig_bampton;
pub(crate) mod entries;
pub(crate) mod free_interface;
pub(crate) mod pencil;
pub(crate) mod reduce;
pub(crate) mod reduced_basis;
