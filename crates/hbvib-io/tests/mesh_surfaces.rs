//! Surfaces of meshes: areas of nodes, faces on the outside, bodies, and nearest points of curved faces.

mod meshes;

use hbvib_io::{NodalAreas, Surface, bodies, faces_of_set, node_contacts, outer_faces};
use meshes::{Mesh, block, near, surface};
use std::f64::consts::FRAC_PI_2;

#[test]
fn areas_of_faces_are_integrals_of_shape_functions() {
    let plane = |x: f64, y: f64| [x, y, 0.5];
    let mesh: Mesh = [
        (1, plane(0.0, 0.0)),
        (2, plane(3.0, 0.0)),
        (3, plane(3.0, 2.0)),
        (4, plane(0.0, 2.0)),
        (5, plane(1.5, 0.0)),
        (6, plane(3.0, 1.0)),
        (7, plane(1.5, 2.0)),
        (8, plane(0.0, 1.0)),
        (9, plane(1.5, 1.0)),
    ]
    .into();
    let areas = |face: &[i64], kind| surface(&[face.to_vec()], &mesh).nodal_areas(kind);
    let same = |found: Vec<f64>, expected: &[f64]| {
        assert!(
            found.iter().zip(expected).all(|(a, b)| near(*a, *b, 1e-14)),
            "{found:?} {expected:?}"
        );
    };
    same(areas(&[1, 2, 3], NodalAreas::Consistent), &[1.0; 3]);
    same(areas(&[1, 2, 3, 4], NodalAreas::Consistent), &[1.5; 4]);
    same(
        areas(&[1, 2, 3, 5, 6, 9], NodalAreas::Consistent),
        &[0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
    );
    let eight = [-0.5, -0.5, -0.5, -0.5, 2.0, 2.0, 2.0, 2.0];
    same(areas(&[1, 2, 3, 4, 5, 6, 7, 8], NodalAreas::Consistent), &eight);
    // The diagonal of a mass matrix: 3 at corners to 16 between them, of 76.
    let shares = [3.0, 3.0, 3.0, 3.0, 16.0, 16.0, 16.0, 16.0].map(|share| 6.0 * share / 76.0);
    same(areas(&[1, 2, 3, 4, 5, 6, 7, 8], NodalAreas::Positive), &shares);
    assert!(
        Surface::new(&[vec![1, 2]], &|n| mesh.get(&n).copied())
            .unwrap_err()
            .contains("2 nodes")
    );
    assert!(
        Surface::new(&[vec![1, 2, 77]], &|n| mesh.get(&n).copied())
            .unwrap_err()
            .contains("node 77")
    );
    assert!(
        Surface::new(&[vec![1, 5, 2]], &|n| mesh.get(&n).copied())
            .unwrap_err()
            .contains("no area")
    );
}

/// Nearest points on a quarter of a cylinder of radius 2 from nodes outside it.
#[test]
fn nodes_are_projected_onto_curved_faces() {
    let at = |r: f64, turn: f64, z: f64| [r * (turn * FRAC_PI_2).cos(), r * (turn * FRAC_PI_2).sin(), z];
    let n = 8;
    let mut mesh = Mesh::new();
    let mut faces = Vec::new();
    for k in 0..=2 * n {
        for (j, z) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            mesh.insert((100 * k + j) as i64, at(2.0, k as f64 / (2 * n) as f64, z));
        }
    }
    for k in 0..n {
        let node = |k: usize, j: usize| (100 * k + j) as i64;
        let (a, m, b) = (2 * k, 2 * k + 1, 2 * k + 2);
        faces.push(vec![
            node(a, 0),
            node(b, 0),
            node(b, 2),
            node(a, 2),
            node(m, 0),
            node(b, 1),
            node(m, 2),
            node(a, 1),
        ]);
    }
    for (k, turn) in [0.21, 0.44, 0.77].into_iter().enumerate() {
        for (j, z) in [0.3, 0.6].into_iter().enumerate() {
            mesh.insert((10_000 + 10 * k + j) as i64, at(2.1, turn, z));
        }
    }
    let own = surface(
        &[
            vec![10_000, 10_010, 10_011, 10_001],
            vec![10_010, 10_020, 10_021, 10_011],
        ],
        &mesh,
    );
    let contacts = node_contacts(&own, &surface(&faces, &mesh), 0.15, NodalAreas::Positive).unwrap();
    assert_eq!(contacts.len(), 6);
    for contact in contacts {
        let mut point = [0.0; 3];
        for (node, weight) in &contact.others {
            for d in 0..3 {
                point[d] += weight * mesh[node][d];
            }
        }
        // Quadratic faces are within 1e-6 of the cylinder, and the nearest point lies on the same radius.
        let expected = contact.position.map(|x| x * 2.0 / 2.1);
        assert!(
            near(point[0], expected[0], 1e-5)
                && near(point[1], expected[1], 1e-5)
                && near(point[2], contact.position[2], 1e-9)
        );
        assert!(near(contact.others.iter().map(|(_, w)| w).sum(), 1.0, 1e-12));
    }
}

