//! Periodic responses by integration in time against closed forms, against event-driven integrations
//! made by other programs, and against harmonic balance with many harmonics.

mod common;

use common::{BASE, all_harmonics, complex, data, harmonics, largest, number, relative_gap, solve_at, sweep};
use hbvib::analysis::time_response::{TimeResponse, time_response};
use hbvib::contact::Contact;
use hbvib::error::Status;
use hbvib::hooks::Hooks;
use hbvib::linalg::matrix_view::{MatrixView, Part};
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{SteadyMethod, TimeOptions};
use num_complex::Complex64;
use std::f64::consts::TAU;

fn at(omega: f64) -> TimeOptions<'static> {
    TimeOptions {
        omega,
        ..TimeOptions::default()
    }
}

fn solve(model: &Model, options: &TimeOptions<'_>) -> TimeResponse {
    let found = time_response(model, options, &mut Hooks::default()).unwrap();
    assert_eq!(found.status, Status::Ok);
    found
}

/// Mass 1, damping 0.02, stiffness 1, with a contact to the ground.
fn oscillator(contact: &Contact, forces: &[(usize, f64)]) -> Model {
    damped_oscillator(0.02, contact, forces)
}

fn damped_oscillator(damping: f64, contact: &Contact, forces: &[(usize, f64)]) -> Model {
    let mut model = Model::new(1).unwrap();
    for (which, a) in [
        (MatrixKind::Mass, 1.0),
        (MatrixKind::Damping, damping),
        (MatrixKind::Stiffness, 1.0),
    ] {
        model.set_matrix(which, &MatrixView::dense(1, &[a])).unwrap();
    }
    model.add_contact(contact).unwrap();
    for &(harmonic, force) in forces {
        model.add_force(0, harmonic, force.into()).unwrap();
    }
    model
}

fn jenkins(kt: f64, limit: f64) -> Contact {
    Contact::jenkins(0, None, kt, 1.0, limit)
}

/// The spring of the hard cases, f = kn·max(x − gap, 0): it is the ground that moves over side b.
fn stop(kn: f64, gap: f64) -> Contact {
    Contact::unilateral(None, Some(0), kn, gap)
}

#[test]
fn a_linear_structure_moves_as_its_frequency_response_says() {
    // Mass with coupling, damping without symmetry, forces in three harmonics and a constant one.
    let (m, c, k) = ([2.0, 0.3, 0.3, 1.0], [0.3, 0.1, -0.05, 0.2], [5.0, -2.0, -2.0, 4.0]);
    let mut model = Model::new(2).unwrap();
    model.set_matrix(MatrixKind::Mass, &MatrixView::dense(2, &m)).unwrap();
    let general = MatrixView::dense(2, &c).part(Part::General);
    model.set_matrix(MatrixKind::Damping, &general).unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(2, &k))
        .unwrap();
    let forces = [
        (0, 0, Complex64::new(0.7, 0.0)),
        (0, 1, Complex64::new(1.0, -0.4)),
        (1, 2, Complex64::new(0.2, 0.9)),
        (1, 5, Complex64::new(-0.5, 0.1)),
    ];
    for (dof, h, value) in forces {
        model.add_force(dof, h, value).unwrap();
    }
    for omega in [0.3, 1.1, 1.9] {
        let options = TimeOptions {
            harmonics: 6,
            samples: 7,
            ..at(omega)
        };
        let found = solve(&model, &options);
        let mut expected = vec![Complex64::ZERO; 14];
        for h in 0..=6 {
            let w = h as f64 * omega;
            let z = |i: usize| Complex64::new(k[i] - w * w * m[i], w * c[i]);
            let mut f = [Complex64::ZERO; 2];
            for (dof, _, value) in forces.iter().filter(|f| f.1 == h) {
                f[*dof] += value;
            }
            let determinant = z(0) * z(3) - z(1) * z(2);
            expected[2 * h] = (z(3) * f[0] - z(2) * f[1]) / determinant;
            expected[2 * h + 1] = (z(0) * f[1] - z(1) * f[0]) / determinant;
        }
        let error = relative_gap(&found.harmonics, &expected);
        println!(
            "{omega}: {error:.1e}, residual {:.1e}, {} periods",
            found.residual, found.periods
        );
        assert!(error < 1e-12);
        for (i, x) in found.samples.chunks_exact(2).enumerate() {
            for (dof, x) in x.iter().enumerate() {
                let turn = TAU * i as f64 / 7.0;
                let sum: f64 = (0..=6)
                    .map(|h| (expected[2 * h + dof] * Complex64::cis(h as f64 * turn)).re)
                    .sum();
                assert!((x - sum).abs() < 1e-12 * largest(&expected), "sample {i}");
            }
        }
    }
}

