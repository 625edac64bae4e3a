//! Sweeps along which the tolerance changes the harmonics: no change turns the branch round.

use crate::common::peers::structure;
use crate::common::{harmonics, sweep};
use crate::random_problems::random::{Random, from_environment};
use hbvib::contact::Contact;
use hbvib::error::Status;
use hbvib::interrupt::Interrupt;
use hbvib::linalg::eigen;
use hbvib::model::Model;
use hbvib::options::SolverOptions;
use hbvib::results::Branch;
use nalgebra::DMatrix;
use num_complex::Complex64;

/// Three masses with two sliders, whose third natural frequency is three times the excited one.
fn three_masses() -> Model {
    let stiffness = [2.2, -1.0, 0.0, -1.0, 2.1, -1.0, 0.0, -1.0, 1.3];
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let mut model = structure(&mass, &stiffness.map(|k| 0.001 * k), &stiffness);
    model.add_contact(&Contact::jenkins(0, None, 0.3, 1.0, 0.1)).unwrap();
    model.add_contact(&Contact::jenkins(2, None, 0.2, 1.0, 0.05)).unwrap();
    model.add_force(0, 1, 0.2.into()).unwrap();
    model
}

#[test]
fn a_third_harmonic_that_appears_at_its_resonance_does_not_turn_the_branch() {
    let model = three_masses();
    let observed = |solver| SolverOptions {
        response_dof: Some(0),
        ..solver
    };
    for (from, to) in [(0.5, 1.3), (1.3, 0.5)] {
        for solver in [SolverOptions::default(), harmonics(9), harmonics(31)] {
            let branch = sweep(&model, &observed(solver), from, to, &[]);
            assert_eq!(branch.status(), Status::Ok, "from {from}");
            assert!(branch.folds().is_empty() && turns(&branch) == 0, "from {from}");
            let top = branch
                .peaks()
                .iter()
                .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
                .unwrap();
            let near = (top.amplitude - 0.8492).abs() < 5e-5 && (top.omega - 0.6581).abs() < 5e-5;
            assert!(near, "from {from}: {top:?}");
        }
    }
}

/// A chain of 2 to 7 masses with sliders, of which some slip, and a range around one of its resonances.
struct Case {
    model: Model,
    range: (f64, f64),
    response: usize,
}

fn case(number: u64) -> Case {
    let mut random = Random::of(from_environment("HBVIB_SEED", 16), number);
    let n = 2 + random.below(6);
    let mut mass = vec![0.0; n * n];
    let mut stiffness = vec![0.0; n * n];
    let springs: Vec<f64> = (0..=n).map(|_| random.decade(-0.5, 0.5)).collect();
    let end = if random.happens(0.3) { 0.0 } else { springs[n] };
    for i in 0..n {
        mass[i * (n + 1)] = random.decade(-0.3, 0.3);
        stiffness[i * (n + 1)] = springs[i] + if i + 1 < n { springs[i + 1] } else { end };
        if i > 0 {
            stiffness[i * n + i - 1] = -springs[i];
            stiffness[(i - 1) * n + i] = -springs[i];
        }
    }
    let damping = random.decade(-4.0, -2.0);
    let mut model = structure(
        &mass,
        &stiffness.iter().map(|k| damping * k).collect::<Vec<_>>(),
        &stiffness,
    );
    let scale = 0.5 * springs.iter().sum::<f64>() / springs.len() as f64;
    let mut stuck = stiffness.clone();
    for _ in 0..=random.below(4) {
        let a = random.below(n);
        let b = Some(random.below(n)).filter(|&b| b != a && random.happens(0.7));
        let kt = scale * random.decade(-1.0, 0.5);
        model
            .add_contact(&Contact::jenkins(a, b, kt, 1.0, 0.2 * random.decade(-1.0, 0.7)))
            .unwrap();
        stuck[a * (n + 1)] += kt;
        if let Some(b) = b {
            stuck[b * (n + 1)] += kt;
            stuck[a * n + b] -= kt;
            stuck[b * n + a] -= kt;
        }
    }
    model.add_force(random.below(n), 1, 0.2.into()).unwrap();
    let frequencies = |k: &[f64]| {
        let dense = |a: &[f64]| DMatrix::from_iterator(n, n, a.iter().map(|&x| Complex64::from(x)));
        eigen::generalised(&dense(k), &dense(&mass), &Interrupt::none())
            .unwrap()
            .values
    };
    let mode = random.below(n);
    let range = (
        0.6 * frequencies(&stiffness)[mode].sqrt(),
        1.5 * frequencies(&stuck)[mode].sqrt(),
    );
    let response = random.below(n);
    Case { model, range, response }
}

/// Changes of the direction of frequency between neighbouring points.
fn turns(branch: &Branch) -> usize {
    let backwards = |w: &&[f64]| (w[1] - w[0]) * (w[2] - w[1]) < 0.0;
    branch.omega().windows(3).filter(backwards).count()
}

fn top(branch: &Branch) -> f64 {
    let peaks = branch.peaks().iter().map(|p| p.amplitude);
    peaks.chain(branch.amplitude().iter().copied()).fold(0.0, f64::max)
}

/// Sweeps cases up and down, by the tolerance and with 31 harmonics in fine steps.
fn compare(cases: core::ops::Range<u64>) {
    let (mut slipping, mut worst, mut points) = (0, 0.0_f64, [0, 0]);
    for number in cases.clone() {
        let Case {
            model,
            range: (low, high),
            response,
        } = case(number);
        for (from, to) in [(low, high), (high, low)] {
            let by_tolerance = SolverOptions {
                response_dof: Some(response),
                ..SolverOptions::default()
            };
            let fine = SolverOptions {
                response_dof: Some(response),
                step_max: 0.015,
                ..harmonics(31)
            };
            let [found, truth] = [by_tolerance, fine].map(|solver| sweep(&model, &solver, from, to, &[]));
            let ends = |b: &Branch| matches!(b.status(), Status::Ok | Status::StoppedStalled);
            assert!(
                !ends(&truth) || ends(&found),
                "case {number} from {from}: {:?}",
                found.status()
            );
            assert_eq!(turns(&found), turns(&truth), "case {number} from {from}");
            assert_eq!(found.folds().len(), truth.folds().len(), "case {number} from {from}");
            let mut gap = (top(&found) / top(&truth) - 1.0).abs();
            if gap > 1e-3 {
                // Even fine steps pass over narrow peaks.
                let finer = SolverOptions {
                    step_max: 0.004,
                    ..fine
                };
                gap = (top(&found) / top(&sweep(&model, &finer, from, to, &[])) - 1.0).abs();
            }
            assert!(gap <= 1e-3, "case {number} from {from}: maximum off by {gap:e}");
            worst = worst.max(gap);
            slipping += usize::from(found.slip_fraction().iter().any(|&s| s > 0.0));
            points[0] += found.points();
            points[1] += truth.points();
        }
    }
    let sweeps = 2 * (cases.end - cases.start);
    println!(
        "{sweeps} sweeps, {slipping} with slip: worst maximum off by {worst:.1e}; {} and {} points",
        points[0], points[1]
    );
}

#[test]
fn random_sweeps_turn_only_where_a_fine_sweep_with_all_harmonics_turns() {
    compare(0..6);
}

#[test]
#[ignore = "minutes"]
fn thousands_of_random_sweeps_turn_only_where_a_fine_sweep_turns() {
    compare(0..from_environment("HBVIB_CASES", 1000));
}
