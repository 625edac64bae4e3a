//! How calls cross the boundary: panics and errors become statuses, handles and pointers are checked, memory and threads are kept.

pub(crate) mod arrays;
pub(crate) mod boundary;
pub(crate) mod branch_tree;
pub(crate) mod float_environment;
pub(crate) mod handles;
pub(crate) mod indices;
pub(crate) mod last_error;
pub(crate) mod outcome;
pub mod process;
pub mod reserve;
pub(crate) mod stored_point;
pub mod thread_memory;
pub mod thread_start;
pub(crate) mod versioned_struct;
