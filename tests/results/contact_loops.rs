//! Inside a contact: loops, states, work and ranges against closed forms, against a slider marched in
//! time and against the energies of the point.

use crate::common::energy::{close, exactly};
use crate::common::models::oscillator;
use crate::common::{self, B1, BASE, D, R, all_harmonics, amplitude_range, harmonics, solve_at, sweep};
use hbvib::{
    Branch, Constant, Contact, ContactKind, ContactLoop, ContactSummary, Hooks, Model, SolverOptions, State, Status,
    contact_evaluate, nonlinear_mode,
};
use num_complex::Complex64;
use std::f64::consts::TAU;

/// Mass 1, damping 0.05 and stiffness 4.
fn oscillating(contacts: &[Contact]) -> Model {
    oscillator(1.0, 4.0).damping(&[0.05]).contacts(contacts).build()
}

/// ∮ f dy by the trapezoidal rule.
fn area(l: &ContactLoop) -> f64 {
    let n = l.motion.len();
    (0..n)
        .map(|j| (j, (j + 1) % n))
        .map(|(a, b)| 0.5 * (l.force[a] + l.force[b]) * (l.motion[b] - l.motion[a]))
        .sum()
}

fn share(l: &ContactLoop, state: State) -> f64 {
    l.state.iter().filter(|s| **s == state).count() as f64 / l.state.len() as f64
}

/// A slider of stiffness k marched over two periods of the samples, from a virgin loading to the first.
fn marched(motion: &[f64], k: f64, limit: f64) -> Vec<f64> {
    let mut slider = 0.0;
    let mut force = vec![0.0; motion.len()];
    for _ in 0..2 {
        for (f, y) in force.iter_mut().zip(motion) {
            *f = (k * (y - slider)).clamp(-limit, limit);
            slider = y - *f / k;
        }
    }
    force
}

/// Checks what holds for every friction contact, and returns its numbers.
fn check_friction(branch: &Branch, point: usize, id: usize, contact: &Contact) -> ContactSummary {
    let n = 1 << 15;
    let found = branch.contact_loop(point, id, n).unwrap();
    let s = branch.contact_summary(point, id).unwrap();
    let (k, limit) = (contact.constant(Constant::Kt), contact.slip_limit());
    let largest = found.motion.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
    let rounding = 1e-13 * (limit + k * largest);
    for j in 0..n {
        let next = (j + 1) % n;
        let (f, y) = (found.force[j], found.motion[j]);
        assert!(f.abs() <= limit + rounding, "{j}: {f}");
        match found.state[j] {
            State::Slip => {
                assert!((f.abs() - limit).abs() <= rounding, "{j}: {f}");
                assert!(f * (found.motion[next] - y) >= -1e-6 * limit * largest);
            }
            State::Stick if found.state[next] == State::Stick => {
                let slope = found.force[next] - f - k * (found.motion[next] - y);
                // A slip may lie between two times, as short as they are apart.
                assert!(slope.abs() <= rounding + 1e-6 * limit, "{j}: {slope}");
            }
            State::Stick => {}
            State::Open => panic!("friction does not open"),
        }
    }
    let scale = limit * (s.motion_max[0] - s.motion_min[0]);
    println!("contact {id}: {s:?}, area {:e}", area(&found));
    assert!((area(&found) - s.work).abs() < 2e-6 * scale);
    assert!((share(&found, State::Slip) - s.slip_share).abs() < 20.0 / n as f64);
    for (f, g) in found.force.iter().zip(marched(&found.motion, k, limit)) {
        // The part of a turning point that samples miss.
        assert!((f - g).abs() < 1e-5 * limit, "{f} {g}");
    }
    assert!((s.half_range[0] - 0.5 * (s.motion_max[0] - s.motion_min[0])).abs() <= 1e-15 * s.half_range[0]);
    for y in &found.motion {
        assert!(*y <= s.motion_max[0] + 1e-14 * largest && *y >= s.motion_min[0] - 1e-14 * largest);
    }
    assert!(s.motion_max[0] - largest < 1e-6 * largest);
    assert_eq!(
        (s.load_min, s.load_max, s.open_share),
        (
            contact.constant(Constant::Preload),
            contact.constant(Constant::Preload),
            0.0
        )
    );
    s
}

/// Checks all contacts of a branch, Jenkins contacts that can slip, with their totals.
fn check_all(branch: &Branch, model: &Model, point: usize) {
    let mut work = 0.0;
    for (id, contact) in model.contacts().iter().enumerate() {
        let s = check_friction(branch, point, id, contact);
        let reported = branch.slip_fraction_at(point).unwrap()[id];
        assert!((s.slip_share - reported).abs() < 1e-12, "{} {reported}", s.slip_share);
        assert!((s.work > 0.0) == (reported > 0.0));
        work += s.work;
    }
    close("work", work, branch.energy_at(point).unwrap().friction_loss, 1e-10);
}

