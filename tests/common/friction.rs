//! Motions in two directions under friction with a varying normal load, and the law marched over
//! samples, for its tests.

use crate::common::random;
use hbvib::Interrupt;
use hbvib::internals::CoupledPiece;
use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Piece;
use hbvib::internals::ScaledFriction2d;
use hbvib::internals::VaryingNormalLoadEvaluator;
use std::f64::consts::TAU;

pub fn evaluate(law: &ScaledFriction2d, set: &HarmonicSet, motion: &[f64]) -> Evaluation {
    pieces(law, set, motion).0
}

pub fn pieces(
    law: &ScaledFriction2d,
    set: &HarmonicSet,
    motion: &[f64],
) -> (Evaluation, Vec<CoupledPiece>, Vec<Piece>) {
    let mut out = Evaluation::new(set, 2).unwrap();
    let mut way = VaryingNormalLoadEvaluator::new(set).unwrap();
    way.evaluate(law, set, motion, &mut out, &Interrupt::none()).unwrap();
    (out, way.tangential().to_vec(), way.normal().to_vec())
}

pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()))
}

/// Numbers in [−1, 1) that repeat from run to run.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        random::signed(&mut self.0)
    }

    /// A packed motion of size about 1.
    pub fn signal(&mut self, set: &HarmonicSet, mean: f64) -> Vec<f64> {
        (0..set.packed_len())
            .map(|i| {
                if i == 0 {
                    mean * self.next()
                } else {
                    self.next() / i as f64
                }
            })
            .collect()
    }

    /// A motion in both directions, and a law that it makes slip or not, open or not.
    pub fn case(&mut self, set: &HarmonicSet) -> (ScaledFriction2d, Vec<f64>) {
        let motion = [self.signal(set, 0.5), self.signal(set, 0.5)].concat();
        let law = ScaledFriction2d {
            kt: 1.0 + 0.9 * self.next(),
            kn: 1.0 + 0.9 * self.next(),
            mu: 0.6 + 0.5 * self.next(),
            load: 0.8 + 1.2 * self.next(),
            slider: 0.0,
        };
        (law, motion)
    }
}

/// A law and a motion given as cosine and sine coefficients [a0, a1, b1, …] of x and of the closing.
pub fn case(constants: [f64; 4], x: &[f64], closing: &[f64]) -> (ScaledFriction2d, HarmonicSet, Vec<f64>) {
    let [kt, kn, mu, load] = constants;
    let set = HarmonicSet::all((x.len() - 1) / 2).unwrap();
    let packed = |c: &[f64], sign: f64| -> Vec<f64> {
        let part = |(i, c): (usize, &f64)| if i > 0 && i % 2 == 0 { -sign * c } else { sign * c };
        c.iter().enumerate().map(part).collect()
    };
    let motion = [packed(x, 1.0), packed(closing, -1.0)].concat();
    (
        ScaledFriction2d {
            kt,
            kn,
            mu,
            load,
            slider: 0.0,
        },
        set,
        motion,
    )
}

pub const CONSTANTS: [f64; 4] = [1.0, 1.3, 0.4, 0.6];

/// Opens, and slips as soon as it closes.
pub fn slipping_at_closing() -> (ScaledFriction2d, HarmonicSet, Vec<f64>) {
    case(
        CONSTANTS,
        &[0.1, 1.0, 0.2, 0.0, 0.0, 0.1, -0.05],
        &[0.0, 0.5, 0.9, 0.0, 0.1, 0.0, 0.0],
    )
}

/// Opens, and sticks when it closes.
pub fn sticking_at_closing() -> (ScaledFriction2d, HarmonicSet, Vec<f64>) {
    case(
        CONSTANTS,
        &[0.0, 0.35, 0.1, 0.0, 0.0, 0.05, 0.0],
        &[0.0, 1.2, 0.3, 0.0, 0.0, 0.0, 0.0],
    )
}

/// The same law marched over n samples, twice around from a slider at 0: packed forces, and the derivative of
/// the marched force, column-major. With `located`, the time of closing is interpolated between two samples;
/// without, the slider begins at the first closed sample, as a sampled evaluation has it.
pub struct March<'a> {
    pub law: &'a ScaledFriction2d,
    pub set: &'a HarmonicSet,
    pub samples: usize,
    pub located: bool,
}

impl March<'_> {
    pub fn run(&self, motion: &[f64], jacobian: Option<&mut [f64]>) -> Vec<f64> {
        let ScaledFriction2d { kt, kn, mu, load, .. } = *self.law;
        let (n, m) = (self.samples, self.set.packed_len());
        let mut basis = vec![0.0; m];
        let mut force = vec![0.0; 2 * m];
        let mut table = jacobian;
        let (mut w, mut by) = (0.0, vec![0.0; 2 * m]);
        let mut last: Option<(f64, f64)> = None;
        for j in 0..2 * n {
            self.set.basis(TAU * (j % n) as f64 / n as f64, &mut basis);
            let value = |packed: &[f64]| -> f64 { basis.iter().zip(packed).map(|(c, x)| c * x).sum() };
            let (x, y) = (value(&motion[..m]), value(&motion[m..]));
            let pressure = load - kn * y;
            let (mut f, mut slope) = (0.0, vec![]);
            if pressure > 0.0 {
                if let (Some((before, then)), true) = (last, self.located)
                    && before <= 0.0
                {
                    w = then + (x - then) * before / (before - pressure);
                }
                let cutoff = mu * pressure / kt;
                let sign = if w < x { 1.0 } else { -1.0 };
                if (w - x).abs() > cutoff {
                    w = x - sign * cutoff;
                    if table.is_some() {
                        by = [basis.clone(), basis.iter().map(|c| sign * mu * kn / kt * c).collect()].concat();
                    }
                }
                f = kt * (x - w);
                if table.is_some() {
                    slope = by.iter().map(|b| -kt * b).collect();
                    for (s, c) in slope.iter_mut().zip(&basis) {
                        *s += kt * c;
                    }
                }
            } else {
                w = x;
                if table.is_some() {
                    by = [basis.clone(), vec![0.0; m]].concat();
                }
            }
            last = Some((pressure, x));
            if j < n {
                continue;
            }
            for (i, c) in basis.iter().enumerate() {
                let weight = if i == 0 && self.set.has_mean() { 1.0 } else { 2.0 } / n as f64 * c;
                force[i] += weight * f;
                force[m + i] -= weight * pressure.max(0.0);
                if let Some(table) = table.as_deref_mut() {
                    for (k, s) in slope.iter().enumerate() {
                        table[k * 2 * m + i] += weight * s;
                    }
                }
            }
        }
        force
    }
}
