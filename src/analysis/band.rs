//! The band of a forced response: the least and the largest result over the forces that contacts keep which stick through the period.

use crate::analysis::band_growth::{Grown, grown};
use crate::analysis::band_line::line;
use crate::analysis::band_search::Search;
use crate::analysis::band_starts::{Starts, climbed, within_limits};
use crate::analysis::forced_response::forced_response;
use crate::analysis::freedom::free_sliders;
use crate::analysis::held_sliders::{HeldSliders, HeldState};
use crate::analysis::stuck_contacts::StuckSlider;
use crate::condense::{Condensed, Reference, Resolution};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::{ForcedOptions, SolverOptions};
use crate::results::{Branch, Recovery};
use std::sync::Arc;

pub use crate::analysis::held_sliders::BandOf;

const CONTEXT: &str = "the band of a response";

/// Margin, over the mean limit, at which a contact is at its limit.
const BAND_AT_LIMIT: f64 = 1e-6;

/// Most starts of a search.
const BAND_MOST_STARTS: usize = 1000;

/// Gain that the linear model foretells at an extremum, relative to the result.
const BAND_FORETOLD: f64 = 1e-4;

/// Times that contacts which stick at an end, but not at the state before, are set free.
const BAND_GROWTHS: usize = 8;

/// Other states of the model for each start, from which the search begins where other contacts stick in them.
const BAND_STATES_PER_START: usize = 2;

/// Shares of the distances of the sliders by which those that are not at their limits go on beyond an end.
const BAND_BEYOND: [f64; 2] = [0.05, 0.3];

/// Senses of the searches of both ends.
const BAND_SENSES: [f64; 2] = [-1.0, 1.0];

/// Relative gain with which a search from another state betters an end.
const BAND_BETTER: f64 = 1e-9;

/// Relative difference of an end from the solution of the model with its places.
const BAND_SAME: f64 = 1e-6;

/// Options of a band.
#[derive(Clone, Copy, Debug)]
pub struct BandOptions<'a> {
    /// The result that is bounded.
    pub of: BandOf,
    /// Contacts whose residual force is free; none: all that are.
    pub contacts: &'a [usize],
    /// Starts of the search with several free sliders, at least 1: the state of the branch, then others within the limits.
    pub starts: usize,
}

impl Default for BandOptions<'_> {
    fn default() -> Self {
        Self {
            of: BandOf::Amplitude,
            contacts: &[],
            starts: 3,
        }
    }
}

/// An end of a band.
#[derive(Debug)]
pub struct BandEnd {
    /// The result.
    pub value: f64,
    /// Its angular frequency.
    pub omega: f64,
    /// The amplitude there.
    pub amplitude: f64,
    /// Places of the free sliders, in the order of [`Band::sliders`].
    pub places: Vec<f64>,
    /// Contacts that are at the limit of their friction.
    pub at_limit: Vec<usize>,
    /// Relative gain that the linearised problem still foretells within a tenth of the distances over which the sliders can be
    /// dragged; 0 with one slider.
    pub gain: f64,
    /// The solution, as a branch of one point on the model with [`Model::set_slider`] of these places.
    pub branch: Option<Branch>,
}

/// A state on the way from one limit to the other, with one free slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandState {
    /// Place of the slider.
    pub place: f64,
    /// The result.
    pub value: f64,
    /// Its derivative by the place.
    pub derivative: f64,
    /// Its angular frequency.
    pub omega: f64,
}

/// A band.
#[derive(Debug)]
pub struct Band {
    /// Free sliders as (contact, direction); none: the response has no band. Those of the point, then those that stick at an end.
    pub sliders: Vec<(usize, usize)>,
    /// The least result found.
    pub lower: BandEnd,
    /// The largest result found.
    pub upper: BandEnd,
    /// With one free slider at the point the states from one of its limits to the other.
    pub states: Vec<BandState>,
    /// Whether one slider was followed to both of its limits, or every search of several ended at an extremum.
    pub is_complete: bool,
    /// Solutions that were computed.
    pub solved: usize,
}

