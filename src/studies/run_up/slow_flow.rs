//! The slow flow of a nonlinear mode under forces whose frequency W changes: with the complex modal amplitude q, whose modulus is the
//! amplitude of the mode,
//!
//! > q″ + (2iW + c) q′ + Z q = u₁ᴴ F − defect,  Z = ω₀² − W² + iW′ + i(loss + cW).
//!
//! As an equation of the second order it also has a motion that turns against the force, which the amplitude-dependent frequency would
//! excite. It is left out: with the slow root P² + (2iW + c) P + Z = 0,
//!
//! > q′ = P q + (u₁ᴴ F − defect − excess)/(P + 2iW + c),  excess = q″ − P q′,
//!
//! where defect and excess, of the first order in the rate, are those of the solution before.

use crate::error::{Error, Result, fail, try_push};
use crate::interrupt::{Interrupt, Phase};
use crate::roots::root;
use crate::studies::run_up::chirp::Chirp;
use crate::studies::run_up::mode_table::{ModeTable, Oscillator, Place};
use crate::studies::run_up::other_modes::OtherModes;
use crate::studies::run_up::slider_memory::Defect;
use crate::studies::run_up::slow_path::{SlowPath, cubic};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Steps per turn, of the fourth order. Chosen: the linear oscillator of the stored runs is met to 1e-7 at rates of 1e-4 and less, so that
/// steps are no part of the error.
/// Kind: tuned; measured on: nothing, it is chosen.
const SLOW_FLOW_STEPS: usize = 16;

/// Displacements that are looked at in a step. Chosen: 96 looks in a turn, and a parabola through three, find a maximum to 1e-7.
/// Kind: tuned; measured on: nothing, it is chosen.
const SLOW_FLOW_LOOKS: usize = 6;

/// Turns that are followed behind the end, for averages around it: the half turn of the memory, rounded up.
/// Kind: fixed.
const SLOW_FLOW_BEHIND: usize = 1;

const CONTEXT: &str = "the slow flow";

/// Data of one turn of the forces in a run-up.
#[derive(Clone, Copy, Debug)]
pub struct RunUpTurn {
    /// Time at the beginning of the turn.
    pub time: f64,
    /// Angular frequency of the forces at the beginning of the turn.
    pub omega: f64,
    /// Largest displacement within the turn.
    pub amplitude: f64,
    /// Modal amplitude at the beginning of the turn.
    pub modal_amplitude: f64,
}

/// The largest displacement of a slow flow, with its time, and all its turns.
#[derive(Clone, Debug, Default)]
pub(super) struct Observed {
    pub turns: Vec<RunUpTurn>,
    pub largest: f64,
    pub largest_time: f64,
    /// Displacement of the other modes at that time, in the part of first order in the rate.
    pub beside: f64,
}

/// The slow flow of a mode under the forces of a run-up.
pub(super) struct SlowFlow<'a> {
    pub table: &'a ModeTable,
    pub others: &'a OtherModes,
    pub chirp: &'a Chirp,
    pub interrupt: &'a Interrupt<'a>,
}

