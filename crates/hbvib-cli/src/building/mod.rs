//! The model of a job from its files.

pub(crate) mod at_speeds;
pub(crate) mod build;
pub(crate) mod built;
pub(crate) mod check;
pub(crate) mod contact_guess;
pub(crate) mod contacts;
pub(crate) mod dampers;
pub(crate) mod expected;
pub(crate) mod model_report;
pub(crate) mod responses;
pub(crate) mod solver;
