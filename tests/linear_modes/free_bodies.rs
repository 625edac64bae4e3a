//! Damped modes and responses of structures that nothing holds, of every size: their rigid motion is no vibration, whatever rounding
//! makes of its two eigenvalues zero.

use crate::common::models::dense;
use crate::common::{all_harmonics, harmonics, sweep};
use hbvib::{Contact, Hooks, LinearContacts, MatrixKind, MatrixView, Model, Speed, damped_modes};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::PI;

const BETA: f64 = 3e-3;

/// M, K and G of a free chain of masses 1/n and springs n in x and, where a gyroscopic force couples them, the same in y.
fn matrices(n: usize, gyroscopic: Option<f64>) -> [DMatrix<f64>; 3] {
    let order = n * if gyroscopic.is_some() { 2 } else { 1 };
    let stiffness = DMatrix::from_fn(order, order, |i, j| {
        let (row, column) = (i % n, j % n);
        match (i / n == j / n, row.abs_diff(column)) {
            (true, 0) if row == 0 || row == n - 1 => n as f64,
            (true, 0) => 2.0 * n as f64,
            (true, 1) => -(n as f64),
            _ => 0.0,
        }
    });
    let mass = DMatrix::from_diagonal_element(order, order, 1.0 / n as f64);
    let mut skew = DMatrix::zeros(order, order);
    if let Some(force) = gyroscopic {
        // Columns: a force in y from a velocity in x, and the opposite.
        for i in 0..n {
            skew[(n + i, i)] = force / n as f64;
            skew[(i, n + i)] = -force / n as f64;
        }
    }
    [mass, stiffness, skew]
}

fn free_chain(n: usize, gyroscopic: Option<f64>) -> Model {
    let [mass, stiffness, skew] = matrices(n, gyroscopic);
    let order = mass.nrows();
    let mut model = Model::new(order).unwrap();
    let mut set = |kind, a: &DMatrix<f64>| model.set_matrix(kind, &MatrixView::dense(order, a.as_slice())).unwrap();
    set(MatrixKind::Mass, &mass);
    set(MatrixKind::Stiffness, &stiffness);
    if gyroscopic.is_some() {
        set(MatrixKind::Gyroscopic, &skew);
        model.set_speed(Speed::Fixed(1.0)).unwrap();
    }
    model.set_rayleigh(0.0, BETA).unwrap();
    model
}

/// ω of the k-th mode of the free chain.
fn natural(n: usize, k: usize) -> f64 {
    2.0 * n as f64 * (0.5 * PI * k as f64 / n as f64).sin()
}

#[test]
fn the_rigid_motion_is_no_damped_mode() {
    for n in [12, 60, 99, 100, 101, 130, 260] {
        let model = free_chain(n, None);
        let found = damped_modes(&model, 0, LinearContacts::Free, 5, &mut Hooks::default()).unwrap();
        assert_eq!(found.count(), 5, "{n}");
        for k in 0..5 {
            let own = natural(n, k + 1);
            let half = 0.5 * BETA * own * own;
            let right = Complex64::new(-half, (own * own - half * half).sqrt());
            let off = (found.eigenvalue[k] - right).norm() / right.norm();
            assert!(off < 1e-9, "{n}, mode {k}: {} {right}", found.eigenvalue[k]);
        }
    }
}

/// Under damping αM the rigid motion has the eigenvalues 0 and −α, which is no vibration.
#[test]
fn the_rigid_motion_under_mass_damping_is_no_damped_mode() {
    const ALPHA: f64 = 0.2;
    for n in [12, 60, 99, 100, 101, 130, 260, 400] {
        let mut model = free_chain(n, None);
        model.set_rayleigh(ALPHA, 0.0).unwrap();
        let found = damped_modes(&model, 0, LinearContacts::Free, 5, &mut Hooks::default()).unwrap();
        assert_eq!(found.count(), 5, "{n}");
        for k in 0..5 {
            let own = natural(n, k + 1);
            let right = Complex64::new(-0.5 * ALPHA, (own * own - 0.25 * ALPHA * ALPHA).sqrt());
            let off = (found.eigenvalue[k] - right).norm() / right.norm();
            assert!(off < 1e-9, "{n}, mode {k}: {} {right}", found.eigenvalue[k]);
        }
    }
}

/// M and K of a free beam of EI = ρA = L = 1 by Hermite elements, whose rotations have another unit than its deflections.
fn free_beam(elements: usize) -> Model {
    let (n, length) = (2 * elements + 2, 1.0 / elements as f64);
    let (mut mass, mut stiffness) = (DMatrix::<f64>::zeros(n, n), DMatrix::<f64>::zeros(n, n));
    let l = length;
    let inertia = [
        [156.0, 22.0 * l, 54.0, -13.0 * l],
        [22.0 * l, 4.0 * l * l, 13.0 * l, -3.0 * l * l],
        [54.0, 13.0 * l, 156.0, -22.0 * l],
        [-13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l],
    ];
    let bending = [
        [12.0, 6.0 * l, -12.0, 6.0 * l],
        [6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l],
        [-12.0, -6.0 * l, 12.0, -6.0 * l],
        [6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l],
    ];
    for element in 0..elements {
        for i in 0..4 {
            for j in 0..4 {
                mass[(2 * element + i, 2 * element + j)] += inertia[i][j] * l / 420.0;
                stiffness[(2 * element + i, 2 * element + j)] += bending[i][j] / l.powi(3);
            }
        }
    }
    dense(mass.as_slice(), stiffness.as_slice()).build()
}

