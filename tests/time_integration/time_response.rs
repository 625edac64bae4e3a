//! Periodic responses by integration in time against closed forms, against event-driven integrations
//! made by other programs, and against harmonic balance with many harmonics.

use crate::common::chains::driven_mass;
use crate::common::models::dense;
use crate::common::{
    BASE, Blisk, SECTORS, all_harmonics, complex, data, harmonics, largest, number, phase, relative_gap, solve_at,
    sweep,
};
use hbvib::{Contact, Hooks, MatrixKind, Model, Part, Status, SteadyMethod, TimeOptions, TimeResponse, time_response};
use num_complex::Complex64;
use std::f64::consts::TAU;

fn at(omega: f64) -> TimeOptions<'static> {
    TimeOptions {
        omega,
        ..TimeOptions::default()
    }
}

fn solve(model: &Model, options: &TimeOptions<'_>) -> TimeResponse {
    let found = time_response(model, options, &mut Hooks::default()).unwrap();
    assert_eq!(found.status, Status::Ok);
    found
}

/// Mass 1, damping 0.02, stiffness 1, with a contact to the ground.
fn oscillator(contact: &Contact, forces: &[(usize, f64)]) -> Model {
    driven_mass(0.02, contact, forces)
}

fn jenkins(kt: f64, limit: f64) -> Contact {
    Contact::jenkins(0, None, kt, 1.0, limit)
}

/// The spring of the hard cases, f = kn·max(x − gap, 0): it is the ground that moves over side b.
fn stop(kn: f64, gap: f64) -> Contact {
    Contact::unilateral(None, Some(0), kn, gap)
}

#[test]
fn a_linear_structure_moves_as_its_frequency_response_says() {
    // Mass with coupling, damping without symmetry, forces in three harmonics and a constant one.
    let (m, c, k) = ([2.0, 0.3, 0.3, 1.0], [0.3, 0.1, -0.05, 0.2], [5.0, -2.0, -2.0, 4.0]);
    let forces = [
        (0, 0, Complex64::new(0.7, 0.0)),
        (0, 1, Complex64::new(1.0, -0.4)),
        (1, 2, Complex64::new(0.2, 0.9)),
        (1, 5, Complex64::new(-0.5, 0.1)),
    ];
    let model = dense(&m, &k)
        .part(MatrixKind::Damping, &c, Part::General)
        .forces(forces)
        .build();
    for omega in [0.3, 1.1, 1.9] {
        let options = TimeOptions {
            harmonics: 6,
            samples: 7,
            ..at(omega)
        };
        let found = solve(&model, &options);
        let mut expected = vec![Complex64::ZERO; 14];
        for h in 0..=6 {
            let w = h as f64 * omega;
            let z = |i: usize| Complex64::new(k[i] - w * w * m[i], w * c[i]);
            let mut f = [Complex64::ZERO; 2];
            for (dof, _, value) in forces.iter().filter(|f| f.1 == h) {
                f[*dof] += value;
            }
            let determinant = z(0) * z(3) - z(1) * z(2);
            expected[2 * h] = (z(3) * f[0] - z(2) * f[1]) / determinant;
            expected[2 * h + 1] = (z(0) * f[1] - z(1) * f[0]) / determinant;
        }
        let error = relative_gap(&found.harmonics, &expected);
        println!(
            "{omega}: {error:.1e}, residual {:.1e}, {} periods",
            found.residual, found.periods
        );
        assert!(error < 1e-12);
        for (i, x) in found.samples.chunks_exact(2).enumerate() {
            for (dof, x) in x.iter().enumerate() {
                let turn = TAU * i as f64 / 7.0;
                let sum: f64 = (0..=6)
                    .map(|h| (expected[2 * h + dof] * Complex64::cis(h as f64 * turn)).re)
                    .sum();
                assert!((x - sum).abs() < 1e-12 * largest(&expected), "sample {i}");
            }
        }
    }
}

