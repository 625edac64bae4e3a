//! Friction in a plane whose motion is any multiple of its slip length, closed for all or a millionth of it: against the mapping
//! that returns a trial force to the limit, in any units, and with derivatives against differences.

use crate::common::depth::some_of;
use crate::common::plane::{Random, evaluate, gap, largest};
use hbvib::Interrupt;
use hbvib::internals::{Evaluation, HarmonicSet, Law, PlaneFrictionEvaluator, ScaledFriction3d};
use std::f64::consts::{PI, TAU};

/// Motions over the largest limit divided by kt.
const RATIOS: [f64; 10] = [1e-2, 3.0, 30.0, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e10];

/// Time of the largest load: at no node of the evaluation, which would otherwise see a touch however short it is.
const LOADED_AT: f64 = -0.5;

/// The normal load over a period: constant, varying, or that of a touch from −w to w about its time.
#[derive(Clone, Copy, Debug)]
enum Load {
    Constant,
    Varying,
    Touch(f64),
}

const LOADS: [Load; 7] = [
    Load::Constant,
    Load::Varying,
    Load::Touch(2.0),
    Load::Touch(0.5),
    Load::Touch(3e-2),
    Load::Touch(1e-3),
    Load::Touch(1e-5),
];

/// Packed harmonics 0 to 3 of both tangential motions, of size 1: a circle, an ellipse that is passed beside its centre, a line, the
/// cusps of an astroid, turned so that no cusp is at a touch, and a loop.
const PATHS: [[[f64; 7]; 2]; 5] = [
    [
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0],
    ],
    [
        [0.4, 0.5, 0.2, 0.0, 0.0, 0.0, 0.0],
        [-0.2, 0.1, 0.9, 0.0, 0.0, 0.0, 0.0],
    ],
    [
        [0.1, 0.48, 0.36, 0.0, 0.0, 0.1, 0.0],
        [0.1, 0.64, 0.48, 0.0, 0.0, 0.133_333_333_333_333_33, 0.0],
    ],
    [
        [0.0, 0.7, -0.2, 0.0, 0.0, 0.15, -0.2],
        [0.0, 0.2, 0.7, 0.0, 0.0, 0.2, -0.15],
    ],
    [
        [0.0, 0.3, -0.4, 0.3, 0.1, 0.0, 0.2],
        [0.0, -0.5, 0.1, 0.2, -0.3, 0.1, 0.1],
    ],
];

/// A law in units of force and length, and its packed motion.
struct Case {
    law: ScaledFriction3d,
    motion: Vec<f64>,
    /// Closed time.
    closed: [f64; 2],
}

/// The largest limit is 1 in units of force, kt 1 in units of force per length.
fn case(path: &[[f64; 7]; 2], load: Load, ratio: f64, units: [f64; 2]) -> Case {
    let [force, length] = units;
    let mu = 0.4;
    // N(τ) = mean + swing·cos(τ − time) with the largest value 1/μ.
    let (mean, swing, half) = match load {
        Load::Constant => (1.0, 0.0, PI),
        Load::Varying => (0.6, 0.4, PI),
        Load::Touch(w) => {
            // 1 − cos w without cancellation.
            let rise = 2.0 * (0.5 * w).sin().powi(2);
            (-w.cos() / rise, rise.recip(), w)
        }
    };
    let mut motion: Vec<f64> = path.iter().flatten().map(|x| ratio * length * x).collect();
    let has_normal = !matches!(load, Load::Constant);
    let kn = 2.0;
    if has_normal {
        let y = -swing / (mu * kn) * length;
        let (sin, cos) = LOADED_AT.sin_cos();
        motion.extend([0.0, y * cos, -y * sin, 0.0, 0.0, 0.0, 0.0]);
    }
    let law = ScaledFriction3d {
        kt: force / length,
        kn: if has_normal { kn * force / length } else { 0.0 },
        mu,
        load: mean / mu * force,
        has_normal,
        slider: [0.0; 2],
    };
    Case {
        law,
        motion,
        closed: [LOADED_AT - half, LOADED_AT + half],
    }
}

