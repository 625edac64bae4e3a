//! Friction in a plane on prescribed motions: order in the number of samples, circular and straight
//! motion against closed forms and the scalar law, symmetry, limits and work.

use crate::common::plane::{OMEGA, Random, evaluate, gap, largest, law, short};
use hbvib::aft::{Evaluation, Evaluator};
use hbvib::contact::law::Law;
use hbvib::contact::laws::friction_3d::Friction3d;
use hbvib::contact::laws::jenkins::Jenkins;
use hbvib::fourier::HarmonicSet;
use hbvib::interrupt::Interrupt;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

#[test]
fn the_force_is_of_second_order_in_the_distance_of_samples() {
    let set = HarmonicSet::all(3).unwrap();
    let mut random = Random(11);
    let mut ratios = Vec::new();
    for round in 0..12 {
        let law = law(0.6 + 0.5 * random.next(), round % 3 != 0);
        let motion = random.motion(&set, law.directions(), 4.0);
        let (truth, _) = evaluate(&law, &set, 1 << 15, &motion);
        let errors: Vec<f64> = [128, 512, 2048]
            .map(|n| gap(&evaluate(&law, &set, n, &motion).0.force, &truth.force) / largest(&truth.force))
            .to_vec();
        println!(
            "relative error at 128, 512, 2048 samples: {}, open {:.2}",
            short(&errors),
            truth.open_fraction
        );
        ratios.push((errors[0] / errors[2]).log2() / 4.0);
    }
    ratios.sort_by(f64::total_cmp);
    println!("orders {ratios:.2?}");
    assert!(ratios[0] > 1.5 && ratios[ratios.len() / 2] > 1.8);
}

#[test]
fn circular_motion_slips_steadily_at_the_lag_of_its_closed_form() {
    // f = μN e^{iθ} turns with the motion x = A e^{iτ}: μN = kt A sin ψ, ψ the angle from f to x'.
    let set = HarmonicSet::all(1).unwrap();
    let law = law(1.0, false);
    let limit = law.mu * law.load;
    for amplitude in [1.01, 1.5, 10.0].map(|a| a * limit / law.kt) {
        let psi = (limit / (law.kt * amplitude)).asin();
        // x₁ = A cos τ, x₂ = A sin τ; the force leads the motion by π/2 − ψ.
        let motion = [0.0, amplitude, 0.0, 0.0, 0.0, -amplitude];
        let lead = Complex64::from_polar(limit, PI / 2.0 - psi);
        let exact = [0.0, lead.re, lead.im, 0.0, lead.im, -lead.re];
        let errors = [256, 1024, 4096].map(|n| {
            let (out, way) = evaluate(&law, &set, n, &motion);
            assert!(out.slip_fraction > 1.0 - 1e-12 && out.open_fraction == 0.0);
            for f in way.march().f.chunks_exact(2) {
                assert!((f[0].hypot(f[1]) - limit).abs() < 1e-14);
            }
            gap(&out.force, &exact) / limit
        });
        println!("amplitude {amplitude:.3}: {}", short(&errors));
        assert!(errors[2] < 1e-4 && errors[0] / errors[1] > 14.0 && errors[1] / errors[2] > 14.0);
    }
}

/// Force harmonics of the scalar law with the load N(y), marched over fine samples.
fn scalar_truth(law: &Friction3d, set: &HarmonicSet, x: &[f64], y: &[f64]) -> Vec<f64> {
    let n: u32 = 1 << 19;
    let m = set.packed_len();
    let mut row = vec![0.0; m];
    let mut sums = vec![0.0; m];
    let (mut f, mut before, mut load_before) = (0.0_f64, 0.0, law.load);
    for j in 0..3 * n {
        set.basis(TAU * f64::from(j % n) / f64::from(n), &mut row);
        let value = |signal: &[f64]| row.iter().zip(signal).map(|(b, s)| b * s).sum::<f64>();
        let load = law.load - law.kn * value(y);
        let limit = law.mu * load.max(0.0);
        let now = value(x);
        // From the time of closing on, where the sides close.
        let share = if load_before < 0.0 && load > 0.0 {
            load / (load - load_before)
        } else {
            1.0
        };
        f = (f + share * law.kt * (now - before)).clamp(-limit, limit);
        (before, load_before) = (now, load);
        if j >= 2 * n {
            for (k, (sum, b)) in sums.iter_mut().zip(&row).enumerate() {
                *sum += if k == 0 { 1.0 } else { 2.0 } / f64::from(n) * f * b;
            }
        }
    }
    sums
}