#[test]
fn faces_on_the_outside_of_solids_point_outward() {
    let (mut elements, mesh) = block(2, [0.0, 1.0], 1);
    let (others, other_mesh) = block(1, [1.0, 2.0], 500);
    let faces = outer_faces(&elements);
    assert_eq!(faces.len(), 4 + 4 + 8);
    let total: f64 = surface(&faces, &mesh).nodal_areas(NodalAreas::Consistent).iter().sum();
    assert!(near(total, 6.0, 1e-12));
    let centre = [0.5, 0.5, 0.5];
    let side = surface(&faces, &mesh);
    for (x, normal) in side.positions.iter().zip(side.nodal_normals()) {
        let outward: f64 = (0..3).map(|d| (x[d] - centre[d]) * normal[d]).sum();
        assert!(outward > 0.4, "{x:?} {normal:?}");
    }
    let top: Vec<i64> = mesh.iter().filter(|(_, x)| x[2] > 0.9).map(|(node, _)| *node).collect();
    assert_eq!(faces_of_set(&faces, &top).len(), 4);
    elements.extend(others);
    let bodies = bodies(&elements);
    assert_eq!(bodies.len(), mesh.len() + other_mesh.len());
    assert!(
        mesh.keys().all(|node| bodies[node] == bodies[&1])
            && other_mesh.keys().all(|node| bodies[node] == bodies[&500])
    );
    assert_ne!(bodies[&1], bodies[&500]);
    // With nodes between the corners: these lie in the middle of their sides.
    for (corners, edges) in [
        (
            vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]],
            "01 12 20 03 13 23",
        ),
        (
            vec![
                [0.0, 0.0, 0.0],
                [2.0, 0.0, 0.0],
                [0.0, 2.0, 0.0],
                [0.0, 0.0, 2.0],
                [2.0, 0.0, 2.0],
                [0.0, 2.0, 2.0],
            ],
            "01 12 20 34 45 53 03 14 25",
        ),
    ] {
        let mut mesh: Mesh = (0..).zip(corners.clone()).collect();
        for edge in edges.split(' ') {
            let [a, b] = [0, 1].map(|k| corners[(edge.as_bytes()[k] - b'0') as usize]);
            mesh.insert(mesh.len() as i64, [0, 1, 2].map(|d| f64::midpoint(a[d], b[d])));
        }
        let faces = outer_faces(&[(0..mesh.len() as i64).collect()]);
        let count = corners.len();
        let middle = [0, 1, 2].map(|d| corners.iter().map(|x| x[d]).sum::<f64>() / count as f64);
        for face in faces {
            let n = face.len() / 2;
            for k in 0..n {
                let (a, b, between) = (mesh[&face[k]], mesh[&face[(k + 1) % n]], mesh[&face[n + k]]);
                assert!(
                    (0..3).all(|d| near(between[d], f64::midpoint(a[d], b[d]), 1e-15)),
                    "{face:?}"
                );
            }
            let one = surface(&[face], &mesh);
            let (x, normal) = (one.positions[0], one.nodal_normals()[0]);
            assert!((0..3).map(|d| (x[d] - middle[d]) * normal[d]).sum::<f64>() > 0.1);
        }
    }
}
