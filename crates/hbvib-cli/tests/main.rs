//! The command as its users call it: jobs, mistakes, and what it writes. One crate, so that it is linked once.

mod arguments;
mod bands;
mod calculix;
mod campbell;
mod command;
mod command_licences;
mod common;
mod contact_outputs;
mod decimal_comma;
mod demo;
mod doubtful_jobs;
mod example_programs;
mod first_job;
mod fits;
mod free_interfaces;
mod html_reports;
mod lossy_matrices;
mod lost_runs;
mod map_and_tornado;
mod modal_coordinates;
mod model_reports;
mod motion_outputs;
mod mutations;
mod node_lists;
mod passages;
mod plots;
mod prestressed_models;
mod projected_faces;
mod reductions;
mod residual_states;
mod response_tables;
mod restarted_runs;
mod rotation;
mod schema;
mod solutions;
mod stability;
mod study;
mod surface_pairs;
mod verify;

#[path = "../../hbvib-io/tests/meshes/brick.rs"]
mod brick;
#[path = "../../../tests/common/decimal_comma.rs"]
mod comma_locale;
mod wheels;
