//! A stable motion and a saddle at one phase of the forces, and the side of the saddle on which the stable motion is after a kick.

use crate::error::{Result, Status, fail, try_copy, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::TimeOptions;
use crate::time_integration::{EventLoop, Observers, Search, Sensitivity, State, System, state_of};
use num_complex::Complex64;

const CONTEXT: &str = "the smallest kick";

/// Distance of two motions, relative to their size, up to which they are one.
const KICKED_SAME: f64 = 1e-6;

/// Accuracy of shooting and of the last check, and of the many integrations before it where a law is smooth.
const TIGHT: f64 = 1e-11;
const KICKED_LOOSE: f64 = 1e-7;

/// Distances over that of the two motions: within it of the lower motion a kick has returned; beyond it, and settled, it has not.
const RETURNED: f64 = 0.05;
const ELSEWHERE: f64 = 0.5;

/// Change over a period, over the same distance, of a motion that has settled, and its distance from the saddle, near which all is slow.
const SETTLED: f64 = 1e-4;
const AWAY: f64 = 0.1;

/// Periods after which a motion that has not returned counts as one that does not.
const KICKED_MOST_PERIODS: usize = 3_000;

/// Iterations for the left eigenvector, and its change that ends them.
const KICKED_ITERATIONS: usize = 20_000;
const KICKED_CHANGE: f64 = 1e-10;

/// End of a kicked motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// It comes back.
    Returns,
    /// It does not.
    Across,
}

/// The two motions at one phase.
pub(super) struct Kicked<'a> {
    system: System<'a>,
    event_loop: EventLoop,
    lower: State,
    saddle: State,
    /// Distance of the two.
    gap: f64,
    /// Velocities by a unit impulse, and that of the degree of freedom itself.
    kick: Vec<f64>,
    mobility: f64,
    estimate: f64,
    multiplier: f64,
}

impl<'a> Kicked<'a> {
    /// The motions with the harmonics of the two points, when the forces have a phase.
    pub fn new(
        (model, omega, dof): (&Model, f64, usize),
        (lower, between): (&[Complex64], &[Complex64]),
        phase: f64,
        hooks: &mut Hooks<'_>,
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let mut system = System::new(model, omega, interrupt)?;
        for load in &mut system.loads {
            load.value *= Complex64::cis(load.harmonic as f64 * phase);
        }
        let mut event_loop = EventLoop::new(&system, TIGHT)?;
        let given = model.ndof();
        let mut shoot = |harmonics: &[Complex64], name: &str| -> Result<State> {
            let mut turned = try_copy(harmonics, CONTEXT)?;
            for (h, row) in turned.chunks_exact_mut(given).enumerate() {
                for x in row {
                    *x *= Complex64::cis(h as f64 * phase);
                }
            }
            let start = state_of(model, &system, &turned)?;
            let options = TimeOptions {
                omega,
                tolerance: TIGHT,
                ..TimeOptions::default()
            };
            let Some(steady) = Search::new(&mut system, &mut event_loop, &options, hooks, start)?.closest()? else {
                return fail!(
                    NoConvergence,
                    "shooting did not converge from the {name}: it has too few harmonics"
                );
            };
            if steady.status == Status::StoppedByCaller {
                return fail!(StoppedByCaller, "the caller stopped the shooting");
            }
            Ok(steady.state)
        };
        let (lower, saddle) = (shoot(lower, "point")?, shoot(between, "saddle")?);
        let mut force = try_vec(given, Complex64::ZERO, CONTEXT)?;
        force[dof] = Complex64::ONE;
        let mut kick = impulse(model, &force, system.order())?;
        system.accelerate(&mut kick)?;
        let mut moved = try_vec(given, Complex64::ZERO, CONTEXT)?;
        let mut complex = try_vec(system.order(), Complex64::ZERO, CONTEXT)?;
        for (z, v) in complex.iter_mut().zip(&kick) {
            *z = (*v).into();
        }
        system.degrees.expand(Complex64::ONE, &complex, &mut moved);
        let (w, multiplier) = left_eigenvector(&mut system, &mut event_loop, &saddle)?;
        let n = system.order();
        let mut away = lower.try_clone()?;
        away.add(-1.0, &saddle);
        let across: f64 = w
            .iter()
            .zip(away.x.iter().chain(&away.v).chain(&away.e))
            .map(|(w, z)| w * z)
            .sum();
        let along: f64 = w[n..2 * n].iter().zip(&kick).map(|(w, v)| w * v).sum();
        let gap = distance(&lower, &saddle, omega);
        let size = distance(&saddle, &State::rest(&system)?, omega);
        if gap.is_nan() || gap <= KICKED_SAME * size {
            return fail!(Argument, "point and saddle are one motion");
        }
        Ok(Self {
            event_loop: EventLoop::new(&system, KICKED_LOOSE)?,
            system,
            lower,
            saddle,
            gap,
            mobility: moved[dof].re,
            kick,
            estimate: -across / along,
            multiplier,
        })
    }

