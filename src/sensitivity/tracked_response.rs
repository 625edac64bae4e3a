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
use crate::linalg::dot;
use crate::linalg::newton::linear_system::Jacobian;
use crate::model::Model;
use crate::options::Range;
use crate::options::{Response, SolverOptions};
use crate::problem::Problem;
use crate::problem::epmc::OMEGA_UNIT;
use crate::problem::gauges::Gauges;
use crate::results::{Branch, ParameterData, Record, Special, SpecialKind};
use crate::sensitivity::adjoint::CONTEXT;
use crate::sensitivity::design::design;
use crate::sensitivity::fold_point::Borders;
use crate::sensitivity::forced_point::ForcedPoint;
use crate::sensitivity::parameter::Parameter;
use crate::sensitivity::tracked::{FirstMotion, Tracked, Unknowns};
use num_complex::Complex64;
use std::sync::Arc;

mod tracked_conditions;

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

/// The followed point of a response, and the parameter over which it is followed.
#[derive(Clone, Copy)]
pub(crate) struct FollowedPoint<'a> {
    pub model: &'a Model,
    pub parameter: Parameter<'a>,
    pub response_dof: usize,
    /// The response that is followed in place of the amplitude; `None`: the amplitude.
    pub response: Option<Response<'a>>,
    pub kind: ResponsePoint,
}

/// The followed point of a forced response over a parameter, as a problem.
pub(crate) struct TrackedResponse<'a> {
    followed: FollowedPoint<'a>,
    solver: SolverOptions,
    /// The fixed frequency, or the frequency of the first peak or fold.
    omega: f64,
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
    /// The followed point over `range`, from a solution at its start.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(
        followed: FollowedPoint<'a>,
        solver: &SolverOptions,
        range: Range,
        start: &FirstMotion<'_>,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let &FirstMotion { motion, length, omega } = start;
        let n = motion.len() + usize::from(followed.kind != ResponsePoint::Fixed);
        let mut start = try_vec(n, 0.0, CONTEXT)?;
        start[..motion.len()].copy_from_slice(motion);
        // The unknown of the frequency is 1 at the first one: unknowns of size 0 have no unit.
        start[motion.len()..].fill(1.0);
        Ok(Self {
            followed,
            solver: *solver,
            omega,
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
        self.followed.kind != ResponsePoint::Fixed
    }

    fn frequency(&self, u: &[f64]) -> f64 {
        if self.is_free() {
            self.omega * (OMEGA_UNIT * (u[u.len() - 1] - 1.0)).exp()
        } else {
            self.omega
        }
    }

    fn at(&self, p: f64, omega: f64) -> Result<At> {
        let model = design(
            self.followed.model,
            core::slice::from_ref(&self.followed.parameter),
            &[p],
        )?;
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
        let point = ForcedPoint::new(condensed, self.followed.response_dof, samples, omega, self.interrupt)?;
        match self.followed.response {
            Some(response) => point.watching(&response, self.followed.response_dof, samples),
            None => Ok(point),
        }
    }

    /// Values of the followed response at a solution, as an estimate watches them, in the caller's unit.
    fn watched(&self, condensed: &Condensed, own: &[f64], omega: f64) -> Result<Vec<Complex64>> {
        let mut seen = Vec::new();
        let mut values = Vec::new();
        if let Some(response) = &self.followed.response {
            let mut v = try_copy(own, CONTEXT)?;
            try_push(&mut v, omega, CONTEXT)?;
            let none = try_vec(v.len(), 0.0, CONTEXT)?;
            let responses = (core::slice::from_ref(response), self.followed.response_dof);
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
}

impl Tracked for TrackedResponse<'_> {
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

    /// The amplitude; its derivative is taken along the curve of solutions.
    fn result(&self, u: &[f64], direction: &[f64]) -> (f64, f64) {
        let mut change = dot(&self.last.gradient[..u.len()], &direction[..u.len()]);
        change += self.last.gradient[u.len()] * direction[u.len()];
        (self.last.amplitude, change)
    }

    fn curvature(&self) -> Option<f64> {
        (self.followed.kind == ResponsePoint::Peak).then_some(self.last.curvature)
    }

    fn motions(&self) -> usize {
        self.unknowns.len() - usize::from(self.is_free())
    }

    fn select(&mut self, from: &HarmonicSet, to: &Resolution, highest: usize) -> Result<()> {
        let motions = to.condensed.unknowns();
        let n = motions + usize::from(self.is_free());
        if let Some(borders) = &mut self.borders {
            let to = to.condensed.set();
            if self.followed.kind == ResponsePoint::Extremum {
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
        if matches!(self.followed.kind, ResponsePoint::Fold | ResponsePoint::Extremum) {
            return Ok(None);
        }
        let (u, p) = (point.unknowns(), point.parameter());
        let omega = self.frequency(u);
        let At { model, condensed } = self.at(p, omega)?;
        let own = self.own_motion(u, &condensed)?;
        let mut at = ForcedPoint::new(
            &condensed,
            self.followed.response_dof,
            self.solver.samples,
            omega,
            self.interrupt,
        )?;
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
        let estimator = ForcedEstimator::new(&model, &self.solver, self.followed.response_dof, models, self.interrupt);
        let mut estimator = estimator.watching(self.followed.response.as_slice());
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
        self.evaluate_equations(u, p, true, &mut values)?;
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
        data.push(p, self.last.d_amplitude, f64::NAN)?;
        let special = Special {
            point: branch.stored() - 1,
            omega,
            amplitude: self.last.amplitude,
        };
        Ok((special, sampling_error))
    }
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
