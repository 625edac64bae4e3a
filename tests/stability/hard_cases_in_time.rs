//! Stability of the motions of the hard cases: which of their solutions a machine would show.

use crate::common::mode_cases::follow;
use crate::common::models::{Structure, dense};
use crate::common::{
    B2, BASE, Blisk, D, R, SECTORS, amplitude_range, data, harmonics, number, omega_range, one_mass, solve_at, sweep,
};
use crate::{multipliers, ordinary};
use hbvib::{
    Branch, Contact, Floquet, FloquetOptions, Hooks, MatrixKind, Model, SolverOptions, Status, Waves, floquet,
    forced_response,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// A parameter of a case of `data/hardcases.json`.
fn parameter(id: &str, name: &str) -> f64 {
    let all = data("hardcases.json");
    let mut cases = all.as_array().unwrap().iter();
    number(&cases.find(|case| case["id"] == id).unwrap()["params"][name])
}

/// Asserts that the table of the book has a radius, or its difference from another one, to the digits printed there.
fn in_book(id: &str, radius: f64) {
    let path = crate::common::programs::root().join("docs/stability.md");
    let text = std::fs::read_to_string(path).unwrap();
    let table = text.split("## Motions of hard cases").nth(1).unwrap();
    let table = table.split("\n## ").next().unwrap();
    assert!(
        table.contains(&format!("{radius:.6}")),
        "{id}: {radius:.6} is not in the book"
    );
}

fn told(id: &str, branch: &Branch, point: usize, found: &Floquet) {
    println!(
        "{id:<6} {:>8.5} {:>12.5e} {:>13.10} {:>2} unstable, {} neutral, moved {:.0e}",
        branch.omega_at(point).unwrap(),
        branch.amplitude().first().copied().unwrap_or(f64::NAN),
        found.radius,
        found.unstable,
        found.neutral,
        found.orbit_change
    );
    assert!(found.radius < 1.0 && found.unstable == 0, "{id}");
    in_book(id, found.radius);
}

/// The multipliers of a motion that is stable and in the book.
fn at(id: &str, model: &Model, omega: f64, highest: usize) -> Floquet {
    let branch = solve_at(model, &harmonics(highest), omega);
    let found = multipliers(model, &branch, 0, Waves::Wave);
    told(id, &branch, 0, &found);
    found
}

/// One mass with a slider.
fn sliding(id: &str) -> Model {
    let slider = Contact::jenkins(0, None, parameter(id, "kt"), 1.0, parameter(id, "fc"));
    one_mass(parameter(id, "c"), &slider, parameter(id, "F"))
}

/// Where nothing slips the radius is e^{−cT/2} in closed form.
#[test]
fn linear_cases_decay_as_their_damping_says() {
    for (id, limit) in [("HC01", 0.0), ("HC02", f64::INFINITY)] {
        let omega = parameter(id, "w");
        let slider = Contact::jenkins(0, None, parameter(id, "kt"), 1.0, limit);
        let model = one_mass(parameter(id, "c"), &slider, parameter(id, "F"));
        let found = at(id, &model, omega, 7);
        let decay = (-0.5 * parameter(id, "c") * TAU / omega).exp();
        assert!((found.radius - decay).abs() < 1e-11);
    }
    for (id, gap) in [("HC16", parameter("HC16", "gap")), ("HC17", parameter("HC17", "gap"))] {
        let omega = parameter(id, "w");
        let stop = Contact::unilateral(None, Some(0), parameter(id, "kn"), gap);
        let found = at(id, &one_mass(parameter(id, "c"), &stop, parameter(id, "F")), omega, 7);
        let decay = (-0.5 * parameter(id, "c") * TAU / omega).exp();
        assert!((found.radius - decay).abs() < 1e-9);
    }
}

/// Friction takes energy from every perturbation of one mass: nearly rigid contacts and an undamped resonance included.
#[test]
fn sliding_cases_are_stable() {
    for (id, highest) in [("HC04a", 63), ("HC04b", 127), ("HC06", 31)] {
        let found = at(id, &sliding(id), parameter(id, "w"), highest);
        assert_eq!(ordinary(&found).len(), 2, "{id}");
    }
    let slider = Contact::jenkins(0, None, 1.0, 1.0, 0.3);
    let mut third = one_mass(0.02, &slider, 0.0);
    third.add_force(0, 3, 0.2.into()).unwrap();
    at("HC29", &third, parameter("HC29", "w"), 9);
    let mut pushed = one_mass(0.02, &slider, 0.2);
    pushed.add_force(0, 0, parameter("HC21", "F0").into()).unwrap();
    at("HC21", &pushed, parameter("HC21", "w"), 31);
    // The second force of the case holds the contact stuck.
    let mut held = one_mass(0.02, &slider, 0.05);
    held.add_force(0, 0, parameter("HC21", "F0").into()).unwrap();
    assert_eq!(at("HC21", &held, 0.9, 31).neutral, 1);
}

/// Without a bounded motion there is nothing to perturb, and artificial damping is no property of a motion in time.
#[test]
fn cases_without_a_periodic_motion_have_no_multipliers() {
    let omega = parameter("HC07", "w");
    let range = omega_range(omega, omega);
    let e = forced_response(&sliding("HC07"), &harmonics(31), &range, &mut Hooks::default()).unwrap_err();
    assert_eq!(e.status, Status::NoBoundedSolution);
    // The model of HC38 is that of HC09 without its force and its damping.
    let mut model = blisk("HC09", 2, 0.03);
    model.clear_forces();
    model.set_rayleigh(0.0, 0.0).unwrap();
    let range = amplitude_range(-4.5, -4.2);
    let branch = follow(&model, &harmonics(7), &range);
    let last = branch.points() - 1;
    let e = floquet(&model, &branch, last, &FloquetOptions::default(), &mut Hooks::default()).unwrap_err();
    assert_eq!(e.status, Status::Unsupported);
}

/// The middle one of three motions of a mass behind a gap, between the folds, is unstable.
#[test]
fn the_middle_one_of_coexisting_motions_is_unstable() {
    let id = "HC18";
    let stop = Contact::unilateral(None, Some(0), parameter(id, "kn"), parameter(id, "gap"));
    let model = one_mass(parameter(id, "c"), &stop, parameter(id, "F"));
    let branch = sweep(&model, &harmonics(31), 0.9, 1.5, &[parameter(id, "w")]);
    let mut solutions = branch.at(0).to_vec();
    solutions.sort_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    let counts: Vec<usize> = solutions
        .iter()
        .map(|s| {
            let found = multipliers(&model, &branch, s.point, Waves::Wave);
            println!(
                "{id} {:.6} {:.9} {} unstable",
                s.amplitude, found.radius, found.unstable
            );
            in_book(id, found.radius);
            found.unstable
        })
        .collect();
    assert_eq!(counts, [0, 1, 0]);
}

/// Contacts that all switch at once are one contact of their sums.
#[test]
fn a_hundred_equal_contacts_are_one() {
    let part = Contact::jenkins(0, None, 0.01, 1.0, 0.003);
    let mut many = one_mass(0.02, &part, parameter("HC26", "F"));
    for _ in 1..100 {
        many.add_contact(&part).unwrap();
    }
    let whole = one_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, 0.3), parameter("HC26", "F"));
    let omega = parameter("HC26", "w");
    let gap = at("HC26", &many, omega, 21).radius - at("HC26", &whole, omega, 21).radius;
    assert!(gap.abs() < 1e-9, "{gap}");
}

