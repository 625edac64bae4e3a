//! Families 2 and 3 near the veering about nodal diameter 3: a nonlinear mode is followed by
//! continuity, not by the order of frequencies. Same-H solutions.

use crate::common::mode_cases::{damping, delta, follow, only};
use crate::common::{BASE, Blisk, D, R, amplitude_range, data, harmonics, number};
use hbvib::{Branch, Constant, ModeChoice, ModeField, ModeOptions, Model, SolverOptions, Spring};

/// The sector of a nodal diameter without structural damping, its contact's stiffness scaled, and
/// the ring's too.
fn model(case: &Blisk, stiffness: f64, ring: f64) -> Model {
    let mut model = case.sector_without_contact();
    model.set_rayleigh(0.0, 0.0).unwrap();
    let ring_stiffness = number(&data("model.json")["stiffness_N_per_m"]["Kr"]);
    model
        .add_spring(&Spring {
            dof_a: Some(R),
            dof_b: Some(R),
            sector_offset: 1,
            stiffness: (ring - 1.0) * ring_stiffness,
        })
        .unwrap();
    let contact = case.contact();
    let kt = stiffness * contact.constant(Constant::Kt);
    model.add_contact(&contact.with(Constant::Kt, kt).unwrap()).unwrap();
    model
}

/// Amplitudes asked for, over that of the onset.
const TIMES: [f64; 12] = [1.01, 1.1, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1e3, 1e4];

fn run(model: &Model, onset: f64, family: usize, solver: &SolverOptions) -> Branch {
    let at = TIMES.map(|t| onset + t.log10());
    let range = ModeOptions {
        choice: ModeChoice::Index(family),
        at: &at,
        ..amplitude_range(onset - 0.5, onset + 5.0)
    };
    follow(model, solver, &range)
}

/// Least assurance between neighbours.
fn assurance(branch: &Branch) -> f64 {
    let all = branch.mode_field(ModeField::Assurance).unwrap();
    all.iter().fold(1.0, |m, &a| m.min(a))
}

/// Follows with coarse and with fine steps and checks that both are the same branch, with at least
/// this assurance between neighbours of the coarse ones.
fn check(case: &Blisk, (stiffness, ring): (f64, f64), family: usize, highest: usize, least: f64) {
    let model = model(case, stiffness, ring);
    let start = model.select_mode(ModeChoice::Index(family)).unwrap();
    let play = delta(case) / stiffness;
    let onset = (play / (start.shape[D] - start.shape[R]).norm()).log10();
    let with = |step_max: f64| SolverOptions {
        step_max,
        ..harmonics(highest)
    };
    let free = run(&model, onset, family, &harmonics(highest));
    let coarse = run(&model, onset, family, &with(0.04));
    let fine = run(&model, onset, family, &with(0.005));
    let gap = start.stuck[2] / start.stuck[1] - 1.0;
    println!(
        "EO {}, ring {:?} kg, kt × {stiffness}, Kr × {ring}, H = {highest}, family {}: stuck frequencies {gap:.1e} apart; points {}, {}, {}; assurance {:.5}, {:.5}, {:.6}; largest D {:.4}",
        case.engine_order,
        case.ring_mass.unwrap(),
        family + 1,
        free.points(),
        coarse.points(),
        fine.points(),
        assurance(&free),
        assurance(&coarse),
        assurance(&fine),
        damping(&fine).iter().fold(0.0_f64, |m, &d| m.max(d)),
    );
    assert!(assurance(&free) > least && assurance(&coarse) > least && assurance(&fine) > 0.99);
    let most = damping(&fine).iter().fold(0.0_f64, |m, &d| m.max(d));
    let mut compared = 0;
    for i in 0..TIMES.len() {
        for other in [&free, &coarse] {
            assert_eq!(other.at(i).len(), fine.at(i).len());
            for (a, b) in other.at(i).iter().zip(fine.at(i)) {
                let d = |branch: &Branch, point| branch.mode_at(point).unwrap().damping_ratio;
                assert!((a.omega / b.omega - 1.0).abs() < 1e-9);
                assert!((d(other, a.point) - d(&fine, b.point)).abs() < 1e-9 * most);
                compared += 1;
            }
        }
    }
    assert!(compared >= 2 * TIMES.len(), "{compared} solutions");
}

#[test]
fn both_families_pass_the_veering_without_a_jump_for_any_step() {
    for engine_order in [2, 3, 4] {
        for family in [1, 2] {
            for highest in [1, 5] {
                check(&Blisk { engine_order, ..BASE }, (1.0, 1.0), family, highest, 0.99);
            }
        }
    }
}

#[test]
fn both_families_pass_sharper_veerings_of_other_rings_and_contacts() {
    for (engine_order, ring_mass, stiffness) in [
        (3, 0.06, 1.0),
        (3, 0.01, 1.0),
        (3, 0.03, 0.1),
        (2, 0.06, 0.3),
        (2, 0.06, 10.0),
    ] {
        let case = Blisk {
            engine_order,
            ring_mass: Some(ring_mass),
            ..BASE
        };
        for family in [1, 2] {
            check(&case, (stiffness, 1.0), family, 3, 0.99);
        }
    }
}

/// With a stiffer ring the disk's frequency, stuck, lies above that of the blades and falls through it
/// as the contact slides: the veering is met on the way, and the shape turns from one to the other
/// within few steps.
#[test]
fn a_mode_that_slides_through_the_veering_is_followed_without_a_jump() {
    for ring in [1.5, 1.9, 2.0, 2.1, 2.5, 4.0] {
        for family in [1, 2] {
            check(&BASE, (1.0, ring), family, 3, 0.8);
        }
    }
}

#[test]
fn the_two_families_end_on_different_sliding_modes() {
    // In the limit of large amplitude the ring no longer acts on the disk.
    let case = Blisk {
        engine_order: 3,
        ..BASE
    };
    let model = model(&case, 1.0, 1.0);
    let ends: Vec<f64> = [1, 2]
        .into_iter()
        .map(|family| {
            let start = model.select_mode(ModeChoice::Index(family)).unwrap();
            let onset = (delta(&case) / (start.shape[D] - start.shape[R]).norm()).log10();
            let branch = run(&model, onset, family, &harmonics(3));
            let (omega, _, _) = only(&branch, TIMES.len() - 1);
            let nearest = branch.mode().unwrap().free.iter().fold(0.0_f64, |best, &w| {
                if (w - omega).abs() < (best - omega).abs() {
                    w
                } else {
                    best
                }
            });
            println!("family {}: ends at {omega}, free frequency {nearest}", family + 1);
            assert!((omega / nearest - 1.0).abs() < 1e-3);
            nearest
        })
        .collect();
    assert!((ends[0] / ends[1] - 1.0).abs() > 1e-2);
}
