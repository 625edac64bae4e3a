//! One mass on a spring that rubs on the ground, and the blisk, where solvers go wrong: no damping at a
//! resonance, nearly rigid contact, units far from one, static loads, forces in a higher harmonic,
//! massless and floating parts. Each test says whether it checks a closed form, the same-H solution
//! (stored, from an independent harmonic balance) or a limit.

use crate::common;
use crate::common::models::oscillator;
use crate::common::omega_range;
use hbvib::{Contact, Hooks, Model, Result, SolverOptions, Status, forced_response};
use num_complex::Complex64;

/// m = k = 1 with viscous damping c and a Jenkins contact to the ground.
#[derive(Clone, Copy)]
struct Oscillator {
    c: f64,
    kt: f64,
    limit: f64,
}

const BASE: Oscillator = Oscillator {
    c: 0.02,
    kt: 1.0,
    limit: 0.3,
};

/// Harmonics 0 ..= H of a model of one degree of freedom at one frequency.
fn solve(model: &Model, omega: f64, harmonics: usize, keep_even_harmonics: bool) -> Result<Vec<Complex64>> {
    let options = SolverOptions {
        keep_even_harmonics,
        ..crate::common::harmonics(harmonics)
    };
    let range = omega_range(omega, omega);
    let branch = forced_response(model, &options, &range, &mut Hooks::default())?;
    assert_eq!(branch.status(), Status::Ok);
    let mut x = vec![Complex64::ZERO; (harmonics + 1) * model.ndof()];
    branch.harmonics_at(0, &mut x)?;
    Ok(x)
}

impl Oscillator {
    fn model(self, forces: &[(usize, f64)]) -> Model {
        oscillator(1.0, 1.0)
            .damping(&[self.c])
            .contacts((self.kt > 0.0).then(|| Contact::jenkins(0, None, self.kt, 1.0, self.limit)))
            .forces(forces.iter().map(|&(harmonic, force)| (0, harmonic, force)))
            .build()
    }

    fn answer(self, forces: &[(usize, f64)], omega: f64, harmonics: usize) -> Vec<Complex64> {
        solve(&self.model(forces), omega, harmonics, false).unwrap()
    }
}

fn close(found: f64, wanted: f64, tolerance: f64) {
    assert!(
        (found / wanted - 1.0).abs() <= tolerance,
        "{found:e} against {wanted:e}"
    );
}

/// Same H.
#[test]
fn without_damping_friction_bounds_the_free_resonance() {
    let x = Oscillator { c: 0.0, ..BASE }.answer(&[(1, 0.35)], 1.0, 31);
    close(x[1].norm(), 0.490_802_366_597_389_6, 1e-9);
}

/// Closed form: a square wave of height fc carries at most 4 fc/π in its fundamental.
#[test]
fn beyond_the_capacity_of_friction_no_solution_is_made_up() {
    let slip_capacity = 4.0 * 0.3 / std::f64::consts::PI;
    let model = Oscillator { c: 0.0, ..BASE }.model(&[(1, 1.05 * slip_capacity)]);
    let found = solve(&model, 1.0, 9, false);
    assert!(found.is_err_and(|e| e.status == Status::NoBoundedSolution));
}

/// Same H. A rigid contact is near: kt is 1e3 and 1e6 times the spring.
#[test]
fn nearly_rigid_contact_converges_from_a_cold_start() {
    for (kt, harmonics, wanted, tolerance) in [
        (1e3, 15, 2.157_102_954_910_939_3, 1e-10),
        (1e3, 63, 2.161_209_735_473_136, 1e-10),
        (1e6, 31, 2.175_573_821_371_159, 1e-8),
        (1e6, 63, 2.176_995_518_866_986_5, 1e-8),
    ] {
        let limit = 0.2;
        let x = Oscillator { kt, limit, ..BASE }.answer(&[(1, 0.5)], 0.9, harmonics);
        close(x[1].norm(), wanted, tolerance);
    }
}

/// Same H; the response is proportional to force and slip limit together.
#[test]
fn units_of_1e_160_and_1e160_change_nothing() {
    for s in [1e-160, 1e-12, 1.0, 1e6, 1e160] {
        let limit = 0.3 * s;
        let x = Oscillator { limit, ..BASE }.answer(&[(1, 0.2 * s)], 1.25, 7);
        close(x[1].norm() / s, 0.579_897_803_910_427_1, 1e-12);
    }
}

