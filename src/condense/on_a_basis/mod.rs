//! Large structures on Krylov bases that carry a certificate.

pub(crate) mod basis_outlook;
pub(crate) mod certificate;
pub(crate) mod krylov_wave;
pub(crate) mod reduced_block;
pub(crate) mod reduced_resonances;
pub(crate) mod residual_directions;
pub(crate) mod sampled_motions;
pub(crate) mod wave_matrices;
pub(crate) mod wave_reduction;
