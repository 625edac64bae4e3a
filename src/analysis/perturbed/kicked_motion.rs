//! A stable motion and a saddle at one phase of the forces, and the side of the saddle on which the stable motion is after a kick.

use crate::continuation::ONE_SOLUTION;
use crate::error::{Result, Status, fail, try_copy, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::TimeOptions;
use crate::time_integration::{EventLoop, Observers, Sensitivity, State, SteadySearch, System, state_of};
use num_complex::Complex64;

const CONTEXT: &str = "the smallest kick";

/// Accuracy of shooting and of the last check, and of the many integrations before it where a law is smooth.
/// Kind: rounding.
const TIGHT: f64 = 1e-11;
/// Accuracy of the many integrations before the last check, where a law is smooth.
/// Kind: tuned; measured on: not recorded.
const KICKED_LOOSE: f64 = 1e-7;

/// Distances over that of the two motions: within it of the lower motion a kick has returned; beyond it, and settled, it has not.
/// Kind: tuned; measured on: not recorded.
const RETURNED: f64 = 0.05;
const ELSEWHERE: f64 = 0.5;

/// Change over a period, over the same distance, of a motion that has settled, and its distance from the saddle, near which all is slow.
/// Kind: tuned; measured on: not recorded.
const SETTLED: f64 = 1e-4;
const AWAY: f64 = 0.1;

/// Periods after which a motion that has not returned counts as one that does not.
/// Kind: cap.
const KICKED_MOST_PERIODS: usize = 3_000;

/// Iterations for the left eigenvector, and its change that ends them.
/// Kind: cap.
const KICKED_ITERATIONS: usize = 20_000;
/// Change of the left eigenvector that ends its iterations.
/// Kind: rounding.
const KICKED_CHANGE: f64 = 1e-10;

/// Lapses over which the growth of perturbations beside the unstable direction is measured, after as many others.
/// Kind: tuned; measured on: not recorded.
const KICKED_GROWTH: usize = 200;

/// Growth of a lapse up to which a second direction counts as stable: sliders that rest neither grow nor decay.
/// Kind: tuned; measured on: not recorded.
const KICKED_NEUTRAL: f64 = 1e-4;

/// Outcome of a kicked motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// The motion comes back to where it was.
    Returns,
    /// The motion crosses to the other side of the saddle, and does not come back.
    Across,
}

/// The stable motion and the saddle at one phase of the forces.
pub(crate) struct Kicked<'a> {
    system: System<'a>,
    event_loop: EventLoop,
    lower: State,
    saddle: State,
    /// Distance between both motions.
    gap: f64,
    /// Velocities of all degrees of freedom after a unit impulse; and the velocity of the kicked one.
    kick: Vec<f64>,
    mobility: f64,
    estimate: f64,
    multiplier: f64,
}

