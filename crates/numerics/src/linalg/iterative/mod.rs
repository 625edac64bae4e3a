//! Iterations: Krylov spaces for eigenvalues and for linear systems.

pub mod block_krylov;
pub mod gmres;
pub mod lanczos;
pub mod near_shift;
pub mod orthonormal_block;
pub mod refined_modes;
pub mod spectrum_slices;
