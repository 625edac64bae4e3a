//! The command `hbvib`: analyses from a job file.
//!
//! ```text
//! hbvib run job.toml     solves and writes what the job names
//! hbvib check job.toml   reads the job and its files, builds the model, and reports on it
//! hbvib modes job.toml   natural frequencies, with free and with stuck contacts
//! hbvib --help           all verbs, with examples
//! ```

mod arguments;
mod at_speeds;
mod band_curve;
mod basis_motions;
mod build;
mod built;
mod calculix_results;
mod calculix_run;
mod campbell;
mod canvas;
mod ccx_deck;
mod check;
mod contact_figures;
mod contact_guess;
mod contact_tables;
mod contacts;
mod convert;
mod counted;
mod craig_bampton;
mod curve;
mod dampers;
mod decay;
mod demo;
mod end;
mod entries;
mod events;
mod expected;
mod face_images;
mod faces;
mod figure;
mod files;
mod fit_files;
mod fit_run;
mod fit_table;
mod frd;
mod free_interface;
mod html_report;
mod incomplete_bands;
mod init;
mod init_job;
mod inp_cards;
mod job;
mod job_damper;
mod job_faces;
mod job_fit;
mod job_life;
mod job_motion;
mod job_passages;
mod job_residual;
mod job_response;
mod job_solutions;
mod job_static;
mod job_studies;
mod job_surfaces;
mod job_words;
mod kicks;
mod life;
mod line_chart;
mod manual;
mod map;
mod mesh;
mod mesh_elements;
mod mesh_picture;
mod modal_coordinates;
mod mode_band;
mod model_report;
mod modes_table;
mod motion_files;
mod nearest_name;
mod netcdf;
mod netcdf_response;
mod node_match;
mod node_motion;
mod node_table;
mod normals;
mod npz;
mod outcome;
mod output;
mod passages;
mod pencil;
mod plot;
mod points;
mod positions;
mod prestress;
mod prestress_decks;
mod progress;
mod reduce;
mod reduced_basis;
mod residual_state;
mod responses;
mod restart;
mod run_job;
mod solutions;
mod solver;
mod static_contacts;
mod static_states;
mod stored_response;
mod study;
mod surface_pairs;
mod tornado;
mod uff;
mod varied;
mod verification;
mod vtu;
mod vtu_series;
mod wheel_patterns;
mod wheel_response;

use arguments::{Arguments, LogForm, Verb};
use clap::Parser;
use clap::error::ErrorKind;
use end::FAILED;
use job::Job;
use outcome::Outcome;
use serde_json::json;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

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