impl SlowFlow<'_> {
    /// Steady complex amplitude at the first frequency; the smallest where there are several.
    ///
    /// # Errors
    /// `Argument` where the mode has no such amplitude.
    pub fn first(&self) -> Result<Complex64> {
        steady(self.table, self.chirp.omega(0.0))
    }

    /// Follows the slow flow from the steady motion at the first frequency, and observes the displacement. Defect
    /// force and q″ are taken from the solution before.
    ///
    /// # Errors
    /// `Argument` beyond the amplitudes of the mode; `OutOfMemory`; `StoppedByCaller`.
    pub fn run(&self, defect: &Defect, before: &SlowPath) -> Result<(SlowPath, Observed)> {
        let chirp = self.chirp;
        let mut known = Known {
            defect,
            before,
            place: Place::default(),
        };
        let mut q = self.first()?;
        let (mut path, mut seen) = (SlowPath::default(), Observed::default());
        let mut watch = Watch::new(self.table);
        let mut slope = self.slope(0.0, chirp.rate(0.0), q, &mut known)?;
        path.push(0.0, [q, slope])?;
        watch.add(self, 0.0, q, &mut seen)?;
        let whole = chirp.turns().ceil() as usize + SLOW_FLOW_BEHIND;
        let (mut time, end) = (0.0, chirp.duration());
        for turn in 0..whole {
            self.interrupt.part(Phase::Results, turn, whole)?;
            for step in 1..=SLOW_FLOW_STEPS {
                let phase = TAU * (turn as f64 + step as f64 / SLOW_FLOW_STEPS as f64);
                let next = chirp.time(phase);
                // A step ends where the sweep does.
                let stops = if time < end && next > end {
                    [end, next]
                } else {
                    [next, next]
                };
                for stop in stops {
                    if stop <= time {
                        continue;
                    }
                    let begin = [q, slope];
                    let length = stop - time;
                    // The rate is that of the inside of the step.
                    let rate = chirp.rate(time + 0.5 * length);
                    q = self.step(time, stop, rate, q, &mut known)?;
                    slope = self.slope(stop, rate, q, &mut known)?;
                    if stop <= end {
                        for look in 1..=SLOW_FLOW_LOOKS {
                            let s = look as f64 / SLOW_FLOW_LOOKS as f64;
                            let inside = cubic(s, length, &begin, &[q, slope]);
                            watch.add(self, time + s * length, inside, &mut seen)?;
                        }
                    }
                    time = stop;
                    path.push(time, [q, slope])?;
                }
            }
        }
        Ok((path, seen))
    }

    /// One step of the classical Runge–Kutta method.
    fn step(&self, begin: f64, end: f64, rate: f64, q: Complex64, known: &mut Known<'_>) -> Result<Complex64> {
        let h = end - begin;
        let middle = begin + 0.5 * h;
        let a = self.slope(begin, rate, q, known)?;
        let b = self.slope(middle, rate, q + a * (0.5 * h), known)?;
        let c = self.slope(middle, rate, q + b * (0.5 * h), known)?;
        let d = self.slope(end, rate, q + c * h, known)?;
        Ok(q + (a + (b + c) * 2.0 + d) * (h / 6.0))
    }

    fn slope(&self, time: f64, rate: f64, q: Complex64, known: &mut Known<'_>) -> Result<Complex64> {
        self.table.find(q.norm().max(f64::MIN_POSITIVE), &mut known.place)?;
        let oscillator = self.table.oscillator(&known.place);
        let omega = self.chirp.omega(time);
        let stiffness = oscillator.stiffness(omega) + Complex64::new(0.0, rate);
        let damping = Complex64::new(oscillator.viscous, 2.0 * omega);
        let root = slow_root(damping, stiffness);
        let (rate_before, acceleration) = known.before.motion(time);
        let excess = acceleration - root * rate_before;
        Ok(root * q + (oscillator.force - known.defect.at(time) - excess) / (root + damping))
    }
}

/// Root of p² + 2h p + Z = 0 next to zero, where `damping` is 2h and `stiffness` is Z.
pub(crate) fn slow_root(damping: Complex64, stiffness: Complex64) -> Complex64 {
    let half = damping * 0.5;
    let mut root = (half * half - stiffness).sqrt();
    if (half.conj() * root).re < 0.0 {
        root = -root;
    }
    -stiffness / (half + root)
}

/// Defect force and path of the solution before.
struct Known<'a> {
    defect: &'a Defect,
    before: &'a SlowPath,
    place: Place,
}

