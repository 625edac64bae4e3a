//! Linear and nonlinear modes, responses synthesised from them.

pub(crate) mod mode_bands;
pub(crate) mod modes;
pub(crate) mod modes_damped;
pub(crate) mod modes_interference;
pub(crate) mod modes_linear;
pub(crate) mod modes_results;
pub(crate) mod modes_synthesis;

pub use mode_bands::*;
pub use modes::*;
pub use modes_damped::*;
pub use modes_interference::*;
pub use modes_linear::*;
pub use modes_results::*;
pub use modes_synthesis::*;
