//! The steady state in time: shooting by Newton's method, or marching if that fails.
//!
//! The unknown is the state z at the start of a lapse, the equation S G(z) = z with the flow G over the lapse and the
//! shift S that assigns to every sector the motion of the one it follows. The monodromy ∂G/∂z is integrated piece by
//! piece and is exact, since the field is continuous at events. A slider that never moves may rest anywhere: its
//! equation is void, and it keeps its initial place.

use crate::error::{Result, Status, check_memory, fail, try_extend, try_push, try_vec};
use crate::hooks::{Hooks, Progress};
use crate::linalg::dense::least_squares::LeastSquares;
use crate::options::{SteadyMethod, TimeOptions};
use crate::time_integration::event_loop::{EventLoop, LapseSummary, Observers, State};
use crate::time_integration::sensitivity::Sensitivity;
use crate::time_integration::unrolled_structure::System;
use crate::time_integration::variation::Variation;

/// Newton iterations before marching replaces them.
/// Kind: cap.
const SHOOTING_MOST_ITERATIONS: usize = 30;

/// Ratio of successive errors below which the monodromy is kept.
/// Kind: tuned; measured on: not recorded.
const SHOOTING_FAST: f64 = 0.1;

/// Smallest share of a Newton step that is tried.
/// Kind: cap.
const SHOOTING_SHORTEST: f64 = 1.0 / 64.0;

/// Distance from 1 below which directions of the monodromy are not corrected, such as the free rotation of a ring
/// that friction alone holds: the whole motion may be shifted along them.
/// Kind: rounding.
const NEUTRAL: f64 = 1e-9;

/// Bytes of a matrix of derivatives that stretches of sliders may make larger than the structure needs: beyond it, periods are
/// marched instead.
/// Kind: cap.
const MOST_BYTES: usize = 100 << 20;

/// A search for the closest motion leaves a lapse whose motion is so many times its first state, or that takes so many times the
/// steps of its first lapse: from there it would come back to another motion, if at all.
/// Kind: tuned; measured on: not recorded.
const SHOOTING_BEYOND: f64 = 1e3;
/// Steps of a lapse, over those of its first lapse, at which such a search leaves it.
/// Kind: cap.
const SHOOTING_STEPS: usize = 16;

/// Steps that any lapse of it may take.
/// Kind: cap.
const SHOOTING_LEAST_STEPS: usize = 20_000;

/// Number of periods that are marched after the first failure of Newton's method; each time twice as many.
/// Kind: tuned; measured on: not recorded.
const FIRST_MARCH: usize = 8;

/// Checks that memory is available for the largest arrays of shooting, the derivatives of the state and the equations made
/// of them, before a structure of `order` degrees of freedom is unrolled for it. Stretches of sliders come on top.
pub(crate) fn check_shooting(order: usize) -> Result<()> {
    let states = order.saturating_mul(2);
    check_memory::<f64>(states.saturating_mul(states).saturating_mul(2), "shooting in time")
}

/// Result of a search for a steady state.
pub(crate) struct Steady {
    /// The state at time 0.
    pub state: State,
    /// Largest change over a lapse, relative to the largest displacement and velocity.
    pub residual: f64,
    /// Number of periods that were integrated, rounded up.
    pub periods: usize,
    /// Status: `Ok`, or `StoppedByCaller`.
    pub status: Status,
    /// Whether periods were marched.
    pub marched: bool,
}

enum Outcome {
    Found,
    Failed,
    Stopped,
}

/// A search for a steady state, with its memory.
pub(crate) struct SteadySearch<'a, 'h, 's> {
    system: &'a mut System<'s>,
    event_loop: &'a mut EventLoop,
    options: &'a TimeOptions<'a>,
    hooks: &'a mut Hooks<'h>,
    state: State,
    images: Images,
    scale: (f64, f64),
    residual: f64,
    laps: usize,
    most_laps: usize,
    sought: Sought,
    /// Unit of velocities in the equations factorised last.
    unit: f64,
}

/// A lapse later.
pub(crate) struct Images {
    /// The state after a lapse from `state`, and the same with the sectors shifted.
    image: State,
    shifted: State,
}

