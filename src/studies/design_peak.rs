//! The highest peak of one design.

use crate::analysis::forced::forced_curve::special_points;
use crate::analysis::forced_response::forced_response;
use crate::error::{Error, Result, Status, try_push};
use crate::hooks::Hooks;
use crate::model::Model;
use crate::options::{BatchOptions, SolverOptions};
use crate::results::{Branch, Special};
use crate::sensitivity::{Parameter, design};
use crate::studies::range_ends::at_ends;

/// The highest maximum of the amplitude of a design within the range.
#[derive(Clone, Debug)]
pub struct DesignPeak {
    /// Amplitude; NaN without a maximum.
    pub amplitude: f64,
    /// Angular frequency of the maximum; NaN without a maximum.
    pub omega: f64,
    /// `Ok`; `StoppedNoPeak` where the amplitude has no maximum within the range; the status of a branch that ended
    /// early, whose maxima may not be all; or the error of the design.
    pub status: Status,
    /// Number of points of the curve.
    pub points: usize,
    /// Reason of a status that is not `Ok`.
    pub reason: Option<Error>,
    /// Amplitude and angular frequency of the highest peak of each requested response; NaN without a maximum. Empty
    /// where the design failed.
    pub responses: Vec<(f64, f64)>,
    /// The larger value of each response at the two ends of the range, with its angular frequency. If it exceeds the
    /// highest peak, a higher one lies beyond the range.
    pub ends: Vec<(f64, f64)>,
}

/// Amplitude and angular frequency of the highest of some peaks; NaN without peaks.
fn highest(peaks: &[Special]) -> (f64, f64) {
    let mut found = (f64::NAN, f64::NAN);
    for peak in peaks {
        if found.0.is_nan() || peak.amplitude > found.0 {
            found = (peak.amplitude, peak.omega);
        }
    }
    found
}

impl DesignPeak {
    /// Result of a design that was not solved.
    pub(crate) fn not_solved() -> Self {
        Self {
            amplitude: f64::NAN,
            omega: f64::NAN,
            status: Status::StoppedByCaller,
            points: 0,
            reason: None,
            responses: Vec::new(),
            ends: Vec::new(),
        }
    }

    /// Result of a design that failed with an error.
    fn failed(error: Error) -> Self {
        Self {
            status: error.status,
            reason: Some(error),
            ..Self::not_solved()
        }
    }

    /// The highest peak of a branch.
    fn of(branch: &Branch) -> Result<Self> {
        let mut found = Self {
            status: branch.status(),
            points: branch.points(),
            reason: branch.reason().cloned(),
            ..Self::not_solved()
        };
        (found.amplitude, found.omega) = highest(branch.peaks());
        for response in branch.responses() {
            try_push(&mut found.responses, highest(response.peaks()), "the peaks of a design")?;
            try_push(&mut found.ends, at_ends(branch, response), "the peaks of a design")?;
        }
        if found.status == Status::Ok && branch.peaks().is_empty() {
            found.status = Status::StoppedNoPeak;
        }
        Ok(found)
    }
}

/// Solution of one design.
pub(crate) struct Solved {
    pub peak: DesignPeak,
    /// Branch of the design, if branches are kept.
    pub branch: Option<Branch>,
}

/// Solves one design and finds its highest peak.
pub(crate) fn solve_design(
    model: &Model,
    solver: &SolverOptions,
    options: &BatchOptions<'_>,
    parameters: &[Parameter<'_>],
    values: &[f64],
    hooks: &mut Hooks<'_>,
) -> Solved {
    // A branch that is kept draws its curve, and the peaks of responses are sought between close points.
    let is_curve = options.keep || options.responses.iter().any(|one| !one.is_plain()) || options.responses.len() > 1;
    let solver = &SolverOptions {
        freedom: solver.freedom && options.keep,
        ..*solver
    };
    let solve = if is_curve { forced_response } else { special_points };
    let solved: Result<Branch> =
        design(model, parameters, values).and_then(|model| solve(&model, solver, &options.range(), hooks));
    let peak = solved.and_then(|branch| Ok((DesignPeak::of(&branch)?, branch)));
    match peak {
        Ok((peak, branch)) => Solved {
            peak,
            branch: options.keep.then_some(branch),
        },
        Err(e) => Solved {
            peak: DesignPeak::failed(e),
            branch: None,
        },
    }
}
