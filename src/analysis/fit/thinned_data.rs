//! A first search on a share of many data: as near to the end as their deviations tell, at a share of the cost.

use crate::analysis::fit::fit_data::{DataKind, FitData};
use crate::analysis::fit::fit_options::{FIT_THINNED_FROM, FitOptions};
use crate::analysis::fit::fit_search::{Search, State};
use crate::analysis::fit::predicted_data::Predictor;
use crate::error::{Result, try_push};
use num_complex::Complex64;

const CONTEXT: &str = "the first search of a fit";

/// Data points of the share for each unknown, and the most points of which one is kept.
const FIT_THINNED_POINTS: usize = 10;
const FIT_THINNED_MOST: usize = 8;

/// Step in standard deviations of the share at which the first search ends: all data move the end by more than one of their own.
const FIT_THINNED_STEP: f64 = 0.3;

/// Data of a set in memory of their own.
struct Share {
    x: Vec<f64>,
    value: Vec<Complex64>,
    sigma: Vec<f64>,
    second_sigma: Vec<f64>,
}

impl Share {
    fn of(set: &FitData<'_>, stride: usize) -> Result<Self> {
        let mut share = Self {
            x: Vec::new(),
            value: Vec::new(),
            sigma: Vec::new(),
            second_sigma: Vec::new(),
        };
        let stride = if is_thinned(set) { stride } else { 1 };
        for i in (0..set.x.len()).skip((stride - 1) / 2).step_by(stride) {
            try_push(&mut share.x, set.x[i], CONTEXT)?;
            try_push(&mut share.value, set.value[i], CONTEXT)?;
            try_push(&mut share.sigma, set.sigma[i], CONTEXT)?;
            if let Some(sigma) = set.second_sigma.get(i) {
                try_push(&mut share.second_sigma, *sigma, CONTEXT)?;
            }
        }
        Ok(share)
    }
}

/// Whether a set is dense enough to be thinned; peaks are few and dear.
fn is_thinned(set: &FitData<'_>) -> bool {
    matches!(set.kind, DataKind::Response | DataKind::Amplitude) && set.x.len() > FIT_THINNED_MOST
}

/// Unknowns from which a search on all data is short; `None` where there are few data, or a share of them is not explained.
///
/// # Errors
/// Those of the predictor.
pub(super) fn start(
    search: &Search<'_>,
    z: &[f64],
    explains: impl Fn(&Search<'_>, &State) -> bool,
    report: &mut dyn FnMut(usize, &State) -> bool,
) -> Result<Option<Vec<f64>>> {
    let predictor = search.predictor;
    let points: usize = predictor.data.iter().map(|set| set.x.len()).sum();
    let stride = (points / (FIT_THINNED_POINTS * z.len())).min(FIT_THINNED_MOST);
    if points < FIT_THINNED_FROM || stride < 2 || !predictor.data.iter().any(is_thinned) {
        return Ok(None);
    }
    let mut shares = Vec::new();
    for set in predictor.data {
        try_push(&mut shares, Share::of(set, stride)?, CONTEXT)?;
    }
    let mut data = Vec::new();
    for (set, share) in predictor.data.iter().zip(&shares) {
        let range = if is_thinned(set) {
            Some(set.followed()).filter(|(low, high)| high > low)
        } else {
            set.range
        };
        let thinned = FitData {
            range,
            x: &share.x,
            value: &share.value,
            sigma: &share.sigma,
            second_sigma: &share.second_sigma,
            ..*set
        };
        try_push(&mut data, thinned, CONTEXT)?;
    }
    let predictor = Predictor {
        data: &data,
        ..*predictor
    };
    let options = FitOptions {
        step: search.options.step.max(FIT_THINNED_STEP),
        ..*search.options
    };
    let thinned = Search {
        predictor: &predictor,
        unknowns: search.unknowns,
        options: &options,
    };
    let Some(first) = thinned.at(crate::error::try_copy(z, CONTEXT)?)? else {
        return Ok(None);
    };
    let found = thinned.from(first, report)?;
    Ok(explains(&thinned, &found.state).then_some(found.state.z))
}
