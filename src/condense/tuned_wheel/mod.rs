//! A wheel as a tuned one plus terms of low rank.

pub(crate) mod tuned_basis;
pub(crate) mod tuned_factors;
pub(crate) mod tuned_plan;
pub(crate) mod tuned_ring;
pub(crate) mod tuned_table;
#[cfg(test)]
pub(crate) mod tuned_tests;
