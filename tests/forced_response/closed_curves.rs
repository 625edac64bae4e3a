//! A sweep whose step enters a closed curve beside its own ends there after three rounds, with the curve.

use hbvib::analysis::forced_response::forced_response;
use hbvib::contact::Contact;
use hbvib::error::Status;
use hbvib::hooks::Hooks;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{ForcedOptions, SolverOptions};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Deviations of the blades' damping and forces.
const DAMPING: [f64; 7] = [
    -0.025261436780700905,
    -0.009141948729886745,
    0.027026256587740105,
    0.09675440170494265,
    -0.013481016367095675,
    -0.01217793395395523,
    0.050115680063784564,
];
const FORCE: [f64; 7] = [
    0.051065340875004,
    -0.04798223799040709,
    -0.08343099213279848,
    0.013822287976049983,
    0.035027244267469504,
    -0.022238372784139204,
    -0.053820292005040384,
];

/// Seven blades on sectors of a disk, with a gap between neighbours, under engine order 1.
fn wheel() -> Model {
    let n = 14;
    let [ground, blade, disk, mass] = [
        1.4736210131921994,
        1.1205097860825588,
        0.3119729162289655,
        1.1882572844807984,
    ];
    let (alpha, beta) = (0.005, 0.02);
    let [mut k, mut m, mut c] = [const { [0.0; 14 * 14] }; 3];
    let spring = |a: &mut [f64], x: usize, y: usize, value: f64| {
        for (row, column, value) in [(x, x, value), (y, y, value), (x, y, -value), (y, x, -value)] {
            a[row * n + column] += value;
        }
    };
    for i in 0..7 {
        let (hub, tip) = (2 * i, 2 * i + 1);
        k[hub * n + hub] += ground;
        spring(&mut k, hub, tip, blade);
        spring(&mut k, hub, 2 * ((i + 1) % 7), disk);
        (m[hub * n + hub], m[tip * n + tip]) = (mass, 1.0);
    }
    for ((c, m), k) in c.iter_mut().zip(&m).zip(&k) {
        *c = alpha * m + beta * k;
    }
    for (i, deviation) in DAMPING.iter().enumerate() {
        spring(&mut c, 2 * i, 2 * i + 1, (beta * blade + alpha) * deviation);
    }
    let mut model = Model::new(n).unwrap();
    for (kind, values) in [
        (MatrixKind::Mass, &m),
        (MatrixKind::Stiffness, &k),
        (MatrixKind::Damping, &c),
    ] {
        model.set_matrix(kind, &MatrixView::dense(n, values)).unwrap();
    }
    for (i, deviation) in FORCE.iter().enumerate() {
        let force = Complex64::new(0.22993808207094216, -0.008379480743666401) * Complex64::cis(-TAU * i as f64 / 7.0);
        model.add_force(2 * i + 1, 1, force * (1.0 + deviation)).unwrap();
        let next = 2 * ((i + 1) % 7) + 1;
        model
            .add_contact(&Contact::unilateral(Some(2 * i + 1), Some(next), 0.3, 0.2))
            .unwrap();
    }
    model
}

#[test]
fn a_sweep_that_enters_a_closed_curve_ends_after_three_rounds() {
    let model = wheel();
    let sweep = |omega_start, omega_stop| {
        let options = SolverOptions {
            harmonics: 3,
            response_dof: Some(1),
            ..SolverOptions::default()
        };
        let range = ForcedOptions {
            omega_start,
            omega_stop,
            ..ForcedOptions::default()
        };
        forced_response(&model, &options, &range, &mut Hooks::default()).unwrap()
    };
    let (low, high) = (0.6276746998495621, 1.059201055996136);
    let up = sweep(low, high);
    assert_eq!(up.status(), Status::StoppedClosed);
    assert!(up.points() < 300, "{} points", up.points());
    // The folds of the closed curve, and no other after them.
    let last = &up.folds()[up.folds().len() - 4..];
    assert!((last[0].omega - last[2].omega).abs() < 1e-8 && (last[1].omega - last[3].omega).abs() < 1e-8);
    // Downwards the whole range is covered.
    let down = sweep(high, low);
    assert_eq!(down.status(), Status::Ok);
}
