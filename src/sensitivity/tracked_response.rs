//! A forced response as a function of a parameter of the model, as a [`Problem`]: at a fixed frequency, or in a peak.
//!
//! The unknowns are the packed relative motions u and in a peak also ln ω. At a fixed frequency the equations are
//! R(u, p) = 0; in a peak follows dA/dω = g(u, ω, p) = ∂A/∂ω − λᵀ ∂R/∂ω = 0 with the adjoint λ of the amplitude. With
//! the direction t = (du/dω, 1) of the branch over ω, the derivatives of g by u and ω are those of ∂A − (∂R)ᵀ λ along t at
//! a fixed λ: by one difference of exact Jacobians.

use crate::condense::{Condensed, Reference, Resolution};
use crate::continuation::Point;
use crate::error::{Result, fail, try_copy, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::linear_system::Jacobian;
use crate::linalg::norm;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::problem::{Homotopy, InitialGuess, Problem, Residual};
use crate::results::{Branch, ParameterData, Record, Special, SpecialKind};
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::design::design;
use crate::sensitivity::forced_point::ForcedPoint;
use crate::sensitivity::parameter::Parameter;
use crate::sensitivity::total_derivative::TotalDerivative;
use num_complex::Complex64;
use std::sync::Arc;

/// Change of ln ω that has the same weight as a change of the motions by their size.
const OMEGA_UNIT: f64 = 0.05;

/// Step of the differences by the parameter, over its range.
const PARAMETER_STEP: f64 = 1e-5;

/// Step of the differences along the branch over ω, over the width of the peak.
const BRANCH_STEP: f64 = 1e-4;

/// The response as a function of a parameter.
pub(crate) struct TrackedResponse<'a> {
    model: &'a Model,
    parameter: Parameter<'a>,
    solver: SolverOptions,
    response_dof: usize,
    range: (f64, f64),
    /// Frequency at a fixed one, or that of the first peak.
    omega: f64,
    is_peak: bool,
    /// Unit of lengths of the unknowns.
    length: f64,
    start: Vec<f64>,
    interrupt: &'a Interrupt<'a>,
    matrix: Vec<f64>,
    /// Amplitude, its derivative by ω and by the parameter at the point evaluated last.
    amplitude: f64,
    slopes: [f64; 2],
    /// Whether the reciprocal of the amplitude is observed.
    is_reciprocal: bool,
}

/// A model at a value of the parameter, condensed.
struct At {
    model: Model,
    condensed: Condensed,
}

