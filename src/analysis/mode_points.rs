//! The points of a nonlinear mode: what is measured and stored of each.

use super::follow::{Ending, Keeper};
use crate::branch::mode::ModePoint;
use crate::branch::{Branch, Record, SpecialKind};
use crate::condense::Condensed;
use crate::continuation::Point;
use crate::error::{Result, try_copy, try_push, try_vec};
use crate::error_estimate::Solved;
use crate::error_estimate::mode::ModeEstimator;
use crate::linalg::{inner, norm};
use crate::postprocess::energy::{self, Balance};
use crate::problem::mode::{LinearMode, Mode};
use crate::problem::{Linearisation, Problem};
use num_complex::Complex64;

const WHAT: &str = "the nonlinear mode";

/// Collects the points of one run.
pub(super) struct ModePoints<'a> {
    condensed: &'a Condensed,
    linear: &'a LinearMode,
    branch: Branch,
    problem: Mode<'a>,
    at: Linearisation,
    specials: Vec<Kept>,
    estimator: Option<ModeEstimator<'a>>,
    motion: Vec<f64>,
    forces: Vec<f64>,
    response: Vec<Complex64>,
    /// Fundamental of the point of the curve before.
    before: Vec<Complex64>,
    weighted: Vec<Complex64>,
    stalled: bool,
}

/// A special point until the curve is complete.
struct Kept {
    kind: SpecialKind,
    point: Point,
    motion: Vec<f64>,
    response: Vec<Complex64>,
    slip_fractions: Vec<f64>,
    numbers: Numbers,
    mode: ModePoint,
}

/// Beside the motion: amplitude, sampling error and error estimates.
type Numbers = (Complex64, f64, (f64, f64));

impl<'a> ModePoints<'a> {
    /// An empty collection.
    pub fn new(
        condensed: &'a Condensed,
        linear: &'a LinearMode,
        problem: Mode<'a>,
        branch: Branch,
        estimator: Option<ModeEstimator<'a>>,
    ) -> Result<Self> {
        let unknowns = problem.size();
        let carried = condensed.blocks().len();
        Ok(Self {
            at: Linearisation::new(unknowns)?,
            specials: Vec::new(),
            estimator,
            motion: try_vec(unknowns - 2, 0.0, WHAT)?,
            forces: try_vec(unknowns - 2, 0.0, WHAT)?,
            response: try_vec(carried, Complex64::ZERO, WHAT)?,
            before: Vec::new(),
            weighted: try_vec(condensed.ndof(), Complex64::ZERO, WHAT)?,
            stalled: false,
            condensed,
            linear,
            branch,
            problem,
        })
    }

    /// The linear mode as a point of the branch.
    pub fn linear_point(&mut self, p: f64) -> Result<Point> {
        let n = self.problem.size();
        let mut v = try_vec(n + 1, 0.0, WHAT)?;
        self.problem.linear_start(&mut v[..n]);
        v[n] = p;
        let mut tangent = try_vec(n + 1, 0.0, WHAT)?;
        tangent[n] = 1.0;
        self.problem.evaluate(&v[..n], p, &mut self.at)?;
        let (amplitude, slope) = self.problem.observe(&v[..n], &tangent);
        Ok(Point {
            v,
            tangent,
            amplitude,
            slope,
            residual: norm(&self.at.residual) / self.at.scale,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        })
    }

    /// Evaluates the problem at a point, and what is stored of it.
    fn measure(&mut self, point: &Point) -> Result<ModePoint> {
        let n = point.unknowns().len();
        let (u, p) = (point.unknowns(), point.parameter());
        self.problem.evaluate(u, p, &mut self.at)?;
        let (omega, damping_ratio) = Mode::frequency_and_damping(self.linear, u);
        let a = 10f64.powf(p);
        for (m, u) in self.motion.iter_mut().zip(u) {
            *m = a * u;
        }
        let dofs = self.condensed.ndof();
        let dof = self.branch.response_dof();
        let x = self.problem.shape();
        for (r, x) in self.response.iter_mut().zip(x.chunks_exact(dofs)) {
            *r = a * x[dof];
        }
        self.forces.copy_from_slice(self.problem.forces().forces());
        let unit = a * self.condensed.length();
        let balance: Balance = energy::balance(self.condensed, omega, x, &self.forces, &u[..n - 2]);
        let i = self.condensed.set().fundamental();
        let first = &x[i * dofs..(i + 1) * dofs];
        self.condensed.blocks()[i].multiply_mass(first, &mut self.weighted);
        let size = inner(first, &self.weighted).re;
        let assurance = if self.before.is_empty() {
            1.0
        } else {
            let overlap = inner(&self.before, &self.weighted).norm_sqr();
            self.condensed.blocks()[i].multiply_mass(&self.before, &mut self.weighted);
            overlap / (size * inner(&self.before, &self.weighted).re)
        };
        Ok(ModePoint {
            log10_amplitude: p,
            modal_amplitude: unit * size.sqrt(),
            damping_ratio,
            energy: balance.twice_mean_kinetic * unit * unit,
            fundamental_share: 0.5 * omega * omega * size / balance.twice_mean_kinetic,
            friction_loss: balance.friction_loss * unit * unit,
            structural_loss: balance.structural_loss * unit * unit,
            assurance,
        })
    }

