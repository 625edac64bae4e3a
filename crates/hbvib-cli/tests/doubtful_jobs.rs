//! Jobs whose words have two meanings are refused, or told: nodes without rows, rows of one node and direction, pairs that the right
//! face repeats, normals that the gaps contradict, files without the right names, values other than expected.

use std::path::{Path, PathBuf};
use std::process::Command;

fn data() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .display()
        .to_string()
}

fn printed(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// Exit code, standard output and errors.
fn hbvib(verb: &str, name: &str, job: &str) -> (i32, String, String) {
    let (output, _) = crate::common::hbvib(verb, ("doubtful", name), job);
    (
        output.status.code().unwrap(),
        printed(&output.stdout),
        printed(&output.stderr),
    )
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("doubtful_files").join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

const END: &str = "[forced]\nfrom_hz = 1.0\nto_hz = 2.0\n";

/// The beam of bricks, whose nodes 1, 7, 13 and 19 are clamped, with a contact of one pair of nodes.
fn beam(model: &str, a: i64, b: i64, contact: &str, force: &str) -> String {
    let data = data();
    format!(
        "[model]\nmatrices = '{data}/beam.sti'\nmesh = '{data}/beam.inp'\n{model}\n[[contact]]\nkind = 'friction_3d'\n{contact}\n\
         kt = 1e6\nkn = 1e6\nmu = 0.3\npreload = 1.0\n[contact.nodes]\na = [{a}]\nb = [{b}]\nlargest_distance = 1.0\n\
         [[force]]\ndof = {force}\nvalue = 1.0\n{END}"
    )
}

#[test]
fn a_node_without_rows_is_refused_unless_it_is_said_to_be_fixed() {
    // Node 2 stands over node 8 along y.
    let normal = "normal = [0, -1, 0]";
    let (code, text, errors) = hbvib("check", "present", &beam("", 2, 8, normal, "'3.1'"));
    assert!(code == 0 && text.contains("1 contact"), "{errors}");
    let (code, _, errors) = hbvib("check", "absent", &beam("", 1, 7, normal, "'3.1'"));
    assert_eq!(code, 1);
    for words in ["a[0]: node 1 has no rows", "TIE", "absent = \"fixed\""] {
        assert!(errors.contains(words), "{errors}");
    }
    let (code, _, errors) = hbvib(
        "check",
        "fixed",
        &beam("absent = 'fixed'", 2, 7, "normal = [1, -1, 0]", "'3.1'"),
    );
    assert_eq!(code, 0, "{errors}");
    for (name, model) in [("force", ""), ("force_fixed", "absent = 'fixed'")] {
        let (code, _, errors) = hbvib("check", name, &beam(model, 2, 8, normal, "'1.1'"));
        assert!(
            code == 1 && errors.contains("[[force]] 1: dof = \"1.1\": node 1 has no row"),
            "{errors}"
        );
    }
}

#[test]
fn a_node_with_several_rows_of_a_direction_is_refused_with_the_rows() {
    let folder = folder("rows");
    for file in ["beam.sti", "beam.mas", "beam.inp"] {
        std::fs::copy(Path::new(&data()).join(file), folder.join(file)).unwrap();
    }
    let names = std::fs::read_to_string(Path::new(&data()).join("beam.dof")).unwrap();
    std::fs::write(folder.join("beam.dof"), names.replacen("3.2", "2.2", 1)).unwrap();
    let job = |dof: &str| {
        format!(
            "[model]\nmatrices = '{}/beam.sti'\n[[force]]\ndof = {dof}\nvalue = 1.0\n{END}",
            folder.display()
        )
    };
    let (code, _, errors) = hbvib("check", "rows", &job("'2.2'"));
    assert!(
        code == 1 && errors.contains("node 2 has 2 rows along y: [1, 4]"),
        "{errors}"
    );
    let (code, text, errors) = hbvib("check", "row", &job("4"));
    assert!(
        code == 0 && text.contains("rows that repeat the node and direction of another one: 1"),
        "{text}{errors}"
    );
}

#[test]
fn a_normal_in_the_plane_or_against_the_gap_is_refused() {
    for (name, normal, words) in [
        ("plane_x", "normal = [1, 0, 0]", "in the plane of the contact"),
        ("plane_z", "normal = [0, 0, 1]", "in the plane of the contact"),
        ("wrong", "normal = [0, 1, 0]", "the wrong way"),
    ] {
        let (code, _, errors) = hbvib("check", name, &beam("", 2, 8, normal, "'3.1'"));
        assert!(
            code == 1 && errors.contains("[[contact]] 1: normal") && errors.contains(words),
            "{errors}"
        );
        let any = beam("", 2, 8, normal, "'3.1'").replace("normal = ", "any_normal = true\nnormal = ");
        assert_eq!(hbvib("check", name, &any).0, 0);
        // The same pair by its degrees of freedom: rows 0 to 2 and 15 to 17.
        let (start, end) = (any.find("[contact.nodes]").unwrap(), any.find("[[force]]").unwrap());
        let by_rows = any.replace(&any[start..end], "a = [0, 1, 2]\nb = [15, 16, 17]\n");
        assert_eq!(hbvib("check", name, &by_rows).0, 0);
        let (code, _, errors) = hbvib("check", name, &by_rows.replace("any_normal = true\n", ""));
        assert!(code == 1 && errors.contains(words), "{errors}");
    }
}

/// The sector of one brick between two clamped nodes of each face, with contacts on both faces.
#[test]
fn pairs_of_the_right_face_that_repeat_the_left_are_counted_once() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hbvib-io/tests/data");
    let data = data.display();
    let job = |a: &str, b: &str, name: &str| {
        format!(
            "[model]\nmatrices = '{data}/sector.sti'\nmesh = '{data}/sector.inp'\nsectors = 24\nengine_order = 3\nabsent = 'fixed'\n\
             [model.faces]\nleft = [3, 1, 5, 9, 11, 7]\nright = [12, 4, 8, 2, 10, 6]\n[[contact]]\nname = '{name}'\n\
             kind = 'friction_3d'\nnormal = [0, 0, 1]\nany_normal = true\nkt = 1e6\nkn = 1e6\nmu = 0.3\npreload = 1.0\n[contact.nodes]\n\
             a = [{a}]\nb = [{b}]\nlargest_distance = 1.0\n[[force]]\ndof = '5.3'\nvalue = 1.0\n{END}"
        )
    };
    let frequencies = |job: &str| {
        let (code, text, errors) = hbvib("modes", "repeated", job);
        assert_eq!(code, 0, "{errors}");
        text
    };
    // The images of nodes 3 and 9 are 4 and 10.
    let (left, right, both) = (
        job("9", "3", "left"),
        job("10", "4", "right"),
        job("9, 10", "3, 4", "both"),
    );
    let once = frequencies(&left);
    assert_eq!(once, frequencies(&both));
    let (code, text, _) = hbvib("check", "both", &both);
    assert!(
        code == 0 && text.contains("left out, as images of pairs of the left face: 1 pair"),
        "{text}"
    );
    assert!(text.contains("1 contact"), "{text}");
    // Alone it is kept, and is the same pair of the wheel.
    let (_, text, _) = hbvib("check", "right", &right);
    assert!(text.contains("1 contact") && !text.contains("images"), "{text}");
    let stuck = |text: &str| -> Vec<f64> {
        text.lines()
            .skip(1)
            .map(|line| line.split(',').nth(3).unwrap().parse().unwrap())
            .collect()
    };
    for (a, b) in stuck(&once).iter().zip(stuck(&frequencies(&right))) {
        assert!((a / b - 1.0).abs() < 1e-7, "{a} and {b}");
    }
}

/// A node of one face that is fixed alone: its image is fixed as well, and told.
#[test]
fn a_node_that_is_fixed_on_one_face_is_fixed_on_both() {
    let folder = folder("face");
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../hbvib-io/tests/data");
    let names = std::fs::read_to_string(data.join("sector.dof")).unwrap();
    // Node 3 becomes one without rows: its rows are those of a node that the mesh does not have.
    let renamed: Vec<String> = names
        .lines()
        .map(|line| {
            line.trim()
                .replacen("3.", "103.", usize::from(line.trim().starts_with("3.")))
        })
        .collect();
    std::fs::write(folder.join("sector.dof"), renamed.join("\n") + "\n").unwrap();
    for file in ["sector.sti", "sector.mas", "sector.inp"] {
        std::fs::copy(data.join(file), folder.join(file)).unwrap();
    }
    let job = format!(
        "[model]\nmatrices = '{0}/sector.sti'\nmesh = '{0}/sector.inp'\nsectors = 24\nengine_order = 3\nabsent = 'fixed'\n\
         [model.faces]\nleft = [3, 1, 5, 9, 11, 7]\nright = [12, 4, 8, 2, 10, 6]\n[[force]]\ndof = '5.3'\nvalue = 1.0\n{END}",
        folder.display()
    );
    let (code, text, errors) = hbvib("check", "face", &job);
    assert_eq!(code, 0, "{errors}");
    assert!(
        text.contains("[model.faces]: node 4 is fixed, as its image 3 is"),
        "{text}"
    );
}

/// The pair as Abaqus writes it: node 1 under 1e36, an internal node −1, and no rows without mass in the mass.
#[test]
fn a_pair_of_abaqus_with_a_penalty_has_the_frequencies_of_fixed_nodes() {
    let data = data();
    let job = format!(
        "[model]\nstiffness = '{data}/fixed_by_1e36_STIF1.mtx'\nmass = '{data}/fixed_by_1e36_MASS1.mtx'\n{END}"
    );
    let (code, text, errors) = hbvib("modes", "penalty", &job);
    assert!(code == 0 && errors.is_empty(), "{errors}");
    let expected = [
        7.293_206_54,
        14.586_413_09,
        19.926_884_68,
        30.409_347_34,
        39.853_769_35,
        60.818_694_67,
    ];
    let found: Vec<f64> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(2).unwrap().parse::<f64>().unwrap() * std::f64::consts::TAU)
        .collect();
    assert_eq!(found.len(), 6, "{text}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-8, "{found} and {expected}");
    }
    let (code, text, _) = hbvib("check", "penalty_check", &job);
    assert!(code == 0 && !text.contains("warning"), "{text}");
    assert!(
        text.contains("rows fixed by a diagonal that exceeds all else by 1/epsilon: 2, first 1.1"),
        "{text}"
    );
}

