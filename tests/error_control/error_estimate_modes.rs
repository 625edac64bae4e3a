//! The error estimate of nonlinear modes against the true errors of frequency and damping ratio.

use crate::common::mode_cases::{damped, follow};
use crate::common::{BASE, BETA, Blisk, amplitude_range, harmonics};
use hbvib::{Branch, DampingForm, ModeOptions, Model, SolverOptions, Special, estimate_at};
use std::fmt::Write as _;
use std::time::Instant;

/// Harmonics of the truth.
const TRUTH: usize = 511;

const HARMONICS: [usize; 5] = [5, 7, 9, 15, 31];

/// Follows the first mode from the onset of slip on, with solutions at amplitudes beyond it.
fn backbone(model: &Model, solver: &SolverOptions, form: DampingForm, count: usize) -> Branch {
    let range = |start: f64, at| ModeOptions {
        damping_form: form,
        at,
        ..amplitude_range(start, start + 2.1)
    };
    let short = follow(model, &harmonics(1), &range(-7.0, &[]));
    let onset = short.mode().unwrap().linear_up_to;
    let at: Vec<f64> = (0..count)
        .map(|i| onset + 0.05 + 2.0 * i as f64 / count as f64)
        .collect();
    follow(model, solver, &range(onset, &at))
}

/// Frequency and damping ratio: estimated and true errors.
struct Row {
    highest: usize,
    frequency: (f64, f64),
    damping: (f64, f64),
}

/// All rows of a curve, errors below a tenth of the curve's largest counted as that.
fn rows(model: &Model, form: DampingForm, count: usize) -> Vec<Row> {
    let started = Instant::now();
    let truth = backbone(model, &harmonics(TRUTH), form, count);
    println!(
        "truth: {} points, {:.1} s",
        truth.points(),
        started.elapsed().as_secs_f64()
    );
    let mut all = Vec::new();
    for highest in HARMONICS {
        let solver = harmonics(highest);
        let branch = backbone(model, &solver, form, count);
        let mut rows: Vec<Row> = Vec::new();
        for i in 0..count {
            // Where the curve turns in amplitude, solutions are told apart by their frequency.
            if branch.at(i).len() != truth.at(i).len() {
                println!("H = {highest}: another number of solutions at amplitude {i}");
                continue;
            }
            for special in branch.at(i) {
                let point = branch.mode_at(special.point).unwrap();
                let distance = |s: &&Special| (s.omega - special.omega).abs();
                let nearest = truth
                    .at(i)
                    .iter()
                    .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                    .unwrap();
                let damping = truth.mode_at(nearest.point).unwrap().damping_ratio;
                let estimate = estimate_at(model, &solver, &branch, special.point).unwrap();
                rows.push(Row {
                    highest,
                    frequency: (estimate.frequency, distance(&nearest) / nearest.omega),
                    damping: (estimate.damping, (point.damping_ratio - damping).abs()),
                });
            }
        }
        let floor = |of: fn(&mut Row) -> &mut (f64, f64), rows: &mut [Row]| {
            let least = 0.1 * rows.iter_mut().fold(0.0_f64, |m, r| m.max(of(r).1));
            for row in rows {
                let pair = of(row);
                // An unknown error stays unknown.
                if !pair.0.is_nan() {
                    pair.0 = pair.0.max(least);
                }
                pair.1 = pair.1.max(least);
            }
        };
        floor(|r| &mut r.frequency, &mut rows);
        floor(|r| &mut r.damping, &mut rows);
        all.extend(rows);
    }
    all
}

