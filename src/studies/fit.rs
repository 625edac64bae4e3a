//! Fit of parameters of a model to data of tests, with their uncertainty.
//!
//! The residuals r = (v(θ) − datum)/σ of all data have exact derivatives by the parameters. Steps of Levenberg and Marquardt end at the
//! least loss; the covariance there is (JᵀJ + priors)⁻¹. The loop is the library's own: it has the weights of a robust loss, bounds,
//! priors, models without a solution at a trial, and the caller's interrupt, which a general optimiser would hide.

mod fit_data;
mod fit_options;
mod fit_profile;
mod fit_result;
mod fit_search;
mod fit_unknowns;
mod further_starts;
mod identifiability;
mod marquardt_step;
mod predicted_data;
mod prediction;
mod preparation;
mod searches;
mod shared_work;
mod suspected_units;
mod thinned_data;

pub use crate::studies::fit::fit_data::{DataKind, FitData};
pub use crate::studies::fit::fit_options::{FitOptions, Loss};
pub use crate::studies::fit::fit_profile::{FitProfile, Profiled, fit_profile};
pub use crate::studies::fit::fit_result::Fit;
pub use crate::studies::fit::fit_unknowns::{Scale, Unknown};
pub use crate::studies::fit::prediction::{Prediction, predict};
pub use crate::studies::fit::suspected_units::Suspicion;

use crate::error::{Result, fail};
use crate::hooks::{Hooks, LogLevel};
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::sensitivity::Parameter;
use crate::studies::fit::fit_result::{is_poor, result};
use crate::studies::fit::fit_search::FitSearch;
use crate::studies::fit::fit_unknowns::Unknowns;
use crate::studies::fit::preparation::{check, predictor};
use crate::studies::fit::searches::{Searched, searched};
use crate::studies::fit::suspected_units::suspected;

/// Fits parameters of `model` to data. If the solver has a tolerance, it is lowered where errors by harmonics would
/// exceed a third of the standard deviations. Many data are first replaced by a share of them; a fit that is stopped
/// in this stage returns the result of the share. Where the given start fits poorly, or the data do not depend on
/// friction there, starts towards sliding and sticking are tried; `options.starts` adds others.
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
    check(model, parameters, data, (solver, options))?;
    let unknowns = Unknowns::new(model, (parameters, unknowns), data.len())?;
    if unknowns.free.is_empty() {
        return fail!(Argument, "every unknown is fixed; needs one that is free");
    }
    let interrupt = hooks.interrupt();
    interrupt.phase(Phase::Results, 0.0)?;
    let own = model.separate_clone()?;
    let predictor = predictor(&own, parameters, &unknowns.scopes, data, solver, &interrupt);
    let search = FitSearch {
        predictor: &predictor,
        unknowns: &unknowns,
        options,
    };
    let (ended, start) = match searched(&search, hooks)? {
        Searched::Ended(ended, start) => (ended, start),
        Searched::StoppedEarly(found) => return Ok(*found),
        Searched::NoSolution => {
            return fail!(
                NoConvergence,
                "the model has no solution for all data at the start of the fit; give other starts"
            );
        }
    };
    let suspicion = if is_poor(&search, &ended.found.state) {
        suspected(&predictor, &start)?
    } else {
        Suspicion::None
    };
    if suspicion != Suspicion::None {
        hooks.log(LogLevel::Warn, suspicion.sentence());
    }
    result(&search, *ended, suspicion)
}
