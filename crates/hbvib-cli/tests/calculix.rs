//! From a mesh to a response: CalculiX assembles the sector of the book, and its own frequencies of the wheel are those of
//! `hbvib`; faces and degrees of freedom by names of nodes are those by numbers.

use crate::common::{printed, root, run};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Output;

/// A copy of the example, with the matrices of CalculiX.
fn wheel() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("calculix");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    for file in ["mesh.py", "matrices.inp", "cyclic.inp", "job.toml"] {
        std::fs::copy(root().join("examples/jobs/cover_plate").join(file), folder.join(file)).unwrap();
    }
    run("python3", &["mesh.py"], &folder);
    run("ccx", &["matrices"], &folder);
    folder
}

/// Frequencies by diameter, from a column of a table.
fn by_diameter<'a>(rows: impl Iterator<Item = Vec<&'a str>>, column: usize) -> BTreeMap<usize, Vec<f64>> {
    let mut found: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for row in rows {
        let diameter = row[0].parse().unwrap();
        found.entry(diameter).or_default().push(row[column].parse().unwrap());
    }
    found
}

#[test]
fn the_wheel_of_calculix_has_the_frequencies_of_calculix_and_the_response_of_the_book() {
    let folder = wheel();
    run("ccx", &["cyclic"], &folder);
    let hbvib = env!("CARGO_BIN_EXE_hbvib");
    let modes = run(hbvib, &["modes", "job.toml"], &folder);
    let free = by_diameter(modes.lines().skip(1).map(|line| line.split(',').collect()), 2);
    let theirs = std::fs::read_to_string(folder.join("cyclic.dat")).unwrap();
    let rows = theirs.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let eigenvalues = rows.filter(|row| row.len() == 6 && row[..2].iter().all(|word| word.parse::<usize>().is_ok()));
    let theirs = by_diameter(eigenvalues, 4);
    assert_eq!((theirs.len(), free.len()), (5, 13));
    for (diameter, theirs) in &theirs {
        assert_eq!(theirs.len(), 10);
        // Both waves of a diameter have the same frequencies. CalculiX prints seven digits.
        for (k, hertz) in theirs.iter().enumerate() {
            let own = free[diameter][k / 2];
            let gap = (own / hertz - 1.0).abs();
            println!("diameter {diameter}, mode {}: {own:.6} Hz, differs by {gap:.1e}", k / 2);
            assert!(gap < 6e-7, "diameter {diameter}, mode {}: {own} and {hertz}", k / 2);
        }
    }
    let text = run(hbvib, &["run", "job.toml"], &folder);
    // The chapter shows this summary.
    let chapter = std::fs::read_to_string(root().join("docs/from-fe-to-response.md")).unwrap();
    for line in text.lines().filter(|line| !line.starts_with("wrote")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words[0] != "peak" {
            continue;
        }
        let shown = chapter
            .lines()
            .find(|line| line.starts_with("peak "))
            .expect("a peak in the chapter");
        for (a, b) in words.iter().zip(shown.split_whitespace()) {
            if let (Ok(a), Ok(b)) = (a.parse::<f64>(), b.parse::<f64>()) {
                assert!((a / b - 1.0).abs() < 1e-4, "{line}, the chapter has {shown}");
            }
        }
    }
    assert!(text.contains("\npeak "), "{text}");
    for figure in ["response.png", "slip.png"] {
        let file = std::io::BufReader::new(std::fs::File::open(folder.join(figure)).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!(
            (info.width, info.height, info.color_type),
            (900, 600, png::ColorType::Rgb)
        );
        let drawn = pixels.chunks_exact(3).filter(|pixel| *pixel != [255; 3]).count();
        assert!(drawn > 5000, "{figure} has {drawn} pixels that are not white");
    }
}

/// A job on the clamped sector of two bricks; its nodes 1, 2, 7 and 8 do not move.
fn two_bricks(verb: &str, name: &str, faces: &str, rest: &str) -> Output {
    let data = root().join("crates/hbvib-io/tests/data");
    let data = data.display();
    let job = format!(
        "model.matrices = '{data}/sector.sti'\nmodel.mesh = '{data}/sector.inp'\nmodel.engine_order = 3\n{faces}\n\
         [[force]]\nvalue = 1.0\n{rest}\n[forced]\nfrom_hz = 1.0\nto_hz = 2.0\n"
    );
    crate::common::hbvib(verb, ("calculix_faces", name), &job).0
}

#[test]
fn nodes_of_a_face_are_paired_by_position() {
    let by_dofs = "model.sectors = 24\nmodel.faces.left = [[0, 1, 2], [6, 7, 8], [12, 13, 14], [18, 19, 20]]\n\
                   model.faces.right = [[3, 4, 5], [9, 10, 11], [15, 16, 17], [21, 22, 23]]";
    let by_nodes = "model.sectors = 24\nmodel.absent = 'fixed'\nmodel.faces.left = [3, 1, 5, 9, 11, 7]\nmodel.faces.right = [12, 4, 8, 2, 10, 6]";
    let expected = two_bricks("modes", "dofs", by_dofs, "dof = 8");
    let found = two_bricks("modes", "nodes", by_nodes, "dof = '5.3'");
    assert!(
        expected.status.success() && found.status.success(),
        "{}",
        printed(&found.stderr)
    );
    assert!(printed(&found.stdout).lines().count() > 100);
    // Sums in another order differ in the last digits.
    for (a, b) in printed(&found.stdout)
        .lines()
        .zip(printed(&expected.stdout).lines())
        .skip(1)
    {
        let hertz = |line: &str| line.split(',').nth(2).unwrap().parse::<f64>().unwrap();
        assert!((hertz(a) / hertz(b) - 1.0).abs() < 1e-9, "{a} and {b}");
    }
    for (name, faces, dof, words) in [
        (
            "sectors",
            by_nodes.replace("24", "20"),
            "0",
            "has no node of right within",
        ),
        (
            "set",
            by_nodes.replace("[3, 1, 5, 9, 11, 7]", "'LEFT'"),
            "0",
            "there is no set \"LEFT\" in",
        ),
        (
            "unequal",
            by_nodes.replace(", 7]", "]"),
            "0",
            "is the nearest of no node of left",
        ),
        (
            "mixed",
            by_nodes.replace(", 7]", ", [1, 2, 3]]"),
            "0",
            "left[5] names degrees of freedom",
        ),
        (
            "fixed",
            by_nodes.into(),
            "'1.3'",
            "dof = \"1.3\": node 1 has no row along z",
        ),
        (
            "absent",
            by_nodes.replace("'fixed'", "'refused'"),
            "0",
            "left[1]: node 1 has no rows in the matrices: it may be fixed, or follow others by a constraint (MPC, TIE",
        ),
        ("unknown", by_nodes.into(), "'99.3'", "node 99 is not in the matrices"),
        ("several", by_nodes.into(), "'ALL.3'", "the set has 12 nodes"),
    ] {
        let output = two_bricks("check", name, &faces, &format!("dof = {dof}"));
        let errors = printed(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{name}: {errors}");
        assert!(errors.contains(words), "{name}: {errors}");
    }
}
