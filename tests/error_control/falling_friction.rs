//! The error told with a law of the caller whose friction falls with the velocity, against many harmonics.

use crate::common::models::chain;
use crate::common::{at_dof, harmonics, relative_gap, solve_at};
use hbvib::{Call, Contact, ContactKind, Model, SolverOptions, User, UserForce};
use num_complex::Complex64;
use std::sync::Arc;

/// f = limit · tanh(v/sharp) · (1 + ½ exp(−(v/fall)²))
struct Stribeck {
    limit: f64,
    sharp: f64,
    fall: f64,
}

impl UserForce for Stribeck {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        let Self { limit, sharp, fall } = self;
        for j in 0..call.samples {
            let v = call.v[j];
            let (direction, more) = ((v / sharp).tanh(), 0.5 * (-(v / fall).powi(2)).exp());
            call.f[j] = limit * direction * (1.0 + more);
            call.df_dv[j] = limit
                * ((1.0 - direction * direction) / sharp * (1.0 + more) - direction * more * 2.0 * v / (fall * fall));
        }
        0
    }
}

/// Two masses between two walls, with stiffness damping; force and friction act on the second.
struct Case {
    springs: [f64; 3],
    mass: [f64; 2],
    beta: f64,
    omega: f64,
    law: Stribeck,
}

fn cases() -> [Case; 2] {
    [
        Case {
            springs: [1.55623, 1.492503, 0.60349],
            mass: [1.202802, 0.818962],
            beta: 0.0162545,
            omega: 0.569907,
            law: Stribeck {
                limit: 0.0548006,
                sharp: 0.00835130,
                fall: 0.405399,
            },
        },
        Case {
            springs: [0.669352, 1.240627, 0.915201],
            mass: [0.643714, 0.686932],
            beta: 0.00554862,
            omega: 0.738493,
            law: Stribeck {
                limit: 0.0341798,
                sharp: 0.0245956,
                fall: 0.123734,
            },
        },
    ]
}

fn model(case: Case) -> Model {
    let law = User {
        odd: true,
        ..User::new(Arc::new(case.law), 1, 0).unwrap()
    };
    chain(&case.mass, &case.springs)
        .rayleigh(0.0, case.beta)
        .force(1, 1, Complex64::ONE)
        .contact(Contact::over(vec![1], ContactKind::User(law)))
        .build()
}

#[test]
fn errors_told_where_friction_falls_with_the_velocity_are_the_true_ones() {
    for (number, case) in cases().into_iter().enumerate() {
        let omega = case.omega;
        let model = model(case);
        let solve = |solver: SolverOptions| {
            let solver = at_dof(1, solver);
            solve_at(&model, &solver, omega)
        };
        let first = |branch: &hbvib::Branch| branch.response_at(0).unwrap()[0];
        let truth = first(&solve(SolverOptions {
            samples: 32_768,
            ..harmonics(201)
        }));
        for (name, solver, tolerance) in [
            ("one harmonic", harmonics(1), f64::INFINITY),
            ("three harmonics", harmonics(3), f64::INFINITY),
            ("the default", SolverOptions::default(), 1e-3),
            (
                "a tolerance of 1e-4",
                SolverOptions {
                    tolerance: 1e-4,
                    ..SolverOptions::default()
                },
                1e-4,
            ),
        ] {
            let branch = solve(SolverOptions {
                estimate_error: true,
                ..solver
            });
            let (told, own) = (
                branch.error_estimate_at(0).unwrap(),
                relative_gap(&[first(&branch)], &[truth]),
            );
            assert!(own <= 2.0 * told, "{number}, {name}: told {told:e}, true {own:e}");
            assert!(own <= tolerance, "{number}, {name}: true {own:e}");
        }
    }
}
