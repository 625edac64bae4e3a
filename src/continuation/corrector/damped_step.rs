//! The damped step of Newton's method.

use crate::continuation::Metric;
use crate::continuation::corrector::{Corrector, SMALLEST_DAMPING, STEP_ERROR, tolerate};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::LinearSystem;
use crate::linalg::norm;
use crate::problem::Problem;

impl Corrector {
    /// Tries damping factors λ = min(1, 4·last), halving; returns the accepted one.
    pub(super) fn damped_step(
        &mut self,
        problem: &mut dyn Problem,
        v: &mut [f64],
        metric: Metric,
        (size, last): (f64, f64),
        interrupt: &Interrupt<'_>,
    ) -> Result<Option<f64>> {
        let n = v.len() - 1;
        let mut damping = (4.0 * last).min(1.0);
        while damping >= SMALLEST_DAMPING {
            interrupt.check()?;
            self.memory.trial.copy_from_slice(v);
            metric.add(&mut self.memory.trial, damping, &self.memory.step);
            let finite = self.memory.trial.iter().all(|x| x.is_finite());
            let evaluated = if finite {
                let outcome = problem.evaluate(&self.memory.trial[..n], self.memory.trial[n], &mut self.at);
                self.failure = outcome.as_ref().err().filter(|e| e.recoverable).cloned();
                tolerate(outcome)?
            } else {
                false
            };
            if evaluated {
                for (s, r) in self.memory.next.iter_mut().zip(&self.at.values) {
                    *s = -r;
                }
                self.memory.next[n] = 0.0;
                let solved = self
                    .system
                    .solve(problem, STEP_ERROR, &mut self.memory.next, interrupt)?;
                let shrunk = solved && norm(&self.memory.next) <= (1.0 - 0.25 * damping) * size;
                if shrunk || self.relative_residual() <= self.attainable() {
                    v.copy_from_slice(&self.memory.trial);
                    return Ok(Some(damping));
                }
            }
            damping *= 0.5;
        }
        Ok(None)
    }
}
