//! Tests of sliders that are masses, against steps in time.

use super::SlidingMass;
use crate::contact::forms::law::{PackedMotion, PiecewiseLinear, SlidingEnds};
use crate::contact::forms::piece::Piece;
use crate::fourier::{HarmonicSet, TurningPoints, jet};
use crate::interrupt::Interrupt;
use std::f64::consts::PI;

/// Steps of half a turn.
const STEPS: usize = 6_000;

/// Harmonic 1 to 7 of a motion that passes the limit 1 by little or by much.
fn motion(set: &HarmonicSet, seed: usize) -> Vec<f64> {
    let draw = |i: usize| ((i * 37 + seed * 101 + 5) as f64 * 0.61).sin();
    let size = [1.02, 1.1, 1.5, 4.0][seed % 4];
    let mut x: Vec<f64> = (0..set.packed_len())
        .map(|i| draw(i) / (1.0 + (i / 2) as f64))
        .collect();
    let largest = (0..1000)
        .map(|k| jet(set, &x, k as f64 * PI / 1000.0).x.abs())
        .fold(0.0, f64::max);
    for x in &mut x {
        *x *= size / largest;
    }
    x
}

/// The force in the last of many half turns, an odd number, by steps in time.
fn stepped(set: &HarmonicSet, x: &[f64], half_turns: usize) -> Vec<f64> {
    let h = PI / STEPS as f64;
    let pushed: Vec<f64> = (0..STEPS).map(|k| jet(set, x, (k as f64 + 0.5) * h).x).collect();
    let (mut p, mut force) = (0.0_f64, vec![0.0; STEPS]);
    for turn in 0..half_turns {
        for (x, f) in pushed.iter().zip(&mut force) {
            let x = if turn % 2 == 0 { *x } else { -*x };
            // The force that stops the mass within the step, within its limits.
            *f = (p / h + x).clamp(-1.0, 1.0);
            p += h * (x - *f);
        }
    }
    force
}

/// The time by which a half turn does not repeat itself, and its pieces.
fn followed(law: &SlidingMass, set: &HarmonicSet, motion: &[f64]) -> (f64, Vec<Piece>) {
    let none = Interrupt::none();
    let (mut extrema, mut pieces) = (Vec::with_capacity(64), Vec::with_capacity(256));
    let mut turning = TurningPoints::new(set).unwrap();
    turning.find(set, motion, &mut extrema, &none).unwrap();
    let at = PackedMotion {
        set,
        motion,
        omega: 1.0,
    };
    let apart = law.follow(at, &extrema, &mut pieces, &none).unwrap();
    (apart, pieces)
}

#[test]
fn forces_are_those_of_steps_in_time() {
    let set = HarmonicSet::excited(&[1], 7, true, true, false).unwrap();
    let law = SlidingMass {
        stiffness: 1.0,
        limit: 1.0,
        late: 0.0,
    };
    for seed in 0..32 {
        let x = motion(&set, seed);
        let (apart, pieces) = followed(&law, &set, &x);
        assert!(apart == 0.0, "{seed}: {apart:e}");
        // An odd number of half turns, whose last one has the sign of the motion.
        let force = stepped(&set, &x, 81);
        let h = PI / STEPS as f64;
        let (mut differs, mut slips) = (0.0, false);
        for (k, f) in force.iter().enumerate() {
            let tau = (k as f64 + 0.5) * h;
            let at = pieces[0].start + (tau - pieces[0].start).rem_euclid(PI);
            let sign = if ((tau - pieces[0].start).div_euclid(PI) as i64) % 2 == 0 {
                1.0
            } else {
                -1.0
            };
            let piece = &pieces[pieces.partition_point(|p| p.start <= at) - 1];
            let own = piece.slope * jet(&set, &x, tau).x + sign * piece.offset;
            differs += h * (own - f).abs();
            slips |= law.state(piece) == crate::contact::forms::contact_state::State::Slip;
        }
        assert!(slips && differs < 6e-3, "{seed}: {differs:e}");
    }
}

/// Late forces may let two motions approach each other ever so slowly, as this one of 20,000: the time that is left is told.
#[test]
fn half_turns_that_do_not_repeat_themselves_are_told() {
    let set = HarmonicSet::excited(&[1], 5, true, true, false).unwrap();
    let law = SlidingMass {
        stiffness: 1.0,
        limit: 1.0,
        late: 0.1,
    };
    let apart = |first: f64| {
        let x = [
            first,
            0.0,
            -0.038_488_951_846_097_44,
            0.0,
            0.0,
            0.049_747_394_157_306_31,
        ];
        followed(&law, &set, &x).0
    };
    let found = apart(1.5015);
    assert!(found > 1e-8 && found < 1e-4, "{found:e}");
    assert!(apart(1.3) == 0.0 && apart(1.7) == 0.0);
}
