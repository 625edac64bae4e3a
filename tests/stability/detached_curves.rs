//! Response curves without connection to the sweep, found from nonlinear modes: against shooting, and against one harmonic in
//! closed form.

use crate::common::models::chain;
use crate::common::peers::structure;
use crate::common::random;
use crate::common::{data, harmonics, omega_range, one_mass};
use core::f64::consts::PI;
use hbvib::{
    Branch, Call, Contact, ContactKind, ContactState, ForcedOptions, Hooks, Model, Polynomial, SolverOptions, Status,
    SteadyMethod, TimeOptions, User, UserForce, forced_response, time_response,
};
use num_complex::Complex64;
use std::sync::Arc;

/// x″ + 0.05 x′ − 0.05 x′³ + 0.012 x′⁵ + x = F cos ωt
fn falling_damping(force: f64) -> Model {
    let damper = Polynomial::scalar(&[], &[0.0, 0.0, -0.05, 0.0, 0.012]).unwrap();
    one_mass(0.05, &Contact::between(0, None, ContactKind::Polynomial(damper)), force)
}

fn with_detached(model: &Model, solver: &SolverOptions, (from, to): (f64, f64), at: &[f64]) -> Branch {
    let range = ForcedOptions {
        at,
        branches: 2,
        ..omega_range(from, to)
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
    let points = curve.amplitude().iter().zip(curve.unstable_directions());
    let top = points.max_by(|a, b| a.0.total_cmp(b.0)).unwrap();
    assert!(*top.1 < 0.5);
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

/// Dry friction that falls with the speed (Stribeck): 0.005 + 0.045 e^{−(v/0.3)²} times tanh(v/0.15).
struct Falling;

impl Falling {
    fn force(v: f64) -> (f64, f64) {
        let share = (-(v / 0.3).powi(2)).exp();
        let (friction, turn) = (0.005 + 0.045 * share, (v / 0.15).tanh());
        let slope = friction * (1.0 - turn * turn) / 0.15 - 0.045 * share * 2.0 * v / 0.09 * turn;
        (friction * turn, slope)
    }
}

impl UserForce for Falling {
    fn evaluate(&self, call: &mut Call<'_>) -> i32 {
        for (i, v) in call.v.iter().enumerate() {
            (call.f[i], call.df_dv[i]) = Self::force(*v);
        }
        0
    }
}

/// The motion that integration in time settles on from a motion of given harmonics.
fn settles_at(model: &Model, omega: f64, start: &[Complex64]) -> f64 {
    let options = TimeOptions {
        omega,
        method: SteadyMethod::Marching,
        tolerance: 1e-7,
        max_periods: 2000,
        start: Some(start),
        ..TimeOptions::default()
    };
    let found = time_response(model, &options, &mut Hooks::default()).unwrap();
    found.harmonics[1].norm()
}

/// Under friction that falls with the speed a sweep shows the small motion. Beside it lies a curve whose large motion remains in time.
#[test]
fn friction_that_falls_with_the_speed_has_a_curve_beside_the_sweep() {
    let law = User {
        odd: true,
        ..User::new(Arc::new(Falling), 1, 0).unwrap()
    };
    let model = one_mass(0.01, &Contact::between(0, None, ContactKind::User(law)), 0.025);
    let found = with_detached(&model, &harmonics(9), (0.9, 1.1), &[]);
    println!(
        "{:?} {:?}",
        found.searched(),
        found.children().iter().map(Branch::descent).collect::<Vec<_>>()
    );
    assert_eq!(found.children().len(), 1);
    let curve = &found.children()[0];
    let largest = |branch: &Branch| branch.amplitude().iter().copied().fold(0.0, f64::max);
    assert!(largest(&found) < 0.15 && largest(curve) > 1.5);
    let top = curve
        .peaks()
        .iter()
        .max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
        .unwrap();
    let mut x = vec![Complex64::ZERO; curve.harmonics() + 1];
    curve.harmonics_at(top.point, &mut x).unwrap();
    // Disturbed by a twentieth, the large motion comes back; a third of it falls to the small one.
    let scaled = |factor: f64| x.iter().map(|x| factor * x).collect::<Vec<_>>();
    let (near, below) = (
        settles_at(&model, top.omega, &scaled(0.95)),
        settles_at(&model, top.omega, &scaled(0.2)),
    );
    println!("{} {near} {below}", x[1].norm());
    assert!((near - x[1].norm()).abs() < 1e-3 * near);
    assert!(below < 0.2);
}

/// Chains with sliders, whose resonances all lie on their sweeps.
fn none_beside_random_chains(count: u64) {
    let mut state = 5_u64;
    let mut next = move || random::unit(&mut state);
    let mut resonances = 0;
    for number in 0..count {
        let n = 2 + (4.0 * next()) as usize;
        let k: Vec<f64> = (0..=n).map(|_| 10f64.powf(next() - 0.5)).collect();
        let mass: Vec<f64> = (0..n).map(|_| 10f64.powf(0.6 * next() - 0.3)).collect();
        let mut model = chain(&mass, &k).rayleigh(0.0, 0.01).build();
        let at = (n as f64 * next()) as usize;
        let kt = 10f64.powf(next() - 0.5);
        let limit = 10f64.powf(1.5 * next() - 1.0);
        model.add_contact(&Contact::jenkins(at, None, kt, 1.0, limit)).unwrap();
        model
            .add_force((n as f64 * next()) as usize, 1, (10f64.powf(1.3 * next() - 1.0)).into())
            .unwrap();
        let omega = model.lowest_modes(0, ContactState::Stuck, 1).unwrap().omega[0];
        let found = with_detached(&model, &harmonics(7), (0.8 * omega, 1.2 * omega), &[]);
        let searched = found.searched().unwrap();
        resonances += searched.resonances;
        assert!(found.children().is_empty(), "chain {number}: {searched:?}");
    }
    assert!(resonances > 0);
}

#[test]
fn no_curve_is_found_beside_a_few_random_chains() {
    none_beside_random_chains(5);
}

#[test]
#[ignore = "a minute"]
fn no_curve_is_found_beside_many_random_chains() {
    none_beside_random_chains(100);
}

/// Just above the birth, and just below the merging, two resonances lie between neighbours of the mode.
#[test]
fn a_small_curve_is_found_next_to_its_birth() {
    for force in [0.004_95, 0.0234] {
        let found = with_detached(&falling_damping(force), &harmonics(3), (0.95, 1.05), &[]);
        assert_eq!(found.children().len(), 1);
        assert_eq!(found.searched().unwrap().resonances, 3);
    }
}

/// Two coupled masses in newtons, millimetres and tonnes with a stiffening spring: their lightly damped peaks lean far over, with long steps
/// along them. No curve comes back as one that was not shown: at the requested frequencies all solutions differ.
#[test]
fn no_curve_is_found_twice() {
    let at: Vec<f64> = (0..12).map(|i| 1_950.0 + 100.0 * f64::from(i)).collect();
    for (cubic, forces) in [
        (1e5, [0.1, 1.0, 3.0]),
        (1e6, [0.7, 0.9, 2.0]),
        (3e6, [0.5, 0.9, 1.3]),
        (1e7, [0.3, 0.7, 3.0]),
    ] {
        for force in forces {
            let mass = [1e-3, 0.0, 0.0, 1e-3];
            let stiffness = [6_000.0, -1_000.0, -1_000.0, 6_000.0];
            let mut model = structure(&mass, &mass.map(|m| 10.0 * m), &stiffness);
            let spring = Contact::cubic(0, None, 0.0, cubic);
            model.add_contact(&spring).unwrap();
            model.add_force(0, 1, force.into()).unwrap();
            let found = with_detached(&model, &harmonics(5), (600.0 * PI, 1_000.0 * PI), &at);
            let curves: Vec<&Branch> = core::iter::once(&found).chain(found.children()).collect();
            for (i, omega) in at.iter().enumerate() {
                let mut all: Vec<f64> = curves.iter().flat_map(|c| c.at(i)).map(|s| s.amplitude).collect();
                all.sort_by(f64::total_cmp);
                let differ = all.windows(2).all(|pair| pair[1] - pair[0] > 1e-6 * pair[1]);
                assert!(differ, "{cubic} {force} at {omega}: {all:?}");
            }
            println!(
                "{cubic} {force}: {} curves, {:?}",
                curves.len(),
                found.searched().unwrap()
            );
        }
    }
}
