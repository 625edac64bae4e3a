//! Campbell and interference (SAFE) diagrams of a job: natural frequencies over speed, and over nodal diameter.

use crate::build::Outcome;
use crate::counted::counted;
use crate::figure::{bounds, draw};
use crate::files::Files;
use crate::job_studies::{CampbellPart, StateName};
use hbvib::{Campbell, Hooks, LinearContacts, Model, Speed, campbell, damped_modes};
use plotters::prelude::{ChartBuilder, Circle, LineSeries};
use plotters::style::{BLACK, Color, Palette, Palette99, RED};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Radians per time unit of one turn per minute, times in seconds.
const RPM: f64 = TAU / 60.0;

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
    let found = campbell(
        model,
        &speeds,
        (part.diameter, state, count),
        &part.engine_orders,
        hooks,
    )
    .map_err(|e| said(&e))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&found)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| {
        figure(path, &found, &part.engine_orders)
    });
    if let Some(path) = &part.interference_figure {
        let sectors = model.structure().sectors();
        let rpm = part.interference_rpm.unwrap_or(part.to_rpm);
        let mut rotating = model.try_clone().map_err(|e| said(&e))?;
        rotating.set_speed(Speed::Fixed(rpm * RPM)).map_err(|e| said(&e))?;
        let mut points = Vec::new();
        for diameter in 0..=sectors / 2 {
            let modes = damped_modes(&rotating, diameter, state, count, hooks).map_err(|e| said(&e))?;
            points.extend((0..modes.count()).map(|k| (diameter as f64, modes.omega(k) / TAU)));
        }
        files.write(Some(path), &|path| interference(path, &points, sectors, rpm));
    }
    Ok(summary(&found))
}

fn summary(found: &Campbell) -> String {
    let mut text = counted(found.crossings.len(), "crossing of engine orders and modes") + "\n";
    for c in &found.crossings {
        let sense = match c.direction {
            1 => ", forward",
            -1 => ", backward",
            _ => "",
        };
        let _ = writeln!(
            text,
            "EO {} at {:.6} rpm, {:.6} Hz{sense}",
            c.engine_order,
            c.speed / RPM,
            c.omega / TAU
        );
    }
    text
}

fn table(found: &Campbell) -> String {
    let mut text = String::from("rpm,mode,hz,damping_ratio,direction\n");
    for (i, speed) in found.speeds.iter().enumerate() {
        for k in 0..found.count {
            let at = i * found.count + k;
            let _ = writeln!(
                text,
                "{:.10e},{k},{:.10e},{:.10e},{}",
                speed / RPM,
                found.omega[at] / TAU,
                found.damping_ratio[at],
                found.direction[at]
            );
        }
    }
    text
}

/// Frequencies over speed, rays of the engine orders, and a circle at each crossing.
fn figure(path: &Path, found: &Campbell, engine_orders: &[i64]) -> Outcome<()> {
    let rpm: Vec<f64> = found.speeds.iter().map(|speed| speed / RPM).collect();
    let hertz = || found.omega.iter().map(|w| w / TAU).filter(|f| f.is_finite());
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
        for k in 0..found.count {
            let colour = Palette99::pick(k).to_rgba();
            let curve = rpm
                .iter()
                .enumerate()
                .map(|(i, x)| (*x, found.omega[i * found.count + k] / TAU));
            chart.draw_series(LineSeries::new(curve.filter(|p| p.1.is_finite()), &colour))?;
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

/// Frequencies over nodal diameter at one speed, with the zigzag of the engine orders.
fn interference(path: &Path, points: &[(f64, f64)], sectors: usize, rpm: f64) -> Outcome<()> {
    let y = bounds(points.iter().map(|p| p.1).chain([0.0]));
    let folded = |order: usize| order.min(sectors - order) as f64;
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption(
                format!("interference of engine orders at {rpm} rpm"),
                ("sans-serif", 18),
            )
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(70)
            .build_cartesian_2d(-0.5..sectors as f64 / 2.0 + 0.5, y.clone())?;
        chart
            .configure_mesh()
            .x_desc("nodal diameter")
            .y_desc("frequency, Hz")
            .draw()?;
        let orders = (0..=sectors).map(|order| (folded(order), order as f64 * rpm / 60.0));
        chart.draw_series(LineSeries::new(orders.filter(|p| y.contains(&p.1)), BLACK.mix(0.4)))?;
        chart.draw_series(points.iter().map(|p| Circle::new(*p, 4, RED.filled())))?;
        Ok(())
    })
}
