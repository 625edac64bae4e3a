//! Random chains with friction have no detached curves, and none is reported. Without `branches` nothing is sought.

use crate::common::depth::some_of;
use crate::common::models::coupled;
use crate::common::random;
use crate::common::{harmonics, omega_range};
use hbvib::{Branch, Contact, ContactState, ForcedOptions, Hooks, Model, SolverOptions, Waves, forced_response};
use std::time::Instant;

/// Numbers in 0 … 1.
struct Random(u64);

impl Random {
    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * random::unit(&mut self.0)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.between(0.0, n as f64) as usize).min(n - 1)
    }
}

/// A chain of two to five masses held by springs, with one or two sliders against the ground, and its lowest frequency.
fn chain(seed: u64) -> (Model, f64) {
    let mut random = Random(seed);
    for _ in 0..8 {
        random.between(0.0, 1.0);
    }
    let n = 2 + random.below(4);
    let draw = |_| (random.between(0.5, 2.0), random.between(0.2, 1.0));
    let (mass, ground): (Vec<_>, Vec<_>) = (0..n).map(draw).unzip();
    let between: Vec<f64> = (1..n).map(|_| random.between(0.3, 1.5)).collect();
    let mut model = coupled(&mass, &ground, &between).rayleigh(0.01, 0.01).build();
    let omega = model.linear_modes(0, ContactState::Free).unwrap().omega[0];
    for _ in 0..1 + random.below(2) {
        let (kt, load) = (random.between(0.1, 0.6), random.between(0.05, 0.5));
        let contact = Contact::jenkins(random.below(n), None, kt, 0.5, load);
        model.add_contact(&contact).unwrap();
    }
    let force = random.between(0.02, 0.3);
    model.add_force(random.below(n), 1, force.into()).unwrap();
    (model, omega)
}

fn solve(seed: u64, branches: usize, stability: Option<Waves>) -> (Branch, f64) {
    let (model, omega) = chain(seed);
    let range = ForcedOptions {
        branches,
        ..omega_range(0.7 * omega, 1.6 * omega)
    };
    let solver = SolverOptions {
        stability,
        ..harmonics(5)
    };
    let begin = Instant::now();
    let branch = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
    (branch, begin.elapsed().as_secs_f64())
}

/// The times of all: responses, with stability, and with all solutions sought.
#[test]
fn no_curve_is_reported_beside_chains_without_one() {
    let mut times = [0.0; 3];
    for seed in 0..some_of(25, 100) {
        let (alone, time) = solve(seed, 0, None);
        times[0] += time;
        let (stable, time) = solve(seed, 0, Some(Waves::Wave));
        times[1] += time;
        let (searched, time) = solve(seed, 2, Some(Waves::Wave));
        times[2] += time;
        assert_eq!(searched.children().len(), 0, "chain {seed}");
        assert_eq!(alone.omega(), stable.omega());
        assert_eq!(stable.omega(), searched.omega());
    }
    println!(
        "{:.3} s alone, {:.3} s with stability, {:.2} times as long with branches = 2",
        times[0],
        times[1],
        times[2] / times[1]
    );
}
