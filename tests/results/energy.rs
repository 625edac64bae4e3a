//! Energies and losses of a point: against closed forms and against the work of the forces.

use crate::common::energy::{close, energy, exactly, maximum, work};
use crate::common::models::oscillator;
use crate::common::{BASE, Blisk, all_harmonics, harmonics, slip, solve_at};
use hbvib::{Contact, Energy, MatrixKind, MatrixView, Model, Part, Status};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// A mass on a spring, M = 2 and K = 8.
fn mass_on_spring() -> Model {
    oscillator(2.0, 8.0).build()
}

#[test]
fn a_mass_on_a_spring_has_the_energies_of_the_textbook() {
    let mut model = mass_on_spring();
    model.add_force(0, 1, Complex64::new(0.3, -0.4)).unwrap();
    for omega in [0.7, 1.5, 3.1] {
        let x = 0.5 / (8.0 - 2.0 * omega * omega);
        let (kinetic, potential) = (omega * omega * x * x, 4.0 * x * x);
        let e = energy(&solve_at(&model, &harmonics(3), omega));
        close("T", e.twice_mean_kinetic, kinetic, 1e-13);
        close("kinetic, mean", e.kinetic_mean, 0.5 * kinetic, 1e-13);
        close("kinetic, peak", e.kinetic_peak, kinetic, 1e-13);
        close("potential, mean", e.potential_mean, 0.5 * potential, 1e-13);
        close("potential, peak", e.potential_peak, potential, 1e-13);
        assert!(e.structural_loss.abs() < 1e-15 * potential && e.friction_loss == 0.0);
        // The wheel of a plain structure is the structure.
        let whole = Energy {
            wheel_kinetic_mean: e.kinetic_mean,
            wheel_kinetic_peak: e.kinetic_peak,
            wheel_potential_mean: e.potential_mean,
            wheel_potential_peak: e.potential_peak,
            ..e
        };
        assert_eq!(e, whole);
    }
}

#[test]
fn static_and_several_harmonic_motions_add_up_in_the_peak() {
    // All harmonics are positive at t = 0, where the motion x₀ + x₁ + x₂ is largest.
    let mut model = mass_on_spring();
    let omega = 0.4;
    let forces = [0.5, 1.0, 0.2];
    for (h, f) in forces.into_iter().enumerate() {
        model.add_force(0, h, f.into()).unwrap();
    }
    let x = [0.0, 1.0, 2.0].map(|h: f64| forces[h as usize] / (8.0 - 2.0 * (h * omega).powi(2)));
    let e = energy(&solve_at(&model, &harmonics(2), omega));
    let squares = x[1] * x[1] + x[2] * x[2];
    close(
        "potential, mean",
        e.potential_mean,
        4.0 * x[0] * x[0] + 2.0 * squares,
        1e-13,
    );
    close(
        "potential, peak",
        e.potential_peak,
        4.0 * (x[0] + x[1] + x[2]).powi(2),
        1e-13,
    );
    let t = omega * omega * (x[1] * x[1] + 4.0 * x[2] * x[2]);
    close("T", e.twice_mean_kinetic, t, 1e-13);
    let velocity = |t: f64| omega * (x[1] * t.sin() + 2.0 * x[2] * (2.0 * t).sin());
    close("kinetic, peak", e.kinetic_peak, maximum(|t| velocity(t).powi(2)), 1e-13);
}

#[test]
fn a_static_motion_has_its_strain_energy_alone() {
    let mut model = mass_on_spring();
    model.add_force(0, 0, 4.0.into()).unwrap();
    let e = energy(&solve_at(&model, &harmonics(0), 1.0));
    let expected = Energy {
        potential_mean: 1.0,
        potential_peak: 1.0,
        wheel_potential_mean: 1.0,
        wheel_potential_peak: 1.0,
        ..Energy::default()
    };
    assert_eq!(e, expected);
}

#[test]
fn a_slipping_contact_takes_four_limits_times_the_slip() {
    // W = 4 fc (A − fc/k), A half the range of a relative motion that reverses twice.
    for highest in [1, 3, 9] {
        let mut model = mass_on_spring();
        let (stiffness, limit) = (5.0, 0.3 * 0.7);
        model
            .add_contact(&Contact::jenkins(0, None, stiffness, 0.3, 0.7))
            .unwrap();
        // A second contact on the same motion.
        model.add_contact(&Contact::jenkins(0, None, 1.0, 0.3, 0.1)).unwrap();
        model.add_force(0, 1, Complex64::new(0.3, 0.9)).unwrap();
        let branch = solve_at(&model, &harmonics(highest), 2.1);
        assert!(slip(&branch, 0) > 0.2 && slip(&branch, 0) < 1.0);
        let x = all_harmonics(&branch, 0);
        let motion = |t: f64| {
            (0..)
                .zip(&x)
                .map(|(h, x)| (x * Complex64::cis(f64::from(h) * t)).re)
                .sum()
        };
        let a = maximum(motion);
        let expected = 4.0 * limit * (a - limit / stiffness) + 4.0 * 0.03 * (a - 0.03);
        close(
            &format!("H = {highest}, loss"),
            energy(&branch).friction_loss,
            expected,
            1e-12,
        );
    }
}

