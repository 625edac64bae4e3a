//! Multipliers that are known by construction are told apart from those that decide about stability.

use crate::common::models::dense;
use crate::common::random;
use crate::common::{amplitude_range, harmonics, one_mass, solve_at};
use crate::{multipliers, of_class, ordinary};
use hbvib::{
    Contact, FloquetOptions, Hooks, MatrixKind, MatrixView, Model, MultiplierClass, Status, Waves, floquet,
    nonlinear_mode,
};
use std::f64::consts::TAU;

/// A chain of three masses, the last of which only friction holds.
fn chain(limit: f64) -> Model {
    let stiffness = [1.5, -0.5, 0.0, -0.5, 0.5, 0.0, 0.0, 0.0, 0.0];
    let damping = stiffness.map(|k| 0.05 * k);
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.3];
    dense(&mass, &stiffness)
        .damping(&damping)
        .contact(Contact::jenkins(1, Some(2), 0.4, 1.0, limit))
        .force(0, 1, 0.3)
        .build()
}

#[test]
fn a_mass_that_friction_alone_holds_is_neutral_and_a_contact_that_sticks_too() {
    for (limit, memory, stuck, rigid) in [(0.05, 1, 0, 1), (50.0, 0, 1, 0)] {
        let model = chain(limit);
        let found = multipliers(&model, &solve_at(&model, &harmonics(31), 0.8), 0, Waves::Wave);
        println!("limit {limit}: {:?}", found.multipliers);
        let count = |class| of_class(&found, class).len();
        assert_eq!(count(MultiplierClass::Memory), memory);
        assert_eq!(count(MultiplierClass::NeutralStuck), stuck);
        assert_eq!(count(MultiplierClass::NeutralRigid), rigid);
        assert_eq!(found.multipliers.len(), 7);
        assert!(found.radius < 1.0 && found.unstable == 0 && found.neutral == 1);
        for m in of_class(&found, MultiplierClass::Memory) {
            assert!(m.norm() < 1e-15);
        }
    }
}

/// Where no slider slips the product of the multipliers is e^{−T·trace M⁻¹C} (Liouville).
#[test]
fn the_product_of_the_multipliers_is_that_of_the_damping() {
    let mut cubic = chain(50.0);
    cubic.add_contact(&Contact::cubic(0, Some(1), 0.2, 0.5)).unwrap();
    for (name, model) in [("stuck", chain(50.0)), ("stuck and cubic", cubic)] {
        let omega = 0.8;
        let found = multipliers(&model, &solve_at(&model, &harmonics(15), omega), 0, Waves::Wave);
        let product: num_complex::Complex64 = ordinary(&found).iter().product();
        let expected = (-TAU / omega * 0.05 * 2.0).exp();
        println!("{name}: {product} {expected}");
        assert!((product - expected).norm() < 1e-9 * expected, "{name}");
    }
}

/// The largest |kt·x| of a contact that sticks is set to its limit.
#[test]
fn a_force_that_touches_its_limit_has_no_derivative() {
    let sticks = |limit| one_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, limit), 0.2);
    let amplitude = 0.2 / num_complex::Complex64::new(2.0 - 1.25 * 1.25, 0.02 * 1.25).norm();
    for (limit, grazes) in [
        (amplitude * (1.0 - 1e-13), true),
        (0.99 * amplitude, false),
        (1.01 * amplitude, false),
    ] {
        let model = sticks(limit);
        let found = multipliers(&model, &solve_at(&model, &harmonics(3), 1.25), 0, Waves::Wave);
        println!("{limit}: {:?} {}", found.grazing, found.radius);
        assert_eq!(found.grazing.is_some(), grazes);
        assert_eq!(found.radius.is_nan(), grazes);
    }
}

#[test]
fn points_without_a_motion_in_time_are_refused() {
    let model = chain(0.05);
    let branch = solve_at(&model, &harmonics(3), 0.8);
    let ask = |model: &Model, branch, point, options: &FloquetOptions| {
        floquet(model, branch, point, options, &mut Hooks::default()).unwrap_err()
    };
    let plain = FloquetOptions::default();
    assert_eq!(ask(&model, &branch, 9, &plain).status, Status::Index);
    let other = one_mass(0.1, &Contact::cubic(0, None, 0.0, 0.1), 0.1);
    assert_eq!(ask(&other, &branch, 0, &plain).status, Status::Argument);
    let bad = FloquetOptions {
        tolerance: 2.0,
        ..plain
    };
    assert_eq!(ask(&model, &branch, 0, &bad).status, Status::Argument);
    let range = amplitude_range(-4.0, -3.0);
    let mode = nonlinear_mode(&model, &harmonics(3), &range, &mut Hooks::default()).unwrap();
    let refused = ask(&model, &mode, 0, &plain);
    println!("{refused}");
    assert_eq!(refused.status, Status::Unsupported);
    assert!(refused.to_string().contains("limit cycle"));
}

/// Random structures of one to six masses with up to three contacts of different laws, in other units of mass, length and
/// time: multipliers are numbers without a unit.
#[test]
fn multipliers_have_no_unit() {
    let mut state = 7_u64;
    let mut random = move || random::unit(&mut state);
    for n in 1..=6 {
        let mut matrices = [vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]];
        for (a, (own, other)) in matrices.iter_mut().zip([(1.0, 0.0), (0.05, 0.02), (1.0, 0.4)]) {
            for i in 0..n {
                a[i * n + i] += own * (0.7 + 0.6 * random());
                if i > 0 {
                    let k = other * (0.5 + random());
                    for (r, c, sign) in [(i, i, 1.0), (i - 1, i - 1, 1.0), (i, i - 1, -1.0), (i - 1, i, -1.0)] {
                        a[r * n + c] += sign * k;
                    }
                }
            }
        }
        let (omega, force) = (0.9 + 0.5 * random(), 0.3 + 0.2 * random());
        let mut radii = Vec::new();
        for (mass, length, time) in [(1.0, 1.0, 1.0), (1e-3, 1e3, 1.0), (1e4, 1e-2, 1e-3)] {
            let stiffness = mass / (time * time);
            let unit_force = stiffness * length;
            let mut model = Model::new(n).unwrap();
            for ((kind, a), unit) in [MatrixKind::Mass, MatrixKind::Damping, MatrixKind::Stiffness]
                .into_iter()
                .zip(&matrices)
                .zip([mass, mass / time, stiffness])
            {
                let a: Vec<f64> = a.iter().map(|x| x * unit).collect();
                model.set_matrix(kind, &MatrixView::dense(n, &a)).unwrap();
            }
            let last = n - 1;
            let mut contacts = vec![Contact::jenkins(last, None, 0.8 * stiffness, 0.5, 0.3 * unit_force)];
            if n > 1 {
                contacts.push(Contact::unilateral(Some(0), None, 2.0 * stiffness, 0.2 * length));
            }
            if n > 3 {
                contacts.push(Contact::cubic(
                    1,
                    Some(2),
                    0.1 * stiffness,
                    0.2 * stiffness / length.powi(2),
                ));
            }
            for contact in &contacts {
                model.add_contact(contact).unwrap();
            }
            model.add_force(0, 1, (force * unit_force).into()).unwrap();
            let branch = solve_at(&model, &harmonics(21), omega / time);
            radii.push(multipliers(&model, &branch, 0, Waves::Wave).radius);
        }
        println!("{n} masses: {radii:?}");
        for radius in &radii {
            assert!((radius - radii[0]).abs() < 1e-10, "{n} masses: {radii:?}");
        }
    }
}
