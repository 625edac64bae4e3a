//! Files and summary of a result.

use crate::building::responses;
use crate::job_file::job::Job;
use crate::meshes::node_table::Nodes;
use crate::outputs::curve::Curve;
use crate::outputs::figure::{bounds, draw, scientific};
use crate::outputs::files::Files;
use crate::outputs::npz::Npz;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{BifurcationKind, Branch, Stretch};
use plotters::prelude::{ChartBuilder, DashedLineSeries, LineSeries};
use plotters::style::BLUE;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

/// Writes the files of a branch that a job names.
pub fn write(job: &Job, curve: &Curve<'_>, nodes: &Nodes, files: &mut Files<'_>) {
    let table = files.write(job.output.csv.as_deref(), &|path| csv(path, curve));
    let arrays = files.write(job.output.npz.as_deref(), &|path| npz(path, curve, nodes));
    let label = amplitude_label(job, curve, nodes);
    files.write(job.output.figure.as_deref(), &|path| figure(path, curve, &label));
    if !(table || arrays) && (job.output.csv.is_some() || job.output.npz.is_some()) {
        // As on a disk that is full: the points are kept in what the caller reads.
        files.tell(&rows(curve));
    }
}

fn csv(path: &Path, curve: &Curve<'_>) -> Outcome<()> {
    fs::write(path, rows(curve)).map_err(|e| e.to_string())
}

/// Columns of the curve: a mode has its amplitude and damping ratio, too.
fn rows(curve: &Curve<'_>) -> String {
    let branch = curve.branch;
    let mut text = String::from("frequency_hz,amplitude,slip_fraction,harmonics");
    if branch.mode().is_some() {
        text += ",log10_amplitude,damping_ratio";
    }
    if branch.tells_stability() {
        text += ",floquet_radius,unstable_directions";
    }
    if branch.tells_freedom() {
        text += ",free_sliders,least_by_place,largest_by_place";
    }
    let responses: Vec<Vec<f64>> = (0..branch.responses().len())
        .map(|r| curve.response(r, false))
        .collect();
    for r in 0..responses.len() {
        let _ = write!(text, ",response_{r}");
    }
    text += "\n";
    let (omega, amplitude, used) = (curve.omega(), curve.amplitude(), curve.harmonics_used());
    let (radius, count) = (curve.floquet_radius(), curve.unstable_directions());
    let free = curve.free_sliders();
    for point in 0..curve.points() {
        let _ = write!(
            text,
            "{:.16e},{:.16e},{:.6},{}",
            omega[point] / TAU,
            amplitude[point],
            curve.slip(point).iter().copied().fold(0.0, f64::max),
            used[point]
        );
        if let Some(mode) = curve.mode_at(point) {
            let _ = write!(text, ",{:.16e},{:.16e}", mode.log10_amplitude, mode.damping_ratio);
        }
        if branch.tells_stability() {
            let _ = write!(text, ",{:.16e},{}", radius[point], count[point]);
        }
        if branch.tells_freedom() {
            let [least, largest] = range(curve.by_place(point));
            let _ = write!(text, ",{},{least:.16e},{largest:.16e}", free[point]);
        }
        for of in &responses {
            let _ = write!(text, ",{:.16e}", of[point]);
        }
        text += "\n";
    }
    text
}

/// The least and the largest of the derivatives by the places of free sliders; 0 where none is free.
fn range(by_place: &[f64]) -> [f64; 2] {
    let mut free = by_place.iter().copied().filter(|x| !x.is_nan());
    let first = free.next().unwrap_or(0.0);
    free.fold([first; 2], |[least, largest], x| [least.min(x), largest.max(x)])
}

/// Name of the axis of a figure: of what, where nodes have names, and its unit.
fn amplitude_label(job: &Job, curve: &Curve<'_>, nodes: &Nodes) -> String {
    let of = match named(nodes, curve.branch.response_dof()) {
        Some(name) if curve.branch.responses().is_empty() => format!(" of {name}"),
        _ => String::new(),
    };
    let unit = responses::amplitude(job)
        .1
        .map_or(String::new(), |unit| format!(", {unit}"));
    format!("amplitude{of}{unit}")
}

/// Node and direction of a degree of freedom, as 12.3, where the matrices name it.
fn named(nodes: &Nodes, dof: usize) -> Option<String> {
    Some(nodes.name_of(dof)).filter(|name| name.contains('.'))
}

