//! Multipliers on modes of a structure are those on all its degrees of freedom, within the change from half as many modes.

use crate::common::models::{Structure, chain_stiffness, dense, diagonal};
use crate::common::{harmonics, solve_at};
use crate::of_class;
use hbvib::{
    Branch, Contact, ContactKind, Error, Floquet, FloquetOptions, Hooks, MatrixKind, Model, MultiplierClass,
    Polynomial, SolverOptions, Table, Waves, floquet,
};
use std::time::Instant;

fn try_on(model: &Model, branch: &Branch, modes: Option<usize>, waves: Waves) -> Result<Floquet, Error> {
    let options = FloquetOptions {
        waves,
        modes,
        ..FloquetOptions::default()
    };
    floquet(model, branch, 0, &options, &mut Hooks::default())
}

fn on(model: &Model, branch: &Branch, modes: Option<usize>, waves: Waves) -> Floquet {
    try_on(model, branch, modes, waves).unwrap()
}

/// Mass and stiffness of a bar of lumps that becomes thinner towards its end, held at one end.
fn bar(n: usize) -> (Vec<f64>, Vec<f64>) {
    let thickness = |i: usize| 1.0 - 0.6 * i as f64 / n as f64;
    let mass: Vec<f64> = (0..n).map(|i| thickness(i) * thickness(i) / n as f64).collect();
    let mut springs: Vec<f64> = (0..n).map(|i| 3.0 * thickness(i) * n as f64).collect();
    springs.push(0.0);
    (diagonal(&mass), chain_stiffness(&springs))
}

fn held_bar(n: usize, contacts: &[Contact], force: f64) -> Model {
    let (mass, stiffness) = bar(n);
    // The forces are not where a contact acts.
    dense(&mass, &stiffness)
        .rayleigh(0.1, 0.02)
        .contacts(contacts)
        .force(n - 4, 1, force)
        .force(n / 3, 3, 0.2 * force)
        .build()
}

/// One case of every law that integration in time takes.
fn laws(n: usize) -> Vec<(&'static str, Vec<Contact>)> {
    let (tip, inner) = (n - 1, n / 2);
    let table = Table::new(&[-1.0, -0.1, 0.1, 1.0], &[-1.5, -0.05, 0.05, 1.5]).unwrap();
    let damper = Polynomial::scalar(&[0.1, 0.0, 0.5], &[0.05, 0.0, 0.1]).unwrap();
    vec![
        ("friction", vec![Contact::jenkins(tip, None, 1.0, 0.5, 0.1)]),
        (
            "two sliders",
            vec![
                Contact::jenkins(tip, None, 1.0, 0.5, 0.4),
                Contact::jenkins(inner, Some(n / 3), 3.0, 0.5, 0.1),
            ],
        ),
        ("stop", vec![Contact::unilateral(Some(tip), None, 1.0, 0.05)]),
        (
            "varying load",
            vec![Contact::friction_2d(
                [Some(tip), Some(inner)],
                [None; 2],
                (1.0, 1.0),
                0.5,
                0.2,
            )],
        ),
        ("cubic", vec![Contact::cubic(tip, None, 0.3, 0.4)]),
        ("smooth friction", vec![Contact::regularised(tip, None, 0.5, 0.3, 0.3)]),
        ("table", vec![Contact::between(tip, None, ContactKind::Table(table))]),
        (
            "polynomial",
            vec![Contact::between(tip, None, ContactKind::Polynomial(damper))],
        ),
        ("stuck", vec![Contact::jenkins(tip, None, 1.0, 0.5, 100.0)]),
    ]
}

#[test]
fn every_law_has_the_multipliers_of_all_degrees_of_freedom() {
    compare(16, 8);
}

#[test]
#[ignore = "as the test above, on three times as many degrees of freedom: half a minute"]
fn every_law_has_the_multipliers_of_a_finer_bar() {
    compare(48, 12);
}

fn compare(n: usize, modes: usize) {
    for (name, contacts) in laws(n) {
        let model = held_bar(n, &contacts, 0.4);
        let branch = solve_at(&model, &harmonics(25), 3.0);
        let begin = Instant::now();
        let all = on(&model, &branch, Some(0), Waves::Wave);
        let whole = begin.elapsed();
        let begin = Instant::now();
        let few = on(&model, &branch, Some(modes), Waves::Wave);
        let gap = (few.radius - all.radius).abs();
        println!(
            "{name}: {:.9}, {gap:.1e} off, {:.1e} told, {whole:.1?} and {:.1?}",
            all.radius,
            few.modes_change,
            begin.elapsed()
        );
        assert_eq!((all.modes, few.modes), (0, modes));
        let forgets = ["friction", "two sliders", "varying load"].contains(&name);
        let memories = of_class(&all, MultiplierClass::Memory).len();
        assert_eq!(memories > 0, forgets, "{name} slips");
        assert_eq!(memories, of_class(&few, MultiplierClass::Memory).len());
        assert_eq!((all.unstable, all.neutral), (few.unstable, few.neutral));
        assert!(
            gap < 1e-3 * (1.0 - all.radius).abs() && gap <= few.modes_change.max(1e-9),
            "{name}: {gap:.1e}"
        );
    }
}

