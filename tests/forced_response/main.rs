//! Forced responses: equations and their derivatives, continuation, reference data, closed forms, full wheels and
//! forces of the caller.

#[path = "../common/mod.rs"]
mod common;

mod backward_waves;
mod bands_of_many_sliders;
mod bands_of_two_dampers;
mod capacity;
mod continuation;
mod dampers;
mod derivatives;
mod direct_solutions;
mod duffing;
mod duffing_folds;
mod few_dampers;
mod flexibility_digits;
mod folds;
mod freedom_of_points;
mod full_wheel;
mod isotropic;
mod load_history;
mod many_contacts;
mod many_sliders_in_time;
mod mean_friction;
mod modal_beside_coupling;
mod onset_between_values;
mod onset_in_plane;
mod preload;
mod reduced_structures;
mod reference_point;
mod reference_response;
mod residual_band;
mod ring_damper_speeds;
mod rotation;
mod sampled_peaks;
mod small_systems;
mod stiff_links;
mod structural_closed_forms;
mod structural_damping;
mod stuck_and_scaling;
mod unbounded;
mod user_failures;
mod user_in_solver;
