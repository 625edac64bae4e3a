//! A forced response as a function of a parameter of the model, as a [`Problem`]: at a fixed frequency, in a peak, or in
//! a fold over the frequency.
//!
//! The unknowns are the packed relative motions u and in a peak or fold also ln ω. At a fixed frequency the equations are
//! R(u, p) = 0; in a peak follows dA/dω = g(u, ω, p) = ∂A/∂ω − λᵀ ∂R/∂ω = 0 with the adjoint λ of the amplitude. With
//! the direction t = (du/dω, 1) of the branch over ω, the derivatives of g by u and ω are those of ∂A − (∂R)ᵀ λ along t at
//! a fixed λ: by one difference of exact Jacobians. The condition of a fold is that of [`fold_point`], and
//! that of a peak which is followed beyond the parameter at which it vanishes that of [`extremum_point`].
//!
//! [`fold_point`]: crate::sensitivity::fold_point
//! [`extremum_point`]: crate::sensitivity::extremum_point

use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::{Condensed, ModelCache, Reference, Resolution};
use crate::continuation::Point;
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::forced_response_error::ForcedEstimator;
use crate::harmonics::{Corrected, Estimate, Solved};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::newton::linear_system::Jacobian;
use crate::linalg::{dot, norm};
use crate::model::Model;
use crate::options::Range;
use crate::options::{Response, SolverOptions};
use crate::problem::epmc::OMEGA_UNIT;
use crate::problem::gauges::Gauges;
use crate::problem::{Homotopy, InitialGuess, Problem, Residual};
use crate::results::{Branch, ParameterData, Record, Special, SpecialKind};
use crate::sensitivity::adjoint::{Adjoint, CONTEXT};
use crate::sensitivity::central_differences::central_differences;
use crate::sensitivity::design::design;
use crate::sensitivity::extremum_point::{extremum_gradient, extremum_matrix};
use crate::sensitivity::fold_point::{Borders, FoldCondition, fold_gradient};
use crate::sensitivity::forced_point::ForcedPoint;
use crate::sensitivity::parameter::Parameter;
use crate::sensitivity::total_derivative::TotalDerivative;
use crate::sensitivity::tracked::{Tracked, Unknowns, by_differences};
use num_complex::Complex64;
use std::sync::Arc;

/// Newton iterations by which the work of an estimate is bounded: those of a point that is solved by homotopy.
/// Kind: cap.
const TRACKED_RESPONSE_ITERATIONS: usize = 200;

/// Point of a forced response that is followed over a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ResponsePoint {
    /// The point at a fixed frequency.
    Fixed,
    /// A maximum of the amplitude.
    Peak,
    /// A maximum of the amplitude, and the minimum that meets it.
    Extremum,
    /// A turning point of the frequency.
    Fold,
}

/// The followed point of a forced response over a parameter, as a problem.
pub(crate) struct TrackedResponse<'a> {
    model: &'a Model,
    parameter: Parameter<'a>,
    solver: SolverOptions,
    response_dof: usize,
    /// The response that is followed in place of the amplitude; `None`: the amplitude.
    response: Option<Response<'a>>,
    /// The fixed frequency, or the frequency of the first peak or fold.
    omega: f64,
    kind: ResponsePoint,
    /// Unit of length of the motions among the unknowns.
    length: f64,
    unknowns: Unknowns,
    interrupt: &'a Interrupt<'a>,
    /// Borders of the condition of a fold or an extremum, from the first evaluation on.
    borders: Option<Borders>,
    last: LastResponse,
}

/// Result of the point evaluated last.
pub(crate) struct LastResponse {
    /// Amplitude at the point evaluated last, its total derivative by the parameter, and its change with all unknowns and
    /// the parameter along solutions.
    amplitude: f64,
    d_amplitude: f64,
    gradient: Vec<f64>,
    /// Second derivative d²A/dω² of a peak.
    curvature: f64,
}

