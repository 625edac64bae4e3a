//! The nonlinear mode of a finite-element sector whose 30 pairs of nodes press with a normal load that varies and may
//! vanish, about its static state: one harmonic and the mean, from stuck contacts to the first that lift off.

use crate::common::{all_harmonics, amplitude_range, at_dof, harmonics, omega_range, processor_time, relative_gap};
use crate::sector::{Interface, Sector, Size};
use hbvib::{
    Branch, Constant, Contact, Error, ForcedOptions, Hooks, MatrixKind, ModeChoice, ModeField, ModeOptions, Model,
    SolverOptions, Spring, Status, SynthesisOptions, forced_response, nonlinear_mode, synthesise,
};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::time::Instant;

fn sector() -> Sector {
    let folder = crate::common::programs::root().join("examples/data/fe");
    Sector::read(&folder, Size::Reduced).unwrap()
}

/// The sector with friction in a plane at each pair of nodes, under a force at the tip.
fn pressed(sector: &Sector, force: f64) -> (Model, usize) {
    with_preload(sector, force, true)
}

/// The same; `balanced` with constant forces that keep the structure where the preload acts.
fn with_preload(sector: &Sector, force: f64, balanced: bool) -> (Model, usize) {
    let mut model = sector.model(Interface::Absent).unwrap();
    for pair in &sector.pairs {
        let [along, across] = &pair.friction;
        let contact = Contact::friction_3d(
            [along.dof_a[0], across.dof_a[0], pair.normal.dof_a],
            [along.dof_b[0], across.dof_b[0], pair.normal.dof_b],
            (along.constant(Constant::Kt), pair.normal.stiffness),
            along.constant(Constant::Mu),
            along.constant(Constant::Preload),
        );
        model.add_contact(&contact).unwrap();
        if !balanced {
            continue;
        }
        // The preload of the table acts in the deformed state: constant forces keep the structure there.
        for (dof, force) in [
            (pair.normal.dof_a, -along.constant(Constant::Preload)),
            (pair.normal.dof_b, along.constant(Constant::Preload)),
        ] {
            model.add_force(dof.unwrap(), 0, Complex64::from(force)).unwrap();
        }
    }
    let tip = sector.size.tip();
    model.add_force(tip, 1, Complex64::from(force)).unwrap();
    (model, tip)
}

/// The same with soft springs that hold the ring. With contacts that slip or open in each period, the travelling wave
/// drives a ring that friction alone holds, and no motion is periodic.
fn hold(model: &mut Model, sector: &Sector, stiffness: f64) {
    for pair in &sector.pairs {
        for friction in &pair.friction {
            let spring = Spring {
                dof_a: friction.dof_b[0],
                dof_b: None,
                sector_offset: 0,
                stiffness,
            };
            model.add_spring(&spring).unwrap();
        }
    }
}

fn followed(model: &Model, tip: usize, log10_stop: f64) -> Result<Branch, Error> {
    let solver = at_dof(tip, harmonics(1));
    let range = ModeOptions {
        choice: ModeChoice::Near(530.0 * TAU),
        ..amplitude_range(-7.0, log10_stop)
    };
    nonlinear_mode(model, &solver, &range, &mut Hooks::default())
}

#[test]
#[ignore = "two minutes of processor time; run by tests/deep.sh"]
fn pressed_contacts_of_a_sector_with_a_held_ring_are_followed_over_four_decades() {
    // With the stiffer springs the last contact that holds the ring slips at a corner that the branch reaches along its surface.
    for stiffness in [1e3, 1e5] {
        four_decades(stiffness);
    }
}

fn four_decades(stiffness: f64) {
    let sector = sector();
    let (mut model, tip) = pressed(&sector, 2.0);
    hold(&mut model, &sector, stiffness);
    let begin = (Instant::now(), processor_time(Instant::now()));
    let branch = followed(&model, tip, -3.0).unwrap();
    let time = processor_time(begin.0).saturating_sub(begin.1).as_secs_f64();
    println!(
        "{stiffness:e} N/m: {} points in {time:.1} s of processor time, {:?}",
        branch.points(),
        branch.status()
    );
    // Beside the corner the slider's place is known to the root of rounding alone.
    assert!(branch.status() == Status::Ok || (stiffness > 1e4 && branch.status() == Status::StoppedStalled));
    assert!((branch.mode_at(branch.points() - 1).unwrap().log10_amplitude + 3.0).abs() < 1e-12);
    let damping = branch.mode_field(ModeField::DampingRatio).unwrap();
    let largest = damping.iter().fold(0.0_f64, |m, d| m.max(*d));
    for (point, d) in damping.iter().enumerate() {
        let at = branch.mode_at(point).unwrap();
        println!(
            "{:.3} {:.4} Hz D {d:.4e}",
            at.log10_amplitude,
            branch.omega()[point] / TAU
        );
        let check = at.energy_damping_ratio();
        assert!((check - d).abs() < 1e-5 * largest, "point {point}: {check} {d}");
    }
    // Far above the contact forces the ring slides freely: the damping of the structure is left.
    assert!(*damping.last().unwrap() < 0.6 * largest);
}

