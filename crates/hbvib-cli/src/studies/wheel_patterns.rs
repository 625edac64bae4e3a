//! Many patterns of a wheel: the largest blade of each, and the distribution of their amplification.

use crate::building::built::Built;
use crate::job_file::job_studies::WheelPart;
use crate::outputs::figure::{Area, SIZE, bounds, draw};
use crate::outputs::files::Files;
use crate::studies::map::Written;
use crate::studies::wheel_response::{mistuned, peaks};
use crate::texts::counted::counted;
use crate::texts::outcome::Outcome;
use hbvib::{Hooks, Status};
use plotters::prelude::{ChartBuilder, Circle, LineSeries};
use plotters::style::{BLUE, Color, RED};
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Share of the wheels whose amplification is told beside the largest.
const TOLD_SHARE: f64 = 0.95;

/// The largest blade of a pattern.
struct Row {
    blade: usize,
    omega: f64,
    amplitude: f64,
    amplification: f64,
}

/// The patterns of a file: one a line, numbers between commas, semicolons or blanks; `#` begins a comment.
///
/// # Errors
/// A sentence.
pub fn read(path: &Path) -> Outcome<Vec<Vec<f64>>> {
    let text = fs::read_to_string(path).map_err(|e| format!("cannot be read: {e}"))?;
    let mut rows = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let words = line.split(|c: char| c == ',' || c == ';' || c.is_whitespace());
        let words = words.filter(|word| !word.is_empty());
        let row: Outcome<Vec<f64>> = words
            .map(|word| {
                let value: Option<f64> = word.parse().ok();
                value.ok_or_else(|| format!("line {}: {word}, needs a number", number + 1))
            })
            .collect();
        let row = row?;
        if !row.is_empty() {
            rows.push(row);
        }
    }
    if rows.is_empty() {
        return Err("has no pattern".to_owned());
    }
    Ok(rows)
}

/// Refuses patterns of which no wheel can be made.
///
/// # Errors
/// A sentence.
pub fn check(part: &WheelPart, path: &Path, built: &Built) -> Outcome<()> {
    let said = |e: String| format!("[wheel] patterns: {}: {e}", path.display());
    for (k, pattern) in read(path).map_err(said)?.iter().enumerate() {
        mistuned(part, pattern, built).map_err(|e| said(format!("pattern {k}: {e}")))?;
    }
    Ok(())
}

/// Computes and writes the largest blade of each pattern.
///
/// # Errors
/// A sentence.
pub fn write(
    part: &WheelPart,
    path: &Path,
    built: &Built,
    hooks: &mut Hooks<'_>,
    files: &mut Files<'_>,
) -> Outcome<Written> {
    let patterns = read(path).map_err(|e| format!("[wheel] patterns: {}: {e}", path.display()))?;
    let mut rows = Vec::new();
    let mut ended = None;
    for (k, pattern) in patterns.iter().enumerate() {
        let wheel = mistuned(part, pattern, built)?;
        let found = peaks(part, &wheel, built, hooks)?;
        if found.branch.status() != Status::Ok {
            ended = Some(format!("pattern {k}: {}", found.branch.status().sentence()));
            break;
        }
        let Some(blade) = found.largest else {
            return Err(format!("[wheel]: pattern {k} has no peak within the range"));
        };
        rows.push(Row {
            blade,
            omega: found.blades[blade].omega,
            amplitude: found.blades[blade].amplitude,
            amplification: found.amplification(),
        });
    }
    if rows.is_empty() {
        let reason = ended.unwrap_or_default();
        return Ok((format!("[wheel]: {reason}\n"), true));
    }
    files.write(part.patterns_csv.as_deref(), &|path| {
        fs::write(path, table(&rows)).map_err(|e| e.to_string())
    });
    files.write(part.patterns_figure.as_deref(), &|path| {
        draw(path, |area| charts(area, &rows))
    });
    let mut text = summary(&rows);
    if let Some(reason) = &ended {
        let _ = writeln!(text, "[wheel]: the patterns ended early: {reason}");
    }
    Ok((text, ended.is_some()))
}

fn table(rows: &[Row]) -> String {
    let mut text = String::from("pattern,blade,hz,amplitude,amplification\n");
    for (k, row) in rows.iter().enumerate() {
        let hz = row.omega / TAU;
        let _ = writeln!(
            text,
            "{k},{},{hz:.16e},{:.16e},{:.16e}",
            row.blade, row.amplitude, row.amplification
        );
    }
    text
}

/// Amplifications from the smallest.
fn ordered(rows: &[Row]) -> Vec<f64> {
    let mut values: Vec<f64> = rows.iter().map(|row| row.amplification).collect();
    values.sort_by(f64::total_cmp);
    values
}

fn summary(rows: &[Row]) -> String {
    let values = ordered(rows);
    let worst = (0..rows.len()).max_by(|&i, &j| rows[i].amplification.total_cmp(&rows[j].amplification));
    let worst = worst.unwrap_or_default();
    let at = ((TOLD_SHARE * values.len() as f64).ceil() as usize).clamp(1, values.len()) - 1;
    format!(
        "{}: the largest amplification is {:.4}, blade {} of pattern {worst}; {:.0} % are up to {:.4}\n",
        counted(rows.len(), "pattern"),
        rows[worst].amplification,
        rows[worst].blade,
        100.0 * TOLD_SHARE,
        values[at]
    )
}

/// Amplification over the number of the pattern, and its cumulative distribution.
fn charts(area: &Area<'_>, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let (left, right) = area.split_horizontally(SIZE.0 / 2);
    let values = ordered(rows);
    let range = bounds(values.iter().copied());
    let mut chart = ChartBuilder::on(&left)
        .caption("largest blade of each pattern", ("sans-serif", 18))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(-1.0..rows.len() as f64, range.clone())?;
    chart
        .configure_mesh()
        .x_desc("pattern")
        .y_desc("amplification")
        .max_light_lines(1)
        .draw()?;
    let points = rows.iter().enumerate();
    chart.draw_series(points.map(|(k, row)| Circle::new((k as f64, row.amplification), 2, BLUE.filled())))?;
    let mut chart = ChartBuilder::on(&right)
        .caption("share of the patterns", ("sans-serif", 18))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(range, 0.0..1.0)?;
    chart
        .configure_mesh()
        .x_desc("amplification")
        .y_desc("share that is not above it")
        .max_light_lines(1)
        .draw()?;
    // Steps: each value raises the share by 1 / n.
    let share = |k: usize| k as f64 / values.len() as f64;
    let steps = values.iter().enumerate();
    let steps = steps.flat_map(|(k, &x)| [(x, share(k)), (x, share(k + 1))]);
    chart.draw_series(LineSeries::new(steps, RED.stroke_width(2)))?;
    Ok(())
}
