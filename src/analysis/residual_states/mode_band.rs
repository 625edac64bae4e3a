//! The band of a nonlinear mode: the least and the largest damping ratio or frequency at an amplitude over the forces that sticking
//! contacts may keep.
//!
//! A place beyond the limit of a slider acts as the nearest one within, so that a search over an interval that reaches beyond the
//! limits ends on them.

use crate::analysis::modes::nonlinear_mode::nonlinear_mode;
use crate::analysis::residual_states::stuck_contacts::{StuckSlider, stuck_contacts};
use crate::contact::forms::constants::Constant;
use crate::error::{Result, Status, fail, try_copy, try_push, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::{ModeChoice, ModeOptions, SolverOptions};
use crate::results::Branch;
use crate::results::stored::mode_branch::ModeField;
use crate::sensitivity::SampledModel;

const CONTEXT: &str = "the band of a nonlinear mode";

/// Places of a slider that are computed between both ends of its interval, and their refinements beside an extremum.
/// Kind: tuned; measured on: not recorded.
const MODE_BAND_PLACES: usize = 16;
/// Refinements of such a place beside an extremum.
/// Kind: cap.
const MODE_BAND_SECTIONS: usize = 40;

/// Width of the interval of an extremum, over that of all places, at which it is found.
/// Kind: rounding.
const MODE_BAND_SETTLED: f64 = 1e-7;

/// Rounds over several sliders, and the relative gain of one below which it is the last.
/// Kind: cap.
const MODE_BAND_ROUNDS: usize = 6;
/// Relative gain of a round below which it is the last.
/// Kind: rounding.
const MODE_BAND_ENOUGH: f64 = 1e-8;

/// Times that the interval of a slider is doubled until its ends are dragged.
/// Kind: cap.
const MODE_BAND_DOUBLINGS: usize = 5;

/// Distance in log₁₀ of the amplitude of the second end of a range of one point.
/// Kind: tuned; measured on: not recorded.
pub(crate) const NEXT_AMPLITUDE: f64 = 1e-3;

/// Shift of a place from the one that was given, over its limit, from which the limit has dragged it.
/// Kind: rounding.
const DRAGGED: f64 = 1e-9;

/// Result of a nonlinear mode that a band bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeBandOf {
    /// The damping ratio at the amplitude of the point.
    Damping,
    /// The angular frequency at the amplitude of the point.
    Omega,
}

/// A state of a nonlinear mode at the amplitude of the point.
#[derive(Clone, Debug)]
pub struct ModeBandState {
    /// Places of the sliders, in the order of [`ModeBand::sliders`].
    pub places: Vec<f64>,
    /// Angular frequency of the mode in this state.
    pub omega: f64,
    /// Damping ratio of the mode in this state.
    pub damping_ratio: f64,
}

/// Band of a nonlinear mode over the places of its sticking sliders.
#[derive(Debug)]
pub struct ModeBand {
    /// Sliders that stick through the period, as (contact, direction); empty: the mode has no band.
    pub sliders: Vec<(usize, usize)>,
    /// State with the least result found.
    pub lower: ModeBandState,
    /// State with the largest result found.
    pub upper: ModeBandState,
    /// With one slider, the states that were computed, by rising place; else empty.
    pub states: Vec<ModeBandState>,
    /// Whether every solution was found, and both ends of each interval were dragged by the limit.
    pub is_complete: bool,
    /// Number of solutions that were computed.
    pub solved: usize,
}