#[test]
fn matrices_of_different_sizes_and_unknown_rows_are_told_with_their_files() {
    let folder = folder("sizes");
    let matrix = |name: &str, n: usize| {
        let entries: String = (1..=n).fold(String::new(), |text, i| text + &format!("{i} {i} 2.0\n"));
        let path = folder.join(name);
        std::fs::write(
            &path,
            format!("%%MatrixMarket matrix coordinate real symmetric\n{n} {n} {n}\n{entries}"),
        )
        .unwrap();
        path.display().to_string()
    };
    let (k, m, g) = (matrix("k.mtx", 4), matrix("m.mtx", 3), matrix("g.mtx", 5));
    let (code, _, errors) = hbvib(
        "check",
        "sizes",
        &format!("[model]\nstiffness = '{k}'\nmass = '{m}'\n{END}"),
    );
    assert_eq!(code, 1);
    for words in ["m.mtx: mass is 3 x 3", "stiffness in", "k.mtx is 4 x 4"] {
        assert!(errors.contains(words), "{errors}");
    }
    let job = format!("[model]\nstiffness = '{k}'\nmass = '{k}'\ngyroscopic = '{g}'\nspeed = 1.0\n{END}");
    let (code, _, errors) = hbvib("check", "gyroscopic", &job);
    assert!(code == 1 && errors.contains("g.mtx: is 5 x 5"), "{errors}");
}

