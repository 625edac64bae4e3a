//! Figures as SVG.

use crate::build::Outcome;
use plotters::coord::Shift;
use plotters::prelude::{DrawingArea, IntoDrawingArea, SVGBackend};
use plotters::style::WHITE;
use std::error::Error;
use std::fs;
use std::ops::Range;
use std::path::Path;

/// The white area of a figure.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws a figure and writes it.
///
/// # Errors
/// A sentence.
pub fn draw(path: &Path, content: impl FnOnce(&Area<'_>) -> Result<(), Box<dyn Error>>) -> Outcome<()> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (900, 600)).into_drawing_area();
        let drawn = || -> Result<(), Box<dyn Error>> {
            area.fill(&WHITE)?;
            content(&area)?;
            area.present()?;
            Ok(())
        };
        drawn().map_err(|e| e.to_string())?;
    }
    fs::write(path, text).map_err(|e| e.to_string())
}

/// The range of an axis that shows all values, with some room.
pub fn bounds(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    if low > high {
        return 0.0..1.0;
    }
    let room = 0.04 * (high - low).max(1e-9 * high.abs().max(f64::MIN_POSITIVE));
    (low - room)..(high + room)
}
