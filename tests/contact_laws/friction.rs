//! Friction under a normal load that varies and vanishes: its force against reference coefficients, a march
//! over dense samples, closed forms and the laws that it contains.

use crate::common::depth::{some_of, thorough};
use crate::common::friction::{March, Random, distance, evaluate, pieces, slipping_at_closing};
use hbvib::internals::CoupledPiece;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Law;
use hbvib::internals::ScaledFriction2d;
use hbvib::internals::ScaledJenkins;
use hbvib::internals::ScaledUnilateral;
use hbvib::internals::{Evaluation, Evaluator};
use hbvib::{Interrupt, State};
use std::f64::consts::{PI, TAU};

fn scalar(law: &dyn Law, set: &HarmonicSet, motion: &[f64]) -> Evaluation {
    let mut out = Evaluation::new(set, 1).unwrap();
    let mut way = Evaluator::new(set, 0, std::iter::once(law)).unwrap();
    way.prepare(set, motion, &Interrupt::none()).unwrap();
    way.evaluate(law, set, motion, 1.0, &mut out, &Interrupt::none())
        .unwrap();
    out
}

#[test]
fn reference_coefficients_are_met() {
    let (law, set, motion) = slipping_at_closing();
    let tangential = [
        -0.033_301_198_168_935_95,
        0.193_384_298_657_683_36,
        -0.170_513_580_859_448_68,
        0.210_972_277_462_096_5,
        0.093_468_509_341_053_84,
        0.007_317_470_976_994_152,
        0.051_818_884_158_810_2,
    ];
    let normal = [
        0.756_563_914_040_697_4,
        0.537_733_231_413_537_1,
        0.921_255_543_334_105_4,
        -0.116_660_683_025_654_5,
        0.258_906_877_637_620_27,
        0.061_197_756_473_571_18,
        0.025_027_790_536_833_378,
    ];
    let out = evaluate(&law, &set, &motion);
    for (packed, reference, sign) in [(&out.force[..7], tangential, 1.0), (&out.force[7..], normal, -1.0)] {
        for (i, (f, r)) in packed.iter().zip(reference).enumerate() {
            let f = if i > 0 && i % 2 == 0 { -sign * f } else { sign * f };
            assert!((f - r).abs() < 1e-10 * r.abs().max(1e-1), "{i}: {f} {r}");
        }
    }
}

#[test]
fn forces_are_those_of_a_march_over_a_million_samples() {
    let mut random = Random(7);
    let mut seen = [0; 6];
    let mut worst = 0.0_f64;
    for i in 0..36 {
        let set = HarmonicSet::all([1, 3, 7][i % 3]).unwrap();
        let (mut law, motion) = random.case(&set);
        if i % 9 == 8 {
            // Hardly slips or not at all.
            (law.mu, law.load) = (1.5, law.load + 3.0);
        }
        if !thorough() && i % 4 > 0 {
            continue;
        }
        let (out, tangential, normal) = pieces(&law, &set, &motion);
        let march = March {
            law: &law,
            set: &set,
            samples: 1 << 20,
            located: true,
        };
        let error = distance(&march.run(&motion, None), &out.force);
        worst = worst.max(error);
        assert!(error < 2e-9, "{i}: {error:e} {law:?} {motion:?}");
        let opens = normal.iter().any(|p| p.slope == 0.0);
        let after = |p: &&CoupledPiece| p.state == State::Stick && p.anchor.is_some();
        seen[0] += usize::from(opens);
        seen[1] += usize::from(!opens && out.slip_fraction > 0.0);
        seen[2] += usize::from(out.stuck);
        seen[3] += usize::from(tangential.len() == 1 && tangential[0].anchor.is_some());
        seen[4] += tangential.iter().filter(after).filter(|p| p.moved_y != 0.0).count();
        seen[5] += usize::from(out.open_fraction > 1.0 - 1e-12);
        // The pieces cover the turn.
        let mut time = tangential[0].start;
        for piece in &tangential {
            assert_eq!(piece.start.to_bits(), time.to_bits());
            time = piece.end;
        }
        assert!((time - tangential[0].start - TAU).abs() < 1e-12);
    }
    println!("worst {worst:e}; open, slip closed, stuck, dragged along, stick at closing, never closed: {seen:?}");
    let least = some_of(1, 4);
    assert!(
        seen[0] > least && seen[1] >= least && seen[2] > 0 && seen[4] >= least,
        "{seen:?}"
    );
}

