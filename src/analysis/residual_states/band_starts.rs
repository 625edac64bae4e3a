//! Other states of a model from which the search of a band begins: the sliders of all contacts are placed within the reach of their
//! limits, those too that slip in the state of the branch, so that other contacts may stick.

use crate::analysis::forced_response::forced_response;
use crate::analysis::residual_states::band_corners::corners;
use crate::analysis::residual_states::band_growth::Grown;
use crate::analysis::residual_states::band_search::BandSearch;
use crate::analysis::residual_states::freedom::free_sliders;
use crate::analysis::residual_states::held_sliders::{HeldSliders, HeldState};
use crate::analysis::residual_states::stuck_contacts::{StuckSlider, keeps_force};
use crate::contact::forms::constants::Constant;
use crate::error::{Result, Status, try_copy, try_push, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{ForcedOptions, Response, SolverOptions};
use crate::results::Branch;
use num_complex::Complex64;
use std::rc::Rc;

const CONTEXT: &str = "the starts of a band";

/// Share of the reach of a limit within which sliders are placed.
/// Kind: tuned; measured on: not recorded.
const BAND_STARTS_WITHIN: f64 = 0.9;

/// Margin, over the mean limit, of a contact at its limit.
/// Kind: rounding.
const BAND_STARTS_AT_LIMIT: f64 = 1e-6;

/// A slider that may be placed: its contact and direction, the middle of its motion, and the reach of its friction
/// limit.
#[derive(Clone, Copy)]
struct SliderReach {
    contact: usize,
    direction: usize,
    middle: f64,
    reach: f64,
}

/// Other states of a model at the frequency of a point, as starts of searches.
pub(crate) struct Starts<'a> {
    model: &'a Model,
    solver: SolverOptions,
    response: Option<Response<'a>>,
    omega: f64,
    guess: Vec<Complex64>,
    sliders: Vec<SliderReach>,
    interrupt: &'a Interrupt<'a>,
    /// Number of solutions that were computed.
    pub solved: usize,
}

impl<'a> Starts<'a> {
    /// Prepares states at a stored point, with a solver of exactly the same harmonics, by the sliders of `contacts`;
    /// empty: of all contacts.
    ///
    /// # Errors
    /// Those of the results of the branch.
    pub fn new(
        held: &HeldSliders<'a>,
        (branch, point): (&Branch, usize),
        contacts: &[usize],
        interrupt: &'a Interrupt<'a>,
    ) -> Result<Self> {
        let model = held.model;
        let mut sliders = Vec::new();
        for assembled in branch.condensed_at(point).laws() {
            let number = assembled.contact;
            let contact = &model.contacts()[number];
            if !keeps_force(contact) || !(contacts.is_empty() || contacts.contains(&number)) {
                continue;
            }
            let summary = branch.contact_summary_with(point, number, interrupt)?;
            for direction in 0..contact.sliders() {
                let one = SliderReach {
                    contact: number,
                    direction,
                    middle: 0.5 * (summary.motion_min[direction] + summary.motion_max[direction]),
                    reach: contact.constant(Constant::Mu) * summary.load_max / contact.stiffness(direction),
                };
                if one.middle.is_finite() && one.reach.is_finite() {
                    try_push(&mut sliders, one, CONTEXT)?;
                }
            }
        }
        let size = (branch.harmonics() + 1).saturating_mul(branch.ndof());
        let mut guess = try_vec(size, Complex64::ZERO, CONTEXT)?;
        branch.harmonics_at_with(point, &mut guess, interrupt)?;
        let carried = (held.solver.harmonics + 1).saturating_mul(branch.ndof());
        guess.truncate(carried);
        Ok(Self {
            model,
            solver: held.solver,
            response: held.response,
            omega: branch.omega_at(point).unwrap_or(f64::NAN),
            guess,
            sliders,
            interrupt,
            solved: 0,
        })
    }

    /// Number of sliders that may be placed.
    pub fn sliders(&self) -> usize {
        self.sliders.len()
    }

    /// The state number `number`, with the sliders that are free in it; `None` where no solution was found. Number 0
    /// has the sliders in the middles of their motions, where contacts stick most easily. In the others they lie
    /// without pattern, each second state opposite to the one before.
    ///
    /// # Errors
    /// Those of the model; `OutOfMemory`; `StoppedByCaller`.
    pub fn state(&mut self, number: usize) -> Result<Option<(Branch, Vec<StuckSlider>)>> {
        let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut places = Vec::new();
        for (j, slider) in self.sliders.iter().enumerate() {
            let turn = 0.618_033_988_749_895 * (j + 1 + number.div_ceil(2) * self.sliders.len()) as f64;
            let share = if number == 0 {
                0.0
            } else {
                sign * (2.0 * turn.fract() - 1.0)
            };
            let place = slider.middle + BAND_STARTS_WITHIN * share * slider.reach;
            try_push(&mut places, (slider.contact, slider.direction, place), CONTEXT)?;
        }
        self.solution(&places)
    }

