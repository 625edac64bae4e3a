//! Bad options, ranges and forces give their stated error with a sentence that names the field, and
//! leave the model usable: its response is the same afterwards, bit for bit.

use crate::common::refusal::{OMEGA, refused, unharmed};
use crate::common::{BASE, all_harmonics, at_dof, harmonics, omega_range, one_mass, solve_at};
use hbvib::{
    Amplitude, Contact, DampingForm, ForcedOptions, Hooks, MatrixKind, MatrixView, ModeChoice, ModeOptions, Model,
    Result, SolverOptions, Status, forced_response,
};
use num_complex::Complex64;

fn respond(model: &Model, solver: &SolverOptions, range: &ForcedOptions<'_>) -> Result<()> {
    forced_response(model, solver, range, &mut Hooks::default()).map(|_| ())
}

fn range(from: f64, to: f64) -> ForcedOptions<'static> {
    omega_range(from, to)
}

#[test]
fn every_bad_solver_option_is_refused_by_name() {
    let base = SolverOptions::default();
    let cases: [(SolverOptions, Status, &str); 15] = [
        (
            SolverOptions {
                tolerance: -1.0,
                ..base
            },
            Status::Argument,
            "tolerance",
        ),
        (SolverOptions { tolerance: 1.0, ..base }, Status::Argument, "tolerance"),
        (
            SolverOptions {
                tolerance: f64::NAN,
                ..base
            },
            Status::Argument,
            "tolerance",
        ),
        (
            SolverOptions {
                harmonics: 100_001,
                ..base
            },
            Status::Argument,
            "harmonics",
        ),
        (SolverOptions { samples: 18, ..base }, Status::Argument, "samples"),
        (
            SolverOptions {
                samples: usize::MAX,
                ..base
            },
            Status::Argument,
            "samples",
        ),
        (SolverOptions { step: -0.1, ..base }, Status::Argument, "step"),
        (
            SolverOptions {
                step_min: f64::INFINITY,
                ..base
            },
            Status::Argument,
            "step_min",
        ),
        (
            SolverOptions {
                step_max: f64::NAN,
                ..base
            },
            Status::Argument,
            "step_max",
        ),
        (
            SolverOptions {
                step_min: 0.1,
                step_max: 0.01,
                ..base
            },
            Status::Argument,
            "step_min",
        ),
        (
            SolverOptions {
                tol_residual: 0.0,
                ..base
            },
            Status::Argument,
            "tol_residual",
        ),
        (
            SolverOptions {
                tol_residual: f64::NAN,
                ..base
            },
            Status::Argument,
            "tol_residual",
        ),
        (SolverOptions { max_newton: 0, ..base }, Status::Argument, "max_newton"),
        (SolverOptions { max_points: 0, ..base }, Status::Argument, "max_points"),
        (at_dof(4, base), Status::Index, "response_dof = 4"),
    ];
    unharmed(|model| {
        for (options, status, name) in cases {
            refused(respond(model, &options, &range(OMEGA, OMEGA)), status, &[name]);
        }
    });
}

#[test]
fn every_bad_range_is_refused_by_name() {
    let short = [Complex64::ZERO; 3];
    let mut infinite = vec![Complex64::ZERO; 40];
    infinite[7].im = f64::INFINITY;
    let good = range(OMEGA, 1.1 * OMEGA);
    let cases = [
        (range(0.0, OMEGA), Status::Argument, "omega_start"),
        (range(OMEGA, -1.0), Status::Argument, "omega_stop"),
        (range(OMEGA, OMEGA * (1.0 + 1e-14)), Status::Argument, "omega_stop"),
        (range(f64::NAN, OMEGA), Status::NotFinite, "omega_start"),
        (range(OMEGA, f64::INFINITY), Status::NotFinite, "omega_stop"),
        (
            ForcedOptions {
                at: &[1.05 * OMEGA, 0.9 * OMEGA],
                ..good
            },
            Status::Argument,
            "at[1]",
        ),
        (
            ForcedOptions {
                at: &[f64::NAN],
                ..good
            },
            Status::NotFinite,
            "at[0]",
        ),
        (
            ForcedOptions {
                guess: Some(&short),
                ..good
            },
            Status::Dimension,
            "guess has 3",
        ),
        (
            ForcedOptions {
                guess: Some(&infinite),
                ..good
            },
            Status::NotFinite,
            "guess[7]",
        ),
    ];
    unharmed(|model| {
        for (range, status, name) in cases {
            refused(respond(model, &SolverOptions::default(), &range), status, &[name]);
        }
    });
}

#[test]
fn a_force_above_the_highest_harmonic_is_refused_with_the_remedy() {
    let mut model = BASE.sector();
    model.add_force(0, 7, Complex64::ONE).unwrap();
    refused(
        respond(&model, &harmonics(5), &range(OMEGA, OMEGA)),
        Status::Argument,
        &["harmonic 7", "raise harmonics to 7"],
    );
    // With the remedy, the same model works.
    respond(&model, &harmonics(7), &range(OMEGA, OMEGA)).unwrap();
    // A force of no size asks for nothing.
    let mut model = BASE.sector();
    model.add_force(0, 7, Complex64::ZERO).unwrap();
    respond(&model, &harmonics(5), &range(OMEGA, OMEGA)).unwrap();
}