#[test]
fn a_constant_load_is_a_jenkins_contact() {
    let mut random = Random(31);
    let (mut dragged, mut stuck) = (0, 0);
    for i in 0..60 {
        // Odd harmonics alone are folded for ScaledJenkins, walked around for a load that varies.
        let set = HarmonicSet::excited(&[1], [1, 3, 7][i % 3], true, i % 2 == 0, false).unwrap();
        let (law, motion) = random.case(&set);
        let law = ScaledFriction2d {
            kn: 0.0,
            load: 2.0 * law.load.abs(),
            ..law
        };
        let m = set.packed_len();
        let out = evaluate(&law, &set, &motion);
        let jenkins = ScaledJenkins {
            stiffness: law.kt,
            limit: law.mu * law.load,
            slider: 0.0,
        };
        let reference = scalar(&jenkins, &set, &motion[..m]);
        assert!(distance(&out.force[..m], &reference.force) < 1e-13);
        let shift = (out.slip_fraction - reference.slip_fraction).abs();
        assert!(shift < 1e-9);
        for j in 0..m {
            let column = &out.jacobian[j * 2 * m..(j + 1) * 2 * m];
            // Slip that begins just before a turning point has its time from rounding.
            assert!(distance(&column[..m], &reference.jacobian[j * m..]) < 1e-13 + 10.0 * shift);
            assert!(column[m..].iter().all(|v| *v == 0.0));
        }
        assert!(out.jacobian[2 * m * m..].iter().all(|v| *v == 0.0));
        assert_eq!(out.stuck, reference.stuck);
        let mean = if set.has_mean() { -law.load } else { 0.0 };
        if set.has_mean() {
            assert!((out.force[m] - mean).abs() < 1e-15 * law.load);
        }
        stuck += usize::from(out.stuck);
        dragged += usize::from(!out.stuck && reference.slip_fraction == 0.0);
    }
    assert!(stuck > 0 && dragged > 0, "{stuck} {dragged}");
}

#[test]
fn the_normal_force_is_that_of_a_unilateral_spring() {
    let mut random = Random(41);
    for i in 0..30 {
        let set = HarmonicSet::all([1, 3, 7][i % 3]).unwrap();
        let (law, motion) = random.case(&set);
        let m = set.packed_len();
        let out = evaluate(&law, &set, &motion);
        let spring = ScaledUnilateral {
            stiffness: law.kn,
            gap: -law.load / law.kn,
        };
        let reference = scalar(&spring, &set, &motion[m..]);
        assert!(distance(&out.force[m..], &reference.force) < 1e-13);
        for j in 0..m {
            assert!(out.jacobian[j * 2 * m + m..(j + 1) * 2 * m].iter().all(|v| *v == 0.0));
            let column = &out.jacobian[(m + j) * 2 * m + m..(m + j + 1) * 2 * m];
            assert!(distance(column, &reference.jacobian[j * m..]) < 1e-13);
        }
        assert!((out.open_fraction - reference.open_fraction).abs() < 1e-13);
    }
}

