//! Friction in a plane on prescribed motions: against small steps in time, circular and straight motion against closed
//! forms and the laws of one direction, symmetry, limits and work.

use crate::common::plane::{OMEGA, Random, evaluate, gap, largest, law, short};
use crate::common::plane_step::stepped;
use hbvib::Interrupt;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::ScaledFriction2d;
use hbvib::internals::ScaledFriction3d;
use hbvib::internals::ScaledJenkins;
use hbvib::internals::{Evaluation, Evaluator};
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

#[test]
fn small_steps_approach_the_force() {
    // Steps are of second order: each error is a sixteenth of the one before, down to the rounding of many steps.
    let mut random = Random(11);
    let mut opened = 0;
    for round in 0..16 {
        let set = HarmonicSet::all([3, 6][round % 2]).unwrap();
        let law = law(0.6 + 0.5 * random.next(), round % 3 != 0);
        let motion = random.motion(&set, law.directions(), 4.0);
        let (out, _) = evaluate(&law, &set, &motion);
        opened += usize::from(out.open_fraction > 0.0 && out.open_fraction < 1.0);
        if out.slip_fraction == 0.0 {
            continue;
        }
        let errors: Vec<f64> = [1 << 9, 1 << 11, 1 << 13]
            .map(|n| gap(&stepped(&law, &set, &motion, n).0, &out.force) / largest(&out.force))
            .to_vec();
        println!("relative gaps {}, open {:.2}", short(&errors), out.open_fraction);
        assert!(errors[2] < 5e-6 && errors[2] < 0.03 * errors[0]);
    }
    assert!(opened > 2);
}

#[test]
fn every_motion_has_a_periodic_force() {
    let mut random = Random(77);
    let (mut slips, mut rests) = (0, 0);
    for round in 0..3000 {
        let all = HarmonicSet::all([1, 3, 7][round % 3]).unwrap();
        let odd = HarmonicSet::excited(&[1], 7, true, true, false).unwrap();
        let has_normal = round % 2 == 0;
        let set = if round % 5 == 1 && !has_normal { odd } else { all };
        let law = law(0.6 + 0.5 * random.next(), has_normal);
        let size = 10.0_f64.powf(1.5 * random.next());
        let motion = random.motion(&set, law.directions(), size);
        let (out, way) = evaluate(&law, &set, &motion);
        // The force at the end of the turn is that at its begin.
        let pieces = &way.path().pieces;
        let start = pieces[0].start;
        let jump = gap(&way.path().force(start).0, &way.path().force(start + TAU - 1e-12).0);
        assert!(jump < 1e-8 * (1.0 + largest(&out.force)), "round {round}: {jump:.1e}");
        for (before, after) in pieces.iter().zip(&pieces[1..]) {
            assert!((before.end - after.start).abs() < 1e-9);
        }
        *(if out.slip_fraction > 0.0 {
            &mut slips
        } else {
            &mut rests
        }) += 1;
    }
    println!("{slips} slip, {rests} do not");
    assert!(slips > 500 && rests > 500);
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
        let (out, way) = evaluate(&law, &set, &motion);
        assert!(out.slip_fraction > 1.0 - 1e-12 && out.open_fraction == 0.0);
        for k in 0..100 {
            let f = way.path().force(0.07 * f64::from(k)).0;
            assert!((f[0].hypot(f[1]) - limit).abs() < 1e-14);
        }
        let error = gap(&out.force, &exact) / limit;
        println!("amplitude {amplitude:.3}: {error:.1e}");
        assert!(error < 1e-12);
    }
}

#[test]
fn straight_motion_obeys_the_law_of_one_direction() {
    let mut random = Random(23);
    let mut opened = 0;
    for round in 0..60 {
        let set = HarmonicSet::all([1, 3, 8][round % 3]).unwrap();
        let m = set.packed_len();
        let law = law([1.5, 0.6, 0.1][round / 3 % 3], true);
        let motion = random.motion(&set, 2, 3.0);
        let line = ScaledFriction2d {
            kt: law.kt,
            kn: law.kn,
            mu: law.mu,
            load: law.load,
            slider: 0.0,
        };
        let mut exact = Evaluation::new(&set, 2).unwrap();
        Evaluator::new(&set, 0, std::iter::once(&line as &dyn Law))
            .unwrap()
            .evaluate(&line, &set, &motion, OMEGA, &mut exact, &Interrupt::none())
            .unwrap();
        let (x, y) = motion.split_at(m);
        let (cos, sin) = (0.6, -0.8);
        let turned = |x: &[f64]| -> Vec<f64> { [cos, sin].iter().flat_map(|c| x.iter().map(move |x| c * x)).collect() };
        let (out, _) = evaluate(&law, &set, &[&turned(x)[..], y].concat());
        opened += usize::from(out.open_fraction > 0.0 && out.open_fraction < 1.0);
        let scale = largest(&exact.force).max(1e-3);
        let force = gap(&out.force[..2 * m], &turned(&exact.force[..m])) / scale;
        // Along the line the derivatives are those of one direction, too.
        let mut jacobian = 0.0_f64;
        for k in 0..m {
            let column = |c: usize| &out.jacobian[c * 3 * m..][..2 * m];
            let along: Vec<f64> = column(k)
                .iter()
                .zip(column(m + k))
                .map(|(a, b)| cos * a + sin * b)
                .collect();
            jacobian = jacobian.max(gap(&along, &turned(&exact.jacobian[k * 2 * m..][..m])));
            jacobian = jacobian.max(gap(column(2 * m + k), &turned(&exact.jacobian[(m + k) * 2 * m..][..m])));
        }
        assert!(
            force < 1e-9 && jacobian < 1e-7,
            "round {round}: force {force:.1e}, Jacobian {jacobian:.1e}"
        );
        assert!((out.slip_fraction - exact.slip_fraction).abs() < 1e-6);
    }
    assert!(opened > 10);
}

