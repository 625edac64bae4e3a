//! Random problems, thousands of them: that cold starts converge, that what is reported as converged is a
//! solution, that sweeps reach their end, that nothing hangs, and that results repeat bit for bit.
//!
//! The problems come from a generator of this test's own with a fixed seed. `HBVIB_SEED` chooses another,
//! `HBVIB_CASES` the number of cold starts, 600 otherwise and 2,000 in `tests/deep.sh`: `HBVIB_SEED=7 HBVIB_CASES=20000 cargo test --release --test
//! robustness random_problems -- --nocapture`. Sweeps are an eighth as many.

mod absurd;
mod law;
mod problem;
pub mod random;
mod residual;

use crate::common::depth::some_of;
use crate::common::{all_harmonics, harmonics, omega_range, relative_gap};
use hbvib::{Branch, Error, ForcedOptions, Hooks, SolverOptions, Status, TimeOptions, forced_response, time_response};
use law::LAWS;
use num_complex::Complex64;
use problem::{Case, Known};
use random::from_environment;
use residual::Residual;
use std::collections::BTreeMap;
use std::time::Instant;

/// Highest harmonic.
const H: usize = 5;

/// Relative residual that is asked of a solution.
const BOUND: f64 = 1e-4;

/// Number of friction in a plane.
const PLANE: usize = 2;

/// Share of problems with friction in a plane that converge.
const PLANE_SHARE: f64 = 0.999;

fn seed() -> u64 {
    from_environment("HBVIB_SEED", 20_261_121)
}

fn cases() -> u64 {
    from_environment("HBVIB_CASES", some_of(300, 2_000))
}

/// A cold start at the frequency of a case, and what the log says of it.
fn cold_start(case: &Case, solver: &SolverOptions) -> (Result<Branch, Error>, String) {
    let range = omega_range(case.omega, case.omega);
    let mut reported = String::new();
    let mut log = |_, line: &str| reported = line.to_string();
    let mut hooks = Hooks {
        log: Some(&mut log),
        ..Hooks::default()
    };
    let found = forced_response(&case.model(), solver, &range, &mut hooks);
    (found, reported)
}

/// Samples with which an answer is sought again that its own samples leave above the bound.
const MORE_SAMPLES: usize = 1 << 13;

/// Whether the solution from `x` on with more samples meets the bound.
fn holds_with_more_samples(case: &Case, x: &[Complex64]) -> bool {
    let solver = SolverOptions {
        samples: MORE_SAMPLES,
        ..harmonics(H)
    };
    let range = ForcedOptions {
        guess: Some(x),
        ..omega_range(case.omega, case.omega)
    };
    forced_response(&case.model(), &solver, &range, &mut Hooks::default()).is_ok_and(|branch| {
        let r = Residual::of(case, &all_harmonics(&branch, 0), BOUND);
        r.size <= BOUND || r.size <= 2.0 * r.change
    })
}

/// Which laws a case has.
fn laws_of(case: &Case) -> [bool; LAWS.len()] {
    let mut has = [false; LAWS.len()];
    for assembled in &case.contacts {
        has[assembled.law.number()] = true;
    }
    has
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
    let mut sampled = 0;
    let (mut solving, mut plane) = (0.0, 0.0);
    for number in 0..cases() {
        let case = Case::random(seed(), number);
        let clock = Instant::now();
        let (found, way) = cold_start(&case, &harmonics(H));
        let took = clock.elapsed().as_secs_f64();
        solving += took;
        let has = laws_of(&case);
        plane += if has[PLANE] { took } else { 0.0 };
        let is_bounded = case.known != Known::AboveCapacity;
        bounded += usize::from(is_bounded);
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
                assert!(
                    matches!(
                        e.status,
                        Status::NoConvergence | Status::NoBoundedSolution | Status::NotFinite
                    ),
                    "{e:?}"
                );
                if is_bounded {
                    failed.push(format!(
                        "{number}: {:?} {laws:?} n {}: {:?} {}",
                        case.known,
                        case.n,
                        e.status,
                        e.message()
                    ));
                }
            }
            Ok(branch) => {
                *ways.entry(way).or_insert(0usize) += 1;
                converged += usize::from(is_bounded);
                let x = all_harmonics(&branch, 0);
                let r = Residual::of(&case, &x, BOUND);
                let reported = branch.sampling_error()[0] * r.contacts;
                if r.size > worst.0 {
                    worst = (r.size, number);
                }
                let strict = r.size <= BOUND || r.size <= 2.0 * r.change;
                // The error that samples of a law leave must be told by the branch, and go with more of them.
                let of_samples = !strict && r.size <= 2.0 * reported && holds_with_more_samples(&case, &x);
                sampled += usize::from(of_samples);
                if !is_bounded || !(strict || of_samples) {
                    wrong.push(format!(
                        "{number}: {:?} {laws:?} n {} {r:?} told {reported:.1e} status {:?}",
                        case.known,
                        case.n,
                        branch.status()
                    ));
                }
            }
        }
    }
    println!(
        "{converged} of {bounded} bounded cold starts converge, {solving:.1} s ({plane:.1} s for friction 3D) of {:.1} s",
        began.elapsed().as_secs_f64()
    );
    for (name, [all, good]) in LAWS.iter().zip(per_law) {
        println!("  {name}: {good} of {all}");
    }
    for (way, count) in &ways {
        println!("  {count} by: {way}");
    }
    println!(
        "{sampled} residuals above the bound are of samples: told by the branch, and gone with {MORE_SAMPLES} of them"
    );
    println!("worst residual {:.1e} in {}", worst.0, worst.1);
    for line in &failed {
        println!("failed {line}");
    }
    for line in &wrong {
        println!("wrong {line}");
    }
    assert!(wrong.is_empty());
    let [all, good] = per_law[PLANE];
    let others = (bounded - all, converged - good);
    println!("without friction 3D: {} of {}", others.1, others.0);
    assert!(others.1 as f64 >= 0.999 * others.0 as f64);
    assert!(good as f64 >= PLANE_SHARE * all as f64);
}

