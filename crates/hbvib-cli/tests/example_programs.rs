//! Programs of the examples around finite-element files: C from matrices to a universal file, and Python from the mesh of gmsh to a
//! Craig-Bampton model of the caller's.

use crate::common::{command, empty_folder, printed, root, run};
use num_complex::Complex64;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The folder of the shared libraries: that of this program.
fn libraries() -> PathBuf {
    std::env::current_exe().unwrap().parent().unwrap().to_owned()
}

fn python() -> PathBuf {
    let own = root().join(".venv/bin/python");
    if own.exists() { own } else { "python3".into() }
}

/// The solution of A x = b by elimination with pivots.
fn solved(mut a: Vec<Vec<Complex64>>, mut b: Vec<Complex64>) -> Vec<Complex64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n)
            .max_by(|i, j| a[*i][k].norm().total_cmp(&a[*j][k].norm()))
            .unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (above, known) = (a[k].clone(), b[k]);
        for i in k + 1..n {
            let factor = a[i][k] / above[k];
            for (x, y) in a[i].iter_mut().zip(&above) {
                *x -= factor * y;
            }
            b[i] -= factor * known;
        }
    }
    for k in (0..n).rev() {
        let known: Complex64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

/// The motion at the peak is that of an elimination here, at each node.
#[test]
fn a_c_program_brings_the_motion_of_all_nodes_into_a_universal_file() {
    let folder = empty_folder("example_programs", "motion_to_uff");
    let libraries = libraries();
    let include = root().join("include").canonicalize().unwrap();
    let major = format!(
        "libhbvib.so.{}.{}",
        env!("CARGO_PKG_VERSION_MAJOR"),
        env!("CARGO_PKG_VERSION_MINOR")
    );
    std::os::unix::fs::symlink(libraries.join("libhbvib.so"), folder.join(major)).unwrap();
    let source = root().join("examples/c/motion_to_uff.c").canonicalize().unwrap();
    let options = [
        "-O2",
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-pedantic",
        "-Werror",
        "-o",
        "motion_to_uff",
    ];
    let places = [
        format!("-I{}", include.display()),
        source.display().to_string(),
        format!("-L{}", libraries.display()),
        "-Wl,-rpath,.".into(),
        format!("-Wl,-rpath,{}", libraries.display()),
        "-lhbvib".into(),
        "-lhbvib_io".into(),
        "-lm".into(),
    ];
    let all: Vec<&str> = options.into_iter().chain(places.iter().map(String::as_str)).collect();
    run("cc", &all, &folder);
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for end in ["sti", "mas", "dof"] {
        std::fs::copy(
            data.join("beam").with_extension(end),
            folder.join("beam").with_extension(end),
        )
        .unwrap();
    }
    std::fs::write(folder.join("job.toml"), "[model]\nmatrices = 'beam.sti'\n").unwrap();
    let modes = run(env!("CARGO_BIN_EXE_hbvib"), &["modes", "job.toml"], &folder);
    let first: f64 = modes
        .lines()
        .nth(1)
        .unwrap()
        .split(',')
        .nth(2)
        .unwrap()
        .parse()
        .unwrap();
    let read = hbvib_io::read(&folder.join("beam.sti")).unwrap();
    let row = read.dofs.len() - 1;
    let (from, to, row_word) = ((0.9 * first).to_string(), (1.1 * first).to_string(), row.to_string());
    let told = run(
        folder.join("motion_to_uff").canonicalize().unwrap(),
        &["beam.sti", &row_word, &from, &to, "shapes.uff"],
        &folder,
    );
    let hertz: f64 = told.split(' ').next().unwrap().parse().unwrap();
    assert!(
        (hertz / first - 1.0).abs() < 0.02,
        "{told}, first natural frequency {first}"
    );

    let omega = std::f64::consts::TAU * hertz;
    let n = read.dofs.len();
    let mut a = vec![vec![Complex64::ZERO; n]; n];
    let scales = [Complex64::new(1.0, 1e-6 * omega), Complex64::new(-omega * omega, 0.0)];
    for (matrix, scale) in [read.stiffness, read.mass].iter().flatten().zip(scales) {
        assert_eq!(matrix.symmetry, hbvib_io::Symmetry::Symmetric);
        for ((i, j), value) in matrix.row.iter().zip(&matrix.column).zip(&matrix.values) {
            a[*i as usize][*j as usize] += scale * value;
            if i != j {
                a[*j as usize][*i as usize] += scale * value;
            }
        }
    }
    let mut force = vec![Complex64::ZERO; n];
    force[row] = Complex64::new(1.0, 0.0);
    let x = solved(a, force);
    let shape = hbvib_io::read_universal(&folder.join("shapes.uff"))
        .unwrap()
        .shapes
        .remove(0);
    let place: HashMap<i64, usize> = shape.nodes.iter().enumerate().map(|(i, node)| (*node, i)).collect();
    let largest = x.iter().map(|value| value.norm()).fold(0.0, f64::max);
    for ((node, direction), expected) in read.dofs.iter().zip(&x) {
        let (re, im) = shape.values[3 * place[node] + *direction as usize - 1];
        let apart = (Complex64::new(re, im) - expected).norm();
        // Data sets 55 have six digits.
        assert!(apart < 2e-6 * largest, "{node}.{direction}: {re} {im}, {expected}");
    }
    assert_eq!(n, 3 * shape.nodes.len());
}

/// The mesh of `mesh.py 0.025 0.03` is beside this file.
#[test]
fn a_craig_bampton_model_by_scipy_has_the_response_of_the_mesh_of_gmsh() {
    let folder = empty_folder("example_programs", "gmsh_wheel");
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/gmsh_wheel.inp");
    std::fs::copy(data, folder.join("wheel.inp")).unwrap();
    reduced_by_scipy(&folder, "1590 degrees of freedom");
}

#[test]
#[ignore = "needs gmsh, which tests/deep.sh installs"]
fn the_mesh_of_gmsh_is_that_of_the_test() {
    let folder = empty_folder("example_programs", "mesh");
    let script = root().join("examples/jobs/gmsh_wheel/mesh.py").canonicalize().unwrap();
    let gmsh = root().join(".venv-gmsh/bin/python");
    run(gmsh, &[script.to_str().unwrap(), "0.025", "0.03"], &folder);
    reduced_by_scipy(&folder, "degrees of freedom");
}

/// `init` and `check` of the command, and the reduction of the example with its difference from all degrees of freedom.
fn reduced_by_scipy(folder: &Path, words: &str) {
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
        "RING_RIM:DISK_RIM",
    ];
    let init = command(&arguments, folder);
    let text = printed(&init.stdout);
    assert!(text.contains(words), "{text}{}", printed(&init.stderr));
    let check = command(&["check", "--strict", "job.toml"], folder);
    assert!(check.status.success(), "{}", printed(&check.stderr));
    let script = root()
        .join("examples/jobs/gmsh_wheel/own_craig_bampton.py")
        .canonicalize()
        .unwrap();
    let output = std::process::Command::new(python())
        .args(["-B", script.to_str().unwrap(), "100", "1071", "1076"])
        .current_dir(folder)
        .env("PYTHONPATH", root().join("include").canonicalize().unwrap())
        .env("HBVIB_LIBRARY", libraries().join("libhbvib.so"))
        .env("HBVIB_IO_LIBRARY", libraries().join("libhbvib_io.so"))
        .env("OMP_NUM_THREADS", "1")
        .output()
        .unwrap();
    let text = printed(&output.stdout);
    assert!(output.status.success(), "{text}{}", printed(&output.stderr));
    let difference: f64 = text
        .split("largest difference ")
        .nth(1)
        .unwrap()
        .trim()
        .parse()
        .unwrap();
    assert!(difference < 2e-5, "{text}");
    // Near the peak contacts slip.
    assert!(text.contains("slip fraction up to 0.4"), "{text}");
}
