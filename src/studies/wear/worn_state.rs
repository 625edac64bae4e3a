//! The steady vibration of a model whose contacts have worn: works of the contacts, rates of wear and their exact derivatives.

use crate::analysis::forced_response::forced_response;
use crate::at_a_point::sensitivity_analysis::{Quantity, sensitivity_with};
use crate::contact::forms::constants::Constant;
use crate::error::{Error, Result, Status, fail, try_push, try_vec};
use crate::hooks::Hooks;
use crate::interrupt::Interrupt;
use crate::model::Model;
use crate::model::matrices::speed::Speed;
use crate::options::{Duty, ForcedOptions, LifeFollow, LifeOptions, SolverOptions};
use crate::results::{Branch, Special};
use crate::sensitivity::{Adjoint, ForcedPoint, Parameter, SampledModel, TotalDerivative, work_at_fixed_motion};
use num_complex::Complex64;
use std::rc::Rc;

const CONTEXT: &str = "the state of a life";

/// Half widths of the ranges, relative to the frequency, in which a peak is sought again: a wider one where the narrower has none.
/// Kind: tuned; measured on: not recorded.
const PEAK_WINDOWS: [f64; 3] = [0.02, 0.1, 0.4];

/// A state of a life: worn depths and the vibration with them.
#[derive(Clone, Debug)]
pub(crate) struct WornState {
    /// Normal loads of the contacts that wear, at least 0 where a law has no gap.
    pub loads: Vec<f64>,
    /// Work of friction of each contact per cycle.
    pub works: Vec<f64>,
    /// Rates of wear f = h′: depth of each contact per cycle.
    pub rate: Vec<f64>,
    /// Derivatives ∂f/∂h of the rates by the depths, column-major.
    pub rate_by_depth: Vec<f64>,
    /// Derivatives ∂E/∂h of the works by the depths, column-major.
    pub work_by_depth: Vec<f64>,
    /// Amplitude of the vibration; the largest one over several duties.
    pub amplitude: f64,
    /// Derivatives of the amplitude by the depths.
    pub amplitude_by_depth: Vec<f64>,
    /// Angular frequency of the vibration with this amplitude.
    pub omega: f64,
    /// Derivatives of a peak's frequency by the depths.
    pub omega_by_depth: Vec<f64>,
    /// Whether each contact slips in the cycle.
    pub slips: Vec<bool>,
    /// Whether each contact has lost its load.
    pub lost: Vec<bool>,
    /// Harmonics of the vibration of each duty, as guesses for states nearby; empty ones give no guess.
    motions: Rc<Vec<Vec<Complex64>>>,
}

impl WornState {
    /// Whether a contact slips, or has lost its load, in one of two states and not in the other.
    pub fn changes(&self, other: &Self) -> bool {
        self.slips != other.slips || self.lost != other.lost
    }

    /// Shares of the changes of amplitude and works that are unexplained if another state, at a change of the depths,
    /// continued this one. The mean of the derivatives at both ends leaves a part of third order in the change of the
    /// depths; it is compared with the larger of the change itself and the mean of the moduli. Both are relative to
    /// the amplitude, or to the largest work, at least `work`.
    pub fn breaks(&self, other: &Self, change: &[f64], work: f64) -> (f64, f64) {
        let n = change.len();
        let mut worst = (0.0_f64, 0.0_f64);
        let mut part = |[from, to]: [f64; 2], [begin, end]: [f64; 2], unit: f64| {
            let left = (to - from - 0.5 * (begin + end)).abs() / unit;
            if unit > 0.0 && left > worst.0 {
                worst = (left, (to - from).abs().max(0.5 * (begin.abs() + end.abs())) / unit);
            }
        };
        let along = |by_depth: &[f64], j: usize, rows: usize| -> f64 {
            by_depth
                .iter()
                .skip(j)
                .step_by(rows)
                .zip(change)
                .map(|(by, h)| by * h)
                .sum()
        };
        let both = [self, other];
        let unit = both.iter().fold(0.0_f64, |most, state| most.max(state.amplitude.abs()));
        part(
            both.map(|state| state.amplitude),
            both.map(|state| along(&state.amplitude_by_depth, 0, 1)),
            unit,
        );
        let unit = self
            .works
            .iter()
            .chain(&other.works)
            .fold(work, |most, work| most.max(*work));
        for j in 0..n {
            part(
                both.map(|state| state.works[j]),
                both.map(|state| along(&state.work_by_depth, j, n)),
                unit,
            );
        }
        worst
    }
}

