//! Points of forced responses checked in time: what the check tells against stored truths, against sums
//! over the motion itself, and against where the points come from.

use crate::common::chains::driven_mass;
use crate::common::models::{Structure, dense};
use crate::common::{
    B2, BASE, Blisk, Wheel, all_harmonics, at_dof, complex, data, harmonics, number, phase, relative_gap, sweep,
};
use hbvib::{
    Branch, Contact, Hooks, MatrixKind, Model, SolverOptions, Status, SteadyMethod, TimeOptions, Verification,
    VerifyOptions, estimate_at, time_response, verify,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

fn options(highest: usize) -> SolverOptions {
    harmonics(highest)
}

fn at(model: &Model, highest: usize, omega: f64) -> Branch {
    sweep(model, &options(highest), omega, omega, &[])
}

fn checked(model: &Model, branch: &Branch, point: usize) -> Verification {
    let v = verify(model, branch, point, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
    assert_eq!(v.status, Status::Ok);
    println!(
        "H = {}: response {:.2e}, motion {:.2e}, above {:.2e}, peak {:.2e}; same {}, marched {}, {} periods, {} events",
        branch.harmonics(),
        v.response_error,
        v.motion_error,
        v.above,
        v.peak_error,
        v.same,
        v.marched,
        v.periods,
        v.events
    );
    v
}

/// Mean square over the period and the degrees of freedom of coefficients, mean and all.
fn square<'a>(x: impl Iterator<Item = &'a [Complex64]>) -> f64 {
    x.enumerate()
        .map(|(h, x)| if h == 0 { 1.0 } else { 0.5 } * x.iter().map(Complex64::norm_sqr).sum::<f64>())
        .sum()
}

fn reference_omega() -> f64 {
    TAU * number(&data("point_F5_208p85.json")["hbm"]["f_Hz"])
}

fn tip(highest: usize) -> SolverOptions {
    at_dof(B2, options(highest))
}

#[test]
fn the_error_of_the_response_is_the_distance_to_the_wheel_in_time() {
    let reference = data("point_F5_208p85.json");
    let truth = complex(&reference["td"]["X"]["1"][B2]);
    let omega = reference_omega();
    let model = BASE.sector();
    for highest in [1_usize, 3, 9, 31, 63] {
        let branch = sweep(&model, &tip(highest), omega, omega, &[]);
        let v = checked(&model, &branch, 0);
        let stored = &reference["hbm"]["hbm_exactN"][&highest.to_string()];
        let other = number(&stored["rel_err_b2_vs_td"]);
        let point = all_harmonics(&branch, 0)[4 + B2];
        let own = (point - truth).norm() / truth.norm();
        // The truth is stored to 1e-8 of itself, by another program.
        assert!((v.response_error - own).abs() < 1e-8, "{own:e}");
        assert!((v.response_error - other).abs() < 1e-8, "{other:e}");
        assert!((v.response - truth).norm() < 1e-8 * truth.norm());
        assert!(v.same && !v.marched && v.harmonic == 1);
        let events = reference["td"]["sector1_events_phase_newstate"].as_array().unwrap();
        assert_eq!(v.events, events.len());
    }
}

#[test]
fn the_motion_of_the_blisk_comes_nearer_as_its_harmonics_grow() {
    let model = BASE.sector();
    let distances = [1, 3, 9, 31, 63, 127].map(|h| {
        let v = checked(&model, &at(&model, h, reference_omega()), 0);
        (v.distance, v.above)
    });
    for pair in distances.windows(2) {
        assert!(pair[1].1 < pair[0].1, "{distances:?}");
    }
    assert!(distances[5].0 < 1e-3 * distances[0].0);
}

#[test]
fn the_error_estimate_is_the_error_that_the_check_finds() {
    let model = BASE.sector();
    let mut slipping = 0;
    for hz in [208.5, 208.7, 208.85, 209.0, 209.2] {
        for highest in [1, 3, 9, 31, 63] {
            let solver = tip(highest);
            let omega = TAU * hz;
            let branch = sweep(&model, &solver, omega, omega, &[]);
            let estimate = estimate_at(&model, &solver, &branch, 0).unwrap();
            let v = checked(&model, &branch, 0);
            if v.events == 0 {
                continue;
            }
            slipping += 1;
            let ratio = estimate.response / v.response_error;
            println!("{hz} Hz: estimate {:.2e}, ratio {ratio:.2}", estimate.response);
            assert!(estimate.certified && (0.3..=3.0).contains(&ratio));
        }
    }
    assert!(slipping >= 10);
}

#[test]
fn the_distance_is_that_of_the_two_motions_time_by_time() {
    let model = driven_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, 0.3), &[(0, 0.1), (1, 0.2)]);
    let (omega, times) = (1.25, 20_000);
    for highest in [1, 3, 9] {
        let branch = at(&model, highest, omega);
        let v = checked(&model, &branch, 0);
        let x = all_harmonics(&branch, 0);
        let time = TimeOptions {
            omega,
            samples: times,
            start: Some(&x),
            ..TimeOptions::default()
        };
        let truth = time_response(&model, &time, &mut Hooks::default()).unwrap().samples;
        let sum = |x: &[Complex64], i: usize| -> f64 {
            let turn = |h: usize| Complex64::cis(TAU * ((h * i) % times) as f64 / times as f64);
            x.iter().enumerate().map(|(h, x)| (x * turn(h)).re).sum()
        };
        let mut own = v.harmonics.clone();
        own.truncate(highest + 1);
        let (mut gap, mut above, mut whole, mut peak, mut peak_of_point) = (0.0, 0.0, 0.0, 0.0_f64, 0.0_f64);
        for (i, y) in truth.iter().enumerate() {
            let x = sum(&x, i);
            gap += (x - y).powi(2);
            above += (y - sum(&own, i)).powi(2);
            whole += y.powi(2);
            peak = peak.max(y.abs());
            peak_of_point = peak_of_point.max(x.abs());
        }
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * b;
        assert!(close(v.distance, (gap / whole).sqrt()) && close(v.above, (above / whole).sqrt()));
        assert!(close(v.motion_error.hypot(v.above), v.distance));
        let sum: f64 = v.harmonic_errors.iter().map(|e| e * e).sum();
        assert!(close(sum.sqrt(), v.motion_error));
        assert!((v.peak - peak).abs() < 1e-7 * peak);
        assert!((v.peak_error - (peak_of_point - peak).abs() / peak).abs() < 1e-7);
    }
}

