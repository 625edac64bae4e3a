//! A result that is followed over a parameter of the model, as a problem that may change its harmonics.

use crate::condense::Resolution;
use crate::continuation::Point;
use crate::error::{Error, Result, fail, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::{Corrected, Estimate};
use crate::linalg::newton::linear_system::Jacobian;
use crate::options::Range;
use crate::problem::{Homotopy, InitialGuess, Problem, Residual};
use crate::results::{Branch, ParameterData, Special, SpecialKind};
use num_complex::Complex64;

const CONTEXT: &str = "the parameter response";

/// Step of the differences by the parameter, over its range.
/// Kind: tuned; measured on: not recorded.
const PARAMETER_STEP: f64 = 1e-5;

/// A result over a parameter. Motions come first among its unknowns, in one unit of length for all harmonics and all values
/// of the parameter.
pub(crate) trait Tracked: Jacobian {
    /// This result as the problem whose equations are solved.
    fn problem(&mut self) -> &mut dyn Problem;

    /// The unknowns, with the Jacobian of the equations evaluated last.
    fn unknowns(&self) -> &Unknowns;

    /// The same unknowns, to be changed.
    fn unknowns_mut(&mut self) -> &mut Unknowns;

    /// Writes the values of the equations at unknowns `u` and the parameter p, `fully` with their Jacobian and the result. Returns
    /// their scale.
    fn equations(&mut self, u: &[f64], p: f64, fully: bool, values: &mut [f64]) -> Result<f64>;

    /// The result at the point evaluated last, and its change along a direction: that of `u`, then of the parameter.
    fn result(&self, u: &[f64], direction: &[f64]) -> (f64, f64);

    /// Curvature of the result evaluated last, where what is followed ends as that becomes positive: a peak may become a minimum.
    fn curvature(&self) -> Option<f64>;

    /// Number of unknowns that are motions.
    fn motions(&self) -> usize;

    /// Changes the harmonics to those of a resolution; `highest` is the highest requested one.
    fn select(&mut self, from: &HarmonicSet, to: &Resolution, highest: usize) -> Result<()>;

    /// Estimates the error of a solved point, relative to the result; `None` where no estimate at a fixed frequency or
    /// amplitude exists.
    fn estimate(&mut self, point: &Point) -> Result<Option<(f64, Estimate)>>;

    /// Replaces the unknowns of a point by those of a corrected solution with more harmonics.
    fn take_corrected(&self, corrected: &Corrected, set: &HarmonicSet, v: &mut [f64]);

    /// Stores a point with its estimated error in a branch: on its curve, or beside it if `kind` is given. Returns
    /// the point, and the relative change of its contact forces with the number of samples.
    fn store(
        &mut self,
        point: &Point,
        error: f64,
        branch: &mut Branch,
        data: &mut ParameterData,
        kind: Option<SpecialKind>,
    ) -> Result<(Special, f64)>;

    /// Whether a solved point still is what is followed.
    fn exists(&mut self, point: &Point) -> Result<bool> {
        if self.curvature().is_none() {
            return Ok(true);
        }
        let mut values = try_vec(point.unknowns().len(), 0.0, CONTEXT)?;
        self.equations(point.unknowns(), point.parameter(), true, &mut values)?;
        Ok(self.curvature().is_none_or(|curvature| curvature <= 0.0))
    }
}

impl<T: Tracked> Problem for T {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        let Unknowns { step, range, .. } = *self.unknowns();
        // A correction may leave the range, where the model may not exist: the step is then too long.
        let is_inside = range.low() <= p && p <= range.high();
        let within = |e: Error| if is_inside { e } else { e.recoverable() };
        by_differences(out, p, step, |p, values| self.equations(u, p, false, values)).map_err(within)?;
        out.scale = self.equations(u, p, true, &mut out.values).map_err(within)?;
        out.rounding = 0.0;
        Ok(())
    }

    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        let (value, change) = self.result(u, direction);
        self.unknowns().observe(value, change)
    }

    fn initial_guess(&mut self, kind: InitialGuess, _p: f64, u: &mut [f64]) -> Result<bool> {
        Ok(self.unknowns().initial_guess(kind, u))
    }

    fn homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}

/// The solution from which a result is followed.
pub(crate) struct FirstMotion<'a> {
    /// Packed relative motions, static ones included.
    pub motion: &'a [f64],
    /// Their unit of length.
    pub length: f64,
    /// Angular frequency.
    pub omega: f64,
}

/// Writes the derivatives of equations by the parameter, by differences about p; one-sided ones at a limit of the
/// parameter.
///
/// # Errors
/// Those of the equations at p.
fn by_differences(
    out: &mut Residual,
    p: f64,
    step: f64,
    mut equations: impl FnMut(f64, &mut [f64]) -> Result<f64>,
) -> Result<()> {
    let n = out.values.len();
    let mut below = try_vec(n, 0.0, CONTEXT)?;
    let mut above = try_vec(n, 0.0, CONTEXT)?;
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

/// Unknowns over a parameter: their values at the start; and the Jacobian of the equations evaluated last.
pub(crate) struct Unknowns {
    pub start: Vec<f64>,
    pub matrix: Vec<f64>,
    /// Range of the parameter, and step of the differences by it.
    pub range: Range,
    pub step: f64,
    /// Whether the reciprocal of the result is observed.
    pub is_reciprocal: bool,
}

impl Unknowns {
    /// Unknowns that begin with `start`, over a range of the parameter.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(start: Vec<f64>, range: Range) -> Result<Self> {
        Ok(Self {
            matrix: square(start.len())?,
            start,
            range,
            step: PARAMETER_STEP * range.width(),
            is_reciprocal: false,
        })
    }

    /// Changes the number of unknowns; the values at the start then become 0.
    pub fn resize(&mut self, n: usize) -> Result<()> {
        self.start = try_vec(n, 0.0, CONTEXT)?;
        self.matrix = square(n)?;
        Ok(())
    }

    /// Number of unknowns, the parameter not included.
    pub fn len(&self) -> usize {
        self.start.len()
    }

    /// Copies the Jacobian, and marks all of its columns as active.
    pub fn fill(&self, matrix: &mut [f64], active: &mut [bool]) {
        active.fill(true);
        matrix.copy_from_slice(&self.matrix);
    }

    /// Value of a result and its change; or of its reciprocal, if that is observed.
    pub fn observe(&self, value: f64, change: f64) -> (Complex64, Complex64) {
        if self.is_reciprocal {
            return ((1.0 / value).into(), (-change / (value * value)).into());
        }
        (value.into(), change.into())
    }

    /// Writes the values at the start; `false` where another kind of guess is requested.
    pub fn initial_guess(&self, kind: InitialGuess, u: &mut [f64]) -> bool {
        let is_given = kind == InitialGuess::Given;
        if is_given {
            u.copy_from_slice(&self.start);
        }
        is_given
    }
}

/// Memory for a square matrix of order n.
fn square(n: usize) -> Result<Vec<f64>> {
    match n.checked_mul(n) {
        Some(size) => try_vec(size, 0.0, CONTEXT),
        None => fail!(OutOfMemory, "the Jacobian of {n} unknowns cannot be stored"),
    }
}
