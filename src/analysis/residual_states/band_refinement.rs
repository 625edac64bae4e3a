//! The ends of a band with more harmonics, which tell their error.
//!
//! The harmonics of a point are those that its own motion needs. At an end another contact may be at its limit, and the place of that
//! limit depends on the least margin at one time, which converges more slowly than an amplitude. So an end is searched again with twice
//! the harmonics, and again, until its result changes by less than the tolerance. The last change is the error that is told: it bounds the
//! error of the last one where each doubling halves the error at least, as with friction, whose harmonics fall as h⁻³.

use crate::analysis::residual_states::band_growth::Grown;
use crate::analysis::residual_states::band_search::BandSearch;
use crate::analysis::residual_states::held_sliders::{HeldSliders, HeldState};
use crate::analysis::residual_states::stuck_contacts::StuckSlider;
use crate::error::{Result, Status, try_push};
use crate::interrupt::Interrupt;
use crate::options::{MAX_SAMPLES, SolverOptions};
use std::rc::Rc;

const CONTEXT: &str = "the ends of a band";

/// First radius of the search with more harmonics, in units of the distances of the sliders.
/// Kind: tuned; measured on: not recorded.
const BAND_REFINEMENT_FIRST: f64 = 3e-3;

/// Unknowns above which no end is refined: Newton's method factors dense matrices.
/// Kind: cap.
pub(crate) const BAND_REFINEMENT_MOST_UNKNOWNS: usize = 1500;

/// Limits of the refinement of a band's ends.
#[derive(Clone, Copy)]
pub(crate) struct Refinement {
    /// Relative change of the result that is small enough to stop.
    pub tolerance: f64,
    /// Highest harmonic that may be carried.
    pub highest: usize,
}

/// An end of a band, with more harmonics.
pub(crate) struct Finer<'a> {
    pub own: Grown<'a>,
    /// Relative change of the result by the last doubling.
    pub error: f64,
}

/// Searches for an end again with more harmonics, from a state near it: the least result (`sign` −1) or the largest
/// one (1) nearby. `None` where more harmonics are not allowed, or no solution was found.
///
/// # Errors
/// As [`HeldSliders::first`], those of a missing solution aside.
pub(crate) fn refined<'a>(
    held: &HeldSliders<'a>,
    state: &HeldState,
    (sign, to): (f64, Refinement),
    interrupt: &'a Interrupt<'a>,
) -> Result<Option<Finer<'a>>> {
    let mut found: Option<Finer<'a>> = None;
    loop {
        let next = match &found {
            Some(last) => doubled(&last.own.held, &last.own.state, sign, to, interrupt)?,
            None => doubled(held, state, sign, to, interrupt)?,
        };
        let Some((mut own, error)) = next else { return Ok(found) };
        own.solved += found.map_or(0, |last| last.own.solved);
        found = Some(Finer { own, error });
        if error <= to.tolerance {
            return Ok(found);
        }
    }
}

/// The end with twice the harmonics; and the relative change of its result.
fn doubled<'a>(
    held: &HeldSliders<'a>,
    state: &HeldState,
    sign: f64,
    to: Refinement,
    interrupt: &'a Interrupt<'a>,
) -> Result<Option<(Grown<'a>, f64)>> {
    let harmonics = 2 * held.solver.harmonics;
    let samples = 2 * held.solver.samples;
    if harmonics > to.highest || samples > MAX_SAMPLES {
        return Ok(None);
    }
    let mut sliders: Vec<StuckSlider> = Vec::new();
    for (slider, &place) in held.sliders.iter().zip(&state.places) {
        try_push(&mut sliders, StuckSlider { place, ..*slider }, CONTEXT)?;
    }
    let solver = SolverOptions { samples, ..held.solver };
    let more = HeldSliders::new(
        held.model,
        (&solver, harmonics),
        (held.response_dof, held.response),
        sliders,
        held.of,
        interrupt,
    )?;
    let first = match more.first(&state.set, &state.motion, state.omega) {
        Err(e) if e.recoverable || matches!(e.status, Status::NoConvergence | Status::Singular) => return Ok(None),
        first => first?,
    };
    let units = more.distances(&first)?;
    let mut search = BandSearch {
        held: &more,
        units,
        solved: 1,
    };
    let Some(within) = search.within(first)? else {
        return Ok(None);
    };
    let found = search.climb_from(within, sign, BAND_REFINEMENT_FIRST)?;
    let solved = search.solved;
    let size = found.state.value.abs().max(f64::MIN_POSITIVE);
    let error = (found.state.value - state.value).abs() / size;
    let own = Grown {
        state: found.state,
        gain: found.gain,
        solved,
        held: Rc::new(more),
    };
    Ok(Some((own, error)))
}
