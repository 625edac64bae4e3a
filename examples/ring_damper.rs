//! A bladed disk with a friction ring damper, after the paper "Nonlinear Vibrational Analysis for
//! Integrally Bladed Disk Using Frictional Ring Damper".
//!
//! `cargo run --release --example ring_damper` draws the paper's figures 4 to 7; with flags
//! (`-- --help` lists them) it computes one response. Exit status: 0 done, 1 a computation or a
//! file failed, 2 the flags are wrong; in the last two cases no JSON file is written.

use std::io::Write;
use std::process::ExitCode;

use flags::Flags;
use progress::write_stderr;
use single::Request;

#[path = "support/csv.rs"]
mod csv;
#[path = "ring_damper/figures.rs"]
mod figures;
#[path = "support/flags.rs"]
mod flags;
#[path = "support/json.rs"]
mod json;
#[path = "ring_damper/model.rs"]
mod model;
#[path = "support/plot.rs"]
mod plot;
#[path = "support/progress.rs"]
mod progress;
#[path = "support/response.rs"]
mod response;
#[path = "ring_damper/single.rs"]
mod single;

fn main() -> ExitCode {
    let flags = match Flags::read(std::env::args_os().skip(1), &single::FLAGS) {
        Ok(flags) => flags,
        Err(message) => return refuse(&message),
    };
    let done = if flags.is_empty() {
        figures::run()
    } else if flags.has("--help") {
        std::io::stdout()
            .write_all(single::help().as_bytes())
            .map_err(Into::into)
    } else {
        match Request::new(&flags) {
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

fn refuse(message: &str) -> ExitCode {
    write_stderr(&format!("ring_damper: {message}\n(--help lists the flags)\n"));
    ExitCode::from(2)
}
