//! Contacts between meshes that do not match: weights, pairs where they match, and refusals.

mod meshes;

use hbvib_io::{Matrix, NodalAreas, RelativeCoordinates, Symmetry, node_contacts, surface_contacts};
use meshes::{Kind, near, noise, square, surface};
use std::collections::HashMap;

/// Forces of a uniform pressure are those of the other side's own shape functions, and linear motions are followed.
#[test]
fn weights_keep_uniform_pressures_and_linear_motions() {
    for own_kind in [Kind::Triangles, Kind::Quadrilaterals, Kind::SixNodes] {
        for other_kind in [Kind::Triangles, Kind::Quadrilaterals, Kind::SixNodes, Kind::EightNodes] {
            let ((own_faces, mut mesh), (other_faces, other_mesh)) = (
                square(own_kind, 3, 0.0, 1, false),
                square(other_kind, 4, 0.01, 1000, true),
            );
            mesh.extend(other_mesh);
            let (own, other) = (surface(&own_faces, &mesh), surface(&other_faces, &mesh));
            let contacts = surface_contacts(&own, &other, 0.05, NodalAreas::Consistent).unwrap();
            let told = format!("{own_kind:?} on {other_kind:?}");
            let total: f64 = contacts.iter().map(|c| c.area).sum();
            assert!(near(total, 1.0, 1e-12), "{told}: {total}");
            let mut forces: HashMap<i64, f64> = HashMap::new();
            for contact in &contacts {
                assert!(near(contact.gap, 0.01, 1e-12), "{told}: gap {}", contact.gap);
                let mut sums = [0.0; 4];
                for (node, weight) in &contact.others {
                    *forces.entry(*node).or_default() += weight * contact.area;
                    sums[3] += weight;
                    for d in 0..3 {
                        sums[d] += weight * mesh[node][d];
                    }
                }
                assert!(near(sums[3], 1.0, 1e-11), "{told}: weights {}", sums[3]);
                for d in 0..3 {
                    let opposite = contact.position[d] + 0.01 * contact.normal[d];
                    assert!(
                        near(sums[d], opposite, 1e-11),
                        "{told}, node {}: {sums:?}",
                        contact.node
                    );
                }
            }
            for (node, area) in other.nodes.iter().zip(other.nodal_areas(NodalAreas::Consistent)) {
                let force = forces.get(node).copied().unwrap_or(0.0);
                assert!(near(force, area, 1e-12), "{told}, node {node}: {force} and {area}");
            }
        }
    }
}

#[test]
fn meshes_that_match_give_pairs_of_nodes() {
    for kind in [Kind::Triangles, Kind::Quadrilaterals, Kind::SixNodes] {
        let ((faces, mut mesh), (other_faces, other_mesh)) =
            (square(kind, 3, 0.0, 1, false), square(kind, 3, 0.0, 1000, false));
        mesh.extend(other_mesh);
        let (own, other) = (surface(&faces, &mesh), surface(&other_faces, &mesh));
        for contacts in [
            surface_contacts(&own, &other, 1e-3, NodalAreas::Consistent).unwrap(),
            node_contacts(&own, &other, 1e-3, NodalAreas::Consistent).unwrap(),
        ] {
            let areas = own.nodal_areas(NodalAreas::Consistent);
            assert_eq!(contacts.len(), areas.iter().filter(|a| **a > 1e-9).count());
            for contact in contacts {
                let whole: Vec<&(i64, f64)> = contact.others.iter().filter(|(_, w)| w.abs() > 1e-10).collect();
                assert!(
                    matches!(whole[..], [(node, w)] if *node == contact.node + 999 && near(*w, 1.0, 1e-10)),
                    "{contact:?}"
                );
            }
        }
    }
}

#[test]
fn faces_with_eight_nodes_need_positive_areas() {
    let ((faces, mut mesh), (other_faces, other_mesh)) = (
        square(Kind::EightNodes, 2, 0.0, 1, false),
        square(Kind::Quadrilaterals, 3, 0.0, 1000, true),
    );
    mesh.extend(other_mesh);
    let (own, other) = (surface(&faces, &mesh), surface(&other_faces, &mesh));
    let sentence = surface_contacts(&own, &other, 0.1, NodalAreas::Consistent).unwrap_err();
    assert!(sentence.contains("eight nodes are negative"), "{sentence}");
    let contacts = surface_contacts(&own, &other, 0.1, NodalAreas::Positive).unwrap();
    assert!(near(contacts.iter().map(|c| c.area).sum(), 1.0, 1e-12) && contacts.iter().all(|c| c.area > 0.0));
    assert!(
        surface_contacts(
            &own,
            &surface(&faces, &square(Kind::EightNodes, 2, 1.0, 1, false).1),
            0.1,
            NodalAreas::Positive
        )
        .unwrap_err()
        .contains("within 0.1")
    );
}

