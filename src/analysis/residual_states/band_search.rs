//! The band of several free sliders: steps to the best place that the linearised margins allow, within a radius that grows with success.
//!
//! In units of the distances over which the sliders could be dragged, a step is the projection of a long step along the gradient onto
//! the half-spaces gᵢ + ∇gᵢ·d ≥ 0 and a box. It is taken where result and margins together gain what the linear model foretells;
//! a bound that is found is one that a motion attains.

use crate::analysis::residual_states::held_sliders::{HeldSliders, HeldState};
use crate::error::{Result, try_copy, try_push, try_vec};

const CONTEXT: &str = "the search of a band";

/// First radius of a step, its largest, and the smallest, which ends the search; in units of the sliders' distances.
/// Kind: tuned; measured on: not recorded.
const BAND_SEARCH_FIRST: f64 = 0.3;
const BAND_SEARCH_LARGEST: f64 = 1.0;
const BAND_SEARCH_SMALLEST: f64 = 1e-5;

/// Share of the foretold gain that is enough, growth after success and shrinking after failure.
/// Kind: tuned; measured on: not recorded.
const BAND_SEARCH_ENOUGH: f64 = 0.1;
const BAND_SEARCH_GROWTH: f64 = 2.0;
const SHRINKING: f64 = 0.35;

/// Steps of one search.
/// Kind: cap.
const BAND_SEARCH_MOST_STEPS: usize = 80;

/// Foretold gain, relative to the result, that ends a search.
/// Kind: rounding.
const BAND_SEARCH_SETTLED: f64 = 1e-9;

/// Beyond a limit, over its mean, that counts as within: rounding of a solution.
/// Kind: rounding.
const WITHIN: f64 = 1e-10;

/// Rounds of the projection.
/// Kind: cap.
const BAND_SEARCH_ROUNDS: usize = 400;

/// An end of the band that a search found.
pub(crate) struct Found {
    pub state: HeldState,
    /// Relative gain that the linear model still foretells for a step of a tenth of the sliders' distances.
    pub gain: f64,
}

/// Search for both ends of a band with several free sliders.
pub(crate) struct BandSearch<'h, 'a> {
    pub held: &'h HeldSliders<'a>,
    /// Units of the places: distances over which the sliders can be dragged.
    pub units: Vec<f64>,
    /// Number of solutions that were computed.
    pub solved: usize,
}

impl BandSearch<'_, '_> {
    fn solve(&mut self, places: &[f64], from: &HeldState) -> Result<Option<HeldState>> {
        self.solved += 1;
        self.held.find(places, from)
    }

    /// The best step from a state by the linear model: along the objective's gradient times `sign` or, with `sign` =
    /// 0, the shortest step to within the limits. In units of the sliders' distances.
    fn step(&self, state: &HeldState, sign: f64, radius: f64) -> Result<Vec<f64>> {
        let n = self.units.len();
        let mut step = try_vec(n, 0.0, CONTEXT)?;
        let mut size = 0.0_f64;
        for (j, x) in step.iter_mut().enumerate() {
            *x = sign * state.gradient[j] * self.units[j];
            size = size.max(x.abs());
        }
        if size > 0.0 {
            // Far beyond the box, so that its projection is the best point of it but for a rounded corner.
            for x in &mut step {
                *x *= 100.0 * radius / size;
            }
        }
        project(&mut step, state, &self.units, radius)?;
        Ok(step)
    }

    fn foretold(&self, state: &HeldState, sign: f64, step: &[f64]) -> f64 {
        let terms = step.iter().zip(&state.gradient).zip(&self.units);
        sign * terms.map(|((d, g), unit)| d * g * unit).sum::<f64>()
    }

    fn moved(&self, state: &HeldState, step: &[f64]) -> Result<Vec<f64>> {
        let mut places = try_copy(&state.places, CONTEXT)?;
        for ((place, d), unit) in places.iter_mut().zip(step).zip(&self.units) {
            *place += d * unit;
        }
        Ok(places)
    }

    /// Moves a state to within the limits; `None` where that fails.
    pub fn within(&mut self, mut state: HeldState) -> Result<Option<HeldState>> {
        for _ in 0..12 {
            if state.least_margin() >= -WITHIN {
                return Ok(Some(state));
            }
            let step = self.step(&state, 0.0, BAND_SEARCH_LARGEST)?;
            let Some(next) = self.solve(&self.moved(&state, &step)?, &state)? else {
                return Ok(None);
            };
            state = next;
        }
        Ok((state.least_margin() >= -1e3 * WITHIN).then_some(state))
    }