#[test]
fn what_lies_above_is_what_more_harmonics_in_time_show() {
    let model = BASE.sector();
    let branch = at(&model, 3, reference_omega());
    let v = checked(&model, &branch, 0);
    let x = all_harmonics(&branch, 0);
    let time = TimeOptions {
        omega: reference_omega(),
        harmonics: 255,
        start: Some(&x),
        ..TimeOptions::default()
    };
    let truth = time_response(&model, &time, &mut Hooks::default()).unwrap();
    let whole = square(truth.harmonics.chunks_exact(4));
    let below = square(truth.harmonics[..16].chunks_exact(4));
    let above = ((whole - below) / whole).sqrt();
    assert!((v.above / above - 1.0).abs() < 1e-6, "{} {above}", v.above);
    assert!(relative_gap(&v.harmonics, &truth.harmonics[..16]) < 1e-9);
}

#[test]
fn points_that_stick_or_are_linear_have_no_error() {
    let stuck = Blisk { force: 0.05, ..BASE };
    let free = driven_mass(0.02, &Contact::jenkins(0, None, 1.0, 0.0, 1.0), &[(0, 0.3), (1, 0.2)]);
    let held = driven_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, 10.0), &[(0, 0.3), (1, 0.2)]);
    for (model, omega) in [
        (stuck.sector(), TAU * 209.0),
        (stuck.sector_without_contact(), TAU * 203.0),
        (free, 0.9),
        (held, 1.3),
    ] {
        let branch = at(&model, 5, omega);
        let before = all_harmonics(&branch, 0);
        let v = checked(&model, &branch, 0);
        assert!(v.same && v.events == 0 && v.periods <= 3);
        assert!(v.response_error < 1e-9 && v.distance < 1e-9 && v.peak_error < 1e-9);
        assert_eq!(all_harmonics(&branch, 0), before);
    }
}

