//! A bladed disk with a friction ring damper, after the paper "Nonlinear Vibrational Analysis for
//! Integrally Bladed Disk Using Frictional Ring Damper".
//!
//! `cargo run --release --example ring_damper` draws the paper's figures 4 to 9; with flags (`-- --help` lists
//! them) it computes one response, with `--mode` one nonlinear mode, or with `--study` the best damper. Exit status: 0
//! done, 1 a computation or a file failed, 2 the flags are wrong; in the last two cases no JSON file is written.

use std::io::Write;
use std::process::ExitCode;

use flags::{Flag, Flags};
use progress::write_stderr;

#[path = "ring_damper/backbone.rs"]
mod backbone;
#[path = "support/csv.rs"]
mod csv;
#[path = "ring_damper/figures.rs"]
mod figures;
#[path = "support/flags.rs"]
mod flags;
#[path = "support/json.rs"]
mod json;
#[path = "ring_damper/mode.rs"]
mod mode;
#[path = "ring_damper/model.rs"]
mod model;
#[path = "ring_damper/modes.rs"]
mod modes;
#[path = "support/plot.rs"]
mod plot;
#[path = "support/progress.rs"]
mod progress;
#[path = "support/response.rs"]
mod response;
#[path = "ring_damper/single.rs"]
mod single;
#[path = "support/stability.rs"]
mod stability;
#[path = "ring_damper/study.rs"]
mod study;

/// The flags that a response and a mode have in common.
const COMMON: [Flag; 10] = [
    Flag::new("--ring-mass", "kg", "mass of the ring per sector (0.03)"),
    Flag::new(
        "--rpm",
        "n",
        "speed that sets the normal load, may be fractional (3000)",
    ),
    Flag::new("--kt", "N/m", "tangential stiffness of the contact (5e7)"),
    Flag::new(
        "--beta",
        "s",
        "damping C = beta K, without the contact (1.5e-6; 0 with --mode)",
    ),
    Flag::new("--harmonics", "H", "highest harmonic number (9)"),
    Flag::new(
        "--tolerance",
        "e",
        "choose the harmonics of each point so that the relative error stays below e",
    ),
    Flag::new(
        "--max-harmonics",
        "H",
        "highest harmonic number that --tolerance may choose (511)",
    ),
    Flag::new(
        "--samples",
        "N",
        "samples per period (without: exact stick-slip events)",
    ),
    Flag::new("--json", "FILE", "write the result to this file"),
    Flag::new("--help", "", "show this text"),
];

fn main() -> ExitCode {
    let known = [&COMMON[..], &single::FLAGS, &mode::FLAGS, &study::FLAGS].concat();
    let flags = match Flags::read(std::env::args_os().skip(1), &known) {
        Ok(flags) => flags,
        Err(message) => return refuse(&message),
    };
    let done = if flags.is_empty() {
        figures::run()
    } else if flags.has("--help") {
        std::io::stdout().write_all(help().as_bytes()).map_err(Into::into)
    } else if flags.first_of(&study::FLAGS).is_some() {
        match study::Request::new(&flags) {
            Ok(request) => request.run(),
            Err(message) => return refuse(&message),
        }
    } else if flags.has("--mode") {
        match mode::Request::new(&flags) {
            Ok(request) => request.run(),
            Err(message) => return refuse(&message),
        }
    } else {
        match single::Request::new(&flags) {
            Ok(request) => request.run(),
            Err(message) => return refuse(&message),
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            write_stderr(&format!("ring_damper: {error}\n"));
            ExitCode::FAILURE
        }
    }
}

fn help() -> String {
    format!(
        "HarmonicBalance response and nonlinear modes of a bladed disk with a friction ring damper.\n\n\
         Without flags: figures 4 to 9 of the paper, as CSV, SVG and PNG under target/ring_damper/.\n\
         With flags: one response, with --mode one nonlinear mode, or with --study the best damper; what is not given\n\
         has the value in brackets.\n\n\
         {}\nOf a response only:\n{}\nOf a nonlinear mode only:\n{}\n{}\nOf a study only:\n{}",
        flags::table(&COMMON),
        flags::table(&single::FLAGS),
        flags::table(&mode::FLAGS),
        mode::NOTE,
        flags::table(&study::FLAGS)
    )
}

fn refuse(message: &str) -> ExitCode {
    write_stderr(&format!("ring_damper: {message}\n(--help lists the flags)\n"));
    ExitCode::from(2)
}
