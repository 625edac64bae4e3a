//! Damping that is refused: triangles of complex symmetric matrices, factors out of range, modal damping without
//! modes, and structural damping in time.

use crate::common::refusal::refused;
use crate::common::{BASE, harmonics, omega_range, solve_at};
use hbvib::{
    FloquetOptions, Hooks, MatrixKind, MatrixView, Model, Part, SolverOptions, Speed, Status, Storage, TimeOptions,
    Values, VerifyOptions, Waves, floquet, forced_response, time_response,
};

use num_complex::Complex64;
use std::f64::consts::TAU;

fn complex(k: [f64; 4]) -> [Complex64; 4] {
    k.map(|k| k * Complex64::new(1.0, 0.05))
}

#[test]
fn a_triangle_of_a_complex_symmetric_matrix_is_no_hermitian_one() {
    let k = complex([2.0, -1.0, -1.0, 2.0]);
    let mut model = Model::new(2).unwrap();
    for (part, words) in [
        (
            Part::Lower,
            ["stiffness[0,0] has the imaginary part 1.000e-1", "SYMMETRIC_LOWER"],
        ),
        (
            Part::Upper,
            ["stiffness[0,0] has the imaginary part 1.000e-1", "SYMMETRIC_UPPER"],
        ),
        (
            Part::Full,
            [
                "stiffness[0,0] has the imaginary part 1.000e-1, and the diagonal of a Hermitian matrix is real",
                "say SYMMETRIC if that is meant, part=\"symmetric\" of set_matrix",
            ],
        ),
    ] {
        let view = MatrixView::dense_complex(2, &k).part(part);
        refused(
            model.set_matrix(MatrixKind::Stiffness, &view),
            Status::NotHermitian,
            &words,
        );
    }
    let hermitian = [
        2.0.into(),
        Complex64::new(-1.0, 0.3),
        Complex64::new(-1.0, -0.3),
        2.0.into(),
    ];
    let view = MatrixView::dense_complex(2, &hermitian).part(Part::Symmetric);
    refused(
        model.set_matrix(MatrixKind::Stiffness, &view),
        Status::NotHermitian,
        &["stiffness[", "differ by", "GENERAL"],
    );
    let one = complex([2.0, -1.0, 0.0, 2.0]);
    let view = MatrixView::dense_complex(2, &one).part(Part::Symmetric);
    refused(
        model.set_matrix(MatrixKind::Stiffness, &view),
        Status::NotHermitian,
        &["SYMMETRIC_LOWER or SYMMETRIC_UPPER"],
    );
    // Without a promise of symmetry the diagonal shows which triangle is meant.
    refused(
        model.set_matrix(MatrixKind::Stiffness, &MatrixView::dense_complex(2, &one)),
        Status::NotHermitian,
        &["SYMMETRIC_LOWER or SYMMETRIC_UPPER"],
    );
    let mut hermitian_triangle = [2.0.into(), Complex64::new(-1.0, 0.3), Complex64::ZERO, 2.0.into()];
    // Rounding on the diagonal is no loss.
    for rounding in [0.0, 1e-17] {
        hermitian_triangle[3].im = rounding;
        refused(
            model.set_matrix(
                MatrixKind::Stiffness,
                &MatrixView::dense_complex(2, &hermitian_triangle),
            ),
            Status::NotHermitian,
            &["say LOWER or UPPER"],
        );
    }
    let view = MatrixView::dense_complex(2, &k).part(Part::Symmetric);
    refused(
        model.set_matrix(MatrixKind::Mass, &view),
        Status::NotHermitian,
        &["mass must be real symmetric or Hermitian"],
    );
    // Rounding on the diagonal of a Hermitian triangle is none of this.
    let mut rounded = hermitian;
    rounded[3].im = 1e-16;
    let view = MatrixView::dense_complex(2, &rounded).part(Part::Lower);
    model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
}