    /// Another start: moves from a state along a direction, in units of the sliders' distances, as far as the limits
    /// allow, in a few steps.
    pub fn far(&mut self, from: &HeldState, direction: &[f64]) -> Result<Option<HeldState>> {
        let mut state = from.clone();
        for _ in 0..4 {
            let mut step = try_copy(direction, CONTEXT)?;
            project(&mut step, &state, &self.units, 0.5)?;
            match self.solve(&self.moved(&state, &step)?, &state)? {
                Some(next) => state = next,
                None => break,
            }
        }
        self.within(state)
    }

    /// The largest (`sign` 1) or smallest (−1) result that is found from a start within the limits.
    pub fn climb(&mut self, start: HeldState, sign: f64) -> Result<Found> {
        self.climb_from(start, sign, BAND_SEARCH_FIRST)
    }

    /// The largest (`sign` 1) or smallest (−1) result from a start within the limits; `first` is the radius of the
    /// first step, in units of the sliders' distances.
    pub fn climb_from(&mut self, start: HeldState, sign: f64, first: f64) -> Result<Found> {
        let mut state = start;
        let mut radius = first;
        let mut best = state.clone();
        for _ in 0..BAND_SEARCH_MOST_STEPS {
            let step = self.step(&state, sign, radius)?;
            let foretold = self.foretold(&state, sign, &step);
            let violated = (-state.least_margin()).max(0.0);
            if radius < BAND_SEARCH_SMALLEST
                || (foretold < BAND_SEARCH_SETTLED * state.value.abs() && violated < WITHIN)
            {
                break;
            }
            let next = self.solve(&self.moved(&state, &step)?, &state)?;
            let Some(next) = next else {
                radius *= SHRINKING;
                continue;
            };
            // Curvature takes a step beyond the limits; a second step brings it back.
            let within = if next.least_margin() < -WITHIN {
                self.within(next)?
            } else {
                Some(next)
            };
            let Some(next) = within else {
                radius *= SHRINKING;
                continue;
            };
            let gain = sign * (next.value - state.value);
            if gain < BAND_SEARCH_ENOUGH * foretold {
                radius *= SHRINKING;
                if gain > 0.0 {
                    state = next;
                }
            } else {
                radius = (BAND_SEARCH_GROWTH * radius).min(BAND_SEARCH_LARGEST);
                state = next;
            }
            if sign * (state.value - best.value) > 0.0 {
                best = state.clone();
            }
        }
        let step = self.step(&best, sign, 0.1)?;
        let gain = self.foretold(&best, sign, &step).max(0.0) / best.value.abs().max(f64::MIN_POSITIVE);
        Ok(Found { state: best, gain })
    }
}

/// Projects a step onto the half-spaces of the linearised margins and a box of the given radius, by Dykstra's method
/// (Boyle & Dykstra 1986).
fn project(step: &mut [f64], state: &HeldState, units: &[f64], radius: f64) -> Result<()> {
    struct Half {
        normal: Vec<f64>,
        square: f64,
        level: f64,
        multiplier: f64,
    }
    let mut halves: Vec<Half> = Vec::new();
    for margin in &state.margins {
        let mut normal = try_copy(&margin.gradient, CONTEXT)?;
        for (x, unit) in normal.iter_mut().zip(units) {
            *x *= unit / margin.size();
        }
        let square = normal.iter().map(|x| x * x).sum::<f64>();
        if square > 0.0 {
            let half = Half {
                normal,
                square,
                level: -margin.share(),
                multiplier: 0.0,
            };
            try_push(&mut halves, half, CONTEXT)?;
        }
    }
    let mut of_box = try_vec(step.len(), 0.0, CONTEXT)?;
    for _ in 0..BAND_SEARCH_ROUNDS {
        let mut change = 0.0_f64;
        for half in &mut halves {
            let along = half.normal.iter().zip(&*step).map(|(n, d)| n * d).sum::<f64>();
            let more = ((half.level - along) / half.square).max(-half.multiplier);
            half.multiplier += more;
            for (d, n) in step.iter_mut().zip(&half.normal) {
                *d += more * n;
                change = change.max((more * n).abs());
            }
        }
        for (d, of_box) in step.iter_mut().zip(&mut of_box) {
            let free = *d + *of_box;
            let clamped = free.clamp(-radius, radius);
            change = change.max((clamped - *d).abs());
            *of_box = free - clamped;
            *d = clamped;
        }
        if change < 1e-12 * radius {
            break;
        }
    }
    Ok(())
}
