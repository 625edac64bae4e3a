//! One step of worn depths h over the cycles n, h′ = f(h).
//!
//! The derivative of f along the solution is exact, f′ = J f with the Jacobian J of the rates, so that two points give the fourth order:
//!
//! > h₁ = h₀ + Δ/2 (f₀ + f₁) + Δ²/12 (f₀′ − f₁′),
//!
//! the integral of the cubic that has f and f′ of both ends (the two-point formula of Obreshkov's family, stable for all steps). Newton's
//! matrix is I − Δ/2 J₁ + Δ²/12 J₁². A last correction δ that is so small that J changes by it less than the tolerance is made by the
//! derivatives, f₁ + J₁ δ, without another vibration. The error of a step is Δ⁵/720 h⁗′; the fifth derivative follows from the cubics of
//! two neighbours, and so does the error of the cubic of the amplitude, Δ⁴/384 a⁗. A first step is held to Δ⁴/72 h⁗ instead. A step whose
//! first vibration shows an error far above the tolerance is refused at once, and so is one whose ends are not the same motion.

use crate::error::{Result, try_copy, try_vec};
use crate::hooks::Hooks;
use crate::linalg::factors::lu::Lu;
use crate::studies::wear::worn_state::{WornState, WornStates};

const CONTEXT: &str = "the steps of a life";

/// Newton iterations of a step.
/// Kind: cap; one or two on the chains of the tests.
const LIFE_STEP_ITERATIONS: usize = 8;

/// Share of the tolerance by which the equations of a step may be left, and by which a straight step across an event may err. Chosen: a
/// twentieth does not add to the error of a step.
/// Kind: tuned; measured on: nothing, it is chosen.
pub(super) const LIFE_NEGLIGIBLE: f64 = 0.05;

/// Error over the tolerance from which a step is refused at its first vibration. Chosen: iterations change the estimate by less.
/// Kind: tuned; measured on: nothing, it is chosen.
const LIFE_STEP_HOPELESS: f64 = 3.0;

/// Part of the change of the amplitude, or of a work, that derivatives at both ends may leave within one motion. Chosen: it is the square
/// of the relative change over 12 where that is exponential, and a jump leaves all of it.
/// Kind: tuned; measured on: nothing, it is chosen.
const LIFE_STEP_BREAK: f64 = 0.2;

/// Error over the tolerance that a broken step has at least, as long as its error is above the tolerance: its length is quartered.
/// Kind: tuned; measured on: not recorded.
const LIFE_STEP_BROKEN: f64 = 1e3;

/// Smallest part, relative, that counts as a break, over the square root of the tolerance: 1e-3 by default. Chosen: what a kink that is no
/// event leaves in a step of the wanted error is below.
/// Kind: tuned; measured on: nothing, it is chosen.
const LIFE_STEP_BREAK_FLOOR: f64 = 0.1;

/// Size of a last correction over the tolerance that may not meet the begin of slip: it is told that much too late. Chosen.
/// Kind: tuned; measured on: nothing, it is chosen.
const LIFE_STEP_UNSEEN: f64 = 3.0;

/// Terms of the series by which a part of a step is predicted, in which rates change at most by their own size: the next one is 3e-6.
/// Kind: tuned; measured on: not recorded.
const LIFE_STEP_TERMS: usize = 8;

/// Most parts of a predicted step.
/// Kind: cap.
const LIFE_STEP_PARTS: usize = 64;

/// State of the machine after a number of cycles.
#[derive(Clone, Debug)]
pub(crate) struct LifeState {
    /// Number n of cycles.
    pub n: f64,
    /// Worn depths of the contacts.
    pub depths: Vec<f64>,
    /// Steady vibration with these depths.
    pub worn: WornState,
}

/// Product of a column-major square matrix with `x`.
fn times(matrix: &[f64], x: &[f64]) -> Result<Vec<f64>> {
    let mut product = try_vec(x.len(), 0.0, CONTEXT)?;
    crate::linalg::add_product(1.0, matrix, x, &mut product);
    Ok(product)
}

