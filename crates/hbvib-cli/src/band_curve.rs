//! Band of a job: the lower and the upper curve of a response over the forces that sticking contacts may keep, and the band of its
//! highest peak.

use crate::build::{Built, Outcome};
use crate::counted::counted;
use crate::figure::{bounds, draw, scientific};
use crate::files::Files;
use crate::job_studies::BandPart;
use crate::map::Written;
use crate::solver::solver;
use hbvib::{Band, BandOf, BandOptions, Branch, ForcedOptions, Hooks, Special, Status, band, forced_response};
use plotters::prelude::{ChartBuilder, LineSeries, Polygon};
use plotters::style::{BLUE, Color};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The band at a point of the curve.
struct Row {
    omega: f64,
    amplitude: f64,
    lower: f64,
    upper: f64,
    sliders: usize,
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &BandPart, built: &Built) -> Outcome<()> {
    if part.starts == Some(0) {
        return Err("[band]: starts = 0, needs at least 1".into());
    }
    solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built)
        .map(|_| ())
        .map_err(|e| format!("[band]: {e}"))
}

/// Computes and writes the band.
///
/// # Errors
/// A sentence.
pub fn write(part: &BandPart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<Written> {
    check(part, built)?;
    let said = |e: &dyn std::fmt::Display| format!("[band]: {e}");
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let range = ForcedOptions {
        omega_start: TAU * part.from_hz,
        omega_stop: TAU * part.to_hz,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&built.model, &solver, &range, hooks).map_err(|e| said(&e))?;
    if branch.status() != Status::Ok {
        let text = format!("[band]: the response ended early: {}\n", branch.status().sentence());
        return Ok((text, true));
    }
    let options = BandOptions {
        starts: part.starts.unwrap_or(BandOptions::default().starts),
        ..BandOptions::default()
    };
    let mut rows = Vec::new();
    let mut incomplete = 0;
    for point in 0..branch.points() {
        let found = band(&built.model, &branch, point, &solver, &options, hooks).map_err(|e| said(&e))?;
        incomplete += usize::from(!found.is_complete);
        rows.push(Row {
            omega: branch.omega()[point],
            amplitude: branch.amplitude()[point],
            lower: found.lower.value,
            upper: found.upper.value,
            sliders: found.sliders.len(),
        });
    }
    let peak = of_peak(built, &branch, (&solver, &options), hooks).map_err(|e| said(&e))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&rows)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| figure(path, &rows));
    Ok((summary(&rows, peak.as_ref(), incomplete), false))
}

/// The band of the highest peak, if there is one.
fn of_peak(
    built: &Built,
    branch: &Branch,
    (solver, options): (&hbvib::SolverOptions, &BandOptions<'_>),
    hooks: &mut Hooks<'_>,
) -> hbvib::Result<Option<(Special, Band)>> {
    let highest = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let Some(&peak) = highest else { return Ok(None) };
    let options = BandOptions {
        of: BandOf::PeakAmplitude,
        ..*options
    };
    let found = band(&built.model, branch, peak.point, solver, &options, hooks)?;
    Ok(Some((peak, found)))
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from("hz,amplitude,lower,upper,free_sliders\n");
    for row in rows {
        let _ = writeln!(
            text,
            "{:.16e},{:.16e},{:.16e},{:.16e},{}",
            row.omega / TAU,
            row.amplitude,
            row.lower,
            row.upper,
            row.sliders
        );
    }
    text
}

fn summary(rows: &[Row], peak: Option<&(Special, Band)>, incomplete: usize) -> String {
    let free = rows.iter().filter(|row| row.sliders > 0).count();
    let mut text = format!("band: {free} of {} with free sliders\n", counted(rows.len(), "point"));
    if let Some((peak, found)) = peak {
        let _ = writeln!(
            text,
            "peak {:.6e} at {:.6} Hz; band of it from {:.6e} at {:.6} Hz to {:.6e} at {:.6} Hz, {} free",
            peak.amplitude,
            peak.omega / TAU,
            found.lower.value,
            found.lower.omega / TAU,
            found.upper.value,
            found.upper.omega / TAU,
            counted(found.sliders.len(), "slider")
        );
    }
    if incomplete > 0 {
        let _ = writeln!(
            text,
            "at {} the ends are attained, but others may lie beyond",
            counted(incomplete, "point")
        );
    }
    text
}

/// The band as a shaded area around the curve of the response.
fn figure(path: &Path, rows: &[Row]) -> Outcome<()> {
    let x = bounds(rows.iter().map(|row| row.omega / TAU));
    let y = bounds(rows.iter().map(|row| row.upper).chain([0.0]));
    let (of_x, of_y) = (scientific(&x), scientific(&y));
    let line = |value: fn(&Row) -> f64| rows.iter().map(move |row| (row.omega / TAU, value(row)));
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption("band of the response over residual forces", ("sans-serif", 18))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(90)
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .x_desc("frequency, Hz")
            .y_desc("amplitude")
            .x_label_formatter(&of_x)
            .y_label_formatter(&of_y)
            .max_light_lines(1)
            .draw()?;
        let below = line(|row| row.lower).collect::<Vec<_>>();
        let outline: Vec<(f64, f64)> = line(|row| row.upper).chain(below.into_iter().rev()).collect();
        chart.draw_series([Polygon::new(outline, BLUE.mix(0.2))])?;
        for value in [|row: &Row| row.lower, |row: &Row| row.upper] {
            chart.draw_series(LineSeries::new(line(value), BLUE.mix(0.6)))?;
        }
        chart.draw_series(LineSeries::new(line(|row| row.amplitude), BLUE.stroke_width(2)))?;
        Ok(())
    })
}