/// Works, amplitude and derivatives by the loads at one steady vibration.
struct Vibration {
    works: Vec<f64>,
    /// Derivatives ∂E_j/∂N_k of the works by the loads, at index k n + j.
    work_by_load: Vec<f64>,
    amplitude: f64,
    amplitude_by_load: Vec<f64>,
    omega: f64,
    omega_by_load: Vec<f64>,
    slips: Vec<bool>,
}

/// Solves the steady vibrations of one life.
pub(crate) struct WornStates<'a> {
    model: &'a Model,
    solver: SolverOptions,
    options: &'a LifeOptions<'a>,
    /// Normal loads of the new machine.
    new: Vec<f64>,
    /// Number of steady vibrations solved so far.
    pub solutions: usize,
    /// Largest friction force of the first state, from its work and amplitude: the scale of loads whose static value
    /// is 0.
    friction: Option<f64>,
}

impl<'a> WornStates<'a> {
    /// Checks the options, and reads the normal loads of the new machine.
    ///
    /// # Errors
    /// Those of the options and of the solver; `Unsupported` for a load that follows a speed which is tied to the frequency.
    pub fn new(model: &'a Model, solver: &SolverOptions, options: &'a LifeOptions<'a>) -> Result<Self> {
        solver.check()?;
        options.check(model)?;
        let mut new = Vec::new();
        for wear in options.wear {
            let tied = matches!(model.speed(), Speed::PerOmega(_));
            if tied && model.speed_loads().iter().any(|load| load.contact == wear.contact) {
                return fail!(
                    Unsupported,
                    "the load of contact {} follows a speed that is tied to the frequency; needs a fixed speed",
                    wear.contact
                );
            }
            try_push(&mut new, model.contacts()[wear.contact].load(), CONTEXT)?;
        }
        Ok(Self {
            model,
            // A life asks for no stability and no freedom of its vibrations.
            solver: SolverOptions {
                stability: None,
                freedom: false,
                ..*solver
            },
            options,
            new,
            solutions: 0,
            friction: None,
        })
    }

    /// Number of contacts that wear.
    pub fn len(&self) -> usize {
        self.options.wear.len()
    }

    /// Static stiffness S between the normals of contacts i and j.
    pub fn stiffness(&self, i: usize, j: usize) -> f64 {
        let n = self.len();
        match self.options.stiffness.get(j * n + i) {
            Some(s) => *s,
            None if i == j => self.kn(i),
            None => 0.0,
        }
    }

    fn kn(&self, i: usize) -> f64 {
        self.model.contacts()[self.options.wear[i].contact].constant(Constant::Kn)
    }

    /// The largest load without wear, or the friction force where that is larger, as in a patch that forces press: the unit of errors of
    /// loads.
    pub fn load_unit(&self) -> f64 {
        let friction = self.friction.unwrap_or(0.0);
        self.new.iter().fold(friction, |most, n| most.max(n.abs()))
    }

    /// Unit of works: a quarter of the largest work of the first state, scaled to the amplitude of a state.
    pub fn work_unit(&self, amplitude: f64) -> f64 {
        self.friction.unwrap_or(0.0) * amplitude.abs()
    }

    /// Load of contact i at given depths, which may be negative.
    pub fn raw_load(&self, i: usize, depths: &[f64]) -> f64 {
        let lost: f64 = depths.iter().enumerate().map(|(j, h)| self.stiffness(i, j) * h).sum();
        self.new[i] - lost
    }

    /// The model with the loads that remain at given depths.
    ///
    /// # Errors
    /// Those of the constants; `OutOfMemory`.
    pub fn worn_model(&self, depths: &[f64]) -> Result<Model> {
        let mut model = self.model.separate_clone()?;
        for (i, wear) in self.options.wear.iter().enumerate() {
            model.set_worn_load(wear.contact, self.raw_load(i, depths))?;
        }
        Ok(model)
    }

