//! One step of worn depths h over the cycles n, h′ = f(h).
//!
//! The derivative of f along the solution is exact, f′ = J f with the Jacobian J of the rates, so that two points give the fourth order:
//!
//! > h₁ = h₀ + Δ/2 (f₀ + f₁) + Δ²/12 (f₀′ − f₁′),
//!
//! the integral of the cubic that has f and f′ of both ends (the two-point formula of Obreshkov's family, stable for all steps). Newton's
//! matrix is I − Δ/2 J₁ + Δ²/12 J₁². A last correction δ that is so small that J changes by it less than the tolerance is made by the
//! derivatives, f₁ + J₁ δ, without another vibration. The error of a step is Δ⁵/720 h⁗′; the fifth derivative follows from the cubics of two neighbours. A first
//! step is held to Δ⁴/72 h⁗ instead.

use crate::analysis::worn_state::{WornState, WornStates};
use crate::error::{Result, try_copy, try_vec};
use crate::hooks::Hooks;
use crate::linalg::lu::Lu;

const CONTEXT: &str = "the steps of a life";

/// Newton iterations of a step. A cap: one or two on the chains of the tests.
const LIFE_STEP_ITERATIONS: usize = 8;

/// Share of the tolerance below which the equations of a step may be left. Chosen: a twentieth does not add to the error of a step.
const LIFE_STEP_RESIDUAL: f64 = 0.05;

/// Share of the tolerance by which the rates of a state may be uncertain that is corrected by its derivatives, not solved again. Chosen:
/// the secant of the derivatives takes about half of it away, which leaves the residual above.
const LIFE_STEP_CORRECTED: f64 = 0.1;

/// Size of a last correction over the tolerance that may not meet the begin of slip: it is told that much too late. Chosen.
const LIFE_STEP_UNSEEN: f64 = 3.0;

/// Terms of the series by which a step is predicted. Chosen: the last one is 1e-4 where loads halve.
const LIFE_STEP_TERMS: usize = 8;

/// A state at a number of cycles.
#[derive(Clone, Debug)]
pub(super) struct LifeState {
    /// Cycles.
    pub n: f64,
    /// Depths.
    pub depths: Vec<f64>,
    /// The vibration.
    pub worn: WornState,
}

/// Product of a column-major matrix of the order of `x` with `x`.
fn times(matrix: &[f64], x: &[f64]) -> Result<Vec<f64>> {
    let mut product = try_vec(x.len(), 0.0, CONTEXT)?;
    crate::linalg::add_product(1.0, matrix, x, &mut product);
    Ok(product)
}

impl LifeState {
    /// f′ = J f.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn second(&self) -> Result<Vec<f64>> {
        times(&self.worn.rate_by_depth, &self.worn.rate)
    }

    /// Change of the amplitude per cycle.
    pub fn amplitude_slope(&self) -> f64 {
        crate::linalg::dot(&self.worn.amplitude_by_depth, &self.worn.rate)
    }

    /// Size of a change of the depths: of the loads relative to their unit, or of the amplitude relative to itself.
    pub fn size_of(&self, states: &WornStates<'_>, change: &[f64]) -> f64 {
        let unit = states.load_unit().max(f64::MIN_POSITIVE);
        let mut size = 0.0_f64;
        for i in 0..change.len() {
            let load: f64 = (0..change.len()).map(|j| states.stiffness(i, j) * change[j]).sum();
            size = size.max(load.abs() / unit);
        }
        let amplitude = crate::linalg::dot(&self.worn.amplitude_by_depth, change);
        size.max(amplitude.abs() / self.worn.amplitude.abs().max(f64::MIN_POSITIVE))
    }
}

/// A step between two states.
#[derive(Clone, Debug)]
pub(super) struct LifeStep {
    /// The begin.
    pub from: LifeState,
    /// The end.
    pub to: LifeState,
    second: [Vec<f64>; 2],
    /// h⁗ of the cubic of the rates.
    fourth: Vec<f64>,
}

