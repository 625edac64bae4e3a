//! Profile of the likelihood of a fit: the least loss over the values of one parameter, all others fitted again. Its interval holds where
//! the data depend on the parameters so strongly curved that the covariance does not (Venzon & Moolgavkar 1988, doi:10.2307/2347496).

use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::sensitivity::Parameter;
use crate::studies::fit::fit_data::FitData;
use crate::studies::fit::fit_options::FitOptions;
use crate::studies::fit::fit_result::sizes;
use crate::studies::fit::fit_search::{FitSearch, State};
use crate::studies::fit::fit_unknowns::{Unknown, Unknowns};
use crate::studies::fit::preparation::{check, predictor};
use crate::studies::fit::searches::{Searched, searched};

const CONTEXT: &str = "the profile of a fit";

/// Fall of the loss below that of the fit from which the fit is told not to be the best one: a hundredth of a standard deviation.
/// Kind: tuned; measured on: not recorded.
const PROFILE_BETTER: f64 = 1e-4;

/// Distance from a bound, relative to it, that is rounding.
/// Kind: rounding.
const PROFILE_ROUNDING: f64 = 1e-14;

/// The parameter whose values are scanned.
#[derive(Clone, Copy, Debug)]
pub struct Profiled<'a> {
    /// Values of all parameters that were fitted.
    pub theta: &'a [f64],
    /// Index of the scanned parameter in `theta`. Parameters that are tied to it are scanned with it.
    pub number: usize,
    /// Values of the scanned parameter, in ascending order.
    pub values: &'a [f64],
}

/// Least loss of a fit over the values of one parameter.
#[derive(Clone, Debug)]
pub struct FitProfile {
    /// Status: `Ok`, or `StoppedByCaller` with the values so far.
    pub status: Status,
    /// Values of the scanned parameter.
    pub values: Vec<f64>,
    /// Least loss at each value, priors included; χ² without a robust loss; NaN where no fit was found.
    pub loss: Vec<f64>,
    /// Values of all parameters at each value of the scanned one, row after row; NaN where no fit was found.
    pub theta: Vec<f64>,
    /// Loss of the fit itself.
    pub best: f64,
    /// Rise of the loss that is one standard deviation: 1, or χ² over the degrees of freedom where the covariance is scaled by it.
    pub unit: f64,
}

impl FitProfile {
    /// Interval of the parameter in which the loss exceeds that of the fit by at most `rise` units: 3.841 for 95 %, 1
    /// for one standard deviation. Between two values the root of the excess is interpolated linearly. An end is
    /// infinite where the scan does not reach it.
    #[must_use]
    pub fn interval(&self, rise: f64) -> (f64, f64) {
        let above = |i: usize| (self.loss[i] - self.best).max(0.0).sqrt() - (rise * self.unit).sqrt();
        let known = |i: &usize| self.loss[*i].is_finite();
        let least = (0..self.loss.len())
            .filter(known)
            .min_by(|i, j| self.loss[*i].total_cmp(&self.loss[*j]));
        let Some(least) = least else {
            return (f64::NEG_INFINITY, f64::INFINITY);
        };
        let crossing = |inner: usize, outer: usize| {
            let (a, b) = (above(inner), above(outer));
            let inside = known(&inner) && known(&outer) && a <= 0.0 && b > 0.0;
            inside.then(|| self.values[inner] + a / (a - b) * (self.values[outer] - self.values[inner]))
        };
        let low = (1..=least).rev().find_map(|i| crossing(i, i - 1));
        let high = (least + 1..self.loss.len()).find_map(|i| crossing(i - 1, i));
        (low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY))
    }
}

