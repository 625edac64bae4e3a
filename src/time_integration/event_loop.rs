//! Integration from event to event through one lapse: the part of the period after which the wave has moved on by
//! some sectors.

use crate::contact::forms::time_piece::{Grazing, Mode, TimePiece, Zeros};
use crate::error::{Result, fail, try_copy, try_vec};
use crate::interrupt::Phase;
use crate::time_integration::event_law::Element;
use crate::time_integration::harmonic_analysis::HarmonicAnalysis;
use crate::time_integration::implicit_step::Implicit;
use crate::time_integration::largest_motion::LargestMotion;
use crate::time_integration::linear_step::Taylor;
use crate::time_integration::step_polynomial::{DEGREE, StepPolynomial, first_fall};
use crate::time_integration::unrolled_structure::System;
use crate::time_integration::variation::{Collocation, Interval, Variation};

const CONTEXT: &str = "the motion in time";

/// Operations that a law takes in a step, about.
/// Kind: block.
const OPERATIONS_OF_A_LAW: usize = 200;

/// Steps of one lapse before the integration stops with an error: for integration in time the structure is then too
/// stiff against its period.
/// Kind: cap.
const EVENT_LOOP_MOST_STEPS: usize = 20_000_000;

/// Events without progress in time, per contact, before the integration stops with an error.
/// Kind: cap.
const MOST_AT_ONCE: usize = 50;

/// Share of a step within which events count as simultaneous.
/// Kind: rounding.
const SIMULTANEOUS: f64 = 1e-13;

/// Speed of a slider that begins to move, relative to its stretch times ω, or of a landing, relative to the largest
/// velocity, below which the event is touched rather than passed.
/// Kind: tuned; measured on: not recorded.
pub(crate) const GRAZING_SPEED: f64 = 3e-6;

/// State of the structure: displacements, velocities and stretches of the sliders' springs.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub x: Vec<f64>,
    pub v: Vec<f64>,
    pub e: Vec<f64>,
}

impl State {
    /// The state without any motion or stretch.
    pub fn rest(system: &System<'_>) -> Result<Self> {
        let mut e = try_vec(system.elements.len(), 0.0, CONTEXT)?;
        for (e, element) in e.iter_mut().zip(&system.elements) {
            *e = element.slider().map_or(0.0, |slider| -slider.start());
        }
        Ok(Self {
            x: try_vec(system.order(), 0.0, CONTEXT)?,
            v: try_vec(system.order(), 0.0, CONTEXT)?,
            e,
        })
    }

    /// A copy that returns an error if memory is short.
    pub fn try_clone(&self) -> Result<Self> {
        Ok(Self {
            x: try_copy(&self.x, CONTEXT)?,
            v: try_copy(&self.v, CONTEXT)?,
            e: try_copy(&self.e, CONTEXT)?,
        })
    }

    /// Adds a motion without any symmetry, whose size is a share of the largest displacement or velocity over ω. Signs without
    /// pattern come from multiples of the golden ratio.
    pub fn disturb(&mut self, share: f64, omega: f64) {
        /// Golden ratio − 1.
        /// Kind: fixed.
        const EVENT_LOOP_GOLDEN: f64 = 0.618_033_988_749_894_9;
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let size = largest(&self.x).max(largest(&self.v) / omega);
        let size = if size > 0.0 { size } else { 1.0 };
        for (values, unit) in [(&mut self.x, 1.0), (&mut self.v, omega)] {
            for (i, x) in values.iter_mut().enumerate() {
                let part = (i as f64 + 1.0) * EVENT_LOOP_GOLDEN;
                *x += share * size * unit * (part - part.floor() - 0.3);
            }
        }
    }

    /// Copies the values of another state.
    pub fn set(&mut self, other: &Self) {
        self.x.copy_from_slice(&other.x);
        self.v.copy_from_slice(&other.v);
        self.e.copy_from_slice(&other.e);
    }

