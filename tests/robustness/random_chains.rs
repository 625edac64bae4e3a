//! Chains of 34 to 74 masses with other than proportional damping and contacts of four laws: true errors against the tolerance.

use crate::common::models::{chain_stiffness, diagonal};
use crate::common::peers::structure;
use crate::common::{all_harmonics, at_dof, harmonics, omega_range, sweep};
use crate::random_problems::random::{Random, from_environment};
use hbvib::internals::eigen;
use hbvib::{Branch, Contact, ForcedOptions, Hooks, Interrupt, Model, SolverOptions, forced_response};
use nalgebra::DMatrix;
use num_complex::Complex64;

/// Harmonics of the truth.
const TRUTH: usize = 61;

/// Most points of a branch. Some chains with stops have branches of thousands, which are compared as far as they get.
const MOST: usize = 300;

/// Frequencies of each chain at which points are compared.
const COMPARED: usize = 15;

struct Case {
    model: Model,
    range: (f64, f64),
    response: usize,
    tolerance: f64,
}

fn case(number: u64) -> Case {
    let mut random = Random::of(from_environment("HBVIB_SEED", 29), number);
    let n = 34 + random.below(41);
    let springs: Vec<f64> = (0..=n).map(|_| 1e4 * random.within(0.5, 2.0)).collect();
    let mass: Vec<f64> = (0..n).map(|_| random.within(0.5, 2.0)).collect();
    let (mass, stiffness) = (diagonal(&mass), chain_stiffness(&springs));
    let beta = random.decade(-5.0, -3.5);
    let mut damping: Vec<f64> = stiffness.iter().map(|k| beta * k).collect();
    for _ in 0..3 {
        damping[random.below(n) * (n + 1)] += random.decade(-1.0, 1.0);
    }
    let mut model = structure(&mass, &damping, &stiffness);
    let dense = |a: &[f64]| DMatrix::from_iterator(n, n, a.iter().map(|&x| Complex64::from(x)));
    let pairs = eigen::generalised(&dense(&stiffness), &dense(&mass), &Interrupt::none());
    let omega = pairs.unwrap().values[random.below(4)].sqrt();
    let force = random.decade(0.0, 2.0);
    // About the motion at resonance with a damping ratio of 1 %.
    let size = force / (0.01 * omega * omega * (0..n).map(|i| mass[i * (n + 1)]).sum::<f64>());
    for _ in 0..=random.below(8) {
        let a = random.below(n);
        let b = (a + 1 + random.below(n - 1)) % n;
        let partner = Some(b).filter(|_| random.happens(0.5));
        let kt = random.decade(2.5, 4.5);
        let limit = kt * size * random.decade(-1.5, 0.7);
        let contact = match random.below(5) {
            0 | 1 => Contact::jenkins(a, partner, kt, 0.3, limit / 0.3),
            2 => Contact::friction_2d(
                [Some(a), Some(b)],
                [None; 2],
                (kt, kt * random.within(0.3, 2.0)),
                0.3,
                limit / 0.3,
            ),
            3 => Contact::unilateral(Some(a), partner, kt, size * random.decade(-1.0, 0.5)),
            _ => Contact::cubic(a, partner, 0.0, kt / (size * size) * random.decade(-2.0, 0.0)),
        };
        model.add_contact(&contact).unwrap();
    }
    let response = random.below(n);
    model.add_force(response, 1, force.into()).unwrap();
    let (low, high) = (0.85 * omega, 1.2 * omega);
    Case {
        model,
        range: if random.happens(0.5) { (low, high) } else { (high, low) },
        response,
        tolerance: [1e-2, 3e-3, 1e-3][random.below(3)],
    }
}

/// The response in the fundamental with many harmonics, from the motion of a point.
fn truth(case: &Case, branch: &Branch, point: usize) -> Option<Complex64> {
    let omega = branch.omega_at(point)?;
    let mut guess = all_harmonics(branch, point);
    guess.resize((TRUTH + 1) * case.model.ndof(), Complex64::ZERO);
    let range = ForcedOptions {
        guess: Some(&guess),
        ..omega_range(omega, omega)
    };
    let solver = at_dof(case.response, harmonics(TRUTH));
    let found = forced_response(&case.model, &solver, &range, &mut Hooks::default()).ok()?;
    fundamental(&found, 0)
}

fn fundamental(branch: &Branch, point: usize) -> Option<Complex64> {
    let i = branch.carried_at(point)?.iter().position(|&h| h == 1)?;
    Some(branch.response_at(point)?[i])
}

#[test]
#[ignore = "minutes"]
fn points_of_random_chains_are_within_the_tolerance() {
    let count = from_environment("HBVIB_CASES", 60);
    let (mut compared, mut above, mut unknown, mut worst) = (0, 0, 0, (0.0, 0));
    for number in 0..count {
        let case = case(number);
        let (from, to) = case.range;
        let step = (to - from) / (COMPARED + 1) as f64;
        let at: Vec<f64> = (1..=COMPARED).map(|k| from + step * k as f64).collect();
        let solver = SolverOptions {
            tolerance: case.tolerance,
            response_dof: Some(case.response),
            max_points: MOST,
            ..SolverOptions::default()
        };
        let branch = sweep(&case.model, &solver, from, to, &at);
        for point in (0..branch.stored()).filter(|&k| at.contains(&branch.omega_at(k).unwrap())) {
            if !branch.error_estimate_at(point).is_some_and(|e| e <= case.tolerance) {
                unknown += 1;
                continue;
            }
            let exact = truth(&case, &branch, point).unwrap();
            let ratio = (fundamental(&branch, point).unwrap() - exact).norm() / exact.norm() / case.tolerance;
            compared += 1;
            above += usize::from(ratio > 1.0);
            if ratio > worst.0 {
                worst = (ratio, number);
            }
            if ratio > 1.0 {
                println!("case {number}: {ratio:.2} times the tolerance {:.0e}", case.tolerance);
            }
        }
        println!("{number}: {:?}", branch.status());
    }
    println!(
        "{compared} points, {above} above the tolerance, {unknown} unknown or told to be, worst {:.2} times it (case {})",
        worst.0, worst.1
    );
    assert!(compared > 10 * count as usize && unknown * 20 <= compared);
    assert!(100 * above <= compared && worst.0 < 3.0);
}
