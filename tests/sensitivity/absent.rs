//! Parameters that a model does not have are refused by name; derivatives that do not exist are NaN with their reason,
//! and those by the limit of a stuck contact are exactly zero.

use crate::common::laws::Plate;
use crate::common::{BASE, one_mass};
use crate::design::{Design, Results, tight};
use hbvib::{
    Constant, Contact, ContactKind, MatrixKind, MatrixView, Parameter, Quantity, Reason, Speed, Status, User,
    sensitivity,
};
use std::f64::consts::TAU;
use std::sync::Arc;

fn of(constant: Constant, contact: usize) -> Parameter<'static> {
    Parameter::Contact {
        constant,
        contact: Some(contact),
    }
}

/// Asserts that a parameter of a model is refused with a sentence that has these words.
fn refused(model: &hbvib::Model, parameter: Parameter<'_>, status: Status, words: &str) {
    let (branch, point, _) = Results::At(0.9).solve(model, &tight(3));
    let error = sensitivity(
        model,
        &branch,
        point,
        &[Parameter::Force, parameter],
        Quantity::Amplitude,
    )
    .unwrap_err();
    assert_eq!(error.status, status, "{error}");
    assert!(error.to_string().contains(words), "{error}");
}

#[test]
fn parameters_that_do_not_exist_are_refused_by_name() {
    let mut model = one_mass(0.1, &Contact::jenkins(0, None, 1.0, 0.3, 1.0), 1.0);
    refused(
        &model,
        of(Constant::Kn, 0),
        Status::Unsupported,
        "parameter 1: kn of contact 0, but that is a Jenkins",
    );
    refused(&model, of(Constant::Gap, 0), Status::Unsupported, "gap of contact 0");
    refused(
        &model,
        of(Constant::Mu, 1),
        Status::Index,
        "contact 1, but the model has 1",
    );
    let all = Parameter::Contact {
        constant: Constant::Kn,
        contact: None,
    };
    refused(&model, all, Status::Unsupported, "kn: no contact");
    refused(
        &model,
        Parameter::Direction {
            which: MatrixKind::Mass,
            direction: MatrixView::dense(2, &[0.0; 4]),
        },
        Status::Dimension,
        "direction",
    );
    let which = MatrixKind::Gyroscopic;
    refused(&model, Parameter::Factor { which }, Status::Unsupported, "gyroscopic");
    model.set_speed(Speed::PerOmega(1.0)).unwrap();
    refused(&model, Parameter::Speed, Status::Unsupported, "tied to the frequency");
    model.set_speed(Speed::Fixed(0.0)).unwrap();
    model.set_modal_damping(&[0.01]).unwrap();
    let which = MatrixKind::Stiffness;
    refused(
        &model,
        Parameter::Factor { which },
        Status::Unsupported,
        "modal damping",
    );
    let law = User::new(Arc::new(Plate), 2, 0).unwrap();
    let mut model = hbvib::Model::new(2).unwrap();
    for kind in [MatrixKind::Mass, MatrixKind::Stiffness] {
        model
            .set_matrix(kind, &MatrixView::dense(2, &[1.0, 0.0, 0.0, 1.0]))
            .unwrap();
    }
    model
        .add_contact(&Contact::over(vec![0, 1], ContactKind::User(law)))
        .unwrap();
    model.add_force(0, 1, 0.3.into()).unwrap();
    refused(&model, of(Constant::Kt, 0), Status::Unsupported, "law of the caller");
}

#[test]
fn results_that_a_point_does_not_have_are_refused() {
    let model = Design::ring_damper(&BASE, 300.0).model();
    let (branch, peak, _) = Results::Peak(207.0 * TAU, 209.0 * TAU).solve(&model, &tight(5));
    let stored = branch.stored();
    for (point, of, status, words) in [
        (0, Quantity::PeakOmega, Status::Argument, "point = 0 is no peak"),
        (peak, Quantity::ModeOmega, Status::Argument, "forced response"),
        (stored, Quantity::Amplitude, Status::Index, "needs 0"),
    ] {
        let error = sensitivity(&model, &branch, point, &[Parameter::Force], of).unwrap_err();
        assert_eq!(error.status, status);
        assert!(error.to_string().contains(words), "{error}");
    }
    let other = Design::ring_damper(&BASE, 301.0).model();
    let error = sensitivity(&other, &branch, peak, &[Parameter::Force], Quantity::Amplitude).unwrap_err();
    assert!(error.to_string().contains("other contacts than"), "{error}");
}

