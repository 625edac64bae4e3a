//! Multipliers of one mass with friction and with a cubic spring agree with references of many digits.

use crate::common::{harmonics, one_mass, solve_at, sweep};
use crate::{multipliers, ordinary};
use hbvib::contact::Contact;
use hbvib::model::Model;
use hbvib::options::Waves;
use std::f64::consts::TAU;

/// Hill's method with the tangents of the harmonic forces finds 0.447 and 0.951 in the first case: sliders remember.
#[test]
fn friction_of_one_mass_has_the_multipliers_of_its_flow() {
    for (kt, expected) in [(1.0, 0.3725)] {
        let model = one_mass(0.02, &Contact::jenkins(0, None, kt, 1.0, 0.3), 0.2);
        let branch = solve_at(&model, &harmonics(31), 1.25);
        let found = multipliers(&model, &branch, 0, Waves::Wave);
        println!("kt = {kt}: {found:?}");
        assert!((found.radius - expected).abs() < 5e-5, "{}", found.radius);
    }
}

fn duffing() -> Model {
    one_mass(0.1, &Contact::cubic(0, None, 0.0, 0.1), 0.18)
}

#[test]
fn the_three_solutions_of_duffing_have_their_multipliers() {
    let model = duffing();
    let at = [1.1017664364, 1.1033778377, 1.1001550351];
    let branch = sweep(&model, &harmonics(15), 0.9, 1.3, &at[..1]);
    let mut solutions: Vec<_> = branch.at(0).to_vec();
    solutions.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    let expected = [
        (1.6131373011, [0.9328683077, 0.6060506973]),
        (1.3972458272, [1.0341635042, 0.5466886772]),
        (1.0567696286, [0.9007844495, 0.6276368212]),
    ];
    assert_eq!(solutions.len(), 3);
    for (solution, (amplitude, pair)) in solutions.iter().zip(expected) {
        let found = multipliers(&model, &branch, solution.point, Waves::Wave);
        let mu = ordinary(&found);
        println!(
            "{} {mu:?} {:.1e} {:.1e}",
            solution.amplitude, found.orbit_change, found.residual
        );
        assert!((solution.amplitude - amplitude).abs() < 1e-8);
        for (mu, expected) in mu.iter().zip(pair) {
            assert!((mu - expected).norm() < 1e-7, "{mu} {expected}");
        }
        assert_eq!(found.unstable, usize::from(pair[0] > 1.0));
        let product = (mu[0] * mu[1]).re;
        assert!((product - (-0.1 * TAU / at[0]).exp()).abs() < 1e-9);
    }
}
