//! Stability along a forced response, and the bifurcations located on it.

use crate::common::peers::structure;
use crate::common::{BASE, amplitude_range, harmonics, one_mass, solve_at, sweep};
use crate::{multipliers, ordinary};
use hbvib::{
    Bifurcation, BifurcationKind, Contact, ContactKind, FloquetOptions, Hooks, MatrixKind, MatrixView, Model,
    Polynomial, SolverOptions, Status, Waves, floquet, nonlinear_mode,
};
use std::f64::consts::TAU;
use std::time::Instant;

fn of_wave(highest: usize) -> SolverOptions {
    SolverOptions {
        stability: Some(Waves::Wave),
        ..harmonics(highest)
    }
}

/// Bifurcations of a response, whose numbers of unstable directions must follow each other.
fn bifurcations(model: &Model, solver: &SolverOptions, from: f64, to: f64) -> Vec<Bifurcation> {
    let begin = Instant::now();
    let branch = sweep(model, solver, from, to, &[]);
    println!("{} points, {:?}", branch.points(), begin.elapsed());
    assert_eq!(branch.unstable_directions().len(), branch.points());
    assert_eq!(branch.floquet_radius().len(), branch.points());
    for (radius, count) in branch.floquet_radius().iter().zip(branch.unstable_directions()) {
        assert_eq!(*radius > 1.0, *count > 0.0, "{radius} {count}");
    }
    let found = branch.bifurcations().unwrap();
    let mut count = Some(branch.unstable_directions()[0] as usize);
    for b in &found {
        println!("{b:?}");
        assert_eq!(b.unstable[0], count);
        count = b.unstable[1];
    }
    assert_eq!(count, branch.unstable_directions().last().map(|n| *n as usize));
    found
}

#[test]
fn a_duffing_oscillator_is_unstable_between_its_folds() {
    let model = one_mass(0.1, &Contact::cubic(0, None, 0.0, 0.1), 0.18);
    for (from, to) in [(0.9, 1.3), (1.3, 0.9)] {
        let found = bifurcations(&model, &of_wave(15), from, to);
        let kinds: Vec<_> = found.iter().map(|b| (b.kind, b.unstable)).collect();
        let fold = BifurcationKind::Fold;
        assert_eq!(kinds, [(fold, [Some(0), Some(1)]), (fold, [Some(1), Some(0)])]);
    }
}

#[test]
fn a_mass_against_a_stop_doubles_its_period_at_a_located_frequency() {
    let model = one_mass(0.05, &Contact::unilateral(Some(0), None, 10.0, 0.0), 1.0);
    let found = bifurcations(&model, &of_wave(40), 2.2, 2.7);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].kind, BifurcationKind::PeriodDoubling);
    let at = solve_at(&model, &harmonics(60), found[0].omega);
    let mu = ordinary(&multipliers(&model, &at, 0, Waves::Wave))[0];
    println!("{mu}");
    assert!((mu + 1.0).norm() < 1e-8, "{mu}");
}

#[test]
fn a_forced_self_excited_oscillator_loses_its_frequency_at_a_located_one() {
    let damper = Polynomial::scalar(&[], &[-0.2, 0.0, 0.2]).unwrap();
    let model = one_mass(0.0, &Contact::between(0, None, ContactKind::Polynomial(damper)), 0.2);
    let found = bifurcations(&model, &of_wave(20), 1.1, 1.3);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].kind, BifurcationKind::NeimarkSacker);
    assert_eq!(found[0].unstable, [Some(0), Some(2)]);
    let at = solve_at(&model, &harmonics(30), found[0].omega);
    let mu = ordinary(&multipliers(&model, &at, 0, Waves::Wave))[0];
    println!("{mu}");
    assert!((mu.norm() - 1.0).abs() < 1e-8 && mu.im.abs() > 1e-3, "{mu}");
}

/// A symmetric motion becomes unsymmetric where a multiplier passes 1 away from a fold.
#[test]
fn a_symmetric_motion_loses_its_symmetry_at_branch_points() {
    let model = one_mass(0.1, &Contact::cubic(0, None, 0.0, 1.0), 10.0);
    let found = bifurcations(&model, &of_wave(21), 0.5, 1.0);
    let at: Vec<f64> = found
        .iter()
        .filter(|b| b.kind == BifurcationKind::BranchPoint)
        .map(|b| b.omega)
        .collect();
    // Next to the first one the motion in time is not found.
    for (at, expected) in at.iter().zip([0.568_811, 0.759_292, 0.946_956]) {
        assert!((at - expected).abs() < 2e-6, "{at} {expected}");
    }
    assert_eq!(found.len(), 7);
}

/// A branch that begins between two solutions, leaves its range and comes back passes a fold outside.
#[test]
fn a_branch_that_comes_back_into_its_range_tells_the_fold_outside() {
    let model = one_mass(0.1, &Contact::cubic(0, None, 0.0, 1.0), 10.0);
    let solver = SolverOptions {
        stability: Some(Waves::Wave),
        ..SolverOptions::default()
    };
    let found = bifurcations(&model, &solver, 0.9, 1.0);
    assert_eq!(found.len(), 3);
    assert!((found[1].omega - 0.856_017).abs() < 1e-5);
    assert_eq!(found[1].unstable, [Some(1), Some(0)]);
}

