//! Faces of a sector whose meshes differ, and nodes on the axis: frequencies are those of the whole wheel, assembled with the motion of
//! each node of the finer face as the mean of its neighbours.

use crate::brick::brick;
use hbvib::{ContactState, MatrixKind, MatrixView, Model};
use hbvib_io::{Format, Matrices, Matrix, Symmetry, write};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const SECTORS: usize = 6;
const ANGLE: f64 = TAU / SECTORS as f64;

/// Radius and share of the angle of the nodes of a level: one on the axis, two on the left face, two inside, four on the right face, two
/// between.
const PLACES: [(f64, f64); 11] = [
    (0.0, 0.0),
    (0.4, 0.0),
    (1.0, 0.0),
    (0.4, 0.5),
    (1.0, 0.5),
    (0.4, 1.0),
    (0.6, 1.0),
    (0.8, 1.0),
    (1.0, 1.0),
    (0.6, 0.75),
    (0.8, 0.75),
];

/// Elements of a level; those at the axis are wedges.
const FLAT: [[usize; 4]; 7] = [
    [0, 1, 3, 0],
    [0, 3, 5, 0],
    [1, 2, 4, 3],
    [3, 4, 10, 9],
    [3, 9, 6, 5],
    [9, 10, 7, 6],
    [10, 4, 8, 7],
];

const LEVELS: usize = 2;
const COUNT: usize = PLACES.len();

/// The motion of a node by those of others of its level in the next sector: the right face.
fn images(node: usize) -> Vec<(usize, f64)> {
    match node {
        5 => vec![(1, 1.0)],
        6 => vec![(1, 2.0 / 3.0), (2, 1.0 / 3.0)],
        7 => vec![(1, 1.0 / 3.0), (2, 2.0 / 3.0)],
        8 => vec![(2, 1.0)],
        _ => Vec::new(),
    }
}

fn positions() -> Vec<[f64; 3]> {
    let at = |l: usize| PLACES.map(|(r, share)| [r * (share * ANGLE).cos(), r * (share * ANGLE).sin(), 0.3 * l as f64]);
    (0..LEVELS).flat_map(at).collect()
}

/// Stiffness and mass of the sector, by rows.
fn sector() -> [Vec<Vec<f64>>; 2] {
    let at = positions();
    let n = 3 * at.len();
    let mut sums = [vec![vec![0.0; n]; n], vec![vec![0.0; n]; n]];
    for flat in FLAT {
        let nodes: Vec<usize> = (0..2).flat_map(|l| flat.map(|node| node + COUNT * l)).collect();
        let x: Vec<[f64; 3]> = nodes.iter().map(|node| at[*node]).collect();
        for (sum, own) in sums.iter_mut().zip(brick(&x, (1000.0, 0.3))) {
            for i in 0..24 {
                for j in 0..24 {
                    sum[3 * nodes[i / 3] + i % 3][3 * nodes[j / 3] + j % 3] += own[i][j];
                }
            }
        }
    }
    sums
}

/// A rotation by so many sectors.
fn rotation(sectors: f64) -> [[f64; 3]; 3] {
    let (sin, cos) = (sectors * ANGLE).sin_cos();
    [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]
}

/// The lowest natural frequencies of the whole wheel.
fn of_wheel(sums: &[Vec<Vec<f64>>; 2]) -> Vec<f64> {
    const OWN: [usize; 6] = [1, 2, 3, 4, 9, 10];
    let own = |sector: usize, level: usize, node: usize| {
        let place = OWN.iter().position(|other| *other == node).unwrap();
        3 * (LEVELS + (sector % SECTORS * LEVELS + level) * OWN.len() + place)
    };
    let n = 3 * LEVELS * (1 + SECTORS * OWN.len());
    let mut whole = [vec![0.0; n * n], vec![0.0; n * n]];
    for sector in 0..SECTORS {
        // Coordinates of the wheel and their weights, for each row of the sector.
        let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
        for level in 0..LEVELS {
            for node in 0..COUNT {
                for d in 0..3 {
                    rows.push(if node == 0 {
                        let back = rotation(-(sector as f64));
                        (0..3).map(|e| (3 * level + e, back[d][e])).collect()
                    } else if images(node).is_empty() {
                        vec![(own(sector, level, node) + d, 1.0)]
                    } else {
                        let turn = rotation(1.0);
                        let all = images(node).into_iter();
                        all.flat_map(|(left, w)| {
                            (0..3).map(move |e| (own(sector + 1, level, left) + e, w * turn[d][e]))
                        })
                        .collect()
                    });
                }
            }
        }
        for (whole, a) in whole.iter_mut().zip(sums) {
            for (i, left) in rows.iter().enumerate() {
                for (j, right) in rows.iter().enumerate().filter(|(j, _)| a[i][*j] != 0.0) {
                    for (p, v) in left {
                        for (q, w) in right {
                            whole[p * n + q] += v * w * a[i][j];
                        }
                    }
                }
            }
        }
    }
    let mut model = Model::new(n).unwrap();
    for (kind, a) in [(MatrixKind::Stiffness, &whole[0]), (MatrixKind::Mass, &whole[1])] {
        model.set_matrix(kind, &MatrixView::dense(n, a)).unwrap();
    }
    model.lowest_modes(0, ContactState::Free, 40).unwrap().omega
}

