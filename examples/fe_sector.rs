//! A real finite-element sector: matrices in, response out.
//!
//! A bladed disk with a friction ring under its rim, one of 24 sectors meshed and assembled by a finite-element
//! program, with 30 pairs of nodes in contact. [`sector`] describes how the sign convention of that program for the
//! wave is converted into that of the library.
//!
//! `cargo run --release --example fe_sector` computes natural frequencies, forced responses and maps
//! of the slip in the contact; with flags (`-- --help` lists them) it computes one response. Exit
//! status: 0 done, 1 a computation or a file failed, 2 the flags are wrong; in the last two cases no
//! JSON file is written.

use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use flags::Flags;
use single::Request;

#[path = "fe_sector/cost.rs"]
mod cost;
#[path = "support/csv.rs"]
mod csv;
#[path = "fe_sector/figures.rs"]
mod figures;
#[path = "support/flags.rs"]
mod flags;
#[path = "support/json.rs"]
mod json;
#[path = "support/matrix_market.rs"]
mod matrix_market;
#[path = "support/memory.rs"]
mod memory;
#[path = "support/plot.rs"]
mod plot;
#[path = "support/progress.rs"]
mod progress;
#[path = "support/response.rs"]
mod response;
#[path = "fe_sector/sector.rs"]
mod sector;
#[path = "fe_sector/single.rs"]
mod single;
#[path = "support/stability.rs"]
mod stability;
#[path = "support/table.rs"]
mod table;

fn main() -> ExitCode {
    let flags = match Flags::read(std::env::args_os().skip(1), &single::FLAGS) {
        Ok(flags) => flags,
        Err(message) => return refuse(&message),
    };
    // Cargo sets this variable for a program that it runs; without it the current folder serves.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let data = root.join("examples/data/fe");
    let mut screen = std::io::stdout().lock();
    let done = if flags.is_empty() {
        figures::run(&data, &root.join("target/fe_sector"), &mut screen)
    } else if flags.has("--help") {
        screen.write_all(single::help().as_bytes()).map_err(Into::into)
    } else {
        match Request::new(&flags, &data) {
            Ok(request) => request.run(&mut screen),
            Err(message) => return refuse(&message),
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("fe_sector: {error}");
            ExitCode::FAILURE
        }
    }
}

fn refuse(message: &str) -> ExitCode {
    eprintln!("fe_sector: {message}\n(--help lists the flags)");
    ExitCode::from(2)
}