impl LifeState {
    /// The vibration and the depths of this state, as a start for one nearby.
    pub fn near(&self) -> (&WornState, &[f64]) {
        (&self.worn, &self.depths)
    }

    /// Whether another state continues the motion of this one: its amplitude and works follow from the derivatives at
    /// both states.
    pub fn goes_on_to(&self, other: &Self, states: &WornStates<'_>, tolerance: f64) -> Result<bool> {
        let mut change = try_copy(&other.depths, CONTEXT)?;
        for (x, before) in change.iter_mut().zip(&self.depths) {
            *x -= before;
        }
        let (left, whole) = self
            .worn
            .breaks(&other.worn, &change, states.work_unit(self.worn.amplitude));
        Ok(left <= LIFE_STEP_BREAK_FLOOR * tolerance.sqrt() || left <= LIFE_STEP_BREAK * whole)
    }

    /// Second derivative f′ = J f of the depths by the cycles.
    pub fn second(&self) -> Result<Vec<f64>> {
        times(&self.worn.rate_by_depth, &self.worn.rate)
    }

    /// Change of the amplitude per cycle.
    pub fn amplitude_slope(&self) -> f64 {
        crate::linalg::dot(&self.worn.amplitude_by_depth, &self.worn.rate)
    }

    /// Size of a change of the depths, by its effect: change of the loads over their unit, or relative change of the
    /// amplitude.
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

/// A step of the life between two states.
#[derive(Clone, Debug)]
pub(crate) struct LifeStep {
    /// State at the beginning of the step.
    pub from: LifeState,
    /// State at the end of the step.
    pub to: LifeState,
    second: [Vec<f64>; 2],
    /// Fourth derivative h⁗ of the depths, by the cubic of the rates; and third derivative a‴ of the amplitude, by
    /// its cubic.
    fourth: Vec<f64>,
    third: f64,
}

/// Outcome of an attempt to make a step.
#[allow(clippy::large_enum_variant)]
pub(crate) enum Taken {
    /// The step is solved, or a contact changes its state within it.
    Step(LifeStep),
    /// The step was not solved, because its error over the tolerance is as large as given.
    Refused(f64),
    /// Both ends do not belong to one motion.
    Broken,
    /// The equations of the step were not solved.
    Failed,
}

impl LifeStep {
    /// Tries a step from a state by `delta` cycles; `last` is the step before.
    ///
    /// # Errors
    /// Those of the states.
    pub fn take(
        states: &mut WornStates<'_>,
        from: &LifeState,
        delta: f64,
        last: Option<&Self>,
        tolerance: f64,
        hooks: &mut Hooks<'_>,
    ) -> Result<Taken> {
        let count = from.depths.len();
        let start = from.second()?;
        let mut depths = ahead(from, last, delta)?;
        let mut system = Lu::new(count, 1)?;
        let mut before: Option<LifeState> = None;
        for _ in 0..LIFE_STEP_ITERATIONS {
            if depths.iter().any(|h| !h.is_finite()) {
                return Ok(Taken::Failed);
            }
            let to = LifeState {
                n: from.n + delta,
                worn: states.at(&depths, Some(before.as_ref().unwrap_or(from).near()), hooks)?,
                depths: try_copy(&depths, CONTEXT)?,
            };
            let second = to.second()?;
            let changes = from.worn.changes(&to.worn);
            if !changes {
                let fourth = fourth(from, &to, [&start, &second])?;
                let bends = (&fourth[..], third((from, &to)));
                let (error, _) = error_of(states, &to, bends, delta, last)?;
                let share = error / tolerance;
                if last.is_some() && share > LIFE_STEP_HOPELESS {
                    return Ok(Taken::Refused(share));
                }
                if !from.goes_on_to(&to, states, tolerance)? {
                    return Ok(if share > 1.0 {
                        Taken::Refused(share.max(LIFE_STEP_BROKEN))
                    } else {
                        Taken::Broken
                    });
                }
            }
            let (f0, f1) = (&from.worn.rate, &to.worn.rate);
            let mut gap = try_vec(count, 0.0, CONTEXT)?;
            for (j, gap) in gap.iter_mut().enumerate() {
                let cubic = delta * (0.5 * (f0[j] + f1[j]) + delta / 12.0 * (start[j] - second[j]));
                *gap = from.depths[j] + cubic - depths[j];
            }
            if changes || to.size_of(states, &gap) <= LIFE_NEGLIGIBLE * tolerance {
                return Self::whole(from, to, [start, second]).map(Taken::Step);
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
                return Ok(Taken::Failed);
            }
            system.solve(&mut gap);
            if let Some(to) = corrected(states, from, &to, &gap, delta, tolerance)? {
                let second = to.second()?;
                return Self::whole(from, to, [start, second]).map(Taken::Step);
            }
            for (h, gap) in depths.iter_mut().zip(&gap) {
                *h += gap;
            }
            before = Some(to);
        }
        Ok(Taken::Failed)
    }

