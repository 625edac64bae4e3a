//! Mistakes and results that need a sentence: contacts without stiffness, a negative preload, a model without
//! matrices, a response without any force, and an undamped resonance.

use crate::common::refusal::refused;
use crate::common::{amplitude_range, harmonics, omega_range, peers::structure, sweep};
use hbvib::{Constant, Contact, ContactState, Hooks, Model, SolverOptions, Status, forced_response, nonlinear_mode};

#[test]
fn a_contact_without_stiffness_is_refused_by_the_name_of_its_constant() {
    let mut model = Model::new(3).unwrap();
    let plane = |n| Contact::friction_3d([Some(0), Some(1), n], [None; 3], (0.0, 0.0), 0.3, 0.0);
    for (contact, sentence) in [
        (Contact::jenkins(0, None, 0.0, 0.3, 1.0), "kt = 0"),
        (Contact::unilateral(Some(0), None, 0.0, 0.1), "kn = 0"),
        (Contact::cubic(0, None, 0.0, 0.0), "kt = 0 and cubic = 0"),
        (plane(None), "kt = 0"),
        (plane(Some(2)), "kn = 0"),
    ] {
        refused(model.add_contact(&contact), Status::Argument, &[sentence, "needs"]);
        refused(model.add_contacts(&[contact]), Status::Argument, &["entry 0", sentence]);
    }
}

#[test]
fn a_negative_preload_is_refused_with_the_gap_that_means_the_same() {
    let mut model = Model::new(1).unwrap();
    let stop = Contact::unilateral(Some(0), None, 2.0, 0.5)
        .with(Constant::Preload, -3.0)
        .unwrap();
    refused(
        model.add_contact(&stop),
        Status::Argument,
        &["preload = -3", "gap = 2 "],
    );
    // A load that does not vary has no gap.
    let rubbing = Contact::jenkins(0, None, 1.0, 0.3, -1.0);
    let error = model.add_contact(&rubbing).unwrap_err().to_string();
    assert!(error.contains("preload = -1") && !error.contains("gap"), "{error}");
}

#[test]
fn a_model_without_matrices_is_refused_by_every_analysis() {
    let mut model = Model::new(2).unwrap();
    model.add_force(0, 1, 1.0.into()).unwrap();
    let sentence = &["no matrices were set"];
    let range = omega_range(1.0, 2.0);
    let solver = SolverOptions::default();
    let hooks = &mut Hooks::default();
    refused(
        forced_response(&model, &solver, &range, hooks),
        Status::Argument,
        sentence,
    );
    let amplitudes = amplitude_range(-1.0, 1.0);
    refused(
        nonlinear_mode(&model, &solver, &amplitudes, hooks),
        Status::Argument,
        sentence,
    );
    refused(model.linear_modes(0, ContactState::Stuck), Status::Argument, sentence);
}

#[test]
fn a_response_without_any_force_is_zero_with_a_status_that_says_so() {
    let mut model = structure(&[1.0], &[0.1], &[1.0]);
    model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 1.0)).unwrap();
    let branch = sweep(&model, &harmonics(3), 0.5, 1.5, &[]);
    assert_eq!(branch.status(), Status::StoppedNoForce);
    assert!(branch.amplitude().iter().all(|a| *a == 0.0) && branch.omega().last() == Some(&1.5));
}

#[test]
fn an_undamped_resonance_is_no_peak_and_a_hardly_damped_one_is() {
    for (damping, wanted) in [(0.0, Status::StoppedUnbounded), (1e-8, Status::Ok)] {
        let mut model = structure(&[1.0], &[damping], &[1.0]);
        model.add_force(0, 1, 1.0.into()).unwrap();
        let branch = sweep(&model, &harmonics(1), 0.5, 1.5, &[]);
        assert_eq!(branch.status(), wanted, "damping {damping:e}");
        assert_eq!(branch.reason().is_some(), damping == 0.0);
        if let Some(reason) = branch.reason() {
            assert!(reason.to_string().contains("undamped resonance"), "{reason}");
        }
    }
}
