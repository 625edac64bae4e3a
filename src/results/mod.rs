//! Results: the stored points of a branch, and the quantities derived from them.

mod branch;
mod branch_recording;
pub mod contact_loops;
pub mod energy;
mod floquet_multiplier;
mod floquet_stability;
mod limit_cycles;
pub mod mode_branch;
mod mode_fields;
mod origin;
mod parameter_branch;
mod parameter_fields;
mod point_energy;
mod point_error_fields;
mod point_harmonics;
mod recovery;
mod stored_fields;
mod time_history;
mod unstable_directions;
mod verdict;

pub use crate::condense::Resolution;
pub use branch::{Branch, Special};
pub use branch_recording::Record;
pub(crate) use branch_recording::SpecialKind;
pub use floquet_multiplier::{Multiplier, MultiplierClass};
pub use floquet_stability::Floquet;
pub use limit_cycles::LimitCycle;
pub(crate) use parameter_branch::ParameterData;
pub use parameter_branch::{HigherPeak, Optimum};
pub use point_energy::Energy;
pub(crate) use recovery::Recovery;
pub use stored_fields::PointField;
pub use time_history::{ContactLoop, ContactSummary, MOST_TIMES, SUMMARISED};
pub(crate) use verdict::Verdict;
pub use verdict::{Bifurcation, BifurcationKind, Stretch, UNIT};