impl<'a> Kicked<'a> {
    /// Shoots for both motions from the harmonics of the two points, at a phase of the forces.
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
            let Some(steady) = SteadySearch::new(&mut system, &mut event_loop, &options, hooks, start)?.closest()?
            else {
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
        if gap.is_nan() || gap <= ONE_SOLUTION * size {
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

    /// Repeats the shooting with a tight tolerance.
    pub fn tight(mut self) -> Result<Self> {
        self.event_loop = EventLoop::new(&self.system, TIGHT)?;
        Ok(self)
    }

    /// Impulse, to first order, that leads to the stable surface of the saddle.
    pub fn estimate(&self) -> f64 {
        self.estimate
    }

    /// Multiplier of the saddle in its unstable direction.
    pub fn multiplier(&self) -> f64 {
        self.multiplier
    }

    /// Velocity of the kicked degree of freedom after a unit impulse.
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

/// A unit impulse at a degree of freedom of the caller, on the independent ones, by its virtual work.
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

/// Map of perturbations of a motion over one lapse, with velocities divided by the frequency.
struct LapseMap<'s> {
    sensitivity: Sensitivity<'s>,
    omega: f64,
    /// Number of displacements; and number of all states.
    extent: (usize, usize),
}

impl LapseMap<'_> {
    /// Unit of state i: ω for velocities, 1 for displacements.
    fn unit(&self, i: usize) -> f64 {
        let n = self.extent.0;
        if (n..2 * n).contains(&i) { self.omega } else { 1.0 }
    }

    /// y ← B x, or y ← Bᵀ x if `transposed`.
    fn apply(&self, transposed: bool, x: &[f64], y: &mut [f64]) {
        for (j, y) in y.iter_mut().enumerate() {
            let entry = |i: usize| {
                let (from, to) = if transposed { (j, i) } else { (i, j) };
                self.sensitivity.by_initial(from, to) * self.unit(from) / self.unit(to)
            };
            *y = x.iter().enumerate().map(|(i, x)| x * entry(i)).sum();
        }
    }

    /// The largest multiplier with its eigenvector, by the power method; and whether this converges, as it does if
    /// the multiplier is real and has no equal.
    fn largest(&self, transposed: bool, interrupt: &Interrupt<'_>) -> Result<(Vec<f64>, f64, bool)> {
        let m = self.extent.1;
        let mut w = try_vec(m, 1.0, CONTEXT)?;
        let mut next = try_vec(m, 0.0, CONTEXT)?;
        let mut multiplier = f64::NAN;
        for _ in 0..KICKED_ITERATIONS {
            interrupt.check_before((m * m) as u64)?;
            self.apply(transposed, &w, &mut next);
            multiplier = dot(&w, &next) / dot(&w, &w);
            let size = dot(&next, &next).sqrt() * multiplier.signum();
            if size.is_nan() || size == 0.0 {
                break;
            }
            let mut change = 0.0;
            for (w, next) in w.iter_mut().zip(&next) {
                change = f64::max(change, (next / size - *w).abs());
                *w = next / size;
            }
            if change < KICKED_CHANGE {
                return Ok((w, multiplier, true));
            }
        }
        Ok((w, multiplier, false))
    }

    /// Growth over a lapse of perturbations without the direction of one multiplier μ: x ← B x − μ r (w·x)/(w·r) with
    /// its left and right eigenvectors w and r.
    fn growth_without(&self, multiplier: f64, w: &[f64], r: &[f64], interrupt: &Interrupt<'_>) -> Result<f64> {
        let m = self.extent.1;
        let mut x = try_vec(m, 0.0, CONTEXT)?;
        for (i, x) in x.iter_mut().enumerate() {
            *x = (1.7 * (i + 1) as f64).sin();
        }
        let mut next = try_vec(m, 0.0, CONTEXT)?;
        let both = dot(w, r);
        let mut logarithm = 0.0;
        for lapse in 0..2 * KICKED_GROWTH {
            interrupt.check_before((m * m) as u64)?;
            self.apply(false, &x, &mut next);
            let share = multiplier * dot(w, &x) / both;
            for (next, r) in next.iter_mut().zip(r) {
                *next -= share * r;
            }
            let (before, after) = (dot(&x, &x).sqrt(), dot(&next, &next).sqrt());
            if after <= f64::MIN_POSITIVE {
                return Ok(0.0);
            }
            if lapse >= KICKED_GROWTH {
                logarithm += (after / before).ln();
            }
            for (x, next) in x.iter_mut().zip(&next) {
                *x = next / after;
            }
        }
        Ok((logarithm / KICKED_GROWTH as f64).exp())
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The single multiplier of a motion beyond 1, with its left eigenvector, by the power method.
fn left_eigenvector(system: &mut System<'_>, event_loop: &mut EventLoop, motion: &State) -> Result<(Vec<f64>, f64)> {
    let mut sensitivity = Sensitivity::new(system)?;
    let mut state = motion.try_clone()?;
    let observers = Observers {
        variation: Some(sensitivity.begin()),
        ..Observers::default()
    };
    event_loop.run(system, &mut state, observers)?;
    let map = LapseMap {
        sensitivity,
        omega: system.omega,
        extent: (system.order(), state.len()),
    };
    let (mut w, multiplier, found) = map.largest(true, system.interrupt)?;
    if !(multiplier > 1.0 && found) {
        return fail!(
            Argument,
            "saddle: the largest multiplier is {multiplier:.6}, needs a point with one unstable direction, a real multiplier beyond 1"
        );
    }
    let (r, ..) = map.largest(false, system.interrupt)?;
    let second = map.growth_without(multiplier, &w, &r, system.interrupt)?;
    if second > 1.0 + KICKED_NEUTRAL {
        return fail!(
            Argument,
            "saddle: beside the multiplier {multiplier:.6} another one has the modulus {second:.4}, needs a point with one unstable \
             direction: kicks that do not return may then lead anywhere"
        );
    }
    for (i, w) in w.iter_mut().enumerate() {
        *w /= map.unit(i);
    }
    Ok((w, multiplier))
}