#[test]
#[ignore = "a minute of processor time; run by tests/deep.sh"]
fn a_sector_whose_preload_makes_contacts_slip_at_rest_has_a_mode_where_the_ring_is_held() {
    let sector = sector();
    let (mut model, tip) = with_preload(&sector, 2.0, false);
    let begin = processor_time(Instant::now());
    let refused = followed(&model, tip, -4.0).unwrap_err();
    let time = processor_time(Instant::now()).saturating_sub(begin).as_secs_f64();
    println!("a ring that friction alone holds: {refused}, after {time:.1} s of processor time");
    assert_eq!(refused.status, Status::NoConvergence);
    assert!(refused.to_string().contains("hold it by soft springs"));
    hold(&mut model, &sector, 1e3);
    let begin = processor_time(Instant::now());
    let branch = followed(&model, tip, -4.0).unwrap();
    let time = processor_time(Instant::now()).saturating_sub(begin).as_secs_f64();
    let slipping = branch.slip_fraction()[..30]
        .iter()
        .filter(|&&share| share > 0.0)
        .count();
    println!(
        "held: {} points in {time:.1} s, {slipping} contacts slip at the first",
        branch.points()
    );
    assert_eq!(branch.status(), Status::Ok);
    assert!(slipping > 5 && branch.mode().unwrap().slip_from == f64::NEG_INFINITY);
    let damping = branch.mode_field(ModeField::DampingRatio).unwrap();
    let largest = damping.iter().fold(0.0_f64, |m, d| m.max(*d));
    for (point, d) in damping.iter().enumerate() {
        let check = branch.mode_at(point).unwrap().energy_damping_ratio();
        assert!((check - d).abs() < 1e-5 * largest, "point {point}: {check} {d}");
    }
}

fn mode(model: &Model, tip: usize, harmonic: usize) -> Branch {
    let solver = SolverOptions {
        response_dof: Some(tip),
        tol_residual: 1e-12,
        ..harmonics(harmonic)
    };
    let range = ModeOptions {
        choice: ModeChoice::Near(530.0 * TAU),
        ..amplitude_range(-7.0, -5.0)
    };
    nonlinear_mode(model, &solver, &range, &mut Hooks::default()).unwrap()
}

#[test]
#[ignore = "half a minute of processor time; run by tests/deep.sh"]
fn pressed_contacts_of_a_sector_are_followed_from_stuck_to_lift_off() {
    let sector = sector();
    let (mut model, tip) = pressed(&sector, 2.0);
    // A ring that friction alone holds has no periodic motion once each of its contacts slips.
    hold(&mut model, &sector, 1e3);
    let begin = (Instant::now(), processor_time(Instant::now()));
    let branch = mode(&model, tip, 1);
    println!(
        "{} points in {:.1} s of processor time, {:?}",
        branch.points(),
        processor_time(begin.0).saturating_sub(begin.1).as_secs_f64(),
        branch.status()
    );
    let info = branch.mode().unwrap();
    println!(
        "{} Hz, linear up to {}, slip from {}, lift-off from {}",
        info.omega / TAU,
        info.linear_up_to,
        info.slip_from,
        info.lift_off_from
    );
    let damping = branch.mode_field(ModeField::DampingRatio).unwrap();
    for point in (0..branch.points()).step_by(6) {
        println!(
            "{:.3} {:.4} Hz D {:.4e}",
            branch.mode_at(point).unwrap().log10_amplitude,
            branch.omega()[point] / TAU,
            damping[point]
        );
    }
    assert_eq!(branch.status(), Status::Ok);
    let largest = damping.iter().fold(0.0_f64, |m, d| m.max(*d));
    let mut worst = 0.0_f64;
    for (point, d) in damping.iter().enumerate() {
        let check = branch.mode_at(point).unwrap().energy_damping_ratio();
        worst = worst.max((check - d).abs() / largest);
        assert!((check - d).abs() < 1e-8 * largest, "point {point}: {check} {d}");
    }
    // It follows the residual: 1e-6 with the default tolerance, a hundred times larger.
    println!("balance of work: {worst:.1e}");
    assert!(info.slip_from < info.lift_off_from && info.lift_off_from < -5.0);
    let begin = processor_time(Instant::now());
    let found = synthesise(&branch, &model, &SynthesisOptions::default()).unwrap();
    for peak in &found.peaks {
        println!("resonance at {} Hz: {:?}", peak.at.omega / TAU, peak.validity);
    }
    println!(
        "synthesis in {:.1} s",
        processor_time(Instant::now()).saturating_sub(begin).as_secs_f64()
    );
}

