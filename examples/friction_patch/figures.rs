//! Natural frequencies, responses and energy balance, as CSV, SVG and PNG with short tables on the screen.

use std::error::Error;
use std::f64::consts::TAU;
use std::io::Write;
use std::path::Path;

use hbvib::{ContactState, SolverOptions};
use num_complex::Complex64;

use crate::beam::{Beam, Y, Z};
use crate::csv::write_csv;
use crate::maps;
use crate::plot::{Figure, Series, Style};
use crate::progress::Bar;
use crate::response::{Point, Range, Response};
use crate::stability;

/// Result of every part of the program.
pub type Outcome = Result<(), Box<dyn Error>>;

/// Amplitudes of the force across the beam, N.
const FORCES: [f64; 4] = [1.0, 3.0, 6.0, 12.0];
/// The force whose contacts are examined.
const EXAMINED: f64 = 6.0;
/// The force upwards, as a share of the force across.
pub const LIFT: f64 = 0.1;
const HARMONICS: usize = 3;
/// Hz
const RANGE: (f64, f64) = (380.0, 600.0);
/// Largest step along a curve, small enough for it to be drawn smoothly.
const SMOOTH: f64 = 0.05;
/// Points of a linear response.
const LINEAR_POINTS: usize = 400;

/// Computes and writes everything.
///
/// # Errors
///
/// If a response cannot be computed or a file cannot be written.
pub fn run(folder: &Path, screen: &mut impl Write) -> Outcome {
    let beam = Beam::default();
    frequencies(&beam, screen)?;
    let mut series = Vec::new();
    let mut upwards = Vec::new();
    let mut rows = Vec::new();
    for force in FORCES {
        let response = follow(&beam, force)?;
        let peak = &response.peak;
        writeln!(
            screen,
            "\nResponse to {force} N: {} points, {} iterations, peak {:.2} µm/N at {:.2} Hz",
            response.points.len(),
            response.iterations(),
            1e6 * peak.amplitude() / force,
            peak.frequency
        )?;
        balance(&beam, &response, force, screen)?;
        for p in &response.points {
            rows.push(vec![force, p.frequency, p.amplitude(), amplitude_upwards(p)]);
        }
        // Integration in time does not take friction in a plane, but folds tell where a motion is unstable.
        let (label, unstable) = (format!("{force} N"), stability::between_folds(&response));
        let points = response.points.iter();
        let points: Vec<_> = points.map(|p| (p.frequency, 1e6 * p.amplitude() / force)).collect();
        series.extend(stability::series(&label, &points, &unstable));
        let points = response.points.iter();
        let points: Vec<_> = points.map(|p| (p.frequency, 1e6 * amplitude_upwards(p))).collect();
        upwards.extend(stability::series(&label, &points, &unstable));
        if force == EXAMINED {
            maps::draw(&beam, &response, force, folder, screen)?;
        }
    }
    for (label, sticks) in [("lining sticks", true), ("lining slides freely", false)] {
        let points = linear(&beam, sticks)?;
        let force = if sticks { 0.0 } else { f64::INFINITY };
        rows.extend(points.iter().map(|&[f, x, y]| vec![force, f, x, y]));
        let points = points.iter().map(|&[f, x, _]| (f, 1e6 * x)).collect();
        series.push(Series::new(label, Style::Dashed, points));
    }
    // A force of 0 denotes the sticking limit, an infinite one the limit without friction; both are amplitudes per
    // newton.
    write_csv(
        folder.join("response.csv"),
        &["force_N", "frequency_Hz", "amplitude_across_m", "amplitude_up_m"],
        &rows,
    )?;
    let figure = Figure {
        title: "Beam on a friction lining: motion of the free end across".into(),
        x_label: "Frequency [Hz]".into(),
        y_label: "Amplitude over force [µm/N]".into(),
        log_y: true,
        legend_title: "Force across".into(),
        series,
        ..Figure::default()
    };
    figure.save(&folder.join("response"))?;
    // The upward bending mode, 651 Hz on a closed lining, is softened by lift-off: its resonance bends far to the
    // left, folds back, and appears in the motion across near the intersection of the two.
    let figure = Figure {
        title: "Beam on a friction lining: motion of the free end upwards (dashed: unstable)".into(),
        y_label: "Amplitude [µm]".into(),
        series: upwards,
        ..figure
    };
    figure.save(&folder.join("response_up"))?;
    writeln!(screen, "\nCSV, SVG and PNG are in {}", folder.display())?;
    Ok(())
}

