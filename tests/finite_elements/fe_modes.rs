//! The nonlinear mode of a finite-element sector with 60 friction contacts, whose onsets of slip lie
//! four decades apart.

use crate::common::{amplitude_range, at_dof, harmonics};
use crate::response::{Range, Response};
use crate::sector::{Sector, Size};
use hbvib::{
    Branch, Hooks, ModeChoice, ModeField, ModeOptions, Model, Status, SynthesisOptions, nonlinear_mode, synthesise,
};
use std::f64::consts::TAU;

fn model(size: Size) -> (Model, usize) {
    let folder = crate::common::programs::root().join("examples/data/fe");
    let sector = Sector::read(&folder, size).unwrap();
    (sector.forced(2.0).unwrap(), sector.size.tip())
}

fn mode(model: &Model, tip: usize) -> Branch {
    mode_between((-8.0, -2.0), 1, model, tip)
}

fn mode_between((from, to): (f64, f64), harmonics: usize, model: &Model, tip: usize) -> Branch {
    let solver = at_dof(tip, crate::common::harmonics(harmonics));
    let range = ModeOptions {
        choice: ModeChoice::Near(530.0 * TAU),
        ..amplitude_range(from, to)
    };
    let branch = nonlinear_mode(model, &solver, &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    branch
}

/// Damping ratios of the maxima.
fn maxima(branch: &Branch) -> Vec<f64> {
    let peaks = branch.peaks().iter();
    peaks.map(|p| branch.mode_at(p.point).unwrap().damping_ratio).collect()
}

/// Where the last contacts begin to slide, Newton's steps that are found by iteration grow while the residual falls. The curve takes 28
/// points, and took 95 where such corrections were given up.
#[test]
fn steps_that_are_found_by_iteration_may_grow_where_contacts_begin_to_slide() {
    let (model, tip) = model(Size::Reduced);
    let branch = mode_between((-3.83, -3.8), 9, &model, tip);
    assert!(branch.points() < 40, "{}", branch.points());
}

#[test]
fn sixty_contacts_are_followed_from_stuck_to_sliding_and_balance_their_work() {
    let (model, tip) = model(Size::Reduced);
    let branch = mode(&model, tip);
    let damping = branch.mode_field(ModeField::DampingRatio).unwrap();
    let largest = damping.iter().fold(0.0_f64, |m, d| m.max(*d));
    for (point, d) in damping.iter().enumerate() {
        let check = branch.mode_at(point).unwrap().energy_damping_ratio();
        assert!((check - d).abs() < 1e-9 * largest, "point {point}: {check} {d}");
    }
    let slip = |point: usize| {
        branch
            .slip_fraction_at(point)
            .unwrap()
            .iter()
            .filter(|s| **s > 0.0)
            .count()
    };
    assert_eq!(slip(0), 0);
    assert!(slip(branch.points() - 1) > 50, "{}", slip(branch.points() - 1));
    assert_eq!(
        maxima(&branch).len(),
        3,
        "stick, slip and sliding of two rows of contacts"
    );

    // The resonance of the forced response, from the mode alone: same H, two methods.
    let found = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
    let [peak] = &found.peaks[..] else {
        panic!("{} peaks", found.peaks.len())
    };
    let range = Range {
        from: peak.at.omega / TAU - 3.0,
        to: peak.at.omega / TAU + 3.0,
        at: Vec::new(),
    };
    let solver = harmonics(1);
    let computed = Response::follow(&model, &solver, &range, &[tip], |_| {}).unwrap().peak;
    let error = peak.at.response.norm() / computed.amplitude() - 1.0;
    println!("synthesised peak {error:e}");
    assert!(error.abs() < 1e-2, "{error}");
}

/// A minute of factorisations: run by tests/deep.sh.
#[test]
#[ignore = "a minute long; tests/deep.sh runs it"]
fn the_full_sector_has_the_damping_of_the_reduced_one() {
    let [reduced, full] = [Size::Reduced, Size::Full].map(|size| {
        let (model, tip) = model(size);
        maxima(&mode(&model, tip))
    });
    assert_eq!(reduced.len(), full.len());
    for (a, b) in reduced.iter().zip(&full) {
        println!("{a} {b}");
        assert!((a / b - 1.0).abs() < 1e-4, "{a} {b}");
    }
}
