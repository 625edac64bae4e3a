//! Map of a job: the highest peak of all pairs of two quantities' values.

use crate::building::built::Built;
use crate::building::solver::solver;
use crate::job_file::job_studies::{AxisPart, MapPart};
use crate::outputs::figure::draw;
use crate::outputs::files::Files;
use crate::outputs::npz::Npz;
use crate::studies::varied::{Keys, Varied};
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{BatchOptions, DesignPeak, Hooks, Status, batch};
use plotters::prelude::{ChartBuilder, Rectangle};
use plotters::style::{Color, HSLColor, RGBColor};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;

/// Most pairs of values.
const MOST: usize = 10_000_000;

/// Colours of the legend.
const COLOURS: usize = 64;

/// Quantity and values of an axis.
struct Axis {
    varied: Varied,
    values: Vec<f64>,
}

/// A map that is computed.
struct Map {
    x: Axis,
    y: Axis,
    /// The values of y for the first value of x, and so on.
    peaks: Vec<DesignPeak>,
}

/// A summary, and whether the computation was stopped early.
pub type Written = (String, bool);

/// Refuses what cannot be computed.
///
/// # Errors
/// A sentence.
pub fn check(part: &MapPart, built: &Built) -> Outcome<()> {
    axes(part, built).map(|_| ())
}

fn axes(part: &MapPart, built: &Built) -> Outcome<(Axis, Axis)> {
    let both = axis("[map.x]", &part.x, built)?;
    let both = (both, axis("[map.y]", &part.y, built)?);
    if part.x.points.saturating_mul(part.y.points) > MOST {
        return Err(format!(
            "[map]: {} times {} points, needs at most {MOST} in all",
            part.x.points, part.y.points
        ));
    }
    if both.0.varied.label() == both.1.varied.label() {
        return Err(format!("[map]: x and y both change {}", both.0.varied.label()));
    }
    Ok(both)
}

fn axis(section: &str, part: &AxisPart, built: &Built) -> Outcome<Axis> {
    let keys = Keys {
        parameter: part.parameter,
        contact: part.contact,
        dofs: &part.dofs,
    };
    let varied = Varied::new(&keys, built).map_err(|e| format!("{section}: {e}"))?;
    let (from, to, points) = (part.from, part.to, part.points);
    if !(from.is_finite() && to.is_finite() && from < to && (2..=MOST).contains(&points)) {
        return Err(format!(
            "{section}: from = {from}, to = {to}, points = {points}, needs rising numbers and 2 to {MOST} points"
        ));
    }
    let value = |i: usize| from + (to - from) * (i as f64 / (points - 1) as f64);
    Ok(Axis {
        varied,
        values: (0..points).map(value).collect(),
    })
}

/// Computes and writes the map.
///
/// # Errors
/// A sentence.
pub fn write(part: &MapPart, built: &Built, hooks: &mut Hooks<'_>, files: &mut Files<'_>) -> Outcome<Written> {
    let said = |e: &dyn std::fmt::Display| format!("[map]: {e}");
    let (x, y) = axes(part, built)?;
    let values: Vec<f64> = x
        .values
        .iter()
        .flat_map(|&a| y.values.iter().flat_map(move |&b| [a, b]))
        .collect();
    let solver = solver((part.harmonics, part.tolerance), part.response_dof.as_ref(), built).map_err(|e| said(&e))?;
    let available = || std::thread::available_parallelism().map_or(1, usize::from).min(64);
    let options = BatchOptions {
        omega_start: TAU * part.from_hz,
        omega_stop: TAU * part.to_hz,
        threads: part.threads.unwrap_or_else(available),
        keep: false,
        responses: &[],
    };
    let parameters = [x.varied.parameter(), y.varied.parameter()];
    let found = batch(&built.model, &solver, &options, (&parameters, &values), hooks).map_err(|e| said(&e))?;
    let peaks = found.peaks().to_vec();
    let map = Map { x, y, peaks };
    files.write(part.csv.as_deref(), &|path| {
        fs::write(path, map.table()).map_err(|e| e.to_string())
    });
    files.write(part.npz.as_deref(), &|path| map.npz(path).map_err(|e| e.to_string()));
    files.write(part.figure.as_deref(), &|path| map.figure(path));
    Ok((map.summary(), found.status() != Status::Ok))
}

impl Map {
    /// Value of x, value of y and peak of each pair.
    fn pairs(&self) -> impl Iterator<Item = (f64, f64, &DesignPeak)> {
        let rows = self.peaks.chunks_exact(self.y.values.len());
        let columns = |(&x, row): (&f64, _)| {
            self.y
                .values
                .iter()
                .zip::<&[DesignPeak]>(row)
                .map(move |(&y, peak)| (x, y, peak))
        };
        self.x.values.iter().zip(rows).flat_map(columns)
    }

    fn table(&self) -> String {
        let mut text = String::from("x,y,peak_hz,peak_amplitude,status\n");
        for (x, y, peak) in self.pairs() {
            let _ = writeln!(
                text,
                "{x:.16e},{y:.16e},{:.16e},{:.16e},{}",
                peak.omega / TAU,
                peak.amplitude,
                peak.status.name().to_string_lossy()
            );
        }
        text
    }

