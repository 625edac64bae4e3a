//! Contacts between surfaces whose meshes do not match: for each node of the first side the relative motion, its own less a weighted sum of
//! motions of the second side.
//!
//! Weights are those of the mortar method: for each node i the motion of the other side is averaged so that forces of a uniform pressure are
//! exact on both sides, and motions that are linear in space are followed exactly on flat faces (Wohlmuth 2000,
//! doi:10.1137/S0036142999350929, for the averages of linear faces; those of quadratic faces are the full projection).

use crate::face_overlap::common;
use crate::face_search::FaceSearch;
use crate::face_shapes::{is_quadratic, shapes};
use crate::surface::{NodalAreas, Surface};
use crate::vectors::{Vector, dot, minus};
use std::collections::HashMap;

/// A contact at a node of the first side.
#[derive(Clone, Debug)]
pub struct SurfaceContact {
    /// The node.
    pub node: i64,
    /// Its position.
    pub position: [f64; 3],
    /// Nodes of the other side and their weights, whose sum is 1: the relative motion is that of the node less their weighted sum.
    pub others: Vec<(i64, f64)>,
    /// Area of the contact.
    pub area: f64,
    /// Distance to the other side along the normal; below zero where they overlap.
    pub gap: f64,
    /// Normal of the first side, of length 1, towards the second where faces are listed outward.
    pub normal: [f64; 3],
}

/// Largest number of nodes of quadratic faces, whose weights need a full matrix.
const MOST: usize = 4000;

/// Weights up to this are rounding.
const ROUNDING: f64 = 1e-13;

/// Share of the largest area up to which a node has none.
const NO_AREA: f64 = 1e-9;

/// Contacts of the nodes of a surface with another one, up to a distance. Nodes that touch nothing, or have no area, have none.
///
/// Areas that are integrals of shape functions are negative at corners of faces with eight nodes, which is refused; `NodalAreas::Positive` has
/// others.
///
/// # Errors
/// A sentence: no common part, negative areas, too many nodes of quadratic faces.
pub fn surface_contacts(
    own: &Surface,
    other: &Surface,
    largest_distance: f64,
    areas: NodalAreas,
) -> Result<Vec<SurfaceContact>, String> {
    let parts = Parts::of(own, other, largest_distance);
    let used: Vec<usize> = (0..own.nodes.len()).filter(|i| parts.used[*i]).collect();
    if used.is_empty() {
        return Err(format!(
            "no faces of both sides face each other within {largest_distance}"
        ));
    }
    let weights = if own.faces.iter().any(|face| is_quadratic(face.len())) {
        parts.full(&used)?
    } else {
        parts.local_weights()
    };
    let normals = own.nodal_normals();
    let given = match areas {
        NodalAreas::Consistent => parts.areas.clone(),
        NodalAreas::Positive => own.nodal_areas(areas),
    };
    let largest = given.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
    let mut all = Vec::new();
    for i in used {
        let area = given[i];
        if area < -NO_AREA * largest {
            return Err(format!(
                "node {} has the area {area:.3e}: integrals over faces with eight nodes are negative at corners; needs positive areas",
                own.nodes[i]
            ));
        }
        if area <= NO_AREA * largest {
            continue;
        }
        let Some((row, gap)) = weights.get(&i) else { continue };
        let mut others: Vec<(i64, f64)> = row.iter().map(|(j, w)| (other.nodes[*j], *w)).collect();
        others.retain(|(_, w)| w.abs() > ROUNDING);
        others.sort_unstable_by_key(|(node, _)| *node);
        all.push(SurfaceContact {
            node: own.nodes[i],
            position: own.positions[i],
            others,
            area,
            gap: *gap,
            normal: normals[i],
        });
    }
    Ok(all)
}

