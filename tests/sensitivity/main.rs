//! Design studies: derivatives of results by parameters against closed references, differences and identities.

#[path = "../common/mod.rs"]
mod common;

mod absent;
mod batch;
mod batch_of_chains;
mod complex_responses;
mod corner_peaks;
mod cost;
mod design;
mod differences;
mod fit_coverage;
mod fit_factor_and_direction;
mod fit_of_modes;
mod fit_of_responses;
mod fit_profiles;
mod fit_uncertainty;
mod life;
mod life_of_varying_load;
mod life_patch;
mod optima_at_corners;
mod ring_damper_preload;
mod sampled_curves;
mod tracked_damping;
mod tracked_ends;
mod tracked_fold;
mod tracked_peak;
mod turns_of_peaks;