#[test]
fn points_that_open_and_close_a_gap_come_nearer_in_both_of_their_states() {
    let model = driven_mass(0.02, &Contact::unilateral(None, Some(0), 3.0, 0.2), &[(1, 0.02)]);
    // |X₁| of both states in an event-driven integration of another program.
    for (from, expected) in [(0.9, 0.401_335_298_905_242_4), (1.4, 0.061_858_390_314_775_365)] {
        let [coarse, fine] = [7, 63].map(|highest| {
            let branch = sweep(&model, &options(highest), from, 1.15, &[]);
            let v = checked(&model, &branch, branch.points() - 1);
            assert!(v.same && !v.marched);
            assert!((v.response.norm() / expected - 1.0).abs() < 1e-9);
            v
        });
        // The small motion does not touch the stop.
        if coarse.events > 0 {
            assert!(fine.distance < 0.02 * coarse.distance && fine.response_error < 1e-5);
            assert!(fine.harmonic_errors[0] < 0.02 * coarse.harmonic_errors[0] && coarse.harmonic_errors[0] > 1e-7);
        } else {
            assert!(coarse.distance < 1e-9 && fine.distance < 1e-9);
        }
    }
}

#[test]
fn a_slipping_point_under_a_constant_load_is_checked_with_its_mean() {
    let model = driven_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, 0.3), &[(0, 0.1), (1, 0.2)]);
    let errors = [1, 7, 63].map(|highest| {
        let v = checked(&model, &at(&model, highest, 1.25), 0);
        // |X₁| of another program's event-driven integration.
        assert!((v.response.norm() / 0.579_898_529_742_581_4 - 1.0).abs() < 1e-9);
        assert!(v.same && v.events > 0);
        // Slip one way is slip the other way a half-period later: friction has no mean, and F₀/k is that of the motion.
        assert!((v.harmonics[0] - 0.1).norm() < 1e-12 && v.harmonic_errors[0] < 1e-12);
        [v.response_error, v.distance]
    });
    for i in 0..2 {
        assert!(errors[2][i] < 1e-4 * errors[0][i], "{errors:?}");
    }
}

fn duffing() -> Model {
    driven_mass(0.05, &Contact::cubic(0, None, 0.0, 0.1), &[(1, 0.18)])
}

/// A response with three solutions at one frequency, and the numbers of their points, by amplitude.
fn three(highest: usize) -> (Model, Branch, Vec<usize>) {
    let model = duffing();
    let branch = sweep(&model, &options(highest), 0.5, 1.6, &[1.2]);
    let mut found = branch.at(0).to_vec();
    found.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    assert_eq!(found.len(), 3);
    let points = found.iter().map(|s| s.point).collect();
    (model, branch, points)
}

#[test]
fn each_of_three_solutions_at_one_frequency_is_found_as_itself_the_unstable_one_too() {
    for (highest, tolerance) in [(3, 1e-3), (15, 1e-9)] {
        let (model, branch, points) = three(highest);
        for point in points {
            let v = checked(&model, &branch, point);
            assert!(v.same && !v.marched, "|X| = {}", v.response.norm());
            assert!(v.response_error < tolerance && v.distance < tolerance);
        }
    }
}

