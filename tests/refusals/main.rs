//! Input that is refused: each fault has its status and a sentence that names it.

#[path = "../common/mod.rs"]
mod common;

mod bad_input;
mod damping_input;
mod explained;
mod mode_bad_input;
mod options;
