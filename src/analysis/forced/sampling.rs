//! Samples that follow from the tolerance: a run whose laws without exact events are sampled too coarsely begins again
//! with more samples, until the error of sampling takes no more than its share of the tolerance.

use crate::error::Result;
use crate::harmonics::discretised::Recorder;
use crate::options::{MAX_REFINEMENT, SolverOptions};
use crate::results::Branch;

/// The outcome of a run: the branch, or for a run that ended early the factor by which more samples are required.
pub(crate) type SampledModel = core::result::Result<Box<Branch>, usize>;

/// Whether a run may start again with more samples: its laws choose their samples, and there is a tolerance to meet.
pub(crate) fn may_refine(solver: &SolverOptions) -> bool {
    solver.tolerance > 0.0 && solver.samples == 0 && solver.refinement < MAX_REFINEMENT
}

/// The factor by which a run requires more samples; `None` if it needs no more, or may not have them.
pub(crate) fn required(solver: &SolverOptions, recorder: &dyn Recorder) -> Option<usize> {
    Some(recorder.sampling_factor()).filter(|&factor| may_refine(solver) && factor > 1)
}

/// Repeats a run with more samples until these suffice.
///
/// # Errors
/// Those of the runs.
pub(crate) fn with_samples(
    solver: &SolverOptions,
    mut run: impl FnMut(&SolverOptions) -> Result<SampledModel>,
) -> Result<Box<Branch>> {
    let mut options = *solver;
    loop {
        match run(&options)? {
            Ok(branch) => return Ok(branch),
            Err(factor) => {
                options.refinement = options.refinement.saturating_mul(factor).min(MAX_REFINEMENT);
            }
        }
    }
}
