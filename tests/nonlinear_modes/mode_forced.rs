//! A nonlinear mode against the forced response. An undamped structure under the force that does the
//! work of the artificial damping answers with the mode itself; under any other force the frequency
//! at which the response lags by 90° only lies near the backbone.

use crate::common::mode_cases::{Skewed, WaveMatrices, blisk_matrices, damped, damping, delta, follow, harmonic, only};
use crate::common::{
    self, B1, B2, BASE, Blisk, all_harmonics, amplitude_range, harmonics, omega_range, relative_gap, slip,
};
use hbvib::{
    Branch, DampingForm, ForcedOptions, Hooks, ModeChoice, ModeOptions, Model, SolverOptions, Status, forced_response,
};
use nalgebra::DVector;
use num_complex::Complex64;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Forces that balance the artificial damping at a mode's point: F_h = 2Dω·(ihω) M X_h, or
/// ζ·(ihω) K X_h with ζ = 2D/ω.
fn balancing(
    branch: &Branch,
    point: usize,
    form: DampingForm,
    wave: impl Fn(usize) -> WaveMatrices,
) -> Vec<(usize, DVector<Complex64>)> {
    let omega = if point < branch.points() {
        branch.omega()[point]
    } else {
        panic!("points of the curve only")
    };
    let d = damping(branch)[point];
    let force = |&h: &usize| {
        let a = wave(h);
        let x = harmonic(branch, point, h);
        let rate = Complex64::I * (h as f64 * omega);
        let f = match form {
            DampingForm::Mass => &a.mass * x * (rate * 2.0 * d * omega),
            DampingForm::Stiffness => &a.stiffness * x * (rate * 2.0 * d / omega),
        };
        (h, f)
    };
    branch.carried_at(0).unwrap().iter().map(force).collect()
}

/// Largest relative difference between points of the mode and the answers to their forces.
fn compare(
    model: &Model,
    solver: &SolverOptions,
    branch: &Branch,
    form: DampingForm,
    wave: impl Fn(usize) -> WaveMatrices,
) -> f64 {
    let mut worst = 0.0_f64;
    let mut slipping = 0;
    for point in (0..branch.points()).step_by(3) {
        // Without damping the stuck resonance is unbounded.
        if slip(branch, point) <= 0.01 {
            continue;
        }
        slipping += 1;
        let mut model = model.try_clone().unwrap();
        model.clear_forces();
        for (h, force) in balancing(branch, point, form, &wave) {
            for (dof, f) in force.iter().enumerate() {
                model.add_force(dof, h, *f).unwrap();
            }
        }
        let omega = branch.omega()[point];
        let guess = all_harmonics(branch, point);
        let range = ForcedOptions {
            guess: Some(&guess),
            ..omega_range(omega, omega)
        };
        let answer = forced_response(&model, solver, &range, &mut Hooks::default()).unwrap();
        assert_eq!(answer.status(), Status::Ok, "point {point}");
        worst = worst.max(relative_gap(&all_harmonics(&answer, 0), &guess));
    }
    assert!(slipping >= 8, "{slipping} points");
    worst
}

#[test]
fn an_undamped_structure_under_the_balancing_force_answers_with_the_mode() {
    for form in [DampingForm::Mass, DampingForm::Stiffness] {
        for h in [1, 3, 9] {
            // Far into sliding the balancing force tends to a constant, the capacity of friction, and
            // no longer tells the amplitude.
            let range = ModeOptions {
                damping_form: form,
                ..amplitude_range(delta(&BASE).log10() + 2.0, delta(&BASE).log10() + 4.0)
            };
            let model = damped(&BASE, 0.0);
            let branch = follow(&model, &harmonics(h), &range);
            let worst = compare(&model, &harmonics(h), &branch, form, |h| blisk_matrices(&BASE, 0.0, h));
            println!("{form:?}, H = {h}: {worst:.1e}");
            assert!(worst < 1e-9);
        }
    }
}

#[test]
fn the_balancing_force_holds_for_contacts_across_sectors() {
    for engine_order in [5, 19] {
        let skewed = Skewed::new(engine_order);
        let model = skewed.model(false);
        let range = ModeOptions {
            choice: ModeChoice::Index(1),
            ..amplitude_range(-1.0, 2.0)
        };
        let branch = follow(&model, &harmonics(5), &range);
        let worst = compare(&model, &harmonics(5), &branch, DampingForm::Mass, |h| {
            skewed.matrices(h)
        });
        println!("EO {engine_order}: {worst:.1e}");
        assert!(worst < 1e-9);
    }
}

/// Frequency at which the fundamental of `dof` lags behind the force by 90°, by bisection, and the
/// solution there.
fn phase_resonance(model: &Model, solver: &SolverOptions, dof: usize, low: f64, high: f64) -> Branch {
    let (mut low, mut high) = (low, high);
    loop {
        let omega = 0.5 * (low + high);
        let answer = common::solve_at(model, solver, omega);
        let x = harmonic(&answer, 0, 1)[dof];
        // e^{−iφ} turns from 0 at low frequency to −π.
        let lag = -x.arg();
        if (lag - FRAC_PI_2).abs() < 1e-10 || high - low < 1e-12 * high {
            return answer;
        }
        if lag < FRAC_PI_2 && lag > -0.1 {
            low = omega;
        } else {
            high = omega;
        }
    }
}

#[test]
fn under_the_forces_of_the_paper_the_phase_resonance_lies_near_the_backbone() {
    let solver = harmonics(7);
    let model = damped(&BASE, common::BETA);
    for force in [0.2, 1.0, 5.0, 20.0] {
        let forced = Blisk { force, ..BASE }.sector();
        let resonance = phase_resonance(&forced, &solver, B2, TAU * 205.0, TAU * 213.0);
        let x = harmonic(&resonance, 0, 1);
        let wave = blisk_matrices(&BASE, common::BETA, 1);
        let modal = x.dotc(&(&wave.mass * &x)).re.sqrt();
        let at = [modal.log10()];
        let range = ModeOptions {
            at: &at,
            ..amplitude_range(delta(&BASE).log10() + 1.0, delta(&BASE).log10() + 6.0)
        };
        let branch = follow(&model, &solver, &range);
        let (omega, d, point) = only(&branch, 0);
        // Power balance of the mode alone: 2Dω² a = |φᴴF|, the force in phase with the velocity.
        let mode = harmonic(&branch, point, 1);
        let work = force * (mode[B2] + mode[B1]).norm() / modal;
        let by_frequency = omega / resonance.omega()[0] - 1.0;
        let by_force = 2.0 * d * omega * omega * modal / work - 1.0;
        let shape = (harmonic(&branch, point, 1)[B2].norm() / x[B2].norm() - 1.0).abs();
        println!(
            "F = {force} N: 90° lag at {:.6} Hz, backbone off by {by_frequency:.1e}, force by {by_force:.1e}, |b2| by {shape:.1e}; D = {d:.6}, slip {:.2}",
            resonance.omega()[0] / TAU,
            slip(&resonance, 0)
        );
        assert!(by_frequency.abs() < 1e-2 * d && by_force.abs() < 1e-2 && shape < 1e-3);
    }
}
