//! Following the response over a range: ends, directions, wanted frequencies, stops, corners, and
//! friction cases on which other tools walk back and forth or stop short. All same-H solutions.

use crate::common::models::{dense, diagonal};
use crate::common::{self, BASE, Blisk, all_harmonics, harmonics, omega_range, solve_at, sweep};
use hbvib::{Branch, Contact, Hooks, Model, SolverOptions, Status, forced_response};
use std::cell::Cell;
use std::f64::consts::{PI, TAU};

const LOW: f64 = TAU * 205.0;
const HIGH: f64 = TAU * 213.0;

fn assert_covers(branch: &Branch, from: f64, to: f64, what: &str) {
    assert_eq!(branch.status(), Status::Ok, "{what}");
    assert_eq!(branch.omega()[0].to_bits(), from.to_bits(), "{what}");
    assert_eq!(branch.omega().last().unwrap().to_bits(), to.to_bits(), "{what}");
}

fn highest(branch: &Branch) -> f64 {
    branch.peaks().iter().fold(0.0, |m, p| m.max(p.amplitude))
}

#[test]
fn both_directions_hit_both_ends_exactly_and_give_the_same_peak() {
    for force in [0.3, 1.0, 5.0, 20.0, 60.0] {
        let model = Blisk { force, ..BASE }.sector();
        let (up, down) = (
            sweep(&model, &harmonics(7), LOW, HIGH, &[]),
            sweep(&model, &harmonics(7), HIGH, LOW, &[]),
        );
        assert_covers(&up, LOW, HIGH, "up");
        assert_covers(&down, HIGH, LOW, "down");
        assert_eq!((up.peaks().len(), down.peaks().len()), (1, 1), "{force} N");
        let (a, b) = (up.peaks()[0], down.peaks()[0]);
        assert!((a.amplitude / b.amplitude - 1.0).abs() < 1e-9, "{force} N");
        assert!((a.omega / b.omega - 1.0).abs() < 1e-8, "{force} N");
    }
}

#[test]
fn every_wanted_frequency_is_solved_exactly_in_the_order_given() {
    let model = BASE.sector();
    // Unsorted, repeated, at both ends, and in the resonance.
    let at = [
        TAU * 208.85,
        HIGH,
        TAU * 206.5,
        LOW,
        TAU * 208.85,
        TAU * 212.999,
        TAU * 208.8,
    ];
    for (from, to) in [(LOW, HIGH), (HIGH, LOW)] {
        let branch = sweep(&model, &harmonics(5), from, to, &at);
        for (i, &wanted) in at.iter().enumerate() {
            let found = branch.at(i);
            assert_eq!(found.len(), 1, "{} Hz", wanted / TAU);
            assert_eq!(found[0].omega.to_bits(), wanted.to_bits());
            let alone = all_harmonics(&solve_at(&model, &harmonics(5), wanted), 0);
            let gap = common::relative_gap(&all_harmonics(&branch, found[0].point), &alone);
            assert!(gap < 1e-10, "{} Hz: {gap:.1e}", wanted / TAU);
        }
        assert!(branch.at(at.len()).is_empty());
    }
}

#[test]
fn a_range_of_one_frequency_is_one_point() {
    let branch = sweep(&BASE.sector(), &harmonics(5), LOW, LOW, &[LOW]);
    assert_covers(&branch, LOW, LOW, "one point");
    assert_eq!(branch.points(), 1);
    assert_eq!(branch.at(0).len(), 1);
}

#[test]
fn the_limit_on_points_keeps_what_was_found() {
    let options = SolverOptions {
        max_points: 7,
        ..harmonics(5)
    };
    let branch = sweep(&BASE.sector(), &options, LOW, HIGH, &[]);
    let whole = sweep(&BASE.sector(), &harmonics(5), LOW, HIGH, &[]);
    assert_eq!(branch.status(), Status::StoppedMaxPoints);
    assert_eq!(branch.points(), 7);
    assert!(branch.omega() == &whole.omega()[..7]);
    assert!(all_harmonics(&branch, 6) == all_harmonics(&whole, 6));
}

#[test]
fn a_hook_that_stops_keeps_what_was_found_and_sees_every_point() {
    let model = BASE.sector();
    let range = omega_range(HIGH, LOW);
    let mut seen = Vec::new();
    let mut stop_at_5 = |p: &hbvib::Progress| {
        seen.push((p.point, p.parameter, p.fraction_done));
        p.point == 5
    };
    let mut hooks = Hooks {
        progress: Some(&mut stop_at_5),
        ..Hooks::default()
    };
    let branch = forced_response(&model, &harmonics(5), &range, &mut hooks).unwrap();
    assert_eq!(branch.status(), Status::StoppedByCaller);
    assert_eq!(branch.points(), 5);
    assert_eq!(seen.len(), 5);
    for (i, (point, omega, fraction)) in seen.iter().enumerate() {
        assert_eq!(*point, i + 1);
        assert_eq!(omega.to_bits(), branch.omega()[i].to_bits());
        assert!((0.0..=1.0).contains(fraction));
    }
    assert!(all_harmonics(&branch, 4).iter().all(|z| z.is_finite()));
}

