//! Friction in a plane that sticks through the period: where its slider rests, found by trying all
//! candidates; the exact harmonics of its normal force.

use crate::common::plane::{Random, evaluate, gap, largest, law};
use crate::common::rest::{Disc, nearest_of_many, outside};
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::PlaneFrictionEvaluator;
use hbvib::internals::Repetition;
use hbvib::internals::ScaledFriction3d;
use std::f64::consts::TAU;

/// The discs in which the slider may rest, at equidistant times.
fn discs(law: &ScaledFriction3d, set: &HarmonicSet, samples: usize, motion: &[f64]) -> Vec<Disc> {
    let m = set.packed_len();
    let mut row = vec![0.0; m];
    let of = |j: usize| {
        set.basis(TAU * j as f64 / samples as f64, &mut row);
        let value = |k: usize| row.iter().zip(&motion[k * m..]).map(|(b, x)| b * x).sum::<f64>();
        let load = if law.has_normal {
            law.load - law.kn * value(2)
        } else {
            law.load
        };
        ([value(0), value(1)], law.mu * load / law.kt)
    };
    (0..samples).map(of).collect()
}

/// Where a slider at rest is, from the force at τ = 0.
fn slider(law: &ScaledFriction3d, way: &PlaneFrictionEvaluator, x: [f64; 2]) -> [f64; 2] {
    let f = way.path().force(0.0).0;
    [x[0] - f[0] / law.kt, x[1] - f[1] / law.kt]
}

#[test]
fn a_slider_that_can_rest_is_at_the_admissible_point_nearest_to_its_virgin_place() {
    let set = HarmonicSet::all(3).unwrap();
    // A slider held back by fewer times lies nearer to 0, by as little as these times are apart, squared.
    let n = 2000;
    let mut random = Random(2);
    let (mut kinds, mut worst) = ([0; 4], 0.0_f64);
    for round in 0..400 {
        let law = law(1.2 + 0.5 * random.next(), round % 2 == 0);
        let size = [0.3, 0.8, 2.0][round % 3];
        let motion = random.motion(&set, law.directions(), size);
        let discs = discs(&law, &set, n, &motion);
        if discs.iter().any(|(_, radius)| *radius <= 0.0) {
            continue;
        }
        let (out, way) = evaluate(&law, &set, &motion);
        let Some(exact) = nearest_of_many(&discs, 1e-12) else {
            // No place to rest: it slips.
            kinds[3] += 1;
            assert!(out.slip_fraction > 0.0 && !out.stuck);
            continue;
        };
        if out.slip_fraction > 0.0 {
            // A place to rest at these times, but at none between them.
            continue;
        }
        let place = slider(&law, &way, discs[0].0);
        let most = discs.iter().map(|disc| outside(place, *disc)).fold(f64::MIN, f64::max);
        assert!(most < 1e-12, "{most:.1e} outside");
        worst = worst.max((place[0].hypot(place[1]) - exact[0].hypot(exact[1])).abs());
        let Repetition::Rests(holds) = &way.path().repetition else {
            panic!("it rests")
        };
        let held = holds.iter().flatten().count();
        let virgin = largest(&exact) == 0.0;
        kinds[if virgin { 0 } else { held.min(2) }] += 1;
        assert_eq!(out.stuck, virgin);
    }
    println!("virgin, on one circle, in a corner, slipping: {kinds:?}; largest gap {worst:.1e}");
    assert!(kinds.iter().all(|k| *k > 4) && worst < 2e-5);
}

