//! Tornado of a job: changes of the highest peak by given shares of quantities, from its derivatives, the largest first.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_studies::{SpreadPart, TornadoPart};
use crate::outputs::figure::{bounds, draw};
use crate::outputs::files::Files;
use crate::studies::map::Written;
use crate::studies::varied::{Keys, Varied};
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Branch, ForcedOptions, Hooks, Quantity, Reason, Special, Status, forced_response, sensitivity};
use plotters::prelude::{ChartBuilder, Rectangle};
use plotters::style::{BLUE, Color, RED};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A quantity with the change that is asked for.
struct Spread {
    name: String,
    varied: Varied,
    value: f64,
    share: f64,
}

/// The change of the peak by one quantity.
struct Bar {
    name: String,
    value: f64,
    share: f64,
    amplitude_slope: f64,
    omega_slope: f64,
    /// Changes of amplitude and frequency, relative.
    amplitude: f64,
    frequency: f64,
    reason: Reason,
}

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &TornadoPart, built: &Built) -> Outcome<()> {
    spreads(part, built).map(|_| ())
}

fn spreads(part: &TornadoPart, built: &Built) -> Outcome<Vec<Spread>> {
    if part.parameter.is_empty() {
        return Err("[tornado]: names no quantity: needs [[tornado.parameter]]".into());
    }
    let one = |(i, part): (usize, &SpreadPart)| -> Outcome<Spread> {
        spread(part, built).map_err(|e| format!("[[tornado.parameter]] {}: {e}", i + 1))
    };
    part.parameter.iter().enumerate().map(one).collect()
}

fn spread(part: &SpreadPart, built: &Built) -> Outcome<Spread> {
    let keys = Keys {
        parameter: part.parameter,
        contact: part.contact,
        dofs: &part.dofs,
    };
    let varied = Varied::new(&keys, built)?;
    for (name, value) in [("spread", Some(part.spread)), ("value", part.value)] {
        if let Some(value) = value.filter(|value| !value.is_finite() || *value == 0.0) {
            return Err(format!("{name} = {value}, needs a finite number other than 0"));
        }
    }
    let value = match part.value {
        Some(value) => value,
        None => varied.value(&built.model)?,
    };
    Ok(Spread {
        name: part.name.clone().unwrap_or_else(|| varied.label().into()),
        varied,
        value,
        share: part.spread,
    })
}

/// Computes and writes the tornado.
///
/// # Errors
/// A sentence.
pub fn write(part: &TornadoPart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<Written> {
    let said = |e: &dyn std::fmt::Display| format!("[tornado]: {e}");
    let spreads = spreads(part, built)?;
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let range = ForcedOptions {
        omega_start: TAU * part.from_hz,
        omega_stop: TAU * part.to_hz,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&built.model, &solver, &range, hooks).map_err(|e| said(&e))?;
    if branch.status() != Status::Ok {
        let text = format!("[tornado]: the response ended early: {}\n", branch.status().sentence());
        return Ok((text, true));
    }
    let highest = branch.peaks().iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let Some(peak) = highest else {
        return Err("[tornado]: the response has no peak within the range of frequency".into());
    };
    let bars = bars(built, &spreads, &branch, peak).map_err(|e| said(&e))?;
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&bars)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| figure(path, &bars));
    Ok((summary(&bars, peak), false))
}

/// The changes, the largest of the amplitude first, unknown ones last.
fn bars(built: &Built, spreads: &[Spread], branch: &Branch, peak: &Special) -> hbvib::Result<Vec<Bar>> {
    let parameters: Vec<_> = spreads.iter().map(|spread| spread.varied.parameter()).collect();
    let of = |quantity| sensitivity(&built.model, branch, peak.point, &parameters, quantity);
    let (amplitudes, omegas) = (of(Quantity::PeakAmplitude)?, of(Quantity::PeakOmega)?);
    let bar = |(i, spread): (usize, &Spread)| {
        let (by_amplitude, by_omega) = (amplitudes.values[i], omegas.values[i]);
        let change = spread.share * spread.value;
        Bar {
            name: spread.name.clone(),
            value: spread.value,
            share: spread.share,
            amplitude_slope: by_amplitude,
            omega_slope: by_omega,
            amplitude: change * by_amplitude / peak.amplitude,
            frequency: change * by_omega / peak.omega,
            reason: amplitudes.reasons[i],
        }
    };
    let mut bars: Vec<Bar> = spreads.iter().enumerate().map(bar).collect();
    let size = |bar: &Bar| {
        if bar.amplitude.is_nan() {
            -1.0
        } else {
            bar.amplitude.abs()
        }
    };
    bars.sort_by(|a, b| size(b).total_cmp(&size(a)));
    Ok(bars)
}

