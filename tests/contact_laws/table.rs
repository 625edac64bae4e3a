//! The tabulated spring: against the unilateral spring (the table of two lines), brute force,
//! finite differences and its own symmetries.

use crate::common::stencil::{Stencil, config};
use hbvib::internals::Exact;
use hbvib::internals::HarmonicSet;
use hbvib::internals::Piece;
use hbvib::internals::Sampled;
use hbvib::internals::TurningPoints;
use hbvib::internals::{Evaluation, Evaluator};
use hbvib::internals::{Law, PackedMotion, PiecewiseLinear};
use hbvib::{Contact, Interrupt, Status, Table};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn motion(set: &HarmonicSet, seed: usize) -> Vec<f64> {
    (0..set.packed_len())
        .map(|i| ((i * 37 + seed * 11 + 5) as f64 * 0.61).sin() / (1.0 + 0.4 * i as f64))
        .collect()
}

fn evaluate(law: &Table, set: &HarmonicSet, motion: &[f64]) -> Evaluation {
    let mut out = Evaluation::new(set, 1).unwrap();
    let most = law.most_pieces(set.highest_reduced());
    let mut way = Exact::new(set, most).unwrap();
    way.prepare(set, motion, &Interrupt::none()).unwrap();
    way.evaluate(
        law,
        PackedMotion {
            set,
            motion,
            omega: 1.0,
        },
        &mut out,
        &Interrupt::none(),
    )
    .unwrap();
    assert!(
        way.pieces().len() <= most,
        "{} pieces, bound {most}",
        way.pieces().len()
    );
    out
}

fn sampled(law: &Table, set: &HarmonicSet, samples: usize, motion: &[f64]) -> Evaluation {
    let mut out = Evaluation::new(set, 1).unwrap();
    let mut way = Sampled::new(set, samples).unwrap();
    way.prepare(set, motion, &Interrupt::none()).unwrap();
    way.evaluate(law, set, motion, &mut out, &Interrupt::none()).unwrap();
    out
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b)
}

/// Stiff, soft, falling and flat stretches, not symmetric, loaded at rest.
fn crooked() -> Table {
    Table::new(&[-0.9, -0.5, -0.1, 0.2, 0.6, 0.7], &[-3.0, -0.4, 0.1, 0.1, 0.5, 0.3]).unwrap()
}

/// Play of 2·0.3 between springs, with a harder one beyond 0.6.
fn play() -> Table {
    Table::new(&[-1.0, -0.6, -0.3, 0.3, 0.6, 1.0], &[-2.3, -0.3, 0.0, 0.0, 0.3, 2.3]).unwrap()
}

/// The force by straight interpolation, told another way than the library does.
fn interpolated(x: &[f64], f: &[f64], at: f64) -> f64 {
    let k = (1..x.len() - 1).find(|&k| at < x[k]).unwrap_or(x.len() - 1);
    let share = (at - x[k - 1]) / (x[k] - x[k - 1]);
    (1.0 - share) * f[k - 1] + share * f[k]
}

#[test]
fn the_force_is_interpolated_and_goes_on_along_the_outer_lines() {
    let (x, f) = ([-0.9, -0.5, -0.1, 0.2, 0.6, 0.7], [-3.0, -0.4, 0.1, 0.1, 0.5, 0.3]);
    for j in -200..200 {
        let at = f64::from(j) * 0.01 + 0.003;
        assert!((crooked().force(at) - interpolated(&x, &f, at)).abs() < 1e-13);
    }
    for (x, f) in x.iter().zip(f) {
        assert!((crooked().force(*x) - f).abs() < 1e-15);
    }
}