#[test]
fn a_sparse_triangle_with_a_complex_diagonal_is_refused_in_a_sector_and_for_a_diameter() {
    // [2, −1; −1, 2] of (1 + 0.05i) as compressed columns: the lower triangle, then the upper one.
    let loss = Complex64::new(1.0, 0.05);
    let values = [2.0 * loss, -loss, 2.0 * loss];
    let lower: ([i64; 3], [i64; 3]) = ([0, 2, 3], [0, 1, 1]);
    let upper: ([i64; 3], [i64; 3]) = ([0, 1, 3], [0, 0, 1]);
    for ((col_ptr, row_idx), part, word, kept) in [
        (lower, Part::Lower, "SYMMETRIC_LOWER", Part::SymmetricLower),
        (upper, Part::Upper, "SYMMETRIC_UPPER", Part::SymmetricUpper),
    ] {
        let mut model = Model::cyclic(2, 6).unwrap();
        let view = MatrixView {
            storage: Storage::Csc {
                col_ptr: &col_ptr,
                row_idx: &row_idx,
            },
            values: Values::Complex(&values),
            ..MatrixView::dense(2, &[])
        };
        let words = ["stiffness[0,0] has the imaginary part 1.000e-1", word];
        let status = Status::NotHermitian;
        refused(
            model.set_matrix(MatrixKind::Stiffness, &view.part(part)),
            status,
            &words,
        );
        refused(
            model.set_diameter(MatrixKind::Stiffness, 1, &view.part(part)),
            status,
            &words,
        );
        // As what it is it is taken.
        model.set_matrix(MatrixKind::Stiffness, &view.part(kept)).unwrap();
    }
}

#[test]
fn numbers_of_damping_out_of_range_are_refused() {
    let mut model = BASE.sector();
    refused(
        model.set_loss_factor(-0.1),
        Status::Argument,
        &["loss_factor = -0.1", ">= 0"],
    );
    refused(
        model.set_loss_factor(f64::NAN),
        Status::NotFinite,
        &["loss_factor = NaN"],
    );
    refused(
        model.set_modal_damping(&[0.01, -0.02]),
        Status::Argument,
        &["ratios[1] = -0.02", ">= 0"],
    );
    refused(
        model.set_modal_damping(&[0.01, f64::INFINITY]),
        Status::NotFinite,
        &["ratios[1] = inf"],
    );
    refused(
        model.set_modal_damping(&[0.01; 5]),
        Status::Argument,
        &["ratios[4] = 0.01", "has 4"],
    );
    model.set_modal_damping(&[0.01]).unwrap();
    let mass = [1.0; 16];
    for which in [MatrixKind::Mass, MatrixKind::Stiffness] {
        refused(
            model.set_matrix(which, &MatrixView::dense(4, &mass)),
            Status::Argument,
            &["modal damping", "set it last"],
        );
    }
    refused(model.fix(&[0]), Status::Argument, &["modal damping", "set it last"]);
    let mut large = Model::new(2001).unwrap();
    refused(
        large.set_modal_damping(&[0.01]),
        Status::Unsupported,
        &["2001", "at most 2000", "Rayleigh"],
    );
}

/// A way to give structural damping to the blisk, and words of its viscous equivalent at 208.85 Hz.
type Way = (&'static str, fn(&mut Model), [&'static str; 3]);

const WAYS: [Way; 3] = [
    (
        "matrix",
        |model| {
            let mut d = [0.0; 16];
            d[0] = 1e3;
            let view = MatrixView::dense(4, &d);
            model.set_matrix(MatrixKind::Structural, &view).unwrap();
        },
        ["no causal law", "viscous equivalent", "D/1312"],
    ),
    (
        "loss factor",
        |model| model.set_loss_factor(0.01).unwrap(),
        ["no causal law", "viscous equivalent", "beta_stiffness = 7.62"],
    ),
    (
        "complex stiffness",
        |model| {
            let k: Vec<Complex64> = BASE
                .matrices()
                .own
                .iter()
                .map(|k| k * Complex64::new(1.0, 0.01))
                .collect();
            let view = MatrixView::dense_complex(4, &k).part(Part::Symmetric);
            model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
        },
        ["no causal law", "viscous equivalent", "Im K/1312"],
    ),
];

