//! Missions: cycles, amplitudes and damage over speeds against time.

use crate::common::chains::rubbing_mass;
use crate::common::models::unit_chain;
use crate::common::{amplitude_range, at_dof, harmonics, omega_range};
use hbvib::{
    Branch, CampbellResponseOptions, Hooks, Interrupt, MissionOptions, ModeChoice, ModeOptions, Model, RunUpOptions,
    Status, SweepOptions, Woehler, campbell_response, forced_response, mission, nonlinear_mode, run_up, sweep,
};
use std::f64::consts::TAU;

fn mode(model: &Model) -> Branch {
    let solver = harmonics(5);
    let range = amplitude_range(-2.0, 0.8);
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
    let model = rubbing_mass(0.01);
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
    let model = rubbing_mass(0.12);
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
    let model = rubbing_mass(0.12);
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

/// Masses in a row with three sliders.
fn chain(n: usize) -> Model {
    unit_chain(n)
        .rayleigh(0.0, 0.02)
        .slider(0, 0.2, 0.1, 0.5)
        .slider(2, 0.1, 0.1, 0.3)
        .slider(n - 1, 0.2, 0.1, 0.5)
        .force(n - 1, 1, 0.05)
        .build()
}

/// A speed that rises at ten thousand points through the resonances of five modes: the missions of all of them, whose modes are known.
#[test]
fn five_modes_over_ten_thousand_points() {
    let model = chain(5);
    let solver = at_dof(4, harmonics(3));
    let modes: Vec<Branch> = (0..5)
        .map(|mode| {
            let range = ModeOptions {
                choice: ModeChoice::Index(mode),
                ..amplitude_range(-3.0, 1.0)
            };
            nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap()
        })
        .collect();
    let count = 10_000;
    let times: Vec<f64> = (0..count).map(|i| 50.0 * f64::from(i)).collect();
    let speeds: Vec<f64> = (0..count)
        .map(|i| 1.3 - 1.0 * (0.5 * TAU * f64::from(i) / f64::from(count)).cos())
        .collect();
    let options = MissionOptions {
        times: &times,
        speeds: &speeds,
        engine_order: 1.0,
        dof: None,
        edges: &[0.1, 0.2, 0.5],
        stresses: &[100.0],
        woehler: Some(LINE),
        synthesis: hbvib::SynthesisOptions::default(),
    };
    let begin = std::time::Instant::now();
    let found: Vec<_> = modes
        .iter()
        .map(|mode| mission(mode, &model, &options, &Interrupt::none()).unwrap())
        .collect();
    let took = begin.elapsed();
    let steps: usize = found.iter().map(|one| one.steps).sum();
    println!("five modes over {count} points: {steps} steps, {took:?}");
    for one in &found {
        assert_eq!(one.crossings.len(), 1, "{:?}", one.crossings);
        let all: f64 = one.cycles.iter().sum();
        let wanted: f64 = (1..times.len())
            .map(|i| 25.0 * (speeds[i] + speeds[i - 1]))
            .sum::<f64>()
            / TAU;
        assert!((all / wanted - 1.0).abs() < 1e-9);
    }
    // Work, not time, which the machine may not have: a second is some five million steps.
    assert!(steps < 1_000_000, "{steps} steps");
}

/// Resonances of a Campbell diagram are the peaks of forced responses under their forces, passages are those of sweeps in time, to the
/// harmonics that a mission leaves out and to its slider without memory.
#[test]
fn resonances_of_a_diagram_are_peaks_and_sweeps() {
    let model = rubbing_mass(0.12);
    let branch = mode(&model);
    let (order, factors) = (2.0, [0.5, 1.0]);
    for acceleration in [0.0, 5e-4, -5e-4] {
        let options = CampbellResponseOptions {
            engine_order: order,
            acceleration,
            force_factors: &factors,
            ..CampbellResponseOptions::default()
        };
        let found = campbell_response(&branch, &model, &options, &Interrupt::none()).unwrap();
        for (one, factor) in found.iter().zip(factors) {
            let forced = rubbing_mass(0.12 * factor);
            let range = omega_range(0.8, 1.3);
            let solver = harmonics(5);
            let peak = forced_response(&forced, &solver, &range, &mut Hooks::default())
                .unwrap()
                .peaks()[0];
            assert!((one.amplitude / peak.amplitude - 1.0).abs() < 2.0 * one.error.abs() + 1e-6);
            assert!((one.omega / peak.omega - 1.0).abs() < 1e-3 && (order * one.speed / one.omega - 1.0).abs() < 1e-15);
            if acceleration == 0.0 {
                assert!(one.passed.is_nan());
                continue;
            }
            let (low, high) = (0.5, 2.0);
            let in_time = SweepOptions {
                omega_start: if acceleration > 0.0 { low } else { high },
                omega_stop: if acceleration > 0.0 { high } else { low },
                rate: order * f64::abs(acceleration),
                ..SweepOptions::default()
            };
            let truth = sweep(&forced, &in_time, &mut Hooks::default()).unwrap().largest;
            let error = one.passed / truth - 1.0;
            println!("factor {factor}, acceleration {acceleration:e}: {error:+.2e}");
            assert!(
                error.abs() < 0.04,
                "factor {factor}, acceleration {acceleration:e}: {error:.2e}"
            );
        }
    }
}

#[test]
fn bad_missions_are_refused() {
    let model = rubbing_mass(0.12);
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
