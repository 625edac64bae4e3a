//! A factor of a matrix beside a direction in it: sA + dE in any order of the list, against least squares on the closed form of two
//! masses, with differences for derivatives.

use crate::common::models::dense;
use hbvib::{
    BatchOptions, DataKind, FitData, FitOptions, Hooks, MatrixKind, MatrixView, Model, Parameter, SolverOptions,
    Unknown, batch, fit,
};
use num_complex::Complex64;

const MASS: [f64; 4] = [1.0, 0.0, 0.0, 1.2];
const DAMPING: [f64; 4] = [0.05, 0.0, 0.0, 0.05];
const STIFFNESS: [f64; 4] = [2.0, -1.0, -1.0, 2.0];
const DIRECTION: [f64; 4] = [1.0, 0.0, 0.0, 0.0];
const KINDS: [MatrixKind; 3] = [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness];

/// Share of the direction that the data have.
const TRUTH: [f64; 2] = [1.1, 0.02];

fn model() -> Model {
    let mut model = dense(&MASS, &STIFFNESS).force(0, 1, 1.0).build();
    model
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(2, &DAMPING))
        .unwrap();
    model
}

fn frequencies() -> Vec<f64> {
    (0..25).map(|i| 0.6 + 0.066 * f64::from(i)).collect()
}

/// The displacement of the second mass, in closed form.
fn closed(which: MatrixKind, [s, d]: [f64; 2]) -> Vec<Complex64> {
    let matrix = |kind: MatrixKind, a: &[f64; 4]| {
        let mut a = *a;
        if kind == which {
            for (a, e) in a.iter_mut().zip(DIRECTION) {
                *a = s * *a + d * e;
            }
        }
        a
    };
    let [m, c, k] = [
        matrix(MatrixKind::Mass, &MASS),
        matrix(MatrixKind::Damping, &DAMPING),
        matrix(MatrixKind::Stiffness, &STIFFNESS),
    ];
    let of = |w: f64| {
        let z = |i: usize| Complex64::new(k[i] - w * w * m[i], w * c[i]);
        -z(1) / (z(0) * z(3) - z(1) * z(2))
    };
    frequencies().into_iter().map(of).collect()
}

/// Data with errors of a few deviations.
fn measured(which: MatrixKind, truth: [f64; 2]) -> (Vec<Complex64>, Vec<f64>) {
    let values = closed(which, truth);
    let sigma: Vec<f64> = values.iter().map(|z| 0.03 * z.norm()).collect();
    let turned = |(i, (z, s)): (usize, (&Complex64, &f64))| z + Complex64::from_polar(*s, 2.4 * i as f64);
    let values = values.iter().zip(&sigma).enumerate().map(turned).collect();
    (values, sigma)
}

/// Least squares of the closed form by Gauss and Newton: values and covariance, row after row.
fn least_squares(residuals: impl Fn([f64; 2]) -> Vec<f64>) -> ([f64; 2], [f64; 4]) {
    let mut theta = TRUTH;
    let mut covariance = [0.0; 4];
    for _ in 0..50 {
        let column = |k: usize| {
            let moved = |step: f64| {
                let mut theta = theta;
                theta[k] += step;
                residuals(theta)
            };
            let (a, b) = (moved(1e-5), moved(-1e-5));
            a.iter().zip(b).map(|(a, b)| (a - b) / 2e-5).collect::<Vec<f64>>()
        };
        let (j, r) = ([column(0), column(1)], residuals(theta));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (a, b, c) = (dot(&j[0], &j[0]), dot(&j[0], &j[1]), dot(&j[1], &j[1]));
        let determinant = a * c - b * b;
        covariance = [c, -b, -b, a].map(|x| x / determinant);
        let g = [dot(&j[0], &r), dot(&j[1], &r)];
        for i in 0..2 {
            theta[i] -= covariance[2 * i] * g[0] + covariance[2 * i + 1] * g[1];
        }
    }
    (theta, covariance)
}

fn residuals(which: MatrixKind, theta: [f64; 2], (values, sigma): &(Vec<Complex64>, Vec<f64>)) -> Vec<f64> {
    let gap = closed(which, theta);
    let each = gap.iter().zip(values).zip(sigma);
    each.flat_map(|((z, x), s)| {
        let r = (z - x) / s * 2f64.sqrt();
        [r.re, r.im]
    })
    .collect()
}

fn set<'a>(omega: &'a [f64], (value, sigma): &'a (Vec<Complex64>, Vec<f64>)) -> FitData<'a> {
    FitData {
        kind: DataKind::Response,
        response: hbvib::Response {
            dofs: &[1],
            ..Default::default()
        },
        x: omega,
        value,
        sigma,
        ..FitData::default()
    }
}

