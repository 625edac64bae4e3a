//! The resonance between two points of a mode's branch, solved on the mode's equations.

use super::oscillator::{Load, State};
use crate::branch::Branch;
use crate::branch::mode::{ModeData, ModePoint};
use crate::continuation::events::Locator;
use crate::continuation::step_control::StepControl;
use crate::continuation::{Point, Settings};
use crate::error::{Result, try_copy, try_vec};
use crate::linalg::inner;
use crate::postprocess::energy::balance;
use crate::problem::mode::Mode;
use crate::problem::{Linearisation, Problem};
use num_complex::Complex64;

const WHAT: &str = "the synthesised response";

/// Relative accuracy of the amplitude of a resonance.
const WIDTH: f64 = 1e-12;

/// Most evaluations for one resonance.
const MAX_EVALUATIONS: usize = 60;

/// Solves the mode between two points of its branch.
pub(super) struct Refinement<'a> {
    branch: &'a Branch,
    data: &'a ModeData,
    load: &'a Load,
    problem: Mode<'a>,
    locator: Locator,
    at: Linearisation,
    x: Vec<Complex64>,
}

impl<'a> Refinement<'a> {
    pub fn new(branch: &'a Branch, data: &'a ModeData, load: &'a Load) -> Result<Self> {
        let problem = Mode::new(branch.condensed(), &data.gauge, &data.linear, branch.samples())?;
        let n = problem.size();
        let settings = Settings {
            start: data.range.0,
            end: data.range.1,
            tolerance: 1e-10,
            max_iterations: 25,
            steps: StepControl::new(0.0, 0.0, 0.0),
        };
        Ok(Self {
            branch,
            data,
            load,
            at: Linearisation::new(n)?,
            locator: Locator::new(n, settings)?,
            x: try_vec(branch.ndof(), Complex64::ZERO, WHAT)?,
            problem,
        })
    }

    /// The state without excess between points k and k + 1, whose excesses are given, by the
    /// Illinois variant of regula falsi in log₁₀ a.
    pub fn between(&mut self, k: usize, first: f64, last: f64) -> Result<Option<State>> {
        let (Some(a), Some(b)) = (self.point(k)?, self.point(k + 1)?) else {
            return Ok(None);
        };
        let (mut low, mut high) = ((a.parameter(), first), (b.parameter(), last));
        let mut side = 0;
        let mut found = None;
        for _ in 0..MAX_EVALUATIONS {
            let p = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let p = if p.is_finite() { p } else { 0.5 * (low.0 + high.0) };
            let Some(state) = self.solve(&a, &b, p)? else { break };
            let f = state.excess();
            found = Some(state);
            if f == 0.0 || (high.0 - low.0).abs() <= WIDTH || f.abs() <= WIDTH * state.work.norm() {
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

    /// A point of the curve as the continuation left it.
    fn point(&self, k: usize) -> Result<Option<Point>> {
        let Some((v, tangent)) = self.data.state(k) else {
            return Ok(None);
        };
        Ok(Some(Point {
            v: try_copy(v, WHAT)?,
            tangent: try_copy(tangent, WHAT)?,
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
        let n = self.problem.size();
        let mut v = try_copy(&a.v, WHAT)?;
        if p <= self.data.info.linear_up_to {
            v[n] = p;
        } else if let Some(point) = self.locator.at_parameter(&mut self.problem, a, b, p)? {
            v = point.v;
        } else {
            return Ok(None);
        }
        self.problem.evaluate(&v[..n], p, &mut self.at)?;
        let (omega, damping_ratio) = Mode::frequency_and_damping(&self.data.linear, &v[..n]);
        let unit = 10f64.powf(p) * self.branch.condensed().length();
        let dofs = self.branch.ndof();
        let i = self.branch.condensed().set().fundamental();
        let shape = &self.problem.shape()[i * dofs..(i + 1) * dofs];
        self.branch.condensed().blocks()[i].multiply_mass(shape, &mut self.x);
        let size = inner(shape, &self.x).re;
        let energy = balance(self.branch.condensed(), omega, self.problem.shape(), &[], &[]).twice_mean_kinetic;
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
