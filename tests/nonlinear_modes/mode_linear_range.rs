//! Where all contacts stick a nonlinear mode is linear: its frequency, its damping ratio and the
//! amplitude at which it ends are those of an eigenvalue problem, with or without structural damping.

use crate::common::mode_cases::{
    Skewed, WaveMatrices, blisk_matrices, damped, damping, delta, disk_minus_ring, follow, harmonic, only, singular_at,
    spring,
};
use crate::common::{BASE, Blisk, amplitude_range, data, harmonics, number};
use hbvib::{Amplitude, Branch, ContactState, DampingForm, ModeChoice, ModeField, ModeOptions};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Points of the curve at which every contact sticks.
fn stuck_points(branch: &Branch) -> usize {
    let log10 = branch.mode_field(ModeField::Log10Amplitude).unwrap();
    let limit = branch.mode().unwrap().linear_up_to;
    let stuck = log10.iter().position(|&p| p > limit).unwrap_or(log10.len());
    let contacts = branch.contacts();
    for (i, shares) in branch.slip_fraction().chunks_exact(contacts).enumerate() {
        // At the onset itself rounding decides.
        let slips = shares.iter().any(|&s| s > 1e-6);
        assert!(slips == (i >= stuck), "point {i}, {stuck} stuck: {shares:?}");
    }
    stuck
}

#[test]
fn without_damping_the_stuck_range_has_the_stuck_frequency_and_no_damping() {
    let reference = &data("nf_nd.json")["ring_stuck"]["30g"];
    for diameter in [0, 1, 2, 3, 7, 12] {
        for family in 0..4 {
            let case = Blisk {
                engine_order: diameter,
                ..BASE
            };
            let model = damped(&case, 0.0);
            let exact = model.linear_modes(diameter, ContactState::Stuck).unwrap();
            let motion = (disk_minus_ring().adjoint()
                * DVector::from_column_slice(&exact.shapes[family * 4..(family + 1) * 4]))[0]
                .norm();
            let onset = (delta(&case) / motion).log10();
            let branch = follow(
                &model,
                &harmonics(5),
                &ModeOptions {
                    choice: ModeChoice::Index(family),
                    log10_start: onset - 3.0,
                    log10_stop: onset + 0.5,
                    ..ModeOptions::default()
                },
            );
            let info = branch.mode().unwrap();
            assert!((info.linear_up_to - onset).abs() < 1e-11, "{diameter} {family}");
            let stuck = stuck_points(&branch);
            assert!(stuck > 10 && stuck < branch.points());
            let listed = TAU * number(&reference[diameter.to_string()]["f"][family]);
            for i in 0..stuck {
                assert!((branch.omega()[i] / exact.omega[family] - 1.0).abs() < 1e-12);
                assert!((branch.omega()[i] / listed - 1.0).abs() < 2e-12);
                assert!(damping(&branch)[i].abs() < 1e-12);
            }
            // Beyond it friction takes energy.
            assert!(damping(&branch)[stuck..].iter().all(|&d| d > 0.0));
        }
    }
}

#[test]
fn slip_begins_at_the_amplitude_of_the_closed_form() {
    let limits = &data("closed_forms.json")["asymptotes"];
    let delta = delta(&BASE);
    let wanted = number(&limits["alpha_crit_over_delta"]);
    for factor in [1e-3, 1.0, 1e3] {
        // The same onset wherever the range begins.
        let range = amplitude_range(
            (factor * wanted * delta).log10() - 0.5,
            (factor * wanted * delta).log10() + 4.0,
        );
        let branch = follow(&damped(&BASE, 0.0), &harmonics(3), &range);
        let found = 10f64.powf(branch.mode().unwrap().linear_up_to) / delta;
        assert!((found / wanted - 1.0).abs() < 1e-11, "{found}");
        let first = branch.mode_field(ModeField::Log10Amplitude).unwrap()[0];
        assert!((first - range.log10_start).abs() < 1e-14);
    }
    // Measured at the contact it is δ itself, and a hair around it decides.
    let at = [1.0 - 1e-9, 1.0 + 1e-4].map(|a: f64| (a * delta).log10());
    let range = ModeOptions {
        amplitude: Amplitude::Contact(0),
        at: &at,
        ..amplitude_range(delta.log10() - 1.0, delta.log10() + 1.0)
    };
    let branch = follow(&damped(&BASE, 0.0), &harmonics(3), &range);
    assert!((branch.mode().unwrap().linear_up_to - delta.log10()).abs() < 1e-11);
    let (below, beyond) = (only(&branch, 0), only(&branch, 1));
    println!(
        "D at 1 − 1e-9 and 1 + 1e-4 times the onset: {:e}, {:e}",
        below.1, beyond.1
    );
    assert!(below.1.abs() < 1e-12 && beyond.1 > 1e-9);
}