/// Over laws, frequencies and numbers of modes the radius on all degrees of freedom lies within the error that is told, which says
/// more than that something is small.
#[test]
fn the_error_of_the_radius_holds() {
    let n = 16;
    let (mut compared, mut told, mut off) = (0, 0.0_f64, 0.0_f64);
    for (name, contacts) in laws(n) {
        for (omega, force) in [(1.7, 0.4), (3.0, 0.4), (4.1, 0.5)] {
            let model = held_bar(n, &contacts, force);
            let branch = solve_at(&model, &harmonics(25), omega);
            let all = on(&model, &branch, Some(0), Waves::Wave);
            for modes in [4, 8] {
                let Ok(few) = try_on(&model, &branch, Some(modes), Waves::Wave) else {
                    continue;
                };
                if few.radius_error.is_nan() || all.radius.is_nan() {
                    continue;
                }
                let gap = (few.radius - all.radius).abs();
                println!(
                    "{name} at {omega}, {modes} modes: {gap:.1e} off, {:.1e} told, {:.1e} of any multiplier",
                    few.radius_error, few.modes_change
                );
                assert!(gap <= few.radius_error.max(1e-10), "{name}: {gap:.1e}");
                assert!(few.radius_error <= 2.0 * few.modes_change);
                compared += 1;
                (told, off) = (told.max(few.radius_error), off.max(gap));
            }
        }
    }
    assert!(compared > 45, "{compared}");
    assert!(told < 0.05 && off > 1e-7, "{told:.1e} {off:.1e}");
}

/// Few harmonics: the motion in time is another one, and the change between two numbers of modes bounds nothing.
#[test]
fn a_motion_far_from_its_point_has_no_bound() {
    let contacts = [Contact::jenkins(15, None, 20.0, 0.5, 0.4)];
    let model = held_bar(16, &contacts, 0.4);
    for (highest, omega) in [(3, 1.0), (5, 1.0), (3, 1.5)] {
        let branch = solve_at(&model, &harmonics(highest), omega);
        let all = on(&model, &branch, Some(0), Waves::Wave);
        let few = on(&model, &branch, Some(8), Waves::Wave);
        let gap = (few.radius - all.radius).abs();
        println!(
            "{:.3} from the point, {gap:.1e} off, {:.1e} told",
            few.orbit_change, few.modes_change
        );
        assert_eq!(few.modes_change.is_nan(), few.orbit_change > 0.2);
        assert_eq!(few.modes_change.is_nan(), (highest, omega) == (3, 1.0));
        assert!(few.modes_change.is_nan() || gap <= few.modes_change);
    }
}

/// With all modes nothing is left out.
#[test]
fn sectors_have_the_multipliers_of_all_degrees_of_freedom() {
    let n = 12;
    let (mass, stiffness) = bar(n);
    for (engine_order, waves) in [
        (2, Waves::Wave),
        (2, Waves::Wheel),
        (-3, Waves::Wave),
        (3, Waves::Wheel),
    ] {
        let mut next = vec![0.0; n * n];
        (next[1], next[n]) = (-0.3, -0.1);
        let contact = Contact {
            sector_offset: 1,
            ..Contact::jenkins(n - 1, Some(n - 2), 2.0, 0.5, 0.2)
        };
        let model = Structure::cyclic(n, 8)
            .mass(&mass)
            .stiffness(&stiffness)
            .next(MatrixKind::Stiffness, &next)
            .rayleigh(0.05, 0.005)
            .wave(engine_order)
            .contact(contact)
            .force(n - 3, 1, 0.3)
            .build();
        let branch = solve_at(&model, &harmonics(21), 2.9);
        let all = on(&model, &branch, Some(0), waves);
        for (modes, bound) in [(6, 1e-2), (100, 1e-8)] {
            let few = on(&model, &branch, Some(modes), waves);
            let gap = (few.radius - all.radius).abs();
            println!(
                "{engine_order} {waves:?}: {:.9}, {gap:.1e} off on {} modes, {:.1e} told",
                all.radius, few.modes, few.modes_change
            );
            assert!(gap <= few.modes_change.max(1e-11), "{gap:.1e}");
            assert_eq!((all.unstable, all.neutral), (few.unstable, few.neutral));
            assert!((few.orbit_change - all.orbit_change).abs() < bound);
        }
    }
}

/// A free body that friction alone holds keeps its neutral multiplier.
#[test]
fn a_rigid_motion_stays_neutral_on_modes() {
    let n = 24;
    let (mass, mut stiffness) = bar(n);
    stiffness[0] -= 3.0 * n as f64;
    let model = dense(&mass, &stiffness)
        .rayleigh(0.0, 0.02)
        .slider(0, 3.0, 0.5, 0.2)
        .force(n - 1, 1, 0.4)
        .build();
    let branch = solve_at(&model, &harmonics(25), 2.0);
    for modes in [Some(0), Some(12)] {
        let found = on(&model, &branch, modes, Waves::Wave);
        println!("{modes:?}: {} with {} neutral", found.radius, found.neutral);
        assert_eq!((found.neutral, found.unstable), (1, 0));
    }
}

/// A bar of many degrees of freedom is computed on modes unasked, along a branch too.
#[test]
fn a_large_structure_is_computed_on_modes() {
    let contacts = [Contact::jenkins(299, None, 1.0, 0.5, 0.4)];
    let model = held_bar(300, &contacts, 0.4);
    let solver = SolverOptions {
        stability: Some(Waves::Wave),
        ..harmonics(9)
    };
    let begin = Instant::now();
    let branch = solve_at(&model, &solver, 3.0);
    println!("{} points, {:.1?}", branch.points(), begin.elapsed());
    let found = on(&model, &branch, None, Waves::Wave);
    println!(
        "{} on {} modes, {:.1e} told",
        found.radius, found.modes, found.modes_change
    );
    assert!(found.modes > 0 && found.modes < 50);
    assert!((found.radius - branch.floquet_radius()[0]).abs() < 1e-9);
}
