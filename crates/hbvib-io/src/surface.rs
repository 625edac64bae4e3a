//! Surfaces of meshes: faces of three, four, six or eight nodes, their areas and normals.

use crate::face_shapes::{corners, face_points, middle, shapes};
use crate::vectors::{Vector, cross, length, minus, plus, unit};
use std::collections::HashMap;

/// Faces of one side of a contact.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Numbers of the nodes, ascending.
    pub nodes: Vec<i64>,
    /// Position of each node.
    pub positions: Vec<[f64; 3]>,
    /// Nodes of each face by their places in `nodes`: corners in order, then those between them.
    pub faces: Vec<Vec<u32>>,
}

/// Areas that stand for nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodalAreas {
    /// Integrals of the shape functions, so that a uniform pressure is exact. They vanish at the corners of triangles with six nodes and are
    /// negative at those of quadrilaterals with eight.
    Consistent,
    /// Positive shares of each face, as a diagonal mass has them (Hinton, Rock & Zienkiewicz 1976,
    /// doi:10.1002/eqe.4290040305): for quadrilaterals with eight nodes.
    Positive,
}

impl Surface {
    /// A surface from the numbers of the nodes of its faces.
    ///
    /// # Errors
    /// A sentence: no face, a face with other numbers of nodes, a node without position, a face without area.
    pub fn new(faces: &[Vec<i64>], position: &dyn Fn(i64) -> Option<[f64; 3]>) -> Result<Self, String> {
        let mut nodes: Vec<i64> = faces.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        if nodes.is_empty() {
            return Err("the surface has no face".into());
        }
        let at = |node: &i64| {
            let found = position(*node).filter(|x| x.iter().all(|x| x.is_finite()));
            found.ok_or_else(|| format!("node {node} has no position"))
        };
        let positions = nodes.iter().map(at).collect::<Result<Vec<_>, _>>()?;
        let places: HashMap<i64, u32> = nodes.iter().zip(0..).map(|(node, place)| (*node, place)).collect();
        let faces: Vec<Vec<u32>> = faces
            .iter()
            .map(|face| face.iter().map(|node| places[node]).collect())
            .collect();
        let all = Self {
            nodes,
            positions,
            faces,
        };
        for (f, face) in all.faces.iter().enumerate() {
            if !matches!(face.len(), 3 | 4 | 6 | 8) {
                return Err(format!("face {f} has {} nodes, needs 3, 4, 6 or 8", face.len()));
            }
            if length(all.normal_at(f, middle(face.len()))) == 0.0 {
                return Err(format!(
                    "face {f}, of node {}, has no area",
                    all.nodes[face[0] as usize]
                ));
            }
        }
        Ok(all)
    }

    /// Position of a point of a face.
    pub(crate) fn point(&self, face: usize, local: [f64; 2]) -> Vector {
        let nodes = &self.faces[face];
        let shapes = shapes(nodes.len(), local);
        let all = shapes.iter().zip(nodes);
        all.fold([0.0; 3], |sum, ((n, _), node)| {
            plus(sum, *n, self.positions[*node as usize])
        })
    }

    /// Derivatives of the position by both coordinates of a face.
    pub(crate) fn tangents(&self, face: usize, local: [f64; 2]) -> [Vector; 2] {
        let nodes = &self.faces[face];
        let mut both = [[0.0; 3]; 2];
        for ((_, slope), node) in shapes(nodes.len(), local).into_iter().zip(nodes) {
            for (tangent, slope) in both.iter_mut().zip(slope) {
                *tangent = plus(*tangent, slope, self.positions[*node as usize]);
            }
        }
        both
    }

    /// Normal of a face at a point, as long as the area of a unit of its coordinates.
    pub(crate) fn normal_at(&self, face: usize, local: [f64; 2]) -> Vector {
        let [a, b] = self.tangents(face, local);
        cross(a, b)
    }

    /// Whether the map from coordinates to positions is linear: triangles and parallelograms with straight sides.
    pub(crate) fn is_affine(&self, face: usize) -> bool {
        let nodes = self.faces[face].len();
        let size = self.size(face);
        let [a, b] = self.tangents(face, middle(nodes));
        let ends = if corners(nodes) == 3 {
            [[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]]
        } else {
            [[1.0, 1.0], [-1.0, 1.0], [1.0, 0.0]]
        };
        ends.into_iter().all(|end| {
            let same = self.tangents(face, end);
            length(minus(same[0], a)) + length(minus(same[1], b)) <= 1e-12 * size
        })
    }

    /// Length of the diagonal of the box around a face.
    pub(crate) fn size(&self, face: usize) -> f64 {
        let [low, high] = self.bounds(face);
        length(minus(high, low))
    }

    /// Corners of the box around a face.
    pub(crate) fn bounds(&self, face: usize) -> [Vector; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for node in &self.faces[face] {
            let x = self.positions[*node as usize];
            for d in 0..3 {
                bounds[0][d] = bounds[0][d].min(x[d]);
                bounds[1][d] = bounds[1][d].max(x[d]);
            }
        }
        bounds
    }

    /// Area of each node, in the order of `nodes`.
    #[must_use]
    pub fn nodal_areas(&self, kind: NodalAreas) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        for (f, face) in self.faces.iter().enumerate() {
            let (mut own, mut area) = (vec![0.0; face.len()], 0.0);
            for (local, weight) in face_points(face.len()) {
                let weight = weight * length(self.normal_at(f, local));
                area += weight;
                for (own, (n, _)) in own.iter_mut().zip(shapes(face.len(), local)) {
                    *own += weight * if kind == NodalAreas::Consistent { n } else { n * n };
                }
            }
            let sum: f64 = own.iter().sum();
            for (own, node) in own.iter().zip(face) {
                areas[*node as usize] += own * area / sum;
            }
        }
        areas
    }

    /// Normal of each node, of length 1: the mean of its faces by their areas.
    #[must_use]
    pub fn nodal_normals(&self) -> Vec<[f64; 3]> {
        let mut normals = vec![[0.0; 3]; self.nodes.len()];
        for (f, face) in self.faces.iter().enumerate() {
            for (local, weight) in face_points(face.len()) {
                let normal = self.normal_at(f, local);
                for ((n, _), node) in shapes(face.len(), local).into_iter().zip(face) {
                    let normals = &mut normals[*node as usize];
                    *normals = plus(*normals, weight * n.abs(), normal);
                }
            }
        }
        normals.into_iter().map(unit).collect()
    }
}
