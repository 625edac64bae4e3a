//! Sparse matrices: how callers hand them over, how a model keeps them, and their sums.

pub mod definite;
pub mod held_rows;
pub mod kept_matrix;
pub mod matrix_view;
pub mod row_index;
pub(crate) mod small_sum;
pub(crate) mod sorted_columns;
pub mod sparse;
pub mod triangle;
pub mod triangle_product;