#[test]
fn a_slider_under_one_harmonic_takes_four_limits_times_the_slip() {
    let contact = Contact::jenkins(0, None, 2.0, 0.5, 6.0);
    // The force that makes the amplitude 5.
    let y = [Complex64::ZERO, 5.0.into()];
    let mut law = [Complex64::ZERO; 2];
    contact_evaluate(&contact, 1, 0, 1.0, &y, &mut law, None).unwrap();
    assert!((law[1].re / 5.0 - 0.504_632).abs() < 5e-7, "{}", law[1].re / 5.0);
    let omega = 1.3;
    let mut model = oscillating(core::slice::from_ref(&contact));
    let linear = Complex64::new(4.0 - omega * omega, 0.05 * omega);
    model.add_force(0, 1, linear * 5.0 + law[1]).unwrap();
    let branch = solve_at(&model, &exactly(1), omega);
    let s = check_friction(&branch, 0, 0, &contact);
    close("work", s.work, 42.0, 1e-12);
    close("half range", s.half_range[0], 5.0, 1e-13);
    // Stick from the turning point until the motion has gone by 2·1.5: 5(1 − cos φ) = 3.
    close("slip", s.slip_share, 1.0 - 2.0 * 0.4_f64.acos() / TAU, 1e-12);
    let l = branch.contact_loop(0, 0, 4).unwrap();
    for (f, expected) in l.force.iter().zip([3.0, -3.0, -3.0, 3.0]) {
        assert!((f - expected).abs() < 1e-12, "{:?}", l.force);
    }
    assert_eq!(l.state[1], State::Slip);
    check_all(&branch, &model, 0);
}

#[test]
fn contacts_of_one_motion_have_a_loop_each() {
    // Odd harmonics, all of them, and a forcing in the third alone, whose motion repeats.
    let contacts = [
        Contact::jenkins(0, None, 5.0, 0.3, 0.7),
        Contact::jenkins(0, None, 1.0, 0.3, 0.1),
    ];
    let all = SolverOptions {
        keep_even_harmonics: true,
        ..exactly(9)
    };
    for (solver, forces) in [
        (exactly(9), [(1, 0.9), (1, 0.1)]),
        (all, [(1, 0.9), (1, 0.1)]),
        (exactly(9), [(3, 2.5), (3, 0.5)]),
        (exactly(9), [(1, 0.7), (2, 0.5)]),
        (exactly(7), [(0, 0.3), (1, 0.8)]),
    ] {
        let mut model = oscillating(&contacts);
        for (h, f) in forces {
            let value = if h == 0 { f.into() } else { Complex64::new(f, 0.3) };
            model.add_force(0, h, value).unwrap();
        }
        let omega = if forces[0].0 == 3 { 0.75 } else { 2.1 };
        let branch = solve_at(&model, &solver, omega);
        println!("{:?}", branch.carried_at(0).unwrap());
        check_all(&branch, &model, 0);
    }
}

#[test]
fn the_ring_damper_balances_contact_by_contact() {
    for highest in [1, 3, 9] {
        let model = BASE.sector();
        let branch = sweep(&model, &exactly(highest), TAU * 208.0, TAU * 210.0, &[TAU * 208.85]);
        for point in [branch.peaks()[0].point, branch.at(0)[0].point, 0] {
            check_all(&branch, &model, point);
        }
    }
}

