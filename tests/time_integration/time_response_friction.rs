//! Friction under a load that varies, in time: harmonic balance tends to the motion as its harmonics grow,
//! and so does an integration in small steps; laws that it contains move alike.

use crate::common::laws_in_time::{
    BETA, COMMON, KN, KT, MASS, SAMPLES, STIFFNESS, distances, forces, friction, in_time, model, slanted, try_in_time,
};
use crate::common::models::Structure;
use crate::common::{all_harmonics, harmonics, relative_gap, solve_at, sweep};
use hbvib::{Constant, Contact, MatrixKind, SteadyMethod, TimeOptions, TimeResponse};
use num_complex::Complex64;
use std::f64::consts::TAU;

#[test]
fn friction_under_a_varying_load_is_what_harmonic_balance_tends_to() {
    for (name, mu, preload, normal) in [
        ("closed", 0.06, 10.0, 0.3),
        ("lifting off", 0.4, 0.5, 1.5),
        ("much friction", 1.5, 0.5, 1.5),
        ("gap", 0.8, -0.3, 1.2),
    ] {
        let model = slanted(&[friction(mu, preload)], &forces(normal));
        let mut open = 0;
        for omega in [0.7, 1.3, 2.2] {
            let (truth, [coarse, fine]) = distances(name, &model, omega, [15, 63]);
            open += truth
                .samples
                .chunks_exact(3)
                .filter(|x| preload - KN * x[1] < 0.0)
                .count();
            assert!(fine < 2e-7 && fine < 0.2 * coarse, "{name} at {omega}");
        }
        println!("{name}: open {open} of {} times", 3 * SAMPLES);
        assert_eq!(open > 0, name != "closed", "{name}");
    }
}

