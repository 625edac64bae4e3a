//! All searches of a fit: on a share of the data, from the given start, by a robust loss and from further starts.

use crate::error::{Result, try_push};
use crate::hooks::{Hooks, Progress};
use crate::studies::fit::fit_options::{FitOptions, Loss};
use crate::studies::fit::fit_result::{Ended, Fit, is_poor};
use crate::studies::fit::fit_search::{FitSearch, Found, State};
use crate::studies::fit::further_starts::further_starts;
use crate::studies::fit::thinned_data::{self, Start};

const CONTEXT: &str = "the searches of a fit";

/// Limit of the robust loss of the search that begins where the fit is poor: points that another branch of the model is nearest to do not
/// lead it. With normal errors it costs 5 % of the efficiency (Huber, Robust Statistics, 1981, §4.5).
/// Kind: fixed.
const FIT_ROBUST: f64 = 1.345;

/// Fall of the loss from which a state with slip is preferred to one without: three standard deviations.
/// Kind: tuned; measured on: not recorded.
const FIT_TELLS: f64 = 9.0;

/// Outcome of all searches of a fit.
pub(super) enum Searched {
    /// The best end; and the values of the parameters from which the search on all data began.
    Ended(Box<Ended>, Vec<f64>),
    /// The caller stopped the search on a share of the data; with the result on that share.
    StoppedEarly(Box<Fit>),
    /// The model has no solution for some datum at the start.
    NoSolution,
}

/// Searches from the given start, and from others where that fits poorly.
///
/// # Errors
/// Those of the predictor.
pub(super) fn searched(search: &FitSearch<'_>, hooks: &mut Hooks<'_>) -> Result<Searched> {
    let mut z = Vec::new();
    for free in &search.unknowns.free {
        try_push(&mut z, free.start, CONTEXT)?;
    }
    let mut stopped = false;
    let explains = |search: &FitSearch<'_>, state: &State| !is_poor(search, state) && !unseen(state);
    let mut told = |i: usize, state: &State| report(hooks, i, state, &mut stopped);
    match thinned_data::start(search, &z, explains, &mut told)? {
        Start::Given => {}
        Start::Nearer(nearer) => z = nearer,
        Start::Stopped(found) => return Ok(Searched::StoppedEarly(found)),
    }
    let Some(first) = search.at(z)? else {
        return Ok(Searched::NoSolution);
    };
    let ended = best_of(search, &first, hooks, stopped)?;
    Ok(Searched::Ended(Box::new(ended), first.theta))
}

/// The best end over the searches from all starts.
fn best_of(search: &FitSearch<'_>, first: &State, hooks: &mut Hooks<'_>, mut stopped: bool) -> Result<Ended> {
    let mut starts = 1;
    let mut best = search.from(first.clone(), &mut |i, state| {
        stopped || report(hooks, i, state, &mut stopped)
    })?;
    if !stopped && is_poor(search, &best.state) && search.options.loss == Loss::Square {
        starts += 1;
        let found = by_robust_loss(search, first, &mut |i, state| report(hooks, i, state, &mut stopped))?;
        if found.state.cost < best.state.cost {
            best = found;
        }
    }
    let poor = is_poor(search, &best.state) || unseen(&best.state);
    if !stopped && (poor || search.options.starts > 1) {
        for state in further_starts(search, first, poor)? {
            starts += 1;
            let found = search.from(state, &mut |i, state| report(hooks, i, state, &mut stopped))?;
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

/// Searches from where a search with a robust loss ends. Beyond a fold of the model, the solution nearest to a datum
/// lies on another branch. Such data pull least squares away from the truth; to a robust loss they are outliers until
/// the fold has moved.
fn by_robust_loss(
    search: &FitSearch<'_>,
    first: &State,
    report: &mut dyn FnMut(usize, &State) -> bool,
) -> Result<Found> {
    let options = FitOptions {
        loss: Loss::Huber(FIT_ROBUST),
        ..*search.options
    };
    let robust = FitSearch {
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

/// Reports an iteration as a point whose parameter is the loss.
fn report(hooks: &mut Hooks<'_>, iteration: usize, state: &State, stopped: &mut bool) -> bool {
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
