//! Figures as SVG or, where the name of the file ends so, as PNG.

use crate::outputs::canvas::Canvas;
use crate::texts::outcome::Outcome;
use plotters::coord::Shift;
use plotters::prelude::{BitMapBackend, DrawingArea, IntoDrawingArea, SVGBackend};
use plotters::style::{FontStyle, WHITE, register_font};
use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::ops::Range;
use std::path::Path;

/// Width and height in pixels.
pub const SIZE: (u32, u32) = (900, 600);

/// The white area of a figure.
pub type Area<'a> = DrawingArea<Canvas<'a>, Shift>;

/// Draws a figure and writes it.
///
/// # Errors
/// A sentence.
pub fn draw(path: &Path, content: impl FnOnce(&Area<'_>) -> Result<(), Box<dyn Error>>) -> Outcome<()> {
    if path.extension().is_some_and(|name| name.eq_ignore_ascii_case("png")) {
        let mut pixels = vec![255; 3 * SIZE.0 as usize * SIZE.1 as usize];
        let canvas = Canvas::Pixels(BitMapBackend::with_buffer(&mut pixels, SIZE));
        drawn(canvas, content).map_err(|e| e.to_string())?;
        return png(path, &pixels).map_err(|e| e.to_string());
    }
    fs::write(path, draw_text(content)?).map_err(|e| e.to_string())
}

/// Draws a figure as text of SVG.
///
/// # Errors
/// A sentence.
pub fn draw_text(content: impl FnOnce(&Area<'_>) -> Result<(), Box<dyn Error>>) -> Outcome<String> {
    let mut text = String::new();
    drawn(Canvas::Vectors(SVGBackend::with_string(&mut text, SIZE)), content).map_err(|e| e.to_string())?;
    Ok(text)
}

fn drawn(
    canvas: Canvas<'_>,
    content: impl FnOnce(&Area<'_>) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    // The one font, of which texts have their size: the figure needs none of the system.
    register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| "the font of the figure cannot be read")?;
    let area = canvas.into_drawing_area();
    area.fill(&WHITE)?;
    content(&area)?;
    area.present()?;
    Ok(())
}

fn png(path: &Path, pixels: &[u8]) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), SIZE.0, SIZE.1);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    Ok(writer.finish()?)
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

/// Writes the numbers of an axis; what is round-off beside its range is 0. A short range of large numbers has more digits.
pub fn scientific(range: &Range<f64>) -> impl Fn(&f64) -> String + use<> {
    let length = range.end - range.start;
    let small = 1e-9 * length;
    let largest = range.start.abs().max(range.end.abs());
    let digits = (largest / length).log10().max(0.0).ceil() as usize + 2;
    move |v| {
        if v.abs() < small {
            "0".into()
        } else {
            format!("{v:.*e}", digits.min(12))
        }
    }
}
