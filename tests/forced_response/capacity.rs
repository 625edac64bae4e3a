//! Undamped resonances forced beyond what the contacts can take: which are told, and which are not.

use crate::common::models::{self, Structure, dense, diagonal};
use crate::common::{self, D, R, harmonics, omega_range};
use hbvib::{Branch, Contact, ContactState, Hooks, Interrupt, Model, Result, Status, forced_response};
use num_complex::Complex64;
use std::f64::consts::PI;

const N: usize = 6;

/// A chain of unequal masses on springs, both ends held.
fn chain(damping: f64) -> Model {
    let mass: Vec<f64> = (0..N).map(|i| 1.0 + 0.3 * i as f64).collect();
    models::chain(&mass, &[1.0; N + 1]).rayleigh(0.0, damping).build()
}

fn solve(model: &Model, omega: f64, h: usize) -> Result<Branch> {
    let range = omega_range(omega, omega);
    forced_response(model, &harmonics(h), &range, &mut Hooks::default())
}

/// Whether the model has no bounded solution by the library; an error of another kind is no answer.
fn refused(model: &Model, omega: f64, h: usize) -> bool {
    match solve(model, omega, h) {
        Ok(branch) => {
            assert_eq!(branch.status(), Status::Ok);
            false
        }
        Err(e) => {
            assert_eq!(e.status, Status::NoBoundedSolution, "{e}");
            true
        }
    }
}

/// Force and capacity are those of the mode itself, whichever it is, and the answer changes at their crossing.
#[test]
fn a_chain_is_refused_above_the_capacity_of_its_mode_and_answered_below() {
    let limits = [(1, None, 0.2), (4, Some(2), 0.1)];
    let modes = chain(0.0).linear_modes(0, ContactState::Free).unwrap();
    for (k, &omega) in modes.omega.iter().enumerate() {
        let shape = &modes.shapes[k * N..(k + 1) * N];
        let largest = shape.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        let phi: Vec<Complex64> = shape.iter().map(|z| z / largest).collect();
        let slip_capacity: f64 = limits
            .iter()
            .map(|&(a, b, limit)| 4.0 / PI * limit * (phi[a] - b.map_or(Complex64::ZERO, |b: usize| phi[b])).norm())
            .sum();
        for (harmonic, share) in [(1, 0.7), (1, 1.001), (1, 3.0), (3, 0.7), (3, 1.001)] {
            let mut model = chain(0.0);
            for (a, b, limit) in limits {
                model.add_contact(&Contact::jenkins(a, b, 0.5, 1.0, limit)).unwrap();
            }
            let force = share * slip_capacity / phi[0].norm();
            model.add_force(0, harmonic, Complex64::from_polar(force, 0.4)).unwrap();
            let frequency = omega / harmonic as f64;
            let resonance = model
                .resonance(frequency, harmonic, &Interrupt::none())
                .unwrap()
                .unwrap();
            assert!((resonance.slip_capacity / slip_capacity - 1.0).abs() < 1e-9, "mode {k}");
            assert!(
                (resonance.force / (share * slip_capacity) - 1.0).abs() < 1e-9,
                "mode {k}"
            );
            assert_eq!(
                resonance.is_overloaded(),
                share > 1.0,
                "mode {k}, growth {:e}",
                resonance.growth
            );
            assert_eq!(
                refused(&model, frequency, 9),
                share > 1.0,
                "mode {k}, harmonic {harmonic}, share {share}"
            );
        }
    }
}

/// Damping, another frequency, a contact without bound: each of them gives a bounded solution.
#[test]
fn what_has_a_solution_is_never_refused() {
    let omega = chain(0.0).linear_modes(0, ContactState::Free).unwrap().omega[1];
    let with = |damping: f64, contact: &Contact| {
        let mut model = chain(damping);
        model.add_contact(contact).unwrap();
        model.add_force(0, 1, 50.0.into()).unwrap();
        model
    };
    let slider = Contact::jenkins(1, None, 0.5, 1.0, 0.2);
    assert!(refused(&with(0.0, &slider), omega, 5));
    assert!(!refused(&with(1e-6, &slider), omega, 5));
    assert!(!refused(&with(0.0, &slider), omega * (1.0 + 1e-7), 5));
    assert!(!refused(&with(0.0, &Contact::cubic(1, None, 0.0, 1.0)), omega, 5));
    assert!(!refused(
        &with(0.0, &Contact::unilateral(None, Some(1), 1.0, 0.0)),
        omega,
        5
    ));
    let endless = Contact::jenkins(1, None, 0.5, 1.0, f64::INFINITY);
    assert!(!refused(&with(0.0, &endless), omega, 5));
}

