//! A stiffness K(1 + iη) from files whose formats name no symmetry, or name it: the response is that of the closed form.

use crate::common::{command, empty_folder, hbvib, printed};
use hbvib_io::{Format, Matrices, Matrix, Symmetry, write};
use std::fmt::Write;
use std::path::Path;

const ETA: f64 = 0.02;

/// Masses 2 in a chain with springs 1.3 to the ground and 1 between them; forces alike move both alike, which leaves the springs to the
/// ground.
fn chain(symmetry: Symmetry) -> Matrices {
    let whole = symmetry == Symmetry::General;
    let (mut row, mut column, mut values) = (vec![0, 1, 1], vec![0, 0, 1], vec![]);
    for k in [2.3, -1.0, 2.3] {
        values.extend([k, ETA * k]);
    }
    if whole {
        row.push(0);
        column.push(1);
        values.extend([-1.0, -ETA]);
    }
    let stiffness = Matrix {
        rows: 2,
        columns: 2,
        symmetry,
        row,
        column,
        values,
        is_complex: true,
    };
    let mass = Matrix {
        symmetry: Symmetry::Symmetric,
        row: vec![0, 1],
        column: vec![0, 1],
        values: vec![2.0, 2.0],
        is_complex: false,
        ..stiffness.clone()
    };
    Matrices {
        stiffness: Some(stiffness),
        mass: Some(mass),
        dofs: vec![(1, 1), (2, 1)],
        ..Matrices::default()
    }
}

fn one(matrix: Option<Matrix>) -> Matrices {
    Matrices {
        stiffness: matrix,
        ..Matrices::default()
    }
}

/// Runs a job and compares its amplitudes with |1/(1.3(1 + iη) - 2ω²)|.
fn has_the_response(name: &str, model: &str) {
    let mut job = String::from(model);
    for dof in 0..2 {
        let _ = writeln!(job, "[[force]]\ndof = {dof}\nvalue = 1.0");
    }
    job += "[forced]\nfrom_hz = 0.1\nto_hz = 0.16\nharmonics = 1\nresponse_dof = 0\n[output]\ncsv = 'r.csv'\n";
    let (output, folder) = hbvib("run", ("lossy_matrices", name), &job);
    assert!(output.status.success(), "{name}: {}", printed(&output.stderr));
    let csv = std::fs::read_to_string(folder.join("r.csv")).unwrap();
    let mut points = 0;
    for line in csv.lines().skip(1) {
        let row: Vec<f64> = line.split(',').take(2).map(|x| x.parse().unwrap()).collect();
        let omega = std::f64::consts::TAU * row[0];
        let expected = 1.0 / (1.3 - 2.0 * omega * omega).hypot(1.3 * ETA);
        assert!(
            (row[1] - expected).abs() <= 1e-8 * expected,
            "{name}: {line}, {expected}"
        );
        points += 1;
    }
    assert!(points > 5, "{name}: {csv}");
}

#[test]
fn formats_without_a_symmetry_take_a_stiffness_with_loss_as_symmetric() {
    let folder = empty_folder("lossy_matrices", "files");
    let place = |path: &Path| path.display().to_string();
    for (file, format, symmetry) in [
        ("general.op4", Format::Op4Text, Symmetry::General),
        ("symmetric.op4", Format::Op4Binary, Symmetry::Symmetric),
        ("general.npz", Format::Npz, Symmetry::General),
        ("symmetric.npz", Format::Npz, Symmetry::Symmetric),
        ("symmetric.pch", Format::Dmig, Symmetry::Symmetric),
        ("general.pch", Format::Dmig, Symmetry::General),
    ] {
        let path = folder.join(file);
        write(&path, &chain(symmetry), format).unwrap();
        has_the_response(file, &format!("model.matrices = '{}'\n", place(&path)));
    }
    let mass = folder.join("mass.mtx");
    write(&mass, &one(chain(Symmetry::General).mass), Format::MatrixMarket).unwrap();
    for (name, symmetry) in [("general", Symmetry::General), ("symmetric", Symmetry::Symmetric)] {
        let path = folder.join(format!("{name}.mtx"));
        write(&path, &one(chain(symmetry).stiffness), Format::MatrixMarket).unwrap();
        let model = format!(
            "model.stiffness = '{}'\nmodel.mass = '{}'\n",
            place(&path),
            place(&mass)
        );
        has_the_response(name, &model);
    }
}

/// A matrix that is neither Hermitian nor symmetric has no such reading.
#[test]
fn a_complex_matrix_without_symmetry_is_refused_by_its_entries() {
    let folder = empty_folder("lossy_matrices", "neither");
    let mut found = chain(Symmetry::General);
    if let Some(a) = &mut found.stiffness {
        a.values[2] = -0.9;
    }
    let path = folder.join("k.npz");
    write(&path, &found, Format::Npz).unwrap();
    let job = format!(
        "model.matrices = '{}'\n[[force]]\ndof = 0\nvalue = 1.0\n[forced]\nfrom_hz = 0.1\nto_hz = 0.16\nharmonics = 1\n",
        path.display()
    );
    let (output, _) = hbvib("run", ("lossy_matrices", "neither_job"), &job);
    let text = printed(&output.stderr);
    assert!(!output.status.success() && text.contains("stiffness["), "{text}");
}

#[test]
fn a_reduction_refuses_a_stiffness_with_loss_and_names_the_keys_that_it_takes() {
    let folder = empty_folder("lossy_matrices", "reduced");
    let path = folder.join("k.npz");
    write(&path, &chain(Symmetry::General), Format::Npz).unwrap();
    let job = format!(
        "model.matrices = '{}'\n[[force]]\ndof = 0\nvalue = 1.0\n[forced]\nfrom_hz = 0.1\nto_hz = 0.16\nharmonics = 1\n",
        path.display()
    );
    std::fs::write(folder.join("job.toml"), job).unwrap();
    let output = command(&["reduce", "job.toml", "--output", "reduced.npz"], &folder);
    let text = printed(&output.stderr);
    assert!(!output.status.success(), "{text}");
    assert!(
        text.contains("the stiffness is complex") && text.contains("loss_factor"),
        "{text}"
    );
}
