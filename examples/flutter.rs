//! Flutter of the bladed disk that friction limits: amplitude and stability of limit cycles against aerodynamic damping.
//!
//! A flow drives the forward wave of two nodal diameters alone: influence coefficients c_k = −2G/N sin(4πk/N) between
//! the blade tips give A(d) = iG for d = 2, −iG for the backward wave, and 0 for all others. With mass-normalised
//! shapes the aerodynamic damping ratio of the stuck mode is −G|φ|²/(2ω²). While the ring sticks, the motion grows as
//! soon as this exceeds the damping of the structure. Slip then dissipates: a smaller limit cycle attracts, and a
//! larger one separates it from growth without bound. They meet where friction does its most; beyond, nothing limits
//! the flutter. `cargo run --release --example flutter` writes a table to the screen, and CSV, SVG and PNG to
//! target/flutter/. Exit status: 0 done, 1 a computation or a file failed.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use hbvib::{
    AeroForm, Branch, ContactState, Floquet, FloquetOptions, Hooks, LimitCycle, ModeOptions, Model, SolverOptions,
    Waves, floquet, nonlinear_mode,
};
use num_complex::Complex64;

#[path = "support/csv.rs"]
mod csv;
#[path = "ring_damper/model.rs"]
#[allow(dead_code, reason = "this example uses a part of it")]
mod model;
#[path = "support/plot.rs"]
mod plot;

use model::{B2, Parameters, SECTORS};
use plot::{Figure, Series, Style};

/// Nodal diameter of the wave that the flow drives.
const DIAMETER: i64 = 2;

/// Aerodynamic damping ratios of the stuck mode, percent.
const AERODYNAMIC: [f64; 8] = [-0.12, -0.15, -0.2, -0.28, -0.36, -0.42, -0.45, -0.47];

/// Range of the modal amplitude, common logarithms of m·kg^½.
const AMPLITUDES: (f64, f64) = (-4.5, -1.5);

/// A limit cycle and what its perturbations do.
struct Cycle {
    aerodynamic: f64,
    on_mode: LimitCycle,
    /// Amplitude of the blade tip, m.
    tip: f64,
    stability: Floquet,
}

fn main() -> ExitCode {
    // Cargo sets this variable for a program that it runs; without it the current folder serves.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    match run(&root.join("target/flutter"), &mut std::io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("flutter: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(folder: &Path, screen: &mut impl Write) -> Result<(), Box<dyn Error>> {
    writeln!(
        screen,
        "{:>10}{:>12}{:>14}{:>12}{:>11}{:>11}",
        "aero [%]", "f [Hz]", "tip [m]", "dD/d log a", "radius", ""
    )?;
    let mut cycles = Vec::new();
    for percent in AERODYNAMIC {
        let model = fluttering(percent / 100.0)?;
        let branch = follow(&model)?;
        for cycle in branch.limit_cycles()? {
            let found = verdict(&model, &branch, cycle, percent)?;
            writeln!(
                screen,
                "{percent:>10.3}{:>12.4}{:>14.4e}{:>12.2e}{:>11.6}{:>11}",
                found.stability.omega / TAU,
                found.tip,
                found.on_mode.slope,
                found.stability.radius,
                if found.stability.unstable > 0 {
                    "unstable"
                } else {
                    "stable"
                }
            )?;
            cycles.push(found);
        }
    }
    write(folder, &cycles)?;
    writeln!(screen, "\nFigure and data: {}", folder.display())?;
    Ok(())
}

