//! The Iwan joint against its closed forms.

use crate::common::models::oscillator;
use crate::common::{harmonics, solve_at};
use hbvib::{Constant, Contact, Iwan, contact_evaluate};
use num_complex::Complex64;
use std::f64::consts::PI;

const JOINT: Iwan = Iwan {
    slip_force: 4.0,
    stiffness: 1e3,
    chi: -0.4,
    beta: 0.3,
};

fn sides() -> Contact {
    Contact::jenkins(0, None, 0.0, 0.0, 0.0)
}

/// Fundamental of the force and loss per cycle under y = a cos τ.
fn force(elements: &[Contact], a: f64) -> (Complex64, f64) {
    let y = [Complex64::ZERO, a.into()];
    let mut sum = Complex64::ZERO;
    for contact in elements {
        let mut f = [Complex64::ZERO; 2];
        contact_evaluate(contact, 1, 0, 1.0, &y, &mut f, None).unwrap();
        sum += f[1];
    }
    (sum, PI * (sum * a).im)
}

#[test]
fn stiffness_at_rest_and_slip_force_are_exact_for_any_number_of_elements() {
    for n in [2, 7, 100] {
        let elements = JOINT.elements(&sides(), n).unwrap();
        assert_eq!(elements.len(), n);
        let stiffness: f64 = elements.iter().map(|c| c.constant(Constant::Kt)).sum();
        let slip: f64 = elements.iter().map(Contact::slip_limit).sum();
        assert!((stiffness / JOINT.stiffness - 1.0).abs() < 1e-13);
        assert!((slip / JOINT.slip_force - 1.0).abs() < 1e-13);
    }
}

#[test]
fn the_loss_grows_with_the_power_that_chi_tells() {
    let largest = JOINT.largest_displacement();
    let elements = JOINT.elements(&sides(), 400).unwrap();
    for a in [1e-3, 1e-2, 0.1, 0.5, 1.0].map(|s| s * largest) {
        let (_, loss) = force(&elements, a);
        assert!(
            (loss / JOINT.loss(a) - 1.0).abs() < 2e-3,
            "{a}: {loss} {}",
            JOINT.loss(a)
        );
    }
    // Twice the amplitude beyond full slip: the loss of a slider with the joint's elastic stroke.
    let (_, one) = force(&elements, 10.0 * largest);
    let (_, two) = force(&elements, 11.0 * largest);
    assert!(((two - one) / (4.0 * JOINT.slip_force * largest) - 1.0).abs() < 1e-10);
}

#[test]
fn more_elements_converge_to_the_distribution() {
    let a = 0.3 * JOINT.largest_displacement();
    let error = |n| {
        let (_, loss) = force(&JOINT.elements(&sides(), n).unwrap(), a);
        (loss / JOINT.loss(a) - 1.0).abs()
    };
    assert!(error(40) < 0.1 && error(160) < 0.1 * error(40) + 1e-3 && error(640) < 1e-3);
}

#[test]
fn a_joint_in_a_model_is_its_contacts() {
    let mut model = oscillator(1.0, 100.0).damping(&[0.1]).force(0, 1, 2.0).build();
    let first = model.add_iwan(&sides(), &JOINT, 30).unwrap();
    assert_eq!((first, model.contacts().len()), (0, 30));
    let branch = solve_at(&model, &harmonics(1), 30.0);
    let x = branch.response_at(0).unwrap()[0];
    // H = 1: (k − ω² + iωc) x + f(|x|)·x/|x| = F.
    let (f, _) = force(&JOINT.elements(&sides(), 30).unwrap(), x.norm());
    let rest = (100.0 - 900.0 + Complex64::new(0.0, 3.0)) * x + f * x / x.norm() - 2.0;
    assert!(rest.norm() < 1e-9, "{rest}");
    let slipping = branch.slip_fraction().iter().filter(|s| **s > 0.0).count();
    assert!(slipping > 3 && slipping < 30, "{slipping}");
}

#[test]
fn parameters_out_of_range_are_named() {
    for (joint, words) in [
        (Iwan { chi: -1.0, ..JOINT }, "chi = -1, needs -1 < chi <= 0"),
        (Iwan { chi: f64::NAN, ..JOINT }, "chi = NaN"),
        (Iwan { beta: -0.1, ..JOINT }, "beta = -0.1"),
        (
            Iwan {
                slip_force: 0.0,
                ..JOINT
            },
            "slip_force = 0",
        ),
        (
            Iwan {
                stiffness: -1.0,
                ..JOINT
            },
            "stiffness = -1",
        ),
    ] {
        let error = joint.elements(&sides(), 10).unwrap_err();
        assert!(error.message().contains(words), "{error}");
    }
    let error = JOINT.elements(&sides(), 1).unwrap_err();
    assert!(error.message().contains("elements = 1, needs 2 .. 10000"));
}
