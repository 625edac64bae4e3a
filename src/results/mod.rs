//! Results: the stored points of a branch, and the quantities derived from them.

pub mod motions;
pub mod stored;
pub(crate) mod verdicts;
pub(crate) mod watched;
pub use crate::condense::Resolution;
pub use motions::point_energy::Energy;
pub(crate) use motions::recovery::Recovery;
pub use motions::time_history::{ContactLoop, ContactSummary, MOST_TIMES};
pub use stored::branch::Branch;
pub use stored::branch_recording::Record;
pub(crate) use stored::branch_recording::SpecialKind;
pub use stored::descent::{Descent, Searched};
pub(crate) use stored::freedom_of_points::FreedomOfPoints;
pub use stored::limit_cycles::LimitCycle;
pub(crate) use stored::parameter_branch::ParameterData;
pub use stored::parameter_branch::{HigherPeak, Optimum, Turn};
pub use stored::special::Special;
pub(crate) use stored::stored_fields::PointField;
pub use verdicts::floquet_multiplier::{Multiplier, MultiplierClass};
pub use verdicts::floquet_stability::Floquet;
pub(crate) use verdicts::verdict::Verdict;
pub use verdicts::verdict::{Bifurcation, BifurcationKind, Stretch};
pub use watched::response_series::{ResponseSeries, SeenWithError};
