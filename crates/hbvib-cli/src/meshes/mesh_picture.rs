//! A picture of the contacts over the mesh, as SVG: nodes as points, those of contacts coloured by their slip.

use crate::outputs::node_motion::{ContactField, Places};
use std::fmt::Write;

/// Width and height.
const SIZE: (f64, f64) = (900.0, 600.0);

/// Room at the edges.
const ROOM: f64 = 30.0;

/// Most nodes that are drawn beside those of contacts.
const MOST: usize = 20_000;

/// Nodes of a small mesh, whose points are larger.
const SMALL: usize = 1000;

/// Nodes seen along the direction (1, 1, 1) of their axes; those of contacts from pale (they stick) to dark red (they slip all the
/// time), and blue where they are open all the time.
pub fn svg(places: &Places, field: &ContactField) -> String {
    let flat: Vec<(f64, f64)> = places.at.iter().map(|x| seen(*x)).collect();
    let (mut low, mut high) = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
    for (x, y) in &flat {
        low = (low.0.min(*x), low.1.min(*y));
        high = (high.0.max(*x), high.1.max(*y));
    }
    let spread = (high.0 - low.0, high.1 - low.1);
    let scale = ((SIZE.0 - 2.0 * ROOM) / spread.0).min((SIZE.1 - 2.0 * ROOM) / spread.1);
    let scale = if scale.is_finite() { scale } else { 1.0 };
    let at = |i: usize| {
        let (x, y) = flat[i];
        (ROOM + scale * (x - low.0), SIZE.1 - ROOM - scale * (y - low.1))
    };
    let mut text = format!(
        "<svg width=\"{}\" height=\"{}\" xmlns=\"http://www.w3.org/2000/svg\">\n<g fill=\"#bbb\">\n",
        SIZE.0, SIZE.1
    );
    let size = if flat.len() < SMALL { 2 } else { 1 };
    let step = flat.len().div_ceil(MOST).max(1);
    for i in (0..flat.len()).step_by(step) {
        let (x, y) = at(i);
        let _ = writeln!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{size}\"/>");
    }
    text += "</g>\n";
    for (i, place) in field.places.iter().enumerate() {
        let (x, y) = at(*place);
        let (slip, open) = (field.slip_share[i], field.open_share[i]);
        let light = 85.0 - 55.0 * slip.max(open);
        let hue = if open > slip { 220 } else { 5 };
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" stroke=\"black\" stroke-width=\"0.5\" fill=\"hsl({hue}, 85%, {light:.0}%)\">\
             <title>node {}: slip {slip:.2}, open {open:.2}</title></circle>",
            places.numbers[*place]
        );
    }
    text + "</svg>\n"
}

/// A position in the plane of the picture: isometric, z upwards.
fn seen([x, y, z]: [f64; 3]) -> (f64, f64) {
    let (cos, sin) = (30.0_f64.to_radians().cos(), 30.0_f64.to_radians().sin());
    ((y - x) * cos, z - (x + y) * sin)
}
