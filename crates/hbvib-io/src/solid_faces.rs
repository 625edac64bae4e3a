//! Faces on the outside of solid elements, and the bodies that elements make up.

use std::collections::HashMap;

/// Corners of the faces of an element, outward; and pairs of corners with a node between them, in the order of these nodes.
struct Solid {
    corners: usize,
    faces: &'static [&'static [usize]],
    between: &'static [[usize; 2]],
}

const TETRAHEDRON: Solid = Solid {
    corners: 4,
    faces: &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
    between: &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
};

const WEDGE: Solid = Solid {
    corners: 6,
    faces: &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
    between: &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
};

const BRICK: Solid = Solid {
    corners: 8,
    faces: &[
        &[0, 3, 2, 1],
        &[4, 5, 6, 7],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
        &[3, 0, 4, 7],
    ],
    between: &[
        [0, 1],
        [1, 2],
        [2, 3],
        [3, 0],
        [4, 5],
        [5, 6],
        [6, 7],
        [7, 4],
        [0, 4],
        [1, 5],
        [2, 6],
        [3, 7],
    ],
};

/// Solids by their number of nodes: C3D4, C3D10, C3D6, C3D15, C3D8, C3D20 of Abaqus and CalculiX, in their order of nodes.
fn solid(nodes: usize) -> Option<&'static Solid> {
    match nodes {
        4 | 10 => Some(&TETRAHEDRON),
        6 | 15 => Some(&WEDGE),
        8 | 20 => Some(&BRICK),
        _ => None,
    }
}

/// Faces that belong to one solid element alone, outward. Elements are lists of nodes in the order of Abaqus: 4, 6 and 8, or with nodes
/// between the corners 10, 15 and 20. Others are passed over.
#[must_use]
pub fn outer_faces(elements: &[Vec<i64>]) -> Vec<Vec<i64>> {
    let mut faces: HashMap<Vec<i64>, Option<Vec<i64>>> = HashMap::new();
    let mut order = Vec::new();
    for element in elements {
        let Some(solid) = solid(element.len()) else { continue };
        for corners in solid.faces {
            let mut nodes: Vec<i64> = corners.iter().map(|c| element[*c]).collect();
            let mut key = nodes.clone();
            key.sort_unstable();
            if element.len() > solid.corners {
                for (k, a) in corners.iter().enumerate() {
                    let b = corners[(k + 1) % corners.len()];
                    let at = solid
                        .between
                        .iter()
                        .position(|pair| *pair == [*a, b] || *pair == [b, *a]);
                    nodes.extend(at.map(|at| element[solid.corners + at]));
                }
            }
            faces
                .entry(key.clone())
                .and_modify(|face| *face = None)
                .or_insert_with(|| {
                    order.push(key);
                    Some(nodes)
                });
        }
    }
    order.iter().filter_map(|key| faces.remove(key).flatten()).collect()
}

/// Faces all of whose nodes are among those of a set.
#[must_use]
pub fn faces_of_set(faces: &[Vec<i64>], set: &[i64]) -> Vec<Vec<i64>> {
    let mut sorted = set.to_vec();
    sorted.sort_unstable();
    let within = |face: &&Vec<i64>| face.iter().all(|node| sorted.binary_search(node).is_ok());
    faces.iter().filter(within).cloned().collect()
}

/// Number of the body, from 0, of each node: bodies are sets of elements that share nodes.
#[must_use]
pub fn bodies(elements: &[Vec<i64>]) -> HashMap<i64, usize> {
    // Each node leads to another one of its body, the last one to itself.
    let mut next: HashMap<i64, i64> = HashMap::new();
    for element in elements {
        let Some(first) = element.first() else { continue };
        for node in element {
            let (a, b) = (root(&mut next, *first), root(&mut next, *node));
            next.insert(a.max(b), a.min(b));
        }
    }
    let mut nodes: Vec<i64> = next.keys().copied().collect();
    nodes.sort_unstable();
    let mut numbers: HashMap<i64, usize> = HashMap::new();
    let mut all = HashMap::new();
    for node in nodes {
        let root = root(&mut next, node);
        let count = numbers.len();
        all.insert(node, *numbers.entry(root).or_insert(count));
    }
    all
}

/// The last of the nodes that a node leads to.
fn root(next: &mut HashMap<i64, i64>, mut node: i64) -> i64 {
    loop {
        let to = *next.entry(node).or_insert(node);
        if to == node {
            return node;
        }
        // Paths are halved on the way.
        let beyond = next.get(&to).copied().unwrap_or(to);
        next.insert(node, beyond);
        node = beyond;
    }
}
