//! Crossings of Campbell diagrams in the sense that an engine order excites, and the whirl of modes that gyroscopic forces do
//! not touch.

use crate::common::models::{Structure, dense};
use crate::common::{amplitude_range, harmonics};
use hbvib::{
    AeroForm, Branch, Campbell, Contact, ContactState, Hooks, LinearContacts, LogLevel, MatrixKind, MatrixView,
    ModeOptions, Model, Speed, campbell, damped_modes, nonlinear_mode,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

use crate::signed_diameters::Random;

const SECTORS: usize = 10;

/// Ten masses that move radially and along the circumference, with Coriolis forces: M, K, the coupling and G, row-major.
const STIFFNESS: [f64; 4] = [1500.0, 0.0, 0.0, 1900.0];
const COUPLING: [f64; 4] = [-200.0, -250.0, 250.0, -350.0];

fn wheel() -> Model {
    // Columns of [[0, −2], [2, 0]] and of [[−200, 250], [−250, −350]].
    Structure::cyclic(2, SECTORS)
        .mass(&[1.0, 0.0, 0.0, 1.0])
        .stiffness(&STIFFNESS)
        .set(MatrixKind::Gyroscopic, &[0.0, 2.0, -2.0, 0.0])
        .next(MatrixKind::Stiffness, &COUPLING)
        .build()
}

/// ω² of the wave by the closed form of two degrees of freedom: (k₁ − ω²)(k₂ − ω²) − |k₁₂ − 2iωΩ|² = 0 has the roots ω > 0 of
/// ω⁴ − (k₁ + k₂ + 4Ω²) ω² + 4 Ω Im(k₁₂) ω + k₁k₂ − |k₁₂|² = 0, with k₁₂ imaginary.
fn residual(diameter: i64, speed: f64, omega: f64) -> f64 {
    let lag = Complex64::cis(-TAU * diameter as f64 / SECTORS as f64);
    let k11 = 1500.0 - 400.0 * lag.re;
    let k22 = 1900.0 - 700.0 * lag.re;
    // K₁₂ = 250 e^{−iφ} − 250 e^{iφ}
    let k12 = 250.0 * (lag - lag.conj());
    let coupled = k12 - Complex64::new(0.0, 2.0 * speed * omega);
    (k11 - omega * omega) * (k22 - omega * omega) - coupled.norm_sqr()
}

fn crossings(model: &Model, diameter: i64, order: i64) -> Campbell {
    let speeds: Vec<f64> = (0..181).map(|i| 0.2 + (45.0 - 0.2) * f64::from(i) / 180.0).collect();
    let at = (diameter, LinearContacts::Stuck, 2);
    campbell(model, &speeds, at, &[order], &mut Hooks::default()).unwrap()
}

#[test]
fn engine_orders_of_a_rotating_wheel_meet_the_waves_of_their_own_sense() {
    let model = wheel();
    // Digits of numpy and brentq, wave by wave, confirmed by the peaks of the forced response.
    for (order, wave, known) in [
        (9, -1, [3.799_517_909_874_847_7, 4.057_803_869_088_63]),
        (19, -1, [1.710_413_476_178_725, 1.982_981_220_346_410_8]),
    ] {
        for diameter in [1, -1, 9, 11] {
            let found = crossings(&model, diameter, order);
            assert_eq!(found.diameter, if diameter.rem_euclid(10) == 1 { 1 } else { -1 });
            let [a, b] = found.crossings[..] else {
                panic!("{:?}", found.crossings)
            };
            for (crossing, known) in [a, b].iter().zip(known) {
                assert!((crossing.speed / known - 1.0).abs() < 1e-12, "EO {order}: {crossing:?}");
                assert!((crossing.omega / (order as f64 * crossing.speed) - 1.0).abs() < 1e-12);
                assert_eq!((crossing.engine_order, crossing.diameter), (order, wave));
            }
        }
    }
    for order in [1, 9, 11, 19] {
        let wave = if order % 10 == 1 { 1 } else { -1 };
        let found = crossings(&model, 1, order);
        // Every crossing and no other is a root: signs of the closed form between the speeds.
        let at = |speed: f64| residual(wave, speed, order as f64 * speed);
        for crossing in &found.crossings {
            let scale = 1500.0_f64.powi(2);
            assert!(at(crossing.speed).abs() < 1e-8 * scale, "EO {order}: {crossing:?}");
            let other = residual(-wave, crossing.speed, crossing.omega);
            assert!(other.abs() > 1e-3 * scale, "the senses differ: {other}");
        }
        let steps: Vec<f64> = (0..=4000).map(|i| 0.2 + 44.8 * f64::from(i) / 4000.0).collect();
        let changes = steps.windows(2).filter(|pair| at(pair[0]) * at(pair[1]) < 0.0).count();
        assert_eq!(found.crossings.len(), changes, "EO {order}");
    }
}

#[test]
fn a_speed_tied_to_the_frequency_and_nonlinear_modes_have_the_sense_of_the_wave() {
    for (order, known) in [
        (9, [3.799_517_909_874_847_7, 4.057_803_869_088_63]),
        (19, [1.710_413_476_178_725, 1.982_981_220_346_410_8]),
    ] {
        // At Ω = ω/EO the free motions are at the critical speeds.
        let mut model = wheel();
        model.set_speed(Speed::PerOmega(1.0 / order as f64)).unwrap();
        let modes = model.linear_modes(order, ContactState::Free).unwrap();
        for (omega, speed) in modes.omega.iter().zip(known) {
            assert!((omega / (order as f64 * speed) - 1.0).abs() < 1e-11, "{omega}");
        }
        let other = model.linear_modes(-order, ContactState::Free).unwrap();
        assert!((other.omega[0] / modes.omega[0] - 1.0).abs() > 1e-2);
    }
    let mut model = wheel();
    model.set_speed(Speed::Fixed(5.0)).unwrap();
    model.add_contact(&Contact::jenkins(0, None, 100.0, 0.3, 50.0)).unwrap();
    let solver = harmonics(3);
    for diameter in [1, -1, 9, -3, 5] {
        let range = ModeOptions {
            diameter: Some(diameter),
            ..amplitude_range(-3.0, -2.0)
        };
        let branch = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
        let linear = model.linear_modes(diameter, ContactState::Stuck).unwrap();
        assert!((branch.omega()[0] / linear.omega[0] - 1.0).abs() < 1e-9, "{diameter}");
        assert_eq!(
            branch.mode().unwrap().engine_order,
            model.structure().signed_diameter(diameter)
        );
        let mut in_wave = model.try_clone().unwrap();
        in_wave.set_wave(diameter);
        let own = ModeOptions {
            diameter: None,
            ..range
        };
        let own = nonlinear_mode(&in_wave, &solver, &own, &mut Hooks::default()).unwrap();
        let last = |b: &Branch| b.omega().last().copied().unwrap();
        assert!((last(&own) / last(&branch) - 1.0).abs() < 1e-12, "{diameter}");
    }
}

#[test]
fn an_engine_order_of_another_diameter_meets_no_mode_and_is_told() {
    let mut lines = Vec::new();
    let mut log = |level: LogLevel, line: &str| lines.push((level, line.to_owned()));
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let speeds: Vec<f64> = (0..46).map(f64::from).collect();
    let at = (1, LinearContacts::Stuck, 2);
    let found = campbell(&wheel(), &speeds, at, &[1, 2, 9], &mut hooks).unwrap();
    let orders: Vec<i64> = found.crossings.iter().map(|c| c.engine_order).collect();
    assert!(
        orders.contains(&1) && orders.contains(&9) && !orders.contains(&2),
        "{orders:?}"
    );
    let told = lines
        .iter()
        .any(|(_, line)| line.contains("engine order 2 excites the nodal diameter 2"));
    assert!(told, "{lines:?}");
}

#[test]
fn growth_of_the_sense_that_an_engine_order_excites_is_told_with_its_wave() {
    let mut model = wheel();
    model.set_rayleigh(0.5, 0.0).unwrap();
    // A(d) = −2ig sin(2πd/10) feeds waves of negative diameters.
    let coefficients = [60.0, 0.0, 0.0, 60.0, -60.0, 0.0, 0.0, -60.0].map(Complex64::from);
    model
        .set_aero(&[0, 1], &coefficients, &[1, -1], AeroForm::Displacement)
        .unwrap();
    let speeds: Vec<f64> = (1..=12).map(|i| 0.5 * f64::from(i)).collect();
    let told = |order: i64| {
        let mut lines = Vec::new();
        let mut log = |_: LogLevel, line: &str| lines.push(line.to_owned());
        let mut hooks = Hooks {
            log: Some(&mut log),
            ..Hooks::default()
        };
        let at = (1, LinearContacts::Stuck, 2);
        let found = campbell(&model, &speeds, at, &[order], &mut hooks).unwrap();
        assert!(found.damping_ratio.iter().all(|ratio| *ratio > 0.0));
        lines
            .into_iter()
            .filter(|line| line.contains("grow"))
            .collect::<Vec<_>>()
    };
    assert!(told(11).is_empty());
    let of_other = told(9);
    assert!(
        of_other.len() == 1 && of_other[0].contains("nodal diameter -1"),
        "{of_other:?}"
    );
}

#[test]
fn equal_senses_have_the_same_crossings_and_opposite_whirl() {
    // At rest nothing distinguishes the senses; K₁ stiffens both alike.
    let mut model = wheel();
    model
        .set_matrix(MatrixKind::Gyroscopic, &MatrixView::dense(2, &[0.0; 4]))
        .unwrap();
    model
        .set_matrix(
            MatrixKind::StiffnessSpeed2,
            &MatrixView::dense(2, &[0.3, 0.0, 0.0, 0.5]),
        )
        .unwrap();
    let (one, other) = (crossings(&model, 1, 9), crossings(&model, -1, 9));
    assert!(!one.crossings.is_empty() && one.crossings.len() == other.crossings.len());
    for (a, b) in one.crossings.iter().zip(&other.crossings) {
        assert!((a.speed / b.speed - 1.0).abs() < 1e-12);
        assert_eq!((a.diameter, b.diameter), (-1, -1));
    }
    // Directions at a speed of zero, where the forces have no size yet: the frequency of one sense rises, that of the other falls.
    let model = wheel();
    let of = |d| damped_modes(&model, d, LinearContacts::Stuck, 2, &mut Hooks::default()).unwrap();
    let (one, other) = (of(1), of(-1));
    for k in 0..2 {
        assert!((one.omega(k) / other.omega(k) - 1.0).abs() < 1e-12);
        assert_eq!(one.direction[k], -other.direction[k]);
        assert_eq!(one.direction[k].abs(), 1);
    }
    let all = hbvib::interference(&model, LinearContacts::Stuck, 2, &mut Hooks::default()).unwrap();
    assert!(all.has_equal_senses);
    let at = |d: i64| all.diameters.iter().position(|x| *x == d).unwrap();
    for (d, modes) in [(1, &one), (-1, &other)] {
        assert_eq!(all.direction[2 * at(d)..2 * at(d) + 2], modes.direction);
    }
}

#[test]
fn axial_and_torsional_modes_have_no_whirl() {
    let mut random = Random(2);
    for trial in 0..400 {
        let mut next = |low: f64, high: f64| low + (high - low) * 0.5 * (random.next() + 1.0);
        let (jd, jp) = (next(0.2, 0.5), next(0.1, 0.9));
        let (lateral, axial, m) = (next(500.0, 3000.0), next(500.0, 3000.0), next(500.0, 3000.0));
        let stiffness = [lateral, 0.0, 0.0, 0.0, lateral, 0.0, 0.0, 0.0, axial];
        let damping = stiffness.map(|k| if trial % 2 == 0 { 0.0 } else { 1e-4 * k });
        let model = dense(&[jd, 0.0, 0.0, 0.0, jd, 0.0, 0.0, 0.0, m], &stiffness)
            .damping(&damping)
            .set(MatrixKind::Gyroscopic, &[0.0, -jp, 0.0, jp, 0.0, 0.0, 0.0, 0.0, 0.0])
            .speed(Speed::Fixed(next(0.5, 50.0)))
            .build();
        let found = damped_modes(&model, 0, LinearContacts::Free, 3, &mut Hooks::default()).unwrap();
        let own = (axial / m).sqrt();
        let distance = |k: &usize| (found.omega(*k) - own).abs();
        let at = (0..3).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
        let mut directions = found.direction.clone();
        assert_eq!(directions.remove(at), 0, "trial {trial}: {:?}", found.direction);
        assert_eq!(directions, [-1, 1], "trial {trial}");
    }
}

#[test]
fn a_torsional_chain_beside_a_disk_has_no_whirl_and_neither_have_its_crossings() {
    let mut model = Model::new(4).unwrap();
    let mut set = |kind, entries: &[(usize, usize, f64)]| {
        let mut a = [0.0; 16];
        for &(i, j, v) in entries {
            a[4 * j + i] = v;
        }
        model.set_matrix(kind, &MatrixView::dense(4, &a)).unwrap();
    };
    set(MatrixKind::Mass, &[(0, 0, 0.3), (1, 1, 0.3), (2, 2, 0.2), (3, 3, 0.1)]);
    let chain = [(2, 2, 500.0), (2, 3, -200.0), (3, 2, -200.0), (3, 3, 300.0)];
    set(
        MatrixKind::Stiffness,
        &[&[(0, 0, 900.0), (1, 1, 900.0)], &chain[..]].concat(),
    );
    set(MatrixKind::Gyroscopic, &[(0, 1, 0.2), (1, 0, -0.2)]);
    model.set_speed(Speed::Fixed(10.0)).unwrap();
    let found = damped_modes(&model, 0, LinearContacts::Free, 4, &mut Hooks::default()).unwrap();
    // ω² of [[500, −200], [−200, 300]] with the masses 0.2 and 0.1: 2750 ∓ √(250² + 200²/0.02).
    let first = (2750.0 - 1000.0 * 2.0625_f64.sqrt()).sqrt();
    for k in 0..4 {
        let is_lateral = (found.omega(k) / 54.772 - 1.0).abs() < 0.1 && found.direction[k] != 0;
        assert!(is_lateral || found.direction[k] == 0);
    }
    assert_eq!(
        found.direction.iter().filter(|d| **d == 0).count(),
        2,
        "{:?}",
        found.direction
    );
    assert!((0..4).any(|k| (found.omega(k) / first - 1.0).abs() < 1e-12 && found.direction[k] == 0));

    // A disk with an axial mode: EO 1 meets the backward whirl at √(900/0.8), the axial mode at √2600.
    let model = dense(
        &[0.3, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0, 0.0, 1.0],
        &[900.0, 0.0, 0.0, 0.0, 900.0, 0.0, 0.0, 0.0, 2600.0],
    )
    .set(MatrixKind::Gyroscopic, &[0.0, -0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    .build();
    let speeds: Vec<f64> = (0..25).map(|i| 5.0 * f64::from(i)).collect();
    let diagram = campbell(
        &model,
        &speeds,
        (0, LinearContacts::Stuck, 3),
        &[1],
        &mut Hooks::default(),
    )
    .unwrap();
    let [backward, axial] = diagram.crossings[..] else {
        panic!("{:?}", diagram.crossings)
    };
    assert!((backward.speed - (900.0_f64 / 0.8).sqrt()).abs() < 1e-10 && backward.direction == -1);
    assert!((axial.speed - 2600.0_f64.sqrt()).abs() < 1e-10 && axial.direction == 0);
    // The axial mode has no sense at any speed.
    for (omega, direction) in diagram.omega.iter().zip(&diagram.direction) {
        if (omega / 2600.0_f64.sqrt() - 1.0).abs() < 1e-12 {
            assert_eq!(*direction, 0);
        }
    }
}
