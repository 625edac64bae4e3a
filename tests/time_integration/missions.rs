//! Missions: cycles, amplitudes and damage over speeds against time.

use hbvib::{
    Branch, Contact, Hooks, Interrupt, MatrixKind, MatrixView, MissionOptions, ModeOptions, Model, RunUpOptions,
    SolverOptions, Status, Woehler, mission, nonlinear_mode, run_up,
};
use std::f64::consts::TAU;

fn oscillator(force: f64) -> Model {
    let mut model = Model::new(1).unwrap();
    for (which, value) in [
        (MatrixKind::Mass, 1.0),
        (MatrixKind::Stiffness, 1.0),
        (MatrixKind::Damping, 0.02),
    ] {
        model.set_matrix(which, &MatrixView::dense(1, &[value])).unwrap();
    }
    model.add_contact(&Contact::jenkins(0, None, 0.2, 0.1, 1.0)).unwrap();
    model.add_force(0, 1, force.into()).unwrap();
    model
}

fn mode(model: &Model) -> Branch {
    let solver = SolverOptions {
        harmonics: 5,
        tolerance: 0.0,
        ..SolverOptions::default()
    };
    let range = ModeOptions {
        log10_start: -2.0,
        log10_stop: 0.8,
        ..ModeOptions::default()
    };
    nonlinear_mode(model, &solver, &range, &mut Hooks::default()).unwrap()
}

const LINE: Woehler = Woehler {
    stress: 100.0,
    cycles: 2e6,
    slope: 5.0,
    slope_below: 0.0,
};

/// At a constant speed the damage is that of the steady amplitude, whose closed form is that of an oscillator with a stuck spring.
#[test]
fn a_dwell_has_the_closed_form() {
    let model = oscillator(0.01);
    let branch = mode(&model);
    let omega: f64 = 1.05;
    let options = MissionOptions {
        times: &[0.0, 1e6],
        speeds: &[omega / 2.0; 2],
        engine_order: 2.0,
        dof: None,
        edges: &[1e-6, 1e3],
        stresses: &[5000.0, 0.0],
        woehler: Some(LINE),
        synthesis: hbvib::SynthesisOptions::default(),
    };
    let found = mission(&branch, &model, &options, &Interrupt::none()).unwrap();
    let amplitude = 0.01 / ((1.2 - omega * omega).powi(2) + (0.02 * omega).powi(2)).sqrt();
    for a in &found.amplitude {
        assert!((a / amplitude - 1.0).abs() < 1e-9, "{a} is not {amplitude}");
    }
    let cycles = omega * 1e6 / TAU;
    let damage = cycles * (5000.0 * amplitude / LINE.stress).powi(5) / LINE.cycles;
    assert!(
        (found.damage[0] / damage - 1.0).abs() < 1e-8,
        "{} is not {damage}",
        found.damage[0]
    );
    assert!(found.damage[1] == 0.0 && found.crossings.is_empty());
    assert!((found.cycles[1] / cycles - 1.0).abs() < 1e-12 && found.cycles[0] == 0.0 && found.cycles[2] == 0.0);
}

/// A quick and a slow passage have the amplitudes of run-ups without memory, but for the harmonics that these have; cycles of all classes
/// are those of the phase.
#[test]
fn passages_are_those_of_run_ups() {
    let model = oscillator(0.12);
    let branch = mode(&model);
    for (rate, allowed) in [(1e-2, 1e-2), (1e-3, 1e-2), (1e-5, 3e-3)] {
        let (start, stop) = (0.8, 1.3);
        let length = (stop - start) / rate;
        let edges: Vec<f64> = (1..20).map(|k| 0.1 * f64::from(k)).collect();
        let options = MissionOptions {
            times: &[0.0, length],
            speeds: &[start, stop],
            engine_order: 1.0,
            dof: Some(0),
            edges: &edges,
            stresses: &[],
            woehler: None,
            synthesis: hbvib::SynthesisOptions::default(),
        };
        let found = mission(&branch, &model, &options, &Interrupt::none()).unwrap();
        let slow = RunUpOptions {
            omega_start: start,
            omega_stop: stop,
            rate,
            ..RunUpOptions::default()
        };
        let wanted = run_up(&branch, &model, &slow, &Interrupt::none())
            .unwrap()
            .without_memory;
        assert_eq!(found.crossings.len(), 1, "{:?}", found.crossings);
        println!(
            "rate {rate:e}: {} is {wanted}, {} steps",
            found.crossings[0].amplitude, found.steps
        );
        let error = found.crossings[0].amplitude / wanted - 1.0;
        assert!(
            error.abs() < allowed,
            "rate {rate:e}: {error:.2e}, {} steps",
            found.steps
        );
        let all: f64 = found.cycles.iter().sum();
        let phase = 0.5 * (start + stop) * length / TAU;
        assert!((all / phase - 1.0).abs() < 1e-9, "{all} is not {phase}");
    }
}