#[test]
fn points_of_a_mode_have_loops() {
    let (model, contact) = (BASE.sector(), BASE.contact());
    let unit = (contact.slip_limit() / contact.constant(Constant::Kt)).log10();
    let range = amplitude_range(unit + 1.0, unit + 4.0);
    let branch = nonlinear_mode(&model, &harmonics(5), &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    let slipping = (0..branch.points()).filter(|&p| common::slip(&branch, p) > 0.05);
    let points: Vec<usize> = slipping.step_by(5).collect();
    assert!(points.len() > 2);
    for point in points {
        check_all(&branch, &model, point);
        let loss = branch.mode_at(point).unwrap().friction_loss;
        close("loss", branch.contact_summary(point, 0).unwrap().work, loss, 1e-10);
    }
}

#[test]
fn contacts_without_coordinate_are_recovered() {
    // A contact into the next sector that slips, one that never does, one without force.
    let mut model = BASE.sector();
    let across = Contact {
        sector_offset: 1,
        ..Contact::jenkins(D, Some(B1), 3e6, 0.3, 2.0)
    };
    let stuck = Contact {
        sector_offset: -1,
        ..across.clone()
    }
    .with(Constant::Preload, f64::INFINITY)
    .unwrap();
    let inert = across.clone().with(Constant::Mu, 0.0).unwrap();
    for contact in [&stuck, &across, &inert] {
        model.add_contact(contact).unwrap();
    }
    let branch = solve_at(&model, &exactly(5), TAU * 215.0);
    let x = all_harmonics(&branch, 0);
    let n = 64;
    for (id, contact) in model.contacts().iter().enumerate() {
        let found = branch.contact_loop(0, id, n).unwrap();
        let s = branch.contact_summary(0, id).unwrap();
        let (a, b) = (contact.dof_a[0].unwrap(), contact.dof_b[0].unwrap());
        let dofs = branch.ndof();
        let size = found.motion.iter().fold(0.0_f64, |m, y| m.max(y.abs()));
        for (j, y) in found.motion.iter().enumerate() {
            let expected: f64 = (0..=5)
                .map(|h| {
                    let turn = Complex64::cis(TAU * (h * j) as f64 / n as f64);
                    let lag = model.structure().phase(h, contact.sector_offset);
                    ((x[h * dofs + a] - lag * x[h * dofs + b]) * turn).re
                })
                .sum();
            assert!((y - expected).abs() < 1e-9 * size, "{id}, {j}: {y} {expected}");
        }
        assert!(s.half_range[0] > 0.0);
        if id == 1 || id == 3 {
            let k = if id == 1 { 3e6 } else { 0.0 };
            assert!(
                found
                    .force
                    .iter()
                    .zip(&found.motion)
                    .all(|(f, y)| (f - k * y).abs() <= 1e-15 * k * size)
            );
            assert!(found.state.iter().all(|s| *s == State::Stick));
            assert_eq!((s.work, s.slip_share, s.open_share), (0.0, 0.0, 0.0));
            assert_eq!(
                (s.load_min, s.load_max),
                (contact.constant(Constant::Preload), contact.constant(Constant::Preload))
            );
        } else {
            check_friction(&branch, 0, id, contact);
        }
    }
    let total: f64 = (0..4).map(|id| branch.contact_summary(0, id).unwrap().work).sum();
    close("work", total, branch.energy_at(0).unwrap().friction_loss, 1e-10);
    // The ring contact itself: side a is the disk.
    assert_eq!(
        (model.contacts()[0].dof_a[0], model.contacts()[0].dof_b[0]),
        (Some(D), Some(R))
    );
}

#[test]
fn a_stop_pushes_or_is_open() {
    for (gap, preload) in [(0.2, 0.0), (0.0, 0.0), (0.0, 0.3), (-0.1, 0.0), (9.0, 0.0), (-9.0, 0.0)] {
        let contact = Contact::unilateral(None, Some(0), 3.0, gap)
            .with(Constant::Preload, preload)
            .unwrap();
        let mut model = oscillating(&[contact]);
        model.add_force(0, 1, 0.8.into()).unwrap();
        let branch = solve_at(&model, &exactly(9), 1.7);
        let n = 1 << 14;
        let found = branch.contact_loop(0, 0, n).unwrap();
        let s = branch.contact_summary(0, 0).unwrap();
        println!("gap {gap}, preload {preload}: {s:?}");
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for j in 0..n {
            // Side a is the ground: the closing is −y, and f = −N.
            let load = (preload + 3.0 * (-found.motion[j] - gap)).max(0.0);
            let rounding = 1e-14 * (1.0 + load);
            assert!(found.force[j] <= 0.0 && (found.force[j] + load).abs() < rounding);
            assert_eq!(found.state[j] == State::Open, found.force[j] == 0.0);
            low = low.min(load);
            high = high.max(load);
        }
        assert!((s.load_min - low).abs() < 1e-5 && (s.load_max - high).abs() < 1e-5);
        assert!((share(&found, State::Open) - s.open_share).abs() < 4.0 / n as f64);
        // Open time is not slip.
        assert_eq!(branch.slip_fraction_at(0).unwrap(), [0.0]);
        assert_eq!((s.work, s.slip_share), (0.0, 0.0));
        match gap {
            9.0 => assert_eq!((s.open_share, s.load_max), (1.0, 0.0)),
            -9.0 => assert!(s.open_share == 0.0 && s.load_min > 0.0),
            _ => assert!(s.open_share > 0.05 && s.open_share < 0.95 && s.load_min == 0.0 && s.load_max > 0.0),
        }
    }
}

#[test]
fn a_cubic_spring_has_a_curve_for_a_loop() {
    let mut model = oscillating(&[Contact::cubic(0, None, 0.5, 2.0)]);
    model.add_force(0, 1, 0.8.into()).unwrap();
    let branch = solve_at(&model, &exactly(7), 1.7);
    let l = branch.contact_loop(0, 0, 100).unwrap();
    for (y, f) in l.motion.iter().zip(&l.force) {
        assert!((f - 0.5 * y - 2.0 * y.powi(3)).abs() < 1e-14);
    }
    let s = branch.contact_summary(0, 0).unwrap();
    assert_eq!(
        (s.work, s.slip_share, s.open_share, s.load_min, s.load_max),
        (0.0, 0.0, 0.0, 0.0, 0.0)
    );
    assert!(s.half_range[0] > 0.0 && s.motion_min[0] + s.motion_max[0] == 0.0);
    assert!(matches!(model.contacts()[0].kind, ContactKind::Cubic(_)));
}

#[test]
fn a_branch_of_samples_tells_the_exact_law() {
    let model = BASE.sector();
    let solver = SolverOptions {
        samples: 4096,
        ..exactly(5)
    };
    let branch = solve_at(&model, &solver, TAU * 208.85);
    let s = check_friction(&branch, 0, 0, &BASE.contact());
    let reported = branch.energy_at(0).unwrap().friction_loss;
    close("work", s.work, reported, 1e-4);
    assert!(s.work.to_bits() != reported.to_bits());
}

#[test]
fn time_histories_are_the_sums_of_the_harmonics() {
    let mut linear = oscillating(&[]);
    for (h, f) in [(0, 0.5), (2, 0.3), (5, 0.2)] {
        linear.add_force(0, h, f.into()).unwrap();
    }
    for branch in [
        solve_at(&linear, &harmonics(6), 0.8),
        solve_at(&BASE.sector(), &harmonics(9), TAU * 208.85),
    ] {
        let x = all_harmonics(&branch, 0);
        let dofs = branch.ndof();
        for (dof, n) in (0..dofs).zip([1, 7, 1000, 64]) {
            let history = branch.time_history(0, dof, n).unwrap();
            assert_eq!(history.len(), n);
            let size: f64 = x.iter().skip(dof).step_by(dofs).map(|z| z.norm()).sum();
            for (j, value) in history.iter().enumerate() {
                let expected: f64 = (0..=branch.harmonics())
                    .map(|h| (x[h * dofs + dof] * Complex64::cis(TAU * (h * j) as f64 / n as f64)).re)
                    .sum();
                assert!((value - expected).abs() < 1e-13 * size, "dof {dof}: {value} {expected}");
            }
        }
    }
}

#[test]
fn units_and_wrong_numbers() {
    // Lengths a million times smaller, forces alike: the loop scales.
    let contact = |unit: f64| Contact::jenkins(0, None, 5.0, 0.3, 0.7 * unit);
    let loops = [1.0, 1e-6].map(|unit| {
        let mut model = oscillating(&[contact(unit)]);
        model.add_force(0, 1, (0.9 * unit).into()).unwrap();
        let branch = solve_at(&model, &exactly(5), 2.1);
        (branch.contact_loop(0, 0, 40).unwrap(), branch)
    });
    for j in 0..40 {
        let [(a, _), (b, _)] = &loops;
        assert!((a.motion[j] - 1e6 * b.motion[j]).abs() < 1e-11);
        assert!((a.force[j] - 1e6 * b.force[j]).abs() < 1e-11);
        assert_eq!(a.state[j], b.state[j]);
    }
    let branch = &loops[0].1;
    let end = branch.stored();
    let status = |e: hbvib::Error| e.status;
    assert_eq!(branch.contact_loop(end, 0, 9).map_err(status), Err(Status::Index));
    assert_eq!(branch.contact_loop(0, 1, 9).map_err(status), Err(Status::Index));
    assert_eq!(branch.contact_loop(0, 0, 0).map_err(status), Err(Status::Dimension));
    assert_eq!(
        branch.contact_loop(0, 0, (1 << 24) + 1).map_err(status),
        Err(Status::Dimension)
    );
    assert_eq!(branch.contact_summary(end, 0).map_err(status), Err(Status::Index));
    assert_eq!(branch.contact_summary(0, 1).map_err(status), Err(Status::Index));
    assert_eq!(branch.time_history(end, 0, 9).map_err(status), Err(Status::Index));
    assert_eq!(branch.time_history(0, 1, 9).map_err(status), Err(Status::Index));
    assert_eq!(branch.time_history(0, 0, 0).map_err(status), Err(Status::Dimension));
}