#[test]
fn friction_agrees_with_event_driven_integrations_of_others() {
    let cases: [(&str, Model, f64, f64, f64); 4] = [
        (
            "kt/k 1e3",
            oscillator(&jenkins(1e3, 0.2), &[(1, 0.5)]),
            0.9,
            2.161_790_724_147_932,
            1e-9,
        ),
        (
            "kt/k 1e6",
            oscillator(&jenkins(1e6, 0.2), &[(1, 0.5)]),
            0.9,
            2.178_382_925_129_319,
            1e-9,
        ),
        (
            "undamped at resonance",
            damped_oscillator(0.0, &jenkins(1.0, 0.3), &[(1, 0.35)]),
            1.0,
            0.490_802_178_303_386_2,
            1e-9,
        ),
        (
            "constant load",
            oscillator(&jenkins(1.0, 0.3), &[(0, 0.1), (1, 0.2)]),
            1.25,
            0.579_898_529_742_581_4,
            1e-9,
        ),
    ];
    for (name, model, omega, expected, tolerance) in cases {
        let found = solve(&model, &at(omega));
        let error = (found.harmonics[1].norm() / expected - 1.0).abs();
        println!(
            "{name}: {error:.1e}, residual {:.1e}, {} periods, {} events",
            found.residual, found.periods, found.events
        );
        assert!(error < tolerance, "{name}: {}", found.harmonics[1].norm());
    }
}

/// The last point of a sweep, as a start.
fn swept(model: &Model, highest: usize, from: f64, to: f64) -> Vec<Complex64> {
    let branch = sweep(model, &harmonics(highest), from, to, &[]);
    all_harmonics(&branch, branch.points() - 1)
}

#[test]
fn both_states_of_a_gap_oscillator_are_found_from_their_side() {
    let model = oscillator(&stop(3.0, 0.2), &[(1, 0.02)]);
    for (from, expected) in [(0.9, 0.401_335_298_905_242_4), (1.4, 0.061_858_390_314_775_365)] {
        let start = swept(&model, 15, from, 1.15);
        let found = solve(
            &model,
            &TimeOptions {
                start: Some(&start),
                ..at(1.15)
            },
        );
        let error = (found.harmonics[1].norm() / expected - 1.0).abs();
        println!(
            "from {from}: {error:.1e}, {} periods, {} events",
            found.periods, found.events
        );
        assert!(error < 1e-10);
    }
}

#[test]
fn duffings_peak_is_that_of_two_other_methods() {
    let model = damped_oscillator(0.05, &Contact::cubic(0, None, 0.0, 0.1), &[(1, 0.18)]);
    let omega = 1.268_716_736_0;
    let start = swept(&model, 7, 1.0, omega);
    let now = std::time::Instant::now();
    let found = solve(
        &model,
        &TimeOptions {
            start: Some(&start),
            ..at(omega)
        },
    );
    let error = found.harmonics[1].norm() - 2.830_198_059_4;
    println!(
        "{error:.1e}, residual {:.1e}, {} periods, {:?}",
        found.residual,
        found.periods,
        now.elapsed()
    );
    assert!(error.abs() < 1e-9 * 2.83);
}

#[test]
fn the_blisk_moves_as_in_the_event_driven_integration_of_the_whole_wheel() {
    let reference = data("frf_base.json");
    let start = std::time::Instant::now();
    let mut worst = 0.0_f64;
    for point in reference["curve_F5"]["points"].as_array().unwrap() {
        let omega = TAU * number(&point["f_Hz"]);
        let expected = complex(&point["td"]);
        let model = BASE.sector();
        let close = all_harmonics(&solve_at(&model, &harmonics(9), omega), 0);
        let found = solve(
            &model,
            &TimeOptions {
                start: Some(&close),
                ..at(omega)
            },
        );
        let error = (found.harmonics[4] - expected).norm() / expected.norm();
        worst = worst.max(error);
        assert!(error < 1e-8);
    }
    println!("{worst:.1e} {:?}", start.elapsed());
}

#[test]
fn z() {
    let omega = TAU * 208.85;
    let model = BASE.sector();
    let start = std::time::Instant::now();
    let found = solve(
        &model,
        &TimeOptions {
            harmonics: 31,
            ..at(omega)
        },
    );
    println!("rest {} periods {:?}", found.periods, start.elapsed());
    let start = std::time::Instant::now();
    let wheel = solve(
        &BASE.wheel(),
        &TimeOptions {
            harmonics: 31,
            ..at(omega)
        },
    );
    println!("rest {} periods {:?}", wheel.periods, start.elapsed());
    println!(
        "{:.1e}",
        relative_gap(&wheel.harmonics[96..100], &found.harmonics[4..8])
    );
    let start = std::time::Instant::now();
    let wheel = solve(
        &BASE.sector(),
        &TimeOptions {
            harmonics: 31,
            method: SteadyMethod::Marching,
            ..at(omega)
        },
    );
    println!("march {} periods {:?}", wheel.periods, start.elapsed());
    println!("{:.1e}", relative_gap(&wheel.harmonics[4..8], &found.harmonics[4..8]));
}
