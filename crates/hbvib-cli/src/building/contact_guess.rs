//! A first guess of a contact between two sets of nodes: its normal, distance and stiffness from mesh and matrices.

use crate::building::built::Built;
use crate::meshes::mesh::Mesh;
use crate::texts::outcome::Outcome;
use hbvib::Constant;
use num_complex::Complex64;
use std::fmt::Write;

/// Largest distance of a pair over the largest one that was found.
const ROOM: f64 = 1.5;

/// Gap, relative to the size of the surface, below which the surface tells the normal.
const CLOSED: f64 = 1e-6;

/// A contact of a first job.
pub struct Guess {
    sets: [String; 2],
    normal: [f64; 3],
    distance: f64,
    stiffness: f64,
}

type Point = [f64; 3];

/// Coefficient of friction of a first job.
const MU: f64 = 0.3;

/// Stiffness of a pair over that of the mesh at a node, and that along the normal over the former. A preload is a force of bodies that
/// do not give way: stiff contacts on soft bodies lose it.
const SOFT: f64 = 0.01;
const NORMAL: f64 = 0.1;

/// Share of the largest friction force of stuck contacts at the peak that the preload holds, and the largest normal force.
const HELD: (f64, f64) = (0.8, 1.2);

/// A preload under which the contacts of a mode begin to slip, and stay closed: the mode with stuck contacts, excited at its
/// resonance by a unit force.
pub fn preload(built: &Built, shape: &[Complex64], (omega, damping, dof): (f64, f64, usize)) -> f64 {
    let amplitude = shape[dof].norm() / (2.0 * damping * omega * omega);
    let mut largest = 0.0_f64;
    for contact in built.model.contacts() {
        let side = |dofs: [Option<usize>; 3]| dofs.map(|dof| dof.map_or(Complex64::ZERO, |dof| shape[dof]));
        let (a, b) = (side(contact.dof_a), side(contact.dof_b));
        let motion = [0, 1, 2].map(|k| (a[k] - b[k]) * amplitude);
        let moved = motion.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        largest = largest
            .max((HELD.0 * contact.constant(Constant::Kt) / MU).max(HELD.1 * contact.constant(Constant::Kn)) * moved);
    }
    if largest > 0.0 { largest } else { 1.0 }
}

impl Guess {
    /// The guess for two sets of a mesh.
    ///
    /// # Errors
    /// A sentence: an unknown set.
    pub fn of(built: &Built, (a, b): (&str, &str)) -> Outcome<Self> {
        let mesh = built.nodes.mesh.as_ref().ok_or("--contact needs --mesh")?;
        let points = |set: &str| -> Outcome<Vec<Point>> {
            let numbers = mesh.set(set).filter(|set| !set.is_empty());
            let numbers =
                numbers.ok_or_else(|| format!("--contact: there is no set \"{set}\" in {}", mesh.path().display()))?;
            numbers.iter().map(|node| mesh.position(*node)).collect()
        };
        let (at_a, at_b) = (points(a)?, points(b)?);
        let mut gap = [0.0; 3];
        let mut distance = 0.0_f64;
        for x in &at_a {
            let nearest = at_b
                .iter()
                .min_by(|y, z| length(minus(*x, **y)).total_cmp(&length(minus(*x, **z))));
            let d = minus(*x, *nearest.unwrap_or(x));
            distance = distance.max(length(d));
            gap = [0, 1, 2].map(|k| gap[k] + d[k] / at_a.len() as f64);
        }
        let middle = mean(&at_a);
        let size = at_a.iter().map(|x| length(minus(*x, middle))).fold(0.0, f64::max);
        let surface = across(&at_a, middle);
        // Side a lies on the side of its own body.
        let inside = body(mesh, a).map(|body| dot(minus(body, middle), surface));
        let normal = if length(gap) > CLOSED * size {
            gap.map(|g| g / length(gap))
        } else if inside.is_some_and(|inside| inside < 0.0) {
            surface.map(|n| -n)
        } else {
            surface
        };
        let mut diagonal: Vec<f64> = Vec::new();
        for node in mesh.set(a).unwrap_or(&[]) {
            let rows = built
                .nodes
                .rows_of(*node)
                .into_iter()
                .filter_map(|row| usize::try_from(row).ok());
            diagonal.extend(
                rows.filter_map(|row| built.stiffness_diagonal.get(row))
                    .filter(|k| **k > 0.0),
            );
        }
        diagonal.sort_by(f64::total_cmp);
        Ok(Self {
            sets: [a.to_owned(), b.to_owned()],
            normal: normal.map(|n| if n.abs() < 1e-9 { 0.0 } else { n }),
            distance: (ROOM * distance).max(1e-6 * size),
            stiffness: diagonal.get(diagonal.len() / 2).map_or(1e7, |k| SOFT * k),
        })
    }