/// The band of a stored point of a forced response: the least and the largest result over all places of the sliders that stick through
/// the period, with the states that attain them. The harmonics are those of the point. Contacts that stick at an end, but not at the
/// point, are free there, too: the search goes on from that end.
///
/// With one free slider all states from one limit of its friction to the other are followed, with every extremum between them. With
/// several, a search from each start goes to an extremum: the bounds are attained ones, beyond which others may lie.
///
/// # Errors
/// `Index` for an unknown point or contact, `Argument` for another model than that of the branch, options out of their range, or a
/// point that is no peak, `Unsupported` for a nonlinear mode; those of the solutions; `StoppedByCaller`; `OutOfMemory`.
pub fn band(
    model: &Model,
    branch: &Branch,
    point: usize,
    solver: &SolverOptions,
    options: &BandOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Band> {
    solver.check()?;
    check(model, branch, point, options)?;
    let interrupt = hooks.interrupt();
    let mut sliders = Vec::new();
    for (slider, _) in free_sliders(model, branch, point, &interrupt)? {
        if options.contacts.is_empty() || options.contacts.contains(&slider.contact) {
            try_push(&mut sliders, slider, CONTEXT)?;
        }
    }
    let omega = branch.omega_at(point).unwrap_or(f64::NAN);
    let amplitude = branch.stored_amplitude(point);
    if sliders.is_empty() {
        return Ok(without(options.of, omega, amplitude));
    }
    interrupt.phase(Phase::Results, 0.0)?;
    let condensed = branch.condensed_at(point);
    let response = branch.responses().first();
    let response = response
        .map(crate::results::ResponseSeries::response)
        .filter(|one| !one.is_plain());
    let solver = SolverOptions {
        samples: branch.samples_at(point),
        response_dof: Some(branch.response_dof()),
        stability: None,
        freedom: false,
        ..*solver
    };
    let highest = condensed.set().numbers().last().copied().unwrap_or(1);
    let held = HeldSliders::new(
        model,
        (&solver, highest),
        (branch.response_dof(), response),
        sliders,
        options.of,
        &interrupt,
    )?;
    let mut motion = try_copy(branch.motion_at(point).unwrap_or(&[]), CONTEXT)?;
    for u in &mut motion {
        *u *= condensed.length();
    }
    let first = held.first(condensed.set(), &motion, omega)?;
    let found = if held.sliders.len() == 1 {
        along(&held, first)?
    } else {
        searched(&held, first, options.starts)?
    };
    with_ends(&held, found, (branch, point), options, &interrupt)
}

/// An end with the sliders that are free there.
struct Reached<'a> {
    end: BandEnd,
    /// Where its free sliders are not those of the point.
    own: Option<Grown<'a>>,
    is_settled: bool,
}

/// The end that is reached from a state with the contacts free, too, that stick there; the state is `own`, or one of the sliders of
/// the point with what its search has foretold.
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

/// Whether an end was found again as a solution of the model.
fn is_solution(end: &BandEnd) -> bool {
    let found = end.branch.as_ref().map(|branch| branch.stored_amplitude(0));
    found.is_some_and(|amplitude| (amplitude - end.amplitude).abs() <= BAND_SAME * end.amplitude)
}

