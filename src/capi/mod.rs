//! The C interface: `include/hbvib.h` is generated from this module, and the declarations of the other languages from
//! the header (`crates/bindings`).
//!
//! Infrastructure: `boundary` turns panics and errors into statuses, `handles` turns objects into numbers that cannot
//! be confused, `versioned_struct` has the rules by which structs cross the boundary, `arrays`, `indices` and
//! `stored_point` check the pointers and numbers of the caller, `reserve` is the allocator, `thread_memory` what a thread
//! keeps, `thread_start` how one is started, `process` is for fork and unloading, `float_environment` separates the settings of the floating-point unit. All
//! other files are named after the sections of the header (`crates/bindings/src/header.rs` has their order), and a
//! file lists its items in the order of the header. No file here contains numerics.
//!
//! The doc comments of exported items are written for the reader of the header, and the generator reads four words
//! in the description of a pointer: an argument that may be `NULL` states that, an array of `complex` numbers too,
//! an `int64_t` array that a function fills receives `numbers`, and several structs are an `array of` them.

#![allow(unsafe_code)]
// The comments become those of a C header, whose contract ("Conventions") is at its top.
#![allow(clippy::missing_safety_doc, clippy::doc_markdown)]

mod arrays;
mod boundary;
mod branch_tree;
mod float_environment;
mod handles;
mod indices;
mod last_error;
mod outcome;
pub mod process;
pub mod reserve;
mod stored_point;
pub mod thread_memory;
pub mod thread_start;
mod versioned_struct;

mod band;
mod band_curves;
mod batch;
mod caller_laws;
mod caller_laws_check;
mod campbell_response;
mod complex_sensitivities;
mod contacts;
mod contacts_batch;
mod contacts_damper;
mod contacts_described;
mod contacts_patch;
mod contacts_springs;
mod cyclic;
mod cyclic_aero;
mod cyclic_faces;
mod cyclic_wheel;
mod fit;
mod fit_data;
mod fit_profile;
mod life;
mod low_level;
mod matrices;
mod mode_bands;
mod model;
mod model_contents;
mod model_damping;
mod model_rotation;
mod model_saved;
mod modes;
mod modes_damped;
mod modes_interference;
mod modes_linear;
mod modes_results;
mod modes_synthesis;
mod parameter_optima;
mod parameter_responses;
mod results;
mod results_contacts;
mod results_energy;
mod results_reduction;
mod results_responses;
mod results_special_points;
mod sensitivities;
mod solutions;
mod solve;
mod solve_hooks;
mod solve_options;
mod solve_responses;
mod stability;
mod stability_kick;
mod stability_lists;
mod static_history;
mod time;
mod time_run_up;
mod time_sweep;
mod time_verify;
mod version_and_errors;
mod wheel_blade_modes;
mod wheel_identify;
mod wheel_peaks;

pub use band::*;
pub use band_curves::*;
pub use batch::*;
pub use caller_laws::*;
pub use caller_laws_check::*;
pub use campbell_response::*;
pub use complex_sensitivities::*;
pub use contacts::*;
pub use contacts_batch::*;
pub use contacts_damper::*;
pub use contacts_described::*;
pub use contacts_patch::*;
pub use contacts_springs::*;
pub use cyclic::*;
pub use cyclic_aero::*;
pub use cyclic_faces::*;
pub use cyclic_wheel::*;
pub use fit::*;
pub use fit_data::*;
pub use fit_profile::*;
pub use life::*;
pub use low_level::*;
pub use matrices::*;
pub use mode_bands::*;
pub use model::*;
pub use model_contents::*;
pub use model_damping::*;
pub use model_rotation::*;
pub use model_saved::*;
pub use modes::*;
pub use modes_damped::*;
pub use modes_interference::*;
pub use modes_linear::*;
pub use modes_results::*;
pub use modes_synthesis::*;
pub use parameter_optima::*;
pub use parameter_responses::*;
pub use results::*;
pub use results_contacts::*;
pub use results_energy::*;
pub use results_reduction::*;
pub use results_responses::*;
pub use results_special_points::*;
pub use sensitivities::*;
pub use solutions::*;
pub use solve::*;
pub use solve_hooks::*;
pub use solve_options::*;
pub use solve_responses::*;
pub use stability::*;
pub use stability_kick::*;
pub use stability_lists::*;
pub use static_history::*;
pub use time::*;
pub use time_run_up::*;
pub use time_sweep::*;
pub use time_verify::*;
pub use version_and_errors::*;
pub use wheel_blade_modes::*;
pub use wheel_identify::*;
pub use wheel_peaks::*;