#[test]
fn a_structure_without_matrices_has_no_answer_and_says_so() {
    let mut model = Model::new(2).unwrap();
    model.add_force(0, 1, Complex64::ONE).unwrap();
    refused(
        respond(&model, &harmonics(3), &range(1.0, 2.0)),
        Status::Argument,
        &["no matrices were set"],
    );
    let mut model = Model::cyclic(1, 8).unwrap();
    model
        .set_diameter(MatrixKind::Mass, 1, &MatrixView::dense(1, &[1.0]))
        .unwrap();
    model.set_wave(2);
    model.add_force(0, 1, Complex64::ONE).unwrap();
    refused(
        respond(&model, &harmonics(3), &range(1.0, 2.0)),
        Status::Argument,
        &["nodal diameter 2", "not given"],
    );
}

#[test]
fn a_model_without_forces_stays_at_rest() {
    let mut model = BASE.sector();
    model.clear_forces();
    let branch = solve_at(&model, &harmonics(5), OMEGA);
    assert_eq!(branch.status(), Status::StoppedNoForce);
    assert!(all_harmonics(&branch, 0).iter().all(|z| *z == Complex64::ZERO));
}

/// Good options of a mode.
const SIX_DECADES: ModeOptions<'static> = ModeOptions {
    choice: ModeChoice::Index(0),
    diameter: None,
    amplitude: Amplitude::Modal,
    log10_start: -6.0,
    log10_stop: 0.0,
    at: &[],
    damping_form: DampingForm::Mass,
    reference_dof: None,
    guess: None,
    branches: 0,
    branch_depth: 0,
    most_branches: 0,
};

#[test]
fn every_bad_range_of_a_mode_is_refused_by_name() {
    let good = SIX_DECADES;
    let cases = [
        (
            ModeOptions::default(),
            Status::Argument,
            "amplitude range is empty or reversed: log10_start = 0, log10_stop = 0, needs start < stop",
        ),
        (
            ModeOptions {
                log10_stop: -7.0,
                ..good
            },
            Status::Argument,
            "empty or reversed",
        ),
        (
            ModeOptions {
                log10_start: f64::NAN,
                ..good
            },
            Status::NotFinite,
            "log10_start",
        ),
        (
            ModeOptions {
                log10_stop: f64::INFINITY,
                ..good
            },
            Status::NotFinite,
            "log10_stop",
        ),
        (
            ModeOptions {
                log10_start: -400.0,
                ..good
            },
            Status::Argument,
            "log10_start = -400",
        ),
        (
            ModeOptions {
                at: &[-1.0, 0.5],
                ..good
            },
            Status::Argument,
            "at[1] = 0.5",
        ),
        (
            ModeOptions {
                at: &[f64::NAN],
                ..good
            },
            Status::NotFinite,
            "at[0]",
        ),
        (
            ModeOptions {
                reference_dof: Some(4),
                ..good
            },
            Status::Index,
            "reference_dof = 4, needs 0 .. 3",
        ),
    ];
    for (options, status, words) in cases {
        refused(options.check(4, 2, 24), status, &[words]);
    }
    let all = ModeOptions {
        at: &[-6.0, 0.0],
        reference_dof: Some(3),
        amplitude: Amplitude::Contact(1),
        ..good
    };
    all.check(4, 2, 24).unwrap();
    assert_eq!(all.damping_form, DampingForm::Mass);
}

#[test]
fn every_bad_choice_of_a_mode_is_refused_by_name() {
    let good = SIX_DECADES;
    let zero = [Complex64::ZERO; 4];
    let cases = [
        (
            ModeOptions {
                amplitude: Amplitude::Contact(2),
                ..good
            },
            Status::Index,
            "amplitude_contact = 2, but the model has 2 contacts",
        ),
        (
            ModeOptions {
                choice: ModeChoice::Near(-1.0),
                ..good
            },
            Status::Argument,
            "near_omega = -1",
        ),
        (
            ModeOptions {
                choice: ModeChoice::Shape(&zero[..3]),
                ..good
            },
            Status::Dimension,
            "shape has 3",
        ),
        (
            ModeOptions {
                choice: ModeChoice::Shape(&zero),
                ..good
            },
            Status::Argument,
            "shape is zero",
        ),
    ];
    for (options, status, words) in cases {
        refused(options.check(4, 2, 24), status, &[words]);
    }
}

#[test]
fn contacts_beyond_the_memory_limit_are_refused_by_their_number() {
    let mut model = one_mass(0.1, &Contact::jenkins(0, None, 1e-3, 0.3, 1.0), 1.0);
    for _ in 1..4000 {
        model.add_contact(&Contact::jenkins(0, None, 1e-3, 0.3, 1.0)).unwrap();
    }
    let limited = |memory_limit| SolverOptions {
        memory_limit,
        ..harmonics(1)
    };
    let refusal = respond(&model, &limited(1_999_999), &range(0.5, 0.5)).unwrap_err();
    assert_eq!(refusal.status, Status::OutOfMemory);
    for words in ["4000 contacts", "memory_limit = 1999999", "raise it to 2000000"] {
        assert!(refusal.to_string().contains(words), "{refusal}");
    }
    respond(&model, &limited(2_000_000), &range(0.5, 0.5)).unwrap();
}
