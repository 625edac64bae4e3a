//! The nonlinear mode of the base case: figures 8 and 9 of the paper, and the responses of Fig. 5 synthesised from
//! it.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use hbvib::{Branch, DampingForm, SolverOptions, SynthesisOptions, SynthesisPeak, synthesise};

use crate::backbone::{Backbone, ModeRequest, Point};
use crate::csv::write_csv;
use crate::figures::{RANGE, SMOOTH};
use crate::model::{B2, Parameters, REPORTED_DOFS};
use crate::plot::{Figure, Series, Style};
use crate::progress::Bar;
use crate::response::{Range, Response};

/// Range of slip of the ring, from stuck to the limit of free sliding.
const SLIPS: (f64, f64) = (0.1, 1e4);

/// Range of slip that covers the responses of Fig. 5 with a margin on both sides.
const SLIPS_OF_RESPONSES: (f64, f64) = (0.01, 4e3);

/// With this number of harmonics the response is accurate to 1e-4, which separates the error of the synthesis from
/// that of the harmonics.
const MANY_HARMONICS: usize = 63;

/// The first family at nodal diameter 2.
fn request(beta: f64, (from, to): (f64, f64)) -> ModeRequest {
    ModeRequest {
        parameters: Parameters {
            beta,
            ..Parameters::default()
        },
        family: 1,
        damping: DampingForm::Mass,
        from,
        to,
        at: Vec::new(),
    }
}

