//! Cycles, amplitudes and damage of a resonance over a mission, speed against time.
//!
//! The amplitude follows the slow flow of the mode, q′ = P (q − q_s), with the steady amplitude q_s = u₁ᴴF/Z and the slow root P at the
//! frequency of the time. A step is exact for q_s on a line and constant P, so that it is as long as the frequency allows: short against
//! its distance to the resonance, or the bandwidth, or the time in which the phase of a quick crossing turns. Dwells and slow changes cost
//! one step each. The memory of sliders is left out, which makes amplitudes and damage of quick passages too small; see
//! [`run_up`](crate::run_up).

use crate::error::{Result, fail, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::model::Model;
use crate::options::MissionOptions;
use crate::results::Branch;
use crate::studies::run_up::loaded;
use crate::studies::run_up::mode_table::{ModeTable, Oscillator, Place};
use crate::studies::run_up::other_modes::OtherModes;
use crate::studies::run_up::slow_flow::{slow_root, steady};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Change of the frequency in a step over its distance from the resonance, or the bandwidth.
/// Kind: tuned; measured on: an oscillator with one slider, as the next ones: its passages at 1e-5 to 1e-2 are within 5e-3 of the
/// slow flow, whose
/// harmonics they leave out.
const MISSION_STEP: f64 = 0.04;

/// Phase in which a quick crossing turns within a step, relative to the resonance.
/// Kind: tuned; measured on: the oscillator above.
const MISSION_PHASE: f64 = 0.15;

/// Bandwidths and quick widths (root of the rate) around the resonance in which steps are short.
/// Kind: tuned; measured on: the oscillator above.
const MISSION_NEAR: f64 = 12.0;

/// Share by which an amplitude may differ from the steady one. A dwell is settled below it; a crossing, whose rate over the square of the
/// bandwidth is about the share by which its amplitude lags, is steady below it. Chosen.
/// Kind: tuned; measured on: nothing, it is chosen.
const MISSION_STEADY: f64 = 1e-4;

/// Most steps of a mission.
/// Kind: cap; some minutes.
const MISSION_MOST_STEPS: usize = 50_000_000;

const CONTEXT: &str = "the mission";

/// A passage through the resonance.
#[derive(Clone, Copy, Debug)]
pub struct MissionCrossing {
    /// Time of the largest amplitude.
    pub time: f64,
    /// Angular frequency of the forces at this time.
    pub omega: f64,
    /// Rate dω/dt of the frequency at this time.
    pub rate: f64,
    /// Largest amplitude of the degree of freedom, in the fundamental.
    pub amplitude: f64,
    /// Amplitude of the highest steady resonance; NaN without a resonance.
    pub steady: f64,
    /// Number of cycles, around the largest one, with at least 1/√2 of the largest amplitude.
    pub cycles: f64,
}

/// Vibration in a mode over a mission.
#[derive(Clone, Debug)]
pub struct Mission {
    /// Amplitude of the degree of freedom at each time, in the fundamental.
    pub amplitude: Vec<f64>,
    /// Numbers of cycles with amplitudes below the first edge, between edges, and above the last one.
    pub cycles: Vec<f64>,
    /// Damage of each stress, as Miner's sum. No error is told; it is too small in quick passages.
    pub damage: Vec<f64>,
    /// Passages through the resonance, in the order of time.
    pub crossings: Vec<MissionCrossing>,
    /// Number of steps of the slow flow.
    pub steps: usize,
    /// Amplitude of the highest steady resonance over that of the computed resonance, minus 1; NaN without one.
    pub error: f64,
}

/// Follows the vibration in a mode through a mission.
///
/// # Errors
/// Those of [`MissionOptions::check`] and of [`synthesise`](crate::synthesise); `Unsupported` for an unbalance; `Argument` where the
/// amplitude leaves those of the mode; `StoppedByCaller`.
pub fn mission(
    branch: &Branch,
    model: &Model,
    options: &MissionOptions<'_>,
    interrupt: &Interrupt<'_>,
) -> Result<Mission> {
    options.check(model.ndof())?;
    if model.excitation().has_unbalance() {
        return fail!(Unsupported, "an unbalance follows the frequency, which changes");
    }
    let (load, highest) = loaded(branch, model, &options.synthesis, interrupt)?;
    let dof = options.dof.unwrap_or_else(|| branch.response_dof());
    let table = ModeTable::new(branch, model, (&load, &OtherModes::none()), (dof, &[]), interrupt)?;
    let mut steady_place = Place::default();
    let steady_amplitude = match &highest {
        Some(peak) => {
            table.find(peak.at.modal_amplitude, &mut steady_place)?;
            table.coefficient(&steady_place, 0, 1).norm()
        }
        None => f64::NAN,
    };
    let mut walk = MissionWalk {
        table: &table,
        options,
        place: Place::default(),
        steps: Vec::new(),
        found: Mission {
            amplitude: Vec::new(),
            cycles: try_vec(options.edges.len() + 1, 0.0, CONTEXT)?,
            damage: try_vec(options.stresses.len(), 0.0, CONTEXT)?,
            crossings: Vec::new(),
            steps: 0,
            error: highest.as_ref().map_or(f64::NAN, |peak| peak.validity.error),
        },
    };
    walk.run(interrupt)?;
    walk.crossings(steady_amplitude)?;
    Ok(walk.found)
}

/// One step: time and frequency at its end, amplitude, and number of cycles in it.
#[derive(Clone, Copy)]
struct Step {
    time: f64,
    omega: f64,
    rate: f64,
    amplitude: f64,
    cycles: f64,
    above: bool,
}

struct MissionWalk<'a> {
    table: &'a ModeTable,
    options: &'a MissionOptions<'a>,
    place: Place,
    steps: Vec<Step>,
    found: Mission,
}

