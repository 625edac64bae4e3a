//! The end of a correction with the factors of the iteration before it.
//!
//! Where the residual after a Newton step is within the tolerance, the matrix K there hardly differs from the factored K₀ of
//! the iteration before. Its products are enough: the last step takes K₀, whose error is that of the matrix times a residual
//! within the tolerance, and the tangent is found by x ← x + K₀⁻¹(b − K x). Fast convergence shows that det K has the sign of
//! det K₀, as in [`crate::linalg::bordered`].

use crate::continuation::Metric;
use crate::continuation::corrector::{Corrector, Factors, NEAR, TANGENT_ERROR};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::linear_system::LinearSystem;
use crate::linalg::norm;
use crate::problem::Problem;

/// Largest change of a tangent by the first round, over its size: of a larger one the matrices differ too much.
const LARGEST_CHANGE: f64 = 1e-3;

/// Largest Newton step to the point, over the motion: after a longer one the matrices may differ too much.
const SMALL: f64 = 1e-5;

/// Rounds that take less time than new factors.
const MOST_ROUNDS: usize = 3;

impl Corrector {
    /// Solves for the last Newton step, in `step`, and for the tangent, in `next`, by the factors of the iteration before, whose
    /// step had this length over the motion. `false` where new ones are needed.
    pub(super) fn ends_by_earlier_factors(
        &mut self,
        problem: &mut dyn Problem,
        (v, last_step): (&[f64], f64),
        (metric, row): (Metric, &[f64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = v.len() - 1;
        if last_step.is_nan() || last_step > SMALL {
            return Ok(false);
        }
        // Near-rigid contacts leave residuals that are rounding, to which a matrix that is not exact would add.
        if self.factors != Factors::Own || !self.system.is_direct() || self.at.rounding > 0.0 {
            return Ok(false);
        }
        self.negate_residual();
        if !self.system.solve(problem, TANGENT_ERROR, &mut self.step, interrupt)? {
            return Ok(false);
        }
        let is_near = norm(&self.step[..n]) * metric.u <= NEAR * norm(&v[..n]);
        Ok(is_near && self.refine_tangent(problem, (metric, row), interrupt)?)
    }

    /// The tangent of the current matrix in `next`, by the factors of an earlier one.
    fn refine_tangent(
        &mut self,
        problem: &mut dyn Problem,
        (metric, row): (Metric, &[f64]),
        interrupt: &Interrupt<'_>,
    ) -> Result<bool> {
        let n = self.next.len() - 1;
        self.next.fill(0.0);
        self.next[n] = 1.0;
        if !self.system.solve(problem, TANGENT_ERROR, &mut self.next, interrupt)? {
            return Ok(false);
        }
        let size = norm(&self.next);
        let mut last = size;
        for round in 0..MOST_ROUNDS {
            let (unknowns, along) = (&mut self.trial[..n], metric.p * self.next[n]);
            for (scaled, x) in unknowns.iter_mut().zip(&self.next) {
                *scaled = metric.u * x;
            }
            if !problem.multiply_here(unknowns, &mut self.change[..n])? {
                return Ok(false);
            }
            for (change, r) in self.change.iter_mut().zip(&self.at.d_parameter) {
                *change = -(*change + r * along);
            }
            let on_row: f64 = row.iter().zip(&self.next).map(|(t, x)| t * x).sum();
            self.change[n] = 1.0 - on_row;
            if !self.system.solve(problem, TANGENT_ERROR, &mut self.change, interrupt)? {
                return Ok(false);
            }
            let change = norm(&self.change);
            let largest = if round == 0 { LARGEST_CHANGE * size } else { 0.2 * last };
            // A comparison with NaN is false.
            let shrinks = change <= largest || change <= TANGENT_ERROR * size;
            if !shrinks {
                return Ok(false);
            }
            for (x, change) in self.next.iter_mut().zip(&self.change) {
                *x += change;
            }
            // The remaining error is the change times the shrinkage once more.
            if change * (change / last) <= TANGENT_ERROR * size {
                return Ok(true);
            }
            last = change;
        }
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::condense::Condensed;
    use crate::condense::test_chains::{chain, structure};
    use crate::contact::Contact;
    use crate::continuation::corrector::{Corrected, Outcome};
    use crate::linalg::linear_system::Jacobian;
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

    /// A correction from `start` at its parameter, and the evaluations that took no matrix.
    fn corrected(
        problem: &mut Counting<'_>,
        start: &[f64],
        may_end_early: bool,
    ) -> Option<(Vec<f64>, Corrected, usize)> {
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
                problem: HarmonicBalance::new(&condensed, 8, range, 0, None, &interrupt).unwrap(),
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
}