/// The model at a value of the parameter, condensed.
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
        (solver, response_dof, response): (&SolverOptions, usize, Option<Response<'a>>),
        range: Range,
        (motion, length, omega): (&[f64], f64, f64),
        kind: ResponsePoint,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let n = motion.len() + usize::from(kind != ResponsePoint::Fixed);
        let mut start = try_vec(n, 0.0, CONTEXT)?;
        start[..motion.len()].copy_from_slice(motion);
        // The unknown of the frequency is 1 at the first one: unknowns of size 0 have no unit.
        start[motion.len()..].fill(1.0);
        Ok(Self {
            model,
            parameter,
            solver: *solver,
            response_dof,
            response,
            omega,
            kind,
            length,
            unknowns: Unknowns::new(start, range)?,
            interrupt,
            borders: None,
            last: LastResponse {
                amplitude: 0.0,
                d_amplitude: 0.0,
                gradient: try_vec(n + 1, 0.0, CONTEXT)?,
                curvature: f64::NAN,
            },
        })
    }

    /// Whether the frequency is an unknown.
    fn is_free(&self) -> bool {
        self.kind != ResponsePoint::Fixed
    }

    fn frequency(&self, u: &[f64]) -> f64 {
        if self.is_free() {
            self.omega * (OMEGA_UNIT * (u[u.len() - 1] - 1.0)).exp()
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

    /// The equations on a condensed model, with the followed response.
    fn point<'c>(&self, condensed: &'c Condensed, omega: f64) -> Result<ForcedPoint<'c>>
    where
        'a: 'c,
    {
        let samples = self.solver.samples;
        let point = ForcedPoint::new(condensed, (self.response_dof, samples), omega, self.interrupt)?;
        match self.response {
            Some(response) => point.watching((&response, self.response_dof), samples),
            None => Ok(point),
        }
    }

    /// Values of the followed response at a solution, as an estimate watches them, in the caller's unit.
    fn watched(&self, condensed: &Condensed, own: &[f64], omega: f64) -> Result<Vec<Complex64>> {
        let mut seen = Vec::new();
        let mut values = Vec::new();
        if let Some(response) = &self.response {
            let mut v = try_copy(own, CONTEXT)?;
            try_push(&mut v, omega, CONTEXT)?;
            let none = try_vec(v.len(), 0.0, CONTEXT)?;
            let responses = (core::slice::from_ref(response), self.response_dof);
            Gauges::new(condensed, responses, self.solver.samples, self.interrupt)?.read(&v, &none, None, &mut seen)?;
        }
        for one in &seen {
            try_push(&mut values, one.observed().0 * condensed.length(), CONTEXT)?;
        }
        Ok(values)
    }

    /// Motions in the unit of length of a condensed model.
    fn own_motion(&self, u: &[f64], condensed: &Condensed) -> Result<Vec<f64>> {
        let mut own = try_copy(&u[..self.motions()], CONTEXT)?;
        for y in &mut own {
            *y *= self.length / condensed.length();
        }
        Ok(own)
    }

    /// Evaluates the equations at one value of the parameter; returns the scale of the residual, and writes derivatives
    /// and results if `fully`.
    fn equations(&mut self, u: &[f64], p: f64, fully: bool, values: &mut [f64]) -> Result<f64> {
        let m = self.motions();
        let omega = self.frequency(u);
        let At { model, condensed } = self.at(p, omega)?;
        let unit = self.length / condensed.length();
        let own = self.own_motion(u, &condensed)?;
        let mut point = self.point(&condensed, omega)?;
        let (models, at) = ((&model, &condensed), (&*own, omega, p));
        let scale = match self.kind {
            ResponsePoint::Fold => self.fold_equations(&mut point, models, at, (fully, values))?,
            ResponsePoint::Extremum => self.extremum_equations(&mut point, models, at, (fully, values))?,
            ResponsePoint::Fixed | ResponsePoint::Peak => {
                self.peak_equations(&mut point, models, at, (fully, values))?
            }
        };
        for value in &mut values[..m] {
            *value /= unit;
        }
        // Without contacts the condition of the frequency, whose size is 1, is the only equation.
        Ok(if m == 0 { 1.0 } else { scale / unit })
    }

    /// Evaluates the equations at a fixed frequency or in a peak; returns the scale of their residual, in the unit of
    /// the condensed model.
    fn peak_equations(
        &mut self,
        point: &mut ForcedPoint<'_>,
        (model, condensed): (&Model, &Condensed),
        (own, omega, p): (&[f64], f64, f64),
        (fully, values): (bool, &mut [f64]),
    ) -> Result<f64> {
        let m = own.len();
        let unit = self.length / condensed.length();
        let Some(adjoint) = point.adjoint(own, omega)? else {
            return fail!(Singular, "the response is in a fold over the frequency");
        };
        values[..m].copy_from_slice(point.residual());
        let scale = point.scale();
        let by_gauge = OMEGA_UNIT * omega / adjoint.amplitude;
        if self.is_free() {
            values[m] = adjoint.by_omega * by_gauge;
        }
        if !fully {
            return Ok(scale);
        }
        self.fill_motions(point.jacobian());
        self.last.gradient.fill(0.0);
        if self.is_free() {
            let by_omega = point.residual_by_omega(omega)?;
            let (row, curvature) = peak_row(point, own, omega, &adjoint)?;
            self.last.curvature = curvature;
            self.fill_frequency(&by_omega, &row, omega, unit, by_gauge);
            self.last.gradient[m] = adjoint.by_omega * OMEGA_UNIT * omega;
        }
        let slope = self.by_parameter((model, condensed), p, &adjoint)?;
        self.last.gradient[values.len()] = slope;
        (self.last.amplitude, self.last.d_amplitude) = (adjoint.amplitude, slope);
        Ok(scale)
    }

    /// Evaluates the equations in a fold; returns the scale of their residual.
    fn fold_equations(
        &mut self,
        point: &mut ForcedPoint<'_>,
        (model, condensed): (&Model, &Condensed),
        (own, omega, p): (&[f64], f64, f64),
        (fully, values): (bool, &mut [f64]),
    ) -> Result<f64> {
        let (m, n) = (own.len(), values.len());
        let length = condensed.length();
        let unit = self.length / length;
        let (by_motion, amplitude) = point.amplitude(own, omega)?;
        values[..m].copy_from_slice(point.residual());
        let scale = point.scale();
        let borders = match self.borders.take() {
            Some(borders) => borders,
            None => Borders::near(point.jacobian(), m, self.interrupt)?,
        };
        let at = borders.condition(point.jacobian(), self.interrupt);
        self.borders = Some(borders);
        let at = at?;
        values[m] = at.value;
        if !fully {
            return Ok(scale);
        }
        self.fill_motions(point.jacobian());
        let none = try_vec(m, 0.0, CONTEXT)?;
        let partial = point.of_lambda((own, omega), amplitude, &none)?;
        let by_omega = point.residual_by_omega(omega)?;
        let models = (model, condensed);
        let g = fold_gradient(point, own, omega, length, &at, |adjoint| {
            self.by_parameter(models, p, adjoint)
        })?;
        self.fill_frequency(&by_omega, &g.by_unknowns, omega, unit, 1.0);
        self.last.amplitude = length * amplitude.norm();
        // The change of the amplitude with all unknowns: in a fold its adjoint at a fixed frequency does not exist.
        for (to, from) in self.last.gradient.iter_mut().zip(&by_motion) {
            *to = self.length * from;
        }
        self.last.gradient[m] = partial.by_omega * OMEGA_UNIT * omega;
        self.last.gradient[n] = self.by_parameter(models, p, &partial)?;
        // The adjoint of motions, frequency and condition together.
        let mut system = Lu::new(n, 1)?;
        system.matrix().copy_from_slice(&self.unknowns.matrix);
        self.last.d_amplitude = f64::NAN;
        if system.factor(self.interrupt).is_ok() {
            let mut lambda = try_copy(&self.last.gradient[..n], CONTEXT)?;
            system.solve_transposed(&mut lambda);
            // R is in the unit of the unknowns, and the result of an adjoint motion in that of the condensed model.
            let weight = lambda.pop().unwrap_or(f64::NAN);
            for x in &mut lambda {
                *x /= self.length;
            }
            point.amplitude(own, omega)?;
            let adjoint = point.of_lambda((own, omega), amplitude, &lambda)?;
            self.last.d_amplitude = self.by_parameter(models, p, &adjoint)? - weight * g.by_parameter;
        }
        Ok(scale)
    }

    /// Evaluates the equations in a peak or in the minimum that meets it; returns the scale of their residual.
    fn extremum_equations(
        &mut self,
        point: &mut ForcedPoint<'_>,
        (model, condensed): (&Model, &Condensed),
        (own, omega, p): (&[f64], f64, f64),
        (fully, values): (bool, &mut [f64]),
    ) -> Result<f64> {
        let (m, n) = (own.len(), values.len());
        let length = condensed.length();
        let unit = self.length / length;
        let (by_motion, amplitude) = point.amplitude(own, omega)?;
        values[..m].copy_from_slice(point.residual());
        let scale = point.scale();
        let none = try_vec(m, 0.0, CONTEXT)?;
        let partial = point.of_lambda((own, omega), amplitude, &none)?;
        let by_omega = point.residual_by_omega(omega)?;
        let at = self.extremum_condition(point, (&by_omega, &by_motion, partial.by_omega / length), omega)?;
        values[m] = at.value;
        if !fully {
            return Ok(scale);
        }
        self.fill_motions(point.jacobian());
        let row = extremum_gradient(point, own, omega, length, &at, OMEGA_UNIT * omega)?;
        self.fill_frequency(&by_omega, &row, omega, unit, 1.0);
        self.last.amplitude = length * amplitude.norm();
        for (to, from) in self.last.gradient.iter_mut().zip(&by_motion) {
            *to = self.length * from;
        }
        self.last.gradient[m] = partial.by_omega * OMEGA_UNIT * omega;
        self.last.gradient[n] = self.by_parameter((model, condensed), p, &partial)?;
        // The amplitude does not change with the frequency there, so that its derivative is that at a fixed one.
        self.last.d_amplitude = match point.adjoint(own, omega)? {
            Some(adjoint) => self.by_parameter((model, condensed), p, &adjoint)?,
            None => f64::NAN,
        };
        Ok(scale)
    }

    /// The condition of an extremum at the point linearised last.
    fn extremum_condition(
        &mut self,
        point: &ForcedPoint<'_>,
        derivatives: (&[f64], &[f64], f64),
        omega: f64,
    ) -> Result<FoldCondition> {
        let matrix = extremum_matrix(point.jacobian(), derivatives, OMEGA_UNIT * omega)?;
        let borders = match self.borders.take() {
            Some(borders) => borders,
            None => Borders::near(&matrix, derivatives.1.len() + 1, self.interrupt)?,
        };
        let at = borders.condition(&matrix, self.interrupt);
        self.borders = Some(borders);
        at
    }

    /// Replaces the borders by the null vectors at a solution.
    fn follow_borders(&mut self, point: &mut ForcedPoint<'_>, own: &[f64], omega: f64) -> Result<()> {
        if self.borders.is_none() {
            return Ok(());
        }
        let (by_motion, amplitude) = point.amplitude(own, omega)?;
        let null = if self.kind == ResponsePoint::Extremum {
            let none = try_vec(own.len(), 0.0, CONTEXT)?;
            let slope = point.of_lambda((own, omega), amplitude, &none)?.by_omega / point.length();
            let by_omega = point.residual_by_omega(omega)?;
            Some(self.extremum_condition(point, (&by_omega, &by_motion, slope), omega)?)
        } else {
            None
        };
        if let Some(borders) = &mut self.borders {
            let null = match null {
                Some(null) => null,
                None => borders.condition(point.jacobian(), self.interrupt)?,
            };
            borders.follow(&null)?;
        }
        Ok(())
    }

    /// Writes Newton's matrix of the motions as a part of the Jacobian.
    fn fill_motions(&mut self, jacobian: &[f64]) {
        let (m, n) = (self.motions(), self.unknowns.len());
        self.unknowns.matrix.fill(0.0);
        for (column, from) in self
            .unknowns
            .matrix
            .chunks_exact_mut(n.max(1))
            .zip(jacobian.chunks_exact(m.max(1)))
        {
            column[..m].copy_from_slice(from);
        }
    }

    /// Writes the column of the frequency, and the row of its condition, the latter times a factor.
    fn fill_frequency(&mut self, column: &[f64], row: &[f64], omega: f64, unit: f64, factor: f64) {
        let (m, n) = (self.motions(), self.unknowns.len());
        for (x, r) in self.unknowns.matrix[m * n..m * n + m].iter_mut().zip(column) {
            *x = OMEGA_UNIT * omega * r / unit;
        }
        for (k, x) in row[..m].iter().enumerate() {
            // The unknowns are in another unit than those of the condensed model.
            self.unknowns.matrix[k * n + m] = x * unit * factor;
        }
        self.unknowns.matrix[m * n + m] = row[m] * OMEGA_UNIT * omega * factor;
    }

    /// Derivative by the parameter of the result to which an adjoint motion belongs.
    fn by_parameter(&self, (model, condensed): (&Model, &Condensed), p: f64, adjoint: &Adjoint) -> Result<f64> {
        let at_frequency = model.at_frequency(adjoint.omega)?;
        let solution = (condensed, self.solver.samples);
        let mut total = TotalDerivative::new((model, &at_frequency), solution, adjoint, self.interrupt)?;
        let (by_parameter, _) = total.by(&self.parameter)?;
        Ok(self.parameter.relative_at(p) * by_parameter)
    }
}

