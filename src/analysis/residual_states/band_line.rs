//! The band of one free slider: solutions from one limit of its friction to the other, with every extremum between.

use crate::analysis::residual_states::held_sliders::{HeldSliders, HeldState};
use crate::error::{Result, try_push};
use crate::roots::Bracket;

const CONTEXT: &str = "the states of a band";

/// Steps over the width that the margins foretell at the first state.
/// Kind: tuned; measured on: not recorded.
const BAND_LINE_STEPS: f64 = 12.0;

/// Smallest step, over that width.
/// Kind: tuned; measured on: not recorded.
const BAND_LINE_SMALLEST: f64 = 1e-5;

/// Margin, over the mean limit, of a slider at its limit.
/// Kind: rounding.
const BAND_LINE_AT_LIMIT: f64 = 1e-11;

/// Steps of the search for a limit, of that for an extremum, and states in one direction.
/// Kind: cap.
const MOST_SECANTS: usize = 30;
const MOST_STATES: usize = 400;

/// Change of the place of an extremum, over the width, at which it is found.
/// Kind: rounding.
const BAND_LINE_SETTLED: f64 = 1e-8;

/// Slope, as a relative change of the result over the width, that is rounding.
/// Kind: rounding.
const FLAT: f64 = 1e-9;

/// Halvings of an interval whose cubic has extrema between its ends.
/// Kind: cap.
const BAND_LINE_HALVINGS: usize = 5;

/// States in the order of the place of one free slider, from limit to limit.
pub(crate) struct Line {
    pub states: Vec<HeldState>,
    /// Whether both limits were reached.
    pub is_complete: bool,
    /// Number of solutions that were computed.
    pub solved: usize,
}

/// Distance of the slider's place from its limit, in the direction `sign`, by the margins at a state; infinite where
/// none approaches zero.
fn distance(state: &HeldState, sign: f64) -> f64 {
    let to_limit = state.margins.iter().map(|m| {
        let rate = sign * m.gradient[0];
        if rate < 0.0 {
            m.value.max(0.0) / -rate
        } else {
            f64::INFINITY
        }
    });
    to_limit.fold(f64::INFINITY, f64::min)
}

/// The place of the slider at which the least margin vanishes, by its slope; `None` without a slope.
fn limit_place(state: &HeldState) -> Option<f64> {
    let least = state.margins.iter().min_by(|a, b| a.share().total_cmp(&b.share()))?;
    Some(state.places[0] - least.value / least.gradient[0])
}

/// The states from one limit of the slider to the other, through a first state between them.
///
/// # Errors
/// Those of [`HeldSliders::solve`] other than a missing solution.
pub(crate) fn line(held: &HeldSliders<'_>, first: HeldState) -> Result<Line> {
    let width = distance(&first, 1.0) + distance(&first, -1.0);
    let mut line = Line {
        states: Vec::new(),
        is_complete: false,
        solved: 0,
    };
    if !(width > 0.0 && width.is_finite()) {
        try_push(&mut line.states, first, CONTEXT)?;
        return Ok(line);
    }
    let mut walk = LineWalk { held, width, solved: 0 };
    let first = walk.within(first)?;
    let (mut below, reached_below) = walk.up_to_limit(&first, -1.0)?;
    let (mut above, reached_above) = walk.up_to_limit(&first, 1.0)?;
    below.reverse();
    let mut states = below;
    if first.least_margin() >= -BAND_LINE_AT_LIMIT || states.is_empty() {
        try_push(&mut states, first, CONTEXT)?;
    }
    states.append(&mut above);
    line.states = walk.with_extrema(states)?;
    line.is_complete = reached_below && reached_above;
    line.solved = walk.solved;
    Ok(line)
}

struct LineWalk<'h, 'a> {
    held: &'h HeldSliders<'a>,
    width: f64,
    solved: usize,
}

impl LineWalk<'_, '_> {
    fn solve(&mut self, place: f64, from: &HeldState) -> Result<Option<HeldState>> {
        self.solved += 1;
        self.held.find(&[place], from)
    }

    /// The state at a limit, for a state that rounding has left beyond it.
    fn within(&mut self, mut state: HeldState) -> Result<HeldState> {
        for _ in 0..MOST_SECANTS {
            if state.least_margin() >= -0.5 * BAND_LINE_AT_LIMIT {
                break;
            }
            let Some(place) = limit_place(&state) else { break };
            match self.solve(place, &state)? {
                Some(next) => state = next,
                None => break,
            }
        }
        Ok(state)
    }

