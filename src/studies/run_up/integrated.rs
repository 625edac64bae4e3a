//! The part of a run-up around its largest displacement, integrated in time: it corrects the slow flow and tells the error.
//!
//! The slow flow neglects effects of the second order in the rate: transients of the other modes and of the higher harmonics, and how
//! the shape of the mode changes within a turn. A structure with damping and friction forgets how a motion began. The sweep in time
//! from the steady motion at an earlier turn, the lead, comes to the motion of the whole run-up; what is left of the wrong begin falls
//! from lead to lead, each twice as long as the one before: by the decay of the mode, or more slowly where places of sliders are
//! remembered. The changes of the largest displacement over three leads, |x₁ − x₂| + |x₂ − x₃|, bound what the third one leaves: two
//! leads may agree by chance, and a memory that falls slowly shows in both. Leads double until this sum is small. A lead that reaches the
//! begin of the run-up is the whole motion.
//!
//! A slider that does not move in both directions in the steady motion at the begin of a lead, or in the lead, depends on where the search
//! for that motion has left it: it may shake down beside the middle. So the search begins with the places at the begin of the run-up, and
//! the slider must be there; otherwise the lead is that of another history, and all turns are integrated. So they are where larger
//! vibrations came before the lead, which may have moved it.

use crate::error::{Result, Status, try_push};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::options::{RunUpOptions, SweepOptions};
use crate::studies::run_up::chirp::Chirp;
use crate::studies::run_up::mode_table::{ModeTable, Place};
use crate::studies::run_up::slow_flow::Observed;
use crate::time_integration::{FrequencySweep, run_through};
use std::cell::Cell;
use std::f64::consts::TAU;

/// Exponent by which a perturbation decays in the first lead. Tuned: a shorter one does not see the contraction, each doubling costs its
/// turns; chosen, not measured.
/// Kind: tuned; measured on: nothing, it is chosen.
const RUN_UP_LEAD: f64 = 3.0;

/// Sum of the two changes over three leads, relative, at which leads end: a cap on work, not an accuracy of the result,
/// whose error is told.
/// Kind: cap.
const RUN_UP_LEADS_AGREE: f64 = 1e-5;

/// Amplitude of the slow flow below its largest, relative, at which turns are integrated, too. The slow flow must be right to half of it
/// there; otherwise the whole run-up is integrated.
/// Kind: cap.
const RUN_UP_AROUND: f64 = 0.1;

/// Error of the integration itself, relative.
/// Kind: rounding; it is the tolerance of smooth laws, and runs with friction keep 1e-9 against
/// stored ones.
const RUN_UP_INTEGRATION: f64 = 1e-9;

/// Distance of a slider that does not move in both directions from its place at the begin of the run-up, relative to the largest
/// displacement, which is added
/// to the error told; a larger one is that of another history.
/// Kind: cap.
const RUN_UP_SAME_PLACE: f64 = 1e-6;

/// Amplitude before a lead, relative to that at its begin, which may have moved a slider that rests there.
/// Kind: cap; beats of the begin of
/// the run-up stay below.
const RUN_UP_LARGER_BEFORE: f64 = 1.1;

/// Most operations of all leads together.
/// Kind: cap; some ten seconds.
const RUN_UP_INTEGRATED_WORK: u64 = 20_000_000_000;

/// Change of the amplitude, relative, over which the decay of its perturbations is read.
/// Kind: rounding; of a difference.
const RUN_UP_PERTURBED: f64 = 0.01;

const CONTEXT: &str = "the integrated part of a run-up";

/// Result of the integration in time.
pub(super) struct Integrated {
    /// Number of turns of the last lead and of the integration after it. 0: all turns would be needed, since the
    /// leads differ from the slow flow, but these are too many; the result is then the slow flow with that difference
    /// as its error.
    pub turns: usize,
    /// The largest displacement, its time and its frequency.
    pub largest: f64,
    pub largest_time: f64,
    pub largest_omega: f64,
    /// Relative error of the largest displacement.
    pub error: f64,
}

