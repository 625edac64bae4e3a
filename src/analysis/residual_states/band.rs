//! The band of a forced response: the least and the largest result over the forces that contacts keep which stick through the period.

use crate::analysis::residual_states::band_ends::{Begun, state_of, with_ends};
use crate::analysis::residual_states::band_line::line;
use crate::analysis::residual_states::band_refinement::{BAND_REFINEMENT_MOST_UNKNOWNS, Refinement};
use crate::analysis::residual_states::band_search::BandSearch;
use crate::analysis::residual_states::free_points::FreePoints;
use crate::analysis::residual_states::freedom::free_sliders;
use crate::analysis::residual_states::held_sliders::{HeldSliders, HeldState};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::SolverOptions;
use crate::results::Branch;

pub use crate::analysis::residual_states::band_result::{Band, BandEnd, BandOptions, BandState};
pub use crate::analysis::residual_states::held_sliders::BandOf;

const CONTEXT: &str = "the band of a response";

/// Most starts of a search.
/// Kind: cap.
const BAND_MOST_STARTS: usize = 1000;

/// The band of a stored point of a forced response: the least and the largest result over all places of the sliders that stick through
/// the period, with the states that attain them. Contacts that stick at an end, but not at the point, are free there, too: the search
/// goes on from that end.
///
/// The harmonics are those of the point. Where a tolerance has chosen these, the ends and the limits of one free slider are searched
/// again with twice as many, until their results change by less than the tolerance of `solver`.
///
/// With one free slider all states that are joined to that of the point, from one limit of its friction to the other, are followed, with
/// every extremum between them. With several, a search from each start goes to an extremum: the bounds are attained ones, beyond which others may lie. Where every contact
/// is linear at the point, states with sliders at the corners of their limits are tried, at which another contact may slip or open.
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
    let is_stuck = sliders.is_empty();
    if is_stuck {
        for slider in FreePoints::single(model, branch, &interrupt).stuck_at(point)? {
            if options.contacts.is_empty() || options.contacts.contains(&slider.contact) {
                try_push(&mut sliders, slider, CONTEXT)?;
            }
        }
    }
    let omega = branch.omega_at(point).unwrap_or(f64::NAN);
    if sliders.is_empty() {
        return Ok(without(options.of, branch, point));
    }
    interrupt.phase(Phase::Results, 0.0)?;
    let condensed = branch.condensed_at(point);
    let response = branch.responses().first();
    let response = response
        .map(crate::results::ResponseSeries::response)
        .filter(|one| !one.is_plain());
    let refinement = refinement(branch, point, solver);
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
    let found = if is_stuck {
        let mut band = without(options.of, branch, point);
        (band.sliders, band.is_complete) = (pairs(&held)?, false);
        Begun {
            band,
            ends: [first.clone(), first],
            edges: None,
            is_stuck,
        }
    } else if held.sliders.len() == 1 {
        along(&held, first)?
    } else {
        searched(&held, first, options.starts)?
    };
    with_ends(&held, found, (branch, point), options, refinement, &interrupt)
}

/// How far the ends are refined; `None` where no tolerance has chosen the harmonics of the point.
fn refinement(branch: &Branch, point: usize, solver: &SolverOptions) -> Option<Refinement> {
    let error = branch.error_estimate_at(point).unwrap_or(f64::NAN);
    // A mean, and two unknowns for each harmonic.
    let each = BAND_REFINEMENT_MOST_UNKNOWNS / branch.condensed_at(point).coordinates().max(1);
    let most = each.saturating_sub(1) / 2;
    (solver.tolerance > 0.0 && !error.is_nan()).then_some(Refinement {
        tolerance: solver.tolerance,
        highest: most.min(solver.max_harmonics),
    })
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

/// The band of a response without free sliders: both ends are the response itself.
fn without(of: BandOf, branch: &Branch, point: usize) -> Band {
    let omega = branch.omega_at(point).unwrap_or(f64::NAN);
    let amplitude = branch.stored_amplitude(point);
    let end = || BandEnd {
        value: if of == BandOf::PeakOmega { omega } else { amplitude },
        omega,
        amplitude,
        places: Vec::new(),
        at_limit: Vec::new(),
        gain: 0.0,
        error: branch.error_estimate_at(point).unwrap_or(f64::NAN),
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

/// Pairs (contact, direction) of the held sliders.
fn pairs(held: &HeldSliders<'_>) -> Result<Vec<(usize, usize)>> {
    let mut pairs = Vec::new();
    for slider in &held.sliders {
        try_push(&mut pairs, (slider.contact, slider.direction), CONTEXT)?;
    }
    Ok(pairs)
}

/// A band of the held sliders whose ends are still to be filled in.
fn begun(held: &HeldSliders<'_>, is_complete: bool, solved: usize, gains: [f64; 2]) -> Result<Band> {
    let end = |gain: f64| BandEnd {
        value: f64::NAN,
        omega: f64::NAN,
        amplitude: f64::NAN,
        places: Vec::new(),
        at_limit: Vec::new(),
        gain,
        error: f64::NAN,
        branch: None,
    };
    Ok(Band {
        sliders: pairs(held)?,
        lower: end(gains[0]),
        upper: end(gains[1]),
        states: Vec::new(),
        is_complete,
        solved,
    })
}

fn along(held: &HeldSliders<'_>, first: HeldState) -> Result<Begun> {
    let (mut low, mut high) = (first.clone(), first.clone());
    let line = line(held, first)?;
    let mut band = begun(held, line.is_complete, line.solved, [0.0; 2])?;
    for (i, state) in line.states.iter().enumerate() {
        if i == 0 || state.value < low.value {
            low = state.clone();
        }
        if i == 0 || state.value > high.value {
            high = state.clone();
        }
        try_push(&mut band.states, state_of(state), CONTEXT)?;
    }
    let edges = match (line.states.first(), line.states.last()) {
        (Some(first), Some(last)) if line.is_complete && line.states.len() > 1 => Some([first.clone(), last.clone()]),
        _ => None,
    };
    Ok(Begun {
        band,
        ends: [low, high],
        edges,
        is_stuck: false,
    })
}

fn searched(held: &HeldSliders<'_>, first: HeldState, starts: usize) -> Result<Begun> {
    let units = held.distances(&first)?;
    let mut search = BandSearch { held, units, solved: 0 };
    let (mut low, mut high): (HeldState, HeldState) = (first.clone(), first.clone());
    let mut gains = [f64::INFINITY; 2];
    let Some(within) = search.within(first)? else {
        return Ok(Begun {
            band: begun(held, false, search.solved, [0.0; 2])?,
            ends: [low, high],
            edges: None,
            is_stuck: false,
        });
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
    Ok(Begun {
        band: begun(held, true, search.solved, gains)?,
        ends: [low, high],
        edges: None,
        is_stuck: false,
    })
}
