//! Speed of rotation: gyroscopic matrices, stiffness and normal loads that grow with its square, unbalance; the speed
//! fixed or tied to the frequency. Against models with the same numbers in plain matrices, dense solutions, finite
//! differences and integration in time.

use crate::common::models::rotor;
use crate::common::{BASE, Blisk, all_harmonics, data, harmonics, number, relative_gap, solve_at, sweep};
use hbvib::internals::Condensed;
use hbvib::internals::HarmonicBalance;
use hbvib::internals::{Problem, Residual};
use hbvib::{
    Constant, Contact, ContactState, Hooks, Interrupt, MatrixKind, MatrixView, Model, Part, SolverOptions, Speed,
    Status, TimeOptions, forced_residual, time_response,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

const N: usize = 4;
const M: [f64; 16] = [
    1.0, 0.0, 0.0, 0.0, 0.0, 1.1, 0.0, 0.0, 0.0, 0.0, 0.6, 0.1, 0.0, 0.0, 0.1, 0.7,
];
const C: [f64; 16] = [
    0.02, 0.0, 0.0, 0.0, 0.0, 0.03, 0.0, 0.0, 0.0, 0.0, 0.02, 0.0, 0.0, 0.0, 0.0, 0.01,
];
const K: [f64; 16] = [
    3.0, -1.0, 0.2, 0.0, -1.0, 4.0, -0.5, 0.1, 0.2, -0.5, 5.0, -1.0, 0.0, 0.1, -1.0, 3.5,
];
/// Column-major, skew-symmetric.
const G: [f64; 16] = [
    0.0, 0.5, 0.0, -0.2, -0.5, 0.0, 0.3, 0.0, 0.0, -0.3, 0.0, 0.4, 0.2, 0.0, -0.4, 0.0,
];
const K1: [f64; 16] = [
    -0.2, 0.05, 0.0, 0.0, 0.05, -0.1, 0.0, 0.0, 0.0, 0.0, 0.15, 0.02, 0.0, 0.0, 0.02, -0.05,
];
/// Couplings to the next sector, without symmetry.
const NEXT: [f64; 16] = [
    -0.3, 0.1, 0.0, 0.0, 0.0, -0.2, 0.05, 0.0, 0.0, 0.0, -0.1, 0.0, 0.02, 0.0, 0.0, -0.25,
];
const G_NEXT: [f64; 16] = [
    0.05, 0.1, 0.0, 0.0, -0.02, 0.0, 0.0, 0.03, 0.0, 0.0, 0.04, 0.0, 0.0, 0.0, 0.01, 0.0,
];

/// Contacts, with the load at rest and its growth with the square of the speed.
fn contacts() -> Vec<(Contact, f64, f64)> {
    vec![
        (Contact::jenkins(0, Some(1), 2.0, 0.4, 0.2), 0.2, 0.3),
        (Contact::jenkins(3, None, 1.0, 0.5, 0.1), 0.0, 0.25),
        (Contact::unilateral(Some(2), None, 1.5, 0.4), 0.0, 0.5),
        (
            Contact::friction_2d([Some(1), Some(2)], [None, None], (1.0, 1.2), 0.3, 0.3),
            0.1,
            0.4,
        ),
        (Contact::regularised(0, None, 0.5, 0.1, 0.3), 0.1, 0.2),
    ]
}

fn set(model: &mut Model, which: MatrixKind, a: &[f64], part: Part) {
    model.set_matrix(which, &MatrixView::dense(N, a).part(part)).unwrap();
}

/// A model, plain or cyclic, that knows its speed.
fn rotating(sectors: usize, engine_order: i64, speed: Speed) -> Model {
    let mut model = Model::cyclic(N, sectors).unwrap();
    model.set_wave(engine_order);
    set(&mut model, MatrixKind::Mass, &M, Part::Full);
    set(&mut model, MatrixKind::Damping, &C, Part::Full);
    set(&mut model, MatrixKind::Stiffness, &K, Part::Full);
    set(&mut model, MatrixKind::Gyroscopic, &G, Part::Full);
    set(&mut model, MatrixKind::StiffnessSpeed2, &K1, Part::Full);
    if sectors > 1 {
        for (which, next) in [
            (MatrixKind::Stiffness, NEXT.to_vec()),
            (MatrixKind::StiffnessSpeed2, NEXT.iter().map(|k| 0.1 * k).collect()),
            (MatrixKind::Gyroscopic, G_NEXT.to_vec()),
        ] {
            model.set_coupling(which, &MatrixView::dense(N, &next)).unwrap();
        }
    }
    model.set_rayleigh(0.01, 0.02).unwrap();
    for (contact, preload, per_speed2) in contacts() {
        let id = model.add_contact(&contact).unwrap();
        model.set_preload_at_speed(id, preload, per_speed2).unwrap();
    }
    model.set_speed(speed).unwrap();
    model.add_force(0, 1, Complex64::new(0.8, 0.3)).unwrap();
    model.add_force(2, 2, 0.2.into()).unwrap();
    model.add_unbalance(1, 3, 0.3, 0.7).unwrap();
    model
}

/// The same at one speed and frequency, with all numbers in plain matrices, contacts and forces.
fn plain(sectors: usize, engine_order: i64, speed: f64, omega: f64) -> Model {
    let mut model = Model::cyclic(N, sectors).unwrap();
    model.set_wave(engine_order);
    let (alpha, beta) = (0.01, 0.02);
    let sum = |terms: &[(f64, &[f64])]| -> Vec<f64> {
        (0..N * N).map(|i| terms.iter().map(|(c, a)| c * a[i]).sum()).collect()
    };
    let transposed = |a: &[f64]| -> Vec<f64> { (0..N * N).map(|i| a[(i % N) * N + i / N]).collect() };
    set(&mut model, MatrixKind::Mass, &M, Part::Full);
    let damping = sum(&[(1.0, &C), (alpha, &M), (beta, &K), (speed, &G)]);
    set(&mut model, MatrixKind::Damping, &damping, Part::General);
    let stiffness = sum(&[(1.0, &K), (speed * speed, &K1)]);
    set(&mut model, MatrixKind::Stiffness, &stiffness, Part::Full);
    if sectors > 1 {
        let stiffness = sum(&[(1.0 + 0.1 * speed * speed, &NEXT)]);
        model
            .set_coupling(MatrixKind::Stiffness, &MatrixView::dense(N, &stiffness))
            .unwrap();
        let next = sum(&[(beta, &NEXT), (speed, &G_NEXT)]);
        let previous = sum(&[(beta, &transposed(&NEXT)), (-speed, &transposed(&G_NEXT))]);
        model
            .set_coupling(MatrixKind::Damping, &MatrixView::dense(N, &next))
            .unwrap();
        model
            .set_coupling_previous(MatrixKind::Damping, &MatrixView::dense(N, &previous))
            .unwrap();
    }
    for (contact, preload, per_speed2) in contacts() {
        let preload = preload + per_speed2 * speed * speed;
        model
            .add_contact(&contact.with(Constant::Preload, preload).unwrap())
            .unwrap();
    }
    model.add_force(0, 1, Complex64::new(0.8, 0.3)).unwrap();
    model.add_force(2, 2, 0.2.into()).unwrap();
    let unbalance = Complex64::from_polar(0.3 * omega * omega, 0.7);
    model.add_force(1, 1, unbalance).unwrap();
    model.add_force(3, 1, unbalance * -Complex64::I).unwrap();
    model
}

fn many(highest: usize) -> SolverOptions {
    SolverOptions {
        keep_even_harmonics: true,
        ..harmonics(highest)
    }
}

#[test]
fn a_rotating_model_is_that_of_its_matrices_at_the_speed() {
    for (sectors, engine_order) in [(1, 0), (12, 1), (12, -5), (12, 11), (12, 6)] {
        for omega in [0.7, 1.4, 2.3] {
            for speed in [Speed::Fixed(0.8), Speed::PerOmega(0.5), Speed::PerOmega(-1.0 / 3.0)] {
                let known = plain(sectors, engine_order, speed.at(omega), omega);
                let model = rotating(sectors, engine_order, speed);
                let (a, b) = (solve_at(&model, &many(5), omega), solve_at(&known, &many(5), omega));
                let (x, y) = (all_harmonics(&a, 0), all_harmonics(&b, 0));
                let gap = relative_gap(&x, &y);
                assert!(
                    gap < 1e-8,
                    "{sectors} sectors, EO {engine_order}, {speed:?}, ω = {omega}: {gap:e}"
                );
                let (e, f) = (a.energy_at(0).unwrap(), b.energy_at(0).unwrap());
                for (e, f) in [
                    (e.structural_loss, f.structural_loss),
                    (e.friction_loss, f.friction_loss),
                    (e.potential_mean, f.potential_mean),
                    (e.potential_peak, f.potential_peak),
                ] {
                    assert!((e - f).abs() < 1e-7 * f.abs().max(1e-3), "{e} {f}");
                }
                for contact in 0..contacts().len() {
                    let (s, t) = (
                        a.contact_summary(0, contact).unwrap(),
                        b.contact_summary(0, contact).unwrap(),
                    );
                    assert!((s.work - t.work).abs() < 1e-6 * t.work.abs().max(1e-2));
                    assert!((s.load_max - t.load_max).abs() < 1e-7 * t.load_max.abs().max(1.0));
                }
            }
        }
    }
}

#[test]
fn matrices_per_diameter_are_those_of_the_blocks() {
    for engine_order in [0, 2, -2, 5, 10] {
        let speed = Speed::PerOmega(0.5);
        let blocks = rotating(12, engine_order, speed);
        let mut model = blocks.try_clone().unwrap();
        let mut of_waves = Model::cyclic(N, 12).unwrap();
        of_waves.set_wave(engine_order);
        for which in [
            MatrixKind::Mass,
            MatrixKind::Damping,
            MatrixKind::Stiffness,
            MatrixKind::Gyroscopic,
            MatrixKind::StiffnessSpeed2,
        ] {
            for d in 0..=6 {
                let mut dense = vec![Complex64::ZERO; N * N];
                blocks
                    .structure()
                    .diameter_matrix(which, d)
                    .unwrap()
                    .add_to_dense(Complex64::ONE, &mut dense);
                let view = MatrixView::dense_complex(N, &dense);
                of_waves.set_diameter(which, d, &view).unwrap();
            }
        }
        for (contact, preload, per_speed2) in contacts() {
            let id = of_waves.add_contact(&contact).unwrap();
            of_waves.set_preload_at_speed(id, preload, per_speed2).unwrap();
        }
        of_waves.set_speed(speed).unwrap();
        for m in [&mut of_waves, &mut model] {
            m.clear_forces();
            m.add_force(0, 1, Complex64::new(0.8, 0.3)).unwrap();
            m.add_unbalance(1, 3, 0.3, 0.7).unwrap();
        }
        let (a, b) = (solve_at(&of_waves, &many(4), 1.3), solve_at(&model, &many(4), 1.3));
        let gap = relative_gap(&all_harmonics(&a, 0), &all_harmonics(&b, 0));
        assert!(gap < 1e-8, "EO {engine_order}: {gap:e}");
    }
}

#[test]
fn every_derivative_by_a_frequency_that_sets_the_speed_is_that_of_differences() {
    let random = |i: usize| (1.7 * i as f64 + 0.3).sin();
    for (sectors, engine_order) in [(1, 0), (12, -5)] {
        for speed in [Speed::Fixed(0.8), Speed::PerOmega(0.5), Speed::PerOmega(1.0)] {
            let model = rotating(sectors, engine_order, speed);
            let solver = many(3);
            // The whole residual.
            let size = 4 * N;
            let x: Vec<Complex64> = (0..size)
                .map(|i| Complex64::new(random(2 * i), if i < N { 0.0 } else { random(2 * i + 1) }))
                .collect();
            let omega = 1.2;
            let at = |omega: f64, slope: Option<&mut [Complex64]>| {
                let mut r = vec![Complex64::ZERO; size];
                forced_residual(&model, &solver, omega, &x, &mut r, None, slope).unwrap();
                r
            };
            let mut slope = vec![Complex64::ZERO; size];
            at(omega, Some(&mut slope));
            let h = 1e-5;
            let (up, down) = (at(omega + h, None), at(omega - h, None));
            let differences: Vec<Complex64> = up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect();
            let gap = relative_gap(&slope, &differences);
            assert!(gap < 1e-8, "{sectors} sectors, {speed:?}, whole residual: {gap:e}");
            // The condensed one, which Newton's method solves.
            let condensed = Condensed::new(&model, &solver, omega, &Interrupt::none()).unwrap();
            let interrupt = Interrupt::none();
            let mut problem = HarmonicBalance::new(&condensed, 0, (1.0, 1.5).into(), 0, None, &interrupt).unwrap();
            let n = problem.unknowns();
            let scale = 1.0 / condensed.length();
            let u: Vec<f64> = (0..n).map(|i| scale * random(3 * i)).collect();
            let mut out = Residual::new(n).unwrap();
            problem.evaluate(&u, omega, &mut out).unwrap();
            let slope = out.d_parameter.clone();
            let mut at = |p: f64| {
                problem.evaluate(&u, p, &mut out).unwrap();
                out.values.clone()
            };
            let (up, down) = (at(omega + h), at(omega - h));
            let largest = slope.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for ((up, down), slope) in up.iter().zip(&down).zip(&slope) {
                let difference = (up - down) / (2.0 * h);
                assert!(
                    (difference - slope).abs() < 2e-8 * largest,
                    "{sectors} sectors, {speed:?}, condensed: {difference} {slope}"
                );
            }
        }
    }
}

#[test]
fn a_sweep_with_the_speed_tied_to_the_frequency_passes_the_solutions_of_each_speed() {
    let at = [0.9, 1.25, 1.6, 2.1];
    for sectors in [1, 12] {
        let model = rotating(sectors, 1, Speed::PerOmega(0.5));
        let branch = sweep(&model, &many(3), 0.8, 2.3, &at);
        assert_eq!(branch.status(), Status::Ok);
        for (i, omega) in at.into_iter().enumerate() {
            let [one] = branch.at(i) else {
                panic!("{} solutions", branch.at(i).len())
            };
            let known = solve_at(&plain(sectors, 1, 0.5 * omega, omega), &many(3), omega);
            let gap = relative_gap(&all_harmonics(&branch, one.point), &all_harmonics(&known, 0));
            assert!(gap < 1e-7, "ω = {omega}: {gap:e}");
        }
    }
}

#[test]
fn natural_frequencies_of_a_rotor_split_with_the_speed() {
    for (speed, known) in [
        (1.0, [0.693_911_507, 0.917_055_456, 1.246_325_060, 2.689_847_777]),
        (0.5, [0.785_810_218, 0.892_178_993, 1.418_378_826, 2.145_343_383]),
    ] {
        let mut model = rotor().build();
        model.set_speed(Speed::Fixed(speed)).unwrap();
        let modes = model.linear_modes(0, ContactState::Free).unwrap();
        assert_eq!(modes.omega.len(), 4);
        for (omega, known) in modes.omega.iter().zip(known) {
            assert!((omega - known).abs() < 1e-9, "Ω = {speed}: {omega} {known}");
        }
    }
    // At Ω = ω: one forward critical speed, and the two backward ones.
    let mut model = rotor().build();
    model.set_speed(Speed::PerOmega(1.0)).unwrap();
    let modes = model.linear_modes(0, ContactState::Free).unwrap();
    let forward: Vec<f64> = modes
        .omega
        .iter()
        .zip(modes.shapes.chunks_exact(4))
        // Forward: y follows x by a quarter of a turn.
        .filter(|(_, x)| (x[1] * x[0].conj()).im < 0.0)
        .map(|(omega, _)| *omega)
        .collect();
    assert_eq!(forward.len(), 1, "{:?}", modes.omega);
    assert!((forward[0] - 0.913_522_580_993_896_5).abs() < 1e-12);
}

#[test]
fn an_unbalance_whirls_forward_and_a_stop_bounds_it_as_in_time() {
    let mut model = rotor().build();
    model.set_rayleigh(0.0, 0.03).unwrap();
    model.add_unbalance(0, 1, 0.1, 0.4).unwrap();
    model.set_speed(Speed::PerOmega(1.0)).unwrap();
    // Closed form in z = x + iy: forward whirl alone.
    for omega in [0.5, 0.9, 1.3] {
        let branch = solve_at(&model, &harmonics(1), omega);
        let x = all_harmonics(&branch, 0);
        let damp = |k: f64| Complex64::new(k, 0.03 * k * omega);
        let w2 = omega * omega;
        let (a, b) = (damp(1.0) - w2, damp(0.4));
        let d = damp(0.8) - 0.3 * w2 + 0.5 * w2;
        let force = Complex64::from_polar(0.1 * w2, 0.4);
        let expected = force * d / (a * d - b * b);
        assert!(
            (x[4] / expected - 1.0).norm() < 1e-12,
            "ω = {omega}: {} {expected}",
            x[4]
        );
        assert!((x[5] / (expected * -Complex64::I) - 1.0).norm() < 1e-12);
    }
    // A stop in x, and friction in y whose load grows with the speed.
    model
        .add_contact(&Contact::unilateral(Some(0), None, 3.0, 0.05))
        .unwrap();
    let friction = model.add_contact(&Contact::jenkins(1, None, 0.5, 0.3, 0.0)).unwrap();
    model.set_preload_at_speed(friction, 0.01, 0.1).unwrap();
    for omega in [0.6, 0.85, 1.1] {
        let options = TimeOptions {
            omega,
            harmonics: 5,
            samples: 33,
            ..TimeOptions::default()
        };
        let time = time_response(&model, &options, &mut Hooks::default()).unwrap();
        assert_eq!(time.status, Status::Ok);
        let branch = solve_at(&model, &many(60), omega);
        let x = &all_harmonics(&branch, 0)[..time.harmonics.len()];
        let gap = relative_gap(x, &time.harmonics);
        assert!(gap < 2e-6, "ω = {omega}: {gap:e}");
    }
}

#[test]
fn the_ring_damper_has_the_load_of_its_speed() {
    let reference = data("frf_base.json");
    let curve = &reference["curve_F5"];
    let point = &curve["points"][10];
    let omega = TAU * number(&point["f_Hz"]);
    let mass = number(&curve["m_r_kg"]);
    let mut model = BASE.sector();
    model
        .set_preload_at_speed(0, 0.0, mass * number(&curve["R_m"]))
        .unwrap();
    model
        .set_speed(Speed::Fixed(number(&curve["rpm"]) * TAU / 60.0))
        .unwrap();
    let [re, im] = [0, 1].map(|i| number(&point["hbm"]["7"][i]));
    let x = all_harmonics(&solve_at(&model, &harmonics(7), omega), 0)[4];
    assert!((x / Complex64::new(re, im) - 1.0).norm() < 1e-8);
    // Other speeds of the same model are those of a model with that load.
    for rpm in [1500.0, 2000.0, 4500.0] {
        model.set_speed(Speed::Fixed(rpm * TAU / 60.0)).unwrap();
        let known = Blisk { rpm, ..BASE }.sector();
        let (a, b) = (
            solve_at(&model, &harmonics(7), omega),
            solve_at(&known, &harmonics(7), omega),
        );
        assert!(relative_gap(&all_harmonics(&a, 0), &all_harmonics(&b, 0)) < 1e-10);
    }
    // EO 2 of the rotation itself: the load follows the sweep.
    model.set_speed(Speed::PerOmega(0.5)).unwrap();
    let tied = solve_at(&model, &harmonics(7), omega);
    let rpm = 0.5 * omega * 60.0 / TAU;
    let known = solve_at(&Blisk { rpm, ..BASE }.sector(), &harmonics(7), omega);
    assert!(relative_gap(&all_harmonics(&tied, 0), &all_harmonics(&known, 0)) < 1e-9);
}