#[test]
fn numbers_of_unstable_directions_join_along_other_branches() {
    let stop = |gap| Contact::unilateral(Some(0), None, 10.0, gap);
    for (contact, damping, force, from, to) in [
        (stop(1.0), 0.05, 0.2, 0.8, 1.6),
        (stop(0.1), 0.1, 0.5, 2.0, 1.0),
        (Contact::cubic(0, None, 0.0, -0.1), 0.05, 0.2, 1.2, 0.6),
    ] {
        bifurcations(&one_mass(damping, &contact, force), &of_wave(25), from, to);
    }
}

/// Where all contacts stick perturbations decay as those of the linear structure.
#[test]
fn stuck_contacts_have_the_radius_of_the_linear_structure() {
    let model = one_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, 100.0), 0.2);
    let branch = sweep(&model, &of_wave(9), 0.9, 1.9, &[]);
    for (omega, radius) in branch.omega().iter().zip(branch.floquet_radius()) {
        assert!((radius - (-0.01 * TAU / omega).exp()).abs() < 1e-11);
    }
}

#[test]
fn the_field_has_the_radius_that_floquet_finds() {
    let model = BASE.sector();
    let branch = sweep(&model, &of_wave(9), TAU * 208.7, TAU * 208.9, &[]);
    assert!(branch.points() > 5);
    for point in [2, branch.points() / 2] {
        let found = multipliers(&model, &branch, point, Waves::Wave);
        println!("{} {}", found.radius, branch.floquet_radius()[point]);
        assert!((found.radius - branch.floquet_radius()[point]).abs() < 1e-12);
    }
}

#[test]
fn a_nonlinear_mode_refuses_stability_along_its_curve() {
    let model = one_mass(0.02, &Contact::jenkins(0, None, 1.0, 1.0, 0.3), 0.2);
    let range = amplitude_range(-1.0, 0.0);
    let e = nonlinear_mode(&model, &of_wave(9), &range, &mut Hooks::default()).unwrap_err();
    assert_eq!(e.status, Status::Argument);
}

/// With too few harmonics shooting may begin far from a motion, where a polynomial damper makes steps in time without end: the search
/// leaves there, and its point has the stability that is known of it.
#[test]
#[ignore = "a quarter of a minute"]
fn a_search_in_time_that_leaves_its_point_ends() {
    let stiffness = [3.755, -2.537, 0.0, -2.537, 3.368, -0.832, 0.0, -0.832, 0.832];
    let mass = [1.033, 0.0, 0.0, 0.0, 1.145, 0.0, 0.0, 0.0, 0.869];
    let mut model = structure(&mass, &mass.map(|m| 0.010_67 * m), &stiffness);
    let law = Polynomial::scalar(&[0.0, 0.0, 0.3], &[0.0, 0.0, -0.05, 0.0, 0.012]).unwrap();
    let law = Contact::between(1, None, ContactKind::Polynomial(law));
    model.add_contact(&law).unwrap();
    model.add_force(2, 1, 1.849.into()).unwrap();
    let found = sweep(&model, &of_wave(5), 0.4, 1.001, &[]);
    assert_eq!(found.status(), Status::Ok);
    assert!(found.points() > 40, "{}", found.points());
}

/// Behind a fold the motion of the point before it is near, too: its stability was told for that of the upper branch, 1.18 for 0.742.
/// The reference is an integration from event to event by exponentials of matrices.
#[test]
fn a_motion_behind_a_fold_has_its_own_stability() {
    let mut model = Model::new(1).unwrap();
    let stiffness = 1.819_931_97;
    model
        .set_matrix(MatrixKind::Mass, &MatrixView::dense(1, &[1.040_699_41]))
        .unwrap();
    model
        .set_matrix(MatrixKind::Stiffness, &MatrixView::dense(1, &[stiffness]))
        .unwrap();
    model
        .set_matrix(MatrixKind::Damping, &MatrixView::dense(1, &[0.03 * stiffness]))
        .unwrap();
    let stop = Contact::unilateral(Some(0), None, 4.035_413_456_666_588, 0.334_545_949_573_823_2);
    model.add_contact(&stop).unwrap();
    model.add_force(0, 1, 1.306_675_478_260_829_8.into()).unwrap();
    let branch = sweep(&model, &of_wave(9), 0.578_629_838_414_723, 0.303_826_481_702_321_5, &[]);
    // The frequency falls, rises between the folds at 0.5510 and 0.5536, and falls again.
    let omega = branch.omega();
    let behind = (1..branch.points())
        .rfind(|&i| omega[i] > omega[i - 1] && omega[i] > 0.55)
        .unwrap();
    let mut upper = 0;
    for point in 0..branch.points() {
        let (omega, radius) = (branch.omega()[point], branch.floquet_radius()[point]);
        // Below, nine harmonics are too few to tell which motion a point stands for.
        if omega < 0.5 {
            continue;
        }
        // By itself, without a neighbour; none is found right at the fold.
        let own = floquet(
            &model,
            &branch,
            point,
            &FloquetOptions::default(),
            &mut Hooks::default(),
        );
        if let Ok(own) = own {
            assert!((radius - own.radius).abs() < 1e-3, "{omega}: {radius} {}", own.radius);
        }
        if point > behind && omega > 0.5521 {
            assert!((radius - 0.742).abs() < 1e-3, "{omega}: {radius}");
            upper += 1;
        }
    }
    assert!(upper > 2, "{upper}");
}
