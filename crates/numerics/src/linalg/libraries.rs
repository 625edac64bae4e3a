//! Types and functions of the libraries of linear algebra that layers above use: those import them from here alone.

pub use faer::linalg::matmul::matmul;
pub use faer::{Accum, MatMut, MatRef, Par};
pub use nalgebra::{ColPivQR, ComplexField, DMatrix, DVector, SVD, Schur, SymmetricEigen};
pub use pulp::bytemuck::cast_slice;
pub use pulp::{Arch, Simd, WithSimd};
