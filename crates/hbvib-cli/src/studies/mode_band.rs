//! Band of a nonlinear mode of a job: damping ratio and frequency over the forces that sticking contacts may keep.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_residual::ModeBandPart;
use crate::outputs::figure::{bounds, draw, scientific};
use crate::outputs::files::Files;
use crate::studies::incomplete_bands::beyond;
use crate::studies::map::Written;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Hooks, ModeBandOf, ModeChoice, ModeOptions, Status, mode_band, nonlinear_mode};
use plotters::prelude::{ChartBuilder, LineSeries, Polygon};
use plotters::style::{BLUE, Color};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// The band at an amplitude: that of the mode, the least and the largest value.
struct Row {
    log10: f64,
    damping: [f64; 3],
    hz: [f64; 3],
    sliders: usize,
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &ModeBandPart, built: &Built) -> Outcome<()> {
    if part.points < 2 {
        return Err(format!("[mode_band]: points = {}, needs at least 2", part.points));
    }
    of_model("mode_band", &part.contacts, built)?;
    solver(
        (part.mode.harmonics, part.mode.tolerance),
        part.mode.response_dof.as_ref(),
        built,
    )
    .map(|_| ())
    .map_err(|e| format!("[mode_band.mode]: {e}"))
}

/// Refuses contacts that the model does not have.
///
/// # Errors
/// A sentence.
pub fn of_model(part: &str, contacts: &[usize], built: &Built) -> Outcome<()> {
    let known = built.model.contacts().len();
    match contacts.iter().find(|contact| **contact >= known) {
        None => Ok(()),
        Some(contact) => Err(format!(
            "[{part}] contacts: {contact}, but the model has {}",
            counted(known, "contact")
        )),
    }
}

/// Computes and writes the band.
///
/// # Errors
/// A sentence.
pub fn write(part: &ModeBandPart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<Written> {
    check(part, built)?;
    let said = |e: &dyn std::fmt::Display| format!("[mode_band]: {e}");
    let mode = &part.mode;
    let solver = solver((mode.harmonics, mode.tolerance), mode.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let share = |i: usize| i as f64 / (part.points - 1) as f64;
    let at: Vec<f64> = (0..part.points)
        .map(|i| mode.log10_from + (mode.log10_to - mode.log10_from) * share(i))
        .collect();
    let range = ModeOptions {
        choice: ModeChoice::Index(mode.index),
        log10_start: mode.log10_from,
        log10_stop: mode.log10_to,
        at: &at,
        ..ModeOptions::default()
    };
    let branch = nonlinear_mode(&built.model, &solver, &range, hooks).map_err(|e| said(&e))?;
    if branch.status() == Status::StoppedByCaller {
        let text = format!("[mode_band]: the mode ended early: {}\n", branch.status().sentence());
        return Ok((text, true));
    }
    let mut rows = Vec::new();
    let mut incomplete = 0;
    for (i, &log10) in at.iter().enumerate() {
        let Some(special) = branch.at(i).first() else { continue };
        let own = branch
            .mode_at(special.point)
            .map_or(f64::NAN, |mode| mode.damping_ratio);
        let mut of = |of: ModeBandOf| {
            let wanted = (of, &part.contacts[..]);
            mode_band(&built.model, &branch, special.point, wanted, &solver, &range, hooks).map_err(|e| said(&e))
        };
        let (damping, omega) = (of(ModeBandOf::Damping)?, of(ModeBandOf::Omega)?);
        incomplete += usize::from(!(damping.is_complete && omega.is_complete));
        rows.push(Row {
            log10,
            damping: [own, damping.lower.damping_ratio, damping.upper.damping_ratio],
            hz: [special.omega, omega.lower.omega, omega.upper.omega].map(|omega| omega / TAU),
            sliders: damping.sliders.len(),
        });
    }
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&rows)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| figure(path, &rows));
    Ok((summary(&rows, incomplete), false))
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "log10_amplitude,damping_ratio,lower_damping_ratio,upper_damping_ratio,hz,lower_hz,upper_hz,free_sliders\n",
    );
    for row in rows {
        let _ = write!(text, "{:.16e}", row.log10);
        for x in row.damping.iter().chain(&row.hz) {
            let _ = write!(text, ",{x:.16e}");
        }
        let _ = writeln!(text, ",{}", row.sliders);
    }
    text
}

fn summary(rows: &[Row], incomplete: usize) -> String {
    let free = rows.iter().filter(|row| row.sliders > 0).count();
    let mut text = format!(
        "mode band: {free} of {} with free sliders\n",
        counted(rows.len(), "amplitude")
    );
    let widest = rows
        .iter()
        .max_by(|a, b| (a.damping[2] - a.damping[1]).total_cmp(&(b.damping[2] - b.damping[1])));
    if let Some(row) = widest.filter(|_| free > 0) {
        let _ = writeln!(
            text,
            "widest at log10 of the amplitude {:.4}: damping ratio from {:.6e} to {:.6e}, frequency from {:.6} to {:.6} Hz",
            row.log10, row.damping[1], row.damping[2], row.hz[1], row.hz[2]
        );
    }
    text + &beyond(incomplete, "amplitude")
}

/// The damping ratio as a shaded area over the amplitude.
fn figure(path: &Path, rows: &[Row]) -> Outcome<()> {
    let x = bounds(rows.iter().map(|row| row.log10));
    let y = bounds(rows.iter().map(|row| row.damping[2]).chain([0.0]));
    let of_y = scientific(&y);
    let line = |k: usize| rows.iter().map(move |row| (row.log10, row.damping[k]));
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption("band of the damping ratio over residual forces", ("sans-serif", 18))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(90)
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .x_desc("log10 of the modal amplitude")
            .y_desc("damping ratio")
            .y_label_formatter(&of_y)
            .max_light_lines(1)
            .draw()?;
        let below = line(1).collect::<Vec<_>>();
        let outline: Vec<(f64, f64)> = line(2).chain(below.into_iter().rev()).collect();
        chart.draw_series([Polygon::new(outline, BLUE.mix(0.2))])?;
        for k in [1, 2] {
            chart.draw_series(LineSeries::new(line(k), BLUE.mix(0.6)))?;
        }
        chart.draw_series(LineSeries::new(line(0), BLUE.stroke_width(2)))?;
        Ok(())
    })
}
