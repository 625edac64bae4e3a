//! Factors of matrices, dense and sparse, and what they tell.

pub mod cholesky;
pub mod factor;
pub mod inertia;
pub mod low_rank_term;
pub mod lu;
pub mod shifted_inverse;
pub mod slender_lu;
pub mod small_lu;
