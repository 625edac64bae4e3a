//! The largest damping ratio of a nonlinear mode as a function of a parameter of the model, as a [`Problem`].
//!
//! The unknowns are those x of the mode, the packed relative motions per unit of amplitude, the frequency ω and the damping
//! ratio D, and a = log₁₀ of the amplitude. With R(x, a, p) = 0 follows dD/da = g = −λᵀ ∂R/∂a = 0 with the adjoint λ of D.
//! Along the direction t = (dx/da, 1) of the mode, the derivatives of g by x and a are those of −(∂R)ᵀ λ at a fixed λ: by
//! one difference of exact Jacobians. In the maximum dD/dp is the derivative at a fixed amplitude.

use crate::analysis::linear::static_solution::{NEEDS_SPEED, static_state};
use crate::analysis::modes::mode_equations::{Equations, LinearStart};
use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::condense::by_modes::wave_cache::SharedWaves;
use crate::condense::{Condensed, ModelCache, Resolution};
use crate::continuation::step_control::StepControl;
use crate::continuation::{Point, Settings};
use crate::error::{Result, Status, fail, try_copy, try_vec};
use crate::fourier::HarmonicSet;
use crate::harmonics::mode_error::{ModeEstimator, ModeState, NO_DAMPING};
use crate::harmonics::{Corrected, Estimate, Solved};
use crate::interrupt::Interrupt;
use crate::linalg::factors::lu::Lu;
use crate::linalg::newton::linear_system::Jacobian;
use crate::linalg::{dot, norm};
use crate::model::Model;
use crate::options::Range;
use crate::options::{DampingForm, SolverOptions};
use crate::problem::epmc::{Epmc, Gauge, LinearMode};
use crate::problem::{Problem, Residual};
use crate::results::stored::mode_branch::ModePoint;
use crate::results::{Branch, ParameterData, Record, Special, SpecialKind};
use crate::sensitivity::tracked::{FirstMotion, Tracked, Unknowns};
use crate::sensitivity::{
    ModePointAdjoint, ModeQuantity, Parameter, SampledModel, TotalDerivative, central_differences, design,
};
use num_complex::Complex64;
use std::sync::Arc;

const CONTEXT: &str = "the parameter response";

/// Change of log₁₀ of the amplitude that has the same weight as a change of the motions by their size.
/// Kind: tuned; measured on: not recorded.
const AMPLITUDE_UNIT: f64 = 0.1;

/// The mode whose largest damping ratio is followed, and the parameter over which.
#[derive(Clone, Copy)]
pub(crate) struct FollowedDamping<'a> {
    pub model: &'a Model,
    pub parameter: Parameter<'a>,
    pub response_dof: usize,
    /// The linear mode at the first value, whose frequency, damping and shape give the units at all values.
    pub linear: &'a LinearMode,
    pub gauge: &'a Gauge,
}

/// The largest damping ratio of a nonlinear mode over a parameter.
pub(crate) struct TrackedDamping<'a> {
    followed: FollowedDamping<'a>,
    solver: SolverOptions,
    /// Amplitude, as log₁₀, at which its unknown is 0.
    log10_amplitude: f64,
    /// Unit of length of the motions among the unknowns.
    length: f64,
    unknowns: Unknowns,
    interrupt: &'a Interrupt<'a>,
    last: LastDamping,
}

/// Result of the point evaluated last.
pub(crate) struct LastDamping {
    /// Damping ratio at the point evaluated last, its derivative by the parameter, and its second one along the mode.
    damping: f64,
    d_damping: f64,
    curvature: f64,
}

/// A model at a value of the parameter, condensed about its static state.
struct At {
    model: Model,
    condensed: Condensed,
    linear: LinearMode,
}