    /// The state beyond an end at which some contacts are at their limits. The other sliders move on by a share of
    /// their distances in the sense in which the result grows (`sign` 1) or falls (−1), and the contacts at their
    /// limits slip.
    ///
    /// # Errors
    /// As [`Self::state`].
    pub fn beyond(
        &mut self,
        (held, end): (&HeldSliders<'_>, &HeldState),
        (sign, share): (f64, f64),
    ) -> Result<Option<(Branch, Vec<StuckSlider>)>> {
        let at_limit = |contact: usize| {
            let mut own = end.margins.iter().filter(|margin| margin.contact == contact);
            own.any(|margin| margin.share() < BAND_STARTS_AT_LIMIT)
        };
        let units = held.distances(end)?;
        let mut places = Vec::new();
        let mut goes_on = false;
        for (j, slider) in held.sliders.iter().enumerate() {
            let mut place = end.places[j];
            if !at_limit(slider.contact) {
                place += (sign * share * units[j]).copysign(sign * end.gradient[j]);
                goes_on = true;
            }
            try_push(&mut places, (slider.contact, slider.direction, place), CONTEXT)?;
        }
        let some_slip = held.sliders.iter().any(|slider| at_limit(slider.contact));
        if goes_on && some_slip {
            self.solution(&places)
        } else {
            Ok(None)
        }
    }

    /// Corners at which to place the sliders, see [`corners`].
    pub fn corners(&self, of_point: Option<(&HeldState, &[StuckSlider])>, starts: usize) -> Result<Vec<Vec<f64>>> {
        let mut places = Vec::new();
        for slider in &self.sliders {
            try_push(
                &mut places,
                ((slider.contact, slider.direction), slider.reach > 0.0),
                CONTEXT,
            )?;
        }
        corners(&places, of_point, starts)
    }

    /// The state with the sliders at a corner, and the sliders that are free in it.
    ///
    /// # Errors
    /// As [`Self::state`].
    pub fn corner(&mut self, signs: &[f64], distance: f64) -> Result<Option<(Branch, Vec<StuckSlider>)>> {
        let mut places = Vec::new();
        for (slider, sign) in self.sliders.iter().zip(signs) {
            let place = slider.middle + distance * sign * slider.reach;
            try_push(&mut places, (slider.contact, slider.direction, place), CONTEXT)?;
        }
        self.solution(&places)
    }

    /// The place of a slider at a corner; `None` for one that is not placed.
    pub fn corner_place(&self, pair: (usize, usize), signs: &[f64], distance: f64) -> Option<f64> {
        let mut placed = self.sliders.iter().zip(signs);
        let found = placed.find(|(s, _)| (s.contact, s.direction) == pair);
        found.map(|(slider, sign)| slider.middle + distance * sign * slider.reach)
    }

    /// The solution of the model with sliders at the given places; and the sliders that are free in it.
    fn solution(&mut self, places: &[(usize, usize, f64)]) -> Result<Option<(Branch, Vec<StuckSlider>)>> {
        self.interrupt.check()?;
        let mut model = self.model.try_clone()?;
        for &(contact, direction, place) in places {
            model.set_slider(contact, direction, place)?;
        }
        self.solved += 1;
        let range = ForcedOptions {
            omega_start: self.omega,
            omega_stop: self.omega,
            guess: Some(&self.guess),
            responses: self.response.as_slice(),
            ..ForcedOptions::default()
        };
        let found = match forced_response(&model, &self.solver, &range, &mut Hooks::default()) {
            Ok(branch) if branch.points() > 0 => branch,
            Ok(_) => return Ok(None),
            Err(e) if e.recoverable || matches!(e.status, Status::NoConvergence | Status::Singular) => return Ok(None),
            Err(e) => return Err(e),
        };
        let mut free = Vec::new();
        for (slider, _) in free_sliders(&model, &found, 0, self.interrupt)? {
            if self.sliders.iter().any(|own| own.contact == slider.contact) {
                try_push(&mut free, slider, CONTEXT)?;
            }
        }
        Ok(Some((found, free)))
    }
}

/// The equations for the sliders that are free in a state; and the state moved to within their limits; `None` where
/// none was found.
///
/// # Errors
/// As [`HeldSliders::first`], those of a missing solution aside.
pub(crate) fn within_limits<'a>(
    own: &HeldSliders<'a>,
    branch: &Branch,
    sliders: Vec<StuckSlider>,
    interrupt: &'a Interrupt<'a>,
) -> Result<Option<(Rc<HeldSliders<'a>>, HeldState)>> {
    let held = HeldSliders::new(
        own.model,
        (&own.solver, own.solver.harmonics),
        (own.response_dof, own.response),
        sliders,
        own.of,
        interrupt,
    )?;
    let condensed = branch.condensed_at(0);
    let mut motion = try_copy(branch.motion_at(0).unwrap_or(&[]), CONTEXT)?;
    for u in &mut motion {
        *u *= condensed.length();
    }
    let omega = branch.omega_at(0).unwrap_or(f64::NAN);
    let first = match held.first(condensed.set(), &motion, omega) {
        Err(e) if e.recoverable || matches!(e.status, Status::NoConvergence | Status::Singular) => return Ok(None),
        first => first?,
    };
    let units = held.distances(&first)?;
    let mut search = BandSearch {
        held: &held,
        units,
        solved: 0,
    };
    let within = search.within(first)?;
    Ok(within.map(|first| (Rc::new(held), first)))
}

/// The end that a search reaches from a state within the limits: the least result (`sign` −1) or the largest one (1).
///
/// # Errors
/// As [`HeldSliders::find`].
pub(crate) fn climbed<'a>(held: &Rc<HeldSliders<'a>>, first: &HeldState, sign: f64) -> Result<Grown<'a>> {
    let mut search = BandSearch {
        held,
        units: held.distances(first)?,
        solved: 0,
    };
    let found = search.climb(first.clone(), sign)?;
    let solved = search.solved;
    Ok(Grown {
        held: Rc::clone(held),
        state: found.state,
        gain: found.gain,
        solved,
    })
}
