//! The best damper: the peak against the normal load with its optimum and derivative, a map of the peak over ring mass and
//! speed, and the sensitivities of the peak at the optimum; as CSV, SVG and PNG, with a short table on the screen.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use hbvib::{
    BatchOptions, Branch, Constant, Follow, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Optimum, Parameter,
    ParameterRange, Quantity, SolverOptions, Status, batch, forced_response, parameter_response, sensitivity,
};

use crate::COMMON;
use crate::csv::write_csv;
use crate::figures::folder;
use crate::flags::{Flag, Flags};
use crate::mode;
use crate::model::{B2, CONTACT, Parameters};
use crate::plot::{Figure, Series, Style};
use crate::single;

/// The flags that only a study has.
pub const FLAGS: [Flag; 2] = [
    Flag::new("--study", "", "seek the best damper instead of a response"),
    Flag::new("--grid", "n", "designs along each side of the map, 2 to 1000 (100)"),
];

/// Normal loads of the curve, N.
const LOADS: (f64, f64) = (100.0, 1200.0);

/// Frequency near the peak at the first load, Hz.
const FIRST_PEAK: f64 = 207.8;

/// Tolerance of the curve with harmonics that suffice.
const TOLERANCE: f64 = 1e-4;

/// Ring masses, kg, and speeds, 1/min, of the map.
const MASSES: (f64, f64) = (0.005, 0.06);
const SPEEDS: (f64, f64) = (1000.0, 6000.0);

/// Range of frequency of the map, Hz.
const RANGE: (f64, f64) = (200.0, 215.0);

/// Classes of amplitude of the map.
const CLASSES: usize = 8;

/// Change of a parameter by which its effect is shown.
const CHANGE: f64 = 0.1;

/// A requested study.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    grid: usize,
}

impl Request {
    /// Interprets the flags.
    ///
    /// # Errors
    ///
    /// A sentence naming the flag whose value cannot be used.
    pub fn new(flags: &Flags) -> Result<Self, String> {
        if !flags.has("--study") {
            return Err("--grid belongs to a study, it needs --study".into());
        }
        for others in [&COMMON[..], &single::FLAGS, &mode::FLAGS] {
            if let Some(name) = flags.first_of(others) {
                return Err(format!("{name} cannot be given with --study"));
            }
        }
        let grid = flags.value("--grid", "2 to 1000", |n: &usize| (2..=1000).contains(n))?;
        Ok(Self {
            grid: grid.unwrap_or(100),
        })
    }

    /// Computes and writes the study.
    ///
    /// # Errors
    ///
    /// If a computation fails or a file cannot be written.
    pub fn run(self) -> Result<(), Box<dyn Error>> {
        let folder = folder();
        let model = Parameters::default().model()?;
        let optimum = over_load(&model, &folder)?;
        let optimum = tornado(&model, optimum, &folder)?;
        self.map(&model, optimum, &folder)?;
        writeln!(std::io::stdout(), "\nFigures and their data: {}", folder.display())?;
        Ok(())
    }

    /// Peaks of all designs over ring mass and speed.
    fn map(self, model: &Model, optimum: f64, folder: &Path) -> Result<(), Box<dyn Error>> {
        let ring = direction(3);
        let parameters = [
            Parameter::Direction {
                which: MatrixKind::Mass,
                direction: MatrixView::dense(4, &ring),
            },
            preload(),
        ];
        let base = Parameters::default();
        let mut designs = Vec::new();
        for i in 0..self.grid {
            for j in 0..self.grid {
                let share = |k: usize| k as f64 / (self.grid - 1) as f64;
                designs.push(Parameters {
                    ring_mass: MASSES.0 + share(i) * (MASSES.1 - MASSES.0),
                    rpm: SPEEDS.0 + share(j) * (SPEEDS.1 - SPEEDS.0),
                    ..base
                });
            }
        }
        let values: Vec<f64> = designs
            .iter()
            .flat_map(|d| [d.ring_mass - base.ring_mass, d.normal_load()])
            .collect();
        let threads = std::thread::available_parallelism().map_or(1, usize::from).min(64);
        let options = BatchOptions {
            omega_start: RANGE.0 * TAU,
            omega_stop: RANGE.1 * TAU,
            threads,
            keep: false,
            responses: &[],
        };
        let begin = Instant::now();
        let found = batch(
            model,
            &solver(0.0),
            &options,
            (&parameters, &values),
            &mut Hooks::default(),
        )?;
        let seconds = begin.elapsed().as_secs_f64();
        let mut rows = Vec::new();
        for (design, peak) in designs.iter().zip(found.peaks()) {
            rows.push(vec![
                1000.0 * design.ring_mass,
                design.rpm,
                design.normal_load(),
                peak.omega / TAU,
                peak.amplitude,
            ]);
        }
        let header = ["ring_mass_g", "speed_rpm", "normal_load_N", "peak_Hz", "peak_m"];
        write_csv(folder.join("study_map.csv"), &header, &rows)?;
        let failed = found.peaks().iter().filter(|p| p.status != Status::Ok).count();
        let best = rows.iter().min_by(|a, b| a[4].total_cmp(&b[4])).ok_or("no designs")?;
        writeln!(
            std::io::stdout(),
            "\nPeak over ring mass and speed, nine harmonics: {} designs in {seconds:.1} s on {threads} threads, {failed} without a peak.\n\
             Least: {:.4} mm with {:.1} g at {:.0} rpm, N0 = {:.1} N.",
            rows.len(),
            1000.0 * best[4],
            best[0],
            best[1],
            best[2]
        )?;
        map_figure(&rows, optimum, folder)
    }
}

