//! Campbell and interference diagram of the bladed disk with its ring stuck: where engine orders meet the modes of one
//! nodal diameter as the speed rises, and which wave an engine order excites at one speed.
//!
//! Rotation stiffens the blades: the centrifugal load of their masses pulls a sideways motion back like the weight of a
//! pendulum, K + Ω²K₁. `cargo run --release --example campbell` writes a table to the screen, and CSV, SVG and PNG to
//! target/campbell/. Exit status: 0 done, 1 a computation or a file failed.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use hbvib::{Campbell, Hooks, LinearContacts, MatrixKind, MatrixView, Model, Speed, campbell, damped_modes};

#[path = "support/csv.rs"]
mod csv;
#[path = "ring_damper/model.rs"]
#[allow(dead_code, reason = "this example uses a part of it")]
mod model;
#[path = "support/plot.rs"]
mod plot;

use csv::write_csv;
use model::{LARGEST_DIAMETER, Parameters, SECTORS};
use plot::{Figure, Series, Style};

/// Nodal diameter of the Campbell diagram.
const DIAMETER: i64 = 2;

/// Engine orders that excite it: EO = 2, 22, 26, … on 24 sectors.
const ENGINE_ORDERS: [i64; 3] = [2, 22, 26];

/// Modes of a nodal diameter.
const COUNT: usize = 3;

/// Speeds, 1/min.
const RPM: (f64, f64) = (0.0, 9000.0);

/// Points of a curve.
const POINTS: usize = 46;

/// Radians per second of one turn per minute.
const PER_RPM: f64 = TAU / 60.0;

fn main() -> ExitCode {
    // Cargo sets this variable for a program that it runs; without it the current folder serves.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    match run(&root.join("target/campbell"), &mut std::io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("campbell: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(folder: &Path, screen: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut model = Parameters::default().model()?;
    stiffen(&mut model)?;
    let speeds: Vec<f64> = (0..POINTS)
        .map(|i| (RPM.0 + (RPM.1 - RPM.0) * i as f64 / (POINTS - 1) as f64) * PER_RPM)
        .collect();
    let selection = (DIAMETER, LinearContacts::Stuck, COUNT);
    let found = campbell(&model, &speeds, selection, &ENGINE_ORDERS, &mut Hooks::default())?;
    writeln!(screen, "Engine orders meet modes of nodal diameter {DIAMETER}:")?;
    for crossing in &found.crossings {
        writeln!(
            screen,
            "  EO {:>2} at {:>9.3} rpm, {:>9.4} Hz",
            crossing.engine_order,
            crossing.speed / PER_RPM,
            crossing.omega / TAU
        )?;
    }
    over_speed(folder, &found)?;
    let first = found.crossings.iter().find(|c| c.engine_order == ENGINE_ORDERS[0]);
    let speed = first.ok_or("no engine order meets a mode")?.speed;
    over_diameter(folder, model, speed)?;
    writeln!(screen, "Figures and their data: {}", folder.display())?;
    Ok(())
}

/// Springs of the blades at speed: the load of a mass m at a radius R, m R Ω², stretches the blade of the length l to its
/// root and pulls its sideways motion back by m (R/l) Ω². With R/l = 2 for both masses.
fn stiffen(model: &mut Model) -> Result<(), Box<dyn Error>> {
    const RADIUS_OVER_LENGTH: f64 = 2.0;
    let (tip, root) = (0.2 * RADIUS_OVER_LENGTH, 0.5 * RADIUS_OVER_LENGTH);
    // b2 –tip– b1 –root– d: the root carries both masses.
    let mut stiffness = [0.0; 16];
    for (i, j, k) in [(0, 1, tip), (1, 2, root)] {
        stiffness[5 * i] += k;
        stiffness[5 * j] += k;
        stiffness[4 * i + j] -= k;
        stiffness[4 * j + i] -= k;
    }
    Ok(model.set_matrix(MatrixKind::StiffnessSpeed2, &MatrixView::dense(4, &stiffness))?)
}

/// The Campbell diagram.
fn over_speed(folder: &Path, found: &Campbell) -> Result<(), Box<dyn Error>> {
    let curve = |k: usize| -> Vec<(f64, f64)> {
        let rows = found.speeds.iter().zip(found.omega.chunks_exact(found.count));
        rows.map(|(speed, omega)| (speed / PER_RPM, omega[k] / TAU)).collect()
    };
    let mut rows = Vec::new();
    for (i, speed) in found.speeds.iter().enumerate() {
        let mut row = vec![speed / PER_RPM];
        row.extend((0..found.count).map(|k| found.omega[i * found.count + k] / TAU));
        rows.push(row);
    }
    write_csv(
        folder.join("campbell.csv"),
        &["rpm", "mode_1_Hz", "mode_2_Hz", "mode_3_Hz"],
        &rows,
    )?;
    let mut series: Vec<Series> = (0..found.count)
        .map(|k| Series::new(format!("mode {}", k + 1), Style::Line, curve(k)))
        .collect();
    let top = found.omega.iter().fold(0.0_f64, |m, w| m.max(w / TAU));
    for order in ENGINE_ORDERS {
        let ray = |rpm: f64| (rpm, order as f64 * rpm / 60.0);
        let end = RPM.1.min(60.0 * top / order as f64);
        series.push(Series::new(
            format!("EO {order}"),
            Style::Dashed,
            vec![ray(RPM.0), ray(end)],
        ));
    }
    let crossings = found.crossings.iter().map(|c| (c.speed / PER_RPM, c.omega / TAU));
    series.push(Series::new("resonance", Style::Markers, crossings.collect()));
    let figure = Figure {
        title: format!("Campbell diagram of nodal diameter {DIAMETER}, ring stuck"),
        x_label: "Speed [rpm]".into(),
        y_label: "Frequency [Hz]".into(),
        x_range: Some(RPM),
        y_range: Some((0.0, 1.05 * top)),
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("campbell"))
}

/// The interference diagram at the speed of the first resonance: frequencies over nodal diameter, and the frequency of
/// each engine order at the nodal diameter that it excites.
fn over_diameter(folder: &Path, mut model: Model, speed: f64) -> Result<(), Box<dyn Error>> {
    model.set_speed(Speed::Fixed(speed))?;
    let (mut rows, mut modes) = (Vec::new(), Vec::new());
    for diameter in 0..=LARGEST_DIAMETER {
        let found = damped_modes(&model, diameter, LinearContacts::Stuck, COUNT, &mut Hooks::default())?;
        for k in 0..found.count() {
            rows.push(vec![diameter as f64, (k + 1) as f64, found.omega(k) / TAU]);
            modes.push((diameter as f64, found.omega(k) / TAU));
        }
    }
    write_csv(
        folder.join("interference.csv"),
        &["nodal_diameter", "mode", "Hz"],
        &rows,
    )?;
    let top = modes.iter().fold(0.0_f64, |m, p| m.max(p.1));
    let highest = (top * TAU / speed) as usize;
    let zigzag = (0..=highest).map(|order| {
        let residue = order % SECTORS;
        (residue.min(SECTORS - residue) as f64, order as f64 * speed / TAU)
    });
    let series = vec![
        Series::new("engine orders", Style::Dashed, zigzag.collect()),
        Series::new("modes", Style::Markers, modes),
    ];
    let figure = Figure {
        title: format!(
            "Interference of engine orders at {:.1} rpm, ring stuck",
            speed / PER_RPM
        ),
        x_label: "Nodal diameter".into(),
        y_label: "Frequency [Hz]".into(),
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("interference"))
}
