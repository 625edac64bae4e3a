//! Results: the stored points of a branch, and the numbers that follow from them.

mod branch;
pub mod contact_loops;
pub mod energy;
pub mod mode_branch;
mod point_energy;
mod point_error_fields;
mod point_resolution;
mod recovery;
mod time_history;

pub(crate) use branch::SpecialKind;
pub use branch::{Branch, Record, Special};
pub use point_energy::Energy;
pub use point_resolution::Resolution;
pub(crate) use recovery::Recovery;
pub use time_history::{ContactLoop, ContactSummary, MOST_TIMES, SUMMARISED};
