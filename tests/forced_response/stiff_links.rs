//! Stiffness far above that of its structure, and complex stiffness, at sizes of every way to the flexibility: chains of which two
//! neighbours are linked by a penalty, against the closed form of the chain in which they are one mass; K(1 + iη) against the loss
//! factor η; and contacts that press and hardly vibrate.

use crate::common::depth::some_of;
use crate::common::models::dense;
use crate::common::{at_dof, harmonics, omega_range};
use hbvib::{
    Branch, Constant, Contact, Flexibility, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Part, SolverOptions,
    Status, Storage, Values, forced_response,
};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Frequency, damping C = βK of the soft springs, and stiffness of the contact that sticks.
const OMEGA: f64 = 0.45;
const BETA: f64 = 1e-2;
const KT: f64 = 0.3;

/// Springs between the masses of a chain with both ends held, and to the ground.
fn springs(n: usize) -> (Vec<f64>, Vec<f64>) {
    let wave = |i: usize, a: f64| (a * i as f64).sin();
    (
        (0..=n).map(|i| 1.25 + 0.7 * wave(i, 1.3)).collect(),
        (0..n).map(|i| 0.05 * (1.0 + 0.5 * wave(i, 2.1))).collect(),
    )
}

/// Diagonal and off-diagonal of the tridiagonal stiffness.
fn stiffness(n: usize) -> (Vec<f64>, Vec<f64>) {
    let (between, ground) = springs(n);
    let diagonal = (0..n).map(|i| between[i] + between[i + 1] + ground[i]).collect();
    (diagonal, (1..n).map(|i| -between[i]).collect())
}

fn tridiagonal(model: &mut Model, kind: MatrixKind, diagonal: &[f64], beside: &[f64]) {
    let n = diagonal.len();
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for j in 0..n {
        for i in j.saturating_sub(1)..(j + 2).min(n) {
            rows.push(i as i64);
            values.push(if i == j { diagonal[j] } else { beside[i.min(j)] });
        }
        starts.push(rows.len() as i64);
    }
    let view = MatrixView {
        storage: Storage::Csc {
            col_ptr: &starts,
            row_idx: &rows,
        },
        values: Values::Real(&values),
        ..MatrixView::dense(n, &[])
    };
    model.set_matrix(kind, &view).unwrap();
}

/// The chain with a spring `link` between the masses n/2 and n/2 + 1, and a contact and the force on the mass before.
fn linked(n: usize, link: f64) -> Model {
    let (mut diagonal, mut beside) = stiffness(n);
    let mut model = Model::new(n).unwrap();
    tridiagonal(&mut model, MatrixKind::Mass, &vec![1.0; n], &vec![0.0; n - 1]);
    let scaled = |a: &[f64]| a.iter().map(|k| BETA * k).collect::<Vec<_>>();
    tridiagonal(&mut model, MatrixKind::Damping, &scaled(&diagonal), &scaled(&beside));
    let i = n / 2;
    diagonal[i] += link;
    diagonal[i + 1] += link;
    beside[i] -= link;
    tridiagonal(&mut model, MatrixKind::Stiffness, &diagonal, &beside);
    model.add_contact(&Contact::jenkins(i - 1, None, KT, 0.5, 1e9)).unwrap();
    model.add_force(i - 1, 1, Complex64::ONE).unwrap();
    model
}

/// Motion of the forced mass where the linked ones are one, by elimination from both ends.
fn merged(n: usize) -> Complex64 {
    let (diagonal, beside) = stiffness(n);
    let damped = |k: f64| k * Complex64::new(1.0, OMEGA * BETA);
    let i = n / 2;
    let mut z: Vec<Complex64> = diagonal.iter().map(|&k| damped(k) - OMEGA * OMEGA).collect();
    z[i - 1] += KT;
    let joined = z.remove(i + 1);
    z[i] += joined + 2.0 * damped(beside[i]);
    let mut e: Vec<Complex64> = beside.iter().map(|&k| damped(k)).collect();
    e.remove(i);
    let mut left = z[0];
    for k in 1..i {
        left = z[k] - e[k - 1] * e[k - 1] / left;
    }
    let last = z.len() - 1;
    let mut right = z[last];
    for k in (i..last).rev() {
        right = z[k] - e[k] * e[k] / right;
    }
    (left - e[i - 1] * e[i - 1] / right).inv()
}

