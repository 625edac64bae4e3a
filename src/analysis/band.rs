//! The band of a forced response: the least and the largest result over the forces that contacts keep which stick through the period.

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
    /// Free sliders as (contact, direction); none: the response has no band.
    pub sliders: Vec<(usize, usize)>,
    /// The least result found.
    pub lower: BandEnd,
    /// The largest result found.
    pub upper: BandEnd,
    /// With one free slider the states from one limit to the other.
    pub states: Vec<BandState>,
    /// Whether one slider was followed to both of its limits, or every search of several ended at an extremum.
    pub is_complete: bool,
    /// Solutions that were computed.
    pub solved: usize,
}

/// The band of a stored point of a forced response: the least and the largest result over all places of the sliders that stick through
/// the period, with the states that attain them. The harmonics are those of the point.
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
    let mut band = if held.sliders.len() == 1 {
        along(&held, first)?
    } else {
        searched(&held, first, options.starts)?
    };
    let (lower, upper) = (band.1, band.2);
    for (end, state) in [(&mut band.0.lower, lower), (&mut band.0.upper, upper)] {
        *end = attained(&held, &state, end.gain, &interrupt)?;
    }
    Ok(band.0)
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

/// The distances over which sliders can be dragged: μN/kt.
fn distances(held: &HeldSliders<'_>, first: &HeldState) -> Result<Vec<f64>> {
    let mut units = try_vec(held.sliders.len(), 0.0, CONTEXT)?;
    for (unit, slider) in units.iter_mut().zip(&held.sliders) {
        let own = first.margins.iter().filter(|m| m.contact == slider.contact);
        let limit = own.fold(0.0_f64, |most, m| most.max(m.limit.abs()));
        *unit = limit / slider.stiffness;
    }
    Ok(units)
}

fn searched(held: &HeldSliders<'_>, first: HeldState, starts: usize) -> Result<(Band, HeldState, HeldState)> {
    let units = distances(held, &first)?;
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
    is_complete &= gains.iter().all(|gain| *gain < 1e-4);
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