/// Masses alike have one frequency and many modes; the force picks the one that it drives.
#[test]
fn of_repeated_resonances_the_force_picks_the_one_it_drives() {
    let one = diagonal(&[1.0; 3]);
    // All of them can bear 0.9 × 4/π, but not the first alone.
    let model = dense(&one, &one)
        .contacts((0..3).map(|dof| Contact::jenkins(dof, None, 1.0, 1.0, 0.3)))
        .force(0, 1, 0.5)
        .build();
    let resonance = model.resonance(1.0, 1, &Interrupt::none()).unwrap().unwrap();
    assert!((resonance.force - 0.5).abs() < 1e-12 && (resonance.slip_capacity - 1.2 / PI).abs() < 1e-12);
    assert!(refused(&model, 1.0, 3));
}

/// The blisk at a free resonance of its wave: the mode of the sector, with the contact to the ring.
#[test]
fn a_travelling_wave_is_refused_by_the_mode_of_its_diameter() {
    let mut model = common::BASE.sector();
    model.set_rayleigh(0.0, 0.0).unwrap();
    let modes = model.linear_modes(2, ContactState::Free).unwrap();
    for k in 0..4 {
        let omega = modes.omega[k];
        let shape = &modes.shapes[k * 4..(k + 1) * 4];
        let relative = (shape[D] - shape[R]).norm();
        let limit = common::Blisk::mu() * common::BASE.preload();
        let drive: f64 = (shape[0] + shape[1]).norm();
        if drive < 1e-9 * relative {
            // The ring's own mode is driven through the contact alone.
            continue;
        }
        let critical = 4.0 / PI * limit * relative / drive;
        for (share, beyond) in [(0.5, false), (1.01, true), (20.0, true)] {
            model.clear_forces();
            for dof in [common::B1, common::B2] {
                model.add_force(dof, 1, (share * critical).into()).unwrap();
            }
            assert_eq!(refused(&model, omega, 3), beyond, "mode {k}, share {share}");
        }
    }
}

/// A body that nothing holds but friction, under a constant load: the mean carries fc, not 4 fc/π.
#[test]
fn a_free_body_is_dragged_by_a_constant_load_above_the_slip_limit() {
    let of = |load: f64| {
        Structure::plain(1)
            .mass(&[1.0])
            .slider(0, 1.0, 1.0, 0.3)
            .force(0, 0, load)
            .force(0, 1, 0.1)
            .build()
    };
    let resonance = of(0.31).resonance(0.7, 0, &Interrupt::none()).unwrap().unwrap();
    assert!((resonance.force - 0.31).abs() < 1e-15 && (resonance.slip_capacity - 0.3).abs() < 1e-15);
    assert!(
        of(0.31).overload(0.7, &Interrupt::none()).unwrap().is_some()
            && of(0.29).overload(0.7, &Interrupt::none()).unwrap().is_none()
    );
    assert!(refused(&of(0.31), 0.7, 3));
    assert!(!refused(&of(0.1), 0.7, 3));
}

/// Towards the resonance a bounded solution goes to infinity: the branch ends there and says why.
#[test]
fn a_sweep_into_such_a_resonance_keeps_its_points_and_says_why_it_ends() {
    let modes = chain(0.0).linear_modes(0, ContactState::Free).unwrap();
    let omega = modes.omega[0];
    let of = |damping: f64| {
        let mut model = chain(damping);
        model.add_contact(&Contact::jenkins(1, None, 0.5, 1.0, 0.2)).unwrap();
        model.add_force(0, 1, 2.0.into()).unwrap();
        model
    };
    for (from, to) in [(0.7, 1.3), (1.3, 0.7)] {
        let (from, to) = (from * omega, to * omega);
        let range = omega_range(from, to);
        let sweep = |model: &Model| forced_response(model, &harmonics(5), &range, &mut Hooks::default()).unwrap();
        let branch = sweep(&of(0.0));
        assert_eq!(branch.status(), Status::StoppedStepTooSmall);
        assert!(
            branch.points() > 10 && branch.points() < 1000,
            "{} points",
            branch.points()
        );
        assert!((branch.omega().last().unwrap() / omega - 1.0).abs() < 1e-12);
        let reason = branch.reason().unwrap();
        assert_eq!(reason.status, Status::NoBoundedSolution);
        // Damped, the same sweep passes.
        let branch = sweep(&of(1e-3));
        assert!(branch.status() == Status::Ok && branch.reason().is_none());
    }
}
