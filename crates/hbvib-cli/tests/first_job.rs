//! Jobs that `init` writes: they run without a change, from matrices and from a mesh of gmsh's kind, and `convert` brings matrices from
//! one format to another.

use crate::common::{command, empty_folder, printed, root};
use std::path::Path;
use std::process::Command;

fn done(arguments: &[&str], folder: &Path) -> String {
    let output = command(arguments, folder);
    let (text, errors) = (printed(&output.stdout), printed(&output.stderr));
    assert!(output.status.success(), "{arguments:?}: {text}{errors}");
    text
}

/// The number after a word.
fn number(text: &str, word: &str) -> f64 {
    let rest = text.split(word).nth(1).unwrap_or_else(|| panic!("{text} lacks {word}"));
    rest.split_whitespace().next().unwrap().parse().unwrap()
}

#[test]
fn a_job_from_two_matrices_runs() {
    let folder = empty_folder("first_job", "matrices");
    for file in ["stiffness.mtx", "mass.mtx"] {
        std::fs::copy(root().join("examples/jobs/ring_damper").join(file), folder.join(file)).unwrap();
    }
    let arguments = ["init", "--stiffness", "stiffness.mtx", "--mass", "mass.mtx"];
    let text = done(&arguments, &folder);
    assert!(text.contains("wrote job.toml: 4 degrees of freedom"), "{text}");
    let modes = done(&["modes", "job.toml"], &folder);
    let first: f64 = modes
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .nth(2)
        .unwrap()
        .parse()
        .unwrap();
    assert!((number(&text, "frequency ") / first - 1.0).abs() < 1e-6);
    let summary = done(&["run", "job.toml"], &folder);
    assert!((number(&summary, "peak ") / first - 1.0).abs() < 1e-4, "{summary}");
    for file in ["response.csv", "response.npz", "response.svg"] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    // The damping ratio at the peak is 0.001: the response is that of the mode, φ²/(2 D ω²).
    let job = std::fs::read_to_string(folder.join("job.toml")).unwrap();
    assert!(
        job.contains("damping ratio 0.001") && job.contains("# [[contact]]"),
        "{job}"
    );
    // A job that is there is kept.
    let output = command(&arguments, &folder);
    assert!(output.status.code() == Some(1) && printed(&output.stderr).contains("--overwrite"));
    done(&[&arguments[..], &["--overwrite"]].concat(), &folder);
    // Another folder has the path of the matrices.
    done(&[&arguments[..], &["-o", "sub/other.toml"]].concat(), &folder);
    assert_eq!(done(&["modes", "sub/other.toml"], &folder), modes);
    for (arguments, words) in [
        (&["init"][..], "needs --stiffness and --mass"),
        (&["init", "--stiffness", "stiffness.mtx"], "--mass"),
        (
            &["init", "--matrices", "none.sti", "-o", "a.toml"],
            "none.dof: is missing",
        ),
        (
            &["init", "--mesh", "none.inp", "-o", "a.toml"],
            "none.inp: cannot be read",
        ),
    ] {
        let output = command(arguments, &folder);
        let errors = printed(&output.stderr);
        assert!(
            output.status.code() == Some(1) && errors.contains(words),
            "{arguments:?}: {errors}"
        );
    }
}

/// The mesh of the cover plate with what gmsh adds: surface elements, whose sets are no sets of nodes.
fn mesh(folder: &Path) {
    let script = root().join("examples/jobs/cover_plate/mesh.py");
    let output = Command::new("python3")
        .arg(script)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success());
    let text = std::fs::read_to_string(folder.join("mesh.inp")).unwrap();
    let bore = text.split("*NSET, NSET=BORE\n").nth(1).unwrap();
    let bore = bore.split('*').next().unwrap();
    let nodes: Vec<&str> = bore.split([',', ' ', '\n']).filter(|word| !word.is_empty()).collect();
    let lines: Vec<String> = nodes
        .iter()
        .enumerate()
        .map(|(i, node)| format!("{}, {node}, {node}", 900_001 + i))
        .collect();
    let without = text.replace(&format!("*NSET, NSET=BORE\n{bore}"), "");
    assert_ne!(without, text);
    let more = format!("*ELEMENT, TYPE=T3D2, ELSET=Bore\n{}\n", lines.join("\n"));
    std::fs::write(folder.join("wheel.inp"), without + &more).unwrap();
}

