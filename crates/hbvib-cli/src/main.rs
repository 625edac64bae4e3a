//! The command `hbvib`: analyses from a job file.
//!
//! ```text
//! hbvib run job.toml     solves and writes what the job names
//! hbvib check job.toml   reads the job and its files, builds the model, and reports on the matrices
//! hbvib modes job.toml   natural frequencies, with free and with stuck contacts
//! hbvib schema           the JSON schema of a job
//! ```
//!
//! With `--strict` warnings on the matrices are errors.

mod build;
mod campbell;
mod canvas;
mod check;
mod contact_figures;
mod contact_tables;
mod contacts;
mod counted;
mod end;
mod faces;
mod figure;
mod files;
mod job;
mod job_studies;
mod map;
mod mesh;
mod nearest_name;
mod node_match;
mod node_table;
mod normals;
mod npz;
mod output;
mod points;
mod progress;
mod responses;
mod solver;
mod study;
mod tornado;
mod varied;
mod verification;

use build::{Built, Outcome};
use end::End;
use files::Files;
use hbvib::{
    Branch, ContactState, ForcedOptions, Hooks, ModeChoice, ModeOptions, Model, Progress, SolverOptions, Status, Waves,
    forced_response, nonlinear_mode,
};
use job::{ForcedPart, Job, ModePart, VerifyPart, WavesName};
use progress::Bar;
use responses::ResponsePart;
use solver::solver;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

const USAGE: &str = "usage: hbvib run|check|modes [--strict] job.toml, or hbvib schema";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let strict = arguments.iter().any(|word| word == "--strict");
    let words: Vec<&str> = arguments
        .iter()
        .map(String::as_str)
        .filter(|word| *word != "--strict")
        .collect();
    let outcome = match words[..] {
        ["run", path] => run(Path::new(path), strict),
        ["check", path] => check::check(Path::new(path), strict),
        ["modes", path] => modes(Path::new(path), strict),
        ["schema"] => schema(),
        ["--help" | "-h"] => print(&format!("{USAGE}\n")).map(|()| ExitCode::SUCCESS),
        _ => Err(USAGE.into()),
    };
    outcome.unwrap_or_else(|sentence| {
        let _ = writeln!(std::io::stderr(), "hbvib: {sentence}");
        ExitCode::FAILURE
    })
}

fn print(text: &str) -> Outcome<()> {
    std::io::stdout()
        .write_all(text.as_bytes())
        .map_err(|e| format!("standard output: {e}"))
}

/// The JSON schema of a job, from the same structs that read one.
fn schema() -> Outcome<ExitCode> {
    let schema = serde_json::to_string_pretty(&schemars::schema_for!(Job)).map_err(|e| e.to_string())?;
    print(&format!("{schema}\n"))?;
    Ok(ExitCode::SUCCESS)
}

/// Number of natural frequencies that are listed.
const LISTED: usize = 10;

fn modes(path: &Path, strict: bool) -> Outcome<ExitCode> {
    let job = Job::read(path)?;
    let built = build::built(&job)?;
    built.warn(strict)?;
    let model = built.model;
    let mut text = String::from("diameter,mode,free_hz,stuck_hz\n");
    // A row of a diameter stands for both senses where they have the same modes.
    let least = if model.has_equal_senses() { 0 } else { i64::MIN };
    for diameter in model.structure().all_diameters().filter(|d| *d >= least) {
        let count = LISTED.min(model.structure().ndof());
        let of = |state| {
            let modes = model.lowest_modes(diameter, state, count);
            modes
                .map(|modes| modes.omega)
                .map_err(|e| format!("diameter {diameter}: {e}"))
        };
        let (free, stuck) = (of(ContactState::Free)?, of(ContactState::Stuck)?);
        for (i, (a, b)) in free.iter().zip(&stuck).enumerate() {
            let _ = writeln!(text, "{diameter},{i},{:.10e},{:.10e}", a / TAU, b / TAU);
        }
    }
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

fn run(path: &Path, strict: bool) -> Outcome<ExitCode> {
    let stop = end::stop_flag()?;
    let job = Job::read(path)?;
    let built = build::built(&job)?;
    // A mistake in one part is told before another has taken its time.
    check::parts(&job, &built)?;
    built.warn(strict)?;
    let mut files = Files::of(&job);
    let mut end = End::default();
    over_quantities(&job, &built, &stop, &mut files, &mut end);
    if (job.forced.is_some() || job.mode.is_some()) && end.goes_on(&stop) {
        let solved = solve(&job, &built, &stop);
        if let Some(branch) = end.take(solved, &stop) {
            written(&job, &built, &branch, &mut files);
            judged(&job, (&built.model, &branch), &stop, &mut files, &mut end);
        }
    }
    Ok(end.code(&files))
}

/// Writes what a branch has, points before all else.
fn written(job: &Job, built: &Built, branch: &Branch, files: &mut Files<'_>) {
    if branch.points() > 0 {
        output::write(job, branch, files);
        contact_tables::write(job, branch, &built.names, files);
    }
    files.tell(&output::summary(branch));
    files.tell(&responses::summary(branch));
}

/// Tells why a branch ended, and compares points with integration in time.
fn judged(job: &Job, (model, branch): (&Model, &Branch), stop: &AtomicBool, files: &mut Files<'_>, end: &mut End) {
    let whole = branch.status() == Status::Ok;
    if let Some(part) = job.verify.as_ref().filter(|_| whole || !stop.load(Ordering::Relaxed)) {
        let outcome = verified(part, (model, branch), stop, files, end);
        end.take(outcome, stop);
    }
    if !whole {
        let reason = branch.reason().map_or(String::new(), |e| format!(": {e}"));
        end.early(&format!("the run ended early, {:?}{reason}", branch.status()));
    }
}

/// Diagrams, curves, maps and tornados, each of its own.
fn over_quantities(job: &Job, built: &Built, stop: &AtomicBool, files: &mut Files<'_>, end: &mut End) {
    let model = &built.model;
    let cancelled = || stop.load(Ordering::Relaxed);
    let hooks = || Hooks {
        cancelled: Some(&cancelled),
        ..Hooks::default()
    };
    if let Some(part) = job.campbell.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = campbell::write(part, model, &mut hooks(), files);
        files.tell(&end.take(outcome, stop).unwrap_or_default());
    }
    if let Some(part) = job.study.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = study::write(part, built, &mut hooks(), files);
        files.tell(&end.take(outcome, stop).unwrap_or_default());
    }
    if let Some(part) = job.map.as_ref().filter(|_| end.goes_on(stop)) {
        let bar = Bar::new();
        let mut progress = |progress: &Progress| {
            bar.show(progress);
            false
        };
        let mut hooks = Hooks {
            progress: Some(&mut progress),
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        let outcome = map::write(part, built, &mut hooks, files);
        drop(bar);
        ended(outcome, "map", stop, files, end);
    }
    if let Some(part) = job.tornado.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = tornado::write(part, built, &mut hooks(), files);
        ended(outcome, "tornado", stop, files, end);
    }
}

