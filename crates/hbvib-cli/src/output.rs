//! Files and summary of a result.

use crate::build::Outcome;
use crate::counted::counted;
use crate::figure::{bounds, draw, scientific};
use crate::files::Files;
use crate::job::Job;
use crate::npz::Npz;
use hbvib::{BifurcationKind, Branch, Special};
use num_complex::Complex64;
use plotters::prelude::{ChartBuilder, DashedLineSeries, LineSeries};
use plotters::style::BLUE;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

/// Writes the files of a branch that a job names.
pub fn write(job: &Job, branch: &Branch, files: &mut Files<'_>) {
    let table = files.write(job.output.csv.as_deref(), &|path| csv(path, branch));
    let arrays = files.write(job.output.npz.as_deref(), &|path| npz(path, branch));
    files.write(job.output.figure.as_deref(), &|path| figure(path, branch));
    if !(table || arrays) && (job.output.csv.is_some() || job.output.npz.is_some()) {
        // As on a disk that is full: the points are kept in what the caller reads.
        files.tell(&rows(branch));
    }
}

fn csv(path: &Path, branch: &Branch) -> Outcome<()> {
    fs::write(path, rows(branch)).map_err(|e| e.to_string())
}

/// Columns of the curve: a mode has its amplitude and damping ratio, too.
fn rows(branch: &Branch) -> String {
    let mut text = String::from("frequency_hz,amplitude,slip_fraction,harmonics");
    if branch.mode().is_some() {
        text += ",log10_amplitude,damping_ratio";
    }
    if branch.tells_stability() {
        text += ",floquet_radius,unstable_directions";
    }
    for r in 0..branch.responses().len() {
        let _ = write!(text, ",response_{r}");
    }
    text += "\n";
    for point in 0..branch.points() {
        let slip = branch.slip_fraction_at(point).unwrap_or(&[]);
        let _ = write!(
            text,
            "{:.16e},{:.16e},{:.6},{}",
            branch.omega()[point] / TAU,
            branch.amplitude()[point],
            slip.iter().copied().fold(0.0, f64::max),
            branch.harmonics_used()[point]
        );
        if let Some(mode) = branch.mode_at(point) {
            let _ = write!(text, ",{:.16e},{:.16e}", mode.log10_amplitude, mode.damping_ratio);
        }
        if let (Some(radius), Some(count)) = (
            branch.floquet_radius().get(point),
            branch.unstable_directions().get(point),
        ) {
            let _ = write!(text, ",{radius:.16e},{count}");
        }
        for of in branch.responses() {
            let _ = write!(text, ",{:.16e}", of.values()[point]);
        }
        text += "\n";
    }
    text
}

fn npz(path: &Path, branch: &Branch) -> Outcome<()> {
    let points = branch.points();
    let said = |e: std::io::Error| e.to_string();
    let mut npz = Npz::new(BufWriter::new(File::create(path).map_err(said)?));
    let mut real = |name: &str, shape: &[usize], values: &[f64]| npz.real(name, shape, values).map_err(said);
    real("omega", &[points], &branch.omega()[..points])?;
    real("amplitude", &[points], &branch.amplitude()[..points])?;
    real("residual", &[points], &branch.residual()[..points])?;
    let contacts = branch.contacts();
    let slip: Vec<f64> = (0..points)
        .flat_map(|p| branch.slip_fraction_at(p).unwrap_or(&[]))
        .copied()
        .collect();
    if slip.len() == points * contacts {
        real("slip_fraction", &[points, contacts], &slip)?;
    }
    for (name, special) in [("peaks", branch.peaks()), ("folds", branch.folds())] {
        let pairs: Vec<f64> = special.iter().flat_map(|s| [s.omega, s.amplitude]).collect();
        real(name, &[special.len(), 2], &pairs)?;
    }
    let responses = branch.responses();
    if !responses.is_empty() {
        let of = |f: fn(&hbvib::ResponseSeries) -> &[f64]| -> Vec<f64> {
            responses.iter().flat_map(|r| &f(r)[..points]).copied().collect()
        };
        real(
            "responses",
            &[responses.len(), points],
            &of(hbvib::ResponseSeries::values),
        )?;
        real(
            "response_errors",
            &[responses.len(), points],
            &of(hbvib::ResponseSeries::errors),
        )?;
        let peaks = responses.iter().enumerate();
        let rows = peaks.flat_map(|(r, of)| of.peaks().iter().map(move |p| [r as f64, p.omega, p.amplitude]));
        let rows: Vec<f64> = rows.flatten().collect();
        real("response_peaks", &[rows.len() / 3, 3], &rows)?;
    }
    if branch.tells_stability() {
        real(
            "floquet_radius",
            &[branch.floquet_radius().len()],
            branch.floquet_radius(),
        )?;
        real(
            "unstable_directions",
            &[branch.unstable_directions().len()],
            branch.unstable_directions(),
        )?;
    }
    if branch.mode().is_some() {
        let mode: Vec<_> = (0..points).filter_map(|p| branch.mode_at(p)).collect();
        let of = |f: fn(&hbvib::ModePoint) -> f64| mode.iter().map(f).collect::<Vec<f64>>();
        real("log10_amplitude", &[mode.len()], &of(|m| m.log10_amplitude))?;
        real("damping_ratio", &[mode.len()], &of(|m| m.damping_ratio))?;
    }
    let (rows, ndof) = (branch.harmonics() + 1, branch.ndof());
    let mut x = vec![Complex64::ZERO; rows * ndof];
    npz.complex("harmonics", &[points, rows, ndof], &mut |put| {
        (0..points).try_for_each(|point| {
            branch
                .harmonics_at(point, &mut x)
                .map_err(|e| std::io::Error::other(e.to_string()))?;
            put(&x)
        })
    })
    .map_err(said)?;
    npz.finish().map_err(said)
}

