//! Campbell and interference diagrams of a job.

mod common;

use std::f64::consts::TAU;
use std::fs;

/// Stodola's rotor from files of a test, in Hz as if its unit of time were a second.
fn rotor(test: &str, campbell: &str) -> String {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("rotor")
        .join(test);
    fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, symmetry: &str, entries: &str| {
        let count = entries.lines().count();
        let text = format!("%%MatrixMarket matrix coordinate real {symmetry}\n4 4 {count}\n{entries}\n");
        fs::write(folder.join(name), text).unwrap();
    };
    write("mass.mtx", "symmetric", "1 1 1\n2 2 1\n3 3 0.3\n4 4 0.3");
    write(
        "stiffness.mtx",
        "symmetric",
        "1 1 1\n2 2 1\n3 1 0.4\n4 2 0.4\n3 3 0.8\n4 4 0.8",
    );
    write("gyroscopic.mtx", "skew-symmetric", "4 3 -0.5");
    let folder = folder.display();
    format!(
        "[model]\nmass = '{folder}/mass.mtx'\nstiffness = '{folder}/stiffness.mtx'\n\
         gyroscopic = '{folder}/gyroscopic.mtx'\n[campbell]\n{campbell}"
    )
}

#[test]
fn a_rotor_has_its_frequencies_and_one_forward_critical_speed() {
    let to = 120.0 / TAU;
    let job = rotor(
        "frequencies",
        &format!("from_rpm = 0\nto_rpm = {to:?}\npoints = 21\ncount = 4\ncsv = 'a.csv'\nfigure = 'a.svg'\n"),
    );
    let (output, folder) = common::hbvib("run", ("campbell", "rotor"), &job);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let forward: Vec<&str> = text.lines().filter(|line| line.ends_with("forward")).collect();
    let [one] = forward[..] else { panic!("{text}") };
    let rpm = format!("EO 1 at {:.6} rpm", 0.913_522_580_993_896_5 * 60.0 / TAU);
    assert!(one.starts_with(&rpm), "{one}, needs {rpm}");
    let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
    let known = [0.693_911_507, 0.917_055_456, 1.246_325_060, 2.689_847_777];
    let at_one = csv.lines().skip(1 + 4 * 10).take(4);
    for (line, known) in at_one.zip(known) {
        let hertz: f64 = line.split(',').nth(2).unwrap().parse().unwrap();
        assert!((hertz * TAU / known - 1.0).abs() < 1e-8, "{line}");
    }
    assert!(fs::read_to_string(folder.join("a.svg")).unwrap().contains("speed, rpm"));
}

#[test]
fn a_wheel_has_an_interference_diagram_and_a_plain_structure_none() {
    let model = common::ring_damper();
    let campbell =
        "[campbell]\nfrom_rpm = 1000\nto_rpm = 3000\npoints = 3\ncount = 3\ninterference_figure = 'safe.svg'\n";
    let (output, folder) = common::hbvib("run", ("campbell", "wheel"), &format!("{model}{campbell}"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let figure = fs::read_to_string(folder.join("safe.svg")).unwrap();
    assert!(figure.contains("nodal diameter") && figure.contains("3000 rpm"));
    for (wrong, words) in [
        (
            "from_rpm = 0\nto_rpm = 9\ninterference_figure = 'safe.svg'\n",
            "several sectors",
        ),
        ("from_rpm = 9\nto_rpm = 0\n", "rising speeds"),
        (
            "from_rpm = 0\nto_rpm = 9\nengine_orders = [0]\n",
            "engine_orders[0] = 0",
        ),
    ] {
        let (output, _) = common::hbvib("run", ("campbell", "wrong"), &rotor("wrong", wrong));
        assert!(!output.status.success());
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(words), "{text}");
    }
}