impl MissionWalk<'_> {
    fn run(&mut self, interrupt: &Interrupt<'_>) -> Result<()> {
        let (times, speeds, order) = (self.options.times, self.options.speeds, self.options.engine_order);
        let mut q = steady(self.table, order * speeds[0])?;
        self.record(q)?;
        for i in 1..times.len() {
            interrupt.part(Phase::Results, i, times.len())?;
            let (begin, length) = (times[i - 1], times[i] - times[i - 1]);
            let (first, last) = (order * speeds[i - 1], order * speeds[i]);
            let rate = (last - first) / length;
            let mut time = 0.0;
            while time < length {
                interrupt.check_before(1)?;
                let omega = first + rate * time;
                let at = self.oscillator(q.norm())?;
                let rest = length - time;
                let mut step = longest_step(omega, rate, &at, q).min(rest);
                // No sliver is left.
                let ends = rest - step < 1e-9 * length;
                if ends {
                    step = rest;
                }
                let before = q;
                q = self.step(omega, rate, step, q)?;
                self.count((begin + time + step, omega + rate * step, rate, step), before, q)?;
                time = if ends { length } else { time + step };
                if self.found.steps > MISSION_MOST_STEPS {
                    return fail!(
                        Argument,
                        "more than {MISSION_MOST_STEPS} steps at time {}: the mission is too long for its rates",
                        begin + time
                    );
                }
            }
            self.record(q)?;
        }
        Ok(())
    }

    fn oscillator(&mut self, amplitude: f64) -> Result<Oscillator> {
        self.table.find(amplitude.max(f64::MIN_POSITIVE), &mut self.place)?;
        Ok(self.table.oscillator(&self.place))
    }

    fn record(&mut self, q: Complex64) -> Result<()> {
        self.table.find(q.norm().max(f64::MIN_POSITIVE), &mut self.place)?;
        let amplitude = self.table.coefficient(&self.place, 0, 1).norm();
        try_push(&mut self.found.amplitude, amplitude, CONTEXT)
    }

    /// Makes one step of the given length, with the oscillator at its beginning, then at its middle.
    fn step(&mut self, omega: f64, rate: f64, length: f64, q: Complex64) -> Result<Complex64> {
        let mut end = q;
        for _ in 0..2 {
            let at = self.oscillator(0.5 * (q.norm() + end.norm()))?;
            // Free vibration keeps its size while W changes: the term iW′ of Z and the change of P cancel.
            let target = |omega: f64| at.force / at.stiffness(omega);
            let middle = omega + 0.5 * rate * length;
            let root = slow_root(Complex64::new(at.viscous, 2.0 * middle), at.stiffness(middle));
            let (first, last) = (target(omega), target(omega + rate * length));
            let lag = (last - first) / (root * length);
            end = last + lag + (q - first - lag) * (root * length).exp();
        }
        Ok(end)
    }

    /// Counts the cycles of a step that ends at the given time and frequency.
    fn count(
        &mut self,
        (time, omega, rate, length): (f64, f64, f64, f64),
        before: Complex64,
        after: Complex64,
    ) -> Result<()> {
        let cycles = (omega - 0.5 * rate * length) * length / TAU;
        let (a, b) = (before.norm(), after.norm());
        let middle = 0.5 * (a + b);
        for (damage, stress) in self.found.damage.iter_mut().zip(self.options.stresses) {
            if let Some(line) = &self.options.woehler {
                // Simpson's rule.
                let [first, inside, last] = [a, middle, b].map(|x| line.damage(stress * x));
                *damage += cycles * (first + 4.0 * inside + last) / 6.0;
            }
        }
        self.table.find(middle.max(f64::MIN_POSITIVE), &mut self.place)?;
        let amplitude = self.table.coefficient(&self.place, 0, 1).norm();
        let class = self.options.edges.partition_point(|edge| *edge <= amplitude);
        self.found.cycles[class] += cycles;
        self.found.steps += 1;
        let natural = self.oscillator(b)?.square.max(0.0).sqrt();
        let step = Step {
            time,
            omega,
            rate,
            amplitude: self.table.coefficient(&self.place, 0, 1).norm(),
            cycles,
            above: omega > natural,
        };
        try_push(&mut self.steps, step, CONTEXT)
    }

    /// Lists the passages through the resonance: each is the largest amplitude between two changes of the side.
    fn crossings(&mut self, steady: f64) -> Result<()> {
        let steps = &self.steps;
        let mut changes = Vec::new();
        for k in 1..steps.len() {
            if steps[k].above != steps[k - 1].above {
                try_push(&mut changes, k, CONTEXT)?;
            }
        }
        for (i, &k) in changes.iter().enumerate() {
            // Amplitudes from the middle between passages on.
            let low = if i == 0 { 0 } else { usize::midpoint(changes[i - 1], k) };
            let high = changes
                .get(i + 1)
                .map_or(steps.len(), |&next| usize::midpoint(k, next).max(k + 1));
            let top = (low..high).max_by(|&a, &b| steps[a].amplitude.total_cmp(&steps[b].amplitude));
            let Some(top) = top else { continue };
            let enough = |j: &usize| steps[*j].amplitude >= std::f64::consts::FRAC_1_SQRT_2 * steps[top].amplitude;
            let cycles: f64 = (low..=top)
                .rev()
                .take_while(enough)
                .map(|j| steps[j].cycles)
                .sum::<f64>()
                + (top + 1..high).take_while(enough).map(|j| steps[j].cycles).sum::<f64>();
            let crossing = MissionCrossing {
                time: steps[top].time,
                omega: steps[top].omega,
                rate: steps[top].rate,
                amplitude: steps[top].amplitude,
                steady,
                cycles,
            };
            try_push(&mut self.found.crossings, crossing, CONTEXT)?;
        }
        Ok(())
    }
}

/// The longest step that the change of frequency and the oscillator allow.
fn longest_step(omega: f64, rate: f64, at: &Oscillator, q: Complex64) -> f64 {
    let natural = at.square.max(0.0).sqrt();
    let width = at.decay().abs();
    let distance = (omega - natural).abs();
    let quick = rate.abs().sqrt();
    let mut step = MISSION_STEP * distance.max(width) / rate.abs();
    if quick * quick > MISSION_STEADY * width * width && distance < MISSION_NEAR * (quick + width) {
        step = step.min(MISSION_PHASE / quick.max(width));
    }
    let target = at.force / at.stiffness(omega);
    if (q - target).norm() > MISSION_STEADY * target.norm() {
        // An amplitude that has not settled changes frequency and damping.
        step = step.min(MISSION_PHASE.max(MISSION_STEP * distance / width.max(f64::MIN_POSITIVE)) / width);
    }
    step
}
