//! Linear algebra: matrix input, sparse storage, factorisations, iterative solution, eigenvalues.

pub mod block_krylov;
pub mod bordered;
pub mod cholesky;
pub mod compensated_product;
pub mod compensated_sum;
pub mod complex_columns;
pub mod complex_products;
pub mod definite;
pub mod eigen;
pub mod eigenvalues;
pub mod factor;
pub mod fallible_matrix;
pub mod general_eigen;
pub mod gmres;
mod graph;
pub mod held_rows;
pub mod hermitian;
pub mod inertia;
pub mod kept_matrix;
pub mod lanczos;
pub mod least_squares;
pub mod linear_system;
pub mod lu;
pub mod matrix_view;
pub mod near_shift;
mod nested_dissection;
pub mod orthonormal_block;
pub mod quadratic;
mod real_pencil;
mod reflections;
pub mod row_index;
mod separator;
pub mod shifted_inverse;
pub mod small_lu;
mod small_sum;
mod sorted_columns;
pub mod sparse;
pub mod triangle;
pub mod triangle_product;
mod tridiagonal;
mod vectors;

pub use vectors::{
    COPIED_UP_TO, SAFE_SQUARES, add_outer_products, add_outer_products_to, add_product, dot, expand, first_product,
    inner, norm, power_of_two, remove, transposed_products,
};