    /// The states after the first one up to the limit in one direction; and whether that limit was reached.
    fn up_to_limit(&mut self, first: &HeldState, sign: f64) -> Result<(Vec<HeldState>, bool)> {
        let mut states: Vec<HeldState> = Vec::new();
        let mut step = self.width / BAND_LINE_STEPS;
        let mut last = first.clone();
        while states.len() < MOST_STATES {
            if last.least_margin() <= BAND_LINE_AT_LIMIT && distance(&last, sign) <= BAND_LINE_SETTLED * self.width {
                return Ok((states, true));
            }
            let Some(next) = self.solve(last.places[0] + sign * step, &last)? else {
                step *= 0.5;
                if step < BAND_LINE_SMALLEST * self.width {
                    return Ok((states, false));
                }
                continue;
            };
            if next.least_margin() < 0.0 {
                // Beyond the limit: the last state is within it, or at it.
                if let Some(edge) = self.limit_between(&last, next)? {
                    try_push(&mut states, edge, CONTEXT)?;
                    return Ok((states, true));
                }
                step *= 0.5;
                if step < BAND_LINE_SMALLEST * self.width {
                    return Ok((states, false));
                }
                continue;
            }
            step = (1.5 * step).min(self.width / BAND_LINE_STEPS);
            try_push(&mut states, next.clone(), CONTEXT)?;
            last = next;
        }
        Ok((states, false))
    }

    /// The state at the limit, between a state within it and one beyond: Newton's method on the least margin, kept
    /// within the bracket.
    fn limit_between(&mut self, within: &HeldState, beyond: HeldState) -> Result<Option<HeldState>> {
        let (mut low, mut high) = (within.clone(), beyond);
        let mut guess = high.clone();
        for _ in 0..MOST_SECANTS {
            let margin = guess.least_margin();
            if margin.abs() <= BAND_LINE_AT_LIMIT {
                return Ok(Some(guess));
            }
            if margin > 0.0 {
                low = guess.clone();
            } else {
                high = guess.clone();
            }
            let Some(mut place) = limit_place(&guess) else {
                return Ok(None);
            };
            let [a, b] = [low.places[0], high.places[0]];
            if place.is_nan() || (place - a) * (place - b) >= 0.0 {
                place = 0.5 * (a + b);
            }
            if (place - a).abs() == 0.0 || (place - b).abs() == 0.0 {
                return Ok(Some(low));
            }
            let Some(next) = self.solve(place, &guess)? else {
                return Ok(None);
            };
            guess = next;
        }
        Ok(Some(low))
    }

    /// The states, with the extrema of the result inserted between them.
    fn with_extrema(&mut self, states: Vec<HeldState>) -> Result<Vec<HeldState>> {
        let mut all: Vec<HeldState> = Vec::new();
        for state in states {
            if let Some(last) = all.last().cloned() {
                self.between(&last, &state, BAND_LINE_HALVINGS, &mut all)?;
            }
            try_push(&mut all, state, CONTEXT)?;
        }
        Ok(all)
    }

    fn between(&mut self, a: &HeldState, b: &HeldState, halvings: usize, all: &mut Vec<HeldState>) -> Result<()> {
        let length = b.places[0] - a.places[0];
        if length.abs() <= BAND_LINE_SETTLED * self.width {
            return Ok(());
        }
        // A result that does not depend on the place has slopes of rounding.
        let flat = FLAT * a.value.abs().max(b.value.abs()) / self.width;
        let slope = |of: &HeldState| {
            if of.gradient[0].abs() <= flat {
                0.0
            } else {
                of.gradient[0]
            }
        };
        let (da, db) = (slope(a), slope(b));
        let secant = (b.value - a.value) / length;
        if da * db < 0.0 {
            if let Some(extremum) = self.extremum(a, b)? {
                try_push(all, extremum, CONTEXT)?;
            }
            return Ok(());
        }
        // A cubic with these values and slopes has extrema between only if its slope changes its sign there: the slope at
        // the middle tells it.
        let middle = 1.5 * secant - 0.25 * (da + db);
        if (da == 0.0 && db == 0.0) || halvings == 0 || (secant * da > 0.0 && middle * da > 0.0) {
            return Ok(());
        }
        let Some(half) = self.solve(a.places[0] + 0.5 * length, a)? else {
            return Ok(());
        };
        self.between(a, &half, halvings - 1, all)?;
        try_push(all, half.clone(), CONTEXT)?;
        self.between(&half, b, halvings - 1, all)
    }

    /// The state between two others at which the slope of the result is zero.
    fn extremum(&mut self, a: &HeldState, b: &HeldState) -> Result<Option<HeldState>> {
        let mut bracket = Bracket::between((a.places[0], a.gradient[0]), (b.places[0], b.gradient[0]));
        let mut found: Option<HeldState> = None;
        let mut from = a.clone();
        for _ in 0..MOST_SECANTS {
            let place = bracket.guess();
            let Some(next) = self.solve(place, &from)? else {
                return Ok(found);
            };
            let slope = next.gradient[0];
            let settled = slope == 0.0 || bracket.narrow(place, slope) <= BAND_LINE_SETTLED * self.width;
            from = next.clone();
            found = Some(next);
            if settled {
                break;
            }
        }
        Ok(found)
    }
}
