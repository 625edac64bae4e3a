//! Solutions that a sweep does not show: branches that branch off, and detached curves.

pub(crate) mod all_solutions;
pub(crate) mod branch_switching;
pub(crate) mod deflated_curves;
pub(crate) mod detached_curves;
pub(crate) mod over_force;
pub(crate) mod subharmonic_net;
