//! A result that is followed over a parameter of the model, as a problem that may change its harmonics.

use crate::condense::Resolution;
use crate::continuation::Point;
use crate::error::{Result, try_vec};
use crate::error_estimate::{Corrected, Estimate};
use crate::fourier::HarmonicSet;
use crate::problem::{Problem, Residual};
use crate::results::{Branch, ParameterData, Special, SpecialKind};
use num_complex::Complex64;

/// A result over a parameter. Motions come first among its unknowns, in one unit of length for all harmonics and all values
/// of the parameter.
pub(crate) trait Tracked: Problem {
    /// The same as a problem.
    fn problem(&mut self) -> &mut dyn Problem;

    /// Number of unknowns that are motions.
    fn motions(&self) -> usize;

    /// Changes the harmonics to those of a resolution, of which `highest` is the highest requested.
    fn select(&mut self, from: &HarmonicSet, to: &Resolution, highest: usize) -> Result<()>;

    /// Estimates the error of a solved point, relative to the result; `None` where no estimate at a fixed frequency or
    /// amplitude exists.
    fn estimate(&mut self, point: &Point) -> Result<Option<(f64, Estimate)>>;

    /// Replaces the unknowns of a point by those of a corrected solution.
    fn take_corrected(&self, corrected: &Corrected, set: &HarmonicSet, v: &mut [f64]);

    /// Stores a point with its estimated error in a branch: on its curve, or where `kind` is given beside it.
    fn store(
        &mut self,
        point: &Point,
        error: f64,
        branch: &mut Branch,
        data: &mut ParameterData,
        kind: Option<SpecialKind>,
    ) -> Result<Special>;

    /// Observes the reciprocal of the result, whose maxima are the minima of the result.
    fn set_reciprocal(&mut self, is_reciprocal: bool);

    /// Whether the point solved last is still one of what is followed: a peak may become a minimum.
    fn exists(&mut self, point: &Point) -> Result<bool>;
}

/// Writes the derivatives of equations by the parameter, by differences around p; at the end of what the parameter may be
/// to one side.
///
/// # Errors
/// Those of the equations at p.
pub(crate) fn by_differences(
    out: &mut Residual,
    (p, step): (f64, f64),
    mut equations: impl FnMut(f64, &mut [f64]) -> Result<f64>,
) -> Result<()> {
    let n = out.values.len();
    let mut below = try_vec(n, 0.0, "the parameter response")?;
    let mut above = try_vec(n, 0.0, "the parameter response")?;
    let (mut low, mut high) = (p - step, p + step);
    if equations(low, &mut below).is_err() {
        low = p;
        equations(low, &mut below)?;
    }
    if equations(high, &mut above).is_err() {
        high = p;
        equations(high, &mut above)?;
    }
    for ((d, above), below) in out.d_parameter.iter_mut().zip(&above).zip(&below) {
        *d = (above - below) / (high - low);
    }
    Ok(())
}

/// A result and its change, or those of its reciprocal.
pub(crate) fn observed((value, change): (f64, f64), is_reciprocal: bool) -> (Complex64, Complex64) {
    if is_reciprocal {
        return ((1.0 / value).into(), (-change / (value * value)).into());
    }
    (value.into(), change.into())
}