impl LifeStep {
    /// Steps from a state by `delta`; `last` is the step before. None where the equations were not solved.
    ///
    /// # Errors
    /// Those of the states.
    pub fn take(
        states: &mut WornStates<'_>,
        (from, delta): (&LifeState, f64),
        last: Option<&Self>,
        tolerance: f64,
        hooks: &mut Hooks<'_>,
    ) -> Result<Option<Self>> {
        let count = from.depths.len();
        let start = from.second()?;
        let mut depths = ahead((from, last), delta)?;
        let mut system = Lu::new(count, 1)?;
        for _ in 0..LIFE_STEP_ITERATIONS {
            if depths.iter().any(|h| !h.is_finite()) {
                return Ok(None);
            }
            let to = LifeState {
                n: from.n + delta,
                worn: states.at(&depths, hooks)?,
                depths: try_copy(&depths, CONTEXT)?,
            };
            let second = to.second()?;
            let (f0, f1) = (&from.worn.rate, &to.worn.rate);
            let mut gap = try_vec(count, 0.0, CONTEXT)?;
            for (j, gap) in gap.iter_mut().enumerate() {
                let cubic = delta * (0.5 * (f0[j] + f1[j]) + delta / 12.0 * (start[j] - second[j]));
                *gap = from.depths[j] + cubic - depths[j];
            }
            if to.size_of(states, &gap) <= LIFE_STEP_RESIDUAL * tolerance {
                return Self::whole(from, to, [start, second]).map(Some);
            }
            let jacobian = &to.worn.rate_by_depth;
            for (k, column) in jacobian.chunks_exact(count).enumerate() {
                let square = times(jacobian, column)?;
                for (j, (x, s)) in column.iter().zip(&square).enumerate() {
                    let unit = f64::from(u8::from(j == k));
                    system.matrix()[k * count + j] = unit - 0.5 * delta * x + delta * delta / 12.0 * s;
                }
            }
            if system.factor(&hooks.interrupt()).is_err() {
                return Ok(None);
            }
            system.solve(&mut gap);
            if let Some(to) = corrected(states, (from, &to), &gap, (delta, tolerance))? {
                let second = to.second()?;
                return Self::whole(from, to, [start, second]).map(Some);
            }
            for (h, gap) in depths.iter_mut().zip(&gap) {
                *h += gap;
            }
        }
        Ok(None)
    }

    /// The step between two states that solve its equations, from the derivatives of their rates.
    fn whole(from: &LifeState, to: LifeState, second: [Vec<f64>; 2]) -> Result<Self> {
        let delta = to.n - from.n;
        let mut fourth = try_vec(from.depths.len(), 0.0, CONTEXT)?;
        let (f0, f1) = (&from.worn.rate, &to.worn.rate);
        for (j, x) in fourth.iter_mut().enumerate() {
            *x = 6.0 * (2.0 * (f0[j] - f1[j]) / delta + second[0][j] + second[1][j]) / (delta * delta);
        }
        Ok(Self {
            from: from.clone(),
            to,
            second,
            fourth,
        })
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        self.to.n - self.from.n
    }

    /// The estimated error of the step, and the power of the length with which it grows.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn error(&self, states: &WornStates<'_>, last: Option<&Self>) -> Result<(f64, i32)> {
        let delta = self.length();
        let mut error = try_copy(&self.fourth, CONTEXT)?;
        let (factor, power) = match last {
            Some(last) => {
                for (x, y) in error.iter_mut().zip(&last.fourth) {
                    *x -= y;
                }
                (delta.powi(5) / 360.0 / (delta + last.length()), 5)
            }
            None => (delta.powi(4) / 72.0, 4),
        };
        for x in &mut error {
            *x *= factor;
        }
        Ok((self.to.size_of(states, &error), power))
    }

    /// Depths at n cycles, by the integral of the cubic of the rates.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn depths(&self, n: f64) -> Result<Vec<f64>> {
        let (delta, s) = (self.length(), (n - self.from.n) / self.length());
        let mut depths = try_copy(&self.from.depths, CONTEXT)?;
        for (j, h) in depths.iter_mut().enumerate() {
            let [b, c, d] = self.cubic(j);
            *h += delta * s * (self.from.worn.rate[j] + s * (b / 2.0 + s * (c / 3.0 + s * d / 4.0)));
        }
        Ok(depths)
    }

    /// Rates at n cycles.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn rates(&self, n: f64) -> Result<Vec<f64>> {
        let s = (n - self.from.n) / self.length();
        let mut rates = try_copy(&self.from.worn.rate, CONTEXT)?;
        for (j, f) in rates.iter_mut().enumerate() {
            let [b, c, d] = self.cubic(j);
            *f += s * (b + s * (c + s * d));
        }
        Ok(rates)
    }

    /// Coefficients of s, s² and s³ of the rate of a contact.
    fn cubic(&self, j: usize) -> [f64; 3] {
        let delta = self.length();
        let (f0, f1) = (self.from.worn.rate[j], self.to.worn.rate[j]);
        let (g0, g1) = (delta * self.second[0][j], delta * self.second[1][j]);
        [g0, 3.0 * (f1 - f0) - 2.0 * g0 - g1, 2.0 * (f0 - f1) + g0 + g1]
    }

    /// Amplitude at n cycles, by the cubic through values and slopes of both ends.
    pub fn amplitude(&self, n: f64) -> f64 {
        let (delta, s) = (self.length(), (n - self.from.n) / self.length());
        let (a0, a1) = (self.from.worn.amplitude, self.to.worn.amplitude);
        let (g0, g1) = (delta * self.from.amplitude_slope(), delta * self.to.amplitude_slope());
        a0 + s * (g0 + s * (3.0 * (a1 - a0) - 2.0 * g0 - g1 + s * (2.0 * (a0 - a1) + g0 + g1)))
    }

    /// A step so short that rates are constant over it.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn short(from: &LifeState, to: LifeState) -> Result<Self> {
        let zero = || try_vec(from.depths.len(), 0.0, CONTEXT);
        Ok(Self {
            second: [zero()?, zero()?],
            fourth: zero()?,
            from: from.clone(),
            to,
        })
    }
}

