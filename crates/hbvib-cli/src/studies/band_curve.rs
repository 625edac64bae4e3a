//! Band of a job: the lower and the upper curve of a response over the forces that sticking contacts may keep, and the band of its
//! highest peak.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_studies::{BandName, BandPart};
use crate::outputs::figure::{bounds, draw, scientific};
use crate::outputs::files::Files;
use crate::studies::incomplete_bands::beyond;
use crate::studies::map::Written;
use crate::studies::mode_band::of_model;
use crate::studies::residual_state::write_places;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Band, BandOf, BandOptions, Branch, Contact, ForcedOptions, Hooks, Special, Status, band, forced_response};
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
    if part.of.is_empty() {
        return Err("[band]: of is empty, needs amplitude, peak_amplitude or peak_hz".into());
    }
    let has = |name| part.of.contains(&name);
    let of_peak = has(BandName::PeakAmplitude) || has(BandName::PeakHz);
    for (file, name, fits, needs) in [
        (&part.csv, "csv", has(BandName::Amplitude), "amplitude"),
        (&part.figure, "figure", has(BandName::Amplitude), "amplitude"),
        (&part.ends_csv, "ends_csv", of_peak, "peak_amplitude or peak_hz"),
        (
            &part.lower_npz,
            "lower_npz",
            has(BandName::PeakAmplitude),
            "peak_amplitude",
        ),
        (
            &part.upper_npz,
            "upper_npz",
            has(BandName::PeakAmplitude),
            "peak_amplitude",
        ),
    ] {
        if file.is_some() && !fits {
            return Err(format!("[band]: {name} needs {needs} in of"));
        }
    }
    of_model("band", &part.contacts, built)?;
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
        contacts: &part.contacts,
        ..BandOptions::default()
    };
    let mut rows = Vec::new();
    let mut incomplete = 0;
    let points = if part.of.contains(&BandName::Amplitude) {
        branch.points()
    } else {
        0
    };
    for point in 0..points {
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
    let peaks = of_peak(part, built, &branch, (&solver, &options), hooks).map_err(|e| said(&e))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&rows)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| figure(path, &rows));
    files.write(part.ends_csv.as_deref(), &|path| {
        fs::write(path, ends(&peaks)).map_err(|e| e.to_string())
    });
    let amplitude = peaks.iter().find(|peak| peak.of == BandName::PeakAmplitude);
    let written = [
        (&part.lower_npz, amplitude.map(|peak| &peak.band.lower)),
        (&part.upper_npz, amplitude.map(|peak| &peak.band.upper)),
    ];
    for (path, end) in written {
        let (Some(path), Some(end), Some(peak)) = (path, end, amplitude) else {
            continue;
        };
        let mut places: Vec<[f64; 2]> = built.model.contacts().iter().map(Contact::slider).collect();
        for (&(contact, direction), place) in peak.band.sliders.iter().zip(&end.places) {
            places[contact][direction] = *place;
        }
        files.write(Some(path), &|path| write_places(path, &places));
    }
    Ok((summary(&rows, &peaks, incomplete), false))
}

/// The band of a result of the highest peak.
struct PeakBand {
    of: BandName,
    peak: Special,
    band: Band,
}

/// The bands of the highest peak that are asked for, if there is one.
fn of_peak(
    part: &BandPart,
    built: &Built,
    branch: &Branch,
    (solver, options): (&hbvib::SolverOptions, &BandOptions<'_>),
    hooks: &mut Hooks<'_>,
) -> hbvib::Result<Vec<PeakBand>> {
    let mut found = Vec::new();
    let highest = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let Some(&peak) = highest else { return Ok(found) };
    for (name, of) in [
        (BandName::PeakAmplitude, BandOf::PeakAmplitude),
        (BandName::PeakHz, BandOf::PeakOmega),
    ] {
        if part.of.contains(&name) {
            let options = BandOptions { of, ..*options };
            let band = band(&built.model, branch, peak.point, solver, &options, hooks)?;
            found.push(PeakBand { of: name, peak, band });
        }
    }
    Ok(found)
}

/// A row for each free slider of both ends of each band of the peak.
fn ends(peaks: &[PeakBand]) -> String {
    let mut text = String::from("of,end,hz,amplitude,contact,direction,place\n");
    for found in peaks {
        let of = match found.of {
            BandName::Amplitude => "amplitude",
            BandName::PeakAmplitude => "peak_amplitude",
            BandName::PeakHz => "peak_hz",
        };
        for (name, end) in [("lower", &found.band.lower), ("upper", &found.band.upper)] {
            for (&(contact, direction), place) in found.band.sliders.iter().zip(&end.places) {
                let _ = writeln!(
                    text,
                    "{of},{name},{:.16e},{:.16e},{contact},t{},{place:.16e}",
                    end.omega / TAU,
                    end.amplitude,
                    direction + 1
                );
            }
        }
    }
    text
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

fn summary(rows: &[Row], peaks: &[PeakBand], incomplete: usize) -> String {
    let free = rows.iter().filter(|row| row.sliders > 0).count();
    let mut text = String::new();
    if !rows.is_empty() {
        let _ = writeln!(
            text,
            "band: {free} of {} with free sliders",
            counted(rows.len(), "point")
        );
    }
    for PeakBand { of, peak, band } in peaks {
        let named = match of {
            BandName::PeakHz => "band of its frequency",
            _ => "band of it",
        };
        let _ = writeln!(
            text,
            "peak {:.6e} at {:.6} Hz; {named} from {:.6e} at {:.6} Hz to {:.6e} at {:.6} Hz, {} free{}",
            peak.amplitude,
            peak.omega / TAU,
            band.lower.amplitude,
            band.lower.omega / TAU,
            band.upper.amplitude,
            band.upper.omega / TAU,
            counted(band.sliders.len(), "slider"),
            if band.is_complete {
                ""
            } else {
                "; others may lie beyond"
            }
        );
    }
    text + &beyond(incomplete, "point")
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
