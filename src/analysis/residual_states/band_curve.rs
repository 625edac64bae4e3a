//! Lower and upper curve of a forced response over the residual forces of contacts that stick.

use crate::analysis::residual_states::band::{BandOf, BandOptions, band};
use crate::error::{Result, fail, try_push};
use crate::hooks::Hooks;
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::results::Branch;

const CONTEXT: &str = "the curves of a band";

/// Band of the amplitude at one point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPoint {
    /// Index of the point in the branch.
    pub point: usize,
    /// Angular frequency of the point.
    pub omega: f64,
    /// Amplitude of the branch at the point.
    pub value: f64,
    /// The least result found.
    pub lower: f64,
    /// The largest result found.
    pub upper: f64,
    /// Number of free sliders; 0: no band.
    pub sliders: usize,
    /// Whether the band is complete, as
    /// [`Band::is_complete`](crate::analysis::residual_states::band::Band::is_complete).
    pub is_complete: bool,
    /// Number of solutions that were computed.
    pub solved: usize,
}

/// The band of the amplitude at points of a forced response: its lower and upper curve. Without `points`: all of the curve.
///
/// # Errors
/// As [`band`]; `Argument` for the band of a peak.
pub fn band_curve(
    model: &Model,
    branch: &Branch,
    points: &[usize],
    solver: &SolverOptions,
    options: &BandOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Vec<BandPoint>> {
    if options.of != BandOf::Amplitude {
        return fail!(
            Argument,
            "the curves of a band are those of the amplitude at each frequency"
        );
    }
    let count = if points.is_empty() {
        branch.omega().len()
    } else {
        points.len()
    };
    let mut found = Vec::new();
    for i in 0..count {
        hooks.interrupt().part(Phase::Results, i, count)?;
        let point = points.get(i).copied().unwrap_or(i);
        let one =
            band(model, branch, point, solver, options, hooks).map_err(|e| e.at(format_args!("point {point}")))?;
        let of_point = BandPoint {
            point,
            omega: branch.omega_at(point).unwrap_or(f64::NAN),
            value: branch.stored_amplitude(point),
            lower: one.lower.value,
            upper: one.upper.value,
            sliders: one.sliders.len(),
            is_complete: one.is_complete,
            solved: one.solved,
        };
        try_push(&mut found, of_point, CONTEXT)?;
    }
    Ok(found)
}