/// The blisk of a case, forced at the blade tips alone.
fn blisk(id: &str, engine_order: i64, ring_mass: f64) -> Model {
    let wheel = Blisk {
        ring_mass: Some(ring_mass),
        engine_order,
        ..BASE
    };
    let a = wheel.matrices();
    let mut model = Structure::cyclic(a.n, SECTORS)
        .mass(&a.mass)
        .stiffness(&a.own)
        .next(MatrixKind::Stiffness, &a.next)
        .wave(engine_order)
        .build();
    let slider = Contact::jenkins(D, Some(R), parameter(id, "kt"), 1.0, parameter(id, "fc"));
    model.add_contact(&slider).unwrap();
    model.set_rayleigh(0.0, parameter(id, "beta")).unwrap();
    model.add_force(B2, 1, parameter(id, "F").into()).unwrap();
    model
}

/// The wheel's verdict counts more perturbations than the wave's.
#[test]
fn waves_of_the_blisk_are_stable_over_the_wheel() {
    let mut cases = vec![("HC09", 2, 208.5), ("HC11", 24, 91.3), ("HC40", 2, 208.5)];
    cases.extend([22, 26, 46].map(|order| ("HC12", order, 208.5)));
    cases.extend([676.5, 811.0, 850.0].map(|f| ("HC14", 3, f)));
    for (id, order, frequency) in cases {
        let model = blisk(id, order, 0.03);
        // The motion is odd, whether even harmonics are carried or not.
        let solver = SolverOptions {
            keep_even_harmonics: id == "HC40",
            ..harmonics(31)
        };
        let branch = solve_at(&model, &solver, TAU * frequency);
        let [wave, wheel] = [Waves::Wave, Waves::Wheel].map(|waves| {
            let found = multipliers(&model, &branch, 0, waves);
            println!("engine order {order}, {waves:?}:");
            told(id, &branch, 0, &found);
            found
        });
        assert!(wave.radius <= wheel.radius + 1e-9, "{id} {order}");
    }
    let model = blisk("HC10", 2, 0.0);
    let branch = solve_at(&model, &harmonics(15), TAU * 208.5);
    let e = floquet(&model, &branch, 0, &FloquetOptions::default(), &mut Hooks::default()).unwrap_err();
    assert_eq!(e.status, Status::Unsupported);
}

