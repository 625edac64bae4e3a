//! Stability of a point of a small case against its response: 243 times (wave) and 425 times (wheel), twice as many on a busy machine.
//! The bound leaves room for machines that other programs use; a hundred is the aim.

use crate::common::{BASE, harmonics, sweep};
use hbvib::options::{SolverOptions, Waves};
use std::f64::consts::TAU;
use std::time::Instant;

/// Times of a sweep of the ring damper: points, seconds.
fn time(stability: Option<Waves>) -> (usize, f64) {
    let solver = SolverOptions {
        stability,
        ..harmonics(9)
    };
    let model = BASE.sector();
    let mut best = f64::INFINITY;
    let mut points = 0;
    for _ in 0..3 {
        let begin = Instant::now();
        points = sweep(&model, &solver, TAU * 206.0, TAU * 211.0, &[]).points();
        best = best.min(begin.elapsed().as_secs_f64());
    }
    (points, best)
}

#[test]
fn stability_costs_a_bounded_number_of_responses() {
    let (points, alone) = time(None);
    for waves in [Waves::Wave, Waves::Wheel] {
        let (again, with) = time(Some(waves));
        let ratio = (with - alone) / alone;
        println!(
            "{points} and {again} points, {:.1} us a point, {waves:?}: {ratio:.0} times the response",
            1e6 * alone / points as f64
        );
        assert_eq!(points, again);
        assert!(ratio < 5000.0, "{ratio:.0}");
    }
}