/// Closed form: (F − fc)/k where a virgin slider is dragged, F/(k + kt) where it sticks.
#[test]
fn a_static_load_alone_is_solved_in_the_mean() {
    close(BASE.answer(&[(0, 0.5)], 1.25, 0)[0].re, 0.25, 1e-14);
    close(BASE.answer(&[(0, 1.0)], 1.25, 0)[0].re, 0.7, 1e-14);
}

/// Closed form of the mean, same H of the fundamental.
#[test]
fn a_static_load_beside_a_vibration_is_carried_by_the_spring_once_the_contact_slips() {
    let x = BASE.answer(&[(0, 0.1), (1, 0.2)], 1.25, 31);
    close(x[0].re, 0.1, 1e-12);
    close(x[1].norm(), 0.579_898_538_987_928_6, 1e-9);
    let stuck = BASE.answer(&[(0, 0.1), (1, 0.05)], 0.9, 31);
    close(stuck[0].re, 0.05, 1e-14);
}

/// The same problem in faster time.
#[test]
fn a_force_in_the_third_harmonic_alone_is_the_first_of_three_times_the_frequency() {
    let omega = 1.25;
    let third = BASE.answer(&[(3, 0.2)], omega / 3.0, 9);
    let first = BASE.answer(&[(1, 0.2)], omega, 3);
    assert!((third[3] - first[1]).norm() < 1e-13 && (third[9] - first[3]).norm() < 1e-13);
    let others = [0, 1, 2, 4, 5, 6, 7, 8];
    assert!(others.iter().all(|&h| third[h] == Complex64::ZERO));
}

/// Same H; the quasi-static limit.
#[test]
fn a_frequency_of_1e_8_is_quasi_static() {
    let x = BASE.answer(&[(1, 0.8)], 1e-8, 31);
    close(x[1].norm(), 0.487_578_391_509_699_1, 1e-9);
}

/// Same H. With the mean kept the ring is free to turn, so that its mean is indeterminate.
#[test]
fn the_blisk_with_even_harmonics_kept_answers_with_the_odd_ones() {
    let model = common::BASE.sector();
    let omega = std::f64::consts::TAU * 208.85;
    let (odd, all) = (
        solve(&model, omega, 7, false).unwrap(),
        solve(&model, omega, 7, true).unwrap(),
    );
    let largest = odd.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    for (a, b) in odd.iter().zip(&all) {
        assert!((a - b).norm() < 1e-9 * largest);
    }
}

/// The limit of a vanishing ring mass.
#[test]
fn a_massless_ring_is_the_limit_of_a_light_one() {
    let at = |mass: f64| {
        let blisk = common::Blisk {
            ring_mass: Some(mass),
            ..common::BASE
        };
        let mut model = blisk.sector();
        // The normal load must not vanish with the mass.
        model.set_preload(0, 400.0).unwrap();
        solve(&model, std::f64::consts::TAU * 208.85, 9, false).unwrap()
    };
    let (light, none) = (at(1e-9), at(0.0));
    let largest = none.iter().fold(0.0_f64, |m, z| m.max(z.norm()));
    assert!(largest > 1e-4);
    for (a, b) in light.iter().zip(&none) {
        assert!((a - b).norm() < 1e-6 * largest);
    }
}

/// The same-H solution, from an independent harmonic balance; and the motion in time to 1e-7.
#[test]
fn the_mean_of_a_slipping_contact_is_unique_and_that_of_a_stuck_one_the_virgin_sliders() {
    let slipping = solve(&BASE.model(&[(0, 0.1), (1, 0.2)]), 1.25, 31, false).unwrap();
    close(slipping[0].re, 0.1, 1e-9);
    close(slipping[1].norm(), 0.579_898_538_987_928_6, 1e-9);
    close(slipping[1].norm(), 0.579_898_529_742_581_4, 1e-7);
    let stuck = solve(&BASE.model(&[(0, 0.1), (1, 0.05)]), 0.9, 31, false).unwrap();
    close(stuck[0].re, 0.1 / (1.0 + BASE.kt), 1e-12);
}

/// The same-H solution: many contacts that switch at once are one contact.
#[test]
fn a_hundred_equal_contacts_are_one() {
    let mut one = Oscillator { kt: 0.0, ..BASE }.model(&[(1, 0.5)]);
    let mut many = one.try_clone().unwrap();
    one.add_contact(&Contact::jenkins(0, None, 1.0, 1.0, 0.3)).unwrap();
    for _ in 0..100 {
        many.add_contact(&Contact::jenkins(0, None, 0.01, 1.0, 0.003)).unwrap();
    }
    for model in [one, many] {
        let x = solve(&model, 1.25, 3, false).unwrap();
        close(x[1].norm(), 1.122_791_677_463_721_2, 1e-9);
    }
}