    /// The step between two states that solve its equations, from the derivatives of their rates.
    fn whole(from: &LifeState, to: LifeState, second: [Vec<f64>; 2]) -> Result<Self> {
        let fourth = fourth(from, &to, [&second[0], &second[1]])?;
        Ok(Self {
            third: third((from, &to)),
            from: from.clone(),
            to,
            second,
            fourth,
        })
    }

    /// Length of the step in cycles.
    pub fn length(&self) -> f64 {
        self.to.n - self.from.n
    }

    /// The estimated error of the step, and the power of the length with which it grows.
    pub fn error(&self, states: &WornStates<'_>, last: Option<&Self>) -> Result<(f64, i32)> {
        error_of(states, &self.to, (&self.fourth, self.third), self.length(), last)
    }

    /// Depths at n cycles, as integrals of the cubic of the rates.
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
    pub fn rates(&self, n: f64) -> Result<Vec<f64>> {
        let s = (n - self.from.n) / self.length();
        let mut rates = try_copy(&self.from.worn.rate, CONTEXT)?;
        for (j, f) in rates.iter_mut().enumerate() {
            let [b, c, d] = self.cubic(j);
            *f += s * (b + s * (c + s * d));
        }
        Ok(rates)
    }

    /// Coefficients of s, s² and s³ in the rate of contact j, where s is the share of the step.
    fn cubic(&self, j: usize) -> [f64; 3] {
        let delta = self.length();
        let (f0, f1) = (self.from.worn.rate[j], self.to.worn.rate[j]);
        let (g0, g1) = (delta * self.second[0][j], delta * self.second[1][j]);
        [g0, 3.0 * (f1 - f0) - 2.0 * g0 - g1, 2.0 * (f0 - f1) + g0 + g1]
    }

    /// Amplitude at n cycles, by the cubic through values and slopes at both ends.
    pub fn amplitude(&self, n: f64) -> f64 {
        let [from, to] = [&self.from, &self.to];
        self.through(
            n,
            [from.worn.amplitude, to.worn.amplitude],
            [from.amplitude_slope(), to.amplitude_slope()],
        )
    }

    /// Angular frequency at n cycles, by the cubic through values and slopes at both ends.
    pub fn omega(&self, n: f64) -> f64 {
        let [from, to] = [&self.from.worn, &self.to.worn];
        let slope = |worn: &WornState| crate::linalg::dot(&worn.omega_by_depth, &worn.rate);
        self.through(n, [from.omega, to.omega], [slope(from), slope(to)])
    }

    fn through(&self, n: f64, [a0, a1]: [f64; 2], slopes: [f64; 2]) -> f64 {
        let (delta, s) = (self.length(), (n - self.from.n) / self.length());
        let [g0, g1] = slopes.map(|slope| delta * slope);
        a0 + s * (g0 + s * (3.0 * (a1 - a0) - 2.0 * g0 - g1 + s * (2.0 * (a0 - a1) + g0 + g1)))
    }