/// A stiffer slider under a larger force, of which a reference has three digits.
#[test]
fn a_stiff_slider_has_the_multipliers_of_its_flow() {
    let model = one_mass(0.02, &Contact::jenkins(0, None, 5.0, 1.0, 0.3), 0.5);
    let found = at("stiff", &model, 1.3, 63);
    assert!((found.radius - 0.538).abs() < 5e-4, "{}", found.radius);
}

/// A slider that slips by a millionth of its motion forgets its place all the same.
#[test]
fn a_slider_at_the_onset_of_slip_is_stable() {
    let (kt, c, omega) = (parameter("HC05", "kt"), parameter("HC05", "c"), parameter("HC05", "w"));
    let stuck = Complex64::new(1.0 + kt - omega * omega, c * omega);
    let limit = kt * (parameter("HC05", "F") / stuck.norm()) * (1.0 - 1e-6);
    let model = one_mass(c, &Contact::jenkins(0, None, kt, 1.0, limit), parameter("HC05", "F"));
    let found = at("HC05", &model, omega, 15);
    println!("{:?}", found.multipliers);
    assert!(found.grazing.is_none());
}

/// Multipliers do not depend on the unit of forces, from 1e-160 to 1e160.
#[test]
fn scaled_cases_have_the_same_multipliers() {
    let radii = [1.0, 1e-160, 1e-12, 1e6, 1e160].map(|scale| {
        let slider = Contact::jenkins(0, None, 1.0, 1.0, 0.3 * scale);
        let model = one_mass(0.02, &slider, 0.2 * scale);
        at("HC08", &model, parameter("HC08", "w"), 31).radius
    });
    let near = |radius: &f64| (radius - radii[0]).abs() < 1e-9;
    assert!(radii.iter().all(near), "{radii:?}");
}

