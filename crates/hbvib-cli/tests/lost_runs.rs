//! No run is lost: a sweep that SIGTERM, SIGINT or SIGHUP ends at random times leaves whole files with the points that it found, a
//! disk without room costs the file that does not fit, and an output that cannot be made costs no other.

#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

fn printed(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A sweep of the ring damper that takes seconds.
fn sweep(outputs: &str) -> String {
    let model = crate::common::ring_damper();
    format!(
        "{model}[[contact]]\nname = 'ring'\nkind = 'jenkins'\na = [2]\nb = [3]\nkt = 5e7\nmu = 0.3\npreload = 488.5\n\
         [[force]]\ndof = 0\nvalue = 5.0\n[[force]]\ndof = 1\nvalue = 5.0\n\
         [forced]\nfrom_hz = 150.0\nto_hz = 450.0\nharmonics = 401\n[output]\ncsv = 'response.csv'\nnpz = 'response.npz'\n{outputs}"
    )
}

fn write(name: &str, job: &str) -> (PathBuf, PathBuf) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lost_runs").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("job.toml");
    std::fs::write(&path, job).unwrap();
    (folder, path)
}

/// Names of the files of a folder.
fn files(folder: &Path) -> Vec<String> {
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.unwrap().file_name().into_string().unwrap();
    let mut all: Vec<String> = std::fs::read_dir(folder).unwrap().map(name).collect();
    all.sort();
    all
}

/// Points of the table and of the arrays, which numpy reads whole.
fn points(folder: &Path) -> (usize, usize) {
    let table = std::fs::read_to_string(folder.join("response.csv")).unwrap();
    let columns = table.lines().next().unwrap().split(',').count();
    for line in table.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
        assert_eq!(numbers.len(), columns, "{line}");
    }
    let python = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.venv/bin/python");
    let program = "import numpy as np\nfile = np.load('response.npz')\nx = file['harmonics']\n\
                   assert np.isfinite(x).all() and x.shape[0] == file['omega'].size == file['slip_fraction'].shape[0]\nprint(x.shape[0])";
    let output = Command::new(if python.exists() { python } else { "python3".into() })
        .args(["-c", program])
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", printed(&output.stderr));
    (
        table.lines().count() - 1,
        printed(&output.stdout).trim().parse().unwrap(),
    )
}

fn ended_by(signal: &str, after: Duration, path: &Path) -> Output {
    let child = Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .arg("run")
        .arg(path)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(after);
    let pid = child.id().to_string();
    let _ = Command::new("kill")
        .args(["-s", signal, &pid])
        .stderr(Stdio::null())
        .status();
    child.wait_with_output().unwrap()
}

#[test]
fn a_sweep_ended_at_twenty_random_times_keeps_its_points() {
    let (folder, path) = write("signals", &sweep(""));
    let start = Instant::now();
    let whole = Command::new(env!("CARGO_BIN_EXE_hbvib"))
        .arg("run")
        .arg(&path)
        .output()
        .unwrap();
    let time = start.elapsed().as_secs_f64();
    assert!(whole.status.success(), "{}", printed(&whole.stderr));
    let all = points(&folder).0;
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut early = 0;
    for round in 0..20 {
        // xorshift (Marsaglia 2003, doi:10.18637/jss.v008.i14)
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        for file in ["response.csv", "response.npz"] {
            let _ = std::fs::remove_file(folder.join(file));
        }
        let share = (state % 1000) as f64 / 1000.0;
        let signal = ["TERM", "TERM", "INT", "HUP"][round % 4];
        let output = ended_by(signal, Duration::from_secs_f64(0.98 * share * time), &path);
        let (text, errors) = (printed(&output.stdout), printed(&output.stderr));
        let names = files(&folder);
        match output.status.code() {
            // Before the program could take the signal, or before the first point.
            None | Some(2) if names == ["job.toml"] => assert!(!text.contains("wrote"), "{signal}, {share}: {text}"),
            code => {
                assert!(
                    code == Some(2) || code == Some(0),
                    "{signal}, {share}: {code:?}, {errors}"
                );
                assert_eq!(
                    names,
                    ["job.toml", "response.csv", "response.npz"],
                    "{signal}, {share}: {errors}"
                );
                assert!(text.contains("response.csv") && text.contains("response.npz"), "{text}");
                let (rows, arrays) = points(&folder);
                assert!(
                    rows == arrays && rows >= 1 && rows <= all,
                    "{signal}, {share}: {rows}, {arrays} of {all}"
                );
                if code == Some(2) {
                    early += 1;
                    assert!(errors.contains("ended early"), "{errors}");
                }
            }
        }
    }
    println!("{all} points in {time:.2} s; {early} of 20 runs kept a part");
    // How many, the machine decides: a busy one starts the program late.
    assert!(
        early >= 3,
        "{early} of 20 runs ended between their first and last point"
    );
}

