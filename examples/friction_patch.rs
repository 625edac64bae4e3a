//! A beam on a patch of friction contacts in three directions: slip, lift-off, and where work is lost.
//!
//! A small clamped steel beam of bricks is pressed on a soft friction lining under its free end and shaken
//! across, a little upwards too, through its first bending resonance. Across, friction holds the beam at
//! small forces and loses its grip at large ones; upwards, the lining only pushes, and the resonance that
//! lift-off softens leans far into the range and folds back. `cargo run --release --example
//! friction_patch` computes its response to several forces, between the linear limits of a lining that
//! sticks and one that only carries, and at the resonance what every contact of the patch does. CSV, SVG
//! and PNG go to target/friction_patch/. Exit status: 0 done, 1 a computation or a file failed.

use std::path::PathBuf;
use std::process::ExitCode;

#[path = "friction_patch/beam.rs"]
mod beam;
#[path = "friction_patch/brick.rs"]
mod brick;
#[path = "support/csv.rs"]
mod csv;
#[path = "friction_patch/figures.rs"]
mod figures;
#[path = "support/json.rs"]
mod json;
#[path = "friction_patch/maps.rs"]
mod maps;
#[path = "support/plot.rs"]
mod plot;
#[path = "support/progress.rs"]
mod progress;
#[path = "support/response.rs"]
mod response;

fn main() -> ExitCode {
    // Cargo tells a program that it runs where its package lies; elsewhere the current folder has to do.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    match figures::run(&root.join("target/friction_patch"), &mut std::io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("friction_patch: {error}");
            ExitCode::FAILURE
        }
    }
}