    /// Makes a step so short that rates are constant over it.
    pub fn short(from: &LifeState, to: LifeState) -> Result<Self> {
        let zero = || try_vec(from.depths.len(), 0.0, CONTEXT);
        Ok(Self {
            second: [zero()?, zero()?],
            fourth: zero()?,
            third: 0.0,
            from: from.clone(),
            to,
        })
    }
}

/// Fourth derivative h⁗ of the depths between two states, from f′ at both by the cubic of the rates.
fn fourth(from: &LifeState, to: &LifeState, second: [&[f64]; 2]) -> Result<Vec<f64>> {
    let delta = to.n - from.n;
    let mut fourth = try_vec(from.depths.len(), 0.0, CONTEXT)?;
    let (f0, f1) = (&from.worn.rate, &to.worn.rate);
    for (j, x) in fourth.iter_mut().enumerate() {
        *x = 6.0 * (2.0 * (f0[j] - f1[j]) / delta + second[0][j] + second[1][j]) / (delta * delta);
    }
    Ok(fourth)
}

/// Estimated error of a step, and the power of its length with which the error grows.
fn error_of(
    states: &WornStates<'_>,
    to: &LifeState,
    (fourth, third): (&[f64], f64),
    delta: f64,
    last: Option<&LifeStep>,
) -> Result<(f64, i32)> {
    let mut error = try_copy(fourth, CONTEXT)?;
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
    // The cubic of the amplitude errs by Δ⁴/384 a⁗.
    let amplitude = last.map_or(0.0, |last| {
        let fourth = (third - last.third) / (0.5 * (delta + last.length()));
        fourth.abs() * delta.powi(4) / 384.0 / to.worn.amplitude.abs().max(f64::MIN_POSITIVE)
    });
    Ok((to.size_of(states, &error).max(amplitude), power))
}

/// Third derivative a‴ of the amplitude between two states, by its cubic.
fn third((from, to): (&LifeState, &LifeState)) -> f64 {
    let delta = to.n - from.n;
    let (a0, a1) = (from.worn.amplitude, to.worn.amplitude);
    6.0 * (2.0 * (a0 - a1) / delta + from.amplitude_slope() + to.amplitude_slope()) / (delta * delta)
}

/// The end of a step moved by a correction of its depths, by derivatives; `None` where these change too much along it, or a contact may
/// change its state.
///
/// The correction is δ = t (h₁ − h₀) + δ⊥. Along the step J changes by t (J₁ − J₀), which is taken into account and unknown to the second
/// order in t; across it the change is unknown, and alters the equations of the step by Δ/12 (J₁ − J₀) δ⊥ or so, by f′ = J f.
fn corrected(
    states: &WornStates<'_>,
    from: &LifeState,
    to: &LifeState,
    correction: &[f64],
    delta: f64,
    tolerance: f64,
) -> Result<Option<LifeState>> {
    let count = correction.len();
    if from.worn.changes(&to.worn) {
        return Ok(None);
    }
    let mut turned = try_copy(&to.worn.rate_by_depth, CONTEXT)?;
    for (x, before) in turned.iter_mut().zip(&from.worn.rate_by_depth) {
        *x -= before;
    }
    let (mut along, mut square) = (0.0, 0.0);
    for ((c, h), before) in correction.iter().zip(&to.depths).zip(&from.depths) {
        along += c * (h - before);
        square += (h - before) * (h - before);
    }
    let share = if square > 0.0 { along / square } else { 0.0 };
    let mut parts = [try_copy(correction, CONTEXT)?, try_copy(correction, CONTEXT)?];
    for (k, c) in correction.iter().enumerate() {
        let own = share * (to.depths[k] - from.depths[k]);
        (parts[0][k], parts[1][k]) = (share.abs() * own, c - own);
    }
    for part in &parts {
        let mut unknown = times(&turned, part)?;
        for x in &mut unknown {
            *x *= delta / 12.0;
        }
        // Corrected by derivatives, not solved again: their secant takes about half of it away, which leaves what is negligible.
        if to.size_of(states, &unknown) > 2.0 * LIFE_NEGLIGIBLE * tolerance {
            return Ok(None);
        }
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
    let mut moved = to.clone();
    let worn = &mut moved.worn;
    for (k, &c) in correction.iter().enumerate() {
        moved.depths[k] += c;
        worn.amplitude += c * worn.amplitude_by_depth[k];
        worn.omega += c * worn.omega_by_depth[k];
        for j in 0..count {
            let at = k * count + j;
            let bent = to.worn.work_by_depth[at] - from.worn.work_by_depth[at];
            worn.rate[j] += c * (to.worn.rate_by_depth[at] + 0.5 * share * turned[at]);
            worn.works[j] += c * (to.worn.work_by_depth[at] + 0.5 * share * bent);
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

/// Depths at a distance `delta` from the end of the last step, provided that no contact changes its state: the Taylor
/// series of f′ = J f, where J continues along the line through its values at both ends of that step.
pub(crate) fn ahead(at: &LifeState, last: Option<&LifeStep>, delta: f64) -> Result<Vec<f64>> {
    let jacobian = &at.worn.rate_by_depth;
    let mut slope = try_vec(jacobian.len(), 0.0, CONTEXT)?;
    if let Some(step) = last {
        for (x, (j, before)) in slope.iter_mut().zip(jacobian.iter().zip(&step.from.worn.rate_by_depth)) {
            *x = (j - before) / step.length();
        }
    }
    // With f = Σ f_k tᵏ: (k + 1) f_{k+1} = J f_k + J′ f_{k−1}, and the depths are the integral. Where rates change by more than their size
    // the series is made anew, part by part.
    let count = at.depths.len();
    let mut there = try_copy(jacobian, CONTEXT)?;
    crate::linalg::add_product(delta, &slope, &[1.0], &mut there);
    let size = largest_row(jacobian, count)?.max(largest_row(&there, count)?) * delta;
    // A NaN gives one part.
    let parts = size.min(LIFE_STEP_PARTS as f64).ceil().max(1.0);
    let length = delta / parts;
    let mut here = there;
    let mut depths = try_copy(&at.depths, CONTEXT)?;
    let mut rate = try_copy(&at.worn.rate, CONTEXT)?;
    for part in 0..parts as usize {
        let distance = part as f64 * length;
        for (x, (j, by)) in here.iter_mut().zip(jacobian.iter().zip(&slope)) {
            *x = j + distance * by;
        }
        let mut term = try_copy(&rate, CONTEXT)?;
        let mut before = try_vec(count, 0.0, CONTEXT)?;
        let mut power = 1.0;
        rate.fill(0.0);
        for k in 0..LIFE_STEP_TERMS {
            for ((h, rate), f) in depths.iter_mut().zip(&mut rate).zip(&term) {
                *h += f * power * length / (k + 1) as f64;
                *rate += f * power;
            }
            let mut next = times(&here, &term)?;
            crate::linalg::add_product(1.0, &slope, &before, &mut next);
            for x in &mut next {
                *x /= (k + 1) as f64;
            }
            before = core::mem::replace(&mut term, next);
            power *= length;
        }
    }
    Ok(depths)
}

/// Largest sum of the moduli of a row.
fn largest_row(matrix: &[f64], count: usize) -> Result<f64> {
    let mut sums = try_vec(count, 0.0, CONTEXT)?;
    for column in matrix.chunks_exact(count.max(1)) {
        for (sum, x) in sums.iter_mut().zip(column) {
            *sum += x.abs();
        }
    }
    Ok(sums.iter().fold(0.0, |most, sum| most.max(*sum)))
}
