//! Power balance and scaling of nonlinear modes: exact statements about the equations at every H.

use crate::common::mode_cases::{Skewed, WaveMatrices, blisk_matrices, damped, damping, delta, follow, harmonic, only};
use crate::common::{self, BASE, Blisk, all_harmonics, amplitude_range, harmonics};
use hbvib::{Amplitude, Branch, DampingForm, ModeChoice, ModeField, ModeOptions, Model};
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// xᴴ A x
fn quadratic(a: &DMatrix<Complex64>, x: &DVector<Complex64>) -> f64 {
    x.dotc(&(a * x)).re
}

/// Checks energies and the balance at every point of the curve; `wave` gives the matrices of a harmonic.
/// Returns the largest error relative to the largest D.
fn balance(branch: &Branch, form: DampingForm, wave: impl Fn(usize) -> WaveMatrices) -> f64 {
    let most = damping(branch).iter().fold(0.0_f64, |m, d| m.max(d.abs()));
    let waves: Vec<(usize, WaveMatrices)> = branch.carried_at(0).unwrap().iter().map(|&h| (h, wave(h))).collect();
    let mut worst = 0.0_f64;
    for i in 0..branch.points() {
        let point = branch.mode_at(i).unwrap();
        let omega = branch.omega()[i];
        let (mut twice_kinetic, mut strain, mut structural, mut first) = (0.0, 0.0, 0.0, 0.0);
        for (h, a) in &waves {
            let x = harmonic(branch, i, *h);
            let hw = *h as f64 * omega;
            let kinetic = 0.5 * hw * hw * quadratic(&a.mass, &x);
            twice_kinetic += kinetic;
            if *h == 1 {
                first = kinetic;
            }
            strain += (h * h) as f64 * quadratic(&a.stiffness, &x);
            // ∫ ẋᵀ C ẋ over a cycle.
            structural += PI * (h * h) as f64 * omega * quadratic(&a.damping, &x);
        }
        assert!((point.energy / twice_kinetic - 1.0).abs() < 1e-11);
        assert!((point.fundamental_share - first / twice_kinetic).abs() < 1e-11);
        // Without damping rounding in the strain energy is left.
        assert!((point.structural_loss - structural).abs() <= 1e-10 * structural + 1e-13 * strain);
        let loss = point.friction_loss + point.structural_loss;
        let expected = match form {
            DampingForm::Mass => loss / (2.0 * TAU * twice_kinetic),
            DampingForm::Stiffness => loss / (TAU * strain),
        };
        worst = worst.max((expected - point.damping_ratio).abs() / most);
    }
    worst
}

#[test]
fn the_damping_ratio_is_the_loss_over_the_energy_at_every_point_of_the_blisk() {
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for beta in [0.0, common::BETA] {
            for h in [1, 3, 9] {
                let range = ModeOptions {
                    damping_form: form,
                    ..amplitude_range(delta(&BASE).log10() + 1.0, delta(&BASE).log10() + 6.0)
                };
                let branch = follow(&damped(&BASE, beta), &harmonics(h), &range);
                let worst = balance(&branch, form, |h| blisk_matrices(&BASE, beta, h));
                println!("{form:?}, β = {beta:e}, H = {h}: {worst:.1e} of the largest D");
                assert!(worst < 1e-9);
            }
        }
    }
}

#[test]
fn the_damping_ratio_is_the_loss_over_the_energy_with_contacts_across_sectors() {
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for with_damping in [false, true] {
            let skewed = Skewed::new(5);
            let range = ModeOptions {
                choice: ModeChoice::Index(1),
                damping_form: form,
                ..amplitude_range(-2.0, 3.0)
            };
            let branch = follow(&skewed.model(with_damping), &harmonics(5), &range);
            let worst = balance(&branch, form, |h| WaveMatrices {
                damping: skewed.matrices(h).damping * Complex64::from(f64::from(u8::from(with_damping))),
                ..skewed.matrices(h)
            });
            println!("{form:?}, damped: {with_damping}: {worst:.1e} of the largest D");
            assert!(worst < 1e-9);
        }
    }
}

/// A run over log10(δ) + 1 .. + 6 with solutions at given distances from log10(δ).
fn run(model: &Model, delta: f64, extra: f64, form: DampingForm) -> Branch {
    let at: Vec<f64> = (0..20)
        .map(|k| delta.log10() + extra + 1.5 + 0.22 * f64::from(k))
        .collect();
    let range = ModeOptions {
        at: &at,
        damping_form: form,
        ..amplitude_range(delta.log10() + extra + 1.0, delta.log10() + extra + 6.0)
    };
    follow(model, &harmonics(7), &range)
}