/// Kind of motion that is sought.
pub(crate) struct Sought {
    /// Whether the frequency is an unknown, because no force has one.
    free: bool,
    /// Whether the motion must be near the first state.
    near: bool,
    /// Whether a residual within the tolerance ends the search; else it goes on to round-off.
    quick: bool,
}

impl<'a, 'h, 's> SteadySearch<'a, 'h, 's> {
    /// A search from `start`.
    pub fn new(
        system: &'a mut System<'s>,
        event_loop: &'a mut EventLoop,
        options: &'a TimeOptions<'a>,
        hooks: &'a mut Hooks<'h>,
        start: State,
    ) -> Result<Self> {
        Ok(Self {
            images: Images {
                image: start.try_clone()?,
                shifted: start.try_clone()?,
            },
            state: start,
            most_laps: options.max_periods.saturating_mul(system.wave.lapses),
            system,
            event_loop,
            options,
            hooks,
            scale: (0.0, 0.0),
            residual: f64::INFINITY,
            laps: 0,
            sought: Sought {
                free: false,
                near: false,
                quick: false,
            },
            unit: 1.0,
        })
    }

    /// Makes the frequency an unknown. Its equation fixes the phase: the state moves at right angles to its own
    /// rate.
    pub fn free_frequency(mut self) -> Self {
        self.sought.free = true;
        self
    }

    /// Ends the search as soon as the residual is within the tolerance.
    pub fn quick(mut self) -> Self {
        self.sought.quick = true;
        self
    }

    /// Shoots without marching, so that an unstable motion is kept; `None`: Newton's method did not converge.
    pub fn closest(mut self) -> Result<Option<Steady>> {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let size = largest(&self.state.x).max(largest(&self.state.v) / self.system.omega);
        if size > 0.0 {
            self.event_loop.bounds = (SHOOTING_BEYOND * size, SHOOTING_BEYOND * size * self.system.omega);
        }
        self.sought.near = true;
        let outcome = self.shoot();
        self.event_loop.without_bounds();
        let status = match outcome {
            Ok(Outcome::Found) => Status::Ok,
            Ok(Outcome::Failed) => return Ok(None),
            // The first lapse went too far.
            Err(e) if matches!(e.status, Status::NoBoundedSolution) => return Ok(None),
            Ok(Outcome::Stopped) => Status::StoppedByCaller,
            Err(e) if e.status == Status::StoppedByCaller => e.status,
            Err(e) => return Err(e),
        };
        Ok(Some(self.result(status, false)))
    }

    /// Searches for the steady state.
    pub fn run(mut self) -> Result<Steady> {
        let mut marched = false;
        let status = match self.search(&mut marched) {
            Ok(status) => status,
            Err(e) if e.status == Status::StoppedByCaller => e.status,
            Err(e) => return Err(e),
        };
        Ok(self.result(status, marched))
    }

    fn result(self, status: Status, marched: bool) -> Steady {
        Steady {
            periods: self.laps.div_ceil(self.system.wave.lapses),
            state: self.state,
            residual: self.residual,
            status,
            marched,
        }
    }

    fn search(&mut self, marched: &mut bool) -> Result<Status> {
        let mut march = FIRST_MARCH;
        loop {
            let mut outcome = Outcome::Failed;
            if self.options.method == SteadyMethod::Shooting {
                let before = self.state.try_clone()?;
                outcome = self.shoot()?;
                if matches!(outcome, Outcome::Failed) {
                    self.state.set(&before);
                }
            }
            if matches!(outcome, Outcome::Failed) {
                *marched = true;
                outcome = self.march(march.saturating_mul(self.system.wave.lapses))?;
                march *= 2;
            }
            match outcome {
                Outcome::Found => return Ok(Status::Ok),
                Outcome::Stopped => return Ok(Status::StoppedByCaller),
                Outcome::Failed => {}
            }
        }
    }