#[test]
fn a_contact_that_sticks_is_linear_and_is_dragged_along_by_its_bounds_alone() {
    let set = HarmonicSet::all(1).unwrap();
    let law = ScaledFriction2d {
        kt: 2.0,
        kn: 1.0,
        mu: 0.5,
        load: 3.0,
        slider: 0.0,
    };
    // x = 0.2 cos τ, y = 0.4 sin τ: N is between 2.6 and 3.4, |kt·x| at most 0.4.
    let out = evaluate(&law, &set, &[0.0, 0.2, 0.0, 0.0, 0.0, -0.4]);
    assert!(out.stuck && out.slip_fraction == 0.0 && out.open_fraction == 0.0);
    assert!(distance(&out.force, &[0.0, 0.4, 0.0, -3.0, 0.0, -0.4]) < 1e-15);
    // With a mean of 2, q₊ = kt·x − μN = 2.5 + 0.4 cos τ + 0.2 sin τ, whose highest value is s.
    let out = evaluate(&law, &set, &[2.0, 0.2, 0.0, 0.0, 0.0, -0.4]);
    let s = 2.5 + f64::hypot(0.4, 0.2);
    assert!(!out.stuck && out.slip_fraction == 0.0);
    assert!(distance(&out.force, &[4.0 - s, 0.4, 0.0, -3.0, 0.0, -0.4]) < 1e-14);
    // And the other way, with N highest when x is.
    let out = evaluate(&law, &set, &[-2.0, 0.2, 0.0, 0.0, 0.0, -0.4]);
    assert!(distance(&out.force, &[s - 4.0, 0.4, 0.0, -3.0, 0.0, -0.4]) < 1e-14);
}

#[test]
fn a_load_in_phase_with_the_motion_has_its_closed_form() {
    // x = A cos τ without load at rest and closed on the half of the turn where cos τ > 0: while it opens,
    // x falls, while it closes, x rises, by kt·|x′| = A·|sin τ| against μN′ = μ·kn·B·|sin τ|.
    let set = HarmonicSet::all(3).unwrap();
    let motion = |a: f64, b: f64| {
        let mut motion = vec![0.0; 14];
        (motion[1], motion[8]) = (a, -b);
        motion
    };
    let (kn, mu) = (2.0, 0.5);
    let law = ScaledFriction2d {
        kt: 1.0,
        kn,
        mu,
        load: 0.0,
        slider: 0.0,
    };
    // Harmonics of max(cos τ, 0).
    let half = [1.0 / PI, 0.5, 0.0, 2.0 / (3.0 * PI), 0.0, 0.0, 0.0];
    for (a, b) in [(0.3, 0.7), (0.7, 0.3), (-0.3, 0.7), (-0.7, 0.3)] {
        let out = evaluate(&law, &set, &motion(a, b));
        // Sticks from f = 0 and comes back to it; or slips at once, then back by the bound of the other sign.
        if a.abs() < mu * kn * b {
            let force: Vec<f64> = half.iter().map(|h| a * h).collect();
            assert!(distance(&out.force[..7], &force) < 1e-14, "{a} {b}");
            assert!(out.slip_fraction < 1e-7);
        } else {
            // Work per cycle is π·Im-part of the fundamental; friction only takes.
            assert!(out.slip_fraction > 0.1 && PI * out.force[2] * a > 0.0);
        }
        let force: Vec<f64> = half.iter().map(|h| -kn * b * h).collect();
        assert!(distance(&out.force[7..], &force) < 1e-14);
        assert!((out.open_fraction - 0.5).abs() < 1e-14);
    }
}

#[test]
fn a_load_that_just_vanishes_is_the_limit_from_both_sides() {
    // y = cos τ + … touches the level at τ = 0; a little more and it opens.
    let set = HarmonicSet::all(3).unwrap();
    let mut random = Random(53);
    for _ in 0..20 {
        let mut motion = random.case(&set).1;
        motion[7..].copy_from_slice(&[0.0, 0.8, 0.0, 0.15, 0.0, 0.05, 0.0]);
        let at = |load: f64| {
            let law = ScaledFriction2d {
                kt: 1.0,
                kn: 1.0,
                mu: 0.7,
                load,
                slider: 0.0,
            };
            evaluate(&law, &set, &motion)
        };
        let touching = at(1.0);
        for shift in [1e-16, 1e-14, 1e-12, 1e-10, 1e-8] {
            for side in [-1.0, 1.0] {
                let near = at(1.0 + side * shift);
                assert!(
                    distance(&near.force, &touching.force) < 10.0 * shift.max(1e-14),
                    "{shift:e}"
                );
                // The open time, and with it the Jacobian, is the root of the depth.
                assert!(distance(&near.jacobian, &touching.jacobian) < 20.0 * (2.0 * shift).sqrt().max(1e-7));
            }
        }
    }
}

