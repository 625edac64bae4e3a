//! Line charts for the examples: every figure is written as SVG and as PNG.
//!
//! The charts are drawn by `plotters` onto a canvas several times larger than the figure. The SVG
//! is scaled back by its view box and the PNG by averaging, which gives smooth lines without
//! system libraries. The only font is one of the `dejavu` crate, linked into the program.
#![allow(dead_code, reason = "each example uses a part of this module")]

use std::{error::Error, ffi::OsString, fs, io::BufWriter, path::Path};

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use axis::Axis;
use pen::{Pen, Point};

#[path = "plot/axis.rs"]
mod axis;
#[path = "plot/palette.rs"]
mod palette;
#[path = "plot/pen.rs"]
mod pen;

const SIZE: (u32, u32) = (1000, 650);
const SVG_SCALE: u32 = 10;
const PNG_SCALE: u32 = 3;
const FRAME: RGBColor = RGBColor(60, 60, 60);
const MAJOR: RGBColor = RGBColor(205, 205, 205);
const MINOR: RGBColor = RGBColor(236, 236, 236);
const TITLE_TEXT: f64 = 22.0;
const LABEL_TEXT: f64 = 19.0;
const TICK_TEXT: f64 = 17.0;
const LEGEND_TEXT: f64 = 16.0;
/// Length of the line in an entry of the legend, and the position of the text after it.
const SAMPLE: (f64, f64) = (30.0, 40.0);

type Outcome = Result<(), Box<dyn Error>>;

/// Style of the points of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// A solid line through the points.
    #[default]
    Line,
    /// A dashed line through the points; a single dashed label among others is drawn in black.
    Dashed,
    /// A symbol at every point.
    Markers,
    /// A circle around every point, beside a dashed line of the same label.
    Rings,
    /// A large square at every point, for maps.
    Tiles,
    /// A small square at every point, for maps of many points.
    Cells,
}

/// Named points of one curve. Points that are not finite interrupt the line.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Legend entry. Series with the same label share one entry and one colour, so that a line and its markers are
    /// two series of one label; an empty label has no entry.
    pub label: String,
    /// Abscissa and ordinate of every point.
    pub points: Vec<(f64, f64)>,
    /// Style of the points.
    pub style: Style,
}

impl Series {
    /// Makes a series from its parts.
    pub fn new(label: impl Into<String>, style: Style, points: Vec<(f64, f64)>) -> Self {
        let label = label.into();
        Self { label, points, style }
    }
}

/// A chart of some series over common axes.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    /// Text above the chart.
    pub title: String,
    /// Name and unit of the abscissa.
    pub x_label: String,
    /// Name and unit of the ordinate.
    pub y_label: String,
    /// Whether the abscissa is logarithmic.
    pub log_x: bool,
    /// Whether the ordinate is logarithmic.
    pub log_y: bool,
    /// Ends of the abscissa, or `None` to take them from the points.
    pub x_range: Option<(f64, f64)>,
    /// Ends of the ordinate, or `None` to take them from the points inside the abscissa.
    pub y_range: Option<(f64, f64)>,
    /// The curves, drawn in this order.
    pub series: Vec<Series>,
    /// Text above the legend, for example the name and unit of the parameter of a family.
    pub legend_title: String,
}

