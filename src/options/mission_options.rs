//! Options of a mission: speed against time, stresses and a Wöhler line.

use crate::error::{Result, fail};
use crate::options::SynthesisOptions;

/// Most points of a mission, edges of amplitudes, or stresses.
/// Kind: cap.
pub const MISSION_MOST: usize = 10_000_000;

/// A Wöhler line: N = cycles·(stress/σ)^slope cycles to failure at the stress amplitude σ, with another slope below its knee.
#[derive(Clone, Copy, Debug)]
pub struct Woehler {
    /// Stress amplitude of the knee, above zero.
    pub stress: f64,
    /// Number of cycles to failure at the knee, above zero.
    pub cycles: f64,
    /// Slope above the knee, above zero.
    pub slope: f64,
    /// Slope below the knee; 0: stresses below it do no damage.
    pub slope_below: f64,
}

impl Woehler {
    /// Damage of one cycle, 1/N.
    #[must_use]
    pub fn damage(&self, stress: f64) -> f64 {
        let ratio = stress / self.stress;
        if ratio >= 1.0 {
            ratio.powf(self.slope) / self.cycles
        } else if self.slope_below > 0.0 {
            ratio.powf(self.slope_below) / self.cycles
        } else {
            0.0
        }
    }
}

/// Options of a mission.
#[derive(Clone, Copy, Debug)]
pub struct MissionOptions<'a> {
    /// Times of the mission, rising.
    pub times: &'a [f64],
    /// Speeds of rotation at these times, above zero, with straight lines between them.
    pub speeds: &'a [f64],
    /// Angular frequency of the forces over the speed, above zero: the engine order where the forces belong to one.
    pub engine_order: f64,
    /// Degree of freedom whose amplitude is read; `None`: the response degree of freedom of the mode.
    pub dof: Option<usize>,
    /// Rising amplitudes between which cycles are counted.
    pub edges: &'a [f64],
    /// Stress amplitude per modal amplitude, 0 or more, at each position of interest.
    pub stresses: &'a [f64],
    /// Wöhler line for the damage; needed if `stresses` are given.
    pub woehler: Option<Woehler>,
    /// Forces and damping, as for a synthesised response.
    pub synthesis: SynthesisOptions,
}

impl MissionOptions<'_> {
    /// Checks the values of all options for a model of `ndof` degrees of freedom.
    ///
    /// # Errors
    /// `Argument`, `NotFinite`, `Index` or `Dimension`, naming the field, its value and its range.
    pub fn check(&self, ndof: usize) -> Result<()> {
        let count = self.times.len();
        if !(2..=MISSION_MOST).contains(&count) || self.speeds.len() != count {
            return fail!(
                Dimension,
                "{count} times and {} speeds, needs as many of both, 2 .. {MISSION_MOST}",
                self.speeds.len()
            );
        }
        for (name, list) in [
            ("times", self.times),
            ("speeds", self.speeds),
            ("edges", self.edges),
            ("stresses", self.stresses),
        ] {
            if list.len() > MISSION_MOST {
                return fail!(Dimension, "{} {name}, needs at most {MISSION_MOST}", list.len());
            }
            if let Some(i) = list.iter().position(|x| !x.is_finite()) {
                return fail!(NotFinite, "{name}[{i}] = {}, needs a finite number", list[i]);
            }
        }
        for (name, list) in [("times", self.times), ("edges", self.edges)] {
            if let Some(i) = list.windows(2).position(|x| x[1] <= x[0]) {
                return fail!(
                    Argument,
                    "{name}[{}] = {}, needs more than {}",
                    i + 1,
                    list[i + 1],
                    list[i]
                );
            }
        }
        for (name, list, least) in [
            ("speeds", self.speeds, f64::MIN_POSITIVE),
            ("stresses", self.stresses, 0.0),
        ] {
            if let Some(i) = list.iter().position(|x| *x < least) {
                let range = if least > 0.0 { "> 0" } else { ">= 0" };
                return fail!(Argument, "{name}[{i}] = {}, needs a number {range}", list[i]);
            }
        }
        if !(self.engine_order > 0.0 && self.engine_order.is_finite()) {
            return fail!(Argument, "engine_order = {}, needs a number > 0", self.engine_order);
        }
        if let Some(dof) = self.dof.filter(|&dof| dof >= ndof) {
            return fail!(Index, "dof = {dof}, needs 0 .. {}", ndof.saturating_sub(1));
        }
        match self.woehler {
            Some(line) => {
                for (name, value) in [
                    ("woehler_stress", line.stress),
                    ("woehler_cycles", line.cycles),
                    ("woehler_slope", line.slope),
                ] {
                    if !(value > 0.0 && value.is_finite()) {
                        return fail!(Argument, "{name} = {value}, needs a number > 0");
                    }
                }
                if !(line.slope_below >= 0.0 && line.slope_below.is_finite()) {
                    return fail!(
                        Argument,
                        "woehler_slope_below = {}, needs a number >= 0",
                        line.slope_below
                    );
                }
            }
            None if !self.stresses.is_empty() => {
                return fail!(
                    Argument,
                    "stresses without a Woehler line, needs woehler_stress, cycles and slope"
                );
            }
            None => {}
        }
        self.synthesis.check()
    }
}
