//! The search for the best values of the unknowns by steps of Levenberg and Marquardt.
//!
//! The loss is Σ ρ(r) with residuals r in standard deviations. Residuals beyond the limit of a robust loss have smaller weights in the
//! gradient and in the matrix H = JᵀWJ. Unknowns are scaled by their logarithm where they are positive.

use crate::error::{Result, try_push, try_vec};
use crate::studies::fit::fit_data::FitData;
use crate::studies::fit::fit_options::{FIT_STEP, FIT_THINNED_FROM, FitOptions, Loss};
use crate::studies::fit::fit_unknowns::Unknowns;
use crate::studies::fit::marquardt_step::marquardt_step;
use crate::studies::fit::predicted_data::{Predicted, Predictor};

const CONTEXT: &str = "the search of a fit";

/// Damping of the first step; its factors after a success and a failure, and its bounds.
/// Kind: tuned; measured on: not recorded.
const FIT_DAMPING: (f64, f64, f64) = (1e-3, 0.1, 5.0);
const FIT_DAMPING_BOUNDS: (f64, f64) = (1e-12, 1e12);

/// Largest change of the logarithm of an unknown by one step.
/// Kind: cap.
const FIT_LARGEST_LOG_STEP: f64 = 1.2;

/// Foretold fall of the loss below which a step that fails is rounding of the model.
/// Kind: rounding.
const FIT_ROUNDING: f64 = 1e-5;

/// Step, in standard deviations, along which the model is linear: what is left out is of the order of its square.
/// Kind: tuned; measured on: not recorded.
const FIT_LINEAR_STEP: f64 = 1e-4;

/// Error in standard deviations at which a search on many data ends, whose evaluations are dear: on a sector of finite elements steps of
/// that size are rounding of the solutions.
/// Kind: tuned; measured on: not recorded.
const FIT_DEAR_STEP: f64 = 1e-5;

/// Values of the free unknowns, with the loss and the residuals they lead to.
#[derive(Clone, Debug)]
pub(super) struct State {
    /// Free unknowns, each in its scale.
    pub z: Vec<f64>,
    pub theta: Vec<f64>,
    pub predicted: Predicted,
    /// Residuals in standard deviations, two for each datum, then one for each prior.
    pub residuals: Vec<f64>,
    /// Derivatives of the residuals by the free unknowns, row after row.
    pub slopes: Vec<f64>,
    pub cost: f64,
}

/// Outcome of one search.
pub(super) struct Found {
    pub state: State,
    pub iterations: usize,
    pub converged: bool,
}

pub(super) struct FitSearch<'a> {
    pub predictor: &'a Predictor<'a>,
    pub unknowns: &'a Unknowns,
    pub options: &'a FitOptions,
}

