//! Drawing in the coordinates of a figure on a larger canvas.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Style;

type Outcome = Result<(), Box<dyn Error>>;

/// A point of the figure, in its pixels.
pub(super) type Point = (f64, f64);

/// Largest deviation of a drawn line from its points.
const TOLERANCE: f64 = 0.05;

/// Half the side of a tile.
const TILE: f64 = 11.0;

/// The same of a cell.
const CELL: f64 = 4.1;

/// A canvas `scale` times as large as the figure.
pub(super) struct Pen<DB: DrawingBackend> {
    pub(super) area: DrawingArea<DB, Shift>,
    scale: f64,
    raster: bool,
}

impl<DB: DrawingBackend<ErrorType: 'static>> Pen<DB> {
    pub(super) fn new(backend: DB, scale: u32, raster: bool) -> Self {
        let (area, scale) = (backend.into_drawing_area(), f64::from(scale));
        Self { area, scale, raster }
    }

    #[allow(clippy::cast_possible_truncation)]
    fn pixels(&self, length: f64) -> i32 {
        (length * self.scale).round() as i32
    }

    fn pixel(&self, at: Point) -> (i32, i32) {
        (self.pixels(at.0), self.pixels(at.1))
    }

    /// Draws an open polygon.
    pub(super) fn line(&self, points: &[Point], color: RGBColor, width: f64) -> Outcome {
        let points: Vec<_> = points.iter().map(|p| self.pixel(*p)).collect();
        let width = self.pixels(width);
        let stroke = color.stroke_width(width.unsigned_abs());
        if !self.raster || points.len() <= 2 {
            return Ok(self.area.draw(&PathElement::new(points, stroke))?);
        }
        // A thick polygon of many corners that overlaps itself would leave holes in the bitmap.
        for side in points.windows(2) {
            self.area.draw(&PathElement::new(side, stroke))?;
            self.area.draw(&Circle::new(side[1], width / 2, color.filled()))?;
        }
        Ok(())
    }

    /// Draws the part of a curve that lies in `frame`; the markers depend on `shape`.
    pub(super) fn curve(
        &self,
        points: &[Point],
        frame: [Point; 2],
        style: Style,
        (shape, color): (usize, RGBColor),
    ) -> Outcome {
        let [(x0, y0), (x1, y1)] = frame;
        let inside = |p: &&Point| (x0..=x1).contains(&p.0) && (y0..=y1).contains(&p.1);
        let mut runs = visible_runs(points, frame).into_iter().map(|run| simplify(&run));
        match style {
            Style::Line => runs.try_for_each(|run| self.line(&run, color, 2.0)),
            Style::Dashed => {
                let mut dashes = runs.flat_map(|run| dashes(&run, 9.0, 5.0));
                dashes.try_for_each(|dash| self.line(&dash, color, 2.0))
            }
            Style::Markers => {
                let mut shown = points.iter().filter(inside);
                shown.try_for_each(|p| self.marker(*p, shape, color))
            }
            Style::Rings => {
                let mut shown = points.iter().filter(inside);
                shown.try_for_each(|p| self.ring(*p, color))
            }
            Style::Tiles => {
                let mut shown = points.iter().filter(inside);
                shown.try_for_each(|p| self.tile(*p, TILE, color))
            }
            Style::Cells => {
                let mut shown = points.iter().filter(inside);
                shown.try_for_each(|p| self.tile(*p, CELL, color))
            }
        }
    }

    fn marker(&self, (x, y): Point, shape: usize, color: RGBColor) -> Outcome {
        let corners: &[Point] = match shape % 4 {
            0 => {
                let circle = Circle::new(self.pixel((x, y)), self.pixels(4.5), color.filled());
                return Ok(self.area.draw(&circle)?);
            }
            1 => &[(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)],
            2 => &[(-5.2, 4.0), (5.2, 4.0), (0.0, -5.5)],
            _ => &[(-5.5, 0.0), (0.0, -5.5), (5.5, 0.0), (0.0, 5.5)],
        };
        let corners: Vec<_> = corners.iter().map(|d| self.pixel((x + d.0, y + d.1))).collect();
        Ok(self.area.draw(&Polygon::new(corners, color.filled()))?)
    }

    fn tile(&self, (x, y): Point, half: f64, color: RGBColor) -> Outcome {
        let corners = [self.pixel((x - half, y - half)), self.pixel((x + half, y + half))];
        Ok(self.area.draw(&Rectangle::new(corners, color.filled()))?)
    }

    fn ring(&self, (x, y): Point, color: RGBColor) -> Outcome {
        let corner = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 36.0).sin_cos();
            (x + 8.0 * cos, y + 8.0 * sin)
        };
        self.line(&(0..=36).map(corner).collect::<Vec<_>>(), color, 1.6)
    }

    /// The width of a text.
    pub(super) fn width(&self, text: &str, size: f64) -> f64 {
        let style = ("sans-serif", size * self.scale).into_font().into();
        let extent = self.area.estimate_text_size(text, &style);
        extent.map_or(0.0, |e| f64::from(e.0) / self.scale)
    }

    /// Writes a text of at most `size` and `width`, centred vertically on `at`.
    pub(super) fn text(&self, text: &str, at: Point, size: f64, anchor: HPos, width: f64) -> Outcome {
        let size = self.fit(text, size, width);
        self.write(text, (at.0, at.1 + self.drop(size)), size, anchor, FontTransform::None)
    }

    /// Writes a text upwards, centred on `at`.
    pub(super) fn upright(&self, text: &str, at: Point, size: f64, width: f64) -> Outcome {
        let size = self.fit(text, size, width);
        let at = (at.0 + self.drop(size), at.1);
        self.write(text, at, size, HPos::Center, FontTransform::Rotate270)
    }

    fn fit(&self, text: &str, size: f64, width: f64) -> f64 {
        size * (width / self.width(text, size).max(1.0)).min(1.0)
    }

    /// Distance by which a text is lowered so that its capitals are centred.
    fn drop(&self, size: f64) -> f64 {
        size * if self.raster { 0.2 } else { 0.06 }
    }

    fn write(&self, text: &str, at: Point, size: f64, anchor: HPos, turn: FontTransform) -> Outcome {
        let font = ("sans-serif", size * self.scale).into_font().transform(turn);
        let style = font.color(&BLACK).pos(Pos::new(anchor, VPos::Center));
        Ok(self.area.draw_text(text, &style, self.pixel(at))?)
    }
}

