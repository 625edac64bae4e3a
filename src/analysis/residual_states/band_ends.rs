//! The ends of a band as solutions of the model: contacts that stick there are free, too, other states of the model may lie beyond, and
//! with a tolerance more harmonics tell the error.

use crate::analysis::forced_response::forced_response;
use crate::analysis::residual_states::band_corners::BAND_CORNERS_DISTANCES;
use crate::analysis::residual_states::band_growth::{Grown, grown};
use crate::analysis::residual_states::band_refinement::{Refinement, refined};
use crate::analysis::residual_states::band_result::{Band, BandEnd, BandOptions, BandState};
use crate::analysis::residual_states::band_starts::{Starts, climbed, within_limits};
use crate::analysis::residual_states::held_sliders::{BandOf, HeldSliders, HeldState};
use crate::analysis::residual_states::stuck_contacts::StuckSlider;
use crate::condense::{Condensed, Reference, Resolution};
use crate::error::{Result, try_copy, try_push};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::options::ForcedOptions;
use crate::results::{Branch, Recovery};
use std::sync::Arc;

const CONTEXT: &str = "the ends of a band";

/// Margin, over the mean limit, at which a contact is at its limit.
/// Kind: rounding.
const BAND_AT_LIMIT: f64 = 1e-6;

/// Gain that the linear model foretells at an extremum, relative to the result.
/// Kind: tuned; measured on: not recorded.
const BAND_FORETOLD: f64 = 1e-4;

/// Times that contacts which stick at an end, but not at the state before, are set free.
/// Kind: cap.
const BAND_GROWTHS: usize = 8;

/// Other states of the model for each start, from which the search begins where other contacts stick in them.
/// Kind: tuned; measured on: not recorded.
const BAND_STATES_PER_START: usize = 2;

/// Shares of the distances of the sliders by which those that are not at their limits go on beyond an end.
/// Kind: tuned; measured on: not recorded.
const BAND_BEYOND: [f64; 2] = [0.05, 0.3];

/// Senses of the searches of both ends.
/// Kind: fixed.
const BAND_SENSES: [f64; 2] = [-1.0, 1.0];

/// Relative gain with which a search from another state betters an end.
/// Kind: rounding.
const BAND_BETTER: f64 = 1e-9;

/// Relative difference of an end from the solution of the model with its places.
/// Kind: rounding.
const BAND_SAME: f64 = 1e-6;

/// A band whose ends are states with held sliders, before they are solved on the model itself.
pub(crate) struct Begun {
    pub band: Band,
    /// States with the least and the largest result.
    pub ends: [HeldState; 2],
    /// With one free slider, the states at its two limits, which are the first and the last state of the band; `None`
    /// where a limit was not reached.
    pub edges: Option<[HeldState; 2]>,
    /// Whether no slider is free at the point, so that only places far from it can change the vibration.
    pub is_stuck: bool,
}

/// An end of a band, with the sliders that are free at this end.
struct Reached<'a> {
    end: BandEnd,
    /// The end with its own free sliders or harmonics, where these differ from those of the point; else `None`.
    own: Option<Grown<'a>>,
    is_settled: bool,
}

/// The end reached from a state when the contacts that stick at that state are free, too. The state is `own`, or one
/// of the point's sliders with the gain that its search has foretold.
fn reached<'a>(
    base: (&HeldSliders<'a>, &HeldState, f64),
    mut own: Option<Grown<'a>>,
    free: (&[usize], f64),
    interrupt: &'a Interrupt<'a>,
    solved: &mut usize,
) -> Result<Reached<'a>> {
    let mut end = match &own {
        Some(own) => attained(&own.held, &own.state, own.gain, interrupt)?,
        None => attained(base.0, base.1, base.2, interrupt)?,
    };
    let mut grew = true;
    for _ in 0..BAND_GROWTHS {
        let (held, at) = own.as_ref().map_or((base.0, base.1), |own| (&*own.held, &own.state));
        let more = match &end.branch {
            Some(branch) => grown(held, (at, branch), free, interrupt)?,
            None => None,
        };
        grew = more.is_some();
        let Some(more) = more else { break };
        *solved += more.solved;
        let next = attained(&more.held, &more.state, more.gain, interrupt)?;
        if !is_solution(&next) {
            break;
        }
        end = next;
        own = Some(more);
    }
    Ok(Reached {
        is_settled: !grew && end.gain < BAND_FORETOLD && is_solution(&end),
        end,
        own,
    })
}

