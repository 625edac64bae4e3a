//! Static states along a load history: the residual state that assembly, or a speed that rises and falls, leaves in contacts.
//!
//! Where the motion between two loads is a straight line, so are the forces of contacts that press, and the place of a slider at the end
//! is exactly that of the play operator from the place at the begin. A contact that opens, closes or begins to slip on the way bends
//! the line: such a step is halved until this lies in a piece that no longer counts. So is one whose halves give another place.
//! In a plane a slider that slides follows its contact on a curve, to first order in the length of the pieces.

use crate::aft::{Evaluation, Evaluator};
use crate::analysis::linear::static_solution::{NEEDS_SPEED, linear_static_motion, static_state};
use crate::contact::forms::constants::Constant;
use crate::contact::{Contact, Role};
use crate::error::{Result, fail, try_copy, try_push, try_vec};
use crate::fourier::HarmonicSet;
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::options::SolverOptions;

const CONTEXT: &str = "the static states of a load history";

/// Most halvings of a step, of one with a bend, and of one in which a slider slides in a plane.
/// Kind: cap.
const STATIC_HISTORY_HALVINGS: usize = 12;
const STATIC_HISTORY_BENT: usize = 26;
const STATIC_HISTORY_IN_PLANE: usize = 9;

/// Difference of the places of sliders, over the largest motion of a contact, at which the halves of a step agree, and of those in
/// a plane.
/// Kind: rounding.
const AGREES: f64 = 1e-11;
const AGREES_IN_PLANE: f64 = 1e-7;

/// Distance of the middle of a motion to the line between its ends, over the motion, that is rounding.
/// Kind: rounding.
const STATIC_HISTORY_STRAIGHT: f64 = 1e-9;

/// Halvings before a step may be a curve.
/// Kind: tuned; measured on: not recorded.
const STATIC_HISTORY_CURVE: usize = 3;

/// Most steps of a history.
/// Kind: cap.
const STATIC_HISTORY_MOST_STEPS: usize = 1_000_000;

/// A load history: the loads of each step, with straight lines between them.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadHistory<'a> {
    /// Factors of the constant forces, one a step; empty: 1 in all steps.
    pub factors: &'a [f64],
    /// Speeds of rotation, one a step; empty: the speed of the model in all steps.
    pub speeds: &'a [f64],
}

/// A static state of the history.
#[derive(Clone, Debug)]
pub struct StaticStep {
    /// Displacements of all degrees of freedom.
    pub motion: Vec<f64>,
    /// Places of the sliders of each contact along t1 and t2; 0 for contacts without sliders.
    pub places: Vec<[f64; 2]>,
    /// Force of each contact along t1, t2 and n, positive if it acts against the relative motion; the force along n
    /// is minus the normal load.
    pub forces: Vec<[f64; 3]>,
}