/// Contacts of the nodes of a surface with their nearest points of another one, up to a distance: the weights are the shape functions there.
/// Forces of a uniform pressure are exact on the first side alone; [`surface_contacts`] has them on both.
///
/// # Errors
/// A sentence: no node near enough, negative areas.
pub fn node_contacts(
    own: &Surface,
    other: &Surface,
    largest_distance: f64,
    areas: NodalAreas,
) -> Result<Vec<SurfaceContact>, String> {
    let search = FaceSearch::new(other, largest_distance);
    let (sizes, normals) = (own.nodal_areas(areas), own.nodal_normals());
    let largest = sizes.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
    let mut all = Vec::new();
    for (i, &x) in own.positions.iter().enumerate() {
        let Some(nearest) = search.nearest(x).filter(|found| found.distance <= largest_distance) else {
            continue;
        };
        if sizes[i] < -NO_AREA * largest {
            return Err(format!(
                "node {} has the area {:.3e}, needs positive areas",
                own.nodes[i], sizes[i]
            ));
        }
        if sizes[i] <= NO_AREA * largest {
            continue;
        }
        let nodes = &other.faces[nearest.face];
        let weights = shapes(nodes.len(), nearest.local).into_iter().zip(nodes);
        let mut others: Vec<(i64, f64)> = weights.map(|((n, _), node)| (other.nodes[*node as usize], n)).collect();
        others.retain(|(_, w)| w.abs() > ROUNDING);
        others.sort_unstable_by_key(|(node, _)| *node);
        let point = other.point(nearest.face, nearest.local);
        all.push(SurfaceContact {
            node: own.nodes[i],
            position: x,
            others,
            area: sizes[i],
            gap: dot(normals[i], minus(point, x)),
            normal: normals[i],
        });
    }
    if all.is_empty() {
        return Err(format!(
            "no node of the first side is within {largest_distance} of the second"
        ));
    }
    Ok(all)
}

/// Integrals over the common parts of a face of the first side.
struct FaceParts {
    nodes: Vec<usize>,
    /// ∫ N_k N_l
    products: Vec<f64>,
    /// ∫ N_k
    areas: Vec<f64>,
    /// ∫ N_k g
    gaps: Vec<f64>,
    /// ∫ N_k M_j by j
    mixed: HashMap<usize, Vec<f64>>,
}

struct Parts {
    faces: Vec<FaceParts>,
    used: Vec<bool>,
    areas: Vec<f64>,
}

/// Weights of nodes of the other side, and the mean gap.
type Row = (Vec<(usize, f64)>, f64);

impl Parts {
    fn of(own: &Surface, other: &Surface, most: f64) -> Self {
        let search = FaceSearch::new(other, most);
        let mut parts = Self {
            faces: Vec::new(),
            used: vec![false; own.nodes.len()],
            areas: vec![0.0; own.nodes.len()],
        };
        for (f, face) in own.faces.iter().enumerate() {
            let n = face.len();
            let mut one = FaceParts {
                nodes: face.iter().map(|node| *node as usize).collect(),
                products: vec![0.0; n * n],
                areas: vec![0.0; n],
                gaps: vec![0.0; n],
                mixed: HashMap::new(),
            };
            let [low, high]: [Vector; 2] = own.bounds(f);
            for g in search.near([low, high]) {
                for point in common((own, f), (other, g), most) {
                    one.add(n, &point, &other.faces[g]);
                }
            }
            if one.areas.iter().sum::<f64>() > 0.0 {
                for (k, &node) in one.nodes.iter().enumerate() {
                    parts.used[node] = true;
                    parts.areas[node] += one.areas[k];
                }
                parts.faces.push(one);
            }
        }
        parts
    }

    /// Weights from functions on each face that are orthogonal to the shape functions of other nodes.
    fn local_weights(&self) -> HashMap<usize, Row> {
        let mut rows: HashMap<usize, (HashMap<usize, f64>, f64)> = HashMap::new();
        for face in &self.faces {
            let n = face.nodes.len();
            let columns: Vec<usize> = face.mixed.keys().copied().collect();
            // (∫ N Nᵀ)⁻¹ of the mixed integrals and of the gaps, times ∫ N_k.
            let mut right: Vec<Vec<f64>> = columns.iter().map(|j| face.mixed[j].clone()).collect();
            right.push(face.gaps.clone());
            if !solve(&mut face.products.clone(), n, &mut right) {
                continue;
            }
            for (k, node) in face.nodes.iter().enumerate() {
                let (row, gap) = rows.entry(*node).or_default();
                let share = face.areas[k] / self.areas[*node];
                for (j, column) in columns.iter().zip(&right) {
                    *row.entry(*j).or_default() += share * column[k];
                }
                *gap += share * right[columns.len()][k];
            }
        }
        let sorted = |(node, (row, gap)): (usize, (HashMap<usize, f64>, f64))| (node, (row.into_iter().collect(), gap));
        rows.into_iter().map(sorted).collect()
    }

