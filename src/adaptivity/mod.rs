//! The number of harmonics along a branch, and the steps of a point from its prediction to its storage.
//!
//! [`branch_tracer`] follows the branch: the continuation predicts and corrects a point; [`controller`] estimates its
//! error and refines it until it meets the tolerance, by the harmonics of [`harmonic_levels`]; the analysis records
//! it; peaks, folds and requested solutions between it and the point before are located; the controller selects the
//! harmonics of the next step. Where every contact is linear, [`linear_stretch`] takes the place of the continuation, at the
//! values of [`resonance_grid`]. Where a branch is followed for its special points alone, [`resonance_bands`] bounds the steps. A
//! first point that leads to none within the tolerance is sought again by [`cold_start`]. A branch that comes back along its own
//! points is found and turned round by [`retracing`]; a curve that is entered inside its range ends by [`inner_ends`].
//! An analysis implements the two traits of [`discretised`]. [`resolutions`] stores the
//! equations at the resolutions of a run, [`transfer`] converts points from one resolution to another, and
//! [`branch_recorder`] stores points.

mod bifurcations;
mod branch_points;
pub(crate) mod branch_recorder;
mod branch_special_points;
pub(crate) mod branch_tracer;
mod cold_start;
pub(crate) mod controller;
mod decision;
pub(crate) mod discretised;
pub(crate) mod estimate_spacing;
mod harmonic_history;
pub(crate) mod harmonic_levels;
pub(crate) mod inner_ends;
mod linear_stretch;
mod requested_points;
pub(crate) mod resolutions;
pub(crate) mod resonance_bands;
pub(crate) mod resonance_grid;
mod response_kinks;
mod response_peaks;
mod retracing;
pub(crate) mod transfer;
