//! Times of the parts of a Newton iteration with an increasing number of harmonics: one contact, odd harmonics.
//!
//! All times are minima: read them as ratios.

use super::model;
use hbvib::internals::Bordered;
use hbvib::internals::Condensed;
use hbvib::internals::HarmonicBalance;
use hbvib::internals::Jacobian;
use hbvib::internals::Metric;
use hbvib::internals::norm;
use hbvib::internals::{Corrector, Outcome};
use hbvib::internals::{Evaluation, Evaluator};
use hbvib::internals::{InitialGuess, Problem, Residual};
use hbvib::{Interrupt, SolverOptions};
use std::error::Error;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

/// (highest harmonic, samples per period; 0 = exact events)
const WAYS: [(usize, usize); 8] = [
    (9, 0),
    (31, 0),
    (63, 0),
    (127, 0),
    (255, 0),
    (9, 256),
    (63, 1024),
    (255, 4096),
];

/// Smallest total time of the measurement of a part, s.
const LEAST: f64 = 0.15;

/// Shortest time of one call, s.
fn time(mut work: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let (begin, mut least) = (Instant::now(), f64::INFINITY);
    while begin.elapsed().as_secs_f64() < LEAST {
        let start = Instant::now();
        work()?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    Ok(least)
}

/// Times of the parts of an iteration, and of a whole iteration, µs.
struct Parts {
    unknowns: usize,
    /// Turning points of the motion, or its samples.
    turning_points: f64,
    /// Force of the law and its Jacobian.
    law: f64,
    /// Residual with the forces.
    residual: f64,
    /// Residual and Newton's matrix.
    matrix: f64,
    /// Factors of the dense bordered matrix, and one solution with them.
    dense: f64,
    /// A corrected point per Newton iteration, tangent included.
    iteration: f64,
}

fn measure(force: f64, highest: usize, samples: usize) -> Result<Parts, Box<dyn Error>> {
    let parameters = model::Parameters {
        force,
        ..model::Parameters::default()
    };
    let options = SolverOptions {
        harmonics: highest,
        samples,
        tolerance: 0.0,
        response_dof: Some(model::B2),
        ..SolverOptions::default()
    };
    let omega = 208.85 * TAU;
    let never = Interrupt::none();
    let condensed = Condensed::new(&parameters.model()?, &options, omega, &never)?;
    let range = (207.0 * TAU, 211.0 * TAU);
    let mut problem = HarmonicBalance::new(&condensed, model::B2, range.into(), samples, None, &never)?;
    let n = problem.size();
    let mut v = vec![0.0; n + 1];
    v[n] = omega;
    problem.initial_guess(InitialGuess::Stuck, omega, &mut v[..n])?;
    let mut row = vec![0.0; n + 1];
    row[n] = 1.0;
    let mut corrector = Corrector::new(n, 1e-10, 50)?;
    let metric = Metric {
        u: 10.0 * norm(&v[..n]),
        p: 4.0 * TAU,
    };
    let Outcome::Converged(found) = corrector.correct(&mut problem, &mut v, &row, metric, true, &never)? else {
        return Err("the point of the measurement was not found".into());
    };
    // In the plane across the branch, as in continuation.
    let metric = Metric {
        u: 10.0 * norm(&v[..n]),
        ..metric
    };
    for (r, t) in row.iter_mut().zip(&found.tangent) {
        *r = t / metric.u;
    }
    row[n] = found.tangent[n] / metric.p;

    let set = condensed.set();
    let law = &*condensed.laws()[0].law;
    let mut evaluator = Evaluator::new(set, samples, core::iter::once(law))?;
    let mut out = Evaluation::new(set, 1)?;
    let u = &v[..n];
    let turning_points = time(|| Ok(evaluator.prepare(set, black_box(u), &never)?))?;
    let law = time(|| Ok(evaluator.evaluate(law, set, black_box(u), omega, &mut out, &never)?))?;
    let mut at = Residual::new(n)?;
    let (mut jacobian, mut active) = (vec![0.0; n * n], vec![true; n]);
    let mut turn = false;
    // The frequency differs each time, as in continuation: the flexibility is part of an iteration.
    let mut other = || {
        turn = !turn;
        if turn { omega } else { omega * (1.0 + 1e-9) }
    };
    let residual = time(|| Ok(problem.evaluate(u, other(), &mut at)?))?;
    let matrix = time(|| {
        problem.evaluate(u, other(), &mut at)?;
        problem.fill(&mut jacobian, &mut active)?;
        Ok(())
    })?;
    let mut bordered = Bordered::new(n)?;
    let mut b = vec![1.0; n + 1];
    let dense = time(|| {
        let scales = (metric.u, metric.p);
        bordered.factor(&jacobian, &at.d_parameter, &active, scales, &row, &never)?;
        bordered.solve(black_box(&mut b));
        Ok(())
    })?;
    let mut iterations = 0;
    let mut start = v.clone();
    let iteration = time(|| {
        // The initial point is as far away as a prediction.
        for (s, v) in start.iter_mut().zip(&v[..n]) {
            *s = v * (1.0 + 1e-4);
        }
        start[n] = omega;
        match corrector.correct(&mut problem, &mut start, &row, metric, false, &never)? {
            Outcome::Converged(found) => {
                iterations = found.iterations + 1;
                Ok(())
            }
            Outcome::Failed => Err("a point was not corrected".into()),
        }
    })?;
    let micro = 1e6;
    Ok(Parts {
        unknowns: n,
        turning_points: micro * turning_points,
        law: micro * law,
        residual: micro * residual,
        matrix: micro * matrix,
        dense: micro * dense,
        iteration: micro * iteration / f64::from(u32::try_from(iterations)?),
    })
}

/// Prints the table.
pub fn run() -> Result<(), Box<dyn Error>> {
    println!("Microseconds at 208.85 Hz; residual holds the two columns before it, matrix the residual");
    for force in [1.0, 5.0, 20.0] {
        println!("\nF = {force} N");
        println!("  H    events  unknowns    turning     law  residual    matrix     dense  iteration  exponent");
        let mut last: Option<(usize, f64)> = None;
        for (highest, samples) in WAYS {
            let p = measure(force, highest, samples)?;
            let events = if samples == 0 {
                "exact".into()
            } else {
                format!("N={samples}")
            };
            let exponent = match last {
                Some((n, t)) if p.unknowns > n => {
                    format!("{:.2}", (p.iteration / t).ln() / (p.unknowns as f64 / n as f64).ln())
                }
                _ => String::new(),
            };
            println!(
                "{highest:3}  {events:>8}  {:8}  {:9.2}  {:6.2}  {:8.2}  {:8.2}  {:8.2}  {:9.2}  {exponent:>8}",
                p.unknowns, p.turning_points, p.law, p.residual, p.matrix, p.dense, p.iteration,
            );
            last = (samples == 0).then_some((p.unknowns, p.iteration));
        }
    }
    Ok(())
}