impl Tracked for TrackedResponse<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        self
    }

    fn motions(&self) -> usize {
        self.unknowns.len() - usize::from(self.is_free())
    }

    fn select(&mut self, from: &HarmonicSet, to: &Resolution, highest: usize) -> Result<()> {
        let motions = to.condensed.unknowns();
        let n = motions + usize::from(self.is_free());
        if let Some(borders) = &mut self.borders {
            let to = to.condensed.set();
            if self.kind == ResponsePoint::Extremum {
                borders.transfer_with_frequency(from, to, motions)?;
            } else {
                borders.transfer(from, to, motions)?;
            }
        }
        self.unknowns.resize(n)?;
        self.last.gradient = try_vec(n + 1, 0.0, CONTEXT)?;
        self.solver.harmonics = highest;
        self.solver.samples = self.solver.samples.max(to.samples);
        Ok(())
    }

    fn estimate(&mut self, point: &Point) -> Result<Option<(f64, Estimate)>> {
        // Where curves are born or merge the solution at a fixed frequency is not isolated.
        if matches!(self.kind, ResponsePoint::Fold | ResponsePoint::Extremum) {
            return Ok(None);
        }
        let (u, p) = (point.unknowns(), point.parameter());
        let omega = self.frequency(u);
        let At { model, condensed } = self.at(p, omega)?;
        let own = self.own_motion(u, &condensed)?;
        let samples = (self.response_dof, self.solver.samples);
        let mut at = ForcedPoint::new(&condensed, samples, omega, self.interrupt)?;
        let (_, amplitude) = at.amplitude(&own, omega)?;
        let watched = self.watched(&condensed, &own, omega)?;
        let solved = Solved {
            condensed: &condensed,
            motion: &own,
            omega,
            response: amplitude * condensed.length(),
            watched: &watched,
            together: false,
            sticks: None,
            iterations: TRACKED_RESPONSE_ITERATIONS,
        };
        let models = (&ModelCache::for_estimates()?, &SharedWaves::default());
        let estimator = ForcedEstimator::new(&model, &self.solver, self.response_dof, models, self.interrupt);
        let mut estimator = estimator.watching(self.response.as_slice());
        let estimate = estimator.at(&solved)?;
        Ok(Some((estimate.response, estimate)))
    }

    fn take_corrected(&self, corrected: &Corrected, set: &HarmonicSet, v: &mut [f64]) {
        let motions = self.motions();
        set.transfer(&corrected.set, &corrected.motion, 1.0 / self.length, &mut v[..motions]);
    }

    fn store(
        &mut self,
        point: &Point,
        error: f64,
        branch: &mut Branch,
        data: &mut ParameterData,
        kind: Option<SpecialKind>,
    ) -> Result<(Special, f64)> {
        let (u, p) = (point.unknowns(), point.parameter());
        let mut values = try_vec(u.len(), 0.0, CONTEXT)?;
        self.equations(u, p, true, &mut values)?;
        let omega = self.frequency(u);
        let At { condensed, .. } = self.at(p, omega)?;
        let motion = self.own_motion(u, &condensed)?;
        let resolution = Resolution {
            condensed: Arc::new(condensed),
            samples: self.solver.samples,
        };
        let condensed = &*resolution.condensed;
        let mut at = self.point(condensed, omega)?;
        let mut response = try_vec(condensed.blocks().len(), Complex64::ZERO, CONTEXT)?;
        let slip_fractions = at.response(&motion, omega, &mut response)?;
        self.follow_borders(&mut at, &motion, omega)?;
        let sampling_error = at.sampling_error(&motion, omega)?;
        let record = Record {
            resolution: &resolution,
            omega,
            motion: &motion,
            amplitude: Complex64::from(self.last.amplitude / condensed.length()),
            response: &response,
            residual: point.residual,
            iterations: point.iterations,
            slip_fractions: &slip_fractions,
            sampling_error,
            errors: (error, f64::NAN),
            seen: &[],
        };
        branch.push_followed(kind, &record)?;
        data.push(p, (self.last.d_amplitude, f64::NAN))?;
        let special = Special {
            point: branch.stored() - 1,
            omega,
            amplitude: self.last.amplitude,
        };
        Ok((special, sampling_error))
    }

    fn set_reciprocal(&mut self, is_reciprocal: bool) {
        self.unknowns.is_reciprocal = is_reciprocal;
    }

    fn exists(&mut self, point: &Point) -> Result<bool> {
        if self.kind != ResponsePoint::Peak {
            return Ok(true);
        }
        let mut values = try_vec(point.unknowns().len(), 0.0, CONTEXT)?;
        self.equations(point.unknowns(), point.parameter(), true, &mut values)?;
        Ok(self.last.curvature <= 0.0)
    }
}