    /// Distance of the motions of two states, relative to this one, velocities in the unit of displacements.
    pub fn distance(&self, other: &Self, omega: f64) -> f64 {
        let (mut gap, mut size) = (0.0, 0.0);
        for (own, others, unit) in [(&self.x, &other.x, 1.0), (&self.v, &other.v, 1.0 / omega)] {
            for (a, b) in own.iter().zip(others) {
                gap += ((a - b) * unit).powi(2);
                size += (a * unit).powi(2);
            }
        }
        if gap == 0.0 { 0.0 } else { (gap / size).sqrt() }
    }

    /// The state of the first half of the sectors of `system`; the others follow by [`Self::unfold`].
    pub fn fold(&self, system: &System<'_>) -> Result<Self> {
        let mut half = self.try_clone()?;
        for (values, block) in [(&mut half.x, system.ndof), (&mut half.v, system.ndof), (&mut half.e, 1)] {
            let group = block * system.wave.sectors;
            let mut kept = 0;
            for from in 0..values.len() {
                if from % group < group / 2 {
                    values[kept] = values[from];
                    kept += 1;
                }
            }
            values.truncate(kept);
        }
        Ok(half)
    }

    /// Sets the first half of the sectors of `system` to those of `half`, and the second half to their opposite.
    pub fn unfold(&mut self, half: &Self, system: &System<'_>) {
        let block = system.ndof;
        for (all, half, block) in [
            (&mut self.x, &half.x, block),
            (&mut self.v, &half.v, block),
            (&mut self.e, &half.e, 1),
        ] {
            let part = block * system.wave.sectors / 2;
            for (all, half) in all.chunks_exact_mut(2 * part).zip(half.chunks_exact(part)) {
                let (first, second) = all.split_at_mut(part);
                first.copy_from_slice(half);
                for (to, from) in second.iter_mut().zip(half) {
                    *to = -from;
                }
            }
        }
    }

    /// self ← self + sign·other.
    pub fn add(&mut self, sign: f64, other: &Self) {
        for (own, others) in [
            (&mut self.x, &other.x),
            (&mut self.v, &other.v),
            (&mut self.e, &other.e),
        ] {
            for (a, b) in own.iter_mut().zip(others) {
                *a += sign * b;
            }
        }
    }

    /// Number of entries of the state.
    pub fn len(&self) -> usize {
        self.x.len() + self.v.len() + self.e.len()
    }
}

/// Summary of a lapse.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LapseSummary {
    /// Number of changes of piece.
    pub events: usize,
    /// Largest displacement and velocity at the ends of the steps.
    pub largest: (f64, f64),
}

impl LapseSummary {
    fn update(&mut self, state: &State) {
        for (largest, values) in [(&mut self.largest.0, &state.x), (&mut self.largest.1, &state.v)] {
            *largest = values.iter().fold(*largest, |m, x| m.max(x.abs()));
        }
    }
}

/// Observers of a lapse; `None` for those that are not used.
#[derive(Default)]
pub(crate) struct Observers<'a, 'v> {
    /// Harmonics and samples of the motion.
    pub recorder: Option<&'a mut HarmonicAnalysis>,
    /// Perturbations of the motion.
    pub variation: Option<&'a mut (dyn Variation + 'v)>,
    /// Largest motion of a degree of freedom.
    pub largest: Option<&'a mut LargestMotion<'v>>,
}

enum Stepper {
    Taylor(Box<Taylor>),
    Implicit(Box<Implicit>),
}

/// Memory of the integration.
pub(crate) struct EventLoop {
    stepper: Stepper,
    polynomial: StepPolynomial,
    modes: Vec<Mode>,
    pieces: Vec<TimePiece>,
    /// Margins of each contact that are zero by construction at the beginning of the step.
    zeros: Vec<Zeros>,
    /// Next event of each contact within the step: (θ, margin).
    falls: Vec<Option<(f64, usize)>>,
    /// For each slider whose initial place follows from the motion, its mode; else `None`.
    dependent: Vec<Option<Mode>>,
    /// Sliders that have moved in some lapse since [`Self::clear_moved`].
    pub moved: Vec<bool>,
    /// Directions in which each slider has moved since then: up, down.
    pub directions: Vec<[bool; 2]>,
    /// Number of steps of the last lapse; and the most that a lapse may take.
    pub steps: usize,
    pub most_steps: usize,
    /// Displacement and velocity beyond which a lapse is left.
    pub bounds: (f64, f64),
}