impl<'a> TrackedResponse<'a> {
    /// The response of `model` from a solution at the start of `range`: packed relative motions in the unit `length`, at
    /// the angular frequency ω.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        (model, parameter): (&'a Model, Parameter<'a>),
        (solver, response_dof): (&SolverOptions, usize),
        range: (f64, f64),
        (motion, length, omega): (&[f64], f64, f64),
        is_peak: bool,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let n = motion.len() + usize::from(is_peak);
        let mut start = try_vec(n, 0.0, CONTEXT)?;
        start[..motion.len()].copy_from_slice(motion);
        let Some(size) = n.checked_mul(n) else {
            return fail!(OutOfMemory, "the Jacobian of {n} unknowns cannot be stored");
        };
        Ok(Self {
            model,
            parameter,
            solver: *solver,
            response_dof,
            range,
            omega,
            is_peak,
            length,
            start,
            interrupt,
            matrix: try_vec(size, 0.0, CONTEXT)?,
            amplitude: 0.0,
            slopes: [0.0; 2],
            is_reciprocal: false,
        })
    }

    /// Stores a point in a branch: on its curve, or where `kind` is given beside it. Returns its number.
    ///
    /// # Errors
    /// Those of the model at the point; `OutOfMemory`.
    pub fn store(
        &mut self,
        point: &Point,
        branch: &mut Branch,
        data: &mut ParameterData,
        kind: Option<SpecialKind>,
    ) -> Result<Special> {
        let (u, p) = (point.unknowns(), point.parameter());
        let mut values = try_vec(u.len(), 0.0, CONTEXT)?;
        self.equations(u, p, true, &mut values)?;
        let omega = self.frequency(u);
        let At { condensed, .. } = self.at(p, omega)?;
        let mut motion = try_copy(&u[..self.motions()], CONTEXT)?;
        for y in &mut motion {
            *y *= self.length / condensed.length();
        }
        let resolution = Resolution {
            condensed: Arc::new(condensed),
            samples: self.solver.samples,
        };
        let condensed = &*resolution.condensed;
        let mut at = ForcedPoint::new(
            condensed,
            (self.response_dof, self.solver.samples),
            omega,
            self.interrupt,
        )?;
        let mut response = try_vec(condensed.blocks().len(), Complex64::ZERO, CONTEXT)?;
        let slip_fractions = at.response(&motion, omega, &mut response)?;
        let record = Record {
            resolution: &resolution,
            omega,
            motion: &motion,
            amplitude: Complex64::from(self.amplitude / condensed.length()),
            response: &response,
            residual: point.residual,
            iterations: point.iterations,
            slip_fractions: &slip_fractions,
            sampling_error: f64::NAN,
            errors: (f64::NAN, f64::NAN),
        };
        match kind {
            None => branch.push_curve(&record)?,
            Some(SpecialKind::Peak) => {
                branch.push(&record)?;
            }
            Some(kind) => branch.push_special(kind, branch.points().saturating_sub(1), &record)?,
        }
        data.push(p, self.slopes[1])?;
        Ok(Special {
            point: branch.stored() - 1,
            omega,
            amplitude: self.amplitude,
        })
    }

    /// Observes the reciprocal of the amplitude, whose maxima are the minima of the amplitude.
    pub fn set_reciprocal(&mut self, is_reciprocal: bool) {
        self.is_reciprocal = is_reciprocal;
    }

    fn motions(&self) -> usize {
        self.start.len() - usize::from(self.is_peak)
    }

    fn frequency(&self, u: &[f64]) -> f64 {
        if self.is_peak {
            self.omega * (OMEGA_UNIT * u[u.len() - 1]).exp()
        } else {
            self.omega
        }
    }

    fn at(&self, p: f64, omega: f64) -> Result<At> {
        let model = design(self.model, core::slice::from_ref(&self.parameter), &[p])?;
        let reference = Some(Reference::Complex);
        let condensed = Condensed::with_reference(&model, &self.solver, (omega, omega), reference, self.interrupt)?;
        if condensed.unknowns() != self.motions() {
            return fail!(
                Unsupported,
                "at {p} the model has other contacts or harmonics with a force than at the start of the range"
            );
        }
        Ok(At { model, condensed })
    }

    /// Evaluates the equations at one value of the parameter; returns the residual of the motions and g·ω/A, and writes
    /// derivatives and results if `fully`.
    fn equations(&mut self, u: &[f64], p: f64, fully: bool, values: &mut [f64]) -> Result<f64> {
        let (m, n) = (self.motions(), u.len());
        let omega = self.frequency(u);
        let At { model, condensed } = self.at(p, omega)?;
        let unit = self.length / condensed.length();
        let mut own = try_copy(&u[..m], CONTEXT)?;
        for y in &mut own {
            *y *= unit;
        }
        let mut point = ForcedPoint::new(
            &condensed,
            (self.response_dof, self.solver.samples),
            omega,
            self.interrupt,
        )?;
        let Some(adjoint) = point.adjoint(&own, omega)? else {
            return fail!(Singular, "the response is in a fold over the frequency");
        };
        for (value, r) in values.iter_mut().zip(point.residual()) {
            *value = r / unit;
        }
        let scale = point.scale() / unit;
        let amplitude = adjoint.amplitude;
        let by_gauge = OMEGA_UNIT * omega / amplitude;
        if self.is_peak {
            values[m] = adjoint.by_omega * by_gauge;
        }
        if !fully {
            return Ok(scale);
        }
        self.matrix.fill(0.0);
        for (column, from) in self
            .matrix
            .chunks_exact_mut(n.max(1))
            .zip(point.jacobian().chunks_exact(m.max(1)))
        {
            column[..m].copy_from_slice(from);
        }
        if self.is_peak {
            let by_omega = point.residual_by_omega(omega)?;
            for (x, r) in self.matrix[m * n..m * n + m].iter_mut().zip(&by_omega) {
                *x = OMEGA_UNIT * omega * r / unit;
            }
            let row = peak_row(&mut point, &own, omega, &adjoint)?;
            for (k, x) in row[..m].iter().enumerate() {
                // The unknowns are in another unit than those of the condensed model.
                self.matrix[k * n + m] = x * unit * by_gauge;
            }
            self.matrix[m * n + m] = row[m] * OMEGA_UNIT * omega * by_gauge;
        }
        let at_frequency = model.at_frequency(omega)?;
        let solution = (&condensed, self.solver.samples);
        let mut total = TotalDerivative::new((&model, &at_frequency), solution, &adjoint, self.interrupt)?;
        let (by_parameter, _) = total.by(&self.parameter)?;
        self.amplitude = amplitude;
        // A factor or a force is relative to the value that the model has now.
        let relative = match self.parameter {
            Parameter::Force | Parameter::Factor { .. } => 1.0 / p,
            Parameter::Contact { .. } | Parameter::Direction { .. } | Parameter::Speed => 1.0,
        };
        self.slopes = [adjoint.by_omega, relative * by_parameter];
        Ok(scale)
    }
}

