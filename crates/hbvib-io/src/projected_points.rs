//! Points on a surface: the nearest face of each, and the weights of its nodes there.

use crate::face_search::FaceSearch;
use crate::face_shapes::shapes;
use crate::surface::Surface;

/// Weights up to this are rounding.
const ROUNDING: f64 = 1e-13;

/// The nearest point of a surface.
#[derive(Clone, Debug)]
pub struct ProjectedPoint {
    /// Nodes of its face and the values of their shape functions there, whose sum is 1.
    pub weights: Vec<(i64, f64)>,
    /// Distance to it.
    pub distance: f64,
}

/// The nearest point of a surface for each point; `None` where none lies within a distance.
#[must_use]
pub fn projected_points(points: &[[f64; 3]], surface: &Surface, largest_distance: f64) -> Vec<Option<ProjectedPoint>> {
    let search = FaceSearch::new(surface, largest_distance);
    let of = |x: &[f64; 3]| {
        let near = search.nearest(*x).filter(|near| near.distance <= largest_distance)?;
        let nodes = &surface.faces[near.face];
        let values = shapes(nodes.len(), near.local).into_iter().zip(nodes);
        let weights = values
            .filter(|((value, _), _)| value.abs() > ROUNDING)
            .map(|((value, _), node)| (surface.nodes[*node as usize], value));
        Some(ProjectedPoint {
            weights: weights.collect(),
            distance: near.distance,
        })
    };
    points.iter().map(of).collect()
}
