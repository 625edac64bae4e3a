//! Contacts that slip in the state of a branch and stick through the period at an end of its band: their residual forces are free
//! there, too, and the search goes on from that end with them.

use crate::analysis::residual_states::band_search::BandSearch;
use crate::analysis::residual_states::freedom::free_sliders;
use crate::analysis::residual_states::held_sliders::{HeldSliders, HeldState};
use crate::analysis::residual_states::stuck_contacts::StuckSlider;
use crate::error::{Result, try_push};
use crate::interrupt::Interrupt;
use crate::results::Branch;
use std::rc::Rc;

const CONTEXT: &str = "contacts that stick at an end of a band";

/// An end with more free sliders than the branch has at its point.
pub(crate) struct Grown<'a> {
    pub held: Rc<HeldSliders<'a>>,
    pub state: HeldState,
    /// Relative gain that the linear model still foretells, as in [`Found::gain`](crate::analysis::residual_states::band_search::Found::gain).
    pub gain: f64,
    /// Number of solutions that were computed.
    pub solved: usize,
}

/// The end that a search reaches from another end, given as a state and the branch of its solution, when the sliders
/// that stick at that end are free, too; `None` where no further ones stick. `contacts` are those whose force is
/// free; empty: all possible ones.
///
/// # Errors
/// As [`free_sliders`] and [`HeldSliders::first`].
pub(crate) fn grown<'a>(
    held: &HeldSliders<'a>,
    (state, branch): (&HeldState, &Branch),
    (contacts, sign): (&[usize], f64),
    interrupt: &'a Interrupt<'a>,
) -> Result<Option<Grown<'a>>> {
    let model = held.placed(held.model, &state.places)?;
    let mut sliders: Vec<StuckSlider> = Vec::new();
    for (slider, &place) in held.sliders.iter().zip(&state.places) {
        try_push(&mut sliders, StuckSlider { place, ..*slider }, CONTEXT)?;
    }
    let before = sliders.len();
    for (slider, _) in free_sliders(&model, branch, 0, interrupt)? {
        let is_known = sliders.iter().any(|own| own.contact == slider.contact);
        if (contacts.is_empty() || contacts.contains(&slider.contact))
            && (!is_known || sliders[before..].iter().any(|own| own.contact == slider.contact))
        {
            try_push(&mut sliders, slider, CONTEXT)?;
        }
    }
    if sliders.len() == before {
        return Ok(None);
    }
    let more = HeldSliders::new(
        held.model,
        (&held.solver, held.solver.harmonics),
        (held.response_dof, held.response),
        sliders,
        held.of,
        interrupt,
    )?;
    let first = more.first(&state.set, &state.motion, state.omega)?;
    let units = more.distances(&first)?;
    let mut search = BandSearch {
        held: &more,
        units,
        solved: 1,
    };
    let Some(within) = search.within(first)? else {
        return Ok(None);
    };
    let found = search.climb(within, sign)?;
    let solved = search.solved;
    Ok(Some(Grown {
        state: found.state,
        gain: found.gain,
        solved,
        held: Rc::new(more),
    }))
}
