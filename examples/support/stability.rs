//! Stretches of a response whose motion is unstable, for figures that dash them.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::error::Error;

use hbvib::{FloquetOptions, Hooks, Model, Status, Waves, floquet};

use crate::plot::{Series, Style};
use crate::response::{Point, Response};

/// Whether the motion of each point of a curve is known to be unstable: a curve that runs back between two folds has one
/// multiplier above 1 there.
pub fn between_folds(response: &Response) -> Vec<bool> {
    let points = &response.points;
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let rising = last.frequency >= first.frequency;
    let back = |a: &Point, b: &Point| {
        if rising {
            b.frequency < a.frequency
        } else {
            b.frequency > a.frequency
        }
    };
    let runs_back = |i: usize| {
        let to = |j: usize| j < points.len() && back(&points[j - 1], &points[j]);
        (i > 0 && to(i)) && to(i + 1)
    };
    (0..points.len()).map(runs_back).collect()
}

/// The same with the Floquet multipliers of the block of the wave at `checks` points, spread over the curve, each of which
/// stands for the points next to it. Harmonic motions are taken as they are.
///
/// # Errors
///
/// If the library fails. A law that integration in time does not take leaves the verdict of the folds.
pub fn checked(model: &Model, response: &Response, checks: usize) -> Result<Vec<bool>, Box<dyn Error>> {
    let mut unstable = between_folds(response);
    let options = FloquetOptions {
        waves: Waves::Wave,
        refine: false,
        ..FloquetOptions::default()
    };
    let count = unstable.len();
    for check in 0..checks.min(count) {
        let (from, to) = (check * count / checks, (check + 1) * count / checks);
        let at = response.points[usize::midpoint(from, to)].number;
        match floquet(model, &response.branch, at, &options, &mut Hooks::default()) {
            Ok(found) if found.unstable > 0 => unstable[from..to].fill(true),
            Ok(_) => {}
            Err(error) if error.status == Status::Unsupported => break,
            Err(error) => return Err(error.into()),
        }
    }
    Ok(unstable)
}

/// A curve as series of one label: solid where it is not known to be unstable, dashed where it is.
pub fn series(label: &str, points: &[(f64, f64)], unstable: &[bool]) -> Vec<Series> {
    let mut series: Vec<Series> = Vec::new();
    let mut last = None;
    for (point, &unstable) in points.iter().zip(unstable) {
        let style = if unstable { Style::Dashed } else { Style::Line };
        match series.last_mut() {
            Some(current) if current.style == style => current.points.push(*point),
            _ => series.push(Series::new(label, style, last.into_iter().chain([*point]).collect())),
        }
        last = Some(*point);
    }
    series
}
