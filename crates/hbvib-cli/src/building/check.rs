//! The command `check`: a job and its files, the model, and the report on its matrices.

use crate::building::build::built;
use crate::building::built::Built;
use crate::building::expected::near;
use crate::building::model_report::ModelReport;
use crate::job_file::job::Job;
use crate::outputs::motion_files;
use crate::print;
use crate::studies::band_curve;
use crate::studies::campbell;
use crate::studies::fit_run;
use crate::studies::kicks;
use crate::studies::life;
use crate::studies::map;
use crate::studies::mode_band;
use crate::studies::passages;
use crate::studies::residual_state;
use crate::studies::study;
use crate::studies::tornado;
use crate::studies::wheel_patterns;
use crate::studies::wheel_response;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{ContactState, Model};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// Natural frequencies that are told.
const LISTED: usize = 3;

/// Degrees of freedom up to which natural frequencies are computed for a check.
const MOST: usize = 20_000;

/// Reads and checks a job.
///
/// # Errors
/// A sentence; with `strict` also where there are warnings.
pub fn check(path: &Path, strict: bool, json: bool) -> Outcome<u8> {
    let job = Job::read(path)?;
    let mut built = built(&job)?;
    parts(&job, &built)?;
    let model = &built.model;
    let structure = model.structure();
    let mut all = vec![counted(model.ndof(), "degree of freedom")];
    if structure.sectors() > 1 {
        all.push(counted(structure.sectors(), "sector"));
        all.push(format!("engine order {}", structure.engine_order()));
    }
    all.push(counted(model.contacts().len(), "contact"));
    all.push(counted(model.excitation().forces().len(), "force"));
    let mut text = format!("{}: {}\n", path.display(), all.join(", "));
    let (facts, warnings) = frequencies(&job, model);
    built.report.facts.extend(facts);
    built.report.warnings.extend(warnings);
    if job.needs_analysis(path).is_err() {
        let fact = "the job names no analysis: run needs one, modes and check do not";
        built.report.facts.push(fact.into());
    }
    let mut report = ModelReport::of(path, &job, &built);
    built.report.facts.append(&mut report.facts);
    built.report.warnings.append(&mut report.warnings);
    for fact in &built.report.facts {
        let _ = writeln!(text, "{fact}");
    }
    for warning in &built.report.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    if json {
        report.facts.clone_from(&built.report.facts);
        report.warnings.clone_from(&built.report.warnings);
        text = serde_json::to_string_pretty(&report).map_err(|e| e.to_string())? + "\n";
    }
    print(&text)?;
    let count = built.report.warnings.len();
    if strict && count > 0 {
        return Err(format!(
            "{}: {}, which --strict refuses",
            path.display(),
            counted(count, "warning")
        ));
    }
    Ok(0)
}

/// Refuses parts of a job that cannot be computed.
///
/// # Errors
/// A sentence.
pub fn parts(job: &Job, built: &Built) -> Outcome<()> {
    motion_files::check(job, built)?;
    kicks::check(job, built)?;
    if let Some(part) = &job.campbell {
        campbell::check(part, &built.model)?;
    }
    if let Some(part) = &job.study {
        study::check(part, built)?;
    }
    if let Some(part) = &job.map {
        map::check(part, built)?;
    }
    if let Some(part) = &job.fit {
        fit_run::check(job, part, built)?;
    }
    if let Some(part) = &job.tornado {
        tornado::check(part, built)?;
    }
    if let Some(part) = &job.band {
        band_curve::check(part, built)?;
    }
    if let Some(part) = &job.residual {
        residual_state::check(job, part, built)?;
    }
    if let Some(part) = &job.mode_band {
        mode_band::check(part, built)?;
    }
    if let Some(part) = &job.wheel {
        wheel_response::check(part, built)?;
        if let Some(path) = &part.patterns {
            wheel_patterns::check(part, &job.path(path), built)?;
        }
    }
    if let Some(part) = &job.life {
        life::check(part, built)?;
    }
    if let Some(part) = &job.run_up {
        passages::check_run_up(part, built)?;
    }
    if let Some(part) = &job.mission {
        passages::check_mission(part, built)?;
    }
    Ok(())
}

/// The lowest natural frequencies without contacts: facts, and warnings for motions that grow and for another frequency than
/// expected.
fn frequencies(job: &Job, model: &Model) -> (Vec<String>, Vec<String>) {
    let (mut facts, mut warnings) = (Vec::new(), Vec::new());
    let structure = model.structure();
    if structure.ndof() > MOST {
        facts.push(format!(
            "natural frequencies: not computed above {MOST} degrees of freedom, see hbvib modes"
        ));
        return (facts, warnings);
    }
    let sectors = structure.sectors();
    let signed = structure.signed_diameter(structure.engine_order());
    let wave = if model.has_equal_senses() { signed.abs() } else { signed };
    let mut diameters = vec![wave];
    if wave != 0 {
        diameters.insert(0, 0);
    }
    for diameter in diameters {
        let of = if sectors > 1 {
            format!(" of diameter {diameter}")
        } else {
            String::new()
        };
        let modes = match model.lowest_modes(diameter, ContactState::Free, LISTED.min(structure.ndof())) {
            Ok(modes) => modes.omega,
            Err(e) => {
                warnings.push(format!("natural frequencies{of}: {e}"));
                continue;
            }
        };
        let hertz: Vec<String> = modes.iter().map(|omega| format!("{:.6}", omega / TAU)).collect();
        facts.push(format!(
            "natural frequencies{of} without contacts: {} Hz",
            hertz.join(", ")
        ));
        if modes.first().is_some_and(|omega| *omega < 0.0) {
            warnings.push(format!(
                "the stiffness{of} is negative in some direction: a motion grows as {:.6e} per second",
                -modes[0]
            ));
        }
        let expected = job.model.expected.as_ref().and_then(|part| part.first_hz);
        if let (Some(expected), Some(first), true) = (expected, modes.first(), diameter == wave) {
            let found = first / TAU;
            if !near(found, expected) {
                warnings.push(format!(
                    "the lowest natural frequency{of} is {found:.6} Hz, and {expected} Hz is expected"
                ));
            }
        }
    }
    (facts, warnings)
}
