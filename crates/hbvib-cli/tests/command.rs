//! The command on the ring damper, on jobs with mistakes, and ended by Ctrl-C.

use hbvib::{Contact, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, SolverOptions, forced_response};
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn jobs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/jobs/ring_damper")
}

/// A folder with the files of the job and a changed job.
fn job(name: &str, change: impl FnOnce(String) -> String) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    for file in ["stiffness.mtx", "coupling.mtx", "mass.mtx"] {
        std::fs::copy(jobs().join(file), folder.join(file)).unwrap();
    }
    let text = std::fs::read_to_string(jobs().join("job.toml")).unwrap();
    let text = text.replace("../../../target/ring_damper_job/", "");
    let path = folder.join("job.toml");
    std::fs::write(&path, change(text)).unwrap();
    path
}

fn hbvib(verb: &str, path: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .arg(verb)
        .arg(path)
        .output()
        .unwrap()
}

fn printed(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// The same model in Rust.
fn ring_damper() -> Model {
    let mut model = Model::cyclic(4, 24).unwrap();
    let mut k = [0.0; 16];
    let mut spring = |i: usize, j: usize, stiffness: f64| {
        for (at, sign) in [(5 * i, 1.0), (5 * j, 1.0), (4 * i + j, -1.0), (4 * j + i, -1.0)] {
            k[at] += sign * stiffness;
        }
    };
    spring(0, 1, 2e6);
    spring(1, 2, 1e6);
    k[10] += 6e5 + 2.0 * 5e7;
    k[15] += 2.0 * 2e7;
    let (mut m, mut next) = ([0.0; 16], [0.0; 16]);
    (m[0], m[5], m[10], m[15]) = (0.2, 0.3, 1.2, 0.03);
    (next[10], next[15]) = (-5e7, -2e7);
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(4, &k))
        .unwrap();
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(4, &m)).unwrap();
    model
        .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(4, &next))
        .unwrap();
    model.set_rayleigh(0.0, 1.5e-6).unwrap();
    model.set_wave(2);
    let load = 0.03 * 0.165 * (3000.0 * 2.0 * PI / 60.0_f64).powi(2);
    model
        .add_contact(&Contact::jenkins(2, Some(3), 5e7, 0.3, load))
        .unwrap();
    for dof in [0, 1] {
        model.add_force(dof, 1, 5.0.into()).unwrap();
    }
    model
}

