//! Values that a model predicts for the data, with their exact derivatives by the parameters.
//!
//! Each set is one curve over its range, on which every solution at the frequencies or amplitudes of the data is stored. Where a curve
//! turns back there are several; the one nearest to the datum is taken, of complex data in the complex plane.

use crate::analysis::forced::forced_curve::special_points_with;
use crate::analysis::forced_response::forced_response;
use crate::analysis::modes::nonlinear_mode::nonlinear_mode;
use crate::analysis::residual_states::mode_band::NEXT_AMPLITUDE;
use crate::at_a_point::complex_sensitivity::{Equations, complex_at};
use crate::at_a_point::sensitivity_analysis::{Quantity, sensitivity_with};
use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::Range;
use crate::options::{ForcedOptions, ModeChoice, ModeOptions, SolverOptions};
use crate::results::stored::mode_branch::ModeField;
use crate::results::{Branch, Special};
use crate::sensitivity::{Parameter, Reason, by_value, design_with_bases};
use crate::studies::fit::fit_data::{DataKind, FitData};
use crate::studies::fit::fit_unknowns::Named;
use crate::studies::fit::shared_work::SharedWork;
use num_complex::Complex64;

const CONTEXT: &str = "the predicted data";

/// log₁₀ of the first modal amplitude of a linear mode, and the distance that it keeps from the onset of slip.
/// Kind: tuned; measured on: not recorded.
const LINEAR_AMPLITUDE: (f64, f64) = (-6.0, 1.0);

/// Share of the period above which a contact slips.
/// Kind: rounding.
const FIT_SLIPS: f64 = 1e-9;

/// Predicted numbers, two for each datum, set after set.
#[derive(Clone, Debug, Default)]
pub(super) struct Predicted {
    pub values: Vec<f64>,
    /// Derivatives by the parameters, one row for each number; empty unless requested.
    pub slopes: Vec<f64>,
    /// Largest estimated error by harmonics over the standard deviation of the datum; NaN where none was estimated.
    pub harmonic_error: f64,
    /// Whether each contact slips at any point of the data.
    pub slips: Vec<bool>,
}

/// The model whose parameters are fitted, and the data to predict.
pub(super) struct Predictor<'a> {
    pub model: &'a Model,
    pub parameters: &'a [Parameter<'a>],
    /// For each parameter, the data set that alone has it; empty where all sets have all parameters.
    pub scopes: &'a [Option<usize>],
    pub data: &'a [FitData<'a>],
    pub solver: SolverOptions,
    pub interrupt: &'a Interrupt<'a>,
}

/// Memory to which the predictions of one data set are written.
struct Into<'a> {
    values: &'a mut [f64],
    slopes: &'a mut [f64],
    theta: &'a [f64],
    harmonic_error: &'a mut f64,
    slips: &'a mut [bool],
    shared: &'a mut SharedWork,
    /// The parameters of the set, and their indices among all.
    own: (&'a [Parameter<'a>], &'a [usize]),
}