#[test]
fn constant_load_on_a_line_is_the_jenkins_element_its_dragged_mean_included() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    let law = law(1.0, false);
    let jenkins = ScaledJenkins {
        stiffness: law.kt,
        limit: law.mu * law.load,
        slider: 0.0,
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
        evaluator.prepare(&set, &x, &Interrupt::none()).unwrap();
        evaluator
            .evaluate(&jenkins, &set, &x, OMEGA, &mut exact, &Interrupt::none())
            .unwrap();
        let mut motion = x.clone();
        motion.resize(2 * m, 0.0);
        let (out, _) = evaluate(&law, &set, &motion);
        let force = gap(&out.force[..m], &exact.force) / largest(&exact.force);
        let block: Vec<f64> = (0..m).flat_map(|c| out.jacobian[c * 2 * m..][..m].to_vec()).collect();
        let jacobian = gap(&block, &exact.jacobian) / law.kt;
        println!("mean {mean}, amplitude {amplitude}: force {force:.1e}, Jacobian {jacobian:.1e}");
        assert_eq!(out.stuck, exact.stuck);
        assert!((out.slip_fraction - exact.slip_fraction).abs() < 1e-9);
        assert!(force < 1e-11 && jacobian < 1e-9);
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
        let one = evaluate(&law, &set, &motion).0;
        let other = evaluate(&law, &set, &turned(&motion)).0;
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
        let law = ScaledFriction3d {
            mu,
            load,
            ..law(1.0, false)
        };
        let (out, _) = evaluate(&law, &set, &motion);
        assert!(out.stuck && out.slip_fraction == 0.0);
        let spring: Vec<f64> = motion.iter().map(|x| law.kt * x).collect();
        assert!(gap(&out.force, &spring) < 1e-13 && largest(&out.offset) < 1e-13);
        for (i, j) in out.jacobian.iter().enumerate() {
            let exact = if i % (2 * m + 1) == 0 { law.kt } else { 0.0 };
            assert!((j - exact).abs() < 1e-13);
        }
    }
    let motion = random.motion(&set, 3, 2.0);
    for law in [
        ScaledFriction3d {
            mu: 0.0,
            ..law(0.5, true)
        },
        ScaledFriction3d {
            kt: 0.0,
            ..law(0.5, true)
        },
        ScaledFriction3d {
            load: -9.0,
            ..law(0.5, true)
        },
    ] {
        let (out, _) = evaluate(&law, &set, &motion);
        assert!(largest(&out.force[..2 * m]) == 0.0 && !out.stuck);
        assert!(out.jacobian.iter().all(|j| j.is_finite()));
        assert_eq!(largest(&out.force) > 0.0, law.load > 0.0);
    }
    // Normal motion alone, and no motion at all.
    for law in [law(0.5, true), law(-0.5, true), law(0.0, true)] {
        let mut still = vec![0.0; 3 * m];
        let (out, _) = evaluate(&law, &set, &still);
        assert!((out.force[2 * m] + law.load.max(0.0)).abs() < 1e-14);
        still[2 * m + 1] = 2.0;
        let (out, _) = evaluate(&law, &set, &still);
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
        let (out, way) = evaluate(&law, &set, &motion);
        let mut work = 0.0;
        for i in 0..3 {
            for h in 0..set.numbers().len() {
                let of = |packed: &[f64]| set.get(&packed[i * m..(i + 1) * m], h);
                work += PI * set.numbers()[h] as f64 * (of(&out.force) * of(&motion).conj()).im;
            }
        }
        let mut gaps = Vec::new();
        for n in [512, 8192] {
            // Loss: the slip of each step, travel less elastic stretch, against the mean force.
            let mut row = vec![0.0; m];
            let mut at = |j: usize| -> ([f64; 2], [f64; 2]) {
                let tau = TAU * j as f64 / n as f64;
                set.basis(tau, &mut row);
                let x = |i: usize| row.iter().zip(&motion[i * m..]).map(|(b, x)| b * x).sum();
                ([x(0), x(1)], way.path().force(tau).0)
            };
            let mut loss = 0.0;
            for j in 0..n {
                let ((x, f), (x0, f0)) = (at(j), at((j + n - 1) % n));
                for i in 0..2 {
                    loss += 0.5 * (f[i] + f0[i]) * (x[i] - x0[i] - (f[i] - f0[i]) / law.kt);
                }
            }
            assert!(work > -1e-12 && loss > -1e-12, "{work} {loss}");
            gaps.push((work - loss).abs() / (largest(&motion) * law.mu));
        }
        println!("work less loss at 512 and 8192 samples {}", short(&gaps));
        assert!(gaps[1] < 1e-4 && (gaps[0] > 10.0 * gaps[1] || gaps[1] < 1e-9));
    }
}
