//! Damped modes and the Campbell diagram: Stodola's rotor, eigenvalues of the first-order system by a dense solver,
//! the sense of whirl, crossings with engine orders.

use crate::common::models::{oscillator, rotor};
use crate::common::refusal::refused;
use crate::common::{BASE, Blisk, SECTORS};
use hbvib::{
    Campbell, Contact, ContactState, DampedModes, Hooks, LinearContacts, MatrixKind, MatrixView, Model, Part, Speed,
    Status, Storage, Values, campbell, damped_modes,
};
use nalgebra::DMatrix;
use num_complex::Complex64;

const STODOLA: [(f64, [f64; 4]); 2] = [
    (1.0, [0.693_911_507, 0.917_055_456, 1.246_325_060, 2.689_847_777]),
    (0.5, [0.785_810_218, 0.892_178_993, 1.418_378_826, 2.145_343_383]),
];

fn matrices(model: &mut Model, n: usize, all: &[(MatrixKind, &[f64])]) {
    for (which, a) in all {
        model.set_matrix(*which, &MatrixView::dense(n, a)).unwrap();
    }
}

fn modes(model: &Model, diameter: i64, count: usize) -> DampedModes {
    damped_modes(model, diameter, LinearContacts::Stuck, count, &mut Hooks::default()).unwrap()
}

fn diagram(model: &Model, speeds: &[f64], count: usize, orders: &[i64]) -> Campbell {
    let at = (0, LinearContacts::Stuck, count);
    campbell(model, speeds, at, orders, &mut Hooks::default()).unwrap()
}

#[test]
fn stodolas_rotor_has_its_frequencies_and_its_sense_of_whirl() {
    for (speed, known) in STODOLA {
        for sense in [1.0, -1.0] {
            let mut model = rotor().build();
            model.set_speed(Speed::Fixed(sense * speed)).unwrap();
            let found = modes(&model, 0, 4);
            for (k, known) in known.iter().enumerate() {
                assert!(
                    (found.omega(k) - known).abs() < 1e-9,
                    "Ω = {speed}: {} {known}",
                    found.omega(k)
                );
                assert!(found.damping_ratio(k).abs() < 1e-12);
            }
            let backward_first = [-1, 1, -1, 1].map(|d: i64| d * sense as i64);
            assert_eq!(found.direction, backward_first);
        }
    }
    // At rest the modes come in pairs, whose whirl has no sense.
    let found = modes(&rotor().build(), 0, 4);
    assert_eq!(found.direction, [0; 4]);
    assert!((found.omega(0) - found.omega(1)).abs() < 1e-12);
    // The shapes of a pair are independent.
    let (a, b) = found.shapes.split_at(4);
    let product: Complex64 = a
        .iter()
        .zip(&b[..4])
        .zip([1.0, 1.0, 0.3, 0.3])
        .map(|((a, b), m)| a.conj() * b * m)
        .sum();
    assert!(product.norm() < 0.999, "{product}");
}

#[test]
fn engine_orders_meet_the_modes_at_the_critical_speeds() {
    let speeds: Vec<f64> = (0..=15).map(|i| 0.1 + 0.1 * f64::from(i)).collect();
    let found = diagram(&rotor().build(), &speeds, 4, &[1, 2]);
    assert_eq!(found.omega.len(), speeds.len() * 4);
    let at_half = &found.omega[4 * 4..5 * 4];
    for (omega, known) in at_half.iter().zip(STODOLA[1].1) {
        assert!((omega - known).abs() < 1e-9);
    }
    let forward: Vec<_> = found
        .crossings
        .iter()
        .filter(|c| c.engine_order == 1 && c.direction == 1)
        .collect();
    let [one] = forward[..] else {
        panic!("{:?}", found.crossings)
    };
    assert!((one.speed - 0.913_522_580_993_896_5).abs() < 1e-12, "{}", one.speed);
    for crossing in &found.crossings {
        let mut model = rotor().build();
        model.set_speed(Speed::Fixed(crossing.speed)).unwrap();
        let at = crossing.engine_order as f64 * crossing.speed;
        assert!((crossing.omega / at - 1.0).abs() < 1e-12);
        assert!((0..4).any(|k| (modes(&model, 0, 4).omega(k) / at - 1.0).abs() < 1e-11));
    }
    let orders: Vec<i64> = found.crossings.iter().map(|c| c.engine_order).collect();
    assert!(orders.is_sorted() && orders.contains(&2), "{orders:?}");
}

/// Random numbers in −1 .. 1.
fn random(seed: usize) -> f64 {
    let x = (seed as f64 * 12.9898).sin() * 43_758.545_3;
    2.0 * (x - x.floor()) - 1.0
}

