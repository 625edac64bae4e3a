//! A job with `[fit]` and `[[data]]`: the values are those behind the data, in the report, JSON, table and figure, and what cannot be
//! computed is refused with the place in the job.

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

/// A mass on a spring with damping 0.1, whose data have a stiffness of 1.1, and parts of the job.
fn run(name: &str, verb: &str, parts: &str) -> (std::process::Output, PathBuf) {
    let matrices = crate::common::empty_folder("fits", &format!("{name}_matrices"));
    let mut job = String::new();
    for (key, value) in [("mass", 1.0), ("damping", 0.1), ("stiffness", 1.0)] {
        let path = matrices.join(format!("{key}.mtx"));
        fs::write(
            &path,
            format!("%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 {value}\n"),
        )
        .unwrap();
        let _ = writeln!(job, "model.{key} = '{}'", path.display());
    }
    let mut table = String::from("# by hand\nhz, re, im, sigma\n");
    for i in 0..9 {
        let omega = 0.9 + 0.03 * f64::from(i);
        // 0.2 / (a + ib)
        let (a, b) = (1.1 - omega * omega, 0.1 * omega);
        let scale = 0.2 / (a * a + b * b);
        let _ = writeln!(
            table,
            "{}, {}, {}, 0.01",
            omega / std::f64::consts::TAU,
            scale * a,
            -scale * b
        );
    }
    fs::write(matrices.join("test.csv"), table).unwrap();
    job += "[[force]]\ndof = 0\nvalue = 0.2\n";
    job += &parts.replace("FILE", matrices.join("test.csv").to_str().unwrap());
    crate::common::hbvib(verb, ("fits", name), &job)
}

const FIT: &str = "[fit]\nharmonics = 1\ncsv = 'points.csv'\njson = 'fit.json'\nreport = 'fit.txt'\nfigure = 'fit.svg'\n\
                   [[fit.parameter]]\nparameter = 'stiffness'\n[[fit.parameter]]\nparameter = 'damping'\nstart = 1.3\n\
                   [[data]]\nfile = 'FILE'\n";

#[test]
fn a_fit_finds_the_values_behind_its_data() {
    for verb in ["run", "fit"] {
        let (output, folder) = run(verb, verb, FIT);
        let text = crate::common::printed(&output.stdout);
        assert!(
            output.status.success(),
            "{text}{}",
            crate::common::printed(&output.stderr)
        );
        assert!(text.contains("correlations") && text.contains("18 data"), "{text}");
        let json: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(folder.join("fit.json")).unwrap()).unwrap();
        for (k, truth) in [1.1, 1.0].into_iter().enumerate() {
            assert!((json["theta"][k].as_f64().unwrap() - truth).abs() < 1e-6, "{json}");
            assert!(json["deviation"][k].as_f64().unwrap() > 1e-4);
        }
        assert!(json["finished"].as_bool().unwrap());
        let csv = fs::read_to_string(folder.join("points.csv")).unwrap();
        assert_eq!(csv.lines().count(), 10);
        assert!(fs::read_to_string(folder.join("fit.txt")).unwrap().contains("chi2"));
        assert!(
            fs::read_to_string(folder.join("fit.svg"))
                .unwrap()
                .contains("marks of the data")
        );
    }
}