fn table(bars: &[Bar]) -> String {
    let mut text =
        String::from("parameter,value,spread,amplitude_change,frequency_change,amplitude_derivative,hz_derivative\n");
    for bar in bars {
        let _ = writeln!(
            text,
            "\"{}\",{:.16e},{:.16e},{:.16e},{:.16e},{:.16e},{:.16e}",
            bar.name.replace('"', "\"\""),
            bar.value,
            bar.share,
            bar.amplitude,
            bar.frequency,
            bar.amplitude_slope,
            bar.omega_slope / TAU
        );
    }
    text
}

fn summary(bars: &[Bar], peak: &Special) -> String {
    let mut text = format!(
        "changes of the peak {:.6e} at {:.6} Hz by {}: spread, amplitude, frequency, %\n",
        peak.amplitude,
        peak.omega / TAU,
        counted(bars.len(), "quantity")
    );
    let width = bars.iter().map(|bar| bar.name.chars().count()).max().unwrap_or(0);
    for bar in bars {
        let _ = write!(
            text,
            "{:width$} {:+8.2} {:+12.5} {:+12.6}",
            bar.name,
            100.0 * bar.share,
            100.0 * bar.amplitude,
            100.0 * bar.frequency
        );
        if bar.amplitude.is_nan() {
            let _ = write!(text, "  {}", sentence(bar.reason));
        }
        text += "\n";
    }
    text
}

fn sentence(reason: Reason) -> String {
    match reason {
        Reason::Exists => String::new(),
        Reason::OnsetOfSlip { contact } => {
            format!("contact {contact} is at the onset of slip, and the derivatives on both sides differ")
        }
        Reason::ZeroConstant => "the constant is zero, and acts above it alone".into(),
        Reason::Fold => "the peak is a fold".into(),
    }
}

/// A bar for each quantity, red where it raises the peak.
fn figure(path: &Path, bars: &[Bar]) -> Outcome<()> {
    let known = || bars.iter().filter(|bar| !bar.amplitude.is_nan());
    let x = bounds(known().map(|bar| 100.0 * bar.amplitude).chain([0.0]));
    let rows = bars.len() as f64;
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption("change of the peak by the spread of each quantity", ("sans-serif", 18))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(200)
            .build_cartesian_2d(x, -0.5..rows - 0.5)?;
        chart.draw_series(
            bars.iter()
                .enumerate()
                .filter(|(_, bar)| !bar.amplitude.is_nan())
                .map(|(i, bar)| {
                    let (row, change) = (rows - 1.0 - i as f64, 100.0 * bar.amplitude);
                    let style = if change > 0.0 { RED.mix(0.7) } else { BLUE.mix(0.7) };
                    Rectangle::new(
                        [(change.min(0.0), row - 0.35), (change.max(0.0), row + 0.35)],
                        style.filled(),
                    )
                }),
        )?;
        // Rows are centred at whole numbers.
        let name = |row: &f64| {
            let whole = (row - row.round()).abs() < 1e-6 && *row > -0.5;
            let bar = bars.iter().rev().nth(row.round().max(0.0) as usize).filter(|_| whole);
            bar.map_or(String::new(), |bar| bar.name.clone())
        };
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc("change of the amplitude, %")
            .disable_y_mesh()
            .max_light_lines(1);
        mesh.y_labels((bars.len() + 2).clamp(3, 30))
            .y_label_formatter(&name)
            .draw()?;
        Ok(())
    })
}