/// Integrates in time around the largest displacement of a slow flow, and replaces the amplitudes of these turns;
/// `None` where the allowed work does not suffice, or no steady motion is found.
#[inline(never)]
pub(super) fn integrate(
    model: &Model,
    (table, seen): (&ModeTable, &mut Observed),
    (options, chirp, dof): (&RunUpOptions, &Chirp, usize),
    (operations, interrupt): (u64, &Interrupt<'_>),
) -> Result<Option<Integrated>> {
    let s = &options.synthesis;
    // A damping ratio that is added to the mode's belongs to no matrix.
    if options.integrated_turns == 0 || s.damping_ratio != 0.0 || seen.turns.is_empty() {
        return Ok(None);
    }
    let mut loaded = model.separate_clone()?;
    loaded.scale_fundamental(s.force_factor)?;
    let (mut decays, mut amplitudes) = (Vec::new(), Vec::new());
    let mut place = Place::default();
    for turn in &seen.turns {
        table.find(turn.modal_amplitude.max(f64::MIN_POSITIVE), &mut place)?;
        try_push(&mut decays, decay(table, &place), CONTEXT)?;
        try_push(&mut amplitudes, turn.amplitude, CONTEXT)?;
    }
    let mut leads = Leads {
        model: loaded,
        placed: None,
        options,
        chirp,
        dof,
        decays: &decays,
        amplitudes: &amplitudes,
        checks: RUN_UP_INTEGRATED_WORK / operations.max(1),
        first: None,
        interrupt,
    };
    leads.around(seen)
}

/// Rate at which a small change of the amplitude decays: the decay rate δ of the oscillator or, with the amplitude a,
/// the slope d(aδ)/da, whichever is less.
fn decay(table: &ModeTable, at: &Place) -> f64 {
    let here = table.oscillator(at).decay();
    let mut below = *at;
    // Below the mode it is as at its begin.
    if table
        .find(at.amplitude() * (1.0 - RUN_UP_PERTURBED), &mut below)
        .is_err()
    {
        return here;
    }
    let slope = here + (here - table.oscillator(&below).decay()) / RUN_UP_PERTURBED;
    here.min(slope.max(0.1 * here))
}

/// Sweeps in time, each with a lead: turns before the ones of interest in which the start is forgotten.
struct Leads<'a> {
    /// The model with the forces of the run-up.
    model: Model,
    /// The model for leads: sliders that do not move at the beginning of the run-up have the places of that time.
    placed: Option<Model>,
    options: &'a RunUpOptions,
    chirp: &'a Chirp,
    dof: usize,
    /// Rate at which perturbations decay in each turn.
    decays: &'a [f64],
    /// Largest displacement of each turn by the slow flow.
    amplitudes: &'a [f64],
    /// Number of checks of the interrupt that are left.
    checks: u64,
    /// The first turn of the run-up, for the places of its sliders.
    first: Option<FrequencySweep>,
    interrupt: &'a Interrupt<'a>,
}

/// The turns of interest, and their sweep from the first turn of a lead on.
struct Swept {
    from: usize,
    sweep: FrequencySweep,
    largest: f64,
    largest_time: f64,
    largest_omega: f64,
}

