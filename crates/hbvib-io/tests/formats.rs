//! Files of other programs give their matrices: scipy, pyNastran and CalculiX; see `data/make.py`.

use hbvib_io::{Matrix, Symmetry, read};
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// The whole matrix, row by row, as (real, imaginary) pairs.
fn whole(matrix: &Matrix) -> Vec<Vec<(f64, f64)>> {
    let mut all = vec![vec![(0.0, 0.0); matrix.columns]; matrix.rows];
    let parts = if matrix.is_complex { 2 } else { 1 };
    for (k, values) in matrix.values.chunks_exact(parts).enumerate() {
        let (i, j) = (matrix.row[k] as usize, matrix.column[k] as usize);
        let (re, im) = (values[0], values.get(1).copied().unwrap_or(0.0));
        let mut add = |i: usize, j: usize, re: f64, im: f64| {
            all[i][j].0 += re;
            all[i][j].1 += im;
        };
        add(i, j, re, im);
        if i != j {
            match matrix.symmetry {
                Symmetry::General => {}
                Symmetry::Symmetric => add(j, i, re, im),
                Symmetry::Hermitian => add(j, i, re, -im),
                Symmetry::Skew => add(j, i, -re, -im),
            }
        }
    }
    all
}

/// The numbers of a JSON array of arrays of numbers that follows a key.
fn table(key: &str, part: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(data("values.json")).unwrap();
    let start = text.find(&format!("\"{key}\"")).unwrap();
    let start = start + text[start..].find(&format!("\"{part}\"")).unwrap();
    let start = start + text[start..].find('[').unwrap();
    let end = start
        + text[start..]
            .find(']')
            .map_or(0, |_| text[start..].find("]\n]").unwrap_or(text.len() - start));
    text[start + 1..=end]
        .split(']')
        .filter(|row| row.contains('['))
        .map(|row| {
            let row = row.split('[').nth(1).unwrap();
            row.split(',').map(|x| x.trim().parse().unwrap()).collect()
        })
        .collect()
}

fn assert_same(name: &str, matrix: &Matrix, tolerance: f64) {
    let (re, im, found) = (table(name, "re"), table(name, "im"), whole(matrix));
    assert_eq!((found.len(), found[0].len()), (re.len(), re[0].len()), "{name}");
    let largest = re.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
    for i in 0..re.len() {
        for j in 0..re[0].len() {
            let gap = (found[i][j].0 - re[i][j]).hypot(found[i][j].1 - im[i][j]);
            let size = if tolerance == 0.0 { 0.0 } else { tolerance * largest };
            assert!(gap <= size, "{name} [{i}, {j}]: {:?}, needs {}", found[i][j], re[i][j]);
        }
    }
}

#[test]
fn matrix_market_files_of_scipy_are_read_to_the_last_bit() {
    for (name, symmetry) in [
        ("general.mtx", Symmetry::General),
        ("symmetric.mtx", Symmetry::Symmetric),
        ("symmetric.mtx.gz", Symmetry::Symmetric),
        ("hermitian.mtx", Symmetry::Hermitian),
        ("complex.mtx", Symmetry::General),
        ("skew.mtx", Symmetry::Skew),
        ("rectangular.mtx", Symmetry::General),
        ("array.mtx", Symmetry::Symmetric),
    ] {
        let found = read(&data(name)).unwrap();
        let matrix = found.stiffness.unwrap();
        assert_eq!(matrix.symmetry, symmetry, "{name}");
        assert_same(name, &matrix, 0.0);
        assert!(found.mass.is_none() && found.damping.is_none() && found.dofs.is_empty());
    }
}

#[test]
fn harwell_boeing_files_of_scipy_are_read() {
    for name in ["general.rua", "symmetric.rsa"] {
        assert_same(name, &read(&data(name)).unwrap().stiffness.unwrap(), 1e-15);
    }
}

#[test]
fn op4_files_of_pynastran_are_read_by_the_names_of_their_matrices() {
    for name in ["dense.op4", "sparse.op4"] {
        let found = read(&data(name)).unwrap();
        assert_same(name, &found.stiffness.unwrap(), 1e-15);
        assert_same(&format!("{name} damping"), &found.damping.unwrap(), 1e-15);
        let mass = whole(&found.mass.unwrap());
        for (i, row) in mass.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                let expected = if i == j { (i + 1) as f64 } else { 0.0 };
                assert!(x.0.to_bits() == expected.to_bits() && x.1.to_bits() == 0);
            }
        }
    }
}

