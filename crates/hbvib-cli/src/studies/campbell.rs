//! Campbell and interference (SAFE) diagrams of a job: natural frequencies over speed, and over nodal diameter.

use crate::job_file::job_studies::{CampbellPart, StateName};
use crate::outputs::figure::{bounds, draw};
use crate::outputs::files::Files;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Campbell, Hooks, Interference, LinearContacts, Model, Speed, campbell, interference};
use plotters::prelude::{ChartBuilder, Circle, LineSeries};
use plotters::style::{BLACK, Color, Palette, Palette99, RED};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Radians per time unit of one turn per minute, times in seconds.
const RPM: f64 = TAU / 60.0;

/// Difference of two frequencies, relative, that is not seen.
const SAME: f64 = 1e-9;

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &CampbellPart, model: &Model) -> Outcome<()> {
    if part.points < 2 || part.to_rpm <= part.from_rpm {
        return Err(format!(
            "[campbell]: points = {}, from_rpm = {}, to_rpm = {}, needs at least 2 points and rising speeds",
            part.points, part.from_rpm, part.to_rpm
        ));
    }
    if part.interference_figure.is_some() && model.structure().sectors() == 1 {
        return Err("[campbell]: interference_figure needs a model of several sectors".into());
    }
    Ok(())
}

/// Computes and writes the diagrams; returns a summary.
///
/// # Errors
/// A sentence.
pub fn write(part: &CampbellPart, model: &Model, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<String> {
    let said = |e: &dyn std::fmt::Display| format!("[campbell]: {e}");
    let step = (part.to_rpm - part.from_rpm) / (part.points - 1) as f64;
    let speeds: Vec<f64> = (0..part.points)
        .map(|i| (part.from_rpm + step * i as f64) * RPM)
        .collect();
    let state = match part.contacts {
        StateName::Stuck => LinearContacts::Stuck,
        StateName::Free => LinearContacts::Free,
        StateName::Static => LinearContacts::Static,
    };
    let count = part.count.min(model.structure().ndof());
    let structure = model.structure();
    let first = structure.signed_diameter(part.engine_orders.first().copied().unwrap_or(0));
    let at = (part.diameter.unwrap_or(first), state, count);
    let found = campbell(model, &speeds, at, &part.engine_orders, hooks).map_err(|e| said(&e))?;
    let has_opposite = found.crossings.iter().any(|c| c.diameter != found.diameter);
    let opposite = if has_opposite {
        let at = (-found.diameter, state, count);
        let lines = campbell(model, &speeds, at, &[], hooks).map_err(|e| said(&e))?;
        Some(lines).filter(|lines| differ(lines, &found))
    } else {
        None
    };
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&found, opposite.as_ref())).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| {
        figure(path, &found, opposite.as_ref(), &part.engine_orders)
    });
    if let Some(path) = &part.interference_figure {
        let rpm = part.interference_rpm.unwrap_or(part.to_rpm);
        let mut rotating = model.try_clone().map_err(|e| said(&e))?;
        rotating.set_speed(Speed::Fixed(rpm * RPM)).map_err(|e| said(&e))?;
        let waves = interference(&rotating, state, count, hooks).map_err(|e| said(&e))?;
        files.write(Some(path), &|path| safe(path, &waves, &rotating, rpm));
    }
    Ok(summary(&found, structure.sectors()))
}

/// Whether two diagrams have other frequencies.
fn differ(one: &Campbell, other: &Campbell) -> bool {
    let mut pairs = one.omega.iter().zip(&other.omega);
    pairs.any(|(a, b)| a.is_nan() != b.is_nan() || (a - b).abs() > SAME * a.abs())
}

fn summary(found: &Campbell, sectors: usize) -> String {
    let mut text = counted(found.crossings.len(), "crossing of engine orders and modes") + "\n";
    for c in &found.crossings {
        let sense = match c.direction {
            1 => ", forward",
            -1 => ", backward",
            _ => "",
        };
        let wave = if sectors > 1 {
            format!(", nodal diameter {}", c.diameter)
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "EO {} at {:.6} rpm, {:.6} Hz{wave}{sense}",
            c.engine_order,
            c.speed / RPM,
            c.omega / TAU
        );
    }
    text
}

