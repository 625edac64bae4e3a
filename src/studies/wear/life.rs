//! Vibration over the life of a machine whose contacts wear.
//!
//! The depth that a contact has worn grows by h_j′ = α_j E_j/A_j per cycle with the work E_j of a cycle of the steady vibration, and the
//! loads follow as N = N₀ − S h with the static stiffness S between the normals. That is an ordinary differential equation for h over the
//! number of cycles; its steps are those of `life_step`, with the exact derivatives of the works by the loads. Where a
//! contact begins or ends to slip, or loses its load, rates keep their value and change their slope: a step ends there.

use crate::error::{Error, Result, Status, try_copy, try_push, try_vec};
use crate::hooks::{Hooks, Progress};
use crate::interrupt::Phase;
use crate::model::Model;
use crate::options::{LifeOptions, SolverOptions};
use crate::roots::root;
use crate::studies::wear::life_length::{Doubt, LIFE_TRIES, Refusals, growth, length_of};
use crate::studies::wear::life_step::{LIFE_NEGLIGIBLE, LifeState, LifeStep, Taken, ahead};
use crate::studies::wear::worn_state::{WornState, WornStates};

const CONTEXT: &str = "the life";

/// Share of the length across an event that the step before it leaves. Chosen: the path ahead errs by less than the rest of that length.
/// Kind: tuned; measured on: nothing, it is chosen.
const LIFE_APPROACH: f64 = 0.7;

/// Vibrations that are looked at to find an event.
/// Kind: cap; two or three on the chains of the tests.
const LIFE_EVENT_TRIES: usize = 12;

/// Error of a step over the tolerance. Chosen: errors of some steps add up to less than the tolerance where they do not grow.
/// Kind: tuned; measured on: nothing, it is chosen.
const LIFE_STEP_SHARE: f64 = 0.5;

/// Half of the change of depths over the tolerance within which a jump is located. Chosen: rates that jump by their own size err by less.
/// Kind: tuned; measured on: nothing, it is chosen.
const LIFE_JUMP: f64 = 0.15;

/// Halvings of a step that fails.
/// Kind: cap.
const LIFE_HALVINGS: usize = 40;

/// Kind of an event: a change of a contact, of the motion, or of the amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LifeEventKind {
    /// A contact begins to slip.
    Slips,
    /// A contact ends to slip: it sticks, or is open all the time.
    Sticks,
    /// A contact loses its load.
    Lost,
    /// A contact gets load again.
    Pressed,
    /// The amplitude passes the limit.
    Limit,
    /// The motion that was followed ends, as at a fold, or where a peak meets a minimum. Amplitude and works jump,
    /// and the life continues with the motion that is found.
    Jumps,
}

/// An event in the life of a machine.
#[derive(Clone, Copy, Debug)]
pub struct LifeEvent {
    /// Number of cycles at the event.
    pub cycles: f64,
    /// Kind of the event.
    pub kind: LifeEventKind,
    /// Index of the contact in the model; `None` for an event of the amplitude.
    pub contact: Option<usize>,
}

/// State at a requested number of cycles, with the contacts in the order of [`LifeOptions::wear`].
#[derive(Clone, Debug)]
pub struct LifePoint {
    /// Number of cycles of the life so far.
    pub cycles: f64,
    /// Worn depth of each contact.
    pub depths: Vec<f64>,
    /// Static normal load of each contact.
    pub loads: Vec<f64>,
    /// Work of friction of each contact per cycle.
    pub works: Vec<f64>,
    /// Amplitude of the vibration.
    pub amplitude: f64,
    /// Angular frequency of the vibration.
    pub omega: f64,
}

