//! Friction in a plane, for its tests: random motions, one law, and comparisons of numbers.

use crate::common::random;
use hbvib::Interrupt;

use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::PlaneFrictionEvaluator;
use hbvib::internals::ScaledFriction3d;

pub const OMEGA: f64 = 1.7;

/// A plain generator of numbers in (−1, 1).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        random::signed(&mut self.0)
    }

    pub fn motion(&mut self, set: &HarmonicSet, directions: usize, size: f64) -> Vec<f64> {
        let mut motion = Vec::new();
        for direction in 0..directions {
            // The normal motion is the smaller one, so that not all contacts are open most of the time.
            let size = if direction == 2 { size.min(3.0) / 3.0 } else { size };
            for h in set.numbers() {
                let scale = size / (1.0 + (*h as f64).powi(2));
                motion.push(scale * self.next());
                if *h > 0 {
                    motion.push(scale * self.next());
                }
            }
        }
        motion
    }
}

pub fn law(load: f64, has_normal: bool) -> ScaledFriction3d {
    ScaledFriction3d {
        kt: 1.3,
        kn: if has_normal { 0.9 } else { 0.0 },
        mu: 0.4,
        load,
        has_normal,
        slider: [0.0; 2],
    }
}

pub fn evaluate(law: &ScaledFriction3d, set: &HarmonicSet, motion: &[f64]) -> (Evaluation, PlaneFrictionEvaluator) {
    let mut out = Evaluation::new(set, law.directions()).unwrap();
    let mut way = PlaneFrictionEvaluator::new(set, law).unwrap();
    way.evaluate(law, set, motion, &mut out, &Interrupt::none()).unwrap();
    (out, way)
}

pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, v| m.max(v.abs()))
}

pub fn short(x: &[f64]) -> String {
    let words: Vec<String> = x.iter().map(|x| format!("{x:.1e}")).collect();
    words.join(" ")
}

pub fn gap(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
}
