//! Integration in time, run-ups, stability.

pub(crate) mod campbell_response;
pub(crate) mod stability;
pub(crate) mod stability_kick;
pub(crate) mod stability_lists;
pub(crate) mod time;
pub(crate) mod time_run_up;
pub(crate) mod time_sweep;
pub(crate) mod time_verify;

pub use campbell_response::*;
pub use stability::*;
pub use stability_kick::*;
pub use stability_lists::*;
pub use time::*;
pub use time_run_up::*;
pub use time_sweep::*;
pub use time_verify::*;