#[test]
fn warnings_are_told_by_run_and_modes_and_refused_if_strict() {
    let folder = folder("unstable");
    std::fs::write(
        folder.join("k.mtx"),
        "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 -4\n2 2 1\n3 3 9\n",
    )
    .unwrap();
    std::fs::write(
        folder.join("m.mtx"),
        "%%MatrixMarket matrix coordinate real symmetric\n3 3 3\n1 1 1\n2 2 1\n3 3 1\n",
    )
    .unwrap();
    let job = format!(
        "[model]\nstiffness = '{0}/k.mtx'\nmass = '{0}/m.mtx'\nrayleigh = [0.1, 0.0]\n[[force]]\ndof = 1\nvalue = 1.0\n\
         [forced]\nfrom_hz = 0.1\nto_hz = 0.2\nharmonics = 1\n",
        folder.display()
    );
    let (code, text, errors) = hbvib("modes", "unstable", &job);
    assert!(
        code == 0 && errors.contains("warning: negative numbers on the diagonal of the stiffness: 1"),
        "{errors}"
    );
    let first: f64 = text.lines().nth(1).unwrap().split(',').nth(2).unwrap().parse().unwrap();
    assert!((first * std::f64::consts::TAU + 2.0).abs() < 1e-9, "{text}");
    let (code, text, _) = hbvib("check", "unstable_check", &job);
    assert!(
        code == 0 && text.contains("warning: the stiffness is negative in some direction: a motion grows as 2.0"),
        "{text}"
    );
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("doubtful/unstable_check/job.toml");
    for verb in ["run", "check", "modes"] {
        let strict = Command::new(env!("CARGO_BIN_EXE_hbvib"))
            .args([verb, "--strict"])
            .arg(&path)
            .output()
            .unwrap();
        assert_eq!(strict.status.code(), Some(1), "{verb}");
        assert!(printed(&strict.stderr).contains("--strict refuses"), "{verb}");
    }
    let (_, text, _) = hbvib(
        "check",
        "expected",
        &job.replace("rayleigh", "expected = { first_hz = 5.0, total_mass = 2 }\nrayleigh"),
    );
    assert!(
        text.contains("5 Hz is expected") && text.contains("expected total mass is not compared"),
        "{text}"
    );
}

