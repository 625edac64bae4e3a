//! Dense matrices: memory that may be refused, products, eigenvalues, least squares.

pub mod complex_columns;
pub mod complex_products;
pub mod eigen;
pub mod eigenvalues;
pub mod fallible_matrix;
pub mod general_eigen;
pub mod hermitian;
pub mod least_squares;
pub(crate) mod real_pencil;
pub(crate) mod reflections;
mod small_pencil;
pub(crate) mod tridiagonal;
