//! Figures 4 to 9 of the paper, each as CSV, SVG and PNG, with a short table on the screen.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use hbvib::SolverOptions;

use crate::csv::write_csv;
use crate::model::{LARGEST_DIAMETER, Parameters, REPORTED_DOFS, modes_with_ring_stuck, modes_without_ring};
use crate::modes::{self, Overlay};
use crate::plot::{Figure, Series, Style};
use crate::progress::Bar;
use crate::response::{Range, Response};
use crate::stability;

/// Range of frequency that shows the resonance of nodal diameter 2 from the ring sliding (207.8 Hz) to stuck (210.0
/// Hz).
pub const RANGE: (f64, f64) = (207.0, 211.0);

/// Largest step along a curve, small enough for it to be drawn smoothly.
pub const SMOOTH: f64 = 0.005;

/// Points of a curve whose Floquet multipliers are computed.
const CHECKS: usize = 4;

/// A response with the value of its parameter.
struct Case {
    value: f64,
    response: Response,
    /// Whether each point of its curve is unstable.
    unstable: Vec<bool>,
    seconds: f64,
}

/// A parameter that is varied over one figure.
struct Study {
    number: u32,
    title: &'static str,
    /// Name and unit of the parameter, for legend and screen.
    parameter: &'static str,
    /// Name of the column of the parameter.
    column: &'static str,
    values: &'static [f64],
    case: fn(f64) -> Parameters,
}

const STUDIES: [Study; 3] = [
    Study {
        number: 5,
        title: "Response to different forces (30 g, 3000 rpm)",
        parameter: "Force [N]",
        column: "force_N",
        values: &[0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0],
        case: |force| Parameters {
            force,
            ..Parameters::default()
        },
    },
    Study {
        number: 6,
        title: "Response with different ring masses (5 N, 3000 rpm)",
        parameter: "Ring mass [g]",
        column: "ring_mass_g",
        values: &[10.0, 20.0, 30.0, 40.0, 50.0, 60.0],
        case: |grams| Parameters {
            ring_mass: grams / 1000.0,
            ..Parameters::default()
        },
    },
    Study {
        number: 7,
        title: "Response at different speeds (5 N, 30 g)",
        parameter: "Speed [rpm]",
        column: "speed_rpm",
        values: &[1000.0, 2000.0, 3000.0, 4000.0, 5000.0, 6000.0],
        case: |rpm| Parameters {
            rpm,
            ..Parameters::default()
        },
    },
];

/// Computes and writes all figures.
///
/// # Errors
///
/// If a response cannot be computed or a file cannot be written.
pub fn run() -> Result<(), Box<dyn Error>> {
    let folder = folder();
    natural_frequencies(&folder)?;
    for study in &STUDIES {
        study.run(&folder)?;
    }
    modes::against_energy(&folder)?;
    writeln!(std::io::stdout(), "\nFigures and their data: {}", folder.display())?;
    Ok(())
}

/// The folder of the figures.
pub fn folder() -> PathBuf {
    // Cargo sets this variable for a program that it runs; without it the current folder serves.
    let root = std::env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .unwrap_or_default();
    root.join("target").join("ring_damper")
}

/// Natural frequencies against nodal diameter, Fig. 4.
fn natural_frequencies(folder: &Path) -> Result<(), Box<dyn Error>> {
    const FAMILIES: [&str; 3] = ["1st family", "2nd family", "3rd family"];
    let base = Parameters::default();
    let mut rows = Vec::new();
    for diameter in 0..=LARGEST_DIAMETER {
        let free = modes_without_ring(diameter)?;
        let stuck = modes_with_ring_stuck(&base, diameter)?;
        let both = free.omega.iter().take(3).chain(stuck.omega.iter().take(3));
        let mut row = vec![diameter as f64];
        row.extend(both.map(|omega| omega / TAU));
        rows.push(row);
    }
    let header = [
        "nodal_diameter",
        "no_ring_1_Hz",
        "no_ring_2_Hz",
        "no_ring_3_Hz",
        "ring_stuck_1_Hz",
        "ring_stuck_2_Hz",
        "ring_stuck_3_Hz",
    ];
    write_csv(folder.join("figure4.csv"), &header, &rows)?;

    let column = |i: usize| rows.iter().map(|row| (row[0], row[i])).collect::<Vec<_>>();
    let mut series = Vec::new();
    for (i, family) in FAMILIES.into_iter().enumerate() {
        series.push(Series::new(family, Style::Line, column(1 + i)));
        series.push(Series::new(family, Style::Markers, column(1 + i)));
    }
    for i in 0..FAMILIES.len() {
        series.push(Series::new("ring stuck, 30 g", Style::Dashed, column(4 + i)));
    }
    let figure = Figure {
        title: "Natural frequencies without the ring (dashed: ring stuck)".into(),
        x_label: "Nodal diameter".into(),
        y_label: "Natural frequency [Hz]".into(),
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("figure4"))?;

    let mut screen = std::io::stdout().lock();
    writeln!(screen, "Figure 4: natural frequencies [Hz]")?;
    writeln!(screen, "{:>9}{:>30}{:>34}", "diameter", "no ring", "ring stuck")?;
    for row in &rows {
        write!(screen, "{:>9}   ", row[0])?;
        for (i, frequency) in row[1..].iter().enumerate() {
            write!(screen, "{}{frequency:>10.3}", if i == 3 { "    " } else { "" })?;
        }
        writeln!(screen)?;
    }
    Ok(())
}

