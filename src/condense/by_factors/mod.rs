//! The flexibility by factors of the dynamic stiffness.

pub mod dynamic_stiffness;
pub(crate) mod exchanged_motions;
pub mod flexibility;
pub(crate) mod flexibility_slopes;
pub mod near_rigid_motion;
mod side_by_side;
