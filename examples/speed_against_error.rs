//! Time of a whole response against its true error: harmonics fixed or from a tolerance, events exact or sampled.
//!
//! Five structures are followed over a range of frequency in some twenty ways each. The error of a way is the largest
//! relative error of the complex fundamental of the response degree of freedom at frequencies that all ways have in
//! common, against converged harmonic balance; of ways that choose their harmonics some of the branch's own points are
//! compared, too. Times are minima over sweeps that alternate between the ways in one run, without the estimates that
//! only serve the comparison: read them as ratios. Folds are left out: there the error at a fixed frequency is infinite.
//!
//! `cargo run --release --example speed_against_error` does all, letters after `--` some of the systems. Tables go to the
//! screen, CSV, SVG and PNG to target/speed_against_error/. Exit status: 0 done, 1 a computation or a file failed.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use measure::Way;
use systems::{SAMPLES, System};
use tables::{Done, Measured};
use truth::Truth;

#[path = "support/csv.rs"]
mod csv;
#[path = "speed_against_error/figures.rs"]
mod figures;
#[path = "speed_against_error/front.rs"]
mod front;
#[path = "speed_against_error/measure.rs"]
mod measure;
#[path = "ring_damper/model.rs"]
#[allow(dead_code, reason = "the response alone is needed here")]
mod model;
#[path = "support/plot.rs"]
mod plot;
#[path = "speed_against_error/systems.rs"]
mod systems;
#[path = "speed_against_error/tables.rs"]
mod tables;
#[path = "speed_against_error/truth.rs"]
mod truth;

/// Harmonics that a tolerance begins with, the library's own default.
const FIRST: usize = 9;

fn ways(system: &System) -> Vec<Way> {
    let way = |harmonics, samples, tolerance| Way {
        harmonics,
        samples,
        tolerance,
    };
    let fixed = system.fixed.iter().map(|&h| way(h, 0, 0.0));
    let sampled = system.sampled.iter().flat_map(|&h| SAMPLES.map(|n| way(h, n, 0.0)));
    // With fewer, forces in harmonics above 3H alias onto those that are solved for.
    let sampled = sampled.filter(|w| w.samples >= 4 * w.harmonics);
    let automatic = system.tolerances.iter().map(|&t| way(FIRST, 0, t));
    fixed.chain(sampled).chain(automatic).collect()
}

fn run() -> Done {
    // Cargo tells a program that it runs where its package lies; elsewhere the current folder has to do.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let folder = root.join("target/speed_against_error");
    let wanted: String = std::env::args().skip(1).collect();
    let mut screen = std::io::stdout().lock();
    let mut all = Vec::new();
    for system in systems::all()? {
        if !wanted.is_empty() && !wanted.contains(system.key) {
            continue;
        }
        let truth = Truth::new(&system)?;
        let outcomes = measure::all(&system, &ways(&system), &truth)?;
        let measured = Measured {
            system,
            truth,
            outcomes,
        };
        measured.show(&mut screen)?;
        screen.flush()?;
        figures::draw(&measured, &folder)?;
        all.push(measured);
    }
    tables::write(&all, &folder)?;
    writeln!(screen, "\nCSV, SVG and PNG are in {}", folder.display())?;
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("speed_against_error: {error}");
            ExitCode::FAILURE
        }
    }
}
