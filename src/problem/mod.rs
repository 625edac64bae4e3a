//! Mechanical problems R(u, p) = 0 with one parameter p.
//!
//! [`harmonic_balance`] is the forced response over frequency, [`epmc`] the nonlinear mode (extended periodic motion
//! concept) over amplitude, and [`homotopy`] wraps either where Newton's method does not find a first point. The
//! continuation uses the trait [`Problem`] and nothing else of mechanics.

mod contact_base;
pub mod contact_forces;
mod contact_jacobian;
mod contact_rank;
pub mod epmc;
pub mod gauges;
pub mod harmonic_balance;
pub mod homotopy;
mod nearby_response;
pub mod newton_products;
mod parametric_problem;
mod passed_resonance;
mod residual_scale;
mod ring_blocks;
mod single_balance;
pub(crate) mod slip_forces;
pub mod static_force;
pub mod static_state;

pub use parametric_problem::{End, Homotopy, InitialGuess, Problem, Residual};