/// Computes the static states of a model along a load history, beginning with the places of its sliders.
/// `Model::set_slider` with the places of a step gives a model the residual state of this step.
///
/// # Errors
/// `Dimension` for a history without steps, or lists of different lengths; `NotFinite`; those of the static states; `StoppedByCaller`.
pub fn static_history(
    model: &Model,
    solver: &SolverOptions,
    history: &LoadHistory<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Vec<StaticStep>> {
    solver.check()?;
    let count = check(history)?;
    model.check_matrices(false)?;
    let mut walk = HistoryWalk {
        model,
        solver,
        interrupt,
        size: 0.0,
    };
    let mut places = Vec::new();
    for contact in model.contacts() {
        try_push(&mut places, contact.slider(), CONTEXT)?;
    }
    let mut steps: Vec<StaticStep> = Vec::new();
    let load = |i: usize| Load {
        factor: history.factors.get(i).copied().unwrap_or(1.0),
        speed: history.speeds.get(i).copied(),
    };
    for i in 0..count {
        interrupt.part(Phase::Results, i, count)?;
        let step = match steps.last() {
            // The first load is reached at once.
            None => walk.state(load(0), &places)?,
            Some(last) => walk.to(load(i - 1), last, load(i), 0)?,
        };
        try_push(&mut steps, step, CONTEXT)?;
    }
    Ok(steps)
}

fn check(history: &LoadHistory<'_>) -> Result<usize> {
    let [factors, speeds] = [history.factors.len(), history.speeds.len()];
    let count = factors.max(speeds);
    if count == 0 || count > STATIC_HISTORY_MOST_STEPS {
        return fail!(
            Dimension,
            "{count} steps of a load history, needs 1 .. {STATIC_HISTORY_MOST_STEPS}"
        );
    }
    if factors > 0 && speeds > 0 && factors != speeds {
        return fail!(
            Dimension,
            "{factors} factors and {speeds} speeds of a load history, needs as many of both, or none of one"
        );
    }
    for (name, list) in [("factors", history.factors), ("speeds", history.speeds)] {
        if let Some(i) = list.iter().position(|x| !x.is_finite()) {
            return fail!(NotFinite, "{name}[{i}] = {}, needs a finite number", list[i]);
        }
    }
    Ok(count)
}

/// The load at one time of the history.
#[derive(Clone, Copy)]
struct Load {
    factor: f64,
    speed: Option<f64>,
}

impl Load {
    fn middle(self, other: Self) -> Self {
        Self {
            factor: 0.5 * (self.factor + other.factor),
            speed: self.speed.zip(other.speed).map(|(a, b)| 0.5 * (a + b)),
        }
    }
}

/// Whether the middle of a motion lies on the line between its ends.
fn is_straight(begin: &[f64], middle: &[f64], end: &[f64]) -> bool {
    let (mut bend, mut size) = (0.0_f64, 0.0_f64);
    for ((a, m), b) in begin.iter().zip(middle).zip(end) {
        bend = bend.max((m - 0.5 * (a + b)).abs());
        size = size.max(a.abs()).max(b.abs());
    }
    bend <= STATIC_HISTORY_STRAIGHT * size
}

struct HistoryWalk<'a> {
    model: &'a Model,
    solver: &'a SolverOptions,
    interrupt: &'a Interrupt<'a>,
    /// Largest motion at a contact so far.
    size: f64,
}

