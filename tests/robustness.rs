//! Random problems, thousands of them: that cold starts converge, that what is reported as converged is a
//! solution, that sweeps reach their end, that nothing hangs, and that results repeat bit for bit.
//!
//! The problems come from a generator of this test's own with a fixed seed. `HBVIB_SEED` chooses another,
//! `HBVIB_CASES` the number of cold starts: `HBVIB_SEED=7 HBVIB_CASES=20000 cargo test --release --test
//! robustness -- --nocapture`. Sweeps are an eighth as many.

mod common;
#[path = "robustness/law.rs"]
mod law;
#[path = "robustness/problem.rs"]
mod problem;
#[path = "robustness/random.rs"]
mod random;
#[path = "robustness/residual.rs"]
mod residual;

use common::{all_harmonics, harmonics, relative_gap};
use hbvib::analysis::{forced_response, time_response};
use hbvib::branch::Branch;
use hbvib::error::{Error, Status};
use hbvib::hooks::Hooks;
use hbvib::options::{ForcedOptions, SolverOptions, TimeOptions};
use law::LAWS;
use problem::{Case, Known};
use random::from_environment;
use residual::Residual;
use std::collections::BTreeMap;
use std::time::Instant;

/// Highest harmonic.
const H: usize = 5;

/// Relative residual that is asked of a solution.
const BOUND: f64 = 1e-4;

fn seed() -> u64 {
    from_environment("HBVIB_SEED", 20_261_121)
}

fn cases() -> u64 {
    from_environment("HBVIB_CASES", 2_000)
}

/// A cold start at the frequency of a case, and what the log says of it.
fn cold_start(case: &Case, solver: &SolverOptions) -> (Result<Branch, Error>, String) {
    let range = ForcedOptions {
        omega_start: case.omega,
        omega_stop: case.omega,
        ..ForcedOptions::default()
    };
    let mut told = String::new();
    let mut log = |_, line: &str| told = line.to_string();
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let found = forced_response(&case.model(), solver, &range, &mut hooks);
    (found, told)
}

#[test]
fn cold_starts_converge_to_solutions() {
    let began = Instant::now();
    let mut failed = Vec::new();
    let mut wrong = Vec::new();
    let (mut bounded, mut converged) = (0, 0);
    let mut per_law = [[0usize; 2]; LAWS.len()];
    let mut ways = BTreeMap::new();
    let mut worst = (0.0, 0);
    let mut solving = 0.0;
    for number in 0..cases() {
        let case = Case::random(seed(), number);
        let clock = Instant::now();
        let (found, way) = cold_start(&case, &harmonics(H));
        let took = clock.elapsed().as_secs_f64();
        solving += took;
        if took > 0.5 { println!("{number} took {took:.2} {way} {:?}", case.contacts.iter().map(|p| LAWS[p.law.number()]).collect::<Vec<_>>()); }
        let is_bounded = case.known != Known::AboveCapacity;
        bounded += usize::from(is_bounded);
        let mut has = [false; LAWS.len()];
        for placed in &case.contacts {
            has[placed.law.number()] = true;
        }
        for (law, count) in per_law.iter_mut().enumerate() {
            if has[law] && is_bounded {
                count[0] += 1;
                count[1] += usize::from(found.is_ok());
            }
        }
        let laws: Vec<&str> = case.contacts.iter().map(|p| LAWS[p.law.number()]).collect();
        match found {
            Err(e) => {
                assert!(!e.message().is_empty());
                assert!(matches!(e.status, Status::NoConvergence | Status::NoBoundedSolution | Status::NotFinite), "{e:?}");
                if is_bounded {
                    failed.push(format!("{number}: {:?} {laws:?} n {}: {:?} {}", case.known, case.n, e.status, e.message()));
                }
            }
            Ok(branch) => {
                *ways.entry(way).or_insert(0usize) += 1;
                converged += usize::from(is_bounded);
                let x = all_harmonics(&branch, 0);
                let r = Residual::of(&case, &x, BOUND);
                let told = branch.sampling_error()[0] * r.contacts;
                if r.size > worst.0 {
                    worst = (r.size, number);
                }
                if !is_bounded || !(r.size <= BOUND || r.size <= 2.0 * r.change || r.size <= 2.0 * told) {
                    wrong.push(format!("{number}: {:?} {laws:?} n {} {r:?} told {told:.1e} status {:?}", case.known, case.n, branch.status()));
                }
            }
        }
    }
    println!("{converged} of {bounded} bounded cold starts converge, {solving:.1} s of {:.1} s", began.elapsed().as_secs_f64());
    for (name, [all, good]) in LAWS.iter().zip(per_law) {
        println!("  {name}: {good} of {all}");
    }
    for (way, count) in &ways {
        println!("  {count} by: {way}");
    }
    println!("worst residual {:.1e} in {}", worst.0, worst.1);
    for line in &failed {
        println!("failed {line}");
    }
    for line in &wrong {
        println!("wrong {line}");
    }
    assert!(wrong.is_empty());
    assert!(converged as f64 >= 0.999 * bounded as f64);
}
