//! The error told at the first harmonics, where what the third one changes vanishes by chance, and of friction that is regularised over
//! a small velocity, against many harmonics.

use crate::common::models::chain;
use crate::common::{at_dof, harmonics, relative_gap, solve_at};
use hbvib::{Contact, Model, SolverOptions};
use num_complex::Complex64;

/// Two masses in a row on the ground, with stiffness damping.
struct Case {
    springs: [f64; 2],
    mass: [f64; 2],
    beta: f64,
    omega: f64,
    force: usize,
    contact: Contact,
    /// Samples of the reference.
    samples: usize,
}

fn cases() -> [Case; 4] {
    [
        Case {
            springs: [0.586394, 1.93684],
            mass: [1.06533, 0.703424],
            beta: 0.0214831,
            omega: 0.524355,
            force: 0,
            contact: Contact::jenkins(1, None, 0.329197, 1.0, 0.340557),
            samples: 0,
        },
        Case {
            springs: [1.09795, 1.60062],
            mass: [0.566969, 1.03543],
            beta: 0.00322128,
            omega: 0.728306,
            force: 0,
            contact: Contact::jenkins(1, None, 0.259627, 1.0, 0.129663),
            samples: 0,
        },
        Case {
            springs: [1.46782, 1.71428],
            mass: [0.636905, 0.94006],
            beta: 0.108267,
            omega: 0.81677,
            force: 1,
            contact: Contact::regularised(0, None, 1.0, 0.160515, 0.184337),
            samples: 8192,
        },
        Case {
            springs: [0.566484, 1.20765],
            mass: [0.962905, 0.978068],
            beta: 0.123588,
            omega: 0.541023,
            force: 1,
            contact: Contact::regularised(1, None, 1.0, 0.158753, 0.052978),
            samples: 8192,
        },
    ]
}

fn model(case: &Case) -> Model {
    let [k1, k2] = case.springs;
    chain(&case.mass, &[k1, k2, 0.0])
        .rayleigh(0.0, case.beta)
        .force(case.force, 1, Complex64::ONE)
        .contact(&case.contact)
        .build()
}

#[test]
fn errors_told_at_few_harmonics_are_the_true_ones_within_a_factor_of_two() {
    for (number, case) in cases().iter().enumerate() {
        let model = model(case);
        let solve = |solver: SolverOptions| {
            let solver = at_dof(case.force, solver);
            solve_at(&model, &solver, case.omega)
        };
        let first = |branch: &hbvib::Branch| branch.response_at(0).unwrap()[0];
        let truth = first(&solve(SolverOptions {
            samples: case.samples,
            ..harmonics(301)
        }));
        for (name, solver) in [
            ("one harmonic", harmonics(1)),
            ("three harmonics", harmonics(3)),
            ("the default", SolverOptions::default()),
        ] {
            let branch = solve(SolverOptions {
                estimate_error: true,
                ..solver
            });
            let (told, own) = (
                branch.error_estimate_at(0).unwrap(),
                relative_gap(&[first(&branch)], &[truth]),
            );
            assert!(
                own <= 2.0 * told && told <= 2.0 * own,
                "{number}, {name}: told {told:e}, true {own:e}"
            );
        }
    }
}
