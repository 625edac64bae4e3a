//! Inside a contact, for every law: states, shares, loads and ranges against the forces told, and these
//! against the laws' own formulas and marches of plain steps.

use crate::common::laws::{Case, Plate, cases, range, solve};
use hbvib::{Constant, ContactKind, ContactLoop, ContactSummary, State};
use std::f64::consts::TAU;

fn of(values: &[f64], directions: usize, k: usize) -> impl Iterator<Item = f64> + '_ {
    values[k..].iter().step_by(directions).copied()
}

/// Largest difference to forces by plain steps, relative to the largest: stick, then back to the limit μN. The
/// steps begin with no force and go round the period until it repeats.
fn plain_steps(l: &ContactLoop, kt: f64, mu: f64, loads: &[f64], tangents: usize) -> f64 {
    let (n, d) = (loads.len(), l.directions);
    let mut force = vec![0.0; tangents];
    let (mut gap, mut largest) = (0.0_f64, 0.0_f64);
    for j in 0..4 * n {
        let (now, before) = (j % n, (j + n - 1) % n);
        for (k, f) in force.iter_mut().enumerate() {
            // From no force straight to the first motion.
            let from = if j == 0 { 0.0 } else { l.motion[before * d + k] };
            *f += kt * (l.motion[now * d + k] - from);
        }
        let (size, limit) = (force.iter().map(|f| f * f).sum::<f64>().sqrt(), mu * loads[now]);
        if size > limit {
            for f in &mut force {
                *f *= limit / size;
            }
        }
        if j >= 3 * n {
            for (k, f) in force.iter().enumerate() {
                gap = gap.max((f - l.force[now * d + k]).abs());
                largest = largest.max(f.abs());
            }
        }
    }
    gap / largest
}

/// Checks friction: limits in every state, shares, loads, forces.
fn check_friction(case: &Case, l: &ContactLoop, s: &ContactSummary) {
    let c = &case.contact;
    let (n, d) = (l.state.len(), l.directions);
    let normal = c.normal_direction();
    let tangents = d - usize::from(normal.is_some());
    let load = |j: usize| {
        normal.map_or(c.constant(Constant::Preload), |k| {
            (c.load() - c.constant(Constant::Kn) * l.motion[j * d + k]).max(0.0)
        })
    };
    let loads: Vec<f64> = (0..n).map(load).collect();
    let rounding = 1e-12 * (1.0 + s.load_max);
    for (j, (f, load)) in l.force.chunks_exact(d).zip(&loads).enumerate() {
        let size = f[..tangents].iter().map(|f| f * f).sum::<f64>().sqrt();
        let limit = c.constant(Constant::Mu) * load;
        match l.state[j] {
            State::Stick => assert!(size <= limit + rounding, "{}, {j}: {size} {limit}", case.name),
            State::Slip => assert!((size - limit).abs() <= rounding, "{}, {j}: {size} {limit}", case.name),
            State::Open => assert!(f.iter().all(|f| *f == 0.0) && *load <= rounding, "{}, {j}", case.name),
        }
        if let Some(k) = normal {
            assert!((f[k] + load).abs() <= rounding, "{}, {j}", case.name);
        }
    }
    let gap = plain_steps(l, c.constant(Constant::Kt), c.constant(Constant::Mu), &loads, tangents);
    println!("{}: plain steps differ by {gap:.1e}", case.name);
    assert!(gap < 2e-3, "{}: {gap:e}", case.name);
    check_load(case, s, &loads);
}

fn check_load(case: &Case, s: &ContactSummary, loads: &[f64]) {
    let (low, high) = range(loads.iter().copied());
    let error = 1e-6 * (1.0 + high);
    assert!(
        s.load_min <= low && low - s.load_min < error,
        "{}: {low} {s:?}",
        case.name
    );
    assert!(
        s.load_max >= high && s.load_max - high < error,
        "{}: {high} {s:?}",
        case.name
    );
}

/// Velocities by central differences.
fn velocity(l: &ContactLoop, omega: f64, j: usize, k: usize) -> f64 {
    let (n, d) = (l.state.len(), l.directions);
    let (after, before) = ((j + 1) % n * d + k, (j + n - 1) % n * d + k);
    (l.motion[after] - l.motion[before]) * n as f64 * omega / (2.0 * TAU)
}

