//! Superelements of each format that is written are read back with the same matrices, by this crate and by scipy.

#![cfg(target_os = "linux")]

use hbvib_io::{Format, Matrices, Matrix, Op4Form, Symmetry, read, read_files, write, write_op4, write_scipy_npz};
use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder that goes with its test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("hbvib_io_{name}_{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Numbers without a pattern, of many sizes (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let z = z ^ (z >> 31);
        let size = 10_f64.powi((z % 25) as i32 - 12);
        ((z >> 11) as f64 / (1_u64 << 53) as f64 - 0.5) * size
    }
}

/// One triangle, or all entries, of a matrix in which `share` of 8 places has an entry.
fn matrix(n: usize, symmetry: Symmetry, is_complex: bool, share: u64, seed: u64) -> Matrix {
    let mut random = Random(seed);
    let mut a = Matrix {
        rows: n,
        columns: n,
        symmetry,
        row: Vec::new(),
        column: Vec::new(),
        values: Vec::new(),
        is_complex,
    };
    for i in 0..n {
        for j in 0..if symmetry == Symmetry::General { n } else { i + 1 } {
            let value = random.next();
            if i == j || random.0 % 8 < share {
                a.row.push(i as u32);
                a.column.push(j as u32);
                a.values.push(value);
                if is_complex {
                    a.values.push(random.next());
                }
            }
        }
    }
    a
}

/// All entries as (real, imaginary) pairs, row by row.
fn whole(a: &Matrix) -> Vec<Vec<(f64, f64)>> {
    let mut all = vec![vec![(0.0, 0.0); a.columns]; a.rows];
    let parts = if a.is_complex { 2 } else { 1 };
    for (k, value) in a.values.chunks_exact(parts).enumerate() {
        let (i, j) = (a.row[k] as usize, a.column[k] as usize);
        let value = (value[0], value.get(1).copied().unwrap_or(0.0));
        all[i][j].0 += value.0;
        all[i][j].1 += value.1;
        if i != j && a.symmetry == Symmetry::Symmetric {
            all[j][i].0 += value.0;
            all[j][i].1 += value.1;
        }
    }
    all
}

/// Largest difference of two matrices relative to their entries.
fn difference(found: Option<&Matrix>, expected: Option<&Matrix>) -> f64 {
    let (Some(found), Some(expected)) = (found, expected) else {
        assert_eq!(found.is_some(), expected.is_some());
        return 0.0;
    };
    assert_eq!((found.rows, found.columns), (expected.rows, expected.columns));
    let mut largest = 0.0_f64;
    for (found, expected) in whole(found).iter().flatten().zip(whole(expected).iter().flatten()) {
        for (x, y) in [(found.0, expected.0), (found.1, expected.1)] {
            if x.to_bits() != y.to_bits() {
                largest = largest.max((x - y).abs() / y.abs());
            }
        }
    }
    largest
}

fn same(found: &Matrices, expected: &Matrices, tolerance: f64, told: &str) {
    for ((name, found), expected) in [
        ("stiffness", &found.stiffness),
        ("mass", &found.mass),
        ("damping", &found.damping),
        ("structural", &found.structural),
    ]
    .into_iter()
    .zip([
        &expected.stiffness,
        &expected.mass,
        &expected.damping,
        &expected.structural,
    ]) {
        let gap = difference(found.as_ref(), expected.as_ref());
        assert!(gap <= tolerance, "{told}, {name}: {gap:.1e}");
    }
}

/// Six directions of node 7, three of node 12, one each of two more.
fn dofs() -> Vec<(i64, i64)> {
    let six = (1..=6).map(|d| (7, d));
    six.chain((1..=3).map(|d| (12, d))).chain([(30, 2), (45, 1)]).collect()
}

fn models() -> Vec<(&'static str, Matrices)> {
    let n = 11;
    let mut all = Vec::new();
    for (name, symmetry, is_complex, share) in [
        ("full", Symmetry::Symmetric, false, 8),
        ("sparse", Symmetry::Symmetric, false, 1),
        ("unsymmetric", Symmetry::General, false, 5),
        ("complex", Symmetry::Symmetric, true, 4),
    ] {
        let one = |seed| Some(matrix(n, symmetry, is_complex, share, seed));
        all.push((
            name,
            Matrices {
                stiffness: one(1),
                mass: Some(matrix(n, symmetry, false, 1, 2)),
                damping: one(3),
                structural: one(4),
                dofs: dofs(),
                ..Matrices::default()
            },
        ));
    }
    all
}

#[test]
fn op4_and_npz_keep_every_bit_and_dmig_ten_digits() {
    let folder = Folder::new("superelements");
    for (name, model) in models() {
        for (format, file, tolerance, named) in [
            (Format::Op4Text, "a.op4", 0.0, false),
            (Format::Op4Binary, "b.op4", 0.0, false),
            (Format::Npz, "c.npz", 0.0, true),
            (Format::Dmig, "d.pch", 5e-10, true),
            (Format::Dmig, "e.dat", 5e-10, true),
        ] {
            let path = folder.file(file);
            assert_eq!(write(&path, &model, format).unwrap(), vec![path.clone()]);
            let found = read(&path).unwrap();
            same(&found, &model, tolerance, &format!("{name} {file}"));
            assert_eq!(found.dofs, if named { dofs() } else { Vec::new() }, "{name} {file}");
        }
        // The writer of each form, as a caller without a format has it.
        let path = folder.file("f.op4");
        write_op4(&path, &model, Op4Form::Binary).unwrap();
        assert_eq!(
            std::fs::read(&path).unwrap(),
            std::fs::read(folder.file("b.op4")).unwrap()
        );
    }
}