    /// The part of a job, with the force of each pair at rest.
    pub fn text(&self, preload: f64) -> String {
        let mut text = String::new();
        let ([a, b], [x, y, z]) = (&self.sets, self.normal);
        let _ = write!(
            text,
            "\n[[contact]]\nname = \"{a}\"\nkind = \"friction_3d\"\n{:<35} # from side b to side a\n\
             {:<36}# of each pair of nodes; here a hundredth of the mesh at a node: measure it\n\
             {:<36}# the smaller, the more constant is the load of each pair\nmu = {MU}\n{:<36}# force of each pair at rest: with this one some of them begin to slip\n\
             balanced = true                     # by stresses that are not in the matrices: neither side gives way\n\n\
             [contact.nodes]\na = {a:?}\nb = {b:?}\nlargest_distance = {:.3e}\n",
            format!("normal = [{x:.6}, {y:.6}, {z:.6}]"),
            format!("kt = {:.3e}", self.stiffness),
            format!("kn = {:.3e}", NORMAL * self.stiffness),
            format!("preload = {preload:.3e}"),
            self.distance
        );
        text
    }
}

/// Middle of the elements that have a node of a set.
fn body(mesh: &Mesh, set: &str) -> Option<Point> {
    let nodes: std::collections::HashSet<i64> = mesh.set(set)?.iter().copied().collect();
    let drawn = mesh.drawn();
    let elements = drawn.iter().filter(|e| e.nodes.iter().any(|node| nodes.contains(node)));
    let all: Vec<Point> = elements
        .flat_map(|e| &e.nodes)
        .filter_map(|node| mesh.position(*node).ok())
        .collect();
    (!all.is_empty()).then(|| mean(&all))
}

/// The direction in which points spread least, by inverse iteration on their second moments.
fn across(points: &[Point], middle: Point) -> Point {
    let mut m = [[0.0; 3]; 3];
    for x in points {
        let d = minus(*x, middle);
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += d[i] * d[j];
            }
        }
    }
    let scale = (m[0][0] + m[1][1] + m[2][2]).max(f64::MIN_POSITIVE);
    for (i, row) in m.iter_mut().enumerate() {
        for x in row.iter_mut() {
            *x /= scale;
        }
        row[i] += 1e-9;
    }
    // The adjugate of a symmetric matrix is its inverse up to a factor.
    let cross = |a: Point, b: Point| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let inverse = [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])];
    let mut n = [0.3, 0.5, 0.8];
    for _ in 0..50 {
        let next = [0, 1, 2].map(|i| dot(inverse[i], n));
        let size = length(next);
        if size == 0.0 {
            return n;
        }
        n = next.map(|x| x / size);
    }
    n
}

fn mean(points: &[Point]) -> Point {
    let n = points.len().max(1) as f64;
    [0, 1, 2].map(|k| points.iter().map(|x| x[k]).sum::<f64>() / n)
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(x: Point) -> f64 {
    dot(x, x).sqrt()
}

#[cfg(test)]
mod tests {
    use super::across;

    #[test]
    fn a_plane_of_points_has_its_normal() {
        let points: Vec<[f64; 3]> = (0..20)
            .map(|i| {
                let (s, t) = (f64::from(i % 5), f64::from(i / 5));
                [s + t, s - t, 2.0 * s]
            })
            .collect();
        let n = across(&points, super::mean(&points));
        // s (1, 1, 2) and t (1, -1, 0) span it.
        assert!(
            (n[0] + n[1] + 2.0 * n[2]).abs() < 1e-6 && (n[0] - n[1]).abs() < 1e-6,
            "{n:?}"
        );
    }
}
