//! The band of a forced response: the least and the largest result over the forces that contacts keep which stick through the period.

use crate::analysis::band_growth::{Grown, grown};
use crate::analysis::band_line::line;
use crate::analysis::band_search::Search;
use crate::analysis::forced_response::forced_response;
use crate::analysis::freedom::free_sliders;
use crate::analysis::held_sliders::{HeldSliders, HeldState};
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
    with_ends(&held, found, options, &interrupt)
}

/// The ends as solutions of the model, each with the contacts free that stick there.
fn with_ends<'a>(
    held: &HeldSliders<'a>,
    (mut band, lower, upper): (Band, HeldState, HeldState),
    options: &BandOptions<'_>,
    interrupt: &'a Interrupt<'a>,
) -> Result<Band> {
    for (sign, state) in [(-1.0, lower), (1.0, upper)] {
        let foretold = if sign < 0.0 { band.lower.gain } else { band.upper.gain };
        let mut end = attained(held, &state, foretold, interrupt)?;
        let mut grew = true;
        let mut last: Option<Grown<'a>> = None;
        for _ in 0..BAND_GROWTHS {
            let (own, at) = last.as_ref().map_or((held, &state), |last| (&last.held, &last.state));
            let more = match &end.branch {
                Some(branch) => grown(own, (at, branch), (options.contacts, sign), interrupt)?,
                None => None,
            };
            grew = more.is_some();
            let Some(more) = more else { break };
            band.solved += more.solved;
            end = attained(&more.held, &more.state, more.gain, interrupt)?;
            last = Some(more);
        }
        band.is_complete &= !grew && (last.is_none() || end.gain < BAND_FORETOLD);
        let own = last.as_ref().map_or(&held.sliders, |last| &last.held.sliders);
        for slider in own {
            let pair = (slider.contact, slider.direction);
            if !band.sliders.contains(&pair) {
                try_push(&mut band.sliders, pair, CONTEXT)?;
            }
        }
        // A slider that slips at an end forgets its place, which is that of the model.
        let mut places = Vec::new();
        for &(contact, direction) in &band.sliders {
            let found = own
                .iter()
                .position(|s| (s.contact, s.direction) == (contact, direction));
            let place = found.map_or(held.model.contacts()[contact].slider[direction], |j| end.places[j]);
            try_push(&mut places, place, CONTEXT)?;
        }
        end.places = places;
        *if sign < 0.0 { &mut band.lower } else { &mut band.upper } = end;
    }
    // The upper end may have more sliders than the lower one.
    for &(contact, direction) in &band.sliders[band.lower.places.len()..] {
        let place = held.model.contacts()[contact].slider[direction];
        try_push(&mut band.lower.places, place, CONTEXT)?;
    }
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
    let mut is_complete = true;
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
    is_complete &= gains.iter().all(|gain| *gain < BAND_FORETOLD);
    let mut band = begun(held, is_complete, search.solved)?;
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