/// Whether an end was confirmed as a solution of the model.
fn is_solution(end: &BandEnd) -> bool {
    let found = end.branch.as_ref().map(|branch| branch.stored_amplitude(0));
    found.is_some_and(|amplitude| (amplitude - end.amplitude).abs() <= BAND_SAME * end.amplitude)
}

/// Improves both ends by searches from other states of the model, in which other contacts may stick.
fn from_other_states<'a>(
    held: &HeldSliders<'a>,
    (branch, point): (&Branch, usize),
    options: &BandOptions<'_>,
    (begun, ends): (&Begun, &mut [Reached<'a>; 2]),
    interrupt: &'a Interrupt<'a>,
) -> Result<usize> {
    let mut solved = 0;
    let mut starts = Starts::new(held, (branch, point), options.contacts, interrupt)?;
    if starts.sliders() == held.sliders.len() && held.sliders.len() == 1 && !begun.is_stuck {
        // All of its states are known.
        return Ok(0);
    }
    let mut known: Vec<Vec<(usize, usize)>> = Vec::new();
    if !begun.is_stuck {
        try_push(&mut known, pairs(&held.sliders)?, CONTEXT)?;
    }
    for own in ends.iter().filter_map(|end| end.own.as_ref()) {
        try_push(&mut known, pairs(&own.held.sliders)?, CONTEXT)?;
    }
    let placed = BAND_STATES_PER_START * options.starts;
    let of_point = begun.is_stuck.then_some((&begun.ends[0], &held.sliders[..]));
    let corners = starts.corners(of_point, options.starts)?;
    let beyond = if begun.is_stuck { 0 } else { 2 * BAND_BEYOND.len() };
    let distances = BAND_CORNERS_DISTANCES.len();
    for number in 0..placed + beyond + distances * corners.len() {
        let corner = number.checked_sub(placed + beyond);
        let corner = corner.map(|k| (&corners[k / distances], BAND_CORNERS_DISTANCES[k % distances]));
        let found = if let Some((signs, distance)) = corner {
            starts.corner(signs, distance)?
        } else if let Some(k) = number.checked_sub(placed) {
            let (k, share) = (k / BAND_BEYOND.len(), BAND_BEYOND[k % BAND_BEYOND.len()]);
            let own = ends[k].own.as_ref();
            let end = own.map_or((held, &begun.ends[k]), |own| (&*own.held, &own.state));
            starts.beyond(end, (BAND_SENSES[k], share))?
        } else {
            starts.state(number)?
        };
        let Some((branch, sliders)) = found else { continue };
        let value = branch.stored_amplitude(0);
        let is_beyond = held.of == BandOf::Amplitude
            && !(ends[0].end.value * (1.0 - BAND_BETTER)..=ends[1].end.value * (1.0 + BAND_BETTER)).contains(&value);
        if sliders.is_empty() {
            // A motion without a free slider is an end by itself; its places are those of all that were placed.
            if let Some((signs, distance)) = corner.filter(|_| is_beyond) {
                let mut places = Vec::new();
                for pair in pairs(&held.sliders)? {
                    let place = starts.corner_place(pair, signs, distance);
                    try_push(&mut places, place.unwrap_or(f64::NAN), CONTEXT)?;
                }
                let best = &mut ends[usize::from(value > ends[1].end.value)];
                *best = Reached {
                    end: alone(branch, places),
                    own: None,
                    is_settled: false,
                };
            }
            continue;
        }
        let free = pairs(&sliders)?;
        let is_new = !known.contains(&free);
        if !(is_new || is_beyond) {
            continue;
        }
        if is_new {
            try_push(&mut known, free, CONTEXT)?;
        }
        let Some((own, first)) = within_limits(held, &branch, sliders, interrupt)? else {
            continue;
        };
        for (best, sign) in ends.iter_mut().zip(BAND_SENSES) {
            let found = climbed(&own, &first, sign)?;
            solved += found.solved;
            let gain = sign * (found.state.value - best.end.value);
            if gain > BAND_BETTER * best.end.value.abs() {
                let base = (&*own, &first, 0.0);
                let next = reached(base, Some(found), (options.contacts, sign), interrupt, &mut solved)?;
                if is_solution(&next.end) {
                    *best = next;
                }
            }
        }
    }
    Ok(solved + starts.solved)
}

/// A motion of the model without free sliders, as an end of the band.
fn alone(branch: Branch, places: Vec<f64>) -> BandEnd {
    let amplitude = branch.stored_amplitude(0);
    BandEnd {
        value: amplitude,
        omega: branch.omega_at(0).unwrap_or(f64::NAN),
        amplitude,
        places,
        at_limit: Vec::new(),
        gain: f64::NAN,
        error: f64::NAN,
        branch: Some(branch),
    }
}

/// Pairs (contact, direction) of sliders.
fn pairs(sliders: &[StuckSlider]) -> Result<Vec<(usize, usize)>> {
    let mut pairs = Vec::new();
    for slider in sliders {
        try_push(&mut pairs, (slider.contact, slider.direction), CONTEXT)?;
    }
    Ok(pairs)
}

/// The ends as solutions of the model, each with those contacts free that stick at the end.
pub(crate) fn with_ends<'a>(
    held: &HeldSliders<'a>,
    mut begun: Begun,
    at: (&Branch, usize),
    options: &BandOptions<'_>,
    refinement: Option<Refinement>,
    interrupt: &'a Interrupt<'a>,
) -> Result<Band> {
    let mut solved = 0;
    let mut end = |k: usize, gain: f64| {
        let base = (held, &begun.ends[k], gain);
        reached(base, None, (options.contacts, BAND_SENSES[k]), interrupt, &mut solved)
    };
    let (lower, upper) = (begun.band.lower.gain, begun.band.upper.gain);
    let mut ends = [end(0, lower)?, end(1, upper)?];
    solved += from_other_states(held, at, options, (&begun, &mut ends), interrupt)?;
    if begun.is_stuck && ends.iter().all(|end| end.own.is_none() && !end.end.gain.is_nan()) {
        // No other state was found.
        begun.band.sliders.clear();
        begun.band.solved += solved;
        return Ok(begun.band);
    }
    if let Some(refinement) = refinement {
        solved += refine(held, &mut begun, &mut ends, refinement, interrupt)?;
    }
    let mut band = begun.band;
    band.solved += solved;
    band.is_complete &= ends.iter().all(|end| end.is_settled);
    // The sliders of the point, and those that are free at an end alone.
    for own in ends.iter().filter_map(|end| end.own.as_ref()) {
        for pair in pairs(&own.held.sliders)? {
            if !band.sliders.contains(&pair) {
                try_push(&mut band.sliders, pair, CONTEXT)?;
            }
        }
    }
    for reached in &mut ends {
        let own = reached.own.as_ref().map_or(&held.sliders, |own| &own.held.sliders);
        // A slider that slips at an end forgets its place, which is that of the model.
        let mut places = Vec::new();
        for &(contact, direction) in &band.sliders {
            let found = own
                .iter()
                .position(|s| (s.contact, s.direction) == (contact, direction));
            let place = found.map_or(held.model.contacts()[contact].slider()[direction], |j| {
                reached.end.places[j]
            });
            try_push(&mut places, place, CONTEXT)?;
        }
        reached.end.places = places;
    }
    let [lower, upper] = ends;
    (band.lower, band.upper) = (lower.end, upper.end);
    Ok(band)
}