impl EventLoop {
    /// Memory for `system`; `tolerance` bounds the local error where a law is smooth.
    pub fn new(system: &System<'_>, tolerance: f64) -> Result<Self> {
        let count = system.elements.len();
        let stepper = if system.is_piecewise_linear() {
            Stepper::Taylor(Box::new(Taylor::new(system)?))
        } else {
            Stepper::Implicit(Box::new(Implicit::new(system, tolerance)?))
        };
        Ok(Self {
            stepper,
            polynomial: StepPolynomial::new(system.order())?,
            modes: try_vec(count, Mode::Stick, CONTEXT)?,
            pieces: try_vec(count, TimePiece::default(), CONTEXT)?,
            zeros: try_vec(count, Zeros::default(), CONTEXT)?,
            falls: try_vec(count, None, CONTEXT)?,
            dependent: try_vec(count, None, CONTEXT)?,
            moved: try_vec(count, false, CONTEXT)?,
            directions: try_vec(count, [false; 2], CONTEXT)?,
            steps: 0,
            most_steps: EVENT_LOOP_MOST_STEPS,
            bounds: (f64::INFINITY, f64::INFINITY),
        })
    }

    /// Removes the bounds on steps and motions of a lapse, except the general ones.
    pub fn without_bounds(&mut self) {
        self.most_steps = EVENT_LOOP_MOST_STEPS;
        self.bounds = (f64::INFINITY, f64::INFINITY);
    }

    /// Clears the record of sliders that have moved.
    pub fn clear_moved(&mut self) {
        self.moved.fill(false);
        self.directions.fill([false; 2]);
    }

    /// Notes that the slider of an element moves, if it does. A contact that opens frees it in both directions.
    fn note(&mut self, i: usize) {
        let mode = self.modes[i];
        self.moved[i] |= mode.moves_slider();
        match mode {
            Mode::Slip(sign) => self.directions[i][usize::from(sign < 0.0)] = true,
            Mode::Open => self.directions[i] = [true; 2],
            _ => {}
        }
    }

    /// Integrates a state from time 0 over one lapse, together with the data that the observers need.
    pub fn run(
        &mut self,
        system: &mut System<'_>,
        state: &mut State,
        observers: Observers<'_, '_>,
    ) -> Result<LapseSummary> {
        let end = system.lapse();
        self.run_for(system, state, end, observers)
    }