    /// Integrates one lapse from the state, shifts the image, and compares it with the state. `true`: the caller
    /// requested a stop.
    fn lap(&mut self, sensitivity: Option<&mut Sensitivity<'s>>) -> Result<bool> {
        if self.laps >= self.most_laps {
            return fail!(
                NoConvergence,
                "no steady state within max_periods = {}: the last change over a period is {:.1e} of the motion; raise max_periods, start nearer, or the motion has another period",
                self.options.max_periods,
                self.residual
            );
        }
        self.laps += 1;
        self.images.image.set(&self.state);
        let summary = {
            let observers = Observers {
                variation: sensitivity.map(|s| s.begin() as &mut dyn Variation),
                ..Observers::default()
            };
            self.event_loop.run(self.system, &mut self.images.image, observers)?
        };
        if self.sought.near && self.laps == 1 {
            self.event_loop.most_steps = SHOOTING_LEAST_STEPS.max(SHOOTING_STEPS.saturating_mul(self.event_loop.steps));
        }
        self.compare(&summary);
        if self.residual.is_nan() {
            return fail!(NoBoundedSolution, "the motion in time grows beyond all bounds");
        }
        let progress = Progress {
            point: self.laps,
            parameter: self.system.omega,
            amplitude: summary.largest.0,
            residual: self.residual,
            ..Progress::default()
        };
        Ok(self.hooks.report(&progress))
    }

    /// Shifts the image, so that each sector has the values of the one with the same motion a lapse later, and
    /// measures its relative distance from the state.
    fn compare(&mut self, summary: &LapseSummary) {
        let system = &*self.system;
        shift(system, system.ndof, &self.images.image.x, &mut self.images.shifted.x);
        shift(system, system.ndof, &self.images.image.v, &mut self.images.shifted.v);
        shift(system, 1, &self.images.image.e, &mut self.images.shifted.e);
        let unit = |x: f64| if x > 0.0 { x } else { 1.0 };
        self.scale = (unit(summary.largest.0), unit(summary.largest.1));
        self.residual = 0.0;
        for (a, b, scale) in [
            (&self.images.shifted.x, &self.state.x, self.scale.0),
            (&self.images.shifted.v, &self.state.v, self.scale.1),
            (&self.images.shifted.e, &self.state.e, self.scale.0),
        ] {
            for (a, b) in a.iter().zip(b) {
                let gap = (a - b).abs() / scale;
                self.residual = if gap.is_nan() { gap } else { self.residual.max(gap) };
            }
        }
    }

    /// Marches period by period until the state no longer changes.
    fn march(&mut self, laps: usize) -> Result<Outcome> {
        for _ in 0..laps {
            if self.lap(None)? {
                return Ok(Outcome::Stopped);
            }
            self.state.set(&self.images.shifted);
            if self.residual <= self.options.tolerance {
                return Ok(Outcome::Found);
            }
        }
        Ok(Outcome::Failed)
    }

    /// Newton's method with halved steps where a whole one increases the error. The monodromy is kept as long as steps
    /// with it reduce the error fast; then each of them costs a lapse of the motion alone.
    fn shoot(&mut self) -> Result<Outcome> {
        let unknowns = self.state.len() + usize::from(self.sought.free);
        let of_structure = 2 * self.state.x.len();
        if unknowns > 2 * of_structure && unknowns.saturating_mul(unknowns).saturating_mul(8) > MOST_BYTES {
            return Ok(Outcome::Failed);
        }
        let interrupt = self.system.interrupt;
        interrupt.check()?;
        let mut sensitivity = Sensitivity::new(self.system)?;
        let mut equations = LeastSquares::new(unknowns, interrupt)?;
        let mut step = try_vec(unknowns, 0.0, "Newton's method in time")?;
        let mut base = self.state.try_clone()?;
        for _ in 0..SHOOTING_MOST_ITERATIONS {
            self.event_loop.clear_moved();
            if self.lap(Some(&mut sensitivity))? {
                return Ok(Outcome::Stopped);
            }
            let mut damped = true;
            loop {
                let residual = self.residual;
                let converged = residual <= self.options.tolerance;
                if converged && self.sought.quick {
                    return Ok(Outcome::Found);
                }
                // With the frequency as an unknown the equations change with the rates.
                let fresh = damped || self.sought.free;
                if fresh {
                    self.equations(&sensitivity, &mut equations)?;
                }
                if !self.correction(fresh, &mut equations, &mut step)? {
                    return Ok(if converged { Outcome::Found } else { Outcome::Failed });
                }
                base.set(&self.state);
                let omega = self.system.omega;
                let shortest = if damped && !converged { SHOOTING_SHORTEST } else { 1.0 };
                if self.step_from(&base, omega, &step, residual, shortest)? {
                    return Ok(Outcome::Stopped);
                }
                let fast = self.residual < SHOOTING_FAST * residual;
                if self.residual >= residual {
                    // Round-off may keep the last correction from reducing the error.
                    self.state.set(&base);
                    self.system.omega = omega;
                    self.residual = residual;
                    if converged {
                        return Ok(Outcome::Found);
                    }
                    if damped {
                        return Ok(Outcome::Failed);
                    }
                    break;
                }
                if !fast {
                    if self.residual <= self.options.tolerance {
                        return Ok(Outcome::Found);
                    }
                    break;
                }
                damped = false;
            }
        }
        Ok(Outcome::Failed)
    }

