//! Figures of contacts: force over motion, and slip fraction over frequency.

use crate::outputs::curve::Curve;
use crate::outputs::figure::{Area, bounds, draw, draw_text, scientific};
use crate::texts::outcome::Outcome;
use hbvib::{ContactLoop, Special};
use plotters::prelude::{ChartBuilder, LineSeries, PathElement, Rectangle};
use plotters::style::{BLACK, Color, HSLColor, Palette, Palette99, RGBColor, WHITE};
use std::f64::consts::TAU;
use std::path::Path;

/// Outcome of drawing.
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Closed loops of force over motion, one for each point and direction.
///
/// # Errors
/// A sentence.
pub fn loops_figure(path: &Path, label: &str, loops: &[(Special, ContactLoop)]) -> Outcome<()> {
    draw(path, |area| loops_content(area, label, loops))
}

/// The same as text of SVG.
///
/// # Errors
/// A sentence.
pub fn loops_svg(label: &str, loops: &[(Special, ContactLoop)]) -> Outcome<String> {
    draw_text(|area| loops_content(area, label, loops))
}

fn loops_content(area: &Area<'_>, label: &str, loops: &[(Special, ContactLoop)]) -> Drawn {
    let mut curves: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    for (point, one) in loops {
        for d in 0..one.directions {
            let direction = match one.directions {
                1 => String::new(),
                _ => format!(", direction {d}"),
            };
            let along = |all: &[f64]| all.iter().skip(d).step_by(one.directions).copied().collect::<Vec<_>>();
            let mut curve: Vec<_> = along(&one.motion).into_iter().zip(along(&one.force)).collect();
            curve.extend(curve.first().copied());
            curves.push((format!("{:.6} Hz{direction}", point.omega / TAU), curve));
        }
    }
    let points = || curves.iter().flat_map(|(_, curve)| curve);
    let (x, y) = (bounds(points().map(|p| p.0)), bounds(points().map(|p| p.1)));
    let mut chart = ChartBuilder::on(area)
        .caption(format!("contact {label}"), ("sans-serif", 18))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(90)
        .build_cartesian_2d(x.clone(), y.clone())?;
    let mesh = &mut chart.configure_mesh();
    mesh.x_desc("relative motion").y_desc("force");
    let (x_label, y_label) = (scientific(&x), scientific(&y));
    mesh.x_label_formatter(&x_label).y_label_formatter(&y_label).draw()?;
    for (i, (name, curve)) in curves.iter().enumerate() {
        let colour = Palette99::pick(i).to_rgba();
        chart
            .draw_series(LineSeries::new(curve.iter().copied(), &colour))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
    }
    chart
        .configure_series_labels()
        .background_style(WHITE)
        .border_style(BLACK)
        .draw()?;
    Ok(())
}

/// Number of colours of a slip map.
const LEVELS: f64 = 20.0;

/// A part of a row of the slip map.
struct Stretch {
    from: f64,
    to: f64,
    contact: usize,
    level: u32,
}

/// A row for each contact, its slip fraction as colour over frequency. Where the curve folds back, the larger slip is
/// on top.
///
/// # Errors
/// A sentence.
pub fn slip_figure(path: &Path, curve: &Curve<'_>, labels: &[String]) -> Outcome<()> {
    draw(path, |area| slip_content(area, curve, labels))
}

/// The same as text of SVG.
///
/// # Errors
/// A sentence.
pub fn slip_svg(curve: &Curve<'_>, labels: &[String]) -> Outcome<String> {
    draw_text(|area| slip_content(area, curve, labels))
}

fn slip_content(area: &Area<'_>, curve: &Curve<'_>, labels: &[String]) -> Drawn {
    let stretches = stretches(curve, labels.len());
    let omega = curve.omega();
    let hertz = || omega.iter().map(|w| w / TAU);
    let contacts = labels.len().max(1) as f64;
    let mut chart = ChartBuilder::on(area)
        .caption("slip fraction of each contact: white 0, dark red 1", ("sans-serif", 18))
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(110)
        .build_cartesian_2d(bounds(hertz()), -0.5..contacts - 0.5)?;
    chart.draw_series(stretches.iter().map(|s| {
        let row = s.contact as f64;
        Rectangle::new([(s.from, row - 0.5), (s.to, row + 0.5)], colour(s.level).filled())
    }))?;
    // Rows are centred at whole numbers.
    let name = |row: &f64| {
        let whole = (row - row.round()).abs() < 1e-6;
        let label = labels.get(row.round() as usize).filter(|_| whole && *row > -0.5);
        label.cloned().unwrap_or_default()
    };
    let mesh = &mut chart.configure_mesh();
    mesh.x_desc("frequency, Hz").y_desc("contact");
    mesh.y_labels((labels.len() + 2).clamp(3, 20)).y_label_formatter(&name);
    mesh.disable_mesh().draw()?;
    Ok(())
}

fn colour(level: u32) -> RGBColor {
    let slip = f64::from(level) / LEVELS;
    let colour = HSLColor(0.02, 0.9, 0.96 - 0.66 * slip).to_rgba();
    RGBColor(colour.0, colour.1, colour.2)
}

/// Neighbours of one colour in a row, the larger slip last. A point reaches halfway to its neighbours.
fn stretches(curve: &Curve<'_>, contacts: usize) -> Vec<Stretch> {
    let (points, omega) = (curve.points(), curve.omega());
    let hertz = |p: usize| omega[p] / TAU;
    let mut all: Vec<Stretch> = Vec::new();
    for contact in 0..contacts {
        let mut open: Option<Stretch> = None;
        for p in 0..points {
            let before = 0.5 * (hertz(p) + hertz(p.saturating_sub(1)));
            let after = 0.5 * (hertz(p) + hertz((p + 1).min(points - 1)));
            let slip = curve.slip(p).get(contact);
            // Any slip has a colour.
            let level = (slip.copied().unwrap_or(0.0) * LEVELS).ceil() as u32;
            let (from, to) = (before.min(after).min(hertz(p)), before.max(after).max(hertz(p)));
            match &mut open {
                Some(stretch) if stretch.level == level => {
                    stretch.from = stretch.from.min(from);
                    stretch.to = stretch.to.max(to);
                }
                _ => {
                    all.extend(open.take());
                    open = Some(Stretch {
                        from,
                        to,
                        contact,
                        level,
                    });
                }
            }
        }
        all.extend(open);
    }
    all.retain(|stretch| stretch.level > 0);
    all.sort_by_key(|stretch| stretch.level);
    all
}
