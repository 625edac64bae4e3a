//! A sweep that enters a closed curve goes round it a few times.

use crate::common::models;
use crate::common::{at_dof, sweep};
use hbvib::{Contact, SolverOptions, Status};

/// Ten masses with a cubic spring: with three harmonics the sweep goes on to a curve that is closed with eleven, between the folds at
/// 0.1765 and 0.2378. It was followed round after round, up to 20,000 points. The folds are those that a sweep in the other sense finds.
#[test]
fn a_sweep_goes_round_a_closed_curve_a_few_times() {
    let mass = [1.981, 0.9781, 1.683, 1.805, 1.087, 1.157, 1.059, 0.6604, 1.218, 0.862];
    let springs = [
        0.8857, 0.7771, 0.7908, 1.721, 1.134, 0.8839, 1.386, 1.406, 1.47, 1.867, 0.0,
    ];
    let model = models::chain(&mass, &springs)
        .rayleigh(0.0, 0.001_997)
        .contact(Contact::cubic(8, None, 0.0, 1.123e-4))
        .force(2, 1, 0.05531)
        .build();
    let solver = SolverOptions {
        tolerance: 1e-2,
        max_points: 2_000,
        ..at_dof(2, SolverOptions::default())
    };
    for (from, to) in [(0.07, 2.1), (2.1, 0.07)] {
        let branch = sweep(&model, &solver, from, to, &[]);
        assert_eq!(branch.status(), Status::StoppedClosed, "{:?}", branch.reason());
        assert!(branch.points() < 1_500, "{} points", branch.points());
        let folds: Vec<f64> = branch.folds().iter().map(|fold| fold.omega).collect();
        for fold in [0.1765, 0.23777] {
            let passed = folds.iter().filter(|omega| (*omega / fold - 1.0).abs() < 1e-3).count();
            // One of them is passed with fewer harmonics as well, at nearly the same frequency.
            assert!(
                (7..=9).contains(&passed),
                "{from}: {fold} is passed {passed} times, {folds:?}"
            );
        }
    }
}