#[test]
fn a_cancel_at_any_check_keeps_what_was_found() {
    let range = omega_range(LOW, HIGH);
    let checks = {
        let asked = Cell::new(0);
        let counted = || {
            asked.set(asked.get() + 1);
            false
        };
        let mut hooks = Hooks {
            cancelled: Some(&counted),
            ..Hooks::default()
        };
        let branch = forced_response(&BASE.sector(), &harmonics(5), &range, &mut hooks).unwrap();
        assert_eq!(branch.status(), Status::Ok);
        asked.get()
    };
    assert!(checks > 1_000, "{checks}");
    // Asked in every long loop: at once, in the set-up, and after some points.
    let late = checks * 9 / 10;
    for patience in [0, 1, 10, 60, 300, late] {
        let asked = Cell::new(0);
        let cancelled = || {
            asked.set(asked.get() + 1);
            asked.get() > patience
        };
        let mut hooks = Hooks {
            cancelled: Some(&cancelled),
            ..Hooks::default()
        };
        let branch = forced_response(&BASE.sector(), &harmonics(5), &range, &mut hooks).unwrap();
        assert_eq!(branch.status(), Status::StoppedByCaller);
        assert_eq!(asked.get(), patience + 1, "nothing is done after a cancel");
        assert!(patience > 0 || branch.points() == 0);
        assert!(patience < late || branch.points() > 0);
    }
}

#[test]
fn a_linear_problem_is_followed_through_its_resonances() {
    let model = Blisk {
        ring_mass: None,
        ..BASE
    }
    .sector();
    let (from, to) = (TAU * 150.0, TAU * 750.0);
    let branch = sweep(&model, &harmonics(9), from, to, &[]);
    assert_covers(&branch, from, to, "linear");
    assert_eq!(branch.carried_at(0).unwrap(), [1]);
    // Three families of nodal diameter 2 lie within; the truth is in the natural frequencies.
    let natural = model.linear_modes(2, hbvib::ContactState::Free).unwrap();
    assert_eq!(branch.peaks().len(), 3);
    for (peak, omega) in branch.peaks().iter().zip(&natural.omega) {
        // A peak lies within the half width of its mode, which is the modal damping ratio.
        let damping = 0.5 * common::BETA * omega;
        assert!((peak.omega / omega - 1.0).abs() < damping);
    }
    assert!(branch.points() < 400, "{} points", branch.points());
}

/// Longest walk that counts as bounded: the worst case here takes about 570 points.
const MANY: usize = 1000;

/// Sweeps both ways; both must cover the range within a bounded number of points and agree.
fn robust(name: &str, model: &Model, highest_harmonic: usize, low: f64, high: f64) -> usize {
    let options = SolverOptions {
        max_points: MANY,
        // The default depends on the frequency at the start.
        response_dof: Some(0),
        ..harmonics(highest_harmonic)
    };
    let up = sweep(model, &options, low, high, &[]);
    assert_covers(&up, low, high, name);
    let down = sweep(model, &options, high, low, &[]);
    assert_covers(&down, high, low, name);
    // The highest peak; a pair of peak and hollow within one step is seen from neither side.
    let gap = (highest(&up) - highest(&down)).abs();
    assert!(gap <= 1e-8 * highest(&up), "{name}: peaks differ by {gap:.1e}");
    up.points().max(down.points())
}

#[test]
fn the_blisk_is_followed_at_every_force_through_the_onset_of_slip() {
    let mut most = 0;
    for i in 0..24 {
        let force = 0.3 * 200.0_f64.powf(f64::from(i) / 23.0);
        for h in (1..=15).step_by(2) {
            let model = Blisk { force, ..BASE }.sector();
            most = most.max(robust(&format!("F = {force} N, H = {h}"), &model, h, LOW, HIGH));
        }
    }
    println!("at most {most} points");
}

#[test]
fn corners_of_the_branch_are_passed() {
    // Engine order 0 leaves the ring free in the wheel's sense: where it begins to slip, the motion
    // of the contact turns sharply, at 5 N by more than 60 degrees.
    let mut most = 0;
    for force in [2.0, 3.0, 4.0, 5.0, 6.0, 10.0, 20.0, 40.0, 100.0] {
        for h in [1, 3, 5, 7, 9, 15] {
            let model = Blisk {
                force,
                engine_order: 0,
                ..BASE
            }
            .sector();
            let name = format!("EO 0, F = {force} N, H = {h}");
            most = most.max(robust(&name, &model, h, TAU * 89.5, TAU * 92.5));
        }
    }
    println!("at most {most} points");
}

