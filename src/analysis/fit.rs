//! Fit of parameters of a model to data of tests, with their uncertainty.
//!
//! The residuals r = (v(θ) − datum)/σ of all data have exact derivatives by the parameters. Steps of Levenberg and Marquardt end at the
//! least loss; the covariance there is (JᵀJ + priors)⁻¹. The loop is the library's own: it has the weights of a robust loss, bounds,
//! priors, models without a solution at a trial, and the caller's interrupt, which a general optimiser would hide.

mod fit_data;
mod fit_options;
mod fit_search;
mod fit_unknowns;
mod identifiability;
mod marquardt_step;
mod predicted_data;
mod prediction;
mod shared_work;
mod suspected_units;
mod thinned_data;

pub use crate::analysis::fit::fit_data::{DataKind, FitData};
pub use crate::analysis::fit::fit_options::{FitOptions, Loss};
pub use crate::analysis::fit::fit_unknowns::{Scale, Unknown};
pub use crate::analysis::fit::prediction::{Prediction, predict};
pub use crate::analysis::fit::suspected_units::Suspicion;

use crate::analysis::fit::fit_search::{Found, Search, State};
use crate::analysis::fit::fit_unknowns::Unknowns;
use crate::analysis::fit::identifiability::condition;
use crate::analysis::fit::marquardt_step::inverse;
use crate::analysis::fit::predicted_data::Predictor;
use crate::analysis::fit::prediction::check_parameters;
use crate::analysis::fit::suspected_units::suspected;
use crate::contact::force_derivative::Constant;
use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::hooks::{Hooks, LogLevel, Progress};
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::sensitivity::Parameter;

const CONTEXT: &str = "a fit";

/// χ² over the degrees of freedom above which units are suspected and other starts are tried.
const FIT_POOR: f64 = 9.0;

/// Limit of the robust loss of the search that begins where the fit is poor: points that another branch of the model is nearest to do not
/// lead it.
const FIT_ROBUST: f64 = 1.345;

/// Fall of the loss from which a state with slip is preferred to one without: three standard deviations.
const FIT_TELLS: f64 = 9.0;

/// Share of the standard deviations of the data that errors by harmonics may have.
const FIT_SHARE_OF_SIGMA: f64 = 1.0 / 3.0;

/// Logarithms of the factors on friction and loads of the starts beside the given one: towards sliding, and towards sticking.
const FIT_LIMITS: [f64; 6] = [-1.15, 1.15, -2.3, 2.3, -4.6, 4.6];

/// Half of the width of the logarithm within which further starts lie, where there are no bounds.
const FIT_SPREAD: f64 = 1.15;

/// Result of a fit.
#[derive(Debug)]
pub struct Fit {
    /// `Ok`; `StoppedMaxPoints` where the iterations did not suffice, `StoppedStalled` where no step lowers the loss any more,
    /// `StoppedByCaller`.
    pub status: Status,
    /// Values of the parameters, in their order.
    pub theta: Vec<f64>,
    /// Their covariance, row after row; 0 for fixed ones and for those at a bound.
    pub covariance: Vec<f64>,
    /// Whether each parameter lies at one of its bounds.
    pub at_bound: Vec<bool>,
    /// Σ r² over the data and the priors.
    pub chi2: f64,
    /// Number of data and priors minus the number of free unknowns.
    pub degrees_of_freedom: i64,
    /// The loss, Σ ρ(r); χ² without a robust one.
    pub loss: f64,
    /// Number of data: two for a complex amplitude.
    pub data: usize,
    /// Number of free unknowns.
    pub free: usize,
    /// Iterations from the start that led here.
    pub iterations: usize,
    /// Starts that were searched from.
    pub starts: usize,
    /// Residuals in standard deviations, two for each datum, set after set; 0 for numbers that are no data.
    pub residuals: Vec<f64>,
    /// Values of the model, likewise.
    pub values: Vec<f64>,
    /// Largest over smallest eigenvalue of the matrix of the fit with unit diagonal.
    pub condition: f64,
    /// Largest estimated error by harmonics over the standard deviation of its datum; NaN where none was estimated.
    pub harmonic_error: f64,
    /// Whether each contact slips at any point of the data.
    pub slips: Vec<bool>,
    /// Units that the data may have.
    pub suspicion: Suspicion,
    /// The model with the values of the parameters that all data sets have.
    pub model: Model,
}

