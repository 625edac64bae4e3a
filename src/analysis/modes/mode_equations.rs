//! The equations of a nonlinear mode at one resolution, and the measured quantities of a point.

use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::continuation::corrector::Corrector;
use crate::continuation::{Point, Settings};
use crate::error::{Result, try_vec};
use crate::interrupt::Interrupt;
use crate::linalg::newton::linear_system::Jacobian;
use crate::linalg::{inner, norm};
use crate::problem::epmc::{Epmc, Gauge, LinearMode};
use crate::problem::static_state::StaticState;
use crate::problem::{Problem, Residual};
use crate::results::Resolution;
use crate::results::motions::energy::{self, Balance};
use crate::results::stored::mode_branch::ModePoint;
use num_complex::Complex64;

const CONTEXT: &str = "the nonlinear mode";

/// The linear mode from which a nonlinear one starts, with its normalisation.
#[derive(Clone, Copy)]
pub(crate) struct LinearStart<'a> {
    pub linear: &'a LinearMode,
    pub gauge: &'a Gauge,
    /// Whether several linear modes share its frequency.
    pub is_repeated: bool,
    pub interrupt: &'a Interrupt<'a>,
}

/// The equations of a nonlinear mode at one resolution.
pub(crate) struct Equations<'a> {
    pub resolution: &'a Resolution,
    pub problem: Epmc<'a>,
    pub corrector: Corrector,
    at: Residual,
    /// Packed relative motions of the point evaluated last: about the static state, and in total.
    pub vibration: Vec<f64>,
    pub motion: Vec<f64>,
    /// The static state in the units of the solver.
    rest: StaticState,
    forces: Vec<f64>,
    /// Response degree of freedom at the point evaluated last, by carried harmonics.
    pub response: Vec<Complex64>,
    weighted: Vec<Complex64>,
}

impl<'a> Equations<'a> {
    /// Equations at a resolution, with their memory.
    pub fn new(resolution: &'a Resolution, start: &LinearStart<'a>, settings: &Settings) -> Result<Self> {
        let condensed = &*resolution.condensed;
        let mut problem = Epmc::new(
            condensed,
            start.gauge,
            start.linear,
            resolution.samples,
            start.interrupt,
        )?;
        problem.set_repeated(start.is_repeated);
        let unknowns = problem.size();
        Ok(Self {
            corrector: Corrector::new(unknowns, settings.tolerance, settings.max_iterations)?,
            at: Residual::new(unknowns)?,
            vibration: try_vec(unknowns - 2, 0.0, CONTEXT)?,
            motion: try_vec(unknowns - 2, 0.0, CONTEXT)?,
            rest: start.linear.rest.in_units(condensed.length())?,
            forces: try_vec(unknowns - 2, 0.0, CONTEXT)?,
            weighted: try_vec(condensed.ndof(), Complex64::ZERO, CONTEXT)?,
            response: try_vec(condensed.blocks().len(), Complex64::ZERO, CONTEXT)?,
            problem,
            resolution,
        })
    }

    /// The linear mode as a point of the branch.
    pub fn linear_point(&mut self, p: f64) -> Result<Point> {
        let Self { problem, at, .. } = self;
        let n = problem.size();
        let mut v = try_vec(n + 1, 0.0, CONTEXT)?;
        problem.linear_start(&mut v[..n]);
        v[n] = p;
        let mut tangent = try_vec(n + 1, 0.0, CONTEXT)?;
        tangent[n] = 1.0;
        problem.evaluate(&v[..n], p, at)?;
        let (amplitude, slope) = problem.observe(&v[..n], &tangent);
        Ok(Point {
            v,
            tangent,
            amplitude,
            slope,
            residual: norm(&at.values) / at.scale,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        })
    }

    /// Evaluates the problem at a point, and the response of the degree of freedom `dof`.
    pub fn evaluate(&mut self, point: &Point, dof: usize) -> Result<()> {
        let (u, p) = (point.unknowns(), point.parameter());
        self.problem.evaluate(u, p, &mut self.at)?;
        let a = 10f64.powf(p);
        for (m, u) in self.vibration.iter_mut().zip(u) {
            *m = a * u;
        }
        self.motion.copy_from_slice(&self.vibration);
        let packed = self.resolution.condensed.set().packed_len();
        for (m, rest) in self.motion.iter_mut().step_by(packed).zip(&self.rest.motion) {
            *m += rest;
        }
        let condensed = &self.resolution.condensed;
        let harmonics = self.problem.shape().chunks_exact(condensed.ndof());
        for (i, (r, x)) in self.response.iter_mut().zip(harmonics).enumerate() {
            let row = condensed.motion_row(i, dof)?;
            *r = a * row.along(x);
            if condensed.blocks()[i].number == 0 && self.rest.is_loaded() {
                *r += row.terms().map(|&(p, a)| a * self.rest.structure[p]).sum::<Complex64>();
            }
        }
        Ok(())
    }

    /// Fundamental of all degrees of freedom per unit of amplitude at the point evaluated last.
    pub fn fundamental(&self) -> &[Complex64] {
        self.problem.fundamental()
    }

    /// Numbers of the mode at the point evaluated last; `before` is the fundamental of the previous point, empty if
    /// there is none.
    pub fn measure(&mut self, point: &Point, linear: &LinearMode, before: &[Complex64]) -> ModePoint {
        let condensed = &*self.resolution.condensed;
        let n = point.unknowns().len();
        let (u, p) = (point.unknowns(), point.parameter());
        let DampedFrequency {
            omega,
            damping: damping_ratio,
        } = Epmc::frequency_and_damping(linear, u);
        let dofs = condensed.ndof();
        self.forces.copy_from_slice(self.problem.forces().forces());
        let x = self.problem.shape();
        let unit = 10f64.powf(p) * condensed.length();
        let balance: Balance = energy::balance(condensed, omega, x, &self.forces, &u[..n - 2]);
        let i = condensed.set().fundamental();
        let first = &x[i * dofs..(i + 1) * dofs];
        condensed.blocks()[i].multiply_mass(first, &mut self.weighted);
        let size = inner(first, &self.weighted).re;
        let assurance = if before.is_empty() {
            1.0
        } else {
            let overlap = inner(before, &self.weighted).norm_sqr();
            condensed.blocks()[i].multiply_mass(before, &mut self.weighted);
            overlap / (size * inner(before, &self.weighted).re)
        };
        ModePoint {
            log10_amplitude: p,
            modal_amplitude: unit * size.sqrt(),
            damping_ratio,
            energy: balance.twice_mean_kinetic * unit * unit,
            fundamental_share: 0.5 * omega * omega * size / balance.twice_mean_kinetic,
            friction_loss: balance.friction_loss * unit * unit,
            structural_loss: balance.structural_loss * unit * unit,
            assurance,
        }
    }
}
