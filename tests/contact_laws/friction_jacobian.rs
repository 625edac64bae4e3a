//! Friction under a normal load that varies and vanishes: its Jacobian against differences of the force, which
//! the march over samples in `friction.rs` checks.

use crate::common::friction::{March, Random, distance, evaluate, pieces, slipping_at_closing, sticking_at_closing};
use hbvib::internals::Evaluation;
use hbvib::internals::HarmonicSet;
use hbvib::internals::ScaledFriction2d;

/// Column by column differences of the force, by the four-point rule.
fn differences(law: &ScaledFriction2d, set: &HarmonicSet, motion: &[f64], step: f64) -> Vec<f64> {
    let mut columns = Vec::new();
    for j in 0..motion.len() {
        let at = |s: f64| {
            let mut moved = motion.to_vec();
            moved[j] += s * step;
            evaluate(law, set, &moved).force
        };
        let (far, near) = ((at(2.0), at(-2.0)), (at(1.0), at(-1.0)));
        for i in 0..motion.len() {
            columns.push((8.0 * (near.0[i] - near.1[i]) - (far.0[i] - far.1[i])) / (12.0 * step));
        }
    }
    columns
}

#[test]
fn slip_at_closing_has_the_jacobian_of_differences() {
    let (law, set, motion) = slipping_at_closing();
    let error = distance(
        &evaluate(&law, &set, &motion).jacobian,
        &differences(&law, &set, &motion, 2e-4),
    );
    println!("{error:e}");
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn the_moving_time_of_closing_is_in_the_jacobian_and_not_in_a_marched_one() {
    let (law, set, motion) = sticking_at_closing();
    let (out, tangential, _) = pieces(&law, &set, &motion);
    assert!(tangential.iter().any(|p| p.moved_y != 0.0));
    let exact = differences(&law, &set, &motion, 2e-4);
    let error = distance(&out.jacobian, &exact);
    assert!(error < 1e-8, "{error:e}");
    for samples in [1 << 10, 1 << 14] {
        let mut marched = vec![0.0; out.jacobian.len()];
        let march = March {
            law: &law,
            set: &set,
            samples,
            located: false,
        };
        let force = march.run(&motion, Some(&mut marched));
        // Its force converges, its tangential force's derivative by the normal motion does not.
        let m = set.packed_len();
        assert!(distance(&force[..m], &out.force[..m]) < 10.0 / samples as f64);
        let block = |table: &[f64]| -> Vec<f64> {
            (m..2 * m)
                .flat_map(|j| table[j * 2 * m..j * 2 * m + m].to_vec())
                .collect()
        };
        let gap = distance(&block(&marched), &block(&exact));
        println!("{samples} samples: tangent off by {gap}, exact by {error:e}");
        assert!(gap > 0.1, "{samples}: {gap}");
    }
}

#[test]
fn every_block_of_the_jacobian_is_that_of_differences() {
    let mut random = Random(11);
    let mut errors = Vec::new();
    for i in 0..60 {
        let set = HarmonicSet::all([1, 3, 7][i % 3]).unwrap();
        let (law, motion) = random.case(&set);
        let out = evaluate(&law, &set, &motion);
        errors.push(distance(&out.jacobian, &differences(&law, &set, &motion, 1e-4)));
        // Homogeneity of degree 1 in motion and load: the offset is load·∂F/∂load.
        let at = |s: f64| {
            let load = law.load * (1.0 + s * 1e-4);
            evaluate(&ScaledFriction2d { load, ..law }, &set, &motion).force
        };
        let (far, near) = ((at(2.0), at(-2.0)), (at(1.0), at(-1.0)));
        let by_load: Vec<f64> = (0..motion.len())
            .map(|i| (8.0 * (near.0[i] - near.1[i]) - (far.0[i] - far.1[i])) / 12e-4)
            .collect();
        errors.push(distance(&out.offset, &by_load));
    }
    errors.sort_by(f64::total_cmp);
    println!("median {:e}, worst {:?}", errors[60], &errors[110..]);
    // The Jacobian jumps at the onset of a slip; no motion here is within a step of one.
    assert!(errors[119] < 1e-7, "{:?}", &errors[100..]);
}

#[test]
fn the_jacobian_integrates_to_the_force_through_every_change_of_events() {
    // From motions in one regime to motions in another, in steps of Gauss's rule of two points. At the onset of a
    // slip the anchor of what follows jumps, and the Jacobian with it: such a step is in error by its length.
    let mut random = Random(23);
    for i in 0..12 {
        let set = HarmonicSet::all([1, 3][i % 2]).unwrap();
        let (law, first) = random.case(&set);
        let scale = 2.0 + random.next();
        let second: Vec<f64> = random.case(&set).1.iter().map(|x| scale * x).collect();
        let steps = 4000;
        let along: Vec<f64> = second
            .iter()
            .zip(&first)
            .map(|(b, a)| (b - a) / f64::from(steps))
            .collect();
        let at = |s: f64| -> Evaluation {
            let motion: Vec<f64> = first.iter().zip(&along).map(|(a, d)| a + s * d).collect();
            evaluate(&law, &set, &motion)
        };
        let size = first.len();
        let (mut passed, mut worst) = (0, 0.0_f64);
        let mut before = at(0.0);
        for j in 0..steps {
            let after = at(f64::from(j + 1));
            let mut rise = before.force.clone();
            for side in [-0.5, 0.5] {
                let out = at(f64::from(j) + 0.5 + side / 3.0_f64.sqrt());
                for (column, d) in out.jacobian.chunks_exact(size).zip(&along) {
                    for (r, jacobian) in rise.iter_mut().zip(column) {
                        *r += 0.5 * jacobian * d;
                    }
                }
            }
            let error = distance(&rise, &after.force);
            passed += usize::from(error > 1e-9);
            worst = worst.max(error);
            before = after;
        }
        println!("{i}: {passed} of {steps} steps above 1e-9, the worst {worst:e}");
        let step = along.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        assert!(passed < 40 && worst < step, "{i}: {passed} {worst:e}");
    }
}

#[test]
fn the_jacobian_is_the_derivative_of_the_force_next_to_every_event() {
    // One direction of many motions. Where the slope of the force is monotone within the step it lies between the
    // one-sided differences. Bounds that all but stand still have many turning points, near each other.
    let mut random = Random(71);
    let step = 1e-7;
    for i in 0..4000 {
        let set = HarmonicSet::all([1, 2, 3, 5, 9][i % 5]).unwrap();
        let (mut law, mut motion) = random.case(&set);
        let m = set.packed_len();
        match i / 5 % 6 {
            0 => law.load = 3.0,
            1 => law.mu *= 4.0,
            2 => law.kn *= 100.0,
            3 => law.kt *= 100.0,
            4 => {
                for x in &mut motion[..m] {
                    *x *= 1e-3;
                }
            }
            _ => {
                let ratio = law.kt / (law.mu * law.kn) * random.next().signum();
                for k in 0..m {
                    motion[m + k] = ratio * motion[k] * (1.0 + 0.01 * random.next());
                }
            }
        }
        let direction: Vec<f64> = motion.iter().map(|_| random.next()).collect();
        let at = |s: f64| {
            let moved: Vec<f64> = motion.iter().zip(&direction).map(|(x, d)| x + s * step * d).collect();
            evaluate(&law, &set, &moved)
        };
        let (below, here, above) = (at(-1.0).force, at(0.0), at(1.0).force);
        let mut slope = vec![0.0; 2 * m];
        for (column, d) in here.jacobian.chunks_exact(2 * m).zip(&direction) {
            for (s, jacobian) in slope.iter_mut().zip(column) {
                *s += jacobian * d;
            }
        }
        let scale = law.kt + law.kn * (1.0 + law.mu);
        for k in 0..2 * m {
            let central = (above[k] - below[k]) / (2.0 * step);
            let gap = (above[k] - 2.0 * here.force[k] + below[k]).abs() / step;
            assert!(
                (central - slope[k]).abs() < gap + 3e-7 * scale,
                "{i}: {central:e} {:e} {law:?}",
                slope[k]
            );
        }
    }
}