/// Tangential force harmonics by a trial of stick that returns to the limit, in steps over the closed time.
fn returned(case: &Case, set: &HarmonicSet, steps: usize) -> Vec<f64> {
    let m = set.packed_len();
    let law = &case.law;
    let [from, to] = case.closed;
    let mut row = vec![0.0; m];
    let mut at = |j: usize| {
        let tau = from + (to - from) * j as f64 / steps as f64;
        set.basis(tau, &mut row);
        let value = |k: usize| -> f64 { row.iter().zip(&case.motion[k * m..]).map(|(b, x)| b * x).sum() };
        let load = if law.has_normal {
            law.load - law.kn * value(2)
        } else {
            law.load
        };
        ([law.kt * value(0), law.kt * value(1)], law.mu * load, row.clone())
    };
    let times: Vec<_> = (0..=steps).map(&mut at).collect();
    let opens = to - from < TAU;
    // A closed contact begins virgin and repeats after a turn; after an opening it begins without force.
    let (mut force, turns) = if opens { ([0.0; 2], 1) } else { (times[0].0, 3) };
    let mut sums = vec![0.0; 2 * m];
    for _ in 0..turns {
        sums.fill(0.0);
        for pair in times.windows(2) {
            let ((before, ..), (now, limit, row)) = (&pair[0], &pair[1]);
            let trial: [f64; 2] = std::array::from_fn(|i| force[i] + now[i] - before[i]);
            let size = trial[0].hypot(trial[1]);
            let share = if size > *limit { limit.max(0.0) / size } else { 1.0 };
            force = trial.map(|f| share * f);
            for (sums, f) in sums.chunks_exact_mut(m).zip(force) {
                for (i, (sum, b)) in sums.iter_mut().zip(row).enumerate() {
                    let weight = if i == 0 { 1.0 } else { 2.0 };
                    *sum += weight * (to - from) / (TAU * steps as f64) * f * b;
                }
            }
        }
    }
    sums
}

#[test]
fn forces_of_any_stiffness_and_shortness_are_those_of_returned_steps() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    let (mut worst, mut slipping) = (0.0_f64, 0);
    for path in &PATHS {
        for load in LOADS {
            for ratio in RATIOS {
                let case = case(path, load, ratio, [1.0, 1.0]);
                let (out, _) = evaluate(&case.law, &set, &case.motion);
                slipping += usize::from(out.slip_fraction > 0.0);
                // The mean force over the closed time is the measure: the harmonics of a touch are that, times its share of the turn.
                let share = (case.closed[1] - case.closed[0]) / TAU;
                let [coarse, fine] = [1 << 11, 1 << 12].map(|steps| returned(&case, &set, steps));
                let error = gap(&fine, &out.force[..2 * m]) / share;
                // Steps are of first order, where a cusp or an onset of slip lies within one of less.
                let of_steps = gap(&fine, &coarse) / share;
                assert!(
                    error < 4e-4 + 3.0 * of_steps && of_steps < 5e-3,
                    "{path:?} {load:?} ratio {ratio:e}: {error:.1e}, steps {of_steps:.1e}"
                );
                worst = worst.max(error);
            }
        }
    }
    println!("{slipping} slip, largest error {worst:.1e}");
    assert!(slipping > 250);
}

