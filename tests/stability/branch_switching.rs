//! Branches of the double period and of broken symmetry, found without a guess: against motions that shooting found in time.

use crate::common::models::dense;
use crate::common::peers::structure;
use crate::common::{all_harmonics, at_dof, data, harmonics, largest, omega_range, one_mass};
use hbvib::{
    BifurcationKind, Branch, Contact, ContactKind, ForcedOptions, Hooks, MatrixKind, MatrixView, Model, Part,
    Polynomial, SolverOptions, VerifyOptions, forced_response, verify,
};
use num_complex::Complex64;

/// A response with the branches that branch off from it.
fn tree(model: &Model, solver: &SolverOptions, (from, to): (f64, f64), at: &[f64]) -> Branch {
    let range = ForcedOptions {
        at,
        branches: 1,
        ..omega_range(from, to)
    };
    forced_response(model, solver, &range, &mut Hooks::default()).unwrap()
}

/// Harmonics of the only degree of freedom at the only solution at a requested frequency.
fn at(branch: &Branch, i: usize) -> (usize, Vec<Complex64>) {
    let found = branch.at(i);
    assert_eq!(found.len(), 1);
    let mut x = vec![Complex64::ZERO; branch.harmonics() + 1];
    branch.harmonics_at(found[0].point, &mut x).unwrap();
    (found[0].point, x)
}

