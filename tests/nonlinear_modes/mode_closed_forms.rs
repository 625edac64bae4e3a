//! Nonlinear modes with one harmonic against the describing function of a Jenkins contact, and the
//! limit of large amplitude: closed forms. Only the eigenvalue problem is solved here, by a
//! method of its own.

use crate::common::mode_cases::{
    blisk_matrices, damped, delta, disk_minus_ring, follow, harmonic, only, singular_at, spring,
};
use crate::common::{self, BASE, Blisk, D, R, amplitude_range, data, harmonics, number};
use hbvib::{Amplitude, ContactState, DampingForm, ModeOptions};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::PI;

/// k_eq + i·loss at fundamental amplitude a·δ, a ≥ 1, over kt.
fn describing_function(a: f64) -> Complex64 {
    let theta = (1.0 - 2.0 / a).acos();
    Complex64::new((theta - 0.5 * (2.0 * theta).sin()) / PI, 4.0 * (a - 1.0) / (PI * a * a))
}

#[test]
fn the_describing_function_of_this_file_is_that_of_the_reference() {
    for row in data("closed_forms.json")["table"].as_array().unwrap() {
        let k = describing_function(number(&row["a"]));
        assert!((k.re / number(&row["k_eq_over_kt"]) - 1.0).abs() < 1e-9);
        assert!((k.im / number(&row["loss_over_kt"]) - 1.0).abs() < 1e-9);
    }
}

/// The closed form at slip amplitude a.
struct Expected {
    a: f64,
    omega: f64,
    damping: f64,
    modal_amplitude: f64,
}

/// The family's backbone by the describing function, from stuck to sliding.
fn closed_form(case: &Blisk, beta: f64, family: usize, form: DampingForm) -> Vec<Expected> {
    let wave = blisk_matrices(case, beta, 1);
    let w = disk_minus_ring();
    let modes = case
        .sector()
        .linear_modes(case.engine_order, ContactState::Stuck)
        .unwrap();
    let mut shape = DVector::from_column_slice(&modes.shapes[family * 4..(family + 1) * 4]);
    let mut at = (modes.omega[family], 0.0);
    let mut expected = Vec::new();
    for step in 0..=80 {
        let a = 10f64.powf(0.002 + 0.05 * f64::from(step));
        let contact = spring(&w, case.kt() * describing_function(a));
        let matrix = |omega: f64, d: f64| -> DMatrix<Complex64> {
            let i = Complex64::I;
            let loss = &wave.damping * (i * omega) + &wave.stiffness + &contact;
            match form {
                DampingForm::Mass => loss - &wave.mass * (omega * omega * (1.0 + 2.0 * i * d)),
                DampingForm::Stiffness => {
                    loss - &wave.stiffness * (2.0 * i * d) - &wave.mass * Complex64::from(omega * omega)
                }
            }
        };
        let (omega, d, x) = singular_at(matrix, at, &shape);
        let modal = (x.adjoint() * &wave.mass * &x)[0].re.sqrt();
        let motion = (w.adjoint() * &x)[0].norm();
        expected.push(Expected {
            a,
            omega,
            damping: d,
            modal_amplitude: a * delta(case) * modal / motion,
        });
        at = (omega, d);
        shape = x;
    }
    expected
}

/// Follows the family and compares at equal amplitude: largest errors of ω, of D relative to its
/// maximum, and of the slip amplitude.
fn compare(case: &Blisk, beta: f64, family: usize, form: DampingForm, by_contact: bool) -> (f64, f64, f64) {
    let expected = closed_form(case, beta, family, form);
    let delta = delta(case);
    let amplitude = |e: &Expected| {
        if by_contact {
            (e.a * delta).log10()
        } else {
            e.modal_amplitude.log10()
        }
    };
    let at: Vec<f64> = expected.iter().map(amplitude).collect();
    let branch = follow(
        &damped(case, beta),
        &harmonics(1),
        &ModeOptions {
            choice: hbvib::ModeChoice::Index(family),
            amplitude: if by_contact {
                Amplitude::Contact(0)
            } else {
                Amplitude::Modal
            },
            log10_start: at[0] - 0.5,
            log10_stop: at[at.len() - 1] + 0.1,
            at: &at,
            damping_form: form,
            ..ModeOptions::default()
        },
    );
    let most = expected.iter().fold(0.0_f64, |m, e| m.max(e.damping.abs()));
    let mut worst = (0.0_f64, 0.0_f64, 0.0_f64);
    for (i, e) in expected.iter().enumerate() {
        let (omega, d, point) = only(&branch, i);
        let x = harmonic(&branch, point, 1);
        worst.0 = worst.0.max((omega / e.omega - 1.0).abs());
        worst.1 = worst.1.max((d - e.damping).abs() / most);
        worst.2 = worst.2.max(((x[D] - x[R]).norm() / (e.a * delta) - 1.0).abs());
    }
    println!(
        "{form:?}, β = {beta:e}, EO {}, family {family}: ω {:.1e}, D {:.1e}, slip {:.1e}",
        case.engine_order, worst.0, worst.1, worst.2
    );
    worst
}

#[test]
fn one_harmonic_equals_the_describing_function_with_damping_of_either_type() {
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for beta in [0.0, common::BETA] {
            for (engine_order, family) in [(2, 0), (2, 1), (0, 0), (5, 2)] {
                let case = Blisk { engine_order, ..BASE };
                let worst = compare(&case, beta, family, form, engine_order != 2);
                assert!(worst.0 < 1e-9 && worst.1 < 1e-9 && worst.2 < 1e-9, "{worst:?}");
            }
        }
    }
}

#[test]
fn damping_times_amplitude_tends_to_the_closed_form_of_the_sliding_contact() {
    let limits = &data("closed_forms.json")["asymptotes"];
    let (wanted, slide) = (number(&limits["D_alpha_over_delta"]), number(&limits["omega_slide"]));
    let delta = delta(&BASE);
    let at = [4.0, 5.0, 6.0].map(|log: f64| delta.log10() + log);
    for h in [1, 3, 9] {
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(delta.log10() + 2.0, at[2])
        };
        let branch = follow(&damped(&BASE, 0.0), &harmonics(h), &range);
        let errors: Vec<(f64, f64)> = (0..3)
            .map(|i| {
                let (omega, d, point) = only(&branch, i);
                let alpha = branch.mode_at(point).unwrap().modal_amplitude / delta;
                (d * alpha / wanted - 1.0, omega / slide - 1.0)
            })
            .collect();
        for (at, (d, omega)) in ["1e4", "1e5", "1e6"].iter().zip(&errors) {
            println!("H = {h}, α = {at} δ: relative error of D·α {d:.1e}, of ω {omega:.1e}");
        }
        assert!(errors[1].0.abs() < 2e-4);
        // Both errors fall with the amplitude; that of D·α at least with its first power.
        assert!(errors[2].0.abs() < 0.2 * errors[1].0.abs() && errors[1].0.abs() < 0.2 * errors[0].0.abs());
        assert!(errors[2].1.abs() < 0.2 * errors[1].1.abs() && errors[2].1.abs() < 1e-8);
    }
}