fn sweep(model: &Model, solver: &SolverOptions, range: (f64, f64), at: &[f64]) -> Branch {
    let range = ForcedOptions {
        at,
        ..omega_range(range.0, range.1)
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn a_penalty_is_a_rigid_link_at_every_size() {
    let sizes: &[usize] = some_of(&[110, 300, 610, 1000], &[110, 130, 200, 300, 500, 610, 700, 1000, 1500]);
    for &n in sizes {
        let exact = merged(n).norm();
        for link in [1e6, 1e8, 1e9] {
            let model = linked(n, link);
            for fixed in [true, false] {
                let given = SolverOptions::default();
                let solver = SolverOptions {
                    harmonics: if fixed { 3 } else { given.harmonics },
                    tolerance: if fixed { 0.0 } else { given.tolerance },
                    response_dof: Some(n / 2 - 1),
                    ..given
                };
                let branch = sweep(&model, &solver, (0.4, 0.5), &[OMEGA]);
                let case = format!("{n} masses, link {link:e}, {fixed}: {}", branch.reduction().certificate);
                assert_eq!(branch.status(), Status::Ok, "{case}");
                let found = branch.at(0)[0].amplitude;
                // The link itself gives 1/link, and K as stored has lost 1e-16 link of the soft springs beside it.
                let error = (found / exact - 1.0).abs();
                assert!(error < 1e-5 + 1e-13 * link, "{case}: {found}, needs {exact}");
            }
        }
    }
}

#[test]
fn a_basis_that_rounding_spoils_is_refused_where_it_was_asked_for() {
    let range = omega_range(0.4, 0.5);
    let solver = SolverOptions {
        flexibility: Flexibility::Krylov,
        ..harmonics(3)
    };
    let refused = forced_response(&linked(700, 1e8), &solver, &range, &mut Hooks::default()).unwrap_err();
    assert_eq!(refused.status, Status::NoConvergence);
    assert!(refused.message().contains("penalty"), "{}", refused.message());
}

#[test]
fn one_loss_in_a_complex_stiffness_is_the_loss_factor_at_every_size() {
    const ETA: f64 = 0.02;
    for n in [30, 150, some_of(320, 590), 620] {
        let (diagonal, beside) = stiffness(n);
        let real = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 => diagonal[i],
            1 => beside[i.min(j)],
            _ => 0.0,
        });
        let complex = real.map(|k| k * Complex64::new(1.0, ETA));
        let models = [true, false].map(|is_complex| {
            let mut model = Model::new(n).unwrap();
            tridiagonal(&mut model, MatrixKind::Mass, &vec![1.0; n], &vec![0.0; n - 1]);
            if is_complex {
                let view = MatrixView::dense_complex(n, complex.as_slice()).part(Part::Symmetric);
                model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
            } else {
                let view = MatrixView::dense(n, real.as_slice());
                model.set_matrix(MatrixKind::Stiffness, &view).unwrap();
                model.set_loss_factor(ETA).unwrap();
            }
            model.set_rayleigh(1e-3, 2e-3).unwrap();
            for (dof, limit) in [(n / 3, 0.05), (n - 2, 0.3)] {
                model.add_contact(&Contact::jenkins(dof, None, KT, limit, 1.0)).unwrap();
            }
            model.add_force(n / 2, 1, Complex64::new(0.8, 0.3)).unwrap();
            model
        });
        let solver = at_dof(n / 3, harmonics(3));
        let at = [0.31, 0.4, 0.437, 0.5];
        let [complex, real] = models.each_ref().map(|model| sweep(model, &solver, (0.3, 0.5), &at));
        let ways = [&complex, &real].map(|branch| branch.reduction().flexibility_way);
        assert_eq!(ways[0], ways[1], "{n} masses");
        assert!(complex.reduction().basis == real.reduction().basis);
        for i in 0..at.len() {
            let (a, b) = (complex.at(i)[0].amplitude, real.at(i)[0].amplitude);
            assert!((a / b - 1.0).abs() < 1e-7, "{n} masses at {}: {a}, needs {b}", at[i]);
        }
        // Alone each frequency is solved by factors.
        let alone = sweep(&models[0], &solver, (0.437, 0.437), &[]).amplitude()[0];
        let found = complex.at(2)[0].amplitude;
        assert!((found / alone - 1.0).abs() < 1e-7, "{n} masses: {found}, needs {alone}");
    }
}

/// Two equal pairs of masses under equal forces, with a preloaded contact between them whose sides move alike but for `difference`.
fn pair(contact: &Contact, difference: f64) -> (Model, Complex64) {
    let stiffness = DMatrix::from_row_slice(
        4,
        4,
        &[
            2.0, -1.0, -0.3, 0.0, -1.0, 2.0, 0.0, -0.3, -0.3, 0.0, 2.0, -1.0, 0.0, -0.3, -1.0, 2.0,
        ],
    );
    let model = dense(DMatrix::identity(4, 4).as_slice(), stiffness.as_slice())
        .damping((0.02 * &stiffness).as_slice())
        .contact(contact)
        .force(0, 1, Complex64::ONE)
        .force(1, 1, 1.0 + difference)
        .build();
    let omega = 0.5;
    let z = stiffness.map(|k| k * Complex64::new(1.0, 0.02 * omega))
        - DMatrix::identity(4, 4) * Complex64::from(omega * omega);
    let force = DVector::from_vec(vec![
        Complex64::ONE,
        (1.0 + difference).into(),
        Complex64::ZERO,
        Complex64::ZERO,
    ]);
    (model, z.lu().solve(&force).unwrap()[0])
}

#[test]
fn a_pressed_contact_whose_sides_move_alike_has_a_first_point() {
    let mut stop = Contact::unilateral(Some(2), Some(3), 0.4, 0.0);
    stop.set(Constant::Preload, 0.06).unwrap();
    let damper = Contact::friction_2d([Some(0), Some(2)], [Some(1), Some(3)], (0.4, 0.4), 0.5, 0.06);
    let cases = [stop, damper].into_iter().flat_map(|contact| {
        let differences = [0.0, 1e-15, 1e-13, 1e-11, 1e-9];
        differences.map(|difference| (contact.clone(), difference))
    });
    for (contact, difference) in cases {
        let (model, exact) = pair(&contact, difference);
        let solver = at_dof(0, harmonics(3));
        let found = sweep(&model, &solver, (0.5, 0.5), &[]).amplitude()[0];
        assert!(
            (found / exact.norm() - 1.0).abs() < 1e-8,
            "{difference:e}: {found}, needs {exact}"
        );
        let branch = sweep(&model, &solver, (0.6, 1.6), &[]);
        assert_eq!(branch.status(), Status::Ok);
    }
}
