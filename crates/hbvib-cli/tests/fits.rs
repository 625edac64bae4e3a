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

/// A NumPy archive with vectors, as numpy.savez writes it: a zip file whose members are stored without compression.
fn archive(vectors: &[(&str, Vec<f64>)]) -> Vec<u8> {
    let checksum = |bytes: &[u8]| {
        !bytes.iter().fold(!0_u32, |sum, byte| {
            (0..8).fold(sum ^ u32::from(*byte), |c, _| {
                (c >> 1) ^ (0xEDB8_8320 & (c & 1).wrapping_neg())
            })
        })
    };
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for (name, values) in vectors {
        let mut head = format!(
            "{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}",
            values.len()
        );
        let length = (head.len() + 11).next_multiple_of(64) - 10;
        head = format!("{head:<0$}\n", length - 1);
        let mut member = b"\x93NUMPY\x01\x00".to_vec();
        member.extend(u16::try_from(head.len()).unwrap().to_le_bytes());
        member.extend(head.as_bytes());
        member.extend(values.iter().flat_map(|x| x.to_le_bytes()));
        let name = format!("{name}.npy");
        let (size, start) = (u32::try_from(member.len()).unwrap(), u32::try_from(file.len()).unwrap());
        // Version, flags, method, time and date, then what both headers have.
        let mut common = [20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0].to_vec();
        for number in [checksum(&member), size, size] {
            common.extend(number.to_le_bytes());
        }
        common.extend(u16::try_from(name.len()).unwrap().to_le_bytes());
        common.extend([0; 2]);
        file.extend(b"PK\x03\x04");
        file.extend(&common);
        file.extend(name.as_bytes());
        file.extend(member);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(common);
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (size, start) = (
        u32::try_from(directory.len()).unwrap(),
        u32::try_from(file.len()).unwrap(),
    );
    let count = u16::try_from(vectors.len()).unwrap().to_le_bytes();
    file.extend(directory);
    file.extend(b"PK\x05\x06\0\0\0\0");
    file.extend([count, count].concat());
    file.extend(size.to_le_bytes());
    file.extend(start.to_le_bytes());
    file.extend([0; 2]);
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

/// e^{−Dωt} cos(ω (1 − D²)^½ t) of the mass on stiffness and contact, 1.2 together, with damping 0.02; its derivatives by time; and a history
/// of a universal file.
#[test]
fn a_decay_is_a_backbone() {
    let omega = 1.2_f64.sqrt();
    let decay = num_complex::Complex64::new(-0.01, (1.2_f64 - 1e-4).sqrt());
    assert!((decay.norm() - omega).abs() < 1e-12);
    let folder = crate::common::empty_folder("fits", "decay_files");
    for (order, quantity) in [(0, 8), (1, 11), (2, 12)] {
        let mut table = String::from("time, signal\n");
        let mut history = universal(quantity, (3, 3));
        let mut samples = Vec::new();
        for i in 0..3000 {
            let t = 0.05 * f64::from(i);
            let x = (0.3 * decay.powi(order) * (decay * t).exp()).re;
            let _ = writeln!(table, "{t}, {x:.17e}");
            samples.push((t, x));
        }
        // The numbers of the frequency response give way to those of a history, type 1.
        let head: Vec<&str> = history.lines().take(13).collect();
        history = head
            .join("\n")
            .replacen("    4         1    0", "    1         1    0", 1)
            + "\n";
        history = history.replacen("         6         9", "         6      3000", 1);
        for (t, x) in &samples {
            let _ = writeln!(history, "{t:>13.5e}{x:>20.11e}{:>20.11e}", 0.0);
        }
        history += "    -1\n";
        let (csv, uff) = (folder.join(format!("{order}.csv")), folder.join(format!("{order}.uff")));
        fs::write(&csv, table).unwrap();
        fs::write(&uff, history).unwrap();
        let named = format!("component = {order}\n");
        let mut files = vec![(csv, named.clone()), (uff, String::new())];
        if order == 0 {
            let (time, signal): (Vec<f64>, Vec<f64>) = samples.iter().copied().unzip();
            let (mat, npz) = (folder.join("0.mat"), folder.join("0.npz"));
            fs::write(&npz, archive(&[("time", time.clone()), ("signal", signal.clone())])).unwrap();
            fs::write(&mat, matlab(&[("time", time, vec![]), ("signal", signal, vec![])])).unwrap();
            files.extend([(mat, named.clone()), (npz, named)]);
        }
        for (path, component) in files {
            let kind = path.extension().unwrap().to_str().unwrap();
            let job = format!(
                "[[contact]]\nkind = 'jenkins'\na = [0]\nb = [-1]\nkt = 0.2\nmu = 0.3\npreload = 1.0\n\
                 [fit]\nharmonics = 1\njson = 'fit.json'\nfigure = 'fit.svg'\nresidual_figure = 'residuals.svg'\n\
                 [[fit.parameter]]\nparameter = 'stiffness'\n[[fit.parameter]]\nparameter = 'damping'\n\
                 [[data]]\nkind = 'decay'\nfile = '{}'\ncycles = 4\n{component}",
                path.display()
            );
            let (output, folder) = run(&format!("decay_{order}_{kind}"), "fit", &job);
            assert!(output.status.success(), "{}", crate::common::printed(&output.stderr));
            let json: serde_json::Value =
                serde_json::from_str(&fs::read_to_string(folder.join("fit.json")).unwrap()).unwrap();
            // The frequency of the damped motion, that of the mode times (1 - D^2)^1/2, would give a stiffness of 0.9999. The model has a
            // damping of 0.1.
            for (k, (truth, allowed)) in [(1.0, 3e-5), (0.2, 2e-4)].into_iter().enumerate() {
                let theta = json["theta"][k].as_f64().unwrap();
                assert!((theta / truth - 1.0).abs() < allowed, "{order} {kind}: {json}");
            }
            let figure = fs::read_to_string(folder.join("fit.svg")).unwrap();
            assert!(figure.contains("log10 of the modal amplitude") && figure.matches("<circle").count() > 3);
            let residuals = fs::read_to_string(folder.join("residuals.svg")).unwrap();
            assert_eq!(
                residuals.matches("<circle").count(),
                usize::try_from(json["data"].as_u64().unwrap()).unwrap()
            );
        }
    }
    let data = "[fit]\n[[fit.parameter]]\nparameter = 'stiffness'\n[[data]]\nkind = 'decay'\nfile = 'FILE'\n";
    for (name, keys, words) in [
        ("column", "", "has no column time"),
        ("cycles", "cycles = 1\n", "cycles = 1, needs at least 2"),
        ("shape", "shape = 0.0\n", "shape = 0, needs"),
        ("component", "component = 3\n", "component = 3, needs 0"),
        ("long", "cycles = 4000\n", "too few zero crossings"),
    ] {
        let file = if name == "column" {
            "FILE".to_owned()
        } else {
            folder.join("0.csv").display().to_string()
        };
        let (output, _) = run(&format!("decay_{name}"), "fit", &(data.replace("FILE", &file) + keys));
        let said = crate::common::printed(&output.stderr);
        assert!(!output.status.success() && said.contains(words), "{name}: {said}");
    }
}

/// Data that lie far from the model are within the axes, and the legend is beside them.
#[test]
fn figures_hide_no_data() {
    let two = FIT.replace(
        "figure = 'fit.svg'",
        "figure = 'fit.svg'\nresidual_figure = 'residuals.svg'",
    ) + "[[data]]\nfile = 'FILE'\nforce = 1.5\n";
    let (output, folder) = run("two_sets", "fit", &two);
    assert!(output.status.success(), "{}", crate::common::printed(&output.stderr));
    for (name, marks) in [("fit.svg", 18), ("residuals.svg", 36)] {
        let svg = fs::read_to_string(folder.join(name)).unwrap();
        let number = |line: &str, key: &str| {
            let text = line
                .split(&format!(" {key}=\""))
                .nth(1)
                .unwrap()
                .split('"')
                .next()
                .unwrap();
            text.parse::<f64>().unwrap()
        };
        let circles: Vec<&str> = svg.lines().filter(|line| line.contains("<circle")).collect();
        assert_eq!(circles.len(), marks, "{name}");
        let right = circles.iter().map(|line| number(line, "cx")).fold(0.0, f64::max);
        let names: Vec<&str> = svg.lines().collect();
        let place = names.iter().position(|line| line.trim() == "data set 1").unwrap();
        assert!(number(names[place - 1], "x") > right, "{name}");
        let inside = |y: f64| y > 0.0 && y < 600.0;
        assert!(circles.iter().all(|line| inside(number(line, "cy"))), "{name}");
    }
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

#[test]
fn a_fit_that_ends_early_names_its_own_option() {
    let parts = FIT.replace("harmonics = 1", "harmonics = 1\nmax_iterations = 1");
    let (output, folder) = run("early", "fit", &parts);
    let text = crate::common::printed(&output.stdout);
    assert!(
        text.contains("the search ended early: max_iterations was reached"),
        "{text}"
    );
    assert!(!text.contains("max_points"), "{text}");
    assert!(text.contains("\n1 iterations from"), "{text}");
    let json = fs::read_to_string(folder.join("fit.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["finished"].as_bool(), Some(false));
    let (output, _) = run(
        "no_iterations",
        "fit",
        &FIT.replace("harmonics = 1", "harmonics = 1\nmax_iterations = 0"),
    );
    let told = crate::common::printed(&output.stderr);
    assert!(
        !output.status.success() && told.contains("max_iterations = 0, needs 1 .. 10000"),
        "{told}"
    );
}