#[test]
fn friction_agrees_with_event_driven_integrations_of_others() {
    let cases: [(&str, Model, f64, f64, f64); 4] = [
        (
            "kt/k 1e3",
            oscillator(&jenkins(1e3, 0.2), &[(1, 0.5)]),
            0.9,
            2.161_790_724_147_932,
            1e-9,
        ),
        (
            "kt/k 1e6",
            oscillator(&jenkins(1e6, 0.2), &[(1, 0.5)]),
            0.9,
            2.178_382_925_129_319,
            1e-9,
        ),
        (
            "undamped at resonance",
            driven_mass(0.0, &jenkins(1.0, 0.3), &[(1, 0.35)]),
            1.0,
            0.490_802_178_303_386_2,
            1e-9,
        ),
        (
            "constant load",
            oscillator(&jenkins(1.0, 0.3), &[(0, 0.1), (1, 0.2)]),
            1.25,
            0.579_898_529_742_581_4,
            1e-9,
        ),
    ];
    for (name, model, omega, expected, tolerance) in cases {
        let found = solve(&model, &at(omega));
        let error = (found.harmonics[1].norm() / expected - 1.0).abs();
        println!(
            "{name}: {error:.1e}, residual {:.1e}, {} periods, {} events",
            found.residual, found.periods, found.events
        );
        assert!(error < tolerance, "{name}: {}", found.harmonics[1].norm());
    }
}

/// The last point of a sweep, as a start.
fn swept(model: &Model, highest: usize, from: f64, to: f64) -> Vec<Complex64> {
    let branch = sweep(model, &harmonics(highest), from, to, &[]);
    all_harmonics(&branch, branch.points() - 1)
}

#[test]
fn both_states_of_a_gap_oscillator_are_found_from_their_side() {
    let model = oscillator(&stop(3.0, 0.2), &[(1, 0.02)]);
    for (from, expected) in [(0.9, 0.401_335_298_905_242_4), (1.4, 0.061_858_390_314_775_365)] {
        let start = swept(&model, 15, from, 1.15);
        let found = solve(
            &model,
            &TimeOptions {
                start: Some(&start),
                ..at(1.15)
            },
        );
        let error = (found.harmonics[1].norm() / expected - 1.0).abs();
        println!(
            "from {from}: {error:.1e}, {} periods, {} events",
            found.periods, found.events
        );
        // The stored fundamental comes from samples of the motion, which alias as deep as this.
        assert!(error < 1e-9);
    }
}

#[test]
fn duffings_peak_is_that_of_two_other_methods() {
    let model = driven_mass(0.05, &Contact::cubic(0, None, 0.0, 0.1), &[(1, 0.18)]);
    let omega = 1.268_716_736_0;
    let start = swept(&model, 7, 1.0, omega);
    let found = solve(
        &model,
        &TimeOptions {
            start: Some(&start),
            ..at(omega)
        },
    );
    let error = found.harmonics[1].norm() - 2.830_198_059_4;
    println!(
        "{error:.1e}, residual {:.1e}, {} periods",
        found.residual, found.periods,
    );
    assert!(error.abs() < 1e-9 * 2.83);
}

#[test]
fn the_blisk_moves_as_in_the_event_driven_integration_of_the_whole_wheel() {
    let reference = data("frf_base.json");
    let mut worst = 0.0_f64;
    for point in reference["curve_F5"]["points"].as_array().unwrap() {
        let omega = TAU * number(&point["f_Hz"]);
        let expected = complex(&point["td"]);
        let model = BASE.sector();
        let close = all_harmonics(&solve_at(&model, &harmonics(9), omega), 0);
        let found = solve(
            &model,
            &TimeOptions {
                start: Some(&close),
                ..at(omega)
            },
        );
        let error = (found.harmonics[4] - expected).norm() / expected.norm();
        worst = worst.max(error);
        assert!(error < 1e-8);
    }
    println!("worst of all points: {worst:.1e}");
}

