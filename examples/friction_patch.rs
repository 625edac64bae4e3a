//! A beam on a patch of friction contacts in three directions: slip, lift-off, and the places where work is
//! dissipated.
//!
//! A small clamped steel beam of bricks is pressed on a soft friction lining under its free end. A harmonic force
//! across the beam, with a small share upwards, excites its first bending resonance. Across, the contacts stick at
//! small forces and slip at large ones; upwards, the lining transmits compression only, and the resonance that
//! lift-off softens bends far into the range and folds back. `cargo run --release --example friction_patch`
//! computes its response to several forces, between the linear limits of a sticking and of a frictionless lining,
//! and the state of every contact of the patch at the resonance. CSV, SVG and PNG go to target/friction_patch/.
//! Exit status: 0 done, 1 a computation or a file failed.

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
#[path = "support/stability.rs"]
mod stability;

fn main() -> ExitCode {
    // Cargo sets this variable for a program that it runs; without it the current folder serves.
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