/// Marches the slanted masses with friction by the classical Runge-Kutta method, the slider following in
/// each step; the fundamental of the last of 150 periods.
fn in_small_steps(mu: f64, preload: f64, normal: f64, omega: f64, steps: usize) -> [Complex64; 3] {
    const PERIODS: usize = 150;
    let step = TAU / omega / steps as f64;
    // The inverse of the mass matrix, whose last mass is on its own.
    let determinant = MASS[0] * MASS[4] - MASS[1] * MASS[3];
    let load = |y: f64| (preload - KN * y).max(0.0);
    let follow = |z: &[f64; 6], w: f64| {
        let range = mu * load(z[1]) / KT;
        w.max(z[0] - range).min(z[0] + range)
    };
    let rates = |t: f64, z: &[f64; 6], w: f64| {
        let mut f = [
            (omega * t).cos() - KT * (z[0] - follow(z, w)),
            -normal * (omega * t).sin() + load(z[1]),
            0.0,
        ];
        for (i, f) in f.iter_mut().enumerate() {
            for j in 0..3 {
                *f -= STIFFNESS[3 * i + j] * (z[j] + BETA * z[3 + j]);
            }
        }
        let a = (MASS[4] * f[0] - MASS[1] * f[1]) / determinant;
        let b = (MASS[0] * f[1] - MASS[3] * f[0]) / determinant;
        [z[3], z[4], z[5], a, b, f[2] / MASS[8]]
    };
    let moved = |z: &[f64; 6], h: f64, k: &[f64; 6]| -> [f64; 6] { std::array::from_fn(|i| z[i] + h * k[i]) };
    let (mut z, mut w) = ([0.0; 6], 0.0);
    let mut fundamental = [Complex64::ZERO; 3];
    for n in 0..PERIODS * steps {
        let t = (n % steps) as f64 * step;
        if n >= (PERIODS - 1) * steps {
            for (x, z) in fundamental.iter_mut().zip(&z) {
                *x += z * Complex64::cis(-omega * t) * 2.0 / steps as f64;
            }
        }
        let k1 = rates(t, &z, w);
        let k2 = rates(t + 0.5 * step, &moved(&z, 0.5 * step, &k1), w);
        let k3 = rates(t + 0.5 * step, &moved(&z, 0.5 * step, &k2), w);
        let k4 = rates(t + step, &moved(&z, step, &k3), w);
        for i in 0..6 {
            z[i] += step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
        w = follow(&z, w);
    }
    fundamental
}

#[test]
fn friction_with_separation_moves_as_in_small_steps() {
    for (mu, preload, normal, omega) in [(0.4, 0.5, 1.5, 1.3), (0.8, -0.3, 1.2, 2.2), (0.4, 2.0, 0.6, 0.7)] {
        let found = in_time(&slanted(&[friction(mu, preload)], &forces(normal)), omega, None);
        let [coarse, fine] = [1000, 16_000].map(|steps| {
            let expected = in_small_steps(mu, preload, normal, omega, steps);
            relative_gap(&found.harmonics[3..6], &expected)
        });
        println!(
            "mu = {mu}: {coarse:.1e} and {fine:.1e}, {} events, {} periods",
            found.events, found.periods
        );
        // A step in which the contact closes leaves the slider within the motion of the step.
        assert!(fine < 2e-5 && fine < 0.25 * coarse);
    }
}

#[test]
fn friction_under_a_load_that_stays_is_a_jenkins_contact() {
    // The normal motion is free of the others and not forced: its load is shared by two springs.
    let (m, k, c) = ([1.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.05, 0.0, 0.0, 0.3]);
    let of = |contact| model([&m, &c, &k], &[contact], &[(0, 1, 0.5.into())]);
    let varying = Contact::friction_2d([Some(0), Some(1)], [None, None], (2.0, 3.0), 0.5, 1.0);
    let constant = Contact::jenkins(0, None, 2.0, 0.5, 1.0 * 2.0 / (2.0 + 3.0));
    for omega in [0.6, 1.1] {
        let [a, b] = [&varying, &constant].map(|c| in_time(&of(c.clone()), omega, None));
        let along = |x: &TimeResponse| x.harmonics.iter().step_by(2).copied().collect::<Vec<_>>();
        let error = relative_gap(&along(&a), &along(&b));
        println!(
            "{omega}: {error:.1e}, {} events, {} and {} periods",
            a.events, a.periods, b.periods
        );
        assert!(error < 1e-10 && a.events == 4);
        assert_eq!(a.events, b.events);
        // N = n₀ − kn·y = k·y at rest
        assert!((a.harmonics[1].re - 1.0 / 5.0).abs() < 1e-12);
    }
}

#[test]
fn friction_without_a_coefficient_is_a_unilateral_spring() {
    let mut spring = Contact::unilateral(Some(1), None, 3.0, 0.0);
    spring.set(Constant::Preload, 0.5).unwrap();
    let [a, b] = [friction(0.0, 0.5), spring].map(|c| in_time(&slanted(&[c], &forces(1.5)), 1.3, None));
    let error = relative_gap(&a.harmonics, &b.harmonics);
    println!("{error:.1e}, {} events", a.events);
    assert!(error < 1e-12 && a.events == b.events && a.events >= 2);
}

#[test]
fn marching_and_shooting_end_in_the_same_motion_with_separation() {
    for (mu, omega) in [(0.4, 1.3), (0.8, 2.2)] {
        let model = slanted(&[friction(mu, 0.5)], &forces(1.5));
        let shot = in_time(&model, omega, None);
        let options = TimeOptions {
            omega,
            harmonics: COMMON,
            method: SteadyMethod::Marching,
            ..TimeOptions::default()
        };
        let marched = try_in_time(&model, &options).unwrap();
        let error = relative_gap(&marched.harmonics, &shot.harmonics);
        println!(
            "mu = {mu}: {error:.1e}, {} and {} periods",
            marched.periods, shot.periods
        );
        assert!(error < 1e-9);
        // Newton's method converges as its exact derivative promises.
        assert!(shot.periods <= 20 && marched.periods > shot.periods);
    }
}

/// A sector of four that moves along the surface and its normal, with friction to the next.
#[test]
fn friction_across_sectors_of_a_wave_is_what_harmonic_balance_tends_to() {
    for engine_order in [1, -1, 2] {
        let mut contact = Contact::friction_2d([Some(0), Some(1)], [Some(0), Some(1)], (KT, KN), 0.4, 0.8);
        contact.sector_offset = 1;
        let model = Structure::cyclic(2, 4)
            .matrices([&[1.0, 0.1, 0.1, 1.2], &[0.15, 0.0, 0.0, 0.15], &[3.0, -0.4, -0.4, 2.5]])
            .next(MatrixKind::Mass, &[0.0; 4])
            .next(MatrixKind::Stiffness, &[-0.5, 0.1, -0.2, -0.3])
            .next(MatrixKind::Damping, &[-0.02, 0.0, 0.0, -0.01])
            .wave(engine_order)
            .contact(contact)
            .forces(forces(1.5))
            .build();
        let name = format!("EO {engine_order}");
        let (truth, [coarse, fine]) = distances(&name, &model, 1.7, [15, 63]);
        assert!(truth.events >= 3);
        assert!(fine < 2e-7 && fine < 0.2 * coarse);
    }
}

/// A chain of three masses above each other, each pressed on the next by the weight of those above, on a
/// base that shakes it across and along.
#[test]
fn masses_pressed_statically_that_lift_off_are_what_harmonic_balance_tends_to() {
    let n = 6;
    // Across: 0, 1, 2; along: 3, 4, 5. Weak springs hold each mass to the frame.
    let (mut m, mut k, mut c) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
    for i in 0..n {
        m[i * n + i] = 1.0 + 0.2 * (i % 3) as f64;
        k[i * n + i] = 0.8 + 0.1 * i as f64;
        c[i * n + i] = 0.25;
    }
    let pressed = |a: usize, b: Option<usize>, preload: f64| {
        Contact::friction_2d([Some(a), Some(a + 3)], [b, b.map(|b| b + 3)], (4.0, 6.0), 0.3, preload)
    };
    let contacts = [
        pressed(0, None, 0.9),
        pressed(1, Some(0), 0.6),
        pressed(2, Some(1), 0.3),
    ];
    let forces = [
        (0, 1, 0.6.into()),
        (2, 1, 0.3.into()),
        (3, 1, Complex64::new(0.2, 0.7)),
        (5, 1, 0.5.into()),
    ];
    let model = model([&m, &c, &k], &contacts, &forces);
    let mut most = 0;
    for omega in [0.9, 1.6] {
        let branch = sweep(&model, &harmonics(15), 0.5, omega, &[]);
        let start = all_harmonics(&branch, branch.points() - 1);
        let truth = in_time(&model, omega, Some(&start));
        let errors = [15, 63].map(|h| {
            let found = all_harmonics(&solve_at(&model, &harmonics(h), omega), 0);
            relative_gap(&found[..truth.harmonics.len()], &truth.harmonics)
        });
        println!(
            "{omega}: {errors:?}, {} events, {} periods",
            truth.events, truth.periods
        );
        most = most.max(truth.events);
        assert!(errors[1] < 2e-6 && errors[1] < 0.1 * errors[0]);
    }
    assert!(most >= 9);
}
