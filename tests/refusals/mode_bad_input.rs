//! Bad input to a nonlinear mode gives its stated error with a sentence that names the fault.

use crate::common::mode_cases as modes;
use crate::common::models::{dense, oscillator};
use crate::common::refusal::{self, refused};
use crate::common::{BASE, at_dof, harmonics};
use hbvib::{
    Amplitude, Branch, Constant, Contact, Hooks, MatrixKind, MatrixView, ModeChoice, ModeOptions, Model, Result,
    SolverOptions, Status, nonlinear_mode,
};
use num_complex::Complex64;

const RANGE: ModeOptions = ModeOptions {
    choice: ModeChoice::Index(0),
    diameter: None,
    amplitude: Amplitude::Modal,
    log10_start: -4.0,
    log10_stop: 0.0,
    at: &[],
    damping_form: hbvib::DampingForm::Mass,
    reference_dof: None,
    guess: None,
    branches: 0,
    branch_depth: 0,
    most_branches: 0,
};

fn follow(model: &Model, range: &ModeOptions) -> Result<Branch> {
    nonlinear_mode(model, &harmonics(3), range, &mut Hooks::default())
}

/// Asserts that the base case refuses these options.
fn base_refuses(range: &ModeOptions, status: Status, words: &[&str]) {
    refused(follow(&BASE.sector(), range), status, words);
}

#[test]
fn a_mode_that_does_not_exist_is_refused() {
    for index in [4, 5, usize::MAX] {
        let choice = ModeChoice::Index(index);
        base_refuses(
            &ModeOptions { choice, ..RANGE },
            Status::Index,
            &["mode_index", &index.to_string(), "0 .. 3"],
        );
    }
    for (choice, status, word) in [
        (ModeChoice::Near(f64::NAN), Status::NotFinite, "near_omega = NaN"),
        (ModeChoice::Near(0.0), Status::Argument, "near_omega = 0"),
        (ModeChoice::Near(-5.0), Status::Argument, "near_omega = -5"),
        (
            ModeChoice::Shape(&[Complex64::ONE; 3]),
            Status::Dimension,
            "3 complex entries",
        ),
        (ModeChoice::Shape(&[Complex64::ZERO; 4]), Status::Argument, "zero"),
        (
            ModeChoice::Shape(&[Complex64::new(f64::INFINITY, 0.0); 4]),
            Status::NotFinite,
            "shape[0]",
        ),
    ] {
        base_refuses(&ModeOptions { choice, ..RANGE }, status, &[word]);
    }
    for diameter in [1, -1, i64::MIN] {
        let range = ModeOptions {
            diameter: Some(diameter),
            ..RANGE
        };
        let words = format!("diameter = {diameter}, needs 0 .. 0");
        refused(range.check(1, 1, 1), Status::Argument, &[&words, "plain structure"]);
        // Any number of waves counts modulo the sectors.
        assert!(range.check(1, 1, 24).is_ok());
    }
}

#[test]
fn an_empty_reversed_or_unbounded_amplitude_range_is_refused() {
    for (start, stop) in [(-3.0, -3.0), (0.0, -1.0)] {
        let range = ModeOptions {
            log10_start: start,
            log10_stop: stop,
            ..RANGE
        };
        base_refuses(
            &range,
            Status::Argument,
            &[
                "empty or reversed",
                &format!("log10_start = {start}"),
                &format!("log10_stop = {stop}"),
            ],
        );
    }
    for (start, stop, status, word) in [
        (f64::NAN, 0.0, Status::NotFinite, "log10_start = NaN"),
        (-1.0, f64::INFINITY, Status::NotFinite, "log10_stop = inf"),
        (-200.0, 0.0, Status::Argument, "log10_start = -200"),
        (0.0, 151.0, Status::Argument, "log10_stop = 151"),
    ] {
        let range = ModeOptions {
            log10_start: start,
            log10_stop: stop,
            ..RANGE
        };
        base_refuses(&range, status, &[word]);
    }
    for (at, status, word) in [
        ([-2.0, 0.5], Status::Argument, "at[1] = 0.5"),
        ([-5.0, -2.0], Status::Argument, "at[0] = -5"),
        ([f64::NAN, -2.0], Status::NotFinite, "at[0] = NaN"),
    ] {
        base_refuses(&ModeOptions { at: &at, ..RANGE }, status, &[word]);
    }
}