    /// Integrates a state from time 0 up to the time `end`, together with the data that the observers need.
    pub fn run_for(
        &mut self,
        system: &mut System<'_>,
        state: &mut State,
        end: f64,
        observers: Observers<'_, '_>,
    ) -> Result<LapseSummary> {
        let Observers {
            mut recorder,
            mut variation,
            mut largest,
        } = observers;
        let mut summary = LapseSummary::default();
        summary.update(state);
        system.begin(&state.x, &state.v, &mut state.e, &mut self.modes, &mut self.dependent);
        self.zeros.fill(Zeros::default());
        if let Some(variation) = variation.as_deref_mut() {
            for (i, e) in system.elements.iter().enumerate() {
                if let Some(mode) = self.dependent[i] {
                    couple_variation(e, i, mode, mode, state, variation)?;
                }
            }
        }
        for i in 0..self.modes.len() {
            self.note(i);
        }
        let mut t = 0.0;
        let mut at_once = 0;
        self.steps = 0;
        while t < end {
            // At most ten reports of a lapse, which may be short.
            system
                .interrupt
                .phase(Phase::TimeIntegration, 0.1 * (10.0 * t / end).floor())?;
            let work = OPERATIONS_OF_A_LAW * system.elements.len();
            system.interrupt.check_before(work as u64)?;
            self.steps += 1;
            if self.steps > self.most_steps {
                return fail!(
                    NoConvergence,
                    "a period takes more than {} time steps; the structure is too stiff for omega = {}",
                    self.most_steps,
                    system.omega
                );
            }
            if summary.largest.0 > self.bounds.0 || summary.largest.1 > self.bounds.1 {
                return fail!(
                    NoBoundedSolution,
                    "the motion in time leaves the neighbourhood of its point"
                );
            }
            for (i, e) in system.elements.iter().enumerate() {
                if let Some(law) = e.events() {
                    self.pieces[i] = law.piece(self.modes[i], e.relative(&state.x), state.e[i]);
                }
            }
            self.step(system, state, t, end - t)?;
            let theta = self.next_event(system, state);
            let h = self.polynomial.length;
            if let Some(r) = recorder.as_deref_mut() {
                r.add(&self.polynomial, theta, system.interrupt)?;
            }
            if let Some(largest) = largest.as_deref_mut() {
                largest.add(&self.polynomial, theta);
            }
            if theta > 0.0 {
                if let Some(variation) = variation.as_deref_mut() {
                    variation.advance(&self.interval(theta))?;
                }
                self.polynomial.at(theta, &mut state.x, &mut state.v);
                for (i, e) in system.elements.iter().enumerate() {
                    if let Some(slider) = e.slider() {
                        let growth = self.polynomial.growth(&e.rows[0], theta);
                        let [_, y] = e.relative(&state.x);
                        slider.stretch(self.modes[i], growth, y, &mut state.e[i]);
                    }
                }
                summary.update(state);
                self.zeros.fill(Zeros::default());
            }
            let happened = self.switch(system, state, variation.as_deref_mut(), summary.largest.1)?;
            summary.events += happened;
            at_once = if theta * h > 1e-15 * end { 0 } else { at_once + happened };
            if at_once > MOST_AT_ONCE * (1 + system.elements.len()) {
                return fail!(NoConvergence, "contacts change without end at time {t} of the period");
            }
            t = if theta >= 1.0 && h >= end - t {
                end
            } else {
                t + theta * h
            };
        }
        system.interrupt.check()?;
        if let Some(variation) = variation {
            // The place of a slider that still moves follows from the motion.
            for (i, e) in system.elements.iter().enumerate() {
                couple_variation(e, i, self.modes[i], self.modes[i], state, variation)?;
            }
            variation.end()?;
        }
        Ok(summary)
    }

    fn step(&mut self, system: &mut System<'_>, state: &State, t: f64, longest: f64) -> Result<()> {
        let (pieces, polynomial) = (&self.pieces, &mut self.polynomial);
        match &mut self.stepper {
            Stepper::Taylor(s) => s.step(system, pieces, &state.x, &state.v, t, longest, polynomial),
            Stepper::Implicit(s) => s.step(system, pieces, &state.x, &state.v, t, longest, polynomial),
        }
    }

    /// The first share θ of the step at which a contact leaves its piece, 1 if none does; `falls` receives the
    /// contacts that do so up to this share.
    fn next_event(&mut self, system: &System<'_>, state: &State) -> f64 {
        let mut first = f64::INFINITY;
        for (i, e) in system.elements.iter().enumerate() {
            self.falls[i] = None;
            let Some(law) = e.events() else { continue };
            let mode = self.modes[i];
            let used = self.polynomial.degree + 1;
            let mut motion = [[0.0; DEGREE + 1]; 2];
            for (motion, row) in motion.iter_mut().zip(&e.rows) {
                self.polynomial.relative(row, motion);
            }
            let [x, y] = &motion;
            for which in 0..law.margins(mode) {
                let mut margin = [0.0; DEGREE + 1];
                law.margin(mode, which, state.e[i], &x[..used], &y[..used], &mut margin[..used]);
                if let Some(theta) = first_fall(&margin[..used], self.zeros[i][which])
                    && self.falls[i].is_none_or(|(before, _)| theta < before)
                {
                    self.falls[i] = Some((theta, which));
                }
            }
            if let Some((theta, _)) = self.falls[i] {
                first = first.min(theta);
            }
        }
        let until = first + SIMULTANEOUS;
        for fall in &mut self.falls {
            *fall = fall.filter(|(theta, _)| *theta <= until);
        }
        first.min(1.0)
    }