impl HistoryWalk<'_> {
    /// The state at the end of a step, from the state at its beginning.
    fn to(&mut self, from: Load, begin: &StaticStep, to: Load, halvings: usize) -> Result<StaticStep> {
        let whole = self.state(to, &begin.places)?;
        if !self.model.contacts().iter().any(|contact| contact.sliders() > 0) {
            return Ok(whole);
        }
        let middle = from.middle(to);
        let half = self.state(middle, &begin.places)?;
        let second = self.state(to, &half.places)?;
        let is_line = is_straight(&begin.motion, &half.motion, &second.motion);
        let is_even = !self.changes(begin, &half, &second) && (is_line || halvings >= STATIC_HISTORY_CURVE);
        let (on_line, in_plane) = self.gaps(&whole, &second);
        let agrees = on_line <= AGREES * self.size;
        let agrees_in_plane = in_plane <= AGREES_IN_PLANE * self.size || halvings >= STATIC_HISTORY_IN_PLANE;
        let most = if is_even {
            STATIC_HISTORY_HALVINGS
        } else {
            STATIC_HISTORY_BENT
        };
        if halvings >= most || (is_even && agrees && agrees_in_plane) {
            return Ok(second);
        }
        let half = self.to(from, begin, middle, halvings + 1)?;
        self.to(middle, &half, to, halvings + 1)
    }

    /// Whether a contact opens, closes, begins to slip or begins to stick within a step, by the states at its
    /// beginning, middle and end.
    fn changes(&self, begin: &StaticStep, half: &StaticStep, end: &StaticStep) -> bool {
        let moved = |a: &[f64; 2], b: &[f64; 2]| {
            let gap = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            gap > AGREES * self.size
        };
        self.model.contacts().iter().enumerate().any(|(id, contact)| {
            let is_open = |step: &StaticStep| contact.places().contains(&2) && step.forces[id][2] == 0.0;
            let opens = is_open(begin) != is_open(half) || is_open(half) != is_open(end);
            let (first, second) = (
                moved(&begin.places[id], &half.places[id]),
                moved(&half.places[id], &end.places[id]),
            );
            opens || (!is_open(half) && first != second)
        })
    }

    /// Largest differences between the places of two states: of sliders on a line, and of sliders in a plane.
    fn gaps(&self, a: &StaticStep, b: &StaticStep) -> (f64, f64) {
        let (mut on_line, mut in_plane) = (0.0_f64, 0.0_f64);
        for (contact, (a, b)) in self.model.contacts().iter().zip(a.places.iter().zip(&b.places)) {
            let most = if contact.sliders() > 1 {
                &mut in_plane
            } else {
                &mut on_line
            };
            for (a, b) in a.iter().zip(b) {
                *most = most.max((a - b).abs());
            }
        }
        (on_line, in_plane)
    }

    /// The static state under a load, with sliders that are dragged from the given places.
    fn state(&mut self, load: Load, places: &[[f64; 2]]) -> Result<StaticStep> {
        self.interrupt.check()?;
        let mut model = self.model.try_clone()?;
        if load.factor.to_bits() != 1.0_f64.to_bits() {
            model.scale_forces(load.factor)?;
        }
        if let Some(speed) = load.speed {
            model.set_speed(Speed::Fixed(speed))?;
        }
        for (id, place) in places.iter().enumerate() {
            for (k, &place) in place.iter().enumerate().take(model.contacts()[id].sliders()) {
                if model.contacts()[id].role() == Role::Active {
                    model.set_slider(id, k, place)?;
                }
            }
        }
        let state = static_state(&model, self.solver, NEEDS_SPEED, self.interrupt)?;
        let degrees = model.structure().degrees();
        let independent = if state.is_loaded() {
            try_copy(&state.structure, CONTEXT)?
        } else {
            linear_static_motion(&model, self.solver, self.interrupt)?
        };
        let mut motion = try_vec(model.ndof(), 0.0, CONTEXT)?;
        degrees.expand_in_time(&independent, &independent, &mut motion);
        let mut step = StaticStep {
            motion,
            places: try_copy(places, CONTEXT)?,
            forces: try_vec(places.len(), [0.0; 3], CONTEXT)?,
        };
        for (id, contact) in model.contacts().iter().enumerate() {
            let relative = |k: usize| -> f64 {
                let row = model.structure().contact_motion(contact, k);
                let terms = row.ring_row(|dof, _| dof);
                terms.iter().flatten().map(|&(dof, a)| a * independent[dof]).sum()
            };
            self.contact(contact, relative, &mut step.places[id], &mut step.forces[id])?;
        }
        Ok(step)
    }

    /// Force of a contact at a static motion, and the new places of its sliders.
    fn contact(
        &mut self,
        contact: &Contact,
        relative: impl Fn(usize) -> f64,
        place: &mut [f64; 2],
        force: &mut [f64; 3],
    ) -> Result<()> {
        let count = contact.directions();
        if contact.role() == Role::Inert || contact.places().is_empty() {
            return Ok(());
        }
        let mut motion = try_vec(count, 0.0, CONTEXT)?;
        for (k, y) in motion.iter_mut().enumerate() {
            *y = relative(k);
            self.size = self.size.max(y.abs());
        }
        if contact.role() == Role::Spring {
            force[contact.places()[0]] = contact.stiffness_as_spring() * motion[0];
            return Ok(());
        }
        let set = HarmonicSet::all(0)?;
        let law = contact.law(1.0)?;
        let mut evaluator = Evaluator::force_alone(&set, (self.solver.samples, 1), core::iter::once(&*law))?;
        let mut found = Evaluation::force_alone(&set, count)?;
        if count == 1 {
            evaluator.prepare(&set, &motion, self.interrupt)?;
        }
        evaluator.evaluate(&*law, &set, &motion, 1.0, &mut found, self.interrupt)?;
        let kt = contact.constant(Constant::Kt);
        for (k, f) in found.force.iter().enumerate() {
            force[contact.places()[k]] = *f;
            if k < contact.sliders() && kt > 0.0 {
                place[k] = motion[k] - f / kt;
            }
        }
        Ok(())
    }
}
