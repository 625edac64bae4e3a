//! Resonances of a harmonic within less than one step, with damping ratios down to 1e-6: sweeps with default steps find the peaks that
//! steps of 1e-3 find.

use crate::common::depth::some_of;
use crate::common::models;
use crate::common::{at_dof, harmonics, sweep};
use crate::random_problems::random::Random;
use hbvib::{Branch, Contact, Model, SolverOptions, Special, Status};

/// Masses on springs, the first spring to the ground, with stiffness-proportional damping.
fn chain(masses: &[f64], springs: &[f64], damping: f64) -> Model {
    let springs: Vec<f64> = (0..=masses.len())
        .map(|i| springs.get(i).copied().unwrap_or(0.0))
        .collect();
    let n = masses.len();
    models::chain(masses, &springs)
        .damping(&vec![0.0; n * n])
        .rayleigh(0.0, damping)
        .build()
}

/// The highest peak.
fn highest(branch: &Branch) -> (f64, f64) {
    assert!(matches!(branch.status(), Status::Ok), "{:?}", branch.reason());
    let peaks = branch.peaks().iter().map(|p| (p.omega, p.amplitude));
    peaks.fold((0.0, 0.0), |m, p| if p.1 > m.1 { p } else { m })
}

/// Five masses with a slider, damping ratio 1e-5: harmonic 5 of the friction force resonates with the fourth mode, between points that
/// are smooth. The truth has 63 harmonics and steps of 1e-3.
#[test]
fn a_harmonic_of_a_slider_resonates_within_a_step() {
    let first = 0.367_609_2;
    let mut model = chain(&[1.0; 5], &[1.0; 5], 2e-5 / first);
    model.add_contact(&Contact::jenkins(2, None, 0.3, 0.05, 1.0)).unwrap();
    model.add_force(4, 1, 0.02.into()).unwrap();
    let with = |solver: SolverOptions, upward: bool| {
        let solver = at_dof(4, solver);
        let (from, to) = if upward { (0.8, 1.1) } else { (1.1, 0.8) };
        highest(&sweep(&model, &solver, from * first, to * first, &[]))
    };
    let fine = |highest: usize| SolverOptions {
        step_max: 1e-3,
        ..harmonics(highest)
    };
    let (omega, truth) = with(fine(63), true);
    for upward in [true, false] {
        let (found_at, found) = with(SolverOptions::default(), upward);
        println!("tolerance 1e-3: {found} at {found_at}, truth {truth} at {omega}");
        assert!((found / truth - 1.0).abs() <= 1e-3 && (found_at / omega - 1.0).abs() <= 1e-4);
        let (same_at, same) = with(harmonics(31), upward);
        let (omega, truth) = with(fine(31), upward);
        assert!((same / truth - 1.0).abs() <= 1e-9 && (same_at / omega - 1.0).abs() <= 1e-8);
    }
}

/// A random chain with sliders and stops, the range around one of its first modes and a response.
fn random_chain(number: u64) -> (Model, (f64, f64), usize) {
    let mut random = Random::of(31, number);
    let n = 3 + random.below(7);
    let masses: Vec<f64> = (0..n).map(|_| random.within(0.5, 2.0)).collect();
    let springs: Vec<f64> = (0..n).map(|_| random.within(0.5, 2.0)).collect();
    let (force, at) = (0.02 * random.decade(-0.5, 0.5), random.below(n));
    let bare = chain(&masses, &springs, 0.0);
    let mode = random.below(n.min(3));
    let ratio = random.decade(-6.0, -3.0);
    let first = frequencies(&bare, n)[0];
    let mut model = chain(&masses, &springs, 2.0 * ratio / first);
    for _ in 0..=random.below(3) {
        let (dof, stiffness) = (random.below(n), random.decade(-1.5, 0.7));
        let contact = if random.happens(2.0 / 3.0) {
            Contact::jenkins(dof, None, stiffness, 1.0, force * random.decade(-0.3, 1.0))
        } else {
            Contact::unilateral(Some(dof), None, stiffness, force * random.decade(0.0, 1.0))
        };
        model.add_contact(&contact).unwrap();
    }
    model.add_force(at, 1, force.into()).unwrap();
    let (low, high) = (0.85 * frequencies(&bare, n)[mode], 1.1 * frequencies(&model, n)[mode]);
    let range = if random.happens(0.5) { (low, high) } else { (high, low) };
    (model, range, random.below(n))
}

/// Natural frequencies with stuck sliders.
fn frequencies(model: &Model, count: usize) -> Vec<f64> {
    use hbvib::ContactState;
    model.linear_modes(0, ContactState::Stuck).unwrap().omega[..count].to_vec()
}