fn linear() -> SolverOptions {
    SolverOptions {
        harmonics: 1,
        ..SolverOptions::default().fixed()
    }
}

/// Asserts that a fit has the values and the covariance of the closed form, whatever the order of its list.
fn assert_fit(which: MatrixKind, scopes: [Option<usize>; 2], data: &[FitData<'_>], wanted: ([f64; 2], [f64; 4])) {
    let direction = MatrixView::dense(2, &DIRECTION);
    let parameters = [Parameter::Factor { which }, Parameter::Direction { which, direction }];
    for order in [[0, 1], [1, 0]] {
        let unknowns = order.map(|i| Unknown {
            start: Some(TRUTH[i]),
            data_set: scopes[i],
            ..Unknown::default()
        });
        let found = fit(
            &model(),
            (&order.map(|i| parameters[i]), &unknowns),
            data,
            &linear(),
            &FitOptions::default(),
            &mut Hooks::default(),
        )
        .unwrap();
        for (row, &i) in order.iter().enumerate() {
            let (value, deviation) = (wanted.0[i], wanted.1[3 * i].sqrt());
            let gap = (found.theta[row] - value).abs() / deviation;
            assert!(gap < 1e-4, "{} {order:?}: {:?} {wanted:?}", which.name(), found.theta);
            for (column, &j) in order.iter().enumerate() {
                let scale = deviation * wanted.1[3 * j].sqrt();
                let gap = (found.covariance[2 * row + column] - wanted.1[2 * i + j]).abs() / scale;
                assert!(gap < 1e-5, "{} {order:?}: {gap:.1e}", which.name());
            }
        }
    }
}

#[test]
fn values_and_covariance_are_those_of_the_closed_form_in_any_order() {
    let omega = frequencies();
    for which in KINDS {
        let data = measured(which, TRUTH);
        let wanted = least_squares(|theta| residuals(which, theta, &data));
        assert_fit(which, [None, None], &[set(&omega, &data)], wanted);
    }
}

#[test]
fn a_factor_of_one_data_set_leaves_the_direction_of_all_as_it_is() {
    let (which, omega) = (MatrixKind::Stiffness, frequencies());
    let data = [measured(which, [1.0, TRUTH[1]]), measured(which, TRUTH)];
    let wanted = least_squares(|[s, d]| {
        let mut all = residuals(which, [1.0, d], &data[0]);
        all.extend(residuals(which, [s, d], &data[1]));
        all
    });
    assert_fit(
        which,
        [Some(1), None],
        &data.each_ref().map(|data| set(&omega, data)),
        wanted,
    );
}

#[test]
fn designs_are_the_same_in_any_order() {
    let direction = MatrixView::dense(2, &DIRECTION);
    for which in KINDS {
        let parameters = [Parameter::Factor { which }, Parameter::Direction { which, direction }];
        let peak = |order: [usize; 2]| {
            let values = order.map(|i| TRUTH[i]);
            let options = BatchOptions {
                omega_start: 0.6,
                omega_stop: 1.5,
                ..BatchOptions::default()
            };
            let solver = SolverOptions {
                response_dof: Some(1),
                ..linear()
            };
            let parameters = order.map(|i| parameters[i]);
            let found = batch(
                &model(),
                &solver,
                &options,
                (&parameters, &values),
                &mut Hooks::default(),
            )
            .unwrap();
            found.peaks()[0].amplitude
        };
        // The peak of the closed form, by a search around its largest value.
        let at = |w: f64| {
            let [m, c, k] = [&MASS, &DAMPING, &STIFFNESS].map(|a| *a);
            let own = |kind: MatrixKind, a: [f64; 4], i: usize| {
                if kind == which {
                    TRUTH[0] * a[i] + TRUTH[1] * DIRECTION[i]
                } else {
                    a[i]
                }
            };
            let z = |i: usize| {
                let stiff = own(MatrixKind::Stiffness, k, i) - w * w * own(MatrixKind::Mass, m, i);
                Complex64::new(stiff, w * own(MatrixKind::Damping, c, i))
            };
            (z(1) / (z(0) * z(3) - z(1) * z(2))).norm()
        };
        let wanted = (0..90_000).map(|i| at(0.6 + 1e-5 * f64::from(i))).fold(0.0, f64::max);
        for order in [[0, 1], [1, 0]] {
            assert!((peak(order) / wanted - 1.0).abs() < 1e-7, "{} {order:?}", which.name());
        }
    }
}
