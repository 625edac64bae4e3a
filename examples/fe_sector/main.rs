//! A real finite-element sector: matrices in, response out.
//!
//! A bladed disk with a friction ring under its rim, one of 24 sectors meshed and assembled by a
//! finite-element program, with 30 pairs of nodes in contact. Without arguments the program shows
//! natural frequencies, forced responses and where the contact slips; with flags it computes one
//! response. `--help` lists them.
//!
//! [`sector`] says how the program's convention for the wave is turned into the library's.

#[path = "../support/csv.rs"]
mod csv;
#[path = "../support/flags.rs"]
mod flags;
#[path = "../support/json.rs"]
mod json;
#[path = "../support/matrix_market.rs"]
mod matrix_market;
#[path = "../support/plot.rs"]
mod plot;
#[path = "../support/progress.rs"]
mod progress;
#[path = "../support/response.rs"]
mod response;
#[path = "../support/table.rs"]
mod table;

mod cost;
mod figures;
mod sector;
mod single;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use flags::Flags;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    // Cargo tells a program that it runs where its package lies; elsewhere the current folder has to do.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    let data = root.join("examples/data/fe");
    let flags = Flags::read(std::env::args_os().skip(1), &single::FLAGS)?;
    let mut screen = std::io::stdout().lock();
    if flags.has("--help") {
        use std::io::Write;
        return Ok(write!(screen, "{}", single::help())?);
    }
    if flags.is_empty() {
        return figures::run(&data, &root.join("target/fe_sector"), &mut screen);
    }
    single::Request::new(&flags, &data)?.run(&mut screen)
}