    /// The steady vibration at given depths; `near` is the state at depths nearby, from which it is continued.
    ///
    /// # Errors
    /// Those of the solver; `StoppedNoPeak` where there is no peak.
    pub fn at(
        &mut self,
        depths: &[f64],
        near: Option<(&WornState, &[f64])>,
        hooks: &mut Hooks<'_>,
    ) -> Result<WornState> {
        let n = self.len();
        self.solutions += 1;
        let model = self.worn_model(depths)?;
        let mut loads = try_vec(n, 0.0, CONTEXT)?;
        let mut lost = try_vec(n, false, CONTEXT)?;
        for i in 0..n {
            loads[i] = self.raw_load(i, depths);
            if self.kn(i) <= 0.0 {
                lost[i] = loads[i] <= 0.0;
                loads[i] = loads[i].max(0.0);
            }
        }
        let mut state = WornState {
            loads,
            works: try_vec(n, 0.0, CONTEXT)?,
            rate: try_vec(n, 0.0, CONTEXT)?,
            rate_by_depth: try_vec(n * n, 0.0, CONTEXT)?,
            work_by_depth: try_vec(n * n, 0.0, CONTEXT)?,
            amplitude: f64::NEG_INFINITY,
            amplitude_by_depth: try_vec(n, 0.0, CONTEXT)?,
            omega: 0.0,
            omega_by_depth: try_vec(n, 0.0, CONTEXT)?,
            slips: try_vec(n, false, CONTEXT)?,
            lost,
            motions: Rc::default(),
        };
        match self.options.follow {
            LifeFollow::Peak {
                omega_start,
                omega_stop,
            } => {
                let near = near.map(|(state, at)| {
                    let by_depth = state.omega_by_depth.iter().zip(depths.iter().zip(at));
                    let shift: f64 = by_depth.map(|(by, (to, from))| by * (to - from)).sum();
                    state.omega + if shift.abs() < 0.1 * state.omega { shift } else { 0.0 }
                });
                let found = self.peak(&model, &state, (omega_start, omega_stop), near, hooks)?;
                self.add(&mut state, &found, 1.0);
            }
            LifeFollow::Duties(duties) => {
                let total: f64 = duties.iter().map(|duty| duty.share * duty.omega).sum();
                let mut motions = Vec::new();
                for (d, duty) in duties.iter().enumerate() {
                    let guess = near.and_then(|(state, _)| state.motions.get(d));
                    let (found, motion) = self.duty(&model, &state, duty, guess, hooks)?;
                    try_push(&mut motions, motion, CONTEXT)?;
                    self.add(&mut state, &found, duty.share * duty.omega / total);
                }
                state.motions = Rc::new(motions);
            }
        }
        if self.friction.is_none() {
            // A work is at most four times force and amplitude of the contact, which is taken to be that of the response.
            let most = state.works.iter().fold(0.0_f64, |most, work| most.max(*work));
            let force = 0.25 * most / state.amplitude.abs().max(f64::MIN_POSITIVE);
            self.friction = Some(if force.is_finite() { force } else { 0.0 });
        }
        for (j, wear) in self.options.wear.iter().enumerate() {
            let factor = wear.rate / wear.area;
            state.rate[j] = factor * state.works[j];
            for k in 0..n {
                state.rate_by_depth[k * n + j] = factor * state.work_by_depth[k * n + j];
            }
        }
        Ok(state)
    }

    /// Adds the vibration of a duty with its share of the cycles, and its derivatives by the depths: ∂/∂h = −S ∂/∂N.
    fn add(&self, state: &mut WornState, found: &Vibration, share: f64) {
        let n = self.len();
        let largest = found.amplitude > state.amplitude;
        if largest {
            state.amplitude = found.amplitude;
            state.omega = found.omega;
            state.amplitude_by_depth.fill(0.0);
            state.omega_by_depth.fill(0.0);
        }
        for j in 0..n {
            state.slips[j] |= found.slips[j] && share > 0.0;
            state.works[j] += share * found.works[j];
        }
        for k in 0..n {
            if state.lost[k] {
                continue;
            }
            for l in 0..n {
                let s = self.stiffness(k, l);
                if s == 0.0 {
                    continue;
                }
                for j in 0..n {
                    state.work_by_depth[l * n + j] -= share * s * found.work_by_load[k * n + j];
                }
                if largest {
                    state.amplitude_by_depth[l] -= s * found.amplitude_by_load[k];
                    state.omega_by_depth[l] -= s * found.omega_by_load[k];
                }
            }
        }
    }

    /// Keeps the response degree of freedom of the first solution in the options.
    fn keep(&mut self, branch: &Branch) {
        self.solver.response_dof = Some(branch.response_dof());
    }