/// Runs a shell command in the folder of a job, with the program as $HBVIB.
fn shell(command: &str, folder: &Path) -> Output {
    Command::new("sh")
        .args(["-c", command])
        .current_dir(folder)
        .env("HBVIB", env!("CARGO_BIN_EXE_hbvib"))
        .output()
        .unwrap()
}

fn short(outputs: &str) -> String {
    sweep(outputs)
        .replace("harmonics = 401", "harmonics = 9")
        .replace("150.0", "200.0")
        .replace("450.0", "215.0")
}

#[test]
fn a_file_that_does_not_fit_costs_no_other_and_leaves_the_old_one() {
    let (folder, path) = write("full", &short("figure = 'response.svg'\nslip_csv = 'slip.csv'\n"));
    let whole = shell("\"$HBVIB\" run job.toml", &folder);
    assert!(whole.status.success(), "{}", printed(&whole.stderr));
    let before = points(&folder);
    // Arrays of all harmonics exceed 16 blocks of 512 bytes, as on a disk without room; the tables do not.
    let small = std::fs::metadata(folder.join("response.csv")).unwrap().len();
    let large = std::fs::metadata(folder.join("response.npz")).unwrap().len();
    let blocks = small
        .max(std::fs::metadata(folder.join("response.svg")).unwrap().len())
        .div_ceil(512)
        + 1;
    assert!(large > 512 * blocks, "{large} and {blocks}");
    for file in ["response.csv", "response.svg", "slip.csv"] {
        std::fs::remove_file(folder.join(file)).unwrap();
    }
    let output = shell(&format!("ulimit -f {blocks}; exec \"$HBVIB\" run job.toml"), &folder);
    let (text, errors) = (printed(&output.stdout), printed(&output.stderr));
    assert_eq!(output.status.code(), Some(4), "{text}{errors}");
    assert!(errors.contains("response.npz: cannot be written: "), "{errors}");
    assert_eq!(
        files(&folder),
        ["job.toml", "response.csv", "response.npz", "response.svg", "slip.csv"],
        "{errors}"
    );
    assert!(
        text.contains("peak") && text.contains("slip.csv") && !text.contains("response.npz"),
        "{text}"
    );
    // The arrays are those of the run before, whole.
    assert_eq!(points(&folder), before);
    // Without room for any file the points are printed.
    for file in ["response.csv", "response.npz", "response.svg", "slip.csv"] {
        std::fs::remove_file(folder.join(file)).unwrap();
    }
    let output = shell("ulimit -f 0; exec \"$HBVIB\" run job.toml", &folder);
    assert_eq!(
        (output.status.code(), files(&folder)),
        (Some(4), vec!["job.toml".to_owned()])
    );
    let text = printed(&output.stdout);
    assert!(
        text.starts_with("frequency_hz,amplitude,") && text.lines().count() > before.0,
        "{text}"
    );
    drop(path);
}

#[test]
fn outputs_that_cannot_be_made_cost_no_other() {
    // A folder stands where a figure is to be; a reader of the summary is gone; a name is no file.
    let outputs = "figure = 'taken.svg'\nslip_csv = 'slip.csv'\nslip_figure = 'slip.svg'\n";
    let (folder, _) = write("taken", &short(outputs));
    std::fs::create_dir(folder.join("taken.svg")).unwrap();
    let output = shell("\"$HBVIB\" run job.toml", &folder);
    let errors = printed(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{errors}");
    assert!(errors.contains("taken.svg: cannot be written"), "{errors}");
    assert_eq!(
        files(&folder),
        [
            "job.toml",
            "response.csv",
            "response.npz",
            "slip.csv",
            "slip.svg",
            "taken.svg"
        ]
    );
    let (folder, _) = write("pipe", &short(""));
    let output = shell("\"$HBVIB\" run job.toml | true; wait", &folder);
    assert!(output.status.success());
    assert_eq!(files(&folder), ["job.toml", "response.csv", "response.npz"]);
    let (folder, _) = write("device", &short("").replace("response.npz", "/dev/null"));
    let output = shell("\"$HBVIB\" run job.toml", &folder);
    assert!(
        output.status.success() && Path::new("/dev/null").exists(),
        "{}",
        printed(&output.stderr)
    );
}

#[test]
fn an_analysis_that_fails_costs_no_other() {
    // A tornado whose range has no peak, beside a sweep.
    let tornado =
        "[tornado]\nfrom_hz = 300.0\nto_hz = 301.0\nharmonics = 1\n[[tornado.parameter]]\nparameter = 'force'\n";
    let (folder, _) = write(
        "analysis",
        &short("").replace("[output]", &format!("{tornado}[output]")),
    );
    let output = shell("\"$HBVIB\" run job.toml", &folder);
    let errors = printed(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert!(errors.contains("[tornado]: "), "{errors}");
    assert!(points(&folder).0 > 1);
}