/// Answer of the model to the force that does the work of the artificial damping at a point of its mode.
fn balanced(model: &Model, solver: &SolverOptions, branch: &Branch, (omega, point): (f64, usize)) -> Vec<Complex64> {
    let d = branch.mode_at(point).unwrap().damping_ratio;
    let guess = all_harmonics(branch, point);
    let n = branch.ndof();
    let mass = model.structure().wave_matrix(MatrixKind::Mass, 1).unwrap();
    let inertia = mass.times(&guess[n..2 * n], "the force").unwrap();
    let mut forced = model.try_clone().unwrap();
    for (dof, z) in inertia.iter().enumerate() {
        forced
            .add_force(dof, 1, z * Complex64::new(0.0, 2.0 * d * omega * omega))
            .unwrap();
    }
    let range = ForcedOptions {
        guess: Some(&guess),
        ..omega_range(omega, omega)
    };
    let answer = forced_response(&forced, solver, &range, &mut Hooks::default()).unwrap();
    assert_eq!(answer.status(), Status::Ok);
    all_harmonics(&answer, 0)
}

#[test]
#[ignore = "half a minute of processor time; run by tests/deep.sh"]
fn pressed_contacts_of_a_sector_stick_and_then_slip_as_the_forced_response_does() {
    let sector = sector();
    let (mut model, tip) = pressed(&sector, 0.0);
    hold(&mut model, &sector, 1e3);
    let begin = processor_time(Instant::now());
    let solver = SolverOptions {
        response_dof: Some(tip),
        tol_residual: 1e-13,
        ..harmonics(1)
    };
    let range = ModeOptions {
        choice: ModeChoice::Near(530.0 * TAU),
        at: &[-6.5, -6.35],
        ..amplitude_range(-6.5, -6.35)
    };
    let branch = nonlinear_mode(&model, &solver, &range, &mut Hooks::default()).unwrap();
    assert_eq!(branch.status(), Status::Ok);
    let info = branch.mode().unwrap();
    assert!(info.slip_from > -6.5 && info.slip_from < -6.35 && info.lift_off_from == f64::INFINITY);
    let slip = |point: usize| {
        branch
            .slip_fraction_at(point)
            .unwrap()
            .iter()
            .fold(0.0_f64, |m, s| m.max(*s))
    };
    let mut damping = Vec::new();
    for (i, slips) in [false, true].into_iter().enumerate() {
        let (omega, point) = (branch.at(i)[0].omega, branch.at(i)[0].point);
        assert_eq!(slip(point) > 0.0, slips);
        let at = branch.mode_at(point).unwrap();
        assert!((at.energy_damping_ratio() / at.damping_ratio - 1.0).abs() < 1e-8);
        damping.push(at.damping_ratio);
        let (x, found) = (
            all_harmonics(&branch, point),
            balanced(&model, &solver, &branch, (omega, point)),
        );
        let n = branch.ndof();
        let gap = relative_gap(&found[n..], &x[n..]);
        // Constant forces keep the structure where the preload acts; slip moves the mean by little.
        let mean = x[..n].iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        let most = x[n..].iter().fold(0.0_f64, |m, z| m.max(z.norm()));
        println!(
            "log10 a = {}: D {:.6e}, slip {:.2}, response off by {gap:.1e}, mean over vibration {:.1e}",
            at.log10_amplitude,
            at.damping_ratio,
            slip(point),
            mean / most
        );
        assert!(gap < 1e-9, "{gap:e}");
        assert!(slips || mean < 1e-12 * most);
    }
    assert!(damping[1] > 1.2 * damping[0], "{damping:?}");
    println!(
        "{} points in {:.1} s of processor time",
        branch.points(),
        processor_time(Instant::now()).saturating_sub(begin).as_secs_f64()
    );
}
