//! The error that a synthesised resonance tells, against the peak of a computed sweep, for pressed and unpressed
//! contacts: a resonance without a flag is right within 1 %.

use crate::common::mode_cases::follow;
use crate::common::{harmonics, sweep};
use hbvib::analysis::synthesise;
use hbvib::contact::Contact;
use hbvib::linalg::matrix_view::MatrixView;
use hbvib::model::Model;
use hbvib::model::structure::MatrixKind;
use hbvib::options::{ModeOptions, SolverOptions, SynthesisOptions};

/// Three masses in a chain under a force on one of them.
fn chain(beta: f64, contacts: &[Contact], constant: f64, (dof, force): (usize, f64)) -> Model {
    const STIFFNESS: [f64; 9] = [2.0, -0.7, 0.0, -0.7, 2.6, -0.5, 0.0, -0.5, 3.1];
    let mut model = Model::new(3).unwrap();
    let mass = [1.0, 0.0, 0.0, 0.0, 1.3, 0.0, 0.0, 0.0, 0.8];
    for (kind, values) in [(MatrixKind::Mass, mass), (MatrixKind::Stiffness, STIFFNESS)] {
        model.set_matrix(kind, &MatrixView::dense(3, &values)).unwrap();
    }
    model.set_rayleigh(0.0, beta).unwrap();
    for contact in contacts {
        model.add_contact(contact).unwrap();
    }
    model.add_force(1, 0, constant.into()).unwrap();
    model.add_force(dof, 1, force.into()).unwrap();
    model
}

fn cases() -> Vec<(&'static str, Vec<Contact>, f64)> {
    let stop = |preload, gap| Contact {
        preload,
        ..Contact::unilateral(Some(1), None, 1.5, gap)
    };
    let rubbing = Contact::friction_2d([Some(0), Some(1)], [None; 2], (0.8, 0.9), 0.4, 0.6);
    vec![
        ("stop with a gap", vec![stop(0.0, 0.3)], 0.0),
        ("pressed stop", vec![stop(0.3, 0.0)], 0.0),
        ("pressed by a force", vec![stop(0.0, 0.1)], -0.6),
        ("Jenkins", vec![Contact::jenkins(0, None, 0.8, 0.4, 0.6)], 0.0),
        (
            "Jenkins under a force",
            vec![Contact::jenkins(1, None, 0.8, 0.4, 0.6)],
            0.1,
        ),
        ("pressed friction", vec![rubbing.clone()], 0.0),
        ("pressed friction and a stop", vec![rubbing, stop(0.0, 0.4)], -0.1),
        (
            "cubic spring under a force",
            vec![Contact::cubic(1, None, 0.0, 0.2)],
            0.5,
        ),
    ]
}

#[test]
fn the_error_of_a_synthesised_resonance_is_that_against_the_computed_peak() {
    let (mut valid, mut flagged, mut worst) = (0, 0, (0.0_f64, 0.0_f64));
    for (name, contacts, constant) in cases() {
        for (beta, force) in [(0.003, 0.02), (0.01, 0.1), (0.05, 0.5)] {
            let model = chain(beta, &contacts, constant, (0, force));
            let range = ModeOptions {
                log10_start: -3.0,
                log10_stop: 1.5,
                ..ModeOptions::default()
            };
            let mut errors = Vec::new();
            // The default response degree of freedom is the one that moves most; the forced one is another.
            for response_dof in [None, Some(0), Some(2)] {
                let solver = SolverOptions {
                    response_dof,
                    ..harmonics(5)
                };
                let branch = follow(&model, &solver, &range);
                let found = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
                for peak in &found.peaks {
                    let validity = peak.validity;
                    if validity.inaccurate() || validity.another_mode() || validity.internal_resonance() || !peak.rising
                    {
                        flagged += 1;
                        continue;
                    }
                    valid += 1;
                    let width = 3.0 * peak.at.damping_ratio * peak.at.omega;
                    let sought = SolverOptions {
                        response_dof: Some(branch.response_dof()),
                        ..solver
                    };
                    let swept = sweep(&model, &sought, peak.at.omega - width, peak.at.omega + width, &[]);
                    let nearest = swept.peaks().iter().min_by(|a, b| {
                        let distance = |p: f64| (p - peak.at.omega).abs();
                        distance(a.omega).total_cmp(&distance(b.omega))
                    });
                    let Some(nearest) = nearest else { continue };
                    let error = peak.at.response.norm() / nearest.amplitude - 1.0;
                    worst.0 = worst.0.max(error.abs());
                    worst.1 = worst.1.max((error - validity.error).abs());
                    errors.push(error.abs());
                }
            }
            println!("{name}, β = {beta}, {force}: {errors:?}");
            if let [default, others @ ..] = &errors[..]
                && others.len() == 2
            {
                let most = others.iter().fold(0.0_f64, |m, e| m.max(*e));
                assert!(
                    *default < 2.0 * most + 1e-4,
                    "{name}: the default degree of freedom has {default:e}"
                );
            }
        }
    }
    println!(
        "{valid} valid, {flagged} flagged: error {:.1e}, told to {:.1e}",
        worst.0, worst.1
    );
    assert!(valid >= 30 && worst.0 < 0.01 && worst.1 < 1e-5);
}

#[test]
fn the_phase_reference_does_not_change_a_resonance() {
    let (_, contacts, constant) = cases().remove(5);
    let model = chain(0.01, &contacts, constant, (0, 0.1));
    let mut found = Vec::new();
    for reference_dof in [None, Some(0), Some(1), Some(2)] {
        let range = ModeOptions {
            log10_start: -3.0,
            log10_stop: 1.5,
            reference_dof,
            ..ModeOptions::default()
        };
        let solver = SolverOptions {
            response_dof: Some(0),
            ..harmonics(5)
        };
        let branch = follow(&model, &solver, &range);
        let peak = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap().peaks[0];
        found.push((peak.at.response.norm(), peak.at.omega, peak.validity.error));
    }
    for peak in &found {
        assert!((peak.0 / found[0].0 - 1.0).abs() < 1e-8 && (peak.1 / found[0].1 - 1.0).abs() < 1e-9);
        assert!((peak.2 - found[0].2).abs() < 1e-8);
    }
}
