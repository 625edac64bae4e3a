//! Running a job: its analyses one after the other, and what each writes.

use crate::building::build::built;
use crate::building::built::Built;
use crate::building::check;
use crate::building::responses;
use crate::building::solver::solver;
use crate::job_file::job::{ForcedPart, Job, ModePart, VerifyPart, WavesName};
use crate::job_file::job_response::ResponsePart;
use crate::job_file::job_solutions::SolutionsPart;
use crate::outputs::contact_tables;
use crate::outputs::curve::{Before, Curve};
use crate::outputs::files::Files;
use crate::outputs::html_report;
use crate::outputs::motion_files;
use crate::outputs::output;
use crate::outputs::restart::{self, Begin};
use crate::outputs::stored_response::Stored;
use crate::studies::band_curve;
use crate::studies::campbell;
use crate::studies::fit_run;
use crate::studies::kicks;
use crate::studies::life;
use crate::studies::map;
use crate::studies::mode_band;
use crate::studies::passages;
use crate::studies::residual_state;
use crate::studies::solutions;
use crate::studies::study;
use crate::studies::tornado;
use crate::studies::verification;
use crate::studies::wheel_patterns;
use crate::studies::wheel_response;
use crate::texts::end::{self, End};
use crate::texts::outcome::Outcome;
use crate::texts::progress::watched;
use hbvib::{
    Branch, ForcedOptions, Hooks, ModeChoice, ModeOptions, Model, SolverOptions, Status, Waves, forced_response,
    nonlinear_mode,
};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Runs a job; returns the exit code.
///
/// # Errors
/// A sentence where nothing was computed.
pub fn run(path: &Path, strict: bool) -> Outcome<u8> {
    let stop = end::stop_flag()?;
    let job = Job::read(path)?;
    job.needs_analysis(path)?;
    let mut built = built(&job)?;
    // A mistake in one part is told before another has taken its time.
    check::parts(&job, &built)?;
    let stored = restart::stored(&job, &built)?;
    built.warn(strict)?;
    let mut files = Files::of(&job);
    let mut end = End::default();
    residual(&job, &mut built, &stop, &mut files)?;
    over_quantities(&job, &built, &stop, &mut files, &mut end);
    if (job.forced.is_some() || job.mode.is_some()) && end.goes_on(&stop) {
        let solved = solve(&job, &built, stored, &stop);
        if let Some((branch, before)) = end.take(solved, &stop) {
            written(&job, &built, &Curve::new(&branch, before.as_ref()), &mut files);
            let text = solutions::write(&job, &branch, &mut files);
            files.tell(&text);
            let kick = job.solutions.as_ref().and_then(|part| part.kick.as_ref());
            if let Some(part) = kick.filter(|_| end.goes_on(&stop)) {
                let outcome = watched(&stop, |hooks| {
                    kicks::write((&job, part), &built, &branch, hooks, &mut files)
                });
                ended(outcome, "solutions.kick", &stop, &mut files, &mut end);
            }
            judged(&job, (&built.model, &branch), &stop, &mut files, &mut end);
        }
    }
    Ok(end.code(&files))
}

/// Runs the fit of a job alone; returns the exit code.
///
/// # Errors
/// A sentence where nothing was computed.
pub fn fit(path: &Path, strict: bool) -> Outcome<u8> {
    let stop = end::stop_flag()?;
    let job = Job::read(path)?;
    let Some(part) = &job.fit else {
        return Err(format!("{}: names no fit: needs [fit]", path.display()));
    };
    let mut built = built(&job)?;
    fit_run::check(&job, part, &built)?;
    built.warn(strict)?;
    let mut files = Files::of(&job);
    let mut end = End::default();
    residual(&job, &mut built, &stop, &mut files)?;
    fitted(&job, &built, &stop, &mut files, &mut end);
    Ok(end.code(&files))
}

/// Gives the model the state in which earlier loads have left it.
fn residual(job: &Job, built: &mut Built, stop: &AtomicBool, files: &mut Files<'_>) -> Outcome<()> {
    if let Some(part) = &job.residual {
        let text = watched(stop, |hooks| residual_state::set(job, part, built, hooks, files))?;
        files.tell(&text);
    }
    Ok(())
}

fn fitted(job: &Job, built: &Built, stop: &AtomicBool, files: &mut Files<'_>, end: &mut End) {
    if let Some(part) = job.fit.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| fit_run::write(job, part, built, hooks, files));
        ended(outcome, "fit", stop, files, end);
    }
}

