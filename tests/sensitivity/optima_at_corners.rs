//! Optima of a response over the limit of a slider: from a plateau, on which the slider sticks, down and up, and on both sides of the
//! corners at which it begins to slip. Each is compared with responses at single values.

use crate::common::solve_at;
use crate::design::tight;
use hbvib::{
    Constant, Contact, Follow, Hooks, MatrixKind, MatrixView, Model, Parameter, ParameterRange, SolverOptions,
    parameter_response,
};
use num_complex::Complex64;

/// Two masses between walls, with a slider against the ground.
struct Case {
    springs: [f64; 3],
    masses: [f64; 2],
    dampers: [f64; 2],
    slider: (usize, f64),
    omega: f64,
    response: usize,
}

impl Case {
    fn model(&self, limit: f64) -> Model {
        let [a, b, c] = self.springs;
        let diagonal = |[x, y]: [f64; 2]| [x, 0.0, 0.0, y];
        let mut model = Model::new(2).unwrap();
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense(2, &diagonal(self.masses)))
            .unwrap();
        model
            .set_matrix(MatrixKind::Damping, &MatrixView::dense(2, &diagonal(self.dampers)))
            .unwrap();
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(2, &[a + b, -b, -b, b + c]))
            .unwrap();
        let (dof, kt) = self.slider;
        model.add_contact(&Contact::jenkins(dof, None, kt, 1.0, limit)).unwrap();
        model.add_force(0, 1, 0.5.into()).unwrap();
        model.add_force(1, 1, Complex64::from_polar(0.3, 2.0)).unwrap();
        model
    }

    fn solver(&self) -> SolverOptions {
        SolverOptions {
            response_dof: Some(self.response),
            ..tight(3)
        }
    }

    /// Optima over the limit, with their values, in the order of the limit.
    fn optima(&self, start: f64, stop: f64) -> Vec<(f64, f64, bool)> {
        let limit = Parameter::Contact {
            constant: Constant::Preload,
            contact: Some(0),
        };
        let range = ParameterRange {
            start,
            stop,
            at: &[],
            follow: Follow::Omega(self.omega),
            response: None,
        };
        let found =
            parameter_response(&self.model(start), &self.solver(), limit, &range, &mut Hooks::default()).unwrap();
        let mut optima: Vec<_> = found
            .optima()
            .iter()
            .map(|o| (o.parameter, o.amplitude, o.is_maximum))
            .collect();
        optima.sort_by(|a, b| a.0.total_cmp(&b.0));
        optima
    }
}

#[test]
fn an_optimum_beside_a_plateau_is_found_from_both_sides() {
    let cases = [
        Case {
            springs: [0.727, 0.903, 1.483],
            masses: [1.105, 1.525],
            dampers: [0.0227, 0.023],
            slider: (0, 0.718),
            omega: 0.6274,
            response: 1,
        },
        Case {
            springs: [0.984, 1.417, 1.189],
            masses: [1.439, 1.964],
            dampers: [0.0254, 0.017],
            slider: (0, 1.341),
            omega: 0.6844,
            response: 1,
        },
        Case {
            springs: [1.424, 0.642, 0.78],
            masses: [1.481, 1.367],
            dampers: [0.0234, 0.0231],
            slider: (1, 1.965),
            omega: 1.4315,
            response: 0,
        },
    ];
    for (number, case) in cases.iter().enumerate() {
        let (from, to, steps) = (0.1, 1.0, 180);
        let (up, down) = (case.optima(from, to), case.optima(to, from));
        println!("{number}: {up:?}");
        assert_eq!(up.len(), down.len(), "{number}: {up:?}, {down:?}");
        for (a, b) in up.iter().zip(&down) {
            assert!(
                (a.0 - b.0).abs() < 1e-6 && (a.1 - b.1).abs() < 1e-9 && a.2 == b.2,
                "{number}: {a:?}, {b:?}"
            );
        }
        // Each optimum of the responses at single values is listed, and each that is listed is one.
        let at = |i: usize| from + (to - from) * i as f64 / steps as f64;
        let alone = |limit: f64| solve_at(&case.model(limit), &case.solver(), case.omega).amplitude()[0];
        let values: Vec<f64> = (0..=steps).map(|i| alone(at(i))).collect();
        let mut seen = 0;
        for i in 1..steps {
            for is_maximum in [true, false] {
                let sense = if is_maximum { 1.0 } else { -1.0 };
                let least = [i - 1, i + 1].map(|j| sense * (values[i] - values[j]));
                if least.iter().all(|d| *d > 1e-9) {
                    let near = |o: &&(f64, f64, bool)| o.2 == is_maximum && o.0 > at(i - 1) && o.0 < at(i + 1);
                    assert!(up.iter().any(|o| near(&o)), "{number}: {} at {}", values[i], at(i));
                    seen += 1;
                }
            }
        }
        assert!(seen > 0 && seen == up.len(), "{number}: {seen}, {up:?}");
        for (limit, value, _) in up {
            assert!((alone(limit) / value - 1.0).abs() < 1e-8);
        }
    }
}