/// Vibration over the life of a machine.
#[derive(Clone, Debug)]
pub struct Life {
    /// States at the requested cycles, as many as were reached.
    pub points: Vec<LifePoint>,
    /// Events of the life, by rising cycles.
    pub events: Vec<LifeEvent>,
    /// Number of cycles that were reached.
    pub reached: f64,
    /// Largest amplitude and the cycles at which it occurs.
    pub largest: (f64, f64),
    /// Amplitude at the beginning and at the end of the life.
    pub ends: (f64, f64),
    /// Number of steps that were taken.
    pub steps: usize,
    /// Number of steady vibrations that were solved.
    pub solutions: usize,
    /// `Ok`, or why the life ended early: `StoppedByCaller`, `StoppedMaxPoints`, `StoppedStepTooSmall`.
    pub status: Status,
    /// Reason of a status that is not `Ok`.
    pub reason: Option<Error>,
    depths: Vec<f64>,
}

impl Life {
    /// Worn depths at the end, with which another life may continue.
    #[must_use]
    pub fn depths(&self) -> &[f64] {
        &self.depths
    }
}

/// Follows the wear of contacts over the cycles of a life. Progress reports each step with its cycles as `parameter`.
///
/// Wear between two states is small in practice: a state is the steady vibration under the loads of its cycles. Wear by the work of
/// friction is Fouvry's law, <https://doi.org/10.1016/S0043-1648(03)00117-0>; with constant pressure and friction it is Archard's.
///
/// # Errors
/// Those of [`LifeOptions::check`] and of the first steady vibration; `Unsupported` for contacts whose load follows a speed that is tied to
/// the frequency. Later failures end the life with a status.
pub fn life(model: &Model, solver: &SolverOptions, options: &LifeOptions<'_>, hooks: &mut Hooks<'_>) -> Result<Life> {
    let mut states = WornStates::new(model, solver, options)?;
    let depths = if options.worn.is_empty() {
        try_vec(states.len(), 0.0, CONTEXT)?
    } else {
        try_copy(options.worn, CONTEXT)?
    };
    let first = LifeState {
        n: 0.0,
        worn: states.at(&depths, None, hooks)?,
        depths,
    };
    let mut walk = LifeWalk {
        found: Life {
            points: Vec::new(),
            events: Vec::new(),
            reached: 0.0,
            largest: (first.worn.amplitude, 0.0),
            ends: (first.worn.amplitude, first.worn.amplitude),
            steps: 0,
            solutions: 0,
            status: Status::Ok,
            reason: None,
            depths: Vec::new(),
        },
        options,
        states,
    };
    let ended = walk.run(first, hooks);
    walk.found.solutions = walk.states.solutions;
    if let Err(e) = ended {
        if matches!(e.status, Status::OutOfMemory | Status::Internal | Status::Callback) {
            return Err(e);
        }
        // A vibration that is not found on the way ends the life as a step that is too small.
        let status = if (e.status as i32) < 0 {
            Status::StoppedStepTooSmall
        } else {
            e.status
        };
        walk.found.status = status;
        walk.found.reason = Some(Error::new(status, format_args!("{e}")));
    }
    Ok(walk.found)
}

struct LifeWalk<'a> {
    states: WornStates<'a>,
    options: &'a LifeOptions<'a>,
    found: Life,
}

