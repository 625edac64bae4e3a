//! hbvib: harmonic balance of vibrating structures with friction contacts.
//!
//! Mass, damping and stiffness matrices, contact data and forces go in; converged harmonics of the
//! steady state come out: M ẍ + C ẋ + K x + f_nl = f_ex with x(t) = Re Σₕ Xₕ e^{ihωt}.
//!
//! The way of the data, one direction, each step a module of its own:
//!
//! [`model`] (structure, contacts, excitation) → [`condense`] (relative coordinates) → [`problem`]
//! (residual and Jacobian, with [`aft`] evaluating the [`contact`] laws) → [`continuation`]
//! (predict, correct, accept) → [`branch`] (points, peaks, folds; [`postprocess`] makes energies of
//! a point; [`error_estimate`] tells how wrong it is). [`time_response`] finds the same periodic motions without harmonics, in time. [`analysis`]
//! puts them together and [`capi`] hands them to C.
//!
//! Units are the caller's, consistent; angular frequencies in rad per time unit; amplitudes are
//! peak values.

#![deny(unsafe_code)]

mod adaptivity;
pub mod aft;
pub mod analysis;
pub mod capi;
pub mod condense;
pub mod contact;
pub mod continuation;
pub mod error;
pub mod error_estimate;
pub mod fourier;
pub mod hooks;
pub mod linalg;
pub mod model;
pub mod options;
pub mod problem;
pub mod results;
pub mod time_integration;

#[doc = include_str!("../docs/statuses.md")]
pub mod when_it_does_not_converge {}
