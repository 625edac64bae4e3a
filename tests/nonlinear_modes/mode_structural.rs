//! Nonlinear modes of structures with structural damping and at speed: the closed forms of a linear structure and of a
//! Jenkins contact at one harmonic, the balance of the works, and a speed that follows the frequency.

use crate::common::mode_cases::{follow, only};
use crate::common::models::{dense, oscillator};
use crate::common::{BASE, amplitude_range, harmonics};
use hbvib::internals::Condensed;
use hbvib::internals::Jacobian;
use hbvib::internals::{Epmc, Gauge, LinearMode};
use hbvib::internals::{Problem, Residual};
use hbvib::{
    Contact, ContactState, DampingForm, Hooks, Interrupt, MatrixKind, MatrixView, ModeOptions, Model, Part,
    SolverOptions, Speed,
};
use num_complex::Complex64;
use std::f64::consts::PI;

const ETA: f64 = 0.05;

#[test]
fn a_loss_factor_on_a_linear_structure_is_half_of_it_as_damping_ratio() {
    // Without contact stiffness that matters, over the whole wheel: D = η/2 and ω stays.
    for engine_order in [1, 2, 5] {
        let base = crate::common::Blisk { engine_order, ..BASE };
        let mut model = base.sector_without_contact();
        model.set_rayleigh(0.0, 0.0).unwrap();
        model.set_loss_factor(ETA).unwrap();
        for family in 0..3 {
            let undamped = model.linear_modes(engine_order, ContactState::Stuck).unwrap();
            let options = ModeOptions {
                choice: hbvib::ModeChoice::Index(family),
                ..amplitude_range(-5.0, -4.0)
            };
            let start = model.select_mode(options.choice).unwrap();
            let mode = model.damped_mode(&start, DampingForm::Mass).unwrap();
            assert!((mode.omega / undamped.omega[family] - 1.0).abs() < 1e-13);
            assert!((mode.damping / (0.5 * ETA) - 1.0).abs() < 1e-13, "{:e}", mode.damping);
        }
    }
    // With a stuck contact beside it, which does not dissipate.
    let (m, k, kt) = (1.5, 40.0, 25.0);
    let model = oscillator(m, k)
        .loss_factor(ETA)
        .contact(Contact::jenkins(0, None, kt, 1.0, 1e3))
        .build();
    let branch = follow(
        &model,
        &harmonics(3),
        &ModeOptions {
            log10_start: -3.0,
            log10_stop: -1.0,
            at: &[-2.0],
            ..ModeOptions::default()
        },
    );
    let (omega, d, point) = only(&branch, 0);
    assert!((omega / ((k + kt) / m).sqrt() - 1.0).abs() < 1e-13);
    assert!((d / (0.5 * ETA * k / (k + kt)) - 1.0).abs() < 1e-13, "{d}");
    let energy_damping = branch.mode_at(point).unwrap().energy_damping_ratio();
    assert!((energy_damping / d - 1.0).abs() < 1e-12, "{energy_damping} {d}");
}

/// Jenkins contact at one harmonic: k_eq + i·loss over kt at amplitude a over the slip motion.
fn describing_function(a: f64) -> Complex64 {
    let theta = (1.0 - 2.0 / a).acos();
    Complex64::new((theta - 0.5 * (2.0 * theta).sin()) / PI, 4.0 * (a - 1.0) / (PI * a * a))
}

#[test]
fn a_loss_factor_beside_a_jenkins_contact_has_the_closed_form_of_one_harmonic() {
    let (m, k, kt, slip) = (1.5_f64, 40.0, 25.0, 0.1);
    let model = oscillator(m, k)
        .loss_factor(ETA)
        .contact(Contact::jenkins(0, None, kt, 1.0, kt * slip))
        .build();
    let amplitudes = [1.01, 1.3, 2.0, 7.0, 100.0];
    let at: Vec<f64> = amplitudes.iter().map(|a| (a * slip * m.sqrt()).log10()).collect();
    let solver = SolverOptions {
        tol_residual: 1e-14,
        ..harmonics(1)
    };
    let branch = follow(
        &model,
        &solver,
        &ModeOptions {
            log10_start: at[0] - 1.0,
            log10_stop: at[4] + 0.1,
            at: &at,
            ..ModeOptions::default()
        },
    );
    for (i, a) in amplitudes.into_iter().enumerate() {
        let (omega, d, point) = only(&branch, i);
        let contact = kt * describing_function(a);
        let square = (k + contact.re) / m;
        let expected = (ETA * k + contact.im) / (2.0 * m * square);
        let gaps = [omega * omega / square - 1.0, d / expected - 1.0];
        println!("a = {a}: {gaps:?}");
        assert!(gaps.iter().all(|gap| gap.abs() < 1e-13), "a = {a}: {gaps:?}");
        let energy_damping = branch.mode_at(point).unwrap().energy_damping_ratio();
        assert!((energy_damping / d - 1.0).abs() < 1e-9, "{energy_damping} {d}");
    }
}