/// The bladed disk without force, in a flow of an aerodynamic damping ratio.
fn fluttering(ratio: f64) -> Result<Model, Box<dyn Error>> {
    let mut model = Parameters::default().model()?;
    model.clear_forces();
    let stuck = model.linear_modes(DIAMETER, ContactState::Stuck)?;
    let (omega, tip) = (stuck.omega[0], stuck.shapes[B2].norm_sqr());
    let gain = -2.0 * omega * omega * ratio / tip;
    let sectors = SECTORS as f64;
    let coefficient = |k: usize| -2.0 * gain / sectors * (TAU * (DIAMETER * k as i64) as f64 / sectors).sin();
    let coefficients: Vec<Complex64> = (0..SECTORS).map(|k| coefficient(k).into()).collect();
    let offsets: Vec<i64> = (0..SECTORS as i64).collect();
    model.set_aero(&[B2], &coefficients, &offsets, AeroForm::Displacement)?;
    Ok(model)
}

/// The nonlinear mode of the driven wave.
fn follow(model: &Model) -> Result<Branch, Box<dyn Error>> {
    let solver = SolverOptions {
        harmonics: 31,
        tolerance: 0.0,
        response_dof: Some(B2),
        ..SolverOptions::default()
    };
    let range = ModeOptions {
        diameter: Some(DIAMETER),
        log10_start: AMPLITUDES.0,
        log10_stop: AMPLITUDES.1,
        ..ModeOptions::default()
    };
    Ok(nonlinear_mode(model, &solver, &range, &mut Hooks::default())?)
}

/// Shoots for a limit cycle, and computes the multipliers of all perturbations of the wheel.
fn verdict(model: &Model, branch: &Branch, cycle: LimitCycle, percent: f64) -> Result<Cycle, Box<dyn Error>> {
    let options = FloquetOptions {
        waves: Waves::Wheel,
        ..FloquetOptions::default()
    };
    let stability = floquet(model, branch, cycle.point, &options, &mut Hooks::default())?;
    let mut x = vec![Complex64::ZERO; (branch.harmonics() + 1) * branch.ndof()];
    branch.harmonics_at(cycle.point, &mut x)?;
    Ok(Cycle {
        aerodynamic: percent,
        on_mode: cycle,
        tip: x[branch.ndof() + B2].norm(),
        stability,
    })
}

/// Writes CSV and figure.
fn write(folder: &Path, cycles: &[Cycle]) -> Result<(), Box<dyn Error>> {
    let header = [
        "aerodynamic_damping_percent",
        "frequency_Hz",
        "tip_amplitude_m",
        "slope_of_damping",
        "radius",
        "unstable_directions",
    ];
    let row = |c: &Cycle| {
        let stability = &c.stability;
        let frequency = stability.omega / TAU;
        let unstable = stability.unstable as f64;
        vec![
            c.aerodynamic,
            frequency,
            c.tip,
            c.on_mode.slope,
            stability.radius,
            unstable,
        ]
    };
    let rows: Vec<Vec<f64>> = cycles.iter().map(row).collect();
    csv::write_csv(folder.join("limit_cycles.csv"), &header, &rows)?;
    // The damping ratio rises through the smaller cycle and falls through the larger one.
    let side = |smaller: bool| {
        let same = cycles.iter().filter(|c| (c.on_mode.slope > 0.0) == smaller);
        same.collect::<Vec<_>>()
    };
    let mut series = Vec::new();
    for (label, same) in [("smaller cycle", side(true)), ("larger cycle", side(false))] {
        for unstable in [false, true] {
            let style = if unstable { Style::Dashed } else { Style::Line };
            let points = same.iter().map(|c| {
                let shown = (c.stability.unstable > 0) == unstable;
                (c.aerodynamic, if shown { 1e3 * c.tip } else { f64::NAN })
            });
            let points: Vec<_> = points.collect();
            if points.iter().any(|p| p.1.is_finite()) {
                series.push(Series::new(label, style, points.clone()));
                series.push(Series::new(label, Style::Markers, points));
            }
        }
    }
    let figure = Figure {
        title: "Limit cycles of the bladed disk with a ring damper (dashed: unstable)".into(),
        x_label: "Aerodynamic damping ratio [%]".into(),
        y_label: "Amplitude of the blade tip [mm]".into(),
        log_y: true,
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("limit_cycles"))
}
