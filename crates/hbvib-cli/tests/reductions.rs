//! Craig-Bampton models of `reduce`: natural frequencies against an independent reduction, the response of the wheel against the whole
//! model, and the error that is told.

use crate::common::{command, empty_folder, printed, root};
use std::path::Path;
use std::process::Command;

pub fn done(arguments: &[&str], folder: &Path) -> String {
    let output = command(arguments, folder);
    let (text, errors) = (printed(&output.stdout), printed(&output.stderr));
    assert!(
        output.status.success() && errors.is_empty(),
        "{arguments:?}: {text}{errors}"
    );
    text
}

/// The number after a word.
pub fn number(text: &str, word: &str) -> f64 {
    let rest = text.split(word).nth(1).unwrap_or_else(|| panic!("{text} lacks {word}"));
    let number = rest.split_whitespace().next().unwrap().trim_end_matches(',');
    number.parse().unwrap()
}

/// The beam of bricks with a contact and a force.
pub fn beam(folder: &Path) {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for file in ["beam.sti", "beam.mas", "beam.dof", "beam.inp"] {
        std::fs::copy(data.join(file), folder.join(file)).unwrap();
    }
    let job = "[model]\nmatrices = \"beam.sti\"\nmesh = \"beam.inp\"\nrayleigh = [0.0, 1e-6]\n[[contact]]\nkind = \"friction_3d\"\n\
               normal = [0, -1, 0]\nkt = 1e6\nkn = 1e6\nmu = 0.3\npreload = 1.0\n[contact.nodes]\na = [2]\nb = [8]\n\
               largest_distance = 1.0\n[[force]]\ndof = \"6.3\"\nvalue = 1.0\n[forced]\nfrom_hz = 2500.0\nto_hz = 4500.0\n\
               harmonics = 1\nresponse_dof = \"6.3\"\n";
    std::fs::write(folder.join("job.toml"), job).unwrap();
}

/// An own reduction by numpy; prints the largest difference of frequencies, and of the reduced mass on the kept rows.
const OWN: &str = "
import csv, sys, numpy as np, scipy.linalg as sl, scipy.sparse as sp
n = len(open('beam.dof').read().split())
def triangle(name):
    a = np.loadtxt(name); full = np.zeros((n, n)); i, j = a[:, 0].astype(int) - 1, a[:, 1].astype(int) - 1
    np.add.at(full, (i, j), a[:, 2]); return full + full.T - np.diag(np.diag(full))
K, M = triangle('beam.sti'), triangle('beam.mas')
rows = list(csv.DictReader(open('reduced.dofs.csv')))
keep = np.array([int(r['degree_of_freedom']) for r in rows if r['degree_of_freedom']]); nb = len(keep); nm = len(rows) - nb
inner = np.setdiff1d(np.arange(n), keep); at = np.ix_(inner, inner)
T = np.zeros((n, nb + nm)); T[keep, np.arange(nb)] = 1
T[np.ix_(inner, np.arange(nb))] = -np.linalg.solve(K[at], K[np.ix_(inner, keep)])
w, phi = sl.eigh(K[at], M[at]); T[np.ix_(inner, nb + np.arange(nm))] = phi[:, :nm]
file = np.load('reduced.npz')
def reduced(letter):
    part = [file[f'{letter}_{k}'] for k in ('data', 'indices', 'indptr')]
    return sp.csc_matrix(tuple(part), shape=file[f'{letter}_shape']).toarray()
k, m = reduced('K'), reduced('M')
assert (k == k.T).all() and (m == m.T).all()
own = sl.eigh(T.T @ K @ T, T.T @ M @ T, eigvals_only=True); theirs = sl.eigh(k, m, eigvals_only=True)
whole = sl.eigh(K, M, eigvals_only=True)
print(abs(np.sqrt(theirs / own) - 1).max(), abs((T.T @ M @ T - m)[:nb, :nb]).max() / abs(m).max(), nb, nm, abs(np.sqrt(theirs[:3] / whole[:3]) - 1).max())
";