impl<'a> TrackedDamping<'a> {
    /// The damping ratio of `model` from a point of its mode at the start of `range`: packed relative motions, static
    /// ones included, with their unit of length, frequency and numbers.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        followed: FollowedDamping<'a>,
        solver: &SolverOptions,
        range: Range,
        start: &FirstMotion<'_>,
        point: ModePoint,
        set: &HarmonicSet,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let &FirstMotion { motion, length, omega } = start;
        let linear = followed.linear;
        let n = motion.len() + 3;
        let mut begin = try_vec(n, 0.0, CONTEXT)?;
        begin[..motion.len()].copy_from_slice(motion);
        let rest = linear.rest.in_units(length)?;
        for (u, rest) in begin.iter_mut().step_by(set.packed_len()).zip(&rest.motion) {
            *u -= rest;
        }
        let amplitude = 10f64.powf(point.log10_amplitude);
        for u in &mut begin[..motion.len()] {
            *u /= amplitude;
        }
        Epmc::set_frequency_and_damping(
            linear,
            DampedFrequency::new(omega, point.damping_ratio),
            &mut begin[..n - 1],
        );
        Ok(Self {
            followed,
            solver: *solver,
            log10_amplitude: point.log10_amplitude,
            length,
            unknowns: Unknowns::new(begin, range)?,
            interrupt,
            last: LastDamping {
                damping: 0.0,
                d_damping: 0.0,
                curvature: f64::NAN,
            },
        })
    }

    /// Amplitude, as log₁₀, from the unknowns.
    fn log10(&self, u: &[f64]) -> f64 {
        self.log10_amplitude + AMPLITUDE_UNIT * u[u.len() - 1]
    }

    fn at(&self, p: f64) -> Result<At> {
        let model = design(
            self.followed.model,
            core::slice::from_ref(&self.followed.parameter),
            &[p],
        )?;
        let model = model.with_separate_loss()?.into_owned();
        let linear = LinearMode {
            rest: static_state(&model, &self.solver, NEEDS_SPEED, self.interrupt)?,
            shape: try_copy(&self.followed.linear.shape, CONTEXT)?,
            ..*self.followed.linear
        };
        let form = (DampingForm::Mass, linear.rest.is_loaded());
        let (condensed, _) = Condensed::for_mode(&model, &self.solver, form, &linear.shape, self.interrupt)?;
        if condensed.unknowns() != self.motions() {
            return fail!(
                Unsupported,
                "at {p} the mode has other contacts or harmonics than at the start of the range"
            );
        }
        Ok(At {
            model,
            condensed,
            linear,
        })
    }

    /// Unknowns of the mode in the unit of length of a condensed model.
    fn own(&self, u: &[f64], condensed: &Condensed) -> Result<Vec<f64>> {
        let mut own = try_copy(&u[..u.len() - 1], CONTEXT)?;
        for y in &mut own[..self.motions()] {
            *y *= self.length / condensed.length();
        }
        Ok(own)
    }

    /// Packed relative motions from the unknowns: about the static state, and in total.
    fn motion(&self, own: &[f64], log10: f64, at: &At) -> Result<(Vec<f64>, Vec<f64>)> {
        let mut vibration = try_copy(&own[..self.motions()], CONTEXT)?;
        for y in &mut vibration {
            *y *= 10f64.powf(log10);
        }
        let mut motion = try_copy(&vibration, CONTEXT)?;
        let rest = at.linear.rest.in_units(at.condensed.length())?;
        let packed = at.condensed.set().packed_len();
        for (m, rest) in motion.iter_mut().step_by(packed).zip(&rest.motion) {
            *m += rest;
        }
        Ok((vibration, motion))
    }

    /// Evaluates the equations at one value of the parameter; returns the scale of the residual, and writes derivatives
    /// and results if `fully`.
    fn evaluate_equations(&mut self, u: &[f64], p: f64, fully: bool, values: &mut [f64]) -> Result<f64> {
        let (m, n) = (self.motions(), u.len());
        let x = n - 1;
        let at = self.at(p)?;
        let unit = self.length / at.condensed.length();
        let (own, log10) = (self.own(u, &at.condensed)?, self.log10(u));
        let mut problem = Epmc::new(
            &at.condensed,
            self.followed.gauge,
            &at.linear,
            self.solver.samples,
            self.interrupt,
        )?;
        let mut here = Residual::new(x)?;
        problem.evaluate(&own, log10, &mut here)?;
        let mut system = Lu::new(x, 1)?;
        problem.fill(system.matrix(), &mut try_vec(x, true, CONTEXT)?)?;
        let jacobian = try_copy(system.matrix(), CONTEXT)?;
        if let Err(e) = system.factor(self.interrupt) {
            if e.status != Status::Singular {
                return Err(e);
            }
            return fail!(Singular, "the mode is in a fold over the amplitude");
        }
        let mut lambda = try_vec(x, 0.0, CONTEXT)?;
        lambda[problem.damping_unknown().0] = 1.0;
        system.solve_transposed(&mut lambda);
        for (i, (value, r)) in values.iter_mut().zip(&here.values).enumerate() {
            *value = if i < m { r / unit } else { *r };
        }
        values[x] = -AMPLITUDE_UNIT * dot(&lambda, &here.d_parameter);
        if !fully {
            return Ok(here.scale);
        }
        let mut tangent = try_copy(&here.d_parameter, CONTEXT)?;
        system.solve(&mut tangent);
        for t in &mut tangent {
            *t = -*t;
        }
        let row = maximum_row(&mut problem, &own, log10, &tangent, &lambda)?;
        self.last.curvature = dot(&row[..x], &tangent) + row[x];
        self.unknowns.matrix.fill(0.0);
        // Motions are in another unit than those of the condensed model.
        let of = |i: usize| if i < m { unit } else { 1.0 };
        for k in 0..x {
            let column = &mut self.unknowns.matrix[k * n..(k + 1) * n];
            for (i, (to, from)) in column.iter_mut().zip(&jacobian[k * x..(k + 1) * x]).enumerate() {
                *to = from * of(k) / of(i);
            }
            column[x] = AMPLITUDE_UNIT * row[k] * of(k);
        }
        let last = &mut self.unknowns.matrix[x * n..];
        for (i, (to, from)) in last.iter_mut().zip(&here.d_parameter).enumerate() {
            *to = AMPLITUDE_UNIT * from / of(i);
        }
        last[x] = AMPLITUDE_UNIT * AMPLITUDE_UNIT * row[x];
        self.last.damping = Epmc::frequency_and_damping(&at.linear, &own).damping;
        self.last.d_damping = self.by_parameter(&own, log10, p, &at)?;
        Ok(here.scale)
    }

    /// Derivative of the damping ratio by the parameter at a fixed amplitude.
    fn by_parameter(&self, own: &[f64], log10: f64, p: f64, at: &At) -> Result<f64> {
        let DampedFrequency {
            omega,
            damping: damping_ratio,
        } = Epmc::frequency_and_damping(&at.linear, own);
        let (_, motion) = self.motion(own, log10, at)?;
        let adjoint = ModePointAdjoint {
            condensed: &at.condensed,
            linear: &at.linear,
            gauge: self.followed.gauge,
            samples: self.solver.samples,
            motion: &motion,
            omega,
            point: ModePoint {
                log10_amplitude: log10,
                damping_ratio,
                ..ModePoint::default()
            },
        };
        let Some(adjoint) = adjoint.solve(ModeQuantity::Damping, self.interrupt)? else {
            return Ok(f64::NAN);
        };
        let at_frequency = at.model.at_frequency(omega)?;
        let solution = SampledModel {
            condensed: &at.condensed,
            samples: self.solver.samples,
        };
        let mut total = TotalDerivative::new(&at.model, &at_frequency, solution, &adjoint, self.interrupt)?;
        Ok(self.followed.parameter.relative_at(p) * total.by(&self.followed.parameter)?.0)
    }
}

