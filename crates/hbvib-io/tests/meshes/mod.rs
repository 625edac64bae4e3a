//! Meshes of squares and blocks for the tests of contacts.

#![allow(dead_code, reason = "each test uses some of it")]

use hbvib_io::Surface;
use std::collections::HashMap;

pub type Mesh = HashMap<i64, [f64; 3]>;

pub fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

pub fn surface(faces: &[Vec<i64>], mesh: &Mesh) -> Surface {
    Surface::new(faces, &|node| mesh.get(&node).copied()).unwrap()
}

/// Numbers between −1 and 1 without a pattern.
pub fn noise(k: usize) -> f64 {
    ((k as f64 + 1.0) * 12.9898).sin().mul_add(43_758.545_3, 0.0).fract()
}

/// How a square is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Triangles,
    Quadrilaterals,
    SixNodes,
    EightNodes,
}

/// A turned and moved unit square, `lift` off its plane, divided by n × n with corners inside that are moved. Nodes from `first` on; the faces
/// are outward against the normal if `down`.
pub fn square(kind: Kind, n: usize, lift: f64, first: i64, down: bool) -> (Vec<Vec<i64>>, Mesh) {
    let quadratic = matches!(kind, Kind::SixNodes | Kind::EightNodes);
    let mut mesh = Mesh::new();
    let flat = |x: f64, y: f64| {
        // Axes of a turned frame.
        let (a, b, c) = ([0.6, 0.8, 0.0], [-0.48, 0.36, 0.8], [0.64, -0.48, 0.6]);
        [0, 1, 2].map(|d| 0.3 + x * a[d] + y * b[d] + lift * c[d])
    };
    let corner = |i: usize, j: usize| {
        let inner = |k: usize| k > 0 && k < n;
        let moved = |k| if inner(i) && inner(j) { 0.2 * noise(k) } else { 0.0 };
        let x = (i as f64 + moved(7 * i + j)) / n as f64;
        let y = (j as f64 + moved(5 * j + 3 * i)) / n as f64;
        (x, y)
    };
    let mut numbers: HashMap<(usize, usize, usize, usize), i64> = HashMap::new();
    // The node between two corners, or a corner itself.
    let mut node = |a: (usize, usize), b: (usize, usize)| {
        let key = if a <= b {
            (a.0, a.1, b.0, b.1)
        } else {
            (b.0, b.1, a.0, a.1)
        };
        let count = numbers.len() as i64;
        *numbers.entry(key).or_insert_with(|| {
            let (p, q) = (corner(a.0, a.1), corner(b.0, b.1));
            let number = first + count;
            mesh.insert(number, flat(f64::midpoint(p.0, q.0), f64::midpoint(p.1, q.1)));
            number
        })
    };
    let mut faces = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let outlines = if matches!(kind, Kind::Triangles | Kind::SixNodes) {
                vec![vec![a, b, c], vec![a, c, d]]
            } else {
                vec![vec![a, b, c, d]]
            };
            for mut outline in outlines {
                if down {
                    outline.reverse();
                }
                let mut face: Vec<i64> = outline.iter().map(|p| node(*p, *p)).collect();
                if quadratic {
                    for k in 0..outline.len() {
                        face.push(node(outline[k], outline[(k + 1) % outline.len()]));
                    }
                }
                faces.push(face);
            }
        }
    }
    (faces, mesh)
}

/// A block of n × n × 1 bricks from z = `bottom` to `top` over the unit square, its corners inside moved.
pub fn block(n: usize, [bottom, top]: [f64; 2], first: i64) -> (Vec<Vec<i64>>, Mesh) {
    let mut mesh = Mesh::new();
    let number = |i: usize, j: usize, k: usize| first + (i + (n + 1) * (j + (n + 1) * k)) as i64;
    for i in 0..=n {
        for j in 0..=n {
            let inner = i > 0 && i < n && j > 0 && j < n;
            let moved = |k| if inner { 0.2 * noise(k) } else { 0.0 };
            for (k, z) in [bottom, top].into_iter().enumerate() {
                let x = (i as f64 + moved(3 * i + 11 * j + n)) / n as f64;
                let y = (j as f64 + moved(8 * i + j + n)) / n as f64;
                mesh.insert(number(i, j, k), [x, y, z]);
            }
        }
    }
    let mut elements = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let layer = |k| {
                [
                    number(i, j, k),
                    number(i + 1, j, k),
                    number(i + 1, j + 1, k),
                    number(i, j + 1, k),
                ]
            };
            elements.push([layer(0), layer(1)].concat());
        }
    }
    (elements, mesh)
}