#[test]
fn the_reduction_is_that_of_another_program_in_every_format() {
    let folder = empty_folder("reductions", "beam");
    beam(&folder);
    let own = root().join(".venv/bin/python");
    let python = if own.exists() { own } else { "python3".into() };
    let mut gaps = Vec::new();
    for modes in ["2", "6", "15"] {
        let told = done(
            &["reduce", "job.toml", "--modes", modes, "--output", "reduced.npz"],
            &folder,
        );
        let output = Command::new(&python)
            .args(["-c", OWN])
            .current_dir(&folder)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", printed(&output.stderr));
        let found: Vec<f64> = printed(&output.stdout)
            .split_whitespace()
            .map(|x| x.parse().unwrap())
            .collect();
        let [frequencies, mass, kept, count, error] = found[..] else {
            panic!("{found:?}")
        };
        println!("{modes} modes: {frequencies:.1e} {mass:.1e}, error {error:.1e}");
        assert!(frequencies < 1e-8 && mass < 1e-10, "{frequencies:e} {mass:e}");
        // Two nodes of the contact and one direction of the force.
        assert!((kept - 7.0).abs() < 0.5 && (count - modes.parse::<f64>().unwrap()).abs() < 0.5);
        gaps.push((error, number(&told, "at most ")));
    }
    assert!(gaps[0].0 > 10.0 * gaps[2].0, "more modes are nearer: {gaps:?}");
    assert!(
        gaps[0].1 > 3.0 * gaps[2].1,
        "and the error that is told falls: {gaps:?}"
    );
    // Each job has results of its own.
    let text = std::fs::read_to_string(folder.join("job.toml")).unwrap();
    std::fs::write(folder.join("job.toml"), text + "[output]\ncsv = \"curve.csv\"\n").unwrap();
    // Modes are chosen by the error.
    let told = done(
        &["reduce", "job.toml", "--tolerance", "1e-5", "--output", "reduced.npz"],
        &folder,
    );
    assert!(number(&told, "at most ") <= 1e-5, "{told}");
    let peak = |job: &str| {
        let summary = done(&["run", job], &folder);
        (number(&summary, "peak "), number(&summary, "Hz    "))
    };
    let (_, whole) = (peak("job.toml"), done(&["run", "job.toml"], &folder));
    let hertz = number(&whole, "peak ");
    for (name, format) in [
        ("reduced.npz", "npz"),
        ("reduced.pch", "dmig"),
        ("reduced.inp", "user-element"),
    ] {
        done(
            &[
                "reduce",
                "job.toml",
                "--tolerance",
                "1e-5",
                "--format",
                format,
                "--output",
                name,
            ],
            &folder,
        );
        let summary = done(&["run", "reduced.toml"], &folder);
        assert!(
            (number(&summary, "peak ") / hertz - 1.0).abs() < 2e-5,
            "{name}: {summary}"
        );
        let curve = |file: &str| std::fs::read_to_string(folder.join(file)).unwrap();
        assert_ne!(curve("curve.csv"), curve("reduced_curve.csv"), "{name}");
    }
    for name in ["reduced.op4", "reduced.mtx"] {
        let told = done(&["reduce", "job.toml", "--modes", "5", "--output", name], &folder);
        assert!(told.contains("names the degrees of freedom of the table"), "{told}");
    }
    // The folder of the job has no file that served the comparison.
    let left: Vec<_> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert!(
        !left.iter().any(|name| name.to_string_lossy().starts_with('.')),
        "{left:?}"
    );
}