/// A structure with every kind of damping, and its M, C + ΩG and K + Ω²K₁ + i(D + ηK) with springs and contacts.
fn everything(n: usize) -> (Model, [DMatrix<Complex64>; 3]) {
    let mut model = Model::new(n).unwrap();
    let dense = |scale: f64, sign: f64, seed: usize| {
        DMatrix::<f64>::from_fn(n, n, |i, j| {
            let (low, high) = (i.min(j), i.max(j));
            let v = if high - low > 3 {
                0.0
            } else {
                scale * random(seed + low * n + high)
            };
            if i == j && sign < 0.0 {
                0.0
            } else if i > j {
                sign * v
            } else {
                v
            }
        })
    };
    let identity = DMatrix::<f64>::identity(n, n);
    let mass = &identity + dense(0.05, 1.0, 1);
    let damping = dense(0.02, 1.0, 1000) + &identity * 0.1;
    let ramp = DMatrix::from_fn(n, n, |i, j| if i == j { 3.0 + 0.7 * i as f64 } else { 0.0 });
    let stiffness = &ramp + dense(0.5, 1.0, 2000);
    let structural = dense(0.01, 1.0, 3000) + &identity * 0.03;
    let gyroscopic = dense(0.3, -1.0, 4000);
    let softening = dense(0.1, 1.0, 5000);
    let all = [
        (MatrixKind::Mass, &mass),
        (MatrixKind::Damping, &damping),
        (MatrixKind::Stiffness, &stiffness),
        (MatrixKind::Structural, &structural),
        (MatrixKind::Gyroscopic, &gyroscopic),
        (MatrixKind::StiffnessSpeed2, &softening),
    ];
    for (which, a) in all {
        let (mut col_ptr, mut row_idx, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..n {
            for i in (0..n).filter(|&i| a[(i, j)] != 0.0) {
                row_idx.push(i as i64);
                values.push(a[(i, j)]);
            }
            col_ptr.push(row_idx.len() as i64);
        }
        let view = MatrixView {
            storage: Storage::Csc {
                col_ptr: &col_ptr,
                row_idx: &row_idx,
            },
            values: Values::Real(&values),
            ..MatrixView::dense(n, &[])
        };
        let part = if which == MatrixKind::Damping {
            Part::General
        } else {
            Part::Full
        };
        model.set_matrix(which, &view.part(part)).unwrap();
    }
    model.set_rayleigh(0.01, 0.002).unwrap();
    model.set_loss_factor(0.02).unwrap();
    model.set_speed(Speed::Fixed(0.8)).unwrap();
    model.add_contact(&Contact::jenkins(0, Some(1), 2.0, 0.3, 1.0)).unwrap();
    let mut k = (&stiffness + &softening * 0.64).map(Complex64::from)
        + (&structural + &stiffness * 0.02).map(|d| Complex64::new(0.0, d));
    for (i, j, v) in [(0, 0, 2.0), (1, 1, 2.0), (0, 1, -2.0), (1, 0, -2.0)] {
        k[(i, j)] += v;
    }
    let c = damping + &mass * 0.01 + &stiffness * 0.002 + gyroscopic * 0.8;
    (model, [mass.map(Complex64::from), c.map(Complex64::from), k])
}

/// Eigenvalues of the first-order system in the upper half plane, by rising frequency.
pub fn first_order(m: &DMatrix<Complex64>, c: &DMatrix<Complex64>, k: &DMatrix<Complex64>) -> Vec<Complex64> {
    let n = m.nrows();
    let inverse = m.clone().try_inverse().unwrap();
    let mut a = DMatrix::<Complex64>::zeros(2 * n, 2 * n);
    a.view_mut((0, n), (n, n)).fill_with_identity();
    a.view_mut((n, 0), (n, n)).copy_from(&(-&inverse * k));
    a.view_mut((n, n), (n, n)).copy_from(&(-&inverse * c));
    let mut values: Vec<Complex64> = a.schur().unpack().1.diagonal().iter().copied().collect();
    values.retain(|v| v.im > 0.0);
    values.sort_by(|a, b| a.im.total_cmp(&b.im));
    values
}

#[test]
fn damped_eigenvalues_are_those_of_the_first_order_system() {
    for (n, count) in [(5, 5), (30, 30), (130, 8)] {
        let (model, [m, c, k]) = everything(n);
        let found = modes(&model, 0, count);
        assert_eq!(found.count(), count);
        let known = first_order(&m, &c, &k);
        for (a, b) in found.eigenvalue.iter().zip(&known) {
            assert!((a - b).norm() < 1e-9 * b.norm(), "n = {n}: {a} {b}");
        }
        for (lambda, shape) in found.eigenvalue.iter().zip(found.shapes.chunks_exact(n)) {
            let x = nalgebra::DVector::from_column_slice(shape);
            let residual = &m * &x * (lambda * lambda) + &c * &x * *lambda + &k * &x;
            assert!(
                residual.norm() < 1e-9 * (&k * &x).norm(),
                "n = {n}: {:e}",
                residual.norm()
            );
            assert!((x.dotc(&(&m * &x)).re - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn directions_are_the_signs_of_differences_over_the_speed() {
    let (mut model, _) = everything(12);
    // At fixed K₁: without it.
    model
        .set_matrix(MatrixKind::StiffnessSpeed2, &MatrixView::dense(12, &[0.0; 144]))
        .unwrap();
    let found = modes(&model, 0, 12);
    model.set_speed(Speed::Fixed(0.8 + 1e-5)).unwrap();
    let up = modes(&model, 0, 12);
    model.set_speed(Speed::Fixed(0.8 - 1e-5)).unwrap();
    let down = modes(&model, 0, 12);
    for k in 0..12 {
        let change = up.omega(k) - down.omega(k);
        assert_eq!(found.direction[k], change.signum() as i64, "mode {k}: {change:e}");
    }
}

#[test]
fn a_wheel_without_rotation_has_the_modes_of_each_diameter() {
    let base = Blisk {
        engine_order: 3,
        ..BASE
    };
    let model = base.sector();
    for diameter in [0, 1, 5, SECTORS as i64 / 2] {
        let undamped = model.linear_modes(diameter, ContactState::Stuck).unwrap();
        let found = modes(&model, diameter, 4);
        for (k, omega) in undamped.omega.iter().enumerate() {
            // Rayleigh damping leaves out the contact, so that the modulus is that of the undamped mode up to ζ².
            assert!(
                (found.eigenvalue[k].norm() / omega - 1.0).abs() < 1e-4,
                "{} {omega}",
                found.omega(k)
            );
            assert_eq!(found.direction[k], 0);
        }
    }
}

#[test]
fn a_mode_that_grows_is_told_and_bad_input_is_refused() {
    let mut model = rotor().build();
    let mut damping = [0.0; 16];
    damping[0] = -0.01;
    model
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(4, &damping))
        .unwrap();
    let mut lines = Vec::new();
    let mut log = |_: hbvib::LogLevel, line: &str| lines.push(line.to_owned());
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let found = damped_modes(&model, 0, LinearContacts::Free, 4, &mut hooks).unwrap();
    assert!((0..4).any(|k| found.damping_ratio(k) < 0.0));
    assert!(lines.iter().any(|line| line.contains("grows")), "{lines:?}");
    let ask = |diameter, count| damped_modes(&model, diameter, LinearContacts::Free, count, &mut Hooks::default());
    refused(ask(1, 4), Status::Argument, &["diameter = 1", "0 .. 0"]);
    refused(ask(0, 0), Status::Argument, &["count = 0", "at least 1"]);
    let at = (0, LinearContacts::Free, 4);
    let over = |speeds: &[f64], orders: &[i64]| campbell(&model, speeds, at, orders, &mut Hooks::default());
    refused(over(&[], &[1]), Status::Dimension, &["no speeds", "at least 1"]);
    refused(over(&[0.0, f64::NAN], &[1]), Status::NotFinite, &["speeds[1] = NaN"]);
    refused(
        over(&[0.2, 0.1], &[1]),
        Status::Argument,
        &["speeds[1] = 0.1", "more than"],
    );
    refused(
        over(&[0.1, 0.2], &[1, 0]),
        Status::Argument,
        &["engine_orders[1] = 0", "at least 1"],
    );
    model.set_speed(Speed::PerOmega(1.0)).unwrap();
    refused(
        damped_modes(&model, 0, LinearContacts::Free, 4, &mut Hooks::default()),
        Status::Argument,
        &["tied to the frequency", "fixed speed"],
    );
}

#[test]
fn contacts_about_the_static_state_follow_the_load_at_each_speed() {
    // A mass on a spring of 1 with a stop of stiffness 3 beside it, pressed by 1 − Ω²/2: the stop opens at √2.
    let model = oscillator(1.0, 1.0)
        .contact(Contact::unilateral(Some(0), None, 3.0, 0.0))
        .build();
    let frequency = |speed: f64, force: f64| {
        let mut at = model.try_clone().unwrap();
        at.set_preload_at_speed(0, 1.0, -0.5).unwrap();
        at.set_speed(Speed::Fixed(speed)).unwrap();
        at.clear_forces();
        at.add_force(0, 0, force.into()).unwrap();
        damped_modes(&at, 0, LinearContacts::Static, 1, &mut Hooks::default())
            .unwrap()
            .omega(0)
    };
    // The load at rest is N₀ + cΩ², a constant force opens or closes the stop beside it.
    for (speed, force, closed) in [
        (0.0, 0.0, true),
        (2.0, 0.0, false),
        (2.0, -4.0, true),
        (0.0, 4.0, false),
    ] {
        let expected = if closed { 2.0 } else { 1.0 };
        let found = frequency(speed, force);
        println!("speed {speed}, force {force}: {found}");
        assert!((found - expected).abs() < 1e-9);
    }
}

#[test]
fn a_frequency_that_jumps_over_an_engine_order_is_no_crossing() {
    // ω = 2 with the stop closed, up to Ω = √2, then 1: EO 1 is passed by the jump, EO 2 met at Ω = 1.
    let stop = Contact::unilateral(Some(0), None, 3.0, 0.0);
    let mut model = oscillator(1.0, 1.0).contact(&stop).build();
    model.set_preload_at_speed(0, 1.0, -0.5).unwrap();
    let speeds: Vec<f64> = (0..7).map(|i| 0.1 + 0.3 * f64::from(i)).collect();
    let found = campbell(
        &model,
        &speeds,
        (0, LinearContacts::Static, 1),
        &[1, 2],
        &mut Hooks::default(),
    )
    .unwrap();
    let [one] = found.crossings[..] else {
        panic!("{:?}", found.crossings)
    };
    assert_eq!(one.engine_order, 2);
    assert!(
        (one.speed - 1.0).abs() < 1e-12 && (one.omega - 2.0).abs() < 1e-12,
        "{one:?}"
    );
}

#[test]
fn a_mode_that_ceases_to_oscillate_is_crossed_where_it_does_oscillate() {
    // λ² + 1.5 λ + 1 − Ω²/5 = 0: ω² = 0.4375 − Ω²/5 is Ω² at Ω = √(0.4375/1.2), and 0 at Ω = 1.479.
    let mut model = Model::new(2).unwrap();
    matrices(
        &mut model,
        2,
        &[
            (MatrixKind::Mass, &[1.0, 0.0, 0.0, 1.0]),
            (MatrixKind::Damping, &[1.5, 0.0, 0.0, 0.0]),
            (MatrixKind::Stiffness, &[1.0, 0.0, 0.0, 9.0]),
            (MatrixKind::StiffnessSpeed2, &[-0.2, 0.0, 0.0, 0.0]),
        ],
    );
    let expected = (0.4375_f64 / 1.2).sqrt();
    // Between 0 and 2 the mode crosses and ceases in one interval, whose end knows nothing of it.
    for speeds in [vec![0.0, 0.5, 1.0, 1.5, 2.0], vec![0.0, 2.0]] {
        let found = diagram(&model, &speeds, 2, &[1]);
        let [one] = found.crossings[..] else {
            panic!("{:?}", found.crossings)
        };
        assert!((one.speed / expected - 1.0).abs() < 1e-12, "{one:?}");
        assert!((one.omega / expected - 1.0).abs() < 1e-12, "{one:?}");
    }
    // Past the interval in which it ceases, the mode above is met where EO·Ω is its frequency.
    let found = diagram(&model, &[0.0, 2.0, 4.0], 2, &[1]);
    let speeds: Vec<f64> = found.crossings.iter().map(|c| c.speed).collect();
    assert!(
        speeds.len() == 2 && (speeds[0] / expected - 1.0).abs() < 1e-12 && (speeds[1] - 3.0).abs() < 1e-12,
        "{speeds:?}"
    );
}

#[test]
fn modes_that_grow_with_the_speed_are_told_once() {
    let mut model = rotor().build();
    let mut damping = [0.0; 16];
    damping[0] = -0.01;
    matrices(&mut model, 4, &[(MatrixKind::Damping, &damping)]);
    let mut lines = Vec::new();
    let mut log = |_: hbvib::LogLevel, line: &str| lines.push(line.to_owned());
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let at = (0, LinearContacts::Stuck, 4);
    let found = campbell(&model, &[0.0, 0.5, 1.0], at, &[1], &mut hooks).unwrap();
    assert!(found.damping_ratio.iter().any(|ratio| *ratio < -1e-3));
    let told: Vec<&String> = lines.iter().filter(|line| line.contains("grow")).collect();
    assert!(
        told.len() == 1
            && told[0].contains("at 3 of 3 speeds")
            && told[0].contains("the speed 0 has the damping ratio -"),
        "{lines:?}"
    );
}