#[test]
fn the_works_of_a_mode_with_many_harmonics_balance_with_structural_damping() {
    let mut model = BASE.sector();
    model.set_loss_factor(2e-3).unwrap();
    let branch = follow(
        &model,
        &harmonics(9),
        &ModeOptions {
            log10_start: -6.0,
            log10_stop: -3.0,
            at: &[-5.5, -4.5, -4.0, -3.5],
            ..ModeOptions::default()
        },
    );
    for i in 0..4 {
        let (_, d, point) = only(&branch, i);
        let by_works = branch.mode_at(point).unwrap().energy_damping_ratio();
        assert!((by_works / d - 1.0).abs() < 1e-7, "{by_works} {d}");
    }
}

/// Two masses whose motions gyroscopic forces couple, a Jenkins contact whose load depends on the speed.
fn gyroscopic(speed: Speed) -> Model {
    let mut model = dense(&[1.0, 0.0, 0.0, 1.3], &[4.0, 0.3, 0.3, 9.0])
        .damping(&[0.01, 0.0, 0.0, 0.02])
        .set(MatrixKind::Gyroscopic, &[0.0, 0.8, -0.8, 0.0])
        .set(MatrixKind::StiffnessSpeed2, &[-0.3, 0.1, 0.1, -0.2])
        .slider(0, 3.0, 0.5, 0.1)
        .build();
    model.set_preload_at_speed(0, 0.05, 0.2).unwrap();
    model.set_speed(speed).unwrap();
    model
}

fn options(index: usize, form: DampingForm, at: &[f64]) -> ModeOptions<'_> {
    ModeOptions {
        choice: hbvib::ModeChoice::Index(index),
        damping_form: form,
        at,
        ..amplitude_range(-3.0, 1.0)
    }
}

#[test]
fn a_mode_whose_speed_follows_its_frequency_is_that_of_the_speed_at_each_amplitude() {
    for index in [0, 1] {
        for form in [DampingForm::Mass, DampingForm::Stiffness] {
            let at = [-2.5, -1.0, 0.2, 0.9];
            let branch = follow(
                &gyroscopic(Speed::PerOmega(0.6)),
                &harmonics(5),
                &options(index, form, &at),
            );
            for (i, log10) in at.into_iter().enumerate() {
                let (omega, d, point) = only(&branch, i);
                let fixed = gyroscopic(Speed::Fixed(0.6 * omega));
                let here = [log10];
                let known = follow(&fixed, &harmonics(5), &options(index, form, &here));
                let (known_omega, known_d, _) = only(&known, 0);
                assert!((omega / known_omega - 1.0).abs() < 1e-9, "{omega} {known_omega}");
                assert!((d - known_d).abs() < 1e-9, "{d} {known_d}");
                if form == DampingForm::Mass {
                    let by_works = branch.mode_at(point).unwrap().energy_damping_ratio();
                    assert!((by_works / d - 1.0).abs() < 1e-7, "{by_works} {d}");
                }
            }
        }
    }
}

#[test]
fn the_derivatives_of_a_mode_contain_the_speed_that_follows_its_frequency() {
    let model = gyroscopic(Speed::PerOmega(0.6));
    let start = model.select_mode(hbvib::ModeChoice::Index(0)).unwrap();
    let linear = LinearMode {
        omega: start.omega,
        damping: 0.01,
        shape: start.shape.clone(),
        rest: hbvib::internals::StaticState::default(),
    };
    let gauge = Gauge {
        contact: None,
        reference_dof: 0,
    };
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        let interrupt = Interrupt::none();
        let (condensed, _) =
            Condensed::for_mode(&model, &harmonics(3), (form, false), &start.shape, &interrupt).unwrap();
        let mut problem = Epmc::new(&condensed, &gauge, &linear, 0, &interrupt).unwrap();
        let n = problem.size();
        let u: Vec<f64> = (0..n).map(|i| (1.7 * i as f64 + 0.4).sin()).collect();
        let mut out = Residual::new(n).unwrap();
        problem.evaluate(&u, -0.3, &mut out).unwrap();
        let (mut jacobian, mut active) = (vec![0.0; n * n], vec![true; n]);
        problem.fill(&mut jacobian, &mut active).unwrap();
        let largest = jacobian.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        for c in 0..n {
            let h = 1e-5;
            let mut at = |step: f64| {
                let mut u = u.clone();
                u[c] += step;
                problem.evaluate(&u, -0.3, &mut out).unwrap();
                out.values.clone()
            };
            let (up, down) = (at(h), at(-h));
            for row in 0..n {
                let difference = (up[row] - down[row]) / (2.0 * h);
                assert!(
                    (difference - jacobian[c * n + row]).abs() < 1e-7 * largest,
                    "{form:?}, row {row}, column {c}: {difference} {}",
                    jacobian[c * n + row]
                );
            }
        }
    }
}

