//! The aliasing check of sampled laws: against the true error of their forces, from exact events or
//! from many more samples.

use crate::common::models::{dense, diagonal};
use crate::common::{all_harmonics, harmonics, relative_gap, solve_at};
use hbvib::{Contact, ContactKind, Model, Polynomial, SolverOptions, Status, contact_evaluate};
use num_complex::Complex64;

const HARMONICS: usize = 5;
const OMEGA: f64 = 1.2;

/// Three masses on springs and coupled, each of them a direction of the contact, all forced.
fn model(contact: &Contact) -> Model {
    dense(
        &diagonal(&[1.0; 3]),
        &[1.0, -0.1, -0.1, -0.1, 1.3, -0.1, -0.1, -0.1, 0.8],
    )
    .damping(&diagonal(&[0.05; 3]))
    .contact(contact)
    .force(0, 1, 0.4)
    .force(1, 1, Complex64::new(0.0, 0.3))
    .force(2, 1, Complex64::new(0.2, 0.1))
    .build()
}

/// The check of the first point, and the true error of the contact force at its motion.
fn check(contact: &Contact, samples: usize, truth: usize) -> (f64, f64) {
    let model = model(contact);
    let solver = SolverOptions {
        samples,
        keep_even_harmonics: true,
        ..harmonics(HARMONICS)
    };
    let branch = solve_at(&model, &solver, OMEGA);
    let x = all_harmonics(&branch, 0);
    let count = HARMONICS + 1;
    let places = contact.places();
    let dof = |k: usize| {
        if contact.dofs.is_empty() {
            contact.dof_a[places[k]].unwrap()
        } else {
            contact.dofs[k]
        }
    };
    let motion: Vec<Complex64> = (0..contact.directions())
        .flat_map(|k| (0..count).map(move |h| (k, h)))
        .map(|(k, h)| x[h * 3 + dof(k)])
        .collect();
    let force = |samples: usize| {
        let mut f = vec![Complex64::ZERO; motion.len()];
        contact_evaluate(contact, HARMONICS, samples, OMEGA, &motion, &mut f, None).unwrap();
        f
    };
    let error = relative_gap(&force(samples), &force(truth));
    (branch.sampling_error()[0], error)
}

#[test]
fn the_check_tells_the_size_of_the_error_of_sampling_and_falls_with_it() {
    for (name, contact, truth) in [
        ("friction", Contact::jenkins(0, None, 1.0, 0.5, 0.6), 0),
        (
            "regularised friction",
            Contact::regularised(0, None, 0.5, 0.6, 0.05),
            1 << 14,
        ),
    ] {
        let mut checks = Vec::new();
        for samples in [64, 256, 1024] {
            let (check, error) = check(&contact, samples, truth);
            println!("{name}, {samples} samples: check {check:.1e}, error {error:.1e}");
            assert!(error < 10.0 * check || error < 1e-12, "{name}");
            checks.push(check);
        }
        // Kinks between samples make a single one large or small.
        assert!(checks[2] < 0.1 * checks[0], "{name}");
    }
}

#[test]
fn laws_that_are_exact_have_nothing_to_check() {
    let cubic = Polynomial::scalar(&[0.0, 0.0, 0.4], &[0.0, 0.0, 0.1]).unwrap();
    for (contact, samples) in [
        (Contact::jenkins(0, None, 1.0, 0.5, 0.6), 0),
        (Contact::cubic(0, None, 0.5, 0.2), 64),
        (
            Contact::friction_2d([Some(0), Some(2)], [None; 2], (1.0, 0.9), 0.4, 0.5),
            0,
        ),
        (
            Contact::friction_3d([Some(0), Some(1), Some(2)], [None; 3], (1.0, 0.9), 0.4, 0.5),
            64,
        ),
        (Contact::between(0, None, ContactKind::Polynomial(cubic)), 64),
    ] {
        assert!(check(&contact, samples, samples).0 == 0.0);
    }
}

/// With a tolerance the samples are as many as the error of the response requires: against the same harmonics with many
/// more samples.
#[test]
fn the_samples_follow_from_the_tolerance() {
    for (name, contact) in [
        ("smooth", Contact::regularised(0, None, 0.5, 0.6, 0.05)),
        ("sharp", Contact::regularised(0, None, 0.5, 0.6, 5e-3)),
    ] {
        let model = model(&contact);
        for tolerance in [1e-2, 1e-5] {
            let solver = SolverOptions {
                tolerance,
                max_harmonics: 7,
                keep_even_harmonics: true,
                ..SolverOptions::default()
            };
            let branch = solve_at(&model, &solver, OMEGA);
            let check = branch.sampling_error()[0] / 3.0;
            let harmonics = branch.harmonics_used()[0] as usize;
            let finer = SolverOptions {
                tolerance: 0.0,
                harmonics,
                samples: 1 << 14,
                ..solver
            };
            let error = relative_gap(
                &branch.response_at(0).unwrap()[..2],
                &solve_at(&model, &finer, OMEGA).response_at(0).unwrap()[..2],
            );
            println!("{name}, tolerance {tolerance:e}: H {harmonics}, check {check:.1e}, error {error:.1e}");
            assert!(check <= 0.5 * tolerance && error <= 0.5 * tolerance, "{name}");
        }
    }
}

#[test]
fn beyond_the_bound_of_the_samples_the_status_tells_that_the_tolerance_is_missed() {
    let model = model(&Contact::regularised(0, None, 0.5, 0.6, 1e-6));
    let solver = SolverOptions {
        tolerance: 1e-10,
        max_harmonics: 1,
        keep_even_harmonics: true,
        ..SolverOptions::default()
    };
    let branch = solve_at(&model, &solver, OMEGA);
    assert!(branch.sampling_error()[0] > 3e-10);
    assert_eq!(branch.status(), Status::StoppedMaxHarmonics);
}
