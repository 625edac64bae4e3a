//! Time against error, one figure for each system.

use std::path::Path;

use hbvib::error::Status;

use crate::measure::Outcome;
use crate::plot::{Figure, Series, Style};
use crate::tables::{Done, Measured};
use crate::truth::ROUNDING;

/// Draws the ways of a system: fixed harmonics, samples with their harmonics, tolerances.
///
/// # Errors
///
/// If a file cannot be written.
pub fn draw(measured: &Measured, folder: &Path) -> Done {
    let place = |o: &Outcome| (o.error().max(o.own_error()).max(ROUNDING), 1e3 * o.seconds);
    // A way is shown if no common frequency is missing, or if it chooses its harmonics and its branch covers the
    // whole range.
    let is_shown = |o: &Outcome| o.missing() == 0 || (o.way.is_automatic() && o.status == Status::Ok);
    let mut series = Vec::new();
    let mut add = |label: String, chosen: &dyn Fn(&Outcome) -> bool| {
        let shown = measured.outcomes.iter().filter(|o| chosen(o) && is_shown(o));
        let points: Vec<_> = shown.map(place).collect();
        if !points.is_empty() {
            series.push(Series::new(label.clone(), Style::Line, points.clone()));
            series.push(Series::new(label, Style::Markers, points));
        }
    };
    add("H fixed".into(), &|o| !o.way.is_automatic() && o.way.samples == 0);
    for &h in measured.system.sampled {
        add(format!("H = {h}, N samples"), &|o| {
            !o.way.is_automatic() && o.way.samples > 0 && o.way.harmonics == h
        });
    }
    add("tolerance".into(), &|o| o.way.is_automatic());
    let figure = Figure {
        title: format!("({}) {}", measured.system.key, measured.system.title),
        x_label: "Largest relative error of the fundamental".into(),
        y_label: "Time of the whole response [ms]".into(),
        log_x: true,
        log_y: true,
        series,
        ..Figure::default()
    };
    figure.save(&folder.join(format!("system_{}", measured.system.key)))
}