/// The peak of the fundamental over frequency near `omega`, by the parabola through three points.
fn peak(model: &Model, omega: f64, step: f64, start: &[Complex64]) -> (f64, f64) {
    let amplitude = |omega: f64| {
        let options = TimeOptions {
            start: Some(start),
            harmonics: 1,
            ..at(omega)
        };
        solve(model, &options).harmonics[4].norm()
    };
    let [a, b, c] = [-1.0, 0.0, 1.0].map(|k| amplitude(omega + k * step));
    let shift = 0.5 * (a - c) / (a - 2.0 * b + c);
    (omega + shift * step, b - 0.25 * (a - c) * shift)
}

#[test]
fn the_peaks_of_the_blisk_are_those_of_the_whole_wheel_in_time() {
    let reference = data("frf_base.json");
    for (name, force) in [("F1", 1.0), ("F5", 5.0), ("F20", 20.0)] {
        let truth = &reference["peaks"][name]["peak_td"];
        let omega = TAU * number(&truth["f_Hz"]);
        let model = Blisk { force, ..BASE }.sector();
        let close = all_harmonics(&solve_at(&model, &harmonics(15), omega), 0);
        // Steps of a fifth of the half-power width keep the parabola's own error below the claim.
        let (place, height) = peak(&model, omega, 2e-5 * omega, &close);
        let error = (height / number(&truth["amp_b2_fund_m"]) - 1.0).abs();
        let away = (place - omega).abs() / TAU;
        println!("{name}: {error:.1e}, {away:.1e} Hz away");
        assert!(error < 1e-8, "{name}: {error:.1e}");
        // As sharp as the stored frequency.
        assert!(away < 2e-4, "{name}: {away:.1e} Hz");
    }
}

#[test]
fn all_harmonics_of_a_point_and_its_events_are_those_of_the_whole_wheel_in_time() {
    let reference = data("point_F5_208p85.json");
    let truth = &reference["td"];
    let omega = TAU * number(&truth["f_Hz"]);
    let found = solve(
        &BASE.sector(),
        &TimeOptions {
            harmonics: 31,
            ..at(omega)
        },
    );
    for (h, dofs) in truth["X"].as_object().unwrap() {
        let h: usize = h.parse().unwrap();
        let expected: Vec<Complex64> = dofs.as_array().unwrap().iter().map(complex).collect();
        let error = relative_gap(&found.harmonics[4 * h..4 * (h + 1)], &expected);
        println!("harmonic {h}: {error:.1e}");
        assert!(error < 1e-8, "harmonic {h}: {error:.1e}");
    }
    let events = truth["sector1_events_phase_newstate"].as_array().unwrap().len();
    assert_eq!(found.events, events);
}

#[test]
fn a_sector_in_its_wave_is_the_wheel_as_a_plain_structure() {
    let omega = TAU * 208.85;
    let sector = BASE.sector();
    let full_wheel = BASE.full_wheel();
    let found = solve(&sector, &at(omega));
    let mut start = Vec::new();
    for (h, x) in found.harmonics.chunks_exact(4).enumerate() {
        for s in 0..SECTORS {
            start.extend(x.iter().map(|x| x * phase(h, BASE.engine_order, s, SECTORS)));
        }
    }
    let all = solve(
        &full_wheel,
        &TimeOptions {
            start: Some(&start),
            ..at(omega)
        },
    );
    let error = relative_gap(&all.harmonics, &start);
    println!("{error:.1e}");
    assert!(error < 1e-10);
    assert_eq!(all.events, SECTORS * found.events);
}