/// The derivatives of g = −λᵀ ∂R/∂a by the unknowns of the mode and by a.
fn maximum_row(problem: &mut Epmc<'_>, own: &[f64], log10: f64, tangent: &[f64], lambda: &[f64]) -> Result<Vec<f64>> {
    let x = own.len();
    let mut row = try_vec(x + 1, 0.0, CONTEXT)?;
    let mut there = Residual::new(x)?;
    let mut matrix = try_vec(x * x, 0.0, CONTEXT)?;
    let mut active = try_vec(x, true, CONTEXT)?;
    let width = (norm(own) / norm(tangent)).min(1.0);
    for (step, weight) in central_differences(width) {
        let mut moved = try_copy(own, CONTEXT)?;
        for (y, t) in moved.iter_mut().zip(tangent) {
            *y += step * t;
        }
        problem.evaluate(&moved, log10 + step, &mut there)?;
        problem.fill(&mut matrix, &mut active)?;
        for (to, column) in row.iter_mut().zip(matrix.chunks_exact(x)) {
            *to -= weight * dot(column, lambda);
        }
        row[x] -= weight * dot(&there.d_parameter, lambda);
    }
    Ok(row)
}

impl Tracked for TrackedDamping<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        self
    }

    fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    fn unknowns_mut(&mut self) -> &mut Unknowns {
        &mut self.unknowns
    }

    fn equations(&mut self, u: &[f64], p: f64, fully: bool, values: &mut [f64]) -> Result<f64> {
        self.evaluate_equations(u, p, fully, values)
    }

    /// The damping ratio. At its maximum it changes with the parameter alone.
    fn result(&self, u: &[f64], direction: &[f64]) -> (f64, f64) {
        (self.last.damping, self.last.d_damping * direction[u.len()])
    }

    fn curvature(&self) -> Option<f64> {
        Some(self.last.curvature)
    }

    fn motions(&self) -> usize {
        self.unknowns.len() - 3
    }

    fn select(&mut self, _from: &HarmonicSet, to: &Resolution, highest: usize) -> Result<()> {
        let n = to.condensed.unknowns() + 3;
        self.solver.harmonics = highest;
        self.solver.samples = self.solver.samples.max(to.samples);
        self.unknowns.resize(n)
    }

    fn estimate(&mut self, point: &Point) -> Result<Option<(f64, Estimate)>> {
        let (u, p) = (point.unknowns(), point.parameter());
        let at = self.at(p)?;
        let (own, log10) = (self.own(u, &at.condensed)?, self.log10(u));
        let DampedFrequency { omega, damping } = Epmc::frequency_and_damping(&at.linear, &own);
        let (vibration, _) = self.motion(&own, log10, &at)?;
        let solved = Solved {
            condensed: &at.condensed,
            motion: &vibration,
            omega,
            response: Complex64::ZERO,
            watched: &[],
            together: false,
            sticks: Some(false),
            iterations: 0,
        };
        let start = (&at.linear, self.followed.gauge);
        let response = self.followed.response_dof;
        let (models, waves) = (ModelCache::for_estimates()?, SharedWaves::default());
        let mut estimator = ModeEstimator::new(
            (&at.model, &self.solver),
            DampingForm::Mass,
            start,
            response,
            (&models, &waves),
            self.interrupt,
        );
        let state = ModeState {
            log10_amplitude: log10,
            damping,
            damping_unit: damping.abs().max(NO_DAMPING),
        };
        let estimate = estimator.at(&solved, state)?;
        let error = (estimate.damping / damping).abs().max(estimate.frequency);
        Ok(Some((error, estimate)))
    }

    fn take_corrected(&self, corrected: &Corrected, set: &HarmonicSet, v: &mut [f64]) {
        let motions = self.motions();
        let unit = 10f64.powf(self.log10(&v[..motions + 3])) * self.length;
        set.transfer(&corrected.set, &corrected.motion, 1.0 / unit, &mut v[..motions]);
        let both = DampedFrequency::new(corrected.omega, corrected.damping);
        Epmc::set_frequency_and_damping(self.followed.linear, both, &mut v[..motions + 2]);
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
        self.evaluate_equations(u, p, true, &mut values)?;
        let At { condensed, linear, .. } = self.at(p)?;
        let (own, log10) = (self.own(u, &condensed)?, self.log10(u));
        let omega = Epmc::frequency_and_damping(&linear, &own).omega;
        let resolution = Resolution {
            condensed: Arc::new(condensed),
            samples: self.solver.samples,
        };
        let mut v = own;
        crate::error::try_push(&mut v, log10, CONTEXT)?;
        let at = Point {
            tangent: try_vec(v.len(), 0.0, CONTEXT)?,
            v,
            ..*point
        };
        let start = LinearStart {
            linear: &linear,
            gauge: self.followed.gauge,
            is_repeated: false,
            interrupt: self.interrupt,
        };
        let settings = Settings {
            start: log10,
            end: log10,
            tolerance: self.solver.tol_residual,
            max_iterations: self.solver.max_newton,
            steps: StepControl::new(self.solver.step, self.solver.step_min, self.solver.step_max),
        };
        let mut equations = Equations::new(&resolution, &start, &settings)?;
        equations.evaluate(&at, self.followed.response_dof)?;
        let mode = equations.measure(&at, &linear, &[]);
        let sampling_error = equations.problem.sampling_error(&equations.motion, omega)?;
        let record = Record {
            resolution: &resolution,
            omega,
            motion: &equations.motion,
            amplitude: equations.response[resolution.condensed.set().fundamental()],
            response: &equations.response,
            residual: point.residual,
            iterations: point.iterations,
            slip_fractions: equations.problem.forces().slip_fractions(),
            sampling_error,
            errors: (f64::NAN, error * self.last.damping.abs()),
            seen: &[],
        };
        branch.push_followed(kind, &record)?;
        if let Some(modes) = branch.mode_data_mut() {
            modes.push(mode)?;
        }
        data.push(p, f64::NAN, self.last.d_damping)?;
        let special = Special {
            point: branch.stored() - 1,
            omega,
            amplitude: self.last.damping,
        };
        Ok((special, sampling_error))
    }
}

impl Jacobian for TrackedDamping<'_> {
    fn size(&self) -> usize {
        self.unknowns.len()
    }

    fn fill(&mut self, matrix: &mut [f64], active: &mut [bool]) -> Result<()> {
        self.unknowns.fill(matrix, active);
        Ok(())
    }
}