/// Cuts a curve where it leaves the frame or is not finite.
fn visible_runs(points: &[Point], frame: [Point; 2]) -> Vec<Vec<Point>> {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    let mut joined = false;
    for pair in points.windows(2) {
        let Some((from, to, complete)) = clip(pair[0], pair[1], frame) else {
            joined = false;
            continue;
        };
        match runs.last_mut() {
            Some(run) if joined => run.push(to),
            _ => runs.push(vec![from, to]),
        }
        joined = complete;
    }
    runs
}

/// The part of the segment from `a` to `b` inside the frame (after Liang and Barsky), and `true` if it reaches `b`.
fn clip(a: Point, b: Point, [low, high]: [Point; 2]) -> Option<(Point, Point, bool)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    if !(dx.is_finite() && dy.is_finite()) {
        return None;
    }
    let (mut start, mut end) = (0.0_f64, 1.0_f64);
    let sides = [
        (-dx, a.0 - low.0),
        (dx, high.0 - a.0),
        (-dy, a.1 - low.1),
        (dy, high.1 - a.1),
    ];
    for (speed, room) in sides {
        if speed < 0.0 {
            start = start.max(room / speed);
        } else if speed > 0.0 {
            end = end.min(room / speed);
        } else if room < 0.0 {
            return None;
        }
    }
    let at = |t: f64| {
        let (x, y) = (a.0 + t * dx, a.1 + t * dy);
        (x.clamp(low.0, high.0), y.clamp(low.1, high.1))
    };
    (start <= end).then(|| (at(start), at(end), end >= 1.0))
}

/// Removes points that lie on the line through their neighbours.
fn simplify(points: &[Point]) -> Vec<Point> {
    let mut kept = points[..1].to_vec();
    let mut from = 0;
    for to in 2..points.len() {
        let near = |p: &Point| distance(*p, points[from], points[to]) < TOLERANCE;
        if to - from > 100 || !points[from + 1..to].iter().all(near) {
            from = to - 1;
            kept.push(points[from]);
        }
    }
    kept.extend(points.last());
    kept
}

/// The distance of `p` from the segment from `a` to `b`.
fn distance(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = (dx * dx + dy * dy).max(f64::MIN_POSITIVE);
    let t = (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / square).clamp(0.0, 1.0);
    (a.0 + t * dx - p.0).hypot(a.1 + t * dy - p.1)
}

/// Cuts a line into dashes with gaps between them.
fn dashes(points: &[Point], dash: f64, gap: f64) -> Vec<Vec<Point>> {
    let mut result = vec![points[..1].to_vec()];
    let (mut solid, mut left) = (true, dash);
    for side in points.windows(2) {
        let (mut a, b) = (side[0], side[1]);
        let mut length = (b.0 - a.0).hypot(b.1 - a.1);
        while length > left {
            let part = left / length;
            a = (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1));
            length -= left;
            match result.last_mut() {
                Some(current) if solid => current.push(a),
                _ => result.push(vec![a]),
            }
            solid = !solid;
            left = if solid { dash } else { gap };
        }
        left -= length;
        if let Some(current) = result.last_mut().filter(|_| solid) {
            current.push(b);
        }
    }
    result
}

/// Averages squares of `scale` times `scale` pixels of three bytes.
#[allow(clippy::cast_possible_truncation)]
pub(super) fn average(pixels: &[u8], width: usize, scale: usize) -> Vec<u8> {
    let mut result = Vec::with_capacity(pixels.len() / (scale * scale));
    for band in pixels.chunks_exact(3 * width * scale * scale) {
        let mut sums = vec![0_usize; 3 * width];
        for row in band.chunks_exact(3 * width * scale) {
            for (sum, cell) in sums.chunks_exact_mut(3).zip(row.chunks_exact(3 * scale)) {
                for pixel in cell.chunks_exact(3) {
                    sum.iter_mut().zip(pixel).for_each(|(s, p)| *s += usize::from(*p));
                }
            }
        }
        result.extend(sums.iter().map(|sum| (sum / (scale * scale)) as u8));
    }
    result
}