fn npz(path: &Path, curve: &Curve<'_>, nodes: &Nodes) -> Outcome<()> {
    let (branch, points) = (curve.branch, curve.points());
    let said = |e: std::io::Error| e.to_string();
    let mut npz = Npz::new(BufWriter::new(File::create(path).map_err(said)?));
    let mut real = |name: &str, shape: &[usize], values: &[f64]| npz.real(name, shape, values).map_err(said);
    real("omega", &[points], &curve.omega())?;
    real("amplitude", &[points], &curve.amplitude())?;
    real("residual", &[points], &curve.residual())?;
    real("harmonics_used", &[points], &curve.harmonics_used())?;
    let contacts = branch.contacts();
    let slip: Vec<f64> = (0..points).flat_map(|p| curve.slip(p)).copied().collect();
    if slip.len() == points * contacts {
        real("slip_fraction", &[points, contacts], &slip)?;
    }
    for (name, special) in [("peaks", curve.special(false)), ("folds", curve.special(true))] {
        real(name, &[special.len(), 2], special.as_flattened())?;
    }
    let requested = curve.requested();
    real("requested", &[requested.len(), 3], requested.as_flattened())?;
    let responses = branch.responses().len();
    if responses > 0 {
        for (name, errors) in [("responses", false), ("response_errors", true)] {
            let all: Vec<f64> = (0..responses).flat_map(|r| curve.response(r, errors)).collect();
            real(name, &[responses, points], &all)?;
        }
        let rows = curve.response_peaks();
        real("response_peaks", &[rows.len(), 3], rows.as_flattened())?;
    }
    if branch.tells_stability() {
        real("floquet_radius", &[points], &curve.floquet_radius())?;
        real("unstable_directions", &[points], &curve.unstable_directions())?;
    }
    if branch.tells_freedom() {
        real("free_sliders", &[points], &curve.free_sliders())?;
        let by_place: Vec<f64> = (0..points).flat_map(|p| curve.by_place(p)).copied().collect();
        if by_place.len() == 2 * points * contacts {
            real("d_amplitude_by_place", &[points, contacts, 2], &by_place)?;
        }
    }
    if branch.mode().is_some() {
        let mode: Vec<_> = (0..points).filter_map(|p| curve.mode_at(p)).collect();
        let of = |f: fn(&hbvib::ModePoint) -> f64| mode.iter().map(f).collect::<Vec<f64>>();
        real("log10_amplitude", &[mode.len()], &of(|m| m.log10_amplitude))?;
        real("damping_ratio", &[mode.len()], &of(|m| m.damping_ratio))?;
    }
    let dofs = nodes.directions(branch.ndof());
    if !dofs.is_empty() {
        real("dofs", &[branch.ndof(), 2], dofs.as_flattened())?;
    }
    let mut x = Vec::new();
    npz.complex("harmonics", &[points, curve.rows(), branch.ndof()], &mut |put| {
        (0..points).try_for_each(|point| {
            curve.harmonics_at(point, &mut x).map_err(std::io::Error::other)?;
            put(&x)
        })
    })
    .map_err(said)?;
    npz.finish().map_err(said)
}

/// Amplitude over frequency, dashed where it is unstable.
fn figure(path: &Path, curve: &Curve<'_>, label: &str) -> Outcome<()> {
    let (omega, amplitude) = (curve.omega(), curve.amplitude());
    let x = bounds(omega.iter().map(|omega| omega / TAU));
    let y = bounds(amplitude.iter().copied());
    let mut stretches = curve.branch.stretches().map_err(|e| e.to_string())?;
    let kept = (curve.kept() + 1).min(omega.len());
    if kept > 1 {
        // Points of the run before, up to the first of this one.
        let points = omega.iter().copied().zip(amplitude.iter().copied()).take(kept);
        stretches.push(Stretch {
            unstable: false,
            points: points.collect(),
        });
    }
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(90)
            .build_cartesian_2d(x, y.clone())?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc("frequency, Hz").y_desc(label);
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

/// Points at which contacts that stick leave the response free.
fn freedom(text: &mut String, curve: &Curve<'_>) {
    if curve.branch.tells_freedom() {
        let free = curve.free_sliders();
        let _ = writeln!(
            text,
            "{} of {} with free sliders",
            free.iter().filter(|n| **n > 0.0).count(),
            counted(free.len(), "point")
        );
    }
}

/// Summary of a branch.
pub fn summary(curve: &Curve<'_>, nodes: &Nodes) -> String {
    let (branch, omega) = (curve.branch, curve.omega());
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{}, {:.6} to {:.6} Hz, {}",
        counted(curve.points(), "point"),
        omega.first().map_or(f64::NAN, |w| w / TAU),
        omega.last().map_or(f64::NAN, |w| w / TAU),
        if branch.responses().is_empty() {
            let dof = branch.response_dof();
            let name = named(nodes, dof).map_or(String::new(), |name| format!(" ({name})"));
            format!("response degree of freedom {dof}{name}")
        } else {
            "response 0".into()
        }
    );
    let list = |text: &mut String, name: &str, special: &[[f64; 2]]| {
        for [omega, amplitude] in special {
            let _ = writeln!(text, "{name:<6} {:>14.6} Hz {amplitude:>14.6e}", omega / TAU);
        }
    };
    list(&mut text, "peak", &curve.special(false));
    list(&mut text, "fold", &curve.special(true));
    stability(&mut text, branch);
    freedom(&mut text, curve);
    // The first solution of each request.
    let mut requested = curve.requested();
    requested.dedup_by_key(|row| row[0]);
    let first: Vec<[f64; 2]> = requested.iter().map(|row| [row[1], row[2]]).collect();
    list(&mut text, "at", &first);
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
