//! Options, progress, forced responses, all solutions, static states, the residual at a given motion.

pub(crate) mod low_level;
pub(crate) mod solutions;
pub(crate) mod solve;
pub(crate) mod solve_hooks;
pub(crate) mod solve_options;
pub(crate) mod solve_responses;
pub(crate) mod static_history;

pub use low_level::*;
pub use solutions::*;
pub use solve::*;
pub use solve_hooks::*;
pub use solve_options::*;
pub use solve_responses::*;
pub use static_history::*;