#[test]
fn the_ring_damper_has_the_peaks_of_the_library() {
    let path = job("run", |text| text);
    let output = hbvib("run", &path);
    let (text, errors) = (printed(&output.stdout), printed(&output.stderr));
    assert!(output.status.success() && errors.is_empty(), "{text}{errors}");
    let solver = SolverOptions {
        tolerance: 1e-6,
        ..SolverOptions::default()
    };
    let range = ForcedOptions {
        omega_start: TAU * 207.0,
        omega_stop: TAU * 211.0,
        ..ForcedOptions::default()
    };
    let branch = forced_response(&ring_damper(), &solver, &range, &mut Hooks::default()).unwrap();
    assert!(!branch.peaks().is_empty());
    // The peak of 511 harmonics, to all digits that are printed.
    assert!(text.contains("208.841140 Hz    1.361714e-3"), "{text}");
    for peak in branch.peaks() {
        let line = format!("peak   {:>14.6} Hz {:>14.6e}", peak.omega / TAU, peak.amplitude);
        assert!(text.contains(&line), "{text} lacks {line}");
    }
    let folder = path.parent().unwrap();
    let csv = std::fs::read_to_string(folder.join("response.csv")).unwrap();
    let last: Vec<f64> = csv
        .lines()
        .last()
        .unwrap()
        .split(',')
        .map(|x| x.parse().unwrap())
        .collect();
    assert_eq!(csv.lines().count(), branch.points() + 1);
    assert!((last[1] / branch.amplitude()[branch.points() - 1] - 1.0).abs() < 1e-9);
    let svg = std::fs::read_to_string(folder.join("response.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("frequency, Hz"));
    read_by_numpy(folder, branch.points(), branch.harmonics() + 1);
}

#[test]
fn folders_of_outputs_are_made() {
    let path = job("new_folders", |text| {
        text.replace("tolerance = 1e-6", "harmonics = 1")
            .replace("response.", "new/folder/response.")
    });
    let output = hbvib("run", &path);
    assert!(output.status.success(), "{}", printed(&output.stderr));
    for extension in ["csv", "npz", "svg"] {
        let file = path.with_file_name("new/folder/response.").with_extension(extension);
        assert!(file.is_file(), "{}", file.display());
    }
}

/// The archive as numpy sees it.
fn read_by_numpy(folder: &Path, points: usize, rows: usize) {
    let program = "print(*f['harmonics'].shape, abs(abs(f['harmonics'][:, 1, 0]) / f['amplitude'] - 1).max() < 1e-12, \
                   len(f['peaks']) > 0)";
    read_by_numpy_with(folder, program, &format!("{points} {rows} 4 True True"));
}

/// Runs a program on the archive `f` and compares what it prints.
fn read_by_numpy_with(folder: &Path, program: &str, expected: &str) {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.venv/bin/python");
    let python = if own.exists() { own } else { "python3".into() };
    let program = format!("import numpy as np; f = np.load('response.npz'); {program}");
    let output = Command::new(python)
        .args(["-c", &program])
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", printed(&output.stderr));
    assert_eq!(printed(&output.stdout).trim_end(), expected);
}

#[test]
fn mistakes_are_told_on_standard_error_with_a_code() {
    for (name, from, to, words) in [
        (
            "key",
            "stiffness =",
            "stifness =",
            &["unknown field `stifness`", "did you mean `stiffness`?", "line 5"][..],
        ),
        (
            "section",
            "[forced]",
            "[force_d]",
            &["unknown field `force_d`", "did you mean `force"],
        ),
        (
            "kind",
            "\"jenkins\"",
            "\"jenkin\"",
            &["unknown variant `jenkin`", "did you mean `jenkins`?"],
        ),
        ("type", "from_hz = 207.0", "from_hz = \"207\"", &["expected", "from_hz"]),
        ("file", "mass.mtx", "mass2.mtx", &["mass2.mtx: cannot be read"]),
        (
            "dof",
            "a = [2]",
            "a = [4]",
            &["[[contact]] 1", "dof_a[0] = 4", "0 .. 3"],
        ),
        ("same", "b = [3]", "b = [2]", &["[[contact]] 1", "two different sides"]),
        ("pairs", "b = [3]", "b = [3, 1]", &["b has 2 numbers"]),
        ("force", "dof = 1", "dof = 9", &["[[force]] 2", "dof = 9"]),
        (
            "range",
            "tolerance = 1e-6",
            "tolerance = 1e-6\nresponse_dof = 7",
            &["[forced]", "response_dof = 7"],
        ),
        (
            "nothing",
            "[forced]\nfrom_hz = 207.0\nto_hz = 211.0\ntolerance = 1e-6",
            "",
            &["names no analysis"],
        ),
    ] {
        let path = job(name, |text| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        let output = hbvib("run", &path);
        let errors = printed(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{name}: {errors}");
        assert!(output.stdout.is_empty(), "{name}");
        for word in words {
            assert!(errors.contains(word), "{name}: {errors}");
        }
    }
    let output = Command::new(env!("CARGO_BIN_EXE_hbvib")).arg("fly").output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(printed(&output.stderr).contains("usage"));
}

#[test]
fn check_and_modes_report_without_solving() {
    let path = job("check", |text| text);
    let output = hbvib("check", &path);
    let text = printed(&output.stdout);
    assert!(output.status.success());
    assert!(
        text.contains("4 degrees of freedom, 24 sectors, engine order 2, 1 contact, 2 forces"),
        "{text}"
    );
    let output = hbvib("modes", &path);
    let text = printed(&output.stdout);
    assert!(output.status.success());
    assert_eq!(text.lines().count(), 1 + 13 * 4);
    let omega = ring_damper()
        .lowest_modes(2, hbvib::ContactState::Stuck, 1)
        .unwrap()
        .omega[0];
    let row = text.lines().find(|line| line.starts_with("2,0,")).unwrap();
    let stuck: f64 = row.split(',').nth(3).unwrap().parse().unwrap();
    assert!((stuck * TAU / omega - 1.0).abs() < 1e-9);
}

#[test]
fn a_nonlinear_mode_is_a_job_too() {
    let path = job("mode", |text| {
        let start = text.find("[forced]").unwrap();
        let end = text.find("[output]").unwrap();
        format!(
            "{}[mode]\nindex = 0\nlog10_from = -6.0\nlog10_to = -3.0\nharmonics = 3\n\n{}",
            &text[..start],
            &text[end..]
        )
    });
    let output = hbvib("run", &path);
    assert!(output.status.success(), "{}", printed(&output.stderr));
    let csv = std::fs::read_to_string(path.with_file_name("response.csv")).unwrap();
    assert!(csv.starts_with("frequency_hz,amplitude,slip_fraction,harmonics,log10_amplitude,damping_ratio\n"));
    assert!(csv.lines().count() > 10);
}

/// Runs the command on a terminal of its own, which `script` of util-linux opens; other tests have pipes.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_has_a_progress_bar() {
    let path = job("terminal", |text| text);
    let command = format!("{} run {}", env!("CARGO_BIN_EXE_hbvib"), path.display());
    let output = Command::new("script").args(["-qec", &command, "/dev/null"]).output();
    let output = output.expect("`script` (Debian: apt-get install bsdutils)");
    let text = printed(&output.stdout);
    assert!(output.status.success(), "{text}");
    assert!(text.contains("\r[#") && text.contains("] 100 %"), "{text}");
    assert!(text.contains("\npeak "), "{text}");
}

/// Ended by SIGINT, the run keeps what it found: rows of whole numbers, and an archive with as many points.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_a_readable_result() {
    // Minutes of work.
    let at: Vec<String> = (0..100_000)
        .map(|i| format!("{:.6}", 207.0 + 4e-5 * f64::from(i)))
        .collect();
    let path = job("interrupted", |text| {
        let harmonics = format!("harmonics = 255\nat_hz = [{}]", at.join(", "));
        text.replace("tolerance = 1e-6", &harmonics)
    });
    let child = Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .arg("run")
        .arg(&path)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_secs(1));
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    let errors = printed(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{errors}");
    // No progress in a pipe.
    assert!(
        errors.starts_with("hbvib: the run ended early, StoppedByCaller"),
        "{errors}"
    );
    let csv = std::fs::read_to_string(path.with_file_name("response.csv")).unwrap();
    let rows: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert!(
        rows.iter()
            .all(|row| row.len() == 4 && row.iter().all(|x| x.is_finite()))
    );
    assert!(rows.len() > 1 && (207.0 - 1e-9..211.0).contains(&rows[rows.len() - 1][0]));
    read_by_numpy_with(
        path.parent().unwrap(),
        "print(len(f['omega']), len(f['harmonics']))",
        &format!("{0} {0}", rows.len()),
    );
}
