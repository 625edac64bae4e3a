//! Sweeps on which programs for harmonic balance walk in circles, stop short or jump: each one here
//! begins and ends where it was told to, goes through its points once, and takes few of them.

use crate::common::peers::{RANGE, blade_and_ring, structure};
use crate::common::{self, Blisk, all_harmonics, at_dof, harmonics, omega_range, relative_gap, slip, sweep};
use hbvib::{Branch, Contact, ForcedOptions, Hooks, Model, SolverOptions, Status, forced_response};
use std::f64::consts::PI;

/// One mass with its Jenkins contact to the ground, under a force.
fn rubbing(damping: f64, kt: f64, limit: f64, force: f64) -> Model {
    let mut model = structure(&[1.0], &[damping], &[1.0]);
    model.add_contact(&Contact::jenkins(0, None, kt, 1.0, limit)).unwrap();
    model.add_force(0, 1, force.into()).unwrap();
    model
}

/// Checks what every sweep owes: it covers its range to the last bit, turns only at the folds that it
/// reports, and never stands at one solution twice. Tells what it cost.
fn check(name: &str, branch: &Branch, from: f64, to: f64, most_points: usize) {
    let omega = branch.omega();
    assert_eq!(branch.status(), Status::Ok, "{name}: {:?}", branch.reason());
    let ends = [omega[0], omega[omega.len() - 1]].map(f64::to_bits);
    assert_eq!(ends, [from, to].map(f64::to_bits), "{name}");
    // A branch may leave at the start of the range and come back there, without turning in it.
    let turned = |w: &&[f64]| (w[1] - w[0]) * (w[2] - w[1]) < 0.0 && w[1].to_bits() != from.to_bits();
    let turns = omega.windows(3).filter(turned).count();
    assert_eq!(turns, branch.folds().len(), "{name}: turns without a fold");
    let amplitude = branch.amplitude();
    let scale = amplitude.iter().fold(0.0_f64, |m, a| m.max(*a));
    for i in 1..omega.len() {
        let step = ((omega[i] - omega[i - 1]) / omega[i]).hypot((amplitude[i] - amplitude[i - 1]) / scale);
        assert!(step > 1e-12, "{name}: points {i} and {} are one", i - 1);
    }
    let mut iterations = branch.newton_iterations().to_vec();
    iterations.sort_by(f64::total_cmp);
    let [median, worst] = [iterations.len() / 2, iterations.len() - 1].map(|i| iterations[i]);
    println!(
        "{name}: {} points, {median} iterations a point, {worst} at most, {} peaks, {} folds",
        omega.len(),
        branch.peaks().len(),
        branch.folds().len()
    );
    assert!(omega.len() <= most_points, "{name}: {} points", omega.len());
}

/// The highest peak of the blade tip.
fn peak(branch: &Branch) -> f64 {
    branch.peaks().iter().fold(0.0, |m, p| m.max(p.amplitude))
}

#[test]
#[ignore = "half a minute of processor time; run by tests/deep.sh"]
fn a_bladed_disk_is_swept_whole_at_every_force_harmonic_and_sampling() {
    for force in [0.05, 0.5, 2.0, 5.0, 20.0, 50.0] {
        let model = blade_and_ring(force, true);
        for highest in [1, 3, 5, 7, 9, 15] {
            for samples in [0, 64, 128, 256, 512] {
                let solver = SolverOptions {
                    harmonics: highest,
                    samples,
                    response_dof: Some(0),
                    tolerance: 0.0,
                    // So few samples for so many harmonics give twenty narrow maxima, which differ by 3 %: longer steps pass by
                    // the highest.
                    step_max: if (highest, samples) == (15, 64) { 0.004 } else { 0.0 },
                    ..SolverOptions::default()
                };
                let (from, to) = RANGE;
                // Each sample is a kink of the curve that steps are cut at.
                let most = if samples == 0 { 200 } else { 2000 };
                let name = format!("{force} N, H = {highest}, {samples} samples");
                let up = sweep(&model, &solver, from, to, &[]);
                check(&name, &up, from, to, most);
                let down = sweep(&model, &solver, to, from, &[]);
                check(&format!("{name}, downwards"), &down, to, from, most);
                let gap = (peak(&up) / peak(&down) - 1.0).abs();
                // With samples the curve has kinks and many maxima within a step, alike to about 1 %.
                let near = if samples == 0 { 1e-8 } else { 2e-2 };
                assert!(peak(&up) > 0.0 && gap < near, "{name}: {gap:e}");
            }
        }
    }
}

