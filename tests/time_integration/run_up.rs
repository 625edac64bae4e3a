//! Sweeps of the frequency in time, against stored runs by Taylor series with events and by DOP853, and closed limits.

use crate::common::chains::rubbing_mass;
use crate::common::models::{dense, oscillator};
use crate::common::{data, number};
use hbvib::{Contact, Hooks, Model, Status, SweepOptions, TimeOptions, sweep, time_response};

/// The largest displacement to 1e-9 and its frequency, in both senses. That of the frequency is known to half of the digits alone.
#[test]
fn runs_through_a_resonance_are_those_of_stored_ones() {
    let runs = &data("run_up.json")["runs"];
    for (case, friction, force, range) in [
        ("linear", false, 0.05, (0.8, 1.2)),
        ("friction", true, 0.05, (0.85, 1.3)),
        ("friction_strong", true, 0.12, (0.8, 1.3)),
    ] {
        let smooth = oscillator(1.0, 1.0).damping(&[0.02]).force(0, 1, force).build();
        let model = if friction { rubbing_mass(force) } else { smooth };
        for (text, rate) in [("0.01", 0.01), ("-0.01", -0.01), ("0.001", 0.001), ("-0.001", -0.001)] {
            let wanted = &runs[format!("{case} {text}").as_str()];
            let (omega_start, omega_stop) = if rate > 0.0 { range } else { (range.1, range.0) };
            let options = SweepOptions {
                omega_start,
                omega_stop,
                rate: f64::abs(rate),
                ..SweepOptions::default()
            };
            let found = sweep(&model, &options, &mut Hooks::default()).unwrap();
            assert_eq!(found.status, Status::Ok);
            let largest = number(&wanted["max"]);
            let error = (found.largest - largest).abs() / largest;
            assert!(
                error <= 1e-9,
                "{case} {text}: {} is not {largest}, error {error:.2e}",
                found.largest
            );
            let omega = number(&wanted["frequency"]);
            assert!(
                (found.largest_omega - omega).abs() < 1e-4,
                "{case} {text}: {} is not {omega}",
                found.largest_omega
            );
            assert_eq!(
                Some(found.events as u64),
                wanted["events"].as_u64(),
                "{case} {text}: changes"
            );
            let highest = found.turns.iter().map(|turn| turn.amplitude).fold(0.0, f64::max);
            assert_eq!(highest.to_bits(), found.largest.to_bits());
        }
    }
}

/// A very slow sweep over a narrow range vibrates as the periodic motion of its middle does, a smooth law as well as friction.
#[test]
fn a_slow_sweep_is_nearly_periodic() {
    let mut smooth = oscillator(1.0, 1.0).damping(&[0.02]).force(0, 1, 0.05).build();
    smooth.add_contact(&Contact::cubic(0, None, 0.0, 0.3)).unwrap();
    for model in [rubbing_mass(0.12), smooth] {
        let options = SweepOptions {
            omega_start: 0.9,
            omega_stop: 0.9001,
            rate: 1e-6,
            ..SweepOptions::default()
        };
        let found = sweep(&model, &options, &mut Hooks::default()).unwrap();
        let steady = TimeOptions {
            omega: 0.90005,
            samples: 4096,
            ..TimeOptions::default()
        };
        let steady = time_response(&model, &steady, &mut Hooks::default()).unwrap();
        let size = steady.samples.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let middle = found.turns[found.turns.len() / 2];
        assert!(
            (middle.amplitude / size - 1.0).abs() < 1e-4,
            "{} is not {size}",
            middle.amplitude
        );
        // Turns are those of the phase.
        let phase = (0.90005 * 1e-4 / 1e-6) / std::f64::consts::TAU;
        assert_eq!(found.turns.len(), phase.ceil() as usize);
    }
}

#[test]
fn bad_sweeps_are_refused() {
    let model = rubbing_mass(0.05);
    let options = SweepOptions {
        omega_start: 0.9,
        omega_stop: 1.1,
        rate: 1e-2,
        ..SweepOptions::default()
    };
    let refused = |model: &Model, options: SweepOptions<'_>, status: Status, words: &str| {
        let error = sweep(model, &options, &mut Hooks::default()).unwrap_err();
        assert_eq!(error.status, status, "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    refused(
        &model,
        SweepOptions { rate: 0.0, ..options },
        Status::Argument,
        "rate = 0",
    );
    refused(
        &model,
        SweepOptions { rate: 1e-12, ..options },
        Status::Argument,
        "turns",
    );
    refused(&model, SweepOptions { dof: 1, ..options }, Status::Index, "dof = 1");
    refused(
        &model,
        SweepOptions {
            omega_stop: f64::NAN,
            ..options
        },
        Status::NotFinite,
        "omega_stop",
    );
    let mut unbalanced = dense(&[1.0, 0.0, 0.0, 1.0], &[1.0, 0.0, 0.0, 1.0]).build();
    unbalanced.add_unbalance(0, 1, 0.1, 0.0).unwrap();
    refused(&unbalanced, options, Status::Unsupported, "unbalance");
    let mut stopping = |state: &hbvib::Progress| state.point >= 3;
    let mut hooks = Hooks {
        progress: Some(&mut stopping),
        ..Hooks::default()
    };
    let found = sweep(&model, &SweepOptions { rate: 1e-3, ..options }, &mut hooks).unwrap();
    assert_eq!((found.status, found.turns.len()), (Status::StoppedByCaller, 3));
}