fn frequencies(beam: &Beam, screen: &mut impl Write) -> Outcome {
    const MODES: usize = 4;
    let on_lining = beam.on_lining()?;
    writeln!(screen, "Natural frequencies [Hz], lowest {MODES}")?;
    for (label, modes) in [
        ("without lining", on_lining.lowest_modes(0, ContactState::Free, MODES)?),
        (
            "lining without friction",
            beam.sprung(false)?.lowest_modes(0, ContactState::Free, MODES)?,
        ),
        (
            "lining that sticks",
            on_lining.lowest_modes(0, ContactState::Stuck, MODES)?,
        ),
    ] {
        write!(screen, "  {label:<24}")?;
        for omega in &modes.omega {
            write!(screen, "{:>10.2}", omega / TAU)?;
        }
        writeln!(screen)?;
    }
    Ok(())
}

/// Response degrees of freedom: across, then upwards.
fn ends(beam: &Beam) -> [usize; 2] {
    let tip = beam.tips()[0];
    [tip + Z, tip + Y]
}

/// Amplitude of the fundamental of the upward motion.
fn amplitude_upwards(point: &Point) -> f64 {
    let first = point.harmonics.iter().find(|h| h.0 == 1);
    first.map_or(0.0, |h| h.1[1].norm())
}

/// Options of the solver for the nonlinear responses.
pub fn solver() -> SolverOptions {
    SolverOptions {
        harmonics: HARMONICS,
        step_max: SMOOTH,
        tolerance: 0.0,
        ..SolverOptions::default()
    }
}

fn follow(beam: &Beam, force: f64) -> Result<Response, Box<dyn Error>> {
    let range = Range {
        from: RANGE.0,
        to: RANGE.1,
        at: Vec::new(),
    };
    let model = beam.forced(force, LIFT)?;
    let mut bar = Bar::new(format!("response to {force} N"), 100);
    let response = Response::follow(&model, &solver(), &range, &ends(beam), |share| bar.set(share))?;
    bar.finish();
    Ok(response)
}

/// The linear response to 1 N at evenly spaced frequencies.
fn linear(beam: &Beam, sticks: bool) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let model = beam.linear(sticks, 1.0, LIFT)?;
    let solver = SolverOptions {
        harmonics: 1,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let step = (RANGE.1 - RANGE.0) / LINEAR_POINTS as f64;
    let range = Range {
        from: RANGE.0,
        to: RANGE.1,
        at: (0..=LINEAR_POINTS).map(|i| RANGE.0 + step * i as f64).collect(),
    };
    let response = Response::follow(&model, &solver, &range, &ends(beam), |_| {})?;
    Ok(response
        .at
        .iter()
        .map(|p| [p.frequency, p.amplitude(), amplitude_upwards(p)])
        .collect())
}

/// Work per cycle at the peak: of the force, dissipated in the beam, and dissipated in each contact.
fn balance(beam: &Beam, response: &Response, force: f64, screen: &mut impl Write) -> Outcome {
    let (branch, point) = (&response.branch, response.peak.number);
    let n = branch.ndof();
    let mut all = vec![Complex64::ZERO; (branch.harmonics() + 1) * n];
    branch.harmonics_at(point, &mut all)?;
    let given = beam.work_of_force(&all[n..2 * n], force, LIFT);
    let lost = branch.energy_at(point)?.structural_loss;
    let mut of_contacts = 0.0;
    for contact in 0..branch.contacts() {
        of_contacts += branch.contact_summary(point, contact)?.work;
    }
    writeln!(
        screen,
        "  work per cycle at the peak: force {:.6e} J = {:.1} % beam + {:.1} % contacts; relative difference {:.1e}",
        given,
        100.0 * lost / given,
        100.0 * of_contacts / given,
        (given - lost - of_contacts) / given
    )?;
    Ok(())
}
