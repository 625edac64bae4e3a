//! Responses synthesised from a nonlinear mode against computed ones: how far the shortcut is from the
//! harmonic balance that it stands for.

use crate::common::models::{dense, oscillator};
use crate::common::{B2, BASE, Blisk, amplitude_range, at_dof, harmonics, sweep};
use hbvib::{Branch, Contact, Hooks, ModeOptions, Model, SolverOptions, SynthesisOptions, nonlinear_mode, synthesise};
use num_complex::Complex64;
use std::f64::consts::TAU;

fn mode(model: &Model, solver: &SolverOptions) -> Branch {
    let delta = Blisk::mu() * BASE.preload() / BASE.kt();
    let range = amplitude_range(delta.log10() - 1.0, delta.log10() + 5.0);
    nonlinear_mode(model, solver, &range, &mut Hooks::default()).unwrap()
}

/// Peak of the computed response to `force` newtons, (amplitude, angular frequency).
fn computed(force: f64, solver: &SolverOptions) -> (f64, f64) {
    let forced = Blisk { force, ..BASE }.sector();
    let swept = sweep(&forced, solver, 206.0 * TAU, 212.0 * TAU, &[]);
    let [peak] = swept.peaks() else {
        panic!("{} peaks", swept.peaks().len())
    };
    (peak.amplitude, peak.omega)
}

fn solver(h: usize) -> SolverOptions {
    at_dof(B2, harmonics(h))
}

/// The bounds are a little above what was measured; the theory promises no more than that it is right
/// where one mode answers.
#[test]
fn synthesised_peaks_lie_near_the_computed_ones() {
    for h in [7, 63] {
        let branch = mode(&BASE.sector(), &solver(h));
        for force in [0.2, 1.0, 5.0, 20.0, 50.0] {
            let options = SynthesisOptions {
                force_factor: force / BASE.force,
                ..SynthesisOptions::default()
            };
            let found = synthesise(&branch, &BASE.sector(), &options).unwrap();
            let [peak] = &found.peaks[..] else {
                panic!("{} peaks at {force} N", found.peaks.len())
            };
            let (amplitude, omega) = computed(force, &solver(h));
            let errors = (peak.at.response.norm() / amplitude - 1.0, (peak.at.omega - omega) / TAU);
            println!(
                "H {h}, {force} N: amplitude {:.1e}, frequency {:.1e} Hz",
                errors.0, errors.1
            );
            assert!(errors.0.abs() < 3e-4 && errors.1.abs() < 1e-2, "{errors:?}");
            assert!(peak.rising && !peak.validity.another_mode() && !peak.validity.internal_resonance());
        }
    }
}

/// A mode without the structure's damping takes it from the model: less right, because friction damps
/// the harmonics as well.
#[test]
fn damping_can_be_added_to_an_undamped_mode() {
    let mut undamped = BASE.sector();
    undamped.set_rayleigh(0.0, 0.0).unwrap();
    let branch = mode(&undamped, &solver(7));
    for (force, bound) in [(0.2, 1e-6), (5.0, 1e-3), (20.0, 1e-3)] {
        let (amplitude, _) = computed(force, &solver(7));
        let mut options = SynthesisOptions {
            force_factor: force / BASE.force,
            model_damping: true,
            ..SynthesisOptions::default()
        };
        let with = synthesise(&branch, &BASE.sector(), &options).unwrap().peaks[0];
        assert!((with.at.response.norm() / amplitude - 1.0).abs() < bound);
        // C = βK gives the stuck mode the ratio βω/2 but for the contact, which has no part in it.
        options.model_damping = false;
        options.damping_ratio = with.at.damping_ratio - branch_damping(&branch, with.log10_amplitude);
        let ratio = synthesise(&branch, &BASE.sector(), &options).unwrap().peaks[0];
        assert!((ratio.at.response.norm() / with.at.response.norm() - 1.0).abs() < 1e-6);
    }
}

/// Damping ratio of the mode where its amplitude is wanted: from a run of its own.
fn branch_damping(branch: &Branch, log10: f64) -> f64 {
    let mut undamped = BASE.sector();
    undamped.set_rayleigh(0.0, 0.0).unwrap();
    let range = ModeOptions {
        at: &[log10],
        ..amplitude_range(log10 - 4.0, log10 + 0.1)
    };
    let solver = harmonics(branch.harmonics());
    let exact = nonlinear_mode(&undamped, &solver, &range, &mut Hooks::default()).unwrap();
    exact.mode_at(exact.at(0)[0].point).unwrap().damping_ratio
}

