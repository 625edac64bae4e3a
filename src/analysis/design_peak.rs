//! The highest peak of one design.

use crate::analysis::forced_response::{forced_response, special_points};
use crate::error::{Error, Result, Status};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{BatchOptions, SolverOptions};
use crate::results::Branch;
use crate::sensitivity::{Parameter, design};

/// The highest maximum of the amplitude of a design within the range.
#[derive(Clone, Debug)]
pub struct DesignPeak {
    /// Amplitude; NaN without a maximum.
    pub amplitude: f64,
    /// Its angular frequency; NaN without a maximum.
    pub omega: f64,
    /// `Ok`; `StoppedNoPeak` where the amplitude has no maximum within the range; the status of a branch that ended
    /// early, whose maxima may not be all; or the error of the design.
    pub status: Status,
    /// Points of the curve.
    pub points: usize,
    /// Sentence of another status than `Ok`.
    pub reason: Option<Error>,
}

impl DesignPeak {
    /// A design that was not solved.
    pub(super) fn not_solved() -> Self {
        Self {
            amplitude: f64::NAN,
            omega: f64::NAN,
            status: Status::StoppedByCaller,
            points: 0,
            reason: None,
        }
    }

    /// A design that failed.
    fn failed(error: Error) -> Self {
        Self {
            status: error.status,
            reason: Some(error),
            ..Self::not_solved()
        }
    }

    /// The highest peak of a branch.
    fn of(branch: &Branch) -> Self {
        let mut found = Self {
            status: branch.status(),
            points: branch.points(),
            reason: branch.reason().cloned(),
            ..Self::not_solved()
        };
        for peak in branch.peaks() {
            if found.amplitude.is_nan() || peak.amplitude > found.amplitude {
                (found.amplitude, found.omega) = (peak.amplitude, peak.omega);
            }
        }
        if found.status == Status::Ok && branch.peaks().is_empty() {
            found.status = Status::StoppedNoPeak;
        }
        found
    }
}

/// A solved design.
pub(super) struct Solved {
    pub peak: DesignPeak,
    /// Its branch, if it is kept.
    pub branch: Option<Branch>,
}

/// Solves a design.
pub(super) fn solve_design(
    model: &Model,
    solver: &SolverOptions,
    options: &BatchOptions,
    (parameters, values): (&[Parameter<'_>], &[f64]),
    hooks: &mut Hooks<'_>,
) -> Solved {
    // A branch that is kept draws its curve.
    let solve = if options.keep { forced_response } else { special_points };
    let solved: Result<Branch> =
        design(model, parameters, values).and_then(|model| solve(&model, solver, &options.range(), hooks));
    match solved {
        Ok(branch) => Solved {
            peak: DesignPeak::of(&branch),
            branch: options.keep.then_some(branch),
        },
        Err(e) => Solved {
            peak: DesignPeak::failed(e),
            branch: None,
        },
    }
}
