//! Curves that branch off from nonlinear modes, against closed forms.

use crate::common::models::{dense, oscillator};
use crate::common::{all_harmonics, amplitude_range, harmonics};
use hbvib::{
    BifurcationKind, Branch, Contact, ContactKind, Hooks, ModeChoice, ModeGuess, ModeOptions, Model, Polynomial,
    nonlinear_mode,
};
use num_complex::Complex64;

const COUPLING: f64 = 0.1;

/// Two masses on springs of 1 + x², coupled by a weak spring.
fn pair() -> Model {
    let own = 1.0 + COUPLING;
    let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &[own, -COUPLING, -COUPLING, own]).build();
    for dof in [0, 1] {
        model.add_contact(&Contact::cubic(dof, None, 0.0, 1.0)).unwrap();
    }
    model
}

/// A mode with its further curves.
fn tree(model: &Model, index: usize, highest: usize, at: &[f64]) -> Branch {
    let range = ModeOptions {
        choice: ModeChoice::Index(index),
        at,
        branches: 1,
        ..amplitude_range(-2.0, 1.0)
    };
    nonlinear_mode(model, &harmonics(highest), &range, &mut Hooks::default()).unwrap()
}

/// With one harmonic the motions A, B of both masses satisfy (k − ω²)A + c(A − B) + ¾A³ = 0 and the same with A and B exchanged. Sum and
/// difference give AB = −4c/3 beside A = −B, which branches off where A² = 4c/3 (Vakakis & Rand 1992,
/// doi:10.1016/0020-7462(92)90025-4, by normal forms).
#[test]
fn localised_modes_branch_off_from_the_opposed_one() {
    let product = -4.0 * COUPLING / 3.0;
    let mode = tree(&pair(), 1, 1, &[0.5]);
    let bifurcations = mode.bifurcations().unwrap();
    assert_eq!(bifurcations.len(), 1);
    let born = bifurcations[0];
    assert_eq!((born.kind, born.unstable), (BifurcationKind::BranchPoint, [None; 2]));
    let amplitude = mode.mode_at(born.point).unwrap().log10_amplitude;
    println!("{amplitude} {}", 0.5 * (-2.0 * product).log10());
    assert!((amplitude - 0.5 * (-2.0 * product).log10()).abs() < 1e-8);
    // ω² = k + 2c + ¾A² with A = −B.
    assert!((born.omega.powi(2) - (1.0 + 2.0 * COUPLING - 0.75 * product)).abs() < 1e-8);
    // One on each mass.
    assert_eq!(mode.children().len(), 2);
    let mut larger = Vec::new();
    for child in mode.children() {
        let descent = child.descent().unwrap();
        assert_eq!((descent.bifurcation, descent.periods), (Some(0), 1));
        assert_eq!(descent.kind, Some(BifurcationKind::BranchPoint));
        for point in 0..child.points() {
            let x = all_harmonics(child, point);
            let (a, b) = (x[2].re, x[3].re);
            assert!((a * b - product).abs() < 1e-9);
            let square = 1.0 + 0.75 * (a * a - a * b + b * b);
            assert!((child.omega()[point].powi(2) - square).abs() < 1e-9);
        }
        let [at] = child.at(0) else { panic!("{:?}", child.at(0)) };
        let x = all_harmonics(child, at.point);
        larger.push(x[2].norm() > x[3].norm());
    }
    larger.sort_unstable();
    assert_eq!(larger, [false, true]);
    assert_eq!(
        mode.searched().map(|s| (s.bifurcations, s.lost, s.left)),
        Some((1, 0, 0))
    );
}

/// More harmonics move the branch point a little, and the curves remain solutions, with damping as well.
#[test]
fn localised_modes_have_their_harmonics_and_damping() {
    let mut model = pair();
    model.set_rayleigh(0.0, 0.01).unwrap();
    let mode = tree(&model, 1, 7, &[]);
    let bifurcations = mode.bifurcations().unwrap();
    assert_eq!((bifurcations.len(), mode.children().len()), (1, 2));
    let alone = tree(&pair(), 1, 7, &[]).bifurcations().unwrap()[0];
    assert!((bifurcations[0].omega - alone.omega).abs() < 1e-4 && (alone.omega - 1.140_034_8).abs() < 1e-6);
    let both = [0, 1].map(|i| mode.children()[i].mode_at(5).unwrap());
    assert!(both.iter().all(|point| point.damping_ratio > 1e-3));
    for point in 0..mode.children()[0].points() {
        let point = mode.children()[0].mode_at(point).unwrap();
        assert!((point.damping_ratio / point.energy_damping_ratio() - 1.0).abs() < 1e-6);
    }
}

/// The common mode has no branch point, and without the option nothing is sought.
#[test]
fn a_mode_without_branch_points_has_no_children() {
    let mode = tree(&pair(), 0, 5, &[]);
    assert!(mode.bifurcations().unwrap().is_empty() && mode.children().is_empty());
    assert_eq!(mode.searched().map(|searched| searched.bifurcations), Some(0));
    let range = ModeOptions {
        choice: ModeChoice::Index(1),
        ..amplitude_range(-2.0, 1.0)
    };
    let plain = nonlinear_mode(&pair(), &harmonics(5), &range, &mut Hooks::default()).unwrap();
    assert!(plain.bifurcations().unwrap().is_empty() && plain.searched().is_none());
    let refused = ModeOptions { branches: 2, ..range };
    let error = nonlinear_mode(&pair(), &harmonics(5), &refused, &mut Hooks::default()).unwrap_err();
    assert!(error.message().contains("branches = 2, needs 0 .. 1"));
}

/// A guess leads to the first point where springs are polynomials, too: their static state has no harmonics of the guess.
#[test]
fn a_guess_is_taken_beside_polynomial_springs() {
    let models = [0, 1].map(|kind| {
        let spring = Polynomial::scalar(&[0.0, 0.0, 1.0], &[]).unwrap();
        let contacts = [
            Contact::cubic(0, None, 0.0, 1.0),
            Contact::between(0, None, ContactKind::Polynomial(spring)),
        ];
        oscillator(1.0, 1.0).contact(&contacts[kind]).build()
    });
    let motion = [Complex64::ZERO, 1.0.into()];
    let range = ModeOptions {
        guess: Some(ModeGuess {
            motion: &motion,
            omega: 1.3,
            damping_ratio: 0.0,
        }),
        ..amplitude_range(0.0, 0.5)
    };
    let [cubic, polynomial] =
        models.map(|model| nonlinear_mode(&model, &harmonics(7), &range, &mut Hooks::default()).unwrap());
    assert!((cubic.omega()[0] - polynomial.omega()[0]).abs() < 1e-10);
}