/// Three masses in a row on springs, symmetric about the middle one.
fn row(contact: Option<Contact>) -> Model {
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let stiffness = [2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0];
    let mut model = dense(&mass, &stiffness).build();
    if let Some(contact) = contact {
        model.add_contact(&contact).unwrap();
    }
    model
}

#[test]
fn a_mode_that_moves_no_contact_is_refused() {
    // The second mode leaves the middle mass at rest.
    let second = ModeOptions {
        choice: ModeChoice::Index(1),
        ..RANGE
    };
    let middle = Contact::jenkins(1, None, 1.0, 1.0, 0.1);
    refused(
        follow(&row(Some(middle.clone())), &second),
        Status::Argument,
        &["mode 1", "moves no contact"],
    );
    assert_eq!(follow(&row(Some(middle.clone())), &RANGE).unwrap().status(), Status::Ok);
    // No contact at all, and contacts that never slip or never resist.
    refused(follow(&row(None), &RANGE), Status::Argument, &["moves no contact"]);
    for contact in [
        middle.clone().with(Constant::Preload, f64::INFINITY).unwrap(),
        middle.clone().with(Constant::Mu, 0.0).unwrap(),
    ] {
        refused(
            follow(&row(Some(contact)), &RANGE),
            Status::Argument,
            &["moves no contact"],
        );
    }
    // The contact that measures the amplitude must move, too.
    let mut model = row(Some(middle));
    model.add_contact(&Contact::jenkins(0, None, 1.0, 1.0, 0.1)).unwrap();
    model.add_contact(&Contact::jenkins(2, None, 1.0, 1.0, 0.1)).unwrap();
    let by_contact = |id| ModeOptions {
        choice: ModeChoice::Index(1),
        amplitude: Amplitude::Contact(id),
        ..RANGE
    };
    refused(
        follow(&model, &by_contact(0)),
        Status::Argument,
        &["amplitude_contact = 0", "does not move"],
    );
    refused(
        follow(&model, &by_contact(3)),
        Status::Index,
        &["amplitude_contact = 3", "3 contacts"],
    );
    assert_eq!(follow(&model, &by_contact(1)).unwrap().status(), Status::Ok);
}

#[test]
fn a_node_of_the_mode_is_no_phase_reference() {
    let model = row(Some(Contact::jenkins(0, None, 1e-3, 1.0, 0.1)));
    let symmetric = {
        let mut model = row(Some(Contact::jenkins(0, None, 1.0, 1.0, 0.1)));
        model.add_contact(&Contact::jenkins(2, None, 1.0, 1.0, 0.1)).unwrap();
        model
    };
    let with = |index, reference_dof| ModeOptions {
        choice: ModeChoice::Index(index),
        reference_dof: Some(reference_dof),
        ..RANGE
    };
    refused(
        follow(&symmetric, &with(1, 1)),
        Status::Argument,
        &["reference_dof = 1", "node"],
    );
    assert_eq!(follow(&symmetric, &with(1, 0)).unwrap().status(), Status::Ok);
    assert_eq!(follow(&symmetric, &with(0, 1)).unwrap().status(), Status::Ok);
    assert_eq!(
        follow(&symmetric, &with(1, 2)).unwrap().mode().unwrap().reference_dof,
        2
    );
    refused(
        follow(&model, &with(0, 3)),
        Status::Index,
        &["reference_dof = 3", "0 .. 2"],
    );
}

