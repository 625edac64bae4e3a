//! Parts that two faces have in common, seen along the normal of the first, as points of quadrature.

use crate::face_shapes::{Local, corners, middle, shapes, triangle_points};
use crate::surface::Surface;
use crate::vectors::{Vector, dot, minus, perpendicular, unit};

/// A point that faces of both sides have in common.
pub(crate) struct Common {
    /// Coordinates in the face of the first side.
    pub own: Local,
    /// Coordinates in the face of the second side.
    pub other: Local,
    /// Area on the first side.
    pub area: f64,
    /// Distance from the first to the second, along the normal.
    pub gap: f64,
}

/// Cosine of the angle between normals up to which faces may touch.
const LEAST_COSINE: f64 = 0.2;

/// Steps of the search for coordinates.
const STEPS: usize = 30;

/// Share of the area of a face up to which a part is rounding.
const SLIVER: f64 = 1e-12;

type Point = [f64; 2];

/// A plane through the middle of a face.
struct Plane {
    origin: Vector,
    normal: Vector,
    axes: [Vector; 2],
}

impl Plane {
    fn of(surface: &Surface, face: usize) -> Self {
        let local = middle(surface.faces[face].len());
        let normal = unit(surface.normal_at(face, local));
        let (first, second) = perpendicular(normal);
        Self {
            origin: surface.point(face, local),
            normal,
            axes: [first, second],
        }
    }

    fn flat(&self, x: Vector) -> Point {
        let from = minus(x, self.origin);
        self.axes.map(|axis| dot(axis, from))
    }

    /// Coordinates in a face of a point of the plane, by Newton's method.
    fn local(&self, surface: &Surface, face: usize, point: Point) -> Option<Local> {
        let nodes = &surface.faces[face];
        let mut local = middle(nodes.len());
        let flat: Vec<Point> = nodes
            .iter()
            .map(|node| self.flat(surface.positions[*node as usize]))
            .collect();
        for _ in 0..STEPS {
            let (mut away, mut slopes) = (point, [[0.0; 2]; 2]);
            for ((n, slope), x) in shapes(nodes.len(), local).into_iter().zip(&flat) {
                for d in 0..2 {
                    away[d] -= n * x[d];
                    slopes[d][0] += slope[0] * x[d];
                    slopes[d][1] += slope[1] * x[d];
                }
            }
            let [[a, b], [c, d]] = slopes;
            let determinant = a * d - b * c;
            if determinant == 0.0 {
                return None;
            }
            let step = [
                (d * away[0] - b * away[1]) / determinant,
                (a * away[1] - c * away[0]) / determinant,
            ];
            local = [local[0] + step[0], local[1] + step[1]];
            if step[0].abs().max(step[1].abs()) < 1e-14 {
                break;
            }
        }
        local.iter().all(|x| x.is_finite()).then_some(local)
    }
}

/// Points of the part that two faces have in common. It is seen in a plane between straight sides from corner to corner; areas
/// and coordinates are those of the faces themselves.
pub(crate) fn common((own, face): (&Surface, usize), (other, other_face): (&Surface, usize), most: f64) -> Vec<Common> {
    let plane = Plane::of(own, face);
    let opposite = unit(other.normal_at(other_face, middle(other.faces[other_face].len())));
    if dot(plane.normal, opposite).abs() < LEAST_COSINE {
        return Vec::new();
    }
    let outline = |surface: &Surface, face: usize| -> Vec<Point> {
        let nodes = &surface.faces[face];
        let corners = nodes[..corners(nodes.len())].iter();
        let mut all: Vec<Point> = corners
            .map(|node| plane.flat(surface.positions[*node as usize]))
            .collect();
        if area(&all) < 0.0 {
            all.reverse();
        }
        all
    };
    let whole = outline(own, face);
    let part = clipped(&whole, &outline(other, other_face));
    if area(&part) <= SLIVER * area(&whole) {
        return Vec::new();
    }
    // Shape functions of quadrilaterals are no polynomials in the plane, unless their sides are parallel.
    let fine = [(own, face), (other, other_face)]
        .into_iter()
        .any(|(surface, face)| !surface.is_affine(face));
    let mut all = Vec::new();
    for k in 1..part.len().saturating_sub(1) {
        let (a, b, c) = (part[0], part[k], part[k + 1]);
        let size = 2.0 * area(&[a, b, c]);
        for ([u, v], weight) in triangle_points(fine) {
            let at = [0, 1].map(|d| a[d] + u * (b[d] - a[d]) + v * (c[d] - a[d]));
            let (Some(x), Some(y)) = (plane.local(own, face, at), plane.local(other, other_face, at)) else {
                continue;
            };
            let gap = dot(plane.normal, minus(other.point(other_face, y), own.point(face, x)));
            // The face may be inclined against the plane.
            let cosine = dot(plane.normal, unit(own.normal_at(face, x))).abs().max(LEAST_COSINE);
            if gap.abs() <= most {
                all.push(Common {
                    own: x,
                    other: y,
                    area: weight * size / cosine,
                    gap,
                });
            }
        }
    }
    all
}

/// Area of a polygon, positive where its corners go round to the left.
fn area(polygon: &[Point]) -> f64 {
    let next = |k: usize| polygon[(k + 1) % polygon.len()];
    let twice: f64 = (0..polygon.len())
        .map(|k| polygon[k][0] * next(k)[1] - polygon[k][1] * next(k)[0])
        .sum();
    twice / 2.0
}

/// The part of a polygon within a convex one, both to the left (Sutherland & Hodgman 1974, doi:10.1145/360767.360802).
fn clipped(polygon: &[Point], window: &[Point]) -> Vec<Point> {
    let mut all = polygon.to_vec();
    for k in 0..window.len() {
        let (from, to) = (window[k], window[(k + 1) % window.len()]);
        let side = |x: Point| (to[0] - from[0]) * (x[1] - from[1]) - (to[1] - from[1]) * (x[0] - from[0]);
        let mut inside = Vec::new();
        for k in 0..all.len() {
            let (a, b) = (all[k], all[(k + 1) % all.len()]);
            let (sa, sb) = (side(a), side(b));
            if sa >= 0.0 {
                inside.push(a);
            }
            if (sa > 0.0 && sb < 0.0) || (sa < 0.0 && sb > 0.0) {
                let share = sa / (sa - sb);
                inside.push([0, 1].map(|d| a[d] + share * (b[d] - a[d])));
            }
        }
        all = inside;
    }
    all
}
