//! Solutions that the sweep of a response does not show: their table, figure and summary.

use crate::job_file::job::Job;
use crate::outputs::figure::{bounds, draw, scientific};
use crate::outputs::files::Files;
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{BifurcationKind, Branch, Stretch};
use plotters::prelude::{ChartBuilder, DashedLineSeries, LineSeries};
use plotters::style::{BLUE, Palette, Palette99};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A branch of the tree, with its number, that of its parent, and the periods of the forces in one of its own.
pub struct Place<'b> {
    pub branch: &'b Branch,
    parent: usize,
    pub periods: usize,
}

/// The branches in the order of the tree, the response first.
pub fn places(branch: &Branch) -> Vec<Place<'_>> {
    let mut found = vec![Place {
        branch,
        parent: 0,
        periods: 1,
    }];
    let mut next = 0;
    while next < found.len() {
        let (branch, periods) = (found[next].branch, found[next].periods);
        found.extend(branch.children().iter().map(|child| Place {
            branch: child,
            parent: next,
            periods: periods * child.descent().map_or(1, |descent| descent.periods),
        }));
        next += 1;
    }
    found
}

/// Writes what the job names, and returns the summary.
pub fn write(job: &Job, branch: &Branch, files: &mut Files<'_>) -> String {
    let Some(part) = &job.solutions else {
        return String::new();
    };
    let places = places(branch);
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, rows(&places)).map_err(|e| e.to_string())
    });
    files.write(part.figure.as_deref(), &|path| figure(path, &places));
    summary(branch, &places)
}

/// Frequencies are those of the forces: the fundamental frequency of a branch times its periods.
fn rows(places: &[Place<'_>]) -> String {
    let mut text = String::from("branch,parent,periods,frequency_hz,amplitude,floquet_radius,unstable_directions\n");
    for (number, place) in places.iter().enumerate() {
        let branch = place.branch;
        for (point, omega) in branch.omega().iter().enumerate() {
            let of = |values: &[f64]| values.get(point).copied().unwrap_or(f64::NAN);
            let _ = writeln!(
                text,
                "{number},{},{},{:.16e},{:.16e},{:.16e},{}",
                place.parent,
                place.periods,
                omega * place.periods as f64 / TAU,
                branch.amplitude()[point],
                of(branch.floquet_radius()),
                of(branch.unstable_directions())
            );
        }
    }
    text
}

/// Amplitude over the frequency of the forces: each branch in a colour, dashed where it is unstable.
fn figure(path: &Path, places: &[Place<'_>]) -> Outcome<()> {
    let mut curves: Vec<(usize, f64, Vec<Stretch>)> = Vec::new();
    for (number, place) in places.iter().enumerate() {
        let stretches = place.branch.stretches().map_err(|e| e.to_string())?;
        curves.push((number, place.periods as f64 / TAU, stretches));
    }
    let all = || {
        let stretches = curves
            .iter()
            .flat_map(|(_, scale, all)| all.iter().map(move |s| (*scale, s)));
        stretches.flat_map(|(scale, s)| s.points.iter().map(move |(omega, a)| (omega * scale, *a)))
    };
    let (x, y) = (bounds(all().map(|p| p.0)), bounds(all().map(|p| p.1)));
    draw(path, |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(90)
            .build_cartesian_2d(x, y.clone())?;
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc("frequency, Hz").y_desc("amplitude");
        mesh.y_label_formatter(&scientific(&y)).draw()?;
        for (number, scale, stretches) in &curves {
            let (r, g, b) = Palette99::COLORS[number % Palette99::COLORS.len()];
            let colour = if *number == 0 {
                BLUE
            } else {
                plotters::style::RGBColor(r, g, b)
            };
            for stretch in stretches {
                let points = stretch.points.iter().map(|&(omega, a)| (omega * scale, a));
                if stretch.unstable {
                    chart.draw_series(DashedLineSeries::new(points, 6, 4, colour.into()))?;
                } else {
                    chart.draw_series(LineSeries::new(points, &colour))?;
                }
            }
        }
        Ok(())
    })
}

fn summary(branch: &Branch, places: &[Place<'_>]) -> String {
    let mut text = String::new();
    for (number, place) in places.iter().enumerate().skip(1) {
        let Some(descent) = place.branch.descent() else {
            continue;
        };
        let origin = match descent.kind {
            Some(BifurcationKind::PeriodDoubling) => "double period".to_owned(),
            Some(_) => "branch point".to_owned(),
            None if descent.internal_resonance > 0 => format!("beyond a {}:1 resonance", descent.internal_resonance),
            None if descent.born_at_force.is_nan() => "detached".to_owned(),
            None => format!("detached, born at {:.6} times the force", descent.born_at_force),
        };
        let amplitudes = place.branch.amplitude();
        let largest = amplitudes.iter().copied().fold(0.0, f64::max);
        let stable = place.branch.unstable_directions().iter().filter(|n| **n == 0.0).count();
        let _ = writeln!(
            text,
            "branch {number} of {}: {origin}, {}, {stable} stable, largest amplitude {largest:.6e}",
            place.parent,
            counted(place.branch.points(), "point")
        );
    }
    if let Some(searched) = branch.searched() {
        let _ = writeln!(
            text,
            "sought from {} ({} without a branch, {} left) and along {} ({} incomplete, {}): not all solutions need be among them",
            counted(searched.bifurcations, "bifurcation"),
            searched.lost,
            searched.left,
            counted(searched.modes, "nonlinear mode"),
            searched.incomplete_modes,
            counted(searched.resonances, "resonance")
        );
        if searched.force_curves > 0 {
            let _ = writeln!(
                text,
                "sought along {} over the force ({} incomplete, {})",
                counted(searched.force_curves, "curve"),
                searched.incomplete_force_curves,
                counted(searched.crossings, "crossing")
            );
        }
        if searched.deflations > 0 {
            let found = counted(searched.deflated, "curve");
            let places = counted(searched.deflations, "place");
            let _ = writeln!(text, "sought by deflation at {places} ({found})");
        }
    }
    text
}