/// The curves of the diameter, then those of the other sense where an engine order meets them.
fn table(found: &Campbell, opposite: Option<&Campbell>) -> String {
    let mut text = String::from("rpm,mode,hz,damping_ratio,direction,diameter\n");
    for found in std::iter::once(found).chain(opposite) {
        for (i, speed) in found.speeds.iter().enumerate() {
            for k in 0..found.count {
                let at = i * found.count + k;
                let _ = writeln!(
                    text,
                    "{:.10e},{k},{:.10e},{:.10e},{},{}",
                    speed / RPM,
                    found.omega[at] / TAU,
                    found.damping_ratio[at],
                    found.direction[at],
                    found.diameter
                );
            }
        }
    }
    text
}

/// Frequencies over speed, rays of the engine orders, and a circle at each crossing; the curves of the other sense are pale.
fn figure(path: &Path, found: &Campbell, opposite: Option<&Campbell>, engine_orders: &[i64]) -> Outcome<()> {
    let rpm: Vec<f64> = found.speeds.iter().map(|speed| speed / RPM).collect();
    let both = || std::iter::once((found, 1.0)).chain(opposite.map(|other| (other, 0.4)));
    let hertz = || {
        let all = both().flat_map(|(lines, _)| &lines.omega);
        all.map(|w| w / TAU).filter(|f| f.is_finite())
    };
    let y = bounds(hertz().chain([0.0]));
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption("natural frequencies over speed, engine orders", ("sans-serif", 18))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(70)
            .build_cartesian_2d(bounds(rpm.iter().copied()), y.clone())?;
        chart
            .configure_mesh()
            .x_desc("speed, rpm")
            .y_desc("frequency, Hz")
            .draw()?;
        for (lines, share) in both() {
            for k in 0..lines.count {
                let colour = Palette99::pick(k).mix(share);
                let curve = rpm
                    .iter()
                    .enumerate()
                    .map(|(i, x)| (*x, lines.omega[i * lines.count + k] / TAU));
                chart.draw_series(LineSeries::new(curve.filter(|p| p.1.is_finite()), &colour))?;
            }
        }
        for order in engine_orders {
            let ray = rpm.iter().map(|x| (*x, *order as f64 * x / 60.0));
            chart.draw_series(LineSeries::new(ray.filter(|p| y.contains(&p.1)), BLACK.mix(0.4)))?;
        }
        chart.draw_series(
            found
                .crossings
                .iter()
                .map(|c| Circle::new((c.speed / RPM, c.omega / TAU), 4, RED)),
        )?;
        Ok(())
    })
}

/// Frequencies over nodal diameter at one speed, with the engine orders: over the signed diameters where both senses differ,
/// else over 0 .. N/2.
fn safe(path: &Path, waves: &Interference, model: &Model, rpm: f64) -> Outcome<()> {
    let structure = model.structure();
    let sectors = structure.sectors();
    let equal = waves.has_equal_senses;
    let rows = waves.diameters.iter().zip(waves.omega.chunks_exact(waves.count));
    let points: Vec<(f64, f64)> = rows
        .filter(|(diameter, _)| !equal || **diameter >= 0)
        .flat_map(|(diameter, row)| row.iter().map(move |omega| (*diameter as f64, omega / TAU)))
        .filter(|point| point.1.is_finite())
        .collect();
    let y = bounds(points.iter().map(|p| p.1).chain([0.0]));
    let wave = |order: usize| {
        let diameter = structure.signed_diameter(order as i64);
        if equal { diameter.abs() } else { diameter }
    };
    let left = if equal { 0 } else { waves.diameters[0] };
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption(
                format!("interference of engine orders at {rpm} rpm"),
                ("sans-serif", 18),
            )
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(70)
            .build_cartesian_2d(left as f64 - 0.5..sectors as f64 / 2.0 + 0.5, y.clone())?;
        chart
            .configure_mesh()
            .x_desc("nodal diameter")
            .y_desc("frequency, Hz")
            .draw()?;
        let orders: Vec<(f64, f64)> = (0..=sectors)
            .map(|order| (wave(order) as f64, order as f64 * rpm / 60.0))
            .filter(|p| y.contains(&p.1))
            .collect();
        // A ray of signed waves begins again where it leaves the diagram.
        for ray in orders.chunk_by(|a, b| equal || a.0 < b.0) {
            chart.draw_series(LineSeries::new(ray.iter().copied(), BLACK.mix(0.4)))?;
        }
        chart.draw_series(points.iter().map(|p| Circle::new(*p, 4, RED.filled())))?;
        Ok(())
    })
}