/// Strings as Nastran writes them: several a column, their row packed with the length or a number of its own; complex
/// numbers in single precision, and a matrix of another name in between.
#[test]
fn op4_strings_of_both_kinds_are_read() {
    let end = |columns: usize| format!("{:8}{:8}{:8}\n 1.0000000000000000E+00\n", columns + 1, 1, 1);
    let packed = |row: usize, words: usize| format!("{:8}\n", (words + 1) * 65536 + row);
    let text = format!(
        "       2       5       2       2KGG     1P,3E23.16\n       1       0       8\n{}{}{}{}{}\
         \n       1      -1       2       1GPL     1P,5E16.9\n       1       1       1\n 7.000000000E+00\n{}\
         \n       2      -4       2       3MGG     1P,3E23.16\n       2       0      10\n       5       1\n\
         \x20 1.0000000000000000E+00-2.0000000000000000E+00 3.0000000000000000E+00\n 4.0000000000000000E+00\n\
         \x20      3       4\n-5.0000000000000000E+00 6.0000000000000000E+00\n{}",
        packed(1, 2),
        " 1.5000000000000000E+00\n",
        packed(4, 4),
        "-2.5000000000000000E+00 3.5000000000000000E+00\n",
        end(2).trim_end_matches('\n'),
        end(1).trim_end_matches('\n'),
        end(2),
    );
    let text = text.replace("\n  1.0000000000000000E+00-2", "\n 1.0000000000000000E+00-2");
    let path = std::env::temp_dir().join(format!("hbvib_io_strings_{}.op4", std::process::id()));
    std::fs::write(&path, &text).unwrap();
    let found = read(&path).unwrap_or_else(|error| panic!("{error}\n{text}"));
    std::fs::remove_file(path).unwrap();
    let k = whole(&found.stiffness.unwrap());
    let expected = [[1.5, 0.0], [0.0; 2], [0.0; 2], [-2.5, 0.0], [3.5, 0.0]];
    for (row, expected) in k.iter().zip(expected) {
        assert_eq!(row.iter().map(|x| x.0).collect::<Vec<_>>(), expected);
    }
    let m = whole(&found.mass.unwrap());
    let column: Vec<(f64, f64)> = m.iter().map(|row| row[1]).collect();
    assert_eq!(column, [(1.0, -2.0), (3.0, 4.0), (0.0, 0.0), (-5.0, 6.0)]);
    assert!(found.damping.is_none());
}

#[test]
fn abaqus_files_have_nodes_and_directions_or_equation_numbers() {
    let found = read(&data("wheel_STIF1.mtx")).unwrap();
    assert_same("wheel_STIF1.mtx", &found.stiffness.unwrap(), 1e-15);
    assert_eq!(found.dofs[..4], [(10, 1), (10, 2), (10, 3), (11, 1)]);
    let found = read(&data("wheel_coordinate.mtx")).unwrap();
    let matrix = found.stiffness.unwrap();
    assert_eq!(matrix.symmetry, Symmetry::General);
    assert_same("wheel_coordinate.mtx", &matrix, 1e-15);
    let folder = std::env::temp_dir().join(format!("hbvib_io_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (name, mass) in [("job_MASS2.mtx", true), ("job_DMPV2.mtx", false)] {
        let path = folder.join(name);
        std::fs::copy(data("wheel_STIF1.mtx"), &path).unwrap();
        let found = read(&path).unwrap();
        assert!(found.stiffness.is_none() && found.mass.is_some() == mass && found.damping.is_some() != mass);
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// Frequencies of K and M against those that CalculiX itself computes, 13827.48, 17468.33 and 23241.94 rad/s.
#[test]
fn a_calculix_job_is_read_whole_and_has_the_frequencies_of_calculix() {
    for name in ["sector.sti", "sector.mas", "sector.dof"] {
        let found = read(&data(name)).unwrap();
        let (k, m) = (whole(&found.stiffness.unwrap()), whole(&found.mass.unwrap()));
        let n = found.dofs.len();
        assert_eq!(n, 24);
        assert_eq!(found.dofs[..4], [(3, 1), (3, 2), (3, 3), (4, 1)]);
        for omega in [13827.48_f64, 17468.33, 23241.94] {
            // The determinant of K - omega^2 M changes its sign within the printed digits.
            let sign = |w: f64| {
                let mut a: Vec<Vec<f64>> = (0..n)
                    .map(|i| (0..n).map(|j| k[i][j].0 - w * w * m[i][j].0).collect())
                    .collect();
                let mut negative = 0;
                for p in 0..n {
                    negative += usize::from(a[p][p] < 0.0);
                    let (done, below) = a.split_at_mut(p + 1);
                    let pivot = &done[p];
                    for row in below {
                        let factor = row[p] / pivot[p];
                        for (x, y) in row.iter_mut().zip(pivot) {
                            *x -= factor * y;
                        }
                    }
                }
                negative
            };
            assert_eq!(sign(omega * 1.000_001), sign(omega * 0.999_999) + 1, "{omega}");
        }
    }
}