/// Largest differences of ω and D (relative to its maximum) and of motions over `scale`.
fn differences(a: &Branch, b: &Branch, time: f64, scale: f64) -> (f64, f64, f64) {
    let most = damping(a).iter().fold(0.0_f64, |m, &d| m.max(d));
    let mut worst = (0.0_f64, 0.0_f64, 0.0_f64);
    for i in 0..20 {
        let ((wa, da, pa), (wb, db, pb)) = (only(a, i), only(b, i));
        worst.0 = worst.0.max((wb * time / wa - 1.0).abs());
        worst.1 = worst.1.max((db - da).abs() / most);
        let x: Vec<Complex64> = all_harmonics(b, pb).iter().map(|z| z / scale).collect();
        worst.2 = worst.2.max(common::relative_gap(&x, &all_harmonics(a, pa)));
    }
    worst
}

#[test]
fn scaling_the_slip_limit_scales_the_amplitude_alone() {
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for beta in [0.0, common::BETA] {
            let reference = run(&damped(&BASE, beta), delta(&BASE), 0.0, form);
            for s in [1e-6, 1e-3, 0.37, 7.0, 1e3, 1e6] {
                let case = Blisk { load_factor: s, ..BASE };
                let scaled = run(&damped(&case, beta), delta(&case), 0.0, form);
                let worst = differences(&reference, &scaled, 1.0, s);
                println!(
                    "{form:?}, s = {s:e}: ω {:.1e}, D {:.1e}, x {:.1e}",
                    worst.0, worst.1, worst.2
                );
                assert!(worst.0 < 1e-10 && worst.1 < 1e-10 && worst.2 < 1e-10);
                assert_eq!(scaled.points(), reference.points());
            }
        }
    }
}

#[test]
fn metres_and_kilograms_agree_with_millimetres_and_tonnes() {
    // Newton stays: 1 t mm/s² = 1 N. The modal amplitude is in mm √t = 1e3 · 1e-1.5 m √kg.
    let small = Blisk {
        units: (1e3, 1e-3, 1.0),
        ..BASE
    };
    let reference = run(&damped(&BASE, common::BETA), delta(&BASE), 0.0, DampingForm::Mass);
    let other = run(&damped(&small, common::BETA), delta(&small), -1.5, DampingForm::Mass);
    let worst = differences(&reference, &other, 1.0, 1e3);
    println!("ω {:.1e}, D {:.1e}, x {:.1e}", worst.0, worst.1, worst.2);
    assert!(worst.0 < 1e-10 && worst.1 < 1e-10 && worst.2 < 1e-10);
    // Energies come in N mm.
    for i in 0..20 {
        let (a, b) = (only(&reference, i).2, only(&other, i).2);
        let (a, b) = (reference.mode_at(a).unwrap(), other.mode_at(b).unwrap());
        assert!((b.energy / a.energy / 1e3 - 1.0).abs() < 1e-9);
        assert!((b.friction_loss - 1e3 * a.friction_loss).abs() <= 1e-8 * b.friction_loss.max(b.structural_loss));
    }
}

#[test]
fn either_amplitude_measures_the_same_branch() {
    let delta = delta(&BASE);
    let model = damped(&BASE, common::BETA);
    let by_mode = run(&model, delta, 0.0, DampingForm::Mass);
    let slip: Vec<f64> = (0..20)
        .map(|i| {
            let x = harmonic(&by_mode, only(&by_mode, i).2, 1);
            (x[common::D] - x[common::R]).norm().log10()
        })
        .collect();
    let range = ModeOptions {
        amplitude: Amplitude::Contact(0),
        at: &slip,
        ..amplitude_range(slip[0] - 0.1, slip[19] + 0.1)
    };
    let by_contact = follow(&model, &harmonics(7), &range);
    let worst = differences(&by_mode, &by_contact, 1.0, 1.0);
    println!("ω {:.1e}, D {:.1e}, x {:.1e}", worst.0, worst.1, worst.2);
    assert!(worst.0 < 1e-9 && worst.1 < 1e-9 && worst.2 < 1e-9);
    let log10 = by_contact.mode_field(ModeField::Log10Amplitude).unwrap();
    assert!(log10.windows(2).all(|w| w[0] < w[1]));
}