#[test]
fn two_lines_are_a_unilateral_spring() {
    for (kn, g) in [(2.0, 0.3), (2.0, -0.2), (0.7, 0.0), (1.0, 5.0), (1.0, -5.0)] {
        // f = −kn·max(−x − g, 0)
        let table = Table::new(&[-g - 1.0, -g, -g + 1.0], &[-kn, 0.0, 0.0]).unwrap();
        let spring = Contact::unilateral(Some(0), None, kn, g).law(1.0).unwrap();
        assert!((table.largest_stiffness() - kn).abs() < 1e-14);
        for highest in [1, 3, 9, 40] {
            let set = HarmonicSet::all(highest).unwrap();
            let x = motion(&set, highest);
            let mut expected = Evaluation::new(&set, 1).unwrap();
            for samples in [0, 256] {
                let mut evaluator = Evaluator::new(&set, samples, std::iter::once(&*spring)).unwrap();
                evaluator.prepare(&set, &x, &Interrupt::none()).unwrap();
                evaluator
                    .evaluate(&*spring, &set, &x, 1.0, &mut expected, &Interrupt::none())
                    .unwrap();
                let found = if samples == 0 {
                    evaluate(&table, &set, &x)
                } else {
                    sampled(&table, &set, samples, &x)
                };
                for (a, b) in [
                    (&found.force, &expected.force),
                    (&found.jacobian, &expected.jacobian),
                    (&found.offset, &expected.offset),
                ] {
                    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
                    assert!(
                        largest(&difference) < 1e-13 * kn * (1.0 + g.abs()),
                        "gap {g}, H {highest}"
                    );
                }
            }
        }
    }
}

#[test]
fn harmonics_of_the_force_are_those_of_brute_force() {
    let n = 1 << 20;
    for (name, law) in [("crooked", crooked()), ("play", play())] {
        for highest in [1, 5] {
            let set = HarmonicSet::all(highest).unwrap();
            for seed in [1, 2, 4] {
                let x = motion(&set, seed);
                let mut row = vec![0.0; x.len()];
                let mut expected = vec![0.0; x.len()];
                for j in 0..n {
                    set.basis(TAU * f64::from(j) / f64::from(n), &mut row);
                    let f = law.force(row.iter().zip(&x).map(|(c, x)| c * x).sum());
                    for (i, (e, c)) in expected.iter_mut().zip(&row).enumerate() {
                        *e += f * c * if i == 0 { 1.0 } else { 2.0 } / f64::from(n);
                    }
                }
                let found = evaluate(&law, &set, &x);
                // The error of 2^20 samples at kinks is of the order of the slope times (2π/N)².
                let error = gap(&found.force, &expected);
                println!("{name}, H {highest}, seed {seed}: {error:.1e}");
                assert!(error < 1e-10, "{name}, H {highest}: {error:.1e}");
                // Sampled pieces are the same sums over fewer samples.
                let coarse = sampled(&law, &set, 4096, &x);
                assert!(gap(&coarse.force, &expected) < 1e-4);
            }
        }
    }
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn the_jacobian_is_that_of_finite_differences(
        numbers in prop::collection::vec(-1.0..1.0_f64, 19),
        points in prop::collection::vec((0.01..0.5_f64, -1.0..1.0_f64), 2..8),
        highest in 0_usize..=9,
        begin in -1.5..0.5_f64,
    ) {
        let (mut at, mut x, mut f) = (begin, vec![], vec![]);
        for (step, force) in points {
            x.push(at);
            f.push(force);
            at += step;
        }
        let law = Table::new(&x, &f).unwrap();
        let set = HarmonicSet::all(highest).unwrap();
        let x: Vec<f64> = numbers[..set.packed_len()]
            .iter()
            .enumerate()
            .map(|(i, x)| x / (1.0 + (i / 2) as f64))
            .collect();
        let out = evaluate(&law, &set, &x);
        let scale = law.largest_stiffness().max(1.0);
        for (c, column) in out.jacobian.chunks_exact(x.len()).enumerate() {
            let stencil = Stencil::of(1e-6, |h| {
                let mut moved = x.clone();
                moved[c] += h;
                evaluate(&law, &set, &moved).force
            });
            stencil.check("table", column, scale)?;
        }
    }
}

