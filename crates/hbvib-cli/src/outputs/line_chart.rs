//! A chart of lines with linear or logarithmic axes, markers and a legend.

use crate::outputs::figure::{Area, SIZE, bounds, draw, draw_text, scientific};
use crate::texts::outcome::Outcome;
use plotters::prelude::{ChartBuilder, Circle, LineSeries, PathElement, Text};
use plotters::style::{BLACK, Color, IntoFont, Palette, Palette99};
use std::error::Error;
use std::path::Path;

/// Size of the letters of the legend, and the distance of its lines, in pixels.
const LETTERS: (u32, i32) = (12, 18);

/// A line with its name.
pub struct Line {
    pub name: String,
    pub points: Vec<(f64, f64)>,
    /// Points that have a larger mark, as peaks.
    pub marked: Vec<(f64, f64)>,
}

/// A chart.
pub struct Chart {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub log_x: bool,
    pub log_y: bool,
    /// A mark at each point.
    pub markers: bool,
    pub lines: Vec<Line>,
}

impl Chart {
    /// Draws it as SVG or PNG, which the name of the file tells.
    ///
    /// # Errors
    /// A sentence: nothing that can be drawn on these axes; that of the system.
    pub fn write(&self, path: &Path) -> Outcome<()> {
        self.drawable()?;
        draw(path, |area| self.content(area))
    }

    /// The chart as text of SVG.
    ///
    /// # Errors
    /// A sentence.
    pub fn svg(&self) -> Outcome<String> {
        self.drawable()?;
        draw_text(|area| self.content(area))
    }

    fn drawable(&self) -> Outcome<()> {
        let any = self
            .lines
            .iter()
            .any(|line| line.points.iter().any(|point| self.place(*point).is_some()));
        match any {
            true => Ok(()),
            false if self.log_x || self.log_y => Err("no point is above zero, as logarithmic axes need".into()),
            false => Err("there is no point to draw".into()),
        }
    }

    /// A point on the axes; `None` for one that they do not have.
    fn place(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        let of = |v: f64, log: bool| if log { v.log10() } else { v };
        let at = (of(x, self.log_x), of(y, self.log_y));
        (at.0.is_finite() && at.1.is_finite()).then_some(at)
    }

    fn content(&self, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
        // The legend stands beside the axes: within, it would hide data.
        let (area, legend) = match self.lines.len() {
            0 | 1 => (area.clone(), None),
            _ => {
                let (left, right) = area.split_horizontally(SIZE.0 - self.legend_width());
                (left, Some(right))
            }
        };
        if let Some(legend) = legend {
            self.legend(&legend)?;
        }
        let placed = |points: &[(f64, f64)]| points.iter().filter_map(|p| self.place(*p)).collect::<Vec<_>>();
        let of_line = |line: &Line| [placed(&line.points), placed(&line.marked)].concat();
        let all: Vec<(f64, f64)> = self.lines.iter().flat_map(of_line).collect();
        let (x, y) = (bounds(all.iter().map(|p| p.0)), bounds(all.iter().map(|p| p.1)));
        let mut chart = ChartBuilder::on(&area)
            .caption(&self.title, ("sans-serif", 18))
            .margin(16)
            .x_label_area_size(44)
            .y_label_area_size(90)
            .build_cartesian_2d(x.clone(), y.clone())?;
        let power = |v: &f64| format!("{:.2e}", 10_f64.powf(*v));
        let plain = |v: &f64| format!("{v:.6}").trim_end_matches('0').trim_end_matches('.').to_owned();
        let small = scientific(&y);
        let x_form: &dyn Fn(&f64) -> String = if self.log_x { &power } else { &plain };
        let y_form: &dyn Fn(&f64) -> String = if self.log_y { &power } else { &small };
        let mesh = &mut chart.configure_mesh();
        mesh.x_desc(&self.x_label).y_desc(&self.y_label);
        mesh.x_label_formatter(&x_form).y_label_formatter(&y_form).draw()?;
        for (i, line) in self.lines.iter().enumerate() {
            let colour = Palette99::pick(i).to_rgba();
            let points = placed(&line.points);
            chart.draw_series(LineSeries::new(points.iter().copied(), &colour))?;
            if self.markers {
                chart.draw_series(points.iter().map(|p| Circle::new(*p, 2, colour.filled())))?;
            }
            let marked = placed(&line.marked);
            chart.draw_series(marked.iter().map(|p| Circle::new(*p, 5, colour)))?;
        }
        Ok(())
    }

    /// Width of the legend in pixels: at most two fifths of the figure.
    fn legend_width(&self) -> u32 {
        let longest = self.lines.iter().map(|line| line.name.chars().count()).max();
        let letters = u32::try_from(longest.unwrap_or(0)).unwrap_or(u32::MAX);
        (letters.saturating_mul(LETTERS.0).saturating_mul(2) / 3 + 44).min(2 * SIZE.0 / 5)
    }

    /// Names of the lines, one under the other; those for which there is no room are counted.
    fn legend(&self, area: &Area<'_>) -> Result<(), Box<dyn Error>> {
        let font = || ("sans-serif", LETTERS.0).into_font();
        let room = (SIZE.1 as i32 - 80) / LETTERS.1;
        let shown = self.lines.len().min(room as usize);
        let at = |i: usize| 50 + LETTERS.1 * i as i32;
        for (i, line) in self.lines.iter().take(shown).enumerate() {
            let colour = Palette99::pick(i).to_rgba();
            area.draw(&PathElement::new([(0, at(i)), (18, at(i))], colour))?;
            let name = Text::new(
                line.name.clone(),
                (24, at(i) - LETTERS.0 as i32 / 2),
                font().color(&BLACK),
            );
            area.draw(&name)?;
        }
        if shown < self.lines.len() {
            let more = format!("and {} more", self.lines.len() - shown);
            area.draw(&Text::new(
                more,
                (24, at(shown) - LETTERS.0 as i32 / 2),
                font().color(&BLACK),
            ))?;
        }
        Ok(())
    }
}
