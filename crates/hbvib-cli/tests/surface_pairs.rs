//! Contacts between surfaces of a sector: equal to pairs of nodes where the meshes match, and near where they do not.

use crate::brick::brick;
use hbvib_io::{Format, Matrices, Matrix, Symmetry, write};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

const SECTORS: usize = 12;

/// A sector of two rings on each other, divided by so many bricks along the circumference.
struct Rings {
    nodes: Vec<[f64; 3]>,
    elements: Vec<Vec<usize>>,
    sets: Vec<(&'static str, Vec<usize>)>,
}

impl Rings {
    fn new(inner: usize, outer: usize) -> Self {
        let mut rings = Self {
            nodes: Vec::new(),
            elements: Vec::new(),
            sets: [
                "LEFT", "RIGHT", "HELD", "RIM", "RING", "RIM_L", "RING_L", "RIM_R", "RING_R",
            ]
            .map(|name| (name, Vec::new()))
            .into(),
        };
        for (radii, count) in [([1.0, 1.15, 1.3], inner), ([1.3, 1.4, 1.5], outer)] {
            let first = rings.nodes.len();
            let number = |i: usize, k: usize, l: usize| first + i + 3 * (k + (count + 1) * l);
            for z in [0.0, 0.1, 0.2] {
                for k in 0..=count {
                    let (sin, cos) = (TAU / SECTORS as f64 * k as f64 / count as f64).sin_cos();
                    rings.nodes.extend(radii.map(|r| [r * cos, r * sin, z]));
                }
            }
            for l in 0..2 {
                for k in 0..count {
                    for i in 0..2 {
                        let layer = |l| {
                            [
                                number(i, k, l),
                                number(i + 1, k, l),
                                number(i + 1, k + 1, l),
                                number(i, k + 1, l),
                            ]
                        };
                        rings.elements.push([layer(l), layer(l + 1)].concat());
                    }
                }
            }
            for l in 0..3 {
                for i in 0..3 {
                    let (left, right) = if first == 0 { (5, 7) } else { (6, 8) };
                    for (set, k) in [(0, 0), (1, count), (left, 0), (right, count)] {
                        rings.sets[set].1.push(number(i, k, l));
                    }
                }
                for k in 0..=count {
                    let (set, i) = if first == 0 { (3, 2) } else { (4, 0) };
                    rings.sets[set].1.push(number(i, k, l));
                    // The inner ring is held inside, the outer one at an edge outside.
                    if first == 0 {
                        rings.sets[2].1.push(number(0, k, l));
                    } else if l == 0 {
                        rings.sets[2].1.push(number(2, k, l));
                    }
                }
            }
        }
        rings
    }

    /// Rows of nodes that are held are left out.
    fn free(&self) -> Vec<usize> {
        (0..self.nodes.len())
            .filter(|node| !self.sets[2].1.contains(node))
            .collect()
    }