/// The band of a stored point of a nonlinear mode: the least and the largest damping ratio or frequency at its amplitude, over all
/// places of the sliders that stick through its period, with the states that attain them. `range` are the options of the mode, whose
/// amplitudes have no effect; `contacts` are those whose residual force is free, none: all that are.
///
/// With one slider all of its places are scanned, and each end is refined; with several one after another is, until nothing is gained:
/// the bounds are attained ones, beyond which others may lie.
///
/// # Errors
/// `Index` for an unknown point or contact, `Argument` for another model than that of the branch, `Unsupported` for a forced
/// response; those of the mode at the point itself; `StoppedByCaller`; `OutOfMemory`.
pub fn mode_band(
    model: &Model,
    branch: &Branch,
    point: usize,
    (of, contacts): (ModeBandOf, &[usize]),
    solver: &SolverOptions,
    range: &ModeOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<ModeBand> {
    let interrupt = hooks.interrupt();
    let sliders = sliders_of(model, branch, point, contacts, &interrupt)?;
    let field = |field| {
        branch
            .mode_data()
            .and_then(|data| data.field(field).get(point).copied())
    };
    let Some(log10) = field(ModeField::Log10Amplitude) else {
        return fail!(Index, "point = {point}, the branch has no such point of a mode");
    };
    let mut places = Vec::new();
    for slider in &sliders {
        try_push(&mut places, slider.place, CONTEXT)?;
    }
    let first = ModeBandState {
        places,
        omega: branch.omega_at(point).unwrap_or(f64::NAN),
        damping_ratio: field(ModeField::DampingRatio).unwrap_or(f64::NAN),
    };
    let mut band = ModeBand {
        sliders: Vec::new(),
        lower: first.clone(),
        upper: first.clone(),
        states: Vec::new(),
        is_complete: true,
        solved: 0,
    };
    for slider in &sliders {
        try_push(&mut band.sliders, (slider.contact, slider.direction), CONTEXT)?;
    }
    if sliders.is_empty() {
        return Ok(band);
    }
    let mut reach = Vec::new();
    for slider in &sliders {
        let summary = branch.contact_summary_with(point, slider.contact, &interrupt)?;
        let limit = model.contacts()[slider.contact].constant(Constant::Mu) * summary.load_max;
        try_push(&mut reach, limit / slider.stiffness, CONTEXT)?;
    }
    // The harmonics of the point, and the linear mode that it came from.
    let highest = branch.condensed_at(point).set().numbers().last().copied().unwrap_or(1);
    let solver = SolverOptions {
        harmonics: highest,
        max_points: 1,
        ..solver.fixed()
    };
    let range = ModeOptions {
        choice: branch
            .mode_data()
            .map_or(range.choice, |data| ModeChoice::Near(data.info.omega)),
        log10_start: log10,
        log10_stop: log10 + NEXT_AMPLITUDE,
        at: &[],
        guess: None,
        ..*range
    };
    let mut search = ModeBandSearch {
        model,
        solver,
        range,
        sliders: &sliders,
        reach,
        of,
        interrupt: &interrupt,
        solved: 0,
        is_complete: true,
    };
    for sign in [1.0, -1.0] {
        let mut best = first.clone();
        let rounds = if sliders.len() == 1 { 1 } else { MODE_BAND_ROUNDS };
        for _ in 0..rounds {
            let before = search.value(&best);
            for k in 0..sliders.len() {
                let keep = (sliders.len() == 1 && sign > 0.0).then_some(&mut band.states);
                best = search.along(best, k, sign, keep)?;
            }
            if (search.value(&best) - before).abs() <= MODE_BAND_ENOUGH * before.abs() {
                break;
            }
        }
        if sign > 0.0 {
            band.upper = best;
        } else {
            band.lower = best;
        }
    }
    band.states.sort_by(|a, b| a.places[0].total_cmp(&b.places[0]));
    (band.is_complete, band.solved) = (search.is_complete, search.solved);
    Ok(band)
}

/// The sticking sliders at a point of a mode; empty where nothing else vibrates nonlinearly.
fn sliders_of(
    model: &Model,
    branch: &Branch,
    point: usize,
    contacts: &[usize],
    interrupt: &Interrupt<'_>,
) -> Result<Vec<StuckSlider>> {
    let Some((omega, motion)) = branch.omega_at(point).zip(branch.motion_at(point)) else {
        return fail!(Index, "point = {point}, needs 0 .. {}", branch.stored());
    };
    if branch.mode_data().is_none() {
        return fail!(
            Unsupported,
            "the branch is no nonlinear mode; the band of a forced response is computed by itself"
        );
    }
    if let Some(contact) = contacts.iter().find(|c| **c >= model.contacts().len()) {
        return fail!(
            Index,
            "contacts has {contact}, but the model has {}",
            model.contacts().len()
        );
    }
    branch.check_model(model)?;
    interrupt.phase(Phase::Results, 0.0)?;
    let at_frequency = model.at_frequency(omega)?;
    let solution = SampledModel::at(branch, point);
    let mut stuck = stuck_contacts(&at_frequency, solution, motion, omega, interrupt)?;
    if !stuck.others_vibrate {
        stuck.sliders.clear();
    }
    stuck
        .sliders
        .retain(|slider| contacts.is_empty() || contacts.contains(&slider.contact));
    Ok(stuck.sliders)
}

/// A solution, and whether its slider was dragged away from its place.
struct Solved {
    state: ModeBandState,
    is_dragged: bool,
}

struct ModeBandSearch<'a> {
    model: &'a Model,
    solver: SolverOptions,
    range: ModeOptions<'a>,
    sliders: &'a [StuckSlider],
    /// Reach of each slider: its largest friction limit over its stiffness.
    reach: Vec<f64>,
    of: ModeBandOf,
    interrupt: &'a Interrupt<'a>,
    solved: usize,
    is_complete: bool,
}