#[test]
fn a_job_from_a_mesh_alone_runs() {
    let folder = empty_folder("first_job", "mesh");
    mesh(&folder);
    let arguments = [
        "init",
        "--mesh",
        "wheel.inp",
        "--fixed",
        "BORE",
        "--sectors",
        "24",
        "--engine-order",
        "3",
        "--contact",
        "PLATE_RIM:DISK_RIM",
    ];
    let text = done(&arguments, &folder);
    // The frequency of CalculiX itself, on the page of the example.
    assert!(text.contains("ccx wheel_matrices made"), "{text}");
    assert!((number(&text, "frequency ") - 609.9509).abs() < 1e-4, "{text}");
    let job = std::fs::read_to_string(folder.join("job.toml")).unwrap();
    assert!(job.contains("normal = [0.000000, 0.000000, 1.000000]"), "{job}");
    let check = done(&["check", "job.toml"], &folder);
    assert!(
        check.contains("1545 degrees of freedom, 24 sectors, engine order 3, 4 contacts"),
        "{check}"
    );
    let summary = done(&["run", "job.toml"], &folder);
    assert!(
        summary.contains("peak ") && folder.join("motion/motion_0_000.vtu").is_file(),
        "{summary}"
    );
    // The matrices are there: CalculiX is not needed again.
    let again = [&arguments[..], &["--overwrite", "--ccx", "no_such_program"]].concat();
    assert!(!done(&again, &folder).contains("made"));
    assert_eq!(std::fs::read_to_string(folder.join("job.toml")).unwrap(), job);
    for (more, words) in [
        (
            &["--young", "1e11", "--ccx", "no_such_program"][..],
            "no_such_program is not found",
        ),
        (&["--left", "LINKS"], "there is no set LINKS in wheel.inp"),
        (&["--fixed", "HUB"], "--fixed HUB: there is no such set"),
        (&["--contact", "RING"], "needs two sets of nodes as A:B"),
        (&["--contact", "RING:RIM"], "there is no set \"RING\""),
    ] {
        let output = command(&[&arguments[..], &["-o", "other.toml"], more].concat(), &folder);
        let errors = printed(&output.stderr);
        assert!(
            output.status.code() == Some(1) && errors.contains(words),
            "{more:?}: {errors}"
        );
        assert!(!folder.join("other.toml").exists());
    }
}

#[test]
fn matrices_survive_all_formats() {
    let folder = empty_folder("first_job", "convert");
    let data = root().join("crates/hbvib-io/tests/data");
    for extension in ["sti", "mas", "dof"] {
        let file = Path::new("sector").with_extension(extension);
        std::fs::copy(data.join(&file), folder.join(&file)).unwrap();
    }
    let modes = |files: &str| -> Vec<f64> {
        std::fs::write(folder.join("job.toml"), format!("[model]\n{files}\n")).unwrap();
        let text = done(&["modes", "job.toml"], &folder);
        let hertz = text
            .lines()
            .skip(1)
            .map(|line| line.split(',').nth(2).unwrap().parse().unwrap());
        hertz.collect()
    };
    let expected = modes("matrices = 'sector.sti'");
    for (name, more) in [
        ("a.op4", &[][..]),
        ("b.op4", &["--format", "op4-binary"]),
        ("c.pch", &[]),
        ("d.inp", &[]),
        ("e.npz", &[]),
    ] {
        let text = done(&[&["convert", "sector.sti", "--output", name], more].concat(), &folder);
        assert!(text.contains(&format!("wrote {name}")), "{text}");
        let found = modes(&format!("matrices = '{name}'"));
        let most = expected
            .iter()
            .zip(&found)
            .map(|(a, b)| (a / b - 1.0).abs())
            .fold(0.0, f64::max);
        // DMIG has nine digits.
        let digits = if name.ends_with("pch") { 1e-6 } else { 1e-10 };
        assert!(found.len() == expected.len() && most < digits, "{name}: {most:e}");
    }
    let text = done(&["convert", "e.npz", "--output", "f.mtx"], &folder);
    assert!(
        text.contains("wrote f_stiffness.mtx") && text.contains("wrote f_mass.mtx"),
        "{text}"
    );
    let found = modes("stiffness = 'f_stiffness.mtx'\nmass = 'f_mass.mtx'");
    assert!(expected.iter().zip(&found).all(|(a, b)| (a / b - 1.0).abs() < 1e-10));
    for (arguments, words) in [
        (&["convert", "sector.sti", "--output", "a.op4"][..], "--overwrite"),
        (
            &["convert", "sector.sti", "--output", "a.xyz"],
            "a.xyz: the name tells no format",
        ),
        (
            &["convert", "sector.sti", "--output", "g.op4", "--format", "op5"],
            "--format op5 is none of op4, op4-binary",
        ),
        (&["convert", "--output", "g.op4"], "required arguments"),
    ] {
        let output = command(arguments, &folder);
        let errors = printed(&output.stderr);
        assert!(
            output.status.code() == Some(1) && errors.contains(words),
            "{arguments:?}: {errors}"
        );
    }
}
