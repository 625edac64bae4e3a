//! Nonlinear modes that do not simply go on: whose amplitude turns as soon as contacts slip, or whose
//! frequency falls to nothing.

use crate::common::models::dense;
use crate::common::{all_harmonics, amplitude_range, harmonics};
use hbvib::{Branch, Contact, Hooks, ModeField, Model, Status, nonlinear_mode};
use num_complex::Complex64;
use std::f64::consts::PI;

fn log10(branch: &Branch) -> &[f64] {
    branch.mode_field(ModeField::Log10Amplitude).unwrap()
}

const KT: f64 = 2.0;
const STIFFNESS: [f64; 4] = [2.52, -0.3, -0.3, 0.8];

/// Two masses, weakly coupled. While the contact of the second mass sticks, the first mode moves mostly
/// the first mass; slip brings the frequencies together, and the motion goes over to the second mass.
fn veering() -> Model {
    let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &STIFFNESS).build();
    model.add_contact(&Contact::jenkins(1, None, KT, 1.0, KT)).unwrap();
    model
}

/// Equivalent stiffness of the contact, slip limit over stiffness 1, at amplitude `y`.
fn equivalent(y: f64) -> Complex64 {
    if y <= 1.0 {
        return KT.into();
    }
    let theta = (1.0 - 2.0 / y).acos();
    Complex64::new(theta - 0.5 * (2.0 * theta).sin(), theta.sin().powi(2)) * KT / PI
}

/// Asserts (K + k_eq(Y) W Wᵀ) x = ω²(1 + 2iD) x for one harmonic at every point.
fn solves_the_closed_form(branch: &Branch) {
    let damping = branch.mode_field(ModeField::DampingRatio).unwrap();
    for (point, d) in damping.iter().enumerate() {
        let x = &all_harmonics(branch, point)[2..4];
        let omega = branch.omega()[point];
        let inertia = omega * omega * Complex64::new(1.0, 2.0 * d);
        let contact = equivalent(x[1].norm()) * x[1];
        let rest = [
            STIFFNESS[0] * x[0] + STIFFNESS[1] * x[1] - inertia * x[0],
            STIFFNESS[2] * x[0] + STIFFNESS[3] * x[1] + contact - inertia * x[1],
        ];
        let size = x[0].norm().max(x[1].norm());
        assert!(rest.iter().all(|r| r.norm() < 1e-9 * size), "point {point}: {rest:?}");
    }
}

#[test]
fn a_mode_whose_amplitude_turns_at_the_onset_of_slip_is_followed_round_the_corner() {
    let model = veering();
    let onset = {
        let range = amplitude_range(-1.0, 0.0);
        let stuck = nonlinear_mode(&model, &harmonics(1), &range, &mut Hooks::default()).unwrap();
        stuck.mode().unwrap().linear_up_to
    };
    // From stuck contacts, and from an amplitude that only the far side of the turn reaches.
    for start in [onset - 3.0, onset + 0.5] {
        let range = amplitude_range(start, onset + 4.0);
        let branch = nonlinear_mode(&model, &harmonics(1), &range, &mut Hooks::default()).unwrap();
        assert_eq!(branch.status(), Status::Ok);
        let p = log10(&branch);
        assert!(p[0].to_bits() == range.log10_start.to_bits());
        assert!(p[p.len() - 1].to_bits() == range.log10_stop.to_bits());
        solves_the_closed_form(&branch);
        println!("{} points, {} folds", p.len(), branch.folds().len());
        if start < onset {
            let turn = branch.mode_at(branch.folds()[0].point).unwrap().log10_amplitude - onset;
            assert!(turn > 0.0 && turn < 0.01, "turns {turn} beyond the onset");
            assert!(p.windows(2).all(|w| w[0].to_bits() != w[1].to_bits()));
        }
    }
}

/// x″ + x − x³ = 0: one harmonic has ω² = 1 − ¾a², so that no motion is left at a = (4/3)^½.
#[test]
fn a_mode_that_softens_until_its_stiffness_is_gone_ends_there_with_numbers_that_mean_something() {
    let mut model = dense(&[1.0], &[1.0]).build();
    model.add_contact(&Contact::cubic(0, None, 0.0, -1.0)).unwrap();
    let range = amplitude_range(-2.0, 2.0);
    let branch = nonlinear_mode(&model, &harmonics(1), &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::StoppedStepTooSmall);
    assert!(branch.points() < 150, "{} points", branch.points());
    for point in 0..branch.points() {
        let found = branch.mode_at(point).unwrap();
        let omega = branch.omega()[point];
        let square = 1.0 - 0.75 * 10f64.powf(2.0 * found.log10_amplitude);
        assert!((omega * omega - square).abs() < 1e-9, "point {point}");
        assert!(found.energy > 0.0 && (found.fundamental_share - 1.0).abs() < 1e-12);
        assert!(found.damping_ratio.abs() < 1e-4);
    }
    let end = log10(&branch)[branch.points() - 1];
    assert!((end - 0.5 * (4.0_f64 / 3.0).log10()).abs() < 1e-8, "ends at {end}");
}
