//! Linear systems of Newton's method along a branch.

pub mod bordered;
pub mod linear_system;
