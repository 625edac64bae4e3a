//! Friction in a plane: slip takes power at every time of its path, and its force does not depend on where the sides stand.

use crate::common::plane::{Random, evaluate, gap, largest, law};
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::PlaneForce;
use std::f64::consts::TAU;

/// Values of the signals of a packed motion at τ.
fn at(set: &HarmonicSet, motion: &[f64], tau: f64) -> Vec<f64> {
    let mut row = vec![0.0; set.packed_len()];
    set.basis(tau, &mut row);
    let value = |x: &[f64]| row.iter().zip(x).map(|(b, x)| b * x).sum();
    motion.chunks_exact(row.len()).map(value).collect()
}

#[test]
fn slip_is_never_against_its_force() {
    const STEP: f64 = 1e-5;
    let mut random = Random(5);
    let (mut sampled, mut sticks, mut least) = (0, 0, f64::INFINITY);
    for round in 0..2000 {
        let set = HarmonicSet::all([1, 2, 3][round % 3]).unwrap();
        let law = law(0.8 + 0.6 * random.next(), round % 4 != 0);
        let motion = random.motion(&set, law.directions(), 3.0);
        let (_, way) = evaluate(&law, &set, &motion);
        let path = way.path();
        for piece in &path.pieces {
            match piece.force {
                PlaneForce::Stick { .. } => sticks += usize::from(piece.end - piece.start < 0.1),
                PlaneForce::Open => (),
                PlaneForce::Slip(_) => {
                    for k in 1..8 {
                        let tau = piece.start + (piece.end - piece.start) * f64::from(k) / 8.0;
                        let (before, after) = (at(&set, &motion, tau - STEP), at(&set, &motion, tau + STEP));
                        let rates: Vec<f64> = before.iter().zip(&after).map(|(a, b)| (b - a) / (2.0 * STEP)).collect();
                        let f = path.force(tau.rem_euclid(TAU)).0;
                        let length = f[0].hypot(f[1]);
                        if length < 1e-3 {
                            continue;
                        }
                        let growth = if law.has_normal {
                            -law.mu * law.kn * rates[2]
                        } else {
                            0.0
                        };
                        let along = law.kt * (f[0] * rates[0] + f[1] * rates[1]) / length;
                        let scale = law.kt * rates[0].hypot(rates[1]) + growth.abs();
                        least = least.min((along - growth) / scale);
                        sampled += 1;
                    }
                }
            }
        }
    }
    println!("{sampled} times of slip, {sticks} short sticks: {least:.1e}");
    assert!(sampled > 100_000 && sticks > 50 && least > -1e-6, "{least:e}");
}

#[test]
fn the_force_of_slip_is_the_same_however_far_the_sides_have_moved() {
    // A ring that soft springs hold moves a million slip lengths before its mean forces balance.
    let mut random = Random(19);
    let (mut compared, mut worst) = (0, 0.0_f64);
    for round in 0..1500 {
        let set = HarmonicSet::all([1, 2, 3][round % 3]).unwrap();
        let law = law(0.8 + 0.6 * random.next(), round % 4 != 0);
        let motion = random.motion(&set, law.directions(), 3.0);
        let (near, _) = evaluate(&law, &set, &motion);
        // A slider that can rest depends on its place.
        if near.slip_fraction == 0.0 {
            continue;
        }
        let m = set.packed_len();
        for distance in [1e3, -4e4] {
            let mut far = motion.clone();
            far[0] += distance;
            far[m] -= 0.3 * distance;
            let (out, _) = evaluate(&law, &set, &far);
            let off = gap(&out.force[..2 * m], &near.force[..2 * m]) / largest(&near.force);
            if off > 1e-9 {
                println!("round {round}, {distance}: {off:.1e}");
            }
            worst = worst.max(off);
            compared += 1;
        }
    }
    println!("{compared} forces, off by {worst:.1e}");
    assert!(compared > 1000 && worst < 1e-9, "{worst:e}");
}
