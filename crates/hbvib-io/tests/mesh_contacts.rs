//! Contacts between meshes that do not match: weights, pairs where they match, and refusals.

mod meshes;

use hbvib_io::{NodalAreas, RelativeCoordinates, node_contacts, surface_contacts};
use meshes::{Kind, near, square, surface};
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
