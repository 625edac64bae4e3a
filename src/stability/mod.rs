//! Floquet multipliers of periodic motions, by the variational equations along the exact path from event to event.
//!
//! `closure` lists the blocks of perturbations of a wheel; `ring` has the matrices of one of them; `perturbations`
//! carries a basis of perturbations of a block through a lapse;
//! `known_directions` has the perturbations that return unchanged by construction; `multipliers` removes them and
//! the zeros of sliders, and finds the eigenvalues that remain; `operations` counts what all this costs.
//!
//! Sectors with many contacts of friction have their modes and sliders as states instead: `modal_ring` has the equations of a
//! block, `slipping` those of its slipping contacts, `slider_motion` its motion, which `slider_lapse` integrates by the steps of
//! `slider_step`; `slider_orbit` shoots, and `slider_map` carries perturbations.

mod closure;
mod known_directions;
mod modal_ring;
mod multipliers;
mod operations;
mod perturbations;
mod ring;
mod slider_lapse;
mod slider_map;
mod slider_motion;
mod slider_orbit;
mod slider_step;
mod slipping;

pub(crate) use closure::{Closure, closures};
pub(crate) use modal_ring::{ModalRing, Sliders};
pub(crate) use multipliers::{Counts, Known, classified, multipliers_of};
pub(crate) use operations::{Extent, fastest_motion};
pub(crate) use perturbations::Blocks;
pub(crate) use slider_map::SliderMap;
pub(crate) use slider_motion::{RingForce, SliderMotion, SliderState};
pub(crate) use slider_orbit::{Orbit, orbit, scale_of_sliders};