/// Solves the ends, and the limits of a single free slider, with more harmonics; sets the errors of the ends.
fn refine<'a>(
    held: &HeldSliders<'a>,
    begun: &mut Begun,
    ends: &mut [Reached<'a>; 2],
    to: Refinement,
    interrupt: &'a Interrupt<'a>,
) -> Result<usize> {
    let mut solved = 0;
    // The coarse places, with which an end is recognised among the limits.
    let mut known: Vec<(f64, BandState)> = Vec::new();
    for (k, best) in ends.iter_mut().enumerate() {
        let own = best.own.as_ref();
        if own.is_none() && best.end.gain.is_nan() {
            continue;
        }
        let (base, state) = own.map_or((held, &begun.ends[k]), |own| (&*own.held, &own.state));
        let Some(finer) = refined(base, state, (BAND_SENSES[k], to), interrupt)? else {
            continue;
        };
        solved += finer.own.solved;
        let end = attained(&finer.own.held, &finer.own.state, finer.own.gain, interrupt)?;
        if !is_solution(&end) {
            continue;
        }
        if own.is_none() && held.sliders.len() == 1 {
            try_push(&mut known, (state.places[0], state_of(&finer.own.state)), CONTEXT)?;
        }
        best.is_settled &= end.gain < BAND_FORETOLD;
        best.end = BandEnd {
            error: finer.error,
            ..end
        };
        best.own = Some(finer.own);
    }
    let Some(edges) = &begun.edges else { return Ok(solved) };
    let last = begun.band.states.len() - 1;
    for (edge, outward) in edges.iter().zip(BAND_SENSES) {
        let place = edge.places[0];
        let same = known.iter().find(|one| one.0.to_bits() == place.to_bits());
        let finer = if let Some((_, state)) = same {
            Some(*state)
        } else {
            // Outwards the result grows or falls.
            let sign = if edge.gradient[0] * outward < 0.0 { -1.0 } else { 1.0 };
            let found = refined(held, edge, (sign, to), interrupt)?;
            solved += found.as_ref().map_or(0, |found| found.own.solved);
            found.map(|found| state_of(&found.own.state))
        };
        if let Some(state) = finer {
            begun.band.states[if outward < 0.0 { 0 } else { last }] = state;
        }
    }
    begun.band.states.sort_unstable_by(|a, b| a.place.total_cmp(&b.place));
    Ok(solved)
}