impl Leads<'_> {
    fn around(&mut self, seen: &mut Observed) -> Result<Option<Integrated>> {
        let highest = seen.turns.iter().fold(0.0_f64, |most, turn| most.max(turn.amplitude));
        let is_near = |a: f64| a >= (1.0 - RUN_UP_AROUND) * highest;
        let first = seen.turns.iter().position(|turn| is_near(turn.amplitude)).unwrap_or(0);
        let last = seen.turns.iter().rposition(|turn| is_near(turn.amplitude)).unwrap_or(0);
        let flow = seen.largest;
        let mut found = self.leads((first, last), flow)?;
        let count = seen.turns.len();
        let close = |found: &Option<(Swept, f64)>| {
            found.as_ref().is_some_and(|(swept, _)| {
                let whole = swept.from == 0 && swept.sweep.turns.len() >= count;
                whole || (swept.largest - flow).abs() <= 0.5 * RUN_UP_AROUND * flow
            })
        };
        if !close(&found) {
            // The slow flow is no guide: the whole run-up.
            if let Some(swept) = self.sweep(0, (0, seen.turns.len() - 1))? {
                found = Some((swept, 0.0));
            } else {
                return Ok(found.map(|(swept, left)| Integrated {
                    turns: 0,
                    largest: flow,
                    largest_time: seen.largest_time,
                    largest_omega: self.chirp.omega(seen.largest_time),
                    error: (left + (swept.largest - flow).abs()) / flow,
                }));
            }
        }
        let Some((swept, left)) = found else { return Ok(None) };
        // Turns of a lead are not those of the run-up, unless it goes back to the begin.
        let kept = if swept.from == 0 { 0 } else { first };
        let integrated = swept.sweep.turns.iter().skip(kept - swept.from);
        for (own, turn) in seen.turns.iter_mut().skip(kept).zip(integrated) {
            own.amplitude = turn.amplitude;
        }
        Ok(Some(Integrated {
            turns: swept.sweep.turns.len(),
            largest: swept.largest,
            largest_time: swept.largest_time,
            largest_omega: swept.largest_omega,
            error: left / swept.largest + RUN_UP_INTEGRATION,
        }))
    }

    /// Sweeps with leads to the `wanted` turns, each lead twice as long as the one before, until the largest
    /// displacement changes little. Returns the last sweep and its possible error. With two leads alone, the
    /// difference from the slow flow replaces a third one.
    fn leads(&mut self, wanted: (usize, usize), flow: f64) -> Result<Option<(Swept, f64)>> {
        let mut exponent = RUN_UP_LEAD;
        let mut before: [Option<f64>; 2] = [None; 2];
        let mut found = None;
        let mut is_other = false;
        loop {
            let from = if is_other { 0 } else { self.begin(wanted.0, exponent) };
            if from > 0 && !self.know_begin()? {
                return Ok(None);
            }
            let Some(swept) = self.sweep(from, wanted)? else {
                return Ok(found);
            };
            if from == 0 {
                return Ok(Some((swept, 0.0)));
            }
            let largest = swept.largest;
            let Some(moved) = self.history(from, &swept.sweep, largest) else {
                (is_other, found) = (true, None);
                continue;
            };
            if let [first, Some(second)] = before {
                let further = first.map_or((largest - flow).abs(), |first| (second - first).abs());
                let left = (largest - second).abs() + further + moved;
                found = Some((swept, left));
                if first.is_some() && left <= RUN_UP_LEADS_AGREE * largest {
                    return Ok(found);
                }
            }
            before = [before[1], Some(largest)];
            exponent *= 2.0;
        }
    }

    /// Integrates the first turn of the run-up, and places the model's sliders that do not move in it; returns
    /// whether the turn was found.
    fn know_begin(&mut self) -> Result<bool> {
        if self.first.is_none() {
            let Some(first) = self.sweep(0, (0, 0))? else {
                return Ok(false);
            };
            if first.sweep.resting.iter().any(Option::is_some) {
                let mut placed = self.model.separate_clone()?;
                for &(contact, place) in first.sweep.resting.iter().flatten() {
                    placed.set_slider(contact, 0, place)?;
                }
                self.placed = Some(placed);
            }
            self.first = Some(first.sweep);
        }
        Ok(true)
    }

    /// Sum of the distances by which sliders are not where they are at the beginning of the run-up, over those that
    /// do not move in both directions in a lead, or in the steady motion at its beginning; `None` where one of them
    /// is elsewhere, or may have been moved before.
    fn history(&self, from: usize, lead: &FrequencySweep, largest: f64) -> Option<f64> {
        let Some(first) = &self.first else { return Some(0.0) };
        let mut distance = 0.0;
        let rests = lead.resting.iter().zip(&first.resting);
        let rests = rests.map(|(lead, first)| (lead.map(|one| one.1), first.map(|one| one.1)));
        let held = lead.held.iter().zip(&first.held).map(|(lead, first)| (*lead, *first));
        for (place, own) in rests.chain(held) {
            let Some(place) = place else { continue };
            let moved = own.map_or(f64::INFINITY, |own| (place - own).abs());
            if moved > RUN_UP_SAME_PLACE * largest {
                return None;
            }
            distance += moved;
        }
        let before = self.amplitudes[..from].iter().fold(0.0_f64, |most, a| most.max(*a));
        let is_larger = before > RUN_UP_LARGER_BEFORE * self.amplitudes[from];
        (!is_larger || lead.resting.iter().all(Option::is_none)).then_some(distance)
    }

    /// The turn from which perturbations decay by the given exponent until `turn`.
    fn begin(&self, turn: usize, exponent: f64) -> usize {
        let (mut k, mut decayed) = (turn, 0.0);
        while k > 0 && decayed < exponent {
            k -= 1;
            let length = self.chirp.time(TAU * (k + 1) as f64) - self.chirp.time(TAU * k as f64);
            decayed += self.decays[k].max(0.0) * length;
        }
        k
    }

    /// The sweep from a turn on, and the largest displacement in the turns `first` to `last`; `None` where it is not
    /// found within the allowed work.
    fn sweep(&mut self, from: usize, (first, last): (usize, usize)) -> Result<Option<Swept>> {
        if last + 1 - from > self.options.integrated_turns {
            return Ok(None);
        }
        let chirp = self.chirp;
        let begin = chirp.time(TAU * from as f64);
        let end = chirp.time(TAU * (last + 1) as f64).min(chirp.duration());
        let options = SweepOptions {
            omega_start: chirp.omega(begin),
            omega_stop: chirp.omega(end),
            rate: self.options.rate,
            dof: self.dof,
            max_periods: self.options.integrated_turns,
            ..SweepOptions::default()
        };
        let left = Cell::new(self.checks);
        let cancelled = || {
            left.set(left.get().saturating_sub(1));
            left.get() == 0 || self.interrupt.check_before(1).is_err()
        };
        let mut hooks = Hooks {
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        // From the begin on it is the run-up itself.
        let model = self.placed.as_ref().filter(|_| from > 0).unwrap_or(&self.model);
        let outcome = run_through(model, &options, &mut hooks);
        self.checks = left.get();
        self.interrupt.check()?;
        let sweep = match outcome {
            Ok(sweep) if sweep.status == Status::Ok => sweep,
            Err(e) if e.status == Status::OutOfMemory => return Err(e),
            _ => return Ok(None),
        };
        // From the begin on all turns are those of the run-up; those of another lead are not.
        let skipped = if from == 0 { 0 } else { first - from };
        let wanted = sweep.turns.iter().skip(skipped);
        let Some(top) = wanted.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)) else {
            return Ok(None);
        };
        let is_all = sweep.largest.to_bits() == top.amplitude.to_bits();
        // The time within the turn is known of the largest of all turns alone.
        let time = if is_all { sweep.largest_time } else { top.time };
        Ok(Some(Swept {
            from,
            largest: top.amplitude,
            largest_time: begin + time,
            largest_omega: chirp.omega(begin + time),
            sweep,
        }))
    }
}
