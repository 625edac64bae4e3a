//! Chains of light damping in which one of the high harmonics of a slider at the onset of slip meets a mode: the error told and the
//! tolerance against a hundred harmonics. The flexibility of the three smaller ones comes from factors, of the others from modes
//! and poles.

use crate::common::models::chain;
use crate::common::{at_dof, harmonics, relative_gap, sweep};
use hbvib::{Branch, MatrixKind, MatrixView, Model, SolverOptions};

/// A chain, and the stiffness and limit of the slider on it.
struct Case {
    masses: usize,
    phase: f64,
    stuck: f64,
    kt: f64,
    limit: f64,
    /// Whether a damper at the end of the chain couples its modes.
    couples: bool,
    tolerance: f64,
}

const LONG: Case = Case {
    masses: 120,
    phase: 4.0,
    stuck: 0.034932840835783,
    kt: 0.103142958188103,
    limit: 715.548119028959,
    couples: false,
    tolerance: 1e-3,
};

const CASES: [Case; 5] = [
    Case {
        masses: 20,
        phase: 10.0,
        stuck: 0.193655199594186,
        kt: 0.609887515912444,
        limit: 757.691702273423,
        couples: false,
        tolerance: 1e-4,
    },
    Case {
        masses: 20,
        phase: 35.0,
        stuck: 0.193711575553125,
        kt: 0.612863983995565,
        limit: 761.407383990954,
        couples: false,
        tolerance: 1e-4,
    },
    Case {
        masses: 31,
        phase: 28.0,
        stuck: 0.134820921872108,
        kt: 0.371765745467827,
        limit: 737.219277639303,
        couples: false,
        tolerance: 1e-4,
    },
    LONG,
    Case { couples: true, ..LONG },
];

/// Damping ratio at the frequency of the stuck slider.
const RATIO: f64 = 2e-4;

fn model(case: &Case) -> Model {
    let n = case.masses;
    let at = |i: usize| i as f64;
    let masses: Vec<f64> = (0..n)
        .map(|i| 1.0 + 0.25 * (3.1 * at(i) + 2.0 * case.phase).sin())
        .collect();
    let springs: Vec<f64> = (0..=n)
        .map(|i| (0.3 * (7.3 * at(i) + case.phase).sin()).exp())
        .collect();
    let mut damping = vec![0.0; n * n];
    for (i, m) in masses.iter().enumerate() {
        let doubled = if case.couples && i == 0 { 2.0 } else { 1.0 };
        damping[i * n + i] = 2.0 * RATIO * case.stuck * m * doubled;
    }
    let mut model = chain(&masses, &springs)
        .slider(n / 3, case.kt, 1.0, case.limit)
        .force(n / 2, 1, 1.0)
        .build();
    model
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(n, &damping))
        .unwrap();
    model
}

#[test]
fn tolerances_hold_where_a_high_harmonic_resonates() {
    for case in &CASES {
        let model = model(case);
        let at: Vec<f64> = (0..61).map(|i| case.stuck * (0.998 + 5e-5 * f64::from(i))).collect();
        let solve = |solver: SolverOptions| {
            let solver = at_dof(case.masses / 2, solver);
            sweep(&model, &solver, 0.985 * case.stuck, 1.015 * case.stuck, &at)
        };
        let found = solve(SolverOptions {
            tolerance: case.tolerance,
            estimate_error: true,
            ..SolverOptions::default()
        });
        let truth = solve(harmonics(101));
        let single = |branch: &Branch, i: usize| match branch.at(i) {
            [one] => Some((branch.response_at(one.point).unwrap()[0], one.point)),
            _ => None,
        };
        let mut compared = 0;
        for i in 0..at.len() {
            let (Some((x, point)), Some((y, _))) = (single(&found, i), single(&truth, i)) else {
                continue;
            };
            let (own, told) = (relative_gap(&[x], &[y]), found.error_estimate_at(point).unwrap());
            assert!(
                own <= 1.5 * case.tolerance && own <= 4.0 * told + 1e-7,
                "{} masses, coupled {}, point {i}: told {told:e}, true {own:e}",
                case.masses,
                case.couples
            );
            compared += usize::from(own > 1e-6);
        }
        assert!(compared >= 5, "{compared}");
    }
}
