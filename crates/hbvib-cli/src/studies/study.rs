//! Study of a job: a result over a parameter of the model, with its optima.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_studies::{FollowName, StudyPart};
use crate::outputs::figure::{bounds, draw, scientific};
use crate::outputs::files::Files;
use crate::studies::varied::{Keys, Varied};
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, Follow, Hooks, ParameterRange, Status, parameter_response};
use plotters::prelude::{ChartBuilder, Circle, LineSeries};
use plotters::style::{BLUE, Color, RED};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

impl StudyPart {
    fn follow(&self) -> Follow {
        let omega = self.near_hz * TAU;
        match self.follow {
            FollowName::Peak => Follow::Peak(omega),
            FollowName::PeakThroughFolds => Follow::PeakThroughFolds(omega),
            FollowName::Frequency => Follow::Omega(omega),
            FollowName::Fold => Follow::Fold(omega),
            FollowName::ModeMaxDamping => Follow::ModeMaxDamping {
                omega,
                log10_range: None,
            },
        }
    }

    /// Name of the result.
    fn result(&self) -> &'static str {
        if self.follow == FollowName::ModeMaxDamping {
            "damping_ratio"
        } else {
            "amplitude"
        }
    }
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &StudyPart, built: &Built) -> Outcome<()> {
    varied(part, built).map(|_| ())
}

fn varied(part: &StudyPart, built: &Built) -> Outcome<Varied> {
    let keys = Keys {
        parameter: part.parameter,
        contact: part.contact,
        dofs: &part.dofs,
    };
    Varied::new(&keys, built).map_err(|e| format!("[study]: {e}"))
}

/// Computes and writes the study; returns a summary.
///
/// # Errors
/// A sentence.
pub fn write(part: &StudyPart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<String> {
    let said = |e: &dyn std::fmt::Display| format!("[study]: {e}");
    let varied = varied(part, built)?;
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let range = ParameterRange {
        start: part.from,
        stop: part.to,
        at: &[],
        follow: part.follow(),
        response: None,
    };
    let found = parameter_response(&built.model, &solver, varied.parameter(), &range, hooks).map_err(|e| said(&e))?;
    let rows = rows(&found);
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(part, &rows)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| {
        figure(path, (part, varied.label()), &rows, &found)
    });
    Ok(summary(part, &found, rows.len()))
}

/// A point of the curve.
struct Row {
    parameter: f64,
    hz: f64,
    value: f64,
    slope: f64,
    harmonics: f64,
}

fn rows(found: &Branch) -> Vec<Row> {
    let (parameter, d_amplitude) = (found.parameter().unwrap_or(&[]), found.d_amplitude().unwrap_or(&[]));
    let row = |i: usize| {
        let mode = found.mode_at(i);
        Row {
            parameter: parameter[i],
            hz: found.omega()[i] / TAU,
            value: mode.map_or(found.amplitude()[i], |at| at.damping_ratio),
            slope: mode.and_then(|_| found.d_damping_at(i)).unwrap_or(d_amplitude[i]),
            harmonics: found.harmonics_used()[i],
        }
    };
    (0..parameter.len()).map(row).collect()
}

fn table(part: &StudyPart, rows: &[Row]) -> String {
    let mut text = format!("parameter,hz,{},derivative,harmonics\n", part.result());
    for row in rows {
        let _ = writeln!(
            text,
            "{:.16e},{:.16e},{:.16e},{:.16e},{}",
            row.parameter, row.hz, row.value, row.slope, row.harmonics
        );
    }
    text
}

fn summary(part: &StudyPart, found: &Branch, points: usize) -> String {
    let mut text = counted(points, "point over the parameter") + "\n";
    if found.status() != Status::Ok {
        let _ = writeln!(
            text,
            "{}: {}",
            found.status().name().to_string_lossy(),
            found.status().sentence()
        );
    }
    for o in found.optima() {
        let kind = if o.is_maximum { "maximum" } else { "minimum" };
        let _ = writeln!(
            text,
            "{kind} of {} {:.6e} at {:.8e}, {:.6} Hz",
            part.result().replace('_', " "),
            o.amplitude,
            o.parameter,
            o.omega / TAU
        );
    }
    for turn in found.turns() {
        let kind = if turn.is_maximum { "largest" } else { "smallest" };
        let _ = writeln!(
            text,
            "{kind} parameter {:.8e} at a turn, {:.6} Hz, amplitude {:.6e}",
            turn.parameter,
            turn.omega / TAU,
            turn.amplitude
        );
    }
    for peak in found.higher_peaks() {
        let _ = writeln!(
            text,
            "at {:.8e} another peak is higher: {:.6e} at {:.6} Hz",
            peak.parameter,
            peak.amplitude,
            peak.omega / TAU
        );
    }
    text
}

/// The result over the parameter, with a circle at each optimum.
fn figure(path: &Path, (part, label): (&StudyPart, &str), rows: &[Row], found: &Branch) -> Outcome<()> {
    let y = bounds(rows.iter().map(|r| r.value));
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption(
                format!("{} over the parameter", part.result().replace('_', " ")),
                ("sans-serif", 18),
            )
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(90)
            .build_cartesian_2d(bounds(rows.iter().map(|r| r.parameter)), y.clone())?;
        chart
            .configure_mesh()
            .x_desc(label)
            .y_desc(part.result().replace('_', " "))
            .y_label_formatter(&scientific(&y))
            .draw()?;
        chart.draw_series(LineSeries::new(rows.iter().map(|r| (r.parameter, r.value)), &BLUE))?;
        chart.draw_series(
            found
                .optima()
                .iter()
                .map(|o| Circle::new((o.parameter, o.amplitude), 4, RED.filled())),
        )?;
        Ok(())
    })
}
