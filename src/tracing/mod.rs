//! The steps of a point of a branch from its prediction to its storage.
//!
//! [`branch_tracer`] follows the branch: the continuation predicts and corrects a point; the controller of [`crate::harmonics`]
//! estimates its error and refines it until it meets the tolerance; the analysis records it; peaks, folds and requested
//! solutions between it and the point before are located; the controller selects the
//! harmonics of the next step. Where every contact is linear, [`linear_stretch`] takes the place of the continuation, at the
//! values of [`resonance_grid`]. Where a branch is followed for its special points alone, [`resonance_bands`] bounds the steps. No
//! step of a sweep passes one of the [`linear_resonances`] that the branch feels. A
//! first point that leads to none within the tolerance is sought again by [`cold_start`]. A branch that comes back along its own
//! points is found and turned round by [`retracing`]; a curve that is entered inside its range ends by [`inner_ends`], and
//! one that goes round a closed curve by [`passed_folds`]. [`branch_recorder`] stores points, but for maxima
//! that samples of a law may have made ([`sampled_ripples`]).

mod bifurcations;
mod branch_points;
pub(crate) mod branch_recorder;
mod branch_special_points;
pub(crate) mod branch_tracer;
mod cold_start;
mod course;
pub(crate) mod inner_ends;
mod linear_onset;
mod linear_peaks;
pub(crate) mod linear_resonances;
mod linear_shares;
mod linear_stretch;
mod passed_folds;
mod points_between;
mod requested_points;
pub(crate) mod resonance_bands;
pub(crate) mod resonance_grid;
mod response_kinks;
mod response_peaks;
mod retracing;
mod sampled_ripples;
