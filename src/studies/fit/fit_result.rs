//! Result of a fit: the values of least loss, their covariance, what the data tell.

use crate::error::{Result, Status, try_copy, try_vec};
use crate::model::Model;
use crate::studies::fit::fit_data::FitData;
use crate::studies::fit::fit_search::{FitSearch, Found, State};
use crate::studies::fit::identifiability::condition;
use crate::studies::fit::marquardt_step::inverse;
use crate::studies::fit::suspected_units::Suspicion;

const CONTEXT: &str = "the result of a fit";

/// χ² over the degrees of freedom above which units are suspected and other starts are tried.
/// Kind: tuned; measured on: not recorded.
const FIT_POOR: f64 = 9.0;

/// Result of a fit: values, their covariance, and how well the data are explained.
#[derive(Debug)]
pub struct Fit {
    /// `Ok`; `StoppedMaxPoints` where the iterations did not suffice, `StoppedStalled` where no step lowers the loss any more,
    /// `StoppedByCaller`.
    pub status: Status,
    /// Fitted values of the parameters, in the order in which they were given.
    pub theta: Vec<f64>,
    /// Covariance of the parameters, row after row; 0 for fixed parameters and for those at a bound.
    pub covariance: Vec<f64>,
    /// Whether each parameter lies at one of its bounds.
    pub at_bound: Vec<bool>,
    /// Sum of squares Σ r² over data and priors.
    pub chi2: f64,
    /// Number of data and priors minus the number of free unknowns.
    pub degrees_of_freedom: i64,
    /// Loss Σ ρ(r) over data and priors; equal to χ² without a robust loss.
    pub loss: f64,
    /// Number of data; a complex amplitude counts as two.
    pub data: usize,
    /// Number of free unknowns.
    pub free: usize,
    /// Number of iterations from the start that led to this result.
    pub iterations: usize,
    /// Number of starts from which the search was made.
    pub starts: usize,
    /// Residuals in standard deviations, two for each datum, set after set; 0 for numbers that are not used as data.
    pub residuals: Vec<f64>,
    /// Predictions of the fitted model, two for each datum, set after set.
    pub values: Vec<f64>,
    /// Condition of the fit: largest over smallest eigenvalue of its matrix, scaled to unit diagonal.
    pub condition: f64,
    /// Largest estimated error by harmonics over the standard deviation of its datum; NaN where none was estimated.
    pub harmonic_error: f64,
    /// Whether each contact slips at any point of the data.
    pub slips: Vec<bool>,
    /// Suspicion that the data have other units than the model.
    pub suspicion: Suspicion,
    /// The model with the fitted values of those parameters that all data sets share.
    pub model: Model,
}

impl Fit {
    /// Sentence about a search that ended early; empty if it found the least loss.
    #[must_use]
    pub fn early_end(&self) -> &'static str {
        match self.status {
            Status::StoppedMaxPoints => {
                "max_iterations was reached; the values of the least loss so far are kept; raise max_iterations, or start nearer"
            }
            Status::StoppedStalled => {
                "no step lowers the loss any more, though the gradient is not zero; the values of the least loss are kept: \
                 the loss may have a kink there, as where a contact begins to slip"
            }
            Status::StoppedByCaller => {
                "stopped by the progress hook or the cancel flag; the values of the least loss so far are kept"
            }
            _ => "",
        }
    }

    /// Akaike's information criterion χ² + 2k with k free unknowns, for known standard deviations.
    #[must_use]
    pub fn aic(&self) -> f64 {
        self.chi2 + 2.0 * self.free as f64
    }

    /// Schwarz's information criterion χ² + k ln n with k free unknowns and n data.
    #[must_use]
    pub fn bic(&self) -> f64 {
        self.chi2 + self.free as f64 * (self.data as f64).ln()
    }
}

/// The best end over all searches.
pub(super) struct Ended {
    pub(super) found: Found,
    pub(super) starts: usize,
    pub(super) stopped: bool,
}

/// Number of data; and number of data and priors minus number of free unknowns.
pub(super) fn sizes(search: &FitSearch<'_>) -> (usize, i64) {
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
pub(super) fn is_poor(search: &FitSearch<'_>, state: &State) -> bool {
    state.cost > FIT_POOR * sizes(search).1.max(1) as f64
}

/// The result of the searches, with its covariance.
///
/// # Errors
/// `Singular` where the data do not tell the unknowns; those of the model; `OutOfMemory`, `StoppedByCaller`.
pub(super) fn result(search: &FitSearch<'_>, ended: Ended, suspicion: Suspicion) -> Result<Fit> {
    let FitSearch {
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
