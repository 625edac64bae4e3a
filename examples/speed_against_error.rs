//! Time of a whole response against its true error: harmonics fixed or from a tolerance, events exact or sampled.
//!
//! The responses of eight structures over a range of frequency are computed in about twenty ways each. The error of
//! a way is the largest relative error of the complex fundamental of the response degree of freedom at frequencies
//! that all ways have in common, compared with converged harmonic balance; for ways that choose their harmonics
//! some points of the branch itself are compared, too. Times are CPU times, minima over sweeps that alternate between the
//! ways in one run, without the estimates that only serve the comparison, and told as multiples of a small factorisation:
//! read them as ratios. Folds are excluded: there the error at a fixed frequency is infinite. A nonlinear mode and
//! integration in time follow.
//!
//! `cargo run --release --example speed_against_error` computes all systems, letters after `--` select some of
//! them. Tables go to the screen, CSV, SVG and PNG to target/speed_against_error/. Exit status: 0 done, 1 a
//! computation or a file failed, 2 an argument is unknown; nothing is computed then.

use std::ffi::OsString;
use std::fmt::Display;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use cpu_time::lu11_seconds;
use measure::Way;
use memory::peak_memory;
use systems::{SAMPLES, System};
use tables::{Done, Measured};
use truth::Truth;

#[path = "support/cpu_time.rs"]
mod cpu_time;
#[path = "support/csv.rs"]
mod csv;
#[path = "speed_against_error/figures.rs"]
mod figures;
#[path = "speed_against_error/front.rs"]
mod front;
#[path = "support/matrix_market.rs"]
mod matrix_market;
#[path = "speed_against_error/measure.rs"]
mod measure;
#[path = "support/memory.rs"]
mod memory;
#[path = "ring_damper/model.rs"]
#[allow(dead_code, reason = "only the response is used here")]
mod model;
#[path = "speed_against_error/others.rs"]
mod others;
#[path = "support/plot.rs"]
mod plot;
#[path = "fe_sector/sector.rs"]
mod sector;
#[path = "speed_against_error/systems.rs"]
mod systems;
#[path = "support/table.rs"]
mod table;
#[path = "speed_against_error/tables.rs"]
mod tables;
#[path = "speed_against_error/truth.rs"]
mod truth;

/// Initial harmonics where a tolerance chooses, the default of the library.
const FIRST: usize = 9;

fn ways(system: &System) -> Vec<Way> {
    let way = |harmonics, samples, tolerance| Way {
        harmonics,
        samples,
        tolerance,
    };
    let fixed = system.fixed.iter().map(|&h| way(h, 0, 0.0));
    let sampled = system.sampled.iter().flat_map(|&h| SAMPLES.map(|n| way(h, n, 0.0)));
    // With fewer samples, forces in harmonics above 3H alias onto the carried ones.
    let sampled = sampled.filter(|w| w.samples >= 4 * w.harmonics);
    let automatic = system.tolerances.iter().map(|&t| way(FIRST, 0, t));
    fixed.chain(sampled).chain(automatic).collect()
}

/// The letters of the arguments, each that of a system.
///
/// # Errors
///
/// A sentence naming the argument that is none.
fn selected(systems: &[System], arguments: impl IntoIterator<Item = OsString>) -> Result<String, String> {
    let mut letters = String::new();
    for argument in arguments {
        let known = |text: &str| text.chars().all(|c| systems.iter().any(|system| system.key == c));
        let Some(text) = argument.to_str().filter(|text| !text.is_empty() && known(text)) else {
            let keys: String = systems.iter().map(|system| system.key).collect();
            let argument = argument.display();
            return Err(format!("unknown argument {argument}; letters of {keys} select systems"));
        };
        letters.push_str(text);
    }
    Ok(letters)
}

fn run(systems: Vec<System>, selected: &str, folder: &Path) -> Done {
    let mut screen = std::io::stdout().lock();
    let mut all = Vec::new();
    for system in systems {
        if !selected.is_empty() && !selected.contains(system.key) {
            continue;
        }
        let truth = Truth::new(&system)?;
        let before = lu11_seconds();
        let outcomes = measure::all(&system, &ways(&system), &truth)?;
        let measured = Measured {
            system,
            truth,
            outcomes,
            units: [before, lu11_seconds()],
            memory: peak_memory(),
        };
        measured.show(&mut screen)?;
        screen.flush()?;
        figures::draw(&measured, folder)?;
        all.push(measured);
    }
    if selected.is_empty() {
        others::show(&mut screen)?;
    }
    tables::write(&all, folder)?;
    writeln!(screen, "\nCSV, SVG and PNG are in {}", folder.display())?;
    Ok(())
}

fn main() -> ExitCode {
    let failed = |error: &dyn Display| eprintln!("speed_against_error: {error}");
    // Cargo sets this variable for a program that it runs; without it the current folder serves.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let systems = match systems::all(&root.join("examples/data/fe")) {
        Ok(systems) => systems,
        Err(error) => {
            failed(&error);
            return ExitCode::FAILURE;
        }
    };
    let selected = match selected(&systems, std::env::args_os().skip(1)) {
        Ok(selected) => selected,
        Err(message) => {
            failed(&message);
            return ExitCode::from(2);
        }
    };
    match run(systems, &selected, &root.join("target/speed_against_error")) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            failed(&error);
            ExitCode::FAILURE
        }
    }
}
