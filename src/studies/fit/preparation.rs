//! Checks of a fit and of its profiles, and the tolerance that their data need.

use crate::error::{Result, fail};
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::sensitivity::Parameter;
use crate::studies::fit::fit_data::{DataKind, FitData};
use crate::studies::fit::fit_options::FitOptions;
use crate::studies::fit::predicted_data::Predictor;
use crate::studies::fit::prediction::check_parameters;

/// Share of the standard deviations of the data that errors by harmonics may have.
/// Kind: tuned; measured on: not recorded.
const FIT_SHARE_OF_SIGMA: f64 = 1.0 / 3.0;

/// Checks options, parameters and data.
///
/// # Errors
/// Those of each, naming it.
pub(super) fn check(
    model: &Model,
    parameters: &[Parameter<'_>],
    data: &[FitData<'_>],
    (solver, options): (&SolverOptions, &FitOptions),
) -> Result<()> {
    options.check()?;
    solver.check()?;
    check_parameters(model, parameters)?;
    if data.is_empty() {
        return fail!(Dimension, "there are no data, needs at least one set");
    }
    for (i, set) in data.iter().enumerate() {
        set.check(model, true).map_err(|e| e.at(format_args!("data set {i}")))?;
    }
    Ok(())
}

/// Predictor of the data, on a model of the fit's own, so that all its designs share the bases of waves, and the
/// caller's model is not changed. `scopes` are the data sets of the unknowns.
pub(super) fn predictor<'a>(
    own: &'a Model,
    parameters: &'a [Parameter<'a>],
    scopes: &'a [Option<usize>],
    data: &'a [FitData<'a>],
    solver: &SolverOptions,
    interrupt: &'a Interrupt<'a>,
) -> Predictor<'a> {
    Predictor {
        model: own,
        parameters,
        scopes,
        data,
        solver: of_fit(solver, data),
        interrupt,
    }
}

/// The solver's options with the tolerance that the data need.
fn of_fit(solver: &SolverOptions, data: &[FitData<'_>]) -> SolverOptions {
    SolverOptions {
        tolerance: tolerance_of(data, solver.tolerance),
        ..*solver
    }
}

/// The tolerance with which errors by harmonics stay below a share of the standard deviations; a given tolerance of 0
/// stays 0.
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
