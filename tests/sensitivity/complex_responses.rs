//! Derivatives of complex amplitudes equal closed forms of a linear oscillator and differences of converged solutions.

use crate::common::models::{dense, oscillator};
use crate::common::omega_range;
use hbvib::{
    Component, Constant, Hooks, MatrixKind, MatrixView, Measure, Model, Parameter, Response, SolverOptions,
    complex_sensitivity, forced_response,
};
use num_complex::Complex64;

fn solved(model: &Model, omega: f64) -> hbvib::Branch {
    let solver = SolverOptions {
        harmonics: 9,
        response_dof: Some(0),
        tol_residual: 1e-13,
        ..SolverOptions::default().fixed()
    };
    let range = omega_range(omega, omega);
    forced_response(model, &solver, &range, &mut Hooks::default()).unwrap()
}

#[test]
fn of_a_linear_oscillator_are_closed_forms() {
    let (k, m, c, f, omega) = (1.3, 0.7, 0.05, 0.4, 1.2);
    let model = oscillator(m, k).damping(&[c]).force(0, 1, f).build();
    let branch = solved(&model, omega);
    let one = [1.0];
    let direction = |which| Parameter::Direction {
        which,
        direction: MatrixView::dense(1, &one),
    };
    let parameters = [
        direction(MatrixKind::Stiffness),
        direction(MatrixKind::Mass),
        direction(MatrixKind::Damping),
        Parameter::Force,
    ];
    let x = f / Complex64::new(k - omega * omega * m, omega * c);
    let i = Complex64::I;
    for (component, factor, by_omega) in [
        (Component::Displacement, Complex64::ONE, Complex64::ZERO),
        (Component::Velocity, i * omega, i),
        (Component::Acceleration, (-omega * omega).into(), (-2.0 * omega).into()),
    ] {
        let response = Response {
            component,
            ..Response::default()
        };
        let found = complex_sensitivity(&model, &branch, 0, &response, &parameters).unwrap();
        let wanted = [-x * x / f, omega * omega * x * x / f, -i * omega * x * x / f, x];
        assert!((found.value - factor * x).norm() < 1e-12 * x.norm());
        for (found, wanted) in found.values.iter().zip(wanted) {
            assert!(
                (found - factor * wanted).norm() < 1e-12 * wanted.norm(),
                "{found} {wanted}"
            );
        }
        let slope = factor * (2.0 * omega * m - i * c) * x * x / f + by_omega * x;
        assert!((found.by_omega - slope).norm() < 1e-11 * slope.norm());
    }
}

/// Two masses, of which the first rubs on the ground.
fn rubbing(kt: f64, mu: f64, stiffness: f64, damping: f64) -> Model {
    let k = [1.5, -0.5, -0.5, 0.5].map(|k| stiffness * k);
    dense(&[1.0, 0.0, 0.0, 0.5], &k)
        .rayleigh(0.0, 0.01 * damping)
        .slider(0, kt, mu, 1.0)
        .force(1, 1, 0.05)
        .build()
}

#[test]
fn under_friction_are_differences_of_solutions() {
    let at = [0.3, 0.15, 1.0, 1.0];
    let model = |p: [f64; 4]| rubbing(p[0], p[1], p[2], p[3]);
    let constant = |constant| Parameter::Contact {
        constant,
        contact: Some(0),
    };
    let parameters = [
        constant(Constant::Kt),
        constant(Constant::Mu),
        Parameter::Factor {
            which: MatrixKind::Stiffness,
        },
        Parameter::Factor {
            which: MatrixKind::Damping,
        },
    ];
    let (omega, h) = (0.74, 1e-4);
    let (dofs, weights) = ([0, 1], [1.0, -0.6]);
    for measure in [Measure::Fundamental, Measure::Harmonic(3)] {
        let response = Response {
            measure,
            dofs: &dofs,
            weights: &weights,
            component: Component::Velocity,
            ..Response::default()
        };
        let value = |p: [f64; 4], omega: f64| {
            let model = model(p);
            complex_sensitivity(&model, &solved(&model, omega), 0, &response, &[])
                .unwrap()
                .value
        };
        let base = model(at);
        let found = complex_sensitivity(&base, &solved(&base, omega), 0, &response, &parameters).unwrap();
        for (k, found) in found.values.iter().enumerate() {
            let central = |h: f64| {
                let moved = |sign: f64| {
                    let mut p = at;
                    p[k] *= 1.0 + sign * h;
                    value(p, omega)
                };
                (moved(1.0) - moved(-1.0)) / (2.0 * h * at[k])
            };
            let wanted = (4.0 * central(h) - central(2.0 * h)) / 3.0;
            assert!(
                (found - wanted).norm() < 1e-6 * wanted.norm(),
                "{measure:?} {k}: {found} {wanted}"
            );
        }
        let central = |h: f64| (value(at, omega + h) - value(at, omega - h)) / (2.0 * h);
        let wanted = (4.0 * central(h) - central(2.0 * h)) / 3.0;
        assert!((found.by_omega - wanted).norm() < 1e-6 * wanted.norm());
    }
}

#[test]
fn of_a_measure_without_phase_are_refused() {
    let model = rubbing(0.3, 0.15, 1.0, 1.0);
    let branch = solved(&model, 0.74);
    let response = Response {
        measure: Measure::Rms,
        ..Response::default()
    };
    let e = complex_sensitivity(&model, &branch, 0, &response, &[Parameter::Force]).unwrap_err();
    assert!(e.to_string().contains("complex amplitude"), "{e}");
}
