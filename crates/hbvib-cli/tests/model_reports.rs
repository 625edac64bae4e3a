//! The report of `check` as text and JSON: mass and its centre, rows without mass, rigid motions, frequencies, faces, and contacts at
//! rest against closed forms.

use serde_json::Value;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Output};

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn near(value: &Value, expected: f64, relative: f64) {
    let found = value.as_f64().unwrap_or_else(|| panic!("{value}"));
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "{found} {expected}"
    );
}

/// The report of a job as text and as JSON.
fn reports(name: &str, job: &str) -> (String, Value) {
    let (plain, folder) = crate::common::hbvib("check", ("model_reports", name), job);
    assert!(plain.status.success(), "{}", text(&plain.stderr));
    let path = folder.join("job.toml");
    let output: Output = Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .args(["check", "--json"])
        .arg(path)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    (text(&plain.stdout), serde_json::from_slice(&output.stdout).unwrap())
}

/// Three nodes on springs to the ground: masses 1 and 3 at x = 0 and 4, and one without mass at x = 2. Each pair of numbers is the
/// stiffness and the mass of a node.
const NODES: [(i64, f64, f64, f64); 3] = [(10, 0.0, 1000.0, 1.0), (11, 4.0, 2000.0, 3.0), (12, 2.0, 500.0, 0.0)];

fn three_nodes() -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("model_reports");
    std::fs::create_dir_all(&folder).unwrap();
    let (mut stiffness, mut mass, mut mesh) = (String::new(), String::new(), String::new());
    for (node, x, k, m) in NODES {
        let _ = writeln!(mesh, "{node}, {x}, 1.0, -2.0");
        for d in 1..=3 {
            let _ = writeln!(stiffness, "{node},{d}, {node},{d}, {k:?}");
            let _ = writeln!(mass, "{node},{d}, {node},{d}, {m:?}");
        }
    }
    let file = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    format!(
        "[model]\nstiffness = '{}'\nmass = '{}'\nmesh = '{}'\n",
        file("three_STIF1.mtx", &stiffness),
        file("three_MASS1.mtx", &mass),
        file("three.txt", &mesh)
    )
}

#[test]
fn mass_centre_frequencies_and_contacts_at_rest_have_their_closed_forms() {
    let job = format!(
        "{}[[contact]]\nname = 'pressed'\nkind = 'friction_3d'\nnormal = [0, 0, 1]\nkt = 300.0\nkn = 500.0\nmu = 0.3\npreload = 12.0\n\
         a = [0, 1, 2]\n[[contact]]\nname = 'apart'\nkind = 'unilateral'\nkn = 700.0\ngap = 0.1\na = [5]\n\
         [[force]]\ndof = '11.1'\nvalue = 0.5\n",
        three_nodes()
    );
    let (plain, json) = reports("three", &job);
    for k in 0..3 {
        near(&json["mass"][k], 4.0, 1e-12);
        near(&json["centre_of_mass"][k], [3.0, 1.0, -2.0][k], 1e-12);
    }
    assert_eq!(json["rows_without_mass"]["count"], 3);
    assert_eq!(
        json["rows_without_mass"]["first"],
        serde_json::json!(["12.1", "12.2", "12.3"])
    );
    let frequencies = &json["frequencies"][0];
    assert!(frequencies["diameter"] == 0 && frequencies["rigid_motions"] == 0);
    near(&frequencies["free_hz"][0], (2000.0_f64 / 3.0).sqrt() / TAU, 1e-9);
    // A gap that is open is no spring.
    near(&frequencies["stuck_hz"][2], (2000.0_f64 / 3.0).sqrt() / TAU, 1e-9);
    // The preload is a force at zero motion: the spring of the node takes the share kn / (k + kn) of it.
    let pressed = &json["contacts"][0]["pairs"][0];
    near(&pressed["normal_force"], 12.0 * 1000.0 / 1500.0, 1e-6);
    assert!(pressed["closed"] == true && pressed["friction_force"].as_f64().unwrap() < 1e-3);
    assert_eq!(pressed["a"], serde_json::json!(["10.1", "10.2", "10.3"]));
    assert_eq!(json["contacts"][0]["normal"], serde_json::json!([0.0, 0.0, 1.0]));
    let apart = &json["contacts"][1]["pairs"][0];
    near(&apart["gap"], 0.1, 1e-15);
    assert!(apart["closed"] == false && apart["normal_force"] == 0.0, "{apart}");
    for words in [
        "centre of mass: [3.000000e0, 1.000000e0, -2.000000e0]",
        "3 rows without mass in a translation: 12.1, 12.2, 12.3",
        "contact pressed: 1 pair of",
        "at rest normal force 8.0000e0",
        "0 closed, 1 open",
        "names no analysis",
    ] {
        assert!(plain.contains(words), "{words}: {plain}");
    }
    // The facts of the text are those of JSON.
    for fact in json["facts"].as_array().unwrap() {
        assert!(plain.lines().any(|line| line == fact.as_str().unwrap()), "{fact}");
    }
}