#[test]
fn a_stuck_contact_and_a_structure_without_damping_take_nothing() {
    let mut model = BASE.sector();
    model.set_rayleigh(0.0, 0.0).unwrap();
    model.set_preload(0, 1e9).unwrap();
    let branch = solve_at(&model, &harmonics(3), TAU * 200.0);
    let e = energy(&branch);
    println!("{e:?}");
    assert!(slip(&branch, 0) == 0.0 && e.potential_mean > 0.0);
    // Rounding of the squares of the numbers, not of the numbers.
    assert!(e.structural_loss.abs() < 1e-25 * e.potential_mean);
    assert!(e.friction_loss.abs() < 1e-14 * e.potential_mean);
}

#[test]
fn the_work_of_the_forces_is_what_damping_and_friction_take() {
    let force: Complex64 = BASE.force.into();
    for highest in [1, 3, 9] {
        for hz in [208.0, 208.85, 210.0] {
            let branch = solve_at(&BASE.sector(), &exactly(highest), TAU * hz);
            assert!(slip(&branch, 0) > 0.0);
            let e = energy(&branch);
            let expected = work(&branch, &[(0, 1, force), (1, 1, force)]);
            close(
                &format!("H = {highest}, {hz} Hz"),
                e.structural_loss + e.friction_loss,
                expected,
                1e-9,
            );
            assert!(e.structural_loss > 0.0 && e.friction_loss > 0.0);
        }
    }
}

#[test]
fn stiffness_without_symmetry_works_on_the_structure() {
    // A follower force feeds the motion: the loss of the structure is negative.
    let mut model = Model::new(2).unwrap();
    let dense = |a| MatrixView::dense(2, a);
    model
        .set_matrix(MatrixKind::Mass, &dense(&[1.0, 0.0, 0.0, 1.0]))
        .unwrap();
    let follower = [4.0, 0.5, -0.5, 4.0];
    model
        .set_matrix(MatrixKind::Stiffness, &dense(&follower).part(Part::General))
        .unwrap();
    model.add_contact(&Contact::jenkins(0, None, 2.0, 0.5, 0.4)).unwrap();
    // The force turns with the motion that the follower force feeds, or against it.
    let mut signs = [0.0; 2];
    for (sign, quarter) in signs.iter_mut().zip([Complex64::I, -Complex64::I]) {
        let forces = [(0, 1, Complex64::ONE), (1, 1, quarter)];
        model.clear_forces();
        for (dof, h, value) in forces {
            model.add_force(dof, h, value).unwrap();
        }
        let branch = solve_at(&model, &exactly(5), 1.2);
        assert!(slip(&branch, 0) > 0.0);
        let e = energy(&branch);
        close(
            "work",
            e.structural_loss + e.friction_loss,
            work(&branch, &forces),
            1e-9,
        );
        *sign = e.structural_loss.signum();
    }
    assert!(signs[0] * signs[1] < 0.0);
}

#[test]
fn energies_come_in_the_units_of_the_caller() {
    // Tonnes, millimetres and newtons: energies in millijoules.
    let small = Blisk {
        units: (1e3, 1e-3, 1.0),
        ..BASE
    };
    let omega = TAU * 208.85;
    let a = energy(&solve_at(&BASE.sector(), &exactly(5), omega));
    let b = energy(&solve_at(&small.sector(), &exactly(5), omega));
    for (name, si, millijoules) in [
        ("T", a.twice_mean_kinetic, b.twice_mean_kinetic),
        ("kinetic", a.kinetic_peak, b.kinetic_peak),
        ("potential", a.wheel_potential_peak, b.wheel_potential_peak),
        ("structural loss", a.structural_loss, b.structural_loss),
        ("friction loss", a.friction_loss, b.friction_loss),
    ] {
        close(name, 1e-3 * millijoules, si, 1e-11);
    }
}

#[test]
fn a_point_that_is_not_stored_is_refused() {
    let branch = solve_at(&BASE.sector(), &harmonics(1), 1300.0);
    let error = branch.energy_at(branch.stored()).unwrap_err();
    assert_eq!(error.status, Status::Index);
}
