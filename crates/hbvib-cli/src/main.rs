//! The command `hbvib`: analyses from a job file.
//!
//! ```text
//! hbvib run job.toml     solves and writes what the job names
//! hbvib check job.toml   reads the job and its files, builds the model, and reports on it
//! hbvib modes job.toml   natural frequencies, with free and with stuck contacts
//! hbvib --help           all verbs, with examples
//! ```

pub(crate) mod building;
pub(crate) mod job_file;
pub(crate) mod meshes;
pub(crate) mod outputs;
pub(crate) mod reduction;
mod run_job;
pub(crate) mod static_steps;
pub(crate) mod studies;
pub(crate) mod texts;

use building::check;
use clap::Parser;
use clap::error::ErrorKind;
use job_file::job::Job;
use outputs::modes_table;
use outputs::plot;
use reduction::reduce;
use serde_json::json;
use static_steps::prestress;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;
use texts::arguments;
use texts::arguments::{Arguments, LogForm, Verb};
use texts::convert;
use texts::demo;
use texts::end::FAILED;
use texts::events;
use texts::init;
use texts::manual;
use texts::outcome::Outcome;

fn main() -> ExitCode {
    let words = arguments::words(std::env::args_os());
    let arguments = match Arguments::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(e) => return ExitCode::from(refused(&e, &words)),
    };
    events::start(arguments.log);
    events::line("start", json!({ "version": env!("CARGO_PKG_VERSION") }));
    let code = done(&arguments.verb).unwrap_or_else(|sentence| {
        events::error(&sentence);
        FAILED
    });
    events::line("end", json!({ "exit_code": code }));
    ExitCode::from(code)
}

/// Does what the arguments say; returns the exit code.
fn done(verb: &Verb) -> Outcome<u8> {
    match verb {
        Verb::Demo { folder, open } => demo::demo(folder, *open),
        Verb::Run(of) => run_job::run(&of.job, of.strict),
        Verb::Fit(of) => run_job::fit(&of.job, of.strict),
        Verb::Check { of, json } => check::check(&of.job, of.strict, *json),
        Verb::Modes(of) => modes_table::modes(&of.job, of.strict),
        Verb::Init(of) => init::init(of),
        Verb::Convert(of) => convert::convert(of),
        Verb::Reduce(of) => reduce::reduce(of),
        Verb::Prestress(of) => prestress::prestress(of),
        Verb::Plot(of) => plot::plot(of),
        Verb::Schema => schema(),
        Verb::Completions { shell } => print(&manual::completions(*shell)).map(|()| 0),
        Verb::Man => print(&manual::page()?).map(|()| 0),
    }
}

/// Prints help and version on standard output, mistakes on standard error; returns the exit code.
fn refused(error: &clap::Error, words: &[OsString]) -> u8 {
    let text = error.render().to_string();
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        return print(&text).map_or(FAILED, |()| 0);
    }
    let in_json = words.windows(2).any(|two| two[0] == "--log" && two[1] == "json")
        || words.iter().any(|word| word == "--log=json");
    events::start(if in_json { LogForm::Json } else { LogForm::Text });
    let text = text
        .strip_prefix("error: ")
        .unwrap_or(&text)
        .replace("Usage:", "usage:");
    events::error(text.trim_end());
    events::line("end", json!({ "exit_code": FAILED }));
    FAILED
}

fn print(text: &str) -> Outcome<()> {
    match std::io::stdout().write_all(text.as_bytes()) {
        // The reader, as head, has enough.
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome.map_err(|e| format!("standard output: {e}")),
    }
}

/// The JSON schema of a job, from the same structs that read one.
fn schema() -> Outcome<u8> {
    let schema = serde_json::to_string_pretty(&schemars::schema_for!(Job)).map_err(|e| e.to_string())?;
    print(&format!("{schema}\n"))?;
    Ok(0)
}