/// Writes what a branch has, points before all else.
fn written(job: &Job, built: &Built, curve: &Curve<'_>, files: &mut Files<'_>) {
    if curve.points() > 0 {
        output::write(job, curve, &built.nodes, files);
        contact_tables::write(job, curve, built, files);
        motion_files::write(job, curve, built, files);
        html_report::write(job, curve, built, files);
    }
    files.tell(&output::summary(curve, &built.nodes));
    files.tell(&responses::summary(curve));
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

/// Diagrams, curves, maps, tornados and bands, each of its own.
fn over_quantities(job: &Job, built: &Built, stop: &AtomicBool, files: &mut Files<'_>, end: &mut End) {
    let model = &built.model;
    if let Some(part) = job.campbell.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| campbell::write(part, model, hooks, files));
        files.tell(&end.take(outcome, stop).unwrap_or_default());
    }
    if let Some(part) = job.study.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| study::write(part, built, hooks, files));
        files.tell(&end.take(outcome, stop).unwrap_or_default());
    }
    if let Some(part) = job.map.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| map::write(part, built, hooks, files));
        ended(outcome, "map", stop, files, end);
    }
    if let Some(part) = job.tornado.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| tornado::write(part, built, hooks, files));
        ended(outcome, "tornado", stop, files, end);
    }
    if let Some(part) = job.band.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| band_curve::write(part, built, hooks, files));
        ended(outcome, "band", stop, files, end);
    }
    if let Some(part) = job.mode_band.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| mode_band::write(part, built, hooks, files));
        ended(outcome, "mode_band", stop, files, end);
    }
    if let Some(part) = job.wheel.as_ref().filter(|_| end.goes_on(stop)) {
        if !part.pattern.is_empty() {
            let outcome = watched(stop, |hooks| wheel_response::write(part, built, hooks, files));
            ended(outcome, "wheel", stop, files, end);
        }
        if let Some(path) = part.patterns.as_ref().filter(|_| end.goes_on(stop)) {
            let path = job.path(path);
            let outcome = watched(stop, |hooks| wheel_patterns::write(part, &path, built, hooks, files));
            ended(outcome, "wheel", stop, files, end);
        }
    }
    if let Some(part) = job.life.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| life::write(part, built, hooks, files));
        ended(outcome, "life", stop, files, end);
    }
    if let Some(part) = job.run_up.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| passages::write_run_up(part, built, hooks, files));
        ended(outcome, "run_up", stop, files, end);
    }
    if let Some(part) = job.mission.as_ref().filter(|_| end.goes_on(stop)) {
        let outcome = watched(stop, |hooks| passages::write_mission(part, built, hooks, files));
        ended(outcome, "mission", stop, files, end);
    }
    fitted(job, built, stop, files, end);
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
    let all = watched(stop, |hooks| verification::compare(part, (model, branch), hooks, files))?;
    verification::write(part, &all.compared, files);
    files.tell(&verification::summary(&all.compared));
    if !all.complete {
        end.early("the verification ended early");
    }
    end.differs |= !all.compared.iter().all(|(_, found)| found.same);
    Ok(())
}

fn solve(job: &Job, built: &Built, stored: Option<Stored>, stop: &AtomicBool) -> Outcome<(Branch, Option<Before>)> {
    watched(stop, |hooks| match (&job.forced, &job.mode) {
        (Some(part), _) => {
            let parts = (part, &job.response[..], job.solutions.as_ref());
            let mut run = |begin: &Begin<'_>| forced(parts, built, begin, hooks);
            match stored {
                Some(stored) => restart::go_on(part, stored, &mut run).map(|(branch, before)| (branch, Some(before))),
                None => run(&Begin {
                    from_hz: part.from_hz,
                    at_hz: part.at_hz.clone(),
                    guess: None,
                })
                .map(|branch| (branch, None)),
            }
        }
        (None, Some(part)) => mode((part, job.solutions.as_ref()), built, hooks).map(|branch| (branch, None)),
        (None, None) => Err("names no analysis".into()),
    })
}

fn forced(
    (part, watched, sought): (&ForcedPart, &[ResponsePart], Option<&SolutionsPart>),
    built: &Built,
    begin: &Begin<'_>,
    hooks: &mut Hooks<'_>,
) -> Outcome<Branch> {
    let dofs = responses::dofs(watched, built)?;
    let responses = responses::responses(watched, &dofs);
    let at: Vec<f64> = begin.at_hz.iter().map(|f| TAU * f).collect();
    let range = ForcedOptions {
        omega_start: TAU * begin.from_hz,
        omega_stop: TAU * part.to_hz,
        at: &at,
        guess: begin.guess,
        responses: &responses,
        together: part.together,
        branches: sought.map_or(0, |sought| sought.branches),
        branch_depth: sought.map_or(0, |sought| sought.depth),
        most_branches: sought.map_or(0, |sought| sought.most),
    };
    let named = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built);
    let solver = SolverOptions {
        estimate_error: part.estimate_error,
        stability: part.stability.map(|waves| match waves {
            WavesName::Wave => Waves::Wave,
            WavesName::Wheel => Waves::Wheel,
        }),
        freedom: part.freedom,
        ..named.map_err(|e| format!("[forced]: {e}"))?
    };
    forced_response(&built.model, &solver, &range, hooks).map_err(|e| format!("[forced]: {e}"))
}

fn mode((part, sought): (&ModePart, Option<&SolutionsPart>), built: &Built, hooks: &mut Hooks<'_>) -> Outcome<Branch> {
    let range = ModeOptions {
        branches: sought.map_or(0, |sought| sought.branches.min(1)),
        branch_depth: sought.map_or(0, |sought| sought.depth),
        most_branches: sought.map_or(0, |sought| sought.most),
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