#[test]
fn user_elements_keep_thirteen_digits_and_refuse_damping() {
    let folder = Folder::new("user_elements");
    let path = folder.file("element.inp");
    for (name, model) in models() {
        let bare = Matrices {
            damping: None,
            structural: None,
            ..model.clone()
        };
        let refusal = write(&path, &model, Format::UserElement).unwrap_err().to_string();
        assert!(refusal.contains("damping"), "{refusal}");
        let outcome = write(&path, &bare, Format::UserElement);
        if name == "complex" {
            assert!(outcome.unwrap_err().to_string().contains("real numbers"));
            continue;
        }
        outcome.unwrap();
        let found = read(&path).unwrap();
        same(&found, &bare, 5e-13, name);
        assert_eq!(found.dofs, dofs());
        let longest = std::fs::read_to_string(&path).unwrap().lines().map(str::len).max();
        assert!(longest < Some(256), "Abaqus reads 256 characters of a line");
    }
}

#[test]
fn matrix_market_has_a_file_for_each_matrix() {
    let folder = Folder::new("matrix_market");
    for (name, model) in models() {
        let files = write(&folder.file("red.mtx"), &model, Format::MatrixMarket).unwrap();
        assert_eq!(files.len(), 4);
        let found = read_files(&hbvib_io::Files {
            matrices: None,
            stiffness: Some(&folder.file("red_stiffness.mtx")),
            mass: Some(&folder.file("red_mass.mtx")),
            damping: Some(&folder.file("red_damping.mtx")),
            structural: Some(&folder.file("red_structural.mtx")),
        })
        .unwrap();
        same(&found, &model, 0.0, name);
    }
}

#[test]
fn scipy_reads_what_is_written() {
    let folder = Folder::new("scipy");
    for (name, model) in models() {
        let k = model.stiffness.as_ref().unwrap();
        write_scipy_npz(&folder.file(&format!("{name}_k.npz")), k).unwrap();
        write(&folder.file(&format!("{name}.npz")), &model, Format::Npz).unwrap();
        write(&folder.file(&format!("{name}.mtx")), &model, Format::MatrixMarket).unwrap();
        let values: Vec<String> = whole(k)
            .iter()
            .flatten()
            .map(|(re, im)| format!("{re:e} {im:e}"))
            .collect();
        std::fs::write(folder.file(&format!("{name}.txt")), values.join("\n")).unwrap();
    }
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let python = own.join("../../.venv/bin/python");
    let output = Command::new(if python.exists() { python } else { "python3".into() })
        .arg(own.join("tests/superelements.py"))
        .arg(&folder.0)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(text, "ok\n", "{}", String::from_utf8_lossy(&output.stderr));
}

/// Matrices that a caller made wrongly are refused with what is wrong, and no file is left.
#[test]
fn matrices_that_no_format_holds_are_refused() {
    let folder = Folder::new("refused");
    let path = folder.file("refused.op4");
    let good = models().swap_remove(0).1;
    let with = |change: &dyn Fn(&mut Matrices)| {
        let mut model = good.clone();
        change(&mut model);
        model
    };
    for (words, model) in [
        ("no matrix", Matrices::default()),
        (
            "not finite",
            with(&|m| m.stiffness.as_mut().unwrap().values[3] = f64::NAN),
        ),
        ("out of range", with(&|m| m.stiffness.as_mut().unwrap().row[3] = 11)),
        (
            "different lengths",
            with(&|m| m.stiffness.as_mut().unwrap().row.push(0)),
        ),
        ("square", with(&|m| m.stiffness.as_mut().unwrap().columns = 12)),
        (
            "one size",
            with(&|m| {
                let mass = m.mass.as_mut().unwrap();
                (mass.rows, mass.columns) = (12, 12);
            }),
        ),
        ("degrees of freedom", with(&|m| m.dofs.truncate(3))),
    ] {
        for (_, format) in Format::NAMES {
            if format == Format::MatrixMarket && !matches!(words, "no matrix" | "not finite") {
                continue;
            }
            let sentence = write(&path, &model, format).unwrap_err().to_string();
            assert!(
                sentence.contains(words) && sentence.contains("refused.op4") || format == Format::MatrixMarket,
                "{sentence}"
            );
        }
    }
    assert!(!path.exists());
    let twice = with(&|m| m.dofs[1] = m.dofs[0]);
    assert!(
        write(&path, &twice, Format::Dmig)
            .unwrap_err()
            .to_string()
            .contains("two rows are node 7")
    );
    let missing = folder.file("missing/a.op4");
    assert!(
        write(&missing, &good, Format::Op4Text)
            .unwrap_err()
            .to_string()
            .contains("cannot be written")
    );
}
