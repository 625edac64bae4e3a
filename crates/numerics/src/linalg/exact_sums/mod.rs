//! Sums and products as if in twice the working precision.

pub mod compensated_product;
pub mod compensated_sum;
pub mod quadratic;