    /// Fundamental of the response and the errors of the point measured last.
    fn numbers(&mut self, point: &Point, mode: &ModePoint) -> Result<Numbers> {
        let omega = Mode::frequency_and_damping(self.linear, point.unknowns()).0;
        let amplitude = self.response[self.condensed.set().fundamental()];
        let sampling_error = self.problem.sampling_error(&self.motion, omega)?;
        let Some(estimator) = &mut self.estimator else {
            return Ok((amplitude, sampling_error, (f64::NAN, f64::NAN)));
        };
        let solved = Solved {
            condensed: self.condensed,
            motion: &self.motion,
            omega,
            response: amplitude * self.condensed.length(),
        };
        let errors = estimator.at(&solved, mode.log10_amplitude, mode.damping_ratio)?;
        Ok((amplitude, sampling_error, (errors.frequency, errors.damping)))
    }

    /// Numbers the special points after the curve.
    pub fn finish(mut self, ending: &Ending) -> Result<Branch> {
        for kept in &self.specials {
            let record = record(
                self.linear,
                &kept.point,
                &kept.motion,
                &kept.response,
                &kept.slip_fractions,
                kept.numbers,
            );
            self.branch.push_special(kept.kind, &record)?;
            if let Some(data) = self.branch.mode_data_mut() {
                data.push(kept.mode)?;
            }
        }
        self.branch.set_ending(ending.status, ending.reason, self.stalled);
        Ok(self.branch)
    }
}

impl Keeper for ModePoints<'_> {
    fn problem(&mut self) -> &mut dyn Problem {
        &mut self.problem
    }

    fn branch(&self) -> &Branch {
        &self.branch
    }

    fn keep(&mut self, point: &Point) -> Result<()> {
        let mode = self.measure(point)?;
        // All that may fail comes before anything is kept.
        let numbers = self.numbers(point, &mode)?;
        self.stalled |= point.stalled;
        if let Some(data) = self.branch.mode_data_mut() {
            data.push_state(&point.v, &point.tangent)?;
            data.push(mode)?;
        }
        let slip = self.problem.forces().slip_fractions();
        let i = self.condensed.set().fundamental();
        let record = record(self.linear, point, &self.motion, &self.response, slip, numbers);
        self.branch.push_curve(&record)?;
        let dofs = self.condensed.ndof();
        self.before = try_copy(&self.problem.shape()[i * dofs..(i + 1) * dofs], WHAT)?;
        Ok(())
    }

    fn keep_special(&mut self, kind: SpecialKind, point: Point) -> Result<()> {
        let mode = self.measure(&point)?;
        let kept = Kept {
            numbers: self.numbers(&point, &mode)?,
            kind,
            motion: try_copy(&self.motion, "the special points")?,
            response: try_copy(&self.response, "the special points")?,
            slip_fractions: try_copy(self.problem.forces().slip_fractions(), "the special points")?,
            mode,
            point,
        };
        try_push(&mut self.specials, kept, "the special points")
    }
}

fn record<'a>(
    linear: &LinearMode,
    point: &'a Point,
    motion: &'a [f64],
    response: &'a [Complex64],
    slip_fractions: &'a [f64],
    (amplitude, sampling_error, errors): Numbers,
) -> Record<'a> {
    Record {
        omega: Mode::frequency_and_damping(linear, point.unknowns()).0,
        motion,
        amplitude,
        response,
        residual: point.residual,
        iterations: point.iterations,
        slip_fractions,
        sampling_error,
        errors,
    }
}
