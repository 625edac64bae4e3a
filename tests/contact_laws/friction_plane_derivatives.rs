//! Derivatives of friction in a plane against differences.

use crate::common::depth::some_of;
use crate::common::plane::{Random, evaluate, largest, law};
use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::PlanePiece;
use hbvib::{Interrupt, State};
use std::f64::consts::PI;

#[test]
fn the_jacobian_is_the_derivative_of_the_force() {
    let mut random = Random(3);
    let mut worst = 0.0_f64;
    let (mut entries, mut corners) = (0, 0);
    let (mut opened, mut slipped_in_part, mut slipped) = (0, 0, 0);
    for highest in [1, 3, 5] {
        // Every fifth has all kinds too.
        for round in (0..60).step_by(some_of(5, 1)) {
            let has_normal = round % 4 != 0;
            // Half a turn suffices for odd motions under a constant load.
            let set = if round % 8 == 4 {
                HarmonicSet::excited(&[1], highest, true, true, false).unwrap()
            } else {
                HarmonicSet::all(highest).unwrap()
            };
            let load = if has_normal { 0.8 + 0.6 * random.next() } else { 0.8 };
            let mut law = law(load, has_normal);
            // From soft to nearly rigid.
            law.kt *= [1.0, 1.0, 0.1, 1e3][round / 4 % 4];
            let d = law.directions();
            let motion = random.motion(&set, d, [0.8, 3.0, 20.0][round % 3]);
            let (out, mut way) = evaluate(&law, &set, &motion);
            opened += usize::from(out.open_fraction > 0.0);
            slipped_in_part += usize::from(out.slip_fraction > 0.0 && out.slip_fraction < 0.9);
            slipped += usize::from(out.slip_fraction > 0.9);
            let scale = largest(&out.jacobian).max(1.0);
            let mut other = Evaluation::new(&set, d).unwrap();
            for c in 0..motion.len() {
                let h = 1e-6;
                let mut at = |t: f64| {
                    let mut x = motion.clone();
                    x[c] += t * h;
                    way.evaluate(&law, &set, &x, &mut other, &Interrupt::none()).unwrap();
                    other.force.clone()
                };
                let (up, down, up2, down2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
                for (r, exact) in out.jacobian[c * motion.len()..][..motion.len()].iter().enumerate() {
                    let near = (up[r] - down[r]) / (2.0 * h);
                    let far = (up2[r] - down2[r]) / (4.0 * h);
                    entries += 1;
                    // Where a motion grazes its limit the force has a corner: the two differences then disagree,
                    // whatever the Jacobian says.
                    if (near - far).abs() > 1e-6 * scale {
                        corners += 1;
                        continue;
                    }
                    let central = (4.0 * near - far) / 3.0;
                    worst = worst.max((central - exact).abs() / scale);
                }
            }
            let n = motion.len();
            for r in 0..n {
                let product: f64 = (0..n).map(|c| out.jacobian[c * n + r] * motion[c]).sum();
                assert!((out.force[r] - product - out.offset[r]).abs() < 1e-12 * (scale + largest(&motion)));
            }
        }
    }
    println!("largest relative error of the Jacobian {worst:.1e}");
    println!("{corners} of {entries} entries left out at corners");
    println!("{opened} with separation, {slipped_in_part} with partial, {slipped} with full slip");
    let least = some_of(2, 10);
    assert!(opened > least && slipped_in_part > least && slipped > least / 2);
    assert!(worst < 1e-6 && 1000 * corners < entries);
}

#[test]
fn a_slider_dragged_across_rests_with_the_force_at_the_limit_and_its_derivative() {
    // A straight vibration within the limit, loaded across far beyond it: the slider rests where the force is on
    // the limit at both ends of the motion, f₂ = √(μ²N² − kt²A²).
    let set = HarmonicSet::all(1).unwrap();
    let law = law(1.0, false);
    let limit = law.mu * law.load;
    for stretch in [0.4, 0.8, 0.97, 0.98, 0.9999] {
        let pull = stretch * limit;
        let motion = [0.0, pull / law.kt, 0.0, 2.0, 0.0, 0.0];
        let (out, mut way) = evaluate(&law, &set, &motion);
        let most = (0..64).fold(0.0_f64, |m, k| {
            let f = way.path().force(PI / 32.0 * f64::from(k)).0;
            m.max(f[0].hypot(f[1]))
        });
        assert!((most - limit).abs() < 1e-14 && out.slip_fraction == 0.0 && !out.stuck);
        let mut other = Evaluation::new(&set, 2).unwrap();
        let h = 1e-6 * (1.0 - stretch);
        let mut at = |t: f64| {
            let mut x = motion;
            x[1] += t;
            way.evaluate(&law, &set, &x, &mut other, &Interrupt::none()).unwrap();
            other.force[3]
        };
        let (central, exact) = ((at(h) - at(-h)) / (2.0 * h), out.jacobian[6 + 3]);
        println!("pull {stretch}: derivative {exact:.9}, differences {central:.9}");
        let rest = (limit * limit - pull * pull).sqrt();
        assert!((out.force[3] - rest).abs() < 1e-12 && out.force[0].abs() < 1e-12);
        assert!((exact + law.kt * pull / rest).abs() < 1e-8 && (central / exact - 1.0).abs() < 1e-4);
    }
}

#[test]
fn a_stick_that_a_closing_leaves_for_a_moment_only_has_finite_derivatives() {
    let set = HarmonicSet::all(2).unwrap();
    let law = law(0.0, true);
    let packed = set.packed_len();
    // N = kn·(0.5 − cos τ) closes at τ = π/3 with R′ = μ kn sin(π/3).
    let closing = PI / 3.0;
    let limit_rate = law.mu * law.kn * (PI / 3.0).sin();
    for share in [0.9, 0.99, 0.9999, 0.999_999, 1.0, 1.01] {
        // Along (0.6, −0.8) the motion has the rate share·R′/kt at the closing, and grows from there: a sin(τ − τc) + b (1 − cos 2(τ − τc)).
        let (a, b) = (share * limit_rate / law.kt, 0.3);
        let (sin, cos) = closing.sin_cos();
        let (sin2, cos2) = (2.0 * closing).sin_cos();
        let along = [b, -a * sin, -a * cos, -b * cos2, b * sin2];
        let mut motion = vec![0.0; 3 * packed];
        for (k, x) in along.into_iter().enumerate() {
            motion[k] = 0.6 * x;
            motion[packed + k] = -0.8 * x;
        }
        motion[2 * packed] = -0.5;
        motion[2 * packed + 1] = 1.0;
        let (out, mut way) = evaluate(&law, &set, &motion);
        let states: Vec<State> = way.path().pieces.iter().map(PlanePiece::state).collect();
        let sticks = states.contains(&State::Stick);
        assert!(states.contains(&State::Open) && states.contains(&State::Slip));
        assert!(sticks || share > 0.999, "share {share}: no stick after the closing");
        let mut other = Evaluation::new(&set, 3).unwrap();
        let h = 1e-7;
        let mut worst = 0.0_f64;
        for c in 0..motion.len() {
            let mut at = |t: f64| {
                let mut x = motion.clone();
                x[c] += t;
                way.evaluate(&law, &set, &x, &mut other, &Interrupt::none()).unwrap();
                other.force.clone()
            };
            let (up, down) = (at(h), at(-h));
            for (r, exact) in out.jacobian[c * motion.len()..][..motion.len()].iter().enumerate() {
                worst = worst.max((exact - (up[r] - down[r]) / (2.0 * h)).abs());
            }
        }
        println!("u′/R′ = {share} at the closing: sticks {sticks}, derivatives {worst:.1e}");
        assert!(worst < 1e-5, "share {share}: {worst:e}");
    }
}