/// Frequency and damping against energy, Figs 8 and 9.
///
/// # Errors
///
/// If the mode cannot be computed or a file cannot be written.
pub fn against_energy(folder: &Path) -> Result<(), Box<dyn Error>> {
    let solver = SolverOptions {
        step_max: SMOOTH,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let mut bar = Bar::new("Figures 8 and 9, percent", 100);
    let begin = Instant::now();
    let mode = Backbone::follow(&request(0.0, SLIPS), &solver, |share| bar.set(share))?;
    let time = 1e3 * begin.elapsed().as_secs_f64();
    bar.finish();
    let peak = mode.max_damping.as_ref().ok_or("the damping ratio has no maximum")?;
    let (Some(stuck), Some(sliding)) = (mode.points.first(), mode.points.last()) else {
        return Err("the mode has no points".into());
    };

    let case = format!(
        "nodal diameter 2, 1st family (30 g, 3000 rpm, H = {})",
        solver.harmonics
    );
    let one =
        |number: u32, what: &str, column: &str, y_label: &str, curve: Vec<(f64, f64)>, mark: Option<(f64, f64)>| {
            let stem = folder.join(format!("figure{number}"));
            let rows: Vec<Vec<f64>> = curve.iter().map(|p| vec![p.0, p.1]).collect();
            write_csv(stem.with_extension("csv"), &["kinetic_energy_peak_J", column], &rows)?;
            let mut series = vec![Series::new("", Style::Line, curve)];
            series.extend(mark.map(|p| Series::new("", Style::Markers, vec![p])));
            let figure = Figure {
                title: format!("{what}: {case}"),
                x_label: "Kinetic energy per sector, peak [J]".into(),
                y_label: y_label.into(),
                log_x: true,
                series,
                ..Figure::default()
            };
            figure.save(&stem)
        };
    let curve = |y: fn(&Point) -> f64| mode.points.iter().map(|p| (p.kinetic_peak, y(p))).collect();
    one(
        8,
        "Frequency",
        "frequency_Hz",
        "Natural frequency [Hz]",
        curve(|p| p.frequency),
        None,
    )?;
    let mark = Some((peak.kinetic_peak, 100.0 * peak.damping_ratio));
    one(
        9,
        "Damping",
        "damping_ratio_percent",
        "Damping ratio [%]",
        curve(|p| 100.0 * p.damping_ratio),
        mark,
    )?;

    let mut screen = std::io::stdout().lock();
    writeln!(screen, "\nFigures 8 and 9: {case}")?;
    writeln!(
        screen,
        "{:>11}{:>14}{:>18}{:>16}{:>9}{:>11}",
        "stuck [Hz]", "sliding [Hz]", "largest damping", "at energy [J]", "points", "time [ms]"
    )?;
    writeln!(
        screen,
        "{:>11.4}{:>14.4}{:>18.6e}{:>16.6e}{:>9}{time:>11.1}",
        stuck.frequency,
        sliding.frequency,
        peak.damping_ratio,
        peak.kinetic_peak,
        mode.points.len()
    )?;
    Ok(())
}

/// A resonance: force, frequency in Hz and amplitude of b2.
pub type Resonance = (f64, f64, f64);

/// The nonlinear mode beside responses.
#[derive(Debug)]
pub struct Overlay {
    branch: Branch,
    harmonics: usize,
    rows: Vec<Row>,
}

/// A computed resonance beside the one synthesised from the mode.
#[derive(Debug)]
struct Row {
    computed: Resonance,
    frequency: f64,
    amplitude: f64,
    /// Assessment of the validity of the synthesis.
    judgement: &'static str,
}

impl Overlay {
    /// Synthesises the resonances under the same forces from the mode, whose damping includes that of the
    /// structure: this preserves the phases between the masses, which damping changes.
    ///
    /// # Errors
    ///
    /// If the mode cannot be computed or has no resonance under one of the forces.
    pub fn new(solver: &SolverOptions, computed: &[Resonance]) -> Result<Self, Box<dyn Error>> {
        let base = Parameters::default();
        let solver = SolverOptions {
            response_dof: Some(B2),
            ..*solver
        };
        let branch = Backbone::follow(&request(base.beta, SLIPS_OF_RESPONSES), &solver, |_| {})?.branch;
        let mut rows = Vec::new();
        for &computed in computed {
            let force = computed.0;
            let model = Parameters { force, ..base }.model()?;
            let synthesis = synthesise(&branch, &model, &SynthesisOptions::default())?;
            let amplitude = |p: &SynthesisPeak| p.at.response.norm();
            let largest = synthesis
                .peaks
                .iter()
                .max_by(|a, b| amplitude(a).total_cmp(&amplitude(b)));
            let peak = largest.ok_or_else(|| format!("the mode has no resonance under {force} N"))?;
            rows.push(Row {
                computed,
                frequency: peak.at.omega / TAU,
                amplitude: amplitude(peak),
                judgement: match (peak.validity.another_mode(), peak.validity.internal_resonance()) {
                    (false, false) => "valid",
                    (true, false) => "another mode near",
                    (false, true) => "internal resonance",
                    (true, true) => "another mode near, internal resonance",
                },
            });
        }
        Ok(Self {
            branch,
            harmonics: solver.harmonics,
            rows,
        })
    }

    /// The backbone and the synthesised resonances as series of one label.
    pub fn series(&self) -> [Series; 2] {
        let hertz = self.branch.omega().iter().map(|omega| omega / TAU);
        let curve = hertz.zip(self.branch.amplitude().iter().copied()).collect();
        let peaks = self.rows.iter().map(|row| (row.frequency, row.amplitude)).collect();
        [
            Series::new("nonlinear mode", Style::Dashed, curve),
            Series::new("nonlinear mode", Style::Rings, peaks),
        ]
    }

    /// Writes the backbone to `figure5_mode.csv` and the resonances to `figure5_resonances.csv`.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Box<dyn Error>> {
        let [curve, _] = self.series();
        let rows: Vec<Vec<f64>> = curve.points.iter().map(|p| vec![p.0, p.1]).collect();
        write_csv(
            folder.join("figure5_mode.csv"),
            &["frequency_Hz", "amplitude_b2_m"],
            &rows,
        )?;
        let row = |r: &Row| vec![r.computed.0, r.computed.1, r.computed.2, r.frequency, r.amplitude];
        let header = [
            "force_N",
            "computed_Hz",
            "computed_b2_m",
            "synthesised_Hz",
            "synthesised_b2_m",
        ];
        let rows: Vec<Vec<f64>> = self.rows.iter().map(row).collect();
        write_csv(folder.join("figure5_resonances.csv"), &header, &rows)
    }

    /// Shows the resonances, computed and synthesised.
    ///
    /// # Errors
    ///
    /// If the screen cannot be written to.
    pub fn show(&self, screen: &mut impl Write) -> std::io::Result<()> {
        writeln!(
            screen,
            "\nResonances computed and synthesised from the nonlinear mode (with the structure's damping, H = {})",
            self.harmonics
        )?;
        writeln!(
            screen,
            "{:>13}{:>15}{:>18}{:>12}{:>13}   synthesis",
            "Force [N]", "computed [m]", "synthesised [m]", "error", "error [Hz]"
        )?;
        for row in &self.rows {
            let (force, frequency, amplitude) = row.computed;
            writeln!(
                screen,
                "{force:>13}{amplitude:>15.6e}{:>18.6e}{:>12.1e}{:>13.1e}   {}",
                row.amplitude,
                row.amplitude / amplitude - 1.0,
                row.frequency - frequency,
                row.judgement
            )?;
        }
        Ok(())
    }
}

/// Compares resonances with many harmonics.
///
/// # Errors
///
/// If a response or the mode cannot be computed.
pub fn with_many_harmonics(screen: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let solver = SolverOptions {
        harmonics: MANY_HARMONICS,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let range = Range {
        from: RANGE.0,
        to: RANGE.1,
        at: Vec::new(),
    };
    let mut computed = Vec::new();
    for force in [1.0, 5.0, 20.0] {
        let parameters = Parameters {
            force,
            ..Parameters::default()
        };
        let peak = Response::follow(&parameters.model()?, &solver, &range, &REPORTED_DOFS, |_| {})?.peak;
        computed.push((force, peak.frequency, peak.amplitude()));
    }
    Ok(Overlay::new(&solver, &computed)?.show(screen)?)
}