#[test]
fn the_flanks_of_a_linear_mode_are_those_of_one_oscillator() {
    // One mass on a spring, stuck to the ground by a contact that never comes to slip here.
    let model = oscillator(2.0, 3.0)
        .damping(&[0.05])
        .slider(0, 5.0, 1.0, 1e6)
        .force(0, 1, Complex64::new(0.3, 0.4))
        .build();
    let range = amplitude_range(-3.0, 3.0);
    let branch = nonlinear_mode(&model, &harmonics(3), &range, &mut Hooks::default()).unwrap();
    let found = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
    assert!(found.points.len() > 20);
    for point in &found.points {
        // The oscillator's damping force is 2Dω₀·Ω, as is that of C.
        let z = Complex64::new(8.0 - 2.0 * point.omega.powi(2), 0.05 * point.omega);
        let exact = Complex64::new(0.3, 0.4) / z;
        assert!(
            (point.response - exact).norm() < 1e-12 * exact.norm(),
            "{} {exact}",
            point.response
        );
    }
    let [peak] = &found.peaks[..] else { panic!() };
    // Where |z| is least: Ω² = ω₀² − c²/(2m²).
    let least = (4.0 - 0.05_f64.powi(2) / 8.0).sqrt();
    assert!((peak.at.omega / least - 1.0).abs() < 1e-12);
    let z = Complex64::new(8.0 - 2.0 * least * least, 0.05 * least);
    assert!((peak.at.response.norm() * z.norm() / 0.5 - 1.0).abs() < 1e-10);
}

#[test]
fn doubtful_resonances_are_told() {
    // Two equal oscillators, hardly coupled: each lies within the bandwidth of the other.
    let model = dense(&[1.0, 0.0, 0.0, 1.0], &[1.0, -1e-3, -1e-3, 1.0])
        .rayleigh(0.0, 0.02)
        .contact(Contact::cubic(0, None, 0.0, 1.0))
        .force(0, 1, 0.01)
        .build();
    let range = amplitude_range(-3.0, 0.5);
    let branch = nonlinear_mode(&model, &harmonics(5), &range, &mut Hooks::default()).unwrap();
    let found = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
    assert!(!found.peaks.is_empty());
    assert!(found.peaks[0].validity.another_mode(), "{:?}", found.peaks[0].validity);

    // Where an in-phase mode meets the other one 3:1, its amplitude turns and the third harmonic grows.
    let model = dense(&[1.0, 0.0, 0.0, 1.0], &[2.0, -1.0, -1.0, 2.0])
        .rayleigh(0.0, 2e-5)
        .contact(Contact::cubic(0, None, 0.0, 0.5))
        .force(1, 1, 1.0)
        .build();
    let range = amplitude_range(-2.0, 3.0);
    let branch = nonlinear_mode(&model, &harmonics(15), &range, &mut Hooks::default()).unwrap();
    let options = |force_factor| SynthesisOptions {
        force_factor,
        ..SynthesisOptions::default()
    };
    let low = synthesise(&branch, &model, &options(1e-5)).unwrap();
    assert!(!low.peaks.is_empty() && !low.peaks[0].validity.internal_resonance());
    let high = synthesise(&branch, &model, &options(2e-3)).unwrap();
    assert!(!high.peaks.is_empty());
    assert!(
        high.peaks.iter().any(|p| p.validity.internal_resonance()),
        "{:?}",
        high.peaks
    );
}

/// A mode that its caller stops before the first point has nothing to synthesise from, with or without matrices prepared.
#[test]
fn a_mode_without_points_gives_a_response_without_points() {
    for stop_at in [0, 1, 5, 20, 100] {
        let asked = std::cell::Cell::new(0);
        let cancelled = || {
            asked.set(asked.get() + 1);
            asked.get() > stop_at
        };
        let mut hooks = Hooks {
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        let range = amplitude_range(-7.0, -2.0);
        let branch = nonlinear_mode(&BASE.sector(), &solver(7), &range, &mut hooks).unwrap();
        println!("stopped at check {stop_at}: {} points", branch.points());
        let found = synthesise(&branch, &BASE.sector(), &SynthesisOptions::default()).unwrap();
        assert!(found.points.len() == branch.points() && found.peaks.is_empty());
    }
}
