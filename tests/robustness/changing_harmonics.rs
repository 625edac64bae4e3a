//! Sweeps along which the tolerance changes the harmonics: no change turns the branch round.

use crate::common::peers::structure;
use crate::common::{at_dof, harmonics, sweep};
use crate::random_problems::random::{Random, from_environment};
use hbvib::internals::eigen;
use hbvib::{Branch, Contact, ContactKind, Interrupt, Model, Polynomial, SolverOptions, Status};
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
    let observed = |solver| at_dof(0, solver);
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

/// Outcome of a sweep by the tolerance beside the fine one with 31 harmonics.
struct Compared {
    slips: bool,
    /// Relative distance of the maxima.
    gap: f64,
    /// Points of both.
    points: [usize; 2],
    failure: Option<String>,
}

fn compare_one(case: &Case, (from, to): (f64, f64)) -> Compared {
    let by_tolerance = at_dof(case.response, SolverOptions::default());
    let fine = |step_max: f64| SolverOptions {
        response_dof: Some(case.response),
        step_max,
        ..harmonics(31)
    };
    let found = sweep(&case.model, &by_tolerance, from, to, &[]);
    let mut truth = sweep(&case.model, &fine(0.015), from, to, &[]);
    let mut points = truth.points();
    let differs = |truth: &Branch| {
        let ends = |b: &Branch| matches!(b.status(), Status::Ok | Status::StoppedStalled);
        if ends(truth) && !ends(&found) {
            return Some(format!("{:?} {:?}", found.status(), found.reason()));
        }
        if (turns(&found), found.folds().len()) != (turns(truth), truth.folds().len()) {
            let of = |b: &Branch| format!("{} turns and {} folds", turns(b), b.folds().len());
            return Some(format!("{}, finely {}", of(&found), of(truth)));
        }
        let gap = (top(&found) / top(truth) - 1.0).abs();
        (gap > 1e-3).then(|| format!("maximum off by {gap:.2e}"))
    };
    let mut failure = differs(&truth);
    if failure.is_some() {
        // Even fine steps pass over narrow peaks and folds.
        truth = sweep(&case.model, &fine(0.004), from, to, &[]);
        points += truth.points();
        failure = differs(&truth);
    }
    Compared {
        slips: found.slip_fraction().iter().any(|&s| s > 0.0),
        gap: (top(&found) / top(&truth) - 1.0).abs(),
        points: [found.points(), points],
        failure,
    }
}

/// Sweeps cases up and down, by the tolerance and with 31 harmonics in fine steps.
fn compare(cases: core::ops::Range<u64>) {
    let (mut slipping, mut worst, mut points) = (0, 0.0_f64, [0, 0]);
    let mut failures = Vec::new();
    for number in cases.clone() {
        let case = case(number);
        let (low, high) = case.range;
        for (from, to) in [(low, high), (high, low)] {
            let compared = compare_one(&case, (from, to));
            slipping += usize::from(compared.slips);
            points = [points[0] + compared.points[0], points[1] + compared.points[1]];
            match compared.failure {
                Some(failure) => {
                    println!("case {number} from {from}: {failure}");
                    failures.push(number);
                }
                None => worst = worst.max(compared.gap),
            }
        }
    }
    let sweeps = 2 * cases.clone().count();
    println!(
        "cases {cases:?}: {sweeps} sweeps, {slipping} with slip, {} differ, worst maximum of the others off by {worst:.1e}; {} and {} points",
        failures.len(),
        points[0],
        points[1]
    );
    assert!(failures.is_empty(), "cases {failures:?}");
}

#[test]
fn random_sweeps_turn_only_where_a_fine_sweep_with_all_harmonics_turns() {
    compare(0..6);
}

/// `HBVIB_FIRST` chooses the first case, `HBVIB_CASES` their number.
#[test]
#[ignore = "minutes"]
fn thousands_of_random_sweeps_turn_only_where_a_fine_sweep_turns() {
    let first = from_environment("HBVIB_FIRST", 0);
    compare(first..first + from_environment("HBVIB_CASES", 1000));
}

/// Three masses with quadratic and cubic stiffness of all their motions. The curve from 0.28 turns back, leaves the range at its start and
/// comes back there to its first point.
fn closed_curve() -> Model {
    let stiffness = [1.993, -1.269, 0.0, -1.269, 1.973, -0.704, 0.0, -0.704, 0.704];
    let mass = [1.934, 0.0, 0.0, 0.0, 0.812, 0.0, 0.0, 0.0, 1.743];
    let mut model = structure(&mass, &stiffness.map(|k| 0.02 * k), &stiffness);
    let quadratic = [
        [0.084, -0.024, 0.0, -0.024, -0.021, -0.078, 0.0, -0.078, -0.054],
        [-0.024, -0.021, -0.078, -0.021, 0.043, -0.025, -0.078, -0.025, -0.019],
        [0.0, -0.078, -0.054, -0.078, -0.025, -0.019, -0.054, -0.019, 0.017],
    ];
    let mut cubic = [0.0; 81];
    for (i, k) in [0.087, 0.084, 0.112].into_iter().enumerate() {
        cubic[40 * i] = k;
    }
    let law = Polynomial::tensors(3, &[], quadratic.as_flattened(), &cubic).unwrap();
    model
        .add_contact(&Contact::over(vec![0, 1, 2], ContactKind::Polynomial(law)))
        .unwrap();
    model.add_force(0, 1, 0.091.into()).unwrap();
    model
}

#[test]
fn a_closed_curve_is_followed_once_whichever_harmonics_a_tolerance_selects() {
    let model = closed_curve();
    let with = |solver: SolverOptions| {
        let solver = SolverOptions {
            max_points: 300,
            ..solver
        };
        let branch = sweep(&model, &solver, 0.28, 1.0, &[]);
        assert_eq!(branch.status(), Status::StoppedClosed, "{:?}", branch.reason());
        let peaks: Vec<_> = branch.peaks().iter().map(|p| (p.omega, p.amplitude)).collect();
        (peaks, branch.folds().len())
    };
    let (truth, folds) = with(harmonics(15));
    assert!(!truth.is_empty() && folds > 0);
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let (peaks, turns) = with(SolverOptions {
            tolerance,
            ..SolverOptions::default()
        });
        assert_eq!(
            (peaks.len(), turns),
            (truth.len(), folds),
            "{tolerance}: {peaks:?}, {truth:?}"
        );
        for (found, exact) in peaks.iter().zip(&truth) {
            let error = (found.0 / exact.0 - 1.0).hypot(found.1 / exact.1 - 1.0);
            assert!(error <= 2.0 * tolerance, "{tolerance}: {found:?}, {exact:?}");
        }
    }
}
