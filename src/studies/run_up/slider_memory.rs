//! Memory of sliders for amplitudes before: the force of contacts in a vibration whose amplitude changes, minus that of a steady one of
//! the same amplitude.
//!
//! The motion of a slow flow is passed through the sliders for a turn, which lets them forget how they began, and a further one around the
//! time of interest. Two steady motions at the least and the largest amplitude of these turns are passed through the same laws; the
//! steady force at each time is the line between both. The fundamental of the difference, projected on the mode, is the defect of the
//! slow flow. It is of the first order in the rate, and errors of its average over a turn are of the second.

use crate::contact::forms::law::{EventLaw, SliderLaw};
use crate::contact::forms::time_piece::{Instant, Mode};
use crate::error::{Result, try_push, try_vec};
use crate::interrupt::{Interrupt, Phase};
use crate::studies::run_up::chirp::Chirp;
use crate::studies::run_up::mode_table::{ModeTable, Place};
use crate::studies::run_up::other_modes::OtherModes;
use crate::studies::run_up::slow_path::SlowPath;
use crate::time_integration::Element;
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Times per turn at which sliders are moved. Chosen, not measured by itself; turning points between them are exact.
/// Kind: tuned; measured on: nothing, it is chosen.
const SLIDER_MEMORY_SAMPLES: usize = 64;

/// Most times of a run-up at which the memory is evaluated.
/// Kind: cap.
const SLIDER_MEMORY_MOST_TIMES: usize = 1000;

/// Evaluations of the memory per turn where there are few turns. Chosen, not measured by itself.
/// Kind: tuned; measured on: nothing, it is chosen.
const SLIDER_MEMORY_TIMES_PER_TURN: f64 = 6.0;

/// Change of the amplitude within two turns, relative, below which nothing is remembered.
/// Kind: rounding.
const SLIDER_MEMORY_STEADY: f64 = 1e-9;

const CONTEXT: &str = "the memory of sliders";

/// The defect force of a slow flow over time, piecewise linear between equidistant times.
#[derive(Clone, Debug, Default)]
pub(super) struct Defect {
    length: f64,
    values: Vec<Complex64>,
}

impl Defect {
    /// Defect force at a time.
    pub fn at(&self, time: f64) -> Complex64 {
        let Some(last) = self.values.len().checked_sub(1) else {
            return Complex64::ZERO;
        };
        let x = (time / self.length).clamp(0.0, last as f64);
        let k = (x as usize).min(last.saturating_sub(1));
        let share = x - k as f64;
        self.values[k] * (1.0 - share) + self.values[(k + 1).min(last)] * share
    }
}

/// The three motions that pass through a slider: that of the slow flow, and the steady ones.
/// Kind: fixed.
const PASSED: usize = 3;

/// Evaluates the memory of sliders along slow flows.
pub(super) struct SliderMemory<'a> {
    table: &'a ModeTable,
    others: &'a OtherModes,
    /// Laws with sliders, each with the index of its first motion in the table and the number of its motions, at most
    /// 2.
    sliders: Vec<(&'a dyn EventLaw, usize, usize)>,
    powers: Vec<Complex64>,
    places: Vec<[Place; PASSED]>,
    turns: Vec<Complex64>,
    forces: Vec<Complex64>,
}

impl<'a> SliderMemory<'a> {
    /// The memory of the elements whose motions the table has.
    ///
    /// # Errors
    /// `OutOfMemory`.
    pub fn new(table: &'a ModeTable, others: &'a OtherModes, elements: &'a [Element]) -> Result<Self> {
        let mut sliders = Vec::new();
        let mut motion = 1;
        for element in elements {
            if let Some(law) = element.events().filter(|law| law.slider().is_some()) {
                try_push(&mut sliders, (law, motion, element.rows.len().min(2)), CONTEXT)?;
            }
            motion += element.rows.len();
        }
        let count = 2 * SLIDER_MEMORY_SAMPLES + 1;
        Ok(Self {
            table,
            others,
            forces: try_vec(2 * sliders.len(), Complex64::ZERO, CONTEXT)?,
            sliders,
            powers: try_vec(table.harmonics.saturating_mul(count), Complex64::ZERO, CONTEXT)?,
            places: try_vec(count, [Place::default(); PASSED], CONTEXT)?,
            turns: try_vec(count, Complex64::ZERO, CONTEXT)?,
        })
    }

    /// Whether no contact has a memory.
    pub fn is_empty(&self) -> bool {
        self.sliders.is_empty()
    }

    /// The defect force along a slow flow.
    ///
    /// # Errors
    /// `Argument` beyond the amplitudes of the mode; `OutOfMemory`; `StoppedByCaller`.
    pub fn along(&mut self, path: &SlowPath, chirp: &Chirp, interrupt: &Interrupt<'_>) -> Result<Defect> {
        let wanted = (SLIDER_MEMORY_TIMES_PER_TURN * chirp.turns()).ceil().max(8.0);
        let times = (wanted as usize).min(SLIDER_MEMORY_MOST_TIMES);
        let mut defect = Defect {
            length: chirp.duration() / times as f64,
            values: Vec::new(),
        };
        for i in 0..=times {
            interrupt.part(Phase::Results, i, times + 1)?;
            let value = self.at(defect.length * i as f64, path, chirp)?;
            try_push(&mut defect.values, value, CONTEXT)?;
        }
        Ok(defect)
    }