/// Whether the motion of a point solves the equations of motion in time.
fn holds_in_time(model: &Model, branch: &Branch, point: usize) -> bool {
    let found = verify(model, branch, point, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
    println!("{:?} {:?}", found.response_error, found.same);
    found.same && found.response_error < 1e-6
}

/// Beyond the doubling the only stable motion has the double period.
#[test]
fn a_mass_against_a_stop_moves_with_the_double_period() {
    let model = one_mass(0.05, &Contact::unilateral(Some(0), None, 10.0, 0.0), 1.0);
    let reference = data("period_doubled_stop.json");
    let found = tree(&model, &harmonics(50), (2.3, 2.5), &[2.38, 2.43]);
    assert_eq!(found.children().len(), 1);
    let child = &found.children()[0];
    let descent = child.descent().unwrap();
    assert_eq!((descent.periods, descent.bifurcation), (2, Some(0)));
    assert!(child.unstable_directions().iter().all(|n| *n < 0.5));
    for (i, omega) in ["2.38", "2.43"].into_iter().enumerate() {
        let (point, x) = at(child, i);
        for h in [1, 2] {
            let right = &reference[omega]["2"]["X"][h];
            let right = right[0].as_f64().unwrap().hypot(right[1].as_f64().unwrap());
            println!("{omega} {h} {} {right}", x[h].norm());
            assert!((x[h].norm() - right).abs() < 1e-6);
        }
        let longer = model.with_longer_period(2).unwrap();
        assert!(holds_in_time(&longer, child, point));
    }
}

/// x″ + 0.1 x′ + x − x² = 0.11 cos ωt doubles its period three times and on (Thompson 1989, doi:10.1098/rspa.1989.0009).
#[test]
fn a_cascade_of_doublings_is_followed_down_to_its_depth() {
    let spring = Polynomial::scalar(&[0.0, -1.0], &[]).unwrap();
    let model = one_mass(0.1, &Contact::between(0, None, ContactKind::Polynomial(spring)), 0.11);
    let found = tree(&model, &harmonics(10), (0.95, 0.84), &[]);
    let mut doublings = Vec::new();
    let (mut branch, mut periods) = (&found, 1);
    loop {
        let bifurcations = branch.bifurcations().unwrap();
        let first = bifurcations[0];
        assert_eq!(first.kind, BifurcationKind::PeriodDoubling);
        doublings.push(first.omega * f64::from(periods));
        let Some(child) = branch.children().first() else { break };
        // Each is stable from where it begins to its own doubling.
        assert!(child.unstable_directions()[0] < 0.5 && first.unstable[0] == Some(0));
        assert_eq!(child.descent().unwrap().bifurcation, Some(0));
        // The motion does not have the period of its parent, nor a shorter one.
        let mut x = vec![Complex64::ZERO; child.harmonics() + 1];
        child.harmonics_at(child.points() / 2, &mut x).unwrap();
        let odd = x.iter().skip(1).step_by(2).fold(0.0_f64, |most, x| most.max(x.norm()));
        assert!(odd > 1e-3);
        (branch, periods) = (child, 2 * periods);
    }
    println!("{doublings:?} {:?}", found.searched());
    assert_eq!(doublings.len(), 4);
    assert_eq!(
        found.searched().map(|searched| (searched.bifurcations, searched.left)),
        Some((3, 1))
    );
    let steps: Vec<f64> = doublings.windows(2).map(|pair| pair[0] - pair[1]).collect();
    // Feigenbaum's ratio is 4.669; the first steps of a cascade are near it.
    for pair in steps.windows(2) {
        assert!((3.5..8.0).contains(&(pair[0] / pair[1])), "{steps:?}");
    }
    // Before its own doubling the motion of four periods is stable in time.
    let four = &found.children()[0].children()[0];
    assert!(four.unstable_directions()[0] < 0.5);
    let longer = model.with_longer_period(4).unwrap();
    assert!(holds_in_time(&longer, four, 2));
}

/// Between two branch points the stable motions of a hard spring have even harmonics and a mean.
#[test]
fn a_broken_symmetry_is_followed_from_one_branch_point_to_the_other() {
    let model = one_mass(0.1, &Contact::cubic(0, None, 0.0, 1.0), 10.0);
    let found = tree(&model, &harmonics(21), (0.9, 2.0), &[1.2]);
    let all = found.bifurcations().unwrap();
    let points: Vec<_> = all.iter().filter(|b| b.kind == BifurcationKind::BranchPoint).collect();
    assert_eq!((points.len(), found.children().len()), (2, 1));
    let child = &found.children()[0];
    assert!((child.descent().unwrap().merges_at - points[1].omega).abs() < 1e-6);
    assert!((child.omega()[0] - points[0].omega).abs() < 1e-3);
    // Folds alone: those at its ends are the branch points of the parent.
    let own = child.bifurcations().unwrap();
    assert!(own.iter().all(|b| b.kind == BifurcationKind::Fold), "{own:?}");
    let (point, x) = at(child, 0);
    assert!(x[0].norm() > 0.1 && x[2].norm() > 0.1);
    assert!(holds_in_time(&model, child, point));
}

/// A second frequency is no branch of motions with one frequency.
#[test]
fn a_second_frequency_has_no_child() {
    let damper = Polynomial::scalar(&[], &[-0.2, 0.0, 0.2]).unwrap();
    let model = one_mass(0.0, &Contact::between(0, None, ContactKind::Polynomial(damper)), 0.2);
    let found = tree(&model, &harmonics(9), (1.1, 1.3), &[]);
    assert!(found.children().is_empty());
    assert_eq!(found.bifurcations().unwrap()[0].kind, BifurcationKind::NeimarkSacker);
}

/// An unbalance and a speed that is tied to the frequency are the same over the longer period.
#[test]
fn the_model_of_a_longer_period_has_the_same_response() {
    let mut model = one_mass(0.1, &Contact::cubic(0, None, 0.0, 0.1), 0.2);
    model.add_force(0, 3, 0.1.into()).unwrap();
    let longer = model.with_longer_period(3).unwrap();
    let plain = crate::common::solve_at(&model, &harmonics(7), 0.6);
    let other = crate::common::solve_at(&longer, &harmonics(21), 0.2);
    let (x, y) = (
        crate::common::all_harmonics(&plain, 0),
        crate::common::all_harmonics(&other, 0),
    );
    for h in 0..8 {
        assert!((x[h] - y[3 * h]).norm() < 1e-9, "{h}");
    }
    assert!(model.with_longer_period(0).is_err());
}

/// A child of the double period ends where its odd harmonics vanish, at the other doubling, and does not go on along its parent.
#[test]
fn a_doubled_period_ends_where_it_merges() {
    let stiffness = [2.1435, -0.8997, -0.8997, 1.5991];
    let mass = [0.5728, 0.0, 0.0, 0.7802];
    let damping: Vec<f64> = mass
        .iter()
        .zip(&stiffness)
        .map(|(m, k)| 0.002_53 * m + 0.003_407 * k)
        .collect();
    let mut model = structure(&mass, &damping, &stiffness);
    model
        .add_contact(&Contact::unilateral(Some(1), None, 3.6137, 0.4556))
        .unwrap();
    model.add_force(1, 1, 0.0587.into()).unwrap();
    let found = tree(&model, &harmonics(3), (0.857, 2.008), &[]);
    let doublings: Vec<f64> = found
        .bifurcations()
        .unwrap()
        .iter()
        .filter(|b| b.kind == BifurcationKind::PeriodDoubling)
        .map(|b| b.omega)
        .collect();
    println!("{doublings:?}");
    assert_eq!((doublings.len(), found.children().len()), (2, 1));
    let child = &found.children()[0];
    assert!((child.descent().unwrap().merges_at - 0.5 * doublings[1]).abs() < 1e-15);
    for point in 0..child.points() {
        let x = all_harmonics(child, point);
        let odd = largest(&x[2..4]).max(largest(&x[6..8]));
        println!("{} {odd} {}", 2.0 * child.omega()[point], largest(&x));
        assert!(odd > 1e-3 * largest(&x));
    }
}

/// Two oscillators of the cascade that a weak spring pushes apart: where both move alike with the double period, a branch point leads to
/// motions in which one moves more than the other, in both senses. The doubled curve itself goes straight on there.
#[test]
fn a_doubled_curve_has_children_at_its_branch_point() {
    let push = 0.005;
    let mut model = dense(&[1.0, 0.0, 0.0, 1.0], &[1.0 - push, push, push, 1.0 - push])
        .damping(&[0.1, 0.0, 0.0, 0.1])
        .build();
    for dof in [0, 1] {
        let spring = Polynomial::scalar(&[0.0, -1.0], &[]).unwrap();
        let contact = Contact::between(dof, None, ContactKind::Polynomial(spring));
        model.add_contact(&contact).unwrap();
        model.add_force(dof, 1, 0.11.into()).unwrap();
    }
    let found = tree(&model, &harmonics(6), (0.9, 0.86), &[]);
    let doubled = found
        .children()
        .iter()
        .find(|child| !child.children().is_empty())
        .unwrap();
    assert_eq!(doubled.descent().unwrap().kind, Some(BifurcationKind::PeriodDoubling));
    assert_eq!(doubled.children().len(), 2);
    let all = doubled.bifurcations().unwrap();
    assert!(
        all.iter().all(|found| found.kind == BifurcationKind::BranchPoint),
        "{all:?}"
    );
    for point in 0..doubled.points() {
        let x = all_harmonics(doubled, point);
        assert!((x[2] - x[3]).norm() < 1e-6 * x[2].norm());
    }
    let longer = model.with_longer_period(2).unwrap();
    let mut larger = Vec::new();
    for child in doubled.children() {
        let descent = child.descent().unwrap();
        assert_eq!((descent.kind, descent.periods), (Some(BifurcationKind::BranchPoint), 1));
        let middle = child.points() / 2;
        let x = all_harmonics(child, middle);
        let [a, b] = [x[2].norm(), x[3].norm()];
        assert!((a / b).ln().abs() > 0.1 && child.unstable_directions()[middle].is_finite());
        larger.push(a > b);
        let found = verify(&longer, child, middle, &VerifyOptions::default(), &mut Hooks::default()).unwrap();
        println!("{:?} {}", found.response_error, found.same);
        // Six harmonics of half the frequency doubled are twelve.
        assert!(found.response_error < 1e-3);
    }
    assert_ne!(larger[0], larger[1]);
}

/// Every child moves with its longer period at all of its points: beside some doublings the curve falls back onto the parent, which is no
/// child of itself. The stop acts on the last of five masses with gyroscopic forces.
#[test]
fn no_child_is_its_parent() {
    let mass = [1.447, 0.689, 0.679, 0.85, 0.731];
    let springs = [1.17, 0.615, 1.396, 1.358];
    let stiffness = [2.171, 1.948, 2.043, 2.832, 1.483];
    // By rows; its skew part is that of a rotation.
    let damping = [
        0.0541, 0.0401, 0.056, -0.0158, -0.0865, -0.0729, 0.0386, -0.0581, -0.0215, 0.016, -0.056, 0.0409, 0.0398,
        -0.0526, -0.0348, 0.0158, 0.0215, 0.0134, 0.0537, -0.0575, 0.0865, -0.016, 0.0348, 0.0194, 0.0328,
    ];
    let n = mass.len();
    let (mut m, mut k, mut c) = (vec![0.0; n * n], vec![0.0; n * n], vec![0.0; n * n]);
    for i in 0..n {
        (m[i * n + i], k[i * n + i]) = (mass[i], stiffness[i]);
        for j in 0..n {
            c[j * n + i] = damping[i * n + j];
        }
        if i > 0 {
            k[i * n + i - 1] = -springs[i - 1];
            k[(i - 1) * n + i] = -springs[i - 1];
        }
    }
    let mut model = dense(&m, &k).build();
    let general = MatrixView {
        part: Part::General,
        ..MatrixView::dense(n, &c)
    };
    model.set_matrix(MatrixKind::Damping, &general).unwrap();
    model
        .add_contact(&Contact::unilateral(Some(4), None, 5.836, 0.238))
        .unwrap();
    model.add_force(2, 1, 0.458.into()).unwrap();
    let range = ForcedOptions {
        branches: 1,
        branch_depth: 2,
        ..omega_range(0.7247, 1.2681)
    };
    let solver = at_dof(0, harmonics(5));
    let found = forced_response(&model, &solver, &range, &mut Hooks::default()).unwrap();
    println!("{} children", found.children().len());
    let mut left: Vec<&Branch> = found.children().iter().collect();
    assert!(left.len() > 1);
    while let Some(child) = left.pop() {
        for point in 0..child.points() {
            let x = all_harmonics(child, point);
            let of = |remainder: usize| {
                let rows = x.chunks_exact(n).enumerate().filter(|(h, _)| h % 2 == remainder);
                rows.flat_map(|(_, x)| x).map(|z| z.norm_sqr()).sum::<f64>().sqrt()
            };
            assert!(of(1) > 1e-6 * of(0), "point {point} of {}", child.points());
        }
        left.extend(child.children());
    }
}