/// Prints shares within [0.3, 3] and the extremes; returns the least share.
fn table(rows: &[Row]) -> f64 {
    let mut least = 1.0_f64;
    for highest in HARMONICS.into_iter().map(Some).chain([None]) {
        let chosen = || rows.iter().filter(|r| highest.is_none_or(|h| r.highest == h));
        let mut line = format!("H = {:>3}:", highest.map_or("all".to_owned(), |h| h.to_string()));
        for (name, of) in [("frequency", 0), ("damping", 1)] {
            let ratios: Vec<f64> = chosen()
                .map(|r| [r.frequency, r.damping][of])
                .map(|(a, b)| a / b)
                .collect();
            let unknown = ratios.iter().filter(|x| x.is_nan()).count();
            let inside = ratios.iter().filter(|x| (0.3..=3.0).contains(*x)).count() as f64 / ratios.len() as f64;
            let (low, high) = ratios
                .iter()
                .fold((f64::INFINITY, 0.0_f64), |(l, h), &x| (l.min(x), h.max(x)));
            write!(
                line,
                "  {name} {inside:.3} [{low:.2}, {high:.2}] {unknown} unknown of {}",
                ratios.len()
            )
            .unwrap();
            if highest.is_none() {
                least = least.min(inside);
            }
        }
        println!("{line}");
    }
    least
}

#[test]
fn the_estimate_is_the_true_error_along_a_backbone_of_the_blisk() {
    let rows = rows(&damped(&BASE, BETA), DampingForm::Mass, 12);
    assert!(table(&rows) >= 0.9);
}

#[test]
#[ignore = "minutes"]
fn the_estimate_is_the_true_error_along_many_backbones() {
    let mut all = Vec::new();
    for (ring, engine_order, beta, form) in [
        (0.01, 2, BETA, DampingForm::Mass),
        (0.03, 1, 0.0, DampingForm::Mass),
        (0.03, 2, BETA, DampingForm::Stiffness),
        (0.03, 4, BETA, DampingForm::Mass),
        (0.06, 3, 0.0, DampingForm::Stiffness),
        (0.06, 2, BETA, DampingForm::Mass),
    ] {
        let blisk = Blisk {
            ring_mass: Some(ring),
            engine_order,
            ..BASE
        };
        let found = rows(&damped(&blisk, beta), form, 24);
        println!("{ring} kg, EO {engine_order}, {form:?}");
        table(&found);
        all.extend(found);
    }
    println!("all curves");
    assert!(table(&all) >= 0.9);
}

#[test]
fn every_point_of_a_mode_has_its_errors_when_they_are_asked_for_and_stuck_points_have_none() {
    let model = damped(&BASE, BETA);
    let solver = SolverOptions {
        estimate_error: true,
        ..harmonics(5)
    };
    let range = amplitude_range(-4.0, -2.5);
    let branch = follow(&model, &solver, &range);
    let onset = branch.mode().unwrap().linear_up_to;
    let mut slipping = 0;
    for i in 0..branch.points() {
        let at = branch.mode_at(i).unwrap();
        let (frequency, damping) = (branch.error_estimate()[i], branch.damping_error_estimate()[i]);
        if at.log10_amplitude <= onset {
            assert_eq!((frequency, damping), (0.0, 0.0), "point {i}");
        } else {
            slipping += 1;
            assert!(frequency > 0.0 && damping > 0.0 && frequency < 0.01 && damping < 1e-3);
        }
    }
    assert!(slipping > 5 && slipping < branch.points());
}

#[test]
fn the_estimate_is_made_on_the_wave_of_the_branch() {
    let of = |engine_order, diameter| {
        let blisk = Blisk { engine_order, ..BASE };
        let model = damped(&blisk, BETA);
        let range = ModeOptions {
            diameter,
            at: &[-3.0],
            ..amplitude_range(-3.3, -2.5)
        };
        let branch = follow(&model, &harmonics(7), &range);
        let point = branch.at(0)[0].point;
        estimate_at(&model, &harmonics(7), &branch, point).unwrap()
    };
    let (reported, own, other) = (of(2, Some(3)), of(3, None), of(2, None));
    println!(
        "{:.6e} {:.6e} {:.6e}",
        reported.frequency, own.frequency, other.frequency
    );
    assert!((reported.frequency / own.frequency - 1.0).abs() < 1e-3);
    assert!((reported.frequency / other.frequency - 1.0).abs() > 1e-3);
}
