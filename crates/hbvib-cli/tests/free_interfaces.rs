//! Free-interface models of `reduce`, on a chain that nothing holds and a rigid mass beside it: natural frequencies and the error that is
//! told against numpy, the response with slip against the whole model, and every format.

use crate::common::{command, empty_folder, printed, root};
use crate::reductions::{beam, done, number};
use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

const MASSES: u32 = 40;

/// Masses 1 to 40 on springs, mass 41 by itself, and a slider between masses 20 and 41.
fn chain(folder: &Path) {
    let (mut stiffness, mut mass, mut names) = (String::new(), String::new(), String::new());
    let spring = |i: u32| 1e6 * (1.0 + 0.2 * f64::from(i).cos());
    for i in 1..=MASSES {
        let right = if i < MASSES { spring(i) } else { 0.0 };
        let left = if i > 1 { spring(i - 1) } else { 0.0 };
        writeln!(stiffness, "{i} {i} {:.17e}", left + right).unwrap();
        if i < MASSES {
            writeln!(stiffness, "{i} {} {:.17e}", i + 1, -right).unwrap();
        }
        writeln!(mass, "{i} {i} {:.17e}", 1.0 + 0.3 * f64::from(i).sin()).unwrap();
        writeln!(names, "{i}.1").unwrap();
    }
    let last = MASSES + 1;
    writeln!(stiffness, "{last} {last} 0.0").unwrap();
    writeln!(mass, "{last} {last} 2.0").unwrap();
    writeln!(names, "{last}.1").unwrap();
    for (file, text) in [("chain.sti", stiffness), ("chain.mas", mass), ("chain.dof", names)] {
        std::fs::write(folder.join(file), text).unwrap();
    }
    let job = "[model]\nmatrices = \"chain.sti\"\nrayleigh = [0.0, 2e-5]\n[[contact]]\nkind = \"jenkins\"\na = [\"20.1\"]\nb = [\"41.1\"]\n\
               kt = 2e5\nmu = 1.0\npreload = 1.0\n[[force]]\ndof = \"1.1\"\nvalue = 1.0\n[forced]\nfrom_hz = 10.0\nto_hz = 40.0\n\
               harmonics = 3\nresponse_dof = \"40.1\"\n";
    std::fs::write(folder.join("job.toml"), job).unwrap();
}

/// For each number of modes and both methods, prints the true error of the frequencies up to 60 Hz with and without the stuck slider,
/// that of as many of the lowest ones without it, and the largest frequency of both rigid motions, Hz.
const TRUE_ERROR: &str = "
import csv, sys, numpy as np, scipy.linalg as sl, scipy.sparse as sp
n = len(open('chain.dof').read().split())
def triangle(name):
    a = np.loadtxt(name); full = np.zeros((n, n)); i, j = a[:, 0].astype(int) - 1, a[:, 1].astype(int) - 1
    np.add.at(full, (i, j), a[:, 2]); return full + full.T - np.diag(np.diag(full))
K, M = triangle('chain.sti'), triangle('chain.mas')
def reduced(file, letter):
    return sp.csc_matrix(tuple(file[f'{letter}_{k}'] for k in ('data', 'indices', 'indptr')), shape=file[f'{letter}_shape']).toarray()
def hertz(K, M, a, b, kt):
    d = np.zeros(len(K)); d[a], d[b] = 1, -1
    return np.sqrt(np.maximum(sl.eigh(K + kt * np.outer(d, d), M, eigvals_only=True), 0)) / 2 / np.pi
def errors(name, count):
    row = {r['degree_of_freedom']: int(r['row']) for r in csv.DictReader(open(name + '.dofs.csv')) if r['degree_of_freedom']}
    k, m = (reduced(np.load(name + '.npz'), letter) for letter in 'KM')
    worst = 0
    for kt, rigid in ((0.0, 2), (2e5, 1)):
        whole, own = hertz(K, M, 19, 40, kt), hertz(k, m, row['19'], row['40'], kt)
        low = np.arange(rigid, min(len(own), 10)); low = low[whole[low] <= 60]
        worst = max(worst, abs(own[low] / whole[low] - 1).max())
        if kt == 0:
            exact = abs(own[2:count] / whole[2:count] - 1).max(); still = own[:2].max()
    return worst, exact, still
for count in sys.argv[1:]:
    for name in ('fixed', 'free'):
        print(*errors(name + count, int(count)))
";

fn reduced(folder: &Path, method: &str, modes: &str, name: &str) -> String {
    let arguments = [
        "reduce", "job.toml", "--method", method, "--modes", modes, "--output", name,
    ];
    let output = command(&arguments, folder);
    assert!(output.status.success(), "{}", printed(&output.stderr));
    printed(&output.stdout)
}