    /// Steps from `base` by the longest halved share of the step that reduces the error below `residual`, but not
    /// shorter than `shortest`; `true`: the caller requested a stop.
    fn step_from(&mut self, base: &State, omega: f64, step: &[f64], residual: f64, shortest: f64) -> Result<bool> {
        let mut share = 1.0;
        loop {
            self.advance(base, omega, step, share);
            match self.lap(None) {
                Ok(false) => {}
                Ok(true) => return Ok(true),
                // A step that is far too long may lead to a state that cannot be integrated.
                Err(e) if !(e.recoverable || matches!(e.status, Status::NoBoundedSolution | Status::NoConvergence)) => {
                    return Err(e);
                }
                Err(e) if self.laps >= self.most_laps => return Err(e),
                Err(_) => self.residual = f64::INFINITY,
            }
            share *= 0.5;
            if self.residual < residual || share < shortest {
                return Ok(false);
            }
        }
    }

    /// Whether the slider of a stretch does not move in any sector, so that it has a fixed place and no equation.
    fn rests(&self, i: usize) -> bool {
        let n = self.state.x.len();
        i >= 2 * n
            && self
                .system
                .elements
                .iter()
                .zip(&self.event_loop.moved)
                .all(|(e, &moved)| {
                    e.family != self.system.elements[i - 2 * n].family || !(moved && e.slider().is_some())
                })
    }

    /// Fills the matrix I − S ∂G/∂z, with a free frequency bordered by the rate of the state.
    fn equations(&mut self, s: &Sensitivity<'_>, equations: &mut LeastSquares) -> Result<()> {
        let rates = if self.sought.free { Some(self.rates()?) } else { None };
        // Velocities are scaled to displacements, so that pivots compare.
        self.unit = self.scale.1 / self.scale.0;
        let (system, m, n) = (&*self.system, self.state.len(), self.state.x.len());
        let order = m + usize::from(self.sought.free);
        let unit = |i: usize| if (n..2 * n).contains(&i) { self.unit } else { 1.0 };
        let matrix = equations.matrix();
        matrix.fill(0.0);
        for i in 0..m {
            system.interrupt.check()?;
            let (void, (from, sign)) = (self.rests(i), source_of(system, n, i));
            for j in 0..m {
                let image = if void { 0.0 } else { sign * s.by_initial(j, from) };
                matrix[j * order + i] = f64::from(u8::from(i == j)) - image * unit(j) / unit(i);
            }
        }
        // Where the slider rests its spring follows the motion: δe = r·δx.
        for (i, e) in system.elements.iter().enumerate() {
            if self.rests(2 * n + i) && e.slider().is_some() {
                for &(dof, a) in e.rows[0].iter().flatten() {
                    matrix[dof * order + 2 * n + i] -= a;
                }
            }
        }
        if let Some((here, there)) = &rates {
            // The lapse as an unknown, in units of itself, and the phase.
            let lapse = system.lapse();
            let size: f64 = (0..m).map(|i| (here[i] / unit(i)).powi(2)).sum::<f64>().sqrt();
            for i in 0..m {
                let (void, (from, sign)) = (self.rests(i), source_of(system, n, i));
                matrix[m * order + i] = if void {
                    0.0
                } else {
                    -lapse * sign * there[from] / unit(i)
                };
                matrix[i * order + m] = if void { 0.0 } else { here[i] / unit(i) / size };
            }
        }
        Ok(())
    }