/// A state of one free slider in the form of the result.
pub(crate) fn state_of(state: &HeldState) -> BandState {
    BandState {
        place: state.places[0],
        value: state.value,
        derivative: state.gradient[0],
        omega: state.omega,
    }
}

/// An end of the band, solved on the model itself.
fn attained(held: &HeldSliders<'_>, state: &HeldState, gain: f64, interrupt: &Interrupt<'_>) -> Result<BandEnd> {
    let mut at_limit: Vec<usize> = Vec::new();
    for margin in &state.margins {
        if margin.value <= BAND_AT_LIMIT * margin.limit.abs() && !at_limit.contains(&margin.contact) {
            try_push(&mut at_limit, margin.contact, CONTEXT)?;
        }
    }
    let model = held.placed(held.model, &state.places)?;
    let guess = harmonics(held, state, interrupt)?;
    let responses = held.response.as_slice();
    let range = ForcedOptions {
        omega_start: state.omega,
        omega_stop: state.omega,
        guess: Some(&guess),
        responses,
        ..ForcedOptions::default()
    };
    // Progress of one point is none of the band.
    let branch = forced_response(&model, &held.solver, &range, &mut Hooks::default());
    Ok(BandEnd {
        value: state.value,
        omega: state.omega,
        amplitude: state.amplitude,
        places: try_copy(&state.places, CONTEXT)?,
        at_limit,
        gain,
        error: f64::NAN,
        branch: branch.ok(),
    })
}

/// The harmonics of all degrees of freedom in a state.
fn harmonics(
    held: &HeldSliders<'_>,
    state: &HeldState,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<num_complex::Complex64>> {
    let model = held.placed(&held.held, &state.places)?;
    let omega = state.omega;
    let reference = Some(Reference::Complex);
    let condensed = Condensed::with_reference(&model, &held.solver, (omega, omega), reference, interrupt)?;
    let mut u = try_copy(&state.motion, CONTEXT)?;
    for u in &mut u {
        *u /= condensed.length();
    }
    let resolution = Resolution {
        condensed: Arc::new(condensed),
        samples: held.solver.samples,
    };
    Recovery::of(&resolution, (&u, omega, 0.0), interrupt)?.all(held.solver.harmonics)
}