#[test]
#[ignore = "takes minutes: 216 sensitivities over hundreds of periods"]
fn the_wheel_comes_into_the_wave_from_rest() {
    let omega = TAU * 208.85;
    let (full_wheel, sector) = (solve(&BASE.full_wheel(), &at(omega)), solve(&BASE.sector(), &at(omega)));
    let first: Vec<Complex64> = full_wheel
        .harmonics
        .chunks_exact(96)
        .flat_map(|x| x[..4].to_vec())
        .collect();
    // The ring may rest anywhere around the wheel.
    let error = relative_gap(&first[4..], &sector.harmonics[4..]);
    println!("{error:.1e}, {} periods", full_wheel.periods);
    assert!(error < 1e-10);
}

#[test]
fn marching_and_shooting_end_in_the_same_motion() {
    let contacts = [jenkins(1.0, 0.3), stop(3.0, 0.1), Contact::cubic(0, None, 0.5, 0.2)];
    for contact in contacts {
        let model = driven_mass(0.1, &contact, &[(0, 0.05), (1, 1.0)]);
        let options = TimeOptions {
            method: SteadyMethod::Marching,
            ..at(0.8)
        };
        let (marched, shot) = (solve(&model, &options), solve(&model, &at(0.8)));
        let error = relative_gap(&marched.harmonics, &shot.harmonics);
        println!(
            "{:?}: {error:.1e}, {} and {} periods",
            contact.kind, marched.periods, shot.periods
        );
        assert!(error < 1e-9);
        assert!(marched.periods > shot.periods);
    }
}

#[test]
fn loads_and_lengths_of_any_unit_scale_the_motion() {
    let model = |s: f64| oscillator(&jenkins(1.0, 0.3 * s), &[(1, 0.2 * s)]);
    let reference = solve(&model(1.0), &at(1.25)).harmonics;
    for s in [1e-150, 1e-12, 1e6, 1e150] {
        let mut x = solve(&model(s), &at(1.25)).harmonics;
        for x in &mut x {
            *x /= s;
        }
        let error = relative_gap(&x, &reference);
        println!("{s:e}: {error:.1e}");
        assert!(error < 1e-12);
    }
}

#[test]
fn springs_that_never_change_give_linear_motions() {
    let linear = |stiffness: f64, mean: f64| {
        let x = 0.2 / (Complex64::new(1.0 + stiffness - 1.21, 0.022));
        (x, mean)
    };
    let free = linear(0.0, 0.0);
    // Closed throughout: a mean force of kn·gap on a spring of 1 + kn.
    let pressed = linear(1000.0, -0.5 * 1000.0 / 1001.0);
    for (name, contact, (x, mean)) in [
        ("no friction", jenkins(1.0, 0.0), free),
        ("sticks for ever", jenkins(1.0, f64::INFINITY), linear(1.0, 0.0)),
        ("sticks", jenkins(1.0, 10.0), linear(1.0, 0.0)),
        ("wide gap", stop(3.0, 10.0), free),
        ("pressed", stop(1000.0, -0.5), pressed),
    ] {
        let found = solve(&oscillator(&contact, &[(1, 0.2)]), &at(1.1));
        let error = (found.harmonics[1] - x).norm() / x.norm().max(mean.abs());
        let mean_error = (found.harmonics[0].re - mean).abs();
        println!("{name}: {error:.1e}, mean {mean_error:.1e}, {} events", found.events);
        assert!(error < 1e-12 && mean_error < 1e-12, "{name}");
        assert_eq!(found.events, 0);
    }
}

#[test]
fn a_slider_that_never_slips_stays_where_a_virgin_one_is() {
    // Stuck under a constant load: half of it on each spring.
    let model = oscillator(&jenkins(1.0, 0.3), &[(0, 0.1), (1, 0.05)]);
    let close = all_harmonics(&solve_at(&model, &harmonics(3), 0.9), 0);
    for start in [None, Some(&close[..])] {
        let found = solve(&model, &TimeOptions { start, ..at(0.9) });
        assert!((found.harmonics[0].re - 0.05).abs() < 1e-13);
        assert_eq!(found.events, 0);
    }
}
