//! Run-ups and missions of a job, by the slow flow of a nonlinear mode.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_passages::{MissionPart, PassedMode, RunUpPart};
use crate::outputs::files::Files;
use crate::outputs::line_chart::{Chart, Line};
use crate::studies::map::Written;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{
    Branch, Hooks, Mission, MissionOptions, ModeChoice, ModeOptions, RunUp, RunUpOptions, Status, SynthesisOptions,
    Woehler, mission, nonlinear_mode, run_up,
};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

/// The mode of a passage; the sentence where it ended early.
fn solved(part: &PassedMode, name: &str, built: &Built, hooks: &mut Hooks<'_>) -> Outcome<Result<Branch, String>> {
    let range = ModeOptions {
        choice: ModeChoice::Index(part.index),
        log10_start: part.log10_from,
        log10_stop: part.log10_to,
        ..ModeOptions::default()
    };
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built)
        .map_err(|e| format!("[{name}.mode]: {e}"))?;
    let branch = nonlinear_mode(&built.model, &solver, &range, hooks).map_err(|e| format!("[{name}.mode]: {e}"))?;
    if branch.status() == Status::StoppedByCaller {
        return Ok(Err(format!(
            "[{name}]: the mode ended early: {}\n",
            branch.status().sentence()
        )));
    }
    Ok(Ok(branch))
}

fn through(part: &RunUpPart) -> RunUpOptions {
    RunUpOptions {
        omega_start: TAU * part.from_hz,
        omega_stop: TAU * part.to_hz,
        rate: TAU * part.hz_per_s,
        ..RunUpOptions::default()
    }
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check_run_up(part: &RunUpPart, built: &Built) -> Outcome<()> {
    through(part)
        .check(built.model.ndof())
        .map_err(|e| format!("[run_up]: {e}"))
}

/// Computes and writes a run-up.
///
/// # Errors
/// A sentence.
pub fn write_run_up(part: &RunUpPart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<Written> {
    let branch = match solved(&part.mode, "run_up", built, hooks)? {
        Ok(branch) => branch,
        Err(early) => return Ok((early, true)),
    };
    let found =
        run_up(&branch, &built.model, &through(part), &hooks.interrupt()).map_err(|e| format!("[run_up]: {e}"))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, turns(&found)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| {
        Chart {
            title: format!("run-up at {} Hz/s", part.hz_per_s),
            x_label: "frequency of the forces, Hz".into(),
            y_label: "largest displacement of each turn".into(),
            log_x: false,
            log_y: false,
            markers: false,
            lines: vec![Line {
                name: "run-up".into(),
                points: found
                    .turns
                    .iter()
                    .map(|turn| (turn.omega / TAU, turn.amplitude))
                    .collect(),
                marked: vec![(found.largest_omega / TAU, found.largest)],
            }],
        }
        .write(path)
    });
    let text = format!(
        "run-up: {:.6e} at {:.6} Hz after {:.6e} s, error {:.2e} with {} turns integrated in time; {:.4} of the steady resonance\n",
        found.largest,
        found.largest_omega / TAU,
        found.largest_time,
        found.error,
        found.integrated,
        found.factor()
    );
    Ok((text, false))
}

fn turns(found: &RunUp) -> String {
    let mut text = String::from("s,hz,amplitude,modal_amplitude\n");
    for turn in &found.turns {
        let _ = writeln!(
            text,
            "{:.16e},{:.16e},{:.16e},{:.16e}",
            turn.time,
            turn.omega / TAU,
            turn.amplitude,
            turn.modal_amplitude
        );
    }
    text
}

fn flown<'a>(part: &'a MissionPart, speeds: &'a [f64]) -> MissionOptions<'a> {
    MissionOptions {
        times: &part.seconds,
        speeds,
        engine_order: part.engine_order,
        dof: None,
        edges: &part.edges,
        stresses: &part.stresses,
        woehler: part.woehler.as_ref().map(|line| Woehler {
            stress: line.stress,
            cycles: line.cycles,
            slope: line.slope,
            slope_below: line.slope_below,
        }),
        synthesis: SynthesisOptions::default(),
    }
}

fn speeds(part: &MissionPart) -> Vec<f64> {
    part.rpm.iter().map(|rpm| rpm / 60.0 * TAU).collect()
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check_mission(part: &MissionPart, built: &Built) -> Outcome<()> {
    flown(part, &speeds(part))
        .check(built.model.ndof())
        .map_err(|e| format!("[mission]: {e}"))
}

/// Computes and writes a mission.
///
/// # Errors
/// A sentence.
pub fn write_mission(
    part: &MissionPart,
    built: &Built,
    hooks: &mut Hooks<'_>,
    files: &mut Files<'_>,
) -> Outcome<Written> {
    let branch = match solved(&part.mode, "mission", built, hooks)? {
        Ok(branch) => branch,
        Err(early) => return Ok((early, true)),
    };
    let speeds = speeds(part);
    let found = mission(&branch, &built.model, &flown(part, &speeds), &hooks.interrupt())
        .map_err(|e| format!("[mission]: {e}"))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, passages(&found)).map_err(|e| e.to_string())
    });
    files.write(part.spectrum_csv.as_deref(), &|path| {
        fs::write(path, spectrum(part, &found)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| {
        let mut points: Vec<(f64, f64)> = part
            .seconds
            .iter()
            .copied()
            .zip(found.amplitude.iter().copied())
            .collect();
        let peaks: Vec<(f64, f64)> = found.crossings.iter().map(|one| (one.time, one.amplitude)).collect();
        points.extend(&peaks);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Chart {
            title: "mission; circles: passages through the resonance".into(),
            x_label: "time, s".into(),
            y_label: "amplitude".into(),
            log_x: false,
            log_y: true,
            markers: false,
            lines: vec![Line {
                name: "amplitude".into(),
                points,
                marked: peaks,
            }],
        }
        .write(path)
    });
    Ok((summary(&found), false))
}

fn passages(found: &Mission) -> String {
    let mut text = String::from("s,hz,hz_per_s,amplitude,factor,cycles\n");
    for one in &found.crossings {
        let _ = writeln!(
            text,
            "{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e}",
            one.time,
            one.omega / TAU,
            one.rate / TAU,
            one.amplitude,
            one.amplitude / one.steady,
            one.cycles
        );
    }
    text
}

fn spectrum(part: &MissionPart, found: &Mission) -> String {
    let mut text = String::from("from,to,cycles\n");
    for (i, cycles) in found.cycles.iter().enumerate() {
        let low = if i == 0 { 0.0 } else { part.edges[i - 1] };
        let high = part.edges.get(i).copied().unwrap_or(f64::INFINITY);
        let _ = writeln!(text, "{low:.16e},{high:.16e},{cycles:.16e}");
    }
    text
}

fn summary(found: &Mission) -> String {
    let largest = found.crossings.iter().map(|one| one.amplitude).fold(0.0, f64::max);
    // A sum of no passages is −0.
    let cycles = found.crossings.iter().map(|one| one.cycles).sum::<f64>() + 0.0;
    let mut text = format!(
        "mission: {} of the resonance, the largest amplitude {largest:.6e}, {cycles:.1} cycles near the largest ones\n",
        counted(found.crossings.len(), "passage")
    );
    for (i, damage) in found.damage.iter().enumerate() {
        let _ = writeln!(text, "  sum of Miner of stress {i}: {damage:.6e}");
    }
    text
}