/// Ten thousand points in which the frequency passes the resonance five times.
#[test]
fn ten_thousand_points_are_quick() {
    let model = oscillator(0.12);
    let branch = mode(&model);
    let count = 10_000;
    let times: Vec<f64> = (0..count).map(|i| 50.0 * f64::from(i)).collect();
    let speeds: Vec<f64> = (0..count)
        .map(|i| 1.05 - 0.25 * (5.0 * 0.5 * TAU * f64::from(i) / f64::from(count)).cos())
        .collect();
    let options = MissionOptions {
        times: &times,
        speeds: &speeds,
        engine_order: 1.0,
        dof: None,
        edges: &[0.5, 1.0],
        stresses: &[100.0],
        woehler: Some(LINE),
        synthesis: hbvib::SynthesisOptions::default(),
    };
    let begin = std::time::Instant::now();
    let found = mission(&branch, &model, &options, &Interrupt::none()).unwrap();
    let took = begin.elapsed();
    println!("{} steps, {took:?}, {:?}", found.steps, found.crossings);
    assert_eq!(found.crossings.len(), 5);
    assert!(found.damage[0] > 0.0 && found.steps < 1_000_000);
}

#[test]
fn bad_missions_are_refused() {
    let model = oscillator(0.12);
    let branch = mode(&model);
    let options = MissionOptions {
        times: &[0.0, 1.0],
        speeds: &[0.8, 0.9],
        engine_order: 1.0,
        dof: None,
        edges: &[],
        stresses: &[],
        woehler: None,
        synthesis: hbvib::SynthesisOptions::default(),
    };
    let refused = |options: MissionOptions<'_>, status: Status, words: &str| {
        let error = mission(&branch, &model, &options, &Interrupt::none()).unwrap_err();
        assert_eq!(error.status, status, "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    let given = options;
    refused(MissionOptions { times: &[0.0], ..given }, Status::Dimension, "1 times");
    refused(
        MissionOptions {
            times: &[1.0, 1.0],
            ..given
        },
        Status::Argument,
        "times[1] = 1",
    );
    refused(
        MissionOptions {
            speeds: &[0.8, 0.0],
            ..given
        },
        Status::Argument,
        "speeds[1] = 0",
    );
    refused(
        MissionOptions {
            speeds: &[f64::NAN, 1.0],
            ..given
        },
        Status::NotFinite,
        "speeds[0]",
    );
    refused(
        MissionOptions {
            engine_order: 0.0,
            ..given
        },
        Status::Argument,
        "engine_order = 0",
    );
    refused(
        MissionOptions {
            edges: &[1.0, 0.5],
            ..given
        },
        Status::Argument,
        "edges[1]",
    );
    refused(
        MissionOptions {
            stresses: &[1.0],
            ..given
        },
        Status::Argument,
        "Woehler",
    );
    let line = Some(Woehler { slope: 0.0, ..LINE });
    refused(
        MissionOptions { woehler: line, ..given },
        Status::Argument,
        "woehler_slope = 0",
    );
    refused(MissionOptions { dof: Some(1), ..given }, Status::Index, "dof = 1");
}
