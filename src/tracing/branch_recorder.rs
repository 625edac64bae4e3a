//! Storage of the points of a run: points of the curve at once, special points when the curve is complete.

use crate::condense::{Reduction, Resolution};
use crate::error::{Error, Result, Status, try_copy, try_push, try_vec};
use crate::options::MAX_REFINEMENT;
use crate::results::stored::mode_branch::ModePoint;
use crate::results::watched::responses;
use crate::results::{Branch, Record, SeenWithError, SpecialKind, Verdict};
use crate::tracing::sampled_ripples::{EXACT_SAMPLES, Maximum, are_ripples};
use core::cmp::Ordering;
use num_complex::Complex64;

const CONTEXT: &str = "the special points";

/// How a run ended: its status, and the error of a failed law.
pub(crate) struct Ending {
    pub status: Status,
    /// The failure of a law that ended the run.
    pub reason: Option<Error>,
}

impl Ending {
    /// The end of a run that has recorded `branch` so far: a stop by the caller, or a failed law, ends it and keeps the
    /// points.
    pub fn of(outcome: Result<Status>, branch: &Branch) -> Result<Self> {
        match outcome {
            Ok(status) => Ok(Self { status, reason: None }),
            Err(e) if e.status == Status::StoppedByCaller => Ok(Self {
                status: e.status,
                reason: None,
            }),
            Err(e) if e.status == Status::Callback && branch.points() > 0 => Ok(Self {
                status: Status::StoppedCallback,
                reason: Some(e),
            }),
            // A law with states failed at a point beside the curve.
            Err(e) if e.recoverable && branch.points() > 0 => Ok(Self {
                status: Status::StoppedStepTooSmall,
                reason: Some(e),
            }),
            Err(e) => Err(e),
        }
    }
}

/// A special point, stored until the curve is complete.
struct SpecialRecord<'a> {
    kind: SpecialKind,
    /// Number of points of the curve before the special point.
    after: usize,
    resolution: &'a Resolution,
    omega: f64,
    motion: Vec<f64>,
    amplitude: Complex64,
    response: Vec<Complex64>,
    numbers: Accuracy,
    slip_fractions: Vec<f64>,
    seen: Vec<SeenWithError>,
    mode: Option<ModePoint>,
}

/// How well a special point is solved.
struct Accuracy {
    residual: f64,
    iterations: usize,
    sampling_error: f64,
    errors: (f64, f64),
}

/// Collects the points of one run.
pub(crate) struct BranchRecorder<'a> {
    branch: Box<Branch>,
    specials: Vec<SpecialRecord<'a>>,
    tolerance: f64,
    /// Whether the error of some point misses the tolerance; and whether round-off stopped some residual above its
    /// tolerance.
    missed: bool,
    stalled: bool,
    /// Largest relative change of forces if half the samples are used, over all points so far.
    sampling_error: f64,
}

/// Change of forces with half the samples over their error: samples are of second order.
/// Kind: tuned; measured on: not recorded.
const SAMPLING: f64 = 3.0;

/// Share of the tolerance that the error of sampling may take.
/// Kind: tuned; measured on: not recorded.
const BRANCH_RECORDER_SHARE: f64 = 0.5;

/// Largest change of sampled forces with half the samples that meets a tolerance.
pub fn largest_change(tolerance: f64) -> f64 {
    SAMPLING * BRANCH_RECORDER_SHARE * tolerance
}

impl<'a> BranchRecorder<'a> {
    /// An empty branch whose points may miss a tolerance.
    pub fn new(branch: Box<Branch>, tolerance: f64) -> Self {
        Self {
            branch,
            specials: Vec::new(),
            tolerance,
            missed: false,
            stalled: false,
            sampling_error: 0.0,
        }
    }

    /// The branch with the points recorded so far.
    pub fn branch(&self) -> &Branch {
        &self.branch
    }

    /// The branch with the points recorded so far, writable, for the data of a mode.
    pub fn branch_mut(&mut self) -> &mut Branch {
        &mut self.branch
    }

    /// Notes the error of a point that the tolerance bounds, NaN if unknown; not for folds.
    pub fn note_error(&mut self, error: f64) {
        let meets = matches!(
            error.partial_cmp(&self.tolerance),
            Some(Ordering::Less | Ordering::Equal)
        );
        self.missed |= self.tolerance > 0.0 && !meets;
    }

    /// Notes the sampling error of a point. An unknown error misses the tolerance.
    fn note_sampling(&mut self, error: f64) {
        if self.tolerance > 0.0 {
            self.missed |= !matches!(
                error.partial_cmp(&largest_change(self.tolerance)),
                Some(Ordering::Less | Ordering::Equal)
            );
            self.sampling_error = self.sampling_error.max(error);
        }
    }