    /// The same with the tolerance of shooting.
    pub fn tight(mut self) -> Result<Self> {
        self.event_loop = EventLoop::new(&self.system, TIGHT)?;
        Ok(self)
    }

    /// Impulse that leads to the stable surface of the saddle to first order.
    pub fn estimate(&self) -> f64 {
        self.estimate
    }

    /// Multiplier of the saddle in its unstable direction.
    pub fn multiplier(&self) -> f64 {
        self.multiplier
    }

    /// Velocity of the degree of freedom by a unit impulse.
    pub fn mobility(&self) -> f64 {
        self.mobility
    }

    /// Integrates the lower motion after an impulse until it has come back or settled elsewhere.
    pub fn side(&mut self, impulse: f64) -> Result<Side> {
        let omega = self.system.omega;
        let mut state = self.lower.try_clone()?;
        for (v, kick) in state.v.iter_mut().zip(&self.kick) {
            *v += impulse * kick;
        }
        for _ in 0..KICKED_MOST_PERIODS {
            let before = state.try_clone()?;
            self.event_loop
                .run(&mut self.system, &mut state, Observers::default())?;
            let away = distance(&state, &self.lower, omega) / self.gap;
            if away.is_nan() {
                return fail!(NoBoundedSolution, "the motion after a kick grows beyond all bounds");
            }
            if away < RETURNED {
                return Ok(Side::Returns);
            }
            let change = distance(&state, &before, omega) / self.gap;
            let from_saddle = distance(&state, &self.saddle, omega) / self.gap;
            if change < SETTLED && away > ELSEWHERE && from_saddle > AWAY {
                return Ok(Side::Across);
            }
        }
        Ok(Side::Across)
    }
}

/// The impulse on the independent degrees of freedom: the virtual work of one at the caller's.
fn impulse(model: &Model, force: &[Complex64], order: usize) -> Result<Vec<f64>> {
    let degrees = model.structure().degrees();
    let mut found = try_vec(order, 0.0, CONTEXT)?;
    for (dof, f) in force.iter().enumerate().filter(|(_, f)| **f != Complex64::ZERO) {
        for (independent, weight) in degrees.image(dof).1 {
            found[independent] += weight * f.re;
        }
    }
    Ok(found)
}

/// Distance of two states, velocities in the unit of displacements.
fn distance(a: &State, b: &State, omega: f64) -> f64 {
    let square =
        |a: &[f64], b: &[f64], unit: f64| -> f64 { a.iter().zip(b).map(|(a, b)| ((a - b) * unit).powi(2)).sum() };
    (square(&a.x, &b.x, 1.0) + square(&a.v, &b.v, 1.0 / omega)).sqrt()
}

/// The left eigenvector of the largest multiplier of a motion, by powers, and this multiplier.
fn left_eigenvector(system: &mut System<'_>, event_loop: &mut EventLoop, motion: &State) -> Result<(Vec<f64>, f64)> {
    let mut sensitivity = Sensitivity::new(system)?;
    let mut state = motion.try_clone()?;
    let observers = Observers {
        variation: Some(sensitivity.begin()),
        ..Observers::default()
    };
    event_loop.run(system, &mut state, observers)?;
    let (n, m) = (system.order(), state.len());
    // Velocities times 1/ω have the unit of displacements.
    let unit = |i: usize| if (n..2 * n).contains(&i) { system.omega } else { 1.0 };
    let mut w = try_vec(m, 1.0, CONTEXT)?;
    let mut next = try_vec(m, 0.0, CONTEXT)?;
    let (mut multiplier, mut change) = (f64::NAN, f64::INFINITY);
    for _ in 0..KICKED_ITERATIONS {
        system.interrupt.check_before((m * m) as u64)?;
        for (j, next) in next.iter_mut().enumerate() {
            *next = (0..m)
                .map(|i| w[i] * sensitivity.by_initial(j, i) * unit(j) / unit(i))
                .sum();
        }
        multiplier = w.iter().zip(&next).map(|(a, b)| a * b).sum::<f64>() / w.iter().map(|a| a * a).sum::<f64>();
        let size = next.iter().map(|x| x * x).sum::<f64>().sqrt() * multiplier.signum();
        if size.is_nan() || size == 0.0 {
            break;
        }
        change = 0.0;
        for (w, next) in w.iter_mut().zip(&next) {
            change = f64::max(change, (next / size - *w).abs());
            *w = next / size;
        }
        if change < KICKED_CHANGE {
            break;
        }
    }
    if !(multiplier.abs() > 1.0 && change < KICKED_CHANGE) {
        return fail!(
            Argument,
            "saddle: the largest multiplier is {multiplier:.6}, needs a point with one unstable direction, a real multiplier beyond 1"
        );
    }
    for (i, w) in w.iter_mut().enumerate() {
        *w /= unit(i);
    }
    Ok((w, multiplier))
}
