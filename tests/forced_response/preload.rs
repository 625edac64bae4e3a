//! Contacts pressed by static loads: the static solution first, then the vibration with the mean as an
//! unknown. Against closed forms of the linear structure that contacts make when they stick and press.

use crate::common::models::Structure;
use crate::common::{all_harmonics, harmonics, omega_range, solve_at};
use hbvib::{Contact, Hooks, Model, Status, forced_response};
use num_complex::Complex64;

const KT: f64 = 2.0;
const KN: f64 = 3.0;
const MU: f64 = 0.3;
const OMEGA: f64 = 1.3;
const DAMPING: f64 = 0.04;
const STIFFNESS: [f64; 3] = [1.0, 0.7, 0.4];

/// Masses moving along t1, t2 and n, the last without a spring where `free`.
fn masses(free: bool) -> Model {
    let mut stiffness = STIFFNESS;
    if free {
        stiffness[2] = 0.0;
    }
    Structure::plain(3)
        .diagonals([&[1.0; 3], &[DAMPING; 3], &stiffness])
        .build()
}

/// Friction on the ground in one direction and in a plane, of the given load at rest.
fn contacts(preload: f64) -> [(Contact, usize); 2] {
    let ground = [None; 3];
    [
        (
            Contact::friction_2d([Some(0), Some(2)], [None; 2], (KT, KN), MU, preload),
            1,
        ),
        (
            Contact::friction_3d([Some(0), Some(1), Some(2)], ground, (KT, KN), MU, preload),
            2,
        ),
    ]
}

fn close(what: &str, found: Complex64, expected: Complex64, tolerance: f64) {
    let gap = (found - expected).norm() / expected.norm();
    println!("{what}: {gap:.1e}");
    assert!(gap < tolerance, "{what}: {found} against {expected}");
}

#[test]
fn a_contact_pressed_hard_is_the_stuck_linear_system() {
    let force = [
        Complex64::new(0.1, 0.0),
        Complex64::new(0.0, 0.2),
        Complex64::new(-0.1, 0.1),
    ];
    for (contact, tangential) in contacts(1e4) {
        let mut model = masses(false);
        model.add_contact(&contact).unwrap();
        for (dof, f) in force.into_iter().enumerate() {
            model.add_force(dof, 1, f).unwrap();
        }
        // A static load beside the preload, along the normal and across.
        model.add_force(2, 0, 5.0.into()).unwrap();
        model.add_force(0, 0, 0.3.into()).unwrap();
        let branch = solve_at(&model, &harmonics(3), OMEGA);
        let x = all_harmonics(&branch, 0);
        for dof in 0..3 {
            let contact = match dof {
                2 => KN,
                dof if dof < tangential => KT,
                _ => 0.0,
            };
            let k = STIFFNESS[dof] + contact;
            let z = Complex64::new(k - OMEGA * OMEGA, DAMPING * OMEGA);
            close(&format!("dof {dof}"), x[3 + dof], force[dof] / z, 1e-10);
        }
        // The contact pushes with its load at rest where y = 0.
        close("mean along n", x[2], ((5.0 + 1e4) / (STIFFNESS[2] + KN)).into(), 1e-10);
        close("mean along t1", x[0], (0.3 / (STIFFNESS[0] + KT)).into(), 1e-10);
        assert_eq!(branch.reduction().held_by_contacts, 0);
        assert!(branch.slip_fraction_at(0).unwrap()[0] == 0.0);
    }
}

#[test]
fn a_body_that_contacts_alone_hold_rests_on_them_and_is_reported() {
    // Its weight presses the third mass, which no spring holds, on the ground at y = −weight/kn.
    let weight = 2.0;
    for kind in 0..3 {
        let mut model = masses(true);
        let contact = match kind {
            0 => Contact::unilateral(None, Some(2), KN, 0.0),
            kind => contacts(0.0)[kind - 1].0.clone(),
        };
        model.add_contact(&contact).unwrap();
        // A unilateral spring closes as side b rises over a, friction as a falls towards b.
        let down = if kind == 0 { 1.0 } else { -1.0 };
        model.add_force(2, 0, (down * weight).into()).unwrap();
        model.add_force(2, 1, 0.1.into()).unwrap();
        let branch = solve_at(&model, &harmonics(3), OMEGA);
        assert_eq!(branch.reduction().held_by_contacts, 1);
        let x = all_harmonics(&branch, 0);
        close("mean", x[2], (down * weight / KN).into(), 1e-10);
        let z = Complex64::new(KN - OMEGA * OMEGA, DAMPING * OMEGA);
        close("vibration", x[5], Complex64::from(0.1) / z, 1e-10);
    }
}

#[test]
fn a_body_pulled_off_its_contact_has_no_static_solution_and_an_error_says_so() {
    let mut model = masses(true);
    model.add_contact(&contacts(0.5)[0].0).unwrap();
    model.add_force(2, 0, 2.0.into()).unwrap();
    model.add_force(0, 1, 0.1.into()).unwrap();
    let range = omega_range(OMEGA, OMEGA);
    let error = forced_response(&model, &harmonics(3), &range, &mut Hooks::default()).unwrap_err();
    println!("{error}");
    assert_eq!(error.status, Status::NoConvergence);
    assert!(error.to_string().contains("static solution") && error.to_string().contains("1 rigid-body"));
}

#[test]
fn the_load_of_a_vibrating_contact_couples_mean_and_vibration() {
    // A stop under a load that lifts it in every period: the mean is not that of the static solution.
    let mut model = masses(false);
    model.add_contact(&contacts(0.2)[1].0).unwrap();
    for (dof, f) in [(0, 0.5), (1, 0.3), (2, 0.8)] {
        model.add_force(dof, 1, f.into()).unwrap();
    }
    let branch = solve_at(&model, &harmonics(15), OMEGA);
    let x = all_harmonics(&branch, 0);
    let rest = 0.2 / (STIFFNESS[2] + KN);
    let summary = branch.contact_summary(0, 0).unwrap();
    println!("mean {} at rest {rest}, open {}", x[2].re, summary.open_share);
    assert!(summary.open_share > 0.1 && x[2].re > 1.5 * rest);
}