    /// Factor by which the samples must grow to meet the tolerance at the points so far, a power of two; 1: they
    /// suffice.
    pub fn sampling_factor(&self) -> usize {
        if self.sampling_error <= largest_change(self.tolerance) {
            return 1;
        }
        let excess = self.sampling_error / largest_change(self.tolerance);
        (excess.sqrt().min(MAX_REFINEMENT as f64).ceil() as usize)
            .next_power_of_two()
            .max(2)
    }

    /// Stores a point of the curve.
    pub fn record(&mut self, record: &Record<'_>, stalled: bool) -> Result<()> {
        self.stalled |= stalled;
        self.note_sampling(record.sampling_error);
        self.branch.push_curve(record)
    }

    /// Stores the stability of the point of the curve recorded last.
    pub fn record_verdict(&mut self, verdict: &Verdict) -> Result<()> {
        self.branch.push_verdict(verdict)
    }

    /// Keeps a special point until [`Self::finish`].
    pub fn record_special(
        &mut self,
        kind: SpecialKind,
        resolution: &'a Resolution,
        record: &Record<'_>,
        mode: Option<ModePoint>,
    ) -> Result<()> {
        self.note_sampling(record.sampling_error);
        let special = SpecialRecord {
            kind,
            // The neighbour after it has been recorded.
            after: self.branch.points().saturating_sub(1),
            resolution,
            omega: record.omega,
            motion: try_copy(record.motion, CONTEXT)?,
            amplitude: record.amplitude,
            response: try_copy(record.response, CONTEXT)?,
            numbers: Accuracy {
                residual: record.residual,
                iterations: record.iterations,
                sampling_error: record.sampling_error,
                errors: record.errors,
            },
            slip_fractions: try_copy(record.slip_fractions, CONTEXT)?,
            seen: try_copy(record.seen, CONTEXT)?,
            mode,
        };
        try_push(&mut self.specials, special, CONTEXT)
    }

    /// For each special point, whether it is a maximum of the observed amplitude that sampling may have made.
    fn ripples(&self) -> Result<Vec<bool>> {
        let mut ripples = try_vec(self.specials.len(), false, CONTEXT)?;
        let leads = match self.branch.responses().first() {
            Some(first) => first.is_observed(),
            None => true,
        };
        // The peaks of a nonlinear mode are those of its damping.
        if !leads || self.branch.mode_data().is_some() {
            return Ok(ripples);
        }
        let (mut maxima, mut numbers) = (Vec::new(), Vec::new());
        for (number, special) in self.specials.iter().enumerate() {
            if matches!(special.kind, SpecialKind::Peak) && special.numbers.sampling_error > EXACT_SAMPLES {
                let maximum = Maximum {
                    after: special.after,
                    amplitude: special.amplitude.norm() * special.resolution.condensed.length(),
                    error: special.numbers.sampling_error,
                };
                try_push(&mut maxima, maximum, CONTEXT)?;
                try_push(&mut numbers, number, CONTEXT)?;
            }
        }
        for (number, is_ripple) in numbers.into_iter().zip(are_ripples(self.branch.amplitude(), &maxima)?) {
            ripples[number] = is_ripple;
        }
        Ok(ripples)
    }

    /// Completes the branch: the special points are numbered after the curve.
    pub fn finish(mut self, ending: &Ending, reduction: Reduction, estimates: usize) -> Result<Box<Branch>> {
        let ripples = self.ripples()?;
        for (special, is_ripple) in self.specials.iter().zip(ripples) {
            if is_ripple {
                continue;
            }
            let seen = special.kind.response().and_then(|r| Some((r, special.seen.get(r)?)));
            if let Some((response, seen)) = seen
                && responses::is_rounding(&self.branch, response, seen.seen.reading.value, special.resolution)
            {
                continue;
            }
            let record = Record {
                resolution: special.resolution,
                omega: special.omega,
                motion: &special.motion,
                amplitude: special.amplitude,
                response: &special.response,
                residual: special.numbers.residual,
                iterations: special.numbers.iterations,
                slip_fractions: &special.slip_fractions,
                sampling_error: special.numbers.sampling_error,
                errors: special.numbers.errors,
                seen: &special.seen,
            };
            self.branch.push_special(special.kind, special.after, &record)?;
            if let (Some(mode), Some(data)) = (special.mode, self.branch.mode_data_mut()) {
                data.push(mode)?;
            }
        }
        self.branch.complete_stability()?;
        self.branch.set_reduction(reduction);
        self.branch.set_estimates(estimates);
        self.branch
            .set_ending(ending.status, ending.reason.clone(), (self.stalled, self.missed));
        Ok(self.branch)
    }
}