/// Four degrees of freedom with one contact, undriven ring on its own spring.
fn chain(force: f64) -> Model {
    let wave = (PI / 12.0).sin().powi(2);
    let (outer, inner) = (2e6, 1e6);
    let (disk, ring) = (6e5 + 4.0 * 5e7 * wave, 4.0 * 2e7 * wave);
    #[rustfmt::skip]
    let stiffness = [
        outer, -outer, 0.0, 0.0,
        -outer, outer + inner, -inner, 0.0,
        0.0, -inner, inner + disk, 0.0,
        0.0, 0.0, 0.0, ring,
    ];
    dense(&diagonal(&[0.2, 0.3, 1.2, 0.03]), &stiffness)
        .rayleigh(0.0, 2e-6)
        .contact(Contact::jenkins(2, Some(3), 5e7, 1.0, 5.0))
        .force(0, 1, force)
        .build()
}

#[test]
fn a_case_on_which_others_walk_back_and_forth_is_covered_at_every_force() {
    let mut most = 0;
    for force in [0.05, 0.5, 2.0, 5.0, 20.0, 50.0] {
        for h in (1..=15).step_by(2) {
            let name = format!("F = {force} N, H = {h}");
            most = most.max(robust(&name, &chain(force), h, 1187.306, 1451.152));
        }
    }
    println!("at most {most} points");
}

/// A chain of masses with sliders, driven in the first harmonic and at its end in the second.
fn masses(mass: &[f64], stiffness: &[f64], beta: f64, sliders: &[(usize, usize, f64, f64)], second: f64) -> Model {
    let slider = |&(a, b, kt, limit): &_| Contact::jenkins(a, (a != b).then_some(b), kt, 1.0, limit);
    dense(&diagonal(mass), stiffness)
        .rayleigh(0.0, beta)
        .contacts(sliders.iter().map(slider))
        .force(0, 1, 1.0)
        .force(mass.len() - 1, 2, second)
        .build()
}

#[test]
fn corners_of_any_angle_are_turned_the_right_way() {
    // Found among thousands of random models: where the mean and even harmonics take part, the
    // branch has corners of up to 150 degrees at the onset of slip. Taken in the wrong sense, the
    // walk would return to its start, or show folds that friction alone does not make.
    let two_sliders = masses(
        &[0.240_551_262_159_742_82, 0.933_400_618_444_965_7],
        &[
            0.480_144_445_181_182_8,
            -0.479_758_041_0,
            -0.479_758_041_0,
            0.570_053_863_3,
        ],
        0.003_924_002_981_529_376,
        &[
            (1, 1, 0.565_731_340_1, 1.673_161_756_6),
            (1, 1, 8.905_198_709_5, 2.137_619_228_4),
        ],
        0.073_641_765_9,
    );
    #[rustfmt::skip]
    let one_slider = masses(
        &[0.476_744_001_4, 0.375_600_070_1, 0.071_228_003_6],
        &[
            1.039_910_380_5, -0.429_336_815_6, 0.0,
            -0.429_336_815_6, 1.425_287_064_0, -0.992_614_757_7,
            0.0, -0.992_614_757_7, 1.005_532_355_1,
        ],
        0.016_849_774_1,
        &[(0, 0, 4.889_625_822_3, 1.921_551_019_7)],
        1.553_517_512_0,
    );
    #[rustfmt::skip]
    let between = masses(
        &[0.735_678_227_8, 0.430_770_645_6, 1.045_435_072_7],
        &[
            0.686_139_663_4, -0.675_627_425_8, 0.0,
            -0.675_627_425_8, 1.543_444_338_2, -0.184_752_867_1,
            0.0, -0.184_752_867_1, 0.739_289_104_1,
        ],
        0.001_123_634_1,
        &[(2, 0, 6.906_990_633_7, 1.069_299_312_2)],
        1.405_598_641_4,
    );
    let mut most = 0;
    for (name, model, h) in [
        ("two sliders", two_sliders, 3),
        ("one slider", one_slider, 5),
        ("a slider between", between, 3),
    ] {
        for (low, high) in [(0.1, 4.0), (0.1, 2.5), (0.15, 1.0)] {
            most = most.max(robust(name, &model, h, low, high));
            let branch = sweep(&model, &harmonics(h), low, high, &[]);
            assert!(branch.folds().is_empty(), "{name}");
            assert!(branch.omega().windows(2).all(|w| w[1] > w[0]), "{name}: a step back");
        }
    }
    println!("at most {most} points");
}
