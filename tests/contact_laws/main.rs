//! Contact laws on prescribed motions: forces, derivatives, sampling, and the contacts that joints and patches are
//! made of.

#[path = "../common/mod.rs"]
mod common;

mod cubic;
mod derivatives_of_laws;
mod force_alone;
mod friction;
mod friction_jacobian;
mod friction_plane;
mod friction_plane_derivatives;
mod friction_plane_rest;
mod friction_plane_rigid;
mod friction_plane_slip;
mod iwan;
mod law;
mod marched;
mod patch;
mod pointwise;
mod polynomial;
mod sampling_error;
mod table;
mod unilateral;
mod user_force;
