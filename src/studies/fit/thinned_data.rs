//! A first search on a share of many data: as near to the end as their deviations tell, at a share of the cost.

use crate::error::{Result, try_copy, try_push, try_vec};
use crate::studies::fit::fit_data::{DataKind, FitData};
use crate::studies::fit::fit_options::{FIT_THINNED_FROM, FitOptions};
use crate::studies::fit::fit_result::{Ended, Fit, result};
use crate::studies::fit::fit_search::{FitSearch, State};
use crate::studies::fit::predicted_data::Predictor;
use crate::studies::fit::suspected_units::Suspicion;
use num_complex::Complex64;

const CONTEXT: &str = "the first search of a fit";

/// Data points of the share for each unknown, and the most points of which one is kept.
/// Kind: tuned; measured on: not recorded.
const FIT_THINNED_POINTS: usize = 10;
const FIT_THINNED_MOST: usize = 8;

/// Step in standard deviations of the share at which the first search ends: all data move the end by more than one of their own.
/// Kind: tuned; measured on: not recorded.
const FIT_THINNED_STEP: f64 = 0.3;

/// Data of a set, copied to memory of their own.
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
        for i in kept(set, stride) {
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

/// Indices of the points of a set that belong to its share.
fn kept(set: &FitData<'_>, stride: usize) -> impl Iterator<Item = usize> + use<> {
    let stride = if is_thinned(set) { stride } else { 1 };
    (0..set.x.len()).skip((stride - 1) / 2).step_by(stride)
}

/// Whether a set is dense enough to be thinned. Sets of peaks are not: they are small, and each peak is expensive.
fn is_thinned(set: &FitData<'_>) -> bool {
    matches!(set.kind, DataKind::Response | DataKind::Amplitude) && set.x.len() > FIT_THINNED_MOST
}

/// Start of the search on all data.
pub(super) enum Start {
    /// The given start, since there are few data, or the search did not explain its share of them.
    Given,
    /// Free unknowns found on a share of the data, from which the search is short.
    Nearer(Vec<f64>),
    /// No start: the caller stopped the search on a share of the data. The numbers are those of the share; residuals
    /// and values are NaN elsewhere.
    Stopped(Box<Fit>),
}

/// Finds the start of the search on all data.
///
/// # Errors
/// Those of the predictor, and of a result.
pub(super) fn start(
    search: &FitSearch<'_>,
    z: &[f64],
    explains: impl Fn(&FitSearch<'_>, &State) -> bool,
    report: &mut dyn FnMut(usize, &State) -> bool,
) -> Result<Start> {
    let predictor = search.predictor;
    let points: usize = predictor.data.iter().map(|set| set.x.len()).sum();
    let stride = (points / (FIT_THINNED_POINTS * z.len())).min(FIT_THINNED_MOST);
    if points < FIT_THINNED_FROM || stride < 2 || !predictor.data.iter().any(is_thinned) {
        return Ok(Start::Given);
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
    let thinned = FitSearch {
        predictor: &predictor,
        unknowns: search.unknowns,
        options: &options,
    };
    let Some(first) = thinned.at(try_copy(z, CONTEXT)?)? else {
        return Ok(Start::Given);
    };
    let mut stopped = false;
    let found = thinned.from(first, &mut |i, state| {
        stopped |= report(i, state);
        stopped
    })?;
    if stopped {
        let ended = Ended {
            found,
            starts: 1,
            stopped,
        };
        let mut told = result(&thinned, ended, Suspicion::None)?;
        told.residuals = spread(&told.residuals, search.predictor.data, stride)?;
        told.values = spread(&told.values, search.predictor.data, stride)?;
        return Ok(Start::Stopped(Box::new(told)));
    }
    if explains(&thinned, &found.state) {
        return Ok(Start::Nearer(found.state.z));
    }
    Ok(Start::Given)
}

/// Numbers of a share of the data, placed among all data, two for each datum; NaN elsewhere.
fn spread(numbers: &[f64], data: &[FitData<'_>], stride: usize) -> Result<Vec<f64>> {
    let rows = 2 * data.iter().map(|set| set.x.len()).sum::<usize>();
    let mut all = try_vec(rows, f64::NAN, CONTEXT)?;
    let mut pairs = numbers.chunks_exact(2);
    let mut row = 0;
    for set in data {
        for i in kept(set, stride) {
            if let Some(pair) = pairs.next() {
                all[row + 2 * i..][..2].copy_from_slice(pair);
            }
        }
        row += 2 * set.x.len();
    }
    Ok(all)
}
