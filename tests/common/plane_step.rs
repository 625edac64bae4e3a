//! Friction in a plane by small steps, over which motion and load are linear: the reference for the exact path, of
//! second order in the length of a step.

use crate::common::plane::{gap, largest};
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::ScaledFriction3d;
use std::f64::consts::TAU;

fn scaled(a: [f64; 2], factor: f64) -> [f64; 2] {
    [a[0] * factor, a[1] * factor]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Force harmonics over `samples` steps a period, and the share of the steps with slip; periods are followed until the force returns.
pub fn stepped(law: &ScaledFriction3d, set: &HarmonicSet, motion: &[f64], samples: usize) -> (Vec<f64>, f64) {
    let (m, d) = (set.packed_len(), law.directions());
    let mut row = vec![0.0; m];
    let mut at = |j: usize| {
        set.basis(TAU * j as f64 / samples as f64, &mut row);
        let value = |k: usize| -> f64 { row.iter().zip(&motion[k * m..]).map(|(b, x)| b * x).sum() };
        let load = if law.has_normal {
            law.load - law.kn * value(2)
        } else {
            law.load
        };
        ([value(0), value(1), load], row.clone())
    };
    let samples_of: Vec<_> = (0..samples).map(&mut at).collect();
    let mut force = [0.0; 2];
    let last = samples_of[samples - 1].0;
    let rest = law.load.max(0.0);
    step(law, &mut force, [last[0], last[1]], [rest, last[2]]);
    let mut sums = vec![0.0; d * m];
    let mut slips = 0.0;
    for _ in 0..400 {
        let begin = force;
        sums.fill(0.0);
        slips = 0.0;
        let mut before = last;
        for (now, row) in &samples_of {
            let slipped = step(
                law,
                &mut force,
                [now[0] - before[0], now[1] - before[1]],
                [before[2], now[2]],
            );
            slips += f64::from(u8::from(slipped)) / samples as f64;
            before = *now;
            let all = [force[0], force[1], -now[2].max(0.0)];
            for (k, f) in all.iter().enumerate().take(d) {
                for (i, b) in row.iter().enumerate() {
                    let weight = if i == 0 && set.has_mean() { 1.0 } else { 2.0 };
                    sums[k * m + i] += weight / samples as f64 * f * b;
                }
            }
        }
        if gap(&begin, &force) < 1e-14 * (1.0 + largest(&force)) {
            break;
        }
    }
    (sums, slips)
}

/// One step; `true` if the contact slips in it.
fn step(law: &ScaledFriction3d, force: &mut [f64; 2], travel: [f64; 2], load: [f64; 2]) -> bool {
    if load[1] <= 0.0 {
        *force = [0.0; 2];
        return false;
    }
    let (kt, mu) = (law.kt, law.mu);
    if load[0] <= 0.0 {
        // Closing: stick if the limit grows faster than the force, else slip along the travel.
        let (growth, length) = (load[1] - load[0], travel[0].hypot(travel[1]));
        let slips = kt * length >= mu * growth;
        let factor = if slips {
            mu * load[1] / length
        } else {
            kt * load[1] / growth
        };
        *force = scaled(travel, factor);
        return slips;
    }
    let (limit, growth) = (mu * load[0], mu * (load[1] - load[0]));
    let size = force[0].hypot(force[1]);
    if size > limit {
        *force = scaled(*force, limit / size);
    }
    // |f + kt d s| = R + R′ s: the first s at which the left side passes.
    let pull = scaled(travel, kt);
    let a = dot(pull, pull) - growth * growth;
    let b = dot(*force, pull) - limit * growth;
    let c = (dot(*force, *force) - limit * limit).min(0.0);
    let square = b * b - a * c;
    let at_limit = c.abs() < 1e-14 * limit * limit;
    let onset = if at_limit && b > 0.0 {
        0.0
    } else if b > 0.0 {
        if square < 0.0 { 1.0 } else { -c / (b + square.sqrt()) }
    } else if a > 0.0 {
        (square.sqrt() - b) / a
    } else {
        1.0
    };
    if onset >= 1.0 {
        *force = [force[0] + pull[0], force[1] + pull[1]];
        return false;
    }
    // Slip over the rest h: with ψ the angle from the travel to the force, tan(ψ/2) shrinks by exp(−∫|u′|/R).
    let start: [f64; 2] = std::array::from_fn(|i| force[i] + onset * pull[i]);
    let (rest, begin, end) = (1.0 - onset, limit + onset * growth, limit + growth);
    let mean = if growth.abs() < 1e-6 * limit {
        2.0 / (begin + end)
    } else {
        (end / begin).ln() / (end - begin)
    };
    let speed = pull[0].hypot(pull[1]);
    if speed == 0.0 {
        *force = scaled(start, end / start[0].hypot(start[1]));
        return true;
    }
    let axis = scaled(pull, 1.0 / speed);
    let angle = (axis[0] * start[1] - axis[1] * start[0]).atan2(dot(axis, start));
    let turned = 2.0 * ((0.5 * angle).tan() * (-speed * rest * mean).exp()).atan();
    let (sin, cos) = turned.sin_cos();
    *force = [
        end * (cos * axis[0] - sin * axis[1]),
        end * (sin * axis[0] + cos * axis[1]),
    ];
    true
}