    /// The vibration of a duty; and its harmonics as a guess for the next one.
    fn duty(
        &mut self,
        model: &Model,
        state: &WornState,
        duty: &Duty,
        guess: Option<&Vec<Complex64>>,
        hooks: &mut Hooks<'_>,
    ) -> Result<(Vibration, Vec<Complex64>)> {
        let scaled;
        let model = if duty.force.to_bits() == 1.0_f64.to_bits() {
            model
        } else {
            let mut other = model.try_clone()?;
            other.scale_forces(duty.force)?;
            scaled = other;
            &scaled
        };
        let options = ForcedOptions {
            omega_start: duty.omega,
            omega_stop: duty.omega,
            ..ForcedOptions::default()
        };
        let guessed = ForcedOptions {
            guess: guess.map(Vec::as_slice).filter(|guess| !guess.is_empty()),
            ..options
        };
        let mut branch = quietly(model, &self.solver, &guessed, hooks);
        if branch.is_err() && guessed.guess.is_some() {
            branch = quietly(model, &self.solver, &options, hooks);
        }
        let branch = whole(branch?)?;
        self.keep(&branch);
        let mut x = try_vec((branch.harmonics() + 1) * branch.ndof(), Complex64::ZERO, CONTEXT)?;
        branch.harmonics_at(0, &mut x)?;
        // A guess brings the harmonics that it has: none that vanish by symmetry.
        let motion = if branch
            .carried_at(0)
            .is_some_and(|carried| carried.len() == branch.harmonics() + 1)
        {
            x
        } else {
            Vec::new()
        };
        let at = (&branch, 0, branch.stored_amplitude(0));
        let found = self.vibration(model, state, at, None, &hooks.interrupt())?;
        Ok((found, motion))
    }