/// cosh β cos β = 1 has β₁ = 4.730040744862704: the frequencies of the rigid motions are rounding, and no place to search about.
#[test]
fn the_first_mode_of_a_free_beam_is_its_first_bending_however_few_are_requested() {
    const FIRST: f64 = 4.730_040_744_862_704;
    for elements in [20, 49, 51, 100, 120, 200] {
        for (alpha, beta) in [(0.0, 0.0), (0.0, 1e-4), (0.5, 1e-4)] {
            let mut model = free_beam(elements);
            model.set_rayleigh(alpha, beta).unwrap();
            for count in [1, 2, 4] {
                let found = damped_modes(&model, 0, LinearContacts::Free, count, &mut Hooks::default()).unwrap();
                let own = FIRST * FIRST;
                let half = 0.5 * (alpha + beta * own * own);
                let right = Complex64::new(-half, (own * own - half * half).sqrt());
                let off = (found.eigenvalue[0] - right).norm() / right.norm();
                // The error of the mesh falls by the fourth power of its elements.
                assert!(
                    off < 1e-6 + 0.5 * (elements as f64).powi(-4),
                    "{elements} elements, {alpha} {beta}, {count}: {}",
                    found.eigenvalue[0]
                );
            }
        }
    }
}

/// With x + iy both directions are one chain: λ² ± igλ + ω²(1 + βλ) = 0. The rigid motion turns with λ = ig.
#[test]
fn a_free_body_under_gyroscopic_forces_has_its_whirls() {
    let force = 2.0;
    for n in [10, 49, 51, 65, 130] {
        let model = free_chain(n, Some(force));
        let found = damped_modes(&model, 0, LinearContacts::Free, 5, &mut Hooks::default()).unwrap();
        let mut right = Vec::new();
        for k in 0..6 {
            let own = natural(n, k).powi(2);
            for sense in [1.0, -1.0] {
                let b = Complex64::new(BETA * own, sense * force);
                let root = (b * b - 4.0 * own).sqrt();
                right.extend(
                    [0.5 * (root - b), -0.5 * (root + b)]
                        .into_iter()
                        .filter(|z| z.im > 1e-6),
                );
            }
        }
        right.sort_by(|a, b| a.im.total_cmp(&b.im));
        assert_eq!(found.count(), 5, "{n}");
        for (k, right) in right.iter().enumerate().take(5) {
            let off = (found.eigenvalue[k] - right).norm() / right.norm();
            assert!(off < 1e-9, "{n}, mode {k}: {} {right}", found.eigenvalue[k]);
        }
    }
}

/// A stuck slider within the body: the stored points of a sweep against direct factors.
#[test]
fn a_free_body_under_gyroscopic_forces_has_a_response() {
    const KT: f64 = 2.0;
    for n in [49, 51, 65] {
        let mut model = free_chain(n, Some(1.0));
        model
            .add_contact(&Contact::jenkins(3, Some(n - 7), KT, 0.3, 1e9))
            .unwrap();
        model.add_force(10, 1, Complex64::ONE).unwrap();
        let solver = harmonics(1);
        let branch = sweep(&model, &solver, 1.3, 8.0, &[]);
        let order = 2 * n;
        let [mass, stiffness, skew] = matrices(n, Some(1.0));
        for point in [0, branch.points() / 2, branch.points() - 1] {
            let omega = branch.omega_at(point).unwrap();
            let mut dynamic = DMatrix::from_fn(order, order, |i, j| {
                Complex64::new(
                    stiffness[(i, j)] - omega * omega * mass[(i, j)],
                    omega * (BETA * stiffness[(i, j)] + skew[(i, j)]),
                )
            });
            for (i, j, sign) in [(3, 3, 1.0), (n - 7, n - 7, 1.0), (3, n - 7, -1.0), (n - 7, 3, -1.0)] {
                dynamic[(i, j)] += sign * KT;
            }
            let mut load = DVector::zeros(order);
            load[10] = Complex64::ONE;
            let right = dynamic.lu().solve(&load).unwrap();
            let found = all_harmonics(&branch, point);
            let off = (0..order).fold(0.0_f64, |most, i| most.max((found[order + i] - right[i]).norm()));
            assert!(off < 1e-8 * right.camax(), "{n} at {omega}: {off:e}");
        }
    }
}