#[test]
fn constants_without_friction_or_contact_give_no_force_and_no_nan() {
    let set = HarmonicSet::all(3).unwrap();
    let mut random = Random(61);
    let motion = random.case(&set).1;
    let still = [0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let law = ScaledFriction2d {
        kt: 1.0,
        kn: 1.0,
        mu: 0.5,
        load: 0.4,
        slider: 0.0,
    };
    for law in [
        ScaledFriction2d { mu: 0.0, ..law },
        ScaledFriction2d { kt: 0.0, ..law },
        ScaledFriction2d { load: -9.0, ..law },
        ScaledFriction2d {
            kn: 0.0,
            load: 0.0,
            ..law
        },
        ScaledFriction2d {
            kn: 0.0,
            load: -1.0,
            ..law
        },
    ] {
        let out = evaluate(&law, &set, &motion);
        assert!(out.force[..7].iter().all(|f| *f == 0.0), "{law:?}");
        assert!(out.jacobian.iter().all(|f| f.is_finite()) && !out.stuck);
        let closed = law.load > 0.0;
        assert_eq!(out.force[7..].iter().any(|f| *f != 0.0), closed);
        assert_eq!(out.open_fraction > 1.0 - 1e-12, !closed);
    }
    let moving = &motion[..7];
    for kn in [0.0, 1.0, 1e-300] {
        for (x, y) in [
            (&still[..], &motion[7..]),
            (moving, &still[..]),
            (&still[..], &still[..]),
        ] {
            for mean in [0.3, -0.3, 0.4] {
                let mut whole = [x, y].concat();
                whole[7] += mean - 0.3;
                let law = ScaledFriction2d { kn, ..law };
                let out = evaluate(&law, &set, &whole);
                let march = March {
                    law: &law,
                    set: &set,
                    samples: 1 << 16,
                    located: true,
                };
                assert!(distance(&out.force, &march.run(&whole, None)) < 1e-7, "{kn} {whole:?}");
                assert!(out.jacobian.iter().all(|f| f.is_finite()));
            }
        }
    }
    // A motion that overflows ends, whatever it says.
    for bad in [f64::NAN, f64::INFINITY, 1e308] {
        for i in [0, 2, 7, 9] {
            let mut motion = motion.clone();
            motion[i] = bad;
            let _ = evaluate(&law, &set, &motion);
        }
    }
}

#[test]
fn ties_of_events_leave_the_force_right() {
    // Bounds that stand still but for rounding, and coefficients of few digits that make events coincide.
    let mut random = Random(83);
    for i in 0..160 {
        let set = HarmonicSet::all([1, 2, 3, 5][i % 4]).unwrap();
        let (mut law, mut motion) = random.case(&set);
        let m = set.packed_len();
        if i % 2 == 0 {
            for x in &mut motion {
                *x = (3.0 * *x).round() * 0.5;
            }
            law = ScaledFriction2d {
                kt: 1.0,
                kn: 1.0,
                mu: 0.5,
                load: (2.0 * law.load).round() * 0.5,
                slider: 0.0,
            };
        } else {
            let ratio = law.kt / (law.mu * law.kn) * random.next().signum();
            for k in 0..m {
                motion[m + k] = ratio * motion[k];
            }
            motion[m] += 0.1;
        }
        let out = evaluate(&law, &set, &motion);
        let march = March {
            law: &law,
            set: &set,
            samples: 1 << 16,
            located: true,
        };
        let error = distance(&march.run(&motion, None), &out.force);
        assert!(error < 3e-7, "{i}: {error:e} {law:?} {motion:?}");
        assert!(out.jacobian.iter().all(|v| v.is_finite()));
    }
}