/// Draws the map from its rows.
fn map_figure(rows: &[Vec<f64>], optimum: f64, folder: &Path) -> Result<(), Box<dyn Error>> {
    let (low, high) = rows
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(l, h), r| (l.min(r[4]), h.max(r[4])));
    let edge = |k: usize| low * (high / low).powf(k as f64 / CLASSES as f64);
    let class = |a: f64| (1..CLASSES).filter(|&k| a >= edge(k)).count();
    let mut series: Vec<Series> = (0..CLASSES)
        .map(|k| {
            let inside = rows.iter().filter(|r| class(r[4]) == k);
            let points = inside.map(|r| (r[0], r[1])).collect();
            Series::new(
                format!("{:.2} to {:.2}", 1000.0 * edge(k), 1000.0 * edge(k + 1)),
                Style::Cells,
                points,
            )
        })
        .collect();
    // The hyperbola of the best normal load.
    let along = (0..=100).map(|k| MASSES.0 + f64::from(k) / 100.0 * (MASSES.1 - MASSES.0));
    let best_speed = |mass: f64| {
        let one = Parameters {
            ring_mass: mass,
            rpm: 1.0,
            ..Parameters::default()
        };
        (1000.0 * mass, (optimum / one.normal_load()).sqrt())
    };
    series.push(Series::new("best load", Style::Dashed, along.map(best_speed).collect()));
    Figure {
        title: "Peak over ring mass and speed".into(),
        x_label: "Ring mass per sector [g]".into(),
        y_label: "Speed [rpm]".into(),
        x_range: Some((1000.0 * MASSES.0, 1000.0 * MASSES.1)),
        y_range: Some(SPEEDS),
        legend_title: "Peak [mm]".into(),
        series,
        ..Figure::default()
    }
    .save(&folder.join("study_map"))
}

/// The preload of the contact as a parameter.
fn preload() -> Parameter<'static> {
    Parameter::Contact {
        constant: Constant::Preload,
        contact: Some(CONTACT),
    }
}

/// A matrix with one number, 1, on its diagonal.
fn direction(dof: usize) -> [f64; 16] {
    let mut matrix = [0.0; 16];
    matrix[5 * dof] = 1.0;
    matrix
}

/// Nine harmonics, or those that a tolerance requires.
fn solver(tolerance: f64) -> SolverOptions {
    SolverOptions {
        harmonics: 9,
        tolerance,
        response_dof: Some(B2),
        ..SolverOptions::default()
    }
}

/// The peak against the normal load; returns the optimum with converged harmonics.
fn over_load(model: &Model, folder: &Path) -> Result<Optimum, Box<dyn Error>> {
    let mut screen = std::io::stdout().lock();
    writeln!(screen, "Peak against the normal load\n")?;
    writeln!(
        screen,
        "harmonics          best N0 [N]   peak [Hz]   peak [mm]   points"
    )?;
    let mut rows = Vec::new();
    let (mut peaks, mut slopes) = (Vec::new(), Vec::new());
    let mut best = None;
    for (tolerance, label) in [(0.0, "9"), (TOLERANCE, "by tolerance 1e-4")] {
        let range = ParameterRange {
            start: LOADS.0,
            stop: LOADS.1,
            at: &[],
            follow: Follow::Peak(FIRST_PEAK * TAU),
            response: None,
        };
        let found = parameter_response(model, &solver(tolerance), preload(), &range, &mut Hooks::default())?;
        let optima = found.optima().iter().filter(|o| !o.is_maximum);
        let least = *optima
            .min_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
            .ok_or("the peak has no minimum over the normal load")?;
        writeln!(
            screen,
            "{label:<18} {:>11.3} {:>11.6} {:>11.6} {:>8}",
            least.parameter,
            least.omega / TAU,
            1000.0 * least.amplitude,
            found.points()
        )?;
        let curve = points(&found, tolerance);
        peaks.push(series(&curve, label, 3));
        slopes.push(series(&curve, label, 4));
        let mark = vec![(least.parameter, 1000.0 * least.amplitude)];
        peaks.push(Series::new(label, Style::Markers, mark));
        rows.extend(curve);
        best = Some(least);
    }
    let header = [
        "tolerance",
        "normal_load_N",
        "peak_Hz",
        "peak_mm",
        "d_peak_um_per_N",
        "harmonics",
    ];
    write_csv(folder.join("study_load.csv"), &header, &rows)?;
    let mut figure = Figure {
        title: "Peak against the normal load (30 g, 5 N)".into(),
        x_label: "Normal load [N]".into(),
        y_label: "Peak of the blade tip [mm]".into(),
        legend_title: "Harmonics".into(),
        series: peaks,
        ..Figure::default()
    };
    figure.save(&folder.join("study_load"))?;
    figure.title = "Derivative of the peak by the normal load".into();
    figure.y_label = "Derivative [um/N]".into();
    figure.series = slopes;
    figure.save(&folder.join("study_load_derivative"))?;
    best.ok_or_else(|| "no curve".into())
}

