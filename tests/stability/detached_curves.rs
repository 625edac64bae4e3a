//! Response curves without connection to the sweep, found from nonlinear modes: against shooting, and against one harmonic in
//! closed form.

use crate::common::{data, harmonics, one_mass};
use hbvib::contact::{Contact, ContactKind};
use hbvib::error::Status;
use hbvib::hooks::Hooks;
use hbvib::model::Model;
use hbvib::options::{ForcedOptions, SolverOptions};
use hbvib::results::Branch;
use hbvib::{Polynomial, forced_response};

/// x″ + 0.05 x′ − 0.05 x′³ + 0.012 x′⁵ + x = F cos ωt
fn falling_damping(force: f64) -> Model {
    let damper = Polynomial::scalar(&[], &[0.0, 0.0, -0.05, 0.0, 0.012]).unwrap();
    one_mass(0.05, &Contact::between(0, None, ContactKind::Polynomial(damper)), force)
}

fn with_detached(model: &Model, solver: &SolverOptions, (from, to): (f64, f64), at: &[f64]) -> Branch {
    let range = ForcedOptions {
        omega_start: from,
        omega_stop: to,
        at,
        branches: 2,
        ..ForcedOptions::default()
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

/// All three motions at two frequencies, and the curve through those that a sweep does not show.
#[test]
fn a_closed_curve_is_found_beside_the_sweep() {
    let found = with_detached(&falling_damping(0.015), &harmonics(9), (0.9, 1.1), &[1.0, 1.004]);
    assert_eq!(found.children().len(), 1);
    let curve = &found.children()[0];
    assert_eq!(curve.status(), Status::StoppedClosed);
    let reference = data("detached_curve.json");
    for (i, omega) in [1.0, 1.004].into_iter().enumerate() {
        let mut amplitudes: Vec<f64> = [&found, curve]
            .iter()
            .flat_map(|branch| branch.at(i).iter().map(|s| s.amplitude))
            .collect();
        amplitudes.sort_by(f64::total_cmp);
        let right: Vec<f64> = reference["points"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|p| p["omega"] == omega)
            .map(|p| p["X1"][0].as_f64().unwrap().hypot(p["X1"][1].as_f64().unwrap()))
            .collect();
        println!("{omega} {amplitudes:?} {right:?}");
        assert_eq!((amplitudes.len(), right.len()), (3, 3));
        for (a, b) in amplitudes.iter().zip(&right) {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }
    // The upper motion is stable, the lower one of the curve is not.
    let largest = curve.amplitude().iter().copied().fold(0.0, f64::max);
    let top = curve.amplitude().iter().position(|a| *a == largest).unwrap();
    assert_eq!(curve.unstable_directions()[top], 0.0);
}

/// F(a) = a(c₁ + ¾c₃a² + ⅝c₅a⁴) at resonance is extreme where its derivative vanishes.
#[test]
fn forces_of_birth_and_merging_are_those_of_the_closed_form() {
    let force = 0.015;
    let found = with_detached(&falling_damping(force), &harmonics(1), (0.9, 1.1), &[]);
    let descent = found.children()[0].descent().unwrap();
    let (c1, c3, c5) = (0.05_f64, -0.05_f64, 0.012_f64);
    // c₁ + (9/4)c₃ s + (25/8)c₅ s² = 0 for s = a².
    let (p, q) = (0.36 * c3 / c5, 0.32 * c1 / c5);
    for (sign, told) in [(1.0, descent.born_at_force), (-1.0, descent.merges_at_force)] {
        let s = -p + sign * (p * p - q).sqrt();
        let right = s.sqrt() * (c1 + 0.75 * c3 * s + 0.625 * c5 * s * s);
        println!("{} {right}", force * told);
        assert!((force * told - right).abs() < 1e-9 * right);
    }
}

/// Below the birth there is no other curve, and above the merging all resonances lie on the sweep.
#[test]
fn no_curve_is_found_where_there_is_none() {
    for (force, resonances) in [(0.004, 1), (0.03, 1)] {
        let found = with_detached(&falling_damping(force), &harmonics(3), (0.9, 1.1), &[]);
        let searched = found.searched().unwrap();
        assert!(found.children().is_empty());
        assert_eq!(
            (searched.modes, searched.resonances, searched.lost_resonances),
            (1, resonances, 0)
        );
    }
}
