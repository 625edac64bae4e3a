//! Campbell and interference diagrams of a job.

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
    let (output, folder) = crate::common::hbvib("run", ("campbell", "rotor"), &job);
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
    let model = crate::common::ring_damper();
    let campbell =
        "[campbell]\nfrom_rpm = 1000\nto_rpm = 3000\npoints = 3\ncount = 3\ninterference_figure = 'safe.svg'\n";
    let (output, folder) = crate::common::hbvib("run", ("campbell", "wheel"), &format!("{model}{campbell}"));
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
        let (output, _) = crate::common::hbvib("run", ("campbell", "wrong"), &rotor("wrong", wrong));
        assert!(!output.status.success());
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(words), "{text}");
    }
}

/// Ten masses that move radially and along the circumference, with Coriolis forces, of the engine order `order`.
fn coriolis_wheel(name: &str, order: i64, rest: &str) -> String {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, entries: &str| {
        let count = entries.lines().count();
        let text = format!("%%MatrixMarket matrix coordinate real general\n2 2 {count}\n{entries}\n");
        fs::write(folder.join(name), text).unwrap();
    };
    write("mass.mtx", "1 1 1\n2 2 1");
    write("stiffness.mtx", "1 1 1500\n2 2 1900");
    write("coupling.mtx", "1 1 -200\n1 2 250\n2 1 -250\n2 2 -350");
    write("gyroscopic.mtx", "1 2 -2\n2 1 2");
    let folder = folder.display();
    format!(
        "[model]\nmass = '{folder}/mass.mtx'\nstiffness = '{folder}/stiffness.mtx'\ncoupling_stiffness = '{folder}/coupling.mtx'\n\
         gyroscopic = '{folder}/gyroscopic.mtx'\nsectors = 10\nengine_order = {order}\n{rest}"
    )
}

#[test]
fn engine_orders_of_a_rotating_wheel_meet_the_waves_of_their_own_sense() {
    // Digits of numpy and brentq, wave by wave.
    for (order, known) in [
        (9, [3.799_517_909_874_847_7, 4.057_803_869_088_63]),
        (19, [1.710_413_476_178_725, 1.982_981_220_346_410_8]),
    ] {
        let (from, to) = (0.2 * 60.0 / TAU, 45.0 * 60.0 / TAU);
        // With the default, with a diameter of either sense, and with one that the engine order does not excite.
        for (diameter, found, rows) in [
            ("", 2, 1),
            ("diameter = 1\n", 2, 2),
            ("diameter = -1\n", 2, 1),
            ("diameter = 21\n", 2, 2),
            ("diameter = 2\n", 0, 1),
        ] {
            let part = format!(
                "[campbell]\nfrom_rpm = {from:?}\nto_rpm = {to:?}\npoints = 181\ncount = 2\nengine_orders = [{order}]\n{diameter}\
                 csv = 'a.csv'\nfigure = 'a.svg'\ninterference_figure = 'safe.svg'\ninterference_rpm = 48\n"
            );
            let job = coriolis_wheel("wheel_of_orders", 1, &part);
            let (output, folder) = crate::common::hbvib("run", ("campbell", "senses"), &job);
            let text = String::from_utf8(output.stdout).unwrap();
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("EO")).collect();
            assert_eq!(lines.len(), found, "{text}");
            for (line, speed) in lines.iter().zip(known) {
                let words = format!("EO {order} at {:.6} rpm", speed * 60.0 / TAU);
                assert!(
                    line.starts_with(&words) && line.contains("nodal diameter -1"),
                    "{line}, needs {words}"
                );
            }
            // The curves of the other sense are there where a crossing lies on them.
            let csv = fs::read_to_string(folder.join("a.csv")).unwrap();
            assert_eq!(csv.lines().count(), 1 + rows * 181 * 2, "{diameter}");
            assert!(fs::read_to_string(folder.join("safe.svg")).unwrap().contains("48 rpm"));
        }
    }
}

#[test]
fn modes_of_a_rotating_wheel_are_listed_in_both_senses() {
    // At the speed 5, by numpy: waves of 1 and −1.
    for (speed, rows) in [(5.0, 10), (0.0, 6)] {
        let job = coriolis_wheel(
            "wheel_of_modes",
            1,
            &format!("speed = {speed:?}\n[campbell]\nfrom_rpm = 0\nto_rpm = 9\n"),
        );
        let (output, _) = crate::common::hbvib("modes", ("campbell", "both"), &job);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(text.lines().count(), 1 + 2 * rows, "{text}");
        if speed > 0.0 {
            for (diameter, known) in [
                ("1", [26.314_906_92, 44.725_237_32]),
                ("-1", [34.107_559_06, 36.932_585_18]),
            ] {
                let of: Vec<f64> = text
                    .lines()
                    .filter(|line| line.split(',').next() == Some(diameter))
                    .map(|line| line.split(',').nth(2).unwrap().parse::<f64>().unwrap() * TAU)
                    .collect();
                assert!(
                    of.iter().zip(known).all(|(a, b)| (a - b).abs() < 1e-7),
                    "{diameter}: {of:?}"
                );
            }
        }
    }
}
