//! The error estimate with other laws, several contacts, samples and means: against solutions with many
//! more harmonics, against the motion in time, and against zero where nothing is missing.

use crate::common::laws;
use crate::common::models::{dense, diagonal};
use crate::common::{
    self, B2, BASE, all_harmonics, at_dof, harmonics, largest, omega_range, one_mass, relative_gap, slip, solve_at,
    sweep,
};
use hbvib::{
    Branch, Contact, ForcedOptions, Hooks, Model, SolverOptions, Spring, TimeOptions, estimate_at, forced_response,
    time_response,
};
use num_complex::Complex64;

/// The solution with the options of a truth, from another solution on: there may be several.
fn truth_from(model: &Model, branch: &Branch, truth: &SolverOptions) -> Branch {
    let omega = branch.omega()[0];
    let mut guess = all_harmonics(branch, 0);
    guess.resize((truth.harmonics + 1) * model.ndof(), Complex64::ZERO);
    let range = ForcedOptions {
        guess: Some(&guess),
        ..omega_range(omega, omega)
    };
    forced_response(model, truth, &range, &mut Hooks::default()).unwrap()
}

/// Estimate and true error of the fundamental of the response, and the steps of the estimate.
fn compared(model: &Model, solver: &SolverOptions, branch: &Branch, truth: &Branch) -> (f64, f64, usize) {
    let fundamental = |b: &Branch| {
        let i = b.carried_at(0).unwrap().iter().position(|&h| h > 0).unwrap();
        b.response_at(0).unwrap()[i]
    };
    let (x, y) = (fundamental(branch), fundamental(truth));
    let estimate = estimate_at(model, solver, branch, 0).unwrap();
    (estimate.response, (x - y).norm() / y.norm(), estimate.steps)
}

/// The same at one frequency, with a truth of its own.
fn compare(model: &Model, solver: &SolverOptions, truth: &SolverOptions, omega: f64) -> (f64, f64, usize) {
    let branch = solve_at(model, solver, omega);
    compared(model, solver, &branch, &truth_from(model, &branch, truth))
}

fn with(solver: SolverOptions, highest: usize, samples: usize) -> SolverOptions {
    SolverOptions {
        harmonics: highest,
        samples,
        ..solver
    }
}

#[test]
fn the_estimate_holds_for_every_law() {
    let mut inside = (0, 0);
    for case in laws::cases() {
        let mut model = laws::structure();
        model.add_contact(&case.contact).unwrap();
        for &(dof, h, value) in &case.forces {
            model.add_force(dof, h, value).unwrap();
        }
        // Truths of sampled laws are slow.
        let numbers = if case.samples > 256 { 1 } else { 2 };
        for highest in [case.highest, 2 * case.highest + 3].into_iter().take(numbers) {
            let base = SolverOptions {
                response_dof: Some(0),
                tolerance: 0.0,
                ..SolverOptions::default()
            };
            let truth = with(base, 63, if case.samples > 0 { 1 << 15 } else { 0 });
            let (estimate, error, steps) = compare(&model, &with(base, highest, case.samples), &truth, case.omega);
            let ratio = estimate / error;
            println!(
                "{}, H = {highest}: {estimate:.2e} for {error:.2e}, {ratio:.2}, {steps} steps",
                case.name
            );
            if error < 1e-9 {
                assert!(estimate < 1e-8, "{}", case.name);
                continue;
            }
            inside.1 += 1;
            inside.0 += usize::from((0.3..=3.0).contains(&ratio));
            assert!((0.1..=10.0).contains(&ratio), "{}, H = {highest}: {ratio}", case.name);
        }
    }
    println!("{} of {} within [0.3, 3]", inside.0, inside.1);
    assert!(10 * inside.0 >= 9 * inside.1);
}