#[test]
fn structural_damping_is_refused_in_time_with_its_viscous_equivalent() {
    let omega = TAU * 208.85;
    for (name, give, words) in WAYS {
        println!("{name}");
        let mut model = BASE.sector();
        give(&mut model);
        let options = TimeOptions {
            omega,
            ..TimeOptions::default()
        };
        refused(
            time_response(&model, &options, &mut Hooks::default()),
            Status::Unsupported,
            &words,
        );
        let branch = solve_at(&model, &harmonics(3), omega);
        refused(
            hbvib::verify(&model, &branch, 0, &VerifyOptions::default(), &mut Hooks::default()),
            Status::Unsupported,
            &words,
        );
        refused(
            floquet(&model, &branch, 0, &FloquetOptions::default(), &mut Hooks::default()),
            Status::Unsupported,
            &words,
        );
        let solver = SolverOptions {
            stability: Some(Waves::Wheel),
            ..harmonics(3)
        };
        let range = omega_range(omega, omega);
        refused(
            forced_response(&model, &solver, &range, &mut Hooks::default()),
            Status::Unsupported,
            &words,
        );
    }
}

#[test]
fn a_rotation_out_of_range_is_refused_by_name() {
    let mut model = BASE.sector();
    let symmetric = [
        0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    ];
    for (part, words) in [
        (Part::Full, ["gyroscopic must be skew-symmetric", "2.000e0"]),
        (Part::General, ["gyroscopic must be skew-symmetric", "2.000e0"]),
        (
            Part::Symmetric,
            ["gyroscopic must be skew-symmetric", "passed as SYMMETRIC"],
        ),
    ] {
        let view = MatrixView::dense(4, &symmetric).part(part);
        refused(
            model.set_matrix(MatrixKind::Gyroscopic, &view),
            Status::NotHermitian,
            &words,
        );
    }
    // One triangle of a skew-symmetric matrix is enough.
    let view = MatrixView::dense(4, &symmetric).part(Part::Lower);
    model.set_matrix(MatrixKind::Gyroscopic, &view).unwrap();
    let previous = MatrixView::dense(4, &symmetric);
    refused(
        model.set_coupling_previous(MatrixKind::Gyroscopic, &previous),
        Status::Unsupported,
        &["gyroscopic has a symmetry"],
    );
    refused(
        model.set_speed(Speed::Fixed(f64::NAN)),
        Status::NotFinite,
        &["speed = NaN"],
    );
    refused(
        model.set_speed(Speed::PerOmega(f64::INFINITY)),
        Status::NotFinite,
        &["per_omega = inf"],
    );
    refused(
        model.set_preload_at_speed(0, 1.0, f64::NAN),
        Status::NotFinite,
        &["per_speed2 = NaN"],
    );
    refused(
        model.set_preload_at_speed(0, -1.0, 1.0),
        Status::Argument,
        &["preload = -1", ">= 0"],
    );
    refused(
        model.set_preload_at_speed(0, f64::INFINITY, 1.0),
        Status::Argument,
        &["preload = inf", "finite"],
    );
    refused(
        model.set_preload_at_speed(7, 1.0, 1.0),
        Status::Index,
        &["id = 7", "1 contacts"],
    );
    model.set_preload_at_speed(0, 1.0, -1.0).unwrap();
    refused(
        model.set_speed(Speed::PerOmega(0.5)),
        Status::Argument,
        &["per_speed2 = -1 of contact 0", ">= 0"],
    );
    model.set_preload(0, 1.0).unwrap();
    model.set_speed(Speed::PerOmega(0.5)).unwrap();
    refused(
        model.set_preload_at_speed(0, 1.0, -1.0),
        Status::Argument,
        &["per_speed2 = -1", ">= 0"],
    );
    for (x, y, m_e, phase, status, words) in [
        (4, 1, 1.0, 0.0, Status::Index, ["dof_x = 4", "0 .. 3"]),
        (0, 9, 1.0, 0.0, Status::Index, ["dof_y = 9", "0 .. 3"]),
        (1, 1, 1.0, 0.0, Status::Argument, ["both 1", "different"]),
        (0, 1, f64::NAN, 0.0, Status::NotFinite, ["m_e = NaN", "finite"]),
        (0, 1, 1.0, f64::INFINITY, Status::NotFinite, ["phase = inf", "finite"]),
    ] {
        refused(model.add_unbalance(x, y, m_e, phase), status, &words);
    }
}
