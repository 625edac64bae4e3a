//! Wheel of a job: all blades of a mistuned wheel, the largest of them, and its amplification against the tuned wheel.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_studies::{MistunedName, WheelPart};
use crate::outputs::figure::{bounds, draw, scientific};
use crate::outputs::files::Files;
use crate::studies::map::Written;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{BladeProperty, ForcedOptions, Hooks, Mistuning, Model, Response, Status, WheelPeaks, wheel_peaks};
use plotters::prelude::{ChartBuilder, LineSeries};
use plotters::style::{BLACK, Color, RED, RGBColor};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Grey of the single blades.
const BLADES: RGBColor = RGBColor(150, 150, 150);

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &WheelPart, built: &Built) -> Outcome<()> {
    if !part.pattern.is_empty() || part.patterns.is_none() {
        mistuned(part, &part.pattern, built)?;
    } else if part.csv.is_some() || part.figure.is_some() {
        return Err("[wheel]: csv and figure tell the blades of `pattern`, which is not given; `patterns` alone has patterns_csv and \
                    patterns_figure"
            .into());
    }
    solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built)
        .map(|_| ())
        .map_err(|e| format!("[wheel]: {e}"))
}

/// The wheel with a pattern.
///
/// # Errors
/// A sentence.
pub fn mistuned(part: &WheelPart, pattern: &[f64], built: &Built) -> Outcome<Model> {
    let said = |e: &dyn std::fmt::Display| format!("[wheel]: {e}");
    let mut wheel = built.model.wheel().map_err(|e| said(&e))?;
    let dofs: Outcome<Vec<usize>> = part.dofs.iter().map(|name| built.nodes.dof(name)).collect();
    let dofs = dofs.map_err(|e| format!("[wheel] dofs: {e}"))?;
    let blade = |property| Mistuning::Blade(property, &dofs);
    let kind = match part.kind {
        MistunedName::Stiffness => blade(BladeProperty::Stiffness),
        MistunedName::Frequency => blade(BladeProperty::Frequency),
        MistunedName::Mass => blade(BladeProperty::Mass),
        MistunedName::Damping => blade(BladeProperty::Damping),
        MistunedName::Preload => Mistuning::Preload(None),
        MistunedName::Force => Mistuning::Force,
    };
    wheel.mistune(&built.model, &kind, pattern).map_err(|e| said(&e))?;
    Ok(wheel)
}

/// Peaks of all blades of a wheel.
///
/// # Errors
/// A sentence.
pub fn peaks(part: &WheelPart, wheel: &Model, built: &Built, hooks: &mut Hooks<'_>) -> Outcome<WheelPeaks> {
    let said = |e: &dyn std::fmt::Display| format!("[wheel]: {e}");
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let range = ForcedOptions {
        omega_start: TAU * part.from_hz,
        omega_stop: TAU * part.to_hz,
        ..ForcedOptions::default()
    };
    wheel_peaks(wheel, &built.model, &Response::default(), &solver, &range, hooks).map_err(|e| said(&e))
}

/// Computes and writes the peaks of all blades.
///
/// # Errors
/// A sentence.
pub fn write(part: &WheelPart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<Written> {
    let wheel = mistuned(part, &part.pattern, built)?;
    let found = peaks(part, &wheel, built, hooks)?;
    if found.branch.status() != Status::Ok {
        let sentence = found.branch.status().sentence();
        return Ok((format!("[wheel]: the response ended early: {sentence}\n"), true));
    }
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, table(&found)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| figure(path, &found));
    Ok((summary(&found), false))
}

fn table(found: &WheelPeaks) -> String {
    let mut text = String::from("blade,hz,amplitude,error,amplification\n");
    for (i, blade) in found.blades.iter().enumerate() {
        let _ = writeln!(
            text,
            "{i},{:.16e},{:.16e},{:.3e},{:.16e}",
            blade.omega / TAU,
            blade.amplitude,
            blade.error,
            blade.amplitude / found.tuned.amplitude
        );
    }
    text
}

fn summary(found: &WheelPeaks) -> String {
    let blades = counted(found.blades.len(), "blade");
    let Some(largest) = found.largest else {
        return format!("wheel of {blades}: no peak within the range\n");
    };
    let peak = &found.blades[largest];
    format!(
        "wheel of {blades}: blade {largest} is the largest, {:.6e} at {:.6} Hz; amplification {:.4} over {:.6e} of the tuned wheel\n",
        peak.amplitude,
        peak.omega / TAU,
        found.amplification(),
        found.tuned.amplitude
    )
}

/// All blades, the largest one at each frequency, and the peak of the tuned wheel.
fn figure(path: &Path, found: &WheelPeaks) -> Outcome<()> {
    let hz: Vec<f64> = found.branch.omega().iter().map(|omega| omega / TAU).collect();
    let all: Vec<&[f64]> = found
        .branch
        .responses()
        .iter()
        .map(|one| &one.values()[..hz.len()])
        .collect();
    let envelope: Vec<f64> = (0..hz.len())
        .map(|i| all.iter().fold(0.0_f64, |most, of_blade| most.max(of_blade[i])))
        .collect();
    let tuned = Some(found.tuned.amplitude).filter(|x| x.is_finite());
    let x = bounds(hz.iter().copied());
    let y = bounds(envelope.iter().copied().chain([0.0]).chain(tuned));
    let (of_x, of_y) = (scientific(&x), scientific(&y));
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .caption(
                "blades of the wheel; dashed: peak of the tuned wheel",
                ("sans-serif", 18),
            )
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
        let line = |values: &[f64]| hz.iter().copied().zip(values.iter().copied()).collect::<Vec<_>>();
        for of_blade in &all {
            chart.draw_series(LineSeries::new(line(of_blade), BLADES))?;
        }
        chart.draw_series(LineSeries::new(line(&envelope), RED.stroke_width(2)))?;
        if let Some(tuned) = tuned {
            // Dashes of a hundredth of the range.
            let step = (x.end - x.start) / 100.0;
            for k in (0..100).step_by(2) {
                let from = x.start + step * f64::from(k);
                chart.draw_series(LineSeries::new([(from, tuned), (from + step, tuned)], BLACK))?;
            }
        }
        Ok(())
    })
}