#[test]
fn what_rests_does_not_depend_on_where_the_period_begins() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    let mut random = Random(8);
    let (mut worst, mut dragged) = (0.0_f64, 0);
    for _ in 0..600 {
        let law = law(1.0 + 0.3 * random.next(), true);
        let motion = random.motion(&set, 3, 0.7);
        let (out, _) = evaluate(&law, &set, &motion);
        // A third of a period later: X_h turns by e^{ihθ}.
        let mut later = motion.clone();
        for signal in later.chunks_exact_mut(m) {
            for (h, pair) in signal[1..].chunks_exact_mut(2).enumerate() {
                let (sin, cos) = (2.1 * (h + 1) as f64).sin_cos();
                (pair[0], pair[1]) = (cos * pair[0] - sin * pair[1], sin * pair[0] + cos * pair[1]);
            }
        }
        let (other, _) = evaluate(&law, &set, &later);
        if out.open_fraction > 0.0 {
            continue;
        }
        dragged += usize::from(!out.stuck);
        for i in [0, m] {
            worst = worst.max((out.force[i] - other.force[i]).abs());
        }
    }
    println!("{dragged} dragged, largest change of the mean force {worst:.1e}");
    assert!(dragged > 30 && worst < 1e-9);
}

#[test]
fn the_force_is_continuous_where_slip_begins() {
    // Growing motions from rest to far beyond the onset: the change of the force between neighbours shrinks
    // with their distance, at least as its square root.
    let set = HarmonicSet::all(3).unwrap();
    let mut random = Random(6);
    let mut crossed = 0;
    for round in 0..40 {
        let law = law(1.3, round % 2 == 0);
        let motion = random.motion(&set, law.directions(), 1.5);
        let at = |scale: f64| -> (Vec<f64>, bool) {
            let scaled: Vec<f64> = motion.iter().map(|x| scale * x).collect();
            let (out, _) = evaluate(&law, &set, &scaled);
            (out.force, out.slip_fraction == 0.0)
        };
        let (mut low, mut high) = (0.0, 2.0);
        if at(high).1 {
            continue;
        }
        crossed += 1;
        while high - low > 1e-10 {
            let middle = 0.5 * (low + high);
            *(if at(middle).1 { &mut low } else { &mut high }) = middle;
        }
        for step in [1e-4, 1e-6, 1e-8] {
            let jump = gap(&at(low - step).0, &at(high + step).0);
            assert!(jump < 20.0 * step.sqrt(), "round {round}, {step:.0e}: {jump:.1e}");
        }
    }
    println!("{crossed} onsets");
    assert!(crossed > 20);
}

#[test]
fn the_normal_force_has_exact_harmonics() {
    // Against those of max(n₀ − kn·y, 0) at very many times.
    let set = HarmonicSet::all(5).unwrap();
    let m = set.packed_len();
    let mut random = Random(4);
    let (mut opened, mut worst) = (0, 0.0_f64);
    let many = 1 << 14;
    let mut row = vec![0.0; m];
    for _ in 0..20 {
        let law = law(0.5 + 0.6 * random.next(), true);
        let motion = random.motion(&set, 3, 4.0);
        let (out, _) = evaluate(&law, &set, &motion);
        opened += usize::from(out.open_fraction > 0.0);
        let (mut force, mut tangent) = (vec![0.0; m], vec![0.0; m * m]);
        for j in 0..many {
            set.basis(TAU * f64::from(j) / f64::from(many), &mut row);
            let y: f64 = row.iter().zip(&motion[2 * m..]).map(|(b, y)| b * y).sum();
            let load = law.load - law.kn * y;
            for r in 0..m {
                let weight = if r == 0 { 1.0 } else { 2.0 } / f64::from(many) * row[r];
                force[r] -= weight * load.max(0.0);
                for c in 0..m {
                    tangent[c * m + r] += if load > 0.0 { weight * law.kn * row[c] } else { 0.0 };
                }
            }
        }
        worst = worst.max(gap(&out.force[2 * m..], &force));
        for k in 0..m {
            let column = |c: usize| &out.jacobian[c * 3 * m..][2 * m..3 * m];
            assert!(gap(column(2 * m + k), &tangent[k * m..][..m]) < 1e-3);
            assert!(largest(column(k)) == 0.0 && largest(column(m + k)) == 0.0);
        }
    }
    println!("{opened} with separation, largest gap {worst:.1e}");
    assert!(opened > 5 && worst < 1e-6);
}