impl Predictor<'_> {
    /// Number of predicted values over all data.
    pub fn rows(&self) -> usize {
        2 * self.data.iter().map(|set| set.x.len()).sum::<usize>()
    }

    /// Predicts the data at given values of the parameters; `None` where an analysis finds no solution for some
    /// datum.
    ///
    /// # Errors
    /// Those of the model, of the analyses and of the derivatives; `StoppedByCaller`.
    pub fn at(&self, theta: &[f64], with_slopes: bool) -> Result<Option<Predicted>> {
        let (rows, p) = (self.rows(), self.parameters.len());
        let mut found = Predicted {
            values: try_vec(rows, 0.0, CONTEXT)?,
            slopes: try_vec(if with_slopes { rows * p } else { 0 }, 0.0, CONTEXT)?,
            harmonic_error: f64::NAN,
            slips: try_vec(self.model.contacts().len(), false, CONTEXT)?,
        };
        let model = self.common_model(theta)?;
        let mut shared = SharedWork::default();
        let mut row = 0;
        for (number, set) in self.data.iter().enumerate() {
            let (own, numbers) = self.parameters_of(Some(number))?;
            let of_test;
            let mut apart = SharedWork::default();
            let (model, shared) = match self.model_of(&model, number, theta)? {
                Some(other) => {
                    of_test = other;
                    (&of_test, &mut apart)
                }
                None => (&model, &mut shared),
            };
            let next = row + 2 * set.x.len();
            let into = Into {
                values: &mut found.values[row..next],
                slopes: if with_slopes {
                    &mut found.slopes[row * p..next * p]
                } else {
                    &mut []
                },
                theta,
                harmonic_error: &mut found.harmonic_error,
                slips: &mut found.slips,
                shared,
                own: (&own, &numbers),
            };
            let scaled;
            let of_set = if set.force_factor.to_bits() == 1.0_f64.to_bits() {
                model
            } else {
                // Another force leaves the bases of the structure as they are.
                let mut other = model.try_clone()?;
                other.scale_forces(set.force_factor)?;
                scaled = other;
                &scaled
            };
            match self.set(of_set, set, into) {
                Ok(true) => {}
                Ok(false) => return Ok(None),
                Err(e)
                    if matches!(
                        e.status,
                        Status::NoConvergence | Status::Singular | Status::NoBoundedSolution
                    ) =>
                {
                    return Ok(None);
                }
                Err(e) => return Err(e.at(format_args!("data set {number}"))),
            }
            row = next;
        }
        Ok(Some(found))
    }

    /// The model with the values of those parameters that all data sets share.
    ///
    /// # Errors
    /// Those of the model.
    pub fn common_model(&self, theta: &[f64]) -> Result<Model> {
        if self.scopes.iter().all(Option::is_none) {
            return design_with_bases(self.model, self.parameters, theta);
        }
        let mut parameters = Vec::new();
        let mut values = Vec::new();
        for (k, (parameter, value)) in self.parameters.iter().zip(theta).enumerate() {
            if self.scopes[k].is_none() {
                try_push(&mut parameters, *parameter, CONTEXT)?;
                try_push(&mut values, *value, CONTEXT)?;
            }
        }
        design_with_bases(self.model, &parameters, &values)
    }

    /// The common model with the values of those parameters that only one data set has; `None` where the set has
    /// none.
    fn model_of(&self, common: &Model, number: usize, theta: &[f64]) -> Result<Option<Model>> {
        let mut parameters = Vec::new();
        let mut values = Vec::new();
        for (k, _) in self
            .scopes
            .iter()
            .enumerate()
            .filter(|(_, scope)| **scope == Some(number))
        {
            try_push(&mut parameters, self.parameters[k], CONTEXT)?;
            try_push(&mut values, theta[k], CONTEXT)?;
        }
        if parameters.is_empty() {
            return Ok(None);
        }
        if !parameters.iter().any(Parameter::is_factor) {
            return design_with_bases(common, &parameters, &values).map(Some);
        }
        // A factor acts before the directions that all sets have.
        for (k, _) in self.scopes.iter().enumerate().filter(|(_, scope)| scope.is_none()) {
            try_push(&mut parameters, self.parameters[k], CONTEXT)?;
            try_push(&mut values, theta[k], CONTEXT)?;
        }
        design_with_bases(self.model, &parameters, &values).map(Some)
    }

    /// The parameters that act in a data set, and their indices.
    fn parameters_of(&self, set: Option<usize>) -> Result<(Vec<Parameter<'_>>, Vec<usize>)> {
        let (mut parameters, mut numbers) = (Vec::new(), Vec::new());
        for (k, parameter) in self.parameters.iter().enumerate() {
            let scope = self.scopes.get(k).copied().flatten();
            if scope.is_none() || scope == set {
                try_push(&mut parameters, *parameter, CONTEXT)?;
                try_push(&mut numbers, k, CONTEXT)?;
            }
        }
        Ok((parameters, numbers))
    }

    fn set(&self, model: &Model, set: &FitData<'_>, into: Into<'_>) -> Result<bool> {
        let cancelled = || self.interrupt.check().is_err();
        let mut hooks = Hooks {
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        let found = if set.is_forced() {
            self.forced(model, set, into, &mut hooks)
        } else {
            self.mode(model, set, into, &mut hooks)
        };
        self.interrupt.check()?;
        found
    }

    fn forced(&self, model: &Model, set: &FitData<'_>, mut into: Into<'_>, hooks: &mut Hooks<'_>) -> Result<bool> {
        let (omega_start, omega_stop) = set.followed();
        let is_peak = set.kind == DataKind::Peak;
        let response = set.response;
        // The fundamental of one degree of freedom is the amplitude that every response has.
        let is_plain = response.is_plain() && response.sector == 0;
        let watched = [response];
        let solver = SolverOptions {
            response_dof: response
                .dofs
                .first()
                .filter(|_| is_plain)
                .copied()
                .or(self.solver.response_dof),
            ..self.solver
        };
        let range = ForcedOptions {
            omega_start,
            omega_stop,
            at: if is_peak { &[] } else { set.x },
            responses: if is_plain { &[] } else { &watched },
            ..ForcedOptions::default()
        };
        let branch = if is_plain {
            let waves = into.shared.waves(solver.response_dof)?;
            special_points_with(model, &solver, &range, (waves, hooks))?
        } else {
            forced_response(model, &solver, &range, hooks)?
        };
        let measured = |special: &Special| match branch.responses().first() {
            Some(series) => series.values().get(special.point).copied().unwrap_or(f64::NAN),
            None => special.amplitude,
        };
        let mut equations = Equations {
            range: Range::new(omega_start, omega_stop),
            at: None,
        };
        for i in 0..set.x.len() {
            let datum = set.value.get(i).copied();
            let found = match set.kind {
                DataKind::Peak => {
                    let peaks = match branch.responses().first() {
                        Some(series) => series.peaks(),
                        None => branch.peaks(),
                    };
                    let gap = |s: &Special| (s.omega - set.x[i]).abs();
                    let nearest = |a: &&Special, b: &&Special| gap(a).total_cmp(&gap(b));
                    let Some(peak) = peaks.iter().min_by(nearest) else {
                        return Ok(false);
                    };
                    (into.values[2 * i], into.values[2 * i + 1]) = (measured(peak), peak.omega);
                    if !into.slopes.is_empty() {
                        let of_amplitude = if is_plain {
                            Quantity::PeakAmplitude
                        } else {
                            Quantity::Response(0)
                        };
                        let of_omega = if is_plain {
                            Quantity::PeakOmega
                        } else {
                            Quantity::ResponsePeakOmega(0)
                        };
                        self.rows_of(model, &branch, peak.point, (of_amplitude, 2 * i), &mut into)?;
                        self.rows_of(model, &branch, peak.point, (of_omega, 2 * i + 1), &mut into)?;
                    }
                    peak.point
                }
                DataKind::Amplitude => {
                    let target = datum.map_or(f64::INFINITY, |z| z.re);
                    let gap = |s: &Special| (measured(s) - target).abs();
                    let nearest = |a: &&Special, b: &&Special| {
                        if target.is_finite() {
                            gap(a).total_cmp(&gap(b))
                        } else {
                            measured(b).total_cmp(&measured(a))
                        }
                    };
                    let Some(special) = branch.at(i).iter().min_by(nearest) else {
                        return Ok(false);
                    };
                    into.values[2 * i] = measured(special);
                    if !into.slopes.is_empty() {
                        let of = if is_plain {
                            Quantity::Amplitude
                        } else {
                            Quantity::Response(0)
                        };
                        self.rows_of(model, &branch, special.point, (of, 2 * i), &mut into)?;
                    }
                    special.point
                }
                _ => match self.complex_row(model, (&branch, i, &mut equations), set, datum, &mut into)? {
                    Some(point) => point,
                    None => return Ok(false),
                },
            };
            note(&branch, found, set, i, &mut into);
        }
        Ok(true)
    }

    /// Predicts the complex amplitude at one frequency; returns the index of its point.
    fn complex_row<'b>(
        &'b self,
        model: &Model,
        (branch, i, equations): (&'b Branch, usize, &mut Equations<'b>),
        set: &FitData<'_>,
        datum: Option<Complex64>,
        into: &mut Into<'_>,
    ) -> Result<Option<usize>> {
        let p = self.parameters.len();
        let all = branch.at(i);
        let mut best: Option<(f64, usize, Complex64)> = None;
        for special in all.iter().filter(|_| all.len() > 1 || into.slopes.is_empty()) {
            let value = equations.amplitude((branch, special.point), &set.response, self.interrupt)?;
            let gap = match datum {
                Some(z) => (value - z).norm(),
                None => -value.norm(),
            };
            if best.is_none_or(|(least, ..)| gap < least) {
                best = Some((gap, special.point, value));
            }
        }
        let nearest = best.map(|(_, point, _)| point);
        let Some(point) = nearest.or_else(|| all.first().map(|special| special.point)) else {
            return Ok(None);
        };
        if into.slopes.is_empty() {
            let value = best.map_or(Complex64::ZERO, |(.., value)| value);
            (into.values[2 * i], into.values[2 * i + 1]) = (value.re, value.im);
            return Ok(value.is_finite().then_some(point));
        }
        let (parameters, numbers) = into.own;
        let found = complex_at(
            model,
            (branch, point),
            &set.response,
            (parameters, &mut into.shared.matrices),
            (false, equations, self.interrupt),
        )?;
        if !found.value.is_finite() {
            return Ok(None);
        }
        (into.values[2 * i], into.values[2 * i + 1]) = (found.value.re, found.value.im);
        let slopes = self.slopes_of(parameters, numbers, &found.values, &found.reasons, into.theta)?;
        for (slope, &k) in slopes.iter().zip(numbers) {
            into.slopes[2 * i * p + k] = slope.re;
            into.slopes[(2 * i + 1) * p + k] = slope.im;
        }
        Ok(Some(point))
    }

    /// Derivatives by the values of the parameters of a set from those by the parameters of its model as it is. 0 where one does not
    /// exist: at an onset of slip and in a fold the search goes on without it.
    fn slopes_of(
        &self,
        parameters: &[Parameter<'_>],
        numbers: &[usize],
        of: &[Complex64],
        reasons: &[Reason],
        theta: &[f64],
    ) -> Result<Vec<Complex64>> {
        let mut values = try_vec(numbers.len(), 0.0, CONTEXT)?;
        for (value, &k) in values.iter_mut().zip(numbers) {
            *value = theta[k];
        }
        let mut slopes = try_vec(numbers.len(), Complex64::ZERO, CONTEXT)?;
        for (i, (slope, reason)) in slopes.iter_mut().zip(reasons).enumerate() {
            match reason {
                Reason::Exists => *slope = by_value(parameters, &values, of, i),
                Reason::OnsetOfSlip { .. } | Reason::Fold => {}
                Reason::ZeroConstant => {
                    return fail!(
                        Argument,
                        "{} is 0, where the derivative exists on one side only; start above 0",
                        Named(&self.parameters[numbers[i]])
                    );
                }
            }
        }
        Ok(slopes)
    }

    /// Writes the derivatives of a result at a point.
    fn rows_of(
        &self,
        model: &Model,
        branch: &Branch,
        point: usize,
        (of, row): (Quantity, usize),
        into: &mut Into<'_>,
    ) -> Result<()> {
        let (parameters, numbers) = into.own;
        let found = sensitivity_with(model, branch, point, parameters, of, self.interrupt)?;
        let p = self.parameters.len();
        let mut of = try_vec(numbers.len(), Complex64::ZERO, CONTEXT)?;
        for (of, &value) in of.iter_mut().zip(&found.values) {
            *of = value.into();
        }
        let slopes = self.slopes_of(parameters, numbers, &of, &found.reasons, into.theta)?;
        for (slope, &k) in slopes.iter().zip(numbers) {
            into.slopes[row * p + k] = slope.re;
        }
        Ok(())
    }

    fn mode(&self, model: &Model, set: &FitData<'_>, mut into: Into<'_>, hooks: &mut Hooks<'_>) -> Result<bool> {
        let linear = set.kind == DataKind::LinearMode;
        let mut options = ModeOptions {
            choice: ModeChoice::Index(set.mode),
            ..ModeOptions::default()
        };
        let mut at = try_copy(set.x, CONTEXT)?;
        if linear {
            at.fill(LINEAR_AMPLITUDE.0);
        }
        let ends = |at: &[f64]| {
            let low = at.iter().fold(f64::INFINITY, |a, b| a.min(*b));
            let high = at.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
            (low, high.max(low + NEXT_AMPLITUDE))
        };
        (options.log10_start, options.log10_stop) = ends(&at);
        let mut branch = nonlinear_mode(model, &self.solver, &ModeOptions { at: &at, ..options }, hooks)?;
        if linear && let Some(data) = branch.mode_data() {
            let below = data.info.linear_up_to - LINEAR_AMPLITUDE.1;
            if below.is_finite() && below < LINEAR_AMPLITUDE.0 {
                at.fill(below);
                (options.log10_start, options.log10_stop) = ends(&at);
                branch = nonlinear_mode(model, &self.solver, &ModeOptions { at: &at, ..options }, hooks)?;
            }
        }
        let Some(data) = branch.mode_data() else {
            return Ok(false);
        };
        let damping = data.field(ModeField::DampingRatio);
        for i in 0..set.x.len() {
            let target = set.value.get(i).map_or(0.0, |z| z.re);
            let gap = |s: &Special| (s.omega - target).abs();
            let nearest = |a: &&Special, b: &&Special| gap(a).total_cmp(&gap(b));
            let Some(special) = branch.at(i).iter().min_by(nearest) else {
                return Ok(false);
            };
            into.values[2 * i] = special.omega;
            into.values[2 * i + 1] = damping.get(special.point).copied().unwrap_or(f64::NAN);
            if !into.slopes.is_empty() {
                self.rows_of(model, &branch, special.point, (Quantity::ModeOmega, 2 * i), &mut into)?;
                self.rows_of(
                    model,
                    &branch,
                    special.point,
                    (Quantity::ModeDamping, 2 * i + 1),
                    &mut into,
                )?;
            }
            note(&branch, special.point, set, i, &mut into);
        }
        Ok(true)
    }
}

/// Notes the estimated error of a point, and the contacts that slip at it.
fn note(branch: &Branch, point: usize, set: &FitData<'_>, i: usize, into: &mut Into<'_>) {
    if let Some(shares) = branch.slip_fraction_at(point) {
        for (slips, share) in into.slips.iter_mut().zip(shares) {
            *slips |= *share > FIT_SLIPS;
        }
    }
    let relative = branch.error_estimate_at(point).unwrap_or(f64::NAN);
    let size = match set.kind {
        DataKind::Response => into.values[2 * i].hypot(into.values[2 * i + 1]),
        _ => into.values[2 * i].abs(),
    };
    if let Some(sigma) = set.sigma.get(i) {
        // The larger one; a number where the other is none.
        *into.harmonic_error = into.harmonic_error.max(relative * size / sigma);
    }
}
