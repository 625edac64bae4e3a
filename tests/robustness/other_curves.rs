//! Chains with sliders alone have one motion at each frequency: with `branches = 2` nothing is found beside their sweep, which stays the same
//! to the bit.

use crate::common::depth::some_of;
use crate::common::peers::structure;
use crate::common::{harmonics, omega_range, sweep};
use crate::random_problems::random::Random;
use hbvib::{Contact, ForcedOptions, Hooks, SolverOptions, Waves, forced_response};
use std::time::Instant;

/// Chains of 2 to 6 masses whose sliders rub on the ground or between two masses: friction under a constant load has one motion at each
/// frequency, so nothing lies beside the sweep and nothing bifurcates.
#[test]
fn chains_with_sliders_alone_have_no_other_curve() {
    let (mut with, mut without, mut modes, mut lost) = (0.0, 0.0, 0, 0);
    for number in 0..some_of(12, 100) {
        let mut random = Random::of(47, number);
        let n = 2 + random.below(5);
        let mut stiffness = vec![0.0; n * n];
        for i in 0..n {
            stiffness[i * (n + 1)] = if i == 0 {
                2.0
            } else {
                1.0 + f64::from(u8::from(i + 1 < n))
            };
            if i > 0 {
                stiffness[i * n + i - 1] = -1.0;
                stiffness[(i - 1) * n + i] = -1.0;
            }
        }
        let mass: Vec<f64> = (0..n * n).map(|k| f64::from(u8::from(k % (n + 1) == 0))).collect();
        let beta = random.decade(-2.5, -1.3);
        let damping: Vec<f64> = stiffness.iter().map(|k| beta * k).collect();
        let mut model = structure(&mass, &damping, &stiffness);
        for _ in 0..=random.below(3) {
            let a = random.below(n);
            let partner = Some((a + 1) % n).filter(|_| random.happens(0.5));
            let (kt, limit) = (random.decade(-1.0, 1.0), random.decade(-1.5, 0.5));
            model
                .add_contact(&Contact::jenkins(a, partner, kt, 0.3, limit / 0.3))
                .unwrap();
        }
        model.add_force(n - 1, 1, random.decade(-1.5, 0.0).into()).unwrap();
        let range = (0.15, random.within(0.6, 1.9));
        let clock = Instant::now();
        let sought_too = ForcedOptions {
            branches: 2,
            ..omega_range(range.0, range.1)
        };
        let found = forced_response(&model, &harmonics(5), &sought_too, &mut Hooks::default()).unwrap();
        with += clock.elapsed().as_secs_f64();
        let solver = SolverOptions {
            stability: Some(Waves::Wave),
            ..harmonics(5)
        };
        let clock = Instant::now();
        let alone = sweep(&model, &solver, range.0, range.1, &[]);
        without += clock.elapsed().as_secs_f64();
        let searched = found.searched().unwrap();
        modes += searched.modes;
        assert!(
            found.children().is_empty(),
            "chain {number}: {} curves",
            found.children().len()
        );
        assert_eq!(searched.bifurcations, 0, "chain {number}");
        lost += searched.lost_resonances;
        assert_eq!(found.omega(), alone.omega(), "chain {number}");
        assert_eq!(found.amplitude(), alone.amplitude(), "chain {number}");
    }
    println!(
        "{modes} nonlinear modes, {lost} of their resonances without a solution; {:.2} times the sweep with its stability",
        with / without
    );
    assert!(modes > 12);
}