    /// Arrays x, y, and peak_hz, peak_amplitude and status of shape (x, y).
    fn npz(&self, path: &Path) -> std::io::Result<()> {
        let mut npz = Npz::new(BufWriter::new(File::create(path)?));
        let shape = [self.x.values.len(), self.y.values.len()];
        let of = |value: fn(&DesignPeak) -> f64| self.peaks.iter().map(value).collect::<Vec<f64>>();
        npz.real("x", &shape[..1], &self.x.values)?;
        npz.real("y", &shape[1..], &self.y.values)?;
        npz.real("peak_hz", &shape, &of(|peak| peak.omega / TAU))?;
        npz.real("peak_amplitude", &shape, &of(|peak| peak.amplitude))?;
        npz.real("status", &shape, &of(|peak| f64::from(peak.status as i32)))?;
        npz.finish()
    }

    fn summary(&self) -> String {
        let mut text = format!("map of {}", counted(self.peaks.len(), "peak"));
        let failed: Vec<_> = self.pairs().filter(|(.., peak)| peak.status != Status::Ok).collect();
        let _ = writeln!(text, ", {} complete", self.peaks.len() - failed.len());
        let at = |x: f64, y: f64| {
            format!(
                "at {} {x:.8e}, {} {y:.8e}",
                self.x.varied.label(),
                self.y.varied.label()
            )
        };
        let found = || self.pairs().filter(|(.., peak)| peak.amplitude.is_finite());
        let by = |a: &(f64, f64, &DesignPeak), b: &(f64, f64, &DesignPeak)| a.2.amplitude.total_cmp(&b.2.amplitude);
        for (name, end) in [("least", found().min_by(by)), ("largest", found().max_by(by))] {
            if let Some((x, y, peak)) = end {
                let (amplitude, hz) = (peak.amplitude, peak.omega / TAU);
                let _ = writeln!(text, "{name} peak {amplitude:.6e} {}, {hz:.6} Hz", at(x, y));
            }
        }
        if let Some((x, y, peak)) = failed.first() {
            let reason = peak.reason.as_ref().map_or(String::new(), |e| format!(": {e}"));
            let _ = writeln!(text, "{} {}{reason}", peak.status.name().to_string_lossy(), at(*x, *y));
        }
        text
    }

    /// The peaks as colours over both values, on a logarithmic scale; white where there is none.
    fn figure(&self, path: &Path) -> Outcome<()> {
        let amplitudes = || self.peaks.iter().map(|peak| peak.amplitude).filter(|a| *a > 0.0);
        let (low, high) = amplitudes().fold((f64::INFINITY, 0.0_f64), |(l, h), a| (l.min(a), h.max(a)));
        let width = (high / low).ln();
        let share = |a: f64| if width > 0.0 { (a / low).ln() / width } else { 0.0 };
        let half = |values: &[f64]| 0.5 * (values[1] - values[0]);
        let (dx, dy) = (half(&self.x.values), half(&self.y.values));
        let range = |values: &[f64], d: f64| (values[0] - d)..(values[values.len() - 1] + d);
        draw(path, |area| {
            let (left, right) = area.split_horizontally(760);
            let mut chart = ChartBuilder::on(&left)
                .caption("highest peak", ("sans-serif", 18))
                .margin(16)
                .x_label_area_size(44)
                .y_label_area_size(90)
                .build_cartesian_2d(range(&self.x.values, dx), range(&self.y.values, dy))?;
            let mesh = &mut chart.configure_mesh();
            mesh.x_desc(self.x.varied.label()).y_desc(self.y.varied.label());
            mesh.x_label_formatter(&short(&self.x.values))
                .y_label_formatter(&short(&self.y.values))
                .disable_mesh()
                .draw()?;
            chart.draw_series(
                self.pairs()
                    .filter(|(.., peak)| peak.amplitude > 0.0)
                    .map(|(x, y, peak)| {
                        let cell = [(x - dx, y - dy), (x + dx, y + dy)];
                        Rectangle::new(cell, colour(share(peak.amplitude)).filled())
                    }),
            )?;
            if high > 0.0 {
                // Whole numbers of the legend are shares of its height.
                let amplitude = |row: &f64| format!("{:.2e}", low * (width * row).exp());
                let mut legend = ChartBuilder::on(&right)
                    .margin_top(50)
                    .margin_bottom(60)
                    .margin_right(16)
                    .y_label_area_size(74)
                    .build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
                let mesh = &mut legend.configure_mesh();
                mesh.disable_mesh().disable_x_axis();
                mesh.label_style(("sans-serif", 12));
                mesh.y_label_formatter(&amplitude).draw()?;
                legend.draw_series((0..COLOURS).map(|k| {
                    let edge = |k: usize| k as f64 / COLOURS as f64;
                    Rectangle::new([(0.0, edge(k)), (1.0, edge(k + 1))], colour(edge(k)).filled())
                }))?;
            }
            Ok(())
        })
    }
}

/// Numbers of an axis: plain where they are short; what is round-off beside its values is 0.
fn short(values: &[f64]) -> impl Fn(&f64) -> String + use<> {
    let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    move |value| {
        if value.abs() < 1e-9 * largest {
            return "0".into();
        }
        if !(1e-3..1e6).contains(&value.abs()) {
            return format!("{value:.2e}");
        }
        let plain = format!("{value:.6}");
        plain.trim_end_matches('0').trim_end_matches('.').into()
    }
}

/// Dark blue for the least peak, over green, to yellow for the largest.
fn colour(share: f64) -> RGBColor {
    let share = share.clamp(0.0, 1.0);
    let colour = HSLColor(0.72 - 0.57 * share, 0.75, 0.25 + 0.35 * share).to_rgba();
    RGBColor(colour.0, colour.1, colour.2)
}