#[test]
fn free_modes_are_exact_and_the_error_that_is_told_is_the_true_one() {
    let folder = empty_folder("free_interfaces", "frequencies");
    chain(&folder);
    let counts = ["4", "6", "9", "15", "25"];
    let mut told = Vec::new();
    for modes in counts {
        for (method, name) in [("craig-bampton", "fixed"), ("free-interface", "free")] {
            let text = reduced(&folder, method, modes, &format!("{name}{modes}.npz"));
            told.push(number(&text, "at most "));
        }
    }
    let own = root().join(".venv/bin/python");
    let output = Command::new(if own.exists() { own } else { "python3".into() })
        .args(["-c", TRUE_ERROR])
        .args(counts)
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", printed(&output.stderr));
    let text = printed(&output.stdout);
    let found: Vec<Vec<f64>> = text
        .lines()
        .map(|line| line.split_whitespace().map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!(found.len(), told.len());
    for (told, error) in told.iter().zip(&found) {
        let error = error[0];
        assert!(
            (told - error).abs() <= 0.01 * error + 1e-10,
            "told {told:e}, true {error:e}"
        );
    }
    for (modes, pair) in counts.iter().zip(found.chunks_exact(2)) {
        let (fixed, free) = (&pair[0], &pair[1]);
        println!("{modes} modes: fixed {fixed:?}, free {free:?}");
        assert!(
            free[1] < 1e-9 && free[1] < 1e-3 * fixed[1],
            "own frequencies to {:e} and {:e}",
            free[1],
            fixed[1]
        );
        assert!(free[2] < 1e-3, "rigid motions at {:e} Hz", free[2]);
    }
    // Rigid motions stay: that of mass 41 is a kept degree of freedom.
    let none = reduced(&folder, "free-interface", "0", "reduced.npz");
    assert!(
        none.contains("5 of 41 degrees of freedom: 4 kept, 1 modes with these free"),
        "{none}"
    );
    let up_to = [
        "reduce",
        "job.toml",
        "--output",
        "reduced.npz",
        "--method",
        "free-interface",
        "--up-to-hz",
        "40",
    ];
    let told = command(&up_to, &folder);
    let told = printed(&told.stdout);
    assert!(told.contains("4 modes with these free, up to 36.30"), "{told}");
    let table = std::fs::read_to_string(folder.join("reduced.dofs.csv")).unwrap();
    assert!(
        table.starts_with("row,degree_of_freedom,name,free_mode_hz\n"),
        "{table}"
    );
}

/// Numbers after a word, in each line that has it.
fn numbers(text: &str, word: &str) -> Vec<f64> {
    text.lines()
        .filter(|line| line.contains(word))
        .map(|line| number(line, word))
        .collect()
}

#[test]
fn the_response_with_slip_is_that_of_the_whole_model() {
    let folder = empty_folder("free_interfaces", "response");
    chain(&folder);
    let run = |job: &str| {
        let output = command(&["run", job], &folder);
        assert!(output.status.success(), "{}", printed(&output.stderr));
        printed(&output.stdout)
    };
    let whole = run("job.toml");
    assert!(whole.contains("of 1 contact, 0 never slip"), "{whole}");
    let highest = |text: &str| numbers(text, " Hz ").into_iter().fold(0.0, f64::max);
    for modes in ["9", "15", "25"] {
        let told = number(&reduced(&folder, "free-interface", modes, "reduced.npz"), "at most ");
        let small = run("reduced.toml");
        let (a, b) = (numbers(&small, "peak "), numbers(&whole, "peak "));
        assert!(a.len() == b.len() && b.len() > 3, "{small}{whole}");
        let gap = a
            .iter()
            .zip(&b)
            .fold(0.0_f64, |worst, (a, b)| worst.max((a / b - 1.0).abs()));
        let height = (highest(&small) / highest(&whole) - 1.0).abs();
        println!("{modes} modes: told {told:.1e}, peaks at {gap:.1e}, height {height:.1e}");
        // Seven and eight digits are printed.
        assert!(
            gap <= told + 1e-7 && height <= told + 3e-7,
            "told {told:e}, found {gap:e} and {height:e}"
        );
    }
}

#[test]
fn every_format_has_the_free_interface() {
    let folder = empty_folder("free_interfaces", "formats");
    beam(&folder);
    let whole = done(&["run", "job.toml"], &folder);
    for name in ["reduced.npz", "reduced.pch", "reduced.inp"] {
        let format = if name.ends_with("inp") { "user-element" } else { "npz" };
        let format = if name.ends_with("pch") { "dmig" } else { format };
        let arguments = [
            "reduce",
            "job.toml",
            "--method",
            "free-interface",
            "--format",
            format,
            "--output",
            name,
        ];
        let told = done(&arguments, &folder);
        assert!(number(&told, "at most ") <= 1e-6, "{told}");
        let small = done(&["run", "reduced.toml"], &folder);
        for word in ["peak ", "Hz "] {
            let (a, b) = (number(&small, word), number(&whole, word));
            assert!((a / b - 1.0).abs() < 1e-6, "{name}, {word}: {a} and {b}");
        }
    }
    let arguments = [
        "reduce",
        "job.toml",
        "--method",
        "free-interface",
        "--output",
        "reduced.op4",
    ];
    let told = done(&arguments, &folder);
    assert!(told.contains("names the degrees of freedom of the table"), "{told}");
    let wrong = command(
        &["reduce", "job.toml", "--method", "guyan", "--output", "a.npz"],
        &folder,
    );
    assert!(
        printed(&wrong.stderr).contains("craig-bampton, free-interface"),
        "{}",
        printed(&wrong.stderr)
    );
}