/// The derivatives of g = ∂A/∂ω − λᵀ ∂R/∂ω by the motions and by ω, at fixed p, and d²A/dω².
pub(crate) fn peak_row(
    point: &mut ForcedPoint<'_>,
    u: &[f64],
    omega: f64,
    adjoint: &Adjoint,
) -> Result<(Vec<f64>, f64)> {
    let tangent = point.tangent(omega)?;
    let speed = norm(&tangent);
    let width = if speed > 0.0 { norm(u) / speed } else { omega };
    let mut row = try_vec(u.len() + 1, 0.0, CONTEXT)?;
    for (step, weight) in central_differences(width) {
        let mut moved = try_copy(u, CONTEXT)?;
        for (y, t) in moved.iter_mut().zip(&tangent) {
            *y += step * t;
        }
        let gradient = point.gradient(&moved, omega + step, &adjoint.lambda)?;
        for (x, g) in row.iter_mut().zip(&gradient) {
            *x += weight * g;
        }
    }
    let curvature = dot(&row[..u.len()], &tangent) + row[u.len()];
    Ok((row, curvature))
}

impl Jacobian for TrackedResponse<'_> {
    fn size(&self) -> usize {
        self.unknowns.len()
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        self.unknowns.fill(matrix, active);
        Ok(())
    }
}

impl Problem for TrackedResponse<'_> {
    fn evaluate(&mut self, u: &[f64], p: f64, out: &mut Residual) -> Result<()> {
        by_differences(out, (p, self.unknowns.step), |p, values| {
            self.equations(u, p, false, values)
        })?;
        out.scale = self.equations(u, p, true, &mut out.values)?;
        out.rounding = 0.0;
        Ok(())
    }

    /// Observes the amplitude; its derivative is taken along the curve of solutions.
    fn observe(&self, u: &[f64], direction: &[f64]) -> (Complex64, Complex64) {
        let mut change = dot(&self.last.gradient[..u.len()], &direction[..u.len()]);
        change += self.last.gradient[u.len()] * direction[u.len()];
        self.unknowns.observe(self.last.amplitude, change)
    }

    fn initial_guess(&mut self, kind: InitialGuess, _p: f64, u: &mut [f64]) -> Result<bool> {
        Ok(self.unknowns.initial_guess(kind, u))
    }

    fn homotopy(&mut self, _p: f64, _u: &[f64]) -> Result<Option<Homotopy<'_>>> {
        Ok(None)
    }
}