    /// Solves (I − S ∂G/∂z) step = S G(z) − z with the matrix of [`Self::equations`], `fresh` or factorised before;
    /// `false`: it has no solution.
    fn correction(&mut self, fresh: bool, equations: &mut LeastSquares, step: &mut [f64]) -> Result<bool> {
        let (m, n) = (self.state.len(), self.state.x.len());
        let unit = |i: usize| if (n..2 * n).contains(&i) { self.unit } else { 1.0 };
        step.fill(0.0);
        for (i, step) in step.iter_mut().enumerate().take(m) {
            *step = match i {
                i if self.rests(i) => 0.0,
                i if i < n => self.images.shifted.x[i] - self.state.x[i],
                i if i < 2 * n => (self.images.shifted.v[i - n] - self.state.v[i - n]) / unit(i),
                i => self.images.shifted.e[i - 2 * n] - self.state.e[i - 2 * n],
            };
        }
        if fresh {
            equations.solve(step, NEUTRAL, self.system.interrupt)?;
        } else {
            equations.solve_again(step);
        }
        for (i, step) in step.iter_mut().take(m).enumerate() {
            *step *= unit(i);
        }
        Ok(step.iter().all(|x| x.is_finite()))
    }

    /// Rates of the state and of its image: (x′, v′, e′).
    fn rates(&mut self) -> Result<(Vec<f64>, Vec<f64>)> {
        let mut pair = (Vec::new(), Vec::new());
        for (rates, state) in [(&mut pair.0, &self.state), (&mut pair.1, &self.images.image)] {
            let (a, w) = self.event_loop.rates(self.system, state)?;
            try_extend(rates, &state.v, "Newton's method in time")?;
            try_extend(rates, &a, "Newton's method in time")?;
            for (e, w) in self.system.elements.iter().zip(w) {
                let stretch = if e.slider().is_some() {
                    e.relative(&state.v)[0] - w
                } else {
                    0.0
                };
                try_push(rates, stretch, "Newton's method in time")?;
            }
        }
        Ok(pair)
    }

    /// state ← base + share·step, and the frequency where it is an unknown.
    fn advance(&mut self, base: &State, omega: f64, step: &[f64], share: f64) {
        let n = base.x.len();
        let (x, rest) = step.split_at(n);
        let (v, rest) = rest.split_at(n);
        let (e, lapse) = rest.split_at(base.e.len());
        if let [lapse] = lapse {
            // A step that would turn time around is cut.
            self.system.omega = omega / (1.0 + share * lapse).clamp(0.5, 2.0);
        }
        for (to, from, step) in [
            (&mut self.state.x, &base.x, x),
            (&mut self.state.v, &base.v, v),
            (&mut self.state.e, &base.e, e),
        ] {
            for ((to, from), step) in to.iter_mut().zip(from).zip(step) {
                *to = from + share * step;
            }
        }
    }
}

/// Source of the entry `i` of a shifted state with `n` displacements, and its sign.
fn source_of(system: &System<'_>, n: usize, i: usize) -> (usize, f64) {
    let (first, block) = match i {
        i if i < n => (0, system.ndof),
        i if i < 2 * n => (n, system.ndof),
        _ => (2 * n, 1),
    };
    let (from, sign) = shifted_from(system, block, i - first);
    (first + from, sign)
}

/// Source of the entry `i` of a shifted vector and its sign, with `block` entries per sector.
fn shifted_from(system: &System<'_>, block: usize, i: usize) -> (usize, f64) {
    let (sector, within) = (i / block % system.wave.sectors, i % block);
    let group = i - sector * block - within;
    let (to, sign) = system.after_lapse(sector);
    (group + to * block + within, sign)
}

/// Assigns to every sector the values of the one with the same motion a lapse later.
fn shift(system: &System<'_>, block: usize, from: &[f64], to: &mut [f64]) {
    for (i, to) in to.iter_mut().enumerate() {
        let (at, sign) = shifted_from(system, block, i);
        *to = sign * from[at];
    }
}
