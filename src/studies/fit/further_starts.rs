//! Further starts of a fit: towards sliding, towards sticking, and points within the bounds.

use crate::contact::forms::constants::Constant;
use crate::error::{Result, try_copy, try_push};
use crate::sensitivity::Parameter;
use crate::studies::fit::fit_search::{FitSearch, State};

const CONTEXT: &str = "further starts of a fit";

/// Half of the width of the logarithm within which further starts lie, where there are no bounds, and the smallest logarithm of a factor on
/// friction and loads of the starts beside the given one: half a decade.
/// Kind: tuned; measured on: not recorded.
const FIT_SPREAD: f64 = 1.15;

/// Further starts of the search: the best of those that are tried.
///
/// # Errors
/// Those of the predictor.
pub(super) fn further_starts(search: &FitSearch<'_>, first: &State, poor: bool) -> Result<Vec<State>> {
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
        // Towards sliding, and towards sticking.
        for factor in [-1.0, 1.0, -2.0, 2.0, -4.0, 4.0].map(|way| way * FIT_SPREAD) {
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

/// Element `number` of Halton's sequence (1960, doi:10.1007/BF01386213) in one dimension, within 0 .. 1.
fn halton(number: usize, dimension: usize) -> f64 {
    /// Bases of the dimensions, the first primes.
    /// Kind: fixed.
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