impl Study {
    fn run(&self, folder: &Path) -> Result<(), Box<dyn Error>> {
        let solver = SolverOptions {
            step_max: SMOOTH,
            tolerance: 0.0,
            ..SolverOptions::default()
        };
        let range = Range {
            from: RANGE.0,
            to: RANGE.1,
            at: Vec::new(),
        };
        let count = self.values.len();
        let mut bar = Bar::new(format!("Figure {}, curves", self.number), count as u64);
        let mut cases = Vec::new();
        for (i, &value) in self.values.iter().enumerate() {
            let begin = Instant::now();
            let progress = |share: f64| bar.set((i as f64 + share) / count as f64);
            let failed = |e: Box<dyn Error>| format!("{} = {value}: {e}", self.parameter);
            let model = (self.case)(value).model().map_err(failed)?;
            let response = Response::follow(&model, &solver, &range, &REPORTED_DOFS, progress).map_err(failed)?;
            let seconds = begin.elapsed().as_secs_f64();
            cases.push(Case {
                value,
                unstable: stability::checked(&model, &response, CHECKS).map_err(failed)?,
                response,
                seconds,
            });
        }
        bar.finish();

        let mut rows = Vec::new();
        for case in &cases {
            let points = case.response.points.iter();
            rows.extend(points.map(|p| vec![case.value, p.frequency, p.amplitude()]));
        }
        let stem = folder.join(format!("figure{}", self.number));
        write_csv(
            stem.with_extension("csv"),
            &[self.column, "frequency_Hz", "amplitude_b2_m"],
            &rows,
        )?;
        let mut figure = self.plot(&cases, |_| 1.0, "Amplitude of b2 [m]");
        let mut overlay = None;
        if self.number == 5 {
            let peaks = cases.iter().map(|case| {
                let peak = &case.response.peak;
                (case.value, peak.frequency, peak.amplitude())
            });
            let mode = Overlay::new(&solver, &peaks.collect::<Vec<_>>())?;
            figure.series.extend(mode.series());
            mode.write(folder)?;
            overlay = Some(mode);
            // Divided by the force, all curves of the stuck ring coincide, and so do those of the sliding ring.
            let mut receptance = self.plot(&cases, |force| force, "Amplitude of b2 / force [m/N]");
            receptance.title = "Amplitude per force under different forces (30 g, 3000 rpm)".into();
            receptance.save(&folder.join("figure5_receptance"))?;
        }
        figure.save(&stem)?;

        let mut screen = std::io::stdout().lock();
        writeln!(screen, "\nFigure {}: {}", self.number, self.title)?;
        writeln!(
            screen,
            "{:>13}{:>12}{:>18}{:>9}{:>11}",
            self.parameter, "peak [Hz]", "amplitude [m]", "points", "time [ms]"
        )?;
        for case in &cases {
            let (value, response, seconds) = (case.value, &case.response, case.seconds);
            let (frequency, amplitude) = (response.peak.frequency, response.peak.amplitude());
            let (points, time) = (response.points.len(), 1e3 * seconds);
            writeln!(
                screen,
                "{value:>13}{frequency:>12.4}{amplitude:>18.6e}{points:>9}{time:>11.1}"
            )?;
        }
        if let Some(mode) = overlay {
            mode.show(&mut screen)?;
            modes::with_many_harmonics(&mut screen)?;
        }
        Ok(())
    }

    /// The curves with their peaks marked and unstable stretches dashed, each divided by `unit` of its parameter.
    fn plot(&self, cases: &[Case], unit: impl Fn(f64) -> f64, y_label: &str) -> Figure {
        let mut series = Vec::new();
        for Case {
            value,
            response,
            unstable,
            ..
        } in cases
        {
            let (unit, label) = (unit(*value), value.to_string());
            let curve = response.points.iter().map(|p| (p.frequency, p.amplitude() / unit));
            let peak = (response.peak.frequency, response.peak.amplitude() / unit);
            series.extend(stability::series(&label, &curve.collect::<Vec<_>>(), unstable));
            series.push(Series::new(label, Style::Markers, vec![peak]));
        }
        Figure {
            title: self.title.into(),
            x_label: "Frequency [Hz]".into(),
            y_label: y_label.into(),
            x_range: Some(RANGE),
            log_y: true,
            series,
            legend_title: self.parameter.into(),
            ..Figure::default()
        }
    }
}
