//! Fields of the points of a branch, and how they are stored.

pub(crate) mod branch;
pub(crate) mod branch_parts;
mod branch_questions;
pub(crate) mod branch_recording;
pub(crate) mod descent;
pub(crate) mod freedom_of_points;
pub(crate) mod limit_cycles;
pub mod mode_branch;
pub(crate) mod origin;
pub(crate) mod parameter_branch;
pub(crate) mod special;
pub(crate) mod stored_fields;