/// Checks a law without memory against its formula.
fn check_formula(case: &Case, l: &ContactLoop, f: impl Fn(&[f64], &[f64]) -> Vec<f64>) {
    let d = l.directions;
    let largest = l.force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    let mut worst = 0.0_f64;
    for (j, (u, reported)) in l.motion.chunks_exact(d).zip(l.force.chunks_exact(d)).enumerate() {
        let v: Vec<f64> = (0..d).map(|k| velocity(l, case.omega, j, k)).collect();
        for (a, b) in f(u, &v).iter().zip(reported) {
            worst = worst.max((a - b).abs() / largest);
        }
    }
    println!("{}: formula differs by {worst:.1e}", case.name);
    assert!(worst < 1e-5, "{}: {worst:e}", case.name);
}

#[test]
fn forces_states_and_loads_are_those_of_the_law() {
    for case in cases() {
        let branch = solve(&case);
        let n = 3 << 14;
        let l = branch.contact_loop(0, 0, n).unwrap();
        let s = branch.contact_summary(0, 0).unwrap();
        assert_eq!(l.motion.len(), n * l.directions);
        let share = |state| l.state.iter().filter(|s| **s == state).count() as f64 / n as f64;
        for (share, reported) in [(share(State::Slip), s.slip_share), (share(State::Open), s.open_share)] {
            // Sampled shares are those of the samples of the solution.
            let coarse = if case.samples > 0 {
                4.0 / case.samples as f64
            } else {
                0.0
            };
            assert!(
                (share - reported).abs() < 20.0 / n as f64 + coarse,
                "{}: {share} {reported}",
                case.name
            );
        }
        let reported = branch.slip_fraction_at(0).unwrap()[0];
        assert!(
            (reported - s.slip_share).abs() < 1e-12,
            "{}: {reported} {}",
            case.name,
            s.slip_share
        );
        for k in 0..l.directions {
            let (low, high) = range(of(&l.motion, l.directions, k));
            let error = 1e-6 * (high - low);
            assert!(
                s.motion_min[k] <= low + 1e-14 && low - s.motion_min[k] < error,
                "{}",
                case.name
            );
            assert!(
                s.motion_max[k] >= high - 1e-14 && s.motion_max[k] - high < error,
                "{}",
                case.name
            );
            assert!((2.0 * s.half_range[k] - (s.motion_max[k] - s.motion_min[k])).abs() < 1e-15);
        }
        let c = case.contact.clone();
        match &c.kind {
            ContactKind::Jenkins(_) | ContactKind::Friction2d(_) | ContactKind::Friction3d(_) => {
                check_friction(&case, &l, &s)
            }
            ContactKind::Unilateral(_) => {
                let loads: Vec<f64> = l
                    .motion
                    .iter()
                    .map(|y| (c.constant(Constant::Kn) * (-y - c.constant(Constant::Gap))).max(0.0))
                    .collect();
                assert!(l.force.iter().zip(&loads).all(|(f, load)| (f + load).abs() < 1e-14));
                assert!(
                    l.state
                        .iter()
                        .zip(&l.force)
                        .all(|(s, f)| (*s == State::Open) == (*f == 0.0))
                );
                assert!(s.open_share > 0.1 && s.slip_share == 0.0);
                check_load(&case, &s, &loads);
            }
            ContactKind::Cubic(_) => check_formula(&case, &l, |u, _| vec![0.5 * u[0] + 0.7 * u[0].powi(3)]),
            ContactKind::Regularised(_) => {
                check_formula(&case, &l, |_, v| vec![0.4 * (v[0] / 0.3).tanh()]);
                check_load(&case, &s, &[c.constant(Constant::Preload)]);
            }
            ContactKind::Table(table) => check_formula(&case, &l, |u, _| vec![table.force(u[0])]),
            ContactKind::Polynomial(_) => check_formula(&case, &l, |u, v| {
                let (u, v) = (u[0], v[0]);
                vec![0.5 * u + 0.3 * u * u + 0.2 * u.powi(3) + 0.02 * v + 0.05 * v.powi(3)]
            }),
            kind => {
                assert!(kind.user().is_some(), "a check of {kind:?} is missing");
                check_formula(&case, &l, |u, v| Plate::force([u[0], u[1]], [v[0], v[1]]).to_vec());
            }
        }
        let has_states = matches!(
            c.kind,
            ContactKind::Jenkins(_)
                | ContactKind::Friction2d(_)
                | ContactKind::Friction3d(_)
                | ContactKind::Unilateral(_)
        );
        if !has_states {
            assert!(l.state.iter().all(|s| *s == State::Stick), "{}", case.name);
        }
        if case.name.ends_with("separating") {
            assert!(
                s.slip_share > 0.05 && s.open_share > 0.05 && s.load_min == 0.0,
                "{}: {s:?}",
                case.name
            );
        }
    }
}