#[test]
fn a_resonance_by_few_samples_has_its_peak_in_either_direction() {
    // Downwards, a point of the curve lies above each maximum that was located: the highest of them is the peak all the same.
    let model = blade_and_ring(0.5, true);
    let solver = SolverOptions {
        samples: 64,
        ..at_dof(0, harmonics(3))
    };
    let (from, to) = RANGE;
    let [up, down] = [(from, to), (to, from)].map(|(a, b)| peak(&sweep(&model, &solver, a, b, &[])));
    assert!(down > 0.0 && (up / down - 1.0).abs() < 2e-2, "{up} {down}");
}

#[test]
fn the_error_of_few_harmonics_is_that_which_others_found() {
    let (from, to) = RANGE;
    let model = blade_and_ring(0.5, true);
    let of = |highest: usize| {
        let solver = at_dof(0, harmonics(highest));
        peak(&sweep(&model, &solver, from, to, &[]))
    };
    let truth = of(255);
    for (highest, wanted) in [(1, 0.028), (3, -0.027), (5, 0.107), (9, 0.070), (15, 0.024)] {
        let error = of(highest) / truth - 1.0;
        println!("H = {highest}: {:+.4} %", 100.0 * error);
        // Published with one decimal of a percent.
        assert!((error - wanted).abs() < 0.0006, "H = {highest}: {error}");
    }
}

#[test]
fn a_narrow_curve_with_two_folds_is_followed_round_both() {
    // A hardening spring bends a resonance of relative width 1e-3 over to ten times its width.
    let mut model = structure(&[1.0], &[1e-3], &[1.0]);
    model.add_contact(&Contact::cubic(0, None, 0.0, 1.0)).unwrap();
    model.add_force(0, 1, 1.5e-4.into()).unwrap();
    let up = sweep(&model, &harmonics(7), 0.9, 1.1, &[]);
    check("narrow folds", &up, 0.9, 1.1, 300);
    let down = sweep(&model, &harmonics(7), 1.1, 0.9, &[]);
    check("narrow folds, downwards", &down, 1.1, 0.9, 300);
    assert_eq!((up.folds().len(), down.folds().len()), (2, 2));
    for (a, b) in up.folds().iter().zip(down.folds().iter().rev()) {
        assert!((a.omega / b.omega - 1.0).abs() < 1e-10, "{a:?} {b:?}");
    }
    // Describing function: near the peak, a c ω = F.
    let top = peak(&up);
    assert!(
        (top / (1.5e-4 / (1e-3 * up.peaks()[0].omega)) - 1.0).abs() < 1e-3,
        "{top}"
    );
}

#[test]
fn a_resonance_of_width_1e_minus_5_is_found_without_a_grid() {
    // |X| at the resonance of the free mass is F/(cω); its half-power width is c.
    let model = rubbing(1e-5, 1.0, 0.0, 1.0);
    let branch = sweep(&model, &harmonics(3), 0.5, 1.7, &[]);
    check("narrow resonance", &branch, 0.5, 1.7, 200);
    let top = branch.peaks()[0];
    assert!(
        (top.amplitude * 1e-5 - 1.0).abs() < 1e-9 && (top.omega - 1.0).abs() < 1e-9,
        "{top:?}"
    );
    // The same, stuck: at sqrt 2, and slipping from a millionth of the peak on.
    let stuck = sweep(&rubbing(1e-5, 1.0, f64::INFINITY, 1.0), &harmonics(3), 0.5, 1.7, &[]);
    check("narrow stuck resonance", &stuck, 0.5, 1.7, 200);
    assert!((stuck.peaks()[0].omega - 2.0_f64.sqrt()).abs() < 1e-9);
    let slipping = sweep(&rubbing(1e-5, 1.0, 1.5, 1.0), &harmonics(3), 0.5, 1.7, &[]);
    check("damped by friction", &slipping, 0.5, 1.7, 200);
}

#[test]
fn three_resonances_lie_in_one_sweep() {
    // A chain of three masses, natural frequencies 2 sin(pi j / 8), a weak contact at its end.
    let chain = [2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0];
    let mass = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let mut model = structure(&mass, &chain.map(|k| 0.005 * k), &chain);
    model.add_contact(&Contact::jenkins(2, None, 0.05, 1.0, 0.02)).unwrap();
    model.add_force(0, 1, 0.1.into()).unwrap();
    let branch = sweep(&model, &harmonics(5), 0.3, 2.5, &[]);
    check("three resonances", &branch, 0.3, 2.5, 300);
    let found: Vec<f64> = branch.peaks().iter().map(|p| p.omega).collect();
    assert_eq!(found.len(), 3, "{found:?}");
    for (j, omega) in (1..).zip(found) {
        let free = 2.0 * (PI * f64::from(j) / 8.0).sin();
        assert!((omega / free - 1.0).abs() < 0.02, "{omega} for {free}");
    }
}

