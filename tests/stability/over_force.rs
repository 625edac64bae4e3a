//! Detached curves that no nonlinear mode shows: by peaks and folds over the force, and by deflation.

use crate::common::{all_harmonics, harmonics, omega_range, one_mass};
use hbvib::{
    Branch, Contact, ContactKind, Follow, ForcedOptions, Hooks, Model, Parameter, ParameterRange, Polynomial,
    SolverOptions, Status, VerifyOptions, forced_response, parameter_response, verify,
};
use std::cell::Cell;

/// x″ + 0.05 x′ − 0.05 x′³ + 0.012 x′⁵ + x under a force in harmonic 1.
fn falling_damping(force: f64) -> Model {
    let damper = Polynomial::scalar(&[], &[0.0, 0.0, -0.05, 0.0, 0.012]).unwrap();
    one_mass(0.05, &Contact::between(0, None, ContactKind::Polynomial(damper)), force)
}

fn sought(model: &Model, solver: &SolverOptions, (from, to): (f64, f64), branches: usize) -> Branch {
    let range = ForcedOptions {
        branches,
        ..omega_range(from, to)
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

fn holds_in_time(model: &Model, branch: &Branch, point: usize) -> bool {
    let found = verify(model, branch, point, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
    println!("{:?} {:?}", found.response_error, found.same);
    found.same && found.response_error < 1e-5
}

/// With one harmonic the closed form has the forces 0.00492012 of the birth and 0.02346897 of the merging, as has the curve over the
/// force; with nine it is that of the peak that is followed through its folds, and no longer what the mode predicts.
#[test]
fn birth_and_merging_are_those_of_the_curve_over_the_force() {
    let model = falling_damping(0.015);
    for highest in [1, 9] {
        let found = sought(&model, &harmonics(highest), (0.9, 1.1), 3);
        let [child] = found.children() else {
            panic!("{}", found.children().len())
        };
        let descent = child.descent().unwrap();
        let forces = [descent.born_at_force, descent.merges_at_force].map(|factor| 0.015 * factor);
        let searched = found.searched().unwrap();
        println!("{forces:?} {searched:?}");
        assert!(searched.force_curves >= 2 && searched.crossings >= 2);
        if highest == 1 {
            assert!((forces[0] - 0.004_920_12).abs() < 1e-8 && (forces[1] - 0.023_468_97).abs() < 1e-8);
            continue;
        }
        let range = ParameterRange {
            start: 0.1,
            stop: 2.0,
            at: &[],
            follow: Follow::PeakThroughFolds(1.0),
            response: None,
        };
        let peak = parameter_response(
            &model,
            &harmonics(highest),
            Parameter::Force,
            &range,
            &mut Hooks::default(),
        )
        .unwrap();
        let turns: Vec<f64> = peak.turns().iter().map(|turn| turn.parameter).collect();
        assert!((turns[0] - descent.merges_at_force).abs() < 1e-8 * turns[0]);
        assert!((turns[1] - descent.born_at_force).abs() < 1e-8 * turns[1]);
    }
}

/// A force in harmonic 2 alone resonates with no nonlinear mode; its peak over the force leads to the detached curve.
#[test]
fn a_force_in_another_harmonic_has_its_curve() {
    let mut model = falling_damping(0.0);
    model.add_force(0, 2, 0.015.into()).unwrap();
    let found = sought(&model, &harmonics(10), (0.45, 0.55), 2);
    let searched = found.searched().unwrap();
    println!("{searched:?}");
    assert_eq!(searched.modes, 0);
    let [child] = found.children() else {
        panic!("{}", found.children().len())
    };
    let largest = child
        .peaks()
        .iter()
        .fold(0.0_f64, |most, peak| most.max(peak.amplitude));
    assert!((largest - 1.823_664).abs() < 1e-3, "{largest}");
    let descent = child.descent().unwrap();
    assert!(descent.mode.is_none() && (descent.merges_at_force - 1.564_582).abs() < 1e-4);
    assert!(holds_in_time(&model, child, child.peaks()[0].point));
}

/// A small force in harmonic 3 beside one in harmonic 1 resonates at a third of the frequency of the mode, which is out of the range, and
/// the fundamental has no peak. Deflation finds the detached curve, on which harmonic 3 is as large as under that force alone.
#[test]
fn deflation_finds_a_curve_that_nothing_else_shows() {
    let mut model = falling_damping(0.1);
    model.add_force(0, 3, 0.015.into()).unwrap();
    let solver = harmonics(15);
    assert!(sought(&model, &solver, (0.3, 0.37), 3).children().is_empty());
    let found = sought(&model, &solver, (0.3, 0.37), 4);
    let searched = found.searched().unwrap();
    println!("{searched:?}");
    let [child] = found.children() else {
        panic!("{}", found.children().len())
    };
    assert_eq!((searched.deflated, searched.deflations >= 5), (1, true));
    let third = |point: usize| all_harmonics(child, point)[3].norm();
    let highest = (0..child.points())
        .max_by(|a, b| third(*a).total_cmp(&third(*b)))
        .unwrap();
    println!("{} {:?}", third(highest), child.status());
    assert!((third(highest) - 1.82).abs() < 0.02);
    assert!(child.unstable_directions()[highest] == 0.0 && holds_in_time(&model, child, highest));
    // It is closed: both its ends are one motion.
    assert!((child.omega()[0] - child.omega()[child.points() - 1]).abs() < 1e-9);
}

/// Wherever the caller stops the search, the run ends there without another check, and what was found before is kept.
#[test]
fn a_stopped_search_keeps_the_response() {
    let model = falling_damping(0.015);
    // Number of checks, points, children and status of a run that is stopped at a check.
    let run = |stop: u64| {
        let (checks, stopped) = (Cell::new(0_u64), Cell::new(false));
        let cancelled = || {
            assert!(!stopped.get(), "asked again after the stop");
            checks.set(checks.get() + 1);
            stopped.set(checks.get() == stop);
            stopped.get()
        };
        let mut hooks = Hooks {
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        let range = ForcedOptions {
            branches: 4,
            ..omega_range(0.95, 1.05)
        };
        let branch = forced_response(&model, &harmonics(3), &range, &mut hooks).unwrap();
        (checks.get(), branch.points(), branch.children().len(), branch.status())
    };
    let (checks, points, children, status) = run(0);
    println!("{checks} checks, {points} points, {children} children, {status:?}");
    assert!(children == 1 && status == Status::Ok);
    for share in 1..5 {
        let (until, kept, found, status) = run(checks * share / 5);
        println!("{until} checks, {kept} points, {found} children, {status:?}");
        assert_eq!((until, status), (checks * share / 5, Status::StoppedByCaller));
        assert!(share < 4 || (kept, found) == (points, children));
    }
}