    /// Switches the contacts whose piece has ended to their next piece. Returns the number of these contacts.
    fn switch<'v>(
        &mut self,
        system: &System<'_>,
        state: &mut State,
        mut variation: Option<&mut (dyn Variation + 'v)>,
        largest_speed: f64,
    ) -> Result<usize> {
        let mut happened = 0;
        for (i, e) in system.elements.iter().enumerate() {
            let (Some(law), Some((_, which))) = (e.events(), self.falls[i]) else {
                continue;
            };
            let before = self.modes[i];
            let at = e.instant(&state.x, &state.v);
            // A contact may move far less than the structure.
            let speed = largest_speed.min(system.omega * state.e[i].abs());
            (self.modes[i], self.zeros[i]) = law.leave(before, which, &at, &mut state.e[i]);
            self.note(i);
            if let Some(variation) = variation.as_deref_mut() {
                couple_variation(e, i, before, self.modes[i], state, variation)?;
                let after = self.modes[i];
                if let Some(grazing) = touched(e, before, after, at.rate, (speed, largest_speed)) {
                    variation.graze(i, grazing);
                }
            }
            happened += 1;
        }
        Ok(happened)
    }

    /// The part of the last step up to θ, for the observers.
    fn interval(&self, theta: f64) -> Interval<'_> {
        let step = self.polynomial.length;
        let collocation = match &self.stepper {
            Stepper::Taylor(_) => None,
            Stepper::Implicit(stepper) => {
                let (tables, smooth) = stepper.nodes();
                Some(Collocation {
                    tables,
                    smooth,
                    step,
                    theta,
                })
            }
        };
        Interval {
            pieces: &self.pieces,
            length: theta * step,
            collocation,
        }
    }

    /// Accelerations at a state at time 0, and the speeds of the sliders.
    pub fn rates(&mut self, system: &mut System<'_>, state: &State) -> Result<(Vec<f64>, Vec<f64>)> {
        let mut e = try_copy(&state.e, CONTEXT)?;
        let mut speeds = try_vec(e.len(), 0.0, CONTEXT)?;
        system.begin(&state.x, &state.v, &mut e, &mut self.modes, &mut self.dependent);
        for (i, element) in system.elements.iter().enumerate() {
            if let Some(law) = element.events() {
                self.pieces[i] = law.piece(self.modes[i], element.relative(&state.x), e[i]);
            }
            if let (Some(slider), mode) = (element.slider(), self.modes[i])
                && mode.moves_slider()
            {
                let rate = element.relative(&state.v);
                speeds[i] = rate[0] + slider.follows(mode, mode, rate) * rate[1];
            }
        }
        self.step(system, state, 0.0, system.lapse())?;
        let scale = 2.0 / self.polynomial.length.powi(2);
        let mut accelerations = try_copy(self.polynomial.term(2), CONTEXT)?;
        for a in &mut accelerations {
            *a *= scale;
        }
        Ok((accelerations, speeds))
    }
}

/// The event that is touched without being passed at a change of mode, if any. `speeds`: a speed of slip and a speed
/// of landing, against which slow ones are measured.
fn touched(e: &Element, before: Mode, after: Mode, rate: [f64; 2], speeds: (f64, f64)) -> Option<Grazing> {
    let slider = e.slider()?;
    match (before, after) {
        (Mode::Stick, Mode::Slip(_)) => {
            let speed = rate[0] + slider.follows(after, after, rate) * rate[1];
            (speed.abs() <= GRAZING_SPEED * speeds.0).then_some(Grazing::SlipLimit)
        }
        (Mode::Open, Mode::Stick) => (rate[1].abs() <= GRAZING_SPEED * speeds.1).then_some(Grazing::Landing),
        _ => None,
    }
}

/// Reports, at the end of a mode, that a slider that has moved follows from the motion.
fn couple_variation(
    e: &Element,
    i: usize,
    mode: Mode,
    after: Mode,
    state: &State,
    variation: &mut (dyn Variation + '_),
) -> Result<()> {
    match e.slider().filter(|_| mode.moves_slider()) {
        Some(slider) => variation.couple(i, slider.follows(mode, after, e.relative(&state.v))),
        None => Ok(()),
    }
}
