//! One step of worn depths h over the cycles n, h′ = f(h).
//!
//! The derivative of f along the solution is exact, f′ = J f with the Jacobian J of the rates, so that two points give the fourth order:
//!
//! > h₁ = h₀ + Δ/2 (f₀ + f₁) + Δ²/12 (f₀′ − f₁′),
//!
//! the integral of the cubic that has f and f′ of both ends (the two-point formula of Obreshkov's family, stable for all steps). Newton's
//! matrix is I − Δ/2 J₁ + Δ²/12 J₁². Its error is Δ⁵/720 h⁗′; the fifth derivative follows from the cubics of two neighbours. A first
//! step is held to Δ⁴/72 h⁗ instead.

use crate::analysis::worn_state::{WornState, WornStates};
use crate::error::{Result, try_copy, try_vec};
use crate::hooks::Hooks;
use crate::linalg::lu::Lu;

const CONTEXT: &str = "the steps of a life";

/// Newton iterations of a step.
const LIFE_STEP_ITERATIONS: usize = 8;

/// Share of the tolerance below which the equations of a step may be left.
const LIFE_STEP_RESIDUAL: f64 = 0.05;

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
                let mut fourth = try_vec(count, 0.0, CONTEXT)?;
                for (j, x) in fourth.iter_mut().enumerate() {
                    *x = 6.0 * (2.0 * (f0[j] - f1[j]) / delta + start[j] + second[j]) / (delta * delta);
                }
                return Ok(Some(Self {
                    from: from.clone(),
                    to,
                    second: [start, second],
                    fourth,
                }));
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
            for (h, gap) in depths.iter_mut().zip(&gap) {
                *h += gap;
            }
        }
        Ok(None)
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

    /// Depths at a distance beyond the end.
    fn beyond(&self, delta: f64) -> Result<Vec<f64>> {
        self.depths(self.to.n + delta)
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

/// Depths at a distance from a state that a step has reached, as they follow without a change of a contact's state.
///
/// # Errors
/// `OutOfMemory`.
pub(super) fn ahead((at, last): (&LifeState, Option<&LifeStep>), delta: f64) -> Result<Vec<f64>> {
    if let Some(step) = last {
        return step.beyond(delta);
    }
    let second = at.second()?;
    let mut depths = try_copy(&at.depths, CONTEXT)?;
    for (j, h) in depths.iter_mut().enumerate() {
        *h += delta * (at.worn.rate[j] + 0.5 * delta * second[j]);
    }
    Ok(depths)
}