    /// Writes mesh and matrices, and returns the keys of the model.
    fn written(&self, folder: &Path) -> String {
        std::fs::create_dir_all(folder).unwrap();
        let mut mesh = String::from("*NODE\n");
        for (i, x) in self.nodes.iter().enumerate() {
            let _ = writeln!(mesh, "{}, {:?}, {:?}, {:?}", i + 1, x[0], x[1], x[2]);
        }
        mesh += "*ELEMENT, TYPE=C3D8, ELSET=ALL\n";
        for (e, nodes) in self.elements.iter().enumerate() {
            let nodes: Vec<String> = nodes.iter().map(|node| (node + 1).to_string()).collect();
            let _ = writeln!(mesh, "{}, {}", e + 1, nodes.join(", "));
        }
        for (name, nodes) in &self.sets {
            let _ = writeln!(mesh, "*NSET, NSET={name}");
            for node in nodes {
                let _ = writeln!(mesh, "{},", node + 1);
            }
        }
        std::fs::write(folder.join("mesh.inp"), mesh).unwrap();
        let free = self.free();
        let n = 3 * free.len();
        let mut sums = vec![vec![vec![0.0; n]; n]; 2];
        for element in &self.elements {
            let x: Vec<[f64; 3]> = element.iter().map(|node| self.nodes[*node]).collect();
            let place = |node: &usize, d| free.iter().position(|other| other == node).map(|at| 3 * at + d);
            let rows: Vec<Option<usize>> = element
                .iter()
                .flat_map(|node| [0, 1, 2].map(|d| place(node, d)))
                .collect();
            for (sum, own) in sums.iter_mut().zip(brick(&x, (1000.0, 0.3))) {
                for (i, line) in rows.iter().zip(&own) {
                    for (j, value) in rows.iter().zip(line) {
                        if let (Some(i), Some(j)) = (i, j) {
                            sum[*i][*j] += value;
                        }
                    }
                }
            }
        }
        let matrix = |a: &Vec<Vec<f64>>| {
            let places: Vec<(usize, usize)> = (0..n)
                .flat_map(|i| (0..=i).map(move |j| (i, j)))
                .filter(|(i, j)| a[*i][*j] != 0.0)
                .collect();
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
            dofs: free
                .iter()
                .flat_map(|node| (1..=3).map(|d| (*node as i64 + 1, d)))
                .collect(),
            ..Matrices::default()
        };
        write(&folder.join("rings.npz"), &matrices, Format::Npz).unwrap();
        let folder = folder.display();
        format!(
            "[model]\nmatrices = '{folder}/rings.npz'\nmesh = '{folder}/mesh.inp'\nabsent = 'fixed'\nsectors = {SECTORS}\nengine_order = 2\n\
             loss_factor = 0.02\n[model.faces]\nleft = 'LEFT'\nright = 'RIGHT'\n"
        )
    }
}

const STIFFNESS: f64 = 2000.0;

fn surfaces(method: &str) -> String {
    format!(
        "[[contact]]\nkind = 'friction_3d'\nkt = {STIFFNESS:?}\nkn = {STIFFNESS:?}\nmu = 0.3\npreload = 0.05\n\
         [contact.surfaces]\na = 'RING'\nb = ['RIM']\nlargest_distance = 0.05\n{method}"
    )
}

/// Pairs of nodes with their areas and normals by hand: those of the left face stand for the right one.
fn by_hand(rings: &Rings) -> String {
    let mut text = String::new();
    let (rim, ring) = (&rings.sets[3].1, &rings.sets[4].1);
    let count = rim.len() / 3 - 1;
    let chord = 2.0 * 1.3 * (TAU / SECTORS as f64 / count as f64 / 2.0).sin();
    for (at, (a, b)) in ring.iter().zip(rim).enumerate() {
        let (k, l) = (at % (count + 1), at / (count + 1));
        if k == count {
            continue;
        }
        let area = chord * if l == 1 { 0.1 } else { 0.05 };
        // On the faces the normal is that of the one brick beside it.
        let half = TAU / SECTORS as f64 / count as f64 / 2.0;
        let turn = TAU / SECTORS as f64 * k as f64 / count as f64 + if k == 0 { half } else { 0.0 };
        let _ = writeln!(
            text,
            "[[contact]]\nkind = 'friction_3d'\nkt = {:?}\nkn = {:?}\nmu = 0.3\npreload = {:?}\nnormal = [{:?}, {:?}, 0.0]\n\
             any_normal = true\n[contact.nodes]\na = [{}]\nb = [{}]\nlargest_distance = 1e-6",
            STIFFNESS * area,
            STIFFNESS * area,
            0.05 * area,
            turn.cos(),
            turn.sin(),
            a + 1,
            b + 1
        );
    }
    text
}

fn folder(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("surface_pairs")
        .join(format!("files_{name}"))
}

fn printed(verb: &str, name: &str, job: &str) -> String {
    let (output, _) = crate::common::hbvib(verb, ("surface_pairs", name), job);
    assert!(
        output.status.success(),
        "{name}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

/// Frequencies with stuck contacts, of each diameter and mode.
fn stuck(name: &str, job: &str) -> Vec<f64> {
    let text = printed("modes", name, job);
    let rows = text.lines().skip(1);
    let last = |line: &str| line.split(',').next_back().unwrap().parse().unwrap();
    rows.map(last).collect()
}

#[test]
fn meshes_that_match_give_the_frequencies_of_pairs_and_others_near_ones() {
    let rings = Rings::new(4, 4);
    let model = rings.written(&folder("matching"));
    let pairs = stuck("pairs", &(model.clone() + &by_hand(&rings)));
    let same = stuck("same", &(model.clone() + &surfaces("")));
    assert!(pairs.len() > 40 && pairs[0] > 0.0);
    for (a, b) in pairs.iter().zip(&same) {
        assert!((a - b).abs() <= 1e-8 * a, "{a} and {b}");
    }
    // Sets of each body instead of bodies by their elements.
    let by_sets = model
        .replace("'LEFT'", "['RING_L', 'RIM_L']")
        .replace("'RIGHT'", "['RING_R', 'RIM_R']");
    assert_eq!(same, stuck("sets", &(by_sets + &surfaces(""))));
    // The right face follows images of the left one, and contacts there are those of the left one.
    let projected = model.replace("[model.faces]", "[model.faces]\nmatching = 'projected'");
    for (a, b) in pairs.iter().zip(&stuck("projected", &(projected + &surfaces("")))) {
        assert!((a - b).abs() <= 1e-8 * a, "{a} and {b}");
    }
    // Softer contacts show.
    let soft = stuck("soft", &(model + &surfaces("").replace("2000.0", "1000.0")));
    assert!(
        (soft[0] - pairs[0]).abs() > 0.01 * pairs[0],
        "{} and {}",
        soft[0],
        pairs[0]
    );
    let other = Rings::new(8, 9);
    let conforming = Rings::new(9, 9);
    let reference = stuck(
        "conforming",
        &(conforming.written(&folder("conforming")) + &surfaces("")),
    );
    let model = other.written(&folder("other"));
    for (name, method) in [("nearest", ""), ("mortar", "method = 'mortar'\n")] {
        let found = stuck(name, &(model.clone() + &surfaces(method)));
        for k in 0..10 {
            let gap = (found[k] - reference[k]).abs() / reference[k];
            assert!(gap < 0.02, "{name}, mode {k}: {} and {}", found[k], reference[k]);
        }
    }
}

#[test]
fn the_response_with_slip_is_that_of_pairs() {
    let rings = Rings::new(3, 3);
    let model = rings.written(&folder("response"));
    let tip = rings
        .nodes
        .iter()
        .position(|x| (x[0].hypot(x[1]) - 1.4).abs() < 1e-9 && x[1] > 0.1 && x[2] > 0.15)
        .unwrap()
        + 1;
    let first = stuck("response_modes", &(model.clone() + &surfaces("")))[20];
    let rest = format!(
        "[[force]]\ndof = '{tip}.1'\nvalue = 0.01\n[[force]]\ndof = '{}.2'\nvalue = 0.001\n[forced]\nfrom_hz = {:?}\nto_hz = {:?}\n\
         harmonics = 3\nresponse_dof = '{tip}.1'\n",
        rings.sets[4].1[5] + 1,
        0.9 * first,
        1.05 * first
    );
    let runs = [("pairs_run", by_hand(&rings)), ("surfaces_run", surfaces(""))].map(|(name, contacts)| {
        let job = format!("{model}{contacts}{rest}[output]\nuff = 'shape.uff'\n");
        let (output, place) = crate::common::hbvib("run", ("surface_pairs", name), &job);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).unwrap();
        let peak = text.lines().find(|line| line.contains("peak")).unwrap().to_owned();
        (peak, hbvib_io::read_universal(&place.join("shape.uff")).unwrap().shapes)
    });
    let [(peak, shapes), (other, others)] = runs;
    assert_eq!(peak, other);
    // Motions of all nodes at the peak, those of the contacts included, which are recovered from relative ones.
    assert!(shapes.len() > 1 && shapes.len() == others.len());
    for (shape, other) in shapes.iter().zip(&others) {
        assert_eq!((&shape.nodes, shape.values.len()), (&other.nodes, other.values.len()));
        let largest = shapes[1]
            .values
            .iter()
            .fold(0.0_f64, |m, (re, im)| m.max(re.hypot(*im)));
        for (a, b) in shape.values.iter().zip(&other.values) {
            assert!((a.0 - b.0).hypot(a.1 - b.1) <= 1e-5 * largest, "{a:?} and {b:?}");
        }
    }
}

#[test]
fn surfaces_that_cannot_be_are_refused() {
    let rings = Rings::new(3, 4);
    let model = rings.written(&folder("refused"));
    for (name, contact, words) in [
        ("set", surfaces("").replace("RING", "RANG"), "there is no set \"RANG\""),
        (
            "far",
            surfaces("").replace("0.05\n", "1e-9\n").replace("'RIM'", "'HELD'"),
            "within 0.000000001",
        ),
        (
            "both",
            surfaces("").replace("[contact.surfaces]", "a = [1]\n[contact.surfaces]"),
            "leave no room",
        ),
        (
            "mortar",
            surfaces("method = 'mortar'\n")
                .replace("'RING'", "'RIM'")
                .replace("['RIM']", "'RING'"),
            "are no images",
        ),
        ("key", surfaces("methods = 'mortar'\n"), "methods"),
    ] {
        let (output, _) = crate::common::hbvib("check", ("surface_pairs", name), &(model.clone() + &contact));
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && errors.contains(words), "{name}: {errors}");
    }
    let on_ring = rings.sets[4].1[1] + 1;
    let response = format!(
        "{model}{}[[force]]\ndof = '{on_ring}.1'\nvalue = 1.0\n[forced]\nfrom_hz = 1.0\nto_hz = 2.0\nresponse_dof = '{on_ring}.1'\n",
        surfaces("")
    );
    let (output, _) = crate::common::hbvib("run", ("surface_pairs", "response"), &response);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(errors.contains("moves relative to side b"), "{errors}");
}

/// Nodes of the outer ring lie off the chords of the inner one, by the height of an arc.
#[test]
fn distances_of_the_faces_are_added_to_the_gap() {
    let rings = Rings::new(8, 9);
    let model = rings.written(&folder("gaps"));
    let contact = surfaces("mesh_gaps = true\n").replace("preload = 0.05", "gap = 0.01");
    let (output, _) = crate::common::hbvib("check", ("surface_pairs", "gaps"), &(model.clone() + &contact));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let job = Path::new(env!("CARGO_TARGET_TMPDIR")).join("surface_pairs/gaps/job.toml");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .args(["check", "--json"])
        .arg(job)
        .output()
        .unwrap();
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let pairs = report["contacts"][0]["pairs"].as_array().unwrap();
    assert_eq!(pairs.len(), 27);
    let mut largest = 0.0_f64;
    for pair in pairs {
        let name = pair["a"][0].as_str().unwrap();
        let node: usize = name.split('.').next().unwrap().parse().unwrap();
        let x = rings.nodes[node - 1];
        let chord = TAU / SECTORS as f64 / 8.0;
        let along = (x[1].atan2(x[0]) / chord).rem_euclid(1.0);
        let height = 1.3 * (((along - 0.5) * chord).cos() - (chord / 2.0).cos());
        let gap = pair["gap"].as_f64().unwrap();
        // Normals of both sides differ by a few degrees.
        assert!(
            (gap - 0.01 - height).abs() <= 2e-3 * height + 1e-12,
            "node {node}: {gap}, needs 0.01 + {height:.3e}"
        );
        largest = largest.max(height);
    }
    assert!(largest > 5e-4, "{largest:.1e}");
}