#[test]
fn contacts_that_no_coordinates_can_have_are_refused() {
    let ((faces, mut mesh), (other_faces, other_mesh)) = (
        square(Kind::Triangles, 2, 0.0, 1, false),
        square(Kind::Triangles, 3, 0.0, 50, true),
    );
    mesh.extend(other_mesh);
    let (own, other) = (surface(&faces, &mesh), surface(&other_faces, &mesh));
    let one_way = surface_contacts(&own, &other, 0.1, NodalAreas::Consistent).unwrap();
    let back = surface_contacts(&other, &own, 0.1, NodalAreas::Consistent).unwrap();
    let dofs: Vec<(i64, i64)> = own
        .nodes
        .iter()
        .chain(&other.nodes)
        .flat_map(|node| (1..=3).map(|d| (*node, d)))
        .collect();
    let refused = |dofs: &[(i64, i64)], contacts: &[hbvib_io::SurfaceContact]| {
        RelativeCoordinates::new(dofs, contacts).unwrap_err()
    };
    assert!(
        refused(&dofs, &[one_way.clone(), back].concat()).contains("the first side of one contact and on the second")
    );
    assert!(refused(&dofs, &[one_way.clone(), one_way.clone()].concat()).contains("two contacts"));
    let without: Vec<(i64, i64)> = dofs.iter().copied().filter(|dof| dof.0 < 50 || dof.1 != 2).collect();
    assert!(refused(&without, &one_way).contains("no row of direction 2"));
    assert!(RelativeCoordinates::new(&dofs, &one_way).is_ok());
}

/// All entries, row by row.
fn whole(a: &Matrix) -> Vec<Vec<Complex>> {
    let mut all = vec![vec![(0.0, 0.0); a.columns]; a.rows];
    let mut add = |i: u32, j: u32, value: Complex| {
        let place: &mut Complex = &mut all[i as usize][j as usize];
        *place = (place.0 + value.0, place.1 + value.1);
    };
    for (k, value) in a.values.chunks_exact(2).enumerate() {
        let (i, j, re, im) = (a.row[k], a.column[k], value[0], value[1]);
        add(i, j, (re, im));
        match a.symmetry {
            _ if i == j => {}
            Symmetry::General => {}
            Symmetry::Symmetric => add(j, i, (re, im)),
            Symmetry::Hermitian => add(j, i, (re, -im)),
            Symmetry::Skew => add(j, i, (-re, -im)),
        }
    }
    all
}

type Complex = (f64, f64);

/// Matrices of every symmetry against the product of three, and forces and motions against the change of coordinates.
#[test]
fn relative_coordinates_are_a_congruence() {
    let ((faces, mut mesh), (other_faces, other_mesh)) = (
        square(Kind::Triangles, 2, 0.0, 1, false),
        square(Kind::Quadrilaterals, 1, 0.0, 50, true),
    );
    mesh.extend(other_mesh);
    let (own, other) = (surface(&faces, &mesh), surface(&other_faces, &mesh));
    let contacts = surface_contacts(&own, &other, 0.1, NodalAreas::Consistent).unwrap();
    let nodes = own.nodes.iter().chain(&other.nodes).chain(&[99]);
    let dofs: Vec<(i64, i64)> = nodes.flat_map(|node| (1..=3).map(|d| (*node, d))).collect();
    let n = dofs.len();
    let relative = RelativeCoordinates::new(&dofs, &contacts).unwrap();
    let mut t = vec![vec![0.0; n]; n];
    for (row, line) in t.iter_mut().enumerate() {
        line[row] = 1.0;
        for (column, weight) in relative.weights(row) {
            line[*column as usize] += weight;
        }
    }
    assert!((0..n).filter(|row| relative.is_relative(*row)).count() == 27 && !relative.is_relative(n - 1));
    for symmetry in [
        Symmetry::General,
        Symmetry::Symmetric,
        Symmetry::Hermitian,
        Symmetry::Skew,
    ] {
        let mut a = Matrix {
            rows: n,
            columns: n,
            symmetry,
            row: Vec::new(),
            column: Vec::new(),
            values: Vec::new(),
            is_complex: true,
        };
        for k in 0..6 * n {
            // Either triangle stands for the other one.
            let (i, j) = ((7 * k + k * k) % n, (5 * k + 3) % n);
            let diagonal = i == j && matches!(symmetry, Symmetry::Hermitian | Symmetry::Skew);
            a.row.push(i as u32);
            a.column.push(j as u32);
            a.values.extend(if diagonal && symmetry == Symmetry::Skew {
                [0.0, 0.0]
            } else {
                [noise(k), if diagonal { 0.0 } else { noise(3 * k + 1) }]
            });
        }
        let (given, found) = (whole(&a), whole(&relative.matrix(&a).unwrap()));
        for i in 0..n {
            for j in 0..n {
                let mut sum = (0.0, 0.0);
                for p in (0..n).filter(|p| t[*p][i] != 0.0) {
                    for q in (0..n).filter(|q| t[*q][j] != 0.0) {
                        let factor = t[p][i] * t[q][j];
                        sum = (sum.0 + factor * given[p][q].0, sum.1 + factor * given[p][q].1);
                    }
                }
                let gap = (found[i][j].0 - sum.0).hypot(found[i][j].1 - sum.1);
                assert!(
                    gap <= 1e-12,
                    "{symmetry:?} [{i}, {j}]: {:?}, needs {sum:?}",
                    found[i][j]
                );
            }
        }
    }
    let given: Vec<f64> = (0..n).map(noise).collect();
    let (mut motion, mut force) = (given.clone(), given.clone());
    relative.recover(&mut motion);
    relative.project(&mut force);
    for i in 0..n {
        let (u, f): (f64, f64) = (0..n).fold((0.0, 0.0), |(u, f), j| (u + t[i][j] * given[j], f + t[j][i] * given[j]));
        assert!(near(motion[i], u, 1e-13) && near(force[i], f, 1e-13), "row {i}");
    }
}
