//! Cost of one evaluation of friction with coupled directions against friction in one direction, both under a normal
//! load that varies, at the same motions: force and Jacobian, as a Newton iteration needs them.
//!
//! `cargo run --release --example friction_cost`

use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::ScaledFriction2d;
use hbvib::internals::ScaledFriction3d;
use hbvib::internals::{Evaluation, Evaluator};
use hbvib::{Interrupt, Result};
use std::time::Instant;

/// Motions of one direction whose harmonics fall with the square of their number.
fn signal(set: &HarmonicSet, size: f64, turn: f64) -> Vec<f64> {
    let mut packed = vec![0.0; set.packed_len()];
    for k in 0..set.oscillating() {
        let h = set.reduced(k) as f64;
        let (sin, cos) = (turn * h + 0.3 * h * h).sin_cos();
        packed[1 + 2 * k] = size * cos / (h * h);
        packed[2 + 2 * k] = size * sin / (h * h);
    }
    packed
}

/// Seconds of one evaluation.
fn cost(law: &dyn Law, set: &HarmonicSet, motion: &[f64]) -> Result<f64> {
    let mut evaluator = Evaluator::new(set, 0, core::iter::once(law))?;
    let mut out = Evaluation::new(set, law.directions())?;
    let mut best = f64::INFINITY;
    // Many short runs: other programs interrupt long ones.
    for _ in 0..100 {
        let start = Instant::now();
        let repeats = 2;
        for _ in 0..repeats {
            evaluator.evaluate(law, set, motion, 1.0, &mut out, &Interrupt::none())?;
        }
        best = best.min(start.elapsed().as_secs_f64() / f64::from(repeats));
    }
    Ok(best)
}

fn main() -> Result<()> {
    println!("| H | state | one direction | coupled directions | ratio |");
    println!("|---|---|---|---|---|");
    for highest in [3, 9, 21] {
        let set = HarmonicSet::all(highest)?;
        for (name, size, closing) in [
            ("slip", 3.0, 0.3),
            ("slip and lift-off", 3.0, 1.4),
            ("stick", 0.05, 0.3),
        ] {
            let (x1, x2, y) = (
                signal(&set, size, 0.4),
                signal(&set, 0.7 * size, 1.7),
                signal(&set, closing, 2.6),
            );
            let (kt, kn, mu, load) = (1.0, 1.0, 0.5, 1.0);
            let one = ScaledFriction2d {
                kt,
                kn,
                mu,
                load,
                slider: 0.0,
            };
            let plane = ScaledFriction3d {
                kt,
                kn,
                mu,
                load,
                has_normal: true,
                slider: [0.0; 2],
            };
            let a = cost(&one, &set, &[&x1[..], &y].concat())?;
            let b = cost(&plane, &set, &[&x1[..], &x2, &y].concat())?;
            println!(
                "| {highest} | {name} | {:.1} µs | {:.1} µs | {:.1} |",
                1e6 * a,
                1e6 * b,
                b / a
            );
        }
    }
    Ok(())
}
