//! Six decades of amplitude in one run, for plain structures and for several contacts that begin to
//! slip one after the other.

use crate::common::mode_cases::{damped, damping, delta, follow, only};
use crate::common::models::dense;
use crate::common::{self, BASE, Blisk, amplitude_range, harmonics};
use hbvib::{Branch, Constant, Contact, ContactState, ModeChoice, ModeField, ModeOptions, Model};

fn log10(branch: &Branch) -> &[f64] {
    branch.mode_field(ModeField::Log10Amplitude).unwrap()
}

/// Checks of every run over the whole range.
fn check(branch: &Branch, from: f64, to: f64) {
    let p = log10(branch);
    assert!((p[0] - from).abs() < 1e-13 && (p[p.len() - 1] - to).abs() < 1e-13);
    let info = branch.mode().unwrap();
    // It ends on a mode with the contacts removed.
    let end = branch.omega()[branch.points() - 1];
    let nearest = info
        .free
        .iter()
        .fold(f64::INFINITY, |m, w| m.min((w / end - 1.0).abs()));
    assert!(nearest < 1e-3, "ends {nearest:.1e} off a sliding mode");
    assert!((branch.omega()[0] / info.omega - 1.0).abs() < 1e-12);
    let iterations: f64 = branch.newton_iterations().iter().sum();
    println!(
        "  {} points, {iterations} iterations, {} folds, largest D {:.2e}, steps of log₁₀a {:.4} .. {:.3}",
        branch.points(),
        branch.folds().len(),
        damping(branch).iter().fold(0.0_f64, |m, &d| m.max(d)),
        p.windows(2).map(|w| (w[1] - w[0]).abs()).fold(f64::INFINITY, f64::min),
        p.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max),
    );
    assert!(branch.points() < 400);
}

#[test]
fn six_decades_are_followed_in_one_run_for_any_number_of_harmonics() {
    for h in [1, 3, 9, 31] {
        let from = delta(&BASE).log10() + 1.0;
        let range = amplitude_range(from, from + 6.0);
        println!("H = {h}");
        check(&follow(&damped(&BASE, 0.0), &harmonics(h), &range), from, from + 6.0);
    }
}

#[test]
fn six_decades_are_followed_for_nodal_diameters_0_to_12() {
    for engine_order in [0, 1, 3, 6, 12] {
        let case = Blisk { engine_order, ..BASE };
        let start = case.sector().select_mode(ModeChoice::Index(0)).unwrap();
        let onset = (delta(&case) / (start.shape[common::D] - start.shape[common::R]).norm()).log10();
        let range = amplitude_range(onset - 1.0, onset + 5.0);
        println!("EO {engine_order}");
        check(
            &follow(&damped(&case, 0.0), &harmonics(9), &range),
            onset - 1.0,
            onset + 5.0,
        );
    }
}

/// Two masses in a row, each sprung to the next and to the ground, with contacts to the ground.
fn two_masses(contacts: &[Contact]) -> Model {
    dense(&[1.0, 0.0, 0.0, 1.3], &[2.0, -1.0, -1.0, 2.5])
        .contacts(contacts)
        .build()
}

#[test]
fn a_plain_structure_with_a_contact_to_the_ground_is_followed_from_stuck_to_sliding() {
    for (kt, limit) in [(0.5, 0.2), (0.5, 1e9), (20.0, 1e-9), (1e-3, 1.0)] {
        for family in [0, 1] {
            let model = two_masses(&[Contact::jenkins(0, None, kt, 1.0, limit)]);
            let start = model.select_mode(ModeChoice::Index(family)).unwrap();
            let onset = (limit / kt / start.shape[0].norm()).log10();
            let range = ModeOptions {
                choice: ModeChoice::Index(family),
                ..amplitude_range(onset - 1.0, onset + 5.0)
            };
            println!("kt = {kt}, limit {limit:e}, family {family}");
            let branch = follow(&model, &harmonics(9), &range);
            check(&branch, onset - 1.0, onset + 5.0);
            assert!((branch.mode().unwrap().linear_up_to - onset).abs() < 1e-12);
            assert_eq!(branch.mode().unwrap().stuck.len(), 2);
        }
    }
}

/// Amplitude at which a contact first slips, between the neighbours of the curve that tell.
fn first_slip(branch: &Branch, contact: usize) -> (f64, f64) {
    let contacts = branch.contacts();
    let first = branch
        .slip_fraction()
        .chunks_exact(contacts)
        .position(|shares| shares[contact] > 1e-6)
        .unwrap();
    (log10(branch)[first - 1], log10(branch)[first])
}

#[test]
fn contacts_of_different_slip_limits_begin_to_slip_one_after_the_other() {
    let limits = [0.01, 1.0, 100.0];
    let contacts = [
        Contact::jenkins(0, None, 0.5, 1.0, limits[0]),
        Contact::jenkins(1, None, 0.7, 1.0, limits[1]),
        Contact::jenkins(0, Some(1), 0.4, 1.0, limits[2]),
    ];
    let model = two_masses(&contacts);
    for family in [0, 1] {
        let range = ModeOptions {
            choice: ModeChoice::Index(family),
            ..amplitude_range(-3.0, 5.0)
        };
        let branch = follow(&model, &harmonics(9), &range);
        println!("family {family}");
        check(&branch, -3.0, 5.0);
        // The order is that of slip limit over stiffness and motion. While one contact slides the
        // others see it as if it were not there: the onset of the next is that of the structure
        // without those that slide, but for the little that they still hold.
        let mut left = Vec::from(contacts.clone());
        for (i, contact) in contacts.iter().enumerate() {
            let without = two_masses(&left);
            let modes = without.linear_modes(0, ContactState::Stuck).unwrap();
            let shape = &modes.shapes[2 * family..2 * family + 2];
            let motion = match contact.dof_b[0] {
                Some(b) => (shape[0] - shape[b]).norm(),
                None => shape[contact.dof_a[0].unwrap()].norm(),
            };
            let expected = (limits[i] / contact.constant(Constant::Kt) / motion).log10();
            let (below, above) = first_slip(&branch, i);
            println!("  contact {i}: slips from 10^{below:.4} .. 10^{above:.4}, estimate 10^{expected:.4}");
            let slack = if i == 0 { 1e-9 } else { 0.02 };
            assert!(below <= expected + slack && expected - slack <= above);
            left.remove(0);
        }
    }
}

#[test]
fn a_range_may_begin_anywhere_and_ends_on_the_same_branch() {
    let from = delta(&BASE).log10();
    let at = [from + 4.9];
    let run = |start: f64| {
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(from + start, from + 5.0)
        };
        only(&follow(&damped(&BASE, 0.0), &harmonics(7), &range), 0)
    };
    let reference = run(1.0);
    for start in [2.1541, 2.16, 2.3, 2.5, 3.0, 3.5, 4.0, 4.5, 4.89] {
        let found = run(start);
        let (by_omega, by_damping) = ((found.0 / reference.0 - 1.0).abs(), (found.1 / reference.1 - 1.0).abs());
        println!("from 10^{start} δ: ω {by_omega:.1e}, D {by_damping:.1e}");
        assert!(by_omega < 1e-11 && by_damping < 1e-9);
    }
}