/// The end of a step moved by a correction of its depths, by derivatives; `None` where these change too much along it, or a contact may
/// change its state.
///
/// J changes by (J₁ − J₀) t along the correction δ = t (h₁ − h₀), and the equations of the step by Δ/12 (J₁ − J₀) δ of f′ = Jf.
fn corrected(
    states: &WornStates<'_>,
    (from, to): (&LifeState, &LifeState),
    correction: &[f64],
    (delta, tolerance): (f64, f64),
) -> Result<Option<LifeState>> {
    let count = correction.len();
    if from.worn.changes(&to.worn) {
        return Ok(None);
    }
    let mut turned = try_copy(&to.worn.rate_by_depth, CONTEXT)?;
    for (x, before) in turned.iter_mut().zip(&from.worn.rate_by_depth) {
        *x -= before;
    }
    let mut unknown = times(&turned, correction)?;
    for x in &mut unknown {
        *x *= delta / 12.0;
    }
    if to.size_of(states, &unknown) > LIFE_STEP_CORRECTED * tolerance {
        return Ok(None);
    }
    let sticks = to
        .worn
        .slips
        .iter()
        .zip(&to.worn.lost)
        .any(|(slips, lost)| !slips && !lost);
    if sticks && to.size_of(states, correction) > LIFE_STEP_UNSEEN * tolerance {
        return Ok(None);
    }
    let (mut along, mut square) = (0.0, 0.0);
    for ((c, h), before) in correction.iter().zip(&to.depths).zip(&from.depths) {
        along += c * (h - before);
        square += (h - before) * (h - before);
    }
    let share = if square > 0.0 { along / square } else { 0.0 };
    let mut moved = to.clone();
    let worn = &mut moved.worn;
    for (k, &c) in correction.iter().enumerate() {
        moved.depths[k] += c;
        worn.amplitude += c * worn.amplitude_by_depth[k];
        worn.omega += c * worn.omega_by_depth[k];
        for j in 0..count {
            worn.rate[j] += c * to.worn.rate_by_depth[k * count + j];
            worn.works[j] += c * to.worn.work_by_depth[k * count + j];
        }
    }
    for (x, change) in worn.rate_by_depth.iter_mut().zip(&turned) {
        *x += share * change;
    }
    let secant = worn.work_by_depth.iter_mut().zip(&from.worn.work_by_depth);
    for (x, before) in secant {
        *x += share * (*x - before);
    }
    for j in 0..count {
        let is_lost = states.raw_load(j, &moved.depths) <= 0.0 && states.raw_load(j, &to.depths) > 0.0;
        if is_lost || (worn.slips[j] && worn.works[j] <= 0.0) {
            return Ok(None);
        }
        worn.loads[j] += states.raw_load(j, &moved.depths) - states.raw_load(j, &to.depths);
    }
    Ok(Some(moved))
}

/// Depths at a distance from a state that a step has reached, as they follow without a change of a contact's state: the Taylor series of
/// f′ = J f, where J goes on along the line through its values at both ends of that step.
///
/// # Errors
/// `OutOfMemory`.
pub(super) fn ahead((at, last): (&LifeState, Option<&LifeStep>), delta: f64) -> Result<Vec<f64>> {
    let jacobian = &at.worn.rate_by_depth;
    let mut slope = try_vec(jacobian.len(), 0.0, CONTEXT)?;
    if let Some(step) = last {
        for (x, (j, before)) in slope.iter_mut().zip(jacobian.iter().zip(&step.from.worn.rate_by_depth)) {
            *x = (j - before) / step.length();
        }
    }
    // With f = Σ f_k tᵏ: (k + 1) f_{k+1} = J f_k + J′ f_{k−1}, and the depths are the integral.
    let mut depths = try_copy(&at.depths, CONTEXT)?;
    let mut term = try_copy(&at.worn.rate, CONTEXT)?;
    let mut before = try_vec(term.len(), 0.0, CONTEXT)?;
    let mut power = delta;
    for k in 0..LIFE_STEP_TERMS {
        for (h, f) in depths.iter_mut().zip(&term) {
            *h += f * power / (k + 1) as f64;
        }
        let mut next = times(jacobian, &term)?;
        crate::linalg::add_product(1.0, &slope, &before, &mut next);
        for x in &mut next {
            *x /= (k + 1) as f64;
        }
        before = core::mem::replace(&mut term, next);
        power *= delta;
    }
    Ok(depths)
}
