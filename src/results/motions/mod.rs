//! Motions at a point: of all degrees of freedom, over time, of contacts, with their energies.

pub mod contact_loops;
pub mod energy;
pub(crate) mod point_energy;
pub(crate) mod point_harmonics;
pub(crate) mod recovery;
pub(crate) mod signal_check;
pub(crate) mod time_history;