impl Figure {
    /// Writes the figure to `stem.svg` and `stem.png`, creating the folder if it is missing.
    ///
    /// # Errors
    ///
    /// If there is nothing to show, a range is empty, or a file cannot be written.
    pub fn save(&self, stem: &Path) -> Result<(), Box<dyn Error>> {
        plotters::style::register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular())
            .map_err(|_| "the embedded font cannot be read")?;
        if let Some(folder) = stem.parent() {
            fs::create_dir_all(folder)?;
        }
        let with_suffix = |suffix: &str| {
            let mut path = OsString::from(stem);
            path.push(suffix);
            path
        };
        let (width, height) = SIZE;
        let scaled = |scale: u32| (width * scale, height * scale);
        let size = |(w, h): (u32, u32)| format!(r#"width="{w}" height="{h}""#);

        let large = scaled(SVG_SCALE);
        let mut svg = String::new();
        let canvas = SVGBackend::with_string(&mut svg, large);
        self.draw(&Pen::new(canvas, SVG_SCALE, false))?;
        fs::write(with_suffix(".svg"), svg.replacen(&size(large), &size(SIZE), 1))?;

        let large = scaled(PNG_SCALE);
        let mut pixels = vec![255; 3 * large.0 as usize * large.1 as usize];
        let canvas = BitMapBackend::with_buffer(&mut pixels, large);
        self.draw(&Pen::new(canvas, PNG_SCALE, true))?;
        let file = BufWriter::new(fs::File::create(with_suffix(".png"))?);
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pen::average(&pixels, width as usize, PNG_SCALE as usize))?;
        Ok(writer.finish()?)
    }

    fn draw<DB: DrawingBackend<ErrorType: 'static>>(&self, pen: &Pen<DB>) -> Outcome {
        let points = || self.series.iter().flat_map(|s| s.points.iter().copied());
        let has_markers = self.series.iter().any(|s| s.style == Style::Markers);
        let has_tiles = self.series.iter().any(|s| s.style == Style::Tiles);
        let x_pad = match (has_tiles, has_markers) {
            (true, _) => 0.06,
            (false, true) => 0.03,
            (false, false) => 0.0,
        };
        let mut x = Axis::new(points().map(|p| p.0), self.x_range, self.log_x, x_pad)?;
        let shown = points().filter(|p| (0.0..=1.0).contains(&x.position(p.0)));
        let mut y = Axis::new(
            shown.map(|p| p.1),
            self.y_range,
            self.log_y,
            if has_tiles { 0.1 } else { 0.04 },
        )?;

        let legend = palette::legend(&self.series);
        let entry = |l: &str| {
            if l.is_empty() {
                0.0
            } else {
                SAMPLE.1 + pen.width(l, LEGEND_TEXT)
            }
        };
        let entries = legend.iter().map(|l| entry(l.0)).fold(0.0, f64::max);
        let legend_width = entries.max(pen.width(&self.legend_title, LEGEND_TEXT)).min(330.0);
        let margin = if legend_width > 0.0 { legend_width + 32.0 } else { 30.0 };
        let top = if self.title.is_empty() { 20.0 } else { 50.0 };
        let tick_width = |tick: &(f64, String)| pen.width(&tick.1, TICK_TEXT);
        y.set_ticks(if self.log_y { 12 } else { 8 });
        let left = 50.0 + y.ticks.iter().map(tick_width).fold(0.0, f64::max);
        let (right, bottom) = (f64::from(SIZE.0) - margin, f64::from(SIZE.1) - 66.0);
        for count in [13, 8, 5, 3] {
            x.set_ticks(count);
            if x.ticks.iter().map(|t| tick_width(t) + 18.0).sum::<f64>() < right - left {
                break;
            }
        }

        pen.area.fill(&WHITE)?;
        let frame = [(left, top), (right, bottom)];
        self.draw_axes(pen, frame, &x, &y)?;
        let place = |p: &Point| {
            let (u, v) = (x.position(p.0), y.position(p.1));
            (left + u * (right - left), bottom - v * (bottom - top))
        };
        for series in &self.series {
            let points: Vec<_> = series.points.iter().map(place).collect();
            let entry = legend.iter().enumerate().find(|l| l.1.0 == series.label);
            if let Some((shape, (_, color))) = entry {
                pen.curve(&points, frame, series.style, (shape, *color))?;
            }
        }
        let corners = [(right + 16.0, top), (right + 16.0 + legend_width, bottom)];
        self.draw_legend(pen, corners, &legend)?;
        Ok(pen.area.present()?)
    }

    #[allow(clippy::cast_precision_loss)]
    fn draw_legend<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        pen: &Pen<DB>,
        [(left, top), (right, bottom)]: [Point; 2],
        legend: &[(&str, RGBColor)],
    ) -> Outcome {
        let row = ((bottom - top) / (legend.len() + 1) as f64).min(25.0);
        let size = LEGEND_TEXT.min(row * 0.9);
        let mut at = top + row / 2.0;
        if !self.legend_title.is_empty() {
            pen.text(&self.legend_title, (left, at), LEGEND_TEXT, HPos::Left, right - left)?;
            at += row;
        }
        for (shape, (label, color)) in legend.iter().enumerate().filter(|l| !l.1.0.is_empty()) {
            for series in self.series.iter().filter(|s| s.label == *label) {
                let sample: &[Point] = match series.style {
                    Style::Markers | Style::Rings | Style::Tiles | Style::Cells => &[(left + SAMPLE.0 / 2.0, at)],
                    _ => &[(left, at), (left + SAMPLE.0, at)],
                };
                let frame = [(left, top), (right, bottom)];
                pen.curve(sample, frame, series.style, (shape, *color))?;
            }
            let start = left + SAMPLE.1;
            pen.text(label, (start, at), size, HPos::Left, right - start)?;
            at += row;
        }
        Ok(())
    }

    fn draw_axes<DB: DrawingBackend<ErrorType: 'static>>(
        &self,
        pen: &Pen<DB>,
        [(x0, y0), (x1, y1)]: [Point; 2],
        x: &Axis,
        y: &Axis,
    ) -> Outcome {
        let across = |v: f64| x0 + x.position(v) * (x1 - x0);
        let up = |v: f64| y1 - y.position(v) * (y1 - y0);
        let vertical = |v: f64, c| pen.line(&[(across(v), y0), (across(v), y1)], c, 1.0);
        let horizontal = |v: f64, c| pen.line(&[(x0, up(v)), (x1, up(v))], c, 1.0);
        x.minor.iter().try_for_each(|v| vertical(*v, MINOR))?;
        y.minor.iter().try_for_each(|v| horizontal(*v, MINOR))?;
        x.ticks.iter().try_for_each(|t| vertical(t.0, MAJOR))?;
        y.ticks.iter().try_for_each(|t| horizontal(t.0, MAJOR))?;
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)];
        corners.windows(2).try_for_each(|side| pen.line(side, FRAME, 1.3))?;
        for (value, label) in &x.ticks {
            let at = across(*value);
            pen.line(&[(at, y1), (at, y1 + 6.0)], FRAME, 1.3)?;
            pen.text(label, (at, y1 + 18.0), TICK_TEXT, HPos::Center, x1 - x0)?;
        }
        for (value, label) in &y.ticks {
            let at = up(*value);
            pen.line(&[(x0 - 6.0, at), (x0, at)], FRAME, 1.3)?;
            pen.text(label, (x0 - 10.0, at), TICK_TEXT, HPos::Right, x0)?;
        }
        let (middle, height) = (f64::midpoint(x0, x1), f64::from(SIZE.1));
        let width = 2.0 * middle.min(f64::from(SIZE.0) - middle) - 16.0;
        pen.text(&self.title, (middle, 25.0), TITLE_TEXT, HPos::Center, width)?;
        pen.text(&self.x_label, (middle, height - 20.0), LABEL_TEXT, HPos::Center, width)?;
        pen.upright(&self.y_label, (20.0, f64::midpoint(y0, y1)), LABEL_TEXT, height - 30.0)
    }
}
