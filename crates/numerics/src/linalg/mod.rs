//! Linear algebra: matrix input, sparse storage, factorisations, iterative solution, eigenvalues.

pub mod dense;
pub(crate) mod elimination_order;
pub mod exact_sums;
pub mod factors;
pub mod iterative;
pub mod libraries;
pub mod newton;
pub mod sparse_storage;
mod vectors;

pub use vectors::{
    COPIED_UP_TO, ENOUGH_LEFT, SAFE_SQUARES, add_outer_products, add_outer_products_to, add_product, dot, expand,
    first_product, inner, inner_in_parts, norm, power_of_two, remove, transposed_products,
};