impl ModeBandSearch<'_> {
    fn value(&self, state: &ModeBandState) -> f64 {
        match self.of {
            ModeBandOf::Damping => state.damping_ratio,
            ModeBandOf::Omega => state.omega,
        }
    }

    /// The mode with its sliders at the given places; `None` where it was not found.
    fn solve(&mut self, places: &[f64], k: usize) -> Result<Option<Solved>> {
        self.interrupt.check()?;
        let mut model = self.model.separate_clone()?;
        for (slider, place) in self.sliders.iter().zip(places) {
            model.set_slider(slider.contact, slider.direction, *place)?;
        }
        self.solved += 1;
        let cancelled = || self.interrupt.check().is_err();
        let mut hooks = Hooks {
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        let found = match nonlinear_mode(&model, &self.solver, &self.range, &mut hooks) {
            Ok(branch) if branch.status() == Status::StoppedByCaller => {
                self.interrupt.check()?;
                return Ok(None);
            }
            Ok(branch) if branch.points() > 0 => branch,
            Ok(_) => return Ok(None),
            Err(e) if matches!(e.status, Status::NoConvergence | Status::Singular) => return Ok(None),
            Err(e) => return Err(e),
        };
        let Some((data, motion)) = found.mode_data().zip(found.motion_at(0)) else {
            return Ok(None);
        };
        let omega = found.omega()[0];
        let solution = SampledModel::at(&found, 0);
        let stuck = stuck_contacts(&model, solution, motion, omega, self.interrupt)?;
        let slider = &self.sliders[k];
        let own = |one: &&StuckSlider| (one.contact, one.direction) == (slider.contact, slider.direction);
        let place = stuck.sliders.iter().find(own).map(|one| one.place);
        let scale = places[k].abs().max(f64::MIN_POSITIVE);
        let state = ModeBandState {
            places: try_copy(places, CONTEXT)?,
            omega,
            damping_ratio: data.field(ModeField::DampingRatio)[0],
        };
        Ok(Some(Solved {
            state,
            is_dragged: place.is_none_or(|place| (place - places[k]).abs() > DRAGGED * scale),
        }))
    }

    /// The best state over all places of slider `k` with the others as in `from`; `keep` receives the states of the scan.
    fn along(
        &mut self,
        from: ModeBandState,
        k: usize,
        sign: f64,
        mut keep: Option<&mut Vec<ModeBandState>>,
    ) -> Result<ModeBandState> {
        let middle = from.places[k];
        // The limit lets the slider be anywhere within its reach of the motion; the load may grow on the way.
        let mut half = 3.0 * self.reach[k].max(middle.abs());
        if half == 0.0 || !half.is_finite() {
            half = 10.0_f64.powf(self.range.log10_start);
        }
        let mut places = try_copy(&from.places, CONTEXT)?;
        let mut ends = [middle - half, middle + half];
        for (end, direction) in ends.iter_mut().zip([-1.0, 1.0]) {
            let mut dragged = false;
            for _ in 0..MODE_BAND_DOUBLINGS {
                places[k] = *end;
                dragged = self.solve(&places, k)?.is_some_and(|solved| solved.is_dragged);
                if dragged {
                    break;
                }
                *end = middle + direction * 2.0 * (*end - middle).abs();
            }
            self.is_complete &= dragged;
        }
        let mut best = from;
        let mut at = middle;
        let width = ends[1] - ends[0];
        let mut values = try_vec(MODE_BAND_PLACES + 1, f64::NAN, CONTEXT)?;
        for (i, value) in values.iter_mut().enumerate() {
            places[k] = ends[0] + width * i as f64 / MODE_BAND_PLACES as f64;
            let Some(solved) = self.solve(&places, k)? else {
                self.is_complete = false;
                continue;
            };
            *value = sign * self.value(&solved.state);
            if *value > sign * self.value(&best) {
                at = places[k];
                best = solved.state.clone();
            }
            if let Some(keep) = keep.as_deref_mut() {
                try_push(keep, solved.state, CONTEXT)?;
            }
        }
        // Golden sections between the neighbours of the best place.
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        let step = width / MODE_BAND_PLACES as f64;
        let (mut low, mut high) = (at - step, at + step);
        let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
        let mut found = [f64::NAN; 2];
        for _ in 0..MODE_BAND_SECTIONS {
            if high - low < MODE_BAND_SETTLED * width {
                break;
            }
            for (value, place) in found.iter_mut().zip(inner) {
                if value.is_nan() {
                    places[k] = place;
                    let Some(solved) = self.solve(&places, k)? else {
                        self.is_complete = false;
                        return Ok(best);
                    };
                    *value = sign * self.value(&solved.state);
                    if *value > sign * self.value(&best) {
                        best = solved.state;
                    }
                }
            }
            if found[0] > found[1] {
                high = inner[1];
                inner = [high - ratio * (high - low), inner[0]];
                found = [f64::NAN, found[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + ratio * (high - low)];
                found = [found[1], f64::NAN];
            }
        }
        Ok(best)
    }
}