#[test]
fn the_reduced_wheel_has_the_response_of_the_whole_one() {
    let folder = empty_folder("reductions", "wheel");
    let example = root().join("examples/jobs/cover_plate");
    for file in ["mesh.py", "matrices.inp", "job.toml"] {
        std::fs::copy(example.join(file), folder.join(file)).unwrap();
    }
    for (program, argument) in [("python3", "mesh.py"), ("ccx", "matrices")] {
        let output = Command::new(program).arg(argument).current_dir(&folder).output();
        assert!(
            output
                .expect("python3 and ccx (tests/run.sh installs them)")
                .status
                .success()
        );
    }
    let told = done(&["reduce", "job.toml", "--output", "small/wheel.npz"], &folder);
    assert!(number(&told, "at most ") < 1e-6, "{told}");
    let (whole, small) = (
        done(&["run", "job.toml"], &folder),
        done(&["run", "small/wheel.toml"], &folder),
    );
    assert!(
        number(&small, "unknowns from ") < 0.5 * number(&whole, "unknowns from "),
        "{small}"
    );
    let is_near = |small: &str| {
        for word in ["peak ", "Hz "] {
            let (a, b) = (number(small, word), number(&whole, word));
            assert!((a / b - 1.0).abs() < 1e-6, "{word}: {a} and {b}");
        }
    };
    is_near(&small);
    // Faces stay with free modes as well: those of the sector by itself, which no neighbour holds.
    let told = done(
        &[
            "reduce",
            "job.toml",
            "--method",
            "free-interface",
            "--modes",
            "20",
            "--output",
            "free.npz",
        ],
        &folder,
    );
    assert!(number(&told, "at most ") < 1e-6, "{told}");
    is_near(&done(&["run", "free.toml"], &folder));
}

#[test]
fn models_that_are_not_reduced_are_refused() {
    let folder = empty_folder("reductions", "refused");
    beam(&folder);
    let job = std::fs::read_to_string(folder.join("job.toml")).unwrap();
    let bare = job.split("[[contact]]").next().unwrap();
    std::fs::write(folder.join("bare.toml"), bare).unwrap();
    std::fs::write(folder.join("ring.toml"), crate::common::ring_damper()).unwrap();
    for (arguments, words) in [
        (
            &["reduce", "bare.toml", "--output", "a.npz"][..],
            "--keep names what stays",
        ),
        (
            &["reduce", "ring.toml", "--output", "a.npz"],
            "coupling_stiffness: is not reduced",
        ),
        (&["reduce", "job.toml", "--output", "a.xyz"], "the name tells no format"),
        (
            &["reduce", "job.toml", "--output", "a.npz", "--keep", "1.3"],
            "--keep: dof = \"1.3\": node 1 has no row",
        ),
        (&["reduce", "job.toml"], "--output"),
    ] {
        let output = command(arguments, &folder);
        let errors = printed(&output.stderr);
        assert!(
            output.status.code() == Some(1) && errors.contains(words),
            "{arguments:?}: {errors}"
        );
    }
    let told = done(
        &[
            "reduce",
            "bare.toml",
            "--keep",
            "6.3,0",
            "--modes",
            "4",
            "--output",
            "a.npz",
        ],
        &folder,
    );
    assert!(told.contains("6 of 60 degrees of freedom: 2 kept, 4 modes"), "{told}");
}

/// Rows of the whole model are none of the reduced one: its error is not told, and no job is written that would name them.
#[test]
fn a_job_with_numbers_is_reduced_without_a_job_of_its_own() {
    let folder = empty_folder("reductions", "numbers");
    beam(&folder);
    let job = std::fs::read_to_string(folder.join("job.toml")).unwrap();
    let bare = job.split("[[contact]]").next().unwrap();
    let contact = "[[contact]]\nkind = \"jenkins\"\na = [20]\nkt = 1e3\nmu = 0.3\npreload = 1.0\n";
    std::fs::write(folder.join("numbers.toml"), format!("{bare}{contact}")).unwrap();
    let told = done(
        &["reduce", "numbers.toml", "--modes", "4", "--output", "numbered.npz"],
        &folder,
    );
    assert!(
        told.contains("the error is not told") && told.contains("a job names the degrees of freedom of the table"),
        "{told}"
    );
    assert!(!folder.join("numbered.toml").exists());
}