impl LifeWalk<'_> {
    fn run(&mut self, mut at: LifeState, hooks: &mut Hooks<'_>) -> Result<()> {
        let end = self.options.cycles.last().copied().unwrap_or(0.0);
        self.found.depths = try_copy(&at.depths, CONTEXT)?;
        while self.options.cycles.get(self.found.points.len()) == Some(&0.0) {
            self.push(&at, None, 0.0)?;
        }
        let mut last: Option<LifeStep> = None;
        let mut delta = self.first_length(&at, end);
        let mut halvings = 0;
        let mut refusals = Refusals::default();
        // The event that lies ahead, once a step has met it, and the cycles at which the motion seems another one.
        let mut met: Option<f64> = None;
        let mut broken: Option<(f64, Doubt)> = None;
        let tolerance = LIFE_STEP_SHARE * self.options.tolerance;
        // Length and error over the tolerance of the step before.
        let mut before: Option<(f64, f64)> = None;
        while at.n < end {
            hooks.interrupt().phase(Phase::Continuation, at.n / end)?;
            self.may_go_on(&mut refusals, at.n, end)?;
            let rest = end - at.n;
            if let Some(event) = met {
                let (distance, across) = (event - at.n, self.length_across(&at, rest)?);
                if distance <= across {
                    at = self.across(&at, event, across, hooks)?;
                    (last, met, broken, before) = (None, None, None, None);
                    delta = self.first_length(&at, end - at.n);
                    continue;
                }
                delta = delta.min(distance - LIFE_APPROACH * across);
            }
            if let Some((other, doubt)) = broken {
                // Twice the length of a jump: its half is one, and rounding of the cycles does not matter.
                if other - at.n <= 2.0 * self.length_of_jump(&at) {
                    at = self.jump(&at, other, hooks)?;
                    (last, met, broken, before) = (None, None, None, None);
                    delta = self.first_length(&at, end - at.n);
                    continue;
                }
                delta = match doubt {
                    Doubt::Rest => other - at.n,
                    Doubt::Half | Doubt::None => delta.min(0.5 * (other - at.n)),
                };
            }
            let length = length_of(delta, rest, met.is_some() || broken.is_some());
            let step = match LifeStep::take(&mut self.states, &at, length, last.as_ref(), tolerance, hooks) {
                Err(e) if matches!(e.status, Status::StoppedByCaller | Status::OutOfMemory) => return Err(e),
                Ok(Taken::Step(step)) => step,
                Ok(Taken::Refused(share)) => {
                    delta = length * (0.9 * share.powf(-0.2)).clamp(0.1, 0.9);
                    broken = self.too_short(&at, length).or(Doubt::too_long(broken));
                    continue;
                }
                Ok(Taken::Broken) => {
                    let doubt = broken.map_or(Doubt::Half, |(_, doubt)| doubt.again());
                    broken = Some((at.n + length, doubt));
                    continue;
                }
                failed => {
                    halvings += 1;
                    if halvings > LIFE_HALVINGS {
                        let reason = failed.err().map_or_else(String::new, |e| format!(": {e}"));
                        return Err(Error::new(
                            Status::StoppedStepTooSmall,
                            format_args!("the life does not go on at {} cycles{reason}", at.n),
                        ));
                    }
                    delta = 0.5 * length;
                    continue;
                }
            };
            if let Some(event) = self.event(&at, last.as_ref(), &step, hooks)? {
                // Steps before an event know nothing of what follows it. One that is met again is nearer than it seemed.
                halvings += 1;
                if halvings > LIFE_HALVINGS {
                    return Err(Error::new(
                        Status::StoppedStepTooSmall,
                        format_args!("the life does not pass a change of a contact at {} cycles", at.n),
                    ));
                }
                met = Some(event);
                delta = if event < step.to.n { length } else { 0.5 * length };
                continue;
            }
            let (error, power) = step.error(&self.states, last.as_ref())?;
            let share = error / tolerance;
            if share > 1.0 {
                delta = length * growth(share, power, None).clamp(0.1, 0.9);
                broken = self.too_short(&at, length).or(Doubt::too_long(broken));
                continue;
            }
            halvings = 0;
            self.record(&step, hooks)?;
            let steps = before.map(|(length, earlier)| (step.length() / length, earlier));
            delta = length * growth(share, power, steps).clamp(0.2, 4.0);
            before = (power == 5).then_some((step.length(), share));
            broken = broken.and_then(|(other, doubt)| doubt.after(other, step.to.n));
            at = step.to.clone();
            last = Some(step);
        }
        Ok(())
    }

    /// Refuses a further step at n cycles if there are too many steps, or too many refused ones in a row.
    fn may_go_on(&self, refusals: &mut Refusals, n: f64, end: f64) -> Result<()> {
        if self.found.steps >= self.options.most_steps {
            return Err(Error::new(
                Status::StoppedMaxPoints,
                format_args!("the life has {} steps at {n} of {end} cycles", self.found.steps),
            ));
        }
        if refusals.are_too_many(self.found.steps) {
            return Err(Error::new(
                Status::StoppedStepTooSmall,
                format_args!("the life does not go on at {n} cycles after {LIFE_TRIES} steps that were refused"),
            ));
        }
        Ok(())
    }

    /// Length of the first step: a step of second order has about the requested error.
    fn first_length(&self, at: &LifeState, rest: f64) -> f64 {
        let speed = at.size_of(&self.states, &at.worn.rate);
        if speed > 0.0 {
            (self.options.tolerance.powf(0.25) / speed).min(rest)
        } else {
            rest
        }
    }

    /// Number of cycles within which a jump is located.
    fn length_of_jump(&self, at: &LifeState) -> f64 {
        let speed = at.size_of(&self.states, &at.worn.rate);
        (LIFE_JUMP * self.options.tolerance / speed.max(f64::MIN_POSITIVE)).max(4.0 * f64::EPSILON * at.n)
    }

    /// The end of a refused step that is no longer than the width of a jump: within one motion rates cannot change so
    /// quickly.
    fn too_short(&self, at: &LifeState, length: f64) -> Option<(f64, Doubt)> {
        (length <= self.length_of_jump(at)).then_some((at.n + length, Doubt::None))
    }

    /// The state just after the motion has jumped, so near that rates are constant up to it. Where a still shorter
    /// step shows that the motion continues, there is no event.
    fn jump(&mut self, at: &LifeState, n: f64, hooks: &mut Hooks<'_>) -> Result<LifeState> {
        let mut depths = try_copy(&at.depths, CONTEXT)?;
        for (h, rate) in depths.iter_mut().zip(&at.worn.rate) {
            *h += (n - at.n) * rate;
        }
        let to = LifeState {
            n,
            worn: self.states.at(&depths, Some(at.near()), hooks)?,
            depths,
        };
        self.tell(&at.worn, &to.worn, n)?;
        self.tell_jump(at, &to)?;
        let step = LifeStep::short(at, to)?;
        self.record(&step, hooks)?;
        Ok(step.to)
    }

    /// Records a jump where two neighbouring states do not belong to one motion.
    fn tell_jump(&mut self, at: &LifeState, to: &LifeState) -> Result<()> {
        if at.goes_on_to(to, &self.states, self.options.tolerance)? {
            return Ok(());
        }
        // Next to a fold the motion may jump to the unstable one, which ends there, too: that is one jump.
        let near = to.n - 4.0 * self.length_of_jump(at);
        let told = self.found.events.last();
        if told.is_some_and(|event| event.kind == LifeEventKind::Jumps && event.cycles >= near) {
            return Ok(());
        }
        let event = LifeEvent {
            cycles: to.n,
            kind: LifeEventKind::Jumps,
            contact: None,
        };
        try_push(&mut self.found.events, event, CONTEXT)
    }

    /// Number of cycles before and after an event that a straight step may span: over twice this length, its error is
    /// the allowed share of the tolerance.
    fn length_across(&self, at: &LifeState, length: f64) -> Result<f64> {
        let bent = at.size_of(&self.states, &at.second()?);
        Ok((0.5 * LIFE_NEGLIGIBLE * self.options.tolerance / bent)
            .sqrt()
            .min(length))
    }

    /// Number of cycles at which a contact changes its state within a step, if one does. The work of a slipping
    /// contact, or its load, is followed to 0 along the path of the states before, by Newton's method within a
    /// bracket.
    fn event(
        &mut self,
        at: &LifeState,
        last: Option<&LifeStep>,
        step: &LifeStep,
        hooks: &mut Hooks<'_>,
    ) -> Result<Option<f64>> {
        if !at.worn.changes(&step.to.worn) {
            return Ok(None);
        }
        let (mut low, mut high) = (at.n, step.to.n);
        let mut n = high;
        let across = self.length_across(at, step.length())?;
        for tries in 0..LIFE_EVENT_TRIES {
            // The end of the step is the first probe.
            let probe = if tries == 0 {
                step.to.clone()
            } else {
                let depths = ahead(at, last, n - at.n)?;
                LifeState {
                    n,
                    worn: self.states.at(&depths, Some(at.near()), hooks)?,
                    depths,
                }
            };
            let changed = at.worn.changes(&probe.worn);
            if changed {
                high = n;
            } else {
                low = n;
            }
            let root = self.estimate(at, &probe).filter(|root| *root >= low && *root <= high);
            let close = root.is_some_and(|root| (root - n).abs() <= 0.5 * across);
            if close || high - low <= across {
                return Ok(Some(root.unwrap_or(high)));
            }
            n = root
                .unwrap_or(0.5 * (low + high))
                .clamp(low + 1e-3 * (high - low), high - 1e-3 * (high - low));
        }
        Ok(Some(high))
    }

    /// Estimate of the cycles at which a contact changes its state, by Newton's method from a probe at which the
    /// value is not 0 yet.
    fn estimate(&self, at: &LifeState, probe: &LifeState) -> Option<f64> {
        let (a, b) = (&at.worn, &probe.worn);
        let count = a.slips.len();
        let mut first: Option<f64> = None;
        for j in 0..count {
            let root = if a.lost[j] != b.lost[j] {
                let [from, to] = [at, probe].map(|state| self.states.raw_load(j, &state.depths));
                at.n + (probe.n - at.n) * from / (from - to)
            } else if b.slips[j] {
                let slope: f64 = (0..count).map(|k| b.work_by_depth[k * count + j] * b.rate[k]).sum();
                if a.slips[j] && slope >= 0.0 {
                    continue;
                }
                probe.n - b.works[j] / slope
            } else {
                continue;
            };
            // A contact that slips already ends to do so in the future.
            if root.is_finite() && (!a.slips[j] || root > probe.n || a.lost[j] != b.lost[j]) {
                first = Some(first.map_or(root, |other: f64| other.min(root)));
            }
        }
        first
    }

    /// The state a short distance after an event, whose changes are recorded.
    fn across(&mut self, at: &LifeState, event: f64, beyond: f64, hooks: &mut Hooks<'_>) -> Result<LifeState> {
        let end = self.options.cycles.last().copied().unwrap_or(at.n);
        let mut length = ((event - at.n).max(0.0) + beyond).min(end - at.n);
        for _ in 0..LIFE_HALVINGS {
            let mut depths = try_copy(&at.depths, CONTEXT)?;
            for (h, rate) in depths.iter_mut().zip(&at.worn.rate) {
                *h += length * rate;
            }
            let to = LifeState {
                n: if length < end - at.n { at.n + length } else { end },
                worn: self.states.at(&depths, Some(at.near()), hooks)?,
                depths,
            };
            if at.worn.changes(&to.worn) {
                // Next to the event the state tells it best.
                let root = self.estimate(at, &to).unwrap_or(event);
                self.tell(&at.worn, &to.worn, root.clamp(at.n, to.n))?;
                self.tell_jump(at, &to)?;
            } else if to.n < end {
                length = (2.0 * length).min(end - at.n);
                continue;
            }
            let step = LifeStep::short(at, to)?;
            self.record(&step, hooks)?;
            return Ok(step.to);
        }
        Err(Error::new(
            Status::StoppedStepTooSmall,
            format_args!("the life does not pass a change of a contact at {} cycles", at.n),
        ))
    }

    /// Records the changes of contacts between two states as events.
    fn tell(&mut self, a: &WornState, b: &WornState, cycles: f64) -> Result<()> {
        for (j, wear) in self.options.wear.iter().enumerate() {
            let kind = match (a.lost[j], b.lost[j], a.slips[j], b.slips[j]) {
                (false, true, ..) => LifeEventKind::Lost,
                (true, false, ..) => LifeEventKind::Pressed,
                (_, _, false, true) => LifeEventKind::Slips,
                (_, _, true, false) => LifeEventKind::Sticks,
                _ => continue,
            };
            let event = LifeEvent {
                cycles,
                kind,
                contact: Some(wear.contact),
            };
            try_push(&mut self.found.events, event, CONTEXT)?;
        }
        Ok(())
    }

    /// Records the states at the requested cycles within a step.
    fn record(&mut self, step: &LifeStep, hooks: &mut Hooks<'_>) -> Result<()> {
        self.found.steps += 1;
        while let Some(&n) = self.options.cycles.get(self.found.points.len()) {
            if n > step.to.n {
                break;
            }
            self.push(&step.to, Some(step), n)?;
        }
        let (from, to) = (step.from.n, step.to.n);
        for at in turning(step) {
            let amplitude = step.amplitude(at);
            if amplitude > self.found.largest.0 {
                self.found.largest = (amplitude, at);
            }
        }
        let limit = self.options.limit;
        let (a, b) = (step.from.worn.amplitude - limit, step.to.worn.amplitude - limit);
        if limit > 0.0 && (a < 0.0) != (b < 0.0) {
            let cycles = root((from, a), (to, b), |n| Ok::<_, Error>(step.amplitude(n) - limit))?;
            let event = LifeEvent {
                cycles,
                kind: LifeEventKind::Limit,
                contact: None,
            };
            try_push(&mut self.found.events, event, CONTEXT)?;
            self.found.events.sort_by(|a, b| a.cycles.total_cmp(&b.cycles));
        }
        self.found.reached = to;
        self.found.ends.1 = step.to.worn.amplitude;
        self.found.depths = try_copy(&step.to.depths, CONTEXT)?;
        let end = self.options.cycles.last().copied().unwrap_or(to);
        let progress = Progress {
            point: self.found.steps,
            parameter: to,
            amplitude: step.to.worn.amplitude,
            step: step.length(),
            fraction_done: to / end,
            ..Progress::default()
        };
        if hooks.report(&progress) {
            return Err(Error::new(
                Status::StoppedByCaller,
                format_args!("stopped by the caller at {to} cycles"),
            ));
        }
        Ok(())
    }

    /// Records the state at n cycles, by interpolation within a step, or at its end.
    fn push(&mut self, at: &LifeState, step: Option<&LifeStep>, n: f64) -> Result<()> {
        let within = step.filter(|_| n.to_bits() != at.n.to_bits());
        let depths = match within {
            Some(step) => step.depths(n)?,
            None => try_copy(&at.depths, CONTEXT)?,
        };
        let rates = match within {
            Some(step) => step.rates(n)?,
            None => try_copy(&at.worn.rate, CONTEXT)?,
        };
        let mut loads = try_vec(depths.len(), 0.0, CONTEXT)?;
        let mut works = try_vec(depths.len(), 0.0, CONTEXT)?;
        for (j, wear) in self.options.wear.iter().enumerate() {
            let load = self.states.raw_load(j, &depths);
            loads[j] = if at.worn.lost[j] { 0.0 } else { load };
            works[j] = if wear.rate > 0.0 {
                rates[j] * wear.area / wear.rate
            } else {
                at.worn.works[j]
            };
        }
        let omega = within.map_or(at.worn.omega, |step| step.omega(n));
        let point = LifePoint {
            cycles: n,
            depths,
            loads,
            works,
            amplitude: within.map_or(at.worn.amplitude, |step| step.amplitude(n)),
            omega,
        };
        try_push(&mut self.found.points, point, CONTEXT)
    }
}

/// Numbers of cycles of a step's two ends and of the turning points of its amplitude, by the cubic.
fn turning(step: &LifeStep) -> impl Iterator<Item = f64> {
    let (from, delta) = (step.from.n, step.length());
    let (a0, a1) = (step.from.worn.amplitude, step.to.worn.amplitude);
    let (g0, g1) = (delta * step.from.amplitude_slope(), delta * step.to.amplitude_slope());
    // The derivative g0 + 2 b s + 3 c s².
    let (b, c) = (3.0 * (a1 - a0) - 2.0 * g0 - g1, 2.0 * (a0 - a1) + g0 + g1);
    let root = (b * b - 3.0 * c * g0).max(0.0).sqrt();
    let q = -(b + b.signum() * root);
    [1.0, q / (3.0 * c), g0 / q]
        .into_iter()
        .filter(|s| *s > 0.0 && *s <= 1.0)
        .map(move |s| from + s * delta)
}