/// A(ω, D) of the linear problem, contacts stuck.
fn linear(
    wave: &WaveMatrices,
    stuck: &DMatrix<Complex64>,
    form: DampingForm,
    omega: f64,
    d: f64,
) -> DMatrix<Complex64> {
    let i = Complex64::I;
    let lossy = stuck + &wave.damping * (i * omega);
    match form {
        DampingForm::Mass => lossy - &wave.mass * (omega * omega * (1.0 + 2.0 * i * d)),
        DampingForm::Stiffness => lossy - &wave.stiffness * (2.0 * i * d) - &wave.mass * Complex64::from(omega * omega),
    }
}

/// Checks every stuck point of a branch against the linear problem; `terms` is A with the moduli of
/// its terms, against which rounding is measured.
fn check(branch: &Branch, wave: &WaveMatrices, stuck: &DMatrix<Complex64>, form: DampingForm) {
    let points = stuck_points(branch);
    assert!(points > 10);
    let start = (branch.omega()[0], damping(branch)[0]);
    let (omega, d, x) = singular_at(
        |omega, d| linear(wave, stuck, form, omega, d),
        start,
        &harmonic(branch, 0, 1),
    );
    let inertia = &wave.mass * &x * Complex64::from(omega * omega);
    let mut worst = (0.0_f64, 0.0_f64, 0.0_f64);
    for i in 0..points {
        let (w, dr) = (branch.omega()[i], damping(branch)[i]);
        let x = harmonic(branch, i, 1);
        let residual = linear(wave, stuck, form, w, dr) * &x;
        let size = stuck.map(Complex64::norm) * x.map(Complex64::norm);
        worst.0 = worst.0.max((w / omega - 1.0).abs());
        worst.1 = worst.1.max((dr - d).abs());
        worst.2 = worst.2.max(residual.camax() / size.max());
    }
    println!(
        "{form:?}: ω {omega}, D {d}; errors {:.1e}, {:.1e}, residual {:.1e}",
        worst.0, worst.1, worst.2
    );
    assert!(inertia.camax() > 0.0 && d > 0.0);
    assert!(worst.0 < 1e-12 && worst.1 < 1e-12 && worst.2 < 1e-12);
}

#[test]
fn with_proportional_damping_the_stuck_range_solves_the_damped_linear_problem() {
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for (engine_order, family, beta) in [
            (2, 0, 1.5e-6),
            (2, 1, 1.5e-6),
            (2, 0, 1e-4),
            (22, 0, 1.5e-6),
            (0, 2, 1e-5),
        ] {
            let case = Blisk { engine_order, ..BASE };
            let onset = delta(&case).log10();
            let range = ModeOptions {
                choice: ModeChoice::Index(family),
                amplitude: Amplitude::Contact(0),
                damping_form: form,
                ..amplitude_range(onset - 2.0, onset + 0.3)
            };
            let branch = follow(&damped(&case, beta), &harmonics(3), &range);
            let wave = blisk_matrices(&case, beta, 1);
            let stuck = &wave.stiffness + spring(&disk_minus_ring(), case.kt().into());
            check(&branch, &wave, &stuck, form);
        }
    }
}

#[test]
fn with_damping_in_no_proportion_the_stuck_range_solves_the_damped_linear_problem() {
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for engine_order in [2, 22, 0, 12] {
            for family in 0..3 {
                let skewed = Skewed::new(engine_order);
                let range = ModeOptions {
                    choice: ModeChoice::Index(family),
                    damping_form: form,
                    ..amplitude_range(-3.0, 0.0)
                };
                let branch = follow(&skewed.model(true), &harmonics(3), &range);
                check(&branch, &skewed.matrices(1), &skewed.stuck_stiffness(), form);
            }
        }
    }
}
