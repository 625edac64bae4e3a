//! One canvas of `plotters` for figures as text (SVG) and as pixels (PNG).

use plotters::prelude::{BitMapBackend, SVGBackend};
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind};
use std::error::Error;
use std::fmt;

/// A figure that is drawn.
pub enum Canvas<'a> {
    Vectors(SVGBackend<'a>),
    Pixels(BitMapBackend<'a>),
}

/// The sentence of an error of either kind.
#[derive(Debug)]
pub struct CanvasError(String);

impl fmt::Display for CanvasError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Error for CanvasError {}

type Drawn<T> = Result<T, DrawingErrorKind<CanvasError>>;

/// Converts the error of one kind to that of both.
fn converted<T, E: Error + Send + Sync>(result: Result<T, DrawingErrorKind<E>>) -> Drawn<T> {
    result.map_err(|e| match e {
        DrawingErrorKind::DrawingError(e) => DrawingErrorKind::DrawingError(CanvasError(e.to_string())),
        DrawingErrorKind::FontError(e) => DrawingErrorKind::FontError(e),
    })
}

/// Calls the canvas of either kind.
macro_rules! either {
    ($canvas:expr, $name:ident $(, $argument:expr)*) => {
        match $canvas {
            Canvas::Vectors(canvas) => converted(canvas.$name($($argument),*)),
            Canvas::Pixels(canvas) => converted(canvas.$name($($argument),*)),
        }
    };
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = CanvasError;

    fn get_size(&self) -> (u32, u32) {
        match self {
            Self::Vectors(canvas) => canvas.get_size(),
            Self::Pixels(canvas) => canvas.get_size(),
        }
    }

    fn ensure_prepared(&mut self) -> Drawn<()> {
        either!(self, ensure_prepared)
    }

    fn present(&mut self) -> Drawn<()> {
        either!(self, present)
    }

    fn draw_pixel(&mut self, at: BackendCoord, colour: BackendColor) -> Drawn<()> {
        either!(self, draw_pixel, at, colour)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn<()> {
        either!(self, draw_line, from, to, style)
    }

    fn draw_rect<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S, fill: bool) -> Drawn<()> {
        either!(self, draw_rect, from, to, style, fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn<()> {
        either!(self, draw_path, path, style)
    }

    fn draw_circle<S: BackendStyle>(&mut self, centre: BackendCoord, radius: u32, style: &S, fill: bool) -> Drawn<()> {
        either!(self, draw_circle, centre, radius, style, fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn<()> {
        either!(self, fill_polygon, corners, style)
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn<()> {
        either!(self, draw_text, text, style, at)
    }

    fn estimate_text_size<S: BackendTextStyle>(&self, text: &str, style: &S) -> Drawn<(u32, u32)> {
        either!(self, estimate_text_size, text, style)
    }
}