/// Steady complex amplitude at a frequency; the smallest where there are several.
///
/// # Errors
/// `Argument` where the mode has no such amplitude.
pub(crate) fn steady(table: &ModeTable, omega: f64) -> Result<Complex64> {
    let mut place = Place::default();
    let mut excess = |amplitude: f64| -> Result<(f64, Oscillator)> {
        table.find(amplitude, &mut place)?;
        let at = table.oscillator(&place);
        Ok((at.stiffness(omega).norm() * amplitude - at.force.norm(), at))
    };
    let (first, _) = table.range();
    let mut low = first;
    let (mut value, at) = excess(low)?;
    if value >= 0.0 {
        // The linear range goes down to zero.
        let q = at.force / at.stiffness(omega);
        table.find(q.norm().max(f64::MIN_POSITIVE), &mut place)?;
        return Ok(q);
    }
    for high in table.amplitudes().skip(1) {
        let (next, _) = excess(high)?;
        if next >= 0.0 {
            let high = root((low, value), (high, next), |amplitude| {
                Ok::<_, Error>(excess(amplitude)?.0)
            })?;
            let (_, at) = excess(high)?;
            let q = at.force / at.stiffness(omega);
            return Ok(if q.norm() > 0.0 { q * (high / q.norm()) } else { q });
        }
        (low, value) = (high, next);
    }
    fail!(
        Argument,
        "at omega = {omega} the steady amplitude is beyond the mode, which ends at the modal amplitude {low:.3e} with {:.3e} of the force \
         not balanced; {}",
        -value,
        table.what_goes_further()
    )
}

/// Watches the displacement for its largest value.
struct Watch<'a> {
    table: &'a ModeTable,
    place: Place,
    powers: Vec<Complex64>,
    /// Times and displacements of the last two samples.
    last: [(f64, f64); 2],
    samples: usize,
}

impl<'a> Watch<'a> {
    fn new(table: &'a ModeTable) -> Self {
        Self {
            table,
            place: Place::default(),
            powers: Vec::new(),
            last: [(0.0, 0.0); 2],
            samples: 0,
        }
    }

    fn add(&mut self, flow: &SlowFlow<'_>, time: f64, q: Complex64, seen: &mut Observed) -> Result<()> {
        let amplitude = q.norm();
        self.table.find(amplitude.max(f64::MIN_POSITIVE), &mut self.place)?;
        if self.powers.is_empty() {
            self.powers = crate::error::try_vec(self.table.harmonics, Complex64::ONE, CONTEXT)?;
        }
        let (phase, omega) = (flow.chirp.phase(time), flow.chirp.omega(time));
        let turn = Complex64::cis(phase) * if amplitude > 0.0 { q / amplitude } else { Complex64::ONE };
        let mut power = Complex64::ONE;
        for p in &mut self.powers {
            *p = power;
            power *= turn;
        }
        let beside = flow.others.motion(0, omega, flow.chirp.rate(time));
        let (own, _) = self.table.value(&self.place, 0, &self.powers);
        let x = own + (beside.0 * Complex64::cis(phase)).re;
        let number = (phase / TAU + 1e-9).floor() as usize;
        if number >= seen.turns.len() && time < flow.chirp.duration() {
            let turn = RunUpTurn {
                time,
                omega,
                amplitude: 0.0,
                modal_amplitude: amplitude,
            };
            try_push(&mut seen.turns, turn, CONTEXT)?;
        }
        // The vertex of the parabola through three samples, where the middle one is the largest.
        let [(t0, x0), (t1, x1)] = self.last;
        let mut largest = (time, x.abs());
        if self.samples >= 2 && x1.abs() >= x0.abs() && x1.abs() >= x.abs() && x1 * x0 > 0.0 && x1 * x > 0.0 {
            let (left, right) = ((x1 - x0) / (t1 - t0), (x - x1) / (time - t1));
            let curvature = (right - left) / (time - t0);
            let slope = left + curvature * (t1 - t0);
            if curvature != 0.0 {
                let shift = -0.5 * slope / curvature;
                if (t0 - t1..=time - t1).contains(&shift) {
                    largest = (t1 + shift, (x1 + shift * (slope + shift * curvature)).abs());
                }
            }
        }
        if let Some(turn) = seen.turns.last_mut() {
            turn.amplitude = turn.amplitude.max(largest.1);
        }
        if largest.1 > seen.largest {
            (seen.largest_time, seen.largest) = largest;
            seen.beside = beside.1.norm();
        }
        self.last = [(t1, x1), (time, x)];
        self.samples += 1;
        Ok(())
    }
}
