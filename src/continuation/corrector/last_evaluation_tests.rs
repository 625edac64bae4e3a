//! Tests of the end of a correction with earlier factors.

use super::*;
use crate::condense::Condensed;
use crate::condense::test_chains::{chain, structure};
use crate::contact::Contact;
use crate::continuation::corrector::{Corrected, Outcome};
use crate::linalg::newton::linear_system::Jacobian;
use crate::options::SolverOptions;
use crate::problem::harmonic_balance::HarmonicBalance;
use crate::problem::{Homotopy, InitialGuess, Residual};
use num_complex::Complex64;

/// A response that counts its evaluations and matrices.
struct Counting<'a> {
    problem: HarmonicBalance<'a>,
    evaluations: usize,
    matrices: usize,
}

impl Jacobian for Counting<'_> {
    fn size(&self) -> usize {
        self.problem.size()
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        self.matrices += 1;
        self.problem.fill(matrix, active)
    }

    fn multiply_here(&mut self, d: &[f64], out: &mut [f64]) -> Result<bool> {
        self.problem.multiply_here(d, out)
    }
}

impl Problem for Counting<'_> {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        self.evaluations += 1;
        self.problem.evaluate(u, p, out)
    }

    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        self.problem.observe(u, direction)
    }

    fn initial_guess(&mut self, kind: InitialGuess, p: f64, u: &mut [f64]) -> Result<bool> {
        self.problem.initial_guess(kind, p, u)
    }

    fn homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}

const METRIC: Metric = Metric { u: 1.0, p: 0.5 };

/// A correction from `start` at the parameter of `start`, and the number of evaluations without a matrix.
fn corrected(problem: &mut Counting<'_>, start: &[f64], may_end_early: bool) -> Option<(Vec<f64>, Corrected, usize)> {
    let n = start.len() - 1;
    let mut corrector = Corrector::new(n, 1e-10, 20).unwrap();
    corrector.may_end_early = may_end_early;
    let mut row = vec![0.0; n + 1];
    row[n] = 1.0;
    let mut v = start.to_vec();
    (problem.evaluations, problem.matrices) = (0, 0);
    let outcome = corrector.correct(problem, &mut v, &row, METRIC, false, &Interrupt::none());
    match outcome.unwrap() {
        Outcome::Converged(found) => Some((v, found, problem.evaluations - problem.matrices)),
        Outcome::Failed => None,
    }
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    norm(&off)
}

#[test]
fn points_and_tangents_are_those_of_new_factors() {
    let interrupt = Interrupt::none();
    let options = SolverOptions {
        harmonics: 5,
        ..SolverOptions::default()
    };
    let (mut compared, mut early) = (0, 0);
    for several in [false, true] {
        let mut model = structure(1, (0.0, 2e-3));
        if several {
            model = chain(1, (0.0, 2e-3));
        } else {
            model.add_contact(&Contact::jenkins(1, Some(4), 9.0, 0.3, 1.0)).unwrap();
        }
        let range = (0.1, 0.6);
        let condensed = Condensed::new(&model, &options, range, &interrupt).unwrap();
        let mut problem = Counting {
            problem: HarmonicBalance::new(&condensed, 8, range.into(), 0, None, &interrupt).unwrap(),
            evaluations: 0,
            matrices: 0,
        };
        let n = problem.size();
        let mut near = vec![0.0; n + 1];
        for k in 0..160_usize {
            near[n] = 0.1 + 0.003 * k as f64;
            let Some((solution, ..)) = corrected(&mut problem, &near, false) else {
                near.fill(0.0);
                continue;
            };
            let size = norm(&solution[..n]);
            // From starts that differ by rounding to such from which contacts stick or slip otherwise.
            for exponent in 0..8 {
                let distance = size * 10.0_f64.powi(-2 * exponent);
                let mut start = solution.clone();
                for (i, x) in start[..n].iter_mut().enumerate() {
                    *x += distance * ((i * 13 + k * 7) as f64 * 0.37).sin();
                }
                let (slow, quick) = (
                    corrected(&mut problem, &start, false),
                    corrected(&mut problem, &start, true),
                );
                let (Some(slow), Some(quick)) = (slow, quick) else {
                    continue;
                };
                compared += 1;
                early += quick.2;
                assert_eq!(slow.2, 0);
                assert_eq!(quick.1.iterations, slow.1.iterations);
                assert_eq!(quick.1.positive, slow.1.positive);
                assert!(gap(&quick.0, &slow.0) <= 1e-12 * size, "{k}, {exponent}");
                assert!(gap(&quick.1.tangent, &slow.1.tangent) <= 1e-10 * norm(&slow.1.tangent));
                assert!((quick.1.slope - slow.1.slope).norm() <= 1e-9 * slow.1.slope.norm());
            }
            near.copy_from_slice(&solution);
        }
    }
    // Some need no step, and from some a step is followed by another matrix.
    assert!(compared > 1000, "{compared}");
    assert!(early > compared / 4 && early < compared, "{early} of {compared}");
}