#[test]
fn a_symmetric_table_is_odd_and_half_a_turn_tells_it() {
    assert!(play().is_odd() && !crooked().is_odd());
    // Odd by what it says, not by how it is written: a line in uneven steps, play told on one side
    // by more points, springs of rough numbers.
    assert!(Table::new(&[-0.7, 0.1, 0.3], &[-1.4, 0.2, 0.6]).unwrap().is_odd());
    let uneven = Table::new(
        &[-1.0, -0.6, -0.5, -0.3, 0.3, 0.6, 1.0],
        &[-2.3, -0.3, -0.2, 0.0, 0.0, 0.3, 2.3],
    );
    assert!(uneven.unwrap().is_odd());
    assert!(!Table::new(&[-0.7, 0.1, 0.3], &[-1.4, 0.2, 0.7]).unwrap().is_odd());
    assert!(!Table::new(&[-1.0, 1.0], &[0.0, 2.0]).unwrap().is_odd());
    let third = Table::new(&[-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0], &[-7.1, -0.1, 0.1, 7.1]).unwrap();
    assert!(third.is_odd() && third.in_units(1e-3).is_odd());

    let odd = HarmonicSet::excited(&[1], 9, true, true, false).unwrap();
    let all = HarmonicSet::all(9).unwrap();
    for law in [play(), third] {
        let x = motion(&odd, 3);
        let mut spread = vec![0.0; all.packed_len()];
        for (i, &h) in odd.numbers().iter().enumerate() {
            all.set(&mut spread, h, odd.get(&x, i));
        }
        let (half, whole) = (evaluate(&law, &odd, &x), evaluate(&law, &all, &spread));
        for (i, &h) in odd.numbers().iter().enumerate() {
            assert!((odd.get(&half.force, i) - all.get(&whole.force, h)).norm() < 1e-13);
            assert!((odd.get(&half.offset, i) - all.get(&whole.offset, h)).norm() < 1e-13);
        }
        for h in [0, 2, 4, 6, 8] {
            assert!(all.get(&whole.force, h).norm() < 1e-13);
        }
    }
}

#[test]
fn constants_at_rest_and_at_large() {
    assert!(play().slope_at_rest().abs() < 1e-15);
    assert!((play().largest_stiffness() - 5.0).abs() < 1e-12);
    assert!((crooked().largest_stiffness() - 6.5).abs() < 1e-12);
    // A point at zero: the mean of both slopes, which a small motion about it feels.
    let kink = Table::new(&[-1.0, 0.0, 1.0], &[-3.0, 0.0, 1.0]).unwrap();
    assert!((kink.slope_at_rest() - 2.0).abs() < 1e-15);
    let set = HarmonicSet::excited(&[1], 1, true, false, false).unwrap();
    let out = evaluate(&kink, &set, &[0.0, 0.3, 0.4]);
    assert!((out.force[1] - 0.6).abs() < 1e-14 && (out.force[2] - 0.8).abs() < 1e-14);
    // One line through the origin is a spring whatever the motion.
    let line = Table::new(&[-0.1, 0.3, 0.7], &[-0.3, 0.9, 2.1]).unwrap();
    let x = motion(&set, 1);
    let out = evaluate(&line, &set, &x);
    let expected: Vec<f64> = x.iter().map(|x| 3.0 * x).collect();
    assert!(gap(&out.force, &expected) < 1e-15 && largest(&out.offset) < 1e-15);
}

#[test]
fn units_of_length_do_not_matter_and_those_of_an_eased_law_are_smaller() {
    let set = HarmonicSet::all(5).unwrap();
    let x = motion(&set, 2);
    let length = 0.5;
    let scaled: Vec<f64> = x.iter().map(|x| x * length).collect();
    for law in [crooked(), play()] {
        let found = evaluate(&law.in_units(length), &set, &x);
        let expected: Vec<f64> = evaluate(&law, &set, &scaled).force.iter().map(|f| f / length).collect();
        assert!(gap(&found.force, &expected) < 1e-12);
        let h = 1e-6;
        let at = |s: f64| evaluate(&law.in_units(1.0 / s), &set, &x);
        let (above, below, here) = (at(f64::exp(h)).force, at(f64::exp(-h)).force, at(1.0));
        for ((offset, a), b) in here.offset.iter().zip(&above).zip(&below) {
            assert!((offset - (a - b) / (2.0 * h)).abs() < 1e-6 * largest(&here.jacobian));
        }
    }
    // A tiny length leaves the line at zero.
    let rest = evaluate(&play().in_units(1e-9), &set, &x);
    assert!(largest(&rest.force) == 0.0);
    let hard = Table::new(&[-2.0, -1.0, 1.0, 2.0], &[-5.0, -2.0, 2.0, 5.0]).unwrap();
    let rest = evaluate(&hard.in_units(1e-9), &set, &x);
    let expected: Vec<f64> = x.iter().map(|x| 2.0 * x).collect();
    assert!(gap(&rest.force, &expected) < 1e-15 && rest.stuck);
}

