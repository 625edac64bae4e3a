//! A run that was stopped goes on from its stored response: peaks, folds and requested frequencies are those of the run that was not
//! stopped, wherever it was stopped on a curve that folds.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const EXE: &str = env!("CARGO_BIN_EXE_hbvib");

/// A hardening spring at the blade bends the peak over; the ring damps it.
fn job(harmonics: usize, at: &[String], restart: &str) -> String {
    format!(
        "{}[[contact]]\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n\
         [[contact]]\nkind = 'cubic'\na = [0]\ncubic = 6e10\n\
         [[force]]\ndof = 0\nvalue = 12.0\n[[force]]\ndof = 1\nvalue = 12.0\n{restart}\n\
         [forced]\nfrom_hz = 205.0\nto_hz = 232.0\nharmonics = {harmonics}\nat_hz = [{}]\n\
         [[response]]\ndofs = [0]\n[[response]]\ndofs = [2]\nmeasure = 'rms'\n\
         [output]\ncsv = 'curve.csv'\nnpz = 'curve.npz'\nnetcdf = 'curve.nc'\nfigure = 'curve.svg'\nslip_csv = 'slip.csv'\n",
        crate::common::ring_damper(),
        at.join(", ")
    )
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("restarted_runs").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn run(folder: &Path, job: &str) -> Output {
    let path = folder.join("job.toml");
    std::fs::write(&path, job).unwrap();
    Command::new(EXE).arg("run").arg(path).output().unwrap()
}

fn python(folder: &Path, program: &str) -> String {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.venv/bin/python");
    let python = if own.exists() { own } else { "python3".into() };
    let output = Command::new(python)
        .args(["-c", program])
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

/// Numbers of the summary by the first word of their line.
fn special(summary: &str) -> BTreeMap<String, Vec<f64>> {
    let mut all: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for line in summary.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let [name @ ("peak" | "fold" | "at"), hertz, "Hz", amplitude] = words[..] {
            let of = all.entry(name.to_owned()).or_default();
            of.push(hertz.parse().unwrap());
            of.push(amplitude.parse().unwrap());
        }
    }
    all
}

fn assert_same(one: &BTreeMap<String, Vec<f64>>, other: &BTreeMap<String, Vec<f64>>, name: &str) {
    assert_eq!(
        one.keys().collect::<Vec<_>>(),
        other.keys().collect::<Vec<_>>(),
        "{name}"
    );
    for (word, of) in one {
        let found = &other[word];
        assert_eq!(of.len(), found.len(), "{name}, {word}: {of:?} {found:?}");
        for (a, b) in of.iter().zip(found) {
            // Seven digits are printed.
            assert!((a / b - 1.0).abs() < 1e-6, "{name}, {word}: {a} and {b}");
        }
    }
}

fn requests() -> Vec<String> {
    (0..26).map(|i| format!("{:.1}", 206.0 + f64::from(i))).collect()
}

#[test]
fn a_run_stopped_anywhere_goes_on_to_the_same_curve() {
    let folder = folder("anywhere");
    let whole = run(&folder, &job(3, &requests(), ""));
    assert!(whole.status.success(), "{}", text(&whole.stderr));
    let summary = text(&whole.stdout);
    let expected = special(&summary);
    assert!(expected["fold"].len() == 4 && expected["at"].len() == 52, "{summary}");
    // Requests at which there are several solutions have all of them in the file.
    let table = "import numpy as np; f = np.load('whole.npz'); print(*f['requested'].ravel())";
    std::fs::rename(folder.join("curve.npz"), folder.join("whole.npz")).unwrap();
    let all = |text: String| -> Vec<f64> { text.split_whitespace().map(|x| x.parse().unwrap()).collect() };
    let wanted = all(python(&folder, table));
    assert!(wanted.len() > 3 * 26, "{}", wanted.len());
    let points: usize = python(&folder, "import numpy as np; print(len(np.load('whole.npz')['omega']))")
        .trim()
        .parse()
        .unwrap();
    for share in [0.02, 0.3, 0.55, 0.65, 0.75, 0.85, 0.95, 1.0] {
        let kept = ((share * points as f64) as usize).max(1);
        // As a run leaves it that is stopped after so many points.
        let cut = format!(
            "import numpy as np; f = dict(np.load('whole.npz')); n = len(f['omega']); k = {kept}\n\
             w, a = f['omega'][:k], f['amplitude'][:k]\n\
             def on(x, y, m):\n\
             \x20   near = lambda v, at, m: (v >= np.minimum(at[1:], at[:-1]) - m * abs(np.diff(at))) & (v <= np.maximum(at[1:], at[:-1]) + m * abs(np.diff(at)))\n\
             \x20   return k > 1 and (near(x, w, m) & near(y, a, 0.5)).any()\n\
             for name in ('peaks', 'folds', 'requested'): f[name] = np.array([row for row in f[name] if on(*row[-2:], 0 if name == 'requested' else 0.5)]).reshape(-1, f[name].shape[1])\n\
             f['response_peaks'] = f['response_peaks'][:0]\n\
             for name in ('omega', 'amplitude', 'residual', 'harmonics_used', 'slip_fraction', 'harmonics'): f[name] = f[name][:k]\n\
             for name in ('responses', 'response_errors'): f[name] = f[name][:, :k]\n\
             np.savez('half.npz', **f)"
        );
        python(&folder, &cut);
        let output = run(&folder, &job(3, &requests(), "[restart]\nfrom = 'half.npz'"));
        assert!(output.status.success(), "{share}: {}", text(&output.stderr));
        assert_same(&expected, &special(&text(&output.stdout)), &share.to_string());
        let found = all(python(&folder, &table.replace("whole", "curve")));
        assert_eq!(found.len(), wanted.len(), "{share}");
        for (a, b) in found.chunks_exact(3).zip(wanted.chunks_exact(3)) {
            assert!(
                (a[0] - b[0]).abs() < 0.5 && (a[2] / b[2] - 1.0).abs() < 1e-7,
                "{share}: {a:?} {b:?}"
            );
        }
        // Both parts are one curve in all files.
        let lines = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap().lines().count() - 1;
        let stored = "import numpy as np; from scipy.io import netcdf_file; f = np.load('curve.npz')\n\
                      n = netcdf_file('curve.nc', mmap=False).variables['displacement_real']\n\
                      assert (n[...] == f['harmonics'].real).all(); assert f['responses'].shape[1] == len(f['omega'])\n\
                      assert abs(abs(f['harmonics'][:, 1, 0]) / f['amplitude'] - 1).max() < 1e-12; print(len(f['omega']))";
        let rows: usize = python(&folder, stored).trim().parse().unwrap();
        assert!(lines("curve.csv") == rows && lines("slip.csv") == rows, "{rows}");
    }
}

/// Stopped by SIGINT about halfway, and restarted from the file that it left, under its own name.
#[cfg(unix)]
#[test]
fn a_run_stopped_by_ctrl_c_goes_on() {
    let folder = folder("ctrl_c");
    let many: Vec<String> = (0..1500)
        .map(|i| format!("{:.4}", 205.5 + f64::from(i) * 0.017))
        .collect();
    let whole = run(&folder, &job(31, &many, ""));
    assert!(whole.status.success(), "{}", text(&whole.stderr));
    let expected = special(&text(&whole.stdout));
    std::fs::remove_file(folder.join("curve.npz")).unwrap();
    let path = folder.join("job.toml");
    let mut command = Command::new(EXE);
    let mut child = command
        .args(["run", "--log", "json"])
        .arg(&path)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // At half of the range.
    let mut errors = std::io::BufReader::new(child.stderr.take().unwrap());
    let mut line = String::new();
    while std::io::BufRead::read_line(&mut errors, &mut line).unwrap() > 0 {
        let event: serde_json::Value = serde_json::from_str(&line).unwrap();
        if event["fraction_done"].as_f64().is_some_and(|done| done > 0.5) {
            break;
        }
        line.clear();
    }
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    let rest = std::thread::spawn(move || std::io::copy(&mut errors, &mut std::io::sink()));
    let output = child.wait_with_output().unwrap();
    rest.join().unwrap().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let half = special(&text(&output.stdout));
    assert!(half.get("at").map_or(0, Vec::len) < expected["at"].len());
    let output = run(&folder, &job(31, &many, "[restart]\nfrom = 'curve.npz'"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_same(&expected, &special(&text(&output.stdout)), "ctrl_c");
}

#[test]
fn files_of_other_jobs_are_refused() {
    let folder = folder("refused");
    let first = run(&folder, &job(3, &[], ""));
    assert!(first.status.success());
    let restart = "[restart]\nfrom = 'curve.npz'";
    let good = job(3, &[], restart);
    for (name, job, words) in [
        ("range", good.replace("205.0", "206.0"), "begins at 205"),
        (
            "responses",
            good.replace("[[response]]\ndofs = [0]\n", ""),
            "has 2 responses, and the job 1",
        ),
        ("model", good.replace("12.0", "6.0"), "the model is another one"),
        ("file", good.replace("'curve.npz'\n", "'none.npz'\n"), "none.npz"),
        ("text", good.replace("'curve.npz'\n", "'job.toml'\n"), "job.toml"),
    ] {
        let output = run(&folder, &job);
        let errors = text(&output.stderr);
        assert!(
            output.status.code() == Some(1) && errors.contains(words),
            "{name}: {errors}"
        );
    }
}

#[test]
fn a_mode_has_no_run_to_go_on_from() {
    let job = format!(
        "{}[mode]\nlog10_from = -6\nlog10_to = -3\n[restart]\nfrom = 'curve.npz'\n",
        crate::common::ring_damper()
    );
    let output = run(&folder("mode"), &job);
    assert!(output.status.code() == Some(1) && text(&output.stderr).contains("[restart] needs [forced]"));
}