    /// The vibration in the peak next to a frequency, or in the highest one of a range.
    fn peak(
        &mut self,
        model: &Model,
        state: &WornState,
        (start, stop): (f64, f64),
        near: Option<f64>,
        hooks: &mut Hooks<'_>,
    ) -> Result<Vibration> {
        let mut ranges = [(start, stop); 4];
        if let Some(omega) = near {
            for (range, width) in ranges.iter_mut().zip(PEAK_WINDOWS) {
                *range = ((1.0 - width) * omega, (1.0 + width) * omega);
            }
        }
        let wanted = if near.is_some() { &ranges[..] } else { &ranges[3..] };
        for &(omega_start, omega_stop) in wanted {
            let options = ForcedOptions {
                omega_start,
                omega_stop,
                ..ForcedOptions::default()
            };
            let branch = match quietly(model, &self.solver, &options, hooks) {
                Ok(branch) if branch.status() == Status::Ok => branch,
                Ok(branch) => {
                    whole(branch)?;
                    continue;
                }
                Err(e) if e.status == Status::StoppedByCaller => return Err(e),
                Err(_) => continue,
            };
            let peaks = branch.peaks().iter();
            let chosen: Option<&Special> = match near {
                None => peaks.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)),
                Some(omega) => peaks.min_by(|a, b| (a.omega - omega).abs().total_cmp(&(b.omega - omega).abs())),
            };
            let Some(&peak) = chosen else { continue };
            self.keep(&branch);
            let stop = hooks.interrupt();
            let parameters = self.parameters(model)?;
            let of = sensitivity_with(model, &branch, peak.point, &parameters, Quantity::PeakOmega, &stop)?;
            let mut by_load = of.values;
            for (k, value) in by_load.iter_mut().enumerate() {
                *value = if value.is_finite() {
                    *value * self.per_load(model, k)
                } else {
                    0.0
                };
            }
            let at = (&branch, peak.point, peak.amplitude);
            return self.vibration(model, state, at, Some(&by_load), &stop);
        }
        match near {
            Some(omega) => fail!(StoppedNoPeak, "the response has no peak near omega = {omega}"),
            None => fail!(
                StoppedNoPeak,
                "the response has no peak within omega = {start} .. {stop}: widen the range, or let the force act on the mode in it"
            ),
        }
    }

    /// The constants of the contacts through which their loads act: the normal load, or the gap where a law has one.
    fn parameters(&self, model: &Model) -> Result<Vec<Parameter<'static>>> {
        let mut parameters = Vec::new();
        for wear in self.options.wear {
            let constant = constant(model, wear.contact);
            let contact = Some(wear.contact);
            try_push(&mut parameters, Parameter::Contact { constant, contact }, CONTEXT)?;
        }
        Ok(parameters)
    }

    /// Change of that constant per change of the load of contact k.
    fn per_load(&self, model: &Model, k: usize) -> f64 {
        match constant(model, self.options.wear[k].contact) {
            Constant::Gap => -1.0 / self.kn(k),
            _ => 1.0,
        }
    }

    /// Works and derivatives at a point of a branch; `peak` is the derivative of its frequency by the loads.
    fn vibration(
        &self,
        model: &Model,
        state: &WornState,
        (branch, point, amplitude): (&Branch, usize, f64),
        peak: Option<&[f64]>,
        interrupt: &Interrupt<'_>,
    ) -> Result<Vibration> {
        let n = self.len();
        let (Some(omega), Some(u)) = (branch.omega_at(point), branch.motion_at(point)) else {
            return fail!(Internal, "a solution of a life is not stored");
        };
        let condensed = branch.condensed_at(point);
        if condensed.has_exchanges() {
            return fail!(
                Unsupported,
                "a contact is rigid or near-rigid, and its motion is that of a rigid one; a life needs a finite kt and fixed harmonics, tolerance = 0"
            );
        }
        let samples = branch.samples_at(point);
        let mut found = Vibration {
            works: try_vec(n, 0.0, CONTEXT)?,
            work_by_load: try_vec(n * n, 0.0, CONTEXT)?,
            amplitude,
            amplitude_by_load: try_vec(n, 0.0, CONTEXT)?,
            omega,
            omega_by_load: match peak {
                Some(shift) => crate::error::try_copy(shift, CONTEXT)?,
                None => try_vec(n, 0.0, CONTEXT)?,
            },
            slips: try_vec(n, false, CONTEXT)?,
        };
        let at_frequency = model.at_frequency(omega)?;
        let parameters = self.parameters(model)?;
        let solution = SampledModel { condensed, samples };
        let gradient = |adjoint: &Adjoint, values: &mut [f64]| -> Result<()> {
            let mut total = TotalDerivative::new(model, &at_frequency, solution, adjoint, interrupt)?;
            for (k, (value, parameter)) in values.iter_mut().zip(&parameters).enumerate() {
                let (by, _) = total.by(parameter)?;
                *value = if by.is_finite() {
                    by * self.per_load(model, k)
                } else {
                    0.0
                };
            }
            Ok(())
        };
        let mut at = ForcedPoint::new(condensed, branch.response_dof(), samples, omega, interrupt)?;
        let Some(adjoint) = at.adjoint(u, omega)? else {
            return fail!(Singular, "the vibration is at a fold, where wear would make it jump");
        };
        gradient(&adjoint, &mut found.amplitude_by_load)?;
        let slip = branch.slip_fraction_at(point).unwrap_or(&[]);

        let mut by_load = try_vec(n, 0.0, CONTEXT)?;
        for (j, wear) in self.options.wear.iter().enumerate() {
            let law = condensed.laws().iter().find(|law| law.contact == wear.contact);
            found.slips[j] = slip.get(wear.contact).is_some_and(|share| *share > 0.0) && !state.lost[j];
            let Some(law) = law.filter(|_| found.slips[j]) else {
                continue;
            };
            let (work, adjoint) = at.work(u, omega, law, samples)?;
            found.works[j] = work.max(0.0);
            gradient(&adjoint, &mut by_load)?;
            let own = constant(model, wear.contact);
            let of_load = work_at_fixed_motion(&at_frequency, wear.contact, own, solution, &adjoint, interrupt)?;
            by_load[j] += self.per_load(model, j) * of_load;
            for (k, by) in by_load.iter().enumerate() {
                let moves = peak.map_or(0.0, |shift| shift[k] * adjoint.by_omega);
                found.work_by_load[k * n + j] = by + moves;
            }
        }
        Ok(found)
    }
}

/// The constant through which the load of a contact acts.
fn constant(model: &Model, contact: usize) -> Constant {
    let contact = &model.contacts()[contact];
    if contact.constant(Constant::Kn) > 0.0 && contact.load() < 0.0 {
        Constant::Gap
    } else {
        Constant::Preload
    }
}

/// A forced response whose points are not reported to the caller.
fn quietly(
    model: &Model,
    solver: &SolverOptions,
    options: &ForcedOptions<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Branch> {
    let mut quiet = hooks.quiet();
    forced_response(model, solver, options, &mut quiet)
}

/// The branch, or an error if it ended early.
fn whole(branch: Branch) -> Result<Branch> {
    match branch.status() {
        Status::Ok => Ok(branch),
        status => Err(branch
            .reason()
            .cloned()
            .unwrap_or_else(|| Error::new(status, format_args!("the response of a life ended early")))),
    }
}