#[test]
fn straight_motion_obeys_the_scalar_law_with_variable_load() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    let mut random = Random(23);
    for load in [1.5, 0.6, 0.1] {
        let law = law(load, true);
        let x = random.motion(&set, 1, 3.0);
        let y = random.motion(&set, 1, 2.0);
        let truth = scalar_truth(&law, &set, &x, &y);
        let (cos, sin) = (0.6, -0.8);
        let motion: Vec<f64> = x
            .iter()
            .map(|x| cos * x)
            .chain(x.iter().map(|x| sin * x))
            .chain(y.iter().copied())
            .collect();
        let mut errors = [0.0; 2];
        for (error, n) in errors.iter_mut().zip([256, 4096]) {
            let (out, _) = evaluate(&law, &set, n, &motion);
            let along: Vec<f64> = (0..m).map(|i| cos * out.force[i] + sin * out.force[m + i]).collect();
            let across: Vec<f64> = (0..m).map(|i| cos * out.force[m + i] - sin * out.force[i]).collect();
            assert!(largest(&across) < 1e-13, "{:.1e}", largest(&across));
            *error = gap(&along, &truth) / largest(&truth);
        }
        println!("load {load}: relative error at 256 and 4096 samples {}", short(&errors));
        assert!(errors[1] < 5e-6 && errors[0] > 64.0 * errors[1]);
    }
}

#[test]
fn constant_load_on_a_line_is_the_jenkins_element_its_dragged_mean_included() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    let law = law(1.0, false);
    let jenkins = Jenkins {
        stiffness: law.kt,
        limit: law.mu * law.load,
    };
    let play = law.mu * law.load / law.kt;
    for (mean, amplitude) in [(0.0, 3.0), (2.0, 1.4), (0.4, 0.5), (3.0, 0.5), (-3.0, 0.5), (0.9, 0.5)] {
        let mut x = vec![0.0; m];
        x[0] = mean * play;
        x[1] = 0.6 * amplitude * play;
        x[2] = 0.8 * amplitude * play;
        x[5] = 0.05 * amplitude * play;
        let mut exact = Evaluation::new(&set, 1).unwrap();
        let mut evaluator = Evaluator::new(&set, 0, std::iter::once(&jenkins as &dyn Law)).unwrap();
        evaluator.prepare(&set, &x);
        evaluator
            .evaluate(&jenkins, &set, &x, OMEGA, &mut exact, &Interrupt::none())
            .unwrap();
        let mut motion = x.clone();
        motion.resize(2 * m, 0.0);
        let (out, _) = evaluate(&law, &set, 4096, &motion);
        let force = gap(&out.force[..m], &exact.force) / largest(&exact.force);
        let block: Vec<f64> = (0..m).flat_map(|c| out.jacobian[c * 2 * m..][..m].to_vec()).collect();
        let jacobian = gap(&block, &exact.jacobian) / law.kt;
        println!("mean {mean}, amplitude {amplitude}: force {force:.1e}, Jacobian {jacobian:.1e}");
        assert_eq!(out.stuck, exact.stuck);
        assert!((out.slip_fraction - exact.slip_fraction).abs() < 1e-3);
        assert!(force < 2e-5 && jacobian < 5e-3);
        assert!(largest(&out.force[m..]) < 1e-14);
    }
}

#[test]
fn turning_the_motion_about_the_normal_turns_the_force() {
    let set = HarmonicSet::all(5).unwrap();
    let m = set.packed_len();
    let mut random = Random(31);
    for angle in [0.3, PI / 2.0, 2.5] {
        let law = law(0.7, true);
        let (sin, cos) = f64::sin_cos(angle);
        let turned = |x: &[f64]| -> Vec<f64> {
            let mut y = x.to_vec();
            for i in 0..m {
                y[i] = cos * x[i] - sin * x[m + i];
                y[m + i] = sin * x[i] + cos * x[m + i];
            }
            y
        };
        let motion = random.motion(&set, 3, 3.0);
        let one = evaluate(&law, &set, 128, &motion).0;
        let other = evaluate(&law, &set, 128, &turned(&motion)).0;
        let force = gap(&turned(&one.force), &other.force);
        assert!(largest(&one.force[..2 * m]) > 5e-3);
        // J' R = R J, applied to a vector.
        let w = random.motion(&set, 3, 1.0);
        let product = |j: &[f64], v: &[f64]| -> Vec<f64> {
            (0..3 * m)
                .map(|r| (0..3 * m).map(|c| j[c * 3 * m + r] * v[c]).sum())
                .collect()
        };
        let jacobian = gap(
            &turned(&product(&one.jacobian, &w)),
            &product(&other.jacobian, &turned(&w)),
        );
        println!("angle {angle:.2}: force {force:.1e}, Jacobian {jacobian:.1e}");
        assert!(force < 1e-12 && jacobian < 1e-10);
    }
}

