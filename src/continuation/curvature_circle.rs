//! The parameter by which a branch is predicted: the arc on its circle of curvature.
//!
//! With x and y the coordinates of a point along the tangent and the normal of the branch at its newest point, and the
//! curvature κ, the angle at the centre of the circle over κ is
//!
//! > φ = atan2(κx, 1 − κy)/κ,  dφ = ((1 − κy) dx + κx dy)/((κx)² + (1 − κy)²).
//!
//! On a circle this is the arc length. Elsewhere it differs from that, but derivatives by φ are known exactly: those by an
//! arc length that is approximated would limit the order of a prediction from many points. A resonance is nearly a circle, on
//! which predictions by the place along the tangent would be poor.

use crate::continuation::{Metric, Point};

/// Angle between two tangents, over 1 the difference of its cosine from 1, below which the branch is straight.
/// Kind: rounding.
const CURVATURE_CIRCLE_STRAIGHT: f64 = 1e-14;

/// Angle coordinate φ of a point; and the factor that turns its tangent into the derivative by φ.
pub(super) type Place = (f64, f64);

/// Circle through the newest point with its tangent and, approximately, through the point before.
#[derive(Clone, Copy)]
pub(super) struct CurvatureCircle {
    /// Factor that normalises the tangent of the newest point.
    unit: f64,
    metric: Metric,
    bend: Option<Bend>,
}

/// Plane of the circle, spanned by the tangents of the newest point and of the point before.
#[derive(Clone, Copy)]
struct Bend {
    /// Factor that normalises the tangent of the point before.
    unit: f64,
    /// Cosine of the angle between the tangents, and curvature κ.
    cosine: f64,
    curvature: f64,
    /// Radius 1/κ, and κ over the sine of the angle between the tangents.
    radius: f64,
    across: f64,
}

impl CurvatureCircle {
    /// The circle at `here`; a straight line where there is no point before.
    pub fn new(here: &Point, before: Option<&Point>, metric: Metric) -> Self {
        let mut circle = Self {
            unit: 1.0 / metric.norm(&here.tangent),
            metric,
            bend: None,
        };
        if let Some(before) = before {
            let unit = 1.0 / metric.norm(&before.tangent);
            let cosine = metric.dot(&here.tangent, &before.tangent) * circle.unit * unit;
            let chord = metric.distance(&here.v, &before.v);
            if cosine > 0.0 && 1.0 - cosine > CURVATURE_CIRCLE_STRAIGHT && chord > 0.0 {
                // Twice the sine of half the angle.
                let curvature = (2.0 * (1.0 - cosine)).sqrt() / chord;
                circle.bend = Some(Bend {
                    unit,
                    cosine,
                    curvature,
                    radius: 1.0 / curvature,
                    across: curvature / (1.0 - cosine * cosine).sqrt(),
                });
            }
        }
        circle
    }

    /// Coordinate of a point on this circle, which was made from the points `here` and `before`; `None` where φ does
    /// not grow along it.
    pub fn place(&self, (here, before): (&Point, Option<&Point>), point: &Point) -> Option<Place> {
        let own = &here.tangent[..];
        let other = before.map_or(own, |before| &before.tangent);
        let to = (&point.v[..], &point.tangent[..]);
        let [along, beside] = self.metric.products(&here.v, to, [own, other]);
        let [x, dx] = along.map(|z| z * self.unit);
        let Some(bend) = &self.bend else {
            return (dx > 0.0).then(|| (x, 1.0 / dx));
        };
        let curvature = bend.curvature;
        let across = |x: f64, z: f64| (bend.cosine * x - z * bend.unit) * bend.across;
        let (y, dy) = (across(x, beside[0]), across(dx, beside[1]));
        let (x, dx, inward) = (curvature * x, curvature * dx, 1.0 - y);
        let scale = curvature * (x * x + inward * inward) / (inward * dx + x * dy);
        (scale > 0.0).then(|| (x.atan2(inward) * bend.radius, scale))
    }
}