#[test]
fn units_of_force_and_length_change_nothing() {
    let set = HarmonicSet::all(3).unwrap();
    let m = set.packed_len();
    for path in &PATHS {
        for load in LOADS {
            for ratio in RATIOS {
                let one = case(path, load, ratio, [1.0, 1.0]);
                let force = evaluate(&one.law, &set, &one.motion).0.force;
                let share = (one.closed[1] - one.closed[0]) / TAU;
                for units in [[1e-9, 1.0], [1e9, 1.0], [1.0, 1e-9], [1e9, 1e9]] {
                    let other = case(path, load, ratio, units);
                    let scaled = evaluate(&other.law, &set, &other.motion).0.force;
                    let scaled: Vec<f64> = scaled.iter().map(|f| f / units[0]).collect();
                    // The times of a touch w are differences of cos τ about 1: rounding of the normal motion moves them by ε/w².
                    let rounding = f64::EPSILON / share.powi(2);
                    let off = gap(&scaled[..2 * m], &force[..2 * m]) / share;
                    assert!(
                        off < 1e-9 * ratio.max(1.0).log10().max(1.0) + 10.0 * rounding,
                        "{path:?} {load:?} ratio {ratio:e} units {units:?}: {off:.1e}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_jacobian_of_a_short_touch_is_the_derivative_of_its_force() {
    let set = HarmonicSet::all(3).unwrap();
    let mut worst = 0.0_f64;
    let mut compared = 0;
    for path in &PATHS {
        for w in [0.5, 0.1, 1e-2] {
            for ratio in [3.0, 1e2, 1e4] {
                let Case { law, motion, .. } = case(path, Load::Touch(w), ratio, [1.0, 1.0]);
                let n = motion.len();
                let mut way = PlaneFrictionEvaluator::new(&set, &law).unwrap();
                let mut out = Evaluation::new(&set, 3).unwrap();
                let mut at = |x: &[f64]| {
                    way.evaluate(&law, &set, x, &mut out, &Interrupt::none()).unwrap();
                    (out.force.clone(), out.jacobian.clone())
                };
                let exact = at(&motion).1;
                for c in 0..n {
                    // A normal motion of size 1 presses as much as the preload; the tangential ones move by the ratio.
                    let size = if c < 2 * n / 3 { ratio } else { 1.0 };
                    let column = &exact[c * n..][..n];
                    let scale = largest(column).max(w / size);
                    // Where the motion turns back, the force changes with every slip length.
                    let step = (1e-5 * size).min(1e-2);
                    let mut difference = |h: f64| -> Vec<f64> {
                        let mut moved = |t: f64| {
                            let mut x = motion.clone();
                            x[c] += t;
                            at(&x).0
                        };
                        let (up, down) = (moved(h), moved(-h));
                        up.iter().zip(&down).map(|(up, down)| (up - down) / (2.0 * h)).collect()
                    };
                    let (near, far) = (difference(step), difference(2.0 * step));
                    for ((near, far), exact) in near.iter().zip(&far).zip(column) {
                        // An event that comes or goes is a corner: differences then disagree.
                        if (near - far).abs() < 1e-4 * scale {
                            worst = worst.max(((4.0 * near - far) / 3.0 - exact).abs() / scale);
                            compared += 1;
                        }
                    }
                }
            }
        }
    }
    println!("{compared} entries, largest relative error {worst:.1e}");
    // Differences of motions of many slip lengths round by up to 1e-5 of the derivatives.
    assert!(worst < 5e-5 && compared > 18_000, "{worst:e} of {compared}");
}

#[test]
fn random_motions_of_any_scale_are_evaluated() {
    // A harmonic of a force is at most twice its largest value, and every derivative is finite.
    let mut random = Random(91);
    let sets = [1, 2, 3, 7, 15].map(|highest| HarmonicSet::all(highest).unwrap());
    let (mut slipping, mut parting, mut refused) = (0, 0, 0);
    let rounds = some_of(2000, 100_000);
    for round in 0..rounds {
        let set = &sets[round % 5];
        let m = set.packed_len();
        let mut power = |most: f64| 10.0_f64.powf(most * random.next());
        let (force, length, ratio) = (power(12.0), power(12.0), power(10.0));
        let (stiff, swing) = (power(6.0), power(6.0));
        let has_normal = round % 4 != 0;
        let kt = force / length;
        let law = ScaledFriction3d {
            kt,
            kn: if has_normal { stiff * kt } else { 0.0 },
            mu: 0.5,
            load: force
                * if has_normal && round % 3 == 0 {
                    random.next()
                } else {
                    1.0
                },
            has_normal,
            slider: [0.0; 2],
        };
        let mut limit = law.mu * law.load.max(0.0);
        let mut normal = Vec::new();
        if has_normal {
            normal = random.motion(set, 1, swing * force / law.kn);
            limit += law.mu * law.kn * normal.iter().map(|y| y.abs()).sum::<f64>();
        }
        let mut motion = random.motion(set, 2, ratio * limit / kt);
        motion.extend(normal);
        if round % 7 == 0 {
            // Along a line.
            let share = if round % 2 == 0 { 0.5 } else { 0.0 };
            let (first, second) = motion.split_at_mut(m);
            for (second, first) in second.iter_mut().zip(first) {
                *second = share * *first;
            }
        }
        let mut way = PlaneFrictionEvaluator::new(set, &law).unwrap();
        let mut out = Evaluation::new(set, law.directions()).unwrap();
        if way.evaluate(&law, set, &motion, &mut out, &Interrupt::none()).is_err() {
            refused += 1;
            continue;
        }
        slipping += usize::from(out.slip_fraction > 0.0);
        parting += usize::from(out.open_fraction > 0.0);
        assert!(
            largest(&out.force[..2 * m]) <= 2.0 * limit * (1.0 + 1e-9),
            "round {round}: {:e} of {limit:e}",
            largest(&out.force[..2 * m])
        );
        assert!(
            out.force.iter().chain(&out.jacobian).all(|x| x.is_finite()),
            "round {round}"
        );
    }
    println!("{slipping} slip, {parting} part, {refused} refused");
    assert!(slipping > 400 && parting > 400);
    // The few that docs/limits.md tells.
    assert!(refused <= rounds / 20_000, "{refused} of {rounds} refused");
}