#[test]
fn without_a_limit_the_contact_is_a_spring_and_without_friction_it_has_no_tangential_force() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    let mut random = Random(5);
    let motion = random.motion(&set, 2, 2.0);
    for (mu, load) in [(1e12, 1.0), (0.4, 1e15), (0.4, f64::INFINITY)] {
        let law = Friction3d {
            mu,
            load,
            ..law(1.0, false)
        };
        let (out, way) = evaluate(&law, &set, 64, &motion);
        assert!(out.stuck && out.slip_fraction == 0.0 && way.marches() == 1);
        let spring: Vec<f64> = motion.iter().map(|x| law.kt * x).collect();
        assert!(gap(&out.force, &spring) < 1e-13 && largest(&out.offset) < 1e-13);
        for (i, j) in out.jacobian.iter().enumerate() {
            let exact = if i % (2 * m + 1) == 0 { law.kt } else { 0.0 };
            assert!((j - exact).abs() < 1e-13);
        }
    }
    let motion = random.motion(&set, 3, 2.0);
    for law in [
        Friction3d {
            mu: 0.0,
            ..law(0.5, true)
        },
        Friction3d {
            kt: 0.0,
            ..law(0.5, true)
        },
        Friction3d {
            load: -9.0,
            ..law(0.5, true)
        },
    ] {
        let (out, _) = evaluate(&law, &set, 64, &motion);
        assert!(largest(&out.force[..2 * m]) == 0.0 && !out.stuck);
        assert!(out.jacobian.iter().all(|j| j.is_finite()));
        assert_eq!(largest(&out.force) > 0.0, law.load > 0.0);
    }
    // Normal motion alone, and no motion at all.
    for law in [law(0.5, true), law(-0.5, true), law(0.0, true)] {
        let mut still = vec![0.0; 3 * m];
        let (out, _) = evaluate(&law, &set, 64, &still);
        assert!((out.force[2 * m] + law.load.max(0.0)).abs() < 1e-14);
        still[2 * m + 1] = 2.0;
        let (out, _) = evaluate(&law, &set, 64, &still);
        assert!(largest(&out.force[..2 * m]) == 0.0 && out.open_fraction > 0.0);
        assert!(out.jacobian.iter().all(|j| j.is_finite()));
    }
}

#[test]
fn work_per_cycle_is_the_friction_loss_and_never_negative() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    let mut random = Random(41);
    for round in 0..12 {
        let law = law(0.6 + 0.5 * random.next(), true);
        let motion = random.motion(&set, 3, [0.3, 3.0, 10.0][round % 3]);
        let mut gaps = Vec::new();
        for n in [512, 8192] {
            let (out, way) = evaluate(&law, &set, n, &motion);
            let mut work = 0.0;
            for i in 0..3 {
                for h in 0..set.numbers().len() {
                    let of = |packed: &[f64]| set.get(&packed[i * m..(i + 1) * m], h);
                    work += PI * set.numbers()[h] as f64 * (of(&out.force) * of(&motion).conj()).im;
                }
            }
            // Loss: the slip of each step, travel less elastic stretch, against the mean force.
            let mut row = vec![0.0; m];
            let mut at = |j: usize| -> Vec<f64> {
                set.basis(TAU * j as f64 / n as f64, &mut row);
                (0..2)
                    .map(|i| row.iter().zip(&motion[i * m..]).map(|(b, x)| b * x).sum())
                    .collect()
            };
            let mut loss = 0.0;
            for j in 0..n {
                let before = (j + n - 1) % n;
                let (x, x0) = (at(j), at(before));
                for i in 0..2 {
                    let (f, f0) = (way.march().f[3 * j + i], way.march().f[3 * before + i]);
                    loss += 0.5 * (f + f0) * (x[i] - x0[i] - (f - f0) / law.kt);
                }
            }
            assert!(work > -1e-12 && loss > -1e-12, "{work} {loss}");
            gaps.push((work - loss).abs() / (largest(&motion) * law.mu));
        }
        println!("work less loss at 512 and 8192 samples {}", short(&gaps));
        assert!(gaps[1] < 2e-6 && (gaps[0] > 40.0 * gaps[1] || gaps[1] < 1e-12));
    }
}
