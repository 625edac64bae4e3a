//! The patch test of two blocks whose meshes do not match.

#[path = "meshes/brick.rs"]
mod brick;
mod meshes;

use brick::brick;
use hbvib_io::{
    Matrices, Matrix, NodalAreas, RelativeCoordinates, Symmetry, faces_of_set, outer_faces, surface_contacts,
};
use meshes::{Mesh, block, near, surface};

/// Elastic modulus and Poisson's ratio of the blocks.
const ELASTIC: (f64, f64) = (1000.0, 0.3);

/// Solves a system by elimination with pivots.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for p in 0..n {
        let best = (p..n).max_by(|i, j| a[*i][p].abs().total_cmp(&a[*j][p].abs())).unwrap();
        a.swap(p, best);
        b.swap(p, best);
        for i in p + 1..n {
            let factor = a[i][p] / a[p][p];
            if factor != 0.0 {
                let (done, below) = a.split_at_mut(i);
                for (x, y) in below[0].iter_mut().zip(&done[p]).skip(p) {
                    *x -= factor * y;
                }
                b[i] -= factor * b[p];
            }
        }
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|j| a[i][j] * b[j]).sum();
        b[i] = (b[i] - sum) / a[i][i];
    }
    b
}

/// The stiffness of bricks, with three rows a node.
fn assembled(elements: &[Vec<i64>], mesh: &Mesh, nodes: &[i64]) -> Matrices {
    let dofs: Vec<(i64, i64)> = nodes.iter().flat_map(|node| (1..=3).map(|d| (*node, d))).collect();
    let row = |node: i64, d: usize| 3 * nodes.binary_search(&node).unwrap() + d;
    let n = dofs.len();
    let mut k = vec![vec![0.0; n]; n];
    for element in elements {
        let x: Vec<[f64; 3]> = element.iter().map(|node| mesh[node]).collect();
        let rows: Vec<usize> = element
            .iter()
            .flat_map(|node| [0, 1, 2].map(|d| row(*node, d)))
            .collect();
        for (i, line) in rows.iter().zip(&brick(&x, ELASTIC)[0]) {
            for (j, value) in rows.iter().zip(line) {
                k[*i][*j] += value;
            }
        }
    }
    let lower_triangle = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j)));
    let entries: Vec<(usize, usize)> = lower_triangle.filter(|(i, j)| k[*i][*j] != 0.0).collect();
    Matrices {
        stiffness: Some(Matrix {
            rows: n,
            columns: n,
            symmetry: Symmetry::Symmetric,
            row: entries.iter().map(|(i, _)| *i as u32).collect(),
            column: entries.iter().map(|(_, j)| *j as u32).collect(),
            values: entries.iter().map(|(i, j)| k[*i][*j]).collect(),
            is_complex: false,
        }),
        dofs,
        ..Matrices::default()
    }
}

/// Two blocks of 3 × 3 and 4 × 4 bricks with springs between them and a uniform pressure on top: the stress is uniform, so that motions are
/// linear in each block and the springs have one compression.
#[test]
fn two_blocks_under_pressure_pass_the_patch_test() {
    let ((lower, mut mesh), (upper, upper_mesh)) = (block(3, [0.0, 0.5], 1), block(4, [0.5, 1.25], 1000));
    let upper_nodes: Vec<i64> = upper_mesh.keys().copied().collect();
    mesh.extend(upper_mesh);
    let on = |z: f64, above: bool| -> Vec<i64> {
        let all = mesh
            .iter()
            .filter(|(node, x)| near(x[2], z, 1e-9) && upper_nodes.contains(node) == above);
        all.map(|(node, _)| *node).collect()
    };
    let own = surface(&faces_of_set(&outer_faces(&upper), &on(0.5, true)), &mesh);
    let other = surface(&faces_of_set(&outer_faces(&lower), &on(0.5, false)), &mesh);
    let contacts = surface_contacts(&own, &other, 1e-3, NodalAreas::Consistent).unwrap();
    let mut nodes: Vec<i64> = mesh.keys().copied().collect();
    nodes.sort_unstable();
    let dofs: Vec<(i64, i64)> = nodes.iter().flat_map(|node| (1..=3).map(|d| (*node, d))).collect();
    let row = |node: i64, d: usize| 3 * nodes.binary_search(&node).unwrap() + d;
    let n = dofs.len();
    let given = assembled(&[lower.as_slice(), &upper].concat(), &mesh, &nodes);
    let relative = RelativeCoordinates::new(&dofs, &contacts).unwrap();
    let a = relative.matrix(given.stiffness.as_ref().unwrap()).unwrap();
    let mut k = vec![vec![0.0; n]; n];
    for ((i, j), value) in a.row.iter().zip(&a.column).zip(&a.values) {
        k[*i as usize][*j as usize] += *value;
        if i != j {
            k[*j as usize][*i as usize] += *value;
        }
    }
    // Springs between relative motions along z and the ground.
    let (pressure, spring) = (7.0, 300.0);
    for contact in &contacts {
        let at = row(contact.node, 2);
        assert!(relative.is_relative(at) && near(contact.normal[2], -1.0, 1e-12));
        k[at][at] += spring * contact.area;
    }
    let mut f = vec![0.0; n];
    let top = surface(&faces_of_set(&outer_faces(&upper), &on(1.25, true)), &mesh);
    for (node, area) in top.nodes.iter().zip(top.nodal_areas(NodalAreas::Consistent)) {
        f[row(*node, 2)] -= pressure * area;
    }
    relative.project(&mut f);
    // Planes of symmetry at x = 0 and y = 0, and the bottom held along z. Relative motions there are zero as well.
    let held = |node: &i64| [0, 1, 2].map(|d| near(mesh[node][d], 0.0, 1e-12));
    for node in &nodes {
        for d in (0..3).filter(|d| held(node)[*d]) {
            let at = row(*node, d);
            for line in &mut k {
                line[at] = 0.0;
            }
            k[at].fill(0.0);
            (k[at][at], f[at]) = (1.0, 0.0);
        }
    }
    let mut u = solved(k, f);
    for contact in &contacts {
        let compression = u[row(contact.node, 2)];
        assert!(
            near(compression, -pressure / spring, 1e-12),
            "node {}: {compression}",
            contact.node
        );
    }
    relative.recover(&mut u);
    let strain = pressure / ELASTIC.0;
    for (node, x) in &mesh {
        let jump = if upper_nodes.contains(node) {
            pressure / spring
        } else {
            0.0
        };
        let expected = [
            ELASTIC.1 * strain * x[0],
            ELASTIC.1 * strain * x[1],
            -strain * x[2] - jump,
        ];
        for d in 0..3 {
            let found = u[row(*node, d)];
            assert!(
                near(found, expected[d], 1e-12),
                "node {node} at {x:?}, direction {d}: {found}, needs {}",
                expected[d]
            );
        }
    }
}