/// A frequency response as a universal file, as an accelerometer or another sensor along or against its axis gives it.
fn universal(quantity: i64, (sensor, hammer): (i64, i64)) -> String {
    let order = [8, 11, 12].iter().position(|known| *known == quantity).unwrap_or(0);
    let sense = if (sensor < 0) == (hammer < 0) { 1.0 } else { -1.0 };
    let mut text = format!("{:>6}\n{:>6}\na sensor\nNONE\nNONE\nNONE\nNONE\n", -1, 58);
    let _ = writeln!(
        text,
        "{:>5}{:>10}{:>5}{:>10} {:<10}{:>10}{sensor:>4} {:<10}{:>10}{hammer:>4}",
        4, 1, 0, 0, "NONE", 1, "NONE", 1
    );
    let _ = writeln!(
        text,
        "{:>10}{:>10}{:>10}{:>13}{:>13}{:>13}",
        6, 9, 0, "0.0e0", "0.0e0", "0.0e0"
    );
    for (kind, label) in [(18, "Frequency"), (quantity, "Response"), (13, "Force"), (0, "NONE")] {
        let _ = writeln!(text, "{kind:>10}{:>5}{:>5}{:>5} {label:<20} {:<20}", 0, 0, 0, "NONE");
    }
    for i in 0..9 {
        let omega = 0.9 + 0.03 * f64::from(i);
        let (a, b) = (1.1 - omega * omega, 0.1 * omega);
        let (mut re, mut im) = (sense * a / (a * a + b * b), -sense * b / (a * a + b * b));
        for _ in 0..order {
            (re, im) = (-omega * im, omega * re);
        }
        let _ = writeln!(text, "{:>13.5e}{re:>20.11e}{im:>20.11e}", omega / std::f64::consts::TAU);
    }
    text + "    -1\n"
}

#[test]
fn universal_files_tell_displacements_along_the_axes() {
    for (k, (quantity, directions)) in [
        (8, (3, 3)),
        (11, (3, 3)),
        (12, (3, 3)),
        (8, (-3, 3)),
        (12, (3, -3)),
        (11, (-3, -3)),
    ]
    .into_iter()
    .enumerate()
    {
        let name = format!("universal_{k}");
        let path = crate::common::empty_folder("fits", &format!("{name}_file")).join("test.uff");
        fs::write(&path, universal(quantity, directions)).unwrap();
        let data = format!("{}'\nfrf_force = 0.2\nsigma = 0.01\n", path.display());
        let (output, folder) = run(&name, "fit", &FIT.replace("FILE'\n", &data));
        assert!(output.status.success(), "{}", crate::common::printed(&output.stderr));
        let json: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(folder.join("fit.json")).unwrap()).unwrap();
        for (k, truth) in [1.1, 1.0].into_iter().enumerate() {
            // Frequencies have six digits.
            assert!(
                (json["theta"][k].as_f64().unwrap() - truth).abs() < 1e-3,
                "{quantity} {directions:?}: {json}"
            );
        }
    }
    let path = crate::common::empty_folder("fits", "universal_force_file").join("test.uff");
    fs::write(&path, universal(13, (3, 3))).unwrap();
    let data = format!("{}'\nfrf_force = 0.2\nsigma = 0.01\n", path.display());
    let (output, _) = run("universal_force", "fit", &FIT.replace("FILE'\n", &data));
    let said = crate::common::printed(&output.stderr);
    assert!(!output.status.success() && said.contains("type 13"), "{said}");
}

#[test]
fn a_fit_that_cannot_be_computed_is_refused_by_its_part() {
    for (name, parts, words) in [
        (
            "unknowns",
            "[fit]\nparameter = []\n[[data]]\nfile = 'FILE'\n".to_owned(),
            "needs [[fit.parameter]]",
        ),
        (
            "data",
            FIT.split("[[data]]").next().unwrap().to_owned(),
            "needs [[data]]",
        ),
        (
            "file",
            FIT.replace("FILE", "nowhere.csv"),
            "nowhere.csv: cannot be read",
        ),
        (
            "column",
            FIT.to_owned() + "kind = 'amplitude'\n",
            "has no column amplitude",
        ),
        (
            "constant",
            FIT.replace("'damping'", "'kt'"),
            "[[fit.parameter]] 2: kt: no contact",
        ),
        ("needs", "[[data]]\nfile = 'FILE'\n".to_owned(), "[[data]] needs [fit]"),
    ] {
        let (output, _) = run(name, "fit", &parts);
        let errors = crate::common::printed(&output.stderr);
        assert!(!output.status.success() && errors.contains(words), "{name}: {errors}");
    }
    let (output, _) = run("none", "fit", "[campbell]\nfrom_rpm = 0\nto_rpm = 1\n");
    assert!(crate::common::printed(&output.stderr).contains("names no fit"));
}
