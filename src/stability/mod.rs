//! Floquet multipliers of periodic motions, by the variational equations along the exact path from event to event.
//!
//! `closure` lists the blocks of perturbations of a wheel; `ring` has the matrices of one of them; `perturbations`
//! carries a basis of perturbations of a block through a lapse;
//! `known_directions` has the perturbations that return unchanged by construction; `multipliers` removes them and
//! the zeros of sliders, and finds the eigenvalues that remain; `operations` counts what all this costs.

mod closure;
mod known_directions;
mod multipliers;
mod operations;
mod perturbations;
mod ring;

pub(crate) use closure::{Closure, closures};
pub(crate) use multipliers::{Known, multipliers_of};
pub(crate) use operations::{Extent, fastest_motion};
pub(crate) use perturbations::Blocks;