/// Computes the least loss at each value of one parameter. Values are taken outwards from that of the fit, each
/// starting from its neighbour. The other arguments are those of the fit. If a loss is below that of the fit, the log
/// warns that the fit was not the best one.
///
/// # Errors
/// `Dimension`, `Argument` or `NotFinite` for the scanned parameter, those of [`fit`](crate::fit) but that the data need not tell the
/// others; `NoConvergence` where the model has no solution at the values of the fit.
pub fn fit_profile(
    model: &Model,
    (parameters, unknowns): (&[Parameter<'_>], &[Unknown]),
    data: &[FitData<'_>],
    (solver, options): (&SolverOptions, &FitOptions),
    of: &Profiled<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<FitProfile> {
    check(model, parameters, data, (solver, options))?;
    of.check(unknowns)?;
    let at_fit = Profiled::started(unknowns, of.theta)?;
    let all = Unknowns::new(model, (parameters, &at_fit), data.len())?;
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::Results, 0.0)?;
    let own = model.separate_clone()?;
    let predictor = predictor(&own, parameters, &all.scopes, data, solver, &interrupt);
    let search = FitSearch {
        predictor: &predictor,
        unknowns: &all,
        options,
    };
    let mut z = Vec::new();
    for free in &all.free {
        try_push(&mut z, free.start, CONTEXT)?;
    }
    let Some(state) = search.at(z)? else {
        return fail!(NoConvergence, "the model has no solution for all data at theta");
    };
    let degrees = sizes(&search).1;
    let chi2 = state.residuals.iter().map(|r| r * r).sum::<f64>();
    let (n, p) = (of.values.len(), parameters.len());
    let mut profile = FitProfile {
        status: Status::Ok,
        values: try_copy(of.values, CONTEXT)?,
        loss: try_vec(n, f64::NAN, CONTEXT)?,
        theta: try_vec(n * p, f64::NAN, CONTEXT)?,
        best: state.cost,
        unit: if options.scale_covariance && degrees > 0 {
            chi2 / degrees as f64
        } else {
            1.0
        },
    };
    let above = of.values.partition_point(|x| *x < of.theta[of.number]);
    let below = (0..above).rev().map(|i| (i, i + 1 == above));
    let mut near = try_copy(of.theta, CONTEXT)?;
    for (i, is_first) in below.chain((above..n).map(|i| (i, i == above))) {
        if is_first {
            near.copy_from_slice(of.theta);
        }
        let fixed = of.held(unknowns, &near, of.values[i])?;
        let held = Unknowns::new(model, (parameters, &fixed), data.len())
            .map_err(|e| e.at(format_args!("values[{i}] = {}", of.values[i])))?;
        let search = FitSearch {
            unknowns: &held,
            ..search
        };
        match least(&search, hooks)? {
            Least::Found(state) => {
                near.copy_from_slice(&state.theta);
                profile.theta[i * p..(i + 1) * p].copy_from_slice(&near);
                profile.loss[i] = state.cost + of.known(unknowns, &fixed);
            }
            Least::NoSolution => {}
            Least::Stopped => {
                profile.status = Status::StoppedByCaller;
                return Ok(profile);
            }
        }
    }
    let size = profile.best.max(1.0);
    if profile
        .loss
        .iter()
        .any(|loss| *loss < profile.best - PROFILE_BETTER * size)
    {
        hooks.log(
            LogLevel::Warn,
            "the profile has a smaller loss than the fit: fit again from its values there",
        );
    }
    Ok(profile)
}

/// Outcome of the search at one value.
enum Least {
    Found(Box<State>),
    NoSolution,
    Stopped,
}

/// The state of least loss over the free unknowns; where none is free, the state at their values.
fn least(search: &FitSearch<'_>, hooks: &mut Hooks<'_>) -> Result<Least> {
    if search.unknowns.free.is_empty() {
        let state = search.at(Vec::new())?;
        return Ok(state.map_or(Least::NoSolution, |state| Least::Found(Box::new(state))));
    }
    Ok(match searched(search, hooks)? {
        Searched::Ended(ended, _) if ended.stopped => Least::Stopped,
        Searched::Ended(ended, _) => Least::Found(Box::new(ended.found.state)),
        Searched::StoppedEarly(_) => Least::Stopped,
        Searched::NoSolution => Least::NoSolution,
    })
}

impl Profiled<'_> {
    fn check(&self, unknowns: &[Unknown]) -> Result<()> {
        let p = unknowns.len();
        if self.theta.len() != p {
            return fail!(Dimension, "theta has {} numbers, needs {p}", self.theta.len());
        }
        if self.number >= p {
            return fail!(Argument, "number = {}, needs 0 .. {}", self.number, p.saturating_sub(1));
        }
        if self.values.is_empty() {
            return fail!(Dimension, "values is empty, needs at least one number");
        }
        for (name, list) in [("theta", self.theta), ("values", self.values)] {
            if let Some(i) = list.iter().position(|x| !x.is_finite()) {
                return fail!(NotFinite, "{name}[{i}] = {}, needs a finite number", list[i]);
            }
        }
        if let Some(i) = (1..self.values.len()).find(|&i| self.values[i] <= self.values[i - 1]) {
            return fail!(
                Argument,
                "values[{i}] = {} after {}, needs ascending values",
                self.values[i],
                self.values[i - 1]
            );
        }
        Ok(())
    }

    /// Index of the unknown that an unknown follows by its ties.
    fn leader(unknowns: &[Unknown], mut number: usize) -> usize {
        // Ties lead to earlier ones; others are refused elsewhere.
        while let Some(earlier) = unknowns[number].tied_to.filter(|earlier| *earlier < number) {
            number = earlier;
        }
        number
    }

    /// The unknowns, with starts at the given values of all parameters.
    fn started(unknowns: &[Unknown], theta: &[f64]) -> Result<Vec<Unknown>> {
        let mut list = Vec::new();
        for (unknown, start) in unknowns.iter().zip(theta) {
            let (low, high) = (
                unknown.lower.unwrap_or(f64::NEG_INFINITY),
                unknown.upper.unwrap_or(f64::INFINITY),
            );
            // A value at a bound may have left it by rounding of its logarithm.
            let close = |bound: f64| (start - bound).abs() <= PROFILE_ROUNDING * bound.abs();
            let start = match unknown.tied_to {
                None if *start < low && close(low) => low,
                None if *start > high && close(high) => high,
                _ => *start,
            };
            let moved = Unknown {
                start: Some(start),
                ..*unknown
            };
            try_push(&mut list, moved, CONTEXT)?;
        }
        Ok(list)
    }

    /// The unknowns with starts near the given values, and with the scanned one and all unknowns tied to it held at
    /// `value`.
    fn held(&self, unknowns: &[Unknown], near: &[f64], value: f64) -> Result<Vec<Unknown>> {
        let leader = Self::leader(unknowns, self.number);
        let factor = value / near[self.number];
        let mut theta = try_copy(near, CONTEXT)?;
        for (i, x) in theta.iter_mut().enumerate() {
            if Self::leader(unknowns, i) == leader {
                *x = if i == self.number { value } else { *x * factor };
            }
        }
        if !theta[leader].is_finite() {
            return fail!(
                Argument,
                "number = {}: its value is 0, and it follows that of {leader}; scan that one",
                self.number
            );
        }
        let mut list = Self::started(unknowns, &theta)?;
        list[leader] = Unknown {
            start: Some(theta[leader]),
            lower: Some(theta[leader]),
            upper: Some(theta[leader]),
            ..list[leader]
        };
        Ok(list)
    }

    /// Loss by the prior of the scanned parameter, which is held.
    fn known(&self, unknowns: &[Unknown], held: &[Unknown]) -> f64 {
        let leader = Self::leader(unknowns, self.number);
        let value = held[leader].start.unwrap_or(0.0);
        unknowns[leader]
            .prior
            .map_or(0.0, |(mean, sigma)| ((value - mean) / sigma).powi(2))
    }
}