/// Rows of a curve over the normal load.
fn points(found: &Branch, tolerance: f64) -> Vec<Vec<f64>> {
    let (Some(loads), Some(slopes)) = (found.parameter(), found.d_amplitude()) else {
        return Vec::new();
    };
    let row = |i: usize| {
        let (omega, amplitude) = (found.omega()[i], found.amplitude()[i]);
        let highest = found.harmonics_used()[i];
        vec![
            tolerance,
            loads[i],
            omega / TAU,
            1000.0 * amplitude,
            1e6 * slopes[i],
            highest,
        ]
    };
    (0..found.points()).map(row).collect()
}

/// A column of these rows over the normal load.
fn series(rows: &[Vec<f64>], label: &str, column: usize) -> Series {
    Series::new(label, Style::Line, rows.iter().map(|r| (r[1], r[column])).collect())
}

/// Changes of the peak with each parameter at the optimum, the largest first; returns the best load.
fn tornado(model: &Model, optimum: Optimum, folder: &Path) -> Result<f64, Box<dyn Error>> {
    let mut best = model.clone();
    best.set_preload(CONTACT, optimum.parameter)?;
    let range = ForcedOptions {
        omega_start: 0.98 * optimum.omega,
        omega_stop: 1.02 * optimum.omega,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&best, &solver(TOLERANCE), &range, &mut Hooks::default())?;
    let highest = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let peak = *highest.ok_or("no peak at the optimum")?;
    let base = Parameters::default();
    let ring = direction(3);
    let constant = |constant| Parameter::Contact {
        constant,
        contact: Some(CONTACT),
    };
    let factor = |which| Parameter::Factor { which };
    let ring_mass = Parameter::Direction {
        which: MatrixKind::Mass,
        direction: MatrixView::dense(4, &ring),
    };
    let friction = best.contacts()[CONTACT].constant(Constant::Mu);
    let named = [
        ("force", Parameter::Force, 1.0),
        ("normal load", constant(Constant::Preload), optimum.parameter),
        ("friction coefficient", constant(Constant::Mu), friction),
        ("contact stiffness", constant(Constant::Kt), base.kt),
        ("ring mass", ring_mass, base.ring_mass),
        ("all masses", factor(MatrixKind::Mass), 1.0),
        ("all stiffnesses", factor(MatrixKind::Stiffness), 1.0),
        ("damping", factor(MatrixKind::Damping), 1.0),
    ];
    let parameters = named.map(|(_, parameter, _)| parameter);
    let of = |quantity| sensitivity(&best, &branch, peak.point, &parameters, quantity);
    let (amplitude, omega) = (of(Quantity::PeakAmplitude)?.values, of(Quantity::PeakOmega)?.values);
    let mut effects: Vec<(&str, f64, f64)> = named
        .iter()
        .enumerate()
        .map(|(i, (name, _, value))| {
            let percent = |slope: f64, of: f64| 100.0 * CHANGE * value * slope / of;
            (
                *name,
                percent(amplitude[i], peak.amplitude),
                percent(omega[i], peak.omega),
            )
        })
        .collect();
    effects.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let mut screen = std::io::stdout().lock();
    writeln!(
        screen,
        "\nChange of the peak at the optimum for 10 % more, by the derivatives\n"
    )?;
    writeln!(screen, "parameter              amplitude [%]   frequency [%]")?;
    let mut text = Vec::new();
    writeln!(text, "parameter,amplitude_percent,frequency_percent")?;
    let mut bars = Vec::new();
    for (i, (name, amplitude, frequency)) in effects.iter().enumerate() {
        writeln!(screen, "{name:<22} {amplitude:>13.4} {frequency:>15.5}")?;
        writeln!(text, "{name},{amplitude:.16e},{frequency:.16e}")?;
        let row = (effects.len() - i) as f64;
        bars.push(Series::new(*name, Style::Line, vec![(0.0, row), (*amplitude, row)]));
        bars.push(Series::new(*name, Style::Markers, vec![(*amplitude, row)]));
    }
    std::fs::write(folder.join("study_tornado.csv"), text)?;
    Figure {
        title: "Change of the peak at the best load for 10 % more".into(),
        x_label: "Change of the amplitude [%]".into(),
        y_label: "Rank from below".into(),
        y_range: Some((0.5, effects.len() as f64 + 0.5)),
        legend_title: "Parameter".into(),
        series: bars,
        ..Figure::default()
    }
    .save(&folder.join("study_tornado"))?;
    Ok(optimum.parameter)
}
