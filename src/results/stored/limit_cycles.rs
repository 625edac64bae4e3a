//! Limit cycles: points of a nonlinear mode at which the damping ratio is zero.
//!
//! There the motion needs no artificial damping: it is a periodic motion of the model without forces, which flutter or
//! another negative damping drives and friction limits.

use crate::error::{Result, try_push};
use crate::results::Branch;

/// A limit cycle: a point of a nonlinear mode with a damping ratio of zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitCycle {
    /// Index of the stored point; it continues the numbering of the curve.
    pub point: usize,
    /// Angular frequency of the limit cycle.
    pub omega: f64,
    /// Parameter of the mode: log₁₀ of the amplitude.
    pub log10_amplitude: f64,
    /// Derivative of the damping ratio by log₁₀ of the amplitude. A limit cycle with a negative slope is unstable.
    /// One with a positive slope need not be stable: its Floquet multipliers decide.
    pub slope: f64,
}

/// The limit cycles on a nonlinear mode, refined on the solution, in the order of the branch.
pub(crate) fn limit_cycles(branch: &Branch) -> Result<Vec<LimitCycle>> {
    let mut found = Vec::new();
    for &(special, slope) in &branch.special.limit_cycles {
        let cycle = LimitCycle {
            point: special.point,
            omega: special.omega,
            log10_amplitude: branch.mode_at(special.point).map_or(f64::NAN, |m| m.log10_amplitude),
            slope,
        };
        try_push(&mut found, cycle, "the limit cycles")?;
    }
    Ok(found)
}
