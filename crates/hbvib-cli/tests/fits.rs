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

/// A MATLAB file of version 5 with vectors, the imaginary part none for real numbers.
fn matlab(vectors: &[(&str, Vec<f64>, Vec<f64>)]) -> Vec<u8> {
    let mut file = format!("{:<116}", "MATLAB 5.0 MAT-file").into_bytes();
    file.extend([0; 8]);
    file.extend([0, 1, b'I', b'M']);
    let element = |kind: u32, body: &[u8]| {
        let mut bytes = kind.to_le_bytes().to_vec();
        bytes.extend(u32::try_from(body.len()).unwrap().to_le_bytes());
        bytes.extend(body);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let numbers = |values: &[f64]| element(9, &values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>());
    for (name, real, imaginary) in vectors {
        let class = if imaginary.is_empty() { 6_u32 } else { 6 | 0x0800 };
        let mut body = element(6, &[class.to_le_bytes(), [0; 4]].concat());
        let rows = u32::try_from(real.len()).unwrap();
        body.extend(element(5, &[rows.to_le_bytes(), 1_u32.to_le_bytes()].concat()));
        body.extend(element(1, name.as_bytes()));
        body.extend(numbers(real));
        if !imaginary.is_empty() {
            body.extend(numbers(imaginary));
        }
        file.extend(element(14, &body));
    }
    file
}

#[test]
fn vectors_of_matlab_have_their_deviations_from_coherence() {
    let (mut hz, mut re, mut im) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..9 {
        let omega = 0.9 + 0.03 * f64::from(i);
        let (a, b) = (1.1 - omega * omega, 0.1 * omega);
        hz.push(omega / std::f64::consts::TAU);
        re.push(0.2 * a / (a * a + b * b));
        im.push(-0.2 * b / (a * a + b * b));
    }
    // σ = |X| (0.2 / (0.8 · 25))^½ = 0.1 |X|
    let vectors = [
        ("hz", hz, vec![]),
        ("response", re, im),
        ("coherence", vec![0.8; 9], vec![]),
        ("temperature", vec![20.0; 3], vec![]),
    ];
    let path = crate::common::empty_folder("fits", "matlab_file").join("test.mat");
    fs::write(&path, matlab(&vectors)).unwrap();
    let mut deviations = Vec::new();
    for key in ["averages = 25.0", "sigma = 0.1"] {
        let data = format!("{}'\n{key}\n", path.display());
        let (output, folder) = run(&format!("matlab_{}", key.len()), "fit", &FIT.replace("FILE'\n", &data));
        assert!(output.status.success(), "{}", crate::common::printed(&output.stderr));
        let json: serde_json::Value =
            serde_json::from_str(&fs::read_to_string(folder.join("fit.json")).unwrap()).unwrap();
        assert!((json["theta"][0].as_f64().unwrap() - 1.1).abs() < 1e-6, "{json}");
        deviations.push(json["deviation"][0].as_f64().unwrap());
    }
    assert!((deviations[0] / deviations[1] - 1.0).abs() < 1e-9, "{deviations:?}");
    let data = format!("{}'\naverages = 1.0\n", path.display());
    let (output, _) = run("matlab_one", "fit", &FIT.replace("FILE'\n", &data));
    let said = crate::common::printed(&output.stderr);
    assert!(
        !output.status.success() && said.contains("averages = 1, needs"),
        "{said}"
    );
}

#[test]
fn a_mode_of_a_universal_file_is_a_datum() {
    let mut text = format!("{:>6}\n{:>6}\nbending\nNONE\nNONE\nNONE\nNONE\n", -1, 55);
    text += "         1         2         3         8         2         3\n         2         4         1         2\n";
    let hz = 1.1_f64.sqrt() / std::f64::consts::TAU;
    let _ = writeln!(text, "{hz:>13.5e}{:>13}{:>13}{:>13}", "1.0e0", "2.0e-2", "0.0e0");
    text += "         7\n        1.0e0        0.0e0        0.0e0\n    -1\n";
    let path = crate::common::empty_folder("fits", "mode_file").join("modes.uff");
    fs::write(&path, text).unwrap();
    let job = format!(
        "[[contact]]\nkind = 'jenkins'\na = [0]\nb = [-1]\nkt = 0.2\nmu = 0.3\npreload = 1.0\n\
         [fit]\nharmonics = 1\njson = 'fit.json'\n[[fit.parameter]]\nparameter = 'stiffness'\ndata_set = 0\n\
         [[data]]\nkind = 'linear_mode'\nfile = '{}'\ntest_mode = 2\nsigma = 1e-4\n",
        path.display()
    );
    let (output, folder) = run("mode", "fit", &job);
    let text = crate::common::printed(&output.stdout);
    assert!(output.status.success(), "{}", crate::common::printed(&output.stderr));
    assert!(text.contains("of data set 1"), "{text}");
    let json: serde_json::Value = serde_json::from_str(&fs::read_to_string(folder.join("fit.json")).unwrap()).unwrap();
    // Stiffness and contact together are 1.1.
    assert!((json["theta"][0].as_f64().unwrap() - 0.9).abs() < 1e-4, "{json}");
    let other = job.replace("test_mode = 2", "test_mode = 3");
    let (output, _) = run("mode_3", "fit", &other);
    let said = crate::common::printed(&output.stderr);
    assert!(!output.status.success() && said.contains("no mode"), "{said}");
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