/// Stuck is what moves as at rest. A line that is met far from there is not, though its continuation
/// passes the origin, nor is one side of a kink.
#[test]
fn only_the_line_at_rest_counts_as_stuck() {
    let law = Table::new(&[-0.5, 0.5, 1.0, 2.0], &[0.0, 0.0, 1.0, 2.0]).unwrap();
    let kink = Table::new(&[-1.0, 0.0, 1.0], &[-3.0, 0.0, 1.0]).unwrap();
    let set = HarmonicSet::all(2).unwrap();
    for (law, mean, swing, slope, stuck) in [
        (&law, 0.1, 0.2, 0.0, true),
        (&law, 1.5, 0.2, 1.0, false),
        (&law, 1.5, 0.0, 1.0, false),
        (&kink, 0.5, 0.2, 1.0, false),
    ] {
        let x = [mean, swing, 0.0, 0.0, 0.0];
        for out in [evaluate(law, &set, &x), sampled(law, &set, 64, &x)] {
            assert_eq!(out.stuck, stuck, "about {mean}");
            assert!((out.force[0] - slope * mean).abs() < 1e-15 && (out.force[1] - slope * swing).abs() < 1e-15);
        }
    }
}

#[test]
fn a_motion_that_rests_or_just_touches_a_point_meets_no_gap() {
    let set = HarmonicSet::excited(&[1], 3, true, false, false).unwrap();
    let law = play();
    for mean in [-0.6, -0.45, 0.0, 0.3, 0.9] {
        let mut x = vec![0.0; set.packed_len()];
        x[0] = mean;
        let out = evaluate(&law, &set, &x);
        assert!((out.force[0] - law.force(mean)).abs() < 1e-14);
        // Turning exactly at a point, from either side, and a rounding beyond it.
        for swing in [0.15, 0.3, 0.6, 0.9] {
            for nudge in [0.0, 1e-16, -1e-16, 1e-12, -1e-12] {
                x[1] = swing + nudge;
                let mut pieces: Vec<Piece> = Vec::new();
                let mut turning_points = Vec::new();
                let mut search = TurningPoints::new(&set).unwrap();
                let none = Interrupt::none();
                search.find(&set, &x, &mut turning_points, &none).unwrap();
                law.pieces(&set, &x, &turning_points, &mut pieces, &none).unwrap();
                let covered: f64 = pieces.iter().map(|p| p.end - p.start).sum();
                assert!((covered - TAU).abs() < 1e-12, "mean {mean}, swing {swing}: {covered}");
                assert!(pieces.windows(2).all(|p| (p[0].end - p[1].start).abs() < 1e-15));
                for p in &pieces {
                    let middle = 0.5 * (p.start + p.end);
                    let at = mean + x[1] * middle.cos();
                    assert!((p.slope * at + p.offset - law.force(at)).abs() < 1e-13);
                }
            }
        }
        x[1] = 0.0;
    }
}

/// Displacements and forces.
type Points<'a> = (&'a [f64], &'a [f64]);

#[test]
fn bad_tables_are_refused_with_their_place() {
    let nan = f64::NAN;
    let cases: [(Points<'_>, Status, &str); 9] = [
        ((&[], &[]), Status::Dimension, "0 points"),
        ((&[1.0], &[2.0]), Status::Dimension, "1 points"),
        ((&[1.0, 2.0], &[2.0]), Status::Dimension, "2 displacements and 1 forces"),
        ((&[0.0, nan, 2.0], &[0.0; 3]), Status::NotFinite, "displacement[1]"),
        (
            (&[0.0, 1.0, 2.0], &[0.0, 1.0, f64::INFINITY]),
            Status::NotFinite,
            "force[2]",
        ),
        ((&[0.0, 1.0, 1.0], &[0.0; 3]), Status::Argument, "displacement[2] = 1"),
        ((&[0.0, 1.0, 0.5], &[0.0; 3]), Status::Argument, "displacement[1] = 1"),
        ((&[1.0, 0.0], &[0.0; 2]), Status::Argument, "sort the points"),
        (
            (&[0.0, 1e-300], &[0.0, 1e200]),
            Status::NotFinite,
            "from point 0 to point 1",
        ),
    ];
    for ((x, f), status, words) in cases {
        let error = Table::new(x, f).expect_err("a bad table");
        assert_eq!(error.status, status, "{error}");
        assert!(error.message().contains(words), "{error}");
    }
}
