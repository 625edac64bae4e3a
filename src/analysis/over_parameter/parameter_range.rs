//! The range of a parameter response, and the result that it follows.

use crate::analysis::over_parameter::parameter_curve::Wanted;
use crate::continuation::Settings;
use crate::continuation::step_control::StepControl;
use crate::error::{Result, fail};
use crate::options::{Response, SolverOptions};

/// The result that a parameter response follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Follow {
    /// The response at this angular frequency.
    Omega(f64),
    /// The peak next to this angular frequency, within a tenth of it.
    Peak(f64),
    /// As `Peak`, also beyond the values at which the peak vanishes: there it meets a minimum, and the curve turns
    /// and goes on along that. The peak of a detached curve, the minimum on it and the peak of the curve beneath are
    /// one curve over the force, whose [`turns`](crate::Branch::turns) are the forces of birth and merging.
    PeakThroughFolds(f64),
    /// The fold over the frequency next to this angular frequency, within a tenth of it.
    Fold(f64),
    /// The largest damping ratio along the nonlinear mode whose linear mode with stuck contacts is next to this angular
    /// frequency.
    ModeMaxDamping {
        /// Angular frequency near that of the linear mode.
        omega: f64,
        /// log₁₀ of the modal amplitudes between which the maximum is sought at the first value; `None`: from the onset
        /// of slip to a thousand times its amplitude.
        log10_range: Option<(f64, f64)>,
    },
}

/// Range of a parameter response.
#[derive(Clone, Copy, Debug)]
pub struct ParameterRange<'a> {
    /// First value of the parameter.
    pub start: f64,
    /// Last value; below the first for a downward response.
    pub stop: f64,
    /// Values within the range at which every solution is stored.
    pub at: &'a [f64],
    /// The result that is followed.
    pub follow: Follow,
    /// The response that is followed; `None`: the amplitude of the response degree of freedom.
    pub response: Option<Response<'a>>,
}

impl ParameterRange<'_> {
    /// Checks the range, the requested values and the frequency.
    ///
    /// # Errors
    /// `NotFinite` or `Argument`, naming the field, its value and its range.
    pub fn check(&self) -> Result<()> {
        let (Follow::Omega(omega)
        | Follow::Peak(omega)
        | Follow::PeakThroughFolds(omega)
        | Follow::Fold(omega)
        | Follow::ModeMaxDamping { omega, .. }) = self.follow;
        if !(omega > 0.0 && omega.is_finite()) {
            return fail!(Argument, "omega = {omega}, needs an angular frequency > 0");
        }
        check(self.start, self.stop, self.at)
    }
}

fn check(start: f64, stop: f64, at: &[f64]) -> Result<()> {
    for (name, value) in [("start", start), ("stop", stop)] {
        if !value.is_finite() {
            return fail!(NotFinite, "{name} = {value}, needs a finite number");
        }
    }
    if start.to_bits() == stop.to_bits() {
        return fail!(Argument, "the range of the parameter is empty: start = stop = {start}");
    }
    for (i, &p) in at.iter().enumerate() {
        if !(p >= start.min(stop) && p <= start.max(stop)) {
            return fail!(Argument, "at[{i}] = {p}, needs a value within {start} .. {stop}");
        }
    }
    Ok(())
}

/// Settings of the continuation over the parameter.
pub(crate) fn settings(solver: &SolverOptions, range: &ParameterRange<'_>) -> Settings {
    Settings {
        start: range.start,
        end: range.stop,
        tolerance: solver.tol_residual,
        max_iterations: solver.max_newton,
        steps: StepControl::new(solver.step, solver.step_min, solver.step_max),
    }
}

/// The first value, and points to record beside the curve.
pub(crate) fn wanted<'a>(solver: &SolverOptions, range: &ParameterRange<'a>, begin: f64) -> Wanted<'a> {
    Wanted {
        begin,
        at: range.at,
        max_points: solver.max_points,
        tolerance: solver.tolerance,
    }
}