#[test]
fn effectivities_on_small_systems_are_told() {
    for (name, contact, force, omegas) in [
        ("Duffing", Contact::cubic(0, None, 0.0, 0.5), 0.25, [0.35, 0.6, 1.2]),
        (
            "gap",
            Contact::unilateral(Some(0), None, 5.0, 0.2),
            0.3,
            [0.45, 0.9, 1.6],
        ),
        (
            "Jenkins",
            Contact::jenkins(0, None, 1.0, 0.5, 0.6),
            0.4,
            [0.4, 0.9, 1.3],
        ),
        (
            "stiff Jenkins",
            Contact::jenkins(0, None, 1e3, 0.5, 0.6),
            0.5,
            [0.4, 0.9, 1.3],
        ),
    ] {
        let model = one_mass(0.05, &contact, force);
        let mut ratios = Vec::new();
        let mut unknown = 0;
        for omega in omegas {
            let finest = solve_at(&model, &harmonics(31), omega);
            let truth = truth_from(&model, &finest, &harmonics(255));
            for highest in [1, 3, 5, 9, 15, 31] {
                let solver = harmonics(highest);
                let (estimate, error, _) = compared(&model, &solver, &solve_at(&model, &solver, omega), &truth);
                if estimate.is_nan() {
                    println!("{name}, {omega}, H = {highest}: unknown, {error:.1e}");
                    unknown += 1;
                } else if error > 1e-10 {
                    ratios.push(estimate / error);
                }
            }
        }
        ratios.sort_by(f64::total_cmp);
        println!(
            "{name}: {} ratios, {:.2} to {:.2}, median {:.2}, {unknown} unknown",
            ratios.len(),
            ratios[0],
            ratios[ratios.len() - 1],
            ratios[ratios.len() / 2]
        );
        assert!(ratios.iter().all(|x| (0.1..=10.0).contains(x)), "{ratios:?}");
    }
}

/// A chain of masses of which every other rubs on the ground.
fn chain(masses: usize, contacts: usize, force: f64) -> Model {
    let spring = |i: usize| Spring {
        dof_a: Some(i),
        dof_b: i.checked_sub(1),
        sector_offset: 0,
        stiffness: 4.0,
    };
    let slider = |c: usize| {
        Contact::jenkins(
            masses - 1 - c * (masses / contacts),
            None,
            1.0,
            0.3,
            0.2 + 0.1 * c as f64,
        )
    };
    dense(&diagonal(&vec![1.0; masses]), &vec![0.0; masses * masses])
        .springs((0..masses).map(spring))
        .rayleigh(0.01, 0.002)
        .contacts((0..contacts).map(slider))
        .force(masses - 1, 1, force)
        .build()
}

#[test]
fn the_estimate_holds_for_many_contacts_and_structures_without_a_known_highest_frequency() {
    for (masses, contacts) in [(6, 3), (20, 10), (40, 4)] {
        let lowest = 4.0 * (std::f64::consts::PI / (4 * masses + 2) as f64).sin();
        let model = chain(masses, contacts, 0.5);
        for factor in [0.95, 1.3] {
            for highest in [1, 3, 7, 15] {
                let truth = harmonics(if contacts > 4 { 63 } else { 127 });
                let omega = factor * lowest;
                let branch = solve_at(&model, &harmonics(highest), omega);
                assert!(slip(&branch, 0) > 0.0);
                let (estimate, error, steps) = compare(&model, &harmonics(highest), &truth, omega);
                let ratio = estimate / error;
                println!(
                    "{masses}, {contacts}, {factor}, H = {highest}: {estimate:.2e} for {error:.2e}, {ratio:.2}, {steps}"
                );
                assert!((0.1..=10.0).contains(&ratio));
            }
        }
    }
}

#[test]
fn what_samples_miss_is_part_of_the_estimate() {
    let model = BASE.sector();
    for omega in [1312.0, 1313.0] {
        for (highest, samples) in [(9, 32), (9, 256), (21, 256), (31, 1024)] {
            let solver = at_dof(B2, with(SolverOptions::default(), highest, samples));
            let (estimate, error, _) = compare(&model, &solver, &with(solver, 511, 0), omega);
            let ratio = estimate / error;
            println!("H = {highest}, N = {samples}: {estimate:.2e} for {error:.2e}, {ratio:.2}");
            assert!((0.1..=10.0).contains(&ratio));
        }
    }
}

#[test]
fn even_harmonics_that_are_kept_hardly_matter_to_the_estimate() {
    let model = BASE.sector();
    let estimate = |keep_even_harmonics| {
        let solver = SolverOptions {
            keep_even_harmonics,
            response_dof: Some(B2),
            ..harmonics(9)
        };
        let branch = solve_at(&model, &solver, 1312.0);
        estimate_at(&model, &solver, &branch, 0).unwrap()
    };
    let (odd, all) = (estimate(false), estimate(true));
    println!("{:.6e} {:.6e}", odd.response, all.response);
    // The last harmonic that is extended may be even.
    assert!((odd.response / all.response - 1.0).abs() < 0.02);
    assert!((odd.motion / all.motion - 1.0).abs() < 0.02);
}