#[test]
fn areas_distances_and_faces_are_told() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hbvib-io/tests/data");
    let data = data.display();
    let job = format!(
        "[model]\nmatrices = '{data}/sector.sti'\nmesh = '{data}/sector.inp'\nsectors = 24\nengine_order = 3\nabsent = 'fixed'\n\
         [model.faces]\nleft = [3, 1, 5, 9, 11, 7]\nright = [12, 4, 8, 2, 10, 6]\n\
         [[contact]]\nkind = 'friction_3d'\nnormal = [1, 0, 0]\nany_normal = true\nkt = 1e6\nkn = 1e6\nmu = 0.3\npreload = 1e3\n\
         [contact.nodes]\na = [5]\nb = [3]\nlargest_distance = 10.0\nareas = [2e-6]\n"
    );
    let (plain, json) = reports("sector", &job);
    let faces = json["faces"].as_array().unwrap();
    assert!(
        faces.len() == 6 && faces.iter().all(|pair| pair["distance"].as_f64().unwrap() < 1e-9),
        "{faces:?}"
    );
    assert!(faces.iter().any(|pair| pair["left"] == 3 && pair["right"] == 4));
    assert!(plain.contains("faces: 6 pairs of nodes, the farthest"), "{plain}");
    // Both senses have the same frequencies: diameters 0 to 12.
    assert_eq!(json["frequencies"].as_array().unwrap().len(), 13);
    let pair = &json["contacts"][0]["pairs"][0];
    near(&pair["area"], 2e-6, 1e-12);
    let mesh = std::fs::read_to_string(format!("{data}/sector.inp")).unwrap();
    let position = |node: &str| -> Vec<f64> {
        let line = mesh
            .lines()
            .find(|line| line.split(',').next().unwrap().trim() == node)
            .unwrap();
        line.split(',').skip(1).map(|x| x.trim().parse().unwrap()).collect()
    };
    let apart: f64 = position("5")
        .iter()
        .zip(position("3"))
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt();
    near(&pair["distance"], apart, 1e-12);
    assert!(plain.contains("area 2.000000e-6 in all"), "{plain}");
}

#[test]
fn rigid_motions_and_warnings_are_counted() {
    // The ring damper of diameter 0 has a disk that turns on nothing but the contact.
    let job = format!(
        "{}model.expected.first_hz = 1.0\n[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n",
        crate::common::ring_damper()
    );
    let (plain, json) = reports("ring", &job);
    assert_eq!(json["frequencies"][0]["rigid_motions"], 1);
    assert!(plain.contains("1 rigid motion left without contacts"));
    assert!(json["warnings"].as_array().unwrap().len() == 1, "{json}");
    assert!(json["centre_of_mass"].is_null() && json["mass"].is_null());
    near(&json["contacts"][0]["pairs"][0]["normal_force"], 488.5, 1e-12);
    let (output, _) = crate::common::hbvib("check", ("model_reports", "ring"), &job);
    assert!(output.status.success());
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("model_reports/ring/job.toml");
    let strict = Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .args(["check", "--json", "--strict"])
        .arg(path)
        .output()
        .unwrap();
    assert_eq!(strict.status.code(), Some(1));
    assert!(
        serde_json::from_slice::<Value>(&strict.stdout).is_ok(),
        "the report is there all the same"
    );
}
