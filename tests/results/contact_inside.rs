//! Inside a contact, for every law: the balance of power and the work of loops.

use crate::common::energy::{exactly, work};
use crate::common::laws::{Case, case, cases, range, shaken, solve, structure};
use crate::common::solve_at;
use hbvib::{Contact, ContactLoop, State};

fn of(values: &[f64], directions: usize, k: usize) -> impl Iterator<Item = f64> + '_ {
    values[k..].iter().step_by(directions).copied()
}

/// ∮ f·dy by the trapezoidal rule.
fn area(l: &ContactLoop) -> f64 {
    let (n, d) = (l.state.len(), l.directions);
    let part = |j: usize, k: usize| {
        let (a, b) = (j * d + k, (j + 1) % n * d + k);
        0.5 * (l.force[a] + l.force[b]) * (l.motion[b] - l.motion[a])
    };
    (0..n * d).map(|i| part(i / d, i % d)).sum()
}

/// Σ force times range of motion over the directions.
fn scale(l: &ContactLoop) -> f64 {
    let part = |k| {
        let (low, high) = range(of(&l.motion, l.directions, k));
        of(&l.force, l.directions, k).fold(0.0, |m: f64, f| m.max(f.abs())) * (high - low)
    };
    (0..l.directions).map(part).sum()
}

#[test]
fn the_power_of_the_forces_is_what_structure_and_contact_take() {
    // Exact but for rounding and the residual of the solution: sampled laws balance as they are sampled.
    let own = cases().into_iter().map(|case| Case { samples: 0, ..case });
    for case in cases().into_iter().chain(own) {
        let branch = solve(&case);
        let (e, s) = (branch.energy_at(0).unwrap(), branch.contact_summary(0, 0).unwrap());
        let input = work(&branch, &case.forces);
        let balance = (e.structural_loss + s.work) / input - 1.0;
        let reported = (s.work - e.friction_loss).abs() / input;
        println!(
            "{}: input {input:.3e}, contact {:.3e}, balance {balance:.1e}, told {reported:.1e}",
            case.name, s.work
        );
        assert!(balance.abs() < 1e-9, "{}: {balance:e}", case.name);
        assert!(reported < 1e-10, "{}: {reported:e}", case.name);
        let takes_nothing = ["cubic", "unilateral", "table"].contains(&case.name) || case.name.ends_with("stuck");
        assert_eq!(s.work == 0.0, takes_nothing, "{}: {}", case.name, s.work);
        assert!(s.work >= 0.0, "{}", case.name);
    }
}

#[test]
fn loops_enclose_the_work_as_well_as_they_are_drawn() {
    for case in cases() {
        let branch = solve(&case);
        let s = branch.contact_summary(0, 0).unwrap();
        let error = |n| {
            let l = branch.contact_loop(0, 0, n).unwrap();
            assert_eq!(l.directions, s.directions);
            (area(&l) - s.work).abs() / scale(&l)
        };
        let (coarse, fine) = (error(512), error(1 << 14));
        println!("{}: {coarse:.1e} with 512 times, {fine:.1e} with 16384", case.name);
        assert!(fine < case.area, "{}: {fine:e}", case.name);
        // Second order between the two, where the area is not exact at once.
        assert!(
            fine < 1e-2 * coarse + 0.3 * case.area,
            "{}: {coarse:e} {fine:e}",
            case.name
        );
    }
}

#[test]
fn a_contact_without_force_in_two_directions_shows_both_motions() {
    let friction = |mu| Contact::friction_3d([Some(0), Some(1), None], [None; 3], (2.5, 0.0), mu, 1.0);
    let mut model = structure();
    for mu in [0.0, 0.3] {
        model.add_contact(&friction(mu)).unwrap();
    }
    for (dof, h, value) in shaken() {
        model.add_force(dof, h, value).unwrap();
    }
    let branch = solve_at(&model, &exactly(7), 1.7);
    let [inert, active] = [0, 1].map(|id| branch.contact_loop(0, id, 200).unwrap());
    assert_eq!((inert.directions, active.directions), (2, 2));
    assert_eq!(branch.contact_directions(0), Some(2));
    assert_eq!(branch.contact_directions(2), None);
    for (a, b) in inert.motion.iter().zip(&active.motion) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    assert!(inert.force.iter().all(|f| *f == 0.0) && inert.state.iter().all(|s| *s == State::Stick));
    let [a, b] = [0, 1].map(|id| branch.contact_summary(0, id).unwrap());
    assert!(a.work == 0.0 && a.slip_share == 0.0 && b.work > 0.0);
    assert_eq!((a.load_min, a.load_max, b.load_min, b.load_max), (1.0, 1.0, 1.0, 1.0));
    for k in 0..3 {
        assert!((a.motion_max[k] - b.motion_max[k]).abs() < 1e-10);
    }
}

#[test]
fn loops_scale_with_the_units() {
    for (dofs, kn) in [([Some(0), Some(1), Some(2)], 1.5), ([Some(0), Some(1), None], 0.0)] {
        let loops = [1.0, 1e-6].map(|unit| {
            let contact = Contact::friction_3d(dofs, [None; 3], (2.5, kn), 0.4, 0.5 * unit);
            let forces = shaken().into_iter().map(|(dof, h, f)| (dof, h, f * unit)).collect();
            let branch = solve(&Case {
                forces,
                ..case("plane", contact)
            });
            (
                branch.contact_loop(0, 0, 40).unwrap(),
                branch.contact_summary(0, 0).unwrap(),
            )
        });
        let [(a, s), (b, t)] = &loops;
        for (a, b) in a.motion.iter().zip(&b.motion).chain(a.force.iter().zip(&b.force)) {
            assert!((a - 1e6 * b).abs() < 1e-10, "{a} {b}");
        }
        assert_eq!(a.state, b.state);
        assert!((s.work - 1e12 * t.work).abs() < 1e-10 && (s.load_max - 1e6 * t.load_max).abs() < 1e-10);
    }
}