#[test]
fn what_misses_nothing_has_no_error() {
    let stuck = common::Blisk { force: 0.01, ..BASE };
    let open = one_mass(0.05, &Contact::unilateral(Some(0), None, 3.0, 100.0), 0.3);
    let bare = BASE.sector_without_contact();
    for (model, omega) in [(&stuck.sector(), 1308.0), (&open, 0.9), (&bare, 1308.0)] {
        let branch = solve_at(model, &harmonics(5), omega);
        let found = estimate_at(model, &harmonics(5), &branch, 0).unwrap();
        assert!(found.certified);
        assert_eq!((found.motion, found.response, found.steps), (0.0, 0.0, 0));
    }
}

#[test]
fn the_corrected_solution_is_nearer_to_the_motion_in_time() {
    let model = BASE.sector();
    for (highest, omega) in [(3, 1312.0), (9, 1313.0), (31, 1311.5)] {
        let solver = at_dof(B2, harmonics(highest));
        let branch = solve_at(&model, &solver, omega);
        let options = TimeOptions {
            omega,
            harmonics: highest,
            start: Some(&all_harmonics(&branch, 0)),
            ..TimeOptions::default()
        };
        let truth = time_response(&model, &options, &mut Hooks::default()).unwrap();
        let x = truth.harmonics[truth.ndof + B2];
        let found = estimate_at(&model, &solver, &branch, 0).unwrap();
        let error = (branch.response_at(0).unwrap()[0] - x).norm() / x.norm();
        let corrected = (found.corrected.response - x).norm() / x.norm();
        println!(
            "H = {highest}: {:.3e} for {error:.3e}, corrected {corrected:.1e}",
            found.response
        );
        assert!(found.certified && (0.3..=3.0).contains(&(found.response / error)));
        assert!(corrected < 0.2 * error);
        let tail: Vec<Complex64> = found.tail.iter().map(|&(_, x)| x.into()).collect();
        assert!(largest(&tail) <= found.change && relative_gap(&tail, &tail) == 0.0);
    }
}

#[test]
fn every_point_of_a_response_has_its_error_when_it_is_asked_for() {
    let model = BASE.sector();
    let plain = at_dof(B2, harmonics(7));
    let asked = SolverOptions {
        estimate_error: true,
        ..plain
    };
    let (from, to, at) = (1300.0, 1318.0, [1312.0]);
    let branch = sweep(&model, &asked, from, to, &at);
    assert!(!branch.peaks().is_empty() && branch.at(0).len() == 1);
    let (mut slipping, mut stuck) = (0, 0);
    for point in 0..branch.stored() {
        let error = branch.error_estimate_at(point).unwrap();
        if slip(&branch, point) == 0.0 {
            stuck += 1;
            assert!(error == 0.0);
            continue;
        }
        slipping += 1;
        let alone = estimate_at(&model, &plain, &branch, point).unwrap().response;
        // In a sweep the number of extended harmonics may be that of a neighbour, a quarter more at most.
        println!("{:.3}: {error:.3e} {alone:.3e}", branch.omega_at(point).unwrap());
        assert!(error > 1e-5 && error < 0.2 && (0.5..=2.0).contains(&(error / alone)));
    }
    assert!(slipping > 5 && stuck > 2);
    // Nothing else changes.
    let other = sweep(&model, &plain, from, to, &at);
    assert_eq!(branch.amplitude(), other.amplitude());
    assert!(other.error_estimate().iter().all(|x| x.is_nan()));
    assert_eq!(branch.error_estimate().len(), branch.points());
}

#[test]
fn a_point_that_is_not_there_and_another_model_are_refused() {
    let model = BASE.sector();
    let branch = solve_at(&model, &harmonics(3), 1308.0);
    for (message, result) in [
        ("point = 1", estimate_at(&model, &harmonics(3), &branch, 1)),
        ("harmonics = 3", estimate_at(&model, &harmonics(5), &branch, 0)),
        (
            "another one",
            estimate_at(&BASE.sector_without_contact(), &harmonics(3), &branch, 0),
        ),
    ] {
        let error = result.unwrap_err();
        assert!(error.message().contains(message), "{error:?}");
    }
}