/// Betters both ends by searches from other states of the model, in which other contacts may stick.
fn from_other_states<'a>(
    held: &HeldSliders<'a>,
    (branch, point): (&Branch, usize),
    options: &BandOptions<'_>,
    (bases, ends): ([&HeldState; 2], &mut [Reached<'a>; 2]),
    interrupt: &'a Interrupt<'a>,
) -> Result<usize> {
    let mut solved = 0;
    let mut starts = Starts::new(held, (branch, point), options.contacts, interrupt)?;
    if starts.sliders() == held.sliders.len() && held.sliders.len() == 1 {
        // All of its states are known.
        return Ok(0);
    }
    let mut known: Vec<Vec<(usize, usize)>> = Vec::new();
    try_push(&mut known, pairs(&held.sliders)?, CONTEXT)?;
    for own in ends.iter().filter_map(|end| end.own.as_ref()) {
        try_push(&mut known, pairs(&own.held.sliders)?, CONTEXT)?;
    }
    let placed = BAND_STATES_PER_START * options.starts;
    for number in 0..placed + 2 * BAND_BEYOND.len() {
        let found = if let Some(k) = number.checked_sub(placed) {
            let (k, share) = (k / BAND_BEYOND.len(), BAND_BEYOND[k % BAND_BEYOND.len()]);
            let own = ends[k].own.as_ref();
            let end = own.map_or((held, bases[k]), |own| (&*own.held, &own.state));
            starts.beyond(end, (BAND_SENSES[k], share))?
        } else {
            starts.state(number)?
        };
        let Some((branch, sliders)) = found else { continue };
        if sliders.is_empty() {
            continue;
        }
        let free = pairs(&sliders)?;
        let is_new = !known.contains(&free);
        let value = branch.stored_amplitude(0);
        let is_beyond = held.of == BandOf::Amplitude && !(ends[0].end.value..=ends[1].end.value).contains(&value);
        if !(is_new || is_beyond) {
            continue;
        }
        if is_new {
            try_push(&mut known, free, CONTEXT)?;
        }
        let Some((own, first)) = within_limits(held, (&branch, sliders), interrupt)? else {
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

/// (contact, direction) of sliders.
fn pairs(sliders: &[StuckSlider]) -> Result<Vec<(usize, usize)>> {
    let mut pairs = Vec::new();
    for slider in sliders {
        try_push(&mut pairs, (slider.contact, slider.direction), CONTEXT)?;
    }
    Ok(pairs)
}

/// The ends as solutions of the model, each with the contacts free that stick there.
fn with_ends<'a>(
    held: &HeldSliders<'a>,
    (mut band, lower, upper): (Band, HeldState, HeldState),
    at: (&Branch, usize),
    options: &BandOptions<'_>,
    interrupt: &'a Interrupt<'a>,
) -> Result<Band> {
    let mut solved = 0;
    let gains = [band.lower.gain, band.upper.gain];
    let mut end = |state: &HeldState, k: usize| {
        let sign = if k == 0 { -1.0 } else { 1.0 };
        let base = (held, state, gains[k]);
        reached(base, None, (options.contacts, sign), interrupt, &mut solved)
    };
    let mut ends = [end(&lower, 0)?, end(&upper, 1)?];
    solved += from_other_states(held, at, options, ([&lower, &upper], &mut ends), interrupt)?;
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
            let place = found.map_or(held.model.contacts()[contact].slider[direction], |j| {
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

fn check(model: &Model, branch: &Branch, point: usize, options: &BandOptions<'_>) -> Result<()> {
    if options.starts == 0 || options.starts > BAND_MOST_STARTS {
        return fail!(Argument, "starts = {}, needs 1 .. {BAND_MOST_STARTS}", options.starts);
    }
    if let Some(contact) = options.contacts.iter().find(|c| **c >= model.contacts().len()) {
        return fail!(
            Index,
            "contacts has {contact}, but the model has {}",
            model.contacts().len()
        );
    }
    if options.of != BandOf::Amplitude && !branch.peaks().iter().any(|peak| peak.point == point) {
        return fail!(
            Argument,
            "point = {point} is no peak of the branch, whose band needs one"
        );
    }
    Ok(())
}

/// The band of a response without freedom.
fn without(of: BandOf, omega: f64, amplitude: f64) -> Band {
    let end = || BandEnd {
        value: if of == BandOf::PeakOmega { omega } else { amplitude },
        omega,
        amplitude,
        places: Vec::new(),
        at_limit: Vec::new(),
        gain: 0.0,
        branch: None,
    };
    Band {
        sliders: Vec::new(),
        lower: end(),
        upper: end(),
        states: Vec::new(),
        is_complete: true,
        solved: 0,
    }
}

/// A band without its ends.
fn begun(held: &HeldSliders<'_>, is_complete: bool, solved: usize) -> Result<Band> {
    let mut band = without(held.of, f64::NAN, f64::NAN);
    for slider in &held.sliders {
        try_push(&mut band.sliders, (slider.contact, slider.direction), CONTEXT)?;
    }
    (band.is_complete, band.solved) = (is_complete, solved);
    Ok(band)
}

fn along(held: &HeldSliders<'_>, first: HeldState) -> Result<(Band, HeldState, HeldState)> {
    let (mut low, mut high) = (first.clone(), first.clone());
    let line = line(held, first)?;
    let mut band = begun(held, line.is_complete, line.solved)?;
    for (i, state) in line.states.iter().enumerate() {
        if i == 0 || state.value < low.value {
            low = state.clone();
        }
        if i == 0 || state.value > high.value {
            high = state.clone();
        }
        let one = BandState {
            place: state.places[0],
            value: state.value,
            derivative: state.gradient[0],
            omega: state.omega,
        };
        try_push(&mut band.states, one, CONTEXT)?;
    }
    Ok((band, low, high))
}

fn searched(held: &HeldSliders<'_>, first: HeldState, starts: usize) -> Result<(Band, HeldState, HeldState)> {
    let units = held.distances(&first)?;
    let mut search = Search { held, units, solved: 0 };
    let (mut low, mut high): (HeldState, HeldState) = (first.clone(), first.clone());
    let mut gains = [f64::INFINITY; 2];
    let Some(within) = search.within(first)? else {
        let band = begun(held, false, search.solved)?;
        return Ok((band, low, high));
    };
    (low, high) = (within.clone(), within.clone());
    for start in 0..starts {
        held.interrupt.part(Phase::Results, start, starts)?;
        let from = if start == 0 {
            Some(within.clone())
        } else {
            let mut direction = try_vec(held.sliders.len(), 0.0, CONTEXT)?;
            for (j, d) in direction.iter_mut().enumerate() {
                // Signs without pattern, the opposite ones at the next start.
                let turn = 0.618_033_988_749_895 * (j as f64 + 1.0) * (1 + start.div_ceil(2)) as f64;
                let sign = if start % 2 == 1 { 1.0 } else { -1.0 };
                *d = sign * if turn.fract() < 0.5 { 1.0 } else { -1.0 };
            }
            search.far(&within, &direction)?
        };
        let Some(from) = from else { continue };
        for (k, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let found = search.climb(from.clone(), sign)?;
            let best = if k == 0 { &mut low } else { &mut high };
            if start == 0 || sign * (found.state.value - best.value) > 0.0 {
                gains[k] = found.gain;
                *best = found.state;
            }
        }
    }
    let mut band = begun(held, true, search.solved)?;
    (band.lower.gain, band.upper.gain) = (gains[0], gains[1]);
    Ok((band, low, high))
}

/// The end of a band as a solution of the model.
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
        branch: branch.ok(),
    })
}

/// The harmonics of all degrees of freedom of a state.
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