#[test]
fn a_motion_that_leaves_the_unstable_solution_is_told_as_another_one() {
    // With three harmonics the point is near the solution, but not on it.
    let (model, branch, points) = three(3);
    let options = VerifyOptions {
        method: SteadyMethod::Marching,
        ..VerifyOptions::default()
    };
    let mut said = Vec::new();
    let mut log = |_, text: &str| said.push(text.to_owned());
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let v = verify(&model, &branch, points[1], &options, &mut hooks).unwrap();
    assert!(!v.same && v.marched && v.distance > 0.1, "{}", v.distance);
    assert!(said.iter().any(|text| text.contains("far from the point")));
    // It is one of the stable two.
    let own = |point: usize| branch.response_at(point).unwrap()[0];
    let nearest = [points[0], points[2]]
        .map(|p| (own(p) - v.response).norm() / v.response.norm())
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-4, "{nearest:e}");
    for stable in [points[0], points[2]] {
        let v = verify(&model, &branch, stable, &options, &mut Hooks::default()).unwrap();
        assert!(v.same && v.marched && v.distance < 1e-3);
    }
}

/// A sector of two masses with friction across to the next one, or the whole wheel of five of them.
fn sector_and_wheel() -> (Model, Model) {
    const SECTORS: usize = 5;
    let mass = [1.0, 0.0, 0.0, 0.6];
    let (own, next) = ([4.0, -1.0, -1.0, 3.0], [-0.5, 0.2, 0.0, -0.3]);
    let damping = [0.1, 0.0, 0.0, 0.08];
    let mut across = Contact::jenkins(0, Some(1), 1.5, 0.5, 0.4);
    across.sector_offset = 1;
    let sector = Structure::cyclic(2, SECTORS)
        .matrices([&mass, &damping, &own])
        .next(MatrixKind::Stiffness, &next)
        .wave(1)
        .contact(&across)
        .force(1, 1, 0.5)
        .build();
    let mut full_wheel = Wheel::new(2, SECTORS);
    full_wheel.set(MatrixKind::Mass, &mass, None, None);
    full_wheel.set(MatrixKind::Damping, &damping, None, None);
    full_wheel.set(MatrixKind::Stiffness, &own, Some(&next), None);
    full_wheel.add_contact(&across);
    full_wheel.add_force(1, 1, 0.5.into(), 1);
    (sector, full_wheel.model)
}

#[test]
fn a_sector_in_its_wave_has_the_errors_of_the_whole_wheel() {
    let (sector, full_wheel) = sector_and_wheel();
    let solver = at_dof(1, options(7));
    let [one, all] = [&sector, &full_wheel].map(|model| {
        let branch = sweep(model, &solver, 1.9, 1.9, &[]);
        checked(model, &branch, 0)
    });
    assert!(one.events > 0 && one.response_error > 1e-6);
    for (a, b) in [
        (one.response_error, all.response_error),
        (one.motion_error, all.motion_error),
        (one.above, all.above),
        (one.peak_error, all.peak_error),
    ] {
        assert!((a - b).abs() < 1e-8, "{a:e} {b:e}");
    }
    let wave: Vec<Complex64> = one
        .harmonics
        .chunks_exact(2)
        .enumerate()
        .flat_map(|(h, x)| (0..5).flat_map(move |s| [x[0], x[1]].map(|x| x * phase(h, 1, s, 5))))
        .collect();
    assert!(relative_gap(&all.harmonics, &wave) < 1e-9);
}

#[test]
fn a_contact_that_sticks_under_a_constant_load_beside_one_that_slips_keeps_its_place() {
    let model = dense(&[1.0, 0.0, 0.0, 1.0], &[3.0, -1.0, -1.0, 3.0])
        .damping(&[0.1, 0.0, 0.0, 0.1])
        .slider(0, 1.0, 1.0, 0.1)
        .slider(1, 1.0, 1.0, 2.0)
        .forces([(0, 1, 0.6), (0, 0, 0.2), (1, 0, 0.5)])
        .build();
    let [coarse, fine] = [3, 63].map(|h| {
        let branch = at(&model, h, 1.3);
        let shares = branch.slip_fraction_at(0).unwrap();
        assert!(shares[0] > 0.1 && shares[1] == 0.0);
        checked(&model, &branch, 0)
    });
    assert!(fine.distance < 1e-3 * coarse.distance && coarse.events == 4);
}