    /// The defect force at one time of a slow flow.
    fn at(&mut self, time: f64, path: &SlowPath, chirp: &Chirp) -> Result<Complex64> {
        let table = self.table;
        let n = SLIDER_MEMORY_SAMPLES;
        let centre = chirp.phase(time);
        let step = TAU / n as f64;
        // Phases from one and a half turns before to half a turn behind.
        let phase_of = |j: usize| centre + step * (j as f64 - 1.5 * n as f64);
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for j in 0..=2 * n {
            let phase = phase_of(j);
            let q = path.at(chirp.time(phase));
            let amplitude = q.norm();
            (least, most) = (least.min(amplitude), most.max(amplitude));
            self.places[j] = [Place::default(); PASSED];
            table.find(amplitude, &mut self.places[j][0])?;
            self.turns[j] = Complex64::cis(-phase);
            let turn = Complex64::cis(phase) * if amplitude > 0.0 { q / amplitude } else { Complex64::ONE };
            let mut power = Complex64::ONE;
            for p in &mut self.powers[j * table.harmonics..(j + 1) * table.harmonics] {
                *p = power;
                power *= turn;
            }
        }
        if self.others.is_empty() && most - least <= SLIDER_MEMORY_STEADY * most {
            return Ok(Complex64::ZERO);
        }
        let mut ends = [Place::default(); 2];
        table.find(least, &mut ends[0])?;
        table.find(most, &mut ends[1])?;
        for places in &mut self.places {
            (places[1], places[2]) = (ends[0], ends[1]);
        }
        self.pass(least, most, chirp.omega(time), chirp.rate(time));
        let here = path.at(time).norm();
        let mut place = Place::default();
        table.find(here, &mut place)?;
        let mut defect = Complex64::ZERO;
        for (s, &(_, motion, count)) in self.sliders.iter().enumerate() {
            for k in 0..count {
                let shape = table.coefficient(&place, motion + k, 1) / here.max(f64::MIN_POSITIVE);
                defect += shape.conj() * self.forces[2 * s + k];
            }
        }
        Ok(defect)
    }

    /// Passes the three motions through all sliders. Leaves the fundamentals of the differences of their forces over
    /// the last turn.
    fn pass(&mut self, least: f64, most: f64, omega: f64, rate: f64) {
        let (table, n) = (self.table, SLIDER_MEMORY_SAMPLES);
        self.forces.fill(Complex64::ZERO);
        for (s, &(law, motion, count)) in self.sliders.iter().enumerate() {
            let start = law.slider().map_or(0.0, SliderLaw::start);
            let mut stretch = [0.0; PASSED];
            let mut before = [REST; PASSED];
            let mut other = [Complex64::ZERO; 2];
            for (k, other) in other.iter_mut().enumerate().take(count) {
                *other = self.others.motion(motion + k, omega, rate).0;
            }
            // The other modes have the forces of stuck contacts in their stiffness.
            let stuck = law.piece(Mode::Stick, [0.0; 2], 0.0);
            for j in 0..=2 * n {
                let powers = &self.powers[j * table.harmonics..(j + 1) * table.harmonics];
                let mut forces = [[0.0; 2]; PASSED];
                let mut beside = [0.0; 2];
                for which in 0..PASSED {
                    let mut at = Instant {
                        motion: [0.0; 2],
                        rate: [0.0; 2],
                    };
                    for k in 0..count {
                        let (x, slope) = table.value(&self.places[j][which], motion + k, powers);
                        (at.motion[k], at.rate[k]) = (x, omega * slope);
                        if which == 0 {
                            let turned = other[k] * self.turns[j].conj();
                            beside[k] = turned.re;
                            at.motion[k] += turned.re;
                            at.rate[k] -= omega * turned.im;
                        }
                    }
                    if j == 0 {
                        stretch[which] = at.motion[0] - start;
                    } else {
                        let last = before[which];
                        // A turning point between two times is passed, too.
                        if let Some(turn) = turning_point(&last, &at, TAU / (n as f64 * omega)) {
                            stretch[which] += turn.motion[0] - last.motion[0];
                            law.begin(&turn, &mut stretch[which]);
                            stretch[which] += at.motion[0] - turn.motion[0];
                        } else {
                            stretch[which] += at.motion[0] - last.motion[0];
                        }
                    }
                    before[which] = at;
                    let (mode, _) = law.begin(&at, &mut stretch[which]);
                    forces[which] = law.piece(mode, at.motion, stretch[which]).force;
                }
                if j < n {
                    continue;
                }
                // The trapezoidal rule over the last turn.
                let weight = if j == n || j == 2 * n { 1.0 } else { 2.0 } / n as f64;
                let linear = stuck.along(beside);
                let share = if most > least {
                    (self.places[j][0].amplitude() - least) / (most - least)
                } else {
                    0.0
                };
                for k in 0..count {
                    let steady = forces[1][k] * (1.0 - share) + forces[2][k] * share;
                    self.forces[2 * s + k] += self.turns[j] * (weight * (forces[0][k] - steady - linear[k]));
                }
            }
        }
    }
}

/// No motion and no rate.
const REST: Instant = Instant {
    motion: [0.0; 2],
    rate: [0.0; 2],
};

/// The instant between two others at which the first motion turns, by the cubics through motions and rates; `None` if
/// it does not turn.
fn turning_point(a: &Instant, b: &Instant, length: f64) -> Option<Instant> {
    if (a.rate[0] < 0.0) == (b.rate[0] < 0.0) {
        return None;
    }
    let s = a.rate[0] / (a.rate[0] - b.rate[0]);
    let r = 1.0 - s;
    let cubic = |k: usize| {
        a.motion[k] * (r * r * (1.0 + 2.0 * s))
            + b.motion[k] * (s * s * (3.0 - 2.0 * s))
            + length * (a.rate[k] * (s * r * r) - b.rate[k] * (s * s * r))
    };
    Some(Instant {
        motion: [cubic(0), cubic(1)],
        rate: [0.0, a.rate[1] * r + b.rate[1] * s],
    })
}