/// Outcome of a cold start, comparable bit for bit.
fn fingerprint(case: &Case, solver: &SolverOptions) -> Vec<u64> {
    match cold_start(case, solver).0 {
        Err(e) => vec![e.status as i32 as u64],
        Ok(branch) => {
            let x = all_harmonics(&branch, 0);
            x.iter().flat_map(|z| [z.re.to_bits(), z.im.to_bits()]).collect()
        }
    }
}

#[test]
fn results_repeat_bit_for_bit_on_any_number_of_threads() {
    let count = some_of(40, 100);
    let own: Vec<Case> = (0..count).map(|number| Case::random(seed(), number)).collect();
    let all = |solver: SolverOptions| -> Vec<Vec<u64>> { own.iter().map(|case| fingerprint(case, &solver)).collect() };
    let one = all(harmonics(H));
    assert!(10 * one.iter().filter(|x| x.len() > 1).count() as u64 > 9 * count);
    assert!(one == all(harmonics(H)), "once more");
    std::thread::scope(|scope| {
        let together: Vec<_> = (0..4).map(|_| scope.spawn(|| all(harmonics(H)))).collect();
        for thread in together {
            assert!(one == thread.join().unwrap(), "four at once");
        }
    });
}

#[test]
fn sweeps_through_one_resonance_reach_their_end() {
    let mut open = Vec::new();
    let (mut points, mut iterations) = (Vec::new(), Vec::new());
    let count = cases() / 8;
    for number in 0..count {
        let law = (number % LAWS.len() as u64) as usize;
        let case = Case::single(seed(), number, law);
        let (low, high) = (0.3, case.top());
        let (from, to) = if number % 2 == 0 { (low, high) } else { (high, low) };
        let range = omega_range(from, to);
        let found = forced_response(&case.model(), &harmonics(H), &range, &mut Hooks::default());
        let law = LAWS[law];
        match found {
            Err(e) => open.push(format!("{number}: {law}: {}", e.message())),
            Ok(branch) => {
                let last = branch.omega()[branch.points() - 1];
                if branch.status() != Status::Ok || last.to_bits() != to.to_bits() {
                    open.push(format!(
                        "{number}: {law}: {:?} at {last}, {:?}",
                        branch.status(),
                        case.contacts[0].law
                    ));
                }
                points.push(branch.points() as f64);
                let taken = &branch.newton_iterations()[..branch.points()];
                iterations.push(taken.iter().sum::<f64>() / taken.len() as f64);
            }
        }
    }
    println!("{} of {count} sweeps reach their end", count as usize - open.len());
    println!(
        "  points: median {}, most {}",
        median(&mut points),
        points[points.len() - 1]
    );
    println!(
        "  Newton iterations a point: median {:.2}, most {:.2}",
        median(&mut iterations),
        iterations[iterations.len() - 1]
    );
    for line in &open {
        println!("  open: {line}");
    }
    assert!(open.is_empty());
}

/// The middle one, after sorting.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Shooting from the solutions of a tenth of the cases. Their distance from the motion in time is the
/// truncation to five harmonics, which nothing bounds in the single case: a tenth is more than half of them may
/// be off.
#[test]
fn shooting_from_solutions_stays_near_them() {
    let mut gaps = Vec::new();
    let (mut refused, mut lost) = (0, 0);
    for number in (0..cases()).step_by(10) {
        let case = Case::random(seed(), number);
        let Ok(branch) = cold_start(&case, &harmonics(H)).0 else {
            continue;
        };
        let x = all_harmonics(&branch, 0);
        let options = TimeOptions {
            omega: case.omega,
            harmonics: H,
            max_periods: 300,
            start: Some(&x),
            ..TimeOptions::default()
        };
        match time_response(&case.model(), &options, &mut Hooks::default()) {
            Ok(found) => gaps.push(relative_gap(&x, &found.harmonics)),
            Err(e) if e.status == Status::Unsupported => refused += 1,
            Err(e) => {
                assert!(
                    matches!(e.status, Status::NoConvergence | Status::NoBoundedSolution),
                    "{number}: {e:?}"
                );
                lost += 1;
            }
        }
    }
    let middle = median(&mut gaps);
    let share = |limit: f64| gaps.iter().filter(|gap| **gap < limit).count();
    println!(
        "shooting: {} found, {refused} refused (friction in a plane), {lost} without periodic motion; gap median {middle:.1e}, below 1e-3 {}, 1e-2 {}, 1e-1 {}",
        gaps.len(),
        share(1e-3),
        share(1e-2),
        share(1e-1)
    );
    assert!(gaps.len() > 10 * lost);
    assert!(middle < 0.1);
}