impl Fit {
    /// Criterion of Akaike, χ² + 2k with k free unknowns, under known standard deviations.
    #[must_use]
    pub fn aic(&self) -> f64 {
        self.chi2 + 2.0 * self.free as f64
    }

    /// Criterion of Schwarz, χ² + k ln n.
    #[must_use]
    pub fn bic(&self) -> f64 {
        self.chi2 + self.free as f64 * (self.data as f64).ln()
    }
}

/// Fits parameters of `model` to data. With a tolerance of the solver it is lowered where the errors by harmonics would exceed a third
/// of the standard deviations. Many data are searched by a share of them first. Where the given start fits poorly, or friction is not seen from it, starts towards sliding and sticking
/// are tried; `options.starts` adds others.
///
/// # Errors
/// `Singular` where the data do not tell the unknowns, with a sentence about the reason; `NoConvergence` where the model has no
/// solution at the start; bad options, unknowns and data; those of the analyses and of [`Parameter::check`]; `StoppedByCaller`;
/// `OutOfMemory`.
pub fn fit(
    model: &Model,
    (parameters, unknowns): (&[Parameter<'_>], &[Unknown]),
    data: &[FitData<'_>],
    solver: &SolverOptions,
    options: &FitOptions,
    hooks: &mut Hooks<'_>,
) -> Result<Fit> {
    options.check()?;
    solver.check()?;
    check_parameters(model, parameters)?;
    if data.is_empty() {
        return fail!(Dimension, "there are no data, needs at least one set");
    }
    for (i, set) in data.iter().enumerate() {
        set.check(model, true).map_err(|e| e.at(format_args!("data set {i}")))?;
    }
    let unknowns = Unknowns::new(model, (parameters, unknowns), data.len())?;
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::Results, 0.0)?;
    // Bases of waves are shared by all designs of the fit, and leave the caller's model as it is.
    let own = model.separate_clone()?;
    let predictor = Predictor {
        model: &own,
        parameters,
        scopes: &unknowns.scopes,
        data,
        solver: SolverOptions {
            tolerance: tolerance_of(data, solver.tolerance),
            ..*solver
        },
        interrupt: &interrupt,
    };
    let search = Search {
        predictor: &predictor,
        unknowns: &unknowns,
        options,
    };
    let mut z = Vec::new();
    for free in &unknowns.free {
        try_push(&mut z, free.start, CONTEXT)?;
    }
    let mut stopped = false;
    let explains = |search: &Search<'_>, state: &State| !is_poor(search, state) && !unseen(state);
    let mut told = |i: usize, state: &State| report(hooks, (i, state), &mut stopped);
    if let Some(nearer) = thinned_data::start(&search, &z, explains, &mut told)? {
        z = nearer;
    }
    let Some(first) = search.at(z)? else {
        return fail!(
            NoConvergence,
            "the model has no solution for all data at the start of the fit; give other starts"
        );
    };

    let ended = best_of(&search, &first, (hooks, stopped))?;
    let suspicion = if is_poor(&search, &ended.found.state) {
        suspected(&predictor, &first.theta)?
    } else {
        Suspicion::None
    };
    if suspicion != Suspicion::None {
        hooks.log(LogLevel::Warn, suspicion.sentence());
    }
    result(&search, ended, suspicion)
}

/// The tolerance with which errors by harmonics stay below a share of the standard deviations; 0 stays 0.
fn tolerance_of(data: &[FitData<'_>], given: f64) -> f64 {
    let mut tolerance = given;
    for set in data.iter().filter(|_| given > 0.0) {
        for (z, sigma) in set.value.iter().zip(set.sigma) {
            let size = if set.kind == DataKind::Response {
                z.norm()
            } else {
                z.re.abs()
            };
            if size > 0.0 {
                tolerance = tolerance.min(FIT_SHARE_OF_SIGMA * sigma / size);
            }
        }
    }
    tolerance
}

/// Number of data, and of data and priors minus that of free unknowns.
fn sizes(search: &Search<'_>) -> (usize, i64) {
    let of_set = |set: &FitData<'_>| {
        let counted = |i| set.weights(i).iter().filter(|w| **w > 0.0).count();
        (0..set.x.len()).map(counted).sum::<usize>()
    };
    let data: usize = search.predictor.data.iter().map(of_set).sum();
    let free = &search.unknowns.free;
    let priors = free.iter().filter(|free| free.prior.is_some()).count();
    (data, (data + priors) as i64 - free.len() as i64)
}

/// Whether a state explains the data poorly.
fn is_poor(search: &Search<'_>, state: &State) -> bool {
    state.cost > FIT_POOR * sizes(search).1.max(1) as f64
}

/// End of all searches.
struct Ended {
    found: Found,
    starts: usize,
    stopped: bool,
}

/// The best end of the searches from all starts.
fn best_of(search: &Search<'_>, first: &State, (hooks, mut stopped): (&mut Hooks<'_>, bool)) -> Result<Ended> {
    let mut starts = 1;
    let mut best = search.from(first.clone(), &mut |i, state| {
        stopped || report(hooks, (i, state), &mut stopped)
    })?;
    if !stopped && is_poor(search, &best.state) && search.options.loss == Loss::Square {
        starts += 1;
        let found = by_robust_loss(search, first, &mut |i, state| report(hooks, (i, state), &mut stopped))?;
        if found.state.cost < best.state.cost {
            best = found;
        }
    }
    let poor = is_poor(search, &best.state) || unseen(&best.state);
    if !stopped && (poor || search.options.starts > 1) {
        for state in further_starts(search, first, poor)? {
            starts += 1;
            let found = search.from(state, &mut |i, state| report(hooks, (i, state), &mut stopped))?;
            // A state that fits not much better than one that does not see an unknown does not tell it.
            let gain = if unseen(&best.state) { FIT_TELLS } else { 0.0 };
            if found.state.cost < best.state.cost - gain {
                best = found;
            }
            if stopped {
                break;
            }
        }
    }
    Ok(Ended {
        found: best,
        starts,
        stopped,
    })
}

/// The search from where a robust one ends. Beyond a fold of the model the solution nearest to a datum lies on another branch; such data
/// pull least squares away from the truth, and are outliers to a robust loss until the fold has moved.
fn by_robust_loss(search: &Search<'_>, first: &State, report: &mut dyn FnMut(usize, &State) -> bool) -> Result<Found> {
    let options = FitOptions {
        loss: Loss::Huber(FIT_ROBUST),
        ..*search.options
    };
    let robust = Search {
        options: &options,
        ..*search
    };
    let mut stopped = false;
    let mut report = |i: usize, state: &State| {
        stopped |= report(i, state);
        stopped
    };
    let found = robust.from(robust.weighed(first.clone()), &mut report)?;
    search.from(search.weighed(found.state), &mut report)
}

/// The result with its covariance.
fn result(search: &Search<'_>, ended: Ended, suspicion: Suspicion) -> Result<Fit> {
    let Search {
        predictor,
        unknowns,
        options,
    } = search;
    let interrupt = predictor.interrupt;
    let best = ended.found;
    let (h, _) = search.normal_equations(&best.state, false)?;
    let (_, g) = search.normal_equations(&best.state, true)?;
    let z = &best.state.z;
    let moves = search.moves(z, &g)?;
    let slips = &best.state.predicted.slips;
    let known = condition(&h, (unknowns, predictor.parameters), (z, slips, &moves), interrupt);
    let known = known.map_err(|e| match suspicion {
        Suspicion::None => e,
        _ => e.at(format_args!("{}", suspicion.sentence())),
    })?;
    let (data, degrees) = sizes(search);
    let chi2 = best.state.residuals.iter().map(|r| r * r).sum::<f64>();
    let mut factor = options.loss.inefficiency();
    if options.scale_covariance && degrees > 0 {
        factor *= chi2 / degrees as f64;
    }
    let of_free = inverse(&h, &moves, interrupt)?;
    let (p, n) = (unknowns.parameters(), z.len());
    let mut covariance = try_vec(p * p, 0.0, CONTEXT)?;
    let mut at_bound = try_vec(p, false, CONTEXT)?;
    for i in 0..p {
        let Some((a, by_a)) = unknowns.slope(i, z) else {
            continue;
        };
        at_bound[i] = !moves[a];
        for j in 0..p {
            if let Some((b, by_b)) = unknowns.slope(j, z) {
                covariance[i * p + j] = factor * by_a * by_b * of_free[a * n + b];
            }
        }
    }
    let status = match (ended.stopped, best.converged, best.iterations >= options.max_iterations) {
        (true, ..) => Status::StoppedByCaller,
        (_, true, _) => Status::Ok,
        (_, _, true) => Status::StoppedMaxPoints,
        _ => Status::StoppedStalled,
    };
    Ok(Fit {
        status,
        model: predictor.common_model(&best.state.theta)?,
        covariance,
        at_bound,
        chi2,
        degrees_of_freedom: degrees,
        loss: best.state.cost,
        data,
        free: n,
        iterations: best.iterations,
        starts: ended.starts,
        residuals: try_copy(&best.state.residuals[..predictor.rows()], CONTEXT)?,
        condition: known,
        harmonic_error: best.state.predicted.harmonic_error,
        slips: best.state.predicted.slips,
        values: best.state.predicted.values,
        theta: best.state.theta,
        suspicion,
    })
}

/// Reports an iteration as a point whose parameter is the loss.
fn report(hooks: &mut Hooks<'_>, (iteration, state): (usize, &State), stopped: &mut bool) -> bool {
    let progress = Progress {
        point: iteration + 1,
        parameter: state.cost,
        amplitude: state.theta.first().copied().unwrap_or(0.0),
        ..Progress::default()
    };
    *stopped |= hooks.report(&progress);
    *stopped
}

/// Whether an unknown has no effect at a state.
fn unseen(state: &State) -> bool {
    let n = state.z.len();
    (0..n).any(|k| state.slopes.iter().skip(k).step_by(n).all(|x| *x == 0.0))
}

/// Further points to begin from, the best ones of those that are tried.
fn further_starts(search: &Search<'_>, first: &State, poor: bool) -> Result<Vec<State>> {
    let parameters = search.predictor.parameters;
    let free = &search.unknowns.free;
    let mut tried: Vec<State> = Vec::new();
    let mut attempt = |z: Vec<f64>| -> Result<()> {
        if let Some(state) = search.at(z)? {
            try_push(&mut tried, state, CONTEXT)?;
        }
        Ok(())
    };
    let is_limit = |k: usize| {
        let Parameter::Contact { constant, .. } = parameters[free[k].parameter] else {
            return false;
        };
        free[k].is_log && matches!(constant, Constant::Mu | Constant::Preload)
    };
    if poor && (0..free.len()).any(is_limit) {
        for factor in FIT_LIMITS {
            let mut z = try_copy(&first.z, CONTEXT)?;
            for (k, z) in z.iter_mut().enumerate().filter(|(k, _)| is_limit(*k)) {
                *z = (*z + factor).clamp(free[k].lower, free[k].upper);
            }
            attempt(z)?;
        }
    }
    for number in 1..search.options.starts {
        let mut z = try_copy(&first.z, CONTEXT)?;
        for (k, z) in z.iter_mut().enumerate() {
            let of = &free[k];
            let half = if of.is_log {
                FIT_SPREAD
            } else {
                0.5 * of.start.abs().max(1.0)
            };
            let low = if of.lower.is_finite() {
                of.lower
            } else {
                of.start - half
            };
            let high = if of.upper.is_finite() {
                of.upper
            } else {
                of.start + half
            };
            *z = low + (high - low) * halton(number, k);
        }
        attempt(z)?;
    }
    tried.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    tried.truncate(search.options.starts.max(2) - 1 + usize::from(poor));
    Ok(tried)
}

/// A number of the sequence of Halton (1960, doi:10.1007/BF01386213), within 0 .. 1.
fn halton(number: usize, dimension: usize) -> f64 {
    /// Bases of the dimensions, the first primes.
    const PRIMES: [usize; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
    let base = PRIMES[dimension % PRIMES.len()];
    let (mut rest, mut share, mut found) = (number, 1.0, 0.0);
    while rest > 0 {
        share /= base as f64;
        found += share * (rest % base) as f64;
        rest /= base;
    }
    found
}
