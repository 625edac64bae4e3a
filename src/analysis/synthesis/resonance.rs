//! The resonance between two points of a mode's branch, solved on the mode's equations.

use crate::analysis::synthesis::computed_peak::AtPeak;
use crate::analysis::synthesis::oscillator::{Load, State};
use crate::condense::Condensed;
use crate::condense::by_factors::dynamic_stiffness::DampedFrequency;
use crate::continuation::special_points::Locator;
use crate::continuation::step_control::StepControl;
use crate::continuation::{Point, Settings};
use crate::error::{Result, try_copy, try_vec};
use crate::harmonics::transfer::transferred;
use crate::interrupt::Interrupt;
use crate::linalg::inner;
use crate::linalg::newton::linear_system::Jacobian;
use crate::problem::epmc::Epmc;
use crate::problem::{Problem, Residual};
use crate::results::motions::energy::balance;
use crate::results::stored::mode_branch::{ModeData, ModePoint};
use crate::results::{Branch, Recovery};
use num_complex::Complex64;

const CONTEXT: &str = "the synthesised response";

/// Relative accuracy of the amplitude of a resonance.
/// Kind: rounding.
const RESONANCE_WIDTH: f64 = 1e-12;

/// Largest number of evaluations for one resonance.
/// Kind: cap.
const RESONANCE_MAX_EVALUATIONS: usize = 60;

/// Solves the mode between two points of its branch.
pub(crate) struct Refinement<'a> {
    branch: &'a Branch,
    data: &'a ModeData,
    load: &'a Load,
    interrupt: &'a Interrupt<'a>,
    solver: Solver<'a>,
    x: Vec<Complex64>,
    /// Packed total motion of the state solved last, in the units of its condensed model.
    motion: Vec<f64>,
}

/// The mode's equations with the harmonics of one stored point.
struct Solver<'a> {
    resolution: usize,
    condensed: &'a Condensed,
    samples: usize,
    problem: Epmc<'a>,
    locator: Locator,
    at: Residual,
}

impl<'a> Solver<'a> {
    fn new(branch: &'a Branch, data: &'a ModeData, point: usize, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        let condensed = branch.condensed_at(point);
        let problem = Epmc::new(
            condensed,
            &data.gauge,
            &data.linear,
            branch.samples_at(point),
            interrupt,
        )?;
        let n = problem.size();
        let settings = Settings {
            start: data.range.start,
            end: data.range.stop,
            tolerance: 1e-10,
            max_iterations: 25,
            steps: StepControl::new(0.0, 0.0, 0.0),
        };
        Ok(Self {
            resolution: branch.resolution_index(point),
            condensed,
            samples: branch.samples_at(point),
            at: Residual::new(n)?,
            locator: Locator::new(n, settings)?,
            problem,
        })
    }
}

impl<'a> Refinement<'a> {
    pub fn new(branch: &'a Branch, data: &'a ModeData, load: &'a Load, interrupt: &'a Interrupt<'a>) -> Result<Self> {
        Ok(Self {
            branch,
            data,
            load,
            interrupt,
            solver: Solver::new(branch, data, 0, interrupt)?,
            x: try_vec(branch.condensed_at(0).ndof(), Complex64::ZERO, CONTEXT)?,
            motion: Vec::new(),
        })
    }

    /// The state of zero excess force between points k and k + 1, whose excesses are given, by the Illinois variant
    /// of regula falsi in log₁₀ a.
    pub fn between(&mut self, k: usize, first: f64, last: f64) -> Result<Option<State>> {
        self.select_richer(k)?;
        let (Some(a), Some(b)) = (self.point(k)?, self.point(k + 1)?) else {
            return Ok(None);
        };
        let (mut low, mut high) = ((a.parameter(), first), (b.parameter(), last));
        let mut side = 0;
        let mut found = None;
        for _ in 0..RESONANCE_MAX_EVALUATIONS {
            let p = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let p = if p.is_finite() { p } else { 0.5 * (low.0 + high.0) };
            let Some(state) = self.solve(&a, &b, p)? else { break };
            let f = state.excess();
            found = Some(state);
            if f == 0.0 || (high.0 - low.0).abs() <= RESONANCE_WIDTH || f.abs() <= RESONANCE_WIDTH * state.work.norm() {
                break;
            }
            if (f < 0.0) == (low.1 < 0.0) {
                low = (p, f);
                if side == -1 {
                    high.1 *= 0.5;
                }
                side = -1;
            } else {
                high = (p, f);
                if side == 1 {
                    low.1 *= 0.5;
                }
                side = 1;
            }
        }
        Ok(found)
    }