#[test]
fn mass_that_is_not_positive_and_modes_without_frequency_are_refused() {
    let with_mass = |mass: [f64; 9]| {
        let mut model = row(Some(Contact::jenkins(0, None, 1.0, 1.0, 0.1)));
        model
            .set_matrix(MatrixKind::Mass, &MatrixView::dense(3, &mass))
            .unwrap();
        model
    };
    // Each diagonal entry is positive, an eigenvalue is not.
    let indefinite = with_mass([1.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    refused(follow(&indefinite, &RANGE), Status::NotPositiveDefinite, &["mass"]);
    refused(
        follow(&with_mass([0.0; 9]), &RANGE),
        Status::NotPositiveDefinite,
        &["mass"],
    );
    let mut model = row(Some(Contact::jenkins(0, Some(1), 1.0, 1.0, 0.1)));
    let mut stiffness = |a: [f64; 9]| {
        model
            .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(3, &a))
            .unwrap();
        follow(&model, &RANGE)
    };
    let free = stiffness([1.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 1.0]);
    refused(free, Status::Argument, &["mode 0", "rigid body"]);
    let unstable = stiffness([-1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0]);
    refused(unstable, Status::Argument, &["mode 0", "unstable"]);
}

#[test]
fn bad_solver_options_are_refused() {
    let model = BASE.sector();
    let with = |solver: &SolverOptions| nonlinear_mode(&model, solver, &RANGE, &mut Hooks::default());
    refused(with(&harmonics(0)), Status::Argument, &["harmonics = 0", "at least 1"]);
    let bad = SolverOptions {
        tol_residual: 0.0,
        ..harmonics(3)
    };
    refused(with(&bad), Status::Argument, &["tol_residual = 0"]);
    let bad = at_dof(4, harmonics(3));
    refused(with(&bad), Status::Index, &["response_dof = 4", "0 .. 3"]);
}

#[test]
fn a_constant_load_that_nothing_holds_is_refused() {
    // A mass without a spring, pulled from a pressed stop, or along friction beyond its limit.
    let stop = Contact::unilateral(Some(0), None, 1.0, 0.0)
        .with(Constant::Preload, 0.5)
        .unwrap();
    for contact in [stop, Contact::jenkins(0, None, 1.0, 0.5, 1.0)] {
        let model = oscillator(1.0, 0.0).contact(&contact).force(0, 0, 2.0).build();
        refused(
            follow(&model, &RANGE),
            Status::NoConvergence,
            &["no static state", "constant forces and preload"],
        );
    }
}

#[test]
fn a_static_state_without_stability_is_refused() {
    let mut model = oscillator(1.0, 1.0).contact(Contact::cubic(0, None, 0.0, -1.0)).build();
    // The spring x − x³ holds 0.385 at most; beyond lies only an unstable equilibrium.
    model.add_force(0, 0, 2.0.into()).unwrap();
    refused(
        follow(&model, &RANGE),
        Status::Argument,
        &["mode 0", "statically unstable"],
    );
}

#[test]
fn a_refused_mode_leaves_the_model_as_it_was() {
    refusal::unharmed(|model| {
        refused(
            follow(
                model,
                &ModeOptions {
                    diameter: Some(5),
                    choice: ModeChoice::Index(9),
                    ..RANGE
                },
            ),
            Status::Index,
            &["mode_index = 9"],
        );
        // A mode of another diameter that is found leaves it, too.
        let range = ModeOptions {
            diameter: Some(5),
            ..RANGE
        };
        assert!(follow(model, &range).is_ok());
    });
}

#[test]
fn a_caller_may_stop_at_any_point_and_keeps_what_was_found() {
    let model = modes::damped(&BASE, 0.0);
    for wanted in [1, 3, 12] {
        let mut progress = |p: &hbvib::Progress| p.point == wanted;
        let mut hooks = Hooks {
            progress: Some(&mut progress),
            ..Hooks::default()
        };
        let branch = nonlinear_mode(&model, &harmonics(3), &RANGE, &mut hooks).unwrap();
        assert_eq!((branch.status(), branch.points()), (Status::StoppedByCaller, wanted));
    }
    let solver = SolverOptions {
        max_points: 7,
        ..harmonics(3)
    };
    let branch = nonlinear_mode(&model, &solver, &RANGE, &mut Hooks::default()).unwrap();
    assert_eq!((branch.status(), branch.points()), (Status::StoppedMaxPoints, 7));
}

/// Without linear damping the linear mode needs no artificial damping, but slip will.
#[test]
fn stiffness_type_damping_is_refused_where_all_stiffness_is_in_springs_and_contacts() {
    let model = oscillator(2.0, 0.0).slider(0, 3.0, 0.5, 1.0).build();
    let stiffness = ModeOptions {
        damping_form: hbvib::DampingForm::Stiffness,
        ..RANGE
    };
    refused(
        follow(&model, &stiffness),
        Status::Singular,
        &["springs and contacts", "mass type"],
    );
    assert!(follow(&model, &RANGE).is_ok());
}