/// The derivatives of g = ∂A/∂ω − λᵀ ∂R/∂ω by the motions and by ω, at fixed p.
fn peak_row(point: &mut ForcedPoint<'_>, u: &[f64], omega: f64, adjoint: &Adjoint) -> Result<Vec<f64>> {
    let tangent = point.tangent(omega)?;
    let speed = norm(&tangent);
    let width = if speed > 0.0 { norm(u) / speed } else { omega };
    let mut row = try_vec(u.len() + 1, 0.0, CONTEXT)?;
    // The errors of two steps are even in the step.
    for (step, weight) in [(BRANCH_STEP, 4.0 / 3.0), (2.0 * BRANCH_STEP, -1.0 / 3.0)] {
        let step = step * width;
        for sign in [1.0, -1.0] {
            let mut moved = try_copy(u, CONTEXT)?;
            for (y, t) in moved.iter_mut().zip(&tangent) {
                *y += sign * step * t;
            }
            let gradient = point.gradient(&moved, omega + sign * step, &adjoint.lambda)?;
            for (x, g) in row.iter_mut().zip(&gradient) {
                *x += sign * weight * g / (2.0 * step);
            }
        }
    }
    Ok(row)
}

impl Jacobian for TrackedResponse<'_> {
    fn size(&self) -> usize {
        self.start.len()
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        active.fill(true);
        matrix.copy_from_slice(&self.matrix);
        Ok(())
    }
}

impl Problem for TrackedResponse<'_> {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        let n = u.len();
        let step = PARAMETER_STEP * (self.range.1 - self.range.0).abs();
        let mut below = try_vec(n, 0.0, CONTEXT)?;
        let mut above = try_vec(n, 0.0, CONTEXT)?;
        // At the end of what the parameter may be the difference is taken to one side.
        let (mut low, mut high) = (p - step, p + step);
        if self.equations(u, low, false, &mut below).is_err() {
            low = p;
            self.equations(u, low, false, &mut below)?;
        }
        if self.equations(u, high, false, &mut above).is_err() {
            high = p;
            self.equations(u, high, false, &mut above)?;
        }
        for ((d, above), below) in out.d_parameter.iter_mut().zip(&above).zip(&below) {
            *d = (above - below) / (high - low);
        }
        out.scale = self.equations(u, p, true, &mut out.values)?;
        out.rounding = 0.0;
        Ok(())
    }

    /// The amplitude; its derivative is that along the curve of solutions.
    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        let n = u.len();
        let mut change = self.slopes[1] * direction[n];
        if self.is_peak {
            change += self.slopes[0] * OMEGA_UNIT * self.frequency(u) * direction[n - 1];
        }
        if self.is_reciprocal {
            change /= -self.amplitude * self.amplitude;
            return ((1.0 / self.amplitude).into(), change.into());
        }
        (self.amplitude.into(), change.into())
    }

    fn initial_guess(&mut self, kind: InitialGuess, _p: f64, u: &mut [f64]) -> Result<bool> {
        if kind != InitialGuess::Given {
            return Ok(false);
        }
        u.copy_from_slice(&self.start);
        Ok(true)
    }

    fn homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}