/// A structure at rest under a constant force decays like the stuck structure. Where the force of friction has reached its
/// limit, no motion in time leads back to the point: derivatives differ on its two sides.
#[test]
fn a_static_load_is_stable_while_friction_holds_it() {
    let slider = Contact::jenkins(0, None, 1.0, 1.0, 0.3);
    let loaded = |force: f64| {
        let mut model = one_mass(0.02, &slider, 0.0);
        model.add_force(0, 0, force.into()).unwrap();
        model
    };
    let found = at("HC20", &loaded(0.5), 1.0, 1);
    assert_eq!(found.neutral, 1);
    assert!((found.radius - (-0.01 * TAU).exp()).abs() < 1e-11);
    let model = loaded(1.0);
    let branch = solve_at(&model, &harmonics(1), 1.0);
    let e = floquet(&model, &branch, 0, &FloquetOptions::default(), &mut Hooks::default()).unwrap_err();
    assert_eq!(e.status, Status::NoConvergence);
}

/// Two uncoupled masses of nearly equal frequency.
#[test]
fn uncoupled_masses_have_the_multipliers_of_one_mass() {
    let slider = |dof| Contact::jenkins(dof, None, 1.0, 1.0, 0.3);
    let reference = at("HC27", &one_mass(0.02, &slider(0), 0.2), 1.25, 31).radius;
    let repeated = dense(&[1.0, 0.0, 0.0, 1.0], &[1.0, 0.0, 0.0, 1.0 + 1e-10])
        .damping(&[0.02, 0.0, 0.0, 0.02])
        .contact(slider(0))
        .force(0, 1, 0.2)
        .contact(slider(1))
        .force(1, 1, 0.2)
        .build();
    let found = at("HC27", &repeated, 1.25, 31);
    assert_eq!(ordinary(&found).len(), 4);
    for mu in ordinary(&found) {
        assert!((mu.norm() - reference).abs() < 1e-7, "{mu}");
    }
}

/// The light mass of the case, 1e-14, vibrates 1e7 times in a period. With less light ones the multipliers tend to those of
/// one mass.
#[test]
fn a_light_mass_changes_no_multiplier() {
    let reference = at(
        "HC27",
        &one_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, 0.3), 0.2),
        1.25,
        31,
    )
    .radius;
    let mut last = f64::INFINITY;
    for light in [1e-2, 1e-4, 1e-6] {
        let model = dense(&[1.0, 0.0, 0.0, light], &[2.0, -1.0, -1.0, 1.0])
            .damping(&[0.04, -0.02, -0.02, 0.02])
            .slider(0, 1.0, 1.0, 0.3)
            .force(0, 1, 0.2)
            .build();
        let gap = (at("HC25", &model, 1.25, 31).radius - reference).abs();
        assert!(gap < 0.2 * last, "{light}: {gap}");
        last = gap;
    }
    assert!(last < 1e-6, "{last}");
}

/// A slow period leaves nothing of a perturbation: e^{-cT/2} is below the smallest number of double precision from
/// ω = 8e-5 downwards.
#[test]
fn a_slow_motion_forgets_its_perturbations() {
    let model = sliding("HC32");
    for omega in [0.02, 0.01] {
        let found = at("HC32", &model, omega, 31);
        assert!(found.radius < (-0.01 * TAU / omega).exp());
    }
    forgets_all(&model, 1e-5);
}

/// A period at the frequency of the case has 4e8 steps; the call ends after 2e7 of them.
#[test]
#[ignore = "half a minute; tests/deep.sh runs it"]
fn the_period_of_the_quasi_static_case_is_too_long() {
    let model = sliding("HC32");
    let branch = solve_at(&model, &harmonics(31), parameter("HC32", "w"));
    let e = floquet(&model, &branch, 0, &FloquetOptions::default(), &mut Hooks::default()).unwrap_err();
    println!("{e}");
    assert!(e.status == Status::NoConvergence && e.message().contains("time steps"));
}

/// The point as it is has multipliers that are zero to rounding.
fn forgets_all(model: &Model, omega: f64) {
    let branch = solve_at(model, &harmonics(31), omega);
    let options = FloquetOptions {
        refine: false,
        ..FloquetOptions::default()
    };
    let found = floquet(model, &branch, 0, &options, &mut Hooks::default()).unwrap();
    told("HC32", &branch, 0, &found);
    assert!(found.radius < f64::MIN_POSITIVE);
}
