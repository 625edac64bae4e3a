//! Damped modes of chains with damping ratios of their lowest modes, against the eigenvalues of each mode in closed form, and beside
//! Coriolis forces and a dashpot against those with the whole matrix.

use crate::common::models;
use hbvib::{Hooks, LinearContacts, MatrixKind, Model, Speed, damped_modes};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Natural frequency of the k-th mode, from 1 on, of a chain of `n` unit masses between walls.
fn natural(n: usize, k: usize) -> f64 {
    2.0 * (k as f64 * PI / 2.0 / (n + 1) as f64).sin()
}

fn ratio(k: usize) -> f64 {
    0.003 * k as f64
}

fn found(model: &Model, count: usize) -> Vec<Complex64> {
    damped_modes(model, 0, LinearContacts::Free, count, &mut Hooks::default())
        .unwrap()
        .eigenvalue
}

#[test]
fn ratios_of_the_lowest_modes_are_those_of_the_damped_modes() {
    for n in [10, 33, 101, 200, 401, 1000] {
        let damped = 6;
        let mut model = models::unit_chain(n).build();
        let ratios: Vec<f64> = (1..=damped).map(ratio).collect();
        model.set_modal_damping(&ratios).unwrap();
        let values = found(&model, damped + 3);
        for k in 1..=damped + 3 {
            let zeta = if k > damped { 0.0 } else { ratio(k) };
            let exact = natural(n, k) * Complex64::new(-zeta, (1.0 - zeta * zeta).sqrt());
            // Rounding of the stiffness counts by the square of the frequency.
            let allowed = 1e-10 + 40.0 * f64::EPSILON / natural(n, k).powi(2);
            let off = (values[k - 1] - exact).norm() / exact.norm();
            assert!(off < allowed, "{n}, mode {k}: {} for {exact}, {off:e}", values[k - 1]);
        }
    }
}

#[test]
fn beside_coriolis_forces_they_are_those_of_the_whole_matrix() {
    for n in [33, 101, 160, 300] {
        let mut g = vec![0.0; n * n];
        for i in 1..n {
            (g[i * n + i - 1], g[(i - 1) * n + i]) = (0.01, -0.01);
        }
        let chain = |damping: &[f64]| {
            models::unit_chain(n)
                .damping(damping)
                .set(MatrixKind::Gyroscopic, &g)
                .speed(Speed::Fixed(0.7))
                .build()
        };
        let mut c = vec![0.0; n * n];
        c[n / 3 * (n + 1)] = 0.02;
        let mut own = chain(&c);
        own.set_modal_damping(&(1..=5).map(ratio).collect::<Vec<_>>()).unwrap();
        let shape = |r: usize, i: usize| {
            (2.0 / (n + 1) as f64).sqrt() * (r as f64 * (i + 1) as f64 * PI / (n + 1) as f64).sin()
        };
        for r in 1..=5 {
            for j in 0..n {
                for i in 0..n {
                    c[j * n + i] += 2.0 * ratio(r) * natural(n, r) * shape(r, i) * shape(r, j);
                }
            }
        }
        let (own, whole) = (found(&own, 9), found(&chain(&c), 9));
        for (a, b) in own.iter().zip(&whole) {
            let off = (a - b).norm() / b.norm();
            assert!(off < 1e-9, "{n}: {a} for {b}, {off:e}");
        }
    }
}
