//! Orders of elimination of sparse matrices by nested dissection.

pub(crate) mod graph;
pub(crate) mod nested_dissection;
pub(crate) mod separator;