    /// The state at the amplitude with log₁₀ a = p between points k and k + 1; `None` where the mode is not found at
    /// it.
    pub fn state_at(&mut self, k: usize, p: f64) -> Result<Option<State>> {
        self.select_richer(k)?;
        match (self.point(k)?, self.point(k + 1)?) {
            (Some(a), Some(b)) => self.solve(&a, &b, p),
            _ => Ok(None),
        }
    }

    /// The motion of all degrees of freedom in the state solved last, turned in phase.
    pub fn harmonics(&self, state: &State, turn: Complex64) -> Result<Vec<Complex64>> {
        let resolution = self.branch.numbered_resolution(self.solver.resolution);
        let solution = (&self.motion[..], state.omega, state.own_damping);
        let highest = self.solver.condensed.set().numbers().last().copied().unwrap_or(0);
        let mut x = Recovery::of(resolution, solution, self.interrupt)?.all(highest)?;
        let ndof = self.branch.ndof().max(1);
        let phase = turn.arg();
        for (h, row) in x.chunks_exact_mut(ndof).enumerate() {
            for x in row {
                *x *= Complex64::cis(h as f64 * phase);
            }
        }
        Ok(x)
    }

    /// Selects the equations with the harmonics of that point, k or k + 1, which has more.
    fn select_richer(&mut self, k: usize) -> Result<()> {
        let carried = |point: usize| self.branch.condensed_at(point).set().numbers().len();
        let richer = if carried(k) > carried(k + 1) { k } else { k + 1 };
        if self.branch.resolution_index(richer) != self.solver.resolution {
            self.solver = Solver::new(self.branch, self.data, richer, self.interrupt)?;
        }
        Ok(())
    }

    /// The state solved last, at the frequency `omega` of the force.
    pub fn at_peak<'s>(&'s self, state: &'s State, omega: f64) -> AtPeak<'s> {
        AtPeak {
            state,
            omega,
            condensed: self.solver.condensed,
            samples: self.solver.samples,
            motion: &self.motion,
            response_dof: self.branch.response_dof(),
        }
    }

    /// Point k of the curve as the continuation stored it, transferred to the current harmonics.
    fn point(&self, k: usize) -> Result<Option<Point>> {
        let Some((v, tangent)) = self.data.state(k) else {
            return Ok(None);
        };
        let to = self.solver.condensed;
        let from = self.branch.condensed_at(k);
        let transfer = |v: &[f64]| transferred(from, to, v, v.len() - from.unknowns(), 1.0);
        Ok(Some(Point {
            v: transfer(v)?,
            tangent: transfer(tangent)?,
            amplitude: Complex64::ZERO,
            slope: Complex64::ZERO,
            residual: 0.0,
            iterations: 0,
            step: 0.0,
            stalled: false,
            positive: true,
        }))
    }

    fn solve(&mut self, a: &Point, b: &Point, p: f64) -> Result<Option<State>> {
        let Solver {
            condensed,
            problem,
            locator,
            at,
            ..
        } = &mut self.solver;
        let n = problem.size();
        let mut v = try_copy(&a.v, CONTEXT)?;
        if p <= self.data.info.linear_up_to {
            v[n] = p;
        } else if let Some(point) = locator.at_parameter(problem, a, b, p, self.interrupt)? {
            v = point.v;
        } else {
            return Ok(None);
        }
        problem.evaluate(&v[..n], p, at)?;
        let rest = self.data.linear.rest.in_units(condensed.length())?;
        self.motion = try_copy(&v[..n - 2], CONTEXT)?;
        for y in &mut self.motion {
            *y *= 10f64.powf(p);
        }
        let packed = condensed.set().packed_len().max(1);
        for (y, rest) in self.motion.iter_mut().step_by(packed).zip(&rest.motion) {
            *y += rest;
        }
        let DampedFrequency {
            omega,
            damping: damping_ratio,
        } = Epmc::frequency_and_damping(&self.data.linear, &v[..n]);
        let unit = 10f64.powf(p) * condensed.length();
        let i = condensed.set().fundamental();
        let energy = balance(condensed, omega, problem.shape(), &[], &[]).twice_mean_kinetic;
        let shape = problem.fundamental();
        condensed.blocks()[i].multiply_mass(shape, &mut self.x);
        let size = inner(shape, &self.x).re;
        let point = ModePoint {
            log10_amplitude: p,
            modal_amplitude: unit * size.sqrt(),
            damping_ratio,
            fundamental_share: 0.5 * omega * omega * size / energy,
            ..ModePoint::default()
        };
        for (to, from) in self.x.iter_mut().zip(shape) {
            *to = from * unit;
        }
        Ok(Some(self.load.state(omega, &point, &self.x)))
    }
}