#[test]
fn slip_sets_in_within_the_range_without_walking_back() {
    // Stuck up to where |x| = limit / kt, which the linear response tells.
    let model = rubbing(0.02, 1.0, 0.3, 0.1);
    for highest in [1, 3, 9, 31] {
        for (from, to) in [(0.7, 1.9), (1.9, 0.7)] {
            let branch = sweep(&model, &harmonics(highest), from, to, &[]);
            check(
                &format!("onset of slip, H = {highest}, from {from}"),
                &branch,
                from,
                to,
                300,
            );
            for i in 0..branch.points() {
                let omega = branch.omega()[i];
                let linear = 0.1 / (2.0 - omega * omega).hypot(0.02 * omega);
                if slip(&branch, i) == 0.0 {
                    assert!((branch.amplitude()[i] / linear - 1.0).abs() < 1e-9 && linear < 0.3 * (1.0 + 1e-9));
                } else {
                    assert!(linear > 0.3 * (1.0 - 1e-9), "slip at {omega}, where {linear} sticks");
                }
            }
        }
    }
}

#[test]
fn an_isolated_curve_is_not_on_the_branch() {
    // A gap spring that the mass reaches only where it already moves far: at this frequency there are
    // three solutions (two from impacts), but the sweep at small force never meets them. It says that it
    // covered its range, and has one solution there: curves of their own are not searched (README,
    // Limits).
    let mut model = structure(&[1.0], &[0.02], &[1.0]);
    model
        .add_contact(&Contact::unilateral(Some(0), None, 3.0, 0.2))
        .unwrap();
    model.add_force(0, 1, 0.02.into()).unwrap();
    let alone = sweep(&model, &harmonics(15), 1.3, 1.15, &[]);
    check("below an isolated solution", &alone, 1.3, 1.15, 100);
    let low = alone.amplitude()[alone.points() - 1];
    assert!(low < 0.2, "{low}");
    // The solution of large motion at the same frequency, from the other side.
    let up = sweep(&model, &harmonics(15), 0.9, 1.15, &[]);
    check("towards it from below", &up, 0.9, 1.15, 200);
    let high = up.amplitude()[up.points() - 1];
    assert!(high > 2.0 * low, "{high} {low}");
}

#[test]
fn an_undamped_structure_is_held_by_its_friction() {
    // Bounded while F < 4 limit / pi (a square wave's fundamental).
    let model = rubbing(0.0, 1.0, 0.3, 0.35);
    for (from, to) in [(0.5, 1.8), (1.8, 0.5)] {
        let branch = sweep(&model, &harmonics(9), from, to, &[]);
        check(&format!("undamped, from {from}"), &branch, from, to, 300);
        assert!(branch.peaks().iter().all(|p| p.amplitude.is_finite()));
    }
}

#[test]
fn a_hundred_contacts_that_switch_at_once_are_one() {
    let one = rubbing(0.02, 1.0, 0.3, 0.5);
    let mut many = structure(&[1.0], &[0.02], &[1.0]);
    for _ in 0..100 {
        many.add_contact(&Contact::jenkins(0, None, 0.01, 1.0, 0.003)).unwrap();
    }
    many.add_force(0, 1, 0.5.into()).unwrap();
    let at = [0.9, 1.1, 1.25, 1.4];
    let branches = [one, many].map(|model| sweep(&model, &harmonics(5), 0.5, 1.8, &at));
    for (branch, name) in branches.iter().zip(["one contact", "a hundred contacts"]) {
        check(name, branch, 0.5, 1.8, 300);
    }
    let [one, many] = &branches;
    for i in 0..at.len() {
        let (a, b) = (one.at(i), many.at(i));
        assert_eq!((a.len(), b.len()), (1, 1));
        assert!((a[0].amplitude / b[0].amplitude - 1.0).abs() < 1e-10);
    }
}

#[test]
fn a_sweep_starts_again_from_any_of_its_points() {
    let model = Blisk {
        force: 20.0,
        ..common::BASE
    }
    .sector();
    let (from, to) = (2.0 * PI * 207.0, 2.0 * PI * 211.0);
    let branch = sweep(&model, &harmonics(9), from, to, &[]);
    check("to restart", &branch, from, to, 200);
    for point in 0..branch.stored() {
        let x = all_harmonics(&branch, point);
        let omega = branch.omega_at(point).unwrap();
        let range = ForcedOptions {
            guess: Some(&x),
            ..omega_range(omega, omega)
        };
        let again = forced_response(&model, &harmonics(9), &range, &mut Hooks::default()).unwrap();
        assert_eq!((again.status(), again.points()), (Status::Ok, 1), "point {point}");
        assert!(again.newton_iterations()[0] <= 3.0, "{:?}", again.newton_iterations());
        let gap = relative_gap(&all_harmonics(&again, 0), &x);
        assert!(gap < 1e-9, "point {point}: {gap:e}");
    }
}