    /// Weights from the full projection.
    fn full(&self, used: &[usize]) -> Result<HashMap<usize, Row>, String> {
        let n = used.len();
        if n > MOST {
            return Err(format!(
                "{n} nodes of quadratic faces touch, needs at most {MOST}: divide the contact, or take linear faces"
            ));
        }
        let place: HashMap<usize, usize> = used.iter().enumerate().map(|(k, node)| (*node, k)).collect();
        let mut products = vec![0.0; n * n];
        let mut columns: Vec<usize> = self.faces.iter().flat_map(|face| face.mixed.keys().copied()).collect();
        columns.sort_unstable();
        columns.dedup();
        let number: HashMap<usize, usize> = columns.iter().enumerate().map(|(k, j)| (*j, k)).collect();
        let mut right = vec![vec![0.0; n]; columns.len() + 1];
        for face in &self.faces {
            let m = face.nodes.len();
            for (k, node) in face.nodes.iter().enumerate() {
                let row = place[node];
                for (l, other) in face.nodes.iter().enumerate() {
                    products[row * n + place[other]] += face.products[k * m + l];
                }
                for (j, mixed) in &face.mixed {
                    right[number[j]][row] += mixed[k];
                }
                right[columns.len()][row] += face.gaps[k];
            }
        }
        if !solve(&mut products, n, &mut right) {
            return Err("the common parts of the faces are too small to weigh their nodes".into());
        }
        let row = |k: usize| -> Row {
            let weights = columns.iter().zip(&right).map(|(j, column)| (*j, column[k])).collect();
            (weights, right[columns.len()][k])
        };
        Ok(used.iter().enumerate().map(|(k, node)| (*node, row(k))).collect())
    }
}

impl FaceParts {
    fn add(&mut self, n: usize, point: &crate::face_overlap::Common, other: &[u32]) {
        let own: Vec<f64> = shapes(n, point.own).into_iter().map(|(value, _)| value).collect();
        for k in 0..n {
            let weighted = point.area * own[k];
            self.areas[k] += weighted;
            self.gaps[k] += weighted * point.gap;
            for (l, value) in own.iter().enumerate() {
                self.products[k * n + l] += weighted * value;
            }
        }
        for ((value, _), j) in shapes(other.len(), point.other).into_iter().zip(other) {
            let mixed = self.mixed.entry(*j as usize).or_insert_with(|| vec![0.0; n]);
            for k in 0..n {
                mixed[k] += point.area * own[k] * value;
            }
        }
    }
}

/// Solves a system by Cholesky factors for several right-hand sides; `false` where the matrix is not positive definite.
fn solve(a: &mut [f64], n: usize, right: &mut [Vec<f64>]) -> bool {
    for j in 0..n {
        let own = a[j * n + j];
        let pivot = own - (0..j).map(|k| a[j * n + k] * a[j * n + k]).sum::<f64>();
        if pivot <= own.abs() * f64::EPSILON {
            return false;
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            let sum: f64 = (0..j).map(|k| a[i * n + k] * a[j * n + k]).sum();
            a[i * n + j] = (a[i * n + j] - sum) / root;
        }
    }
    for x in right {
        for i in 0..n {
            let sum: f64 = (0..i).map(|k| a[i * n + k] * x[k]).sum();
            x[i] = (x[i] - sum) / a[i * n + i];
        }
        for i in (0..n).rev() {
            let sum: f64 = (i + 1..n).map(|k| a[k * n + i] * x[k]).sum();
            x[i] = (x[i] - sum) / a[i * n + i];
        }
    }
    true
}