/// Writes mesh and matrices.
fn written(name: &str, sums: &[Vec<Vec<f64>>; 2]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("projected_faces")
        .join(format!("files_{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    let mut mesh = String::from("*NODE\n");
    for (i, [x, y, z]) in positions().into_iter().enumerate() {
        let _ = writeln!(mesh, "{}, {x:?}, {y:?}, {z:?}", i + 1);
    }
    for (e, flat) in FLAT.iter().enumerate() {
        let corners: Vec<usize> = flat[..if flat[3] == flat[0] { 3 } else { 4 }].to_vec();
        let all: Vec<String> = (0..2)
            .flat_map(|l| corners.iter().map(move |c| (c + COUNT * l + 1).to_string()))
            .collect();
        let _ = writeln!(mesh, "*ELEMENT, TYPE=C3D{}\n{}, {}", all.len(), e + 1, all.join(", "));
    }
    for (set, nodes) in [("LEFT", &[0, 1, 2][..]), ("RIGHT", &[0, 5, 6, 7, 8])] {
        let _ = writeln!(mesh, "*NSET, NSET={set}");
        for node in nodes
            .iter()
            .flat_map(|node| (0..LEVELS).map(move |l| node + COUNT * l + 1))
        {
            let _ = writeln!(mesh, "{node},");
        }
    }
    std::fs::write(folder.join("mesh.inp"), mesh).unwrap();
    let n = sums[0].len();
    let matrix = |a: &[Vec<f64>]| {
        let places = (0..n)
            .flat_map(|i| (0..=i).map(move |j| (i, j)))
            .filter(|(i, j)| a[*i][*j] != 0.0);
        let places: Vec<(usize, usize)> = places.collect();
        Some(Matrix {
            rows: n,
            columns: n,
            symmetry: Symmetry::Symmetric,
            row: places.iter().map(|(i, _)| *i as u32).collect(),
            column: places.iter().map(|(_, j)| *j as u32).collect(),
            values: places.iter().map(|(i, j)| a[*i][*j]).collect(),
            is_complex: false,
        })
    };
    let matrices = Matrices {
        stiffness: matrix(&sums[0]),
        mass: matrix(&sums[1]),
        dofs: (0..n as i64).map(|row| (row / 3 + 1, row % 3 + 1)).collect(),
        ..Matrices::default()
    };
    write(&folder.join("sector.npz"), &matrices, Format::Npz).unwrap();
    folder
}

fn job(folder: &Path, faces: &str) -> String {
    let folder = folder.display();
    format!(
        "[model]\nmatrices = '{folder}/sector.npz'\nmesh = '{folder}/mesh.inp'\nsectors = {SECTORS}\nengine_order = 1\nloss_factor = 0.01\n\
         [model.faces]\n{faces}\n"
    )
}

const FACES: &str = "left = 'LEFT'\nright = 'RIGHT'\nmatching = 'projected'";

/// Frequencies in rad per time unit of all waves, ascending.
fn of_waves(name: &str, job: &str) -> Vec<f64> {
    let (output, _) = crate::common::hbvib("modes", ("projected_faces", name), job);
    assert!(
        output.status.success(),
        "{name}: {}",
        crate::common::printed(&output.stderr)
    );
    let mut all = Vec::new();
    for line in crate::common::printed(&output.stdout).lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        let diameter = row[0] as usize;
        let senses = if diameter == 0 || 2 * diameter == SECTORS { 1 } else { 2 };
        all.extend(vec![TAU * row[2]; senses]);
    }
    all.sort_by(f64::total_cmp);
    all
}

#[test]
fn a_wheel_with_different_faces_and_an_axis_has_the_frequencies_of_its_assembly() {
    let sums = sector();
    let folder = written("wheel", &sums);
    let expected = of_wheel(&sums);
    let scale = expected[30];
    // The finer face on the right; and on the left, where the wheel is gone round the other way.
    let exchanged = "left = 'RIGHT'\nright = 'LEFT'\ndirection = -1\nmatching = 'projected'";
    for (name, faces) in [("right", FACES), ("left", exchanged)] {
        let found = of_waves(name, &job(&folder, faces));
        let rigid = expected.iter().filter(|omega| **omega < 1e-4 * scale).count();
        assert_eq!(rigid, 6);
        for (k, (a, b)) in expected.iter().zip(&found).enumerate().take(30) {
            // The tie at the axis gives by one part in 1e6; and rounding of its stiffness, 1e6 times the others, in rigid motions.
            let gap = (a * a - b * b).abs();
            assert!(
                gap <= 5e-7 * a * a + 5e-8 * expected[6] * expected[6],
                "{name}, mode {k}: {a} and {b}, beside {:?}",
                &expected[..8]
            );
        }
    }
    let (output, _) = crate::common::hbvib("check", ("projected_faces", "check"), &job(&folder, FACES));
    let text = crate::common::printed(&output.stdout);
    assert!(
        text.contains("2 nodes on the axis, which move along it in diameter 0"),
        "{text}"
    );
    assert!(
        text.contains("8 nodes of the right face follow 6 of the left one by projection"),
        "{text}"
    );
}

#[test]
fn nodes_of_the_finer_face_move_with_the_next_sector() {
    let folder = written("response", &sector());
    // Node 5 is inside, on the lower level.
    let job = job(&folder, FACES)
        + "[[force]]\ndof = '5.1'\nvalue = 1.0\n[[force]]\ndof = '8.3'\nvalue = 0.5\n[forced]\nfrom_hz = 2.0\nto_hz = 2.0\nharmonics = 1\n\
           response_dof = '5.1'\n[output]\nuff = 'shape.uff'\n";
    let (output, place) = crate::common::hbvib("run", ("projected_faces", "response"), &job);
    assert!(output.status.success(), "{}", crate::common::printed(&output.stderr));
    let shapes = hbvib_io::read_universal(&place.join("shape.uff")).unwrap().shapes;
    let shape = shapes.last().unwrap();
    let motion = |node: i64| -> Vec<(f64, f64)> {
        let at = shape.nodes.iter().position(|other| *other == node).unwrap();
        let width = shape.values.len() / shape.nodes.len();
        shape.values[width * at..width * at + 3].to_vec()
    };
    let (turn, lag) = (rotation(1.0), ANGLE);
    let largest = shape
        .values
        .iter()
        .fold(0.0_f64, |most, (re, im)| most.max(re.hypot(*im)));
    for node in [5, 6, 7, 8] {
        for (d, (re, im)) in motion(node + 1).into_iter().enumerate() {
            let (mut x, mut y) = (0.0, 0.0);
            for (left, w) in images(node as usize) {
                for (e, (re, im)) in motion(left as i64 + 1).into_iter().enumerate() {
                    // The next sector lags.
                    x += w * turn[d][e] * (re * lag.cos() + im * lag.sin());
                    y += w * turn[d][e] * (im * lag.cos() - re * lag.sin());
                }
            }
            assert!(
                (re - x).hypot(im - y) < 1e-4 * largest,
                "node {node}, {d}: {re} + {im} i and {x} + {y} i"
            );
        }
    }
    assert!(motion(1)[2].0.hypot(motion(1)[2].1) < 1e-6 * largest);
    assert!(motion(1)[0].0.hypot(motion(1)[0].1) > 1e-3 * largest);
}

#[test]
fn faces_that_cannot_be_projected_are_refused() {
    let folder = written("refused", &sector());
    for (name, faces, words) in [
        (
            "nodes",
            "left = 'LEFT'\nright = 'RIGHT'".to_owned(),
            "is the nearest of no node of left",
        ),
        ("sense", format!("{FACES}\ndirection = -1"), "is not within"),
        ("far", format!("{FACES}\ntolerance = 0.0"), "tolerance = 0"),
        (
            "frame",
            format!("{FACES}\nframe = 'cylindrical'"),
            "where the cylindrical frame has no directions",
        ),
        ("dofs", FACES.replace("'LEFT'", "[[0, 1, 2]]"), "needs numbers of nodes"),
        ("word", FACES.replace("projected", "project"), "project"),
    ] {
        let (output, _) = crate::common::hbvib("check", ("projected_faces", name), &job(&folder, &faces));
        let errors = crate::common::printed(&output.stderr);
        assert!(!output.status.success() && errors.contains(words), "{name}: {errors}");
    }
    // Right nodes that lie a little off: another distance takes them.
    let mesh = std::fs::read_to_string(folder.join("mesh.inp")).unwrap();
    let line = mesh.lines().find(|line| line.starts_with("7, ")).unwrap();
    let z = line.rsplit(", ").next().unwrap();
    let off = mesh.replacen(
        line,
        &format!("{}, -0.002", line.strip_suffix(&format!(", {z}")).unwrap()),
        1,
    );
    std::fs::write(folder.join("mesh.inp"), off).unwrap();
    let (output, _) = crate::common::hbvib("check", ("projected_faces", "off"), &job(&folder, FACES));
    let errors = crate::common::printed(&output.stderr);
    assert!(
        errors.contains("node 7 is not within") && errors.contains("tolerance sets another distance"),
        "{errors}"
    );
    let (output, _) = crate::common::hbvib(
        "check",
        ("projected_faces", "near"),
        &job(&folder, &format!("{FACES}\ntolerance = 0.01")),
    );
    let text = crate::common::printed(&output.stdout);
    assert!(
        text.contains("at most 2.000e-3 away"),
        "{text}{}",
        crate::common::printed(&output.stderr)
    );
}
