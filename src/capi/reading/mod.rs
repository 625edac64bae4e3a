//! Points of a branch: fields, harmonics, energies, contacts.

pub(crate) mod results;
pub(crate) mod results_contacts;
pub(crate) mod results_energy;
pub(crate) mod results_reduction;
pub(crate) mod results_responses;
pub(crate) mod results_special_points;

pub use results::*;
pub use results_contacts::*;
pub use results_energy::*;
pub use results_reduction::*;
pub use results_responses::*;
pub use results_special_points::*;
