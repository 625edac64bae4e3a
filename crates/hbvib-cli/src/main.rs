//! The command `hbvib`: analyses from a job file.
//!
//! ```text
//! hbvib run job.toml     solves and writes what the job names
//! hbvib check job.toml   reads the job and its files, and builds the model
//! hbvib modes job.toml   natural frequencies, with free and with stuck contacts
//! hbvib schema           the JSON schema of a job
//! ```

mod build;
mod campbell;
mod canvas;
mod contact_figures;
mod contact_tables;
mod contacts;
mod counted;
mod faces;
mod figure;
mod job;
mod job_studies;
mod map;
mod mesh;
mod nearest_name;
mod node_match;
mod node_table;
mod npz;
mod output;
mod points;
mod progress;
mod solver;
mod study;
mod tornado;
mod varied;
mod verification;

use build::{Built, Outcome};
use counted::counted;
use hbvib::{
    Branch, ContactState, ForcedOptions, Hooks, ModeChoice, ModeOptions, Model, Progress, SolverOptions, Status, Waves,
    forced_response, nonlinear_mode,
};
use job::{ForcedPart, Job, ModePart, VerifyPart, WavesName};
use progress::Bar;
use signal_hook::consts::SIGINT;
use solver::solver;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

const USAGE: &str = "usage: hbvib run|check|modes job.toml, or hbvib schema";

/// Exit code of a run that was stopped early and kept its points.
const STOPPED: u8 = 2;

/// Exit code of a run one of whose points is another solution than integration in time finds.
const DIFFERENT: u8 = 3;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let outcome = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["run", path] => run(Path::new(path)),
        ["check", path] => check(Path::new(path)),
        ["modes", path] => modes(Path::new(path)),
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

fn check(path: &Path) -> Outcome<ExitCode> {
    let job = Job::read(path)?;
    let built = build::built(&job)?;
    if let Some(part) = &job.study {
        study::check(part, &built)?;
    }
    if let Some(part) = &job.map {
        map::check(part, &built)?;
    }
    if let Some(part) = &job.tornado {
        tornado::check(part, &built)?;
    }
    let model = &built.model;
    let structure = model.structure();
    let mut parts = vec![counted(model.ndof(), "degree of freedom")];
    if structure.sectors() > 1 {
        parts.push(counted(structure.sectors(), "sector"));
        parts.push(format!("engine order {}", structure.engine_order()));
    }
    parts.push(counted(model.contacts().len(), "contact"));
    parts.push(counted(model.excitation().forces().len(), "force"));
    print(&format!("{}: {}\n", path.display(), parts.join(", ")))?;
    Ok(ExitCode::SUCCESS)
}

/// Number of natural frequencies that are listed.
const LISTED: usize = 10;

fn modes(path: &Path) -> Outcome<ExitCode> {
    let job = Job::read(path)?;
    let model = build::built(&job)?.model;
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

fn run(path: &Path) -> Outcome<ExitCode> {
    let job = Job::read(path)?;
    let built = build::built(&job)?;
    let (model, names) = (&built.model, &built.names);
    let stop = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(SIGINT, Arc::clone(&stop)).map_err(|e| format!("Ctrl-C: {e}"))?;
    if !over_quantities(&job, &built, &stop)? {
        let _ = writeln!(std::io::stderr(), "hbvib: the run ended early");
        return Ok(ExitCode::from(STOPPED));
    }
    if job.forced.is_none() && job.mode.is_none() {
        return Ok(ExitCode::SUCCESS);
    }
    let branch = solve(&job, &built, &stop)?;
    let mut written = output::write(&job, &branch)?;
    written.extend(contact_tables::write(&job, &branch, names)?);
    print(&output::summary(&branch))?;
    told("", &written)?;
    if branch.status() == Status::Ok {
        return match &job.verify {
            Some(part) => verified(&job, part, (model, &branch), &stop),
            None => Ok(ExitCode::SUCCESS),
        };
    }
    if let Some(part) = job.verify.as_ref().filter(|_| !stop.load(Ordering::Relaxed)) {
        verified(&job, part, (model, &branch), &stop)?;
    }
    let reason = branch.reason().map_or(String::new(), |e| format!(": {e}"));
    let _ = writeln!(
        std::io::stderr(),
        "hbvib: the run ended early, {:?}{reason}",
        branch.status()
    );
    Ok(ExitCode::from(STOPPED))
}

/// Diagrams, curves, maps and tornados; false where one was stopped early.
fn over_quantities(job: &Job, built: &Built, stop: &AtomicBool) -> Outcome<bool> {
    let model = &built.model;
    let cancelled = || stop.load(Ordering::Relaxed);
    let hooks = || Hooks {
        cancelled: Some(&cancelled),
        ..Hooks::default()
    };
    if let Some(part) = &job.campbell {
        let (text, files) = campbell::write(job, part, model, &mut hooks())?;
        told(&text, &files)?;
    }
    if let Some(part) = &job.study {
        let (text, files) = study::write(job, part, built, &mut hooks())?;
        told(&text, &files)?;
    }
    let mut complete = true;
    if let Some(part) = &job.map {
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
        let (text, files, stopped) = map::write(job, part, built, &mut hooks)?;
        complete &= !stopped;
        told(&text, &files)?;
    }
    if let Some(part) = job.tornado.as_ref().filter(|_| complete) {
        let (text, files, stopped) = tornado::write(job, part, built, &mut hooks())?;
        complete &= !stopped;
        told(&text, &files)?;
    }
    Ok(complete)
}

/// Prints a summary and the names of files.
fn told(text: &str, files: &[PathBuf]) -> Outcome<()> {
    print(text)?;
    for path in files {
        print(&format!("wrote {}\n", path.display()))?;
    }
    Ok(())
}

/// Compares points with integration in time, and returns the code of the run.
fn verified(job: &Job, part: &VerifyPart, (model, branch): (&Model, &Branch), stop: &AtomicBool) -> Outcome<ExitCode> {
    let cancelled = || stop.load(Ordering::Relaxed);
    let mut hooks = Hooks {
        cancelled: Some(&cancelled),
        ..Hooks::default()
    };
    let all = verification::compare(part, model, branch, &mut hooks)?;
    print(&verification::summary(&all.compared))?;
    print(&verification::write(job, part, &all.compared)?)?;
    if !all.complete {
        let _ = writeln!(std::io::stderr(), "hbvib: the verification ended early");
        return Ok(ExitCode::from(STOPPED));
    }
    let same = all.compared.iter().all(|(_, found)| found.same);
    Ok(if same {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(DIFFERENT)
    })
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
        (Some(part), _) => forced(part, built, &mut hooks),
        (None, Some(part)) => mode(part, built, &mut hooks),
        (None, None) => Err("names no analysis".into()),
    }
}

fn forced(part: &ForcedPart, built: &Built, hooks: &mut Hooks<'_>) -> Outcome<Branch> {
    let at: Vec<f64> = part.at_hz.iter().map(|f| TAU * f).collect();
    let range = ForcedOptions {
        omega_start: TAU * part.from_hz,
        omega_stop: TAU * part.to_hz,
        at: &at,
        guess: None,
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