/// Whether a peak is among those of a branch, or rises above the points around it by no more than a twentieth.
fn is_found(branch: &Branch, peak: &Special) -> bool {
    let same =
        |p: &Special| (p.omega / peak.omega - 1.0).abs() < 1e-6 && (p.amplitude / peak.amplitude - 1.0).abs() < 1e-4;
    let steps = branch.omega().windows(2).zip(branch.amplitude().windows(2));
    let mut around = steps.filter(|(w, _)| (w[0] - peak.omega) * (w[1] - peak.omega) <= 0.0);
    branch.peaks().iter().any(same) || around.any(|(_, a)| a[0].max(a[1]) > 0.95 * peak.amplitude)
}

/// Chains of 3 to 9 masses with 1 to 3 contacts and damping ratios from 1e-6 to 1e-3, with 9 harmonics: default steps find the highest
/// peak of steps of 1e-3, and of the peaks above 5 % of that all that rise above the points around them by a twentieth.
#[test]
fn the_peaks_of_light_chains_are_those_of_short_steps() {
    let (mut peaks, mut missed, mut points) = (0, 0, (0, 0));
    for number in 0..some_of(25, 80) {
        let (model, (from, to), response) = random_chain(number);
        let solver = at_dof(response, harmonics(9));
        let found = sweep(&model, &solver, from, to, &[]);
        let fine = SolverOptions {
            step_max: 1e-3,
            max_points: 100_000,
            ..solver
        };
        let truth = sweep(&model, &fine, from, to, &[]);
        points = (points.0 + found.points(), points.1 + truth.points());
        let ((at, a), (omega, b)) = (highest(&found), highest(&truth));
        if a < 0.999 * b {
            println!("chain {number}: {a} at {at}, {b} at {omega}");
            missed += 1;
        }
        for peak in truth.peaks().iter().filter(|peak| peak.amplitude > 0.05 * b) {
            peaks += 1;
            if !is_found(&found, peak) {
                println!("chain {number}: no {} at {}, highest {b}", peak.amplitude, peak.omega);
                missed += 1;
            }
        }
    }
    println!("{missed} of {peaks} peaks missed, {points:?} points");
    assert_eq!(missed, 0);
}

/// Masses that light springs couple, the first on a stiff spring to the ground with a cubic spring or a slider, a force on the second:
/// several resonances lie within one step of a sweep over all of them.
fn light_chain(number: u64) -> (Model, (f64, f64)) {
    let mut random = Random::of(97, number);
    let n = 3 + random.below(4);
    let masses: Vec<f64> = (0..n).map(|_| random.within(0.5, 2.0)).collect();
    let springs: Vec<f64> = (0..n)
        .map(|i| random.within(0.5, 2.0) * if i == 0 { 1.0 } else { random.decade(-2.5, -1.0) })
        .collect();
    let force = random.decade(-2.0, 0.0);
    let mut model = chain(&masses, &springs, random.decade(-3.0, -1.0));
    let contact = if random.happens(0.5) {
        Contact::cubic(0, None, 0.0, random.decade(-4.0, -1.0))
    } else {
        Contact::jenkins(0, None, random.within(0.1, 2.0), 1.0, force * random.decade(-1.0, 1.0))
    };
    model.add_contact(&contact).unwrap();
    model.add_force(1, 1, force.into()).unwrap();
    let omega = frequencies(&model, n);
    (model, (0.5 * omega[0], 1.2 * omega[n - 1]))
}

/// Sweeps upwards and downwards with 1, 3 and 5 harmonics have the same peaks above 2 % of the highest one. A light chain is linear but for
/// its first mass: the number of harmonics moves no peak by a tenth of a percent.
#[test]
fn sweeps_of_light_chains_agree_on_their_peaks() {
    let (mut peaks, mut missed) = (0, 0);
    for number in 0..some_of(60, 400) {
        let (model, (low, high)) = light_chain(number);
        let mut sweeps = Vec::new();
        for count in [1, 3, 5] {
            let solver = SolverOptions {
                response_dof: Some(1),
                ..harmonics(count)
            };
            for (from, to) in [(low, high), (high, low)] {
                let branch = sweep(&model, &solver, from, to, &[]);
                assert!(matches!(branch.status(), Status::Ok), "{:?}", branch.reason());
                sweeps.push(branch);
            }
        }
        let top = sweeps.iter().map(highest).fold(0.0, |top, peak| peak.1.max(top));
        for peak in sweeps
            .iter()
            .flat_map(Branch::peaks)
            .filter(|p| p.amplitude > 0.02 * top)
        {
            for (i, other) in sweeps.iter().enumerate() {
                peaks += 1;
                let same = |p: &Special| (p.omega / peak.omega - 1.0).abs() < 0.02;
                if !other.peaks().iter().any(same) {
                    println!(
                        "chain {number}, sweep {i}: no {} at {}, highest {top}",
                        peak.amplitude, peak.omega
                    );
                    missed += 1;
                }
            }
        }
    }
    println!("{missed} of {peaks} peaks missed");
    assert!(peaks > 0 && missed == 0);
}