/// The model with its loss factor and the same as complex symmetric stiffness.
fn two_ways(base: &Model, own: &[f64], next: Option<&[f64]>) -> [Model; 2] {
    let n = base.ndof();
    let lossy = |a: &[f64]| -> Vec<Complex64> { a.iter().map(|&k| k * Complex64::new(1.0, ETA)).collect() };
    let (mut by_factor, mut by_matrix) = (base.try_clone().unwrap(), base.try_clone().unwrap());
    by_factor.set_loss_factor(ETA).unwrap();
    let own = lossy(own);
    let view = MatrixView::dense_complex(n, &own).part(Part::Symmetric);
    by_matrix.set_matrix(MatrixKind::Stiffness, &view).unwrap();
    if let Some(next) = next {
        let next = lossy(next);
        let view = MatrixView::dense_complex(n, &next);
        by_matrix.set_coupling(MatrixKind::Stiffness, &view).unwrap();
    }
    [by_factor, by_matrix]
}

fn plain_of_two() -> (Model, [f64; 4]) {
    let stiffness = [4.0, -1.3, -1.3, 9.0];
    let model = dense(&[1.0, 0.1, 0.1, 1.3], &stiffness)
        .slider(0, 3.0, 0.5, 0.1)
        .contact(Contact::unilateral(Some(1), None, 2.0, -0.3))
        .build();
    (model, stiffness)
}

#[test]
fn a_complex_symmetric_stiffness_has_the_modes_of_the_loss_factor() {
    let (plain, own) = plain_of_two();
    let blisk = crate::common::Blisk {
        engine_order: -3,
        ..BASE
    };
    let a = blisk.matrices();
    let mut sector = blisk.sector();
    // Rayleigh damping is proportional to the elastic part alone.
    sector.set_rayleigh(0.5, 1e-6).unwrap();
    let cases = [
        (two_ways(&plain, &own, None), 0, (-2.0, 0.5), [-1.0, 0.0, 0.3]),
        (
            two_ways(&sector, &a.own, Some(&a.next)),
            3,
            (-6.0, -3.0),
            [-5.0, -4.0, -3.5],
        ),
    ];
    for ([by_factor, by_matrix], diameter, (log10_start, log10_stop), at) in cases {
        let linear = |model: &Model| model.linear_modes(diameter, ContactState::Stuck).unwrap().omega;
        for (a, b) in linear(&by_matrix).iter().zip(linear(&by_factor)) {
            assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        }
        let damped = |model: &Model| {
            let state = hbvib::LinearContacts::Stuck;
            hbvib::damped_modes(model, diameter, state, 2, &mut Hooks::default()).unwrap()
        };
        for (a, b) in damped(&by_matrix).eigenvalue.iter().zip(damped(&by_factor).eigenvalue) {
            assert!((a - b).norm() < 1e-12 * b.norm(), "{a} {b}");
        }
        for damping_form in [DampingForm::Mass, DampingForm::Stiffness] {
            let range = ModeOptions {
                damping_form,
                at: &at,
                ..amplitude_range(log10_start, log10_stop)
            };
            let solver = harmonics(5);
            let [known, found] = [&by_factor, &by_matrix].map(|model| follow(model, &solver, &range));
            for i in 0..at.len() {
                let ((omega, d, point), (known_omega, known_d, known_point)) = (only(&found, i), only(&known, i));
                assert!((omega / known_omega - 1.0).abs() < 1e-12, "{omega} {known_omega}");
                assert!((d / known_d - 1.0).abs() < 1e-12, "{d} {known_d}");
                let energy = |branch: &hbvib::Branch, point| branch.mode_at(point).unwrap().energy;
                let (a, b) = (energy(&found, point), energy(&known, known_point));
                assert!((a / b - 1.0).abs() < 1e-11, "{a} {b}");
            }
        }
    }
}

#[test]
fn a_structural_matrix_proportional_to_the_stiffness_is_a_loss_factor_in_a_mode() {
    let (plain, own) = plain_of_two();
    let (mut by_factor, mut by_matrix) = (plain.try_clone().unwrap(), plain);
    by_factor.set_loss_factor(ETA).unwrap();
    by_matrix
        .set_matrix(MatrixKind::Structural, &MatrixView::dense(2, &own.map(|k| ETA * k)))
        .unwrap();
    let at = [-1.0, 0.0, 0.3];
    let range = ModeOptions {
        at: &at,
        ..amplitude_range(-2.0, 0.5)
    };
    let solver = SolverOptions {
        tol_residual: 1e-14,
        ..harmonics(5)
    };
    let [known, found] = [&by_factor, &by_matrix].map(|model| follow(model, &solver, &range));
    for i in 0..at.len() {
        let ((omega, d, _), (known_omega, known_d, _)) = (only(&found, i), only(&known, i));
        assert!((omega / known_omega - 1.0).abs() < 1e-13, "{omega} {known_omega}");
        assert!((d / known_d - 1.0).abs() < 1e-13, "{d} {known_d}");
    }
}