impl FitSearch<'_> {
    /// The state at given values of the free unknowns; `None` where the model has no solution for some datum.
    ///
    /// # Errors
    /// Those of the predictor.
    pub fn at(&self, z: Vec<f64>) -> Result<Option<State>> {
        let theta = self.unknowns.theta(&z)?;
        let Some(predicted) = self.predictor.at(&theta, true)? else {
            return Ok(None);
        };
        let p = theta.len();
        let n = z.len();
        let mut state = State {
            residuals: self.residuals(&z, &predicted.values)?,
            slopes: Vec::new(),
            cost: 0.0,
            z,
            theta,
            predicted,
        };
        state.slopes = try_vec(state.residuals.len() * n, 0.0, CONTEXT)?;
        let mut row = 0;
        for set in self.predictor.data {
            for i in 0..set.x.len() {
                for weight in set.weights(i) {
                    for k in 0..p {
                        if let Some((free, factor)) = self.unknowns.slope(k, &state.z) {
                            state.slopes[row * n + free] += weight * factor * state.predicted.slopes[row * p + k];
                        }
                    }
                    row += 1;
                }
            }
        }
        for (k, free) in self.unknowns.free.iter().enumerate() {
            let Some((_, sigma)) = free.prior else { continue };
            let value = self.unknowns.value(k, state.z[k]);
            state.slopes[row * n + k] = if free.is_log { value } else { 1.0 } / sigma;
            row += 1;
        }
        let state = self.weighed(state);
        Ok(state.cost.is_finite().then_some(state))
    }

    /// The state at other values of the free unknowns, so near that the model is linear; the derivatives are kept.
    fn along(&self, mut state: State, z: Vec<f64>) -> Result<State> {
        let theta = self.unknowns.theta(&z)?;
        let predicted = &mut state.predicted;
        for (value, row) in predicted
            .values
            .iter_mut()
            .zip(predicted.slopes.chunks_exact(theta.len()))
        {
            let changes = theta.iter().zip(&state.theta).map(|(new, old)| new - old);
            *value += row
                .iter()
                .zip(changes)
                .map(|(slope, change)| slope * change)
                .sum::<f64>();
        }
        state.residuals = self.residuals(&z, &state.predicted.values)?;
        state.theta = theta;
        state.z = z;
        Ok(self.weighed(state))
    }

    /// Residuals of the data, then of the priors.
    fn residuals(&self, z: &[f64], values: &[f64]) -> Result<Vec<f64>> {
        let mut found = residuals(self.predictor.data, values)?;
        for (k, free) in self.unknowns.free.iter().enumerate() {
            if let Some((mean, sigma)) = free.prior {
                try_push(&mut found, (self.unknowns.value(k, z[k]) - mean) / sigma, CONTEXT)?;
            }
        }
        Ok(found)
    }

    /// The state, with its loss computed from the residuals.
    pub fn weighed(&self, mut state: State) -> State {
        // A prior is no outlier.
        let (data, priors) = state.residuals.split_at(self.predictor.rows());
        let of_data: f64 = data.iter().map(|r| self.options.loss.cost(*r)).sum();
        state.cost = of_data + priors.iter().map(|r| r * r).sum::<f64>();
        state
    }

    /// JᵀWJ and JᵀWr, the priors with weight 1; without `robust` all weights are 1.
    pub fn normal_equations(&self, state: &State, robust: bool) -> Result<(Vec<f64>, Vec<f64>)> {
        let n = state.z.len();
        let data = self.predictor.rows();
        let mut h = try_vec(n * n, 0.0, CONTEXT)?;
        let mut g = try_vec(n, 0.0, CONTEXT)?;
        for (i, (r, row)) in state.residuals.iter().zip(state.slopes.chunks_exact(n)).enumerate() {
            let weight = match self.options.loss {
                Loss::Huber(_) if robust && i < data => self.options.loss.weight(*r),
                _ => 1.0,
            };
            for (a, x) in row.iter().enumerate() {
                g[a] += weight * r * x;
                for (b, y) in row.iter().enumerate() {
                    h[a * n + b] += weight * x * y;
                }
            }
        }
        Ok((h, g))
    }

    /// Whether each unknown may move; those at a bound may not where the gradient points out of it.
    pub fn moves(&self, z: &[f64], g: &[f64]) -> Result<Vec<bool>> {
        let mut moves = try_vec(z.len(), true, CONTEXT)?;
        for (k, free) in self.unknowns.free.iter().enumerate() {
            moves[k] = !((z[k] <= free.lower && g[k] > 0.0) || (z[k] >= free.upper && g[k] < 0.0));
        }
        Ok(moves)
    }

    /// Searches from a state for the least loss. `report` is called with each iteration and its state; it stops the
    /// search by returning `true`.
    ///
    /// # Errors
    /// Those of the predictor.
    pub fn from(&self, first: State, report: &mut dyn FnMut(usize, &State) -> bool) -> Result<Found> {
        let interrupt = self.predictor.interrupt;
        let mut state = first;
        let mut lambda = FIT_DAMPING.0;
        let mut iterations = 0;
        let mut converged = false;
        // Many data are dear: the last step of them takes no further evaluation.
        let is_dear = self.predictor.rows() >= 2 * FIT_THINNED_FROM;
        let end = if self.options.step < FIT_STEP {
            0.0
        } else {
            self.options.step.max(FIT_DEAR_STEP)
        };
        let mut before = f64::INFINITY;
        while iterations < self.options.max_iterations && !report(iterations, &state) {
            iterations += 1;
            let (h, g) = self.normal_equations(&state, true)?;
            let n = g.len();
            let moves = self.moves(&state.z, &g)?;
            let mut step = marquardt_step(&h, &g, lambda, &moves, interrupt)?;
            let mut z = crate::error::try_copy(&state.z, CONTEXT)?;
            for (k, free) in self.unknowns.free.iter().enumerate() {
                if free.is_log {
                    step[k] = step[k].clamp(-FIT_LARGEST_LOG_STEP, FIT_LARGEST_LOG_STEP);
                }
                z[k] = (z[k] + step[k]).clamp(free.lower, free.upper);
                step[k] = z[k] - state.z[k];
            }
            let along = |v: &[f64]| -> f64 {
                let row = |a: usize| (0..n).map(|b| h[a * n + b] * v[b]).sum::<f64>();
                (0..n).map(|a| v[a] * row(a)).sum()
            };
            let in_sigmas = along(&step).max(0.0).sqrt();
            let foretold = -(2.0 * step.iter().zip(&g).map(|(s, g)| s * g).sum::<f64>() + along(&step));
            if in_sigmas < self.options.step && lambda <= FIT_DAMPING.0 {
                // A state that differs by less than the step takes as long as any other.
                converged = true;
                break;
            }
            let rate = if before.is_finite() { in_sigmas / before } else { 1.0 };
            if is_dear && lambda < FIT_DAMPING.0 && in_sigmas < FIT_LINEAR_STEP && rate * in_sigmas < end {
                state = self.along(state, z)?;
                converged = true;
                break;
            }
            let trial = self.at(z)?;
            let better = trial.as_ref().is_some_and(|t| t.cost <= state.cost);
            if let (true, Some(trial)) = (better, trial) {
                state = trial;
                before = in_sigmas;
                lambda = (lambda * FIT_DAMPING.1).max(FIT_DAMPING_BOUNDS.0);
                converged = in_sigmas < self.options.step;
            } else {
                lambda *= FIT_DAMPING.2;
                converged = in_sigmas < self.options.step || foretold.abs() < FIT_ROUNDING * self.options.step;
            }
            if converged || lambda > FIT_DAMPING_BOUNDS.1 {
                break;
            }
        }
        Ok(Found {
            state,
            iterations,
            converged,
        })
    }
}

/// Residuals of the data in standard deviations.
fn residuals(data: &[FitData<'_>], values: &[f64]) -> Result<Vec<f64>> {
    let mut found = try_vec(values.len(), 0.0, CONTEXT)?;
    let mut row = 0;
    for set in data {
        for (i, z) in set.value.iter().enumerate() {
            for (weight, datum) in set.weights(i).into_iter().zip([z.re, z.im]) {
                if weight > 0.0 {
                    found[row] = weight * (values[row] - datum);
                }
                row += 1;
            }
        }
    }
    Ok(found)
}