#[test]
fn the_limit_of_a_stuck_contact_changes_nothing() {
    let model = one_mass(0.1, &Contact::jenkins(0, None, 1.0, 0.3, 10.0), 1.0);
    let mut design = Design::ring_damper(&BASE, 1e6);
    design.contacts.push(Contact::jenkins(1, None, 1e5, 0.3, 1.0));
    for (model, omega, slips) in [(model, 1.2, false), (design.model(), 208.0 * TAU, true)] {
        let (branch, point, _) = Results::At(omega).solve(&model, &tight(7));
        assert_eq!(branch.slip_fraction_at(point).unwrap().iter().any(|&s| s > 0.0), slips);
        let parameters = [of(Constant::Preload, 0), of(Constant::Mu, 0), of(Constant::Kt, 0)];
        let found = sensitivity(&model, &branch, point, &parameters, Quantity::Amplitude).unwrap();
        assert_eq!(found.values[..2], [0.0, 0.0]);
        assert!(found.values[2] != 0.0);
    }
}

#[test]
fn at_the_onset_of_slip_there_is_no_derivative() {
    let (kt, omega, damping) = (1.0, 1.2, 0.1);
    let stiffness = num_complex::Complex64::new(1.0 + kt - omega * omega, omega * damping);
    let limit = kt / stiffness.norm();
    for (share, exists) in [(1.0, false), (1.001, true), (0.999, true)] {
        let model = one_mass(damping, &Contact::jenkins(0, None, kt, 1.0, share * limit), 1.0);
        let (branch, point, _) = Results::At(omega).solve(&model, &tight(7));
        let parameters = [Parameter::Force, of(Constant::Preload, 0)];
        let found = sensitivity(&model, &branch, point, &parameters, Quantity::Amplitude).unwrap();
        for (value, reason) in found.values.iter().zip(&found.reasons) {
            assert_eq!(value.is_nan(), !exists, "{share}: {found:?}");
            let expected = if exists {
                Reason::Exists
            } else {
                Reason::OnsetOfSlip { contact: 0 }
            };
            assert_eq!(*reason, expected);
        }
    }
}

#[test]
fn a_constant_that_is_zero_has_a_derivative_on_one_side_only() {
    let model = one_mass(0.1, &Contact::jenkins(0, None, 1.0, 0.3, 0.0), 1.0);
    let (branch, point, _) = Results::At(1.2).solve(&model, &tight(7));
    let parameters = [of(Constant::Preload, 0), of(Constant::Kt, 0), Parameter::Force];
    let found = sensitivity(&model, &branch, point, &parameters, Quantity::Amplitude).unwrap();
    assert_eq!(found.reasons, [Reason::ZeroConstant, Reason::Exists, Reason::Exists]);
    assert!(found.values[0].is_nan() && found.values[1] == 0.0);
    assert!((found.values[2] / branch.amplitude()[0] - 1.0).abs() < 1e-12);
}

#[test]
fn in_a_fold_there_is_no_derivative() {
    let model = one_mass(0.04, &Contact::cubic(0, None, 0.0, 1.0), 0.3);
    let range = hbvib::ForcedOptions {
        omega_start: 0.6,
        omega_stop: 3.0,
        ..Default::default()
    };
    let branch = hbvib::forced_response(&model, &tight(5), &range, &mut hbvib::Hooks::default()).unwrap();
    let fold = branch.folds()[0].point;
    let found = sensitivity(&model, &branch, fold, &[Parameter::Force], Quantity::Amplitude).unwrap();
    assert!(found.values[0].is_nan() && found.reasons[0] == Reason::Fold);
}