fn ended(outcome: Outcome<map::Written>, part: &str, stop: &AtomicBool, files: &mut Files<'_>, end: &mut End) {
    let Some((text, early)) = end.take(outcome, stop) else {
        return;
    };
    files.tell(&text);
    if early {
        end.early(&format!("[{part}]: the run ended early"));
    }
}

/// Compares points with integration in time.
fn verified(
    part: &VerifyPart,
    (model, branch): (&Model, &Branch),
    stop: &AtomicBool,
    files: &mut Files<'_>,
    end: &mut End,
) -> Outcome<()> {
    let cancelled = || stop.load(Ordering::Relaxed);
    let mut hooks = Hooks {
        cancelled: Some(&cancelled),
        ..Hooks::default()
    };
    let all = verification::compare(part, (model, branch), &mut hooks, files)?;
    verification::write(part, &all.compared, files);
    files.tell(&verification::summary(&all.compared));
    if !all.complete {
        end.early("the verification ended early");
    }
    end.differs |= !all.compared.iter().all(|(_, found)| found.same);
    Ok(())
}

fn solve(job: &Job, built: &Built, stop: &AtomicBool) -> Outcome<Branch> {
    let bar = Bar::new();
    let mut progress = |progress: &Progress| {
        bar.show(progress);
        false
    };
    let cancelled = || stop.load(Ordering::Relaxed);
    let mut hooks = Hooks {
        progress: Some(&mut progress),
        cancelled: Some(&cancelled),
        ..Hooks::default()
    };
    match (&job.forced, &job.mode) {
        (Some(part), _) => forced((part, &job.response), built, &mut hooks),
        (None, Some(part)) => mode(part, built, &mut hooks),
        (None, None) => Err("names no analysis".into()),
    }
}

fn forced((part, watched): (&ForcedPart, &[ResponsePart]), built: &Built, hooks: &mut Hooks<'_>) -> Outcome<Branch> {
    let dofs = responses::dofs(watched, built)?;
    let responses = responses::responses(watched, &dofs);
    let at: Vec<f64> = part.at_hz.iter().map(|f| TAU * f).collect();
    let range = ForcedOptions {
        omega_start: TAU * part.from_hz,
        omega_stop: TAU * part.to_hz,
        at: &at,
        guess: None,
        responses: &responses,
        together: false,
    };
    let named = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built);
    let solver = SolverOptions {
        estimate_error: part.estimate_error,
        stability: part.stability.map(|waves| match waves {
            WavesName::Wave => Waves::Wave,
            WavesName::Wheel => Waves::Wheel,
        }),
        ..named.map_err(|e| format!("[forced]: {e}"))?
    };
    forced_response(&built.model, &solver, &range, hooks).map_err(|e| format!("[forced]: {e}"))
}

fn mode(part: &ModePart, built: &Built, hooks: &mut Hooks<'_>) -> Outcome<Branch> {
    let range = ModeOptions {
        choice: ModeChoice::Index(part.index),
        log10_start: part.log10_from,
        log10_stop: part.log10_to,
        ..ModeOptions::default()
    };
    let named = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built);
    let solver = SolverOptions {
        estimate_error: part.estimate_error,
        ..named.map_err(|e| format!("[mode]: {e}"))?
    };
    nonlinear_mode(&built.model, &solver, &range, hooks).map_err(|e| format!("[mode]: {e}"))
}