/// Amplitude over frequency, dashed where it is unstable.
fn figure(path: &Path, branch: &Branch) -> Outcome<()> {
    let x = bounds(branch.omega().iter().map(|omega| omega / TAU));
    let y = bounds(branch.amplitude().iter().copied());
    let stretches = branch.stretches().map_err(|e| e.to_string())?;
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(90)
            .build_cartesian_2d(x, y.clone())?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc("frequency, Hz").y_desc("amplitude");
        mesh.y_label_formatter(&scientific(&y)).draw()?;
        for stretch in &stretches {
            let points = stretch
                .points
                .iter()
                .map(|&(omega, amplitude)| (omega / TAU, amplitude));
            if stretch.unstable {
                chart.draw_series(DashedLineSeries::new(points, 6, 4, BLUE.into()))?;
            } else {
                chart.draw_series(LineSeries::new(points, &BLUE))?;
            }
        }
        Ok(())
    })
}

/// Bifurcations other than folds, and the number of unstable points.
fn stability(text: &mut String, branch: &Branch) {
    if !branch.tells_stability() {
        return;
    }
    for b in branch.bifurcations().unwrap_or_default() {
        let name = match b.kind {
            BifurcationKind::Fold => continue,
            BifurcationKind::PeriodDoubling => "period doubling",
            BifurcationKind::NeimarkSacker => "Neimark-Sacker",
            BifurcationKind::BranchPoint => "branch point",
        };
        let _ = writeln!(text, "{name} {:.6} Hz {:.6e}", b.omega / TAU, b.amplitude);
    }
    let counts = branch.unstable_directions();
    let _ = writeln!(
        text,
        "{} unstable, stability unknown at {}",
        counted(counts.iter().filter(|n| **n > 0.0).count(), "point"),
        counts.iter().filter(|n| n.is_nan()).count()
    );
}

/// Summary of a branch.
pub fn summary(branch: &Branch) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{}, {:.6} to {:.6} Hz, response degree of freedom {}",
        counted(branch.points(), "point"),
        branch.omega().first().map_or(f64::NAN, |w| w / TAU),
        branch.omega().last().map_or(f64::NAN, |w| w / TAU),
        branch.response_dof()
    );
    let list = |text: &mut String, name: &str, special: &[Special]| {
        for s in special {
            let _ = writeln!(text, "{name:<6} {:>14.6} Hz {:>14.6e}", s.omega / TAU, s.amplitude);
        }
    };
    list(&mut text, "peak", branch.peaks());
    list(&mut text, "fold", branch.folds());
    stability(&mut text, branch);
    list(
        &mut text,
        "at",
        &(0..).map_while(|i| branch.at(i).first().copied()).collect::<Vec<_>>(),
    );
    let removed = branch.reduction();
    let _ = writeln!(
        text,
        "{} from {}{}; of {}, {} never slip and {} have no force; even harmonics {}",
        counted(removed.unknowns, "unknown"),
        counted(removed.degrees_of_freedom, "degree of freedom"),
        if removed.sectors > 1 {
            format!(" of {}", counted(removed.sectors, "sector"))
        } else {
            String::new()
        },
        counted(removed.contacts, "contact"),
        removed.never_slipping,
        removed.inert,
        if removed.even_removed { "removed" } else { "carried" }
    );
    text
}
