//! The contact laws, one file each.

pub mod cubic;
pub mod friction_2d;
mod friction_2d_slider;
pub mod friction_3d;
mod friction_3d_step;
mod friction_3d_stuck;
pub mod iwan;
pub mod jenkins;
pub mod polynomial;
pub mod regularised;
pub mod table;
pub mod unilateral;
pub mod user_law;
mod user_states;
