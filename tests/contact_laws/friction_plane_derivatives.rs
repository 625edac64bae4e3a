//! Derivatives of friction in a plane, of single steps and of the sampled force, against differences.

use crate::common::plane::{OMEGA, Random, evaluate, largest, law};
use hbvib::aft::Evaluation;
use hbvib::contact::law::Hysteretic;
use hbvib::contact::law::Law;
use hbvib::contact::laws::friction_3d::Friction3d;
use hbvib::contact::march::March;
use hbvib::fourier::HarmonicSet;
use hbvib::interrupt::Interrupt;
use std::f64::consts::PI;

/// The state after one step from motion `before` to `after`.
fn stepped(law: &Friction3d, x: &[f64]) -> (Vec<f64>, March) {
    let mut march = March::new(3, 2, 2).unwrap();
    let u: Vec<f64> = x[5..8].iter().chain(&x[2..5]).copied().collect();
    law.march(OMEGA, 2, &u, &[], &x[..2], &mut march).unwrap();
    (march.z[..2].to_vec(), march)
}

#[test]
fn the_derivatives_of_a_step_are_those_of_differences() {
    let mut random = Random(1);
    let (mut worst, mut skipped, mut kinds) = (0.0_f64, 0, [0; 5]);
    let count = 4000;
    for _ in 0..count {
        let law = law(0.5 * random.next(), true);
        let mut x: Vec<f64> = (0..8).map(|_| random.next()).collect();
        // Some short travels, which stick, and a state within the limit at the start.
        if random.next() > 0.0 {
            for i in 5..7 {
                x[i] = x[i - 3] + 0.1 * (x[i] - x[i - 3]);
            }
        }
        let limit = law.mu * (law.load - law.kn * x[4]).max(0.0);
        let (angle, size) = (PI * random.next(), limit * random.next().abs());
        x[0] = size * angle.cos();
        x[1] = size * angle.sin();
        let (z, march) = stepped(&law, &x);
        let kind = match (march.slip[0], march.open[0]) {
            (_, 1.0) => 0,
            (s, o) if o > 0.0 && s == 0.0 => 1,
            (_, o) if o > 0.0 => 2,
            (s, _) if s > 0.0 => 3,
            _ => 4,
        };
        kinds[kind] += 1;
        for k in 0..8 {
            let h = 1e-6;
            let at = |t: f64| {
                let mut y = x.clone();
                y[k] += t * h;
                stepped(&law, &y).0
            };
            let (up, down, up2, down2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
            for i in 0..2 {
                let exact = match k {
                    0 | 1 => march.dz_dz[2 * i + k],
                    2..=4 => march.dz_du_before[3 * i + k - 2],
                    _ => march.dz_du[3 * i + k - 5],
                };
                let right = (up2[i] - z[i]) / (2.0 * h);
                let left = (z[i] - down2[i]) / (2.0 * h);
                if (right - left).abs() > 1e-2 * (1.0 + right.abs()) {
                    skipped += 1;
                    continue;
                }
                let central = (8.0 * (up[i] - down[i]) - up2[i] + down2[i]) / (12.0 * h);
                worst = worst.max((central - exact).abs() / (1.0 + exact.abs()));
            }
        }
    }
    println!("open, closing to stick, closing or opening with slip, slip, stick: {kinds:?}");
    println!("largest error of a step's derivatives {worst:.1e}, {skipped} kinks left out");
    assert!(kinds.iter().all(|k| *k > 50));
    assert!(worst < 1e-5 && skipped < count / 100);
}

#[test]
fn a_state_on_the_limit_or_beyond_it_is_followed_along_the_limit() {
    // On the circle the derivative along it is unique: of the angle, and of the load with the radius.
    let mut random = Random(7);
    let mut worst = 0.0_f64;
    for beyond in [1.0, 1.5] {
        for _ in 0..500 {
            let law = law(1.5, true);
            let motion: Vec<f64> = (0..6).map(|_| 0.5 * random.next()).collect();
            let angle = PI * random.next();
            let at = |angle: f64, rise: f64| {
                let mut x = vec![0.0; 8];
                x[2..].copy_from_slice(&motion);
                x[4] += rise;
                let r = beyond * law.mu * (law.load - law.kn * x[4]);
                x[0] = r * angle.cos();
                x[1] = r * angle.sin();
                x
            };
            let x = at(angle, 0.0);
            let (_, march) = stepped(&law, &x);
            let h = 1e-5;
            for rise in [false, true] {
                let shifted = |t: f64| if rise { at(angle, t) } else { at(angle + t, 0.0) };
                let (up, down) = (shifted(h), shifted(-h));
                let direction: Vec<f64> = up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect();
                let (z_up, z_down) = (stepped(&law, &up).0, stepped(&law, &down).0);
                for i in 0..2 {
                    let exact = march.dz_dz[2 * i] * direction[0]
                        + march.dz_dz[2 * i + 1] * direction[1]
                        + march.dz_du_before[3 * i + 2] * direction[4];
                    let central = (z_up[i] - z_down[i]) / (2.0 * h);
                    let forward = (z_up[i] - stepped(&law, &x).0[i]) / h;
                    if (forward - central).abs() < 1e-3 {
                        worst = worst.max((central - exact).abs());
                    }
                }
            }
        }
    }
    println!("largest error along the limit {worst:.1e}");
    assert!(worst < 1e-7);
}

#[test]
fn the_jacobian_is_the_derivative_of_the_sampled_force() {
    let mut random = Random(3);
    let (mut worst, mut most) = (0.0_f64, 0);
    let (mut entries, mut corners) = (0, 0);
    let (mut opened, mut slipped_in_part, mut slipped) = (0, 0, 0);
    for (highest, samples) in [(1, 32), (3, 64), (5, 100)] {
        let set = HarmonicSet::all(highest).unwrap();
        for round in 0..120 {
            let has_normal = round % 4 != 0;
            let load = if has_normal { 0.8 + 0.6 * random.next() } else { 0.8 };
            let law = law(load, has_normal);
            let d = law.directions();
            let motion = random.motion(&set, d, [0.8, 3.0, 20.0][round % 3]);
            let (out, mut way) = evaluate(&law, &set, samples, &motion);
            most = most.max(way.marches());
            opened += usize::from(out.open_fraction > 0.0);
            slipped_in_part += usize::from(out.slip_fraction > 0.0 && out.slip_fraction < 0.9);
            slipped += usize::from(out.slip_fraction > 0.9);
            let scale = largest(&out.jacobian).max(1.0);
            let mut other = Evaluation::new(&set, d).unwrap();
            for c in 0..motion.len() {
                let h = 1e-7;
                let mut at = |t: f64| {
                    let mut x = motion.clone();
                    x[c] += t * h;
                    way.evaluate(&law, OMEGA, &x, &mut other, &Interrupt::none()).unwrap();
                    other.force.clone()
                };
                let (up, down, up2, down2) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
                for (r, exact) in out.jacobian[c * motion.len()..][..motion.len()].iter().enumerate() {
                    let near = (up[r] - down[r]) / (2.0 * h);
                    let far = (up2[r] - down2[r]) / (4.0 * h);
                    entries += 1;
                    // Where a sample changes from slip to stick the sampled force has a corner: the two
                    // differences then disagree, whatever the Jacobian says.
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
    println!("largest relative error of the Jacobian {worst:.1e}, most marches {most}");
    println!("{corners} of {entries} entries left out at corners");
    println!("{opened} with separation, {slipped_in_part} with partial, {slipped} with full slip");
    assert!(opened > 10 && slipped_in_part > 10 && slipped > 5);
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
        let (out, mut way) = evaluate(&law, &set, 64, &motion);
        assert!(way.marches() <= 2);
        let most = way
            .march()
            .f
            .chunks_exact(2)
            .map(|f| f[0].hypot(f[1]))
            .fold(0.0, f64::max);
        assert!((most - limit).abs() < 1e-14 && out.slip_fraction < 1e-11 && !out.stuck);
        let mut other = Evaluation::new(&set, 2).unwrap();
        let h = 1e-6 * (1.0 - stretch);
        let mut at = |t: f64| {
            let mut x = motion;
            x[1] += t;
            way.evaluate(&law, OMEGA, &x, &mut other, &Interrupt::none()).unwrap();
            other.force[3]
        };
        let (central, exact) = ((at(h) - at(-h)) / (2.0 * h), out.jacobian[6 + 3]);
        println!("pull {stretch}: derivative {exact:.9}, differences {central:.9}");
        let rest = (limit * limit - pull * pull).sqrt();
        assert!((out.force[3] - rest).abs() < 1e-12 && out.force[0].abs() < 1e-12);
        assert!((exact + law.kt * pull / rest).abs() < 1e-8 && (central / exact - 1.0).abs() < 1e-4);
    }
}