/// The matrices of the model and those of the couplings alike.
#[test]
fn a_file_that_may_be_cut_off_within_its_last_number_is_a_warning() {
    let folder = folder("cut");
    let file = |name: &str, value: &str| {
        let path = folder.join(name);
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 {value}");
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let (mass, stiffness) = (file("m.mtx", "1.0\n"), file("k.mtx", "2.0\n"));
    let (cut, coupling) = (file("cut.mtx", "2.0"), file("coupling.mtx", "-0.25"));
    let check = |name: &str, stiffness: &str, coupling: &str| {
        let sector = if coupling.is_empty() {
            String::new()
        } else {
            format!("coupling_stiffness = '{coupling}'\nsectors = 4\nengine_order = 1\n")
        };
        let job = format!(
            "[model]\nstiffness = '{stiffness}'\nmass = '{mass}'\n{sector}[[force]]\ndof = 0\nvalue = 1.0\n{END}"
        );
        hbvib("check", name, &job)
    };
    let told = |(code, text, errors): (i32, String, String)| {
        assert_eq!(code, 0, "{errors}");
        (text + &errors).matches("may be cut off").count()
    };
    assert_eq!(told(check("whole", &stiffness, "")), 0);
    let (code, text, errors) = check("cut", &cut, "");
    assert!(
        code == 0 && (text.clone() + &errors).contains("cut.mtx, line 3: "),
        "{text}{errors}"
    );
    assert!(told(check("cut_again", &cut, "")) >= 1);
    assert!(told(check("cut_coupling", &stiffness, &coupling)) >= 1);
}

/// One mass in a folder of its own: the matrices are files of the job.
fn one_mass(name: &str, model: &str, output: &str) -> (PathBuf, String) {
    let folder = folder(name);
    for (file, value) in [("k.mtx", 2.0), ("m.mtx", 1.0)] {
        let text = format!("%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 {value}\n");
        std::fs::write(folder.join(file), text).unwrap();
    }
    let job = format!(
        "[model]\nstiffness = 'k.mtx'\nmass = 'm.mtx'\nrayleigh = [0.0, 0.02]\n{model}\n[[force]]\ndof = 0\nvalue = 1.0\n\
         [forced]\nfrom_hz = 0.1\nto_hz = 0.4\nharmonics = 1\n[output]\n{output}\n"
    );
    std::fs::write(folder.join("job.toml"), &job).unwrap();
    (folder, job)
}

#[test]
fn no_file_is_written_over_one_that_the_job_reads_or_writes() {
    for (i, (output, words)) in [
        (
            "csv = 'k.mtx'",
            "output.csv = \"k.mtx\" would replace a file that is read by model.stiffness",
        ),
        ("csv = 'job.toml'", "read by the job itself"),
        ("figure = './m.mtx'", "read by model.mass"),
        ("csv = 'link.csv'", "read by model.stiffness"),
        ("csv = 'r.out'\nnpz = './r.out'", "written by output.csv"),
    ]
    .into_iter()
    .enumerate()
    {
        let (folder, job) = one_mass(&format!("replaced_{i}"), "", output);
        let _ = std::fs::remove_file(folder.join("link.csv"));
        #[cfg(unix)]
        std::os::unix::fs::symlink("k.mtx", folder.join("link.csv")).unwrap();
        if output.contains("link") && !cfg!(unix) {
            continue;
        }
        let before = std::fs::read(folder.join("k.mtx")).unwrap();
        let run = crate::common::command(&["run", "job.toml"], &folder);
        let errors = printed(&run.stderr);
        assert!(!run.status.success() && errors.contains(words), "{output}: {errors}");
        assert_eq!(std::fs::read(folder.join("k.mtx")).unwrap(), before);
        assert_eq!(std::fs::read_to_string(folder.join("job.toml")).unwrap(), job);
    }
    let (folder, _) = one_mass("replaced_none", "", "csv = 'r.csv'\nnpz = 'r.npz'");
    for _ in 0..2 {
        let run = crate::common::command(&["run", "job.toml"], &folder);
        assert!(run.status.success(), "{}", printed(&run.stderr));
    }
}

#[test]
fn an_engine_order_without_sectors_is_refused() {
    let (folder, _) = one_mass("order_alone", "engine_order = 2", "csv = 'r.csv'");
    let run = crate::common::command(&["run", "job.toml"], &folder);
    let errors = printed(&run.stderr);
    assert!(
        !run.status.success() && errors.contains("engine_order = 2 without sectors"),
        "{errors}"
    );
}
